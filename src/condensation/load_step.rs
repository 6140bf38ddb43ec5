//! The same bodies under other factors: nothing is factorised again.
//!
//! A rigid other side that moved by `d` adds to the reference of (C13):
//!
//! ```text
//! (C14)  u_ref,N = d_N,   u_ref,T = d_T + slip of the last state      d: per contact, zero between bodies
//! ```

use super::rigid_bodies::mode_loads;
use super::{Condensed, CondensedBody, Driven, Superposition};
use crate::error::{Error, check_length};

impl Condensed {
    /// Moves on to other factors of loads, supports and rigid bodies, and obstacles moved from where they
    /// were before loading: nothing is substituted (C15).
    ///
    /// - `under`, `factors`: what acts on these bodies, a factor per driven load or support;
    /// - `obstacles`: motion `d` of the obstacle per contact pair, in metre in global axes; not read of
    ///   pairs that a rigid body carries;
    /// - `slip`: of the last state, in metre per unknown of the contact problem
    ///   ([`slip`](Self::slip)); zero at the start. Entries along normals are not read.
    ///
    /// # Errors
    ///
    /// Lengths that do not fit, contradictory supports, a NaN or infinity.
    pub fn act(
        &mut self,
        under: &Superposition,
        factors: &[f64],
        obstacles: &[[f64; 3]],
        slip: &[f64],
    ) -> Result<(), Error> {
        check_length("slip", self.problem.unknowns(), slip.len())?;
        let pairs = self.surface.nodes.iter().map(|contact| contact.pair + 1);
        let pairs = pairs.max().unwrap_or(0);
        if obstacles.len() < pairs {
            check_length("obstacles", pairs, obstacles.len())?;
        }
        let actions = under.at(factors)?;
        check_length("bodies", self.bodies.len(), actions.len())?;
        for (body, action) in self.bodies.iter().zip(&actions) {
            body.dependence()
                .map_or(Ok(()), |tied| tied.check(&action.values))?;
        }
        let mut free = vec![0.0; self.problem.unknowns()];
        for (action, interface) in actions.iter().zip(self.interfaces.iter()) {
            interface.add_displacement(action, &action.free_displacement, &mut free);
        }
        for (driven, &factor) in under.driven().iter().zip(factors) {
            if let Driven::Rigid { body, component } = *driven {
                self.carried.scale(body, component, factor)?;
            }
        }
        let mut problem = self.problem.step(free, self.reference(obstacles, slip))?;
        if let Some(floating) = problem.floating() {
            let groundings: Vec<_> = self.bodies.iter().map(CondensedBody::grounding).collect();
            let loads: Vec<_> = actions.iter().map(|action| &action.load).collect();
            let mut load = mode_loads(&groundings, &loads);
            load.extend(self.carried.load());
            let moved = floating.under(load)?;
            problem = problem.float(moved)?;
        }
        for (body, action) in self.bodies.iter_mut().zip(actions) {
            body.action = action;
        }
        self.problem = problem;
        Ok(())
    }

    /// Takes other coefficients of friction and other gaps before loading, in metre; both per
    /// contact.
    ///
    /// # Errors
    ///
    /// Lengths that do not fit, a NaN or infinity, a negative coefficient, friction at a contact that was
    /// condensed without any and has no tangent for it.
    pub fn replace(&mut self, friction: Vec<f64>, initial_gap: Vec<f64>) -> Result<(), Error> {
        let problem = self.problem.with_friction(friction)?;
        self.problem = problem.with_initial_gap(initial_gap)?;
        Ok(())
    }

    /// Takes other lengths that are added to all gaps of a pair, in metre per contact pair.
    ///
    /// # Errors
    ///
    /// Fewer lengths than pairs, a NaN or infinity.
    pub fn open(&mut self, openings: &[f64]) -> Result<(), Error> {
        let mut gaps = Vec::with_capacity(self.surface.nodes.len());
        for contact in &self.surface.nodes {
            let Some(opening) = openings.get(contact.pair) else {
                check_length("openings", contact.pair + 1, openings.len())?;
                continue;
            };
            gaps.push(contact.initial_gap + opening);
        }
        self.problem = self.problem.with_initial_gap(gaps)?;
        Ok(())
    }

