//! Settings of any kind, and what of them may change without a trace.

use crate::support::random::Random;
use pathtracer::accel::{BvhQuality, Isa, Precision, check_isa};
use pathtracer::render::{AccelKind, CHUNK, Settings};
use pathtracer::sampling::SamplerKind;

/// Settings of a whole small picture.
pub(super) fn any(random: &mut Random) -> Settings {
    let (width, height) = (1 + random.index(28) as u32, 1 + random.index(20) as u32);
    // Enough for blocks to stop, where that is soon done.
    let most = if width * height < 100 { 200 } else { 40 };
    let bounces = if random.chance(0.1) { 60 } else { 1 + random.index(12) as u32 };
    let settings = Settings {
        precision: Precision::Exact,
        chunk: if random.chance(0.3) { 1 + random.index(20) as u32 } else { CHUNK },
        seed: random.bits(),
        sampler: random.pick(&[SamplerKind::Sobol, SamplerKind::Independent]),
        light_sampling: random.chance(0.8),
        clamp: random.chance(0.2).then(|| random.power(-2.0, 3.0)),
        scramble_length: random.chance(0.3).then(|| 1 + random.index(20) as u32),
        error_estimate: random.chance(0.5),
        noise: random.chance(0.3).then(|| random.power(-2.0, 0.0)),
        features: random.chance(0.3),
        ..Settings::new(width, height, 1 + random.index(most) as u64, bounces)
    };
    elsewhere(&settings, random)
}

/// The same picture at another cost.
pub(super) fn elsewhere(settings: &Settings, random: &mut Random) -> Settings {
    let isa = random.pick(&[None, Some(Isa::Sse2), Some(Isa::Avx2), Some(Isa::Avx512)]);
    Settings {
        accel: random.pick(AccelKind::BUILT),
        isa: isa.filter(|&isa| check_isa(Some(isa)).is_ok()),
        bvh: random.pick(&BvhQuality::ALL),
        threads: random.pick(&[None, Some(1), Some(2), Some(5)]),
        tile: random.pick(&[None, Some(1), Some(8), Some(100)]),
        ..settings.clone()
    }
}
