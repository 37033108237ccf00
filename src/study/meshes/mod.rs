//! Meshes to measure on, made here: families that grow to any number of triangles, the same on every machine.

mod building;
mod grids;
mod loose;
mod noise;
mod spheres;

use super::view::View;
use crate::geometry::MeshPart;
use crate::math::DVec3;

/// The kinds of meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Family {
    /// A closed sphere of meridians and parallels, each radius scaled by 1 to 1.05 at random.
    Sphere,
    /// A closed, lumpy body with fine detail and irregular triangles, as scanners make them.
    Scan,
    /// Storeys of furnished rooms: large walls beside small things, most of them aligned to the axes.
    Building,
    /// A square of hills.
    Terrain,
    /// A closed cube of regular grids.
    Cube,
    /// Triangles of any shape and place.
    Soup,
    /// Needles down to a millionth of their length, and cones of slivers that share a tip.
    Slivers,
    /// The sphere with every face four times, in shuffled order.
    Duplicates,
}

impl Family {
    /// In the order in which they are measured.
    pub const ALL: [Family; 8] = [
        Family::Sphere,
        Family::Scan,
        Family::Building,
        Family::Terrain,
        Family::Cube,
        Family::Soup,
        Family::Slivers,
        Family::Duplicates,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Family::Sphere => "sphere",
            Family::Scan => "scan",
            Family::Building => "building",
            Family::Terrain => "terrain",
            Family::Cube => "cube",
            Family::Soup => "soup",
            Family::Slivers => "slivers",
            Family::Duplicates => "duplicates",
        }
    }

    /// Whether a ray from the middle must hit it.
    pub fn is_closed(self) -> bool {
        matches!(self, Family::Sphere | Family::Scan | Family::Cube | Family::Duplicates)
    }

    /// The mesh whose number of triangles is nearest to `triangles`, or nearly so. Equal arguments make equal meshes.
    pub fn make(self, triangles: usize, seed: u64) -> MeshPart {
        match self {
            Family::Sphere => spheres::noise_sphere(triangles, seed),
            Family::Scan => spheres::scan(triangles, seed),
            Family::Building => building::building(triangles, seed),
            Family::Terrain => grids::terrain(triangles, seed),
            Family::Cube => grids::cube(triangles),
            Family::Soup => loose::soup(triangles, seed),
            Family::Slivers => loose::slivers(triangles, seed),
            Family::Duplicates => loose::duplicates(spheres::noise_sphere(triangles / 4, seed), seed),
        }
    }

    /// From where primary rays look at it: from inside a building, from outside at the rest.
    pub fn view(self) -> View {
        let (eye, target) = match self {
            Family::Building => building::eye(),
            Family::Terrain => (DVec3::new(-1.4, -1.1, 0.9), DVec3::new(0.0, 0.0, 0.1)),
            _ => (DVec3::new(-2.6, -1.7, 1.2), DVec3::ZERO),
        };
        View { eye, target, fov: 0.25 }
    }
}
