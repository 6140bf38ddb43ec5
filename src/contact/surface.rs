//! The contact surface: nodes, local frames, initial gaps and areas.
//!
//! ```text
//! area of node i    Σ ∫ N_i dA        over the facing facets of its pair
//! initial gap       signed distance from the node to the obstacle; zero where the sides are tied as they are drawn
//! ```
//!
//! Contacts stand at corners; those of quadratic facets move with the nodes around, (C16) in
//! `footing`, and their gaps are means. Areas of axisymmetric bodies go around the axis.

use super::between_bodies::between_surfaces;
use super::facing::{Bodies, Boundary};
use super::node::ContactNode;
use super::on_obstacle::on_obstacle;
use super::pair::{ContactPair, Coupling, Opposite, check_pair_body};
use crate::body::{Body, Dependence, Facet, dependence};
use crate::error::{Error, check_length};

/// The contact nodes in the order of the contact problem, and what was left out.
///
/// A node may stand in several pairs, a pair may stand twice, and a face may be the first
/// side of one pair and the second of another: each time it is a contact of its own. How
/// such contacts share a force is then not unique; displacements and resultants are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactSurface {
    /// Contact nodes, one per contact.
    pub nodes: Vec<ContactNode>,
    /// Facets that face the other side, with the index of their body (its node numbers,
    /// outward order), for areas and plots; their nodes are contact nodes or left out.
    pub facets: Vec<(usize, Facet)>,
    /// Bodies and nodes of the surface that are no contacts because a support holds
    /// their normal.
    pub left_out: Vec<(usize, usize)>,
    /// How each pair is coupled.
    pub couplings: Vec<Coupling>,
}

impl ContactSurface {
    /// Finds the contact nodes of all pairs.
    ///
    /// `prescribed` holds the prescribed displacement per body and degree of freedom
    /// (`node · dimension + axis`), in metre.
    ///
    /// # Errors
    ///
    /// A body that does not exist, an obstacle without a surface, a friction coefficient
    /// that is negative or not finite, a facet that is not on the boundary or on both sides
    /// of a pair, a pair of which nothing faces the other side, bodies that overlap deeper
    /// than a fit, a support at an angle to an obstacle's normal, a support that drags a
    /// contact with friction along an obstacle, or no contact node at all.
    pub fn new(
        bodies: &[Body],
        pairs: &[ContactPair],
        prescribed: &[Vec<Option<f64>>],
    ) -> Result<Self, Error> {
        check_length("prescribed", bodies.len(), prescribed.len())?;
        for (body, prescribed) in bodies.iter().zip(prescribed) {
            let unknowns = body.mesh.nodes.len() * body.mesh.dimension;
            let place = format!("{}: prescribed", body.name);
            check_length(&place, unknowns, prescribed.len())?;
        }
        let mut surface = Self::default();
        let boundaries = bodies.iter().map(Boundary::new);
        let boundaries: Vec<Boundary> = boundaries.collect();
        let tied = bodies.iter().map(dependence);
        let tied: Vec<Option<Dependence>> = tied.collect::<Result<_, _>>()?;
        let scene = Bodies {
            tied: &tied,
            bodies,
            boundaries: &boundaries,
            prescribed,
        };
        for (index, pair) in pairs.iter().enumerate() {
            check_pair_body(&pair.place, pair.body, bodies.len())?;
            pair.check(bodies[pair.body].mesh.dimension)?;
            let mut found = match &pair.opposite {
                Opposite::Obstacle(obstacle) => on_obstacle(&scene, pair, obstacle)?,
                Opposite::Surface { body, facets } => {
                    between_surfaces(&scene, pair, *body, facets)?
                }
            };
            for contact in &mut found.contacts {
                contact.pair = index;
                if pair.law.bilateral {
                    // As they are drawn.
                    contact.initial_gap = 0.0;
                }
            }
            let body = found.coupling.body;
            let of_body = |facet| (body, facet);
            surface.couplings.push(found.coupling);
            surface.nodes.append(&mut found.contacts);
            surface.facets.extend(found.facets.into_iter().map(of_body));
            let left_out = found.left_out.into_iter();
            surface.left_out.extend(left_out.map(|node| (body, node)));
        }
        if surface.nodes.is_empty() {
            return Err(Error::EmptyContactSurface {
                pairs: pairs.len(),
                left_out: surface.left_out.len(),
            });
        }
        surface.left_out.sort_unstable();
        surface.left_out.dedup();
        Ok(surface)
    }

    /// Motion of each contact's other side in global axes, from that of the obstacle per contact
    /// pair; zero between bodies, and for a pair without an entry. In metre.
    #[must_use]
    pub(crate) fn obstacle_motions(&self, obstacles: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let of = |contact: &ContactNode| match contact.opposite {
            None => obstacles.get(contact.pair).copied().unwrap_or_default(),
            Some(_) => [0.0; 3],
        };
        self.nodes.iter().map(of).collect()
    }
}
