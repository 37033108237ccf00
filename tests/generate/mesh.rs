//! Triangle meshes and the OBJ text that they become.

use glam::DVec3;
use std::fmt::Write;

/// A mesh of triangles that face counter-clockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mesh {
    /// Vertices.
    pub(crate) positions: Vec<DVec3>,
    /// Shading normals of unit length, indexed apart from the positions so that edges can be sharp.
    pub(crate) normals: Vec<DVec3>,
    /// Three corners a triangle.
    pub(crate) triangles: Vec<[Corner; 3]>,
}

/// A corner of a triangle: indices into the positions and, in a smooth mesh, the normals.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    /// Index of the position.
    pub(crate) position: usize,
    /// Index of the normal; the meshes with flat triangles have none.
    pub(crate) normal: Option<usize>,
}

impl Corner {
    /// A corner without a normal.
    pub(crate) fn flat(position: usize) -> Corner {
        Corner { position, normal: None }
    }

    /// A corner whose normal has the index of its position.
    pub(crate) fn smooth(index: usize) -> Corner {
        Corner { position: index, normal: Some(index) }
    }
}

impl Mesh {
    /// Adds a quadrilateral, its corners counter-clockwise seen from outside, split along its shorter diagonal.
    pub(crate) fn add_quad(&mut self, [a, b, c, d]: [Corner; 4]) {
        let length =
            |p: Corner, q: Corner| self.positions[p.position].distance_squared(self.positions[q.position]);
        if length(a, c) <= length(b, d) {
            self.triangles.extend([[a, b, c], [a, c, d]]);
        } else {
            self.triangles.extend([[a, b, d], [b, c, d]]);
        }
    }

    /// Adds all triangles of another mesh.
    pub(crate) fn append(&mut self, other: &Mesh) {
        let (positions, normals) = (self.positions.len(), self.normals.len());
        let moved =
            |c: Corner| Corner { position: c.position + positions, normal: c.normal.map(|n| n + normals) };
        self.triangles.extend(other.triangles.iter().map(|t| t.map(moved)));
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
    }

    /// The OBJ text: numbers with at most `decimals` digits after the point, which is what makes it short and equal
    /// on every machine.
    pub(crate) fn to_obj(&self, title: &str, decimals: usize) -> String {
        let mut text = format!("# {title}. Made by tests/generate; {} triangles.\n", self.triangles.len());
        for (key, vectors) in [("v", &self.positions), ("vn", &self.normals)] {
            for v in vectors {
                let [x, y, z] = v.to_array().map(|x| fixed(x, decimals));
                writeln!(text, "{key} {x} {y} {z}").expect("a String takes all text");
            }
        }
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(corner_text);
            writeln!(text, "f {a} {b} {c}").expect("a String takes all text");
        }
        text
    }
}

/// `x` with at most `decimals` digits after the point and no needless zeros.
pub(crate) fn fixed(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A corner as OBJ writes it, counting from 1.
fn corner_text(corner: Corner) -> String {
    match corner.normal {
        Some(normal) => format!("{}//{}", corner.position + 1, normal + 1),
        None => (corner.position + 1).to_string(),
    }
}
