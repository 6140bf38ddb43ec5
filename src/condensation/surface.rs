//! The contact surface: nodes, local frames, initial gaps and areas.
//!
//! ```text
//! area of node i    Σ ∫ N_i dA        over the facing facets of its pair
//! initial gap       signed distance from the node to the obstacle
//! ```

use std::collections::HashMap;

use super::Obstacle;
use super::facing::Boundary;
use super::frame::Stance;
use super::paired::{Bodies, between_surfaces};
use crate::body::{Body, Facet, FacetGeometry};
use crate::error::{Error, check_finite, check_length};

/// A part of a body's surface that may touch a rigid obstacle or another surface.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPair {
    /// Where the scene says so, for messages, such as `contacts[0]`.
    pub place: String,
    /// Index of the body that the pair names first. Its nodes carry the contacts, unless it
    /// is more than a thousand times as stiff at the surface as the body opposite: then
    /// those of that one do. On flat faces either choice is exact for a uniform pressure;
    /// on curved ones the coarser side averages over the other's facets, while the finer
    /// one follows them in its pressures.
    pub body: usize,
    /// The assumed contact surface; it need only contain the true contact.
    pub facets: Vec<Facet>,
    /// What it may touch.
    pub opposite: Opposite,
    /// Coefficient of friction, `μ ≥ 0`.
    pub friction: f64,
}

/// The other side of a contact pair.
#[derive(Clone, Debug, PartialEq)]
pub enum Opposite {
    /// A rigid obstacle.
    Obstacle(Obstacle),
    /// The surface of a body: another one, or the other face of a crack in the same.
    Surface {
        /// Index of that body.
        body: usize,
        /// Its facets.
        facets: Vec<Facet>,
    },
}

/// The nodes of the other side that a contact is coupled to.
#[derive(Clone, Debug, PartialEq)]
pub struct OppositeNodes {
    /// Index of the body.
    pub body: usize,
    /// Nodes and their mortar weights, which add up to one.
    pub nodes: Vec<(usize, f64)>,
}

/// One node of the contact surface, facing the other side.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactNode {
    /// Index of the body.
    pub body: usize,
    /// Node of its mesh.
    pub node: usize,
    /// The other side; none if that is a rigid obstacle.
    pub opposite: Option<OppositeNodes>,
    /// Index of the contact pair.
    pub pair: usize,
    /// Position before loading, in metre.
    pub position: [f64; 3],
    /// Orthonormal rows: normal (towards the other side), then the tangents.
    pub frame: [[f64; 3]; 3],
    /// Number of tangents that the contact problem holds: 0 without friction, at most
    /// 1 in 2D and 2 in 3D, fewer where a support holds one.
    pub tangents: usize,
    /// Distance along the normal to the other side before loading, in metre.
    pub initial_gap: f64,
    /// Tributary area, in m² (2D: m² for the body's depth).
    pub area: f64,
    /// The body's surface goes on beyond the assumed contact surface here.
    pub rim: bool,
}

/// The contact nodes in the order of the contact problem, and what was left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactSurface {
    /// Contact nodes, one per contact.
    pub nodes: Vec<ContactNode>,
    /// Facets that face the other side, with the index of their body (its node numbers,
    /// outward order), for areas and plots; their nodes are contact nodes or left out.
    pub facets: Vec<(usize, Facet)>,
    /// Bodies and nodes of the surface that are no contacts because a support holds
    /// their normal.
    pub left_out: Vec<(usize, usize)>,
}

