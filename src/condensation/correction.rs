//! Bodies that their factor shows with few digits, set right by what they leave of their own equations.
//!
//! ```text
//! (C24)  r = f + Bᵀ t − K u,   L y = r              r as if in twice the precision
//!        û ← û + (B (u + L_cc⁻ᵀ y_c) − (û + G t))   the contact problem follows the bodies; solved again: t'
//!        Lᵀ δ = y + L⁻¹ Bᵀ (t' − t),   u ← u + δ
//! ```
//!
//! K is exact as it stands, its factor is not: one in single precision has seven digits (C32), and a slender body
//! that would move by kilometres without its contacts keeps few of what it does with them, in û and G as in the
//! recovered displacement. Solved again under the shifted û, the contacts stand where the bodies are: each round
//! takes as many digits as the factor has, as the errors of û and G count only by what still changes. (Iterative
//! refinement: Wilkinson, Rounding Errors in Algebraic Processes (1963), ch. 3.)

use rayon::prelude::*;

use super::Condensed;
use super::condensed_body::FactoredBody;
use super::load_case::Action;
use crate::error::{Error, check_length};
use crate::processor::widest;

impl Condensed {
    /// How much further the contacts of recovered bodies are than the contact problem says, in metre per unknown.
    ///
    /// - `displacement`: of the contact problem, `û + G t`, in metre per unknown;
    /// - `displacements`: per body and degree of freedom, in metre.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] if they do not fit.
    pub fn ahead(
        &self,
        displacement: &[f64],
        displacements: &[Vec<f64>],
    ) -> Result<Vec<f64>, Error> {
        check_length("displacement", self.problem.unknowns(), displacement.len())?;
        check_length("displacements", self.bodies.len(), displacements.len())?;
        let mut ahead = vec![0.0; displacement.len()];
        let bodies = self.bodies.iter().zip(self.interfaces.iter());
        for ((body, interface), moved) in bodies.zip(displacements) {
            let at_contacts = body.factored.at_contacts(moved);
            interface.add_displacement(&body.action, &at_contacts, &mut ahead);
        }
        let total = self.problem.total_displacement(displacement);
        ahead.iter_mut().zip(total).for_each(|(u, said)| *u -= said);
        Ok(ahead)
    }

    /// Whether (C24) is for these bodies: held by their supports, as rigid ones are, and with every contact unknown in the factor.
    #[must_use]
    pub fn corrects(&self) -> bool {
        let mut bodies = self.bodies.iter().map(|body| &body.factored);
        self.carried.modes() == 0
            && bodies.all(|body| body.grounding.modes.ncols() == 0 && body.factor.plain().is_some())
    }

    /// The first of (C24), for bodies that [correct](Self::corrects).
    ///
    /// - `displacement`: of the contact problem, `û + G t`, in metre per unknown;
    /// - `reaction`: t, in newton per unknown;
    /// - `displacements`: u per body and degree of freedom, in metre.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] if they do not fit.
    pub fn correction(
        &self,
        displacement: &[f64],
        reaction: &[f64],
        displacements: &[Vec<f64>],
    ) -> Result<Correction, Error> {
        check_length("reaction", self.problem.unknowns(), reaction.len())?;
        let mut ahead = self.ahead(displacement, displacements)?;
        let (mut half_solved, mut left, mut acting) = (Vec::new(), 0.0_f64, 0.0_f64);
        let bodies = self.bodies.iter().zip(self.interfaces.iter());
        for ((body, interface), moved) in bodies.zip(displacements) {
            let (factored, action) = (&body.factored, &body.action);
            let forces = interface.forces(reaction);
            let Some(factor) = factored.factor.plain() else {
                half_solved.push(Vec::new());
                continue;
            };
            let mut rest = factored.residual(action, &forces, moved);
            factor.forward(&mut rest);
            left = left.hypot(norm(&rest));
            acting = acting.hypot(norm(&factored.half_solved_under(
                factor,
                &action.half_solved,
                &forces,
            )));
            let mut further = rest.clone();
            let further = factor.backward_on_contact(&mut further);
            interface.add_own_displacement(further, &mut ahead);
            half_solved.push(rest);
        }
        Ok(Correction {
            half_solved,
            ahead,
            part: if left > 0.0 { left / acting } else { 0.0 },
        })
    }

