//! Facets as linear pieces, which can be seen, clipped and integrated over.
//!
//! A linear facet is its only piece, and so is a quadratic one with straight sides on its corners.
//! One with curved sides is cut at its nodes: a line into two, a triangle and a quadrilateral
//! with a middle node into four, one without into a quadrilateral and four triangles. Its shape
//! functions are taken where the point of the piece is on the reference facet. This is exact
//! for straight sides; otherwise the geometry that areas and overlaps are taken from is
//! off by a quarter of the error that linear facets on the corners would have.

use nalgebra::Vector3;

use super::super::turn::is_straight;
use crate::body::{Facet, FacetReference, MOST_FACET_NODES, Mesh};

/// A linear piece of a facet.
pub(super) struct Piece<'a> {
    /// The facet it is of, and its number.
    pub(super) facet: &'a Facet,
    pub(super) number: usize,
    /// Its corners.
    pub(super) corners: Facet,
    /// Where they are on the reference facet, if that is quadratic.
    parent: Option<(FacetReference, Vec<[f64; 3]>)>,
}

impl<'a> Piece<'a> {
    /// The pieces of a facet, whose nodes exist.
    pub(super) fn of(mesh: &Mesh, number: usize, facet: &'a Facet) -> Vec<Self> {
        let whole = |parent| Self {
            facet,
            number,
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
        if is_straight(mesh, facet) {
            let corners = nodes[..reference.corners()].to_vec();
            return vec![whole(Some((reference, corners)))];
        }
        let cut = cuts(nodes.len()).iter();
        cut.map(|locals| Self {
            facet,
            number,
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

    /// Unit normal of a quadratic facet at a point of the piece; none if the facet is linear.
    pub(super) fn normal(&self, mesh: &Mesh, of_piece: &[f64; 4]) -> Option<Vector3<f64>> {
        let (reference, at) = self.on_facet(of_piece)?;
        let x = |node: &usize| Vector3::from(mesh.nodes[*node]);
        let mut tangents = [Vector3::zeros(), Vector3::zeros()];
        for (node, slopes) in self.facet.nodes.iter().zip(reference.slopes(at)) {
            for (tangent, slope) in tangents.iter_mut().zip(slopes) {
                *tangent += x(node) * slope;
            }
        }
        let across = if mesh.dimension == 2 {
            Vector3::z()
        } else {
            tangents[1]
        };
        tangents[0].cross(&across).try_normalize(0.0)
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
