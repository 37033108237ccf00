//! Film files as the library sees them, and estimates of memory.

use crate::support::build;
use pathtracer::error::Error;
use pathtracer::film::file::{FilePlace, FilmRecord, Reader};
use pathtracer::film::{Film, Frame, Region, Run, Sums};
use pathtracer::math::{DVec3, Rgb};
use pathtracer::picture::{Decoded, Pixels};
use pathtracer::render::{Estimate, FilmFile, Settings, film_bytes, merge};
use pathtracer::scene::desc::{EnvironmentMapDesc, PictureDesc, SceneDesc};
use std::fs;
use std::path::Path;
use std::sync::Arc;
use xxhash_rust::xxh3::xxh3_128;

/// A film file with this header and these sums; its checksum is right.
fn file(path: &Path, header: &str, sums: &[u8]) {
    let mut bytes = b"PTfilm\r\n\x01\0\0\0".to_vec();
    bytes.extend((header.len() as u32).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(sums);
    bytes.extend(xxh3_128(&bytes).to_le_bytes());
    fs::write(path, bytes).expect("a file");
}

/// A film of some chunks of a region of 37 x 23 pixels.
fn film(region: Region) -> Film {
    let mut film = Film::of(Frame::new(37, 23, region), 4);
    for chunk in 0..7 {
        let light =
            region.pixels(37, 23).map(|pixel| Rgb::splat(libm::exp((pixel % 50) as f64 + chunk as f64)));
        film.add(chunk, Sums::of_scramble(3, 4, light.collect(), Vec::new())).expect("a new chunk");
    }
    film
}

#[test]
fn what_is_written_of_a_film_is_read_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.film");
    let whole: Vec<Rgb> = film(Region::All).means().collect();
    for region in [
        Region::All,
        Region::Part { index: 1, count: 3 },
        Region::Crop { left: 3, top: 1, right: 9, bottom: 23 },
    ] {
        let film = film(region);
        let place = FilePlace::new(&path).expect("a place");
        place
            .write(&FilmRecord::new(&film), |writer| FilmRecord::write(&film, writer))
            .expect("a written file");
        let (record, mut reader): (FilmRecord, Reader) = Reader::open(&path).expect("a film file");
        let read = record.read(film.frame().clone(), &mut reader).expect("a film");
        reader.finish().expect("all of it");
        assert!(read == film, "{region}");
        let expected: Vec<Rgb> = region.pixels(37, 23).map(|pixel| whole[pixel]).collect();
        assert_eq!(read.means().collect::<Vec<_>>(), expected, "{region}");
        assert_eq!(record.samples(), 28);
    }
}

#[test]
fn regions_cover_their_pixels_once() {
    for (width, height) in [(1, 1), (37, 23), (16, 32), (100, 5)] {
        for count in 1..=4 {
            let parts = (0..count).map(|index| Region::Part { index, count });
            let mut all: Vec<usize> =
                parts.flat_map(|part| part.pixels(width, height).collect::<Vec<_>>()).collect();
            all.sort_unstable();
            assert_eq!(
                all,
                (0..(width * height) as usize).collect::<Vec<_>>(),
                "{count} parts of {width} x {height}"
            );
        }
        let part = Region::Part { index: 0, count: 2 };
        assert_eq!(part.area(width, height), part.pixels(width, height).count() as u64);
    }
}

/// Machines that share a folder know nothing of one another's processes.
#[test]
fn every_file_under_way_has_a_temporary_name_of_its_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = || FilePlace::new(&folder.path().join("a.film")).expect("a place");
    let (one, other) = (place(), place());
    assert_eq!(one.path(), other.path());
    assert_ne!(one.partial_path(), other.partial_path());
}

