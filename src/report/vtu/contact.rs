//! The contact surface: pressure, friction, gap, slip, state.

use std::collections::HashMap;

use super::body::padded;
use super::document::{Cells, Document, Section};
use crate::body::{Facet, Mesh};
use crate::error::{Error, check_length};
use crate::report::{Contact, ContactState, Report};

/// The contact surface of a report as a VTU document. One point per contact in the
/// report's order, then the facet nodes that are no contacts.
///
/// Point arrays: `displacement`, `pressure`, `friction_traction`, `gap`, `slip`, `state`
/// (0 open, 1 stick, 2 slip, −1 no contact), `node` (of the mesh). A value that does not
/// exist (pressure without area, gap of what is no contact) is NaN, which plots leave blank.
///
/// # Errors
///
/// [`Error::Length`] if the displacement is not the mesh's, [`Error::OutOfRange`] for a
/// facet with a node that the mesh does not have.
pub fn contact_vtu(
    report: &Report,
    mesh: &Mesh,
    facets: &[Facet],
    displacement: &[f64],
) -> Result<String, Error> {
    check_length(
        "displacement",
        mesh.nodes.len() * mesh.dimension,
        displacement.len(),
    )?;
    let (nodes, cells) = surface(&report.contacts, mesh, facets)?;
    let contacts = &report.contacts;
    let mut document = Document::new(nodes.len(), &cells);
    document.section(Section::Points, |document| {
        let moved = nodes
            .iter()
            .map(|node| &displacement[node * mesh.dimension..][..mesh.dimension]);
        document.reals("displacement", 3, moved.flat_map(padded));
        let blank = nodes.len() - contacts.len();
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
        document.reals("gap", 1, scalar(|contact| Some(contact.gap)));
        document.reals("slip", 3, vector(|contact| Some(&contact.slip)));
        let states = contacts.iter().map(|contact| vtk_state(contact.state));
        document.integers("state", states.chain(std::iter::repeat_n(-1, blank)));
        document.integers("node", nodes.iter().map(|&node| node as i32));
    });
    Ok(document.finish(nodes.iter().map(|&node| mesh.nodes[node]), &cells))
}

/// Mesh nodes of the points, and the facets between them; a contact on no facet is a
/// vertex, so that none is lost.
fn surface(
    contacts: &[Contact],
    mesh: &Mesh,
    facets: &[Facet],
) -> Result<(Vec<usize>, Cells), Error> {
    let mut nodes: Vec<usize> = contacts.iter().map(|contact| contact.node).collect();
    let mut point_of: HashMap<usize, usize> = HashMap::new();
    for (point, &node) in nodes.iter().enumerate() {
        check_node(mesh, "contact", node)?;
        point_of.entry(node).or_insert(point);
    }
    let mut on_facet = vec![false; contacts.len()];
    let mut cells = Cells::default();
    for facet in facets {
        let mut points = Vec::with_capacity(facet.nodes.len());
        for &node in &facet.nodes {
            check_node(mesh, "facet", node)?;
            let point = *point_of.entry(node).or_insert_with(|| {
                nodes.push(node);
                nodes.len() - 1
            });
            if let Some(seen) = on_facet.get_mut(point) {
                *seen = true;
            }
            points.push(point);
        }
        cells.push(vtk_facet(points.len()), points);
    }
    for (point, _) in on_facet.iter().enumerate().filter(|(_, seen)| !**seen) {
        cells.push(vtk_facet(1), [point]);
    }
    Ok((nodes, cells))
}

fn check_node(mesh: &Mesh, what: &str, node: usize) -> Result<(), Error> {
    if node < mesh.nodes.len() {
        return Ok(());
    }
    Err(Error::OutOfRange {
        place: format!("node of a {what}"),
        value: node as f64,
        accepted: "a node of the mesh",
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

fn vtk_state(state: ContactState) -> i32 {
    match state {
        ContactState::Open => 0,
        ContactState::Stick => 1,
        ContactState::Slip => 2,
    }
}
