//! A body with everything that acts on it, and what its unknowns make of (K4).

use sprs::CsMat;

use super::certificate::Worst;
use crate::body::Body;
use crate::condensation::{ContactNode, ContactProblem, ContactSurface};
use crate::error::{Error, check_length};

/// A body with everything that acts on it; unknown `node · dimension + axis`.
#[derive(Clone, Copy, Debug)]
pub struct BodyState<'a> {
    /// Mesh and supports.
    pub body: &'a Body,
    /// K, both triangles, in N/m.
    pub stiffness: &'a CsMat<f64>,
    /// f per unknown, in newton.
    pub load: &'a [f64],
    /// Given displacement per unknown, in metre; `None` where free.
    pub prescribed: &'a [Option<f64>],
    /// Contact nodes and frames.
    pub surface: &'a ContactSurface,
    /// The condensed problem on that surface.
    pub problem: &'a ContactProblem,
    /// Contact reaction per contact unknown, in newton.
    pub reaction: &'a [f64],
    /// Displacement per contact unknown as the judge computed it, in metre.
    pub contact_displacement: &'a [f64],
    /// Recovered displacement per unknown of the body, in metre.
    pub displacement: &'a [f64],
}

impl BodyState<'_> {
    /// Refuses arrays that do not belong together.
    pub(super) fn check(&self) -> Result<(), Error> {
        let nodes = self.body.mesh.nodes.len();
        let (size, unknowns) = (nodes * self.dimension(), self.problem.unknowns());
        let contacts = self.problem.contacts();
        check_length("stiffness rows", size, self.stiffness.rows())?;
        check_length("stiffness columns", size, self.stiffness.cols())?;
        check_length("load", size, self.load.len())?;
        check_length("prescribed", size, self.prescribed.len())?;
        check_length("displacement", size, self.displacement.len())?;
        check_length("contact nodes", contacts, self.surface.nodes.len())?;
        check_length("reaction", unknowns, self.reaction.len())?;
        let condensed = self.contact_displacement.len();
        check_length("contact_displacement", unknowns, condensed)?;
        let mut contacts = self.surface.nodes.iter().map(|contact| contact.node);
        match contacts.position(|node| node >= nodes) {
            None => Ok(()),
            Some(contact) => Err(Error::OutOfRange {
                place: format!("contact nodes[{contact}]"),
                value: self.surface.nodes[contact].node as f64,
                accepted: "a node of the mesh",
            }),
        }
    }

    pub(super) fn dimension(&self) -> usize {
        self.body.mesh.dimension
    }

    /// c of (K4), per unknown of the body, in newton.
    pub(super) fn contact_forces(&self) -> Vec<f64> {
        let mut forces = vec![0.0; self.load.len()];
        for (i, contact) in self.surface.nodes.iter().enumerate() {
            let force = global_force(contact, self.block(i, self.reaction));
            let first = contact.node * self.dimension();
            for (axis, f) in force.into_iter().enumerate().take(self.dimension()) {
                forces[first + axis] += f;
            }
        }
        forces
    }

    /// s = K u − f − c of (K4), per unknown of the body, in newton.
    pub(super) fn support_reactions(&self, contact: &[f64]) -> Vec<f64> {
        let u = self.displacement;
        let rows = self.stiffness.outer_iterator();
        rows.zip(self.load.iter().zip(contact))
            .map(|(row, (f, c))| row.iter().map(|(k, entry)| entry * u[k]).sum::<f64>() - f - c)
            .collect()
    }

    /// Displacement minus the given one, zero where free, in metre.
    pub(super) fn support_departure(&self) -> Vec<f64> {
        let pairs = self.prescribed.iter().zip(self.displacement);
        pairs
            .map(|(given, u)| given.map_or(0.0, |given| u - given))
            .collect()
    }

    /// Largest difference between the body's and the condensed displacement, in metre.
    pub(super) fn surface_departure(&self) -> Worst {
        let mut worst = Worst::default();
        for (i, contact) in self.surface.nodes.iter().enumerate() {
            let u = &self.displacement[contact.node * self.dimension()..][..self.dimension()];
            let condensed = self.block(i, self.contact_displacement);
            for (direction, condensed) in contact.frame.iter().zip(condensed) {
                let along: f64 = direction.iter().zip(u).map(|(d, u)| d * u).sum();
                worst.raise((along - condensed).abs(), i);
            }
        }
        worst
    }

    /// The unknowns of one contact.
    fn block<'v>(&self, contact: usize, values: &'v [f64]) -> &'v [f64] {
        let offsets = self.problem.offsets();
        &values[offsets[contact]..offsets[contact + 1]]
    }
}

/// Force of one contact on the body in global axes, in newton, from its block of the reaction.
#[must_use]
pub fn global_force(contact: &ContactNode, block: &[f64]) -> [f64; 3] {
    let mut force = [0.0; 3];
    for (direction, t) in contact.frame.iter().zip(block) {
        for axis in 0..3 {
            force[axis] += t * direction[axis];
        }
    }
    force
}
