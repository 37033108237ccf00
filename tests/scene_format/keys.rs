use super::{CAMERA, object, parse};
use pathtracer::math::{DVec3, Rgb};
use pathtracer::scene::desc::{
    ApertureDesc, Axes, CameraDesc, EnvironmentDesc, MaterialDesc, MaterialKind, ShapeDesc,
};
use std::path::PathBuf;

fn camera(keys: &str) -> CameraDesc {
    let required = "Position: [0, -5, 1], LookingAt: [0.5, 0, 1e0], Fov: 0.3, FocusDistance: 5";
    parse(&format!("Camera: {{{required}{keys}}}\nObjects: []\n")).desc.camera
}

fn material(keys: &str) -> MaterialDesc {
    object(&format!("{{Type: Ball, Position: [0, 0, 0], Radius: 1, Material: {{{keys}}}}}")).material
}

fn shape(keys: &str) -> ShapeDesc {
    object(&format!("{{{keys}, Material: {{Type: Diffuse}}}}")).shape
}

#[test]
fn a_camera_with_required_keys_has_a_pinhole_and_no_roll() {
    let expected = CameraDesc {
        position: DVec3::new(0.0, -5.0, 1.0),
        looking_at: DVec3::new(0.5, 0.0, 1.0),
        fov: 0.3,
        focus_distance: 5.0,
        aperture: ApertureDesc::DepthOfField(0.0),
        angle: 0.0,
    };
    assert_eq!(camera(""), expected);
}

#[test]
fn a_camera_takes_every_key() {
    let with_depth_of_field = camera(", DepthOfField: 30, Angle: -45, Name: main");
    assert_eq!(with_depth_of_field.aperture, ApertureDesc::DepthOfField(30.0));
    assert_eq!(with_depth_of_field.angle, -45.0);
    assert_eq!(camera(", ApertureRadius: 0.05").aperture, ApertureDesc::Radius(0.05));
}

#[test]
fn a_scene_without_environment_has_the_default_sky() {
    let expected = EnvironmentDesc {
        sky: Rgb::new(0.2, 0.5, 1.0),
        horizon: Rgb::new(0.7, 0.8, 0.8),
        ground: Rgb::new(0.1, 0.1, 0.1),
        strength: 1.0,
    };
    assert_eq!(parse(&format!("{CAMERA}Objects: []\n")).desc.environment, expected);
}

#[test]
fn an_environment_takes_colours_beyond_one_and_a_strength() {
    let colors = "SkyColor: [20, 0, 0], HorizonColor: [0, 2, 0], GroundColor: [0, 0, 0.5]";
    let environment =
        |keys: &str| parse(&format!("{CAMERA}Environment: {{{keys}}}\nObjects: []\n")).desc.environment;
    let expected = EnvironmentDesc {
        sky: Rgb::new(20.0, 0.0, 0.0),
        horizon: Rgb::new(0.0, 2.0, 0.0),
        ground: Rgb::new(0.0, 0.0, 0.5),
        strength: 1.0,
    };
    assert_eq!(environment(colors), expected);
    let weaker = environment(&format!("{colors}, Strength: 0.25, Name: evening"));
    assert_eq!(weaker, EnvironmentDesc { strength: 0.25, ..expected });
}

#[test]
fn a_sky_of_colours_does_not_use_the_rotation_of_a_picture() {
    let colors = "SkyColor: [1, 1, 1], HorizonColor: [1, 1, 1], GroundColor: [1, 1, 1]";
    let scene =
        parse(&format!("{CAMERA}Environment: {{{colors}, Rotation: 90}}\nObjects: [*o]\n").replace("*o", ""));
    assert_eq!(scene.warnings[0].message, "Environment.Rotation is not used by a sky of three colours");
}

#[test]
fn a_ball() {
    let ShapeDesc::Ball { position, radius } = shape("Type: Ball, Position: [1, -2, 3.5], Radius: 1e-9")
    else {
        panic!("no ball")
    };
    assert_eq!((position, radius), (DVec3::new(1.0, -2.0, 3.5), 1e-9));
}

