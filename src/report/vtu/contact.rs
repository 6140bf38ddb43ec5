//! The contact surface: pressure, friction, gap, slip, state.

use std::collections::HashMap;

use super::body::padded;
use super::document::{Cells, Document, Section};
use crate::body::{Body, Facet};
use crate::error::{Error, check_length};
use crate::report::{Contact, Report, ReportedContactState};

/// The contact surface of a report as a VTU document. One point per contact in the
/// report's order, on the contact's own body, then the facet corners that are no contacts.
///
/// `facets` come with the index of their body, `displacements` are per body and unknown.
/// Point arrays: `displacement`, `pressure`, `friction_traction`, `gap`, `slip`, `state`
/// (0 open, 1 slip, 2 stick, −1 no contact), `body`, `node` (of its mesh), under laws beyond Coulomb's `shear_bound`. Cells have `body` and
/// `state`: that of most of their contacts, of two alike the one that holds more. The file says
/// these numbers in a comment. A value that does not exist (pressure without area, gap of what is
/// no contact) is NaN, which plots leave blank.
///
/// # Errors
///
/// [`Error::Length`] if a displacement is not the mesh's, [`Error::UnknownIndex`] for a
/// contact or a facet of a body, or at a node, that does not exist.
pub fn contact_vtu(
    report: &Report,
    bodies: &[Body],
    facets: &[(usize, Facet)],
    displacements: &[Vec<f64>],
) -> Result<String, Error> {
    check_length("displacements", bodies.len(), displacements.len())?;
    for (index, (body, displacement)) in bodies.iter().zip(displacements).enumerate() {
        let unknowns = body.mesh.nodes.len() * body.mesh.dimension;
        let place = format!("displacements[{index}]");
        check_length(&place, unknowns, displacement.len())?;
    }
    let surface = Surface::new(&report.contacts, bodies, facets)?;
    let Surface { points, cells, .. } = &surface;
    let contacts = &report.contacts;
    let mut document = Document::new(points.len(), cells);
    document.section(Section::Points, |document| {
        let moved = points.iter().map(|&(body, node)| {
            let dimension = bodies[body].mesh.dimension;
            &displacements[body][node * dimension..][..dimension]
        });
        document.reals("displacement", 3, moved.flat_map(padded));
        let blank = points.len() - contacts.len();
        let scalar = |value: fn(&Contact) -> Option<f64>| {
            let values = contacts
                .iter()
                .map(move |contact| value(contact).unwrap_or(f64::NAN));
            values.chain(std::iter::repeat_n(f64::NAN, blank))
        };
        let vector = |value: fn(&Contact) -> Option<&[f64]>| {
            let values = contacts
                .iter()
                .map(move |contact| value(contact).map_or([f64::NAN; 3], padded));
            values
                .chain(std::iter::repeat_n([f64::NAN; 3], blank))
                .flatten()
        };
        document.reals("pressure", 1, scalar(|contact| contact.pressure));
        document.reals(
            "friction_traction",
            3,
            vector(|contact| contact.friction_traction.as_deref()),
        );
        if contacts.iter().any(|contact| contact.shear_bound.is_some()) {
            document.reals("shear_bound", 1, scalar(|contact| contact.shear_bound));
        }
        document.reals("gap", 1, scalar(|contact| Some(contact.gap)));
        document.reals("slip", 3, vector(|contact| Some(&contact.slip)));
        document.comment(STATES);
        let states = contacts.iter().map(|contact| vtk_state(contact.state));
        document.integers("state", states.chain(std::iter::repeat_n(-1, blank)));
        document.integers("body", points.iter().map(|&(body, _)| body as i32));
        document.integers("node", points.iter().map(|&(_, node)| node as i32));
    });
    document.section(Section::Cells, |document| {
        document.comment(STATES);
        let cells = surface.points_of_cell.iter();
        document.integers("state", cells.map(|points| state_of(points, contacts)));
        let bodies = surface.body_of_cell.iter();
        document.integers("body", bodies.map(|&body| body as i32));
    });
    let positions = points
        .iter()
        .map(|&(body, node)| bodies[body].mesh.nodes[node]);
    Ok(document.finish(positions, cells))
}

