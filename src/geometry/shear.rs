//! The plane across a ray, where triangles become 2D and the question of a hit becomes exact.

use super::LocalRay;
use crate::math::DVec3;

/// A shear that makes a ray's direction an axis (Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1)
/// 2013), here in f64.
///
/// What a corner is projected to depends on the corner and the ray alone. So however it is rounded, triangles that share
/// corners share their projections, and with exact signs ([`signed_area`]) these triangles tile the plane: no ray passes
/// between them, neither at edges nor at corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shear {
    /// The axes in turn, the direction's largest one last. A table to look up, not a choice to branch on: rays come with
    /// any of the three, and a wrong guess costs more than all the rest of this.
    order: [usize; 3],
    /// Slopes of the direction along the first two of them.
    slopes: [f64; 2],
}

/// The axes in turn, by the one that comes last.
const ORDERS: [[usize; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];

#[inline(always)]
fn rotated(p: DVec3, [x, y, z]: [usize; 3]) -> [f64; 3] {
    // Four, so that no index has to be checked.
    let p = [p.x, p.y, p.z, p.z];
    [p[x & 3], p[y & 3], p[z & 3]]
}

impl Shear {
    /// The shear of a direction, of any length but 0.
    #[inline(always)]
    pub(super) fn onto_largest_axis(direction: DVec3) -> Shear {
        let size = direction.abs();
        let other_than_x = usize::from(size.x < size.y.max(size.z));
        let order = ORDERS[other_than_x * (1 + usize::from(size.y < size.z))];
        let [x, y, z] = rotated(direction, order);
        Shear { order, slopes: [x / z, y / z] }
    }

    /// The components of a vector, that of the direction's largest axis last.
    #[inline(always)]
    pub(super) fn rotate(&self, p: DVec3) -> [f64; 3] {
        rotated(p, self.order)
    }

    /// Where a point, relative to the start of the ray, is seen; its components as [`Shear::rotate`] orders them.
    #[inline(always)]
    pub(super) fn project_rotated(&self, [x, y, z]: [f64; 3]) -> [f64; 2] {
        [x - self.slopes[0] * z, y - self.slopes[1] * z]
    }

    /// Where a point, relative to the start of the ray, is seen.
    #[inline(always)]
    pub(super) fn project(&self, p: DVec3) -> [f64; 2] {
        self.project_rotated(self.rotate(p))
    }
}

/// A local ray with its shear: in f64 to decide about triangles, in f32 to find candidates. The components are ordered as
/// [`Shear::rotate`] does.
#[derive(Clone, Debug)]
pub(crate) struct ShearedRay<'r> {
    /// The ray itself.
    pub(super) ray: &'r LocalRay,
    shear: Shear,
    /// Start and direction.
    pub(super) origin: [f64; 3],
    pub(super) direction: [f64; 3],
    /// The start, rounded to within 2^-23 of the size of each component.
    pub(super) origin32: [f32; 3],
    /// The slopes, rounded to nearest.
    pub(super) slopes32: [f32; 2],
    /// One over the largest component of the direction, that is the distance along the ray by distance along the axis.
    pub(crate) stretch32: f32,
}

impl<'r> ShearedRay<'r> {
    /// The shear of a ray.
    #[inline(always)]
    pub(crate) fn new(ray: &'r LocalRay) -> ShearedRay<'r> {
        let shear = Shear::onto_largest_axis(ray.direction64());
        let direction = shear.rotate(ray.direction64());
        let [x, y, z] = shear.order;
        let rounded = [ray.origin.x, ray.origin.y, ray.origin.z, ray.origin.z];
        ShearedRay {
            ray,
            shear,
            origin: shear.rotate(ray.origin64()),
            direction,
            origin32: [rounded[x & 3], rounded[y & 3], rounded[z & 3]],
            slopes32: [shear.slopes[0] as f32, shear.slopes[1] as f32],
            stretch32: 1.0 / direction[2] as f32,
        }
    }

    /// The axes in the order of the components; each is below three.
    #[inline(always)]
    pub(super) fn order(&self) -> [usize; 3] {
        self.shear.order
    }

    /// The components of a point in the order of those of this ray.
    #[inline(always)]
    pub(super) fn rotate(&self, p: DVec3) -> [f64; 3] {
        self.shear.rotate(p)
    }

    /// Where a point is seen.
    #[inline(always)]
    fn project(&self, p: [f64; 3]) -> [f64; 2] {
        let o = self.origin;
        self.shear.project_rotated([p[0] - o[0], p[1] - o[1], p[2] - o[2]])
    }

    /// Twice the signed areas, seen along the ray, of the three triangles that it makes with the edges opposite to the
    /// corners; their signs are exact for the corners as they are seen, so that triangles that share edges or corners
    /// let no ray through.
    #[inline(always)]
    pub(super) fn edges(&self, corners: [[f64; 3]; 3]) -> [f64; 3] {
        let [a, b, c] = corners;
        let (a, b, c) = (self.project(a), self.project(b), self.project(c));
        [signed_area(b, c), signed_area(c, a), signed_area(a, b)]
    }
}

/// A local ray whose shear is found when it is first asked for: many rays reach no triangle.
pub(crate) struct LazyShear<'r> {
    ray: &'r LocalRay,
    sheared: Option<ShearedRay<'r>>,
}

impl<'r> LazyShear<'r> {
    /// Nothing is computed yet.
    #[inline(always)]
    pub(crate) fn new(ray: &'r LocalRay) -> LazyShear<'r> {
        LazyShear { ray, sheared: None }
    }

    /// The ray itself.
    #[inline(always)]
    pub(crate) fn local(&self) -> &'r LocalRay {
        self.ray
    }

    /// The ray with its shear.
    #[inline(always)]
    pub(crate) fn get(&mut self) -> &ShearedRay<'r> {
        match &mut self.sheared {
            Some(sheared) => sheared,
            none => none.insert(ShearedRay::new(self.ray)),
        }
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
