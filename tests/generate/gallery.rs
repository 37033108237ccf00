//! The pictures and the small mesh of `scenes/gallery.yaml`: wood, a sky with a sun, a paper lantern.

use pathtracer::picture::{Metadata, Picture, Pixels, f16, quantize, srgb_encode};
use std::f64::consts::PI;

/// A picture without metadata.
fn picture(width: u32, height: u32, pixels: Pixels) -> Picture {
    Picture { width, height, pixels, channels: Vec::new(), metadata: Metadata::default() }
}

/// Boards of wood: rings around a far axis, a little wavy, in eight boards that differ. It repeats without a seam
/// between the boards only.
pub(crate) fn wood() -> Picture {
    const SIDE: u32 = 256;
    const BOARDS: u32 = 8;
    let color = |x: u32, y: u32| {
        let board = x / (SIDE / BOARDS);
        let across = f64::from(x % (SIDE / BOARDS)) / f64::from(SIDE / BOARDS);
        let along = f64::from(y) / f64::from(SIDE);
        let phase = f64::from(board * board % 7);
        let wave = libm::sin(2.0 * PI * (along + phase / 7.0)) + 0.4 * libm::sin(6.0 * PI * along + phase);
        let ring = libm::sin(2.0 * PI * (3.0 * across + 0.3 * wave + phase));
        let shade = 0.75 + 0.12 * ring + 0.1 * (phase / 7.0 - 0.5);
        let joint = if across < 0.03 { 0.35 } else { 1.0 };
        [0.48, 0.27, 0.12].map(|value| quantize(srgb_encode(value * shade * joint)))
    };
    let pixels = (0..SIDE).flat_map(|y| (0..SIDE).flat_map(move |x| color(x, y)));
    picture(SIDE, SIDE, Pixels::Bytes(pixels.collect()))
}

/// A clear evening: blue above, warm at the horizon, dark ground, and a sun of four pixels.
pub(crate) fn sky() -> Picture {
    const WIDTH: u32 = 128;
    const HEIGHT: u32 = 64;
    let radiance = |x: u32, y: u32| -> [f64; 3] {
        let height = libm::cos((f64::from(y) + 0.5) / f64::from(HEIGHT) * PI);
        if (30..32).contains(&x) && (22..24).contains(&y) {
            return [450.0, 330.0, 210.0];
        }
        if height < 0.0 {
            return [0.12, 0.11, 0.1];
        }
        let share = libm::pow(height, 0.5);
        let (horizon, zenith) = ([1.1, 0.75, 0.5], [0.12, 0.25, 0.6]);
        std::array::from_fn(|i| horizon[i] + (zenith[i] - horizon[i]) * share)
    };
    let pixels = (0..HEIGHT).flat_map(|y| (0..WIDTH).flat_map(move |x| radiance(x, y)));
    picture(WIDTH, HEIGHT, Pixels::Halves(pixels.map(f16::from_f64).collect()))
}

/// A lantern, 1 wide and 1.5 high on the ground: four sides of paper between a wooden top and bottom.
pub(crate) fn lantern() -> String {
    let mut text = "# A paper lantern\nmtllib lantern.mtl\n".to_owned();
    // The corners of three levels, from below; the file's y is up.
    for (y, half) in [(0.0, 0.5), (0.15, 0.5), (1.35, 0.5), (1.5, 0.5)] {
        for (x, z) in [(-half, half), (half, half), (half, -half), (-half, -half)] {
            text += &format!("v {x} {y} {z}\n");
        }
    }
    text += "vt 0 0\nvt 1 0\nvt 1 0.25\nvt 0 0.25\n";
    let corner = |level: u32, i: u32| 4 * level + i % 4 + 1;
    let face = |corners: [u32; 4]| {
        let [a, b, c, d] = corners;
        format!("f {a}/1 {b}/2 {c}/3 {d}/4\n")
    };
    let ring = |level: u32| {
        (0..4)
            .map(|i| {
                face([corner(level, i), corner(level, i + 1), corner(level + 1, i + 1), corner(level + 1, i)])
            })
            .collect::<String>()
    };
    text += "usemtl wood\n";
    text += &face([corner(0, 3), corner(0, 2), corner(0, 1), corner(0, 0)]);
    text += &ring(0);
    text += "usemtl paper\n";
    text += &ring(1);
    text += "usemtl wood\n";
    text += &ring(2);
    text += &face([corner(3, 0), corner(3, 1), corner(3, 2), corner(3, 3)]);
    text
}

/// The materials of the lantern.
pub(crate) fn lantern_materials() -> String {
    "# The materials of lantern.obj\nnewmtl wood\nKd 1 1 1\nmap_Kd wood.png\n\nnewmtl paper\nKd 0.8 0.8 0.8\nKe 1.3 0.8 0.4\n".to_owned()
}
