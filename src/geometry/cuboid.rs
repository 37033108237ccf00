//! The box, in f64. (`Box` is taken by the language.)

use super::Rectangle;
use super::doubles::{Doubles, One};
use crate::math::{Bounds, DMat3, DVec3};

/// A box that may be turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// Centre.
    pub center: DVec3,
    /// Half of the edge lengths, each > 0.
    pub half: DVec3,
    /// Rotation from the box's axes to the world's; its columns are the box's axes.
    pub rotation: DMat3,
}

/// Where a line meets a box: distance and face (0 to 5: -x +x -y +y -z +z).
type FaceHit = (f64, u32);

impl Cuboid {
    /// Where the line enters and leaves the box; distances may be negative.
    pub fn slabs(&self, origin: DVec3, direction: DVec3) -> Option<(FaceHit, FaceHit)> {
        let o = self.to_local(origin - self.center);
        let d = self.to_local(direction);
        let mut enter = (f64::NEG_INFINITY, 0);
        let mut leave = (f64::INFINITY, 0);
        for axis in 0..3 {
            let (near, far) = slab(One, o[axis], d[axis], self.half[axis]);
            let near_face = 2 * axis as u32 + u32::from(d[axis].is_sign_negative());
            if near > enter.0 {
                enter = (near, near_face);
            }
            if far < leave.0 {
                leave = (far, near_face ^ 1);
            }
        }
        (enter.0 <= leave.0).then_some((enter, leave))
    }

    /// The distance > 0 and the face at which a ray leaves the box that starts on its surface, or within rounding of it,
    /// and goes inward: there always is one, however near to an edge it enters.
    pub fn exit(&self, origin: DVec3, direction: DVec3) -> (f64, u32) {
        let o = self.to_local(origin - self.center);
        let d = self.to_local(direction);
        let mut leave = (f64::INFINITY, 0);
        for axis in (0..3).filter(|&axis| d[axis] != 0.0) {
            let far = (self.half[axis].copysign(d[axis]) - o[axis]) / d[axis];
            if far < leave.0 {
                leave = (far, 2 * axis as u32 + u32::from(d[axis] > 0.0));
            }
        }
        (leave.0.max(f64::MIN_POSITIVE), leave.1)
    }

    /// From the world's axes to the box's.
    pub fn to_local(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.rotation.x_axis), v.dot(self.rotation.y_axis), v.dot(self.rotation.z_axis))
    }

    /// The unit normal of a face, outward.
    pub fn face_normal(&self, face: u32) -> DVec3 {
        let axis = self.rotation.col(face as usize / 2);
        if face.is_multiple_of(2) { -axis } else { axis }
    }

    /// The face that a point of the surface is on, with the normal there, of either sign.
    pub fn face_at(&self, position: DVec3, normal: DVec3) -> u32 {
        let size = self.to_local(normal).abs();
        let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
        2 * axis as u32 + u32::from(self.to_local(position - self.center)[axis] > 0.0)
    }

    /// The point of a face nearest to where the line is after `t`, relative to the centre, in the box's axes.
    pub fn point_on_face(&self, origin: DVec3, direction: DVec3, t: f64, face: u32) -> DVec3 {
        let mut p = self.to_local((origin - self.center) + direction * t).clamp(-self.half, self.half);
        let axis = face as usize / 2;
        p[axis] = if face.is_multiple_of(2) { -self.half[axis] } else { self.half[axis] };
        p
    }

    /// Coordinates in [0, 1] of a point of a face, seen from outside: u to the right, v up (top and bottom: u along
    /// -y, v along +x).
    pub fn face_coordinates(&self, p: DVec3, face: u32) -> (f64, f64) {
        let q = (p / self.half) * 0.5 + 0.5;
        match face {
            0 => (1.0 - q.y, q.z),
            1 => (q.y, q.z),
            2 => (q.x, q.z),
            3 => (1.0 - q.x, q.z),
            _ => (1.0 - q.y, q.x),
        }
    }

    /// The lengths of a face along the coordinates of [`Cuboid::face_coordinates`].
    pub fn face_lengths(&self, face: u32) -> [f64; 2] {
        let DVec3 { x, y, z } = self.half;
        let half = match face {
            0 | 1 => [y, z],
            2 | 3 => [x, z],
            _ => [y, x],
        };
        half.map(|half| 2.0 * half)
    }

    /// A face as a rectangle whose front is outside, with the coordinates of [`Cuboid::face_coordinates`].
    pub fn face(&self, face: u32) -> Rectangle {
        let [x, y, z] = [DVec3::X * self.half.x, DVec3::Y * self.half.y, DVec3::Z * self.half.z];
        let (out, right, up) = match face {
            0 => (-x, -y, z),
            1 => (x, y, z),
            2 => (-y, x, z),
            3 => (y, -x, z),
            4 => (-z, -y, x),
            _ => (z, -y, x),
        };
        let r = self.rotation;
        Rectangle::new(self.center + r * out, r * right, r * up)
    }

    /// The box around it, aligned to the world's axes.
    pub fn bounds(&self) -> Bounds {
        let r = self.rotation;
        let reach =
            r.x_axis.abs() * self.half.x + r.y_axis.abs() * self.half.y + r.z_axis.abs() * self.half.z;
        Bounds { min: self.center - reach, max: self.center + reach }
    }
}

/// The distances at which a line passes the two planes of a slab, nearer first. Along a slab they are infinite: before
/// and after everything from inside of it, both on the same side of everything from outside, and in one of its planes
/// NaN, which neither begins nor ends anything.
#[inline(always)]
fn slab<L: Doubles>(
    lanes: L,
    origin: L::Double,
    direction: L::Double,
    half: L::Double,
) -> (L::Double, L::Double) {
    let last = lanes.with_sign(half, direction);
    let first = lanes.minus(lanes.same(0.0), last);
    let (first, last) = (lanes.minus(first, origin), lanes.minus(last, origin));
    (lanes.over(first, direction), lanes.over(last, direction))
}

/// The distances at which a line enters and leaves a box, of [`Cuboid::slabs`]; the first is the greater one if it
/// misses. `axes` are those of the box.
#[inline(always)]
pub(super) fn enter_and_leave<L: Doubles>(
    lanes: L,
    axes: [[L::Double; 3]; 3],
    half: [L::Double; 3],
    from_center: [L::Double; 3],
    direction: [L::Double; 3],
) -> (L::Double, L::Double) {
    let (mut enter, mut leave) = (lanes.same(f64::NEG_INFINITY), lanes.same(f64::INFINITY));
    for axis in 0..3 {
        let (o, d) = (lanes.dot(from_center, axes[axis]), lanes.dot(direction, axes[axis]));
        let (near, far) = slab(lanes, o, d, half[axis]);
        (enter, leave) = (lanes.greater(near, enter), lanes.lesser(far, leave));
    }
    (enter, leave)
}
