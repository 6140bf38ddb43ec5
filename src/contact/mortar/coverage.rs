//! What one side of a pair sees of the other: the covered parts of all its facets.
//!
//! Either side may carry the contacts, so both may be asked on how many of their facets the other one ends.

use std::collections::{HashMap, HashSet};

use nalgebra::Vector3;

use super::check::{Surface, check_dimensions};
use super::cover::Opposite;
use super::flush::reach_flush_ends;
use super::overlap::{Overlaps, Span};
use super::pieces::Piece;
use super::polygon;
use super::search::Bounds;
use super::seen::Seen;
use super::view::View;
use crate::error::Error;

/// Interference that is believed, of the diagonal of the smaller side: more is no fit, and beyond
/// small displacements.
const INTERFERENCE: f64 = 0.05;

/// Part of a limit that is round-off of the coordinates: what is stated to be just within it is.
const WITHIN: f64 = 1.0 + 1e-9;

/// Part of a facet that is round-off beside the whole.
pub(super) const WHOLE: f64 = 1e-9;

/// Part of the distance between two sides in space by which their ends may lie beside each other and be one: the
/// sine of the most that a face's normal has with the mean of both, 30°.
const BESIDE: f64 = 0.5;

/// Cosine above which a neighbouring facet continues the surface and does not turn a corner.
const SMOOTH: f64 = 0.5;

/// Part of a facet's size by which what covers it may be farther away than the nearest facet of all, to be
/// about as near.
const NEAR: f64 = 0.1;

/// Facets of side 1 on which side 2 ends.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::contact) struct Ends {
    pub(in crate::contact) facets: usize,
    /// Their area, in m² (2D: in metre).
    pub(in crate::contact) area: f64,
}

/// How much of a facet is covered.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Extent {
    Bare,
    Part,
    Whole,
}

/// Side 1, and how side 2 covers it.
pub(in crate::contact) struct Coverage<'a> {
    pub(super) one: &'a Surface<'a>,
    pub(super) two: &'a Surface<'a>,
    /// Per piece of side 1.
    seen: Vec<Seen>,
    /// Facets of side 2 that lie over side 1 but look the same way.
    pub(super) averted: usize,
}

impl<'a> Coverage<'a> {
    /// Looks from side 1 at side 2; `place` names the contact pair in messages.
    ///
    /// # Errors
    ///
    /// Meshes of different dimension, and bodies that overlap deeper than a fit.
    pub(in crate::contact) fn new(
        one: &'a Surface<'a>,
        two: &'a Surface<'a>,
        place: &str,
    ) -> Result<Self, Error> {
        check_dimensions(one.mesh, two.mesh, place)?;
        let extents =
            [one, two].map(|side| Bounds::around(side.mesh, side.facets.iter()).diagonal());
        let depth = WITHIN * INTERFERENCE * extents[0].min(extents[1]);
        let reach = extents[0].max(extents[1]);
        let overlaps = Overlaps::new(one.mesh, two.mesh);
        let opposite = Opposite::new(two, &overlaps, [depth, reach]);
        let mut coverage = Self {
            one,
            two,
            seen: Vec::with_capacity(one.pieces.len()),
            averted: 0,
        };
        for (number, piece) in one.pieces.iter().enumerate() {
            let view = View::new(one.mesh, &piece.corners);
            let outline = view.outline(one.mesh, &piece.corners);
            let cover = opposite.cover(&view, &outline, |shape| {
                one.bulges.height(piece.number, &piece.hats(shape))
            });
            let enclosed = |span: &Span| overlaps.encloses(span, depth);
            if let Some(span) = cover.behind.filter(enclosed) {
                return Err(Error::Overlap {
                    place: place.to_owned(),
                    position: span.from.into(),
                    overlap: span.length(),
                    allowed: depth / WITHIN,
                });
            }
            coverage.averted += cover.averted;
            let mut seen = Seen {
                view,
                outline,
                parts: cover.parts,
            };
            reach_flush_ends(one, two, number, &mut seen);
            coverage.seen.push(seen);
        }
        Ok(coverage)
    }

    /// The pieces of a facet of side 1, and what covers them.
    pub(super) fn of(&self, facet: usize) -> impl Iterator<Item = (&Piece<'a>, &Seen)> {
        let pieces = self.one.pieces_of[facet].clone();
        self.one.pieces[pieces.clone()]
            .iter()
            .zip(&self.seen[pieces])
    }

    /// The facets that the other side ends on, within them or at an edge beyond which the surface goes on, where
    /// it is about as near as anywhere: elsewhere nothing will touch.
    pub(in crate::contact) fn ends(&self) -> Ends {
        let covers: Vec<Extent> = (0..self.one.facets.len()).map(|f| self.extent(f)).collect();
        let bare = |facet: &usize| covers[*facet] == Extent::Bare;
        let beyond = self.edges((0..covers.len()).filter(bare));
        let parts = self.seen.iter().flat_map(|seen| seen.distances());
        let near = parts.fold(f64::INFINITY, f64::min);
        let mut ends = Ends::default();
        for (facet, cover) in covers.iter().enumerate() {
            let at_edge = || {
                let normal = self.normal(facet);
                let mut edges = self.edges_of(facet).filter_map(|edge| beyond.get(&edge));
                edges.any(|other| normal.dot(other) > SMOOTH)
            };
            let ends_here = match cover {
                Extent::Bare => false,
                Extent::Part => true,
                Extent::Whole => at_edge(),
            };
            if ends_here && self.is_near(facet, near) {
                ends.facets += 1;
                ends.area += self.area(facet);
            }
        }
        ends
    }

