//! What a render counted, in words: faults always, the rest unless `--quiet`.

use super::arguments::Job;
use super::console::{number, say};
use crate::render::{FIREFLY, Rendered};

/// Says what is not zero.
pub(super) fn report(job: &Job, rendered: &Rendered) {
    let counters = &rendered.counters;
    if counters.dropped > 0 {
        say(format_args!(
            "warning: {} samples were not finite or negative and count as black",
            counters.dropped
        ));
    }
    if counters.refused > 0 {
        say(format_args!("warning: {} rays were not finite and bring no light", counters.refused));
    }
    if !job.quiet {
        notes(rendered).iter().for_each(say);
    }
}

/// Says that components of pixels were too large for the picture's file, if any were: a fault, as others can't tell.
pub(super) fn report_cut(components: u64) {
    if components > 0 {
        say(format_args!(
            "warning: {components} components of pixels are brighter than the picture's numbers can say, and were \
             written as the largest one"
        ));
    }
}

/// What is no fault, but may be seen in the picture.
fn notes(rendered: &Rendered) -> Vec<String> {
    let counters = &rendered.counters;
    let percent = |share: f64| number(100.0 * share);
    let mut notes = Vec::new();
    if counters.self_hits > 0 {
        notes.push(format!(
            "note: {} hits can't be told from the surface that the ray left",
            counters.self_hits
        ));
    }
    if counters.cut_paths > 0 {
        let light = rendered.cut_light().map(|share| format!(", about {} % of the light", percent(share)));
        notes.push(format!(
            "note: the limit of bounces cut paths that carried {} % of the throughput{}",
            percent(rendered.cut_share()),
            light.unwrap_or_default()
        ));
    }
    if counters.fireflies > 0 {
        notes.push(format!(
            "note: {} fireflies: samples over {FIREFLY} times brighter than the mean of their pixel before them",
            counters.fireflies
        ));
    }
    if let (1.., Some(limit), Some(removed), Some(bias)) =
        (counters.clamped, rendered.clamp, rendered.clamp_removed(), rendered.clamp_bias())
    {
        notes.push(format!(
            "note: {} samples were clamped to {limit}, which took {} % of the light: {} off the picture's mean",
            counters.clamped,
            percent(bias),
            number(removed)
        ));
    }
    notes
}
