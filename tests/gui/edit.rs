use super::{BALLS, Desk, SCENES, load, sample};
use pathtracer::gui::document;
use pathtracer::math::{DVec3, Rgb};
use pathtracer::scene::desc::ApertureDesc;
use pathtracer::scene::edit::{self, Editable, Surface, SurfaceKind, moved, save};
use pathtracer::scene::{self, Scene};
use proptest::prelude::*;
use std::path::Path;

fn parse(text: &str) -> Scene {
    scene::parse(text, Path::new("scene.yaml")).expect("a scene without errors")
}

/// The text after a change, which must say what the change says.
#[track_caller]
fn saved(text: &str, change: impl Fn(&mut Editable)) -> String {
    let desc = parse(text).desc;
    let mut editable = Editable::read(text, &desc);
    change(&mut editable);
    let saved = save(text, &desc, &editable).expect("a scene that can be saved");
    assert_eq!(Editable::read(&saved, &parse(&saved).desc), editable);
    saved
}

fn surface(editable: &mut Editable, index: usize) -> &mut Surface {
    editable.surfaces[index].as_mut().expect("a material of its own")
}

#[test]
fn a_number_is_replaced_and_its_comment_stays() {
    let text = saved(BALLS, |editable| editable.camera.focus_distance = 5.25);
    assert_eq!(text, BALLS.replace("FocusDistance: 6 ", "FocusDistance: 5.25 "));
}

#[test]
fn of_a_vector_only_the_components_that_differ_are_replaced() {
    let text = saved(BALLS, |editable| editable.camera.position.y = -0.0625);
    assert_eq!(text, BALLS.replace("[-6, 0, 2]", "[-6, -0.0625, 2]"));
}

#[test]
fn a_missing_key_gets_a_line_behind_one_that_is_there() {
    let text = saved(BALLS, |editable| editable.camera.angle = 12.0);
    let line = "  FocusDistance: 6       # the ball\n";
    assert_eq!(text, BALLS.replace(line, &format!("{line}  Angle: 12\n")));
    let text = saved(BALLS, |editable| surface(editable, 1).coat = 0.25);
    let line = "        Type: ClearCoat\n";
    assert_eq!(text, BALLS.replace(line, &format!("{line}        ClearCoat: 0.25\n")));
}

#[test]
fn a_sky_is_added_in_front_of_the_objects() {
    let text = saved(BALLS, |editable| editable.environment.strength = 0.5);
    let sky = "Environment:\n  Strength: 0.5\n  SkyColor: [0.2, 0.5, 1]\n  HorizonColor: [0.7, 0.8, 0.8]\n  GroundColor: \
               [0.1, 0.1, 0.1]\n\nObjects:";
    assert_eq!(text, BALLS.replace("Objects:", sky));
}

#[test]
fn another_type_keeps_the_keys_of_the_old_one() {
    let text = saved(BALLS, |editable| {
        surface(editable, 0).kind = SurfaceKind::Reflective;
        surface(editable, 0).specularity = 0.75;
    });
    let line = "        Type: Diffuse    # matt\n";
    assert_eq!(text, BALLS.replace(line, "        Type: Reflective    # matt\n        Specularity: 0.75\n"));
}

#[test]
fn mappings_in_braces_get_keys_inside() {
    let text = "{Camera: {Position: [0, 0, 0], LookingAt: [1, 0, 0], Fov: 0.3, FocusDistance: 1}, Objects: \
                [{Object: {Type: Ball, Position: [5, 0, 0], Radius: 1, Material: {Type: Diffuse}}}]}";
    let changed = saved(text, |editable| {
        editable.camera.angle = 5.0;
        editable.environment.sky = Rgb::new(0.5, 0.25, 1.0);
        surface(editable, 0).color = Rgb::splat(0.5);
    });
    assert!(changed.contains("Camera: {Angle: 5, Position:"), "{changed}");
    assert!(changed.contains("Material: {Color: [0.5, 0.5, 0.5], Type: Diffuse}"), "{changed}");
    assert!(changed.contains("SkyColor: [0.5, 0.25, 1]"), "{changed}");
}

