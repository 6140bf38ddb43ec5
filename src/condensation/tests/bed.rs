//! A lattice on a bed that may touch it, and its dense solution, for tests.
#![allow(clippy::unwrap_used)]

use faer::Mat;
use faer::linalg::solvers::Solve;
use sprs::CsMat;

use super::lattice::Lattice;
use crate::condensation::CondensationWork;
use crate::condensation::condensed_body::CondensedBody;
use crate::condensation::engine::By;
use crate::condensation::factor::Precision;
use crate::condensation::grounding::Grounding;
use crate::condensation::interface::Interface;
use crate::condensation::load_case::Given;
use crate::condensation::supported::SupportedBody;
use crate::contact::frame::Stance;
use crate::contact::{ContactNode, ContactSurface};
use crate::error::Error;
use crate::problem::{ContactProblem, Operator};

/// A lattice on a rough bed: contacts at the bottom, supports, a load on every node.
pub(crate) struct Bed {
    pub(crate) lattice: Lattice,
    dimension: usize,
    pub(crate) prescribed: Vec<Option<f64>>,
    pub(crate) load: Vec<f64>,
    contacts: Vec<ContactNode>,
}

/// A bed, condensed onto its contacts.
#[derive(Debug)]
pub(crate) struct CondensedBed {
    pub(crate) problem: ContactProblem,
    body: CondensedBody,
    interface: Interface,
}

impl CondensedBed {
    /// Displacement per degree of freedom under the load and a contact reaction.
    pub(crate) fn recover(&self, reaction: &[f64]) -> Vec<f64> {
        let forces = self.interface.forces(reaction);
        self.body.recover(&forces, &[]).unwrap()
    }
}

impl Bed {
    /// The side `x = width` is held along x and moved by 0.01 m; top corners of it are held.
    pub(crate) fn new(cells: [usize; 3], tilt: f64, friction: bool) -> Self {
        let lattice = Lattice::new(cells);
        let dimension = if cells[2] == 0 { 2 } else { 3 };
        let mut prescribed = vec![None; lattice.nodes() * dimension];
        for node in 0..lattice.nodes() {
            if lattice.position(node)[0] == cells[0] as f64 {
                prescribed[node * dimension] = Some(0.01);
            }
        }
        // One corner in 2D, two in 3D, which also stop the turn about x.
        for y in if dimension == 2 {
            vec![cells[1]]
        } else {
            vec![0, cells[1]]
        } {
            let corner = lattice.node([cells[0], y, cells[2]]) * dimension;
            prescribed[corner..corner + dimension].fill(Some(-0.02));
        }
        let load = (0..prescribed.len()).map(|d| ((d * d + 3) % 7) as f64 - 3.0);
        let load = load.collect();
        let mut bed = Self {
            lattice,
            dimension,
            prescribed,
            load,
            contacts: Vec::new(),
        };
        bed.lay(cells, tilt, friction);
        bed
    }

    /// Contacts along the bottom edge (2D) or face (3D), listed against the node numbers.
    fn lay(&mut self, cells: [usize; 3], tilt: f64, friction: bool) {
        for node in (0..self.lattice.nodes()).rev() {
            let position = self.lattice.position(node);
            let on_symmetry = position[0] == cells[0] as f64;
            if position[self.dimension - 1] > 0.0 {
                continue;
            }
            let tilt = if on_symmetry { 0.0 } else { tilt };
            let mut normal = [tilt.sin(), 0.0, 0.0];
            normal[self.dimension - 1] = -tilt.cos();
            let Stance::Free { frame, kept } =
                Stance::new(self.dimension, normal, &[on_symmetry, false, false].into())
            else {
                continue;
            };
            self.contacts.push(ContactNode {
                body: 0,
                node,
                own: vec![(node, 1.0)],
                opposite: None,
                pair: 0,
                position,
                frame,
                tangents: if friction { kept } else { 0 },
                initial_gap: 0.0,
                area: 1.0,
                bulge: 0.0,
                second: false,
                rim: false,
            });
        }
    }

    pub(crate) fn condense(&self) -> Result<CondensedBed, Error> {
        let nodes: Vec<_> = (0..self.lattice.nodes())
            .map(|node| self.lattice.position(node))
            .collect();
        let surface = ContactSurface {
            nodes: self.contacts.clone(),
            ..ContactSurface::default()
        };
        let interface = Interface::new(&surface, 0, self.dimension, (&self.prescribed, None));
        let supported = SupportedBody {
            name: "bed",
            nodes: &nodes,
            dimension: self.dimension,
            stiffness: self.lattice.stiffness(),
            load: self.load.clone(),
            given: Given {
                prescribed: self.prescribed.clone(),
                ..Given::default()
            },
            dependence: None,
            grounding: Grounding::none(),
        };
        let mut work = CondensationWork::default();
        let by = By::Faer(Precision::Double);
        let (body, compliance) = supported.condense(&interface, by, &mut work)?;

        let tangents: Vec<usize> = self.contacts.iter().map(|c| c.tangents).collect();
        let (count, unknowns) = (tangents.len(), body.action.free_displacement.len());
        let mut free = vec![0.0; unknowns];
        let action = &body.action;
        interface.add_displacement(action, &action.free_displacement, &mut free);
        let problem = ContactProblem::new(
            &tangents,
            vec![0.5; count],
            vec![0.0; count],
            free,
            Operator::from_bodies(compliance)?,
        )?;
        Ok(CondensedBed {
            problem,
            body,
            interface,
        })
    }

    /// Unit forces of the contact unknowns in global axes, one per column.
    pub(crate) fn contact_directions(&self) -> Mat<f64> {
        let count = self.contacts.iter().map(|c| 1 + c.tangents).sum();
        let mut directions = Mat::zeros(self.load.len(), count);
        let mut column = 0;
        for contact in &self.contacts {
            for row in 0..=contact.tangents {
                for axis in 0..self.dimension {
                    let dof = contact.node * self.dimension + axis;
                    directions[(dof, column)] = contact.frame[row][axis];
                }
                column += 1;
            }
        }
        directions
    }

    /// Displacement under a force per degree of freedom, solved densely in global axes.
    pub(crate) fn solve(&self, force: &Mat<f64>, move_supports: bool) -> Mat<f64> {
        let mut matrix = dense(&self.lattice.stiffness());
        let mut right = force.clone();
        let size = matrix.nrows();
        for (held, value) in self.prescribed.iter().enumerate() {
            let Some(value) = value else { continue };
            let value = if move_supports { *value } else { 0.0 };
            for i in 0..size {
                for j in 0..right.ncols() {
                    right[(i, j)] -= matrix[(i, held)] * value;
                }
            }
            for i in 0..size {
                matrix[(i, held)] = 0.0;
                matrix[(held, i)] = 0.0;
            }
            matrix[(held, held)] = 1.0;
            for j in 0..right.ncols() {
                right[(held, j)] = value;
            }
        }
        matrix.partial_piv_lu().solve(&right)
    }

    pub(crate) fn load_column(&self) -> Mat<f64> {
        Mat::from_fn(self.load.len(), 1, |i, _| self.load[i])
    }
}

/// The dense matrix of a sparse one.
pub(crate) fn dense(sparse: &CsMat<f64>) -> Mat<f64> {
    let mut dense = Mat::zeros(sparse.rows(), sparse.cols());
    for (&value, (i, j)) in sparse.iter() {
        dense[(i, j)] += value;
    }
    dense
}
