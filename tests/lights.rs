//! Every light: the directions that light sampling chooses, against the density that it states. The directions are
//! binned, and what the density puts into each bin is estimated by uniform directions, rays and `pdf_surface`.

use crate::support::build::*;
use crate::support::random::{Random, Sample4};
use crate::support::stats::{SIGNIFICANCE, chi_square_tail, sidak};
use pathtracer::accel::Accelerator;
use pathtracer::accel::brute_force::BruteForce;
use pathtracer::geometry::{PrimitiveId, Ray};
use pathtracer::math::{Bounds, DVec3, Frame};
use pathtracer::sampling::warp::{cone_pdf, square_to_cone};
use pathtracer::sampling::{Independent, Sampler};
use pathtracer::scene::desc::{EnvironmentDesc, MaterialKind, SceneDesc, ShapeDesc};
use pathtracer::world::World;
use pathtracer::world::light::{LightTarget, LightTree, Receiver, TreeItem};
use rayon::prelude::*;

/// How finely directions are binned, and how many are.
struct Grid {
    rows: usize,
    columns: usize,
    samples: u64,
}

const COARSE: Grid = Grid { rows: 20, columns: 40, samples: 400_000 };
const FINE: Grid = Grid { rows: 80, columns: 160, samples: 1_000_000 };

/// A receiver at a point, and a cone of directions that holds all lights.
struct View {
    /// Direction of the axis.
    axis: DVec3,
    one_minus_cos: f64,
}

impl View {
    const ALL: View = View { axis: DVec3::Z, one_minus_cos: 2.0 };

    fn of_ball(center: DVec3, radius: f64) -> View {
        let sin2 = radius * radius / center.length_squared() * 1.0001;
        View { axis: center.normalize(), one_minus_cos: sin2 / (1.0 + (1.0 - sin2).sqrt()) }
    }

    fn bin(&self, direction: DVec3, grid: &Grid) -> Option<usize> {
        let local = Frame::around(self.axis).to_local(direction);
        // 1 - cos without cancellation, as the cone may be narrow.
        let sin2 = local.x * local.x + local.y * local.y;
        let one_minus_cos = if local.z > 0.0 { sin2 / (1.0 + local.z) } else { 1.0 - local.z };
        let row = (one_minus_cos / self.one_minus_cos * grid.rows as f64) as usize;
        let turn = local.y.atan2(local.x) / std::f64::consts::TAU + 0.5;
        let column = ((turn * grid.columns as f64) as usize).min(grid.columns - 1);
        (row < grid.rows).then_some(row * grid.columns + column)
    }
}

fn glow(shape: ShapeDesc) -> (ShapeDesc, MaterialKind) {
    (shape, glowing(grey(0.0), grey(1.0)))
}

/// A receiver in free space with its lit side up.
fn receiver(position: DVec3) -> Receiver {
    let mut desc = scene(DVec3::Z, DVec3::ZERO, vec![(square(DVec3::ZERO, 1e-3), diffuse(grey(1.0)))]);
    desc.environment = sky(0.0);
    let world = World::compile(&desc).expect("a valid scene");
    let ray = Ray::new(DVec3::new(1e-5, 2e-5, 1.0), -DVec3::Z);
    let hit = BruteForce::new(&world.geometry).intersect(&ray).expect("the square is hit");
    let mut point = world.geometry.surface(&ray, &hit);
    (point.position, point.primitive) = (position, PrimitiveId::NONE);
    Receiver { point, side: DVec3::Z }
}

/// p of the chi-square between the directions chosen and the density stated; `wrong` falsifies the density.
fn p_value(desc: &SceneDesc, view: &View, grid: &Grid, wrong: f64) -> f64 {
    let world = World::compile(desc).expect("a valid scene");
    let accelerator = BruteForce::new(&world.geometry);
    let at = receiver(-world.origin);
    let (sampler, pixel) = (Independent::new(5), Independent::new(5).pixel(3, 4));
    let bins = grid.rows * grid.columns;
    let mut observed = vec![0.0; bins];
    let mut outside = 0;
    for index in 0..grid.samples {
        let [a, b, c, _] = sampler.sample4(pixel, index, 0);
        let Some(light) = world.lights.sample(&world.geometry, &world.sky, &at, [a, b, c]) else { continue };
        let direction = match light.target {
            LightTarget::Sky(direction) => direction,
            LightTarget::Surface(point) => (point.position - at.point.position).normalize(),
        };
        match view.bin(direction, grid) {
            Some(bin) => observed[bin] += 1.0,
            None => outside += 1,
        }
    }
    assert_eq!(outside, 0, "the cone of the test holds all lights");
    let (mut expected, mut variance) = (vec![0.0; bins], vec![0.0; bins]);
    let frame = Frame::around(view.axis);
    let uniform = cone_pdf(view.one_minus_cos);
    for index in 0..4 * grid.samples {
        let [a, b, ..] = sampler.sample4(pixel, index, 1);
        let direction = frame.to_world(square_to_cone([a, b], view.one_minus_cos)).normalize();
        let ray = Ray::new(at.point.position, direction);
        let density = match accelerator.intersect(&ray) {
            Some(hit) => world.lights.pdf_surface(&at, &hit, &world.geometry.surface(&ray, &hit)),
            None => world.lights.pdf_sky(&world.sky, direction),
        };
        let weight = wrong * density / uniform / 4.0;
        if let Some(bin) = view.bin(direction, grid) {
            expected[bin] += weight;
            variance[bin] += weight * weight;
        }
    }
    two_sample_p(&observed, &expected, &variance)
}

