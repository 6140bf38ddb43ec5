//! One line on a terminal that says how far a long run is; nothing where nobody watches.

use std::io::{self, IsTerminal, Write};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use dpana::stage::{self, Stage};

/// How often the line is written anew.
const TICK: Duration = Duration::from_millis(200);

/// What takes less is not told of.
const SHORT: Duration = Duration::from_millis(500);

/// The line; it is wiped when this goes.
pub(crate) struct Progress {
    watched: bool,
    clock: Option<(Sender<String>, JoinHandle<()>)>,
}

impl Progress {
    /// A line on standard error, unless that is no terminal or the user wants it `quiet`.
    pub(crate) fn new(quiet: bool) -> Self {
        Self {
            watched: !quiet && io::stderr().is_terminal(),
            clock: None,
        }
    }

    /// The same line, which also tells the stages of a solve with their times.
    pub(crate) fn of_stages(quiet: bool) -> Self {
        let mut progress = Self::new(quiet);
        if progress.watched {
            let (sender, words) = mpsc::channel();
            let clock = thread::spawn(move || {
                let mut watch = Watch::new(Instant::now());
                loop {
                    match words.recv_timeout(TICK) {
                        Ok(words) => watch.words = words,
                        Err(RecvTimeoutError::Timeout) => {}
                        Err(RecvTimeoutError::Disconnected) => break,
                    }
                    if let Some(line) = watch.line(Instant::now(), &stage::progress()) {
                        write_line(&line);
                    }
                }
            });
            progress.clock = Some((sender, clock));
        }
        progress
    }

    /// Replaces what the line said.
    pub(crate) fn show(&self, text: &str) {
        match &self.clock {
            Some((sender, _)) => {
                // The thread ends after this one only.
                let _ = sender.send(text.to_owned());
            }
            None if self.watched => write_line(text),
            None => {}
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((sender, clock)) = self.clock.take() {
            drop(sender);
            // It only writes, and has nothing to say of how it ended.
            let _ = clock.join();
        }
        if self.watched {
            write_line("");
        }
    }
}

fn write_line(text: &str) {
    // A terminal that went away takes no line, and the run goes on without it.
    let _ = write!(io::stderr(), "\r\x1b[2K{text}");
}

/// What was seen of the stages so far.
struct Watch {
    words: String,
    began: Instant,
    stage: Stage,
    since: Instant,
    done: Vec<(Stage, Duration)>,
}

impl Watch {
    fn new(now: Instant) -> Self {
        Self {
            words: String::new(),
            began: now,
            stage: Stage::Assembly,
            since: now,
            done: Vec::new(),
        }
    }

    /// The line, once the run is long enough to be told of.
    fn line(&mut self, now: Instant, progress: &stage::Progress) -> Option<String> {
        if progress.stage != self.stage {
            self.done.push((self.stage, now - self.since));
            (self.stage, self.since) = (progress.stage, now);
        }
        if now - self.began < SHORT {
            return None;
        }
        let mut parts = Vec::new();
        if !self.words.is_empty() {
            parts.push(self.words.clone());
        }
        if progress.contacts > 0 {
            let gigabytes = progress.dense_bytes as f64 * 1e-9;
            parts.push(match gigabytes >= 0.05 {
                true => format!("{} contacts, {gigabytes:.1} GB", progress.contacts),
                false => format!("{} contacts", progress.contacts),
            });
        }
        if progress.rank_bytes > 0.0 {
            parts.push(format!("{:.2} GB on a rank", progress.rank_bytes * 1e-9));
        }
        let long = self.done.iter().filter(|(_, time)| *time >= SHORT);
        parts.extend(long.map(|(stage, time)| told(*stage, *time)));
        let mut current = told(self.stage, now - self.since);
        if self.stage == Stage::Sweeps && progress.sweeps > 0 {
            current += &format!(" ({}, residual {:.0e})", progress.sweeps, progress.residual);
        }
        parts.push(current);
        Some(parts.join(", "))
    }
}

fn told(stage: Stage, time: Duration) -> String {
    format!("{} {:.1} s", stage.name(), time.as_secs_f64())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_line_tells_size_stages_and_times() {
        let start = Instant::now();
        let after = |tenths: u64| start + Duration::from_millis(100 * tenths);
        let mut watch = Watch::new(start);
        let mut progress = stage::Progress {
            stage: Stage::Assembly,
            contacts: 0,
            dense_bytes: 0,
            rank_bytes: 0.0,
            sweeps: 0,
            residual: 0.0,
        };
        assert_eq!(watch.line(after(3), &progress), None);
        (progress.contacts, progress.dense_bytes) = (4800, 5_000_000_000);
        progress.stage = Stage::Factorisation;
        assert_eq!(
            watch.line(after(20), &progress).unwrap(),
            "4800 contacts, 5.0 GB, assembly 2.0 s, factorisation 0.0 s"
        );
        (progress.stage, progress.sweeps, progress.residual) = (Stage::Sweeps, 3, 2e-5);
        progress.rank_bytes = 2.5e8;
        watch.words = "step 2 of 9".to_owned();
        watch.line(after(50), &progress);
        assert_eq!(
            watch.line(after(60), &progress).unwrap(),
            "step 2 of 9, 4800 contacts, 5.0 GB, 0.25 GB on a rank, assembly 2.0 s, factorisation 3.0 s, \
             sweeps 1.0 s (3, residual 2e-5)"
        );
    }
}
