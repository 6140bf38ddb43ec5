//! Processor time of this process.

use std::fs;
use std::time::Instant;

/// Processor time of all threads so far, in second, up to a tick of the system; where the system does not tell it, the
/// time since `start`.
pub(crate) fn processor(start: Instant) -> f64 {
    let Ok(threads) = fs::read_dir("/proc/self/task") else {
        return start.elapsed().as_secs_f64();
    };
    let nanoseconds = threads.flatten().filter_map(|thread| {
        let text = fs::read_to_string(thread.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    });
    nanoseconds.sum::<f64>() * 1e-9
}