impl ContactSurface {
    /// Finds the contact nodes of all pairs.
    ///
    /// `prescribed` holds the prescribed displacement per body and degree of freedom
    /// (`node · dimension + axis`), in metre.
    ///
    /// # Errors
    ///
    /// A body that does not exist, an obstacle without a surface, a friction coefficient
    /// that is negative or not finite, a facet that is not on the boundary or on both sides
    /// of a pair, a pair of which nothing faces the other side, bodies that overlap deeper
    /// than a fit, a support at an angle to an obstacle's normal, a support that drags a
    /// contact with friction along an obstacle, or no contact node at all.
    pub fn new(
        bodies: &[Body],
        pairs: &[ContactPair],
        prescribed: &[Vec<Option<f64>>],
    ) -> Result<Self, Error> {
        check_length("prescribed", bodies.len(), prescribed.len())?;
        for (body, prescribed) in bodies.iter().zip(prescribed) {
            let unknowns = body.mesh.nodes.len() * body.mesh.dimension;
            let place = format!("{}: prescribed", body.name);
            check_length(&place, unknowns, prescribed.len())?;
        }
        let mut surface = Self::default();
        let boundaries = bodies.iter().map(|body| Boundary::new(&body.mesh));
        let boundaries: Vec<Boundary> = boundaries.collect();
        let scene = Bodies {
            bodies,
            boundaries: &boundaries,
            prescribed,
        };
        for (index, pair) in pairs.iter().enumerate() {
            check_pair_body(&pair.place, pair.body, bodies.len())?;
            pair.check(bodies[pair.body].mesh.dimension)?;
            let mut found = match &pair.opposite {
                Opposite::Obstacle(obstacle) => on_obstacle(&scene, pair, obstacle)?,
                Opposite::Surface { body, facets } => {
                    between_surfaces(&scene, pair, *body, facets)?
                }
            };
            for contact in &mut found.contacts {
                contact.pair = index;
            }
            let of_body = |facet| (found.body, facet);
            surface.nodes.append(&mut found.contacts);
            surface.facets.extend(found.facets.into_iter().map(of_body));
            let left_out = found.left_out.into_iter();
            surface
                .left_out
                .extend(left_out.map(|node| (found.body, node)));
        }
        if surface.nodes.is_empty() {
            return Err(Error::EmptyContactSurface {
                pairs: pairs.len(),
                left_out: surface.left_out.len(),
            });
        }
        surface.left_out.sort_unstable();
        surface.left_out.dedup();
        Ok(surface)
    }
}

/// What one pair adds to the contact surface.
pub(super) struct PairSurface {
    /// The body whose nodes carry the contacts.
    pub(super) body: usize,
    pub(super) contacts: Vec<ContactNode>,
    pub(super) facets: Vec<Facet>,
    pub(super) left_out: Vec<usize>,
}

/// The contacts of a pair with a rigid obstacle.
fn on_obstacle(
    scene: &Bodies<'_>,
    pair: &ContactPair,
    obstacle: &Obstacle,
) -> Result<PairSurface, Error> {
    let (body, boundary) = (&scene.bodies[pair.body], &scene.boundaries[pair.body]);
    let prescribed = &scene.prescribed[pair.body];
    let facing = boundary.facing(pair, obstacle)?;
    let (mut contacts, mut left_out) = (Vec::new(), Vec::new());
    for (node, area) in areas(body, &facing) {
        match contact(body, pair, obstacle, node, area, prescribed)? {
            Some(contact) => contacts.push(contact),
            None => left_out.push(node),
        }
    }
    boundary.mark_rims(&mut contacts, &pair.facets);
    Ok(PairSurface {
        body: pair.body,
        contacts,
        facets: facing.into_iter().map(|(facet, _)| facet).collect(),
        left_out,
    })
}

/// Refuses the number of a body that does not exist.
pub(super) fn check_pair_body(place: &str, body: usize, count: usize) -> Result<(), Error> {
    if body < count {
        return Ok(());
    }
    Err(Error::UnknownIndex {
        place: place.to_owned(),
        what: "body",
        index: body,
        count,
    })
}

impl ContactPair {
    fn check(&self, dimension: usize) -> Result<(), Error> {
        if let Opposite::Obstacle(obstacle) = &self.opposite {
            obstacle.check(&self.place, dimension)?;
        }
        let place = format!("{}.friction", self.place);
        if self.friction.is_finite() && self.friction < 0.0 {
            return Err(Error::OutOfRange {
                place,
                value: self.friction,
                accepted: "friction >= 0",
            });
        }
        check_finite(&place, &[self.friction])
    }
}

