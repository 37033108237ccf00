//! All primitives of a scene: flat arrays joined by indices.

use super::{
    Ball, Cuboid, Hit, Instance, LinearSolids, LocalFrame, LocalRay, MeshPart, MeshSpace, PrimitiveId, Ray,
    Rectangle, TriangleHit,
};
use crate::math::{Bounds, round_down, round_up};

/// The shape of a solid, in world space.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// A sphere.
    Ball(Ball),
    /// A box.
    Cuboid(Cuboid),
    /// A rectangle.
    Rectangle(Rectangle),
    /// A mesh that is in the scene several times.
    Instance(Instance),
}

/// A primitive that is decided in f64, or an instance of a mesh.
#[derive(Clone, Copy, Debug)]
pub struct Solid {
    /// Index of the object in the scene.
    pub object: u32,
    /// Its shape.
    pub shape: Shape,
}

/// All primitives, as accelerators see them.
#[derive(Clone, Debug)]
pub struct Geometry {
    /// Spaces of triangles: first those of the meshes that have instances, then those of the meshes that lie in the
    /// world.
    pub spaces: Vec<MeshSpace>,
    /// How many of the spaces have instances.
    instanced: usize,
    /// The solids in the order of the scene.
    pub solids: Vec<Solid>,
    /// The space of the nodes over `tree_solids`.
    pub solid_frame: LocalFrame,
    /// Indices of the solids that every ray is tried against: few ones, or much larger than the rest.
    pub linear_solids: Vec<u32>,
    /// The same solids, four abreast.
    pub(crate) abreast: LinearSolids,
    /// Indices of the solids that need a tree.
    pub tree_solids: Vec<u32>,
}

/// Up to this many solids are tried four abreast: no tree over three balls. Measured: of 16 that takes 0.85 to 0.93 of the
/// time of a render with a tree, of 24 0.88 to 0.99, of 32 as much or more.
const WITHOUT_TREE: usize = 24;

/// Up to this many solids are tried beside a tree, or in place of one if there are instances, which are not abreast.
const LINEAR_SOLIDS: usize = 8;

/// A solid so many times larger than the median one would widen every node and stays out of the tree.
const LARGE: f64 = 64.0;

/// Meshes that lie in the world share a space if all of them together are at most so many times as large as the smallest:
/// so a fine mesh beside a huge one, or far from the others, keeps its digits, and the boxes around its triangles need no
/// padding for the size of the whole.
const SHARED_RANGE: f64 = 256.0;

/// The most spaces of meshes that lie in the world: every ray is brought into each. If they do not suffice, meshes of a
/// wider range share one.
const WORLD_SPACES: usize = 8;

impl Geometry {
    /// Collects primitives without instances. `solids` and `meshes` ascend by object; all numbers are finite.
    pub fn new(solids: Vec<Solid>, meshes: &[MeshPart]) -> Geometry {
        Geometry::with_instances(solids, meshes.to_vec(), Vec::new())
    }

    /// Collects primitives; the instances among `solids` name the spaces `shared`.
    pub fn with_instances(solids: Vec<Solid>, meshes: Vec<MeshPart>, shared: Vec<MeshSpace>) -> Geometry {
        let instanced = shared.len();
        let mut spaces = shared;
        spaces.extend(in_groups(meshes).into_iter().map(MeshSpace::new));
        let bounds: Vec<Bounds> = solids.iter().map(|solid| solid.bounds(&spaces)).collect();
        let instances = solids.iter().any(|solid| matches!(solid.shape, Shape::Instance(_)));
        let most = if instances { LINEAR_SOLIDS } else { WITHOUT_TREE };
        let (linear_solids, tree_solids) = split_solids(&bounds, most);
        let together = tree_solids.iter().fold(Bounds::EMPTY, |b, &i| b.union(bounds[i as usize]));
        let solid_frame = LocalFrame::around(together, together.center());
        let abreast = LinearSolids::new(&solids, &linear_solids);
        Geometry { spaces, instanced, solids, solid_frame, linear_solids, abreast, tree_solids }
    }

    /// The spaces of the meshes that lie in the world, with their indices.
    #[inline(always)]
    pub fn world_spaces(&self) -> impl Iterator<Item = (u32, &MeshSpace)> {
        (self.instanced as u32..).zip(&self.spaces[self.instanced..])
    }

