use pathtracer::error::Error;
use pathtracer::film::{Film, Sums};
use pathtracer::math::Rgb;
use pathtracer::output::{self, display_bytes, linear_floats, quantize, srgb_encode};
use pathtracer::picture::{Destination, Format, Pixels};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// A film of two pixels with one sample.
fn film(left: Rgb, right: Rgb) -> Film {
    let mut film = Film::new(2, 1, 1);
    film.add(0, Sums::plain(1, vec![left, right])).expect("the first chunk");
    film
}

fn names_in(folder: &TempDir) -> Vec<String> {
    let entries = fs::read_dir(folder.path()).expect("a folder");
    entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
}

#[test]
fn the_srgb_curve_has_the_values_of_the_standard() {
    // IEC 61966-2-1: 12.92 x up to 0.0031308, 1.055 x^(1/2.4) - 0.055 above. The constant 0.18 gives 0.4613561295.
    assert_eq!(srgb_encode(0.0), 0.0);
    assert_eq!(srgb_encode(0.002), 12.92 * 0.002);
    assert!((srgb_encode(0.18) - 0.461_356_129_5).abs() < 1e-10);
    // 1.055 - 0.055 in f64 is within one ulp of 1.
    assert!((srgb_encode(1.0) - 1.0).abs() <= f64::EPSILON);
    // The standard's two branches meet to 4 digits only: 12.92 x 0.0031308 = 0.04044994, the other 0.04044991.
    assert!((srgb_encode(0.003_130_8) - srgb_encode(0.003_130_801)).abs() < 5e-8);
}

#[test]
fn the_srgb_curve_clips() {
    assert_eq!(srgb_encode(-1.0), 0.0);
    assert_eq!(srgb_encode(7.0), srgb_encode(1.0));
    assert_eq!(srgb_encode(f64::INFINITY), srgb_encode(1.0));
}

#[test]
fn every_byte_comes_back_through_the_curve() {
    for byte in 0..=255u8 {
        let encoded = f64::from(byte) / 255.0;
        let linear = match encoded {
            0.0..0.04045 => encoded / 12.92,
            _ => libm::pow((encoded + 0.055) / 1.055, 2.4),
        };
        assert_eq!(quantize(srgb_encode(linear)), byte);
    }
}

#[test]
fn exposure_doubles_the_light_of_a_png_a_stop() {
    let dark = film(Rgb::splat(0.1), Rgb::new(0.2, 0.3, 0.4));
    let bright = film(Rgb::splat(0.4), Rgb::new(0.8, 1.2, 1.6));
    assert_eq!(display_bytes(&dark, 2.0), display_bytes(&bright, 0.0));
    assert_eq!(display_bytes(&bright, -2.0), display_bytes(&dark, 0.0));
}

#[test]
fn floats_beyond_the_range_of_f32_become_its_largest_number() {
    let floats = linear_floats(&film(Rgb::new(1e300, f64::INFINITY, 2.5), Rgb::new(1e-300, 0.0, 1.0)));
    assert_eq!(floats, [f32::MAX, f32::MAX, 2.5, 0.0, 0.0, 1.0]);
}

#[test]
fn a_png_reads_back_as_it_was_written() {
    let folder = folder();
    let path = folder.path().join("a.png");
    let film = film(Rgb::new(0.0, 0.5, 1.0), Rgb::new(2.0, 0.18, 0.001));
    output::write(&film, 0.0, &Destination::new(&path).expect("a writable folder")).expect("a picture");
    let read = image::open(&path).expect("a PNG");
    assert_eq!(read.color(), image::ColorType::Rgb8);
    assert_eq!((read.width(), read.height()), (2, 1));
    // 255 x the curve at 0.5 is 187.5: the standard value is 188 (187.516); at 0.18 117.6; at 0.001 3.29.
    assert_eq!(read.into_bytes(), [0, 188, 255, 255, 118, 3]);
}

