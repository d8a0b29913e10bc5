//! Long calls without the interpreter, which still hear Ctrl-C.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use pyo3::prelude::*;

/// How often signals are looked for.
const PAUSE: Duration = Duration::from_millis(50);

/// Does `work` on another thread, without the interpreter, until it ends; Ctrl-C sets the flag that it is handed, at which it
/// should end soon, and is raised then. `heard` is called now and then, with the interpreter, and can end the work by an error, too.
pub(crate) fn interruptible<T: Send>(
    py: Python<'_>,
    heard: impl Fn(Python<'_>) -> PyResult<()> + Sync,
    work: impl FnOnce(&AtomicBool) -> T + Send,
) -> PyResult<T> {
    let stop = AtomicBool::new(false);
    let outcome = py.detach(|| {
        std::thread::scope(|scope| {
            let (ended, end) = channel::<()>();
            let worker = scope.spawn(|| {
                // Dropped at the end, in a panic, too.
                let _ended = ended;
                work(&stop)
            });
            let mut asked = Ok(());
            while let Err(RecvTimeoutError::Timeout) = end.recv_timeout(PAUSE) {
                if asked.is_ok() {
                    asked = Python::attach(|py| py.check_signals().and_then(|()| heard(py)));
                    stop.store(asked.is_err(), Ordering::Relaxed);
                }
            }
            asked.map(|()| worker.join())
        })
    });
    match outcome? {
        Ok(done) => Ok(done),
        Err(panic) => resume_unwind(panic),
    }
}
