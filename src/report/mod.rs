//! REPORT: what the user reads.
//!
//! One [`Report`] holds the answer under stable names; it is written as JSON, as a short
//! text ([`Report::summary`]) and, with the fields of the body, as VTU files ([`vtu`]).
//! Lengths, forces and pressures are in the units of the scene, whose label is echoed
//! and never converts. A contact force acts on the body; pressure is positive.

mod certificate;
mod contacts;
mod file;
mod notes;
mod summary;
mod totals;
pub mod vtu;
mod work;

use serde::Serialize;

pub use certificate::{Balance, Certificate, Defect, Resultant, Worst, WorstNode};
pub use contacts::{Contact, ContactState};
pub use file::replace_file;
pub use totals::Totals;
pub use work::{Seconds, StageWork, Sweep, Work};

use crate::body::Body;
use crate::condensation::{ContactProblem, ContactSurface};
use crate::dpana::{self, Outcome};
use crate::error::{Error, check_length};
use crate::kkt;

/// A solved scene, as it is reported.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Title of the scene.
    pub title: String,
    /// The scene's label of units; empty where it names none.
    pub units: String,
    /// How the solve ended.
    pub status: Status,
    /// Size of the problem.
    pub size: Size,
    /// Every law and the balance, measured.
    pub certificate: Certificate,
    /// Totals over the contact surface.
    pub totals: Totals,
    /// What it took.
    pub work: Work,
    /// Sweep by sweep.
    pub history: Vec<Sweep>,
    /// What a reader should know besides the numbers.
    pub notes: Vec<String>,
    /// Contact by contact.
    pub contacts: Vec<Contact>,
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The natural-map residual is at most the tolerance.
    Certified,
    /// The best state found, with its residuals.
    NotConverged,
    /// No admissible contact forces hold the body.
    NoEquilibrium,
}

/// Size of the problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Size {
    /// Dimension of the body, 2 or 3.
    pub dimension: usize,
    /// Nodes of the mesh.
    pub nodes: usize,
    /// Cells of the mesh.
    pub cells: usize,
    /// Contacts.
    pub contacts: usize,
    /// Unknowns of the condensed problem.
    pub contact_unknowns: usize,
}

/// What a report is made of.
#[derive(Clone, Copy, Debug)]
pub struct ReportParts<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// The scene's label of units; empty where it names none.
    pub units: &'a str,
    /// The body.
    pub body: &'a Body,
    /// Its contact surface.
    pub surface: &'a ContactSurface,
    /// The condensed problem on that surface.
    pub problem: &'a ContactProblem,
    /// The solved problem.
    pub outcome: &'a Outcome,
    /// Recovered displacement per unknown of the body (`node · dimension + axis`), in metre.
    pub displacement: &'a [f64],
    /// Equilibrium of the body in that displacement.
    pub balance: &'a kkt::Balance,
    /// What the stages around the outer loop took.
    pub stages: &'a StageWork,
    /// Notes of other stages; those on the contact surface are added here.
    pub notes: &'a [String],
}

impl Report {
    /// Joins the parts.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] or [`Error::OutOfRange`] if the parts do not belong together.
    pub fn new(parts: &ReportParts<'_>) -> Result<Self, Error> {
        check(parts)?;
        let (mesh, outcome) = (&parts.body.mesh, parts.outcome);
        let measured = &outcome.verdict.certificate;
        Ok(Self {
            title: parts.title.to_owned(),
            units: parts.units.to_owned(),
            status: outcome.status.into(),
            size: Size {
                dimension: mesh.dimension,
                nodes: mesh.nodes.len(),
                cells: mesh.cell_count(),
                contacts: parts.problem.contacts(),
                contact_unknowns: parts.problem.unknowns(),
            },
            certificate: Certificate::new(measured, parts.balance, mesh.dimension),
            totals: Totals::new(parts),
            work: Work::new(parts),
            history: outcome.history.iter().map(Sweep::from).collect(),
            notes: notes::notes(parts),
            contacts: contacts::contacts(parts),
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

impl From<dpana::Status> for Status {
    fn from(status: dpana::Status) -> Self {
        match status {
            dpana::Status::Certified => Self::Certified,
            dpana::Status::NotConverged => Self::NotConverged,
            dpana::Status::NoEquilibrium => Self::NoEquilibrium,
        }
    }
}

fn check(parts: &ReportParts<'_>) -> Result<(), Error> {
    let (mesh, verdict) = (&parts.body.mesh, &parts.outcome.verdict);
    let (contacts, unknowns) = (parts.problem.contacts(), parts.problem.unknowns());
    check_length("contact nodes", contacts, parts.surface.nodes.len())?;
    check_length("status", contacts, verdict.status.len())?;
    check_length("reaction", unknowns, parts.outcome.reaction.len())?;
    check_length("contact displacement", unknowns, verdict.displacement.len())?;
    check_length(
        "displacement",
        mesh.nodes.len() * mesh.dimension,
        parts.displacement.len(),
    )?;
    let stray = parts
        .surface
        .nodes
        .iter()
        .position(|contact| contact.node >= mesh.nodes.len());
    match stray {
        None => Ok(()),
        Some(contact) => Err(Error::OutOfRange {
            place: format!("contact nodes[{contact}]"),
            value: parts.surface.nodes[contact].node as f64,
            accepted: "a node of the mesh",
        }),
    }
}
