//! The pipeline: scene → mechanics → condensation → outer loop → recovery → judge.

mod limit;

use std::path::Path;
use std::time::Instant;

use crate::body::{self, Body};
use crate::condensation::{Condensed, ContactPair};
use crate::dpana::{self, Outcome, Status};
use crate::error::Error;
use crate::kkt::{self, Balance, Worst};
use crate::report::vtu::{self, BodyFields};
use crate::report::{Report, ReportParts, StageWork, replace_file};
use crate::scene::{Mechanics, Scene};

pub use limit::limit;

/// Solves a scene.
///
/// # Errors
///
/// Whatever is wrong with the scene. A solve that does not converge is no error:
/// see [`Solution::status`].
pub fn solve(scene: &Scene) -> Result<Solution, Error> {
    let Mechanics {
        bodies,
        contacts: pairs,
        settings,
    } = scene.mechanics()?;
    let at_scene = |error| scene.locate(error);

    let condensed = Condensed::new(&bodies, &pairs).map_err(at_scene)?;
    let outcome = dpana::solve(condensed.problem(), &settings).map_err(at_scene)?;

    let start = Instant::now();
    let displacements = condensed.recover(&outcome.reaction, &outcome.motion)?;
    let balances = balances(&bodies, &condensed, &outcome.reaction, &displacements)?;
    let departure = kkt::surface_departure(
        &bodies,
        &displacements,
        condensed.surface(),
        condensed.problem(),
        &outcome.verdict.displacement,
    )?;
    let recovery_seconds = start.elapsed().as_secs_f64();

    Ok(Solution {
        title: scene.title.clone(),
        units: scene.units.clone(),
        bodies,
        pairs,
        condensed,
        outcome,
        displacements,
        balances,
        departure,
        recovery_seconds,
    })
}

/// Equilibrium of every body.
fn balances(
    bodies: &[Body],
    condensed: &Condensed,
    reaction: &[f64],
    displacements: &[Vec<f64>],
) -> Result<Vec<Balance>, Error> {
    let parts = bodies.iter().zip(condensed.bodies()).zip(displacements);
    parts
        .enumerate()
        .map(|(index, ((body, operators), displacement))| {
            kkt::balance(&kkt::BodyState {
                index,
                body,
                stiffness: operators.stiffness(),
                load: operators.load(),
                prescribed: operators.prescribed(),
                surface: condensed.surface(),
                problem: condensed.problem(),
                reaction,
                displacement,
            })
        })
        .collect()
}

/// A solved scene.
#[derive(Debug)]
pub struct Solution {
    title: String,
    units: String,
    bodies: Vec<Body>,
    pairs: Vec<ContactPair>,
    condensed: Condensed,
    outcome: Outcome,
    displacements: Vec<Vec<f64>>,
    balances: Vec<Balance>,
    departure: Worst,
    recovery_seconds: f64,
}

impl Solution {
    /// Certified, or why not.
    #[must_use]
    pub fn status(&self) -> Status {
        self.outcome.status
    }

    /// The bodies, in the order of the scene.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// The bodies, condensed onto their contact surface.
    #[must_use]
    pub fn condensed(&self) -> &Condensed {
        &self.condensed
    }

    /// Reactions, the judge's verdict, history and work of the outer loop.
    #[must_use]
    pub fn outcome(&self) -> &Outcome {
        &self.outcome
    }

    /// Displacement per body and unknown (`node · dimension + axis`), in metre.
    #[must_use]
    pub fn displacements(&self) -> &[Vec<f64>] {
        &self.displacements
    }

    /// Displacement of the node of a body nearest to a position before loading, in metre.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownIndex`] if there is no such body.
    pub fn displacement_near(&self, body: usize, position: [f64; 3]) -> Result<[f64; 3], Error> {
        let (Some(mesh), Some(displacement)) = (
            self.bodies.get(body).map(|body| &body.mesh),
            self.displacements.get(body),
        ) else {
            return Err(Error::UnknownIndex {
                place: "displacement".to_owned(),
                what: "body",
                index: body,
                count: self.bodies.len(),
            });
        };
        let distance = |node: &[f64; 3]| {
            (0..3)
                .map(|axis| (node[axis] - position[axis]).powi(2))
                .sum::<f64>()
        };
        let nodes = mesh.nodes.iter().enumerate();
        let nearest = nodes.min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)));
        let first = nearest.map_or(0, |(node, _)| node * mesh.dimension);
        let mut near = [0.0; 3];
        near[..mesh.dimension].copy_from_slice(&displacement[first..first + mesh.dimension]);
        Ok(near)
    }

    /// Equilibrium of each whole body, measured by the judge.
    #[must_use]
    pub fn balances(&self) -> &[Balance] {
        &self.balances
    }

    /// The answer under stable names.
    ///
    /// # Errors
    ///
    /// None for a solution of [`solve`].
    pub fn report(&self) -> Result<Report, Error> {
        let work = self.condensed.work();
        let failure = self.outcome.failure.iter();
        let motions: Vec<_> = failure
            .flat_map(|failure| self.condensed.motions(&failure.apparent))
            .collect();
        Report::new(&ReportParts {
            title: &self.title,
            units: &self.units,
            bodies: &self.bodies,
            pairs: &self.pairs,
            surface: self.condensed.surface(),
            problem: self.condensed.problem(),
            outcome: &self.outcome,
            displacements: &self.displacements,
            motions: &motions,
            balances: &self.balances,
            departure: self.departure,
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

    /// Writes the bodies to `path` and their contact surface beside it, as VTU.
    ///
    /// # Errors
    ///
    /// A file that cannot be written; what stood there before is then left as it was.
    pub fn write_vtu(&self, path: &Path) -> Result<(), Error> {
        let solved = || self.bodies.iter().zip(&self.displacements);
        let stresses: Vec<_> = solved()
            .map(|(body, displacement)| {
                let of_cells = body::cell_stress(body, displacement);
                (body::nodal_stress(body, &of_cells), of_cells)
            })
            .collect();
        let fields: Vec<_> = solved()
            .zip(&stresses)
            .map(
                |((body, displacement), (nodal_stress, cell_stress))| BodyFields {
                    mesh: &body.mesh,
                    displacement,
                    nodal_stress,
                    cell_stress,
                },
            )
            .collect();
        let of_bodies = vtu::body_vtu(&fields)?;
        let facets = &self.condensed.surface().facets;
        let of_contact =
            vtu::contact_vtu(&self.report()?, &self.bodies, facets, &self.displacements)?;
        replace_file(path, &of_bodies)?;
        replace_file(&vtu::contact_path(path), &of_contact)
    }
}
