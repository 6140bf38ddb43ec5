//! The pipeline: scene → mechanics → condensation → outer loop → recovery → judge.

use std::path::Path;
use std::time::Instant;

use crate::body::{self, Body};
use crate::condensation::Condensed;
use crate::dpana::{self, Outcome, Status};
use crate::error::Error;
use crate::kkt::{self, Balance};
use crate::report::vtu::{self, BodyFields};
use crate::report::{Report, ReportParts, StageWork, replace_file};
use crate::scene::Scene;

/// Solves a scene.
///
/// # Errors
///
/// Whatever is wrong with the scene. A solve that does not converge is no error:
/// see [`Solution::status`].
pub fn solve(scene: &Scene) -> Result<Solution, Error> {
    let mechanics = scene.mechanics()?;
    let at_scene = |error| scene.locate(error);
    let [body] = <[Body; 1]>::try_from(mechanics.bodies).map_err(|bodies| Error::Length {
        place: "bodies".to_owned(),
        expected: 1,
        found: bodies.len(),
    })?;

    let condensed = Condensed::new(&body, &mechanics.contacts).map_err(at_scene)?;
    let outcome = dpana::solve(condensed.problem(), &mechanics.settings).map_err(at_scene)?;

    let start = Instant::now();
    let displacement = condensed.recover(&outcome.reaction)?;
    let balance = kkt::balance(&kkt::BodyState {
        body: &body,
        stiffness: condensed.stiffness(),
        load: condensed.load(),
        prescribed: condensed.prescribed(),
        surface: condensed.surface(),
        problem: condensed.problem(),
        reaction: &outcome.reaction,
        contact_displacement: &outcome.verdict.displacement,
        displacement: &displacement,
    })?;
    let recovery_seconds = start.elapsed().as_secs_f64();

    Ok(Solution {
        title: scene.title.clone(),
        units: scene.units.clone(),
        body,
        condensed,
        outcome,
        displacement,
        balance,
        recovery_seconds,
    })
}

/// A solved scene.
#[derive(Debug)]
pub struct Solution {
    title: String,
    units: String,
    body: Body,
    condensed: Condensed,
    outcome: Outcome,
    displacement: Vec<f64>,
    balance: Balance,
    recovery_seconds: f64,
}

impl Solution {
    /// Certified, or why not.
    #[must_use]
    pub fn status(&self) -> Status {
        self.outcome.status
    }

    /// The body.
    #[must_use]
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The body, condensed onto its contact surface.
    #[must_use]
    pub fn condensed(&self) -> &Condensed {
        &self.condensed
    }

    /// Reactions, the judge's verdict, history and work of the outer loop.
    #[must_use]
    pub fn outcome(&self) -> &Outcome {
        &self.outcome
    }

    /// Displacement per unknown of the body (`node · dimension + axis`), in metre.
    #[must_use]
    pub fn displacement(&self) -> &[f64] {
        &self.displacement
    }

    /// Displacement of the node nearest to a position before loading, in metre.
    #[must_use]
    pub fn displacement_near(&self, position: [f64; 3]) -> [f64; 3] {
        let distance = |node: &[f64; 3]| {
            (0..3)
                .map(|axis| (node[axis] - position[axis]).powi(2))
                .sum::<f64>()
        };
        let nodes = self.body.mesh.nodes.iter().enumerate();
        let nearest = nodes.min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)));
        let dimension = self.body.mesh.dimension;
        let first = nearest.map_or(0, |(node, _)| node * dimension);
        std::array::from_fn(|axis| {
            if axis < dimension {
                self.displacement[first + axis]
            } else {
                0.0
            }
        })
    }

    /// Equilibrium of the whole body, measured by the judge.
    #[must_use]
    pub fn balance(&self) -> &Balance {
        &self.balance
    }

    /// The answer under stable names.
    ///
    /// # Errors
    ///
    /// None for a solution of [`solve`].
    pub fn report(&self) -> Result<Report, Error> {
        let work = self.condensed.work();
        Report::new(&ReportParts {
            title: &self.title,
            units: &self.units,
            body: &self.body,
            surface: self.condensed.surface(),
            problem: self.condensed.problem(),
            outcome: &self.outcome,
            displacement: &self.displacement,
            balance: &self.balance,
            stages: &StageWork {
                factorisations: work.factorisations,
                assembly: work.assembly_seconds,
                ordering: work.ordering_seconds,
                factorisation: work.factorisation_seconds,
                condensation: work.condensation_seconds,
                recovery: self.recovery_seconds,
            },
            notes: &[],
        })
    }

    /// Writes the body to `path` and its contact surface beside it, as VTU.
    ///
    /// # Errors
    ///
    /// A file that cannot be written; what stood there before is then left as it was.
    pub fn write_vtu(&self, path: &Path) -> Result<(), Error> {
        let cell_stress = body::cell_stress(&self.body, &self.displacement);
        let nodal_stress = body::nodal_stress(&self.body, &cell_stress);
        let von_mises = |stress: &[[f64; 6]]| stress.iter().map(|&s| body::von_mises(s)).collect();
        let (nodal_von_mises, cell_von_mises): (Vec<f64>, Vec<f64>) =
            (von_mises(&nodal_stress), von_mises(&cell_stress));
        let of_body = vtu::body_vtu(&BodyFields {
            mesh: &self.body.mesh,
            displacement: &self.displacement,
            nodal_stress: &nodal_stress,
            nodal_von_mises: &nodal_von_mises,
            cell_stress: &cell_stress,
            cell_von_mises: &cell_von_mises,
        })?;
        let facets = &self.condensed.surface().facets;
        let of_contact =
            vtu::contact_vtu(&self.report()?, &self.body.mesh, facets, &self.displacement)?;
        replace_file(path, &of_body)?;
        replace_file(&vtu::contact_path(path), &of_contact)
    }
}
