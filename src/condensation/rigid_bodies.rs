//! The bodies as rigid ones: what their supports leave free, and how contacts and loads feel it.

use std::borrow::Borrow;

use faer::Mat;

use super::carried::Carried;
use super::grounding::Grounding;
use crate::body;
use crate::body::Body;
use crate::contact::{ContactNode, ContactPair, ContactSurface, RigidBody, RigidMotion};
use crate::error::Error;
use crate::problem::Floating;

/// Contacts whose two sides move alike, as those between two faces of one part, feel nothing of a mode but the
/// round-off of the mortar's weights: displacements below this part of the mode's largest, and works below
/// this part of what cancels.
const ROUND_OFF: f64 = 1e-13;

/// Bodies, their contact surface and their free modes, without any stiffness.
#[derive(Debug)]
pub(crate) struct RigidBodies {
    surface: ContactSurface,
    groundings: Vec<Grounding>,
    carried: Carried,
    dimension: usize,
}

/// How one unconnected part of a body moves: `translation + rotation × (x − centre)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartMotion {
    /// Index of the body.
    pub body: usize,
    /// Mean position of the part's nodes, in metre.
    pub centre: [f64; 3],
    /// Distance of its farthest node from there, in metre.
    pub size: f64,
    /// Displacement of the centre, in metre.
    pub translation: [f64; 3],
    /// Rotation, in radian.
    pub rotation: [f64; 3],
}

impl RigidBodies {
    /// Finds the contact surface and the free modes.
    ///
    /// # Errors
    ///
    /// What [`check`](body::check()), [`prescribed`](body::prescribed()) and
    /// [`ContactSurface::new`] refuse.
    pub(crate) fn new(
        bodies: &[Body],
        pairs: &[ContactPair],
        rigid: &[RigidBody],
    ) -> Result<Self, Error> {
        let mut prescribed = Vec::with_capacity(bodies.len());
        for body in bodies {
            body::check(body)?;
            prescribed.push(body::prescribed(body)?);
        }
        let surface = ContactSurface::new(bodies, pairs, &prescribed)?;
        let held = bodies.iter().zip(&prescribed);
        Ok(Self {
            carried: Carried::new(rigid, bodies, &surface),
            surface,
            groundings: held
                .map(|(body, held)| {
                    Ok(Grounding::new(
                        body,
                        (held, body::dependence(body)?.as_ref()),
                        &[],
                    ))
                })
                .collect::<Result<_, Error>>()?,
            dimension: bodies.first().map_or(3, |body| body.mesh.dimension),
        })
    }

    /// The contact surface.
    #[must_use]
    pub(crate) fn surface(&self) -> &ContactSurface {
        &self.surface
    }

    /// The contact surface alone.
    #[must_use]
    pub(crate) fn into_surface(self) -> ContactSurface {
        self.surface
    }

    /// R of (C3), per contact unknown and free mode.
    #[must_use]
    pub(crate) fn modes(&self) -> Mat<f64> {
        contact_modes(
            &self.surface,
            &self.groundings,
            self.dimension,
            &self.carried,
        )
    }

    /// Work on every free mode of nodal forces per body (`node · dimension + axis`), in newton; none on those of
    /// rigid bodies.
    #[must_use]
    pub(crate) fn load(&self, forces: &[Vec<f64>]) -> Vec<f64> {
        let mut load = mode_loads(&self.groundings, forces);
        load.resize(load.len() + self.carried.modes(), 0.0);
        load
    }

    /// The same of the force on one component of a rigid body.
    #[must_use]
    pub(crate) fn rigid_load(&self, body: usize, component: usize) -> Vec<f64> {
        let mut load = vec![0.0; self.elastic_modes()];
        load.extend(self.carried.load_of(body, component));
        load
    }

    fn elastic_modes(&self) -> usize {
        let modes = self
            .groundings
            .iter()
            .map(|grounding| grounding.modes.ncols());
        modes.sum()
    }

    /// How the free parts move under an amplitude per free mode, in metre.
    #[must_use]
    pub(crate) fn motions(&self, motion: &[f64]) -> Vec<PartMotion> {
        let mut parts = part_motions(&self.groundings, motion);
        let rigid = &motion[self.elastic_modes()..];
        parts.extend(rigid_parts(&self.carried, self.groundings.len(), rigid));
        parts
    }
}

