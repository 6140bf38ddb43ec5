//! A solved scene as one page of HTML to look at in a browser, which loads nothing else.
//!
//! The page is a viewer (`page.html`, `page.css` and the scripts beside them, as they are written there),
//! then one element with what stays, then one per state. Their text is JSON in which arrays are base64 of
//! little-endian numbers of 32 bits. Nothing has to be closed behind them (HTML leaves `</body>` to the
//! reader), so a load history appends a state per step, and the page is whole after each.
//!
//! | element | what it holds |
//! |---|---|
//! | `<script class="scene">` | title, units, axes; skins of the bodies; where the contacts are; obstacles |
//! | `<script class="state">` | displacement and stress at the drawn points, fields of the contacts, tables |
//!
//! A solid body is drawn by its surface, a plane one by its cells.

mod arc;
mod lattice;
mod obstacle;
mod packed;
mod points;
mod skin;
mod state;
mod surface;
mod units;
mod words;

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;

use self::obstacle::DrawnObstacle;
use self::skin::{DrawnBody, Skin};
use self::state::DrawnState;
use self::surface::{DrawnContacts, DrawnSurface};
use self::units::Symbols;
use super::svg::escaped;
use super::{Report, replace_file};
use crate::body::{Body, Facet, Model};
use crate::contact::{ContactPair, Opposite, RigidMotion};
use crate::error::{Error, check_length};

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");

/// The viewer, in the order in which its parts need each other.
const SCRIPTS: [&str; 11] = [
    include_str!("colour.js"),
    include_str!("data.js"),
    include_str!("fields.js"),
    include_str!("camera.js"),
    include_str!("layers.js"),
    include_str!("webgl.js"),
    include_str!("raster.js"),
    include_str!("chart.js"),
    include_str!("viewer.js"),
    include_str!("controls.js"),
    include_str!("tables.js"),
];

/// A page in a file, state after state.
#[derive(Debug)]
pub struct Page {
    path: PathBuf,
    /// Of every body, once there is a state.
    skins: Vec<Skin>,
}

/// What a page shows of a state; all arrays per body are in the order of the report.
#[derive(Debug)]
pub(crate) struct PageState<'a> {
    /// The solved state.
    pub(crate) report: &'a Report,
    /// The bodies.
    pub(crate) bodies: &'a [Body],
    /// Displacement per body and unknown (`node · dimension + axis`), in metre.
    pub(crate) displacements: &'a [Vec<f64>],
    /// Stress per body and node, xx, yy, zz, yz, xz, xy, in pascal.
    pub(crate) stresses: &'a [Vec<[f64; 6]>],
    /// Facets of the contact surface, with the index of their body.
    pub(crate) facets: &'a [(usize, Facet)],
    /// What may touch what.
    pub(crate) pairs: &'a [ContactPair],
    /// Motion of the obstacle per pair; missing ones stand still.
    pub(crate) obstacles: &'a [RigidMotion],
    /// Coefficient of friction, and gap before loading in metre, per contact.
    pub(crate) friction: &'a [f64],
    /// See `friction`.
    pub(crate) initial_gap: &'a [f64],
}

/// What stays from state to state.
#[derive(Debug, Serialize)]
struct DrawnScene<'a> {
    title: &'a str,
    units: &'a str,
    symbols: Symbols,
    dimension: usize,
    /// Names of the axes.
    axes: [&'static str; 3],
    /// What all positions are relative to, in metre.
    origin: [f64; 3],
    bodies: Vec<DrawnBody<'a>>,
    contacts: DrawnContacts,
    surface: DrawnSurface,
    pairs: Vec<DrawnPair<'a>>,
}

#[derive(Debug, Serialize)]
struct DrawnPair<'a> {
    place: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    obstacle: Option<DrawnObstacle>,
}

impl Page {
    /// A page that its first state will write.
    #[must_use]
    pub fn new(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            skins: Vec::new(),
        }
    }

    /// Writes the page with its first state, or appends the next one.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] if the arrays are not of the bodies, [`Error::Write`] with what the system says.
    pub(crate) fn add(&mut self, parts: &PageState<'_>) -> Result<(), Error> {
        check(parts)?;
        if !self.skins.is_empty() {
            check_length("bodies", self.skins.len(), parts.bodies.len())?;
            for (skin, body) in self.skins.iter().zip(parts.bodies) {
                let place = format!("{}: nodes", body.name);
                check_length(&place, skin.nodes, body.mesh.nodes.len())?;
            }
            let state = element(
                "state",
                &DrawnState::new(parts, &self.skins, middle(parts.bodies)),
            );
            return self.append(&state);
        }
        let mut skins: Vec<Skin> = parts.bodies.iter().map(Skin::new).collect();
        let scene = element("scene", &DrawnScene::new(parts, &mut skins));
        let state = element(
            "state",
            &DrawnState::new(parts, &skins, middle(parts.bodies)),
        );
        let viewer = viewer(&parts.report.title);
        replace_file(&self.path, &[viewer, scene, state].concat())?;
        self.skins = skins;
        Ok(())
    }

    fn append(&self, text: &str) -> Result<(), Error> {
        let file = OpenOptions::new().append(true).open(&self.path);
        let written = file.and_then(|mut file| file.write_all(text.as_bytes()));
        written.map_err(|reason| Error::Write {
            path: self.path.display().to_string(),
            reason: reason.to_string(),
        })
    }
}