    /// Slip of a solved state since the start of the history, in metre per unknown, for the next
    /// [`act`](Self::act); `displacement` is the judge's, `slip` what the step began with.
    #[must_use]
    pub fn slip(&self, displacement: &[f64], slip: &[f64]) -> Vec<f64> {
        let mut total: Vec<f64> = displacement.iter().zip(slip).map(|(u, s)| u + s).collect();
        for &normal in self.problem.normals() {
            total[normal] = 0.0;
        }
        total
    }

    /// (C14).
    pub(super) fn reference(&self, obstacles: &[[f64; 3]], slip: &[f64]) -> Vec<f64> {
        let given = self.carried.motions(&[]);
        let mut moved = self.surface.obstacle_motions(obstacles);
        self.carried.put(&given, &mut moved);
        self.along_contacts(&moved, slip)
    }

    /// Displacement of the other side per contact, in its directions, and along tangents this slip.
    pub(super) fn along_contacts(&self, moved: &[[f64; 3]], slip: &[f64]) -> Vec<f64> {
        let mut along = slip.to_vec();
        let contacts = self.surface.nodes.iter().zip(moved);
        for ((contact, moved), &first) in contacts.zip(self.problem.normals()) {
            along[first] = 0.0;
            let rows = contact.frame[..=contact.tangents].iter();
            for (row, entry) in rows.zip(&mut along[first..]) {
                *entry += row.iter().zip(moved).map(|(n, d)| n * d).sum::<f64>();
            }
        }
        along
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::tests::samples::{distorted, facets};
    use crate::body::{Body, CellKind, Load, Support};
    use crate::contact::{ContactPair, Obstacle, Opposite};
    use crate::problem::ContactProblem;

    /// A distorted block above a plane, held on its right, pressed from above.
    fn pressed(moved: f64, pressure: f64, plane: f64) -> (Body, ContactPair) {
        let mut body = distorted(CellKind::Hex8);
        let right = facets(&body.mesh, "right");
        body.supports.push(Support::new(
            "supports[0]",
            right.into_iter().flat_map(|facet| facet.nodes).collect(),
            [Some(0.0), Some(moved), Some(0.0)],
        ));
        let facets_of = |side| facets(&body.mesh, side);
        let (top, bottom) = (facets_of("top"), facets_of("bottom"));
        body.loads = vec![Load::Pressure {
            facets: top,
            pressure,
        }];
        let pair = ContactPair::new(
            "contacts[0]",
            0,
            bottom,
            Opposite::Obstacle(Obstacle::Plane {
                point: [0.0, 0.0, plane],
                normal: [0.0, 0.0, 1.0],
            }),
            0.0,
        );
        (body, pair)
    }

    fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
        let pairs = a.iter().zip(b);
        pairs.fold(0.0, |most, (a, b)| most.max((a - b).abs()))
    }

    #[test]
    fn a_condensed_body_under_factors_is_the_body_condensed_under_them() {
        let (before, pair) = pressed(0.01, 0.3, -0.5);
        let bodies = [before];
        let mut condensed = Condensed::new(&bodies, std::slice::from_ref(&pair)).unwrap();
        let held = bodies[0].supports.len() - 1;
        let driven = [
            Driven::Support {
                body: 0,
                index: held,
            },
            Driven::Load { body: 0, index: 0 },
        ];
        let under = condensed.superpose(&bodies, &driven).unwrap();
        let slip = vec![0.0; condensed.problem().unknowns()];
        condensed
            .act(&under, &[-2.0, 3.0], &[[0.0; 3]], &slip)
            .unwrap();
        let (after, _) = pressed(-0.02, 0.9, -0.5);
        let fresh = Condensed::new(&[after], &[pair]).unwrap();
        let (found, expected) = (condensed.problem(), fresh.problem());
        let moved = expected.free_displacement();
        assert!(largest_difference(found.free_displacement(), moved) < 1e-14);
        let none = vec![0.0; found.unknowns()];
        let [found, expected] = [&condensed, &fresh].map(|c| c.recover(&none, &[]).unwrap());
        assert!(largest_difference(&found[0], &expected[0]) < 1e-14);
        let (found, expected) = (&condensed.bodies()[0], &fresh.bodies()[0]);
        assert!(largest_difference(found.load(), expected.load()) < 1e-15);
        assert_eq!(found.prescribed(), expected.prescribed());
    }