#[test]
fn an_exr_reads_back_bit_by_bit() {
    let folder = folder();
    let path = folder.path().join("a.exr");
    let film = film(Rgb::new(0.0, 0.1, 1e6), Rgb::new(2.0, 1e-30, 1e30));
    // An EXR holds the light as it is, whatever the exposure.
    output::write(&film, 3.0, &Destination::new(&path).expect("a writable folder")).expect("a picture");
    let read = image::open(&path).expect("an EXR").into_rgb32f();
    assert_eq!(read.into_raw(), [0.0, 0.1, 1e6, 2.0, 1e-30, 1e30]);
}

#[test]
fn equal_films_make_equal_files() {
    let folder = folder();
    let film = film(Rgb::new(0.0, 0.1, 1e6), Rgb::new(2.0, 1e-30, 1e30));
    for extension in ["png", "exr"] {
        let files = ["a", "b"].map(|name| {
            let path = folder.path().join(format!("{name}.{extension}"));
            output::write(&film, 0.0, &Destination::new(&path).expect("a writable folder")).expect("written");
            fs::read(path).expect("a picture")
        });
        assert!(files[0] == files[1], "{extension}");
    }
}

#[test]
fn the_extension_decides_whatever_its_case() {
    assert_eq!(Format::of(Path::new("a.PNG")).expect("known"), Format::Png);
    assert_eq!(Format::of(Path::new("b/a.b.Exr")).expect("known"), Format::Exr);
}

#[test]
fn an_unknown_extension_is_refused_with_the_known_ones() {
    for name in ["a.jpg", "png", "a.", ".png", ""] {
        let error = Format::of(Path::new(name)).expect_err("unknown");
        assert!(matches!(error, Error::Usage(_)));
        assert!(error.to_string().ends_with("known are .png, .exr"), "{error}");
    }
}

#[test]
fn looking_at_a_destination_leaves_nothing_behind() {
    let folder = folder();
    let path = folder.path().join("a.png");
    fs::write(&path, "before").expect("a file");
    Destination::new(&path).expect("a writable folder");
    assert_eq!(names_in(&folder), ["a.png"]);
    assert_eq!(fs::read(&path).expect("the file"), b"before");
}

#[test]
fn a_destination_that_is_a_folder_or_in_none_is_refused() {
    let folder = folder();
    let inner = folder.path().join("b.png");
    fs::create_dir(&inner).expect("a folder");
    for path in [inner, folder.path().join("missing").join("a.png")] {
        let error = Destination::new(&path).expect_err("no place for a picture");
        assert!(matches!(error, Error::Io { .. }));
        assert!(error.to_string().contains(&path.display().to_string()), "{error}");
    }
}

#[test]
fn a_picture_replaces_the_old_one_and_leaves_no_other_file() {
    let folder = folder();
    let path = folder.path().join("a.png");
    fs::write(&path, "before").expect("a file");
    let destination = Destination::new(&path).expect("a writable folder");
    destination.write(1, 1, &Pixels::Bytes(vec![1, 2, 3])).expect("a picture");
    assert_eq!(names_in(&folder), ["a.png"]);
    assert_eq!(image::open(&path).expect("a PNG").into_bytes(), [1, 2, 3]);
}

#[cfg(unix)]
#[test]
fn the_file_behind_a_link_is_replaced() {
    let folder = folder();
    let (file, link) = (folder.path().join("file.png"), folder.path().join("link.png"));
    fs::write(&file, "before").expect("a file");
    std::os::unix::fs::symlink(&file, &link).expect("a link");
    let destination = Destination::new(&link).expect("a writable folder");
    destination.write(1, 1, &Pixels::Bytes(vec![1, 2, 3])).expect("a picture");
    assert!(fs::symlink_metadata(&link).expect("the link").is_symlink());
    assert_eq!(image::open(&file).expect("a PNG").into_bytes(), [1, 2, 3]);
}
