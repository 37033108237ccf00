//! Solids without a tree, four abreast: every ray is tried against all of them, in f64, with the arithmetic of the routines
//! that decide about one ([`super::doubles`]), so with the same bits.

use super::doubles::{Doubles, FourDoubles, One};
use super::rectangle::Pane;
use super::{PrimitiveId, Ray, Shape, Solid, ball, cuboid};

/// Balls, boxes and rectangles in fours.
#[derive(Clone, Debug, Default)]
pub(crate) struct LinearSolids {
    balls: Vec<Four<4>>,
    cuboids: Vec<Four<15>>,
    rectangles: Vec<Four<14>>,
    /// The others: instances.
    rest: Vec<u32>,
}

/// Four solids of a shape, structure of arrays; unused lanes come last and are never hit.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
struct Four<const N: usize> {
    numbers: [[f64; 4]; N],
    /// Their indices.
    solids: [f64; 4],
}

/// What a closest-hit search among them found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Nearest {
    /// Nothing is hit.
    None,
    /// This solid is hit at `t`, before all others.
    Clear {
        /// Index of the solid.
        solid: u32,
        /// In units of the ray's direction.
        t: f64,
    },
    /// Two at one distance, or a ray that passes an edge so closely that only exact signs can tell.
    Unclear,
}

impl<const N: usize> Four<N> {
    /// The solids with these numbers, in fours; `unused` is for lanes that are never hit.
    fn all(solids: Vec<(u32, [f64; N])>, unused: [f64; N]) -> Vec<Four<N>> {
        let fours = solids.chunks(4).map(|chunk| {
            let lane =
                |lane: usize| chunk.get(lane).map_or((-1.0, unused), |&(solid, n)| (f64::from(solid), n));
            let lanes = [lane(0), lane(1), lane(2), lane(3)];
            Four {
                numbers: std::array::from_fn(|i| lanes.map(|(_, numbers)| numbers[i])),
                solids: lanes.map(|(solid, _)| solid),
            }
        });
        fours.collect()
    }

    /// The vector that begins at the number `first`.
    #[inline(always)]
    fn vector<L: FourDoubles>(&self, lanes: L, first: usize) -> [L::Double; 3] {
        [self.number(lanes, first), self.number(lanes, first + 1), self.number(lanes, first + 2)]
    }

    /// A number.
    #[inline(always)]
    fn number<L: FourDoubles>(&self, lanes: L, index: usize) -> L::Double {
        lanes.read(&self.numbers[index])
    }
}

/// A ray in all lanes.
struct WideRay<L: FourDoubles> {
    origin: [L::Double; 3],
    direction: [L::Double; 3],
    /// The sum of the sizes of the origin's components.
    size: L::Double,
    /// Solids that don't count: the one it leaves, the one it goes to.
    without: [L::Double; 2],
}

impl<L: FourDoubles> WideRay<L> {
    #[inline(always)]
    fn new(lanes: L, ray: &Ray, target: PrimitiveId) -> WideRay<L> {
        WideRay {
            origin: lanes.same_each(ray.origin.to_array()),
            direction: lanes.same_each(ray.direction.to_array()),
            size: lanes.same(ray.origin.abs().element_sum()),
            without: [lanes.same(index(ray.leaving)), lanes.same(index(target))],
        }
    }
}

/// The index of a solid among the lanes; one that none has for everything else.
#[inline(always)]
fn index(primitive: PrimitiveId) -> f64 {
    primitive.as_solid().map_or(-2.0, f64::from)
}

/// The distances at which four solids are hit.
struct Hits<L: FourDoubles> {
    /// Infinite or not above 0 where nothing is hit.
    t: L::Double,
    solids: L::Double,
    /// What is added to the index of the solid: something between 0 and 1 if it is only perhaps hit.
    doubt: L::Double,
}

impl Four<4> {
    #[inline(always)]
    fn hits<L: FourDoubles>(&self, lanes: L, ray: &WideRay<L>) -> Hits<L> {
        let (center, radius) = (self.vector(lanes, 0), self.number(lanes, 3));
        let (meets, near, far) = ball::roots(lanes, center, radius, ray.origin, ray.direction);
        let zero = lanes.same(0.0);
        let t = lanes.choose(lanes.is_less(zero, near), near, far);
        let t = lanes.choose(meets, t, zero);
        Hits { t, solids: lanes.read(&self.solids), doubt: zero }
    }
}

