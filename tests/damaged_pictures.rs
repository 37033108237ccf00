//! Files that are no pictures, or no whole ones: errors, soon, whatever reads them.

use pathtracer::error::Error;
use pathtracer::picture::{Destination, Info, Pixels, read};
use pathtracer::scene;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The formats that are written, and one that only OpenImageIO knows.
const EXTENSIONS: [&str; 7] = ["png", "exr", "jpg", "tif", "hdr", "bmp", "tga"];
const WRITTEN: [&str; 5] = ["png", "exr", "jpg", "tif", "hdr"];

/// What a look at a file may take, with the library's start, on a machine that has much else to do.
const SOON: Duration = Duration::from_secs(60);

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// Whether this build reads the format.
fn is_known(extension: &str) -> bool {
    cfg!(feature = "oiio") || ["png", "exr"].contains(&extension)
}

#[track_caller]
fn assert_refused(path: &Path) {
    let start = Instant::now();
    let error = read(path).err().unwrap_or_else(|| panic!("{} is a picture", path.display()));
    assert!(matches!(error, Error::Picture(_) | Error::Io { .. }), "{error:?}");
    assert!(error.to_string().starts_with(&format!("cannot read the picture {}", path.display())), "{error}");
    assert!(start.elapsed() < SOON, "{}: {:?}", path.display(), start.elapsed());
}

/// A picture of 9 x 7 pixels whose rows do not compress.
fn written(folder: &TempDir, extension: &str) -> PathBuf {
    let path = folder.path().join(format!("a.{extension}"));
    let values = 0..3 * 9 * 7u32;
    let pixels = if ["exr", "hdr"].contains(&extension) {
        Pixels::Floats(values.map(|i| (i * 37 % 101) as f32).collect())
    } else {
        Pixels::Bytes(values.map(|i| (i * 37 % 251) as u8).collect())
    };
    Destination::new(&path).expect("a place").write(9, 7, &pixels).expect("written");
    path
}

#[test]
fn a_gigabyte_of_zeros() {
    let folder = folder();
    for extension in EXTENSIONS {
        // A hole, which takes no room.
        let path = folder.path().join(format!("zeros.{extension}"));
        File::create(&path).and_then(|file| file.set_len(1 << 30)).expect("a file");
        assert_refused(&path);
        assert!(Info::read(&path).is_err(), "{extension}");
    }
}

#[test]
fn a_scene_that_names_a_gigabyte_of_zeros_is_told_where() {
    let folder = folder();
    File::create(folder.path().join("zeros.png")).and_then(|file| file.set_len(1 << 30)).expect("a file");
    let text = "Camera: {Position: [0, 0, 5], LookingAt: [0, 0, 0], Fov: 0.3, FocusDistance: 5}\nObjects:\n  - \
                Object:\n      Type: Ball\n      Position: [0, 0, 0]\n      Radius: 1\n      Material:\n        \
                Type: Diffuse\n        Color: {Image: zeros.png}\n";
    let start = Instant::now();
    let error = scene::parse(text, &folder.path().join("scene.yaml")).expect_err("no picture").to_string();
    assert!(error.contains("scene.yaml:9:24") && error.contains("zeros.png"), "{error}");
    assert!(start.elapsed() < SOON, "{:?}", start.elapsed());
}

#[test]
fn empty_files_text_and_folders() {
    let folder = folder();
    for extension in EXTENSIONS {
        let path = |name: &str| folder.path().join(format!("{name}.{extension}"));
        fs::write(path("empty"), "").expect("a file");
        fs::write(path("text"), "this is no picture, but a line of text\n").expect("a file");
        fs::create_dir(path("folder")).expect("a folder");
        for name in ["empty", "text", "folder", "missing"] {
            assert_refused(&path(name));
        }
    }
}

#[test]
fn files_of_another_format_than_their_name() {
    let folder = folder();
    let known: Vec<&str> = WRITTEN.into_iter().filter(|extension| is_known(extension)).collect();
    for from in &known {
        let bytes = fs::read(written(&folder, from)).expect("a file");
        for to in known.iter().filter(|to| *to != from) {
            let path = folder.path().join(format!("{from}.{to}"));
            fs::write(&path, &bytes).expect("a file");
            assert_refused(&path);
        }
    }
}

