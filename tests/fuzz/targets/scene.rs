//! Text to every reader of JSON, and what they accept to the solver.
#![no_main]

use dpana::alternation::Settings;
use dpana::scene::{BareProblem, SavedState, Scene};
use dpana_fuzz::{attempt, change, small, witness};
use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};

/// Mesh files are relative to this one's folder.
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/seeds/scene/scene.json");

/// Most unknowns of a bare problem that is solved.
const SOLVED: usize = 40;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let _ = SavedState::from_json(text, "state.json");
    if let Ok(problem) = BareProblem::from_json(text, "bare.json").and_then(|b| b.to_problem()) {
        let settings = Settings::default();
        if problem.unknowns() <= SOLVED {
            let outcome = dpana::alternation::solve(&problem, &settings).expect("settings are sound");
            witness(&problem, &outcome, settings.tolerance);
        }
    }
    if let Ok(scene) = Scene::from_json(text, FILE) {
        if small(&scene) {
            let _ = attempt(scene);
        }
    }
});

// Half the changes keep the text JSON; the others are of single bytes and words.
fuzz_mutator!(|bytes: &mut [u8], size: usize, most: usize, seed: u32| {
    if seed % 4 != 0 {
        if let Some(changed) = change(&bytes[..size], seed).filter(|text| text.len() <= most) {
            bytes[..changed.len()].copy_from_slice(changed.as_bytes());
            return changed.len();
        }
    }
    fuzzer_mutate(bytes, size, most)
});
