//! The rays of a scene's paths, and chords.

use pathtracer::accel::brute_force::BruteForce;
use pathtracer::geometry::{Ball, Geometry, PrimitiveId, Shape, Solid};
use pathtracer::math::{DVec3, Rgb};
use pathtracer::study::rays::{RayKind, RaySet, Sphere};
use pathtracer::study::record::{Recording, rays_of_paths};
use pathtracer::world::World;

use crate::support::build;

const RECORDING: Recording = Recording { width: 8, height: 6, samples: 2, bounces: 5, rays: 1000, seed: 3 };

/// A lamp over a grey ball that fills the view.
fn recorded(recording: &Recording) -> Vec<RaySet> {
    let grey = build::diffuse(Rgb::splat(0.8));
    let lamp = build::glowing(Rgb::ZERO, Rgb::splat(5.0));
    let objects = vec![
        (build::ball(DVec3::new(0.0, 0.0, -10.0), 10.0), grey),
        (build::ball(DVec3::new(0.0, 0.0, 5.0), 0.5), lamp),
    ];
    let desc = build::scene(DVec3::new(1.0, 0.0, 3.0), DVec3::ZERO, objects);
    let world = World::compile(&desc).expect("a valid scene");
    rays_of_paths(&world, &desc.camera, &BruteForce::new(&world.geometry), recording)
}

fn of_kind(sets: &[RaySet], kind: RayKind) -> &RaySet {
    sets.iter().find(|set| set.kind == kind).expect("a set of every kind")
}

#[test]
fn every_path_has_one_primary_ray() {
    let sets = recorded(&RECORDING);
    let primary = of_kind(&sets, RayKind::Primary);
    assert_eq!(primary.queries.len(), 8 * 6 * 2);
    assert!(primary.queries.iter().all(|query| query.ray.leaving == PrimitiveId::NONE));
}

#[test]
fn bounce_and_shadow_rays_leave_surfaces() {
    let sets = recorded(&RECORDING);
    for kind in [RayKind::Bounce, RayKind::Shadow] {
        let set = of_kind(&sets, kind);
        assert!(!set.queries.is_empty(), "{}", kind.name());
        assert!(set.queries.iter().all(|query| query.ray.leaving != PrimitiveId::NONE), "{}", kind.name());
    }
}

#[test]
fn shadow_rays_keep_their_end_and_their_target() {
    let sets = recorded(&RECORDING);
    let lamp = PrimitiveId::solid(1);
    let shadow = of_kind(&sets, RayKind::Shadow);
    assert!(shadow.queries.iter().all(|query| query.t_max.is_finite() && query.target == lamp));
}

#[test]
fn no_more_rays_are_kept_than_asked_for() {
    let sets = recorded(&Recording { rays: 10, ..RECORDING });
    assert!(sets.iter().all(|set| set.queries.len() <= 10));
    assert_eq!(of_kind(&sets, RayKind::Primary).queries.len(), 10);
}

#[test]
fn recording_twice_gives_the_same_rays() {
    let rays = || format!("{:?}", recorded(&RECORDING));
    assert_eq!(rays(), rays());
}

fn balls(list: &[(DVec3, f64)]) -> Geometry {
    let solids = (0..).zip(list);
    let solid = |(object, &(center, radius))| Solid { object, shape: Shape::Ball(Ball { center, radius }) };
    Geometry::new(solids.map(solid).collect(), &[])
}

#[test]
fn a_ball_underfoot_is_left_out_of_the_sphere() {
    let small = [(DVec3::ZERO, 1.0), (DVec3::X * 4.0, 1.0), (DVec3::Y * 3.0, 0.5)];
    let with_ground = [&small[..], &[(DVec3::Z * -1e7, 1e7)]].concat();
    assert_eq!(Sphere::around(&balls(&with_ground)), Sphere::around(&balls(&small)));
}

#[test]
fn chords_start_on_the_sphere_and_go_inward() {
    let sphere = Sphere { center: DVec3::new(1.0, 2.0, 3.0), radius: 2.0 };
    for query in sphere.chords(1000, 1).queries {
        let from_center = query.ray.origin - sphere.center;
        assert!((from_center.length() - 2.0).abs() < 1e-12);
        assert!(query.ray.direction.dot(from_center) < 0.0);
    }
}

#[test]
fn a_scene_without_objects_has_no_sphere() {
    assert_eq!(Sphere::around(&balls(&[])), None);
}
