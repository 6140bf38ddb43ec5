//! Scenes of the gallery, in few words.

use crate::alternation::Status;
use crate::body::Mesh;
use crate::closed_forms::Elastic;
use crate::error::Error;
use crate::pipeline::{Solution, solve};
use crate::report::Report;
use crate::scene::{
    Scene, SceneBody, SceneContact, SceneMaterial, SceneModel, SceneObstacle, SceneSupport,
};

/// E = 210 GPa, ν = 0.3; in mm, N, MPa.
pub(super) const STEEL: Elastic = Elastic {
    young: 210e3,
    poisson: 0.3,
};

/// A body of one material without supports; in 2D in plane strain.
pub(super) fn body(name: &str, mesh: Mesh, material: Elastic) -> SceneBody {
    SceneBody {
        model: (mesh.dimension == 2).then_some(SceneModel::PlaneStrain),
        materials: vec![SceneMaterial::new(material.young, material.poisson)],
        ..SceneBody::new(name, mesh)
    }
}

/// The body with one component of a group's displacement given.
pub(super) fn hold(mut body: SceneBody, group: &str, axis: usize, value: f64) -> SceneBody {
    let axes = if body.model.is_some() { 2 } else { 3 };
    let given = |at: usize| (at == axis).then_some(value);
    body.supports.push(SceneSupport::Group {
        group: group.into(),
        displacement: (0..axes).map(given).collect(),
    });
    body
}

/// A body on an obstacle.
pub(super) fn on(obstacle: SceneObstacle, body: SceneBody, group: &str, friction: f64) -> Scene {
    Scene {
        bodies: vec![body],
        contacts: vec![SceneContact {
            group: group.into(),
            obstacle: Some(obstacle),
            friction: Some(friction),
            ..SceneContact::default()
        }],
        ..Scene::default()
    }
}

/// A plane through the origin; as many components as the body has axes.
pub(super) fn plane(normal: &[f64]) -> SceneObstacle {
    SceneObstacle::Plane {
        point: vec![0.0; normal.len()],
        normal: normal.to_vec(),
    }
}

/// Two bodies; the group of the first carries the contacts with that of the second.
pub(super) fn pair(bodies: [SceneBody; 2], groups: [&str; 2], friction: f64) -> Scene {
    let [own, other] = [0, 1].map(|side| [bodies[side].name.as_str(), groups[side]]);
    let contact = SceneContact::between(own, other, friction);
    Scene {
        bodies: bodies.to_vec(),
        contacts: vec![contact],
        ..Scene::default()
    }
}

/// A scene, solved: solution, report, and whether it is certified.
pub(super) fn solved(scene: &Scene) -> Result<(Solution, Report, bool), Error> {
    let solution = solve(scene)?;
    let report = solution.report()?;
    let certified = solution.status() == Status::Certified;
    Ok((solution, report, certified))
}
