//! The order of elimination: nested dissection of the body, contact unknowns last.
//!
//! ```text
//! nodes of the body   →  METIS NodeND  →  postorder of the elimination tree  →  their unknowns
//! contact unknowns    →  last, in the order of the contact problem
//! ```
//!
//! Where the nodes are a lattice, `dissection` stands for METIS.
//!
//! METIS orders nodes, not unknowns: the unknowns of a node have the same neighbours.
//! G. Karypis & V. Kumar, A fast and high quality multilevel scheme for partitioning
//! irregular graphs, SIAM J. Sci. Comput. 20 (1998) 359–392.
//!
//! The only file that calls C, but for `mumps/face`.
#![allow(unsafe_code)]

use std::sync::{Mutex, PoisonError};

use metis_sys::{
    METIS_NOPTIONS, METIS_NodeND, METIS_SetDefaultOptions, idx_t, moptions_et_METIS_OPTION_SEED,
    rstatus_et_METIS_OK,
};
use sprs::CsMat;

use super::dissection;
use super::elimination_tree::{Graph, postorder};

/// Not an unknown: the displacement is prescribed.
pub(crate) const HELD: usize = usize::MAX;

/// What becomes of a degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// Prescribed, no unknown.
    Held,
    /// Eliminated in the factorisation.
    Ordinary,
    /// Kept for the contact problem.
    Contact,
}

/// A permutation of the unknowns, contact unknowns last.
#[derive(Clone, Debug)]
pub(crate) struct Ordering {
    /// Position of each degree of freedom in the order of elimination, or [`HELD`].
    pub(crate) position: Vec<usize>,
    /// Degree of freedom at each position.
    pub(crate) dof: Vec<usize>,
    /// Number of contact unknowns, the last positions.
    pub(crate) contact_unknowns: usize,
}

impl Ordering {
    /// Orders the unknowns of a body; none if METIS runs out of memory or of index range.
    ///
    /// `positions` are those of its nodes, in metre, and `contact` lists the degrees of freedom with [`Role::Contact`] in the order of the
    /// contact problem.
    pub(crate) fn new(
        stiffness: &CsMat<f64>,
        (positions, dimension): (&[[f64; 3]], usize),
        roles: &[Role],
        contact: &[usize],
    ) -> Option<Self> {
        let (nodes, graph) = ordinary_graph(stiffness, dimension, roles)?;
        let by_coordinates = dissection::dissect(positions, &nodes, &graph);
        let dissected = by_coordinates.or_else(|| dissect(&graph))?;
        let mut dof = Vec::with_capacity(roles.len());
        for vertex in postorder(&graph, &dissected) {
            let first = nodes[vertex] * dimension;
            dof.extend((first..first + dimension).filter(|&d| roles[d] == Role::Ordinary));
        }
        dof.extend_from_slice(contact);
        let mut position = vec![HELD; roles.len()];
        for (step, &d) in dof.iter().enumerate() {
            position[d] = step;
        }
        Some(Self {
            position,
            dof,
            contact_unknowns: contact.len(),
        })
    }

    /// Number of unknowns.
    pub(crate) fn unknowns(&self) -> usize {
        self.dof.len()
    }

    /// Number of unknowns that are eliminated before the first contact unknown.
    pub(crate) fn ordinary(&self) -> usize {
        self.dof.len() - self.contact_unknowns
    }
}

/// Nodes with an ordinary unknown, and which of them share a cell.
fn ordinary_graph(
    stiffness: &CsMat<f64>,
    dimension: usize,
    roles: &[Role],
) -> Option<(Vec<usize>, Graph)> {
    const OUTSIDE: usize = usize::MAX;
    let mut vertex_of_node = vec![OUTSIDE; roles.len() / dimension];
    let mut nodes = Vec::new();
    for (node, of_node) in roles.chunks_exact(dimension).enumerate() {
        if of_node.contains(&Role::Ordinary) {
            vertex_of_node[node] = nodes.len();
            nodes.push(node);
        }
    }
    let mut graph = Graph {
        starts: vec![0],
        neighbours: Vec::new(),
    };
    // The last vertex that listed a neighbour: each is listed once, whatever the axes.
    let mut listed_by = vec![OUTSIDE; nodes.len()];
    for (vertex, &node) in nodes.iter().enumerate() {
        listed_by[vertex] = vertex;
        for row in node * dimension..(node + 1) * dimension {
            for &column in &stiffness.indices()[stiffness.indptr().outer_inds_sz(row)] {
                let other = vertex_of_node[column / dimension];
                if other != OUTSIDE && listed_by[other] != vertex {
                    listed_by[other] = vertex;
                    graph.neighbours.push(idx_t::try_from(other).ok()?);
                }
            }
        }
        let end = idx_t::try_from(graph.neighbours.len()).ok()?;
        graph.starts.push(end);
    }
    Some((nodes, graph))
}

