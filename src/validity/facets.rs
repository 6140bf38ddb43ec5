//! What straight facets leave of pressures on the surfaces that they mesh.
//!
//! ```text
//! (V1)  s = L φ / 8      sagitta of a facet of length L whose neighbours turn by φ; < 0 in a hollow
//!       (2/3) |s₁ + s₂|  by which the gap of two sides is wrong in the mean; an obstacle has s₂ = 0
//! ```

use std::collections::{HashMap, HashSet};

use nalgebra::Vector3;

use crate::body::{Facet, Mesh};
use crate::contact::{ContactNode, Opposite};
use crate::report::{ReportParts, significant};

/// Turn between facets from which they are too coarse, in degrees,
const COARSE: f64 = 15.0;

/// and from which it is a corner of the body, not of the mesh.
const CORNER: f64 = 34.0;

/// and below which facets lie in one plane.
const STRAIGHT: f64 = 0.01;

/// Part of an overlap or approach from which a note says by how much gaps are wrong.
const OF_OVERLAP: f64 = 0.1;

/// What facets turn by, and what their sagittas leave of an overlap or approach.
pub(super) fn facets(
    parts: &ReportParts<'_>,
    pair: usize,
    pressed: &[&ContactNode],
) -> Option<String> {
    let of_pair = &parts.pairs[pair];
    let own = pressed.iter().flat_map(|c| &c.own).map(|(node, _)| *node);
    let opposite = pressed.iter().filter_map(|c| c.opposite.as_ref());
    let opposite = opposite.flat_map(|side| side.nodes.iter().map(|(node, _)| *node));
    let second = pressed.first()?.second;
    let mut bends = Vec::new();
    let meshes = |body: usize| parts.bodies.get(body).map(|body| &body.mesh);
    match &of_pair.opposite {
        Opposite::Obstacle(_) => bends.push(bend(meshes(of_pair.body)?, &of_pair.facets, own)),
        Opposite::Surface { body, facets } => {
            let (own, opposite): (Vec<usize>, Vec<usize>) = (own.collect(), opposite.collect());
            let (first, other) = if second {
                (opposite, own)
            } else {
                (own, opposite)
            };
            bends.push(bend(
                meshes(of_pair.body)?,
                &of_pair.facets,
                first.into_iter(),
            ));
            bends.push(bend(meshes(*body)?, facets, other.into_iter()));
        }
    }
    let turn = bends.iter().map(|bend| bend.turn).fold(0.0, f64::max);
    if turn > COARSE {
        return Some(format!(
            "facets turn by up to {turn:.0} degrees where they carry: pressures on so coarse a polygon are \
             wrong by tens of per cent; refine to below {COARSE:.0}"
        ));
    }
    let stated = of_pair.gap;
    let moved = pressed
        .iter()
        .map(|contact| (contact.initial_gap + stated).abs());
    let moved = moved.fold(0.0, f64::max);
    let coupling = parts.surface.couplings.get(pair)?;
    if coupling.rounded > 0 {
        return (coupling.largest_bulge > moved).then(|| rounded(coupling.largest_bulge, moved));
    }
    let off = 2.0 / 3.0 * bends.iter().map(|bend| bend.sagitta).sum::<f64>().abs();
    let cure = match of_pair.rounded {
        true => "",
        false => "leave out `rounded: false`, ",
    };
    (off > OF_OVERLAP * moved && moved > 0.0).then(|| {
        format!(
            "if straight facets stand for curved surfaces they are off them by {} in the mean, where these \
             overlap or approach each other by {}, and pressures are wrong by as large a part: {cure}refine, or \
             take quadratic cells; edges that are meant are right as they are",
            significant(off),
            significant(moved)
        )
    })
}

/// That facets are taken for curves which leave them by more than what the sides overlap or approach.
fn rounded(bulge: f64, moved: f64) -> String {
    format!(
        "gaps are measured from the curved surfaces that straight facets stand for, up to {} off them, where these \
         overlap or approach each other by {}: where edges are meant as they are drawn say `rounded: false`",
        significant(bulge),
        significant(moved)
    )
}

/// How the facets of a side bend.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Bend {
    /// Largest turn between neighbours that is no corner, in degrees.
    turn: f64,
    /// (V1) of the facet that stands off farthest, in metre.
    sagitta: f64,
}

