//! Hertz' line contact: parallel cylinders, or a cylinder on a plane.

use std::f64::consts::PI;

use super::range::positive;
use crate::error::Error;

/// A frictionless line contact of half-planes (E3). Its approach is not defined: it grows with the
/// logarithm of the size of the bodies.
///
/// ```
/// use dpana::closed_forms::{Elastic, HertzLine};
///
/// # fn main() -> Result<(), dpana::Error> {
/// // A steel cylinder of radius 50 mm on aluminium, 35 kN per mm (NAFEMS 2006, no. 1); mm, N, MPa.
/// let steel = Elastic { young: 210e3, poisson: 0.3 };
/// let aluminium = Elastic { young: 70e3, poisson: 0.3 };
/// let hertz = HertzLine::new(35e3, 50.0, steel.contact_modulus(Some(aluminium))?)?;
/// assert!((hertz.half_width - 6.21463).abs() < 1e-5);
/// assert!((hertz.peak - 3585.36).abs() < 1e-2);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzLine {
    /// Load P, in newton per metre.
    pub load: f64,
    /// Half-width a of the contact, in metre.
    pub half_width: f64,
    /// Largest pressure p₀, in pascal.
    pub peak: f64,
}

impl HertzLine {
    /// Under a load P per metre, for the composite radius R in metre and modulus E* in pascal.
    /// It holds for `a ≪ R`.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] unless all three are positive.
    pub fn new(load: f64, radius: f64, modulus: f64) -> Result<Self, Error> {
        let load = positive("load", load)?;
        let (radius, modulus) = (positive("radius", radius)?, positive("modulus", modulus)?);
        let half_width = (4.0 * load * radius / (PI * modulus)).sqrt();
        let peak = 2.0 * load / (PI * half_width);
        Ok(Self {
            load,
            half_width,
            peak,
        })
    }

    /// Pressure at a distance from the middle, in pascal; zero outside the contact.
    #[must_use]
    pub fn pressure(&self, x: f64) -> f64 {
        self.peak * (1.0 - (x / self.half_width).powi(2)).max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::quadrature::{assert_close, over_width};
    use super::*;

    #[test]
    fn konters_cylinder_has_the_published_width_and_peak() {
        // NAFEMS Konter 2006 no. 1: a = 6.21463 mm, p₀ = 3585.36 MPa, to half of the last digit.
        let hertz = HertzLine::new(35e3, 50.0, 57_692.307_692_3).unwrap();
        assert_close(hertz.half_width, 6.21463, 1e-6);
        assert_close(hertz.peak, 3585.36, 1e-6);
    }

    #[test]
    fn the_pressure_carries_the_load_and_spreads_by_a_quarter_of_its_width_squared() {
        let hertz = HertzLine::new(3.0, 7.0, 11.0).unwrap();
        let a = hertz.half_width;
        assert_close(over_width(a, |x| hertz.pressure(x)), 3.0, 1e-11);
        let moment = over_width(a, |x| x * x * hertz.pressure(x));
        assert_close(moment, 3.0 * a * a / 4.0, 1e-11);
        assert_eq!(hertz.pressure(1.01 * a), 0.0);
    }

    #[test]
    fn what_is_not_positive_is_refused() {
        assert!(HertzLine::new(0.0, 1.0, 1.0).is_err());
        assert!(HertzLine::new(1.0, f64::INFINITY, 1.0).is_err());
        assert!(HertzLine::new(1.0, 1.0, f64::NAN).is_err());
    }
}