/// Body and node of the points, and the facets between them.
#[derive(Debug, Default)]
struct Surface {
    points: Vec<(usize, usize)>,
    cells: Cells,
    body_of_cell: Vec<usize>,
    points_of_cell: Vec<Vec<usize>>,
}

impl Surface {
    /// A contact on no facet is a vertex, so that none is lost.
    fn new(
        contacts: &[Contact],
        bodies: &[Body],
        facets: &[(usize, Facet)],
    ) -> Result<Self, Error> {
        let mut surface = Self::default();
        let mut point_of: HashMap<(usize, usize), usize> = HashMap::new();
        for (point, contact) in contacts.iter().enumerate() {
            check_node(bodies, "contact", contact.body, contact.node)?;
            surface.points.push((contact.body, contact.node));
            point_of
                .entry((contact.body, contact.node))
                .or_insert(point);
        }
        let mut on_facet = vec![false; contacts.len()];
        for (body, facet) in facets {
            let mut corners = Vec::with_capacity(facet.nodes.len());
            for &node in &facet.nodes {
                check_node(bodies, "facet", *body, node)?;
            }
            for &node in facet.corners(bodies[*body].mesh.dimension) {
                let point = *point_of.entry((*body, node)).or_insert_with(|| {
                    surface.points.push((*body, node));
                    surface.points.len() - 1
                });
                if let Some(seen) = on_facet.get_mut(point) {
                    *seen = true;
                }
                corners.push(point);
            }
            surface.push(*body, corners);
        }
        for (point, _) in on_facet.iter().enumerate().filter(|(_, seen)| !**seen) {
            surface.push(contacts[point].body, vec![point]);
        }
        Ok(surface)
    }

    fn push(&mut self, body: usize, corners: Vec<usize>) {
        self.cells
            .push(vtk_facet(corners.len()), corners.iter().copied());
        self.body_of_cell.push(body);
        self.points_of_cell.push(corners);
    }
}

fn check_node(bodies: &[Body], what: &str, body: usize, node: usize) -> Result<(), Error> {
    let nodes = bodies.get(body).map(|body| body.mesh.nodes.len());
    let (what_is_missing, index, count) = match nodes {
        Some(count) if node < count => return Ok(()),
        Some(count) => ("node", node, count),
        None => ("body", body, bodies.len()),
    };
    Err(Error::UnknownIndex {
        place: format!("a {what}"),
        what: what_is_missing,
        index,
        count,
    })
}

/// VTK's number of a facet: vertex, line, triangle, quadrilateral.
fn vtk_facet(points: usize) -> u8 {
    match points {
        1 => 1,
        2 => 3,
        3 => 5,
        _ => 9,
    }
}

/// What the numbers of `state` mean, for those who open the file. They rise with what a contact
/// holds, so that a plot that blends them passes slip on the way from open to stick.
const STATES: &str = "state: 0 open, 1 slip, 2 stick, -1 no contact";

fn vtk_state(state: ReportedContactState) -> i32 {
    match state {
        ReportedContactState::Open => 0,
        ReportedContactState::Slip => 1,
        ReportedContactState::Stick => 2,
    }
}

/// The state of most of a facet's contacts, of two alike the one that holds more; points behind the
/// contacts are none.
fn state_of(points: &[usize], contacts: &[Contact]) -> i32 {
    let states = points.iter().filter_map(|&point| contacts.get(point));
    let mut counts = [0; 3];
    states.for_each(|contact| counts[vtk_state(contact.state) as usize] += 1);
    let held = (0..3).filter(|&state| counts[state] > 0);
    let most = held.max_by_key(|&state| (counts[state], state));
    most.map_or(-1, |state| state as i32)
}
