//! Lines in space, and the axis of an axisymmetric body, x = 0.

use nalgebra::Vector3;

use super::{Body, Model};

/// Radius, relative to the largest, that round-off of a mesh generator may leave on the axis.
const ROUND_OFF: f64 = 1e-10;

/// The radial unknowns (`dimension · node + axis`) of nodes on the axis, which stay there; none if
/// the body is not axisymmetric.
#[must_use]
pub(crate) fn held_by_axis(body: &Body) -> Vec<usize> {
    let Some(axis) = Axis::of(body) else {
        return Vec::new();
    };
    let nodes = body.mesh.nodes.iter().enumerate();
    let on_axis = nodes.filter(|(_, position)| axis.holds(**position));
    on_axis
        .map(|(node, _)| node * body.mesh.dimension)
        .collect()
}

/// What counts as the axis of a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    width: f64,
}

impl Axis {
    /// The axis of a body; none if it is not axisymmetric.
    pub(crate) fn of(body: &Body) -> Option<Self> {
        let radii = body.mesh.nodes.iter().map(|position| position[0].abs());
        (body.model == Model::Axisymmetric).then(|| Self {
            width: ROUND_OFF * radii.fold(0.0, f64::max),
        })
    }

    /// Whether a position is on it.
    pub(crate) fn holds(self, position: [f64; 3]) -> bool {
        position[0].abs() <= self.width
    }
}

/// A line in space: a point, in metre, and a direction of any length but zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// A point of the line, in metre.
    pub point: [f64; 3],
    /// Its direction.
    pub direction: [f64; 3],
}

impl Line {
    /// The way from the line to a position, across the line, in metre.
    #[must_use]
    pub fn arm(&self, position: [f64; 3]) -> [f64; 3] {
        let along = Vector3::from(self.direction).normalize();
        let way = Vector3::from(position) - Vector3::from(self.point);
        (way - along * along.dot(&way)).into()
    }
}
