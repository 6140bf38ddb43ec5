//! A body with everything that acts on it, and what its unknowns make of (K4).

use sprs::CsMat;

use super::sides::{block, check_nodes, check_surface, global_force, shares};
use crate::body::{Body, Equation};
use crate::condensation::Condensed;
use crate::contact::ContactSurface;
use crate::error::{Error, check_length};
use crate::problem::ContactProblem;

/// A body with everything that acts on it; unknown `node · dimension + axis`.
#[derive(Clone, Copy, Debug)]
pub struct BodyState<'a> {
    /// Which body of the contact surface this is.
    pub index: usize,
    /// Mesh and supports.
    pub body: &'a Body,
    /// K, both triangles, in N/m.
    pub stiffness: &'a CsMat<f64>,
    /// f per unknown, in newton.
    pub load: &'a [f64],
    /// Given displacement per unknown, in metre; `None` where free.
    pub prescribed: &'a [Option<f64>],
    /// Equations between displacements (B14); none where supports give single displacements only.
    pub equations: &'a [Equation],
    /// Their right hand sides, in metre.
    pub values: &'a [f64],
    /// Contacts of all bodies.
    pub surface: &'a ContactSurface,
    /// The condensed problem on that surface.
    pub problem: &'a ContactProblem,
    /// Contact reaction per contact unknown, in newton.
    pub reaction: &'a [f64],
    /// Recovered displacement per unknown of the body, in metre.
    pub displacement: &'a [f64],
}

impl<'a> BodyState<'a> {
    /// The states of condensed bodies under one reaction, in newton per contact unknown, with
    /// their recovered displacements, in metre per body and unknown.
    #[must_use]
    pub fn of_bodies(
        bodies: &'a [Body],
        condensed: &'a Condensed,
        reaction: &'a [f64],
        displacements: &'a [Vec<f64>],
    ) -> Vec<Self> {
        let parts = bodies.iter().zip(condensed.bodies()).zip(displacements);
        parts
            .enumerate()
            .map(|(index, ((body, operators), displacement))| Self {
                index,
                body,
                stiffness: operators.stiffness(),
                load: operators.load(),
                prescribed: operators.prescribed(),
                equations: operators.equations().0,
                values: operators.equations().1,
                surface: condensed.surface(),
                problem: condensed.problem(),
                reaction,
                displacement,
            })
            .collect()
    }
}

impl BodyState<'_> {
    /// Refuses arrays that do not belong together.
    pub(super) fn check(&self) -> Result<(), Error> {
        let nodes = self.body.mesh.nodes.len();
        let size = nodes * self.dimension();
        check_length("stiffness rows", size, self.stiffness.rows())?;
        check_length("stiffness columns", size, self.stiffness.cols())?;
        check_length("load", size, self.load.len())?;
        check_length("prescribed", size, self.prescribed.len())?;
        check_length("values", self.equations.len(), self.values.len())?;
        check_length("displacement", size, self.displacement.len())?;
        check_surface(self.surface, self.problem, "reaction", self.reaction)?;
        check_nodes(self.surface, self.index, self.body)
    }

    pub(super) fn dimension(&self) -> usize {
        self.body.mesh.dimension
    }

    /// c of (K4), per unknown of the body, in newton: from contacts of its own nodes and
    /// from those of other surfaces that it stands opposite to (K5).
    pub(super) fn contact_forces(&self) -> Vec<f64> {
        let mut forces = vec![0.0; self.load.len()];
        for (i, contact) in self.surface.nodes.iter().enumerate() {
            let force = global_force(contact, block(self.problem, i, self.reaction));
            for share in shares(contact).filter(|share| share.body == self.index) {
                let of_node = &mut forces[share.node * self.dimension()..][..self.dimension()];
                for (sum, f) in of_node.iter_mut().zip(force) {
                    *sum += share.weight * f;
                }
            }
        }
        forces
    }

    /// s = K u − f − c of (K4), per unknown of the body, in newton.
    pub(super) fn support_reactions(&self, contact: &[f64]) -> Vec<f64> {
        self.reactions(contact, |_| true)
    }

    /// The same where a support holds, and zero where equilibrium makes it so.
    pub(super) fn held_reactions(&self, contact: &[f64]) -> Vec<f64> {
        let held = self.held();
        self.reactions(contact, |unknown| held[unknown])
    }

    /// Whether a support or a tie acts, per unknown.
    pub(super) fn held(&self) -> Vec<bool> {
        let mut held: Vec<bool> = self.prescribed.iter().map(Option::is_some).collect();
        for &(column, _) in self.equations.iter().flat_map(|equation| &equation.terms) {
            held.get_mut(column)
                .into_iter()
                .for_each(|held| *held = true);
        }
        held
    }

    fn reactions(&self, contact: &[f64], of: impl Fn(usize) -> bool) -> Vec<f64> {
        let u = self.displacement;
        let rows = self.stiffness.outer_iterator().enumerate();
        rows.zip(self.load.iter().zip(contact))
            .map(|((unknown, row), (f, c))| match of(unknown) {
                true => row.iter().map(|(k, entry)| entry * u[k]).sum::<f64>() - f - c,
                false => 0.0,
            })
            .collect()
    }

    /// Largest `Σ |K_ij u_j|` of a node's unknowns, in newton.
    pub(super) fn inner_force(&self, node: usize) -> f64 {
        let size = |unknown| match self.stiffness.outer_view(unknown) {
            Some(row) => row
                .iter()
                .map(|(k, entry)| (entry * self.displacement[k]).abs())
                .sum(),
            None => 0.0,
        };
        let dimension = self.dimension();
        let unknowns = node * dimension..(node + 1) * dimension;
        unknowns.map(size).fold(0.0, f64::max)
    }
}
