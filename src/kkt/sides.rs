//! The two sides of a contact: the nodes it moves with and the forces they receive.
//!
//! ```text
//! (K5)  u = R (Σ_k b_k u_k − Σ_j w_j u_j)       rows of R: the contact's directions
//!       f_k = b_k Rᵀ t,   f_j = −w_j Rᵀ t       k: nodes of its own side, j: of the other side
//! ```

use crate::body::Body;
use crate::contact::{ContactNode, ContactSurface};
use crate::error::{Error, check_length};
use crate::problem::ContactProblem;

/// A node that moves with a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Share {
    pub(super) body: usize,
    pub(super) node: usize,
    /// It is on the contact's own side.
    pub(super) own: bool,
    /// Weight on the contact's own side, minus the mortar weight on the other.
    pub(super) weight: f64,
}

/// The contact's own nodes first, then those of the other side.
pub(super) fn shares(contact: &ContactNode) -> impl Iterator<Item = Share> + '_ {
    let own = contact.own.iter().map(|&(node, weight)| Share {
        body: contact.body,
        node,
        own: true,
        weight,
    });
    let opposite = contact.opposite.iter().flat_map(|side| {
        side.nodes.iter().map(|&(node, weight)| Share {
            body: side.body,
            node,
            own: false,
            weight: -weight,
        })
    });
    own.chain(opposite)
}

/// Force of one contact on its own body in global axes, in newton, from its block of the
/// reaction (K5).
#[must_use]
pub(crate) fn global_force(contact: &ContactNode, block: &[f64]) -> [f64; 3] {
    let mut force = [0.0; 3];
    for (direction, t) in contact.frame.iter().zip(block) {
        for axis in 0..3 {
            force[axis] += t * direction[axis];
        }
    }
    force
}

/// Displacement of one contact relative to the other side in global axes, in metre (K5).
///
/// `displacements` are per body and unknown (`node · dimension + axis`), of bodies and
/// nodes that exist.
#[must_use]
pub(crate) fn relative_displacement(
    contact: &ContactNode,
    displacements: &[Vec<f64>],
    dimension: usize,
) -> [f64; 3] {
    let mut relative = [0.0; 3];
    for share in shares(contact) {
        let of_node = &displacements[share.body][share.node * dimension..][..dimension];
        for (sum, u) in relative.iter_mut().zip(of_node) {
            *sum += share.weight * u;
        }
    }
    relative
}

/// The unknowns of one contact.
pub(super) fn block<'v>(problem: &ContactProblem, contact: usize, values: &'v [f64]) -> &'v [f64] {
    let offsets = problem.offsets();
    &values[offsets[contact]..offsets[contact + 1]]
}

/// Refuses a surface of another problem, and values that are not one per unknown.
pub(super) fn check_surface(
    surface: &ContactSurface,
    problem: &ContactProblem,
    place: &str,
    values: &[f64],
) -> Result<(), Error> {
    check_length("contact nodes", problem.contacts(), surface.nodes.len())?;
    check_length(place, problem.unknowns(), values.len())
}

/// Refuses contacts at nodes that the body `index` does not have.
pub(super) fn check_nodes(
    surface: &ContactSurface,
    index: usize,
    body: &Body,
) -> Result<(), Error> {
    let count = body.mesh.nodes.len();
    for (i, contact) in surface.nodes.iter().enumerate() {
        let shares = shares(contact).filter(|share| share.body == index);
        let own = (contact.body == index).then_some(contact.node);
        let mut nodes = own.into_iter().chain(shares.map(|share| share.node));
        if let Some(stray) = nodes.find(|node| *node >= count) {
            return Err(Error::UnknownIndex {
                place: format!("contact nodes[{i}]"),
                what: "node",
                index: stray,
                count,
            });
        }
    }
    Ok(())
}

/// Refuses contacts at bodies, or at nodes of them, that do not exist.
pub(super) fn check_sides(surface: &ContactSurface, bodies: &[Body]) -> Result<(), Error> {
    for (i, contact) in surface.nodes.iter().enumerate() {
        let stray = shares(contact).find(|share| share.body >= bodies.len());
        if let Some(stray) = stray {
            return Err(Error::UnknownIndex {
                place: format!("contact nodes[{i}]"),
                what: "body",
                index: stray.body,
                count: bodies.len(),
            });
        }
    }
    let mut bodies = bodies.iter().enumerate();
    bodies.try_for_each(|(index, body)| check_nodes(surface, index, body))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kkt::tests::samples::lid_on_box;

    fn contact() -> ContactNode {
        lid_on_box(0.0).1.nodes.remove(0)
    }

    #[test]
    fn a_motion_that_both_sides_share_is_no_relative_displacement() {
        let together = [vec![5.0, 7.0], vec![5.0, 7.0, 5.0, 7.0]];
        assert_eq!(relative_displacement(&contact(), &together, 2), [0.0; 3]);
    }

    #[test]
    fn the_other_side_moves_by_its_weighted_nodes() {
        let (own, opposite) = (vec![1.0, 2.0], vec![4.0, 0.0, 0.0, 4.0]);
        // (1, 2) − 0.25 (4, 0) − 0.75 (0, 4) = (0, −1).
        let found = relative_displacement(&contact(), &[own, opposite], 2);
        assert_eq!(found, [0.0, -1.0, 0.0]);
    }

    #[test]
    fn a_reaction_acts_along_the_directions_of_its_contact() {
        // t_N = −8 N against the normal (0, −1), 3 N along x.
        assert_eq!(global_force(&contact(), &[-8.0, 3.0]), [3.0, 8.0, 0.0]);
    }
}
