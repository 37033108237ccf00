//! The identity of a scene: a hash of the contents of all its files, which does not depend on where they lie.

use std::fmt;
use xxhash_rust::xxh3::xxh3_128;

/// A hash of 128 bits (XXH3). It tells scenes apart; it is no seal against forgery.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Digest(u128);

impl Digest {
    /// Of a text or file.
    pub fn of(bytes: &[u8]) -> Digest {
        Digest(xxh3_128(bytes))
    }

    /// Of several contents in their order.
    pub fn join(parts: &[Digest]) -> Digest {
        Digest::of(&parts.iter().flat_map(|part| part.0.to_le_bytes()).collect::<Vec<u8>>())
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}
