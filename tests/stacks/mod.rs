//! Blocks on blocks: scenes of several bodies, built in code.
#![allow(dead_code)]

use dpana::body::{CellKind, Group, Mesh, box_mesh, graded, rectangle};
use dpana::report::Report;
use dpana::scene::{SceneBody, SceneContact, SceneMaterial, SceneModel, SceneSupport};
use dpana::{Scene, Solution, Status, solve};

/// A block between two corners with `cells` along each axis, their sizes graded; in 2D along
/// the first two axes.
pub(crate) fn block(kind: CellKind, low: [f64; 3], high: [f64; 3], cells: [usize; 3]) -> Mesh {
    let lines = |axis: usize, grading| graded(low[axis], high[axis], cells[axis], grading).unwrap();
    match kind.dimension() {
        2 => rectangle(&lines(0, 1.7), &lines(1, 0.6), kind).unwrap(),
        _ => box_mesh(&lines(0, 1.7), &lines(1, 0.8), &lines(2, 0.6), kind).unwrap(),
    }
}

/// A body of one material, without supports; in 2D in plane strain.
pub(crate) fn body(name: &str, mesh: Mesh, young: f64, poisson: f64) -> SceneBody {
    let model = (mesh.dimension == 2).then_some(SceneModel::PlaneStrain);
    let mut body = SceneBody::new(name, mesh).with_material(SceneMaterial::new(young, poisson));
    body.model = model;
    body
}

/// The body with one component of a group's displacement given.
pub(crate) fn hold(mut body: SceneBody, group: &str, axis: usize, value: f64) -> SceneBody {
    let axes = if body.model.is_some() { 2 } else { 3 };
    let mut displacement = vec![None; axes];
    displacement[axis] = Some(value);
    body.supports.push(SceneSupport::Group {
        group: group.into(),
        displacement,
    });
    body
}

/// A contact of `own` body and group against `other` body and group.
pub(crate) fn contact(own: [&str; 2], other: [&str; 2], friction: f64) -> SceneContact {
    SceneContact::between(own, other, friction)
}

pub(crate) fn scene(bodies: Vec<SceneBody>, contacts: Vec<SceneContact>) -> Scene {
    Scene::new(bodies, contacts)
}

/// Solves a scene that must end certified.
pub(crate) fn certified(scene: &Scene) -> (Solution, Report) {
    let solution = solve(scene).unwrap();
    let faults: Vec<_> = solution.fits().iter().map(|fit| fit.fault()).collect();
    assert_eq!(
        solution.status(),
        Status::Certified,
        "{faults:?} {:?}",
        solution.outcome().shortfall
    );
    let report = solution.report().unwrap();
    (solution, report)
}

/// The cells of a group with what belongs to them, as a mesh of their own.
pub(crate) fn part(mesh: &Mesh, group: &str) -> Mesh {
    let Group::Cells(cells) = &mesh.groups[group] else {
        unreachable!("{group} is no group of cells");
    };
    mesh.part(cells)
}

/// The body with one component given at a node of its mesh.
pub(crate) fn hold_at(mut body: SceneBody, at: [f64; 3], axis: usize, value: f64) -> SceneBody {
    let axes = if body.model.is_some() { 2 } else { 3 };
    let mut displacement = vec![None; axes];
    displacement[axis] = Some(value);
    body.supports.push(SceneSupport::At {
        at: at[..axes].to_vec(),
        displacement,
    });
    body
}
