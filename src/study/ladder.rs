//! The scene solved by the default loop on every mesh, from coarse to fine.

use std::time::Instant;

use super::plan::Plan;
use super::tensor_grid::TensorGrid;
use crate::condensation::Condensed;
use crate::error::Error;
use crate::pipeline::{Solution, solve};
use crate::problem::ContactProblem;
use crate::report::{KnownTotal, Report, StageSeconds, StudiedMesh, Table};
use crate::scene::{Scene, nearest};

/// Shorter solves, in second, are repeated.
pub(super) const SHORT: f64 = 0.25;

/// A grid and the displacement of its nodes.
type Field = (TensorGrid, Vec<f64>);

/// The mesh on which loops are compared.
pub(super) struct Chosen {
    pub(super) mesh: usize,
    pub(super) condensed: Condensed,
    /// Axes of its bodies.
    pub(super) axes: usize,
}

/// The meshes so far.
#[derive(Default)]
pub(super) struct Ladder {
    meshes: Vec<StudiedMesh>,
    /// The fields of every body, per mesh; none where the mesh is no grid.
    fields: Vec<Vec<Option<Field>>>,
    finest: Option<Solution>,
    chosen: Option<Chosen>,
}

impl Ladder {
    /// Solves the scene on its mesh; the condensed problem has not been asked for its stiffness.
    pub(super) fn climb(
        &mut self,
        name: &str,
        scene: &Scene,
        plan: &Plan,
    ) -> Result<ContactProblem, Error> {
        // Bodies of the mesh before are let go: the finest needs the memory.
        self.finest = None;
        let (mut solution, mut report) = solved(scene)?;
        let mut all = vec![StageSeconds::new(&report.work.seconds)];
        while all.len() < plan.repetitions && report.work.seconds.total < SHORT {
            (solution, report) = solved(scene)?;
            all.push(StageSeconds::new(&report.work.seconds));
        }
        let start = Instant::now();
        let estimate = solution.stress_error_estimate();
        let estimate_seconds = start.elapsed().as_secs_f64();
        report.quality.stress_error_estimate = Some(estimate);
        let mut seconds = StageSeconds::median(&all);
        seconds.estimate = estimate_seconds;
        let work = solution.condensed().work();
        self.meshes.push(StudiedMesh {
            name: name.to_owned(),
            unknowns: work.unknowns,
            factor_entries: work.factor_entries,
            size: report.size.clone(),
            status: report.status,
            certificate: report.certificate.clone(),
            sweeps: report.work.sweeps,
            newton_steps: report.work.newton_steps,
            cone_iterations: report.work.cone_iterations,
            seconds,
            quality: report.quality,
            known: known(&report, plan)?,
            error: None,
            effectivity: None,
        });
        let solved = solution.bodies().iter().zip(solution.displacements());
        let fields = solved.map(|(body, u)| Some((TensorGrid::of(&body.mesh)?, u.clone())));
        self.fields.push(fields.collect());
        let condensed = solution.precise()?;
        let problem = condensed.problem().clone();
        if problem.unknowns() <= plan.loop_unknowns || self.chosen.is_none() {
            self.chosen = Some(Chosen {
                mesh: self.meshes.len() - 1,
                condensed: condensed.clone(),
                axes: solution.bodies()[0].mesh.dimension,
            });
        }
        self.finest = Some(solution);
        Ok(problem)
    }

    /// The meshes with their errors (M1), and the one on which loops are compared.
    pub(super) fn finish(mut self) -> (Vec<StudiedMesh>, Option<Chosen>) {
        if let Some(finest) = &self.finest {
            let count = self.meshes.len() - 1;
            for (mesh, fields) in self.meshes.iter_mut().zip(&self.fields).take(count) {
                mesh.error = energy_error(finest, fields);
                let estimate = mesh.quality.stress_error_estimate;
                mesh.effectivity = estimate
                    .zip(mesh.error)
                    .map(|(estimate, error)| estimate / error);
            }
        }
        (self.meshes, self.chosen)
    }
}

fn solved(scene: &Scene) -> Result<(Solution, Report), Error> {
    let solution = solve(scene)?;
    let report = solution.report()?;
    Ok((solution, report))
}

/// Known totals beside those of a report.
fn known(report: &Report, plan: &Plan) -> Result<Vec<KnownTotal>, Error> {
    let mut table = Table::default();
    table.push(&[], report);
    let known = plan.known.iter().map(|(name, exact)| {
        let column = table.column(name).ok_or_else(|| Error::UnknownName {
            place: "plan.known".to_owned(),
            what: "total",
            name: name.clone(),
            nearest: nearest(name, table.columns.iter().map(String::as_str)).map(str::to_owned),
            known: table.columns.clone(),
        })?;
        let computed = column.first().copied().unwrap_or(f64::NAN);
        Ok(KnownTotal {
            name: name.clone(),
            computed,
            exact: *exact,
            error: (computed / exact - 1.0).abs(),
        })
    });
    known.collect()
}

/// `‖I u − u*‖ / ‖u*‖` in the energy norm of the finest mesh, `I u` a coarser displacement at its
/// nodes; none where a mesh is no grid, and in nearly incompressible bodies, where the dilatation
/// between the coarser nodes would be taken for stress.
fn energy_error(finest: &Solution, fields: &[Option<Field>]) -> Option<f64> {
    let (mut error, mut energy) = (0.0, 0.0);
    let bodies = finest.bodies().iter().zip(finest.condensed().bodies());
    for (((body, condensed), fine), coarse) in bodies.zip(finest.displacements()).zip(fields) {
        let (grid, nodal) = coarse.as_ref()?;
        if body.averages_dilatation() {
            return None;
        }
        let positions = body.mesh.nodes.iter();
        let at_nodes = positions.flat_map(|position| grid.displacement(nodal, *position));
        let difference: Vec<f64> = at_nodes.zip(fine).map(|(a, b)| a - b).collect();
        for (entry, (i, j)) in condensed.stiffness() {
            error += difference[i] * entry * difference[j];
            energy += fine[i] * entry * fine[j];
        }
    }
    let ratio = (error / energy).sqrt();
    ratio.is_finite().then_some(ratio)
}
