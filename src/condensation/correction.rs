//! Bodies that their factor shows with few digits, set right by what they leave of their own equations.
//!
//! ```text
//! (C24)  r = f + Bᵀ t − K u,   u ← u + K⁻¹ r        r as if in twice the precision
//!        û ← û + (B u − (û + G t))                  the contact problem follows the bodies
//! ```
//!
//! K is exact as it stands, its factor is not: a slender body that would move by kilometres without its
//! contacts keeps few digits of what it does with them, in û and G as in the recovered displacement. Solved
//! again under the shifted û, the contacts stand where the bodies are: each round takes as many digits as the
//! factor has. (Iterative refinement: Wilkinson, Rounding Errors in Algebraic Processes (1963), ch. 3.)

use super::Condensed;
use super::condensed_body::FactoredBody;
use super::load_case::Action;
use crate::error::{Error, check_length};

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

    /// The first of (C24): displacements under a reaction in newton, in place, in metre.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] if they do not fit.
    pub fn refine(&self, reaction: &[f64], displacements: &mut [Vec<f64>]) -> Result<(), Error> {
        check_length("reaction", self.problem.unknowns(), reaction.len())?;
        check_length("displacements", self.bodies.len(), displacements.len())?;
        let bodies = self.bodies.iter().zip(self.interfaces.iter());
        for ((body, interface), displacement) in bodies.zip(displacements) {
            let forces = interface.forces(reaction);
            body.factored.refine(&body.action, &forces, displacement);
        }
        Ok(())
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
        Ok(())
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

    fn refine(&self, action: &Action, forces: &[f64], displacement: &mut [f64]) {
        let Some(factor) = self.factor.plain() else {
            return;
        };
        let mut rest = self.residual(action, forces, displacement);
        factor.forward(&mut rest);
        factor.backward(&mut rest);
        let change = self.in_space(&rest);
        let unknowns = displacement.iter_mut().zip(&action.prescribed).zip(change);
        for ((u, _), change) in unknowns.filter(|((_, prescribed), _)| prescribed.is_none()) {
            *u += change;
        }
    }

    /// r of (C24), in newton, in the factor's order.
    fn residual(&self, action: &Action, forces: &[f64], displacement: &[f64]) -> Vec<f64> {
        let rows = self.stiffness.outer_iterator().zip(&action.load);
        let rest: Vec<f64> = rows
            .map(|(row, &load)| {
                let terms = row.iter().map(|(k, entry)| (-*entry, displacement[k]));
                deep_sum(load, terms)
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

/// `first + Σ a b`, the rounding of products and sums summed beside them (Ogita, Rump, Oishi, SIAM J. Sci.
/// Comput. 26 (2005), algorithm 5.3).
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
        body.supports.push(Support {
            place: "supports[0]".to_owned(),
            nodes: right.into_iter().flat_map(|facet| facet.nodes).collect(),
            displacement: [Some(0.0), Some(0.01), Some(-0.02)],
            offsets: Vec::new(),
            axes: Vec::new(),
        });
        let pair = ContactPair {
            place: "contacts[0]".to_owned(),
            facets: facets(&body.mesh, "bottom"),
            body: 0,
            opposite: Opposite::Obstacle(Obstacle::Plane {
                point: [0.0, 0.0, -1.0],
                normal: [0.28, 0.0, 0.96],
            }),
            friction: 0.3,
            law: crate::contact::PairLaw::default(),
            rounded: true,
            gap: 0.0,
            dragged: false,
        };
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
        condensed.refine(&reaction, &mut wrong).unwrap();
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
