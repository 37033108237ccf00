//! When, how long and where a picture was made: what two equal renders do not share, written only when asked for.

use crate::picture::{Metadata, Value};
use std::fs;
use std::time::{SystemTime, UNIX_EPOCH};

/// Adds the time (UTC), the seconds of sampling, the threads and the name of the machine.
pub fn stamp(metadata: &mut Metadata, render_seconds: f64, threads: usize) {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    metadata.push("DateTime", Value::Text(date_time(now)));
    metadata.push("renderTimeSeconds", Value::Number(render_seconds));
    metadata.push("pathtracer:threads", Value::Text(threads.to_string()));
    if let Ok(host) = fs::read_to_string("/proc/sys/kernel/hostname") {
        metadata.push("HostComputer", Value::Text(host.trim_end().to_owned()));
    }
}

/// Seconds since 1970 as `YYYY:MM:DD hh:mm:ss`, the form of Exif and OpenEXR.
pub fn date_time(seconds: u64) -> String {
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    // Days to a date: eras of 400 years that begin in March (Hinnant, "chrono-Compatible Low-Level Date Algorithms").
    let z = days + 719_468;
    let (era, day) = (z / 146_097, z % 146_097);
    let year_of_era = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day_of_year = day - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * day_of_year + 2) / 153;
    let date = day_of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 { shifted + 3 } else { shifted - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    format!("{year:04}:{month:02}:{date:02} {:02}:{:02}:{:02}", rest / 3600, rest / 60 % 60, rest % 60)
}
