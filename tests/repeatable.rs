//! The same scene gives the same bits, in every run and on any number of threads.
#![allow(clippy::unwrap_used, missing_docs)]

use dpana::{Scene, Solution, Status, Variation, solve, sweep};
use rayon::ThreadPoolBuilder;
use serde_json::json;

const THREADS: [usize; 3] = [1, 2, 16];

/// The cube of `examples/scenes/cube.json`, 12 cells on a side.
fn cube() -> Scene {
    let side = [0, 1];
    scene(&json!({
        "bodies": [{
            "mesh": {"box": {"x": side, "y": side, "z": side, "cells": [12, 12, 12]}},
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

fn largest_difference(scene: fn() -> Scene) -> f64 {
    let runs = THREADS.map(|threads| {
        let start = std::time::Instant::now();
        let b = on_threads(threads, || bits(&solve(&scene()).unwrap()));
        eprintln!("{threads} threads: {:?}", start.elapsed());
        b
    });
    let one: Vec<f64> = runs[0].iter().map(|b| f64::from_bits(*b)).collect();
    let mut worst = 0.0_f64;
    for r in &runs[1..] {
        let m = one.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let d = one
            .iter()
            .zip(r)
            .map(|(a, b)| (a - f64::from_bits(*b)).abs())
            .fold(0.0, f64::max);
        eprintln!("same bits {}  diff {:e} of {m:e}", &runs[0] == r, d);
        worst = worst.max(d / m);
    }
    worst
}

#[test]
fn explore() {
    for (name, s) in [
        ("cube", cube as fn() -> Scene),
        ("two", two_cubes),
        ("square", square),
        ("pad", pad),
    ] {
        eprintln!("{name}");
        let a = bits(&solve(&s()).unwrap());
        let b = bits(&solve(&s()).unwrap());
        eprintln!("twice {}", a == b);
        largest_difference(s);
    }
    let v = [
        Variation {
            name: "friction".into(),
            values: vec![0.1, 0.2, 0.4],
        },
        Variation {
            name: "bodies[0].loads[0]".into(),
            values: vec![1.0, 0.5, 0.25, 0.1],
        },
    ];
    let runs = THREADS.map(|t| on_threads(t, || sweep(&square(), &v).unwrap()));
    eprintln!("sweep {} {}", runs[0] == runs[1], runs[0] == runs[2]);
}
