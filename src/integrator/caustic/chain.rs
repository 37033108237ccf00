//! Specular paths between two points by way of one ball, in closed form but for the root of a function of one variable.
//!
//! Points, centre and path lie in one plane. Let i be the angle of incidence where the path meets the ball from outside,
//! s = sin i, r the angle inside with sin r = n s for n = n outside / n inside, and a, b the radius over the distances
//! of the two points from the centre. From the direction of the first point, as seen from the centre, the path turns by
//! i - asin(a s) until it meets the ball, by pi - 2 r with every chord inside, and by i - asin(b s) from the ball to the
//! second point. It is a path if this turn T(i) is the angle between the two points, to one side or to the other. Turns
//! are unit complex numbers, and i is given by w = tan(i / 2), so that nothing but square roots is to be taken.
//!
//! (Walter, Zhao, Holzschuch, Bala, "Single Scattering in Refractive Media with Triangle Mesh Boundaries", 2009, join points
//! through flat interfaces in the same spirit; for any surface see Hanika, Droske, Fascione, "Manifold Next Event
//! Estimation", 2015.)

use crate::geometry::Ball;
use crate::math::DVec3;

/// The most chords inside a ball that are looked for.
pub(super) const MOST_CHORDS: u32 = 2;

/// Two points outside a ball, at an angle as seen from its centre.
pub(super) struct Ends {
    ball: Ball,
    /// Radius over the distance from the centre, of both points.
    slopes: [f64; 2],
    /// Cosine and sine of the angle between them.
    angle: Turn,
    /// The directions of the first point, and across it on the side of the second.
    axes: [DVec3; 2],
}

/// A path between two points by way of a ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chain {
    /// Sine and cosine of the angle of incidence.
    pub(super) sin: f64,
    pub(super) cos: f64,
    /// 1 if it turns from the first point straight to the second, -1 if the other way round.
    pub(super) side: f64,
    /// Solid angle at the first point by that at the centre, around the second point and times the cosine there,
    /// of paths beside this one.
    pub(super) spread: f64,
    /// Where it turns at first.
    entry: Turn,
    /// By how much it turns along a chord.
    chord: Turn,
}

/// A rotation: cosine and sine.
#[derive(Clone, Copy, Debug)]
struct Turn(f64, f64);

impl Turn {
    fn then(self, other: Turn) -> Turn {
        Turn(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }

    fn back(self) -> Turn {
        Turn(self.0, -self.1)
    }
}

/// A path that leaves the first point at some angle.
struct Try {
    sin: f64,
    cos: f64,
    entry: Turn,
    chord: Turn,
    /// From the first point to the distance of the second.
    whole: Turn,
    /// Derivative of that by the angle of incidence.
    slope: f64,
}

/// Intervals in which roots are looked for, by the number of chords: without, the turn grows with the angle.
const INTERVALS: [u32; 3] = [1, 8, 8];
/// Steps of a search at most. Bisection alone would find a root to 2^-40 of the interval.
const STEPS: u32 = 40;
/// How exactly a root is found, as a sine of the turn.
const EXACT: f64 = 1e-14;

impl Ends {
    /// `None` unless both are outside the ball, and not in line with its centre.
    pub(super) fn new(ball: &Ball, from: DVec3, to: DVec3) -> Option<Ends> {
        let (x, y) = (from - ball.center, to - ball.center);
        let (distance_x, distance_y) = (x.length(), y.length());
        let slopes = [ball.radius / distance_x, ball.radius / distance_y];
        let (x, y) = (x / distance_x, y / distance_y);
        let across = y - x * x.dot(y);
        let sin = across.length();
        let apart = slopes[0] < 1.0 && slopes[1] < 1.0 && sin > 1e-9;
        apart.then(|| Ends { ball: *ball, slopes, angle: Turn(x.dot(y), sin), axes: [x, across / sin] })
    }

    /// Calls `found` with every path that has so many chords inside a ball of `ratio` = n outside / n inside < 1; with
    /// none, the path is reflected.
    pub(super) fn chains(&self, chords: u32, ratio: f64, mut found: impl FnMut(&Chain)) {
        let intervals = INTERVALS[chords as usize];
        let miss = |tried: &Try| [self.angle.back(), self.angle].map(|end| tried.whole.then(end));
        let mut low = miss(&self.attempt(0.0, chords, ratio));
        for k in 0..intervals {
            let ends = [k, k + 1].map(|k| f64::from(k) / f64::from(intervals));
            let high = miss(&self.attempt(ends[1], chords, ratio));
            for side in 0..2 {
                let (a, b) = (low[side], high[side]);
                // A turn that differs by half a turn has the sine 0, too.
                if (a.1 > 0.0) != (b.1 > 0.0) && a.0 + b.0 > 0.0 {
                    let end = if side == 0 { self.angle.back() } else { self.angle };
                    let tried = self.search(ends, a.1 > 0.0, end, chords, ratio);
                    if let Some(chain) = tried.and_then(|tried| self.chain(&tried, side)) {
                        found(&chain);
                    }
                }
            }
            low = high;
        }
    }