#[test]
fn lines_keep_their_ends() {
    let text = BALLS.replace('\n', "\r\n");
    let changed = saved(&text, |editable| {
        editable.camera.angle = 5.0;
        editable.environment.strength = 2.0;
    });
    assert_eq!(changed.matches('\n').count(), changed.matches("\r\n").count());
}

#[test]
fn quoted_keys_and_lists_of_lines_are_found() {
    let text = BALLS
        .replace("Position: [-6, 0, 2]   # where it stands", "\"Position\":\n    - -6  # x\n    - 0\n    - 2")
        .replace("Type: ClearCoat", "'Type': \"ClearCoat\"");
    let changed = saved(&text, |editable| {
        editable.camera.position = DVec3::new(-7.0, 0.5, 2.0);
        surface(editable, 1).kind = SurfaceKind::Diffuse;
    });
    assert!(changed.contains("    - -7  # x\n    - 0.5\n    - 2\n"), "{changed}");
    assert!(changed.contains("'Type': Diffuse"), "{changed}");
}

/// Two balls with one material.
fn shared_material() -> String {
    let shared = BALLS.replace(
        "      Material:\n        Type: Diffuse    # matt\n        Color: [0.5, 0.6, 0.4]\n",
        "      Material: &red\n        Type: Diffuse    # matt\n        Color: [0.5, 0.6, 0.4]\n",
    );
    let own =
        "      Material:\n        Name: clear\n        Type: ClearCoat\n        Color: [0.8, 0.1, 0.1]\n";
    shared.replace(own, "      Material: *red   # the same\n")
}

#[test]
fn an_alias_becomes_a_value_of_its_own() {
    let text = shared_material();
    let changed = saved(&text, |editable| surface(editable, 1).color = Rgb::splat(0.5));
    let own = "Material: {Type: Diffuse, Color: [0.5, 0.5, 0.5]}   # the same";
    assert_eq!(changed, text.replace("Material: *red   # the same", own));
}

#[test]
fn an_anchor_goes_to_the_first_of_its_aliases() {
    let text = shared_material();
    let changed = saved(&text, |editable| surface(editable, 0).color = Rgb::splat(0.5));
    let expected = text
        .replace("Material: &red\n", "Material: \n")
        .replace("Color: [0.5, 0.6, 0.4]", "Color: [0.5, 0.5, 0.5]")
        .replace("*red   #", "&red {Type: Diffuse, Color: [0.5, 0.6, 0.4]}   #");
    assert_eq!(changed, expected);
}

#[test]
fn a_value_that_an_alias_of_all_around_it_repeats_is_not_changed_behind_its_back() {
    let start = BALLS.find("  # The one").expect("a comment");
    let text = format!("{}  - Object: *ground\n{}", &BALLS[..start], &BALLS[start..]);
    let text = text.replacen("  - Object:\n", "  - Object: &ground\n", 1);
    let desc = parse(&text).desc;
    let mut editable = Editable::read(&text, &desc);
    surface(&mut editable, 0).color = Rgb::splat(0.5);
    let error = save(&text, &desc, &editable).expect_err("the second ball would change too").to_string();
    assert!(error.contains("by an anchor (&) and its aliases (*)"), "{error}");
}

#[test]
fn numbers_of_any_size_come_back() {
    for number in [1e-300, 1e300, 5e-324, 0.1 + 0.2, 1e15, 123_456_789_012_345_680.0, -1e-7] {
        let text = saved(BALLS, |editable| editable.camera.angle = number);
        assert_eq!(parse(&text).desc.camera.angle.to_bits(), number.to_bits(), "{number}");
    }
}

