//! The contact surface: nodes, local frames, initial gaps and areas.
//!
//! ```text
//! area of node i    Σ ∫ N_i dA        over the facing facets of its pair
//! initial gap       signed distance from the node to the obstacle
//! ```
//!
//! Contacts stand at corners; those of quadratic facets move with the nodes around, (C16) in
//! `footing`, and their gaps are means. Areas of axisymmetric bodies go around the axis.

use super::Obstacle;
use super::facing::Boundary;
use super::obstacle_contacts::on_obstacle;
use super::paired::between_surfaces;
use crate::body::{Body, Facet};
use crate::error::{Error, check_finite, check_length};

/// A part of a body's surface that may touch a rigid obstacle or another surface.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPair {
    /// Where the scene says so, for messages, such as `contacts[0]`.
    pub place: String,
    /// Index of the body that the pair names first. Its nodes carry the contacts, unless it
    /// is more than a hundred times as stiff at the surface as the body opposite: then
    /// those of that one do. On flat faces either choice is exact for a uniform pressure;
    /// on curved ones the coarser side averages over the other's facets, while the finer
    /// one follows them in its pressures.
    pub body: usize,
    /// The assumed contact surface; it need only contain the true contact.
    pub facets: Vec<Facet>,
    /// What it may touch.
    pub opposite: Opposite,
    /// Coefficient of friction, `μ ≥ 0`.
    pub friction: f64,
}

/// The other side of a contact pair.
#[derive(Clone, Debug, PartialEq)]
pub enum Opposite {
    /// A rigid obstacle.
    Obstacle(Obstacle),
    /// The surface of a body: another one, or the other face of a crack in the same.
    Surface {
        /// Index of that body.
        body: usize,
        /// Its facets.
        facets: Vec<Facet>,
    },
}

/// The nodes of the other side that a contact is coupled to.
#[derive(Clone, Debug, PartialEq)]
pub struct OppositeNodes {
    /// Index of the body.
    pub body: usize,
    /// Nodes and their mortar weights, which add up to one.
    pub nodes: Vec<(usize, f64)>,
}

/// One corner of the contact surface, facing the other side.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactNode {
    /// Index of the body.
    pub body: usize,
    /// Node of its mesh where it stands.
    pub node: usize,
    /// Nodes of the body that it moves with and their weights, which add up to one: its own
    /// node alone on linear facets, those around it on quadratic ones.
    pub own: Vec<(usize, f64)>,
    /// The other side; none if that is a rigid obstacle.
    pub opposite: Option<OppositeNodes>,
    /// Index of the contact pair.
    pub pair: usize,
    /// Position before loading, in metre.
    pub position: [f64; 3],
    /// Orthonormal rows: normal (towards the other side), then the tangents.
    pub frame: [[f64; 3]; 3],
    /// Number of tangents that the contact problem holds: 0 without friction, at most
    /// 1 in 2D and 2 in 3D, fewer where a support holds one.
    pub tangents: usize,
    /// Distance along the normal to the other side before loading, in metre.
    pub initial_gap: f64,
    /// Tributary area, in m² (plane bodies: for their depth, axisymmetric ones: of the ring).
    pub area: f64,
    /// It stands on the second surface of its pair, which is much the softer one.
    pub second: bool,
    /// The body's surface goes on beyond the assumed contact surface here.
    pub rim: bool,
}

impl ContactNode {
    /// Where its displacement is measured and its force acts on its own body, whose nodes are at
    /// `nodes`: the mean of those that it moves with, in metre.
    #[must_use]
    pub fn centre(&self, nodes: &[[f64; 3]]) -> [f64; 3] {
        let mut centre = [0.0; 3];
        for &(node, weight) in &self.own {
            for (sum, x) in centre.iter_mut().zip(nodes[node]) {
                *sum += weight * x;
            }
        }
        centre
    }
}

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
        let scene = Bodies {
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
            }
            let of_body = |facet| (found.body, facet);
            surface.nodes.append(&mut found.contacts);
            surface.facets.extend(found.facets.into_iter().map(of_body));
            let left_out = found.left_out.into_iter();
            surface
                .left_out
                .extend(left_out.map(|node| (found.body, node)));
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
    pub fn obstacle_motions(&self, obstacles: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let of = |contact: &ContactNode| match contact.opposite {
            None => obstacles.get(contact.pair).copied().unwrap_or_default(),
            Some(_) => [0.0; 3],
        };
        self.nodes.iter().map(of).collect()
    }
}

/// Bodies of a scene with what is known of each.
pub(super) struct Bodies<'a> {
    pub(super) bodies: &'a [Body],
    pub(super) boundaries: &'a [Boundary<'a>],
    /// Prescribed displacement per body and degree of freedom.
    pub(super) prescribed: &'a [Vec<Option<f64>>],
}

/// What one pair adds to the contact surface.
pub(super) struct PairSurface {
    /// The body whose nodes carry the contacts.
    pub(super) body: usize,
    pub(super) contacts: Vec<ContactNode>,
    pub(super) facets: Vec<Facet>,
    pub(super) left_out: Vec<usize>,
}

/// Refuses the number of a body that does not exist.
pub(super) fn check_pair_body(place: &str, body: usize, count: usize) -> Result<(), Error> {
    if body < count {
        return Ok(());
    }
    Err(Error::UnknownIndex {
        place: place.to_owned(),
        what: "body",
        index: body,
        count,
    })
}

impl ContactPair {
    fn check(&self, dimension: usize) -> Result<(), Error> {
        if let Opposite::Obstacle(obstacle) = &self.opposite {
            obstacle.check(&self.place, dimension)?;
        }
        let place = format!("{}.friction", self.place);
        if self.friction.is_finite() && self.friction < 0.0 {
            return Err(Error::OutOfRange {
                place,
                value: self.friction,
                accepted: "friction >= 0",
            });
        }
        check_finite(&place, &[self.friction])
    }
}