/// Over the straight facets that hold a pressed node.
fn bend(mesh: &Mesh, facets: &[Facet], pressed: impl Iterator<Item = usize>) -> Bend {
    let carries: HashSet<usize> = pressed.collect();
    let carries = |nodes: &[usize]| nodes.iter().any(|node| carries.contains(node));
    let near = facets.iter().filter(|facet| carries(&facet.nodes));
    let straight: Vec<&Facet> = near.filter(|f| !f.is_quadratic(mesh.dimension)).collect();
    let mut found = Bend::default();
    for (edge, [one, other]) in neighbours(mesh, &straight) {
        let [a, b] = [one, other].map(|facet| Plane::of(mesh, straight[facet]));
        let turn = a.turn(&b);
        if !carries(&edge) || !(STRAIGHT..=CORNER).contains(&turn) {
            continue;
        }
        found.turn = found.turn.max(turn);
        let bulges = a.normal.dot(&(b.centre - a.centre)) < 0.0;
        let length = (b.centre - a.centre).norm();
        let sagitta = length * turn.to_radians() / 8.0;
        if sagitta > found.sagitta.abs() {
            found.sagitta = if bulges { sagitta } else { -sagitta };
        }
    }
    found
}

/// The edge of a facet (2D: its end), by its corners, and the two facets that meet there.
fn neighbours(mesh: &Mesh, facets: &[&Facet]) -> Vec<(Vec<usize>, [usize; 2])> {
    let mut first: HashMap<Vec<usize>, usize> = HashMap::new();
    let mut both = Vec::new();
    for (index, facet) in facets.iter().enumerate() {
        let corners = facet.corners(mesh.dimension);
        let next = |k: usize| corners[(k + 1) % corners.len()];
        for (k, &corner) in corners.iter().enumerate() {
            let mut edge = match mesh.dimension {
                2 => vec![corner],
                _ => vec![corner, next(k)],
            };
            edge.sort_unstable();
            match first.get(&edge) {
                Some(&before) => both.push((edge, [before, index])),
                None => drop(first.insert(edge, index)),
            }
        }
    }
    both
}

/// Where a facet is and how it looks.
struct Plane {
    centre: Vector3<f64>,
    normal: Vector3<f64>,
}

impl Plane {
    fn of(mesh: &Mesh, facet: &Facet) -> Self {
        let nodes = facet.nodes.iter();
        let sum: Vector3<f64> = nodes.map(|node| Vector3::from(mesh.nodes[*node])).sum();
        Self {
            centre: sum / facet.nodes.len() as f64,
            normal: mesh.facet_geometry(facet).normal.into(),
        }
    }

    /// To another one, in degrees.
    fn turn(&self, other: &Self) -> f64 {
        let across = self.normal.cross(&other.normal).norm();
        across.atan2(self.normal.dot(&other.normal)).to_degrees()
    }
}

/// A contact where the facets that face the other side turn round a corner of the body.
pub(super) fn corner(
    parts: &ReportParts<'_>,
    pair: usize,
    pressed: &[&ContactNode],
) -> Option<String> {
    let (of_pair, carrier) = (&parts.pairs[pair], pressed.first()?);
    let mesh = &parts.bodies.get(carrier.body)?.mesh;
    let facets = match &of_pair.opposite {
        Opposite::Surface { facets, .. } if carrier.second => facets,
        _ => &of_pair.facets,
    };
    let stated: HashSet<&Facet> = facets.iter().collect();
    let carries: HashSet<usize> = pressed.iter().map(|contact| contact.node).collect();
    let facing = parts.surface.facets.iter().filter(|(body, facet)| {
        let holds = facet.nodes.iter().any(|node| carries.contains(node));
        *body == carrier.body && holds && stated.contains(facet)
    });
    let facing: Vec<&Facet> = facing.map(|(_, facet)| facet).collect();
    let turns = neighbours(mesh, &facing)
        .into_iter()
        .filter_map(|(edge, [a, b])| {
            let node = edge.iter().find(|node| carries.contains(node))?;
            let [a, b] = [a, b].map(|facet| Plane::of(mesh, facing[facet]));
            Some((a.turn(&b), *node))
        });
    let (turn, node) = turns.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (turn > CORNER).then(|| {
        format!(
            "the surface turns by {turn:.0} degrees at node {node}, where it carries: one contact stands for both \
             faces, with a normal between theirs; give each face a contact of its own"
        )
    })
}