#[test]
fn a_saved_file_keeps_its_byte_order_mark() {
    let desk = Desk::new();
    desk.write("balls.yaml", &format!("\u{feff}{BALLS}"));
    let loaded = load(&desk.path("balls.yaml"));
    let mut editable = loaded.editable.clone();
    editable.camera.angle = 3.0;
    let text = save(&loaded.text, &loaded.scene.desc, &editable).expect("a scene that can be saved");
    document::write(&desk.path("balls.yaml"), &text).expect("a file that can be written");
    assert!(desk.read("balls.yaml").starts_with("\u{feff}# A ball".as_bytes()));
    assert_eq!(load(&desk.path("balls.yaml")).editable, editable);
}

/// How many lines of `old` are left in `new`, in their order.
fn lines_kept(old: &str, new: &str) -> usize {
    let new: Vec<&str> = new.lines().collect();
    let mut row = vec![0; new.len() + 1];
    for line in old.lines() {
        let mut diagonal = 0;
        for (i, other) in new.iter().enumerate() {
            let above = row[i + 1];
            row[i + 1] = if line == *other { diagonal + 1 } else { above.max(row[i]) };
            diagonal = above;
        }
    }
    row[new.len()]
}

/// One value of a scene that becomes another.
#[derive(Clone, Debug)]
enum Edit {
    Position(usize, f64),
    Fov(f64),
    Lens(f64),
    Sky(usize, f64),
    Strength(f64),
    Color(prop::sample::Index, usize, f64),
    Emission(prop::sample::Index, f64),
    Kind(prop::sample::Index, prop::sample::Index),
    Coat(prop::sample::Index, f64),
    Ratio(prop::sample::Index, f64),
}

impl Edit {
    fn apply(&self, editable: &mut Editable) {
        let pick = |editable: &Editable, index: &prop::sample::Index| index.index(editable.surfaces.len());
        match self {
            Edit::Position(axis, x) => editable.camera.position[*axis] += x,
            Edit::Fov(x) => editable.camera.fov = *x,
            Edit::Lens(x) => editable.camera.aperture = ApertureDesc::DepthOfField(*x),
            Edit::Sky(axis, x) => editable.environment.horizon[*axis] = *x,
            Edit::Strength(x) => editable.environment.strength = *x,
            Edit::Color(index, axis, x) => {
                let index = pick(editable, index);
                surface(editable, index).color[*axis] = *x;
            }
            Edit::Emission(index, x) => {
                let index = pick(editable, index);
                surface(editable, index).emission_strength = *x;
            }
            Edit::Kind(index, kind) => {
                let index = pick(editable, index);
                surface(editable, index).kind = *kind.get(&SurfaceKind::ALL);
            }
            Edit::Coat(index, x) => {
                let index = pick(editable, index);
                surface(editable, index).coat = *x;
            }
            Edit::Ratio(index, x) => {
                let index = pick(editable, index);
                surface(editable, index).ratio = *x;
            }
        }
    }
}