    #[test]
    fn friction_at_contacts_without_tangents_is_refused() {
        let (body, pair) = pressed(0.0, 0.3, -0.5);
        let mut condensed = Condensed::new(&[body], &[pair]).unwrap();
        let (contacts, gaps) = (condensed.problem().contacts(), vec![0.0; 9]);
        let gaps = gaps.into_iter().cycle().take(contacts).collect::<Vec<_>>();
        let refused = condensed.replace(vec![0.2; contacts], gaps.clone());
        let refused = refused.unwrap_err().to_string();
        assert!(refused.contains("condensed without friction"), "{refused}");
        assert!(condensed.replace(vec![0.0; contacts], gaps).is_ok());
    }

    #[test]
    fn an_obstacle_moved_towards_the_body_leaves_what_a_nearer_one_leaves() {
        let (body, pair) = pressed(0.0, 0.3, -0.5);
        let bodies = [body.clone()];
        let mut condensed = Condensed::new(&bodies, &[pair]).unwrap();
        let slip = vec![0.0; condensed.problem().unknowns()];
        let lift = [[0.0, 0.0, 0.125]];
        let under = condensed.superpose(&bodies, &[]).unwrap();
        condensed.act(&under, &[], &lift, &slip).unwrap();
        let (_, near) = pressed(0.0, 0.3, -0.375);
        let near = Condensed::new(&bodies, &[near]).unwrap();
        let left = |problem: &ContactProblem| -> Vec<f64> {
            let pairs = problem
                .initial_gap()
                .iter()
                .zip(problem.free_displacement());
            pairs.map(|(gap, u)| gap - u).collect()
        };
        // Distorted: the gaps differ from node to node.
        for (a, b) in left(condensed.problem()).iter().zip(left(near.problem())) {
            assert!((a - b).abs() < 1e-14, "{a} {b}");
        }
    }

    #[test]
    fn supports_that_factors_set_against_each_other_are_refused() {
        // Both hold the right side at 0.01 m; the first alone is doubled.
        let (mut body, pair) = pressed(0.01, 0.3, -0.5);
        let held = body.supports.len() - 1;
        let mut again = body.supports[held].clone();
        again.place = "supports[1]".to_owned();
        body.supports.push(again);
        let bodies = [body];
        let mut condensed = Condensed::new(&bodies, &[pair]).unwrap();
        let free = condensed.problem().free_displacement().to_vec();
        let driven = [Driven::Support {
            body: 0,
            index: held,
        }];
        let under = condensed.superpose(&bodies, &driven).unwrap();
        let slip = vec![0.0; condensed.problem().unknowns()];
        let mut act = |factor| condensed.act(&under, &[factor], &[[0.0; 3]], &slip);
        let refused = act(2.0).unwrap_err().to_string();
        assert!(refused.contains("supports[1]"), "{refused}");
        assert!(
            act(f64::NAN)
                .unwrap_err()
                .to_string()
                .contains("factors[0]")
        );
        act(1.0).unwrap();
        assert!(largest_difference(condensed.problem().free_displacement(), &free) < 1e-15);
        let absent = Driven::Load { body: 0, index: 1 };
        assert!(condensed.superpose(&bodies, &[absent]).is_err());
        // The body at first, without its driven support, and that support alone.
        assert_eq!(condensed.work().substitutions, 3);
    }
}
