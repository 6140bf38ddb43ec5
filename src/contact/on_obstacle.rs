//! The contacts of a pair with a rigid obstacle, one per corner of the facets that face it.
//!
//! Beside an axisymmetric body an obstacle goes around the axis: a plane is a cone, or a disc, and a
//! circle a ball. What stands on the axis sees only along it, to the apex of a cone.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::corner_weights::{Footing, footings, held_directions};
use super::facing::Bodies;
use super::frame::Stance;
use super::held::Directions;
use super::pair::{Coupling, PairSurface};
use super::repeated;
use super::{Closest, ContactNode, ContactPair, Obstacle};
use crate::body::{Axis, Body, Facet};
use crate::error::Error;

/// Distance from the obstacle, as part of a facet, that is none: shapes and meshes are drawn to so many digits.
const ON_IT: f64 = 1e-4;

/// Part of a facet from which a corner of the obstacle is looked at.
const BACK: f64 = 1e-2;

/// Cosine between normals from which they are those of one side of a corner.
const SAME: f64 = 0.99999;

/// The contacts of a pair with a rigid obstacle.
pub(super) fn on_obstacle(
    scene: &Bodies<'_>,
    pair: &ContactPair,
    obstacle: &Obstacle,
) -> Result<PairSurface, Error> {
    let (body, boundary) = (&scene.bodies[pair.body], &scene.boundaries[pair.body]);
    let view = View {
        body,
        pair,
        obstacle,
        axis: Axis::of(body),
    };
    view.check()?;
    let facing = boundary.facing(pair, obstacle)?;
    let (mut contacts, mut left_out) = (Vec::new(), Vec::new());
    let gap = |node, position| Ok(view.closest(node, position)?.distance);
    let facets: Vec<Facet> = facing.iter().map(|(facet, _)| facet.clone()).collect();
    let bulges = scene.bulges(pair.body, &facets, pair.rounded);
    let every: Vec<usize> = (0..facets.len())
        .filter(|&f| facets[f].is_quadratic(body.mesh.dimension))
        .collect();
    let (rounded, largest_bulge) = bulges.rounded(&every);
    let corners = match obstacle {
        Obstacle::Profile(_) | Obstacle::Triangulated(_) | Obstacle::Turned { .. } => {
            sides(body, &facets)
        }
        _ => HashMap::new(),
    };
    for footing in footings(body, &facing, &bulges, gap)? {
        let node = footing.node;
        let place = view.place(&footing, scene);
        let closest = view.closest(node, place)?;
        if closest.beyond {
            continue;
        }
        let closest = match corners.get(&node) {
            Some(side) => view.at_corner(node, place, closest, *side)?,
            None => closest,
        };
        match view.contact(footing, closest, scene)? {
            Some(contact) => contacts.push(contact),
            None => left_out.push(node),
        }
    }
    let mut contacts = repeated::join(contacts, scene.bodies);
    boundary.mark_rims(&mut contacts, &pair.facets, None);
    Ok(PairSurface {
        coupling: Coupling {
            body: pair.body,
            second: false,
            rounded,
            largest_bulge,
        },
        contacts,
        facets,
        left_out,
    })
}

/// Sum of the outward normals of the facets at every node, and the size of the largest, in metre.
fn sides(body: &Body, facets: &[Facet]) -> HashMap<usize, (Vector3<f64>, f64)> {
    let mut sides: HashMap<usize, (Vector3<f64>, f64)> = HashMap::new();
    for facet in facets {
        let normal = Vector3::from(body.mesh.facet_geometry(facet).normal);
        let at = |node: usize| Vector3::from(body.mesh.nodes[node]);
        let from = facet
            .nodes
            .iter()
            .map(|node| at(*node) - at(facet.nodes[0]));
        let size = from.map(|way| way.norm()).fold(0.0, f64::max);
        for node in &facet.nodes {
            let (sum, most) = sides.entry(*node).or_default();
            *sum += normal;
            *most = most.max(size);
        }
    }
    sides
}

/// An obstacle, as a body sees it.
struct View<'a> {
    body: &'a Body,
    pair: &'a ContactPair,
    obstacle: &'a Obstacle,
    axis: Option<Axis>,
}

