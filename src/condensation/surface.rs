//! The contact surface: nodes, local frames, initial gaps and areas.

use super::Obstacle;
use crate::body::Facet;

/// A part of the body's surface that may touch a rigid obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPair {
    /// Where the scene says so, for messages, such as `contacts[0]`.
    pub place: String,
    /// The assumed contact surface; it need only contain the true contact.
    pub facets: Vec<Facet>,
    /// What it may touch.
    pub obstacle: Obstacle,
    /// Coefficient of friction, `μ ≥ 0`.
    pub friction: f64,
}

/// One node of the contact surface, facing one obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactNode {
    /// Node of the mesh.
    pub node: usize,
    /// Index of the contact pair.
    pub pair: usize,
    /// Position before loading, in metre.
    pub position: [f64; 3],
    /// Orthonormal rows: normal (towards the obstacle), then the tangents.
    pub frame: [[f64; 3]; 3],
    /// Number of tangents that the contact problem holds: 0 without friction, at most
    /// 1 in 2D and 2 in 3D, fewer where a support holds one.
    pub tangents: usize,
    /// Distance along the normal to the obstacle before loading, in metre.
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
    /// Facets between contact nodes (mesh node numbers), for areas and plots.
    pub facets: Vec<Facet>,
    /// Nodes of the surface that are no contacts because a support holds their normal.
    pub left_out: Vec<usize>,
}
