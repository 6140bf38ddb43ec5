//! The parts of a facet that the other side covers, and by which facet.
//!
//! ```text
//! facing    m · m² < −½                      m, m²: outward normals
//! in reach  g > −depth                       g: distance along m; any distance in front
//! behind    −reach < g ≤ −depth              an overlap, or the far side of a thin body
//! nearest   least |g|                        where several layers lie over each other
//! ```
//!
//! The far sides of walls, which no overlap is as deep as, are left out.
//!
//! Sides that touch are parallel there; facets that are inclined by more than 60° to
//! each other only meet at edges that turn a corner.

use nalgebra::Vector3;

use super::check::Surface;
use super::overlap::{Overlaps, Span};
use super::polygon::{Polygon, area, centroid, difference, intersection};
use super::search::{Prism, Tree};
use super::view::{Outline, View};

/// Cosine between the outward normals of facets that face each other, at most.
const FACING: f64 = -0.5;

/// Area of a part, relative to the facet, that is round-off.
const SLIVER: f64 = 1e-14;

/// Depth, relative to the facet, below which nothing behind it is the far side of a wall.
const SHALLOW: f64 = 1e-2;

/// Part of the depth that is believed below which nothing is the far side of a wall: thinner ones are not looked for.
const THIN: f64 = 0.02;

/// Part of a wall from which a face as deep behind another one is its far side.
const WALL: f64 = 0.95;

/// Common area of two parts, relative to the smaller, below which they lie side by side.
const OVERLAP: f64 = 1e-9;

/// The opposite side, ready to be looked at.
pub(super) struct Opposite<'a> {
    surface: &'a Surface<'a>,
    overlaps: &'a Overlaps<'a>,
    tree: Tree,
    /// Depth behind a facet down to which overlap is believed, and down to which it is
    /// looked for, in metre.
    depth: f64,
    reach: f64,
}

/// What the opposite side is to a facet.
#[derive(Default)]
pub(super) struct Cover {
    /// The parts that it covers.
    pub(super) parts: Vec<Part>,
    /// Facets that lie over it but look the same way.
    pub(super) averted: usize,
    /// From the facet back to the nearest facet that is deeper behind it than believed.
    pub(super) behind: Option<Span>,
}

/// A part of a facet and the facet of the other side that covers it.
#[derive(Clone)]
pub(super) struct Part {
    /// Number of the covering piece.
    pub(super) opposite: usize,
    /// The covering facet in the plane of the covered one.
    pub(super) outline: Outline,
    /// The covered area in that plane.
    pub(super) polygon: Polygon,
    /// Distance to the covering facet, in the plane's unit.
    pub(super) distance: f64,
}

impl<'a> Opposite<'a> {
    pub(super) fn new(
        surface: &'a Surface<'a>,
        overlaps: &'a Overlaps<'a>,
        [depth, reach]: [f64; 2],
    ) -> Self {
        Self {
            surface,
            overlaps,
            tree: Tree::new(surface.mesh, &surface.corners),
            depth,
            reach,
        }
    }

    /// What the opposite side is to a facet, whose smooth surface stands off by `bulge` in metre where its
    /// functions have given values.
    pub(super) fn cover(
        &self,
        view: &View,
        outline: &Outline,
        bulge: impl Fn(&[f64; 4]) -> f64,
    ) -> Cover {
        let facet = outline.polygon();
        let least = SLIVER * area(&facet);
        let mut cover = Cover::default();
        for index in self.tree.over(&Prism::new(view, &facet, self.reach)) {
            let cosine = view
                .normal
                .dot(&Vector3::from(self.surface.geometries[index].normal));
            cover.averted += usize::from(cosine > -FACING);
            if cosine >= FACING {
                continue;
            }
            let Some(mut part) = self.part(view, outline, &facet, least, index) else {
                continue;
            };
            let between = bulge(&outline.shape(centroid(&part.polygon))) + self.bulge(&part);
            part.distance -= self.surface.bulges.taken(between) / view.size;
            if part.distance * view.size <= -self.reach {
                continue;
            }
            let (span, depth) = (part.span(view, outline), -part.distance * view.size);
            if depth < self.depth {
                let deep = part.distance < -SHALLOW && depth > THIN * self.depth;
                let wall = || {
                    let own = self.overlaps.reach(0, span.from, -view.normal);
                    own.max(self.overlaps.reach(1, span.to, view.normal))
                };
                if !(deep && depth >= WALL * wall()) {
                    cover.parts.push(part);
                }
                continue;
            }
            if (cover.behind.as_ref()).is_none_or(|known| span.length() < known.length()) {
                cover.behind = Some(span);
            }
        }
        cover.parts = nearest(cover.parts, least);
        cover
    }

