//! What a condensation cost.

/// Counts and wall time of a condensation, over all bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CondensationWork {
    /// Sparse factorisations, one per body.
    pub factorisations: usize,
    /// Pairs of substitutions for loads and given displacements, one per body.
    pub substitutions: usize,
    /// Unknowns of the supported bodies, contact unknowns included.
    pub unknowns: usize,
    /// Unknowns that the bodies are condensed onto: displacements of nodes on the contact surface, or
    /// what contacts see of them where that is less (C17).
    pub condensed_unknowns: usize,
    /// Stored entries of the factors L.
    pub factor_entries: usize,
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
