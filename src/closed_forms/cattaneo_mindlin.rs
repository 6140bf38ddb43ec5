//! Cattaneo's and Mindlin's partial slip: a Hertz contact pressed first, then pulled sideways.

use super::range::{not_negative, positive, within};
use super::{HertzLine, HertzSphere};
use crate::error::Error;

/// Shear of a contact that sticks in its middle and slips around it (E5).
///
/// The load P comes first and stays, then Q grows. It is exact for bodies that do not couple
/// ([`Elastic::dundurs_beta`](super::Elastic::dundurs_beta) zero), for spheres only if also ν = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CattaneoMindlin {
    /// Half-width or radius a of the contact, in metre.
    pub contact_radius: f64,
    /// Half-width or radius c of the part that sticks, over a.
    pub stick_ratio: f64,
    /// μ p₀, the friction that the largest pressure can hold, in pascal.
    pub bound: f64,
}

impl CattaneoMindlin {
    /// Of a line contact, n = 1/2 in (E5); Q in newton per metre.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] unless `μ > 0` and `0 <= Q < μ P`.
    pub fn line(hertz: &HertzLine, friction: f64, tangential: f64) -> Result<Self, Error> {
        Ok(Self {
            contact_radius: hertz.half_width,
            stick_ratio: unused(hertz.load, friction, tangential)?.sqrt(),
            bound: friction * hertz.peak,
        })
    }

    /// Of a point contact, n = 1/3 in (E5); Q in newton.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] unless `μ > 0` and `0 <= Q < μ P`.
    pub fn sphere(hertz: &HertzSphere, friction: f64, tangential: f64) -> Result<Self, Error> {
        Ok(Self {
            contact_radius: hertz.contact_radius,
            stick_ratio: unused(hertz.load, friction, tangential)?.cbrt(),
            bound: friction * hertz.peak,
        })
    }

    /// Shear at a distance from the middle, in pascal, along Q.
    #[must_use]
    pub fn shear(&self, x: f64) -> f64 {
        let (a, c) = (self.contact_radius, self.stick_ratio * self.contact_radius);
        let root = |radius: f64| (radius * radius - x * x).max(0.0).sqrt();
        self.bound / a * (root(a) - root(c))
    }
}

/// How far a point contact's bodies move past each other far from it, along Q, in metre (E5):
/// Mindlin's δ_t, for a tangential load Q in newton and the bodies'
/// [`Elastic::tangential_compliance`](super::Elastic::tangential_compliance) Θ in 1/Pa.
///
/// # Errors
///
/// [`Error::OutOfRange`] unless `μ > 0`, `0 <= Q < μ P` and `Θ > 0`.
pub fn mindlin_displacement(
    hertz: &HertzSphere,
    friction: f64,
    tangential: f64,
    compliance: f64,
) -> Result<f64, Error> {
    let unused = unused(hertz.load, friction, tangential)?;
    let compliance = positive("compliance", compliance)?;
    let most = 3.0 * friction * hertz.load * compliance / (16.0 * hertz.contact_radius);
    Ok(most * (1.0 - unused.cbrt().powi(2)))
}