fn edits() -> impl Strategy<Value = Edit> {
    let index = any::<prop::sample::Index>;
    prop_oneof![
        (0..3usize, -10.0..10.0).prop_map(|(axis, x)| Edit::Position(axis, x)),
        (0.01..0.9).prop_map(Edit::Fov),
        (0.0..50.0).prop_map(Edit::Lens),
        (0..3usize, 0.0..4.0).prop_map(|(axis, x)| Edit::Sky(axis, x)),
        (0.0..4.0).prop_map(Edit::Strength),
        (index(), 0..3usize, 0.0..=1.0).prop_map(|(i, axis, x)| Edit::Color(i, axis, x)),
        (index(), 0.0..100.0).prop_map(|(i, x)| Edit::Emission(i, x)),
        (index(), index()).prop_map(|(i, kind)| Edit::Kind(i, kind)),
        (index(), 0.0..=1.0).prop_map(|(i, x)| Edit::Coat(i, x)),
        (index(), 0.1..3.0).prop_map(|(i, x)| Edit::Ratio(i, x)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_edits_of_sample_scenes_come_back_and_every_other_line_stays(
        scene in prop::sample::select(&SCENES[..]),
        edits in prop::collection::vec(edits(), 1..6),
    ) {
        let text = std::fs::read_to_string(sample(scene)).expect("a sample scene");
        let desc = parse(&text).desc;
        let mut editable = Editable::read(&text, &desc);
        for edit in &edits {
            edit.apply(&mut editable);
        }
        let saved = save(&text, &desc, &editable).expect("a scene that can be saved");
        prop_assert_eq!(&Editable::read(&saved, &parse(&saved).desc), &editable);
        // Each edit changes one line, or adds one; where an anchor stands, those of the anchor and of its first alias too.
        prop_assert!(lines_kept(&text, &saved) + 3 * edits.len() >= text.lines().count());
        let comments = |text: &str| text.lines().filter_map(|line| Some(line.split_once('#')?.1.to_owned())).collect::<Vec<_>>();
        prop_assert_eq!(comments(&text), comments(&saved));
    }
}

#[test]
fn a_scene_that_is_saved_without_a_change_is_the_same_text() {
    for name in SCENES {
        let text = std::fs::read_to_string(sample(name)).expect("a sample scene");
        assert_eq!(saved(&text, |_| {}), text, "{name}");
    }
}

#[test]
fn a_scene_in_another_folder_names_the_same_files_and_keeps_every_other_line() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    for name in ["from/parts", "to/deep"] {
        std::fs::create_dir_all(path(name)).expect("a folder");
    }
    std::fs::write(path("from/parts/a b.obj"), "v 0 -1 0\nv 0 1 0\nv 0 0 2\nf 1 2 3\n").expect("a mesh");
    for name in ["sky.exr", "wood.png"] {
        let picture = Path::new(env!("CARGO_MANIFEST_DIR")).join("objects").join(name);
        std::fs::copy(picture, path("from").join(name)).expect("a picture");
    }
    let text = format!(
        "{BALLS}  - Object:\n      Type: TriangleMesh   # a wall\n      Filepath: &wall parts/a b.obj  # of one\n      \
         Position: [0, 0, 0]\n      Material: {{Type: Diffuse}}\n  - Object: {{Type: TriangleMesh, Filepath: *wall, \
         Position: [1, 1, 1], Material: {{Type: Diffuse}}}}\n  - Object:\n      Type: Ball\n      Position: [9, 0, 0]\n      \
         Radius: 1\n      Material: {{Type: Diffuse, Color: {{Image: 'wood.png'}}}}\nEnvironment:\n  Image: \"sky.exr\" # all\n"
    );
    let read = |text: &str, file: &Path| scene::parse(text, file).expect("a scene without errors");
    let (from, to) = (path("from/scene.yaml"), path("to/deep/scene.yaml"));
    let before = read(&text, &from);
    let moved = moved(&text, &from, &to).expect("a scene that can be moved");
    let expected = text
        .replace("parts/a b.obj", "\"../../from/parts/a b.obj\"")
        .replace("'wood.png'", "\"../../from/wood.png\"")
        .replace("\"sky.exr\"", "\"../../from/sky.exr\"");
    assert_eq!(moved, expected);
    let files = |scene: &Scene| {
        scene.files.iter().map(|file| file.canonicalize().expect("a file")).collect::<Vec<_>>()
    };
    assert_eq!(files(&read(&moved, &to)), files(&before));
    // Back again, and beside: nothing else has changed.
    assert_eq!(edit::moved(&text, &from, &path("from/other.yaml")).expect("a text"), text);
}

#[test]
fn sample_scenes_can_be_saved_in_another_folder_and_show_the_same() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for name in SCENES.into_iter().chain(["objectScene", "gallery"]) {
        let loaded = load(&sample(name));
        let path = folder.path().join(format!("{name}.yaml"));
        let text = moved(&loaded.text, &loaded.path, &path).expect("a scene that can be moved");
        let read = document::read_text(text.clone(), &path).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(read.scene.files.len(), loaded.scene.files.len(), "{name}");
        assert_eq!(read.editable, loaded.editable, "{name}");
        assert_eq!(text.lines().count(), loaded.text.lines().count(), "{name}");
    }
}
