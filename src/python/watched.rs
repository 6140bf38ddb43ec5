//! Work without the interpreter's lock, which Ctrl-C ends.
//!
//! The work has a thread of its own. The caller's, where signals arrive, looks for them from time to
//! time and raises the flag that the solve asks between half-steps and Newton steps.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use dpana::alternation::Interrupt;
use pyo3::prelude::*;

/// How long a signal may wait to be seen.
const GLANCE: Duration = Duration::from_millis(50);

/// Flags that no solve holds; they live as long as the program, so they are used again.
static IDLE: Mutex<Vec<&'static AtomicBool>> = Mutex::new(Vec::new());

/// The flag of a solve and of what is asked of its result, which remembers it.
pub(super) struct Flag(&'static AtomicBool);

impl Flag {
    pub(super) fn take() -> Self {
        let mut idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner);
        Self(idle.pop().unwrap_or_else(|| Box::leak(Box::default())))
    }
}

impl Drop for Flag {
    fn drop(&mut self) {
        let mut idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner);
        idle.push(self.0);
    }
}

/// Does the work; raises `KeyboardInterrupt` (or what else a signal raises) once it has come to an
/// end.
pub(super) fn watched<T: Send>(
    py: Python<'_>,
    flag: &Flag,
    work: impl FnOnce(Interrupt) -> T + Send,
) -> PyResult<T> {
    flag.0.store(false, Ordering::Relaxed);
    py.detach(|| {
        let (done, finished) = sync_channel(1);
        thread::scope(|scope| {
            let worker = scope.spawn(|| {
                let found = work(Interrupt::new(flag.0));
                // The other end is there until this thread has ended.
                let _ = done.send(());
                found
            });
            let mut signal = Ok(());
            while !worker.is_finished() {
                match finished.recv_timeout(GLANCE) {
                    Ok(()) | Err(RecvTimeoutError::Disconnected) => break,
                    Err(RecvTimeoutError::Timeout) if signal.is_ok() => {
                        signal = Python::attach(|py| py.check_signals());
                        flag.0.store(signal.is_err(), Ordering::Relaxed);
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                }
            }
            let found = worker.join().unwrap_or_else(|panic| resume_unwind(panic));
            signal.map(|()| found)
        })
    })
}
