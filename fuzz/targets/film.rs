//! Checkpoints and parts: whatever a file holds, it is refused with a message or taken over. The first byte says whether the
//! checksum is put right, so that the rest is looked at too.
#![no_main]

mod support;

use libfuzzer_sys::fuzz_target;
use pathtracer::render::{FilmFile, merge};
use xxhash_rust::xxh3::xxh3_128;

/// Bytes before the header, and of the checksum.
const PREFIX: usize = 16;

fuzz_target!(|bytes: &[u8]| {
    let Some((&kind, content)) = bytes.split_first() else { return };
    let mut file = content.to_vec();
    if kind % 4 != 0 {
        // Magic, format and length of the header, which ends with the first line end.
        let header = content.iter().position(|&byte| byte == b'\n').unwrap_or(content.len());
        file = b"PTfilm\r\n\x01\0\0\0".to_vec();
        file.extend((header as u32).to_le_bytes());
        file.extend(&content[..header]);
        file.extend(content.get(header + 1..).unwrap_or_default());
        assert!(file.len() >= PREFIX);
        file.extend(xxh3_128(&file).to_le_bytes());
    }
    let path = support::file("a.film", &file);
    if let Ok(file) = FilmFile::open(&path) {
        let recipe = file.origin().recipe.clone();
        let settings = recipe.settings();
        // Larger pictures only take longer.
        if u64::from(settings.width) * u64::from(settings.height) > 1 << 14 {
            return;
        }
        let refused = file.state(&settings, &recipe).err();
        assert!(refused.is_none_or(|error| !error.to_string().is_empty()));
        let refused = merge(&[path], false).err();
        assert!(refused.is_none_or(|error| !error.to_string().is_empty()));
    }
});
