//! Every cell of a mesh split into halves along each of its axes: a family of nested meshes.
//!
//! ```text
//! tensor    child o of 2ᵈ, o_j = ±1:    ξ = (o + η)/2                  η: in the child, ξ: in its parent
//! simplex   corners and middles of edges: Bey, Computing 55 (1995) 355–378, along the shortest diagonal
//! prism     the parts of its triangle, in both halves of its height
//! pyramid   one at every corner, one on its head between these, and four tetrahedra beside it
//! ```
//!
//! A new node lies where the shape functions of its parent put it: curved cells stay curved. Old
//! nodes keep their numbers, and cells and facets of a group are replaced by their parts.

use std::collections::HashMap;

use super::kinds::facet_reference;
use super::reference::{Family, Reference};
use super::{CellKind, Facet, Group, Mesh};

/// Corner nodes with their shares, in parts of [`SHARES`]: the same for a point of an edge or face from either side.
type Place = Vec<(usize, u32)>;

/// Children lie at quarters of their parent: shares are multiples of 4⁻³, but within pyramids, where no other cell
/// has them.
const SHARES: f64 = 64.0;

/// Corners of the parts of a triangle, as the parent's nodes are numbered with all middles.
const TRIANGLE: [[usize; 3]; 4] = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]];

/// The same of those parts of a tetrahedron that have one of its corners.
const TETRAHEDRON: [[usize; 4]; 4] = [[0, 4, 6, 7], [4, 1, 5, 9], [6, 5, 2, 8], [7, 9, 8, 3]];

/// Diagonals of the octahedron that is left, each with the ring of the other four middles.
const DIAGONALS: [([usize; 2], [usize; 4]); 3] = [
    ([4, 8], [5, 6, 7, 9]),
    ([5, 7], [4, 6, 8, 9]),
    ([6, 9], [4, 5, 8, 7]),
];

impl Mesh {
    /// The mesh with every cell split into two (per axis): four in 2D, eight in 3D, and of a pyramid six and four
    /// tetrahedra.
    #[must_use]
    pub fn refined(&self) -> Self {
        let mut refinement = Refinement::new(self);
        for cell in self.cells() {
            refinement.first.push(refinement.mesh.cell_count());
            for nodes in refinement.parts(cell.kind.reference(), cell.nodes) {
                refinement
                    .mesh
                    .push_cell(kind_of_part(cell.kind, nodes.len()), &nodes);
            }
        }
        refinement.first.push(refinement.mesh.cell_count());
        let groups = self.groups.iter();
        let groups = groups.map(|(name, group)| (name.clone(), refinement.group(group)));
        let groups = groups.collect();
        let mut mesh = refinement.mesh;
        mesh.groups = groups;
        mesh
    }
}

struct Refinement {
    mesh: Mesh,
    /// First part of every cell, and their number.
    first: Vec<usize>,
    known: HashMap<Place, usize>,
}

impl Refinement {
    /// No cells yet; the old nodes are known by where they are in their cells.
    fn new(mesh: &Mesh) -> Self {
        let mut known = HashMap::new();
        for cell in mesh.cells() {
            let reference = cell.kind.reference();
            for (position, &node) in reference.nodes.iter().zip(cell.nodes) {
                known.insert(place(reference, cell.nodes, *position), node);
            }
        }
        let mesh = Mesh::new(mesh.dimension, mesh.nodes.clone());
        Self {
            mesh,
            first: Vec::new(),
            known,
        }
    }

    /// Nodes of the parts of a cell or facet.
    fn parts(&mut self, reference: &Reference, nodes: &[usize]) -> Vec<Vec<usize>> {
        let parts = match reference.family {
            Family::Simplex => self.simplices(reference, nodes),
            Family::Tensor | Family::Serendipity => boxes(reference),
            Family::Prism => prisms(reference),
            Family::Pyramid => pyramids(reference),
        };
        let parts = parts.iter();
        parts
            .map(|part| {
                part.iter()
                    .map(|at| self.node(reference, nodes, *at))
                    .collect()
            })
            .collect()
    }

