//! What the contacts need of one body: nodes, axes, and how each contact moves with them.
//!
//! ```text
//! (C11)  u_i = Σ_k B_k v_k + given       v_k: displacement of body k's interface unknowns
//!       û = Σ_k B_k v̂_k + given,   G = Σ_k B_k G_k B_kᵀ,   forces on body k: B_kᵀ t
//! ```
//!
//! A contact's own node enters with weight one, or the nodes around it with those of (C16), a node
//! of the opposite side with minus its mortar weight. A row of B_k is that weight times the contact's direction, in the
//! axes of the node. Where the nodes have many more displacements than the contacts see of them, what
//! these see are the interface unknowns, and B_k goes into the body (C17); so it does where these displacements
//! depend on others, as `B_k T` (B17).

use std::collections::BTreeMap;

use faer::Mat;

use super::columns::BorderRow;
use super::load_case::Action;
use super::local_axes::InterfaceNode;
use crate::body::Dependence;
use crate::contact::{ContactNode, ContactSurface};

/// How many times as many unknowns the nodes have as the contacts that move with them, for a body to
/// be condensed onto these (C17): dense work falls by its third power, while the factor gets as
/// many rows more.
const MANY: usize = 2;

/// One body's share in the contact problem.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Interface {
    pub(crate) nodes: Vec<InterfaceNode>,
    /// Rows of B over the body, each an interface unknown in place of the nodes' displacements
    /// (C17); none if the nodes have not many more.
    pub(crate) border: Vec<BorderRow>,
    /// B_k: `(interface unknown, coefficient)` per unknown of the contact problem.
    rows: Vec<Vec<(usize, f64)>>,
    /// Where supports prescribe part of û: `(degree of freedom, coefficient)` per unknown of
    /// the contact problem.
    given: Vec<Vec<(usize, f64)>>,
    unknowns: usize,
}

/// A contact that moves with a node: its index and its weight there.
type Touch = (usize, f64);

impl Interface {
    /// The interface of body `index`, whose degrees of freedom are `prescribed` in part.
    pub(crate) fn new(
        surface: &ContactSurface,
        index: usize,
        dimension: usize,
        held: (&[Option<f64>], Option<&Dependence>),
    ) -> Self {
        Self::where_many(MANY, surface, index, dimension, held)
    }

    /// The same over a border (C17), however many unknowns the nodes have.
    pub(super) fn bordered(
        surface: &ContactSurface,
        index: usize,
        dimension: usize,
        held: (&[Option<f64>], Option<&Dependence>),
    ) -> Self {
        Self::where_many(0, surface, index, dimension, held)
    }

    fn where_many(
        many: usize,
        surface: &ContactSurface,
        index: usize,
        dimension: usize,
        (prescribed, tied): (&[Option<f64>], Option<&Dependence>),
    ) -> Self {
        let (order, touches) = touches(surface, index);
        let held = |node: usize| -> [Option<f64>; 3] {
            let mut held = [None; 3];
            held[..dimension].copy_from_slice(&prescribed[node * dimension..][..dimension]);
            held
        };
        let nodes: Vec<InterfaceNode> = order
            .into_iter()
            .map(|node| interface_node(surface, dimension, node, &touches[&node], held(node)))
            .collect();

        let mut offsets = vec![0];
        for contact in &surface.nodes {
            offsets.push(offsets[offsets.len() - 1] + 1 + contact.tangents);
        }
        let size = offsets[surface.nodes.len()];
        let (mut rows, mut given) = (vec![Vec::new(); size], vec![Vec::new(); size]);
        let mut seen = vec![BorderRow::new(); size];
        let (mut unknowns, mut depends) = (0, false);
        for interface in &nodes {
            let held = held(interface.node);
            // Of a node's axes some may depend on others, though contacts see none of these.
            let mut dofs = (0..dimension).map(|axis| interface.node * dimension + axis);
            depends |= tied.is_some_and(|tied| dofs.any(|dof| tied.of(dof).is_some()));
            for &(contact, weight) in &touches[&interface.node] {
                for (row, direction) in unknown_rows(&surface.nodes[contact]).enumerate() {
                    let at = offsets[contact] + row;
                    for (axis, held) in held.iter().enumerate() {
                        let coefficient = weight * direction[axis];
                        if coefficient != 0.0 && axis < dimension {
                            let dof = interface.node * dimension + axis;
                            match (held, tied.and_then(|tied| tied.of(dof))) {
                                (Some(_), _) => given[at].push((dof, coefficient)),
                                (None, None) => seen[at].push((dof, coefficient)),
                                (None, Some(of)) => {
                                    given[at].push((dof, coefficient));
                                    let terms = of.terms.iter();
                                    seen[at].extend(terms.map(|&(q, a)| (q, a * coefficient)));
                                }
                            }
                        }
                    }
                    for (kept, axis) in interface.frame[..interface.kept].iter().enumerate() {
                        let coefficient = weight * dot(direction, axis);
                        if coefficient != 0.0 {
                            rows[at].push((unknowns + kept, coefficient));
                        }
                    }
                }
            }
            unknowns += interface.kept;
        }
        let mut interface = Self {
            nodes,
            border: Vec::new(),
            rows,
            given,
            unknowns,
        };
        let bordering = seen.iter().filter(|row| !row.is_empty()).count();
        if many * bordering <= unknowns || depends {
            interface.look_over(seen);
        }
        interface
    }

