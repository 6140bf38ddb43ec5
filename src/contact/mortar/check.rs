//! What the facets of both sides must be, so that everything after can rely on it.

use std::collections::HashMap;
use std::ops::Range;

use nalgebra::Vector3;

use super::super::rounding::Bulges;
use super::pieces::Piece;
use super::view::View;
use crate::body::{Facet, FacetGeometry, Mesh};
use crate::error::{Error, check_finite};

/// Least turn at a facet's corners, relative to the square of its size.
const FLAT: f64 = 1e-12;

/// The facets of one side, and their linear pieces.
pub(in crate::contact) struct Surface<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) facets: &'a [Facet],
    pub(super) pieces: Vec<Piece<'a>>,
    /// Numbers of each facet's pieces.
    pub(super) pieces_of: Vec<Range<usize>>,
    /// Corners of the pieces.
    pub(super) corners: Vec<Facet>,
    /// Geometries of the pieces.
    pub(super) geometries: Vec<FacetGeometry>,
    /// How far the smooth surface stands off the facets.
    pub(super) bulges: Bulges,
    /// How much the body gives way beside the other one.
    pub(super) compliance: f64,
    /// In 2D, the directions in which the body's boundary goes on where this side ends, by its last nodes.
    pub(super) flanks: HashMap<usize, Vector3<f64>>,
}

impl<'a> Surface<'a> {
    /// Cuts the facets of a side; refuses what is no surface of the mesh.
    ///
    /// # Errors
    ///
    /// No facet at all, a wrong number of nodes, a node that does not exist or whose
    /// position is not finite, a facet without area or with a corner that turns backwards.
    pub(in crate::contact) fn new(
        mesh: &'a Mesh,
        facets: &'a [Facet],
        place: &str,
    ) -> Result<Self, Error> {
        if facets.is_empty() {
            return Err(Error::Empty {
                place: place.to_owned(),
            });
        }
        let mut surface = Self {
            mesh,
            facets,
            pieces: Vec::with_capacity(facets.len()),
            pieces_of: Vec::with_capacity(facets.len()),
            corners: Vec::with_capacity(facets.len()),
            geometries: Vec::with_capacity(facets.len()),
            bulges: Bulges::none(facets.len()),
            flanks: HashMap::new(),
            compliance: 1.0,
        };
        for (index, facet) in facets.iter().enumerate() {
            let place = format!("{place}[{index}]");
            check_nodes(mesh, facet, &place)?;
            let first = surface.pieces.len();
            for piece in Piece::of(mesh, index, facet) {
                surface
                    .geometries
                    .push(geometry(mesh, &piece.corners, &place)?);
                surface.corners.push(piece.corners.clone());
                surface.pieces.push(piece);
            }
            surface.pieces_of.push(first..surface.pieces.len());
        }
        Ok(surface)
    }

    /// The same, with what its facets stand for and how the body's boundary goes on.
    pub(in crate::contact) fn with(
        self,
        bulges: Bulges,
        flanks: HashMap<usize, Vector3<f64>>,
    ) -> Self {
        Self {
            bulges,
            flanks,
            ..self
        }
    }

    /// The same of a body that gives way by so much beside the other one.
    pub(in crate::contact) fn giving_way(self, compliance: f64) -> Self {
        Self { compliance, ..self }
    }

    /// Whether a facet's nodes are its corners.
    pub(super) fn is_linear(&self, facet: usize) -> bool {
        !self.facets[facet].is_quadratic(self.mesh.dimension)
    }

    /// Corners of a facet.
    pub(super) fn corners_of(&self, facet: usize) -> &'a [usize] {
        self.facets[facet].corners(self.mesh.dimension)
    }
}

/// Refuses sides in meshes of different dimension.
pub(super) fn check_dimensions(one: &Mesh, two: &Mesh, place: &str) -> Result<(), Error> {
    if one.dimension == two.dimension {
        return Ok(());
    }
    Err(Error::WrongDimension {
        place: format!("{place}.opposite"),
        expected: one.dimension,
        found: two.dimension,
    })
}

fn check_nodes(mesh: &Mesh, facet: &Facet, place: &str) -> Result<(), Error> {
    if facet.corners(mesh.dimension).is_empty() {
        return Err(refuse(facet, place, "of the wrong number of nodes"));
    }
    for &node in &facet.nodes {
        let Some(position) = mesh.nodes.get(node) else {
            return Err(Error::UnknownIndex {
                place: place.to_owned(),
                what: "node",
                index: node,
                count: mesh.nodes.len(),
            });
        };
        check_finite(&format!("{place}: node {node}"), position)?;
    }
    Ok(())
}

fn geometry(mesh: &Mesh, facet: &Facet, place: &str) -> Result<FacetGeometry, Error> {
    let geometry = mesh.facet_geometry(facet);
    if !(geometry.area > 0.0 && geometry.area.is_finite()) || geometry.normal == [0.0; 3] {
        return Err(refuse(facet, place, "without area"));
    }
    let view = View::new(mesh, facet);
    if view.outline(mesh, facet).least_turn(1.0) > FLAT {
        Ok(geometry)
    } else {
        Err(refuse(facet, place, "with a corner that is flat or folded"))
    }
}

fn refuse(facet: &Facet, place: &str, flaw: &str) -> Error {
    Error::NotAccepted {
        place: place.to_owned(),
        found: format!("a facet {flaw}, nodes {:?}", facet.nodes),
        accepted: "a line (2D), or a convex triangle or quadrilateral (3D), with an area"
            .to_owned(),
    }
}
