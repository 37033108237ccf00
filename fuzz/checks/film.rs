//! Checkpoints and parts: whatever a file holds, it is refused with a message or taken over. The first byte says whether the
//! checksum is put right, so that the rest is looked at too.

use pathtracer::render::{FileKind, FilmFile, merge};
use std::fs;
use std::path::Path;
use xxhash_rust::xxh3::xxh3_128;

/// Bytes before the header.
const PREFIX: usize = 16;
/// Larger pictures only take longer.
const MOST_PIXELS: u64 = 1 << 14;

/// Panics where the promise is broken.
pub(crate) fn check(folder: &Path, bytes: &[u8]) {
    let Some((&kind, content)) = bytes.split_first() else { return };
    let file = if kind % 4 == 0 { content.to_vec() } else { with_checksum(content) };
    let path = folder.join("a.film");
    fs::write(&path, file).expect("a temporary file");
    let said = FilmFile::kind_of(&path);
    let Ok(file) = FilmFile::open(&path) else { return };
    assert_eq!(said, Some(file.kind()));
    let recipe = file.origin().recipe.clone();
    let settings = recipe.settings();
    if u64::from(settings.width) * u64::from(settings.height) > MOST_PIXELS {
        return;
    }
    if file.kind() == FileKind::Checkpoint {
        let refused = file.state(&settings, &recipe).err();
        assert!(refused.is_none_or(|error| !error.to_string().is_empty()));
    } else if let Ok(rendered) = file.rendered() {
        let means = rendered.film.means();
        assert!(means.count() <= rendered.film.pixels());
        assert!(rendered.cut_light().is_none_or(|share| (0.0..=1.0).contains(&share) || share.is_nan()));
    }
    let refused = merge(&[path], false).err();
    assert!(refused.is_none_or(|error| !error.to_string().is_empty()));
}

/// Magic, format and the length of the header, which ends with the first line end, before; the checksum behind.
fn with_checksum(content: &[u8]) -> Vec<u8> {
    let header = content.iter().position(|&byte| byte == b'\n').unwrap_or(content.len());
    let mut file = b"PTfilm\r\n\x01\0\0\0".to_vec();
    file.extend((header as u32).to_le_bytes());
    file.extend(&content[..header]);
    file.extend(content.get(header + 1..).unwrap_or_default());
    assert!(file.len() >= PREFIX);
    file.extend(xxh3_128(&file).to_le_bytes());
    file
}
