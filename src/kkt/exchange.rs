//! What the two sides of a contact pair give each other.
//!
//! ```text
//! (K6)  Σ_own f + Σ_opposite f = 0,   Σ_own x × f + Σ_opposite x × f = Σ g₀ (f × n)
//! ```
//!
//! Mortar weights add up to one, so forces cancel whatever the meshes. Moments cancel up to
//! gap × friction: displacements are small, each side is loaded where it stood before, and
//! a friction force acts on the two sides along parallel lines, an initial gap g₀ apart. Where curved
//! sides end at a symmetry plane, their moments cancel with those of the mirror image only.

use super::certificate::{Defect, length};
use super::resultant::Resultant;
use super::sides::{block, check_sides, check_surface, global_force, shares};
use crate::body::Body;
use crate::contact::{ContactPair, ContactSurface, Opposite};
use crate::error::Error;
use crate::problem::ContactProblem;

/// Sum of the contact forces of a pair on either side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exchange {
    /// What the pair's first surface receives.
    pub own: Resultant,
    /// What its second surface receives; none if that is a rigid obstacle.
    pub opposite: Option<Resultant>,
    /// Length of the sum of both forces; zero for a rigid obstacle.
    pub force_defect: Defect,
    /// Length of the sum of both moments, scaled by the sum of forces at the farthest node;
    /// up to gap × friction with an initial gap, zero for a rigid obstacle.
    pub moment_defect: Defect,
}

/// Sums while the contacts of a pair are met.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    own: Resultant,
    opposite: Resultant,
    total: f64,
    reach: f64,
}

/// Measures (K6), pair by pair; `reaction` is in newton per contact unknown.
///
/// # Errors
///
/// [`Error::Length`] if arrays do not belong together, [`Error::UnknownIndex`] if a
/// contact belongs to a pair, or stands at a body or node, that does not exist.
pub fn exchange(
    bodies: &[Body],
    pairs: &[ContactPair],
    surface: &ContactSurface,
    problem: &ContactProblem,
    reaction: &[f64],
) -> Result<Vec<Exchange>, Error> {
    check_surface(surface, problem, "reaction", reaction)?;
    check_sides(surface, bodies)?;
    let mut sums = vec![Sums::default(); pairs.len()];
    for (i, contact) in surface.nodes.iter().enumerate() {
        let Some(sums) = sums.get_mut(contact.pair) else {
            return Err(Error::UnknownIndex {
                place: format!("contact nodes[{i}]"),
                what: "pair",
                index: contact.pair,
                count: pairs.len(),
            });
        };
        let force = global_force(contact, block(problem, i, reaction));
        for share in shares(contact) {
            let position = bodies[share.body].mesh.nodes[share.node];
            let received = force.map(|f| share.weight * f);
            sums.add(share.own != contact.second, position, received);
        }
    }
    let sums = sums.into_iter().zip(pairs);
    Ok(sums
        .map(|(sums, pair)| match pair.opposite {
            Opposite::Obstacle(_) => Exchange {
                own: sums.own,
                ..Exchange::default()
            },
            Opposite::Surface { .. } => sums.close(),
        })
        .collect())
}

impl Sums {
    fn add(&mut self, own: bool, position: [f64; 3], force: [f64; 3]) {
        let side = if own {
            &mut self.own
        } else {
            &mut self.opposite
        };
        side.add(position, force);
        self.total += length(force);
        self.reach = self.reach.max(length(position));
    }

    fn close(self) -> Exchange {
        let Self {
            own,
            opposite,
            total,
            reach,
        } = self;
        Exchange {
            own,
            opposite: Some(opposite),
            force_defect: Defect::of(&[own.force, opposite.force], total),
            moment_defect: Defect::of(&[own.moment, opposite.moment], total * reach),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::kkt::tests::samples::{lid_on_box, pairs};

    #[test]
    fn what_the_lid_gives_the_box_receives() {
        let (bodies, surface, problem) = lid_on_box(0.0);
        // 8 N up on the lid at x = 1, 2 N of friction along x; (1, 0) × (2, 8) = 8 N m.
        let found = exchange(&bodies, &pairs(), &surface, &problem, &[-8.0, 2.0]).unwrap();
        assert_eq!(found[0].own.force, [2.0, 8.0, 0.0]);
        assert_eq!(found[0].own.moment, [0.0, 0.0, 8.0]);
        let opposite = found[0].opposite.unwrap();
        assert_eq!(opposite.force, [-2.0, -8.0, 0.0]);
        // A quarter at x = 4, three quarters at x = 0.
        assert_eq!(opposite.moment, [0.0, 0.0, -8.0]);
        assert_eq!(found[0].force_defect, Defect::default());
        assert_eq!(found[0].moment_defect, Defect::default());
    }

    #[test]
    fn an_initial_gap_leaves_a_moment_of_gap_times_friction() {
        let (bodies, surface, problem) = lid_on_box(0.5);
        let found = exchange(&bodies, &pairs(), &surface, &problem, &[-8.0, 2.0]).unwrap();
        assert_eq!(found[0].force_defect.value, 0.0);
        // 0.5 m · 2 N of friction, about z.
        assert!((found[0].moment_defect.value - 1.0).abs() < 1e-15);
        let frictionless = exchange(&bodies, &pairs(), &surface, &problem, &[-8.0, 0.0]).unwrap();
        assert_eq!(frictionless[0].moment_defect.value, 0.0);
    }

    #[test]
    fn an_obstacle_answers_nothing() {
        let (bodies, mut surface, problem) = lid_on_box(0.0);
        let mut pairs = pairs();
        pairs.swap(0, 1);
        surface.nodes[0].opposite = None;
        let found = exchange(&bodies, &pairs, &surface, &problem, &[-8.0, 2.0]).unwrap();
        assert_eq!(found[0].own.force, [2.0, 8.0, 0.0]);
        assert_eq!(
            (found[0].opposite, found[0].force_defect.value),
            (None, 0.0)
        );
        assert_eq!(found[1].opposite, Some(Resultant::default()));
    }

    #[test]
    fn weights_that_do_not_add_up_to_one_lose_force() {
        let (bodies, mut surface, problem) = lid_on_box(0.0);
        if let Some(opposite) = &mut surface.nodes[0].opposite {
            opposite.nodes.pop();
        }
        let found = exchange(&bodies, &pairs(), &surface, &problem, &[-8.0, 0.0]).unwrap();
        // 8 N − ¾ · 8 N, of 8 + 6 N.
        assert_eq!(found[0].force_defect.value, 2.0);
        assert!((found[0].force_defect.scaled - 2.0 / 14.0).abs() < 1e-15);
    }

    #[test]
    fn contacts_of_unknown_pairs_bodies_and_nodes_are_refused() {
        let (bodies, surface, problem) = lid_on_box(0.0);
        let refused = |surface: &ContactSurface, word: &str| {
            let found = exchange(&bodies, &pairs(), surface, &problem, &[0.0; 2]);
            matches!(found, Err(Error::UnknownIndex { what, .. }) if what == word)
        };
        let mut changed = surface.clone();
        changed.nodes[0].pair = 2;
        assert!(refused(&changed, "pair"));
        let mut changed = surface.clone();
        changed.nodes[0].body = 9;
        assert!(refused(&changed, "body"));
        let mut changed = surface.clone();
        if let Some(opposite) = &mut changed.nodes[0].opposite {
            opposite.nodes[0].0 = 9;
        }
        assert!(refused(&changed, "node"));
        let short = exchange(&bodies, &pairs(), &surface, &problem, &[0.0]);
        assert!(matches!(short, Err(Error::Length { .. })));
    }
}
