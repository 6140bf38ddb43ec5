//! What the facets of both sides must be, so that everything after can rely on it.

use super::pieces::Piece;
use super::view::View;
use crate::body::{Facet, FacetGeometry, Mesh};
use crate::error::{Error, check_finite};

/// Least turn at a facet's corners, relative to the square of its size.
const FLAT: f64 = 1e-12;

/// The facets of one side in linear pieces.
pub(super) struct Surface<'a> {
    pub(super) pieces: Vec<Piece<'a>>,
    /// Corners of the pieces.
    pub(super) facets: Vec<Facet>,
    /// Geometries of the pieces.
    pub(super) geometries: Vec<FacetGeometry>,
}

impl<'a> Surface<'a> {
    /// Cuts the facets of a side; refuses what is no surface of the mesh.
    ///
    /// # Errors
    ///
    /// No facet at all, a wrong number of nodes, a node that does not exist or whose
    /// position is not finite, a facet without area or with a corner that turns backwards.
    pub(super) fn new(mesh: &Mesh, facets: &'a [Facet], place: &str) -> Result<Self, Error> {
        if facets.is_empty() {
            return Err(Error::Empty {
                place: place.to_owned(),
            });
        }
        let mut surface = Self {
            pieces: Vec::with_capacity(facets.len()),
            facets: Vec::with_capacity(facets.len()),
            geometries: Vec::with_capacity(facets.len()),
        };
        for (index, facet) in facets.iter().enumerate() {
            let place = format!("{place}[{index}]");
            check_nodes(mesh, facet, &place)?;
            for piece in Piece::of(mesh, facet) {
                surface
                    .geometries
                    .push(geometry(mesh, &piece.corners, &place)?);
                surface.facets.push(piece.corners.clone());
                surface.pieces.push(piece);
            }
        }
        Ok(surface)
    }
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