    /// The second of (C24): the contact problem with û moved, in metre per unknown.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] if it does not fit.
    pub fn shift(&mut self, ahead: &[f64]) -> Result<(), Error> {
        check_length("ahead", self.problem.unknowns(), ahead.len())?;
        let free = self
            .problem
            .total_displacement(self.problem.free_displacement());
        let free = free.iter().zip(ahead).map(|(u, more)| u + more).collect();
        self.problem = self.problem.step(free, self.problem.reference().to_vec())?;
        self.work.corrections += 1;
        Ok(())
    }

    /// The third of (C24): displacements in place, in metre, under a reaction that changed by `change`, in newton.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] if they do not fit.
    pub fn advance(
        &self,
        correction: Correction,
        change: &[f64],
        displacements: &mut [Vec<f64>],
    ) -> Result<(), Error> {
        check_length("change", self.problem.unknowns(), change.len())?;
        check_length("displacements", self.bodies.len(), displacements.len())?;
        let bodies = self.bodies.iter().zip(self.interfaces.iter());
        let bodies = bodies.zip(correction.half_solved);
        for (((body, interface), rest), displacement) in bodies.zip(displacements) {
            let Some(factor) = body.factored.factor.plain() else {
                continue;
            };
            let forces = interface.forces(change);
            let solved = body.factored.solve(factor, &rest, &forces);
            let change = body.factored.in_space(&solved);
            let given = &body.action.prescribed;
            let unknowns = displacement.iter_mut().zip(given).zip(change);
            for ((u, _), change) in unknowns.filter(|((_, given), _)| given.is_none()) {
                *u += change;
            }
        }
        Ok(())
    }
}

/// What bodies leave of their equations, half solved: a round of (C24) on its way.
#[derive(Debug)]
pub struct Correction {
    /// y per body.
    half_solved: Vec<Vec<f64>>,
    ahead: Vec<f64>,
    part: f64,
}

impl Correction {
    /// By how much û is to move, in metre per unknown of the contact problem.
    #[must_use]
    pub fn ahead(&self) -> &[f64] {
        &self.ahead
    }

    /// What is left over what acts, `√(rᵀ K⁻¹ r)` over the same of all forces.
    #[must_use]
    pub fn part(&self) -> f64 {
        self.part
    }
}

impl FactoredBody {
    /// The interface unknowns of a displacement, in metre.
    fn at_contacts(&self, displacement: &[f64]) -> Vec<f64> {
        let mut local = displacement.to_vec();
        self.frames.turn_to_local(&mut local);
        let contacts = &self.ordering.dof[self.ordering.ordinary()..];
        contacts.iter().map(|&dof| local[dof]).collect()
    }

    /// r of (C24), in newton, in the factor's order.
    fn residual(&self, action: &Action, forces: &[f64], displacement: &[f64]) -> Vec<f64> {
        let rows = action.load.par_iter().enumerate();
        let rest: Vec<f64> = rows
            .map(|(row, &load)| {
                let entries = self.stiffness.indptr().outer_inds_sz(row);
                let columns = self.stiffness.indices()[entries.clone()].iter();
                let terms = columns.zip(&self.stiffness.data()[entries]);
                widest(
                    #[inline(always)]
                    || deep_sum(load, terms.map(|(&k, entry)| (-entry, displacement[k]))),
                )
            })
            .collect();
        let mut rest = self.in_order(rest);
        let at_contacts = rest[self.ordering.ordinary()..].iter_mut();
        at_contacts
            .zip(forces)
            .for_each(|(rest, force)| *rest += force);
        rest
    }
}

fn norm(vector: &[f64]) -> f64 {
    let largest = vector.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let squares = vector.iter().map(|x| (x / largest).powi(2));
    match largest > 0.0 {
        true => largest * squares.sum::<f64>().sqrt(),
        false => largest,
    }
}