/// R and e of (C3); none if every body is held.
pub(super) fn floating(
    surface: &ContactSurface,
    groundings: &[&Grounding],
    forces: &[&[f64]],
    dimension: usize,
    carried: &Carried,
) -> Result<Option<Floating>, Error> {
    let mut load = mode_loads(groundings, forces);
    load.extend(carried.load());
    if load.is_empty() {
        return Ok(None);
    }
    let modes = contact_modes(surface, groundings, dimension, carried);
    Floating::of_bodies(modes, load).map(Some)
}

fn contact_modes(
    surface: &ContactSurface,
    groundings: &[impl Borrow<Grounding>],
    dimension: usize,
    carried: &Carried,
) -> Mat<f64> {
    let unknowns = surface.nodes.iter().map(|node| 1 + node.tangents).sum();
    let of_bodies = groundings.iter().map(Borrow::borrow).enumerate();
    let columns: Vec<(usize, &[f64])> = of_bodies
        .flat_map(|(index, grounding)| {
            let modes = 0..grounding.modes.ncols();
            modes.map(move |k| (index, grounding.modes.col_as_slice(k)))
        })
        .collect();
    let elastic = columns.len();
    let mut modes = Mat::zeros(unknowns, elastic + carried.modes());
    carried.fill(
        surface,
        modes.as_mut().subcols_mut(elastic, carried.modes()),
    );
    for (k, (body, mode)) in columns.into_iter().enumerate() {
        let mut entries = modes.col_as_slice_mut(k).iter_mut();
        for contact in &surface.nodes {
            let moved = moved(contact, body, mode, dimension);
            for (row, entry) in contact.frame[..=contact.tangents].iter().zip(&mut entries) {
                *entry = row.iter().zip(moved).map(|(d, u)| d * u).sum();
            }
        }
        let felt = modes.col_as_slice_mut(k);
        if largest(felt) <= ROUND_OFF * largest(mode) {
            felt.fill(0.0);
        }
    }
    modes
}

fn largest(displacements: &[f64]) -> f64 {
    displacements.iter().fold(0.0, |most, u| u.abs().max(most))
}

/// Relative displacement of a contact, in global axes, under one mode of body `index`.
fn moved(contact: &ContactNode, index: usize, mode: &[f64], axes: usize) -> [f64; 3] {
    let own = contact.own.iter().filter(|_| contact.body == index);
    let opposite = contact.opposite.iter().filter(|side| side.body == index);
    let opposite = opposite.flat_map(|side| side.nodes.iter().map(|&(node, w)| (node, -w)));
    let mut moved = [0.0; 3];
    for (node, weight) in own.copied().chain(opposite) {
        for (axis, sum) in moved[..axes].iter_mut().enumerate() {
            *sum += weight * mode[node * axes + axis];
        }
    }
    moved
}

/// e of (C3): work of nodal forces per body on the free modes, in newton. Forces that are in equilibrium
/// with each other, as those of heat are, leave no round-off behind.
pub(super) fn mode_loads(
    groundings: &[impl Borrow<Grounding>],
    forces: &[impl AsRef<[f64]>],
) -> Vec<f64> {
    let of_bodies = groundings.iter().map(Borrow::borrow).zip(forces);
    of_bodies
        .flat_map(|(grounding, forces)| {
            grounding.modes.col_iter().map(move |mode| {
                let works = mode.iter().zip(forces.as_ref()).map(|(r, f)| r * f);
                let (sum, size) =
                    works.fold((0.0, 0.0), |(sum, size), w| (sum + w, size + w.abs()));
                if f64::abs(sum) <= ROUND_OFF * size {
                    0.0
                } else {
                    sum
                }
            })
        })
        .collect()
}

