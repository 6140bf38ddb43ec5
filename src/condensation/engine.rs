//! What factorises the bodies, and the factor of one.

use faer::Mat;

use super::factor::Factor;
use super::mumps::{Divided, RankMemory};
use crate::body::Body;
use crate::error::Error;
use crate::problem::Operator;

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

/// The engine for a body; it needs the body and its number in the scene where ranks assemble it.
#[derive(Clone, Copy)]
pub(super) enum By<'a> {
    Faer,
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

    /// Wall time of the numeric factorisation, in second.
    pub(super) fn numeric_seconds(&self) -> f64 {
        match self {
            Self::Faer(factor) => factor.numeric_seconds,
            Self::Mumps(factor) => factor.numeric_seconds(),
        }
    }

    /// What the body is for its interface; to be asked once.
    pub(super) fn of_interface(&mut self) -> OfInterface {
        match self {
            Self::Faer(factor) if factor.is_bordered() => {
                OfInterface::Compliance(factor.border_compliance())
            }
            Self::Faer(factor) => OfInterface::Factor(factor.trailing_block()),
            Self::Mumps(factor) => OfInterface::Compliance(factor.take_compliance()),
        }
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

/// What a body is for its interface, as the factor gives it.
pub(super) enum OfInterface {
    /// `L_cc` of (C2).
    Factor(Mat<f64>),
    /// G of (C17).
    Compliance(Mat<f64>),
}

impl OfInterface {
    /// G; it costs a triangular inverse and half a product where there is a factor.
    pub(super) fn operator(self) -> Result<Operator, Error> {
        match self {
            Self::Factor(factor) => Ok(Operator::from_factor(factor)),
            Self::Compliance(compliance) => Operator::from_bodies(compliance),
        }
    }
}
