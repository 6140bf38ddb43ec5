//! Hertz' point contact: spheres, or a sphere on a plane.

use std::f64::consts::PI;

use super::range::positive;
use crate::error::Error;

/// A frictionless point contact of half-spaces (E4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzSphere {
    /// Load P, in newton.
    pub load: f64,
    /// Radius a of the contact, in metre.
    pub contact_radius: f64,
    /// Largest pressure p₀, in pascal.
    pub peak: f64,
    /// Approach δ of points far from the contact, in metre.
    pub approach: f64,
}

impl HertzSphere {
    /// Under a load P in newton, for the composite radius R in metre and modulus E* in pascal.
    /// It holds for `a ≪ R`.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] unless all three are positive.
    pub fn new(load: f64, radius: f64, modulus: f64) -> Result<Self, Error> {
        let load = positive("load", load)?;
        let (radius, modulus) = (positive("radius", radius)?, positive("modulus", modulus)?);
        let a = (3.0 * load * radius / (4.0 * modulus)).cbrt();
        Ok(Self {
            load,
            contact_radius: a,
            peak: 3.0 * load / (2.0 * PI * a * a),
            approach: a * a / radius,
        })
    }

    /// Pressure at a distance from the middle, in pascal; zero outside the contact.
    #[must_use]
    pub fn pressure(&self, r: f64) -> f64 {
        self.peak * (1.0 - (r / self.contact_radius).powi(2)).max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::quadrature::{assert_close, over_disc};
    use super::*;

    #[test]
    fn steel_under_a_sphere_has_the_reference_numbers() {
        // E = 2.1e5, ν = 0.3, rigid sphere R = 10, P = 1000; computed independently.
        let hertz = HertzSphere::new(1000.0, 10.0, 2.1e5 / 0.91).unwrap();
        // Half a unit of the last digit that is printed there.
        assert!((hertz.contact_radius - 0.319_125_21).abs() <= 5e-9);
        assert!((hertz.peak - 4688.3405).abs() <= 5e-5);
        assert!((hertz.approach - 0.010_184_090).abs() <= 5e-10);
    }

    #[test]
    fn the_pressure_carries_the_load_and_the_load_is_the_work_of_the_approach() {
        let of = |load| HertzSphere::new(load, 7.0, 11.0).unwrap();
        let hertz = of(3.0);
        let carried = over_disc(hertz.contact_radius, |r| hertz.pressure(r));
        assert_close(carried, 3.0, 1e-8);
        // P = (4/3) E* √R δ^(3/2).
        let force = 4.0 / 3.0 * 11.0 * 7.0_f64.sqrt() * hertz.approach.powf(1.5);
        assert_close(force, 3.0, 1e-14);
        assert_eq!(hertz.pressure(1.01 * hertz.contact_radius), 0.0);
    }

    #[test]
    fn what_is_not_positive_is_refused() {
        assert!(HertzSphere::new(-1.0, 1.0, 1.0).is_err());
        assert!(HertzSphere::new(1.0, 0.0, 1.0).is_err());
        assert!(HertzSphere::new(1.0, 1.0, f64::NAN).is_err());
    }
}
