//! What the materials of two half-spaces leave in the compliance of their surfaces.

use super::range::check_range;
use crate::error::{Error, check_finite};

/// An isotropic elastic half-space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticHalf {
    /// Young's modulus, in Pa.
    pub young: f64,
    /// Poisson's ratio, from 0 to 0.5.
    pub poisson: f64,
}

impl ElasticHalf {
    fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    fn check(&self, place: &str) -> Result<(), Error> {
        check_finite(place, &[self.young, self.poisson])?;
        let young = (1e-50..=1e50).contains(&self.young);
        let accepted = "young > 0, from 1e-50 to 1e50";
        check_range(format!("{place}.young"), self.young, young, accepted)?;
        let poisson = (0.0..=0.5).contains(&self.poisson);
        let accepted = "0 <= poisson <= 0.5";
        check_range(format!("{place}.poisson"), self.poisson, poisson, accepted)
    }
}

/// Surface compliance of one half-space on a rigid body, or of two on each other; all in 1/Pa.
///
/// ```text
/// direct   = Σ (1 − ν)/G              = 2/E*
/// lateral  = Σ ν/G
/// coupling = (1 − 2ν₁)/G₁ − (1 − 2ν₂)/G₂       = 2 β · direct
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SurfaceCompliance {
    pub(super) direct: f64,
    pub(super) lateral: f64,
    pub(super) coupling: f64,
}

impl SurfaceCompliance {
    pub(super) fn new(one: ElasticHalf, other: Option<ElasticHalf>) -> Result<Self, Error> {
        one.check("half_space.material")?;
        let mut sum = Self::of(one);
        if let Some(other) = other {
            other.check("half_space.other")?;
            let of_other = Self::of(other);
            sum.direct += of_other.direct;
            sum.lateral += of_other.lateral;
            sum.coupling -= of_other.coupling;
        }
        // Two like bodies leave round-off of what cancels.
        if sum.coupling.abs() < 1e-14 * sum.direct {
            sum.coupling = 0.0;
        }
        Ok(sum)
    }

    /// |β|: what a pressure moves along the surface over what it moves along the normal (Dundurs).
    pub(super) fn dundurs(&self) -> f64 {
        0.5 * (self.coupling / self.direct).abs()
    }

    fn of(half: ElasticHalf) -> Self {
        let (poisson, shear) = (half.poisson, half.shear());
        Self {
            direct: (1.0 - poisson) / shear,
            lateral: poisson / shear,
            coupling: (1.0 - 2.0 * poisson) / shear,
        }
    }
}
