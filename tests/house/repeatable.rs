//! The same scene gives the same bits in every run, and on any number of threads.

use dpana::{Scene, Solution, Status, Variation, cases, solve};
use rayon::ThreadPoolBuilder;
use serde_json::json;

const THREADS: [usize; 3] = [1, 2, 16];

/// The cube of `examples/scenes/cube.json`, with other cells.
fn cube(cells: [usize; 3], kind: &str) -> Scene {
    let side = [0, 1];
    scene(&json!({
        "bodies": [{
            "mesh": {"box": {"x": side, "y": side, "z": side, "cells": cells, "cell": kind}},
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": [0.0045, 0, -0.01]}]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.3,
            "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}
        }]
    }))
}

/// A cube on a wider and stiffer one whose cells do not match.
fn two_cubes() -> Scene {
    scene(&json!({
        "bodies": [
            {
                "name": "upper",
                "mesh": {"box": {"x": [0, 1], "y": [0, 1], "z": [1, 2], "cells": [10, 10, 10]}},
                "materials": [{"young": 1000, "poisson": 0.3}],
                "supports": [{"group": "top", "displacement": [0.0045, 0, -0.01]}]
            },
            {
                "name": "lower",
                "mesh": {"box": {"x": [-0.1, 1.1], "y": [-0.1, 1.1], "z": [0, 1], "cells": [10, 10, 10]}},
                "materials": [{"young": 10000, "poisson": 0.3}],
                "supports": [{"group": "bottom", "displacement": [0, 0, 0]}]
            }
        ],
        "contacts": [{
            "body": "upper", "group": "bottom", "friction": 0.3,
            "against": {"body": "lower", "group": "top"}
        }]
    }))
}

/// The square of SSNV128, 64 cells on a side.
fn square() -> Scene {
    let side = [0.0, 0.04];
    scene(&json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": side, "y": side, "cells": [64, 64]}},
            "model": "plane_strain",
            "materials": [{"young": 1.3e11, "poisson": 0.2}],
            "supports": [
                {"group": "right", "displacement": [0, null]},
                {"at": [0.04, 0], "displacement": [null, 0]}
            ],
            "loads": [{"pressure": 5e7, "group": "top"}, {"pressure": 15e7, "group": "left"}]
        }],
        "contacts": [{
            "group": "bottom", "friction": 1,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
        }]
    }))
}

/// A loose pad that only friction holds.
fn pad() -> Scene {
    scene(&json!({
        "bodies": [{
            "mesh": {"box": {"x": [0, 20], "y": [0, 20], "z": [0, 10], "cells": [6, 6, 3]}},
            "materials": [{"young": 210_000, "poisson": 0}],
            "loads": [
                {"group": "top", "traction": [0, 0, -30]},
                {"group": "bottom", "traction": [8, 0, 0]}
            ]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.3,
            "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}
        }]
    }))
}

fn scene(text: &serde_json::Value) -> Scene {
    Scene::from_json(&text.to_string(), "").unwrap()
}

/// Every number of an answer, bit by bit.
fn bits(solution: &Solution) -> Vec<u64> {
    assert_eq!(solution.status(), Status::Certified);
    let outcome = solution.outcome();
    let residual = outcome.verdict.certificate.natural_map;
    let numbers = outcome.reaction.iter().chain(&outcome.motion);
    let displacements = solution.displacements().iter().flatten();
    let numbers = numbers.chain(displacements).chain([&residual]);
    numbers.map(|number| number.to_bits()).collect()
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(work)
}

/// Bits of two runs in one process, and of runs on pools of each size.
fn assert_repeats(scene: &Scene) {
    let run = || bits(&solve(scene).unwrap());
    let once = run();
    assert!(once == run(), "two runs differ");
    for threads in THREADS {
        assert!(once == on_threads(threads, run), "{threads} threads differ");
    }
}

#[test]
fn a_dragged_cube_repeats_bit_by_bit() {
    assert_repeats(&cube([12; 3], "hex8"));
}

#[test]
fn a_cube_of_quadratic_cells_repeats_bit_by_bit() {
    assert_repeats(&cube([7, 7, 4], "hex27"));
}

#[test]
fn two_cubes_repeat_bit_by_bit() {
    assert_repeats(&two_cubes());
}

#[test]
fn a_square_repeats_bit_by_bit() {
    assert_repeats(&square());
}

#[test]
fn a_loose_pad_repeats_bit_by_bit() {
    assert_repeats(&pad());
}

/// Rows of a sweep are solved side by side; each row goes on from its own last state.
#[test]
fn a_sweep_repeats_bit_by_bit() {
    let variation = |name: &str, values: &[f64]| Variation {
        name: name.to_owned(),
        values: values.to_vec(),
    };
    let variations = [
        variation("friction", &[0.1, 0.2, 0.4, 1.0]),
        variation("bodies[0].loads[0]", &[1.0, 0.5, 0.25]),
    ];
    let run = || cases(&square(), &variations).unwrap();
    let once = run();
    assert_eq!(once.rows.len(), 12);
    assert!(once == run(), "two runs differ");
    for threads in THREADS {
        assert!(once == on_threads(threads, run), "{threads} threads differ");
    }
}

/// 441 contacts: cone programs and dense factorisations are divided among threads.
#[test]
#[ignore = "slow"]
fn a_wide_block_repeats_bit_by_bit() {
    assert_repeats(&cube([20, 20, 8], "hex8"));
}
