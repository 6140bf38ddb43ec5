//! REPORT: what the user reads.
//!
//! One [`Report`] holds the answer under stable names; it is written as JSON, as a short
//! text ([`Report::summary`]) and, with the fields of the bodies, as VTU files ([`vtu`]) and as a page to
//! look at in a browser (`Page`, with the feature `cli`).
//! Lengths, forces and pressures are in the units of the scene, whose label is echoed
//! and never converts. A contact force acts on the contact's own body; pressure is positive.
//!
//! The keys of the JSON report:
//!
//! | key | content |
//! |---|---|
//! | `status` | `certified`, `not_converged`, `no_equilibrium`, or `coupling_fault`: the contact problem is solved, but forces, distances or weights of the bodies themselves are off by more than rounding and mesh explain |
//! | `reason`, `advice` | with `not_converged`: sweep limit, stall, cone solver, ill-conditioned, a body out of balance or round-off, and what to do |
//! | `failure` | with `no_equilibrium`: which body moves how, what slides or opens, the force that is missing |
//! | `certificate` | natural-map residual, every law's worst violation and where, bipotential gap; per body the balance of forces and moments |
//! | `step` | of a history: number, instant, values of the tables, ledger of the step and since the start, what halving it changed |
//! | `totals` | counts of open, stick and slip, resultants, contact area, slip area, peak pressure; the same per contact pair, and what its sides exchange |
//! | `rigid_bodies` | of each: motion of the reference point, contact force and moment there, what is given, what is left |
//! | `bolts` | of each: force across its cut, shortening, whether that is held |
//! | `accuracy` | with `--accuracy`: a total extrapolated over a family of meshes, its error, rate and levels |
//! | `found` | of `dpana find`: the parameter, its value, the total there and its derivative |
//! | `sensitivity` | with `--sensitivity`: derivatives of the totals with respect to friction, gaps, loads, supports, obstacles, moduli |
//! | `contacts` | per node: position, normal, state, gap, slip, area, force, pressure, friction traction |
//! | `work`, `history` | factorisations, those in single precision and the corrections they took, or why it was given up; sweeps, cone iterations, Newton steps, seconds per stage, memory per rank; the same sweep by sweep |
//! | `trust` | with `--starts`: the states that other starts led to, the alternation's contraction, whether bodies jump on the way here |
//! | `quality` | oscillation of the contact pressure; with `--quality` the estimated error of the stress, with `--bound` a bound of it |
//! | `size`, `notes` | nodes, cells, contacts; nodes left out of the contact, contact at the rim |

mod accuracy;
mod base64;
mod bolt;
mod certificate;
mod contacts;
mod digits;
mod extremes;
mod failure;
#[cfg(feature = "cli")]
mod figure;
mod file;
mod fit;
mod found;
mod half_space;
#[cfg(feature = "cli")]
mod hard;
mod limit;
#[cfg(feature = "cli")]
mod metamorphic;
mod motion;
mod notes;
#[cfg(feature = "cli")]
mod page;
mod picture;
mod quality;
mod rigid_body;
mod rigid_groups;
mod sensitivity;
mod shortfall;
mod step;
#[cfg(feature = "cli")]
mod study;
#[cfg(feature = "cli")]
mod study_figures;
#[cfg(feature = "cli")]
mod study_page;
mod summary;
mod svg;
mod table;
mod totals;
mod trust;
#[cfg(feature = "cli")]
mod verification;
#[cfg(feature = "cli")]
mod verification_page;
pub mod vtu;
mod work;

use serde::Serialize;

