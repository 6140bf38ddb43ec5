//! What a condensation cost.

/// Counts and wall time of a condensation, over all bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CondensationWork {
    /// Sparse factorisations, one per body, and one more where single precision was not enough.
    pub factorisations: usize,
    /// Factors in single precision (C32) that the bodies have.
    pub single_factors: usize,
    /// Why single precision was not enough, where it was tried in vain.
    pub fallback: Option<Fallback>,
    /// Rounds of (C24).
    pub corrections: usize,
    /// Pairs of substitutions for loads and given displacements, one per body.
    pub substitutions: usize,
    /// Unknowns of the supported bodies, contact unknowns included.
    pub unknowns: usize,
    /// Unknowns that the bodies are condensed onto: displacements of nodes on the contact surface, or
    /// what contacts see of them where that is less (C17).
    pub condensed_unknowns: usize,
    /// Stored entries of the factors L.
    pub factor_entries: usize,
    /// Bytes of these entries.
    pub factor_bytes: usize,
    /// Checks, contact surface, stiffness and load, in second.
    pub assembly_seconds: f64,
    /// Order of elimination, in second.
    pub ordering_seconds: f64,
    /// Factorisation, symbolic and numeric, in second.
    pub factorisation_seconds: f64,
    /// Its numeric part, in second.
    pub numeric_seconds: f64,
    /// Trailing block, compliance and free displacement, in second.
    pub condensation_seconds: f64,
}

impl CondensationWork {
    /// What it took in all, where the bodies were condensed again.
    pub(super) fn again(self, later: Self) -> Self {
        Self {
            factorisations: self.factorisations + later.factorisations,
            substitutions: self.substitutions + later.substitutions,
            corrections: self.corrections + later.corrections,
            assembly_seconds: self.assembly_seconds + later.assembly_seconds,
            ordering_seconds: self.ordering_seconds + later.ordering_seconds,
            factorisation_seconds: self.factorisation_seconds + later.factorisation_seconds,
            numeric_seconds: self.numeric_seconds + later.numeric_seconds,
            condensation_seconds: self.condensation_seconds + later.condensation_seconds,
            ..later
        }
    }
}

/// The sign by which a factor in single precision (C32) was given up for one in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fallback {
    /// A pivot is round-off or negative.
    Pivot {
        /// The pivot over its diagonal entry; NaN where the elimination stopped at it.
        part: f64,
    },
    /// Too few digits of the bodies.
    Residual {
        /// What the recovered bodies leave of their equations, over what acts, both in the norm of energy.
        part: f64,
    },
    /// Too few digits of G: the second correction changes the reactions too much beside the first.
    Contraction {
        /// The second change over the first.
        factor: f64,
    },
    /// The contacts were not solved under the G of single precision.
    Contacts,
}

impl std::fmt::Display for Fallback {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Pivot { part } => write!(f, "a pivot of {part:.1e} of its diagonal entry"),
            Self::Residual { part } => write!(f, "a first residual of {part:.1e}"),
            Self::Contraction { factor } => write!(f, "corrections that contract by {factor:.1e}"),
            Self::Contacts => write!(f, "contacts that were not solved"),
        }
    }
}