    /// The path with w = tan(i / 2).
    #[inline]
    fn attempt(&self, w: f64, chords: u32, ratio: f64) -> Try {
        let scale = 1.0 / (1.0 + w * w);
        let (sin, cos) = (2.0 * w * scale, (1.0 - w * w) * scale);
        let turn = |slope: f64| {
            let sine = slope * sin;
            Turn(((1.0 - sine) * (1.0 + sine)).sqrt(), sine)
        };
        let [x, y] = self.slopes.map(turn);
        let incidence = Turn(cos, sin);
        let entry = incidence.then(x.back());
        let mut whole = entry.then(incidence.then(y.back()));
        let mut slope = 2.0 - self.slopes[0] * cos / x.0 - self.slopes[1] * cos / y.0;
        let inside = turn(ratio);
        let chord = Turn(1.0 - 2.0 * inside.0 * inside.0, 2.0 * inside.0 * inside.1);
        for _ in 0..chords {
            whole = whole.then(chord);
            slope -= 2.0 * ratio * cos / inside.0;
        }
        Try { sin, cos, entry, chord, whole, slope }
    }

    /// The root in an interval at whose ends the sine has different signs: Newton's steps, and halves where they leave
    /// the interval.
    fn search(&self, ends: [f64; 2], above: bool, end: Turn, chords: u32, ratio: f64) -> Option<Try> {
        let [mut low, mut high] = ends;
        let mut w = 0.5 * (low + high);
        for _ in 0..STEPS {
            let tried = self.attempt(w, chords, ratio);
            let miss = tried.whole.then(end);
            if miss.1.abs() <= EXACT {
                return (miss.0 > 0.0).then_some(tried);
            }
            if (miss.1 > 0.0) == above {
                low = w
            } else {
                high = w
            }
            // The sine grows by its cosine times the turn, and the angle by 2 / (1 + w^2) times w.
            let step = miss.1 * (1.0 + w * w) / (2.0 * miss.0 * tried.slope);
            let next = w - step;
            w = if next > low && next < high { next } else { 0.5 * (low + high) };
        }
        None
    }

    fn chain(&self, tried: &Try, side: usize) -> Option<Chain> {
        let &Try { sin, cos, entry, chord, slope, .. } = tried;
        let [a, b] = self.slopes;
        let cosines = ((1.0 - a * sin) * (1.0 + a * sin) * (1.0 - b * sin) * (1.0 + b * sin)).sqrt();
        // A path at the angle alpha with the axis, sin alpha = a s, takes the solid angle sin(alpha) d(alpha) around it, and
        // passes the second point's distance in a ring of the solid angle sin(T) dT.
        let spread = a * a * sin * cos / (cosines * self.angle.1 * slope.abs());
        let side = if side == 0 { 1.0 } else { -1.0 };
        (spread > 0.0 && spread.is_finite()).then_some(Chain { sin, cos, side, spread, entry, chord })
    }

    /// The normals of the ball where a path with so many chords meets it, in order.
    pub(super) fn normals(&self, chain: &Chain, chords: u32) -> [DVec3; MOST_CHORDS as usize + 1] {
        let mut turn = chain.entry;
        let mut normals = [DVec3::ZERO; MOST_CHORDS as usize + 1];
        for normal in &mut normals[..=chords as usize] {
            *normal = self.axes[0] * turn.0 + self.axes[1] * (chain.side * turn.1);
            turn = turn.then(chain.chord);
        }
        normals
    }

    /// Whether a path that leaves the first point in the unit direction `direction` to meet the ball is `chain`.
    pub(super) fn is(&self, chain: &Chain, direction: DVec3) -> bool {
        let [axis, across] = self.axes;
        // Sine of the angle with the way to the centre.
        let sine = (direction + axis * -direction.dot(axis)).length() / self.slopes[0];
        (sine - chain.sin).abs() < SAME && direction.dot(across) * chain.side > 0.0
    }

    /// The ball.
    pub(super) fn ball(&self) -> &Ball {
        &self.ball
    }
}

/// Sines of the angle of incidence nearer than this are the same path: roundings of a path that was traced are far
/// smaller, and paths that meet are farther apart, but for a sliver beside a caustic's edge.
const SAME: f64 = 1e-6;
