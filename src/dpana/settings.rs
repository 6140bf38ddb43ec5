//! What a caller may choose. Nothing here has to be tuned.

use crate::error::Error;

/// Which outer loop runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Variant {
    /// Prediction, accelerated sweeps on working sets, Newton finish.
    #[default]
    Default,
    /// Unaccelerated sweeps with full programs at tight tolerance, for study.
    Plain,
    /// Projected block Gauss–Seidel on all contacts, the baseline, for study.
    Nsgs,
}

/// Settings of the outer loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Largest natural-map residual that counts as solved.
    pub tolerance: f64,
    /// Sweeps (or Gauss–Seidel passes) after which the solve gives up.
    pub max_sweeps: usize,
    /// Which outer loop runs.
    pub variant: Variant,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-12,
            max_sweeps: 100,
            variant: Variant::Default,
        }
    }
}

impl Settings {
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
