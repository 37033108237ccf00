//! `pathtracer compare SCENE`: both accelerators on the same rays.

use super::arguments::CompareJob;
use super::console::say;
use super::event::emit;
use super::studied;
use crate::geometry::Hit;
use crate::math::DVec3;
use crate::output::TextFile;
use crate::study::compare::{self, Comparison, PictureDifference, Side};
use crate::study::machine::Machine;
use crate::study::rounds::{Spread, geometric_mean};
use crate::study::table::{Figure, Table, counted, csv, grouped, short};
use crate::study::tally::{Answer, Difference, Tally};
use crate::study::verdict::Verdict;
use serde::Serialize;
use std::fmt::Write as _;
use std::io::{self, Write as _};

/// The exit code if hits or pictures differ that must not.
pub(super) const DIFFERENT: u8 = 4;

/// Compares; returns the exit code.
pub(super) fn run(job: &CompareJob) -> anyhow::Result<u8> {
    studied::keep([&job.scene], &job.csv)?;
    let file = job.csv.as_deref().map(TextFile::new).transpose()?;
    let (scene, world) = studied::load(&job.scene, job.options.recording.width, job.quiet)?;
    let tell = |doing: &str| {
        if !job.quiet {
            say(format_args!("{doing} ..."));
        }
    };
    let found = compare::run(&world, &scene.desc.camera, &job.options, &tell)?;
    if let Some(warning) = found.machine.warning().filter(|_| !job.quiet) {
        say(format_args!("warning: {warning}"));
    }
    let name = job.scene.to_string_lossy();
    let figures = found.figures(&name);
    if let Some(file) = file {
        file.write(&csv(&figures))?;
    }
    let code = if found.breaks_promise() { DIFFERENT } else { 0 };
    if job.json {
        emit_all(&name, &found, &figures, code);
    } else {
        // A reader that has gone away does not change the answer.
        let _ = write!(io::stdout(), "{}", report(&name, &found));
    }
    if code != 0 {
        say("error: hits or pictures differ at exact, which is a bug in this program");
    }
    Ok(code)
}

fn report(scene: &str, found: &Comparison) -> String {
    let precision = found.sides[0].kind.precision_name();
    let instances = match found.instances {
        0 => String::new(),
        count => format!(", {}", counted(count as u64, "instance")),
    };
    let mut text = format!(
        "{scene}: {}, {}{instances}; both at {precision}\n{}\n\n",
        counted(found.triangles as u64, "triangle"),
        counted(found.solids as u64, "solid"),
        found.machine.line(),
    );
    let _ = writeln!(text, "{}", hits(&found.tallies));
    let worst: String = found.tallies.iter().flat_map(|t| t.worst.iter().map(|d| difference(t, d))).collect();
    if !worst.is_empty() {
        let _ = writeln!(text, "the worst differences\n{worst}");
    }
    for (t, threads) in found.thread_counts().into_iter().enumerate() {
        let _ = writeln!(text, "{}", rates(found, t, threads));
    }
    let _ = writeln!(text, "{}", costs(found));
    let _ = writeln!(text, "{}", picture(&found.picture));
    text
}

fn hits(tallies: &[Tally]) -> Table {
    let mut table = Table::new([
        "hits",
        "rays",
        "hit %",
        "same",
        "tie",
        "edge",
        "other",
        "brute force on",
        "embree differs",
        "native differs",
    ]);
    for tally in tallies {
        let share = 100.0 * tally.hits[0] as f64 / tally.rays.max(1) as f64;
        let mut row = vec![tally.kind.name().to_owned(), grouped(tally.rays), format!("{share:.1}")];
        row.extend(Verdict::ALL.map(|verdict| grouped(tally.count(verdict))));
        row.push(grouped(tally.oracle.rays));
        row.extend(tally.oracle.differing.map(grouped));
        table.push(row);
    }
    table
}

fn difference(tally: &Tally, difference: &Difference) -> String {
    let Difference { verdict, query, answers } = difference;
    let before = if query.t_max.is_finite() { format!(" before {:?}", query.t_max) } else { String::new() };
    format!(
        "  {}, {} ray from {} along {}{before}\n    embree: {}\n    native: {}\n",
        verdict.name(),
        tally.kind.name(),
        point(query.ray.origin),
        point(query.ray.direction),
        answer(&answers[0]),
        answer(&answers[1])
    )
}

fn answer(answer: &Answer) -> String {
    match answer {
        Answer::Closest(None) => "no hit".to_owned(),
        Answer::Closest(Some(Hit { t, object, part, u, v, .. })) => {
            format!("object {object}, part {part}, t = {t:?}, u = {u:?}, v = {v:?}")
        }
        Answer::Occluded(true) => "in the way".to_owned(),
        Answer::Occluded(false) => "free".to_owned(),
    }
}

fn point(p: DVec3) -> String {
    format!("({:?} {:?} {:?})", p.x, p.y, p.z)
}

/// Rates of both sides; the ratio is that of the medians.
fn rates(found: &Comparison, t: usize, threads: usize) -> Table {
    let heading = format!("Mrays/s, {}", counted(threads as u64, "thread"));
    let mut table = Table::new([&heading, "embree", "min - max", "native", "min - max", "native / embree"]);
    let cells = |rate: &Spread| {
        let rate = rate.scaled(1e-6);
        [short(rate.median), format!("{} - {}", short(rate.min), short(rate.max))]
    };
    let [embree, native] = [0, 1].map(|side| &found.sides[side].rates[t]);
    for (tally, (a, b)) in found.tallies.iter().zip(embree.iter().zip(native)) {
        let [a_median, a_range] = cells(a);
        let [b_median, b_range] = cells(b);
        let ratio = format!("{:.2}", b.median / a.median);
        table.push([tally.kind.name().to_owned(), a_median, a_range, b_median, b_range, ratio]);
    }
    let mean = |rates: &[Spread]| geometric_mean(rates.iter().map(|rate| rate.median));
    let [a, b] = [mean(embree), mean(native)];
    let [a_cell, b_cell] = [a, b].map(|mean| short(mean * 1e-6));
    let ratio = format!("{:.2}", b / a);
    table.push(["geometric mean", &a_cell, "", &b_cell, "", &ratio]);
    table
}

