//! A facet that is covered, and its cover, in the facet's own plane.
//!
//! Points of a facet are taken for those of the plane through its corners where the corners' functions
//! have the same values: exact on plane facets with straight sides, and on all others the plane in
//! which these functions are linear.

use nalgebra::Vector3;

use super::coverage::{Coverage, WHOLE};
use super::polygon::{Point, Polygon, nearest};
use super::ties::first_largest;
use super::view::{Outline, View};
use crate::body::Facet;

/// Part of a facet's size up to which the cover ends at a corner.
const AT_END: f64 = 1e-9;

/// A covered facet of side 1.
pub(super) struct Tile {
    pub(super) facet: usize,
    /// The plane through its corners, and these.
    pub(super) view: View,
    pub(super) outline: Outline,
    /// What is covered of it.
    pub(super) polygons: Vec<Polygon>,
    /// How far its cover may end beside its own end, in the plane's unit, for both ends to be one: sides that are apart
    /// and inclined to each other are beside each other seen along either normal.
    pub(super) slack: f64,
    /// Its area in m², and the covered part of that.
    pub(super) area: f64,
    pub(super) share: f64,
}

/// The point of a cover that is nearest to a corner.
pub(super) struct Nearest {
    pub(super) at: Point,
    /// From the corner, in the plane's unit.
    pub(super) distance: f64,
    /// How far across the facet towards the corner it is: 0 at the far side, 1 at the corner.
    pub(super) depth: f64,
}

impl Tile {
    /// None where nothing is covered.
    pub(super) fn of(coverage: &Coverage<'_>, facet: usize) -> Option<Self> {
        let mesh = coverage.one.mesh;
        let nodes = coverage.one.corners_of(facet).to_vec();
        let corners = Facet { nodes };
        let view = View::new(mesh, &corners);
        let outline = view.outline(mesh, &corners);
        let (mut polygons, mut slack) = (Vec::new(), AT_END);
        for (piece, seen) in coverage.of(facet) {
            let within = |at: &Point| outline.at(&piece.hats(&seen.outline.shape(*at)));
            for part in &seen.parts {
                let opposite = Vector3::from(coverage.two.geometries[part.opposite].normal);
                let inclined = (seen.view.normal + opposite).norm();
                slack = inclined.mul_add(part.distance.abs(), AT_END).max(slack);
            }
            let parts = seen.parts.iter();
            polygons.extend(parts.map(|part| part.polygon.iter().map(within).collect()));
        }
        (!polygons.is_empty()).then_some(Self {
            facet,
            view,
            outline,
            polygons,
            slack,
            area: coverage.area(facet),
            share: coverage.share(facet),
        })
    }

    /// Whether all of it is covered.
    pub(super) fn is_whole(&self) -> bool {
        self.share >= 1.0 - WHOLE
    }

    /// The point of the cover nearest to a corner.
    pub(super) fn nearest(&self, corner: usize) -> Nearest {
        let from = self.outline.corners()[corner];
        let points = self.polygons.iter().map(|polygon| nearest(polygon, from));
        let distance = |at: &Point| (at - from).norm();
        let at = first_largest(points, |at| -distance(at)).unwrap_or(from);
        Nearest {
            at,
            distance: distance(&at),
            depth: self.depth(corner, at),
        }
    }

    fn depth(&self, corner: usize, at: Point) -> f64 {
        let shape = self.outline.shape(at);
        if self.outline.corners().len() < 4 {
            return shape[corner];
        }
        // A quadrilateral's point as (u, v) in the unit square.
        let (u, v) = (shape[1] + shape[2], shape[2] + shape[3]);
        match corner {
            0 => (1.0 - u).min(1.0 - v),
            1 => u.min(1.0 - v),
            2 => u.min(v),
            _ => (1.0 - u).min(v),
        }
    }
}
