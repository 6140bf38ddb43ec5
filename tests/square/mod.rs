//! The SSNV128 square (references: code_aster V6.04.128; GRECO), on a mesh of the generator.
//!
//! A square of 40 mm lies on a rigid plane with μ, is pressed from above by 50 MPa and pushed to
//! the right by 150 MPa; its right side cannot move along x, the corner below it not at all.

use dpana::Scene;
use serde_json::json;

/// The square with `cells` cells per side, in m, N, Pa.
pub(crate) fn scene(cells: usize, poisson: f64, friction: f64) -> Scene {
    let side = json!([0, 0.04]);
    let scene = json!({
        "bodies": [{
            "name": "square",
            "mesh": {"rectangle": {"x": side, "y": side, "cells": [cells, cells]}},
            "model": "plane_strain",
            "materials": [{"young": 1.3e11, "poisson": poisson}],
            "supports": [
                {"group": "right", "displacement": [0, null]},
                {"at": [0.04, 0], "displacement": [null, 0]}
            ],
            "loads": [
                {"group": "top", "pressure": 5e7},
                {"group": "left", "pressure": 15e7}
            ]
        }],
        "contacts": [{
            "group": "bottom", "friction": friction,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
        }]
    });
    Scene::from_json(&scene.to_string(), "").unwrap()
}