/// Chi-square of counts against expectations that have a variance of their own. Bins of few counts are pooled.
fn two_sample_p(observed: &[f64], expected: &[f64], variance: &[f64]) -> f64 {
    let (mut statistic, mut degrees) = (0.0, 0);
    let mut pool = (0.0, 0.0, 0.0);
    for ((o, e), v) in observed.iter().zip(expected).zip(variance) {
        pool = (pool.0 + o, pool.1 + e, pool.2 + v);
        // A bin counts where both estimates are near normal.
        if pool.1 > 25.0 && pool.1 * pool.1 > 25.0 * pool.2 {
            statistic += (pool.0 - pool.1) * (pool.0 - pool.1) / (pool.1 + pool.2);
            degrees += 1;
            pool = (0.0, 0.0, 0.0);
        }
    }
    // What is left over holds too little to be normal, but too many samples there would still show.
    statistic += (pool.0 - pool.1) * (pool.0 - pool.1) / (pool.1 + pool.2).max(25.0);
    chi_square_tail(statistic, degrees + 1)
}

fn cases() -> Vec<(&'static str, SceneDesc, View)> {
    let only = |shapes: Vec<ShapeDesc>| scene(DVec3::ZERO, DVec3::Z, shapes.into_iter().map(glow).collect());
    let at = DVec3::new(0.6, -0.5, 1.0);
    let d = at.length();
    let turned = DVec3::new(20.0, 35.0, -50.0);
    let box_of = |size: f64| cuboid(at, DVec3::new(size, 1.5 * size, 0.7 * size), turned);
    let triangles = mesh(
        vec![
            [0.5, -0.2, 1.0],
            [1.5, 0.3, 1.2],
            [0.2, 1.0, 1.4],
            [-0.4, 0.2, 0.9],
            [-2.0, -1.0, 1.0],
            [-1.0, -2.0, 1.5],
            [-2.0, -2.0, 2.0],
        ],
        vec![[0, 1, 2], [0, 2, 3], [4, 5, 6]],
    );
    // A sheet overhead that bends so little that it hides nothing of itself.
    let side = 9u32;
    let corner = |i: u32| {
        let (x, y) = (f64::from(i % side) * 0.5 - 2.0, f64::from(i / side) * 0.5 - 2.0);
        [x, y, 1.0 + 0.1 * x * y + 0.05 * x * x]
    };
    let cell = |i: u32| {
        let [a, b, c, d] = [i, i + 1, i + side, i + side + 1];
        [[a, b, d], [a, d, c]]
    };
    let cells = (0..side * (side - 1)).filter(|i| i % side < side - 1);
    let sheet = mesh((0..side * side).map(corner).collect(), cells.flat_map(cell).collect());
    let row = |count: usize| {
        // A ring, on which no ball hides another.
        let place = |i: usize| {
            let turn = std::f64::consts::TAU * i as f64 / count as f64;
            DVec3::new(3.0 * turn.cos(), 3.0 * turn.sin(), 1.0 + 0.2 * (i % 3) as f64)
        };
        only((0..count).map(|i| ball(place(i), 0.1 + 0.05 * (i % 4) as f64)).collect())
    };
    let mut gradient = only(vec![]);
    gradient.environment =
        EnvironmentDesc { sky: grey(0.2), horizon: grey(2.0), ground: grey(0.1), strength: 1.0 };
    let mut sky_and_ball = only(vec![ball(at, 0.4)]);
    sky_and_ball.environment = gradient.environment.clone();
    vec![
        ("a ball near by", only(vec![ball(at, 0.9 * d)]), View::ALL),
        ("a small ball", only(vec![ball(at, 0.05)]), View::of_ball(at, 0.05)),
        ("a tiny ball", only(vec![ball(at, 1e-6)]), View::of_ball(at, 1e-6)),
        ("a ball of 6 sr", only(vec![ball(DVec3::Z, 0.99898)]), View::ALL),
        ("a ball on the horizon", only(vec![ball(DVec3::X * 2.0, 1.0)]), View::ALL),
        ("a rectangle", only(vec![square(at, 1.0)]), View::ALL),
        ("a rectangle just overhead", only(vec![square(DVec3::Z * 0.01, 2.0)]), View::ALL),
        ("a small rectangle", only(vec![square(at, 0.02)]), View::of_ball(at, 0.0142)),
        ("a rectangle of 6 sr", only(vec![square(DVec3::Z, 39.9)]), View::ALL),
        (
            "a rectangle of 1e-9 sr",
            only(vec![square(DVec3::Z, 3.1623e-5)]),
            View::of_ball(DVec3::Z, 2.237e-5),
        ),
        ("a box", only(vec![box_of(1.0)]), View::ALL),
        ("a small box", only(vec![box_of(0.02)]), View::of_ball(at, 0.02)),
        ("a box from inside", only(vec![cuboid(at * 0.1, DVec3::splat(2.0), turned)]), View::ALL),
        ("a mesh", only(vec![triangles]), View::ALL),
        ("a mesh of many triangles", only(vec![sheet]), View::ALL),
        ("two balls", only(vec![ball(at, 0.3), ball(DVec3::new(-1.0, 0.5, 0.5), 0.2)]), View::ALL),
        ("twelve balls", row(12), View::ALL),
        ("twenty balls", row(20), View::ALL),
        ("the sky", gradient, View::ALL),
        ("the sky and a ball", sky_and_ball, View::ALL),
    ]
}

