//! Light to the bytes of a screen, as fast as a window needs it and with the bits of [`crate::output`].

use crate::output::{quantize, srgb_encode};
use std::sync::LazyLock;

/// Cells of equal width in 0..1, each of which begins with a known byte.
const CELLS: usize = 4096;

/// Where the bytes change.
struct Tone {
    /// The smallest light of each byte; the first is 0.
    thresholds: [f64; 256],
    /// The byte of the light where each cell begins.
    cells: Vec<u8>,
}

static TONE: LazyLock<Tone> = LazyLock::new(|| {
    let mut thresholds = [0.0; 256];
    for (byte, threshold) in (0..=255u8).zip(&mut thresholds).skip(1) {
        *threshold = smallest(byte);
    }
    let at = |cell: usize| quantize(srgb_encode(cell as f64 / CELLS as f64));
    Tone { thresholds, cells: (0..CELLS).map(at).collect() }
});

/// The smallest light that is shown by a byte or one above it. The bits of numbers above 0 are in their order.
fn smallest(byte: u8) -> f64 {
    let (mut below, mut at) = (0, 1.0f64.to_bits());
    while at - below > 1 {
        let middle = below + (at - below) / 2;
        if quantize(srgb_encode(f64::from_bits(middle))) >= byte {
            at = middle;
        } else {
            below = middle;
        }
    }
    f64::from_bits(at)
}

/// The byte that shows light: the sRGB curve of 0..1.
pub fn byte(light: f64) -> u8 {
    if light >= 1.0 {
        return 255;
    }
    // Not a number is black too.
    if light.is_nan() || light <= 0.0 {
        return 0;
    }
    let tone = &*TONE;
    let mut byte = tone.cells[(light * CELLS as f64) as usize];
    while byte < 255 && light >= tone.thresholds[byte as usize + 1] {
        byte += 1;
    }
    byte
}