fn check(parts: &PageState<'_>) -> Result<(), Error> {
    let bodies = parts.bodies.len();
    check_length("displacements", bodies, parts.displacements.len())?;
    check_length("stresses", bodies, parts.stresses.len())?;
    for (body, (displacement, stress)) in parts
        .bodies
        .iter()
        .zip(parts.displacements.iter().zip(parts.stresses))
    {
        let (nodes, name) = (body.mesh.nodes.len(), &body.name);
        let unknowns = nodes * body.mesh.dimension;
        check_length(
            &format!("{name}: displacement"),
            unknowns,
            displacement.len(),
        )?;
        check_length(&format!("{name}: stress"), nodes, stress.len())?;
    }
    let contacts = parts.report.contacts.len();
    check_length("friction", contacts, parts.friction.len())?;
    check_length("initial_gap", contacts, parts.initial_gap.len())
}

/// The page before its data.
fn viewer(title: &str) -> String {
    let title = match title {
        "" => "A contact problem",
        title => title,
    };
    // The title last: what it holds is not filled in again.
    let page = PAGE.replace("{{style}}", STYLE);
    let page = page.replace("{{script}}", &SCRIPTS.join("\n"));
    page.replace("{{title}}", &escaped(title))
}

/// An element that holds a value as JSON, in which nothing ends the element.
fn element(class: &str, value: &impl Serialize) -> String {
    // Plain structs with string keys: there is nothing that could fail to serialise.
    let text = serde_json::to_string(value).unwrap_or_default();
    let text = text.replace('<', "\\u003c");
    format!("<script type=\"application/json\" class=\"{class}\">{text}</script>\n")
}

impl<'a> DrawnScene<'a> {
    fn new(parts: &PageState<'a>, skins: &mut [Skin]) -> Self {
        let report = parts.report;
        let origin = middle(parts.bodies);
        let dimension = report.size.dimension;
        let reach = 2.0 * farthest(parts.bodies, origin);
        let surface = DrawnSurface::new(&report.contacts, skins, parts.facets, dimension);
        let rings = parts
            .bodies
            .iter()
            .all(|body| body.model == Model::Axisymmetric);
        let bodies = parts.bodies.iter().zip(&*skins);
        let pairs = parts.pairs.iter().map(|pair| DrawnPair {
            place: &pair.place,
            obstacle: match &pair.opposite {
                Opposite::Obstacle(obstacle) => {
                    Some(DrawnObstacle::new(obstacle, (dimension, origin, reach)))
                }
                Opposite::Surface { .. } => None,
            },
        });
        Self {
            title: &report.title,
            units: &report.units,
            symbols: Symbols::of(&report.units),
            dimension,
            axes: if rings {
                ["r", "z", "θ"]
            } else {
                ["x", "y", "z"]
            },
            origin,
            bodies: bodies
                .map(|(body, skin)| skin.drawn(body, origin))
                .collect(),
            contacts: DrawnContacts::new(&report.contacts, parts.bodies, parts.facets, origin),
            surface,
            pairs: pairs.collect(),
        }
    }
}

/// Distance of the farthest node from a point, in metre.
fn farthest(bodies: &[Body], from: [f64; 3]) -> f64 {
    let nodes = bodies.iter().flat_map(|body| &body.mesh.nodes);
    let away = nodes.map(|x| (0..3).fold(0.0, |size, axis| f64::hypot(size, x[axis] - from[axis])));
    away.fold(0.0, f64::max)
}

/// Middle of the box around all nodes, in metre: positions far from zero keep their digits.
fn middle(bodies: &[Body]) -> [f64; 3] {
    let nodes = || bodies.iter().flat_map(|body| &body.mesh.nodes);
    [0, 1, 2].map(|axis| {
        let low = nodes().map(|node| node[axis]).fold(f64::INFINITY, f64::min);
        let high = nodes()
            .map(|node| node[axis])
            .fold(f64::NEG_INFINITY, f64::max);
        0.5 * (low + high)
    })
}
