//! Where the values stand that a message points at.
//!
//! Scalars are found in one more pass that reads them as text borrowed from the file, whatever their type. Lists,
//! mappings and texts that the parser had to rewrite (escapes, folded lines) are found one by one: a visitor
//! that takes nothing fails at the value, and the parser's error says where that is. A value that is reached
//! through an alias stands where it was written, at the anchor.

use super::node::offset_of;
use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::cell::RefCell;
use std::fmt;

/// Bytes that the one-by-one search may parse in all. What is left then has no place.
const SEARCH_BUDGET: usize = 64 << 20;

/// A place that is looked for: the child indices from the root, counting entries of mappings too.
pub(crate) struct Target {
    /// The way from the root.
    pub(crate) path: Vec<u32>,
    /// What is meant at its end.
    pub(crate) part: Part,
}

/// What a [`Target`] means.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// The key of the entry.
    Key,
    /// A value that is a list, a mapping or tagged.
    Collection,
    /// Any other value.
    Scalar,
}

/// Byte offsets of the targets.
pub(crate) fn find(text: &str, targets: &[Target]) -> Vec<Option<usize>> {
    let found = RefCell::new(vec![None; targets.len()]);
    let mut scalars: Vec<(&[u32], usize)> = Vec::new();
    for (i, target) in targets.iter().enumerate() {
        if target.part == Part::Scalar {
            scalars.push((&target.path, i));
        }
    }
    scalars.sort();
    if !scalars.is_empty() {
        let sweep = Sweep { text, targets: &scalars, depth: 0, found: &found };
        // A document that was read once can't fail now; what is missing is searched below.
        let _ = sweep.deserialize(serde_yaml::Deserializer::from_str(text));
    }
    let mut found = found.into_inner();
    let mut budget = SEARCH_BUDGET.max(text.len());
    for (target, offset) in targets.iter().zip(&mut found) {
        if offset.is_none() && budget >= text.len() {
            budget -= text.len();
            *offset = search(text, target);
        }
    }
    found
}

/// Byte offset of one target.
fn search(text: &str, target: &Target) -> Option<usize> {
    let search = Search { path: &target.path, key: target.part == Part::Key };
    let error = search.deserialize(serde_yaml::Deserializer::from_str(text)).err()?;
    error.location().map(|location| behind_anchor(text, location.index()))
}

/// The parser's mark of a value is that of its anchor or standard tag, if it has one; the value comes after.
fn behind_anchor(text: &str, mark: usize) -> usize {
    let mut rest = text.get(mark..).unwrap_or("");
    while rest.starts_with('&') || rest.starts_with("!!") {
        rest = rest.trim_start_matches(|c: char| !c.is_whitespace()).trim_start();
        while rest.starts_with('#') {
            rest = rest.trim_start_matches(|c| c != '\n').trim_start();
        }
    }
    text.len() - rest.len()
}

/// Reads the scalars at the ends of `targets`, which are sorted and agree in their first `depth` steps.
#[derive(Clone, Copy)]
struct Sweep<'s> {
    text: &'s str,
    targets: &'s [(&'s [u32], usize)],
    depth: usize,
    found: &'s RefCell<Vec<Option<usize>>>,
}

impl<'s> Sweep<'s> {
    /// The part of the sweep that goes through child `index`, if there is one.
    fn child(&self, index: u32) -> Option<Sweep<'s>> {
        let step = |target: &(&[u32], usize)| target.0.get(self.depth).copied();
        let first = self.targets.partition_point(|target| step(target) < Some(index));
        let last = self.targets.partition_point(|target| step(target) <= Some(index));
        let targets = self.targets.get(first..last).filter(|targets| !targets.is_empty())?;
        Some(Sweep { targets, depth: self.depth + 1, ..*self })
    }
}

impl<'de> DeserializeSeed<'de> for Sweep<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        if self.targets.iter().any(|target| target.0.len() > self.depth) {
            deserializer.deserialize_any(self)
        } else {
            deserializer.deserialize_str(self)
        }
    }
}

impl<'de> Visitor<'de> for Sweep<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the value that was there before")
    }

    fn visit_borrowed_str<E: Error>(self, part: &'de str) -> Result<(), E> {
        let offset = offset_of(self.text, part);
        let mut found = self.found.borrow_mut();
        for &(_, i) in self.targets {
            if let Some(place) = found.get_mut(i) {
                *place = offset;
            }
        }
        Ok(())
    }

    fn visit_str<E: Error>(self, _: &str) -> Result<(), E> {
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<(), A::Error> {
        for index in 0.. {
            let more = match self.child(index) {
                Some(child) => sequence.next_element_seed(child)?.is_some(),
                None => sequence.next_element::<IgnoredAny>()?.is_some(),
            };
            if !more {
                break;
            }
        }
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        for index in 0.. {
            if map.next_key::<IgnoredAny>()?.is_none() {
                break;
            }
            match self.child(index) {
                Some(child) => map.next_value_seed(child)?,
                None => _ = map.next_value::<IgnoredAny>()?,
            }
        }
        Ok(())
    }
}

/// Walks to the end of `path` and fails there.
#[derive(Clone, Copy)]
struct Search<'s> {
    path: &'s [u32],
    key: bool,
}

impl<'de> DeserializeSeed<'de> for Search<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        if self.path.is_empty() {
            deserializer.deserialize_any(Refusal)
        } else {
            deserializer.deserialize_any(self)
        }
    }
}

impl<'de> Visitor<'de> for Search<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the value that was there before")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<(), A::Error> {
        if let Some((&index, path)) = self.path.split_first() {
            for _ in 0..index {
                sequence.next_element::<IgnoredAny>()?;
            }
            sequence.next_element_seed(Search { path, ..self })?;
        }
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        if let Some((&index, path)) = self.path.split_first() {
            for _ in 0..index {
                map.next_entry::<IgnoredAny, IgnoredAny>()?;
            }
            if self.key && path.is_empty() {
                map.next_key_seed(Search { path, ..self })?;
            } else {
                map.next_key::<IgnoredAny>()?;
            }
            map.next_value_seed(Search { path, ..self })?;
        }
        Ok(())
    }
}

/// Takes no value at all, so that the parser reports where the value is.
struct Refusal;

impl Visitor<'_> for Refusal {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "nothing")
    }
}

/// Byte offset of the second document's content.
pub(super) fn second_document(text: &str) -> Option<usize> {
    let document = serde_yaml::Deserializer::from_str(text).nth(1)?;
    let error = Search { path: &[], key: false }.deserialize(document).err()?;
    error.location().map(|location| location.index())
}
