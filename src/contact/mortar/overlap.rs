//! Whether bodies overlap where one side lies behind the other.
//!
//! ```text
//! w(x) = 1/(2π) Σ angle of a line seen from x        (2D)
//!        1/(4π) Σ solid angle of a facet seen from x (3D)     over the boundary of a mesh
//! ```
//!
//! `w` counts how often the mesh covers `x`. Half way between the sides, bodies that overlap
//! are both there; below a thin body that lies on the other one only one of them is. Where they are both
//! there, but not to either side of the span, they are in each other across it: what is a fit seen from
//! their tops is none of their walls.
//!
//! A face behind another one by as much as the thicker of both walls is the far side of walls, and in nothing:
//!
//! ```text
//! d ≥ max(w₁, w₂)       d: distance back to it;  w: how far from either face its own body reaches
//! ```
//!
//! Solid angle of a triangle: van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125–126.

use std::f64::consts::PI;
use std::sync::OnceLock;

use nalgebra::Vector3;

use super::search::Bounds;
use crate::body::{Facet, Mesh};

/// Both bodies are there: one and one, less what round-off may take.
const BOTH: f64 = 1.5;

/// Part of a depth that is within half of any overlap as deep.
const NEARLY_HALF: f64 = 0.499;

/// Directions across a span in space.
const DIRECTIONS: u32 = 8;

/// Part of a facet by which a line that meets its edge may miss it.
const EDGE: f64 = 1e-9;

/// A line between two points of space, in metre.
#[derive(Clone, Copy)]
pub(super) struct Span {
    pub(super) from: Vector3<f64>,
    pub(super) to: Vector3<f64>,
}

impl Span {
    pub(super) fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }
}

/// The two meshes of a pair; one mesh where a body meets itself.
pub(in crate::contact) struct Overlaps<'a> {
    solids: Vec<Solid<'a>>,
}

struct Solid<'a> {
    mesh: &'a Mesh,
    bounds: Bounds,
    boundary: OnceLock<Vec<Facet>>,
}

impl<'a> Overlaps<'a> {
    pub(in crate::contact) fn new(mesh1: &'a Mesh, mesh2: &'a Mesh) -> Self {
        let meshes = [mesh1, mesh2];
        let count = if std::ptr::eq(mesh1, mesh2) { 1 } else { 2 };
        let solids = meshes.into_iter().take(count).map(Solid::new);
        Self {
            solids: solids.collect(),
        }
    }

    /// The middle of the span, and all around it up to half of `depth` in metre, is inside of both bodies, or twice
    /// inside of the one.
    pub(super) fn encloses(&self, span: &Span, depth: f64) -> bool {
        let middle = (span.from + span.to) / 2.0;
        let along = (span.to - span.from).normalize();
        let mut around = self.across(along).chain([along, -along]);
        self.both(middle) && around.all(|way| self.both(middle + way * (NEARLY_HALF * depth)))
    }

    /// How far the body of a side, 0 or 1, reaches from a point on its boundary in a direction of length 1, in metre;
    /// infinite where no end is seen.
    pub(in crate::contact) fn reach(
        &self,
        side: usize,
        from: Vector3<f64>,
        along: Vector3<f64>,
    ) -> f64 {
        let solid = self.solids.get(side).or(self.solids.last());
        solid.map_or(f64::INFINITY, |solid| solid.thickness(from, along))
    }

    fn both(&self, point: Vector3<f64>) -> bool {
        let near = |solid: &Solid<'_>| solid.bounds.contains(point.into());
        let times = || self.solids.iter().map(|s| s.times_inside(point));
        self.solids.iter().all(near) && times().sum::<f64>() > BOTH
    }