    /// Positions of the nodes of every part of a triangle or tetrahedron.
    fn simplices(&self, reference: &Reference, nodes: &[usize]) -> Vec<Vec<[f64; 3]>> {
        let middles = match reference.dimension {
            2 => CellKind::Tri6.reference().nodes,
            _ => CellKind::Tet10.reference().nodes,
        };
        let part =
            |corners: &[usize]| between(reference, corners.iter().map(|corner| middles[*corner]));
        if reference.dimension == 2 {
            return TRIANGLE.iter().map(|corners| part(corners)).collect();
        }
        let at = |corner: usize| self.position(reference, nodes, middles[corner]);
        let length = |[a, b]: [usize; 2]| {
            let (a, b) = (at(a), at(b));
            (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>()
        };
        let mut diagonals = DIAGONALS.iter();
        let first = &DIAGONALS[0];
        let ([a, b], ring) = diagonals
            .by_ref()
            .min_by(|one, other| length(one.0).total_cmp(&length(other.0)))
            .unwrap_or(first);
        let around = (0..4).map(|k| [*a, *b, ring[k], ring[(k + 1) % 4]]);
        let corners = TETRAHEDRON.into_iter().chain(around);
        corners
            .map(|mut corners| {
                if turned(corners.map(|corner| middles[corner])) {
                    corners.swap(2, 3);
                }
                part(&corners)
            })
            .collect()
    }

    fn position(&self, reference: &Reference, nodes: &[usize], at: [f64; 3]) -> [f64; 3] {
        let mut position = [0.0; 3];
        for (share, &node) in reference.shape(at).iter().zip(nodes) {
            for (sum, x) in position.iter_mut().zip(self.mesh.nodes[node]) {
                *sum += share * x;
            }
        }
        position
    }

    /// The node at a position of a cell or facet, made if there is none yet.
    fn node(&mut self, reference: &Reference, nodes: &[usize], at: [f64; 3]) -> usize {
        let place = place(reference, nodes, at);
        if let Some(&node) = self.known.get(&place) {
            return node;
        }
        let node = self.mesh.nodes.len();
        self.mesh.nodes.push(self.position(reference, nodes, at));
        self.known.insert(place, node);
        node
    }

    fn group(&mut self, group: &Group) -> Group {
        match group {
            Group::Cells(cells) => {
                let of = |cell: &usize| self.first[*cell]..self.first[cell + 1];
                Group::Cells(cells.iter().flat_map(of).collect())
            }
            Group::Facets(facets) => {
                let parts = facets.iter().flat_map(|facet| {
                    let reference = facet_reference(self.mesh.dimension, facet.nodes.len());
                    let parts = reference.map(|facet_of| self.parts(facet_of, &facet.nodes));
                    parts.unwrap_or_default()
                });
                Group::Facets(parts.map(|nodes| Facet { nodes }).collect())
            }
            Group::Edges(edges) => {
                let parts = edges.iter().flat_map(|edge| {
                    let reference = facet_reference(2, edge.len());
                    reference
                        .map(|line| self.parts(line, edge))
                        .unwrap_or_default()
                });
                Group::Edges(parts.collect())
            }
            Group::Points(points) => Group::Points(points.clone()),
        }
    }
}

/// Positions of the nodes of every part of a line, quadrilateral or hexahedron.
fn boxes(reference: &Reference) -> Vec<Vec<[f64; 3]>> {
    let corners = &reference.nodes[..reference.corners];
    corners
        .iter()
        .map(|corner| {
            let nodes = reference.nodes.iter();
            nodes
                .map(|node| [0, 1, 2].map(|axis| 0.5 * (corner[axis] + node[axis])))
                .collect()
        })
        .collect()
}

/// Positions of the nodes of a simplex with these corners.
fn between(reference: &Reference, corners: impl Iterator<Item = [f64; 3]>) -> Vec<[f64; 3]> {
    let corners: Vec<[f64; 3]> = corners.collect();
    let nodes = reference.nodes.iter();
    nodes
        .map(|at| {
            let shares = linear(reference).shape(*at);
            std::array::from_fn(|axis| {
                let terms = shares.iter().zip(&corners);
                terms.map(|(share, corner)| share * corner[axis]).sum()
            })
        })
        .collect()
}

/// The same of every part of a prism.
fn prisms(reference: &Reference) -> Vec<Vec<[f64; 3]>> {
    let middles = CellKind::Tri6.reference().nodes;
    let parts = [-0.5, 0.5].into_iter().flat_map(|height| {
        TRIANGLE.iter().map(move |corners| {
            let [a, b, c] = corners.map(|corner| middles[corner]);
            let nodes = reference.nodes.iter();
            let node = |[x, y, z]: &[f64; 3]| {
                let at = |axis: usize| (1.0 - x - y) * a[axis] + x * b[axis] + y * c[axis];
                [at(0), at(1), height + 0.5 * z]
            };
            nodes.map(node).collect()
        })
    });
    parts.collect()
}

/// The same of every part of a pyramid; those with fewer nodes are tetrahedra.
fn pyramids(reference: &Reference) -> Vec<Vec<[f64; 3]>> {
    let half = [0.5; 3];
    let corners = reference.nodes[..4].iter();
    let corners = corners.map(|[a, b, _]| ([0.5 * a, 0.5 * b, 0.0], half));
    let (top, below) = ([0.0, 0.0, 0.5], [0.5, -0.5, -0.5]);
    let placed = corners.chain([(top, half), (top, below)]);
    let parts = placed.map(|(at, by)| {
        let nodes = reference.nodes.iter();
        let node = |xi: &[f64; 3]| std::array::from_fn(|k| at[k] + by[k] * xi[k]);
        nodes.map(node).collect()
    });
    let tetrahedron = match reference.is_linear() {
        true => CellKind::Tet4.reference(),
        false => CellKind::Tet10.reference(),
    };
    let beside = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]].map(|[x, y]| {
        let up = |side: f64| [0.5 * (x - side * y), 0.5 * (y + side * x), 0.5];
        let corners = [[x, y, 0.0], [0.0; 3], up(-1.0), up(1.0)];
        between(tetrahedron, corners.into_iter())
    });
    parts.chain(beside).collect()
}

