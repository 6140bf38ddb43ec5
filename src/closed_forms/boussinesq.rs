//! Boussinesq's point force on a half-space: what any normal load looks like from afar.

use std::f64::consts::PI;

use super::Elastic;
use super::range::{not_negative, positive};
use crate::error::Error;

/// A normal force at a point of the surface (E12).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boussinesq {
    /// P/(4 π G), in m².
    strength: f64,
    poisson: f64,
}

impl Boussinesq {
    /// Of a force P in newton that presses on a half-space of the material.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a force that is not positive or a material that is none.
    pub fn new(load: f64, material: Elastic) -> Result<Self, Error> {
        let compliance = material.check()?.shear_compliance();
        Ok(Self {
            strength: positive("load", load)? * compliance / (4.0 * PI),
            poisson: material.poisson,
        })
    }

    /// Displacement `[u_r, u_z]` away from the axis and into the half-space, in metre, at a distance
    /// from the axis and a depth, in metre; it vanishes far away.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] unless both are not negative, and at the point of the force.
    pub fn displacement(&self, r: f64, depth: f64) -> Result<[f64; 2], Error> {
        let (r, z) = (not_negative("r", r)?, not_negative("depth", depth)?);
        let rho = positive("distance from the force", r.hypot(z))?;
        let (cube, poisson) = (rho.powi(3), self.poisson);
        let u_r = r * z / cube - (1.0 - 2.0 * poisson) * r / (rho * (rho + z));
        let u_z = z * z / cube + 2.0 * (1.0 - poisson) / rho;
        Ok([u_r, u_z].map(|u| self.strength * u))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::quadrature::assert_close;
    use super::*;

    const MATERIAL: Elastic = Elastic {
        young: 2.6,
        poisson: 0.3,
    };

    #[test]
    fn the_surface_moves_as_in_the_influence_formulas() {
        // G = 1: u_z = (1 − ν) P/(2 π G r), u_r = −(1 − 2ν) P/(4 π G r).
        let force = Boussinesq::new(3.0, MATERIAL).unwrap();
        let [u_r, u_z] = force.displacement(2.0, 0.0).unwrap();
        assert_close(u_z, 0.7 * 3.0 / (2.0 * PI * 2.0), 1e-14);
        assert_close(u_r, -0.4 * 3.0 / (4.0 * PI * 2.0), 1e-14);
    }

    #[test]
    fn stress_across_the_depth_does_not_know_the_material() {
        // σ_z = −3 P z³/(2 π ρ⁵), from differences of the displacement; G = 1, λ = 2 G ν/(1 − 2ν).
        let force = Boussinesq::new(3.0, MATERIAL).unwrap();
        let u = |r, z| force.displacement(r, z).unwrap();
        // Differences of a function of 1/ρ are off by (step/ρ)², 1e-7 at most, times some third derivative.
        let step = 1e-4;
        for [r, z] in [[0.5, 1.0], [1.0, 0.3], [2.0, 2.0]] {
            let radial = (u(r + step, z)[0] - u(r - step, z)[0]) / (2.0 * step);
            let along = (u(r, z + step)[1] - u(r, z - step)[1]) / (2.0 * step);
            let dilatation = radial + u(r, z)[0] / r + along;
            let found = 1.5 * dilatation + 2.0 * along;
            let exact = -3.0 * 3.0 * z.powi(3) / (2.0 * PI * r.hypot(z).powi(5));
            assert_close(found, exact, 1e-6);
        }
    }

    #[test]
    fn the_point_of_the_force_and_what_lies_above_the_surface_are_refused() {
        let force = Boussinesq::new(3.0, MATERIAL).unwrap();
        assert!(force.displacement(0.0, 0.0).is_err());
        assert!(force.displacement(1.0, -1.0).is_err());
        assert!(force.displacement(f64::NAN, 1.0).is_err());
        assert!(Boussinesq::new(0.0, MATERIAL).is_err());
    }
}
