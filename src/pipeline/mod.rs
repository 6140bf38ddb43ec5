//! The pipeline: scene → mechanics → condensation → outer loop → recovery → judge; a load history
//! goes round the last three.

mod accuracy;
mod cases;
mod check;
mod corrected;
mod error_bound;
mod find;
mod half_space;
mod half_space_cases;
mod halving;
mod limit;
mod measured;
mod quantities;
mod sensitivity;
mod steps;
mod substep;
mod total;

use std::path::Path;
use std::sync::{Arc, OnceLock};
use std::time::Instant;

use crate::alternation;
use crate::alternation::{Outcome, Settings, Status};
use crate::body::{Body, Extremes};
use crate::condensation::{Condensed, Driven, Engine};
use crate::contact::{ContactPair, Opposite, RigidBody, RigidMotion};
use crate::error::Error;
use crate::kkt::{PairFit, SceneGeometry};
#[cfg(feature = "cli")]
use crate::report;
use crate::report::vtu::BodyFields;
use crate::report::{
    Continuity, Picture, Report, ReportParts, RigidParts, StageWork, Trust, replace_file, vtu,
};
use crate::scene::{Mechanics, Scene};
use crate::stage::Stage;
use crate::{body, kkt, trust, validity};

pub use accuracy::{Request, solve_within};
pub use cases::{cases, cases_watched};
pub use check::{Checked, check};
pub use find::{Search, find};
pub use half_space::solve_half_space;
pub use half_space_cases::half_space_cases;
pub(crate) use halving::Halving;
pub use limit::{limit, rigid_limit};
pub use measured::{Acting, Measured};
pub use quantities::Variation;
pub use steps::{SolvedStep, solve_steps};

/// Solves a scene; one with load steps to its end, or to the first state that is not certified.
///
/// # Errors
///
/// Whatever is wrong with the scene. A solve that does not converge is no error:
/// see [`Solution::status`].
pub fn solve(scene: &Scene) -> Result<Solution, Error> {
    solve_steps(scene, None, |_| Ok(()))
}

/// What stays from state to state, and what acts on the bodies; copies share all that is large.
#[derive(Clone, Debug)]
struct Setup {
    title: String,
    units: String,
    /// Under the factors of heat and initial stress.
    bodies: Arc<[Body]>,
    /// The same at factors of one.
    stated: Arc<[Body]>,
    pairs: Arc<[ContactPair]>,
    settings: Settings,
    notes: Vec<String>,
    condensed: Condensed,
    geometry: Arc<SceneGeometry>,
    acting: Acting,
}

impl Setup {
    /// Bodies in double precision, for problems that are solved again and again.
    fn new(scene: &Scene, mechanics: Mechanics) -> Result<Self, Error> {
        let engine = scene.settings.engine;
        Self::with(scene, mechanics, |bodies, pairs, rigid| {
            Condensed::with_engine(engine, bodies, pairs, rigid)
        })
    }

    /// Bodies for the one state of a scene without history, in single precision where that does (C32).
    fn of_one_state(scene: &Scene, mechanics: Mechanics) -> Result<Self, Error> {
        match scene.settings.engine {
            Engine::Faer => Self::with(scene, mechanics, Condensed::rounded),
            Engine::Mumps => Self::new(scene, mechanics),
        }
    }

    fn with(
        scene: &Scene,
        mechanics: Mechanics,
        condense: impl FnOnce(&[Body], &[ContactPair], &[RigidBody]) -> Result<Condensed, Error>,
    ) -> Result<Self, Error> {
        let Mechanics {
            bodies,
            contacts: pairs,
            rigid_bodies,
            settings,
            notes,
            ..
        } = mechanics;
        let condensed = condense(&bodies, &pairs, &rigid_bodies)?;
        let geometry = SceneGeometry::new(&bodies, &pairs, condensed.surface())?;
        let acting = Acting {
            openings: pairs.iter().map(|pair| pair.gap).collect(),
            ..Acting::default()
        };
        let bodies: Arc<[Body]> = bodies.into();
        Ok(Self {
            title: scene.title.clone(),
            units: scene.units.clone(),
            stated: Arc::clone(&bodies),
            bodies,
            pairs: pairs.into(),
            settings,
            notes,
            condensed,
            geometry: Arc::new(geometry),
            acting,
        })
    }