/// `first + Σ a b`, the rounding of products and sums summed beside them (Ogita, Rump, Oishi, SIAM J. Sci.
/// Comput. 26 (2005), algorithm 5.3).
#[inline(always)]
fn deep_sum(first: f64, products: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut sum, mut lost) = (first, 0.0);
    for (left, right) in products {
        let product = left * right;
        let before = sum;
        sum += product;
        let back = sum - before;
        lost += (before - (sum - back)) + (product - back) + left.mul_add(right, -product);
    }
    sum + lost
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::tests::samples::{distorted, facets};
    use crate::body::{CellKind, Support};
    use crate::contact::{ContactPair, Obstacle, Opposite};

    /// A distorted block above an inclined plane, held and moved on its right.
    fn condensed() -> Condensed {
        let mut body = distorted(CellKind::Hex8);
        let right = facets(&body.mesh, "right");
        body.supports.push(Support::new(
            "supports[0]",
            right.into_iter().flat_map(|facet| facet.nodes).collect(),
            [Some(0.0), Some(0.01), Some(-0.02)],
        ));
        let pair = ContactPair::new(
            "contacts[0]",
            0,
            facets(&body.mesh, "bottom"),
            Opposite::Obstacle(Obstacle::Plane {
                point: [0.0, 0.0, -1.0],
                normal: [0.28, 0.0, 0.96],
            }),
            0.3,
        );
        Condensed::new(&[body], &[pair]).unwrap()
    }

    /// Not in equilibrium with anything.
    fn reaction(condensed: &Condensed) -> Vec<f64> {
        let unknowns = 0..condensed.problem().unknowns();
        unknowns.map(|k| (k as f64 * 0.7).sin()).collect()
    }

    #[test]
    fn a_wrong_displacement_is_set_right_but_where_it_is_given() {
        let condensed = condensed();
        assert!(condensed.corrects());
        let reaction = reaction(&condensed);
        let right = condensed.recover(&reaction, &[]).unwrap();
        let mut wrong = right.clone();
        let prescribed = condensed.bodies()[0].prescribed();
        for (k, u) in wrong[0]
            .iter_mut()
            .enumerate()
            .filter(|(k, _)| prescribed[*k].is_none())
        {
            *u *= 1.0 + 1e-3 * (k as f64).cos();
        }
        let said = condensed.problem().displacement(&reaction);
        let correction = condensed.correction(&said, &reaction, &wrong).unwrap();
        assert!((1e-5..1e-1).contains(&correction.part()));
        // Where the bodies will be is where the problem says.
        assert!(correction.ahead().iter().all(|u| u.abs() < 1e-13));
        let none = vec![0.0; reaction.len()];
        condensed.advance(correction, &none, &mut wrong).unwrap();
        for (found, expected) in wrong[0].iter().zip(&right[0]) {
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
    }

    #[test]
    fn recovered_bodies_are_not_ahead_of_their_problem_until_it_is_shifted() {
        let mut condensed = condensed();
        let reaction = reaction(&condensed);
        let moved = condensed.recover(&reaction, &[]).unwrap();
        let said = condensed.problem().displacement(&reaction);
        let ahead = condensed.ahead(&said, &moved).unwrap();
        assert!(ahead.iter().all(|u| u.abs() < 1e-13), "{ahead:?}");
        let by: Vec<f64> = (0..ahead.len()).map(|k| 1e-3 * k as f64).collect();
        condensed.shift(&by).unwrap();
        let said = condensed.problem().displacement(&reaction);
        for (ahead, by) in condensed.ahead(&said, &moved).unwrap().iter().zip(&by) {
            assert!((ahead + by).abs() < 1e-13);
        }
        assert!(condensed.shift(&by[1..]).is_err());
    }

    #[test]
    fn a_sum_keeps_what_plain_sums_drown() {
        let products = [(1e16, 1.0), (1.0, 1.0), (-1e8, 1e8)];
        assert_eq!(deep_sum(0.5, products.into_iter()), 1.5);
    }
}
