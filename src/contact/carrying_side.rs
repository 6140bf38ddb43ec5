//! Which of two sides carries the contacts.
//!
//! The one with fewer facets on which the other side ends: where it ends within a facet, contacts have to
//! move or to be joined, and a pressure is steepest where a body ends, on its own facets. Of two sides with
//! as many it is the one with the larger facets there, as small ones on a large one that ends see it as a
//! punch. Where neither ends on the other and one is much finer, it is that one: between contacts of the coarser
//! one a body that bends would go through it. Which of the two a scene names first decides only where both are
//! equal in this.
//!
//! But a side that is much stiffer does not carry: its
//! own compliance would drown in that of the other side, `G = G₁ + P G₂ Pᵀ`, and with it
//! all but the patterns of pressure that the other side's mesh can tell apart. Compliance of
//! the softer side is there for every contact, whatever the meshes.

use std::cmp::Ordering;

use super::mortar::{Coverage, Ends, Surface};
use crate::body::{Body, Facet};
use crate::error::Error;

/// Ratio of Young's moduli beyond which the softer side carries the contacts: the stiffer one
/// costs two digits of sixteen there, and from ten times that on, if it is the finer one, also
/// sweeps by the dozen.
const MUCH_STIFFER: f64 = 1e2;

/// Ratio of facets' lengths, about, beyond which the finer side carries.
const MUCH_FINER: f64 = 2.0;

/// Part by which areas of facets differ that are equal.
const ROUND_OFF: f64 = 1e-6;

/// What the carrying side sees of the other one, and whether it is the second; `young` are the least
/// moduli at the surfaces, in pascal.
///
/// # Errors
///
/// What [`Coverage::new`] refuses.
pub(super) fn carrying<'a>(
    [first, second]: [&'a Surface<'a>; 2],
    young: [f64; 2],
    place: &str,
) -> Result<(Coverage<'a>, bool), Error> {
    if young[0] > MUCH_STIFFER * young[1] {
        return Ok((Coverage::new(second, first, place)?, true));
    }
    let of_first = Coverage::new(first, second, place)?;
    let ends = of_first.ends();
    let finer = ends.facets == 0 && of_first.finer_across() > MUCH_FINER;
    if ends.facets == 0 && !finer || young[1] > MUCH_STIFFER * young[0] {
        return Ok((of_first, false));
    }
    let of_second = Coverage::new(second, first, place)?;
    Ok(
        match of_second.meets() && is_better(of_second.ends(), ends, finer) {
            true => (of_second, true),
            false => (of_first, false),
        },
    )
}

/// Whether a side on which the other one has these ends should carry rather than one with those; `finer`:
/// whether it is much finer.
fn is_better(these: Ends, those: Ends, finer: bool) -> bool {
    let larger = these.area > those.area * (1.0 + ROUND_OFF);
    match these.facets.cmp(&those.facets) {
        Ordering::Less => true,
        Ordering::Equal if these.facets == 0 => finer,
        Ordering::Equal => larger,
        Ordering::Greater => false,
    }
}

/// Least Young's modulus at a surface, in pascal.
pub(super) fn softest(body: &Body, facets: &[Facet]) -> f64 {
    let mut on_surface = vec![false; body.mesh.nodes.len()];
    for &node in facets.iter().flat_map(|facet| &facet.nodes) {
        on_surface[node] = true;
    }
    let cells = body.mesh.cells().zip(&body.material_of_cell);
    let at_surface = cells.filter(|(cell, _)| cell.nodes.iter().any(|node| on_surface[*node]));
    at_surface
        .map(|(_, material)| body.materials[*material].softest())
        .fold(f64::INFINITY, f64::min)
}