/// A part with so many nodes: of the kind of its cell, or a tetrahedron of a pyramid.
fn kind_of_part(kind: CellKind, nodes: usize) -> CellKind {
    match kind.is_linear() {
        _ if nodes == kind.node_count() => kind,
        true => CellKind::Tet4,
        false => CellKind::Tet10,
    }
}

/// Shares of the corners in a position; those without one are left out.
fn place(reference: &Reference, nodes: &[usize], at: [f64; 3]) -> Place {
    let shares = linear(reference).shape(at);
    let shares = shares.iter().map(|share| (share * SHARES).round() as u32);
    let mut place: Place = nodes.iter().copied().zip(shares).collect();
    place.retain(|(_, share)| *share > 0);
    place.sort_unstable();
    // A cell with two corners at one node.
    place.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        kept.1 += if same { next.1 } else { 0 };
        same
    });
    place
}

/// The linear cell or facet on the same corners.
fn linear(reference: &Reference) -> &'static Reference {
    match (reference.dimension, reference.corners) {
        (3, 4) => CellKind::Tet4.reference(),
        (3, 5) => CellKind::Pyramid5.reference(),
        (3, 6) => CellKind::Prism6.reference(),
        (3, _) => CellKind::Hex8.reference(),
        _ => super::kinds::linear_facet(reference),
    }
}

/// Whether a tetrahedron is inside out.
fn turned([a, b, c, d]: [[f64; 3]; 4]) -> bool {
    let from = |x: [f64; 3]| nalgebra::Vector3::from([x[0] - a[0], x[1] - a[1], x[2] - a[2]]);
    from(b).cross(&from(c)).dot(&from(d)) < 0.0
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::Body;
    use crate::body::tests::samples::{distorted, facets};

    fn volume(body: &Body) -> f64 {
        let cells = body.mesh.cells();
        let points = cells.map(|cell| crate::body::modes::mapped(body, cell));
        points.flatten().map(|point| point.volume).sum()
    }

    #[test]
    fn the_parts_of_all_kinds_of_cells_fill_them_and_join() {
        for kind in CellKind::all() {
            let mut body = distorted(kind);
            let right = facets(&body.mesh, "right");
            body.mesh
                .groups
                .insert("side".to_owned(), Group::Facets(right));
            let (before, count) = (volume(&body), body.mesh.cell_count());
            let outside = body.mesh.boundary_facets().len();
            let area = |body: &Body, group: &str| match &body.mesh.groups[group] {
                Group::Facets(facets) => {
                    let areas = facets
                        .iter()
                        .map(|facet| body.mesh.facet_geometry(facet).area);
                    areas.sum::<f64>()
                }
                _ => 0.0,
            };
            let side = area(&body, "side");
            let nodes = body.mesh.nodes.clone();
            body.mesh = body.mesh.refined();
            let parts = match kind.reference().family {
                Family::Pyramid => 10,
                _ => 1 << kind.dimension(),
            };
            assert_eq!(body.mesh.cell_count(), parts * count, "{kind:?}");
            // Nodes that were not joined would leave facets open inside.
            let open = body.mesh.boundary_facets().len();
            assert_eq!(open, outside << (kind.dimension() - 1), "{kind:?}");
            assert_eq!(body.mesh.nodes[..nodes.len()], nodes, "{kind:?}");
            body.material_of_cell = vec![0; body.mesh.cell_count()];
            let off = volume(&body) / before - 1.0;
            assert!(off.abs() < 1e-13, "{kind:?} {off:e}");
            // Warped facets have areas of their own: those of the parts sum up to another quadrature.
            let rule = if kind.is_linear() { 1e-2 } else { 1e-3 };
            assert!((area(&body, "side") / side - 1.0).abs() < rule, "{kind:?}");
            assert!(crate::body::check(&body).is_ok(), "{kind:?}");
        }
    }
}
