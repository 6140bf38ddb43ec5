//! A rigid flat punch without friction: pressure that grows without bound at its edge.

use std::f64::consts::PI;

use super::range::positive;
use crate::error::Error;

/// A long flat punch on a half-plane (E6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatLinePunch {
    /// Load P, in newton per metre.
    pub load: f64,
    /// Half-width a of the punch, in metre.
    pub half_width: f64,
}

impl FlatLinePunch {
    /// Under a load P per metre, of half-width a in metre.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] unless both are positive.
    pub fn new(load: f64, half_width: f64) -> Result<Self, Error> {
        Ok(Self {
            load: positive("load", load)?,
            half_width: positive("half_width", half_width)?,
        })
    }

    /// Pressure at a distance from the middle, in pascal; infinite at the edge, zero beyond.
    #[must_use]
    pub fn pressure(&self, x: f64) -> f64 {
        beneath(self.half_width, x, self.load / PI)
    }
}

/// A round flat punch on a half-space (E6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatRoundPunch {
    /// Load P, in newton.
    pub load: f64,
    /// Radius a of the punch, in metre.
    pub radius: f64,
    /// Depth δ to which it sinks, in metre.
    pub approach: f64,
}

impl FlatRoundPunch {
    /// For the modulus E* of the half-space, in pascal.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] unless all three are positive.
    pub fn new(load: f64, radius: f64, modulus: f64) -> Result<Self, Error> {
        let (load, radius) = (positive("load", load)?, positive("radius", radius)?);
        let approach = load / (2.0 * radius * positive("modulus", modulus)?);
        Ok(Self {
            load,
            radius,
            approach,
        })
    }

    /// Pressure at a distance from the middle, in pascal; infinite at the edge, zero beyond.
    #[must_use]
    pub fn pressure(&self, r: f64) -> f64 {
        beneath(self.radius, r, self.load / (2.0 * PI * self.radius))
    }
}

/// `factor`/√(a² − x²) below the punch.
fn beneath(a: f64, x: f64, factor: f64) -> f64 {
    if x.abs() > a {
        return 0.0;
    }
    factor / ((a - x) * (a + x)).sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::quadrature::{assert_close, over_disc, over_width};
    use super::*;

    #[test]
    fn the_pressures_carry_the_load() {
        let line = FlatLinePunch::new(3.0, 2.0).unwrap();
        assert_close(over_width(2.0, |x| line.pressure(x)), 3.0, 1e-10);
        let round = FlatRoundPunch::new(3.0, 2.0, 11.0).unwrap();
        assert_close(over_disc(2.0, |r| round.pressure(r)), 3.0, 1e-8);
        assert_eq!((line.pressure(2.1), round.pressure(-2.1)), (0.0, 0.0));
        assert!(line.pressure(2.0).is_infinite());
    }

    #[test]
    fn the_middle_sinks_as_deep_as_boussinesq_says() {
        // u_z(0) = ∫ p/(π E* r) dA = (1/(π E*)) ∫ p 2π dr.
        let round = FlatRoundPunch::new(3.0, 2.0, 11.0).unwrap();
        let sunk = over_width(2.0, |r| round.pressure(r)) / 11.0;
        assert_close(round.approach, sunk, 1e-10);
    }

    #[test]
    fn what_is_not_positive_is_refused() {
        assert!(FlatLinePunch::new(1.0, 0.0).is_err());
        assert!(FlatRoundPunch::new(f64::NAN, 1.0, 1.0).is_err());
        assert!(FlatRoundPunch::new(1.0, 1.0, -1.0).is_err());
    }
}
