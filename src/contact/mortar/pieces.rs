//! Facets as linear pieces, which can be seen, clipped and integrated over.
//!
//! A linear facet is its only piece, and so is a quadratic one with straight sides on its corners.
//! One with curved sides is cut at its nodes: a line into two, a triangle and a quadrilateral
//! with a middle node into four, one without into a quadrilateral and four triangles. Its shape
//! functions are taken where the point of the piece is on the reference facet. This is exact
//! for straight sides; otherwise the geometry that areas and overlaps are taken from is
//! off by a quarter of the error that linear facets on the corners would have.

use nalgebra::Vector3;

use crate::body::{Facet, FacetReference, MOST_FACET_NODES, Mesh};

/// Departure from straight sides, relative to the size of the facet, that is round-off.
const STRAIGHT: f64 = 1e-10;

/// A linear piece of a facet.
pub(super) struct Piece<'a> {
    /// The facet it is of.
    pub(super) facet: &'a Facet,
    /// Its corners.
    pub(super) corners: Facet,
    /// Where they are on the reference facet, if that is quadratic.
    parent: Option<(FacetReference, Vec<[f64; 3]>)>,
}

impl<'a> Piece<'a> {
    /// The pieces of a facet, whose nodes exist.
    pub(super) fn of(mesh: &Mesh, facet: &'a Facet) -> Vec<Self> {
        let whole = |parent| Self {
            facet,
            corners: Facet {
                nodes: facet.corners(mesh.dimension).to_vec(),
            },
            parent,
        };
        let Some(reference) = FacetReference::of(mesh.dimension, facet.nodes.len()) else {
            return Vec::new();
        };
        if !facet.is_quadratic(mesh.dimension) {
            return vec![whole(None)];
        }
        let nodes = reference.nodes();
        if is_straight(mesh, facet, reference) {
            let corners = nodes[..reference.corners()].to_vec();
            return vec![whole(Some((reference, corners)))];
        }
        let cut = cuts(nodes.len()).iter();
        cut.map(|locals| Self {
            facet,
            corners: Facet {
                nodes: locals.iter().map(|local| facet.nodes[*local]).collect(),
            },
            parent: Some((
                reference,
                locals.iter().map(|local| nodes[*local]).collect(),
            )),
        })
        .collect()
    }

    /// Whether the facet has nodes beside its corners.
    pub(super) fn is_quadratic(&self) -> bool {
        self.parent.is_some()
    }

    /// Number of the facet's corners.
    pub(super) fn hat_count(&self) -> usize {
        match &self.parent {
            None => self.corners.nodes.len(),
            Some((reference, _)) => reference.corners(),
        }
    }

    /// Values at the facet's nodes of its shape functions, from those of the piece.
    pub(super) fn shape(&self, of_piece: &[f64; 4]) -> [f64; MOST_FACET_NODES] {
        let mut values = [0.0; MOST_FACET_NODES];
        match self.on_facet(of_piece) {
            None => values[..4].copy_from_slice(of_piece),
            Some((reference, at)) => {
                for (value, shape) in values.iter_mut().zip(reference.shape(at)) {
                    *value = shape;
                }
            }
        }
        values
    }

    /// Values at the facet's corners of the functions that are linear on it.
    pub(super) fn hats(&self, of_piece: &[f64; 4]) -> [f64; 4] {
        let mut values = *of_piece;
        if let Some((reference, at)) = self.on_facet(of_piece) {
            values = [0.0; 4];
            for (value, hat) in values.iter_mut().zip(reference.hats(at)) {
                *value = hat;
            }
        }
        values
    }

    fn on_facet(&self, of_piece: &[f64; 4]) -> Option<(FacetReference, [f64; 3])> {
        let (reference, corners) = self.parent.as_ref()?;
        let mut at = [0.0; 3];
        for (corner, value) in corners.iter().zip(of_piece) {
            for (sum, x) in at.iter_mut().zip(corner) {
                *sum += x * value;
            }
        }
        Some((*reference, at))
    }
}

/// Whether the nodes between corners are where straight sides have them.
fn is_straight(mesh: &Mesh, facet: &Facet, reference: FacetReference) -> bool {
    let x = |node: &usize| Vector3::from(mesh.nodes[*node]);
    let corners: Vec<_> = facet.corners(mesh.dimension).iter().map(x).collect();
    let size = corners.iter().map(|c| (c - corners[0]).norm());
    let allowed = STRAIGHT * size.fold(0.0, f64::max);
    facet.nodes.iter().zip(reference.nodes()).all(|(node, at)| {
        let terms = corners.iter().zip(reference.hats(*at));
        let straight: Vector3<f64> = terms.map(|(corner, hat)| corner * hat).sum();
        (x(node) - straight).norm() <= allowed
    })
}

/// Local nodes of the pieces of a facet of so many nodes.
fn cuts(nodes: usize) -> &'static [&'static [usize]] {
    match nodes {
        3 => &[&[0, 2], &[2, 1]],
        6 => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
        8 => &[
            &[0, 4, 7],
            &[4, 1, 5],
            &[5, 2, 6],
            &[6, 3, 7],
            &[4, 5, 6, 7],
        ],
        _ => &[&[0, 4, 8, 7], &[4, 1, 5, 8], &[8, 5, 2, 6], &[7, 8, 6, 3]],
    }
}