    /// What one facet covers, if anything.
    fn part(
        &self,
        view: &View,
        facet: &Outline,
        polygon: &Polygon,
        least: f64,
        opposite: usize,
    ) -> Option<Part> {
        let outline = view.outline(self.surface.mesh, &self.surface.corners[opposite]);
        // A warped facet seen askew may fold over itself: then it hides what it covers.
        if outline.least_turn(-1.0) <= 0.0 {
            return None;
        }
        let polygon = intersection(&outline.polygon(), polygon);
        if area(&polygon) <= least {
            return None;
        }
        let centre = centroid(&polygon);
        let distance = outline.height(&outline.shape(centre)) - facet.height(&facet.shape(centre));
        Some(Part {
            opposite,
            outline,
            polygon,
            distance,
        })
    }

    /// How far the smooth surface of what covers a part stands off there, in metre.
    fn bulge(&self, part: &Part) -> f64 {
        let piece = &self.surface.pieces[part.opposite];
        let shape = part.outline.shape(centroid(&part.polygon));
        self.surface
            .bulges
            .height(piece.number, &piece.hats(&shape))
    }
}

impl Part {
    /// From the covered facet to the covering one, at the centre of the part.
    fn span(&self, view: &View, facet: &Outline) -> Span {
        let centre = centroid(&self.polygon);
        let height = facet.height(&facet.shape(centre));
        let at = |height| view.position(facet.within(centre, height));
        Span {
            from: at(height),
            to: at(height + self.distance),
        }
    }
}

/// Takes from every part what nearer parts cover as well.
fn nearest(mut parts: Vec<Part>, least: f64) -> Vec<Part> {
    parts.sort_by(|a, b| a.distance.abs().total_cmp(&b.distance.abs()));
    let hidden_by = overlaps(&parts);
    if hidden_by.is_empty() {
        return parts;
    }
    let mut left: Vec<Vec<Polygon>> = parts.iter().map(|p| vec![p.polygon.clone()]).collect();
    for (nearer, farther) in hidden_by {
        let seen = std::mem::take(&mut left[farther]).into_iter();
        let without = |polygon: Polygon| difference(&polygon, &parts[nearer].polygon, least);
        left[farther] = seen.flat_map(without).collect();
    }
    let visible = parts.into_iter().zip(left);
    visible
        .flat_map(|(part, polygons)| {
            polygons
                .into_iter()
                .map(move |polygon| Part { polygon, ..part })
        })
        .collect()
}

/// Pairs (nearer, farther) of parts that lie over each other, found by a sweep along x.
fn overlaps(parts: &[Part]) -> Vec<(usize, usize)> {
    let range = |part: &Part, axis: usize| {
        let along = part.polygon.iter().map(|corner| corner[axis]);
        let low = along.clone().fold(f64::INFINITY, f64::min);
        (low, along.fold(f64::NEG_INFINITY, f64::max))
    };
    let boxes: Vec<_> = parts
        .iter()
        .map(|part| [range(part, 0), range(part, 1)])
        .collect();
    let areas: Vec<f64> = parts.iter().map(|part| area(&part.polygon)).collect();
    let mut order: Vec<usize> = (0..parts.len()).collect();
    order.sort_by(|a, b| boxes[*a][0].0.total_cmp(&boxes[*b][0].0));
    let mut pairs = Vec::new();
    for (at, &one) in order.iter().enumerate() {
        let [(_, right), (bottom, top)] = boxes[one];
        let rest = order[at + 1..].iter();
        for &other in rest.take_while(|other| boxes[**other][0].0 < right) {
            let (low, high) = boxes[other][1];
            let least = OVERLAP * areas[one].min(areas[other]);
            // Neighbours share an edge: their boxes overlap by round-off, if at all.
            let common = (right - boxes[other][0].0) * (top.min(high) - bottom.max(low));
            if top <= low
                || high <= bottom
                || common <= least
                || area(&intersection(&parts[one].polygon, &parts[other].polygon)) <= least
            {
                continue;
            }
            pairs.push((one.min(other), one.max(other)));
        }
    }
    pairs
}
