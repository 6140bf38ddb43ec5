//! The body in the contact's own axes.
//!
//! ```text
//! (C4)  u_node = Rᵀ u'_node      rows of R: normal, tangents (contact nodes); R = 1 elsewhere
//!       K'_ab  = R_a K_ab R_bᵀ   block of nodes a and b
//! ```
//!
//! A degree of freedom is `node · dimension + row of R`; away from the contact surface
//! that is the global axis. K' is never stored: its rows are formed when asked for.

use sprs::CsMat;

/// A node of a body whose displacement the contact problem needs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct InterfaceNode {
    pub(crate) node: usize,
    /// Orthonormal rows.
    pub(crate) frame: [[f64; 3]; 3],
    /// The contact problem needs the first rows of the frame, this many.
    pub(crate) kept: usize,
}

/// Not a contact node.
const NONE: usize = usize::MAX;

/// The frames R of the contact nodes, and no rotation elsewhere.
#[derive(Clone, Debug)]
pub(crate) struct Frames {
    dimension: usize,
    /// Contact per degree of freedom, or [`NONE`].
    contact_of_dof: Vec<usize>,
    frames: Vec<[[f64; 3]; 3]>,
}

impl Frames {
    /// The frames of an interface on a body of `nodes` nodes.
    pub(crate) fn new(dimension: usize, nodes: usize, interface: &[InterfaceNode]) -> Self {
        let mut contact_of_dof = vec![NONE; nodes * dimension];
        for (index, node) in interface.iter().enumerate() {
            let first = node.node * dimension;
            contact_of_dof[first..first + dimension].fill(index);
        }
        Self {
            dimension,
            contact_of_dof,
            frames: interface.iter().map(|node| node.frame).collect(),
        }
    }

    /// The frame of the degree of freedom's node; none if it is no contact.
    fn frame(&self, dof: usize) -> Option<&[[f64; 3]; 3]> {
        self.frames.get(self.contact_of_dof[dof])
    }

    /// Visits `(column, value)` along row `dof` of K' (C4).
    ///
    /// A column may come more than once; its values then add up.
    pub(crate) fn visit_row(
        &self,
        stiffness: &CsMat<f64>,
        dof: usize,
        mut visit: impl FnMut(usize, f64),
    ) {
        let Some(frame) = self.frame(dof) else {
            self.visit_turned_columns(stiffness, dof, 1.0, &mut visit);
            return;
        };
        let (node, row) = (dof / self.dimension, dof % self.dimension);
        for (axis, &weight) in frame[row][..self.dimension].iter().enumerate() {
            // A frame along the global axes adds no entry to K'.
            if weight != 0.0 {
                let global = node * self.dimension + axis;
                self.visit_turned_columns(stiffness, global, weight, &mut visit);
            }
        }
    }

    /// Row `global` of K, its columns turned by Rᵀ, times `weight`.
    fn visit_turned_columns(
        &self,
        stiffness: &CsMat<f64>,
        global: usize,
        weight: f64,
        visit: &mut impl FnMut(usize, f64),
    ) {
        let entries = stiffness.indptr().outer_inds_sz(global);
        let columns = &stiffness.indices()[entries.clone()];
        for (&column, &value) in columns.iter().zip(&stiffness.data()[entries]) {
            let Some(frame) = self.frame(column) else {
                visit(column, weight * value);
                continue;
            };
            let (node, axis) = (column / self.dimension, column % self.dimension);
            for (row, direction) in frame[..self.dimension].iter().enumerate() {
                if direction[axis] != 0.0 {
                    let local = node * self.dimension + row;
                    visit(local, weight * value * direction[axis]);
                }
            }
        }
    }

    /// Turns a nodal vector from global axes into the frames: `v' = R v`.
    pub(crate) fn turn_to_local(&self, vector: &mut [f64]) {
        self.turn(vector, |frame, row, axis| frame[row][axis]);
    }

    /// Turns a nodal vector back into global axes: `v = Rᵀ v'`.
    pub(crate) fn turn_to_global(&self, vector: &mut [f64]) {
        self.turn(vector, |frame, axis, row| frame[row][axis]);
    }

    fn turn(&self, vector: &mut [f64], entry: impl Fn(&[[f64; 3]; 3], usize, usize) -> f64) {
        let nodes = vector.chunks_exact_mut(self.dimension);
        for (node, part) in nodes.enumerate() {
            let Some(frame) = self.frame(node * self.dimension) else {
                continue;
            };
            let mut before = [0.0; 3];
            before[..part.len()].copy_from_slice(part);
            for (i, turned) in part.iter_mut().enumerate() {
                *turned = (0..self.dimension)
                    .map(|j| entry(frame, i, j) * before[j])
                    .sum();
            }
        }
    }
}