/// METIS keeps its random numbers and its signal handlers per process.
static METIS: Mutex<()> = Mutex::new(());

/// Nested dissection: the vertex eliminated at each step, the same in every run.
fn dissect(graph: &Graph) -> Option<Vec<usize>> {
    let vertices = graph.vertices();
    if graph.neighbours.is_empty() {
        return Some((0..vertices).collect());
    }
    let mut count = idx_t::try_from(vertices).ok()?;
    // METIS declares its inputs mutable; it gets its own copy, gone with this function.
    let (mut starts, mut neighbours) = (graph.starts.clone(), graph.neighbours.clone());
    let mut options = [0 as idx_t; METIS_NOPTIONS as usize];
    let mut order = vec![0 as idx_t; vertices];
    let mut step_of = vec![0 as idx_t; vertices];
    let _alone = METIS.lock().unwrap_or_else(PoisonError::into_inner);
    // SAFETY: `options` has METIS_NOPTIONS entries. `starts` has `count + 1` entries that
    // rise from 0 to the length of `neighbours`, whose entries are vertices below `count`;
    // every edge stands at both ends, because K's pattern is symmetric, and there are no
    // loops. Both outputs have `count` entries. No weights: a null pointer says so. Nothing
    // is kept after the call, and the lock keeps a second call out.
    let status = unsafe {
        METIS_SetDefaultOptions(options.as_mut_ptr());
        options[moptions_et_METIS_OPTION_SEED as usize] = 1;
        METIS_NodeND(
            &raw mut count,
            starts.as_mut_ptr(),
            neighbours.as_mut_ptr(),
            std::ptr::null_mut(),
            options.as_mut_ptr(),
            order.as_mut_ptr(),
            step_of.as_mut_ptr(),
        )
    };
    (status == rstatus_et_METIS_OK)
        .then(|| order.into_iter().map(|vertex| vertex as usize).collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::condensation::tests::lattice::Lattice;

    #[test]
    fn every_unknown_is_eliminated_once_and_the_contact_comes_last_in_its_order() {
        let lattice = Lattice::new([12, 9, 0]);
        let mut roles = vec![Role::Ordinary; 2 * lattice.nodes()];
        let contact = [40, 7, 6, 100];
        contact.iter().for_each(|&dof| roles[dof] = Role::Contact);
        roles[13] = Role::Held;
        let ordering = Ordering::new(&lattice.stiffness(), (&[], 2), &roles, &contact).unwrap();
        assert_eq!(ordering.dof[ordering.ordinary()..], contact);
        assert_eq!(ordering.unknowns(), roles.len() - 1);
        assert_eq!(ordering.position[13], HELD);
        for (step, &dof) in ordering.dof.iter().enumerate() {
            assert_eq!(ordering.position[dof], step);
        }
    }

    #[test]
    fn the_order_is_the_same_in_every_run() {
        let stiffness = Lattice::new([20, 20, 0]).stiffness();
        let roles = vec![Role::Ordinary; stiffness.rows()];
        let runs: Vec<_> = std::thread::scope(|scope| {
            let run = || {
                Ordering::new(&stiffness, (&[], 2), &roles, &[])
                    .unwrap()
                    .dof
            };
            let threads: Vec<_> = (0..4).map(|_| scope.spawn(run)).collect();
            threads.into_iter().map(|t| t.join().unwrap()).collect()
        });
        assert!(runs.windows(2).all(|pair| pair[0] == pair[1]));
    }

    #[test]
    fn separate_bodies_and_lone_nodes_are_ordered_too() {
        // Node 0 alone (a diagonal entry only), nodes 1 and 2 joined.
        let mut entries = sprs::TriMat::new((6, 6));
        (0..6).for_each(|d| entries.add_triplet(d, d, 1.0));
        entries.add_triplet(2, 5, -0.5);
        entries.add_triplet(5, 2, -0.5);
        let ordering =
            Ordering::new(&entries.to_csr(), (&[], 2), &[Role::Ordinary; 6], &[]).unwrap();
        let mut sorted = ordering.dof;
        sorted.sort_unstable();
        assert_eq!(sorted, [0, 1, 2, 3, 4, 5]);
    }

    #[test]
    fn a_body_whose_nodes_are_all_on_the_contact_has_no_ordinary_unknown() {
        let stiffness = Lattice::new([1, 1, 0]).stiffness();
        let contact: Vec<usize> = (0..8).rev().collect();
        let ordering = Ordering::new(&stiffness, (&[], 2), &[Role::Contact; 8], &contact).unwrap();
        assert_eq!((ordering.ordinary(), ordering.dof), (0, contact));
    }
}