/// Nodes of the facing facets in the order they are met, with their area in m².
fn areas(body: &Body, facing: &[(Facet, FacetGeometry)]) -> Vec<(usize, f64)> {
    let depth = body.model.depth();
    let mut areas: Vec<(usize, f64)> = Vec::new();
    let mut place_of_node = HashMap::new();
    for (facet, geometry) in facing {
        for (&node, weight) in facet.nodes.iter().zip(geometry.weights) {
            let place = *place_of_node.entry(node).or_insert(areas.len());
            if place == areas.len() {
                areas.push((node, 0.0));
            }
            areas[place].1 += weight * depth;
        }
    }
    areas
}

/// The contact of a node; none if a support holds its normal.
fn contact(
    body: &Body,
    pair: &ContactPair,
    obstacle: &Obstacle,
    node: usize,
    area: f64,
    prescribed: &[Option<f64>],
) -> Result<Option<ContactNode>, Error> {
    let dimension = body.mesh.dimension;
    let position = body.mesh.nodes[node];
    let closest = obstacle.closest(&pair.place, position)?;
    let mut held = [None; 3];
    held[..dimension].copy_from_slice(&prescribed[node * dimension..(node + 1) * dimension]);
    let stance = Stance::new(dimension, closest.direction, held.map(|u| u.is_some()));
    let (frame, kept) = match stance {
        Stance::Held => return Ok(None),
        Stance::Free { frame, kept } => (frame, kept),
        Stance::Askew => {
            return Err(Error::SupportAskew {
                place: pair.place.clone(),
                node,
                position,
                normal: closest.direction,
                axes: axes(&held),
            });
        }
    };
    let moved = held.iter().position(|u| u.is_some_and(|u| u != 0.0));
    if let (Some(axis), true) = (moved, pair.friction > 0.0) {
        return Err(Error::DraggedContact {
            place: pair.place.clone(),
            node,
            position,
            friction: pair.friction,
            displacement: held[axis].unwrap_or_default(),
            axis: AXES[axis],
        });
    }
    Ok(Some(ContactNode {
        body: pair.body,
        node,
        opposite: None,
        pair: 0,
        position,
        frame,
        tangents: if pair.friction == 0.0 { 0 } else { kept },
        initial_gap: closest.distance,
        area,
        rim: false,
    }))
}

const AXES: [char; 3] = ['x', 'y', 'z'];

/// The supported axes in words.
fn axes(held: &[Option<f64>; 3]) -> String {
    let named = AXES.iter().zip(held).filter(|(_, u)| u.is_some());
    let named: Vec<String> = named.map(|(axis, _)| axis.to_string()).collect();
    named.join(" and ")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::samples::{block, facets};
    use crate::body::{CellKind, Model, Support, prescribed};

    /// A plane below the block, 0.25 m away, and the pair of the named sides with it.
    fn pair(body: &Body, sides: &[&str]) -> ContactPair {
        let normal = match body.mesh.dimension {
            2 => [0.0, 1.0, 0.0],
            _ => [0.0, 0.0, 1.0],
        };
        let point = normal.map(|component| -0.25 * component);
        let facets = sides.iter().flat_map(|side| facets(&body.mesh, side));
        ContactPair {
            place: "contacts[0]".to_owned(),
            facets: facets.collect(),
            body: 0,
            opposite: Opposite::Obstacle(Obstacle::Plane { point, normal }),
            friction: 0.3,
        }
    }

    fn find(body: &Body, pairs: &[ContactPair]) -> Result<ContactSurface, Error> {
        ContactSurface::new(std::slice::from_ref(body), pairs, &[prescribed(body)?])
    }

    fn hold(body: &mut Body, nodes: &[usize], displacement: [Option<f64>; 3]) {
        body.supports.push(Support {
            place: "supports[0]".to_owned(),
            nodes: nodes.to_vec(),
            displacement,
        });
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
