//! What factorises the bodies, and the factor of one.

use faer::Mat;

use super::factor::{Factor, Precision};
use super::mumps::{Divided, RankMemory};
use crate::body::Body;

/// What factorises the stiffness of bodies; the contact problem is the same up to round-off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Engine {
    /// The crate's own factors on all threads of one process.
    #[default]
    Faer,
    /// MUMPS on the processes that [`Ranks`](super::Ranks) joins, under the feature `mumps`.
    Mumps,
}

/// The engine for a body, with the precision that is wanted; where ranks assemble the body, with it and its number in the scene.
#[derive(Clone, Copy)]
pub(super) enum By<'a> {
    Faer(Precision),
    Mumps(&'a Body, usize),
}

/// The factor that joins a body to its interface.
#[derive(Debug)]
pub(super) enum BodyFactor {
    Faer(Factor),
    Mumps(Divided),
}

impl BodyFactor {
    /// The one that is here as a whole, and over no border.
    pub(super) fn plain(&self) -> Option<&Factor> {
        match self {
            Self::Faer(factor) if !factor.is_bordered() => Some(factor),
            _ => None,
        }
    }

    /// Number of contact unknowns or rows of the border.
    pub(super) fn contact_unknowns(&self) -> usize {
        match self {
            Self::Faer(factor) => factor.contact_unknowns(),
            Self::Mumps(factor) => factor.contact_unknowns(),
        }
    }

    /// Stored entries of L.
    pub(super) fn entries(&self) -> usize {
        match self {
            Self::Faer(factor) => factor.entries(),
            Self::Mumps(factor) => factor.entries(),
        }
    }

    /// Bytes of them.
    pub(super) fn bytes(&self) -> usize {
        let each = match self {
            Self::Faer(factor) => factor.precision(),
            Self::Mumps(_) => Precision::Double,
        };
        self.entries() * each.bytes()
    }

    /// G of the interface, in m/N; to be asked once.
    pub(super) fn compliance(&mut self) -> Mat<f64> {
        match self {
            Self::Faer(factor) => factor.compliance(),
            Self::Mumps(factor) => factor.take_compliance(),
        }
    }

    /// `L_cc` of (C2), where it is here in double precision.
    pub(super) fn trailing_block(&self) -> Option<Mat<f64>> {
        self.plain().and_then(Factor::trailing_block)
    }

    /// v̂ of (C17) in metre, over a border; `force` in newton becomes what [`Self::displacement_under`] takes.
    pub(super) fn border_displacement(&self, force: &mut Vec<f64>) -> Vec<f64> {
        match self {
            Self::Faer(factor) => factor.border_displacement(force),
            Self::Mumps(factor) => factor.free_displacement(force),
        }
    }

    /// u of (C17) in metre, over a border; forces in newton.
    pub(super) fn displacement_under(&self, half_solved: &[f64], forces: &[f64]) -> Vec<f64> {
        match self {
            Self::Faer(factor) => factor.displacement_under(half_solved, forces),
            Self::Mumps(factor) => factor.displacement_under(half_solved, forces),
        }
    }

    /// Memory per rank; empty where there are none.
    pub(super) fn memory(&self) -> &[RankMemory] {
        match self {
            Self::Faer(_) => &[],
            Self::Mumps(factor) => factor.memory(),
        }
    }

    /// Why a solve failed, if one did.
    pub(super) fn failure(&self) -> Option<String> {
        match self {
            Self::Faer(_) => None,
            Self::Mumps(factor) => factor.failure(),
        }
    }
}