    /// Unit vectors across a direction, evenly around it.
    fn across(&self, along: Vector3<f64>) -> impl Iterator<Item = Vector3<f64>> + use<> {
        let plane = self.solids.iter().all(|solid| solid.mesh.dimension == 2);
        let mut least = Vector3::zeros();
        least[if plane { 2 } else { along.abs().imin() }] = 1.0;
        let first = along.cross(&least).normalize();
        let second = along.cross(&first);
        let count = if plane { 2 } else { DIRECTIONS };
        (0..count).map(move |k| {
            let (sin, cos) = (2.0 * PI * f64::from(k) / f64::from(count)).sin_cos();
            // In the plane, nothing is across but there and back.
            first * cos + second * if plane { 0.0 } else { sin }
        })
    }
}

impl<'a> Solid<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        Self {
            mesh,
            bounds: Bounds::of(&mesh.nodes),
            boundary: OnceLock::new(),
        }
    }

    fn boundary(&self) -> &[Facet] {
        self.boundary.get_or_init(|| self.mesh.boundary_facets())
    }

    /// How far it is from a point to where a direction of length 1 leaves the body, in metre; infinite where it does not.
    fn thickness(&self, from: Vector3<f64>, along: Vector3<f64>) -> f64 {
        let at = |node: usize| Vector3::from(self.mesh.nodes[node]) - from;
        let ends =
            self.boundary()
                .iter()
                .filter_map(|facet| match *facet.corners(self.mesh.dimension) {
                    [a, b] => leaves_at(along, [at(a), at(b), at(b) + Vector3::z()]),
                    [a, b, c] => leaves_at(along, [a, b, c].map(at)),
                    [a, b, c, d] => leaves_at(along, [a, b, c].map(at))
                        .or_else(|| leaves_at(along, [a, c, d].map(at))),
                    _ => None,
                });
        ends.fold(f64::INFINITY, f64::min)
    }

    /// How often the mesh covers a point.
    fn times_inside(&self, point: Vector3<f64>) -> f64 {
        let boundary = self.boundary();
        let seen = |node: &usize| Vector3::from(self.mesh.nodes[*node]) - point;
        let angles = boundary.iter().map(|facet| {
            let corners = facet.corners(self.mesh.dimension).iter();
            let corners: Vec<Vector3<f64>> = corners.map(seen).collect();
            match corners[..] {
                [a, b] => 2.0 * angle(a, b),
                [a, b, c] => solid_angle(a, b, c),
                [a, b, c, d] => solid_angle(a, b, c) + solid_angle(a, c, d),
                _ => 0.0,
            }
        });
        angles.sum::<f64>() / (4.0 * PI)
    }
}

/// How far along a direction of length 1 a line from the origin leaves through a triangle with outward normal
/// `(b − a) × (c − a)`; none if it does not. (Möller, Trumbore, J. Graphics Tools 2 (1997) 21–28.)
fn leaves_at(along: Vector3<f64>, [a, b, c]: [Vector3<f64>; 3]) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let across = along.cross(&ac);
    let twice = ab.dot(&across);
    let (u, v) = (-a.dot(&across) / twice, along.dot(&ab.cross(&a)) / twice);
    let distance = ac.dot(&ab.cross(&a)) / twice;
    let within = u >= -EDGE && v >= -EDGE && u + v <= 1.0 + EDGE;
    (within && along.dot(&ab.cross(&ac)) > 0.0 && distance > 0.0).then_some(distance)
}

/// Angle from one direction of the plane to another, against the clock.
fn angle(a: Vector3<f64>, b: Vector3<f64>) -> f64 {
    (a.x * b.y - a.y * b.x).atan2(a.dot(&b))
}