impl Four<15> {
    #[inline(always)]
    fn hits<L: FourDoubles>(&self, lanes: L, ray: &WideRay<L>) -> Hits<L> {
        let axes = [self.vector(lanes, 3), self.vector(lanes, 6), self.vector(lanes, 9)];
        let from_center = lanes.difference(ray.origin, self.vector(lanes, 0));
        let half = self.vector(lanes, 12);
        let (enter, leave) = cuboid::enter_and_leave(lanes, axes, half, from_center, ray.direction);
        let zero = lanes.same(0.0);
        let t = lanes.choose(lanes.is_less(zero, enter), enter, leave);
        let t = lanes.choose(lanes.is_at_most(enter, leave), t, zero);
        Hits { t, solids: lanes.read(&self.solids), doubt: zero }
    }
}

impl Four<14> {
    #[inline(always)]
    fn hits<L: FourDoubles>(&self, lanes: L, ray: &WideRay<L>) -> Hits<L> {
        let pane = Pane {
            center: self.vector(lanes, 0),
            normal: self.vector(lanes, 3),
            along_u: self.vector(lanes, 6),
            along_v: self.vector(lanes, 9),
            slack: [self.number(lanes, 12), self.number(lanes, 13)],
        };
        let (t, cosine) = pane.distance(lanes, ray.origin, ray.direction);
        let (_, clearance) = pane.look(lanes, ray.origin, ray.direction, t, cosine, ray.size);
        let zero = lanes.same(0.0);
        // Where in doubt, as with NaN, t may be rounding alone: the hit counts as the nearest. Unused lanes have t = NaN.
        let is_clear = lanes.is_less(zero, clearance.hits);
        let is_number = lanes.is_at_most(lanes.size(t), lanes.same(f64::INFINITY));
        let perhaps = lanes.choose(is_number, lanes.same(f64::MIN_POSITIVE), zero);
        let t = lanes.choose(is_clear, t, perhaps);
        let t = lanes.choose(lanes.is_less(clearance.misses, zero), zero, t);
        let doubt = lanes.choose(is_clear, zero, lanes.same(0.5));
        Hits { t, solids: lanes.read(&self.solids), doubt }
    }
}

/// The closest two in every lane.
struct Search<L: FourDoubles> {
    first: L::Double,
    second: L::Double,
    /// The index of the first one's solid and its doubt.
    solid: L::Double,
}

impl<L: FourDoubles> Search<L> {
    #[inline(always)]
    fn take(&mut self, lanes: L, hits: Hits<L>, ray: &WideRay<L>) {
        let counts = lanes.is_less(lanes.same(0.0), hits.t);
        let counts = lanes.both(counts, lanes.differs(hits.solids, ray.without[0]));
        let t = lanes.choose(counts, hits.t, lanes.same(f64::INFINITY));
        let closer = lanes.is_less(t, self.first);
        self.second = lanes.lesser(self.second, lanes.greater(t, self.first));
        self.first = lanes.lesser(t, self.first);
        self.solid = lanes.choose(closer, lanes.plus(hits.solids, hits.doubt), self.solid);
    }

    /// The closest of all lanes.
    #[inline(always)]
    fn nearest(self, lanes: L) -> Nearest {
        let firsts = lanes.to_memory(self.first);
        let seconds = lanes.to_memory(self.second);
        let solids = lanes.to_memory(self.solid);
        let (mut t, mut second, mut solid) = (firsts[0], seconds[0], solids[0]);
        for lane in 1..4 {
            let first = firsts[lane];
            let later = One.greater(t, first);
            second = One.lesser(One.lesser(second, seconds[lane]), later);
            solid = One.choose(first < t, solids[lane], solid);
            t = One.lesser(t, first);
        }
        if t == f64::INFINITY {
            return Nearest::None;
        }
        let index = solid as u32;
        if t == second || f64::from(index) != solid {
            return Nearest::Unclear;
        }
        Nearest::Clear { solid: index, t }
    }
}