pub use accuracy::{Accuracy, AccuracyLevel};
pub use bolt::ReportedBolt;
pub(crate) use certificate::ReportedDefect;
pub use certificate::{ReportedBalance, ReportedCertificate, ReportedWorst};
pub use contacts::{Contact, ReportedContactState};
pub use extremes::{Largest, ReportedExtremes, SupportForce};
pub use failure::ReportedFailure;
#[cfg(feature = "cli")]
pub use figure::plot;
pub use file::replace_file;
pub use fit::{ReportedMeasure, ReportedPairFit};
pub use found::Found;
pub use half_space::{
    HalfSpaceField, HalfSpaceReport, HalfSpaceStep, half_space_fields, npy, spectrum_table,
};
#[cfg(feature = "cli")]
pub(crate) use hard::{HardCase, HardCases};
pub use limit::{Beyond, Limits, LoadLimit, ReportedElasticLimit, ReportedLeastFriction};
#[cfg(feature = "cli")]
pub use metamorphic::{MetamorphicBattery, MetamorphicChange};
pub use motion::ReportedMotion;
pub(crate) use motion::{motions, names, significant};
#[cfg(feature = "cli")]
pub use page::Page;
#[cfg(feature = "cli")]
pub(crate) use page::PageState;
pub(crate) use picture::Picture;
pub use quality::Quality;
pub use rigid_body::{ReportedRigidBody, RigidParts};
pub use rigid_groups::ReportedRigidGroup;
pub(crate) use sensitivity::{Moved, derivatives};
pub use sensitivity::{ReportedDerivative, Sensitivity};
pub use shortfall::{Reason, ReportedShortfall};
pub(crate) use step::ReportedHalving;
pub use step::{ReportedLedger, ReportedStep};
#[cfg(feature = "cli")]
pub(crate) use study::{KnownTotal, StageSeconds};
#[cfg(feature = "cli")]
pub use study::{Part, StudiedMesh, StudiedRun, Study};
pub use table::{Cell, Table};
pub use totals::{PairTotals, ReportedCoupling, Rounded, Totals};
pub use trust::{Continuity, Trust};
#[cfg(feature = "cli")]
pub(crate) use verification::{Criterion, Rung, Verification, VerifiedQuantity, VerifiedScene};
pub use work::{ReportedRank, ReportedSeconds, ReportedSweep, ReportedWork, StageWork};

use crate::alternation::Outcome;
use crate::body::Body;
use crate::condensation::{PartMotion, RankMemory};
use crate::contact::{ContactPair, ContactSurface};
use crate::error::{Error, check_length};
use crate::problem::ContactProblem;
use crate::{alternation, body, kkt};

/// A solved scene, as it is reported.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Report {
    /// Title of the scene.
    pub title: String,
    /// The scene's label of units; empty where it names none.
    pub units: String,
    /// How the solve ended.
    pub status: ReportedStatus,
    /// Without a certificate: why (`reason`), and what to do (`advice`).
    #[serde(flatten)]
    pub shortfall: Option<ReportedShortfall>,
    /// With `no_equilibrium`: what moves, and what is missing to hold it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<ReportedFailure>,
    /// The load step that led here; absent where the scene has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<ReportedStep>,
    /// Size of the problem.
    pub size: Size,
    /// Every law and the balance of every body, measured.
    pub certificate: ReportedCertificate,
    /// What other starts led to, where they were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trust: Option<Trust>,
    /// Totals over the contact surface, and pair by pair.
    pub totals: Totals,
    /// How wrong a total still is, where that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// The parameter that makes this state what was asked for, where one was looked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub found: Option<Found>,
    /// Derivatives of the totals, where they were asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sensitivity: Vec<Sensitivity>,
    /// What is largest in the bodies.
    pub extremes: ReportedExtremes,
    /// What every support carries.
    pub supports: Vec<SupportForce>,
    /// How every rigid body moved and what acts on it; absent where there is none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rigid_bodies: Vec<ReportedRigidBody>,
    /// What every bolt under preload carries; absent where there is none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bolts: Vec<ReportedBolt>,
    /// How every rigid group has moved, and what holds it; absent where there is none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rigid_groups: Vec<ReportedRigidGroup>,
    /// How far pressure and stress can be trusted by eye.
    pub quality: Quality,
    /// What it took.
    pub work: ReportedWork,
    /// Sweep by sweep.
    pub history: Vec<ReportedSweep>,
    /// What a reader should know besides the numbers.
    pub notes: Vec<String>,
    /// Contact by contact.
    pub contacts: Vec<Contact>,
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ReportedStatus {
    /// The natural-map residual is at most the tolerance.
    Certified,
    /// The best state found, with its residuals.
    NotConverged,
    /// No admissible contact forces hold the bodies.
    NoEquilibrium,
    /// The bodies are not in the state that the contact problem says.
    CouplingFault,
}