fn costs(found: &Comparison) -> Table {
    let all = counted(found.machine.threads as u64, "thread");
    let mut table =
        Table::new(["building", "ms, 1 thread", "min - max", &all, "min - max", "bytes", "bytes/triangle"]);
    for Side { kind, build_seconds, bytes, .. } in &found.sides {
        let range = |seconds: &Spread| format!("{} - {}", short(seconds.min * 1e3), short(seconds.max * 1e3));
        let [one, all] = build_seconds;
        let per_triangle = match found.triangles {
            0 => "-".to_owned(),
            triangles => format!("{:.1}", *bytes as f64 / triangles as f64),
        };
        table.push([
            kind.accel_name().to_owned(),
            short(one.median * 1e3),
            range(one),
            short(all.median * 1e3),
            range(all),
            grouped(*bytes as u64),
            per_triangle,
        ]);
    }
    table
}

fn picture(picture: &PictureDifference) -> String {
    let PictureDifference { width, height, samples, differing, greatest, at } = picture;
    let size = format!("pictures of {width} x {height} pixels with {}", counted(*samples, "sample"));
    match differing {
        0 => format!("{size}: equal to the last bit"),
        _ => format!(
            "{size}: {} differ, by at most {greatest:.3e} at ({} {})",
            counted(*differing, "pixel"),
            at[0],
            at[1]
        ),
    }
}

/// A line of `--json`.
#[derive(Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
enum Event<'e> {
    Start {
        scene: &'e str,
        precision: &'static str,
        triangles: usize,
        solids: usize,
        instances: usize,
        machine: &'e Machine,
    },
    Hits(Hits),
    Difference(DifferenceRecord),
    Figure(&'e Figure),
    Picture {
        width: u32,
        height: u32,
        samples: u64,
        differing_pixels: u64,
        greatest_difference: f64,
        at: [u32; 2],
    },
    Done {
        differs: bool,
        code: u8,
    },
}

#[derive(Serialize)]
struct Hits {
    kind: &'static str,
    rays: u64,
    embree_hits: u64,
    native_hits: u64,
    same: u64,
    tie: u64,
    edge: u64,
    other: u64,
    brute_force_rays: u64,
    embree_differs: u64,
    native_differs: u64,
}

#[derive(Serialize)]
struct DifferenceRecord {
    kind: &'static str,
    verdict: &'static str,
    origin: [f64; 3],
    direction: [f64; 3],
    /// Null for infinite.
    t_max: Option<f64>,
    embree: AnswerRecord,
    native: AnswerRecord,
}

/// A closest hit or null, or whether anything is in the way.
#[derive(Serialize)]
#[serde(untagged)]
enum AnswerRecord {
    Closest(Option<HitRecord>),
    Occluded(bool),
}

#[derive(Serialize)]
struct HitRecord {
    object: u32,
    part: u32,
    t: f64,
    u: f64,
    v: f64,
}

impl From<&Answer> for AnswerRecord {
    fn from(answer: &Answer) -> AnswerRecord {
        match *answer {
            Answer::Occluded(occluded) => AnswerRecord::Occluded(occluded),
            Answer::Closest(hit) => {
                AnswerRecord::Closest(hit.map(|Hit { t, object, part, u, v, .. }| HitRecord {
                    object,
                    part,
                    t,
                    u,
                    v,
                }))
            }
        }
    }
}

fn emit_all(scene: &str, found: &Comparison, figures: &[Figure], code: u8) {
    let &Comparison { ref machine, triangles, solids, instances, .. } = found;
    let precision = found.sides[0].kind.precision_name();
    emit(&Event::Start { scene, precision, triangles, solids, instances, machine });
    for tally in &found.tallies {
        emit(&Event::Hits(Hits {
            kind: tally.kind.name(),
            rays: tally.rays,
            embree_hits: tally.hits[0],
            native_hits: tally.hits[1],
            same: tally.count(Verdict::Same),
            tie: tally.count(Verdict::Tie),
            edge: tally.count(Verdict::Edge),
            other: tally.count(Verdict::Other),
            brute_force_rays: tally.oracle.rays,
            embree_differs: tally.oracle.differing[0],
            native_differs: tally.oracle.differing[1],
        }));
        for Difference { verdict, query, answers } in &tally.worst {
            emit(&Event::Difference(DifferenceRecord {
                kind: tally.kind.name(),
                verdict: verdict.name(),
                origin: query.ray.origin.to_array(),
                direction: query.ray.direction.to_array(),
                t_max: Some(query.t_max).filter(|t| t.is_finite()),
                embree: (&answers[0]).into(),
                native: (&answers[1]).into(),
            }));
        }
    }
    figures.iter().for_each(|figure| emit(&Event::Figure(figure)));
    let PictureDifference { width, height, samples, differing, greatest, at } = found.picture;
    emit(&Event::Picture {
        width,
        height,
        samples,
        differing_pixels: differing,
        greatest_difference: greatest,
        at,
    });
    emit(&Event::Done { differs: found.differs(), code });
}
