//! JUDGE: how far a contact state is from satisfying the laws of the original problem.
//!
//! ```text
//! (L1)  t_N ≤ 0,   u_N − g₀ ≤ 0,   t_N (u_N − g₀) = 0            Signorini
//! (L2)  ‖t_T‖ ≤ −μ t_N                                          Coulomb's disc
//! (L3)  −μ t_N ‖u_T‖ + t_T · u_T = 0                            slip opposes friction
//!
//! (K1)  r_N = t_N − min(0, t_N − ρ_N (u_N − g₀))                natural map, and
//!       r_T = t_T − P_disc(t_T − ρ_T u_T)                       ‖r‖ / max(‖t‖, floor)
//! (K2)  f = (w·w / w·G w) w,   w = û + interference             load force, 1000 × floor
//! (K3)  η = Σ [t_N (u_N − g₀) + t_T · u_T − μ t_N ‖u_T‖]        bipotential gap
//! (K4)  K u = f + contact and support reactions                 equilibrium of the body
//! ```
//!
//! It shares no code with the solver: it never sees a cone program or a sweep, only
//! the problem and a reaction, and computes `u = û + G t` itself. Its [`Certificate`]
//! decides when a solve may stop; [`balance`](balance()) looks at the whole body.

mod bipotential;
mod certificate;
mod coulomb;
mod natural_map;
mod scales;
mod signorini;
mod state;

pub use certificate::{Certificate, ContactStatus, Verdict, Worst};

use crate::condensation::ContactProblem;
use certificate::ratio;
use natural_map::{largest, norm};
use scales::{Scales, compliance_product, dot};
use state::{ContactState, contact_states};

/// The judge of one problem; scales are computed once.
#[derive(Clone, Debug)]
pub struct Judge<'a> {
    problem: &'a ContactProblem,
    scales: Scales,
}

impl<'a> Judge<'a> {
    /// A judge for `problem`.
    #[must_use]
    pub fn new(problem: &'a ContactProblem) -> Self {
        let scales = Scales::new(problem);
        Self { problem, scales }
    }

    /// Measures every law for a reaction, in newton per unknown.
    ///
    /// A reaction that is not finite, or not of the problem's length, is no state of this
    /// problem: displacement and residuals are then infinite, never small.
    #[must_use]
    pub fn measure(&self, reaction: &[f64]) -> Verdict {
        if reaction.len() != self.problem.unknowns() || largest(reaction).is_infinite() {
            return self.no_state();
        }
        let response = compliance_product(self.problem.compliance(), reaction);
        let free = self.problem.free_displacement();
        let displacement: Vec<f64> = free.iter().zip(&response).map(|(a, b)| a + b).collect();
        let states = contact_states(self.problem, reaction, &displacement);
        let steps = self.scales.steps.iter();
        Verdict {
            status: steps
                .zip(&states)
                .map(|(step, state)| step.status(state))
                .collect(),
            certificate: self.certificate(reaction, &response, &states),
            displacement,
        }
    }

    fn certificate(
        &self,
        reaction: &[f64],
        response: &[f64],
        states: &[ContactState],
    ) -> Certificate {
        let force = largest(reaction).max(self.scales.force);
        let length = largest(response).max(self.scales.length);
        let energy = force * length;
        let (signorini, coulomb) = (
            signorini::signorini_residual(states),
            coulomb::coulomb_residual(states),
        );
        Certificate {
            natural_map: self.natural_map(reaction, states),
            penetration: signorini.penetration.over(length),
            tension: signorini.tension.over(force),
            complementarity: signorini.complementarity.over(energy),
            disc_excess: coulomb.disc_excess.over(force),
            dissipation_defect: coulomb.dissipation_defect.over(energy),
            bipotential_gap: bipotential::bipotential_gap(states),
            reaction_energy: 0.5 * dot(reaction, response),
        }
    }

    /// `‖r‖₂` of (K1), relative to the reaction and, where that vanishes, to the load (K2).
    fn natural_map(&self, reaction: &[f64], states: &[ContactState]) -> f64 {
        let steps = self.scales.steps.iter().zip(states);
        let residual: Vec<f64> = steps
            .flat_map(|(step, state)| step.residual(state))
            .collect();
        ratio(norm(&residual), norm(reaction).max(self.scales.force_norm))
    }

    fn no_state(&self) -> Verdict {
        let worst = Worst {
            value: f64::INFINITY,
            scaled: f64::INFINITY,
            contact: 0,
        };
        Verdict {
            displacement: vec![f64::INFINITY; self.problem.unknowns()],
            status: vec![ContactStatus::Open; self.problem.contacts()],
            certificate: Certificate {
                natural_map: f64::INFINITY,
                penetration: worst,
                tension: worst,
                complementarity: worst,
                disc_excess: worst,
                dissipation_defect: worst,
                bipotential_gap: f64::INFINITY,
                reaction_energy: f64::INFINITY,
            },
        }
    }
}
