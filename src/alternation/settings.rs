//! What a caller may choose. Nothing here has to be tuned.

use crate::error::Error;

/// Which outer loop runs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Variant {
    /// Prediction, accelerated sweeps on working sets, Newton finish.
    #[default]
    Default,
    /// Sweeps of full programs without prediction, for study.
    Sweeps(Sweeps),
    /// Fixed point of one program over all Coulomb cones (H8), for study.
    FullCone,
    /// Projected block Gauss–Seidel on all contacts, the baseline, for study.
    Nsgs,
}

impl Variant {
    /// Unaccelerated exact sweeps: the alternation itself.
    pub const PLAIN: Self = Self::Sweeps(Sweeps {
        mixing: Mixing::None,
        exact: true,
        finish: false,
    });
}

/// How sweeps are run for study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweeps {
    /// What follows the normal half-step.
    pub mixing: Mixing,
    /// Half-steps to the last digit (D6); else tied to the outer residual.
    pub exact: bool,
    /// A Newton finish after every sweep.
    pub finish: bool,
}

/// How the normal reaction is taken on from sweep to sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mixing {
    /// As the half-step left it.
    None,
    /// This part of the way to it, in (0, 1].
    Relaxed(f64),
    /// By Anderson acceleration.
    Anderson,
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
        if let Variant::Sweeps(Sweeps {
            mixing: Mixing::Relaxed(part),
            ..
        }) = self.variant
            && !(part > 0.0 && part <= 1.0)
        {
            return Err(Error::OutOfRange {
                place: "settings.variant: relaxed".into(),
                value: part,
                accepted: "0 < part <= 1",
            });
        }
        Ok(())
    }
}