    /// The spaces of the meshes that have instances, which name them by their place.
    pub fn instanced_spaces(&self) -> &[MeshSpace] {
        &self.spaces[..self.instanced]
    }

    /// The space of the mesh that an instance shows.
    #[inline(always)]
    pub fn space_of(&self, instance: &Instance) -> &MeshSpace {
        &self.spaces[instance.space as usize]
    }

    /// Triangles in memory: those of a mesh that has instances count once.
    pub fn triangle_count(&self) -> usize {
        self.spaces.iter().map(|space| space.triangles.len()).sum()
    }

    /// The box around a solid in world space.
    pub fn solid_bounds(&self, solid: u32) -> Bounds {
        self.solids[solid as usize].bounds(&self.spaces)
    }

    /// The ray in a space of the world, for hits up to the world distance `t_max`, without the triangle `target`; `None`
    /// if it misses everything in there.
    #[inline(always)]
    pub fn localize(&self, space: u32, ray: &Ray, t_max: f64, target: PrimitiveId) -> Option<LocalRay> {
        let body = PrimitiveId::triangle(space, 0);
        let excluded = [ray.leaving, target].map(|id| id.triangle_beside(body));
        self.spaces[space as usize].frame.localize(ray, t_max, excluded)
    }

    /// Local box of a solid in the space of `tree_solids`, widened as [`LocalFrame::padding`] says.
    pub fn solid_node_bounds(&self, solid: u32) -> ([f32; 3], [f32; 3]) {
        let bounds = self.solid_bounds(solid);
        let padding = self.solid_frame.padding();
        let low = self.solid_frame.to_local(bounds.min) - padding;
        let high = self.solid_frame.to_local(bounds.max) + padding;
        (low.to_array().map(round_down), high.to_array().map(round_up))
    }

    /// The hit of a solid with t in (0, t_max]. The shared routine of every accelerator; none of an instance, which only an
    /// accelerator can look into ([`crate::accel`]).
    pub fn intersect_solid(&self, solid: u32, ray: &Ray, t_max: f64) -> Option<Hit> {
        let &Solid { object, ref shape } = &self.solids[solid as usize];
        let primitive = PrimitiveId::solid(solid);
        let leaves = ray.leaving == primitive;
        let hit = |t, part, u, v| Hit { t, object, primitive, part, u, v };
        if leaves && !ray.inward {
            return None;
        }
        match shape {
            Shape::Ball(ball) => {
                let t = if leaves {
                    ball.exit(ray.origin, ray.direction)
                } else {
                    let (near, far) = ball.roots(ray.origin, ray.direction)?;
                    if near > 0.0 { near } else { far }
                };
                (t > 0.0 && t <= t_max).then(|| hit(t, 0, 0.0, 0.0))
            }
            Shape::Cuboid(cuboid) => {
                let (t, face) = if leaves {
                    cuboid.exit(ray.origin, ray.direction)
                } else {
                    let (enter, leave) = cuboid.slabs(ray.origin, ray.direction)?;
                    if enter.0 > 0.0 { enter } else { leave }
                };
                if !(t > 0.0 && t <= t_max) {
                    return None;
                }
                let p = cuboid.point_on_face(ray.origin, ray.direction, t, face);
                let (u, v) = cuboid.face_coordinates(p, face);
                Some(hit(t, face, u, v))
            }
            Shape::Rectangle(rectangle) => {
                let (t, part, u, v) = rectangle.intersect(ray.origin, ray.direction, t_max)?;
                Some(hit(t, part, u, v))
            }
            Shape::Instance(_) => None,
        }
    }

    /// The hit of a solid that four-lane arithmetic says is surely hit at `t` ([`super::LinearSolids`]): the one of
    /// [`Geometry::intersect_solid`].
    #[inline]
    pub(crate) fn clear_hit(&self, solid: u32, ray: &Ray, t: f64) -> Option<Hit> {
        let &Solid { object, ref shape } = &self.solids[solid as usize];
        let (part, u, v) = match shape {
            Shape::Ball(_) => (0, 0.0, 0.0),
            Shape::Rectangle(rectangle) => rectangle.clear_hit(ray.origin, ray.direction, t),
            Shape::Cuboid(_) | Shape::Instance(_) => return self.intersect_solid(solid, ray, t),
        };
        Some(Hit { t, object, primitive: PrimitiveId::solid(solid), part, u, v })
    }