impl LinearSolids {
    /// Puts `linear`, indices into `solids`, abreast.
    pub(super) fn new(solids: &[Solid], linear: &[u32]) -> LinearSolids {
        let (mut balls, mut cuboids, mut rectangles, mut rest) = (vec![], vec![], vec![], vec![]);
        for &solid in linear {
            match &solids[solid as usize].shape {
                Shape::Ball(ball) => {
                    let [x, y, z] = ball.center.to_array();
                    balls.push((solid, [x, y, z, ball.radius]));
                }
                Shape::Cuboid(cuboid) => {
                    let r = cuboid.rotation;
                    let vectors = [cuboid.center, r.x_axis, r.y_axis, r.z_axis, cuboid.half];
                    cuboids.push((solid, std::array::from_fn(|i| vectors[i / 3][i % 3])));
                }
                Shape::Rectangle(rectangle) => {
                    let Pane { center, normal, along_u, along_v, slack } = rectangle.pane();
                    let vectors = [center, normal, along_u, along_v];
                    let number = |i: usize| if i < 12 { vectors[i / 3][i % 3] } else { slack[i - 12] };
                    rectangles.push((solid, std::array::from_fn(number)));
                }
                Shape::Instance(_) => rest.push(solid),
            }
        }
        LinearSolids {
            balls: Four::all(balls, [-1.0; 4]),
            // Without axes all distances are NaN, and the box is left at infinity.
            cuboids: Four::all(cuboids, [0.0; 15]),
            // Without a normal every distance is NaN.
            rectangles: Four::all(rectangles, [0.0; 14]),
            rest,
        }
    }

    /// The solids that are not among the lanes.
    pub(crate) fn rest(&self) -> &[u32] {
        &self.rest
    }

    /// The closest hit, without the solid that the ray leaves.
    #[inline(always)]
    pub(crate) fn closest<L: FourDoubles>(&self, ray: &Ray, lanes: L) -> Nearest {
        let ray = WideRay::new(lanes, ray, PrimitiveId::NONE);
        let infinite = lanes.same(f64::INFINITY);
        let mut search = Search { first: infinite, second: infinite, solid: lanes.same(-1.0) };
        for balls in &self.balls {
            search.take(lanes, balls.hits(lanes, &ray), &ray);
        }
        for cuboids in &self.cuboids {
            search.take(lanes, cuboids.hits(lanes, &ray), &ray);
        }
        for rectangles in &self.rectangles {
            search.take(lanes, rectangles.hits(lanes, &ray), &ray);
        }
        search.nearest(lanes)
    }

    /// Whether any is hit at t in (0, `t_max`) without the solid that the ray leaves and `target`; `None` if only exact
    /// signs can tell.
    #[inline(always)]
    pub(crate) fn any<L: FourDoubles>(
        &self,
        ray: &Ray,
        t_max: f64,
        target: PrimitiveId,
        lanes: L,
    ) -> Option<bool> {
        let ray = WideRay::new(lanes, ray, target);
        let end = lanes.same(t_max);
        for cuboids in &self.cuboids {
            if lanes.any(in_range(lanes, &cuboids.hits(lanes, &ray), &ray, end)) {
                return Some(true);
            }
        }
        for balls in &self.balls {
            if lanes.any(in_range(lanes, &balls.hits(lanes, &ray), &ray, end)) {
                return Some(true);
            }
        }
        let mut doubt = false;
        for rectangles in &self.rectangles {
            let hits = rectangles.hits(lanes, &ray);
            let hit = in_range(lanes, &hits, &ray, end);
            if lanes.any(hit) {
                let zero = lanes.same(0.0);
                if lanes.any(lanes.both(hit, lanes.is_at_most(hits.doubt, zero))) {
                    return Some(true);
                }
                doubt = true;
            }
        }
        (!doubt).then_some(false)
    }
}

/// Which hits, certain or not, are at t in (0, `end`) and count.
#[inline(always)]
fn in_range<L: FourDoubles>(lanes: L, hits: &Hits<L>, ray: &WideRay<L>, end: L::Double) -> L::Mask {
    let within = lanes.both(lanes.is_less(lanes.same(0.0), hits.t), lanes.is_less(hits.t, end));
    let others = lanes.differs(hits.solids, ray.without[0]);
    lanes.both(within, lanes.both(others, lanes.differs(hits.solids, ray.without[1])))
}