/// How rigid bodies move under an amplitude per mode, numbered after `elastic` others.
pub(super) fn rigid_parts(
    carried: &Carried,
    elastic: usize,
    amplitudes: &[f64],
) -> Vec<PartMotion> {
    let motions = carried.freely(amplitudes).into_iter().zip(carried.sizes());
    let of_body = |(body, (motion, &size)): (usize, (RigidMotion, &f64))| PartMotion {
        body: elastic + body,
        centre: motion.about,
        size,
        translation: motion.translation,
        rotation: motion.rotation,
    };
    motions.enumerate().map(of_body).collect()
}

pub(super) fn part_motions(
    groundings: &[impl Borrow<Grounding>],
    motion: &[f64],
) -> Vec<PartMotion> {
    let of_bodies = groundings.iter().map(Borrow::borrow).enumerate();
    let modes = of_bodies.flat_map(|(body, grounding)| {
        let modes = grounding.rigid.iter();
        modes.map(move |(mode, size)| (body, mode, *size))
    });
    let mut parts: Vec<((usize, usize), PartMotion)> = Vec::new();
    for ((body, mode, size), amplitude) in modes.zip(motion) {
        let key = (body, mode.part);
        if parts.last().is_none_or(|(last, _)| *last != key) {
            let at_rest = PartMotion {
                body,
                centre: mode.centre,
                size,
                translation: [0.0; 3],
                rotation: [0.0; 3],
            };
            parts.push((key, at_rest));
        }
        if let Some((_, part)) = parts.last_mut() {
            for axis in 0..3 {
                part.translation[axis] += amplitude * mode.translation[axis];
                part.rotation[axis] += amplitude * mode.rotation[axis];
            }
        }
    }
    parts.into_iter().map(|(_, part)| part).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::CellKind;
    use crate::body::tests::samples::{block, facets};
    use crate::contact::{Obstacle, Opposite};

    /// The block of 2 × 1 m (2D) on a floor, free.
    fn loose() -> (Body, RigidBodies) {
        let body = block(CellKind::Quad4);
        let pair = ContactPair::new(
            "contacts[0]",
            0,
            facets(&body.mesh, "bottom"),
            Opposite::Obstacle(Obstacle::Plane {
                point: [0.0; 3],
                normal: [0.0, 1.0, 0.0],
            }),
            0.5,
        );
        let rigid = RigidBodies::new(std::slice::from_ref(&body), &[pair], &[]).unwrap();
        (body, rigid)
    }

    #[test]
    fn modes_at_the_contacts_are_the_motions_of_their_nodes() {
        let (_, rigid) = loose();
        let modes = rigid.modes();
        assert_eq!(
            (modes.nrows(), modes.ncols()),
            (2 * rigid.surface().nodes.len(), 3)
        );
        for k in 0..3 {
            let motion: Vec<f64> = (0..3).map(|j| if j == k { 1.0 } else { 0.0 }).collect();
            let part = rigid.motions(&motion)[0];
            for (i, contact) in rigid.surface().nodes.iter().enumerate() {
                // u = a + ω × (x − c), along the normal and the tangent.
                let arm = [
                    contact.position[0] - part.centre[0],
                    contact.position[1] - part.centre[1],
                ];
                let u = [
                    part.translation[0] - part.rotation[2] * arm[1],
                    part.translation[1] + part.rotation[2] * arm[0],
                ];
                for row in 0..2 {
                    let along = contact.frame[row][0] * u[0] + contact.frame[row][1] * u[1];
                    assert!((modes[(2 * i + row, k)] - along).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn a_load_works_on_a_motion_as_its_resultant_does() {
        // 5 N along x at the node (2, 0): the work of any motion is 5 N times its u_x there.
        let (body, rigid) = loose();
        let node = body
            .mesh
            .nodes
            .iter()
            .position(|x| *x == [2.0, 0.0, 0.0])
            .unwrap();
        let mut forces = vec![0.0; 2 * body.mesh.nodes.len()];
        forces[2 * node] = 5.0;
        let works = rigid.load(&[forces]);
        for (k, work) in works.iter().enumerate() {
            let motion: Vec<f64> = (0..3).map(|j| if j == k { 1.0 } else { 0.0 }).collect();
            let part = rigid.motions(&motion)[0];
            let u_x = part.translation[0] + part.rotation[2] * part.centre[1];
            assert!((work - 5.0 * u_x).abs() < 1e-13);
        }
    }
}
