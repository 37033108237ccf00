//! The scene `legacyBalls`: balls in the spiral of a sunflower's seeds around a large one, seen through a wide lens.

use super::mesh::fixed;
use super::random::Random;
use std::f64::consts::TAU;

/// Balls of the spiral, counted from its middle; the first places are left to the large ball.
const PLACES: std::ops::Range<u32> = 6..190;

/// The turn from one ball to the next, the golden angle (Vogel, "A better way to construct the sunflower head", 1979).
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// The distance of the n-th ball from the middle is this times the root of n.
const SPREAD: f64 = 0.61;

/// Radius of the ball that they all lie on.
const GROUND: f64 = 100_000.0;

/// The part of the scene that is written by hand.
const HEAD: &str = "\
# A sunflower of balls at dusk, some of them lamps, with so wide a lens that only the middle is sharp.
# Meant for 1500 x 1200. Made by tests/generate, which is where to change it.
Camera:
  Position: [-10.8, 0, 2.7]
  LookingAt: [0, 0, 0.95]
  Fov: 0.2           # 36 degrees
  FocusDistance: 10
  DepthOfField: 55

Environment:
  SkyColor: [0.08, 0.16, 0.45]
  HorizonColor: [0.95, 0.55, 0.42]
  GroundColor: [0.12, 0.10, 0.12]

Objects:
  - Object:
      Name: Ground
      Type: Ball
      Position: [0, 0, -100000]
      Radius: 100000
      Material:
        Name: Slate
        Type: Diffuse
        Color: [0.30, 0.29, 0.33]
  - Object:
      Name: Middle
      Type: Ball
      Position: [0, 0, 1.15]
      Radius: 1.15
      Material:
        Name: Clear Glass
        Type: Refractive
        RefractionRatio: 0.67
";

/// The whole scene file.
pub(crate) fn yaml() -> String {
    let mut random = Random::new(1);
    PLACES.map(|n| ball(n, &mut random)).fold(HEAD.to_owned(), |text, ball| text + &ball)
}

/// The n-th ball of the spiral.
fn ball(n: u32, random: &mut Random) -> String {
    let angle = GOLDEN_ANGLE * f64::from(n);
    let distance = SPREAD * f64::from(n).sqrt();
    let radius = random.between(0.24, 0.44);
    // The ball touches the round ground: the centres are as far apart as the sum of the radii.
    let height = ((GROUND + radius).powi(2) - distance * distance).sqrt() - GROUND;
    let [x, y, z] = [distance * libm::cos(angle), distance * libm::sin(angle), height].map(|x| fixed(x, 3));
    let radius = fixed(radius, 3);
    let material = material(n);
    format!(
        "  - Object:\n      Type: Ball\n      Position: [{x}, {y}, {z}]\n      Radius: {radius}\n      Material:\n{material}"
    )
}

/// The material of the n-th ball.
fn material(n: u32) -> String {
    let [r, g, b] = color(n).map(|c| fixed(c, 2));
    if n.is_multiple_of(11) {
        return "        Name: Lamp\n        Type: Diffuse\n        EmissionStrength: 1.8\n        EmissionColor: [1, 0.6, 0.26]\n"
            .to_owned();
    }
    match n % 8 {
        1 => format!("        Type: Reflective\n        Color: [{r}, {g}, {b}]\n        Specularity: 0.96\n"),
        3 | 6 => format!(
            "        Type: ClearCoat\n        Color: [{r}, {g}, {b}]\n        ClearCoat: 0.15\n        Specularity: 0.99\n"
        ),
        4 => "        Type: Refractive\n        RefractionRatio: 0.67\n".to_owned(),
        _ => format!("        Type: Diffuse\n        Color: [{r}, {g}, {b}]\n"),
    }
}

/// The colour of the n-th ball: around the circle of hues once from the middle to the rim.
fn color(n: u32) -> [f64; 3] {
    let t = (f64::from(n) / f64::from(PLACES.end)).sqrt();
    [0.2, 0.5, 0.8].map(|phase| 0.45 + 0.4 * libm::cos(TAU * (t - phase)))
}
