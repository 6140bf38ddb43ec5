//! What the two sides of a contact pair give each other.
//!
//! ```text
//! (K6)  Σ_own f + Σ_opposite f = 0,   Σ_own x × f + Σ_opposite x × f = Σ g₀ (f × n)
//! ```
//!
//! Mortar weights add up to one, so forces cancel whatever the meshes. Moments cancel up to
//! gap × friction: displacements are small, each side is loaded where it stood before, and
//! a friction force acts on the two sides along parallel lines, an initial gap g₀ apart.

use super::resultant::{Defect, Resultant, length};
use super::sides::{block, check_sides, check_surface, global_force, shares};
use crate::body::Body;
use crate::condensation::{ContactPair, ContactProblem, ContactSurface, Opposite};
use crate::error::Error;

/// Sum of the contact forces of a pair on either side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exchange {
    /// What the bodies receive whose nodes carry the contacts.
    pub own: Resultant,
    /// What the opposite body receives; none if that is a rigid obstacle.
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
        for (k, share) in shares(contact).enumerate() {
            let position = bodies[share.body].mesh.nodes[share.node];
            let received = force.map(|f| share.weight * f);
            sums.add(k == 0, position, received);
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