    /// Solves the one state of a scene without history.
    fn solve(mut self) -> Result<Solution, Error> {
        let mut spent = 0.0;
        if self.condensed.is_rounded() {
            let solved = self.solve_rounded(&mut spent)?;
            match solved {
                Ok((outcome, displacements)) => {
                    let mut solution = self.measure(outcome, displacements)?;
                    solution.recovery_seconds += spent;
                    return Ok(solution);
                }
                Err(sign) => {
                    self.condensed = self.condensed.in_double(&self.bodies, &self.pairs, sign)?;
                }
            }
        }
        let outcome = alternation::solve(self.condensed.problem(), &self.settings)?;
        let mut solution = self.recover(outcome)?;
        solution.recovery_seconds += spent;
        Ok(solution)
    }

    /// Recovers the bodies of a solved problem, and measures them.
    fn recover(mut self, outcome: Outcome) -> Result<Solution, Error> {
        Stage::Recovery.begin();
        let start = Instant::now();
        let (outcome, displacements) = self.displacements(outcome)?;
        let seconds = start.elapsed().as_secs_f64();
        let mut solution = self.measure(outcome, displacements)?;
        solution.recovery_seconds += seconds;
        Ok(solution)
    }

    /// Measures recovered bodies; a state that they are not in has no certificate.
    fn measure(
        self,
        mut outcome: Outcome,
        displacements: Vec<Vec<f64>>,
    ) -> Result<Solution, Error> {
        let start = Instant::now();
        let measured = Measured::new(
            &self.bodies,
            &self.condensed,
            &self.geometry,
            &self.acting,
            (&outcome, &displacements),
        )?;
        (outcome.status, outcome.shortfall) = measured.status(&outcome);
        let recovery_seconds = start.elapsed().as_secs_f64();
        Ok(Solution {
            setup: self,
            outcome,
            displacements,
            measured,
            recovery_seconds,
            step: None,
            extremes: OnceLock::new(),
            precise: OnceLock::new(),
        })
    }

    /// Puts heat and initial stress under factors, as the stress of the bodies knows them; nothing is done
    /// where no driven load has any.
    fn stress_under(&mut self, driven: &[Driven], factors: &[f64]) {
        let acting = driven.iter().zip(factors).filter_map(|(driven, factor)| {
            let Driven::Load { body, index } = *driven else {
                return None;
            };
            let load = self.stated.get(body)?.loads.get(index)?;
            load.stresses().then(|| (body, index, load.scaled(*factor)))
        });
        let acting: Vec<_> = acting.collect();
        if acting.is_empty() {
            return;
        }
        let mut bodies = self.stated.to_vec();
        for (body, index, load) in acting {
            bodies[body].loads[index] = load;
        }
        self.bodies = bodies.into();
    }

    fn body_states<'a>(
        &'a self,
        reaction: &'a [f64],
        displacements: &'a [Vec<f64>],
    ) -> Vec<kkt::BodyState<'a>> {
        kkt::BodyState::of_bodies(&self.bodies, &self.condensed, reaction, displacements)
    }
}

/// A solved scene; copies share what is large.
#[derive(Clone, Debug)]
pub struct Solution {
    setup: Setup,
    outcome: Outcome,
    displacements: Vec<Vec<f64>>,
    measured: Measured,
    recovery_seconds: f64,
    step: Option<SolvedStep>,
    /// Of every body, once somebody asks.
    extremes: OnceLock<Vec<Extremes>>,
    /// The bodies in double precision, where they are not and somebody asks.
    precise: OnceLock<Condensed>,
}

