//! The same bodies under another load: nothing is factorised again.
//!
//! A rigid other side that moved by `d` adds to the reference of (C13):
//!
//! ```text
//! (C14)  u_ref,N = d_N,   u_ref,T = d_T + slip of the last state      d: per contact, zero between bodies
//! ```

use super::Condensed;
use super::rigid_bodies::mode_loads;
use crate::body::{self, Body};
use crate::error::{Error, check_finite, check_length};

impl Condensed {
    /// Moves on to other loads, other values of the same supports, and obstacles moved from
    /// where they were before loading: one pair of substitutions per body (C5).
    ///
    /// - `bodies`: those that were condensed, under their loads and supports now;
    /// - `obstacles`: motion `d` of the obstacle per contact pair, in metre in global axes;
    /// - `slip`: of the last state, in metre per unknown of the contact problem
    ///   ([`slip`](Self::slip)); zero at the start. Entries along normals are not read.
    ///
    /// # Errors
    ///
    /// Lengths that do not fit, contradictory supports, a support where there was none or none
    /// where there was one, a NaN or infinity.
    pub fn act(
        &mut self,
        bodies: &[Body],
        obstacles: &[[f64; 3]],
        slip: &[f64],
    ) -> Result<(), Error> {
        check_length("bodies", self.bodies.len(), bodies.len())?;
        check_length("slip", self.problem.unknowns(), slip.len())?;
        let pairs = self.surface.nodes.iter().map(|contact| contact.pair + 1);
        let pairs = pairs.max().unwrap_or(0);
        if obstacles.len() < pairs {
            check_length("obstacles", pairs, obstacles.len())?;
        }
        let mut actions = Vec::with_capacity(bodies.len());
        for (body, condensed) in bodies.iter().zip(&self.bodies) {
            let (load, prescribed) = (body::load_vector(body), body::prescribed(body)?);
            check_length("load", condensed.load().len(), load.len())?;
            check_finite("load", &load)?;
            check_supports(body, condensed.prescribed(), &prescribed)?;
            actions.push((load, prescribed));
        }
        let mut free = vec![0.0; self.problem.unknowns()];
        let of_bodies = self.bodies.iter_mut().zip(&self.interfaces);
        for ((body, interface), (load, prescribed)) in of_bodies.zip(actions) {
            let displacement = body.act(load, prescribed);
            interface.add_displacement(&displacement, body.prescribed(), &mut free);
        }
        let mut problem = self.problem.step(free, self.reference(obstacles, slip))?;
        if let Some(floating) = problem.floating() {
            let groundings: Vec<_> = self.bodies.iter().map(|body| &body.grounding).collect();
            let loads: Vec<_> = self.bodies.iter().map(|body| body.load()).collect();
            let load = mode_loads(&groundings, &loads);
            let moved = floating.under(load)?;
            problem = problem.float(moved)?;
        }
        self.problem = problem;
        Ok(())
    }

    /// Takes other coefficients of friction and other gaps before loading, in metre; both per
    /// contact. Contacts that were condensed without friction have no tangents and stay smooth.
    ///
    /// # Errors
    ///
    /// Lengths that do not fit, a NaN or infinity, a negative coefficient.
    pub fn replace(&mut self, friction: Vec<f64>, initial_gap: Vec<f64>) -> Result<(), Error> {
        let problem = self.problem.with_friction(friction)?;
        self.problem = problem.with_initial_gap(initial_gap)?;
        Ok(())
    }

    /// Slip of a solved state since the start of the history, in metre per unknown, for the next
    /// [`act`](Self::act); `displacement` is the judge's, `slip` what the step began with.
    #[must_use]
    pub fn slip(&self, displacement: &[f64], slip: &[f64]) -> Vec<f64> {
        let mut total: Vec<f64> = displacement.iter().zip(slip).map(|(u, s)| u + s).collect();
        for &normal in &self.problem.offsets()[..self.problem.contacts()] {
            total[normal] = 0.0;
        }
        total
    }

