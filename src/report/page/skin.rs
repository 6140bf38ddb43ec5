//! What is drawn of a body: the surface of a solid one, all cells of a plane one.

use std::collections::HashMap;

use serde::Serialize;

use super::lattice::Lattice;
use super::packed::Packed;
use super::points::Points;
use crate::body::{Body, FacetReference};

/// Up to so many quadratic facets of a body are drawn in four parts along each side, more in two.
const FINE: usize = 10_000;

/// Cosine of the angle between facets from which the edge between them is part of the outline.
const SHARP: f64 = 0.866;

/// A body as triangles between drawn points.
#[derive(Clone, Debug, Default)]
pub(super) struct Skin {
    pub(super) points: Points,
    /// Number of nodes of its mesh.
    pub(super) nodes: usize,
    /// Parts along each side of its quadratic facets.
    parts: u32,
    triangles: Vec<u32>,
    /// Ends of small lines: along all edges of cells, and along those of the outline.
    lines: Vec<u32>,
    outline: Vec<u32>,
}

/// The same as it stands in the page.
#[derive(Debug, Serialize)]
pub(super) struct DrawnBody<'a> {
    name: &'a str,
    /// Relative to the scene's origin, three numbers per point.
    positions: Packed,
    /// Node of each point, the largest integer between nodes.
    nodes: Packed,
    triangles: Packed,
    lines: Packed,
    outline: Packed,
}

/// An edge between corners of facets.
struct Edge {
    /// Drawn points along it.
    points: Vec<u32>,
    normal: [f64; 3],
    sharp: bool,
}

impl Skin {
    pub(super) fn new(body: &Body) -> Self {
        let mesh = &body.mesh;
        let facets: Vec<(Vec<usize>, [f64; 3])> = match mesh.dimension {
            2 => mesh
                .cells()
                .map(|cell| (cell.nodes.to_vec(), [0.0, 0.0, 1.0]))
                .collect(),
            _ => mesh
                .boundary_facets()
                .into_iter()
                .map(|facet| {
                    let normal = mesh.facet_geometry(&facet).normal;
                    (facet.nodes, normal)
                })
                .collect(),
        };
        let mut skin = Self {
            nodes: mesh.nodes.len(),
            parts: if facets.len() <= FINE { 4 } else { 2 },
            ..Self::default()
        };
        let mut edges = Vec::new();
        let mut edge_at = HashMap::new();
        for (nodes, normal) in &facets {
            // Plane cells have the nodes of a solid body's facets.
            let Some(facet) = FacetReference::of(3, nodes.len()) else {
                continue;
            };
            let (lattice, places) = skin.lattice(facet, nodes);
            for piece in &lattice.pieces {
                skin.triangles
                    .extend(piece.iter().map(|&at| places[at as usize]));
            }
            for side in &lattice.sides {
                let points = side.iter().map(|&at| places[at as usize]);
                add_edge(&mut edges, &mut edge_at, points.collect(), *normal);
            }
        }
        for edge in edges {
            let lines = edge.points.windows(2).flatten();
            skin.lines.extend(lines.clone());
            if edge.sharp {
                skin.outline.extend(lines);
            }
        }
        skin
    }

    /// The lattice of a facet, and the drawn points of its points.
    pub(super) fn lattice(
        &mut self,
        facet: FacetReference,
        nodes: &[usize],
    ) -> (Lattice, Vec<u32>) {
        let parts = if facet.corners() == nodes.len() {
            1
        } else {
            self.parts
        };
        let lattice = Lattice::new(facet, parts);
        let places = lattice.points.iter();
        let places = places.map(|&at| self.points.point(nodes, &facet.shape(at)));
        let places = places.collect();
        (lattice, places)
    }

    /// As it stands in the page, relative to `origin`, in metre.
    pub(super) fn drawn<'a>(&self, body: &'a Body, origin: [f64; 3]) -> DrawnBody<'a> {
        let at = |node: usize| {
            let position = body.mesh.nodes[node];
            [0, 1, 2].map(|axis| position[axis] - origin[axis])
        };
        let nodes = self.points.node_of();
        DrawnBody {
            name: &body.name,
            positions: Packed::reals(self.points.means(at).flatten()),
            nodes: Packed::integers(nodes.map(|node| node.map_or(u32::MAX, |node| node as u32))),
            triangles: Packed::integers(self.triangles.iter().copied()),
            lines: Packed::integers(self.lines.iter().copied()),
            outline: Packed::integers(self.outline.iter().copied()),
        }
    }
}

/// Takes up a side of a facet: an edge that one facet has, or facets at an angle, is sharp.
fn add_edge(
    edges: &mut Vec<Edge>,
    edge_at: &mut HashMap<[u32; 2], usize>,
    points: Vec<u32>,
    normal: [f64; 3],
) {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return;
    };
    let known = *edge_at
        .entry([first.min(last), first.max(last)])
        .or_insert(edges.len());
    match edges.get_mut(known) {
        None => edges.push(Edge {
            points,
            normal,
            sharp: true,
        }),
        Some(edge) => {
            let cosine: f64 = edge.normal.iter().zip(normal).map(|(a, b)| a * b).sum();
            edge.sharp = cosine < SHARP;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::{CellKind, box_mesh, rectangle};
    use crate::body::{Mesh, Model};

    const EVEN: [f64; 3] = [0.0, 1.0, 2.0];

    fn skin(mesh: Mesh) -> Skin {
        Skin::new(&Body::new("", mesh, Model::PlaneStrain, Vec::new()))
    }

    fn count(skin: &Skin) -> usize {
        skin.points.node_of().count()
    }

    #[test]
    fn a_plane_body_shows_all_cells_and_a_solid_one_its_surface() {
        let plane = skin(rectangle(&EVEN, &EVEN, CellKind::Quad4).unwrap());
        // 4 cells of 2 triangles; 12 edges, 8 of them outside.
        let counts = |skin: &Skin| {
            (
                skin.triangles.len() / 3,
                skin.lines.len() / 2,
                skin.outline.len() / 2,
            )
        };
        assert_eq!((count(&plane), counts(&plane)), (9, (8, 12, 8)));
        let solid = skin(box_mesh(&EVEN, &EVEN, &EVEN, CellKind::Hex8).unwrap());
        // 24 facets of 2 triangles, 48 edges, and of these 2 on each of the box's 12; no node inside.
        assert_eq!((count(&solid), counts(&solid)), (26, (48, 48, 24)));
    }

    #[test]
    fn quadratic_cells_are_drawn_in_small_parts_that_share_their_points() {
        let plane = skin(rectangle(&EVEN, &EVEN, CellKind::Quad8).unwrap());
        assert_eq!(count(&plane), 9 * 9);
        assert_eq!(plane.triangles.len(), 3 * 4 * 32);
        let solid = skin(box_mesh(&EVEN, &EVEN, &EVEN, CellKind::Tet10).unwrap());
        // A closed surface of triangles of genus 0: V = F/2 + 2.
        assert_eq!(count(&solid), solid.triangles.len() / 6 + 2);
    }
}