#[test]
fn the_pixels_of_a_region_are_numbered_in_their_order() {
    for (width, height) in [(1, 1), (37, 23), (16, 32), (100, 5), (70, 50)] {
        let parts = [1, 2, 3, 5, 7, 11, 100]
            .into_iter()
            .flat_map(|count| (0..count).map(move |index| Region::Part { index, count }));
        let crops = [(0, 0, 1, 1), (3, 2, 37, 23), (17, 4, 18, 5), (16, 0, 70, 48)];
        let crops = crops.map(|(left, top, right, bottom)| Region::Crop { left, top, right, bottom });
        let regions = parts.chain(crops).chain([Region::All]);
        for region in regions.filter(|region| region.check(width, height, false).is_ok()) {
            let frame = Frame::new(width, height, region);
            let expected: Vec<usize> = region.pixels(width, height).collect();
            let number = |(x, y): (u32, u32)| y as usize * width as usize + x as usize;
            let places: Vec<usize> = (0..frame.pixels()).map(|i| number(frame.place(i))).collect();
            assert_eq!(places, expected, "{region} of {width} x {height}");
            let in_runs = frame.runs().flat_map(|Run { x, y }| x.map(move |x| (x, y)));
            for (i, (x, y)) in in_runs.enumerate() {
                assert_eq!((frame.number(x, y), number((x, y))), (i, expected[i]), "{region}");
            }
            assert_eq!(frame.runs().map(|run| run.x.len()).sum::<usize>(), expected.len(), "{region}");
        }
    }
}

#[test]
fn a_part_takes_the_memory_of_its_own_pixels() {
    let whole = Settings { features: true, ..Settings::new(6400, 3200, 64, 4) };
    let crop = Settings { region: Region::Crop { left: 8, top: 8, right: 72, bottom: 40 }, ..whole.clone() };
    let part = Settings { region: Region::Part { index: 3, count: 100 }, ..whole.clone() };
    let ratio = |settings: &Settings| film_bytes(&whole) as f64 / film_bytes(settings) as f64;
    assert_eq!([&crop, &part].map(ratio), [10_000.0, 100.0]);
}

#[test]
fn files_that_claim_more_than_they_hold_are_refused_without_allocating_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.film");
    let node = |first: u64, chunks: u64, samples: u64| {
        format!(
            r#"{{"chunk":16,"nodes":[{{"first":{first},"chunks":{chunks},"samples":{samples},"counts":[{samples},0,0,0,0,0,0,0],"halves":true,"greys":"all","deviations":false}}]}}"#
        )
    };
    for header in [
        node(0, 1, 16),
        node(1, 2, 16),
        node(0, 3, 16),
        node(0, 1, 17),
        node(u64::MAX - 1, 2, 16),
        node(0, 1 << 63, 16),
    ] {
        file(&path, &header, &[0; 64]);
        let (record, mut reader): (FilmRecord, Reader) = Reader::open(&path).expect("a film file");
        let refused =
            record.read(Frame::new(1 << 16, 1 << 14, Region::All), &mut reader).expect_err("too much");
        assert!(matches!(refused, Error::Film(_)), "{header}: {refused}");
    }
}

#[test]
fn sums_that_are_no_light_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.film");
    let header = r#"{"chunk":1,"nodes":[{"first":0,"chunks":1,"samples":1,"counts":[0,0,0,0,0,0,0,0],"halves":false,"greys":"unknown","deviations":false}]}"#;
    for (value, is_light) in [(0.0, true), (3.5, true), (-1.0, false), (f64::NAN, false)] {
        file(&path, header, &[value, 1.0, 1.0].map(f64::to_le_bytes).concat());
        let (record, mut reader): (FilmRecord, Reader) = Reader::open(&path).expect("a film file");
        assert_eq!(record.read(Frame::new(1, 1, Region::All), &mut reader).is_ok(), is_light, "{value}");
    }
}

#[test]
fn headers_of_other_programs_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.film");
    for header in ["", "{}", "[", "null", &"[".repeat(100_000)] {
        file(&path, header, &[]);
        let refused = FilmFile::open(&path).err().expect("no film");
        assert!(refused.to_string().contains("of another program or version"), "{refused}");
        assert!(merge(std::slice::from_ref(&path), false).is_err());
    }
}