    /// Takes what the contacts see of the body for the interface unknowns.
    fn look_over(&mut self, seen: Vec<BorderRow>) {
        for (row, seen) in self.rows.iter_mut().zip(seen) {
            row.clear();
            if !seen.is_empty() {
                row.push((self.border.len(), 1.0));
                self.border.push(seen);
            }
        }
        self.unknowns = self.border.len();
    }

    /// The nodes whose displacements are interface unknowns.
    pub(super) fn condensed_nodes(&self) -> &[InterfaceNode] {
        match self.border.is_empty() {
            true => &self.nodes,
            false => &[],
        }
    }

    /// The contact unknowns are the interface unknowns.
    pub(crate) fn is_identity(&self) -> bool {
        let mut rows = self.rows.iter().enumerate();
        self.rows.len() == self.unknowns && rows.all(|(i, row)| *row == [(i, 1.0)])
    }

    /// Adds `B_k v_k + given` (C11) for displacements of the body's interface unknowns and what is given, in
    /// metre.
    pub(super) fn add_displacement(
        &self,
        action: &Action,
        of_body: &[f64],
        displacement: &mut [f64],
    ) {
        for (u, (row, given)) in displacement
            .iter_mut()
            .zip(self.rows.iter().zip(&self.given))
        {
            let given = given.iter();
            *u += given.map(|&(dof, b)| b * action.given(dof)).sum::<f64>()
                + row.iter().map(|&(k, b)| b * of_body[k]).sum::<f64>();
        }
    }

    /// Adds `B_k v_k` (C11) alone.
    pub(super) fn add_own_displacement(&self, of_body: &[f64], displacement: &mut [f64]) {
        for (u, row) in displacement.iter_mut().zip(&self.rows) {
            *u += row.iter().map(|&(k, b)| b * of_body[k]).sum::<f64>();
        }
    }

    /// Adds `B_k G_k B_kᵀ` (C11) to both triangles.
    pub(crate) fn add_compliance(&self, of_body: &Mat<f64>, compliance: &mut Mat<f64>) {
        let mut column = vec![0.0; self.unknowns];
        for (j, row) in self
            .rows
            .iter()
            .enumerate()
            .filter(|(_, row)| !row.is_empty())
        {
            column.fill(0.0);
            for &(k, b) in row {
                for (sum, g) in column.iter_mut().zip(of_body.col_as_slice(k)) {
                    *sum += b * g;
                }
            }
            let upper = &self.rows[..=j];
            for (i, row) in upper.iter().enumerate() {
                let entry: f64 = row.iter().map(|&(k, b)| b * column[k]).sum();
                compliance[(i, j)] += entry;
                if i != j {
                    compliance[(j, i)] += entry;
                }
            }
        }
    }

    /// `B_kᵀ t`, in newton.
    pub(crate) fn forces(&self, reaction: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.unknowns];
        for (row, t) in self.rows.iter().zip(reaction) {
            for &(k, b) in row {
                forces[k] += b * t;
            }
        }
        forces
    }
}

/// The directions of a contact's unknowns.
fn unknown_rows(contact: &ContactNode) -> impl Iterator<Item = &[f64; 3]> {
    contact.frame[..=contact.tangents].iter()
}

/// Which contacts move with which node of the body; nodes in the order they are met.
fn touches(surface: &ContactSurface, body: usize) -> (Vec<usize>, BTreeMap<usize, Vec<Touch>>) {
    let (mut order, mut touches) = (Vec::new(), BTreeMap::<usize, Vec<Touch>>::new());
    let mut touch = |node: usize, contact: usize, weight: f64| {
        let of_node = touches.entry(node).or_default();
        if of_node.is_empty() {
            order.push(node);
        }
        of_node.push((contact, weight));
    };
    for (index, contact) in surface.nodes.iter().enumerate() {
        for &(node, weight) in contact.own.iter().filter(|_| contact.body == body) {
            touch(node, index, weight);
        }
        if let Some(opposite) = contact.opposite.as_ref().filter(|side| side.body == body) {
            for &(node, weight) in &opposite.nodes {
                touch(node, index, -weight);
            }
        }
    }
    (order, touches)
}

/// The frame of a node: its contact's own where that is all that moves with it, else the
/// global axes along which some contact moves and no support holds.
fn interface_node(
    surface: &ContactSurface,
    dimension: usize,
    node: usize,
    touches: &[Touch],
    held: [Option<f64>; 3],
) -> InterfaceNode {
    if let [(contact, 1.0)] = touches[..] {
        let contact = &surface.nodes[contact];
        let across_supports = unknown_rows(contact)
            .all(|row| row.iter().zip(held).all(|(d, u)| u.is_none() || *d == 0.0));
        if across_supports && (contact.opposite.is_none() || contact.tangents == 0) {
            return InterfaceNode {
                node,
                frame: contact.frame,
                kept: 1 + contact.tangents,
            };
        }
    }
    let needed = |axis: usize| {
        let mut rows = touches
            .iter()
            .flat_map(|&(contact, _)| unknown_rows(&surface.nodes[contact]));
        axis < dimension && held[axis].is_none() && rows.any(|row| row[axis] != 0.0)
    };
    let (kept, rest): (Vec<usize>, Vec<usize>) = (0..3).partition(|&axis| needed(axis));
    let mut frame = [[0.0; 3]; 3];
    // In 2D the third row stays the third axis.
    for (row, &axis) in kept.iter().chain(&rest).enumerate() {
        frame[row][axis] = 1.0;
    }
    InterfaceNode {
        node,
        frame,
        kept: kept.len(),
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
