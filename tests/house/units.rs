//! The same scene in other units, or under a load a billion times smaller or larger: the same
//! answer after scaling, in the same number of sweeps.

use crate::square;
use dpana::scene::{MeshSource, SceneLoad, SceneSupport};
use dpana::{Scene, Solution, Status, solve};
use serde_json::json;

/// Factors on lengths, on stresses, and on the loads beyond that.
#[derive(Clone, Copy, Debug)]
struct Scales {
    length: f64,
    stress: f64,
    load: f64,
}

const METRE_PASCAL: Scales = Scales {
    length: 1.0,
    stress: 1.0,
    load: 1.0,
};

/// m and Pa, mm and MPa, µm and GPa, and m and Pa at 1e-9 and 1e9 of the load.
const SCALES: [Scales; 5] = [
    METRE_PASCAL,
    Scales {
        length: 1e3,
        stress: 1e-6,
        load: 1.0,
    },
    Scales {
        length: 1e6,
        stress: 1e-9,
        load: 1.0,
    },
    Scales {
        load: 1e-9,
        ..METRE_PASCAL
    },
    Scales {
        load: 1e9,
        ..METRE_PASCAL
    },
];

impl Scales {
    /// Scales mesh, materials, prescribed displacements and pressures; obstacles pass through the origin.
    fn apply(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        let body = &mut scene.bodies[0];
        let lengthen = |values: &mut [f64]| values.iter_mut().for_each(|x| *x *= self.length);
        match &mut body.mesh {
            MeshSource::Rectangle { rectangle } => {
                lengthen(&mut rectangle.x);
                lengthen(&mut rectangle.y);
            }
            MeshSource::Box { solid } => {
                let sides = [&mut solid.x, &mut solid.y, &mut solid.z];
                sides.into_iter().for_each(|side| lengthen(side));
            }
            other => unreachable!("{other:?}"),
        }
        for material in &mut body.materials {
            material.young = material.young.map(|young| young * self.stress);
        }
        for support in &mut body.supports {
            let displacement = match support {
                SceneSupport::Group { displacement, .. }
                | SceneSupport::Turned { displacement, .. } => displacement,
                SceneSupport::At { at, displacement } => {
                    lengthen(at);
                    displacement
                }
                other => unreachable!("{other:?}"),
            };
            for value in displacement.iter_mut().flatten() {
                *value *= self.length * self.load;
            }
        }
        for load in &mut body.loads {
            let SceneLoad::Pressure { pressure, .. } = load else {
                unreachable!("{load:?}");
            };
            *pressure *= self.stress * self.load;
        }
        scene
    }
}

fn certified(scene: &Scene) -> Solution {
    let solution = solve(scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    solution
}

/// Largest difference of `found / scale` and `expected`, relative to the largest expected value.
fn difference(found: &[f64], scale: f64, expected: &[f64]) -> f64 {
    let largest = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let pairs = found.iter().zip(expected);
    pairs.fold(0.0_f64, |m, (a, b)| m.max((a / scale - b).abs())) / largest
}

fn check(scene: &Scene) {
    let reference = certified(scene);
    let dimension = reference.bodies()[0].mesh.dimension as i32;
    for scales in SCALES {
        let Scales {
            length,
            stress,
            load,
        } = scales;
        let found = certified(&scales.apply(scene));
        // In 2D a force per depth is a stress times one length.
        let force = stress * load * length.powi(dimension - 1);
        let of_body = difference(
            &found.displacements()[0],
            length * load,
            &reference.displacements()[0],
        );
        let (outcome, expected) = (found.outcome(), reference.outcome());
        let of_contact = difference(&outcome.reaction, force, &expected.reaction);
        // The eight digits that are asked for in any units.
        assert!(of_body < 1e-8 && of_contact < 1e-8, "{scales:?}");
        assert_eq!(outcome.verdict.status, expected.verdict.status);
        let (work, expected) = (outcome.work, expected.work);
        assert!(work.sweeps.abs_diff(expected.sweeps) <= 1, "{scales:?}");
        let newton = work.newton_steps.abs_diff(expected.newton_steps);
        assert!(newton <= 2, "{scales:?}: {work:?}");
    }
}

#[test]
fn the_square_does_not_know_its_units_nor_the_size_of_its_load() {
    for friction in [0.0, 1.0, 5.0] {
        check(&square::scene(64, 0.2, friction));
    }
}

#[test]
fn a_cube_does_not_know_its_units_nor_the_size_of_its_load() {
    let side = [0, 1];
    let scene = json!({
        "bodies": [{
            "mesh": {"box": {"x": side, "y": side, "z": side, "cells": [6, 6, 6]}},
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": [0.0045, 0.001, -0.01]}]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.3,
            "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}
        }]
    });
    check(&Scene::from_json(&scene.to_string(), "").unwrap());
}