impl View<'_> {
    /// Refuses what does not go around the axis.
    fn check(&self) -> Result<(), Error> {
        match self.axis {
            Some(_) => self.obstacle.check_around(&self.pair.place),
            None => Ok(()),
        }
    }

    /// Where a contact's reaction acts, in metre: there its normal is the obstacle's, so that a smooth circle takes no moment.
    /// In a plane of symmetry it acts with that of its image.
    fn place(&self, footing: &Footing, scene: &Bodies<'_>) -> [f64; 3] {
        let at = |node: usize| Vector3::from(self.body.mesh.nodes[node]);
        let corner = at(footing.node);
        if let [_] = footing.own.as_slice() {
            return corner.into();
        }
        let parts = footing
            .own
            .iter()
            .map(|&(node, weight)| (at(node) - corner) * weight);
        let way: Vector3<f64> = parts.sum();
        (corner + scene.held(self.pair.body, footing.node).across(way)).into()
    }

    /// The obstacle from a position, for the contact at `node`.
    fn closest(&self, node: usize, position: [f64; 3]) -> Result<Closest, Error> {
        let closest = self.obstacle.closest(&self.pair.place, position)?;
        let node = self.body.mesh.nodes[node];
        let along = closest.direction[1];
        if along == 0.0 || !self.axis.is_some_and(|axis| axis.holds(node)) {
            return Ok(closest);
        }
        Ok(Closest {
            distance: closest.distance / along.abs(),
            direction: [0.0, along.signum(), 0.0],
            ..closest
        })
    }

    /// The obstacle from a place on it: where that is a corner, which has every normal between its sides, the facets of
    /// the body say which.
    fn at_corner(
        &self,
        node: usize,
        place: [f64; 3],
        closest: Closest,
        (outward, size): (Vector3<f64>, f64),
    ) -> Result<Closest, Error> {
        if closest.distance.abs() > ON_IT * size {
            return Ok(closest);
        }
        let Some(outward) = outward.try_normalize(0.0) else {
            return Ok(closest);
        };
        let back = Vector3::from(place) - outward * (BACK * size);
        let direction = self.closest(node, back.into())?.direction;
        let turned = Vector3::from(direction).dot(&Vector3::from(closest.direction)) < SAME;
        Ok(Closest {
            direction: if turned { direction } else { closest.direction },
            ..closest
        })
    }

    /// The contact of a footing; none if a support holds its normal.
    fn contact(
        &self,
        footing: Footing,
        closest: Closest,
        scene: &Bodies<'_>,
    ) -> Result<Option<ContactNode>, Error> {
        let (pair, node) = (self.pair, footing.node);
        let dimension = self.body.mesh.dimension;
        let position = self.body.mesh.nodes[node];
        let held = |node| scene.held(pair.body, node);
        let mut supported = held_directions(node, &footing.own, closest.direction.into(), held);
        let found = Stance::new(dimension, closest.direction, &supported);
        let stance = match (found, !pair.law.is_smooth(pair.friction)) {
            (Stance::Free { frame, .. }, true) => {
                self.slip_by_supports(&footing, frame[0], scene, &mut supported)?;
                Stance::new(dimension, closest.direction, &supported)
            }
            (found, _) => found,
        };
        let (frame, kept) = match stance {
            Stance::Held => return Ok(None),
            Stance::Free { frame, kept } => (frame, kept),
            Stance::Askew => {
                return Err(Error::SupportAskew {
                    place: pair.place.clone(),
                    node,
                    position,
                    normal: closest.direction,
                    axes: axes(&supported),
                });
            }
        };
        let initial_gap = match footing.own.as_slice() {
            [_] => closest.distance,
            _ => footing.gap,
        };
        Ok(Some(ContactNode {
            body: pair.body,
            node,
            own: footing.own,
            opposite: None,
            pair: 0,
            position,
            frame,
            tangents: if pair.law.is_smooth(pair.friction) {
                0
            } else {
                kept
            },
            initial_gap,
            area: footing.area * self.body.model.depth(),
            bulge: footing.bulge,
            second: false,
            rim: false,
        }))
    }

    /// Keeps of the supported directions of a contact with friction those along which nothing moves it, nor the obstacle:
    /// along the others it slips, if that is meant.
    fn slip_by_supports(
        &self,
        footing: &Footing,
        normal: [f64; 3],
        scene: &Bodies<'_>,
        supported: &mut Directions,
    ) -> Result<(), Error> {
        let (pair, dimension) = (self.pair, self.body.mesh.dimension);
        let moved = |direction: &Vector3<f64>| {
            let own = footing.own.iter();
            let mut moved = own.map(|(node, _)| scene.given_along(pair.body, *node, direction));
            moved.find(|u| *u != 0.0)
        };
        let across = (0..dimension).filter(|axis| normal[*axis] == 0.0);
        let across = across.map(|axis| Vector3::ith(axis, 1.0));
        let mut directions = supported.0.iter().copied().chain(across);
        let refused = directions.find_map(|direction| Some((moved(&direction)?, direction)));
        if let (Some((displacement, direction)), false) = (refused, pair.dragged) {
            return Err(Error::DraggedContact {
                place: pair.place.clone(),
                node: footing.node,
                position: self.body.mesh.nodes[footing.node],
                friction: pair.friction,
                displacement,
                axis: AXES[direction.iamax()],
            });
        }
        let position = self.body.mesh.nodes[footing.node];
        let moves = |direction: &Vector3<f64>| {
            moved(direction).is_some() || pair.moves_along(position, direction)
        };
        // Under an ellipse friction also acts across the motion.
        let all = pair.law.ellipse.is_some()
            && (refused.is_some() || pair.slides_along(position, normal.into()));
        supported.0.retain(|direction| !(all || moves(direction)));
        Ok(())
    }
}

