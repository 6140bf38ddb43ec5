//! What the facets of both sides must be, so that everything after can rely on it.

use super::view::View;
use crate::body::{Facet, FacetGeometry, Mesh};
use crate::error::{Error, check_finite};

/// Least turn at a facet's corners, relative to the square of its size.
const FLAT: f64 = 1e-12;

/// Geometry of the facets of one side; refuses what is no surface of the mesh.
///
/// # Errors
///
/// No facet at all, a wrong number of nodes, a node that does not exist or whose
/// position is not finite, a facet without area or with a corner that turns backwards.
pub(super) fn geometries(
    mesh: &Mesh,
    facets: &[Facet],
    place: &str,
) -> Result<Vec<FacetGeometry>, Error> {
    if facets.is_empty() {
        return Err(Error::Empty {
            place: place.to_owned(),
        });
    }
    let numbered = facets.iter().enumerate();
    numbered
        .map(|(index, facet)| geometry(mesh, facet, &format!("{place}[{index}]")))
        .collect()
}

fn geometry(mesh: &Mesh, facet: &Facet, place: &str) -> Result<FacetGeometry, Error> {
    let fits = match mesh.dimension {
        2 => facet.nodes.len() == 2,
        _ => matches!(facet.nodes.len(), 3 | 4),
    };
    if !fits {
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