/// 1 − Q/(μ P).
fn unused(load: f64, friction: f64, tangential: f64) -> Result<f64, Error> {
    let most = positive("friction", friction)? * load;
    let tangential = not_negative("tangential", tangential)?;
    let accepted = "0 <= Q < friction × load";
    within("tangential", tangential, tangential < most, accepted)?;
    Ok(1.0 - tangential / most)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    // The tables have five digits, whatever number they are of.
    #![allow(clippy::approx_constant)]
    use super::super::quadrature::{assert_close, over_disc, over_width};
    use super::*;

    /// Q/(μP), c/a of the sphere, c/a of the line; computed independently.
    const RATIOS: [[f64; 3]; 4] = [
        [0.25, 0.90856, 0.86603],
        [0.5, 0.79370, 0.70711],
        [0.75, 0.62996, 0.5],
        [0.9, 0.46416, 0.31623],
    ];

    #[test]
    fn the_part_that_sticks_shrinks_as_tabulated_and_the_shear_carries_the_load() {
        let (line, sphere) = (
            HertzLine::new(3.0, 7.0, 11.0).unwrap(),
            HertzSphere::new(3.0, 7.0, 11.0).unwrap(),
        );
        for [part, of_sphere, of_line] in RATIOS {
            let pull = part * 0.4 * 3.0;
            let plane = CattaneoMindlin::line(&line, 0.4, pull).unwrap();
            let round = CattaneoMindlin::sphere(&sphere, 0.4, pull).unwrap();
            assert!((plane.stick_ratio - of_line).abs() < 5.1e-6);
            assert!((round.stick_ratio - of_sphere).abs() < 5.1e-6);
            let carried = over_width(line.half_width, |x| plane.shear(x));
            assert_close(carried, pull, 1e-5);
            let carried = over_disc(sphere.contact_radius, |r| round.shear(r));
            assert_close(carried, pull, 1e-5);
        }
    }

    #[test]
    fn where_it_slips_the_shear_is_friction_times_pressure() {
        let line = HertzLine::new(3.0, 7.0, 11.0).unwrap();
        let found = CattaneoMindlin::line(&line, 0.4, 0.9).unwrap();
        let (c, a) = (found.stick_ratio * line.half_width, line.half_width);
        for x in [1.001 * c, 0.5 * (a + c), 0.999 * a] {
            // Differences of squares leave 13 digits at 0.999 a; the rest of the room is a guard.
            assert_close(found.shear(x), 0.4 * line.pressure(x), 1e-9);
        }
        assert!(found.shear(0.5 * c) < 0.4 * line.pressure(0.5 * c));
        assert_eq!(found.shear(1.1 * a), 0.0);
        let none = CattaneoMindlin::line(&line, 0.4, 0.0).unwrap();
        assert_eq!((none.stick_ratio, none.shear(0.3 * a)), (1.0, 0.0));
    }

    #[test]
    fn the_middle_moves_as_under_the_point_forces_of_its_shear() {
        // A point force Q moves the surface by u_x = Q/(2πG) [(1 − ν)/r + ν x²/r³]; over a shear
        // that depends on r alone, in the middle: (2 − ν)/(2G) ∫ q dr on each side.
        let (friction, compliance) = (0.4, 0.7);
        let sphere = HertzSphere::new(3.0, 7.0, 11.0).unwrap();
        for part in [0.1, 0.5, 0.9] {
            let pull = part * friction * sphere.load;
            let exact = CattaneoMindlin::sphere(&sphere, friction, pull).unwrap();
            let across = over_width(exact.contact_radius, |x| exact.shear(x.abs()));
            let found = mindlin_displacement(&sphere, friction, pull, compliance).unwrap();
            assert_close(found, compliance / 2.0 * across / 2.0, 1e-5);
        }
        // As long as hardly anything slips: δ_t = Q Θ/(8 a).
        let little = mindlin_displacement(&sphere, friction, 1e-6, compliance).unwrap();
        let stuck = 1e-6 * compliance / (8.0 * sphere.contact_radius);
        // Slip adds the part Q/(6 μ P), and the difference that gives it loses six digits.
        assert_close(little, stuck, 1e-6);
        assert!(mindlin_displacement(&sphere, friction, 1.3, compliance).is_err());
        assert!(mindlin_displacement(&sphere, friction, 1.0, 0.0).is_err());
    }

    #[test]
    fn a_pull_beyond_friction_is_refused() {
        let line = HertzLine::new(3.0, 7.0, 11.0).unwrap();
        for (friction, pull) in [(0.4, 1.3), (0.0, 0.0), (0.4, -0.1), (0.4, f64::NAN)] {
            assert!(CattaneoMindlin::line(&line, friction, pull).is_err());
        }
    }
}
