use pathtracer::error::Error;
use pathtracer::film::{Film, Sums};
use pathtracer::math::Rgb;
use pathtracer::output::{self, linear_floats, quantize, srgb_encode};
use pathtracer::picture::{Depth, Destination, Format, Metadata, Pixels};
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
    let shown = |film: &Film, exposure| {
        let light: Vec<f64> = output::channels(film).collect();
        output::picture((film.width(), film.height()), &light, exposure, Depth::Eight).pixels
    };
    assert_eq!(shown(&dark, 2.0), shown(&bright, 0.0));
    assert_eq!(shown(&bright, -2.0), shown(&dark, 0.0));
}

#[test]
fn floats_beyond_the_range_of_f32_become_its_largest_number() {
    let floats = linear_floats(&film(Rgb::new(1e300, f64::INFINITY, 2.5), Rgb::new(1e-300, 0.0, 1.0)));
    assert_eq!(floats, [f32::MAX, f32::MAX, 2.5, 0.0, 0.0, 1.0]);
}

#[cfg(unix)]
#[test]
fn a_picture_that_is_replaced_passes_its_permissions_on() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    let path = folder.path().join("a.png");
    std::fs::write(&path, "before").expect("a file");
    std::fs::set_permissions(&path, PermissionsExt::from_mode(0o640)).expect("permissions");
    let destination = Destination::new(&path).expect("a place");
    output::write(&film(Rgb::ONE, Rgb::ZERO), 0.0, &destination).expect("a picture");
    let mode = std::fs::metadata(&path).expect("a file").permissions().mode();
    assert_eq!(mode & 0o777, 0o640);
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
    for name in ["a.gif", "png", "a.", ".png", ""] {
        let error = Format::of(Path::new(name)).expect_err("unknown");
        assert!(matches!(error, Error::Usage(_)));
        assert!(
            error.to_string().ends_with("known are .png, .exr, .tif, .tiff, .hdr, .jpg, .jpeg"),
            "{error}"
        );
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

#[test]
fn an_exr_of_this_program_is_read_by_the_exr_crate_with_all_its_channels_and_attributes() {
    use exr::prelude::{FlatSamples, Text, read_all_flat_layers_from_file};
    use pathtracer::picture::{Channel, Picture, Samples, Value};
    let folder = folder();
    let path = folder.path().join("a.exr");
    // More lines than a block, an odd number of bytes in none, values that compress and such that do not.
    let (width, height) = (5u32, 37u32);
    let pixels = (width * height) as usize;
    let rgb: Vec<f32> = (0..3 * pixels).map(|i| (i as f32 * 12.9898).sin() * 1e3).collect();
    let depth: Vec<f32> = (0..pixels).map(|i| (i / 7) as f32).collect();
    let object: Vec<u32> = (0..pixels as u32).map(|i| i % 3).collect();
    let mut metadata = Metadata::default();
    metadata.push("a name of more than thirty-one letters", Value::Text("text".into()));
    metadata.push("number", Value::Number(0.25));
    let picture = Picture {
        width,
        height,
        pixels: Pixels::Floats(rgb.clone()),
        channels: vec![
            Channel { name: "Z".into(), values: Samples::Floats(depth.clone()) },
            Channel { name: "Object".into(), values: Samples::Integers(object.clone()) },
        ],
        metadata,
    };
    Destination::new(&path).expect("a writable folder").write_picture(&picture).expect("written");
    let read = read_all_flat_layers_from_file(&path).expect("an EXR");
    let layer = &read.layer_data[0];
    let names: Vec<String> = layer.channel_data.list.iter().map(|channel| channel.name.to_string()).collect();
    assert_eq!(names, ["B", "G", "Object", "R", "Z"]);
    let component = |i: usize| rgb.iter().skip(i).step_by(3).copied().collect::<Vec<f32>>();
    let expected = [FlatSamples::F32(component(2)), FlatSamples::F32(component(1)), FlatSamples::U32(object)];
    for (channel, expected) in layer.channel_data.list.iter().zip(&expected) {
        assert_eq!(format!("{:?}", channel.sample_data), format!("{expected:?}"));
    }
    assert_eq!(
        format!("{:?}", layer.channel_data.list[4].sample_data),
        format!("{:?}", FlatSamples::F32(depth))
    );
    let other = &layer.attributes.other;
    let text: Text = "a name of more than thirty-one letters".into();
    assert!(other.contains_key(&text));
}

#[test]
fn a_date_is_told_as_exif_does() {
    // `date -u -d @SECONDS`.
    assert_eq!(output::date_time(0), "1970:01:01 00:00:00");
    assert_eq!(output::date_time(951_782_399), "2000:02:28 23:59:59");
    assert_eq!(output::date_time(951_782_400), "2000:02:29 00:00:00");
    assert_eq!(output::date_time(4_107_542_400), "2100:03:01 00:00:00");
}

#[test]
fn sixteen_bits_and_half_floats_read_back_to_their_rounding() {
    let folder = folder();
    let film = film(Rgb::new(0.0, 0.1, 1e6), Rgb::new(1.0, 0.18, 1e-3));
    let read = |name: &str, depth: Depth| {
        let path = folder.path().join(name);
        let destination = Destination::new(&path).and_then(|place| place.with_depth(depth)).expect("a place");
        output::write(&film, 0.0, &destination).expect("written");
        image::open(path).expect("a picture").into_rgb32f().into_raw()
    };
    let words = read("a.png", Depth::Sixteen);
    for (value, linear) in words.iter().zip([0.0, 0.1, 1.0, 1.0, 0.18, 1e-3]) {
        // Half a step of 16 bits, and f32's rounding.
        assert!((f64::from(*value) - srgb_encode(linear)).abs() <= 0.5 / 65535.0 + 1e-7, "{value} {linear}");
    }
    let halves = read("a.exr", Depth::Half);
    for (value, linear) in halves.iter().zip([0.0, 0.1, 65504.0, 1.0, 0.18, 1e-3]) {
        // A half has 11 digits in base 2.
        assert!((value - linear).abs() <= linear * 2f32.powi(-11), "{value} {linear}");
    }
}

#[test]
fn a_depth_that_a_format_does_not_have_is_refused() {
    let folder = folder();
    let place = Destination::new(&folder.path().join("a.png")).expect("a place");
    let error = place.with_depth(Depth::Half).expect_err("no half floats in a PNG");
    assert_eq!(error.to_string(), "a PNG has values of depth 8 or 16, not half");
}
