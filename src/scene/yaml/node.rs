//! A YAML document as a tree, read through serde.
//!
//! serde hands over values without places. Text that the parser *borrows* is a slice of the file, though, so its
//! address is its place: keys and most texts know where they stand from the first pass. What else needs a place
//! (only values that a message points at) is looked up by `position`.

use serde::de::{DeserializeSeed, Deserializer, EnumAccess, Error, IgnoredAny, MapAccess, SeqAccess};
use serde::de::{VariantAccess, Visitor};
use std::borrow::Cow;
use std::cell::Cell;
use std::fmt;

/// Most values that a document may hold after its aliases are expanded: about 600,000 objects.
pub(crate) const MAX_VALUES: usize = 10_000_000;

/// One value, with the byte offset of its text where the first pass knows it.
#[derive(Debug)]
pub(crate) struct Node<'t> {
    /// What was written.
    pub(crate) kind: Kind<'t>,
    offset: u32,
}

/// The kinds of values.
#[derive(Debug)]
pub(crate) enum Kind<'t> {
    /// Nothing, `~` or `null`.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// Any number, `.nan` and `.inf` too.
    Number(f64),
    /// Any other scalar.
    Text(Cow<'t, str>),
    /// A sequence.
    List(Vec<Node<'t>>),
    /// A mapping in the order of the file, with its duplicates.
    Map(Vec<(Node<'t>, Node<'t>)>),
    /// A value with a tag of its own, such as `!color`.
    Tagged(String),
}

impl<'t> Node<'t> {
    /// Stands for "not known": files are shorter than 4 GiB.
    const NO_OFFSET: u32 = u32::MAX;

    fn new(kind: Kind<'t>) -> Node<'t> {
        Node { kind, offset: Node::NO_OFFSET }
    }

    /// Byte offset of the value's text, if the first pass knows it.
    pub(crate) fn offset(&self) -> Option<usize> {
        (self.offset != Node::NO_OFFSET).then_some(self.offset as usize)
    }

    /// The text of a text.
    pub(crate) fn text(&self) -> Option<&str> {
        match &self.kind {
            Kind::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The value of a number.
    pub(crate) fn number(&self) -> Option<f64> {
        match self.kind {
            Kind::Number(x) => Some(x),
            _ => None,
        }
    }

    /// The value of a key, if this is a mapping that has it.
    pub(crate) fn entry(&self, key: &str) -> Option<&Node<'t>> {
        self.at(self.position(key)?)
    }

    /// Which entry of this mapping has the key.
    pub(crate) fn position(&self, key: &str) -> Option<usize> {
        match &self.kind {
            Kind::Map(entries) => entries.iter().position(|(name, _)| name.text() == Some(key)),
            _ => None,
        }
    }

    /// The value of an entry of this mapping, or an item of this list.
    pub(crate) fn at(&self, index: usize) -> Option<&Node<'t>> {
        match &self.kind {
            Kind::Map(entries) => entries.get(index).map(|(_, value)| value),
            Kind::List(items) => items.get(index),
            _ => None,
        }
    }

    /// Whether the value is neither a list nor a mapping.
    pub(crate) fn is_scalar(&self) -> bool {
        matches!(self.kind, Kind::Null | Kind::Bool(_) | Kind::Number(_) | Kind::Text(_))
    }
}

/// Byte offset of the scalar whose content is `part`, a slice of `text`. Of a quoted one that is the offset of the
/// quote. Where escapes are in the way, the parser may return a slice from the middle of the scalar: then `None`.
pub(super) fn offset_of(text: &str, part: &str) -> Option<usize> {
    let offset = (part.as_ptr() as usize).checked_sub(text.as_ptr() as usize)?;
    if offset + part.len() > text.len() {
        return None;
    }
    let Some(before) = offset.checked_sub(1) else { return Some(offset) };
    match *text.as_bytes().get(before)? {
        b'"' => Some(before),
        b'\'' if !part.starts_with('\'') => Some(before),
        b' ' | b'\t' | b'\n' | b'\r' | b'[' | b'{' | b',' | b':' => Some(offset),
        _ => None,
    }
}

/// Reads one value of `text`; `left` counts down the values that may still come.
#[derive(Clone, Copy)]
pub(crate) struct NodeSeed<'s> {
    /// The whole file.
    pub(crate) text: &'s str,
    /// How many values may still come; 0 after an error means that there were too many.
    pub(crate) left: &'s Cell<usize>,
}

impl<'de> DeserializeSeed<'de> for NodeSeed<'_> {
    type Value = Node<'de>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Node<'de>, D::Error> {
        let left = self.left.get().checked_sub(1).ok_or_else(|| D::Error::custom("too many values"))?;
        self.left.set(left);
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for NodeSeed<'_> {
    type Value = Node<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "any value")
    }

    fn visit_unit<E: Error>(self) -> Result<Node<'de>, E> {
        Ok(Node::new(Kind::Null))
    }

    fn visit_none<E: Error>(self) -> Result<Node<'de>, E> {
        Ok(Node::new(Kind::Null))
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<Node<'de>, E> {
        Ok(Node::new(Kind::Bool(value)))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Node<'de>, E> {
        Ok(Node::new(Kind::Number(value as f64)))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Node<'de>, E> {
        Ok(Node::new(Kind::Number(value as f64)))
    }

    fn visit_i128<E: Error>(self, value: i128) -> Result<Node<'de>, E> {
        Ok(Node::new(Kind::Number(value as f64)))
    }

    fn visit_u128<E: Error>(self, value: u128) -> Result<Node<'de>, E> {
        Ok(Node::new(Kind::Number(value as f64)))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Node<'de>, E> {
        Ok(Node::new(Kind::Number(value)))
    }

    fn visit_borrowed_str<E: Error>(self, text: &'de str) -> Result<Node<'de>, E> {
        let offset = offset_of(self.text, text).and_then(|offset| u32::try_from(offset).ok());
        Ok(Node { kind: Kind::Text(Cow::Borrowed(text)), offset: offset.unwrap_or(Node::NO_OFFSET) })
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Node<'de>, E> {
        Ok(Node::new(Kind::Text(Cow::Owned(text.to_owned()))))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Node<'de>, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = sequence.next_element_seed(self)? {
            items.push(item);
        }
        Ok(Node::new(Kind::List(items)))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Node<'de>, A::Error> {
        let mut entries = Vec::new();
        while let Some(key) = map.next_key_seed(self)? {
            entries.push((key, map.next_value_seed(self)?));
        }
        Ok(Node::new(Kind::Map(entries)))
    }

    fn visit_enum<A: EnumAccess<'de>>(self, tagged: A) -> Result<Node<'de>, A::Error> {
        let (tag, content) = tagged.variant::<String>()?;
        content.newtype_variant::<IgnoredAny>()?;
        Ok(Node::new(Kind::Tagged(tag)))
    }
}
