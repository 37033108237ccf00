//! Ctrl-C and the like: while there are samples the first one asks the render to stop and the second one ends the program;
//! before, when nothing could be kept, the first one does.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use signal_hook::low_level;
use std::fs;
use std::io;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};
use std::thread;

/// The first signal that came; zero before.
static FIRST: AtomicI32 = AtomicI32::new(0);

/// Whether somebody asks for the first one.
static IS_ASKED_FOR: AtomicBool = AtomicBool::new(false);

/// From now on a signal removes `partial`, files that may be half written, and ends the program at once; after
/// [`ask_first`] the second one does.
pub(super) fn listen(partial: Vec<PathBuf>) -> io::Result<()> {
    let mut signals = Signals::new([SIGINT, SIGTERM])?;
    thread::Builder::new().name("signals".into()).spawn(move || {
        for signal in signals.forever() {
            let is_first = FIRST.compare_exchange(0, signal, Ordering::SeqCst, Ordering::SeqCst).is_ok();
            if !(is_first && IS_ASKED_FOR.load(Ordering::SeqCst)) {
                // There may be none.
                partial.iter().for_each(|path| drop(fs::remove_file(path)));
                // Not `std::process::exit`, which would pull down libraries under the threads that use them.
                low_level::exit(128 + signal);
            }
        }
    })?;
    Ok(())
}

/// From now on [`exit_code`] is asked whether a signal has come, and the first one does nothing else.
pub(super) fn ask_first() {
    IS_ASKED_FOR.store(true, Ordering::SeqCst);
}

/// The exit code of a program that a signal has stopped (130 or 143), or `None` without one.
pub(super) fn exit_code() -> Option<u8> {
    match FIRST.load(Ordering::SeqCst) {
        0 => None,
        signal => u8::try_from(128 + signal).ok(),
    }
}
