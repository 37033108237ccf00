use super::{COLOR, cube, direction_at, normal, refractive};
use pathtracer::material::{Interface, Pdf, Scatter};
use pathtracer::math::DVec3;

const ANGLES: [f64; 6] = [0.0, 10.0, 30.0, 45.0, 80.0, 89.9];

fn sample(ratio: f64, degrees: f64, entering: bool, u: f64) -> Scatter {
    let n = normal();
    refractive(ratio).sample(direction_at(n, degrees), n, entering, [u, 0.3, 0.6]).expect("above the surface")
}

#[test]
fn refraction_follows_snells_law() {
    for (ratio, degrees) in [0.42, 0.67, 0.99, 1.0, 1.2].into_iter().flat_map(|m| ANGLES.map(|a| (m, a))) {
        let n = normal();
        let wo = direction_at(n, degrees);
        let scatter = sample(ratio, degrees, true, 1f64.next_down());
        if scatter.direction.dot(n) > 0.0 {
            assert!(ratio * wo.cross(n).length() > 1.0, "{ratio} {degrees}: nothing refracted");
            continue;
        }
        // n_i sin_i = n_t sin_t, in the same plane: the tangential parts are opposite and in the ratio.
        let tangential = |w: DVec3| w - w.dot(n) * n;
        let rest = tangential(scatter.direction) + ratio * tangential(wo);
        assert!(rest.length() < 8.0 * f64::EPSILON, "{ratio} {degrees}: {rest}");
    }
}

#[test]
fn what_enters_through_one_side_of_a_plate_leaves_parallel() {
    for (ratio, degrees) in [0.42, 0.67, 1.0 - 1e-7, 1.0].into_iter().flat_map(|m| ANGLES.map(|a| (m, a))) {
        let n = normal();
        let wo = direction_at(n, degrees);
        let inside = sample(ratio, degrees, true, 1f64.next_down()).direction;
        let leaving = refractive(ratio).sample(-inside, n, false, [1f64.next_down(), 0.0, 0.0]);
        let direction = leaving.expect("above the surface").direction;
        // A rounding of the sine beyond moves the angle by one over its cosine as much.
        let bound = 16.0 * f64::EPSILON / wo.dot(n);
        assert!((direction + wo).length() < bound, "{ratio} {degrees}: {direction}, not {}", -wo);
    }
}

#[test]
fn the_share_of_reflected_samples_is_the_reflectance() {
    let n = normal();
    let count = 100_000;
    for (ratio, degrees) in [0.42, 0.67, 1.0, 1.2].into_iter().flat_map(|m| ANGLES.map(|a| (m, a))) {
        for entering in [true, false] {
            let wo = direction_at(n, degrees);
            let reflected = cube(2, count)
                .filter_map(|u| refractive(ratio).sample(wo, n, entering, u))
                .filter(|scatter| scatter.direction.dot(n) > 0.0)
                .count();
            let expected = Interface::new(ratio, entering).at(wo.dot(n)).reflectance;
            // Binomial; none of the 48 cases more than four standard deviations away.
            let deviation = (expected * (1.0 - expected) / count as f64).sqrt();
            let share = reflected as f64 / count as f64;
            assert!(
                (share - expected).abs() <= 4.0 * deviation,
                "{ratio} {degrees} {entering}: {share} {expected}"
            );
        }
    }
}

#[test]
fn beyond_the_critical_angle_all_is_reflected() {
    // n = 1 / 0.67: critical at 42.07 degrees.
    for degrees in [42.1, 60.0, 89.9] {
        assert!(cube(3, 1000).all(|[u, ..]| sample(0.67, degrees, false, u).direction.dot(normal()) > 0.0));
    }
    assert!(sample(0.67, 42.0, false, 1f64.next_down()).direction.dot(normal()) < 0.0);
}

#[test]
fn equal_indices_let_everything_pass_straight_on() {
    for degrees in ANGLES {
        for [u, ..] in cube(4, 100).chain([[0.0; 3]]) {
            let scatter = sample(1.0, degrees, true, u);
            assert_eq!(scatter.direction, -direction_at(normal(), degrees));
        }
    }
}

#[test]
fn both_sides_are_delta_and_weigh_exactly_the_color() {
    for (degrees, [u, ..]) in ANGLES.into_iter().flat_map(|degrees| cube(5, 100).map(move |u| (degrees, u))) {
        for entering in [true, false] {
            let scatter = sample(0.67, degrees, entering, u);
            assert_eq!((scatter.weight, scatter.pdf), (COLOR, Pdf::Delta));
        }
    }
}