impl ReportedStatus {
    /// As JSON and tables spell it.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Certified => "certified",
            Self::NotConverged => "not_converged",
            Self::NoEquilibrium => "no_equilibrium",
            Self::CouplingFault => "coupling_fault",
        }
    }
}

/// Size of the problem.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Size {
    /// Dimension of the bodies, 2 or 3.
    pub dimension: usize,
    /// Nodes of all meshes.
    pub nodes: usize,
    /// Cells of all meshes.
    pub cells: usize,
    /// Contacts.
    pub contacts: usize,
    /// Unknowns of the condensed problem.
    pub contact_unknowns: usize,
    /// Body by body.
    pub bodies: Vec<BodySize>,
}

/// Size of a body.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BodySize {
    /// Name of the body.
    pub name: String,
    /// Nodes of its mesh.
    pub nodes: usize,
    /// Cells of its mesh.
    pub cells: usize,
}

/// What a report is made of.
#[derive(Clone, Debug)]
pub struct ReportParts<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// The scene's label of units; empty where it names none.
    pub units: &'a str,
    /// The bodies, all in 2D or all in 3D.
    pub bodies: &'a [Body],
    /// What may touch what.
    pub pairs: &'a [ContactPair],
    /// Contacts of all pairs.
    pub surface: &'a ContactSurface,
    /// The condensed problem on that surface.
    pub problem: &'a ContactProblem,
    /// The solved problem.
    pub outcome: &'a Outcome,
    /// Recovered displacement per body and unknown (`node · dimension + axis`), in metre.
    pub displacements: &'a [Vec<f64>],
    /// How the free parts of the bodies move where nothing holds them.
    pub motions: &'a [PartMotion],
    /// Equilibrium of each body in that displacement.
    pub balances: &'a [kkt::Balance],
    /// Rigid bodies, their motions and equilibrium.
    pub rigid: RigidParts<'a>,
    /// Its extremes, body by body.
    pub extremes: &'a [body::Extremes],
    /// Force of every support on its body in global axes, body by body, in newton.
    pub support_forces: &'a [Vec<[f64; 3]>],
    /// Motion of every rigid group and what holds it, body by body.
    pub group_states: &'a [Vec<kkt::GroupState>],
    /// How far that displacement is from the condensed problem's at the contacts.
    pub departure: kkt::Worst,
    /// Whether the sides of each pair are in that state; empty where nobody looked.
    pub fits: &'a [kkt::PairFit],
    /// What the stages around the outer loop took.
    pub stages: &'a StageWork,
    /// Memory of every rank for the factors; empty where one process factorises.
    pub ranks: &'a [RankMemory],
    /// Relative displacement of every contact, in global axes, from which its slip counts, in
    /// metre; empty where it counts from the bodies before loading.
    pub origins: &'a [[f64; 3]],
    /// The load step that led here.
    pub step: Option<ReportedStep>,
    /// Notes of other stages; those on the contact surface are added here.
    pub notes: &'a [String],
}