const AXES: [char; 3] = ['x', 'y', 'z'];

/// The supported directions in words.
fn axes(held: &Directions) -> String {
    let name = |direction: &Vector3<f64>| match direction.iter().position(|d| *d == 1.0) {
        Some(axis) => AXES[axis].to_string(),
        None => format!("{:?}", <[f64; 3]>::from(*direction)),
    };
    let named: Vec<String> = held.0.iter().map(name).collect();
    named.join(" and ")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::tests::samples::{block, facets};
    use crate::body::{CellKind, Facet, Model, Support, prescribed};
    use crate::contact::{ContactSurface, Opposite};

    /// A plane below the block, 0.25 m away, and the pair of the named sides with it.
    fn pair(body: &Body, sides: &[&str]) -> ContactPair {
        let normal = match body.mesh.dimension {
            2 => [0.0, 1.0, 0.0],
            _ => [0.0, 0.0, 1.0],
        };
        let point = normal.map(|component| -0.25 * component);
        let facets = sides.iter().flat_map(|side| facets(&body.mesh, side));
        ContactPair::new(
            "contacts[0]",
            0,
            facets.collect(),
            Opposite::Obstacle(Obstacle::Plane { point, normal }),
            0.3,
        )
    }

    fn find(body: &Body, pairs: &[ContactPair]) -> Result<ContactSurface, Error> {
        ContactSurface::new(std::slice::from_ref(body), pairs, &[prescribed(body)?])
    }

    fn hold(body: &mut Body, nodes: &[usize], displacement: [Option<f64>; 3]) {
        body.supports
            .push(Support::new("supports[0]", nodes.to_vec(), displacement));
    }

    /// The node of the block's bottom with the largest x (and the smallest y).
    fn bottom_right(body: &Body) -> usize {
        let at = |node: &[f64; 3]| *node == [2.0, 0.0, 0.0];
        body.mesh.nodes.iter().position(at).unwrap()
    }

    #[test]
    fn the_bottom_of_a_block_carries_its_whole_area() {
        for kind in [
            CellKind::Tri3,
            CellKind::Quad4,
            CellKind::Tet4,
            CellKind::Hex8,
        ] {
            let body = block(kind);
            let surface = find(&body, &[pair(&body, &["bottom"])]).unwrap();
            let area: f64 = surface.nodes.iter().map(|contact| contact.area).sum();
            // 2 m × 1 m, or 2 m × 1 m of depth.
            assert!((area - 2.0).abs() < 1e-14, "{kind:?} {area}");
            for contact in &surface.nodes {
                assert_eq!((contact.initial_gap, contact.rim), (0.25, false));
                assert_eq!(contact.tangents, kind.dimension() - 1);
            }
        }
    }

    #[test]
    fn the_area_of_a_plate_counts_its_thickness() {
        let mut body = block(CellKind::Quad4);
        body.model = Model::PlaneStress { thickness: 0.01 };
        let surface = find(&body, &[pair(&body, &["bottom"])]).unwrap();
        let area: f64 = surface.nodes.iter().map(|contact| contact.area).sum();
        assert!((area - 0.02).abs() < 1e-16);
    }

    #[test]
    fn sides_and_back_add_nothing_to_the_assumed_surface() {
        let body = block(CellKind::Quad4);
        let alone = find(&body, &[pair(&body, &["bottom"])]).unwrap();
        let grown = pair(&body, &["bottom", "left", "right", "top", "bottom"]);
        assert_eq!(find(&body, &[grown]).unwrap(), alone);
    }

    #[test]
    fn a_surface_that_only_looks_away_is_refused() {
        let body = block(CellKind::Quad4);
        let found = find(&body, &[pair(&body, &["top", "left"])]).unwrap_err();
        let place = "contacts[0]".to_owned();
        assert_eq!(found, Error::NothingFacesObstacle { place, facets: 6 });
        let none = find(&body, &[pair(&body, &[])]).unwrap_err();
        assert!(matches!(
            none,
            Error::NothingFacesObstacle { facets: 0, .. }
        ));
        let nothing = find(&body, &[]).unwrap_err();
        assert!(matches!(nothing, Error::EmptyContactSurface { .. }));
    }

    #[test]
    fn the_rim_is_where_the_surface_goes_on_smoothly() {
        let body = block(CellKind::Quad4);
        let mut part = pair(&body, &["bottom"]);
        part.facets.truncate(2);
        let surface = find(&body, &[part]).unwrap();
        // Two of four facets from the left corner: the corner is no rim, the cut end is.
        let rims: Vec<_> = surface
            .nodes
            .iter()
            .map(|c| (c.position[0], c.rim))
            .collect();
        assert_eq!(rims.iter().filter(|(_, rim)| *rim).count(), 1);
        let far = rims.iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
        assert!(far.1, "{rims:?}");
    }

    #[test]
    fn a_node_whose_normal_is_held_is_left_out_and_said_so() {
        let mut body = block(CellKind::Quad4);
        let corner = bottom_right(&body);
        hold(&mut body, &[corner], [Some(0.0), Some(0.0), None]);
        let surface = find(&body, &[pair(&body, &["bottom"])]).unwrap();
        assert_eq!(
            (surface.left_out, surface.nodes.len()),
            (vec![(0, corner)], 4)
        );
        let all: Vec<usize> = (0..body.mesh.nodes.len()).collect();
        hold(&mut body, &all, [None, Some(0.0), None]);
        let found = find(&body, &[pair(&body, &["bottom"])]).unwrap_err();
        assert_eq!(
            found,
            Error::EmptyContactSurface {
                pairs: 1,
                left_out: 5
            }
        );
    }

    #[test]
    fn a_symmetry_plane_takes_a_tangent_but_not_the_contact() {
        let mut body = block(CellKind::Quad4);
        let corner = bottom_right(&body);
        hold(&mut body, &[corner], [Some(0.0), None, None]);
        let surface = find(&body, &[pair(&body, &["bottom"])]).unwrap();
        let contact = surface.nodes.iter().find(|c| c.node == corner).unwrap();
        assert_eq!((contact.tangents, surface.nodes.len()), (0, 5));
    }

    #[test]
    fn a_support_may_drag_a_contact_only_without_friction() {
        let mut body = block(CellKind::Quad4);
        let corner = bottom_right(&body);
        hold(&mut body, &[corner], [Some(0.001), None, None]);
        let mut pair = pair(&body, &["bottom"]);
        let found = find(&body, std::slice::from_ref(&pair)).unwrap_err();
        assert!(
            matches!(found, Error::DraggedContact { axis: 'x', .. }),
            "{found}"
        );
        pair.friction = 0.0;
        let surface = find(&body, &[pair]).unwrap();
        assert!(surface.nodes.iter().all(|contact| contact.tangents == 0));
    }

    #[test]
    fn a_support_at_an_angle_to_the_normal_is_refused() {
        let mut body = block(CellKind::Quad4);
        let corner = bottom_right(&body);
        hold(&mut body, &[corner], [Some(0.0), None, None]);
        let mut pair = pair(&body, &["bottom"]);
        pair.opposite = Opposite::Obstacle(Obstacle::Plane {
            point: [0.0, -1.0, 0.0],
            normal: [0.6, 0.8, 0.0],
        });
        let found = find(&body, &[pair]).unwrap_err();
        assert!(found.to_string().contains("supported along x"), "{found}");
    }

    #[test]
    fn flawed_pairs_are_refused_with_their_place() {
        let body = block(CellKind::Quad4);
        let mut rough = pair(&body, &["bottom"]);
        rough.friction = -0.1;
        assert!(
            find(&body, &[rough.clone()])
                .unwrap_err()
                .to_string()
                .starts_with("contacts[0].friction")
        );
        rough.friction = f64::NAN;
        assert!(
            find(&body, &[rough])
                .unwrap_err()
                .to_string()
                .starts_with("contacts[0].friction")
        );
        let mut inside = pair(&body, &["bottom"]);
        inside.facets.push(Facet {
            nodes: vec![0, 999_999],
        });
        assert!(
            find(&body, &[inside])
                .unwrap_err()
                .to_string()
                .starts_with("contacts[0].facets[4]")
        );
    }

    #[test]
    fn the_gap_to_a_cylinder_follows_its_curve() {
        // Cylinder of radius 2 below the origin: the gap at (x, 0) is √(x² + 4) − 2.
        let body = block(CellKind::Quad4);
        let mut round = pair(&body, &["bottom"]);
        round.opposite = Opposite::Obstacle(Obstacle::Cylinder {
            center: [0.0, -2.0, 0.0],
            axis: [0.0, 0.0, 1.0],
            radius: 2.0,
        });
        for contact in find(&body, &[round]).unwrap().nodes {
            let x = contact.position[0];
            assert!((contact.initial_gap - (x.hypot(2.0) - 2.0)).abs() < 1e-15);
            assert!((contact.frame[0][0] + x / x.hypot(2.0)).abs() < 1e-15);
        }
    }
}
