//! What another thread sends once.

use std::sync::mpsc::{Receiver, TryRecvError};

/// What has come: `None` as long as nothing has, `Some(None)` where the thread ended without a word.
pub(super) fn take<T>(coming: &mut Option<Receiver<T>>) -> Option<Option<T>> {
    let received = coming.as_ref()?.try_recv();
    if matches!(received, Err(TryRecvError::Empty)) {
        return None;
    }
    *coming = None;
    Some(received.ok())
}