#[test]
fn too_little_memory_is_an_error_that_names_what_is_large() {
    let triangles = 1_000_000;
    let positions = vec![[0.0; 3]; 3 * triangles];
    let indices = (0..triangles as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let shape = build::mesh(positions, indices);
    let desc = build::scene(DVec3::ZERO, DVec3::X, vec![(shape, build::diffuse(build::grey(0.5)))]);
    let settings = Settings::new(64, 64, 16, 4);
    let estimate = Estimate::new(&desc, &settings, false);
    estimate.check_against(estimate.bytes()).expect("enough");
    let error = estimate.check_against(estimate.bytes() - 1).expect_err("too little").to_string();
    assert!(error.contains("trees over the meshes 160 MB, meshes 84 MB; coarser meshes"), "{error}");
    let large = Estimate::new(&desc, &Settings { features: true, ..Settings::new(8000, 8000, 16, 4) }, true);
    let error = large.check_against(1 << 30).expect_err("too little").to_string();
    assert!(error.contains("the film") && error.contains("the denoiser"), "{error}");
}

#[test]
fn textures_and_the_sky_count_as_memory_each_file_once() {
    let picture = |pixels: Pixels| {
        let picture = Decoded { width: 1000, height: 1000, pixels, is_encoded: false };
        PictureDesc { file: "a.exr".into(), picture: Arc::new(picture), is_encoded: false }
    };
    let shape = build::ball(DVec3::ZERO, 1.0);
    let plain = || build::diffuse(build::grey(0.5));
    let mut desc = build::scene(DVec3::ZERO, DVec3::X, vec![(shape.clone(), plain()), (shape, plain())]);
    let settings = Settings::new(8, 8, 16, 4);
    let bytes = |desc: &SceneDesc| Estimate::new(desc, &settings, false).bytes();
    let without = bytes(&desc);
    let floats = picture(Pixels::Floats(vec![0.5; 3_000_000]));
    desc.objects.iter_mut().for_each(|object| object.material.textures.color = Some(floats.clone()));
    // Three floats a pixel, and a third of that.
    assert_eq!(bytes(&desc) - without, 16_000_000);
    desc.objects[1].material.textures.color = Some(picture(Pixels::Bytes(vec![128; 3_000_000])));
    assert_eq!(bytes(&desc) - without, 20_000_000);
    desc.environment_map = Some(EnvironmentMapDesc { picture: floats, rotation: 0.0 });
    assert_eq!(bytes(&desc) - without, 44_000_000);
    let error =
        Estimate::new(&desc, &settings, false).check_against(1 << 20).expect_err("too little").to_string();
    let places =
        ["the environment map", "textures", "a smaller picture takes less"].map(|part| error.find(part));
    assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{error}");
}

#[cfg(feature = "embree")]
#[test]
fn embree_stays_within_its_memory_and_says_over_what_it_could_not_build() {
    use pathtracer::accel::embree::Embree;
    use pathtracer::accel::{BuildOptions, Precision};
    use pathtracer::geometry::{Geometry, MeshPart};
    let mesh = MeshPart { object: 6, ..crate::support::meshes::sphere(1.0, 100, 0.1, 1) };
    let geometry = Geometry::new(Vec::new(), &[mesh]);
    for precision in [Precision::Exact, Precision::Robust, Precision::Fast] {
        let options = BuildOptions { precision, memory: Some(1 << 16), ..BuildOptions::default() };
        let error = Embree::build(&geometry, &options).err().expect("too little memory").to_string();
        assert!(error.contains("triangles of object 7"), "{error}");
        assert!(error.contains("memory"), "{error}");
        let enough = BuildOptions { memory: None, ..options };
        assert!(Embree::build(&geometry, &enough).is_ok());
    }
}
