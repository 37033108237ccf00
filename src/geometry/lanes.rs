//! Arithmetic on eight f32 at once, in instructions that a value of type [`Lanes`] proves to be there.

/// A set of instructions. Every operation rounds to nearest, by itself: all sets give the same bits, except for which
/// operand `min` and `max` return if one is NaN.
pub(crate) trait Lanes: Copy {
    /// Eight numbers.
    type Floats: Copy;

    /// Eight numbers from memory.
    fn load(self, lanes: &[f32; 8]) -> Self::Floats;

    /// Eight numbers to memory.
    fn to_array(self, a: Self::Floats) -> [f32; 8];

    /// The same number eight times.
    fn splat(self, x: f32) -> Self::Floats;

    fn add(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn sub(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn mul(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn div(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn min(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn max(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn abs(self, a: Self::Floats) -> Self::Floats;

    /// A bit for every lane in which `a <= b`, from the lowest on; never if one is NaN.
    fn at_most(self, a: Self::Floats, b: Self::Floats) -> u32;
}

/// The instructions that everything is compiled with.
#[derive(Clone, Copy)]
pub(crate) struct Portable;

fn each(a: [f32; 8], b: [f32; 8], f: impl Fn(f32, f32) -> f32) -> [f32; 8] {
    std::array::from_fn(|lane| f(a[lane], b[lane]))
}

impl Lanes for Portable {
    type Floats = [f32; 8];

    fn load(self, lanes: &[f32; 8]) -> [f32; 8] {
        *lanes
    }

    fn to_array(self, a: [f32; 8]) -> [f32; 8] {
        a
    }

    fn splat(self, x: f32) -> [f32; 8] {
        [x; 8]
    }

    fn add(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        each(a, b, |a, b| a + b)
    }

    fn sub(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        each(a, b, |a, b| a - b)
    }

    fn mul(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        each(a, b, |a, b| a * b)
    }

    fn div(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        each(a, b, |a, b| a / b)
    }

    fn min(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        each(a, b, f32::min)
    }

    fn max(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        each(a, b, f32::max)
    }

    fn abs(self, a: [f32; 8]) -> [f32; 8] {
        a.map(f32::abs)
    }

    fn at_most(self, a: [f32; 8], b: [f32; 8]) -> u32 {
        (0..8).fold(0, |mask, lane| mask | u32::from(a[lane] <= b[lane]) << lane)
    }
}