fn assert_densities(grid: &Grid) {
    let cases = cases();
    let least = sidak(SIGNIFICANCE, cases.len());
    let found: Vec<f64> = cases.par_iter().map(|(_, desc, view)| p_value(desc, view, grid, 1.0)).collect();
    for ((name, ..), p) in cases.iter().zip(found) {
        assert!(p > least, "{name}: p = {p:e}");
    }
}

#[test]
fn lights_are_sampled_with_the_density_they_state() {
    assert_densities(&COARSE);
}

#[test]
#[ignore = "long: a million samples in 80 x 160 bins"]
fn lights_are_sampled_with_the_density_they_state_in_fine_bins() {
    assert_densities(&FINE);
}

/// Small lights in a cube around the receiver, some without power.
fn items(count: u32) -> Vec<TreeItem> {
    let mut random = Random::new(u64::from(count));
    let item = |i: u32| {
        let (center, size) = (random.in_cube() * 3.0, random.between(0.0, 0.1));
        let bounds = Bounds { min: center - size, max: center + size };
        TreeItem { bounds, power: if i.is_multiple_of(5) { 0.0 } else { random.between(0.1, 10.0) } }
    };
    (0..count).map(item).collect()
}

#[test]
fn a_tree_chooses_each_light_with_the_probability_it_states() {
    // Beyond 2^20 several share a leaf.
    for count in [1, 2, 3, 17, 1000, (1 << 20) + 3] {
        let items = items(count);
        let tree = LightTree::new(&items);
        for position in [DVec3::ZERO, DVec3::new(2.0, -1.0, 0.5), DVec3::splat(100.0), DVec3::splat(-5.0)] {
            let at = receiver(position);
            let all = (0..count).map(|item| tree.probability(&at, item));
            let total = all.sum::<f64>();
            // Sums of products of up to 20 shares, each rounded twice or so. Where lights lie below the receiver, the ball
            // around several may reach above it and theirs not: then nothing is chosen.
            let (all_above, has_power) = (position.z < -4.0, items.iter().any(|item| item.power > 0.0));
            assert!(total < 1.0 + 1e-9, "{count}: {total}");
            assert!(total > 1.0 - 1e-9 || !(all_above && has_power), "{count}: {total}");
            for i in 0..1000 {
                let u = (f64::from(i) + 0.5) / 1000.0;
                let Some((item, probability, rest)) = tree.sample(&at, u) else { continue };
                assert_eq!(probability, tree.probability(&at, item), "{count}: {item}");
                assert!(probability > 0.0 && (0.0..1.0).contains(&rest), "{count}: {probability} {rest}");
            }
        }
    }
}

/// Whatever may send light to the receiver is chosen at times.
#[test]
fn a_tree_leaves_out_only_lights_below_the_receiver() {
    let items = items(1000);
    let tree = LightTree::new(&items);
    for position in [DVec3::ZERO, DVec3::new(0.5, 0.5, -2.0), DVec3::new(-2.9, 0.0, 2.5)] {
        let at = receiver(position);
        for (item, index) in items.iter().zip(0..) {
            let may_shine = item.power > 0.0 && item.bounds.max.z > position.z;
            assert!(!may_shine || tree.probability(&at, index) > 0.0, "{index} at {position}");
        }
    }
}

#[test]
fn a_density_wrong_by_ten_per_cent_is_noticed() {
    for (name, desc, view) in &cases() {
        let p = p_value(desc, view, &COARSE, 1.1);
        assert!(p < 1e-6, "{name}: p = {p:e}");
    }
}
