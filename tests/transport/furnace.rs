//! Furnaces: what a surface reflects of a uniform world, known without sampling.

use crate::support::build::*;
use crate::support::meshes;
use pathtracer::math::DVec3;
use pathtracer::scene::desc::{MaterialKind, ShapeDesc};

pub(super) const EYE: DVec3 = DVec3::new(-4.0, 0.3, 0.4);

pub(super) fn convex_shapes() -> [ShapeDesc; 2] {
    [ball(DVec3::ZERO, 1.0), cuboid(DVec3::ZERO, DVec3::new(1.0, 1.5, 2.0), DVec3::new(10.0, 20.0, 30.0))]
}

pub(super) fn opaque_white() -> Vec<MaterialKind> {
    let white = grey(1.0);
    let mut kinds = vec![diffuse(white)];
    for specularity in [0.0, 0.25, 0.5, 0.75, 0.99, 1.0] {
        kinds.push(MaterialKind::Reflective { color: white, specularity });
        for coat in [0.0, 0.5, 1.0] {
            kinds.push(MaterialKind::ClearCoat { color: white, coat, coat_color: white, specularity });
        }
    }
    kinds
}

#[test]
fn white_opaque_bodies_under_a_white_sky_are_exactly_one() {
    let measure = Measure { samples: 4000, bounces: 20, light_sampling: false };
    for shape in convex_shapes() {
        for kind in opaque_white() {
            let mut desc = scene(EYE, DVec3::ZERO, vec![(shape.clone(), kind.clone())]);
            desc.environment = sky(1.0);
            let wrong = samples(&desc, &measure).into_iter().find(|&sample| sample != 1.0);
            assert_eq!(wrong, None, "{kind:?}");
        }
    }
}

#[test]
fn white_glass_under_a_white_sky_is_one_or_cut() {
    let measure = Measure { samples: 4000, bounces: 12, light_sampling: false };
    for shape in convex_shapes() {
        for ratio in [0.42, 0.67, 1.0 - 1e-7, 1.0, 1.5] {
            let kind = MaterialKind::Refractive { color: grey(1.0), ratio };
            let mut desc = scene(EYE, DVec3::ZERO, vec![(shape.clone(), kind)]);
            desc.environment = sky(1.0);
            let all = samples(&desc, &measure);
            assert!(all.iter().all(|&s| s == 1.0 || s == 0.0), "ratio {ratio}");
            let cut = all.iter().filter(|&&s| s == 0.0).count();
            // A ray in a box may be totally reflected for ever; from a ball every path leaves.
            let box_like = matches!(shape, ShapeDesc::Box { .. });
            assert!(box_like || cut < all.len() / 100, "ratio {ratio}: {cut} cut");
        }
    }
}

/// Inside a closed body with Le = 1 - rho the light after N segments is 1 - rho^N.
#[test]
fn closed_furnaces_reach_one_minus_the_cut_rest() {
    let part = meshes::sphere(1.0, 8, 0.1, 5);
    let shapes = [
        ball(DVec3::ZERO, 1.0),
        cuboid(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, 0.0, 17.0)),
        mesh(part.positions.iter().map(DVec3::to_array).collect(), part.triangles),
    ];
    for (name, shape) in ["ball", "box", "mesh"].into_iter().zip(shapes) {
        for rho in [0.1, 0.5, 0.9, 0.99] {
            for bounces in [1, 2, 5, 16] {
                let body = (shape.clone(), glowing(grey(rho), grey(1.0 - rho)));
                let desc = scene(DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.4, 0.1, -0.2), vec![body]);
                let expected = 1.0 - f64::powi(rho, bounces);
                for light_sampling in [false, true] {
                    let measure = Measure { samples: 20_000, bounces: bounces as u32, light_sampling };
                    let what = format!("{name} rho {rho} bounces {bounces} light sampling {light_sampling}");
                    assert_mean(&what, &desc, &measure, expected, 1e-2);
                }
            }
        }
    }
}
