//! Formats that OpenImageIO reads and writes.

use pathtracer::picture::{Depth, Destination, Info, Metadata, Picture, Pixels, Value, read};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const WIDTH: u32 = 12;
const HEIGHT: u32 = 7;

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// Values that change from pixel to pixel.
fn ramp<T>(of: impl Fn(u32) -> T) -> Vec<T> {
    (0..3 * WIDTH * HEIGHT).map(of).collect()
}

/// Of many digits.
const MATRIX: [f64; 16] = [
    -0.123_456_79,
    0.987_654_3,
    1e-7,
    0.0,
    0.333_333_34,
    -0.666_666_7,
    0.1,
    0.0,
    1.0,
    2.0,
    -1234.5677,
    0.0,
    1e9,
    -7.7,
    5e-5,
    1.0,
];

/// Longer than a line of some headers, and not of ASCII alone.
fn long_name() -> String {
    "größer ".repeat(60) + ".yaml"
}

fn write(path: &Path, pixels: Pixels, depth: Depth) {
    let mut metadata = Metadata::default();
    metadata.push("Software", Value::Text("pathtracer 0".into()));
    metadata.push("samplesPerPixel", Value::Integer(3));
    metadata.push("pathtracer:seed", Value::Text("7".into()));
    metadata.push("worldToCamera", Value::Matrix(MATRIX));
    metadata.push("pathtracer:scene", Value::Text(long_name()));
    let picture = Picture { width: WIDTH, height: HEIGHT, pixels, channels: Vec::new(), metadata };
    let destination = Destination::new(path).and_then(|place| place.with_depth(depth)).expect("a place");
    destination.write_picture(&picture).expect("written");
}

#[test]
fn tiff_reads_back_as_it_was_written_at_every_depth() {
    let folder = folder();
    let bytes = Pixels::Bytes(ramp(|i| i as u8));
    write(&folder.path().join("a.tif"), bytes.clone(), Depth::Eight);
    let decoded = read(&folder.path().join("a.tif")).expect("a picture");
    assert_eq!((decoded.width, decoded.height, decoded.is_encoded), (WIDTH, HEIGHT, true));
    assert_eq!(decoded.pixels, bytes);
    write(&folder.path().join("b.tiff"), Pixels::Words(ramp(|i| i as u16 * 250)), Depth::Sixteen);
    let decoded = read(&folder.path().join("b.tiff")).expect("a picture");
    assert!(decoded.is_encoded);
    for (value, word) in decoded.to_linear(false).iter().zip(ramp(|i| i as u16 * 250)) {
        // f32 has 24 digits.
        assert!((value - f32::from(word) / 65535.0).abs() <= 1e-7);
    }
    let floats = Pixels::Floats(ramp(|i| i as f32 * 1.7 - 3.0));
    write(&folder.path().join("c.tif"), floats.clone(), Depth::Float);
    let decoded = read(&folder.path().join("c.tif")).expect("a picture");
    assert!(!decoded.is_encoded);
    assert_eq!(decoded.pixels, floats);
}

#[test]
fn radiance_and_jpeg_read_back_to_their_rounding() {
    let folder = folder();
    let path = folder.path().join("a.hdr");
    write(&path, Pixels::Floats(ramp(|i| 0.5 + i as f32)), Depth::Float);
    let decoded = read(&path).expect("a picture");
    assert!(!decoded.is_encoded);
    for (pixel, first) in decoded.to_linear(false).chunks_exact(3).zip((0..).step_by(3)) {
        // 8 bits of the pixel's largest component, which is below 2^n where the step is 2^(n - 8).
        let largest = 2.5 + first as f32;
        for (value, i) in pixel.iter().zip(first..) {
            assert!((value - (0.5 + i as f32)).abs() <= largest / 128.0, "{value} {i}");
        }
    }
    let path = folder.path().join("a.jpg");
    write(&path, Pixels::Bytes(vec![128; (3 * WIDTH * HEIGHT) as usize]), Depth::Eight);
    let Pixels::Bytes(bytes) = read(&path).expect("a picture").pixels else { panic!("bytes") };
    assert!(bytes.iter().all(|byte| byte.abs_diff(128) <= 1));
}

#[test]
fn equal_pictures_are_equal_files_that_tell_how_they_were_made() {
    let folder = folder();
    for extension in ["tif", "jpg", "hdr"] {
        let files = ["a", "b"].map(|name| {
            let path = folder.path().join(format!("{name}.{extension}"));
            let is_linear = extension == "hdr";
            let pixels =
                if is_linear { Pixels::Floats(ramp(|i| i as f32)) } else { Pixels::Bytes(ramp(|i| i as u8)) };
            write(&path, pixels, if is_linear { Depth::Float } else { Depth::Eight });
            fs::read(path).expect("a file")
        });
        assert!(files[0] == files[1], "{extension}");
        let info = Info::read(&folder.path().join(format!("a.{extension}"))).expect("a picture");
        assert_eq!((info.width, info.height), (WIDTH, HEIGHT));
        assert_eq!(info.metadata.get("samplesPerPixel").as_deref(), Some("3"), "{extension}");
        assert_eq!(info.metadata.get("pathtracer:seed").as_deref(), Some("7"), "{extension}");
        assert_eq!(
            info.metadata.get("worldToCamera"),
            Some(Value::Matrix(MATRIX).to_string()),
            "{extension}"
        );
        assert_eq!(info.metadata.get("pathtracer:scene"), Some(long_name()), "{extension}");
    }
}