    /// (C14).
    fn reference(&self, obstacles: &[[f64; 3]], slip: &[f64]) -> Vec<f64> {
        let mut reference = slip.to_vec();
        let moved = self.surface.obstacle_motions(obstacles);
        let contacts = self.surface.nodes.iter().zip(moved);
        for ((contact, moved), &first) in contacts.zip(self.problem.offsets()) {
            reference[first] = 0.0;
            for (row, entry) in contact.frame[..=contact.tangents]
                .iter()
                .zip(&mut reference[first..])
            {
                *entry += row.iter().zip(moved).map(|(n, d)| n * d).sum::<f64>();
            }
        }
        reference
    }
}

/// Values may change, what is held may not: it is in the factor.
fn check_supports(body: &Body, was: &[Option<f64>], is: &[Option<f64>]) -> Result<(), Error> {
    let axes = body.mesh.dimension;
    let changed = was
        .iter()
        .zip(is)
        .position(|(a, b)| a.is_some() != b.is_some());
    match changed {
        None => Ok(()),
        Some(dof) => Err(Error::NotAccepted {
            place: format!("{}: supports", body.name),
            found: format!(
                "node {} {} along {}",
                dof / axes,
                if is[dof].is_some() { "held" } else { "free" },
                ['x', 'y', 'z'][dof % axes]
            ),
            accepted: "the supports that were condensed, with other values".to_owned(),
        }),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::samples::{distorted, facets};
    use crate::body::{CellKind, Load, Support};
    use crate::condensation::{ContactPair, ContactProblem, Obstacle, Opposite};

    /// A distorted block above a plane, held on its right, pressed from above.
    fn pressed(moved: f64, pressure: f64, plane: f64) -> (Body, ContactPair) {
        let mut body = distorted(CellKind::Hex8);
        let right = facets(&body.mesh, "right");
        body.supports.push(Support {
            place: "supports[0]".to_owned(),
            nodes: right.into_iter().flat_map(|facet| facet.nodes).collect(),
            displacement: [Some(0.0), Some(moved), Some(0.0)],
        });
        let facets_of = |side| facets(&body.mesh, side);
        let (top, bottom) = (facets_of("top"), facets_of("bottom"));
        body.loads = vec![Load::Pressure {
            facets: top,
            pressure,
        }];
        let pair = ContactPair {
            place: "contacts[0]".to_owned(),
            facets: bottom,
            body: 0,
            opposite: Opposite::Obstacle(Obstacle::Plane {
                point: [0.0, 0.0, plane],
                normal: [0.0, 0.0, 1.0],
            }),
            friction: 0.0,
        };
        (body, pair)
    }

    #[test]
    fn a_condensed_body_under_another_load_is_the_body_condensed_under_it() {
        let (before, pair) = pressed(0.0, 0.3, -0.5);
        let mut condensed = Condensed::new(&[before], std::slice::from_ref(&pair)).unwrap();
        let (after, _) = pressed(0.01, 0.7, -0.5);
        let fresh = Condensed::new(std::slice::from_ref(&after), &[pair]).unwrap();
        let slip = vec![0.0; condensed.problem().unknowns()];
        condensed.act(&[after], &[[0.0; 3]], &slip).unwrap();
        let (found, expected) = (condensed.problem(), fresh.problem());
        assert_eq!(found.free_displacement(), expected.free_displacement());
        let none = vec![0.0; found.unknowns()];
        let recovered = [&condensed, &fresh].map(|c| c.recover(&none, &[]).unwrap());
        assert_eq!(recovered[0], recovered[1]);
        assert_eq!(condensed.work().factorisations, 1);
    }

    #[test]
    fn an_obstacle_moved_towards_the_body_leaves_what_a_nearer_one_leaves() {
        let (body, pair) = pressed(0.0, 0.3, -0.5);
        let bodies = [body.clone()];
        let mut condensed = Condensed::new(&bodies, &[pair]).unwrap();
        let slip = vec![0.0; condensed.problem().unknowns()];
        let lift = [[0.0, 0.0, 0.125]];
        condensed.act(&bodies, &lift, &slip).unwrap();
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
    fn other_supports_are_refused_by_node_and_axis() {
        let (mut body, pair) = pressed(0.0, 0.3, -0.5);
        let mut condensed = Condensed::new(std::slice::from_ref(&body), &[pair]).unwrap();
        let slip = vec![0.0; condensed.problem().unknowns()];
        body.supports[0].displacement[2] = None;
        let refused = condensed.act(&[body], &[[0.0; 3]], &slip).unwrap_err();
        assert!(refused.to_string().contains("free along z"), "{refused}");
    }
}
