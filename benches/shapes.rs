//! Contact beside the linear stages where bodies are slender or thin, weakly held, or finely meshed.
//!
//! `cargo bench --bench shapes [-- --quick] [PART OF A NAME…]`; processor time, each case once. Linear is assembly,
//! ordering, factorisation, G and recovery; contact is the whole outer loop.
#![allow(clippy::print_stdout)]

mod generated_square;
mod processor;

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use dpana::Scene;
use dpana::alternation::{Status, solve};
use dpana::condensation::Condensed;
use generated_square::square;
use processor::processor;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let has = |option: &str| arguments.iter().any(|argument| argument == option);
    let quick = has("--quick") || !has("--bench");
    let wanted: Vec<&String> = arguments
        .iter()
        .filter(|word| !word.starts_with("--"))
        .collect();
    println!(
        "| case | unknowns | contacts | linear s | contact s | contact / linear | cone iterations | Newton steps | proximal steps | path | residual |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    let mut scenes = Vec::new();
    let size = |fine: usize, coarse: usize| if quick { coarse } else { fine };
    for slender in [10, 100, 1000] {
        for friction in [0.3, 1.0] {
            let name = format!("beam {slender}:1, mu {friction}");
            scenes.push((name, beam(size(399, 39), slender, friction)?));
        }
    }
    for thin in [100, 1000] {
        for pressed in [false, true] {
            let name = format!(
                "plate {thin}:1, {}",
                if pressed { "pressed" } else { "clamped" }
            );
            scenes.push((name, plate(size(28, 4), thin, pressed)?));
        }
    }
    scenes.push(("bar".to_owned(), bar(size(999, 99))?));
    for per_side in if quick { vec![32] } else { vec![362, 512, 707] } {
        scenes.push((format!("square {per_side}"), square(per_side)?));
    }
    for (name, scene) in scenes {
        if wanted.is_empty() || wanted.iter().any(|part| name.contains(*part)) {
            row(&name, &scene)?;
        }
    }
    Ok(())
}

fn row(name: &str, scene: &Scene) -> Result<(), Box<dyn Error>> {
    let clock = Instant::now();
    let start = processor(clock);
    let mechanics = scene.mechanics()?;
    let condensed = Condensed::new(&mechanics.bodies, &mechanics.contacts)?;
    let condensation = processor(clock) - start;
    let start = processor(clock);
    let outcome = solve(condensed.problem(), &mechanics.settings)?;
    let contact = processor(clock) - start;
    let start = processor(clock);
    condensed.recover(&outcome.reaction, &outcome.motion)?;
    let linear = condensation + processor(clock) - start;
    let work = outcome.work;
    println!(
        "| {name} | {} | {} | {linear:.3} | {contact:.3} | {:.2} | {} | {} | {} | {} | {:.1e}{} |",
        condensed.work().unknowns,
        condensed.problem().contacts(),
        contact / linear,
        work.cone_iterations,
        work.newton_steps,
        work.proximal_steps,
        work.path_changes + work.path_steps,
        outcome.verdict.certificate.residual(),
        if outcome.status == Status::Certified {
            ""
        } else {
            ", not certified"
        },
    );
    Ok(())
}

fn read(text: &str) -> Result<Scene, Box<dyn Error>> {
    Ok(Scene::from_json(
        text,
        Path::new("shapes.json").display().to_string().as_str(),
    )?)
}

/// As long as high, pushed from its left and pressed on a plane, held at its right.
fn beam(cells: usize, slender: usize, friction: f64) -> Result<Scene, Box<dyn Error>> {
    let height = 40.0 / slender as f64;
    let layers = (cells / slender).clamp(4, 40);
    read(&format!(
        r#"{{"bodies": [{{"name": "beam", "model": "plane_strain",
            "mesh": {{"rectangle": {{"x": [0, 40], "y": [0, {height}], "cells": [{cells}, {layers}]}}}},
            "materials": [{{"young": 1.3e11, "poisson": 0.3}}],
            "supports": [{{"group": "right", "displacement": [0, null]}}, {{"at": [40, 0], "displacement": [null, 0]}}],
            "loads": [{{"group": "left", "pressure": 1e5}}, {{"group": "top", "pressure": 5e7}}]}}],
          "contacts": [{{"group": "bottom", "friction": {friction},
            "obstacle": {{"plane": {{"point": [0, 0], "normal": [0, 1]}}}}}}]}}"#
    ))
}

/// Clamped on its top and dragged, or pressed and sheared on its top while an end holds it.
fn plate(cells: usize, thin: usize, pressed: bool) -> Result<Scene, Box<dyn Error>> {
    let height = 1.0 / thin as f64;
    let held = match pressed {
        true => r#""supports": [{"group": "right", "displacement": [0, 0, null]}],
            "loads": [{"group": "top", "traction": [-0.05, 0, -1]}]"#
            .to_owned(),
        false => format!(
            r#""supports": [{{"group": "top", "displacement": [{}, 0, {}]}}]"#,
            0.0045 * height,
            -0.01 * height
        ),
    };
    read(&format!(
        r#"{{"bodies": [{{"name": "plate",
            "mesh": {{"box": {{"x": [0, 1], "y": [0, 1], "z": [0, {height}], "cells": [{cells}, {cells}, 2]}}}},
            "materials": [{{"young": 1000, "poisson": 0.3}}], {held}}}],
          "contacts": [{{"group": "bottom", "friction": 0.3,
            "obstacle": {{"plane": {{"point": [0, 0, 0], "normal": [0, 0, 1]}}}}}}]}}"#
    ))
}

/// On a base that rubs, pulled at its end so that it slips over a part of its length; nothing else holds it.
fn bar(cells: usize) -> Result<Scene, Box<dyn Error>> {
    read(&format!(
        r#"{{"bodies": [{{"name": "bar", "model": {{"plane_stress": {{"thickness": 1}}}},
            "mesh": {{"rectangle": {{"x": [0, 60], "y": [0, 0.5], "cells": [{cells}, 1]}}}},
            "materials": [{{"young": 1, "poisson": 0}}],
            "loads": [{{"group": "top", "pressure": 0.001}}, {{"group": "right", "traction": [0.024, 0]}}]}}],
          "contacts": [{{"group": "bottom", "friction": 0.3,
            "obstacle": {{"plane": {{"point": [0, 0], "normal": [0, 1]}}}}}}]}}"#
    ))
}