    /// How much of a facet is covered; of faces in space, ends that lie beside each other by less than half of what
    /// both sides are apart are one.
    fn extent(&self, facet: usize) -> Extent {
        let parts = self.of(facet).flat_map(|(_, seen)| &seen.parts);
        let slack = match self.one.mesh.dimension {
            2 => WHOLE,
            _ => parts.fold(WHOLE, |most, part| most.max(BESIDE * part.distance.abs())),
        };
        match self.share(facet) {
            share if share <= slack => Extent::Bare,
            share if share < 1.0 - slack => Extent::Part,
            _ => Extent::Whole,
        }
    }

    /// Covered part of a facet.
    pub(super) fn share(&self, facet: usize) -> f64 {
        let covered = self.of(facet).map(|(_, seen)| {
            let parts = seen.parts.iter();
            parts.map(|part| polygon::area(&part.polygon)).sum::<f64>() * seen.view.unit
        });
        covered.sum::<f64>() / self.area(facet)
    }

    /// Area of a facet, in m² (2D: in metre).
    pub(super) fn area(&self, facet: usize) -> f64 {
        let areas = self.of(facet);
        areas
            .map(|(_, seen)| polygon::area(&seen.outline.polygon()) * seen.view.unit)
            .sum()
    }

    /// Whether something covers a facet that is hardly farther away than `nearest`, in metre.
    fn is_near(&self, facet: usize, nearest: f64) -> bool {
        let mut pieces = self.of(facet);
        pieces.any(|(_, seen)| {
            let within = nearest + NEAR * seen.view.size;
            seen.distances().any(|distance| distance < within)
        })
    }

    fn normal(&self, facet: usize) -> Vector3<f64> {
        let first = self.one.pieces_of[facet].start;
        Vector3::from(self.one.geometries[first].normal)
    }

    /// Edges of a facet by their corners in ascending order; in 2D its ends.
    pub(super) fn edges_of(&self, facet: usize) -> impl Iterator<Item = [usize; 2]> {
        let corners = self.one.corners_of(facet);
        let line = corners.len() == 2;
        let next = corners.iter().cycle().skip(1);
        corners.iter().zip(next).map(move |(&a, &b)| match line {
            true => [a, a],
            false => [a.min(b), a.max(b)],
        })
    }

    /// The edges of some facets with a normal of one of them.
    fn edges(&self, facets: impl Iterator<Item = usize>) -> HashMap<[usize; 2], Vector3<f64>> {
        let edges = facets.flat_map(|facet| {
            let normal = self.normal(facet);
            self.edges_of(facet).map(move |edge| (edge, normal))
        });
        edges.collect()
    }

    /// Whether the other side covers anything at all.
    pub(in crate::contact) fn meets(&self) -> bool {
        self.seen.iter().any(|seen| !seen.parts.is_empty())
    }

    /// Number of those of the given facets of either side that are rounded, and how far the smooth
    /// surface stands off one of them at most, in metre.
    pub(in crate::contact) fn rounded(&self, facets: [&[usize]; 2]) -> (usize, f64) {
        let [own, across] = facets;
        let (own, most) = self.one.bulges.rounded(own);
        let (across, other) = self.two.bulges.rounded(across);
        (own + across, most.max(other))
    }

    /// Numbers of the facets of both sides that meet at all, in ascending order.
    pub(in crate::contact) fn met(&self) -> [Vec<usize>; 2] {
        let own = |facet: &usize| self.of(*facet).any(|(_, seen)| !seen.parts.is_empty());
        let parts = self.seen.iter().flat_map(|seen| &seen.parts);
        let mut across: Vec<usize> = parts.map(|p| self.two.pieces[p.opposite].number).collect();
        across.sort_unstable();
        across.dedup();
        [(0..self.one.facets.len()).filter(own).collect(), across]
    }
    /// How many times as long as those of side 2 the facets of side 1 are, about, where they meet: by the nodes there.
    pub(in crate::contact) fn finer_across(&self) -> f64 {
        let sides = [self.one, self.two].into_iter().zip(self.met());
        let mut counts = sides.map(|(side, facets)| {
            let of_facets = facets.iter().flat_map(|facet| &side.facets[*facet].nodes);
            of_facets.collect::<HashSet<_>>().len() as f64
        });
        let (own, across) = (counts.next(), counts.next());
        let ratio = across.unwrap_or_default() / own.unwrap_or_default().max(1.0);
        match self.one.mesh.dimension {
            2 => ratio,
            _ => ratio.sqrt(),
        }
    }
}
