//! Ctrl-C and the like: the first one asks the render to stop, the second one ends the program.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use signal_hook::low_level;
use std::fs;
use std::io;
use std::path::PathBuf;
use std::sync::atomic::{AtomicI32, Ordering};
use std::thread;

/// The first signal that came; zero before.
static FIRST: AtomicI32 = AtomicI32::new(0);

/// From now on [`exit_code`] tells whether a signal has come. The second one removes `partial`, files that may be half
/// written, and ends the program at once.
pub(super) fn listen(partial: Vec<PathBuf>) -> io::Result<()> {
    let mut signals = Signals::new([SIGINT, SIGTERM])?;
    thread::Builder::new().name("signals".into()).spawn(move || {
        for signal in signals.forever() {
            if FIRST.compare_exchange(0, signal, Ordering::Relaxed, Ordering::Relaxed).is_err() {
                // There may be none.
                partial.iter().for_each(|path| drop(fs::remove_file(path)));
                // Not `std::process::exit`, which would pull down libraries under the threads that use them.
                low_level::exit(128 + signal);
            }
        }
    })?;
    Ok(())
}

/// The exit code of a program that a signal has stopped (130 or 143), or `None` without one.
pub(super) fn exit_code() -> Option<u8> {
    match FIRST.load(Ordering::Relaxed) {
        0 => None,
        signal => u8::try_from(128 + signal).ok(),
    }
}