#[test]
fn files_that_end_too_early() {
    let folder = folder();
    for extension in WRITTEN.into_iter().filter(|extension| is_known(extension)) {
        let path = written(&folder, extension);
        assert!(read(&path).is_ok(), "{extension}");
        let whole = fs::read(&path).expect("a file");
        // A JPEG that lacks its end has its pixels, grey where they are missing: its readers do not refuse it.
        let ends = if extension == "jpg" { 1..whole.len().min(200) } else { 1..whole.len() * 3 / 4 };
        for end in ends {
            fs::write(&path, &whole[..end]).expect("a file");
            assert_refused(&path);
        }
    }
}

/// Bytes of a file with other ones from `at` on.
fn patched(folder: &TempDir, extension: &str, name: &str, edit: impl FnOnce(&mut Vec<u8>)) -> PathBuf {
    let mut bytes = fs::read(written(folder, extension)).expect("a file");
    edit(&mut bytes);
    let path = folder.path().join(format!("{name}.{extension}"));
    fs::write(&path, bytes).expect("a file");
    path
}

/// A PNG that says it has this size.
fn png_of_size(folder: &TempDir, name: &str, [width, height]: [u32; 2]) -> PathBuf {
    patched(folder, "png", name, |bytes| {
        bytes[16..20].copy_from_slice(&width.to_be_bytes());
        bytes[20..24].copy_from_slice(&height.to_be_bytes());
        let crc = crc32(&bytes[12..29]);
        bytes[29..33].copy_from_slice(&crc.to_be_bytes());
    })
}

/// The checksum of PNG chunks: CRC-32 of ISO 3309, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg()))
    })
}

/// An EXR that says its data window has this size.
fn exr_of_size(folder: &TempDir, name: &str, [width, height]: [i32; 2]) -> PathBuf {
    patched(folder, "exr", name, |bytes| {
        for attribute in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
            let found = bytes.windows(attribute.len()).position(|window| window == attribute);
            let start = found.expect("an attribute") + attribute.len() + 4;
            let corners = [0, 0, width.wrapping_sub(1), height.wrapping_sub(1)].map(i32::to_le_bytes);
            bytes[start..start + 16].copy_from_slice(&corners.concat());
        }
    })
}

/// A Radiance file that says it has this size.
fn hdr_of_size(folder: &TempDir, name: &str, [width, height]: [u32; 2]) -> PathBuf {
    let path = folder.path().join(format!("{name}.hdr"));
    let header = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\nabcd");
    fs::write(&path, header).expect("a file");
    path
}

#[test]
fn sizes_that_the_file_does_not_have() {
    let folder = folder();
    for (name, size) in [
        ("flat", [0, 7]),
        ("narrow", [9, 0]),
        ("line", [100_000, 1]),
        ("column", [1, 100_000]),
        ("larger", [10, 700]),
        ("huge", [1_000_000, 1_000_000]),
        ("most", [i32::MAX as u32, i32::MAX as u32]),
    ] {
        assert_refused(&png_of_size(&folder, name, size));
        assert_refused(&exr_of_size(&folder, name, size.map(|side| side as i32)));
        assert_refused(&hdr_of_size(&folder, name, size));
    }
}

/// A picture that is a hundred thousand pixels wide is one.
#[test]
fn a_line_of_a_hundred_thousand_pixels_reads_back() {
    let folder = folder();
    for extension in ["png", "exr", "tif", "hdr"].into_iter().filter(|extension| is_known(extension)) {
        let path = folder.path().join(format!("line.{extension}"));
        let values = 0..300_000u32;
        let pixels = if ["exr", "hdr"].contains(&extension) {
            Pixels::Floats(values.map(|i| (i % 128) as f32).collect())
        } else {
            Pixels::Bytes(values.map(|i| (i % 251) as u8).collect())
        };
        Destination::new(&path).expect("a place").write(100_000, 1, &pixels).expect("written");
        let decoded = read(&path).expect("a picture");
        assert_eq!((decoded.width, decoded.height), (100_000, 1), "{extension}");
    }
}
