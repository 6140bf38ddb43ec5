//! A scene as far as it goes: read, checked, and solved if it is small.

use dpana::scene::{MeshSource, Scene};
use dpana::{Error, Solution, Status};

use crate::witness;

/// Most unknowns of a scene that is solved.
const SOLVED: usize = 300;

/// Most nodes of a mesh that is generated; the program's own limit lies far higher.
const GENERATED: usize = 4000;

/// Most load steps and most sweeps.
const STEPS: usize = 4;
const SWEEPS: usize = 40;

/// Part of the load that a certified body may be out of balance by.
const BALANCE: f64 = 1e-6;

/// Part of the forces inside a body that rounding may leave over.
const ROUNDING: f64 = 1e-12;

/// False where a scene is sound but asks for more work than a fuzzer has time for.
#[must_use]
pub fn small(scene: &Scene) -> bool {
    let steps = scene.steps.as_ref().map_or(0, |steps| steps.at.len());
    let quick = |mesh: &MeshSource| {
        let cells: &[usize] = match mesh {
            MeshSource::Rectangle { rectangle } => &rectangle.cells,
            MeshSource::Box { solid } => &solid.cells,
            MeshSource::File { .. } | MeshSource::Given(_) => &[],
        };
        let nodes = cells
            .iter()
            .map(|&count| count as f64 + 1.0)
            .product::<f64>();
        // Beyond the program's limit it must be refused at once.
        nodes <= GENERATED as f64 || nodes > 2.1e7
    };
    steps <= STEPS && scene.bodies.len() <= 6 && scene.bodies.iter().all(|b| quick(&b.mesh))
}

/// Reads the mechanics of a scene and, if it is small, solves it and has the answer witnessed.
///
/// # Errors
///
/// Those of the scene.
pub fn attempt(mut scene: Scene) -> Result<(), Error> {
    let mechanics = scene.mechanics()?;
    let mut unknowns = 0;
    for body in &mechanics.bodies {
        unknowns += body.mesh.nodes.len() * body.mesh.dimension;
    }
    if unknowns > SOLVED {
        return Ok(());
    }
    for body in &mechanics.bodies {
        let _ = body.free_motions()?;
    }
    if let Some(sweeps) = &mut scene.settings.max_sweeps {
        *sweeps = (*sweeps).min(SWEEPS);
    }
    if let Ok(limits) = dpana::rigid_limit(&scene) {
        let _ = (limits.to_json(), limits.summary());
    }
    let tolerance = mechanics.settings.tolerance;
    let solution = dpana::solve_steps(&scene, None, |step| {
        judge(step, tolerance);
        Ok(())
    })?;
    judge(&solution, tolerance);
    Ok(())
}

fn judge(solution: &Solution, tolerance: f64) {
    let (problem, outcome) = (solution.condensed().problem(), solution.outcome());
    witness(problem, outcome, tolerance);
    if outcome.status == Status::Certified {
        let bodies = solution.bodies().iter().zip(solution.displacements());
        for (balance, (body, displacement)) in solution.balances().iter().zip(bodies) {
            // A body that moves without deforming carries round-off, and nothing else.
            let stiffness = body.stiffness().expect("a solved body is sound");
            let elastic = largest(stiffness.data()) * largest(displacement);
            let sound = balance.equilibrium.scaled <= BALANCE
                || balance.equilibrium.value <= ROUNDING * elastic;
            assert!(
                sound && balance.support.scaled <= BALANCE,
                "certified, but {balance:?}"
            );
        }
    }
    let report = solution.report().expect("a solution has a report");
    let _ = (report.to_json(), report.summary());
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, x| x.abs().max(most))
}
