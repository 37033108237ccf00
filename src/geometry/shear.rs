//! The plane across a ray, where triangles become 2D and the question of a hit becomes exact.

use crate::math::DVec3;

/// A shear that makes a ray's direction an axis (Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1)
/// 2013), here in f64.
///
/// What a corner is projected to depends on the corner and the ray alone. So however it is rounded, triangles that share
/// corners share their projections, and with exact signs ([`signed_area`]) these triangles tile the plane: no ray passes
/// between them, neither at edges nor at corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shear {
    /// The direction's largest axis, 0 to 2.
    axis: u32,
    /// Slopes of the direction along the two axes that follow it in turn.
    slopes: [f64; 2],
}

impl Shear {
    /// The shear of a direction, of any length but 0.
    #[inline(always)]
    pub(super) fn onto_largest_axis(direction: DVec3) -> Shear {
        let size = direction.abs();
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let [x, y, z] = rotated(direction, axis);
        Shear { axis, slopes: [x / z, y / z] }
    }

    /// Where a point, relative to the start of the ray, is seen.
    #[inline(always)]
    pub(super) fn project(&self, p: DVec3) -> [f64; 2] {
        let [x, y, z] = rotated(p, self.axis);
        [x - self.slopes[0] * z, y - self.slopes[1] * z]
    }
}

/// The components with that of `axis` last.
#[inline(always)]
fn rotated(p: DVec3, axis: u32) -> [f64; 3] {
    match axis {
        0 => [p.y, p.z, p.x],
        1 => [p.z, p.x, p.y],
        _ => [p.x, p.y, p.z],
    }
}

/// Twice the signed area of the triangle (0, p, q): rounded, but with the exact sign. Exchanging p and q negates it.
#[inline(always)]
pub(super) fn signed_area(p: [f64; 2], q: [f64; 2]) -> f64 {
    let (a, b) = (p[0] * q[1], p[1] * q[0]);
    // Rounding is monotonous: where the rounded products differ, the exact ones differ in the same sense.
    if a != b { a - b } else { product_error(p[0], q[1], a) - product_error(p[1], q[0], b) }
}

/// What is missing in the rounded product of x and y (Dekker, "A Floating-Point Technique for Extending the Available
/// Precision", 1971).
#[cold]
fn product_error(x: f64, y: f64, product: f64) -> f64 {
    let split = |x: f64| {
        let shifted = 134_217_729.0 * x;
        let high = shifted - (shifted - x);
        (high, x - high)
    };
    let ((x1, x2), (y1, y2)) = (split(x), split(y));
    ((x1 * y1 - product) + x1 * y2 + x2 * y1) + x2 * y2
}
