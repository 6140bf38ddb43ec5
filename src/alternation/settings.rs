//! What a caller may choose. Nothing here has to be tuned.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::Shortfall;
use crate::error::Error;

/// Settings of the outer loop.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Settings {
    /// Largest residual that counts as solved.
    pub tolerance: f64,
    /// Sweeps after which the solve gives up.
    pub max_sweeps: usize,
    /// Time after which a solve gives up with its best state; it is asked between half-steps and
    /// Newton steps, and ends none of them.
    pub time_limit: Option<Duration>,
    /// Ends a solve from elsewhere, with its best state.
    pub interrupt: Option<Interrupt>,
}

/// A flag that ends solves once it is raised, as by a signal or another thread.
#[derive(Clone, Copy, Debug)]
pub struct Interrupt(&'static AtomicBool);

impl Interrupt {
    /// Watches a flag.
    #[must_use]
    pub const fn new(flag: &'static AtomicBool) -> Self {
        Self(flag)
    }

    /// Whether the flag is raised.
    #[must_use]
    pub fn is_raised(self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl PartialEq for Interrupt {
    /// Whether both watch the same flag.
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.0, other.0)
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-12,
            max_sweeps: 100,
            time_limit: None,
            interrupt: None,
        }
    }
}

impl Settings {
    /// The settings with a tolerance of their own, `1e-15 <= tolerance <= 1e-2`.
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// The settings with another largest number of sweeps, at least 1.
    #[must_use]
    pub fn with_max_sweeps(mut self, max_sweeps: usize) -> Self {
        self.max_sweeps = max_sweeps;
        self
    }

    /// Checks the ranges.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] naming the field and its range.
    pub fn validate(&self) -> Result<(), Error> {
        if !(1e-15..=1e-2).contains(&self.tolerance) {
            return Err(Error::OutOfRange {
                place: "settings.tolerance".into(),
                value: self.tolerance,
                accepted: "1e-15 <= tolerance <= 1e-2",
            });
        }
        if self.max_sweeps == 0 {
            return Err(Error::OutOfRange {
                place: "settings.max_sweeps".into(),
                value: 0.0,
                accepted: "max_sweeps >= 1",
            });
        }
        Ok(())
    }
}

/// How long a solve may still go on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    end: Option<Instant>,
    interrupt: Option<Interrupt>,
}

impl Clock {
    pub(super) fn start(settings: &Settings) -> Self {
        let end = |limit| Instant::now().checked_add(limit);
        Self {
            end: settings.time_limit.and_then(end),
            interrupt: settings.interrupt,
        }
    }

    /// Of what has no settings of its own.
    pub(super) const fn endless() -> Self {
        Self {
            end: None,
            interrupt: None,
        }
    }

    /// Why the solve ends here, if it does.
    pub(super) fn over(self) -> Option<Shortfall> {
        if self.interrupt.is_some_and(Interrupt::is_raised) {
            return Some(Shortfall::Interrupted);
        }
        let late = self.end.is_some_and(|end| Instant::now() >= end);
        late.then_some(Shortfall::TimeLimit)
    }
}
