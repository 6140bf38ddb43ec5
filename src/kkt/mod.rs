//! JUDGE: how far a contact state is from satisfying the laws of the original problem.
//!
//! It shares no code with the solver: it never sees a cone program or a sweep, only
//! the problem and a reaction. Its [`Certificate`] decides when a solve may stop.

use crate::condensation::ContactProblem;

/// What a contact does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ContactStatus {
    /// No reaction.
    Open,
    /// Pressed, and the reaction is inside the friction disc (or the slip vanishes).
    Stick,
    /// Pressed, and slipping at the edge of the friction disc.
    Slip,
}

/// A residual with the contact where it is worst.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Worst {
    /// Size of the violation in physical units, never negative.
    pub value: f64,
    /// The same, divided by the load's scale of that unit.
    pub scaled: f64,
    /// Contact where it happens.
    pub contact: usize,
}

/// Every law on the original problem, measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certificate {
    /// Natural-map residual, relative to the reaction with a load-scale floor; the stopping test.
    pub natural_map: f64,
    /// Largest `u_N − g₀ > 0`, in metre (L1).
    pub penetration: Worst,
    /// Largest `t_N > 0`, in newton (L1).
    pub tension: Worst,
    /// Largest `|t_N (u_N − g₀)|`, in joule (L1).
    pub complementarity: Worst,
    /// Largest `‖t_T‖ + μ t_N > 0`, in newton (L2).
    pub disc_excess: Worst,
    /// Largest `|−μ t_N ‖u_T‖ + t_T · u_T|`, in joule (L3).
    pub dissipation_defect: Worst,
    /// `η = Σ [t_N (u_N − g₀) + t_T · u_T − μ t_N ‖u_T‖]`, in joule.
    pub bipotential_gap: f64,
    /// `½ t · G t`, in joule: what `bipotential_gap` is compared with.
    pub reaction_energy: f64,
}

/// A contact state and its certificate.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Displacement `u = û + G t` per unknown, in metre.
    pub displacement: Vec<f64>,
    /// What each contact does.
    pub status: Vec<ContactStatus>,
    /// The residuals.
    pub certificate: Certificate,
}

/// The judge of one problem; scales are computed once.
#[derive(Clone, Debug)]
pub struct Judge<'a> {
    problem: &'a ContactProblem,
}

impl<'a> Judge<'a> {
    /// A judge for `problem`.
    #[must_use]
    pub fn new(problem: &'a ContactProblem) -> Self {
        Self { problem }
    }

    /// Measures every law for a reaction, in newton per unknown.
    #[must_use]
    pub fn measure(&self, reaction: &[f64]) -> Verdict {
        todo!("{reaction:?} {}", self.problem.contacts())
    }
}
