//! What two touching bodies are to each other: composite moduli, composite radius, coupling.

use super::range::{positive, within};
use crate::error::Error;

/// An isotropic elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    /// Young's modulus `E > 0`, in pascal.
    pub young: f64,
    /// Poisson's ratio, `-1 < ν <= 0.5`.
    pub poisson: f64,
}

impl Elastic {
    pub(super) fn check(self) -> Result<Self, Error> {
        positive("young", self.young)?;
        let accept = self.poisson > -1.0 && self.poisson <= 0.5;
        within("poisson", self.poisson, accept, "-1 < poisson <= 0.5")?;
        Ok(self)
    }

    /// Composite modulus E* of a body on another one, or on a rigid one (`None`), in pascal (E1).
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a material that is none.
    pub fn contact_modulus(self, other: Option<Self>) -> Result<f64, Error> {
        let mut compliance = self.check()?.plane_compliance();
        if let Some(other) = other {
            compliance += other.check()?.plane_compliance();
        }
        Ok(1.0 / compliance)
    }

    /// Tangential compliance Θ of a body on another one, or on a rigid one (`None`), in 1/Pa (E1).
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a material that is none.
    pub fn tangential_compliance(self, other: Option<Self>) -> Result<f64, Error> {
        let of = |material: Elastic| -> Result<f64, Error> {
            let material = material.check()?;
            Ok((2.0 - material.poisson) * material.shear_compliance())
        };
        Ok(of(self)? + other.map_or(Ok(0.0), of)?)
    }

    /// Dundurs' β, how far pressure makes slip and friction a gap (E2); dimensionless, positive where
    /// the first body gives more sideways. It is zero for two bodies of one material, and
    /// `(1 − 2ν)/(2(1 − ν))` against a rigid one (`None`).
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a material that is none.
    pub fn dundurs_beta(self, other: Option<Self>) -> Result<f64, Error> {
        let terms = |material: Elastic| {
            let compliance = material.shear_compliance();
            let poisson = material.poisson;
            [1.0 - 2.0 * poisson, 1.0 - poisson].map(|factor| factor * compliance)
        };
        let [mut across, mut along] = terms(self.check()?);
        if let Some(other) = other {
            let [of_across, of_along] = terms(other.check()?);
            across -= of_across;
            along += of_along;
        }
        Ok(across / (2.0 * along))
    }

    /// `(1 − ν²)/E`, in 1/Pa.
    fn plane_compliance(self) -> f64 {
        (1.0 - self.poisson * self.poisson) / self.young
    }

    /// `1/G = 2 (1 + ν)/E`, in 1/Pa.
    pub(super) fn shear_compliance(self) -> f64 {
        2.0 * (1.0 + self.poisson) / self.young
    }
}

/// Composite radius R of two convex surfaces, in metre (E1); infinite for a plane, negative for a
/// hollow one.
///
/// # Errors
///
/// [`Error::OutOfRange`] for a radius that is zero or NaN, and where `1/R₁ + 1/R₂` is not positive.
#[cfg(feature = "cli")]
pub(crate) fn contact_radius(one: f64, other: f64) -> Result<f64, Error> {
    let curved = |place, radius: f64| {
        let accept = radius != 0.0 && !radius.is_nan();
        Ok(1.0 / within(place, radius, accept, "a radius, not zero")?)
    };
    let curvature = curved("one", one)? + curved("other", other)?;
    Ok(1.0 / positive("1/one + 1/other", curvature)?)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::quadrature::assert_close;
    use super::*;

    const STEEL: Elastic = Elastic {
        young: 210e3,
        poisson: 0.3,
    };
    const ALUMINIUM: Elastic = Elastic {
        young: 70e3,
        poisson: 0.3,
    };

    #[test]
    fn steel_on_aluminium_has_the_modulus_of_the_benchmark() {
        // NAFEMS Konter 2006 no. 1: E* = 57692.31 MPa.
        let found = STEEL.contact_modulus(Some(ALUMINIUM)).unwrap();
        // Half of the last digit.
        assert_close(found, 57692.31, 1e-7);
        assert_close(
            STEEL.contact_modulus(None).unwrap(),
            210e3 / (1.0 - 0.09),
            1e-15,
        );
    }

    #[test]
    fn tangential_compliance_is_that_of_both_bodies() {
        // ν = 0, E = 2: G = 1 and Θ = 2 on each side.
        let cork = Elastic {
            young: 2.0,
            poisson: 0.0,
        };
        assert_close(cork.tangential_compliance(Some(cork)).unwrap(), 4.0, 1e-15);
        let steel = 1.7 * 2.6 / 210e3;
        assert_close(STEEL.tangential_compliance(None).unwrap(), steel, 1e-14);
    }

    #[test]
    fn a_sphere_in_a_socket_has_the_difference_of_curvatures() {
        assert_close(contact_radius(10.0, f64::INFINITY).unwrap(), 10.0, 1e-15);
        assert_close(contact_radius(10.0, 10.0).unwrap(), 5.0, 1e-15);
        assert_close(contact_radius(10.0, -12.0).unwrap(), 60.0, 1e-14);
        assert!(contact_radius(10.0, -10.0).is_err() && contact_radius(0.0, 1.0).is_err());
    }

    #[test]
    fn coupling_vanishes_for_one_material_and_changes_sign_with_the_order() {
        assert_eq!(STEEL.dundurs_beta(Some(STEEL)).unwrap(), 0.0);
        let found = STEEL.dundurs_beta(Some(ALUMINIUM)).unwrap();
        assert_eq!(ALUMINIUM.dundurs_beta(Some(STEEL)).unwrap(), -found);
        // One ν on both sides: (1−2ν)/(2(1−ν)) · (E₂ − E₁)/(E₂ + E₁) = 2/7 · (−1/2).
        assert_close(found, -1.0 / 7.0, 1e-14);
    }

    #[test]
    fn a_rigid_side_leaves_the_limit_of_a_stiff_one() {
        let stiff = Elastic {
            young: 210e15,
            poisson: 0.1,
        };
        let rigid = STEEL.dundurs_beta(None).unwrap();
        assert_close(rigid, 0.4 / 1.4, 1e-15);
        // A million million times as stiff.
        assert_close(STEEL.dundurs_beta(Some(stiff)).unwrap(), rigid, 1e-11);
    }

    #[test]
    fn a_material_that_is_none_is_refused() {
        for (young, poisson) in [(0.0, 0.3), (f64::NAN, 0.3), (1.0, 0.6), (1.0, f64::NAN)] {
            let none = Elastic { young, poisson };
            assert!(none.contact_modulus(None).is_err());
            assert!(none.tangential_compliance(Some(STEEL)).is_err());
            assert!(STEEL.tangential_compliance(Some(none)).is_err());
            assert!(STEEL.dundurs_beta(Some(none)).is_err());
        }
    }
}
