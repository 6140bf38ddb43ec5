//! The edges of a plane mesh, and what is known of the tractions on them.

use std::collections::{HashMap, HashSet};

use nalgebra::Vector2;

use super::given::key;
use crate::body::{Body, Facet, Support};

/// An edge with straight sides between two corners.
pub(super) struct Edge {
    /// Corners in outward order of the first cell.
    pub(super) nodes: [usize; 2],
    pub(super) ends: [Vector2<f64>; 2],
    /// Cells that have it, one or two, and which facet of each it is.
    pub(super) cells: Vec<(usize, usize)>,
    /// Outward normal of the first cell.
    pub(super) normal: Vector2<f64>,
    pub(super) length: f64,
    /// Whether each component of the traction is given.
    pub(super) given: [bool; 2],
    /// Whether the body may touch another one here.
    pub(super) contact: bool,
}

/// All edges, and those of every cell.
pub(super) struct Edges {
    pub(super) all: Vec<Edge>,
    /// Per cell and facet of it: the edge, and +1 for its first cell or −1.
    pub(super) of_cell: Vec<Vec<(usize, f64)>>,
}

impl Edges {
    /// Of a body that is in contact on some facets.
    pub(super) fn new(body: &Body, contact: &[Facet]) -> Self {
        let mesh = &body.mesh;
        let mut number = HashMap::new();
        let mut edges = Self {
            all: Vec::new(),
            of_cell: Vec::new(),
        };
        for (index, cell) in mesh.cells().enumerate() {
            let facets = cell.kind.facets().iter().enumerate();
            let of_cell = facets.map(|(local, facet)| {
                let nodes = [cell.nodes[facet[0]], cell.nodes[facet[1]]];
                let at = *number.entry(key(&nodes)).or_insert(edges.all.len());
                if at == edges.all.len() {
                    edges.all.push(Edge::between(body, nodes));
                }
                edges.all[at].cells.push((index, local));
                (
                    at,
                    if edges.all[at].cells.len() == 1 {
                        1.0
                    } else {
                        -1.0
                    },
                )
            });
            let of_cell = of_cell.collect();
            edges.of_cell.push(of_cell);
        }
        let touching: HashSet<_> = contact.iter().map(|facet| key(&facet.nodes)).collect();
        let supports: Vec<(HashSet<usize>, &Support)> = body
            .supports
            .iter()
            .map(|support| (support.nodes.iter().copied().collect(), support))
            .collect();
        for edge in edges.all.iter_mut().filter(|edge| edge.cells.len() == 1) {
            edge.contact = touching.contains(&key(&edge.nodes));
            edge.given = [!edge.contact; 2];
            for (nodes, support) in &supports {
                if edge.nodes.iter().all(|node| nodes.contains(node)) {
                    for (given, held) in edge.given.iter_mut().zip(support.displacement) {
                        *given &= held.is_none();
                    }
                }
            }
        }
        edges
    }

    /// Edges at every node.
    pub(super) fn at_nodes(&self, nodes: usize) -> Vec<Vec<usize>> {
        let mut at = vec![Vec::new(); nodes];
        for (index, edge) in self.all.iter().enumerate() {
            edge.nodes.iter().for_each(|&node| at[node].push(index));
        }
        at
    }
}

impl Edge {
    fn between(body: &Body, nodes: [usize; 2]) -> Self {
        let ends = nodes.map(|node| {
            let [x, y, _] = body.mesh.nodes[node];
            Vector2::new(x, y)
        });
        let along = ends[1] - ends[0];
        let length = along.norm();
        Self {
            nodes,
            ends,
            cells: Vec::new(),
            normal: Vector2::new(along.y, -along.x) / length,
            length,
            given: [false; 2],
            contact: false,
        }
    }

    /// The place at `s` from 0 to 1.
    pub(super) fn place(&self, s: f64) -> Vector2<f64> {
        self.ends[0] * (1.0 - s) + self.ends[1] * s
    }
}
