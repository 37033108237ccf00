//! The identity of a scene: a hash of the contents of all its files, which does not depend on where they lie.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::num::ParseIntError;
use xxhash_rust::xxh3::xxh3_128;

/// A hash of 128 bits (XXH3). It tells scenes apart; it is no seal against forgery.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
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

impl From<Digest> for String {
    fn from(digest: Digest) -> String {
        digest.to_string()
    }
}

impl TryFrom<String> for Digest {
    type Error = ParseIntError;

    fn try_from(text: String) -> Result<Digest, ParseIntError> {
        u128::from_str_radix(&text, 16).map(Digest)
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}
