//! The judge of a contact problem: every law, for one reaction after the other.

use super::bipotential::bipotential_gap;
use super::certificate::{Certificate, ContactStatus, Defect, Verdict, Worst, ratio};
use super::coulomb::coulomb_residual;
use super::depth::{Place, deep_place};
use super::floating::unanswered;
use super::natural_map::{largest, largest_block, norm};
use super::scales::{Scales, compliance_product, dot, local_force};
use super::signorini::signorini_residual;
use super::state::{ContactState, contact_states};
use crate::problem::ContactProblem;

/// A residual below this needs no more digits than plain sums have.
const SEEN: f64 = 1e-13;

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

    /// Measures every law for a reaction, in newton per unknown, between bodies that are held.
    ///
    /// A reaction that is not finite, or not of the problem's length, is no state of this
    /// problem: displacement and residuals are then infinite, never small.
    #[must_use]
    pub fn measure(&self, reaction: &[f64]) -> Verdict {
        self.measure_floating(reaction, &[])
    }

    /// Measures every law for a reaction and a rigid motion, in metre per free mode (C3).
    ///
    /// What [`measure`](Self::measure) says of a reaction holds for the motion as well. Where plain
    /// sums leave no more than their own rounding, displacements are summed in twice the digits.
    #[must_use]
    pub fn measure_floating(&self, reaction: &[f64], motion: &[f64]) -> Verdict {
        self.measure_moved(reaction, motion, &vec![0.0; motion.len()])
    }

    /// The same with what the rounding of a motion left out, in metre per free mode: bodies that move far beside
    /// what their contacts indent have no motion of double precision that answers the laws to the last digits.
    #[must_use]
    pub fn measure_moved(&self, reaction: &[f64], motion: &[f64], left_out: &[f64]) -> Verdict {
        let modes = self.problem.free_modes();
        let fits = reaction.len() == self.problem.unknowns()
            && (motion.len(), left_out.len()) == (modes, modes);
        let size = largest(reaction)
            .max(largest(motion))
            .max(largest(left_out));
        if !fits || size.is_infinite() {
            return self.no_state();
        }
        let response = compliance_product(self.problem.compliance(), reaction);
        let rigid = self.rigid_displacement(motion);
        let free = self.problem.free_displacement().iter();
        let moved = free.zip(&response).zip(&rigid);
        let place = Place::of(self.problem, moved.map(|((a, b), c)| a + b + c).collect());
        let plain = self.verdict(reaction, &response, place);
        let measured = plain.certificate.natural_map;
        let rounded = self.rounding(reaction);
        let moved = self.motion_rounding(reaction, &rigid);
        let seen = measured <= SEEN && moved <= SEEN;
        if seen || measured > rounded + moved {
            return plain;
        }
        let deep = deep_place(self.problem, reaction, [motion, left_out]);
        self.verdict(reaction, &response, deep)
    }

    /// What the rounding of every `t` alone may leave of the natural map: no reaction of double
    /// precision has a residual that is surely smaller.
    #[must_use]
    pub fn round_off(&self, reaction: &[f64]) -> f64 {
        let mut moved = vec![0.0; reaction.len()];
        let columns = self.problem.compliance().col_iter().zip(reaction);
        for (column, t) in columns.filter(|(_, t)| **t != 0.0) {
            for (moved, entry) in moved.iter_mut().zip(column.iter()) {
                *moved += (entry * t).abs();
            }
        }
        let forces = local_force(self.problem.offsets(), &moved, &self.scales.steps);
        0.5 * f64::EPSILON * ratio(norm(&forces), self.size(reaction))
    }

    /// What plain sums may leave of the natural map by rounding.
    fn rounding(&self, reaction: &[f64]) -> f64 {
        let terms = self.problem.unknowns() as f64;
        terms * f64::EPSILON * ratio(self.scales.terms, self.size(reaction))
    }

    /// The same of the sum over the free modes, and of the gaps that it closes.
    fn motion_rounding(&self, reaction: &[f64], rigid: &[f64]) -> f64 {
        let moved = local_force(self.problem.offsets(), rigid, &self.scales.steps);
        let terms = 2.0 + self.problem.free_modes() as f64;
        terms * f64::EPSILON * ratio(norm(&moved), self.size(reaction))
    }

    /// What residuals in newton are relative to.
    fn size(&self, reaction: &[f64]) -> f64 {
        norm(reaction).max(self.scales.force_norm)
    }

    /// `R α`, in metre per unknown.
    fn rigid_displacement(&self, motion: &[f64]) -> Vec<f64> {
        let mut rigid = vec![0.0; self.problem.unknowns()];
        if let Some(floating) = self.problem.floating() {
            for (mode, amplitude) in floating.modes().col_iter().zip(motion) {
                for (u, r) in rigid.iter_mut().zip(mode.iter()) {
                    *u += r * amplitude;
                }
            }
        }
        rigid
    }

    fn verdict(&self, reaction: &[f64], response: &[f64], place: Place) -> Verdict {
        let states = contact_states(self.problem, reaction, &place.beyond);
        let steps = self.scales.steps.iter();
        Verdict {
            status: steps
                .zip(&states)
                .map(|(step, state)| step.status(state))
                .collect(),
            certificate: self.certificate(reaction, response, &states),
            displacement: place.displacement,
            beyond: place.beyond,
        }
    }

    fn certificate(
        &self,
        reaction: &[f64],
        response: &[f64],
        states: &[ContactState],
    ) -> Certificate {
        let offsets = self.problem.offsets();
        let force = largest_block(offsets, reaction).max(self.scales.force);
        let length = largest_block(offsets, response).max(self.scales.length);
        let energy = force * length;
        let (signorini, coulomb) = (signorini_residual(states), coulomb_residual(states));
        Certificate {
            natural_map: self.natural_map(reaction, states),
            equilibrium: self
                .problem
                .floating()
                .map_or_else(Defect::default, |floating| {
                    let (modes, load) = (floating.modes(), floating.load());
                    unanswered(modes, (load, floating.sizes()), (offsets, reaction))
                }),
            penetration: signorini.penetration.over(length),
            tension: signorini.tension.over(force),
            complementarity: signorini.complementarity.over(energy),
            disc_excess: coulomb.disc_excess.over(force),
            dissipation_defect: coulomb.dissipation_defect.over(energy),
            bipotential_gap: bipotential_gap(states),
            reaction_energy: 0.5 * dot(reaction, response),
        }
    }

    /// `‖r‖₂` of (K1), relative to the reaction and, where that vanishes, to the load (K2).
    fn natural_map(&self, reaction: &[f64], states: &[ContactState]) -> f64 {
        let steps = self.scales.steps.iter().zip(states);
        let residual: Vec<f64> = steps
            .flat_map(|(step, state)| step.residual(state))
            .collect();
        ratio(norm(&residual), self.size(reaction))
    }

    fn no_state(&self) -> Verdict {
        let worst = Worst {
            value: f64::INFINITY,
            scaled: f64::INFINITY,
            contact: 0,
        };
        Verdict {
            displacement: vec![f64::INFINITY; self.problem.unknowns()],
            beyond: vec![f64::INFINITY; self.problem.unknowns()],
            status: vec![ContactStatus::Open; self.problem.contacts()],
            certificate: Certificate {
                natural_map: f64::INFINITY,
                equilibrium: Defect {
                    value: f64::INFINITY,
                    scaled: f64::INFINITY,
                },
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::{Mat, mat};

    use super::*;
    use crate::problem::{Floating, Operator};

    /// One contact with K = [[2, 1], [1, 1]] in (normal, tangent), G = [[1, −1], [−1, 2]],
    /// μ = 0.5, no gap; lengths are multiplied by `length`, forces by `force`.
    fn one_contact(free: [f64; 2], length: f64, force: f64) -> ContactProblem {
        let compliance = mat![[1.0, -1.0], [-1.0, 2.0]] * faer::Scale(length / force);
        let operator = Operator::from_compliance(compliance).unwrap();
        let free = free.map(|u| u * length).to_vec();
        ContactProblem::new(&[1], vec![0.5], vec![0.0], free, operator).unwrap()
    }

    #[test]
    fn the_slipping_solution_of_one_contact_is_certified() {
        // û = (0.25, 0.5), t = (−0.5, −0.25): u = (0.25 − 0.25, 0.5 + 0.5 − 0.5) = (0, 0.5),
        // ‖t_T‖ = 0.25 = μ |t_N|, opposed to the slip.
        let problem = one_contact([0.25, 0.5], 1.0, 1.0);
        let verdict = Judge::new(&problem).measure(&[-0.5, -0.25]);
        assert_eq!(verdict.displacement, [0.0, 0.5]);
        assert_eq!(verdict.status, [ContactStatus::Slip]);
        // ½ t · G t = ½ (−0.5, −0.25) · (−0.25, 0) = 0.0625 J.
        let expected = Certificate {
            reaction_energy: 0.0625,
            ..Certificate::default()
        };
        assert_eq!(verdict.certificate, expected);
    }

    #[test]
    fn a_floating_contact_is_judged_with_its_motion_and_its_equilibrium() {
        // One contact of 2 m/N under a lid that sinks by α = 6 m: u = −2 · 3 + 6 = 0 under 3 N.
        let operator = Operator::from_compliance(mat![[2.0]]).unwrap();
        let held = ContactProblem::new(&[0], vec![0.0], vec![0.0], vec![0.0], operator).unwrap();
        let floating = Floating::new(mat![[1.0]], vec![3.0]).unwrap();
        let problem = held.float(floating).unwrap();
        let judge = Judge::new(&problem);
        let found = judge.measure_floating(&[-3.0], &[6.0]);
        assert_eq!(
            (found.displacement[0], found.certificate.residual()),
            (0.0, 0.0)
        );
        // 1 N too much of 4 + 3, and a gap of 2 m under 4 N: ρ = ½.
        let found = judge.measure_floating(&[-4.0], &[6.0]).certificate;
        assert_eq!(found.equilibrium.scaled, 1.0 / 7.0);
        assert_eq!((found.natural_map, found.residual()), (0.25, 0.25));
        // Without its motion it is no state of a floating body.
        assert!(judge.measure(&[-3.0]).certificate.residual().is_infinite());
    }

    #[test]
    fn a_motion_a_quadrillion_times_the_indentation_is_judged_with_what_rounding_left_out() {
        // G = 1 m/N, a gap of 1 m, 2⁻⁶⁰ N: t = −2⁻⁶⁰, and u_N = t + α = 1 with α = 1 + 2⁻⁶⁰.
        let tiny = 2.0_f64.powi(-60);
        let operator = Operator::from_compliance(mat![[1.0]]).unwrap();
        let problem = ContactProblem::new(&[0], vec![0.0], vec![1.0], vec![0.0], operator).unwrap();
        let floating = Floating::new(mat![[1.0]], vec![tiny]).unwrap();
        let problem = problem.float(floating).unwrap();
        let judge = Judge::new(&problem);
        let whole = judge.measure_moved(&[-tiny], &[1.0], &[tiny]);
        assert_eq!((whole.certificate.residual(), whole.beyond[0]), (0.0, 0.0));
        // Without it the contact is open by as much as it should be indented.
        let rounded = judge.measure_floating(&[-tiny], &[1.0]);
        assert_eq!(rounded.certificate.natural_map, 1.0);
        assert_eq!(
            judge.measure_moved(&[-tiny], &[1.0], &[]).status,
            judge.no_state().status
        );
    }

    #[test]
    fn the_open_solution_of_one_contact_is_certified() {
        let problem = one_contact([-0.25, 1.5], 1.0, 1.0);
        let verdict = Judge::new(&problem).measure(&[0.0, 0.0]);
        assert_eq!(verdict.status, [ContactStatus::Open]);
        assert_eq!(verdict.certificate, Certificate::default());
    }

    #[test]
    fn every_law_that_a_wrong_reaction_breaks_is_measured() {
        // t = (1, 2): u = (0.25 + 1 − 2, 0.5 − 1 + 4) = (−0.75, 3.5).
        let problem = one_contact([0.25, 0.5], 1.0, 1.0);
        let found = Judge::new(&problem).measure(&[1.0, 2.0]).certificate;
        // Force ‖t‖ = √5 N, length ‖G t‖ = ‖(−1, 3)‖ = √10 m, energy √50 J;
        // ‖t_T‖ + μ t_N = 2 + 0.5; |−0.5 · 3.5 + 2 · 3.5| = 5.25.
        for (worst, value, scale) in [
            (found.tension, 1.0, 5.0_f64.sqrt()),
            (found.complementarity, 0.75, 50.0_f64.sqrt()),
            (found.disc_excess, 2.5, 5.0_f64.sqrt()),
            (found.dissipation_defect, 5.25, 50.0_f64.sqrt()),
        ] {
            assert_eq!(worst.value, value);
            assert!((worst.scaled - value / scale).abs() < 1e-15);
        }
        assert_eq!(found.bipotential_gap, -0.75 + 7.0 - 1.75);
        // r = (1, 2): the normal reaction pulls, the disc is empty; relative to t itself 1.
        assert_eq!(found.natural_map, 1.0);
    }

    #[test]
    fn no_reaction_where_one_is_needed_is_measured_against_the_load() {
        // u = û = (0.25, 0.5); r = (ρ_N · 0.25, 0) = (0.25, 0). Local load force
        // (0.25/1, 0.5/2), of length 0.25 √2; the floor is a thousandth of it.
        let problem = one_contact([0.25, 0.5], 1.0, 1.0);
        let found = Judge::new(&problem).measure(&[0.0, 0.0]).certificate;
        assert!((found.natural_map - 1000.0 / 2.0_f64.sqrt()).abs() < 1e-12);
        // ‖û‖ = 0.25 √5 m.
        assert_eq!(found.penetration.value, 0.25);
        assert!((found.penetration.scaled - 1.0 / 5.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn units_and_the_size_of_the_load_change_no_scaled_value() {
        let reference = Judge::new(&one_contact([0.25, 0.5], 1.0, 1.0)).measure(&[-0.75, 0.5]);
        for (length, force) in [
            (1e3, 1.0),
            (1e6, 1e-6),
            (1e-9, 1e-9),
            (1e9, 1e9),
            (1e-120, 1e130),
        ] {
            let problem = one_contact([0.25, 0.5], length, force);
            let verdict = Judge::new(&problem).measure(&[-0.75 * force, 0.5 * force]);
            let (found, expected) = (verdict.certificate, reference.certificate);
            for (found, expected) in [
                (found.natural_map, expected.natural_map),
                (
                    found.complementarity.scaled,
                    expected.complementarity.scaled,
                ),
                (found.disc_excess.scaled, expected.disc_excess.scaled),
                (
                    found.dissipation_defect.scaled,
                    expected.dissipation_defect.scaled,
                ),
            ] {
                assert!(
                    (found - expected).abs() < 1e-13 * expected,
                    "{length} {force}"
                );
            }
            assert_eq!(verdict.status, reference.status);
        }
    }

    #[test]
    fn nothing_acting_and_nothing_touching_is_a_perfect_state() {
        let problem = one_contact([0.0, 0.0], 1.0, 1.0);
        let found = Judge::new(&problem).measure(&[0.0, 0.0]).certificate;
        assert_eq!(found, Certificate::default());
        let empty = Operator::from_compliance(Mat::zeros(0, 0)).unwrap();
        let nobody = ContactProblem::new(&[], vec![], vec![], vec![], empty).unwrap();
        assert_eq!(
            Judge::new(&nobody).measure(&[]).certificate,
            Certificate::default()
        );
    }

    #[test]
    fn what_is_no_state_of_the_problem_never_scores() {
        let problem = one_contact([0.25, 0.5], 1.0, 1.0);
        let judge = Judge::new(&problem);
        for reaction in [
            &[f64::NAN, 0.0][..],
            &[0.0, f64::INFINITY],
            &[0.0],
            &[0.0; 3],
        ] {
            let found = judge.measure(reaction);
            assert_eq!(found.certificate.natural_map, f64::INFINITY);
            assert_eq!((found.displacement.len(), found.status.len()), (2, 1));
        }
        // Finite, but its response overflows.
        let huge = judge.measure(&[-1e308, 1e308]).certificate;
        assert_eq!(huge.natural_map, f64::INFINITY);
    }
}
