//! A line and a triangle in double-double arithmetic: an oracle that shares nothing with the code under test.

use super::double_double::DoubleDouble;
use pathtracer::geometry::{Instance, MeshSpace};
use pathtracer::math::DVec3;

/// Three coordinates of twice the digits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector([DoubleDouble; 3]);

impl From<DVec3> for Vector {
    fn from(v: DVec3) -> Vector {
        Vector(v.to_array().map(DoubleDouble::from))
    }
}

impl Vector {
    fn zip(self, other: Vector, f: impl Fn(DoubleDouble, DoubleDouble) -> DoubleDouble) -> Vector {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Vector([f(a, x), f(b, y), f(c, z)])
    }

    pub(crate) fn plus(self, other: Vector) -> Vector {
        self.zip(other, |a, b| a + b)
    }

    pub(crate) fn minus(self, other: Vector) -> Vector {
        self.zip(other, |a, b| a - b)
    }

    pub(crate) fn times(self, factor: DoubleDouble) -> Vector {
        Vector(self.0.map(|x| x * factor))
    }

    fn dot(self, other: Vector) -> DoubleDouble {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        a * x + b * y + c * z
    }

    fn cross(self, other: Vector) -> Vector {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Vector([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    /// Rounded.
    pub(crate) fn to_f64(self) -> DVec3 {
        DVec3::from_array(self.0.map(DoubleDouble::to_f64))
    }
}

/// The corners of a triangle of a space in its outer coordinates.
pub(crate) fn corners(space: &MeshSpace, triangle: u32) -> [Vector; 3] {
    let unit = DoubleDouble::from(1.0 / space.frame.scale);
    space.corners(triangle).map(|corner| Vector::from(corner).times(unit).plus(space.frame.pivot.into()))
}

/// Where an instance shows a point of its mesh.
pub(crate) fn shown(instance: &Instance, p: Vector) -> Vector {
    let Vector([x, y, z]) = p;
    let columns = [instance.rotation.x_axis, instance.rotation.y_axis, instance.rotation.z_axis];
    let [a, b, c] = columns.map(Vector::from);
    let turned = a.times(x).plus(b.times(y)).plus(c.times(z));
    turned.times(DoubleDouble::from(instance.scale)).plus(instance.position.into())
}

/// How a line and a triangle lie to each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    /// Where the line meets the plane, in units of its direction.
    pub(crate) t: f64,
    /// The point of the plane there.
    pub(crate) point: DVec3,
    /// Whether that is in the triangle.
    pub(crate) inside: bool,
    /// The distance of the line from the nearest edge.
    pub(crate) outline: f64,
    /// How far t moves, at most, if line or corners are moved by 1: one over the cosine of the angle to the normal for a
    /// triangle with a right angle, and more for a thin one.
    pub(crate) slope: f64,
}

/// The meeting of the line from `origin` along `direction`, about of length 1, with a triangle; `None` if the line lies in
/// its plane.
pub(crate) fn meeting(origin: DVec3, direction: DVec3, corners: [Vector; 3]) -> Option<Meeting> {
    let d = Vector::from(direction);
    let c = corners.map(|corner| corner.minus(origin.into()));
    let (e1, e2) = (c[1].minus(c[0]), c[2].minus(c[0]));
    let normal = e1.cross(e2);
    let across = normal.dot(d);
    if across.to_f64() == 0.0 {
        return None;
    }
    let t = c[0].dot(normal) / across;
    // The corners as they are seen along the line, which is the origin there.
    let seen = c.map(|c| c.minus(d.times(c.dot(d) / d.dot(d))));
    let area = |i: usize, j: usize| seen[i].cross(seen[j]).dot(d).to_f64();
    let areas = [area(1, 2), area(2, 0), area(0, 1)];
    let flat = seen.map(Vector::to_f64);
    let outline = (0..3).map(|i| from_segment(flat[i], flat[(i + 1) % 3])).fold(f64::INFINITY, f64::min);
    Some(Meeting {
        t: t.to_f64(),
        point: Vector::from(origin).plus(d.times(t)).to_f64(),
        inside: areas.iter().all(|&a| a >= 0.0) || areas.iter().all(|&a| a <= 0.0),
        outline,
        slope: e1.to_f64().length() * e2.to_f64().length() / across.to_f64().abs(),
    })
}

/// The distance of the origin from a segment.
fn from_segment(a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let share = (-a.dot(along) / along.length_squared()).clamp(0.0, 1.0);
    if share.is_nan() { a.length() } else { (a + along * share).length() }
}
