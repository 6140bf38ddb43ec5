//! How rigid groups have moved, and what holds their reference points.

use serde::Serialize;

use super::ReportParts;
use super::certificate::in_dimension;
use crate::body::Tie;

/// A group that moves as a rigid body; vectors in global axes, rotation and moment in 2D a single component.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedRigidGroup {
    /// Where the scene says so, such as `bodies[0].rigid_groups[0]`.
    pub place: String,
    /// Displacement of the reference point, in metre.
    pub displacement: Vec<f64>,
    /// Rotation, in radian.
    pub rotation: Vec<f64>,
    /// Force of the support of the reference point on the body, in newton.
    pub force: Vec<f64>,
    /// Its moment about the reference point, in newton metre.
    pub moment: Vec<f64>,
}

/// All rigid groups, body by body.
pub(super) fn rigid_groups(parts: &ReportParts<'_>) -> Vec<ReportedRigidGroup> {
    let dimension = parts.dimension();
    let turning = |vector: [f64; 3]| match dimension {
        2 => vec![vector[2]],
        _ => vector.to_vec(),
    };
    let bodies = parts.bodies.iter().zip(parts.group_states);
    let states = bodies.flat_map(|(body, states)| states.iter().map(move |state| (body, state)));
    let groups = states.map(|(body, state)| ReportedRigidGroup {
        place: body
            .ties
            .get(state.tie)
            .map(Tie::place)
            .unwrap_or_default()
            .to_owned(),
        displacement: in_dimension(state.displacement, dimension),
        rotation: turning(state.rotation),
        force: in_dimension(state.force, dimension),
        moment: turning(state.moment),
    });
    groups.collect()
}
