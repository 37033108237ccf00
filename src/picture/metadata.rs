//! What a picture file says about itself, beside its pixels.

/// Named values in the order in which they are written. Names are those of the file formats and their readers, such as
/// `Software` and `worldToCamera`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata(Vec<(String, Value)>);

/// A value of [`Metadata`]. Formats that hold text only hold each as it is displayed, with the digits of f32.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Any text.
    Text(String),
    /// A whole number.
    Integer(i64),
    /// A number; f32 in an EXR.
    Number(f64),
    /// A matrix for row vectors, row by row: the last row moves points. f32 in an EXR.
    Matrix([f64; 16]),
}

impl Metadata {
    /// Appends a value.
    pub fn push(&mut self, name: impl Into<String>, value: Value) {
        self.0.push((name.into(), value));
    }

    /// The first value of a name, as text.
    pub fn get(&self, name: &str) -> Option<String> {
        self.iter().find(|(other, _)| *other == name).map(|(_, value)| value.to_string())
    }

    /// All names and values.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.0.iter().map(|(name, value)| (name.as_str(), value))
    }
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Value::Text(text) => f.write_str(text),
            Value::Integer(number) => number.fmt(f),
            Value::Number(number) => (*number as f32).fmt(f),
            Value::Matrix(rows) => {
                let numbers: Vec<String> = rows.iter().map(|number| (*number as f32).to_string()).collect();
                f.write_str(&numbers.join(" "))
            }
        }
    }
}
