//! Channels of a picture beside the light.

use crate::picture::{Channel, Samples};
use crate::render::{FeatureKind, Rendered};

/// What can be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aov {
    /// What is seen.
    Feature(FeatureKind),
    /// `samples`: how many the pixel has. With `--noise` they differ.
    Samples,
    /// `error`: the standard error of the mean of the pixel's components, as radiance.
    Error,
}

impl Aov {
    /// In the order in which they are listed to users.
    pub const ALL: [Aov; 7] = [
        Aov::Feature(FeatureKind::Albedo),
        Aov::Feature(FeatureKind::Normal),
        Aov::Feature(FeatureKind::Depth),
        Aov::Feature(FeatureKind::Position),
        Aov::Feature(FeatureKind::Object),
        Aov::Samples,
        Aov::Error,
    ];

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Aov::Feature(feature) => feature.name(),
            Aov::Samples => "samples",
            Aov::Error => "error",
        }
    }

    /// Its channels; none if they were not collected, or if the errors of the pixels are not known: these need samples in
    /// eight scrambles.
    pub fn channels(self, rendered: &Rendered) -> Vec<Channel> {
        let film = &rendered.film;
        let pixels = 0..film.pixels();
        let samples = match self {
            Aov::Feature(kind) => {
                return rendered.features.as_ref().map_or(Vec::new(), |features| features.channels(&[kind]));
            }
            Aov::Samples => {
                let count = |pixel| u32::try_from(film.samples_of(pixel)).unwrap_or(u32::MAX);
                Some(Samples::Integers(pixels.map(count).collect()))
            }
            Aov::Error => {
                let error = |pixel| {
                    let error = film.error_bar(pixel)?.standard_error;
                    Some(error.min(f64::from(f32::MAX)) as f32)
                };
                pixels.map(error).collect::<Option<_>>().map(Samples::Floats)
            }
        };
        let channel = |values| Channel { name: self.name().to_owned(), values };
        samples.map(channel).into_iter().collect()
    }
}