impl Report {
    /// Joins the parts.
    ///
    /// # Errors
    ///
    /// [`Error::Length`], [`Error::UnknownIndex`] or [`Error::WrongDimension`] if the parts do
    /// not belong together, [`Error::Empty`] without a body.
    pub fn new(parts: &ReportParts<'_>) -> Result<Self, Error> {
        check(parts)?;
        let exchanges = kkt::exchange(
            parts.bodies,
            parts.pairs,
            parts.surface,
            parts.problem,
            &parts.outcome.reaction,
        )?;
        let forces = contacts::contact_forces(parts, &parts.outcome.reaction);
        let contacts = contacts::contacts(parts, &forces);
        Ok(Self {
            title: parts.title.to_owned(),
            units: parts.units.to_owned(),
            status: parts.outcome.status.into(),
            shortfall: ReportedShortfall::of(parts),
            failure: ReportedFailure::new(parts),
            step: parts.step.clone(),
            size: Size::new(parts),
            certificate: ReportedCertificate::new(parts),
            trust: None,
            totals: Totals::new(parts, &exchanges, &forces),
            accuracy: None,
            found: None,
            sensitivity: Vec::new(),
            extremes: ReportedExtremes::new(parts),
            supports: extremes::support_forces(parts),
            rigid_bodies: ReportedRigidBody::all(&parts.rigid, parts.dimension()),
            bolts: ReportedBolt::all(&parts.rigid),
            rigid_groups: rigid_groups::rigid_groups(parts),
            quality: Quality::new(parts, &contacts),
            work: ReportedWork::new(parts),
            history: parts
                .outcome
                .history
                .iter()
                .map(ReportedSweep::from)
                .collect(),
            notes: notes::notes(parts),
            contacts,
        })
    }

    /// The report as indented JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Plain structs with string keys: there is nothing that could fail to serialise.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// The report as a short text for a person.
    #[must_use]
    pub fn summary(&self) -> String {
        summary::summary(self)
    }
}

impl From<alternation::Status> for ReportedStatus {
    fn from(status: alternation::Status) -> Self {
        match status {
            alternation::Status::Certified => Self::Certified,
            alternation::Status::NotConverged => Self::NotConverged,
            alternation::Status::NoEquilibrium => Self::NoEquilibrium,
            alternation::Status::CouplingFault => Self::CouplingFault,
        }
    }
}

impl Size {
    fn new(parts: &ReportParts<'_>) -> Self {
        let bodies = parts.bodies.iter().map(|body| BodySize {
            name: body.name.clone(),
            nodes: body.mesh.nodes.len(),
            cells: body.mesh.cell_count(),
        });
        let bodies: Vec<BodySize> = bodies.collect();
        Self {
            dimension: parts.dimension(),
            nodes: bodies.iter().map(|body| body.nodes).sum(),
            cells: bodies.iter().map(|body| body.cells).sum(),
            contacts: parts.problem.contacts(),
            contact_unknowns: parts.problem.unknowns(),
            bodies,
        }
    }
}

impl ReportParts<'_> {
    /// Dimension of the bodies; they have the same.
    pub(crate) fn dimension(&self) -> usize {
        self.bodies.first().map_or(0, |body| body.mesh.dimension)
    }
}

/// Refuses parts of different sizes; that contacts stand at nodes is checked by the judge.
fn check(parts: &ReportParts<'_>) -> Result<(), Error> {
    let (count, verdict) = (parts.bodies.len(), &parts.outcome.verdict);
    if count == 0 {
        let place = "bodies".to_owned();
        return Err(Error::Empty { place });
    }
    check_length("displacements", count, parts.displacements.len())?;
    check_length("balances", count, parts.balances.len())?;
    check_length("extremes", count, parts.extremes.len())?;
    check_length("support_forces", count, parts.support_forces.len())?;
    for (index, (body, displacement)) in parts.bodies.iter().zip(parts.displacements).enumerate() {
        let (dimension, nodes) = (body.mesh.dimension, body.mesh.nodes.len());
        if dimension != parts.dimension() {
            return Err(Error::WrongDimension {
                place: format!("bodies[{index}]"),
                expected: parts.dimension(),
                found: dimension,
            });
        }
        let place = format!("displacements[{index}]");
        check_length(&place, nodes * dimension, displacement.len())?;
    }
    let (contacts, unknowns) = (parts.problem.contacts(), parts.problem.unknowns());
    check_length("contact nodes", contacts, parts.surface.nodes.len())?;
    if !parts.origins.is_empty() {
        check_length("origins", contacts, parts.origins.len())?;
    }
    check_length("status", contacts, verdict.status.len())?;
    check_length("reaction", unknowns, parts.outcome.reaction.len())?;
    check_length("contact displacement", unknowns, verdict.displacement.len())
}
