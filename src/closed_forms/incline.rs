//! A block on an incline under its weight.

use super::range::{not_negative, positive};
use crate::error::Error;

/// A block of weight W on a slope of tangent tan α (E11); of any stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incline {
    /// Force N across the slope, in newton.
    pub normal: f64,
    /// Force T along the slope, in newton.
    pub tangential: f64,
    slope: f64,
}

impl Incline {
    /// From W in newton and tan α.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] unless `W > 0` and `tan α >= 0`.
    pub fn new(weight: f64, slope: f64) -> Result<Self, Error> {
        let weight = positive("weight", weight)?;
        let slope = not_negative("slope", slope)?;
        let normal = weight / 1.0_f64.hypot(slope);
        Ok(Self {
            normal,
            tangential: slope * normal,
            slope,
        })
    }

    /// Whether friction holds it, unless it tips.
    #[must_use]
    pub fn sticks(&self, friction: f64) -> bool {
        self.slope <= friction
    }

    /// Whether it tips over its lower edge; width is along the slope, height across, in metre.
    #[must_use]
    pub fn tips(&self, width: f64, height: f64) -> bool {
        self.slope * height > width
    }

    /// Friction that is missing to hold it, in newton; zero if it sticks.
    #[must_use]
    pub fn missing(&self, friction: f64) -> f64 {
        (self.tangential - friction * self.normal).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::quadrature::assert_close;
    use super::*;

    #[test]
    fn the_forces_are_the_legs_of_the_weight() {
        // 3 : 4 : 5.
        let block = Incline::new(10.0, 0.75).unwrap();
        assert_close(block.normal, 8.0, 1e-15);
        assert_close(block.tangential, 6.0, 1e-15);
        assert_close(block.missing(0.5), 2.0, 1e-15);
        assert_eq!(block.missing(0.75), 0.0);
    }

    #[test]
    fn it_sticks_to_the_angle_of_friction_and_tips_beyond_its_diagonal() {
        let block = Incline::new(10.0, 0.5).unwrap();
        assert!(block.sticks(0.5) && !block.sticks(0.499));
        assert!(block.tips(1.0, 2.01) && !block.tips(1.0, 2.0));
    }

    #[test]
    fn a_slope_that_is_none_is_refused() {
        assert!(Incline::new(0.0, 0.5).is_err() && Incline::new(1.0, f64::NAN).is_err());
        assert!(Incline::new(1.0, -0.1).is_err());
    }
}