/// Solid angle of a triangle, positive when it looks away from the origin.
fn solid_angle(a: Vector3<f64>, b: Vector3<f64>, c: Vector3<f64>) -> f64 {
    let lengths = [a.norm(), b.norm(), c.norm()];
    let below = lengths[0] * lengths[1] * lengths[2]
        + a.dot(&b) * lengths[2]
        + b.dot(&c) * lengths[0]
        + c.dot(&a) * lengths[1];
    2.0 * a.dot(&b.cross(&c)).atan2(below)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::{CellKind, box_mesh, rectangle};

    /// Blocks of edge 1 over the origin, and the same `shift` further along the last axis.
    fn blocks(kind: CellKind, shift: f64) -> [Mesh; 2] {
        let (from, to) = ([0.0, 0.3, 1.0], [shift, shift + 1.0]);
        [[0.0, 1.0], to].map(|up| match kind.dimension() {
            2 => rectangle(&from, &up, kind).unwrap(),
            _ => box_mesh(&from, &from, &up, kind).unwrap(),
        })
    }

    /// From the bottom of the upper block back to the top of the lower one, through the centre.
    fn back(dimension: usize, shift: f64) -> Span {
        let mut ends = [Vector3::new(0.5, 0.5, 0.0); 2];
        (ends[0][dimension - 1], ends[1][dimension - 1]) = (shift, 1.0);
        Span {
            from: ends[0],
            to: ends[1],
        }
    }

    #[test]
    fn a_point_is_once_inside_the_mesh_around_it_and_never_outside() {
        for kind in CellKind::LINEAR {
            let [mesh, _] = blocks(kind, 0.5);
            let solid = Solid::new(&mesh);
            let depth = if kind.dimension() == 2 { 0.0 } else { 0.4 };
            let at = |x: f64| solid.times_inside(Vector3::new(x, 0.2, depth));
            assert!((at(0.9) - 1.0).abs() < 1e-14, "{kind:?} {}", at(0.9));
            assert!(at(1.2).abs() < 1e-14, "{kind:?} {}", at(1.2));
        }
    }

    #[test]
    fn bodies_overlap_where_both_are_there() {
        for kind in CellKind::LINEAR {
            for (shift, expected) in [(0.7, true), (0.2, true), (1.0, false)] {
                let [lower, upper] = blocks(kind, shift);
                let mut span = back(kind.dimension(), shift);
                if !expected {
                    // From the top of the upper one to the bottom of the lower one.
                    (
                        span.from[kind.dimension() - 1],
                        span.to[kind.dimension() - 1],
                    ) = (2.0, 0.0);
                    span.from *= 0.9;
                }
                let found = Overlaps::new(&upper, &lower).encloses(&span, 0.1);
                assert_eq!(found, expected, "{kind:?} {shift}");
            }
        }
    }

    #[test]
    fn walls_of_bodies_that_fit_by_little_are_in_nothing() {
        for kind in CellKind::LINEAR {
            let [lower, upper] = blocks(kind, 0.99);
            let mut span = back(kind.dimension(), 0.99);
            // From one wall of the upper one to the other of the lower one, through what they share.
            let up = kind.dimension() - 1;
            (span.from[up], span.to[up]) = (0.995, 0.995);
            (span.from[0], span.to[0]) = (1.0, 0.0);
            let overlaps = Overlaps::new(&upper, &lower);
            assert!(!overlaps.encloses(&span, 0.1), "{kind:?}");
            assert!(overlaps.encloses(&span, 0.005), "{kind:?}");
            // From the top of the upper one to the bottom of the lower one, with its middle in what they share.
            (span.from, span.to) = (Vector3::repeat(0.5), Vector3::repeat(0.5));
            (span.from[up], span.to[up]) = (1.99, 0.0);
            assert!(!overlaps.encloses(&span, 0.1), "{kind:?}");
        }
    }

    #[test]
    fn a_body_that_covers_a_place_twice_overlaps_itself() {
        for kind in CellKind::LINEAR {
            let [mut body, upper] = blocks(kind, 0.7);
            let first = body.nodes.len();
            body.nodes.extend(&upper.nodes);
            for cell in upper.cells() {
                let nodes: Vec<usize> = cell.nodes.iter().map(|node| node + first).collect();
                body.push_cell(kind, &nodes);
            }
            let span = back(kind.dimension(), 0.7);
            assert!(Overlaps::new(&body, &body).encloses(&span, 0.1), "{kind:?}");
            assert!(
                !Overlaps::new(&upper, &upper).encloses(&span, 0.1),
                "{kind:?}"
            );
        }
    }
}