#[test]
fn a_box_is_as_deep_along_x_as_wide_along_y_as_high_along_z() {
    let keys = "Type: Box, Position: [1, 2, 3], Width: 4, Height: 5, Depth: 6";
    for (keys, angles) in
        [(keys.to_owned(), DVec3::ZERO), (format!("{keys}, Rotation: [1, 2, 3]"), DVec3::new(1.0, 2.0, 3.0))]
    {
        let ShapeDesc::Box { position, size, rotation } = shape(&keys) else { panic!("no box") };
        assert_eq!(position, DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(size, DVec3::new(6.0, 4.0, 5.0));
        assert_eq!(rotation, angles);
    }
}

#[test]
fn a_rectangle() {
    let keys = "Type: Rectangle, Position: [1, 2, 3], Width: 4, Height: 5, Rotation: [0, 90, 720]";
    let ShapeDesc::Rectangle { position, width, height, rotation } = shape(keys) else {
        panic!("no rectangle")
    };
    assert_eq!(position, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!((width, height), (4.0, 5.0));
    assert_eq!(rotation, DVec3::new(0.0, 90.0, 720.0));
}

#[test]
fn a_mesh_has_defaults() {
    let keys = "Type: TriangleMesh, Filepath: tests/data/meshes/triangle.obj, Position: [1, 2, 3]";
    let ShapeDesc::TriangleMesh { file, mesh, scale, position, rotation, axes, smooth } = shape(keys) else {
        panic!("no mesh")
    };
    assert_eq!(file, PathBuf::from("tests/data/meshes/triangle.obj"));
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!((scale, axes, smooth), (1.0, Axes::YUp, true));
    assert_eq!((position, rotation), (DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO));
}

#[test]
fn a_mesh_takes_every_key() {
    for (name, expected) in [("YUp", Axes::YUp), ("ZUp", Axes::ZUp), ("SwapYZ", Axes::SwapYZ)] {
        let keys = format!(
            "Name: knight, Type: TriangleMesh, Filepath: tests/data/meshes/triangle.obj, Position: [0, 0, 0], \
             Scale: 2.5, Rotation: [90, 0, 0], Axes: {name}, Smooth: false"
        );
        let ShapeDesc::TriangleMesh { scale, rotation, axes, smooth, .. } = shape(&keys) else {
            panic!("no mesh")
        };
        assert_eq!((scale, rotation, smooth), (2.5, DVec3::new(90.0, 0.0, 0.0), false));
        assert_eq!(axes, expected);
    }
}

#[test]
fn a_diffuse_material_is_white_and_dark_by_default() {
    assert_eq!(
        material("Type: Diffuse").kind,
        MaterialKind::Diffuse { color: Rgb::ONE, emission: Rgb::ZERO }
    );
}

#[test]
fn emission_is_strength_times_colour() {
    let kind = |keys: &str| material(&format!("Type: Diffuse, Color: [0, 0.5, 1]{keys}")).kind;
    let expected = |emission| MaterialKind::Diffuse { color: Rgb::new(0.0, 0.5, 1.0), emission };
    assert_eq!(kind(", EmissionStrength: 2"), expected(Rgb::splat(2.0)));
    assert_eq!(kind(", EmissionColor: [17, 12, 4]"), expected(Rgb::ZERO));
    assert_eq!(
        kind(", EmissionStrength: 2, EmissionColor: [17, 12, 4]"),
        expected(Rgb::new(34.0, 24.0, 8.0))
    );
}

#[test]
fn a_reflective_material() {
    let kind = |keys: &str| material(&format!("Type: Reflective{keys}")).kind;
    assert_eq!(kind(""), MaterialKind::Reflective { color: Rgb::ONE, specularity: 1.0 });
    let expected = MaterialKind::Reflective { color: Rgb::ZERO, specularity: 0.25 };
    assert_eq!(kind(", Color: [0, 0, 0], Specularity: 0.25"), expected);
}

#[test]
fn a_clear_coat() {
    let kind = |keys: &str| material(&format!("Type: ClearCoat{keys}")).kind;
    let default =
        MaterialKind::ClearCoat { color: Rgb::ONE, coat: 0.5, coat_color: Rgb::ONE, specularity: 1.0 };
    assert_eq!(kind(""), default);
    let expected = MaterialKind::ClearCoat {
        color: Rgb::new(1.0, 0.0, 0.0),
        coat: 0.125,
        coat_color: Rgb::new(0.0, 1.0, 0.0),
        specularity: 0.0,
    };
    let keys = ", Color: [1, 0, 0], ClearCoat: 0.125, ClearCoatColor: [0, 1, 0], Specularity: 0";
    assert_eq!(kind(keys), expected);
}

#[test]
fn a_refractive_material() {
    let kind = |keys: &str| material(&format!("Type: Refractive{keys}")).kind;
    assert_eq!(kind(""), MaterialKind::Refractive { color: Rgb::ONE, ratio: 1.0 });
    let expected = MaterialKind::Refractive { color: Rgb::splat(0.5), ratio: 0.67 };
    assert_eq!(kind(", Color: [0.5, 0.5, 0.5], RefractionRatio: 0.67"), expected);
}

#[test]
fn names_are_optional_and_any_scalar() {
    let ball = |name: &str| {
        object(&format!("{{Type: Ball, Position: [0, 0, 0], Radius: 1{name}, Material: {{Type: Diffuse}}}}"))
    };
    assert_eq!(ball("").name, None);
    assert_eq!(ball(", Name: ").name, None);
    assert_eq!(ball(", Name: Sun of the scene").name.as_deref(), Some("Sun of the scene"));
    assert_eq!(ball(", Name: 42").name.as_deref(), Some("42"));
    assert_eq!(ball(", Name: true").name.as_deref(), Some("true"));
    assert_eq!(material("Name: RED DIFFUSE, Type: Diffuse").name.as_deref(), Some("RED DIFFUSE"));
}

#[test]
fn keys_that_a_type_does_not_use_are_warnings_in_the_order_of_the_file() {
    let text = format!(
        "{CAMERA}Objects:\n  - Object:\n      Type: Ball\n      Position: [0, 0, 0]\n      Radius: 1\n      \
         Rotation: [0, 0, 0]\n      Material:\n        Type: Reflective\n        EmissionStrength: not a number\n"
    );
    let scene = parse(&text);
    let messages: Vec<&str> = scene.warnings.iter().map(|warning| warning.message.as_str()).collect();
    assert_eq!(
        messages,
        [
            "Objects[0].Object.Rotation is not used by Ball",
            "Objects[0].Object.Material.EmissionStrength is not used by Reflective"
        ]
    );
    let lines: Vec<usize> =
        scene.warnings.iter().filter_map(|w| w.location.as_ref()).map(|l| l.line).collect();
    assert_eq!(lines, [7, 10]);
}

#[test]
fn no_objects_are_a_warning() {
    let scene = parse(&format!("{CAMERA}Objects: []\n"));
    assert_eq!(scene.warnings.len(), 1);
    assert_eq!(scene.warnings[0].message, "Objects is empty: the picture will show only the sky");
}
