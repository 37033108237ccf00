//! Storeys of furnished rooms.

use crate::geometry::MeshPart;
use crate::math::DVec3;
use crate::study::random::Random;
use std::f64::consts::TAU;

/// Width, depth and height of a room, in metres.
const ROOM: DVec3 = DVec3::new(5.0, 4.0, 3.0);
/// Triangles of a room.
const PER_ROOM: usize = 1336;
const WALL: f64 = 0.1;

/// Rooms beside and above each other, filled up storey by storey.
pub(super) fn building(triangles: usize, seed: u64) -> MeshPart {
    let rooms = ((triangles as f64 / PER_ROOM as f64).round() as usize).max(1);
    let side = ((rooms as f64).cbrt().ceil() as usize).max(1);
    let mut builder = Builder { mesh: MeshPart::default(), random: Random::new(seed) };
    for room in 0..rooms {
        let place = [room % side, room / side % side, room / (side * side)].map(|i| i as f64);
        builder.room(DVec3::from_array(place) * ROOM);
    }
    builder.mesh
}

/// Where a visitor stands in the first room, and looks to: past the table to the door.
pub(super) fn eye() -> (DVec3, DVec3) {
    (DVec3::new(4.6, 3.6, 1.7), DVec3::new(0.5, 1.0, 1.0))
}

/// A mesh under construction.
struct Builder {
    mesh: MeshPart,
    random: Random,
}

impl Builder {
    /// A room whose lower corner is `at`. It has no far walls: those are its neighbours'.
    fn room(&mut self, at: DVec3) {
        self.slab(at, [0.0, 0.0, -WALL], [ROOM.x, ROOM.y, 0.0]);
        // The wall along y with a door, the one along x with a window.
        let (from, to) = (0.8, 1.7);
        self.slab(at, [0.0, 0.0, 0.0], [WALL, from, ROOM.z]);
        self.slab(at, [0.0, to, 0.0], [WALL, ROOM.y, ROOM.z]);
        self.slab(at, [0.0, from, 2.1], [WALL, to, ROOM.z]);
        self.slab(at, [0.0, 0.0, 0.0], [ROOM.x, WALL, 0.9]);
        self.slab(at, [0.0, 0.0, 2.3], [ROOM.x, WALL, ROOM.z]);
        self.slab(at, [0.0, 0.0, 0.9], [1.2, WALL, 2.3]);
        self.slab(at, [3.8, 0.0, 0.9], [ROOM.x, WALL, 2.3]);
        for i in 1..4 {
            let x = 1.2 + 0.65 * f64::from(i);
            self.slab(at, [x - 0.02, 0.03, 0.9], [x + 0.02, 0.07, 2.3]);
        }
        let table = DVec3::new(self.random.between(1.4, 3.0), self.random.between(1.2, 2.2), 0.0);
        self.table(at + table);
        let shelf = DVec3::new(self.random.between(0.4, 2.0), ROOM.y - 0.35, 0.0);
        self.shelf(at + shelf);
        // A column in the corner and a lamp under the ceiling.
        let column = [(0.25, 0.0), (0.25, 0.2), (0.16, 0.35), (0.14, 2.6), (0.24, 2.8), (0.24, ROOM.z)];
        self.lathe(at + DVec3::new(0.45, 0.45, 0.0), &column, 16);
        let lamp = [(0.02, 3.0), (0.02, 2.4), (0.06, 2.38), (0.25, 2.15), (0.24, 2.14), (0.05, 2.3)];
        self.lathe(at + DVec3::new(2.5, 2.0, 0.0), &lamp, 12);
    }

    /// A table with four chairs and a vase.
    fn table(&mut self, at: DVec3) {
        self.slab(at, [0.0, 0.0, 0.71], [1.4, 0.8, 0.75]);
        self.legs(at, 1.4, 0.8, 0.71);
        for (x, y, back) in [(0.15, -0.5, 0.0), (0.8, -0.5, 0.0), (0.15, 0.9, 0.36), (0.8, 0.9, 0.36)] {
            let chair = at + DVec3::new(x, y, 0.0) + self.random.in_cube() * DVec3::new(0.1, 0.1, 0.0);
            self.slab(chair, [0.0, 0.0, 0.43], [0.4, 0.4, 0.46]);
            self.slab(chair, [0.0, back, 0.46], [0.4, back + 0.04, 0.95]);
            self.legs(chair, 0.4, 0.4, 0.43);
        }
        let vase = [(0.05, 0.75), (0.09, 0.8), (0.1, 0.87), (0.06, 0.97), (0.04, 1.02), (0.06, 1.05)];
        self.lathe(at + DVec3::new(0.7, 0.4, 0.0), &vase, 12);
    }

    fn legs(&mut self, at: DVec3, width: f64, depth: f64, height: f64) {
        for (x, y) in [(0.0, 0.0), (width - 0.04, 0.0), (0.0, depth - 0.04), (width - 0.04, depth - 0.04)] {
            self.slab(at, [x, y, 0.0], [x + 0.04, y + 0.04, height]);
        }
    }

    /// Boards with books of all sizes.
    fn shelf(&mut self, at: DVec3) {
        let (width, depth) = (1.6, 0.3);
        self.slab(at, [-0.03, 0.0, 0.0], [0.0, depth, 1.75]);
        self.slab(at, [width, 0.0, 0.0], [width + 0.03, depth, 1.75]);
        for board in 0..4 {
            let z = 0.1 + 0.42 * f64::from(board);
            self.slab(at, [0.0, 0.0, z - 0.03], [width, depth, z]);
            let mut x = 0.02;
            for _ in 0..8 {
                let (thick, height) = (self.random.between(0.02, 0.12), self.random.between(0.18, 0.34));
                let front = self.random.between(0.0, 0.1);
                self.slab(at, [x, front, z], [x + thick, depth, z + height]);
                x += thick + 0.002 + self.random.between(0.0, 0.05);
            }
        }
    }

    /// A box between two corners relative to `at`, outward.
    fn slab(&mut self, at: DVec3, low: [f64; 3], high: [f64; 3]) {
        let first = self.mesh.positions.len() as u32;
        let pick = |bits: usize, axis: usize| if bits >> axis & 1 == 0 { low[axis] } else { high[axis] };
        let corner = |bits: usize| at + DVec3::new(pick(bits, 0), pick(bits, 1), pick(bits, 2));
        self.mesh.positions.extend((0..8).map(corner));
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        for [a, b, c, d] in faces.map(|face| face.map(|corner: u32| first + corner)) {
            self.mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }

    /// A profile of (radius, height) turned about the vertical through `at`.
    fn lathe(&mut self, at: DVec3, profile: &[(f64, f64)], segments: u32) {
        let first = self.mesh.positions.len() as u32;
        for &(radius, height) in profile {
            for segment in 0..segments {
                let (sin, cos) = libm::sincos(TAU * f64::from(segment) / f64::from(segments));
                self.mesh.positions.push(at + DVec3::new(radius * cos, radius * sin, height));
            }
        }
        for ring in 0..profile.len() as u32 - 1 {
            for segment in 0..segments {
                let next = (segment + 1) % segments;
                let [a, b] = [segment, next].map(|s| first + ring * segments + s);
                let [c, d] = [a + segments, b + segments];
                self.mesh.triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
    }
}
