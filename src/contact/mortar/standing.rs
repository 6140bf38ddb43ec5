//! Contacts beyond the end of the cover move to it, in 3D.
//!
//! A corner that is covered is where its contact stands. One beyond the cover has it at the nearest point of
//! the cover on its facets. If the cover goes only a short way towards that corner, it would be a
//! contact close to its neighbours, with a small area and a pressure that the mesh cannot tell from
//! theirs: it is none, and the covered corners beside it move out to the end of the cover in its place. So
//! there is always somebody who stands there, and a unit force can act anywhere on the cover, and
//! nowhere else. On the lines of a plane body the same is what `trim` and `join` do.

use std::collections::{HashMap, HashSet};

use nalgebra::Vector3;

use super::check::Surface;
use super::polygon::on_segment;
use super::ties::EQUAL;
use super::tile::Tile;

/// Part of the way to a corner up to which the cover is too short for a contact: beyond it, the contact has half
/// of the area that a whole facet gives it, which goes by the square.
const SHORT: f64 = 0.7;

/// Where the contact of a corner stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) at: Vector3<f64>,
    /// The facet that has moved it away from the corner.
    pub(super) moved: Option<usize>,
    /// It is no contact.
    pub(super) gone: bool,
    /// How far the corner is from the cover, in metre, and how far the cover goes towards it.
    distance: f64,
    depth: f64,
}

impl Place {
    fn is_covered(&self) -> bool {
        self.distance == 0.0
    }
}

/// The contacts of the corners of covered facets.
pub(super) fn places(surface: &Surface<'_>, tiles: &[Tile]) -> HashMap<usize, Place> {
    let mut places = HashMap::new();
    for tile in tiles {
        for (corner, &node) in surface.corners_of(tile.facet).iter().enumerate() {
            let found = place(tile, corner, surface.mesh.nodes[node].into());
            let known = places.entry(node).or_insert(found);
            if found.distance < known.distance - EQUAL * tile.view.size {
                *known = found;
            }
        }
    }
    let leaving = leaving(surface, tiles, &places);
    for (node, place) in &mut places {
        place.gone = leaving.contains(node);
    }
    move_out(surface, tiles, &mut places);
    places
}

/// What one facet says of its corner.
fn place(tile: &Tile, corner: usize, position: Vector3<f64>) -> Place {
    let covered = Place {
        at: position,
        moved: None,
        gone: false,
        distance: 0.0,
        depth: 1.0,
    };
    if tile.is_whole() {
        return covered;
    }
    let nearest = tile.nearest(corner);
    if nearest.distance <= tile.slack {
        return covered;
    }
    Place {
        at: tile.view.position([nearest.at.x, nearest.at.y, 0.0]),
        moved: Some(tile.facet),
        gone: false,
        distance: nearest.distance * tile.view.size,
        depth: nearest.depth,
    }
}

/// Corners that the cover goes a short way towards, beside covered ones that facets beyond them carry.
fn leaving(
    surface: &Surface<'_>,
    tiles: &[Tile],
    places: &HashMap<usize, Place>,
) -> HashSet<usize> {
    let corners = |tile: &Tile| surface.corners_of(tile.facet);
    let covered = |node: &usize| places[node].is_covered();
    let cut = tiles.iter().filter(|tile| !tile.is_whole());
    let beside = cut.filter(|tile| corners(tile).iter().any(covered));
    let short = |node: &&usize| !covered(node) && places[node].depth < SHORT;
    let mut leaving: HashSet<usize> = beside
        .flat_map(|tile| corners(tile).iter().filter(short).copied())
        .collect();
    let (losing, staying): (Vec<&Tile>, Vec<&Tile>) = tiles
        .iter()
        .partition(|tile| corners(tile).iter().any(|node| leaving.contains(node)));
    let carried: HashSet<usize> = staying.into_iter().flat_map(corners).copied().collect();
    // A cover narrower than a facet needs the contacts at both of its ends.
    for tile in losing {
        let alone = |node: &usize| covered(node) && !carried.contains(node);
        if corners(tile).iter().any(alone) {
            for node in corners(tile) {
                leaving.remove(node);
            }
        }
    }
    leaving
}

/// Moves covered corners to the end of the cover where others beside them are gone.
fn move_out(surface: &Surface<'_>, tiles: &[Tile], places: &mut HashMap<usize, Place>) {
    let mut nearest: HashMap<usize, f64> = HashMap::new();
    for tile in tiles {
        let corners = surface.corners_of(tile.facet);
        let gone: Vec<_> = corners
            .iter()
            .map(|node| places[node])
            .filter(|place| place.gone)
            .map(|place| place.at)
            .collect();
        for node in corners {
            let Some(place) = places.get_mut(node).filter(|place| place.is_covered()) else {
                continue;
            };
            let from = Vector3::from(surface.mesh.nodes[*node]);
            let Some(at) = on_line(&gone, from) else {
                continue;
            };
            let distance = (at - from).norm();
            if nearest.get(node).is_none_or(|known| distance < *known) {
                nearest.insert(*node, distance);
                place.at = at;
                place.moved = Some(tile.facet);
            }
        }
    }
}

/// The point nearest to another one on the line through some, if there are any.
fn on_line(points: &[Vector3<f64>], from: Vector3<f64>) -> Option<Vector3<f64>> {
    let distance = |at: &Vector3<f64>| (at - from).norm_squared();
    let segments = points
        .windows(2)
        .map(|ends| on_segment([ends[0], ends[1]], from));
    let nearest = segments.min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.or(points.first().copied())
}