/// Stress of a body in pascal, in the order xx, yy, zz, yz, xz, xy; z is the direction around the
/// axis of axisymmetric bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyStress {
    /// At the centre of each cell.
    pub cells: Vec<[f64; 6]>,
    /// At each node: the mean of the cells around it, weighted by their volume.
    pub nodes: Vec<[f64; 6]>,
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
        &self.setup.bodies
    }

    /// The bodies, condensed onto their contact surface.
    #[must_use]
    pub fn condensed(&self) -> &Condensed {
        &self.setup.condensed
    }

    /// The same under any reactions, not only those of this state: in double precision, factorised again where they
    /// were solved for with a factor in single precision.
    ///
    /// # Errors
    ///
    /// A factor that is larger than the memory.
    pub fn precise(&self) -> Result<&Condensed, Error> {
        let Setup {
            bodies,
            pairs,
            condensed,
            ..
        } = &self.setup;
        if !condensed.is_rounded() {
            return Ok(condensed);
        }
        if let Some(known) = self.precise.get() {
            return Ok(known);
        }
        let precise = condensed.clone().in_double(bodies, pairs, None)?;
        Ok(self.precise.get_or_init(|| precise))
    }

    /// The bodies in double precision if they were asked for, else as they were solved for.
    fn most_precise(&self) -> &Condensed {
        self.precise.get().unwrap_or(&self.setup.condensed)
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
            self.setup.bodies.get(body).map(|body| &body.mesh),
            self.displacements.get(body),
        ) else {
            return Err(Error::UnknownIndex {
                place: "displacement".to_owned(),
                what: "body",
                index: body,
                count: self.setup.bodies.len(),
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

    /// Elastic energy `½ uᵀ K u` of all bodies and of the springs that hold them, in joule.
    #[must_use]
    pub fn elastic_energy(&self) -> f64 {
        let bodies = self.setup.condensed.bodies().iter();
        let energies = bodies.zip(&self.displacements).map(|(body, u)| {
            let entries = body.stiffness().iter();
            entries
                .map(|(k, (row, column))| 0.5 * u[row] * k * u[column])
                .sum::<f64>()
        });
        energies.sum()
    }

    /// Equilibrium of each whole body, measured by the judge.
    #[must_use]
    pub fn balances(&self) -> &[kkt::Balance] {
        &self.measured.balances
    }

    /// Whether the sides of each contact pair are in the state that is reported, measured by the judge.
    #[must_use]
    pub fn fits(&self) -> &[PairFit] {
        &self.measured.fits
    }

    /// The answer under stable names.
    ///
    /// # Errors
    ///
    /// None for a solution of [`solve`].
    pub fn report(&self) -> Result<Report, Error> {
        self.with_parts(|parts| {
            let halving = self.step.as_ref().and_then(SolvedStep::halving);
            let halving: Vec<String> = halving.and_then(Halving::note).into_iter().collect();
            let doubts = validity::notes(parts);
            Report::new(&ReportParts {
                notes: &[self.setup.notes.as_slice(), &halving, &doubts].concat(),
                ..parts.clone()
            })
        })
    }

    /// What a report is made of, without notes.
    fn with_parts<T>(
        &self,
        make: impl FnOnce(&ReportParts<'_>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let condensed = &self.setup.condensed;
        let work = condensed.work();
        let failure = self.outcome.failure.iter();
        let motions: Vec<_> = failure
            .flat_map(|failure| self.setup.condensed.motions(&failure.apparent))
            .collect();
        let states = self
            .setup
            .body_states(&self.outcome.reaction, &self.displacements);
        let support_forces = states.iter().map(kkt::support_forces);
        let support_forces: Vec<_> = support_forces.collect::<Result<_, _>>()?;
        let motion = &self.outcome.motion;
        let rigid_motions = condensed.rigid_motions(motion);
        let obstacles = &self.setup.acting.obstacles;
        let still = condensed.rigid_bodies().is_empty()
            && obstacles.iter().all(|motion| *motion == [0.0; 3]);
        let sides = match still {
            true => Vec::new(),
            false => condensed.other_sides(obstacles, motion),
        };
        let group_states: Vec<_> = states.iter().map(kkt::group_states).collect();
        make(&ReportParts {
            title: &self.setup.title,
            units: &self.setup.units,
            bodies: &self.setup.bodies,
            pairs: &self.setup.pairs,
            surface: self.setup.condensed.surface(),
            problem: self.setup.condensed.problem(),
            outcome: &self.outcome,
            displacements: &self.displacements,
            motions: &motions,
            balances: &self.measured.balances,
            rigid: RigidParts {
                bodies: condensed.rigid_bodies(),
                motions: &rigid_motions,
                balances: &self.measured.rigid,
            },
            extremes: self.extremes(),
            support_forces: &support_forces,
            group_states: &group_states,
            departure: self.measured.departure,
            fits: &self.measured.fits,
            stages: &StageWork {
                factorisations: work.factorisations,
                single_factors: work.single_factors,
                corrections: work.corrections,
                fallback: work.fallback,
                assembly: work.assembly_seconds,
                ordering: work.ordering_seconds,
                factorisation: work.factorisation_seconds,
                condensation: work.condensation_seconds,
                recovery: self.recovery_seconds,
            },
            ranks: &condensed.ranks(),
            origins: self.step.as_ref().map_or(&sides, |step| step.origins()),
            step: self.step.as_ref().map(|step| step.record()),
            notes: &[],
        })
    }

    /// The largest displacement, stress, strain and rotation of every body.
    #[must_use]
    pub fn extremes(&self) -> &[Extremes] {
        self.extremes.get_or_init(|| {
            let solved = self.setup.bodies.iter().zip(&self.displacements);
            solved.map(|(body, u)| body::extremes(body, u)).collect()
        })
    }

    /// Stress of every body, in the order of the scene.
    #[must_use]
    pub fn stresses(&self) -> Vec<BodyStress> {
        let solved = self.setup.bodies.iter().zip(&self.displacements);
        solved
            .map(|(body, displacement)| {
                let cells = body::cell_stress(body, displacement);
                BodyStress {
                    nodes: body::nodal_stress(body, displacement, &cells),
                    cells,
                }
            })
            .collect()
    }

    /// Solves the contacts of a certified solution again from this many other starts, estimates how
    /// much friction the alternation takes, and tells whether bodies jump on the way here; none for a
    /// solution without certificate.
    ///
    /// # Errors
    ///
    /// None for a solution of [`solve`].
    pub fn trust(&self, starts: usize) -> Result<Option<Trust>, Error> {
        let Some(continuity) = self.continuity()? else {
            return Ok(None);
        };
        let problem = self.precise()?.problem();
        let settings = &self.setup.settings;
        let others = trust::other_starts(problem, settings, &self.outcome, starts)?;
        let contraction = trust::contraction(problem, &self.outcome);
        let normals = problem.normals();
        Ok(Some(Trust::new(contraction, continuity, &others, normals)))
    }

    /// Whether a path of states leads here from the one before, or from rest where there is none, loads
    /// changing in proportion; none for a solution without certificate.
    ///
    /// # Errors
    ///
    /// None for a solution of [`solve`].
    pub fn continuity(&self) -> Result<Option<Continuity>, Error> {
        if self.status() != Status::Certified {
            return Ok(None);
        }
        let problem = self.precise()?.problem();
        let start = match &self.step {
            None => &trust::Earlier::rest(problem),
            Some(step) => step.start(),
        };
        let way_back = trust::way_back(problem, &self.setup.settings, &self.outcome, start)?;
        Ok(Some(way_back.into()))
    }

    /// The load step that led here; none where the scene has no steps.
    #[must_use]
    pub fn step(&self) -> Option<&SolvedStep> {
        self.step.as_ref()
    }

    /// The deformed bodies and the contact pressure as a drawing in SVG.
    ///
    /// # Errors
    ///
    /// [`Error::NotAccepted`] for bodies in 3D.
    pub fn to_svg(&self) -> Result<String, Error> {
        let motions = self.pair_motions();
        let obstacle = |(at, pair): (usize, &ContactPair)| match &pair.opposite {
            Opposite::Obstacle(obstacle) => Some((
                obstacle.clone(),
                motions.get(at).copied().unwrap_or_default(),
            )),
            Opposite::Surface { .. } => None,
        };
        let obstacles: Vec<_> = self
            .setup
            .pairs
            .iter()
            .enumerate()
            .filter_map(obstacle)
            .collect();
        Picture {
            report: &self.report()?,
            bodies: &self.setup.bodies,
            displacements: &self.displacements,
            facets: &self.setup.condensed.surface().facets,
            obstacles: &obstacles,
        }
        .to_svg()
    }

    /// Adds the state to a page to look at in a browser.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    #[cfg(feature = "cli")]
    pub fn add_to_page(&self, page: &mut report::Page) -> Result<(), Error> {
        let problem = self.setup.condensed.problem();
        page.add(&report::PageState {
            report: &self.report()?,
            bodies: &self.setup.bodies,
            displacements: &self.displacements,
            stresses: &self.nodal_stresses(),
            facets: &self.setup.condensed.surface().facets,
            pairs: &self.setup.pairs,
            obstacles: &self.pair_motions(),
            friction: problem.friction(),
            initial_gap: problem.initial_gap(),
        })
    }

    /// Motion of the obstacle per pair.
    fn pair_motions(&self) -> Vec<RigidMotion> {
        let (condensed, acting) = (&self.setup.condensed, &self.setup.acting);
        condensed.pair_motions(&acting.obstacles, &self.outcome.motion)
    }

    /// Stress per body and node, xx, yy, zz, yz, xz, xy, in pascal.
    #[cfg(feature = "cli")]
    fn nodal_stresses(&self) -> Vec<Vec<[f64; 6]>> {
        let solved = self.setup.bodies.iter().zip(&self.displacements);
        let stresses = solved.map(|(body, displacement)| {
            let of_cells = body::cell_stress(body, displacement);
            body::nodal_stress(body, displacement, &of_cells)
        });
        stresses.collect()
    }

    /// Writes the bodies to `path` and their contact surface beside it, as VTU.
    ///
    /// # Errors
    ///
    /// A file that cannot be written; what stood there before is then left as it was.
    pub fn write_vtu(&self, path: &Path) -> Result<(), Error> {
        let [of_bodies, of_contact] = self.to_vtu()?;
        replace_file(path, &of_bodies)?;
        replace_file(&vtu::contact_path(path), &of_contact)
    }

    /// The bodies and their contact surface as VTU documents, with the arrays that
    /// [`vtu`] lists.
    ///
    /// # Errors
    ///
    /// None for a solution of [`solve`].
    pub fn to_vtu(&self) -> Result<[String; 2], Error> {
        let (bodies, moved) = (&self.setup.bodies, &self.displacements);
        let solved = || bodies.iter().zip(moved);
        let stresses = self.stresses();
        let strains: Vec<_> = solved()
            .map(|(body, u)| body::cell_strain(body, u))
            .collect();
        let states = self.setup.body_states(&self.outcome.reaction, moved);
        let forces = states.iter().map(kkt::nodal_forces);
        let forces: Vec<_> = forces.collect::<Result<_, _>>()?;
        let fields: Vec<_> = solved()
            .enumerate()
            .map(|(at, (body, displacement))| BodyFields {
                mesh: &body.mesh,
                displacement,
                nodal_stress: &stresses[at].nodes,
                cell_stress: &stresses[at].cells,
                cell_strain: &strains[at],
                contact_force: &forces[at][0],
                support_force: &forces[at][1],
            })
            .collect();
        let of_bodies = vtu::body_vtu(&fields)?;
        let facets = &self.setup.condensed.surface().facets;
        let of_contact = vtu::contact_vtu(
            &self.report()?,
            &self.setup.bodies,
            facets,
            &self.displacements,
        )?;
        Ok([of_bodies, of_contact])
    }
}