    /// The hit of the local ray `ray` in a space of the world as a hit of the path's ray.
    #[inline(always)]
    pub fn world_hit(&self, space: u32, ray: &LocalRay, hit: &TriangleHit) -> Hit {
        let mesh = &self.spaces[space as usize];
        let (object, part) = mesh.triangle_owner(hit.index);
        let t = mesh.outer_distance(ray, hit).max(f64::MIN_POSITIVE);
        Hit { t, object, primitive: PrimitiveId::triangle(space, hit.index), part, u: hit.u, v: hit.v }
    }

    /// The hit of the local ray `ray` in the space of `instance`, the solid `solid`, as a hit of the path's ray.
    pub fn instance_hit(&self, solid: u32, instance: &Instance, ray: &LocalRay, hit: &TriangleHit) -> Hit {
        let distance = self.space_of(instance).outer_distance(ray, hit) * instance.scale;
        Hit {
            t: distance.max(f64::MIN_POSITIVE),
            object: self.solids[solid as usize].object,
            primitive: PrimitiveId::of_instance(solid, hit.index),
            part: hit.index,
            u: hit.u,
            v: hit.v,
        }
    }
}

impl Solid {
    /// The box around it in world space.
    fn bounds(&self, spaces: &[MeshSpace]) -> Bounds {
        match self.shape {
            Shape::Ball(ball) => ball.bounds(),
            Shape::Cuboid(cuboid) => cuboid.bounds(),
            Shape::Rectangle(rectangle) => rectangle.bounds(),
            Shape::Instance(instance) => instance.bounds(&spaces[instance.space as usize]),
        }
    }
}

/// The meshes that have triangles, in groups that share a space (see [`SHARED_RANGE`]), each in the order of the scene.
fn in_groups(meshes: Vec<MeshPart>) -> Vec<Vec<MeshPart>> {
    let around = |mesh: &MeshPart| mesh.positions.iter().fold(Bounds::EMPTY, |b, &p| b.with_point(p));
    let mut sized: Vec<(Bounds, usize)> = (0..meshes.len())
        .filter(|&place| !meshes[place].triangles.is_empty())
        .map(|place| (around(&meshes[place]), place))
        .collect();
    sized.sort_by(|a, b| b.0.extent().total_cmp(&a.0.extent()));
    let ranges = [SHARED_RANGE, SHARED_RANGE * SHARED_RANGE, SHARED_RANGE.powi(3)];
    let groups = ranges.into_iter().find_map(|range| places_in_range(&sized, range));
    let groups = groups.unwrap_or_else(|| vec![sized.iter().map(|&(_, place)| place).collect()]);
    let mut meshes: Vec<Option<MeshPart>> = meshes.into_iter().map(Some).collect();
    let take = |mut places: Vec<usize>| {
        places.sort_unstable();
        places.into_iter().filter_map(|place| meshes[place].take()).collect()
    };
    groups.into_iter().map(take).collect()
}

/// The places of meshes, the largest first, in groups of at most `range` times the smallest mesh; `None` if that takes
/// more than [`WORLD_SPACES`].
fn places_in_range(sized: &[(Bounds, usize)], range: f64) -> Option<Vec<Vec<usize>>> {
    let mut groups: Vec<(Bounds, Vec<usize>)> = Vec::new();
    for &(bounds, place) in sized {
        let fits = |group: &(Bounds, Vec<usize>)| group.0.union(bounds).extent() <= range * bounds.extent();
        match groups.iter().position(fits) {
            Some(group) => {
                let (around, places) = &mut groups[group];
                *around = around.union(bounds);
                places.push(place);
            }
            None if groups.len() == WORLD_SPACES => return None,
            None => groups.push((bounds, vec![place])),
        }
    }
    Some(groups.into_iter().map(|(_, places)| places).collect())
}

/// Indices of the solids that every ray is tried against, and of those that need a tree, as more than `most` do.
fn split_solids(bounds: &[Bounds], most: usize) -> (Vec<u32>, Vec<u32>) {
    let all = 0..bounds.len() as u32;
    if bounds.len() <= most {
        return (all.collect(), Vec::new());
    }
    let extents: Vec<f64> = bounds.iter().map(|bounds| bounds.extent()).collect();
    let mut sorted = extents.clone();
    sorted.sort_by(f64::total_cmp);
    let cut = (LARGE * sorted[sorted.len() / 2]).max(sorted[sorted.len() - 1 - LINEAR_SOLIDS]);
    all.partition(|&i| extents[i as usize] > cut)
}
