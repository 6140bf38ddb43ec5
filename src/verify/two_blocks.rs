//! Two blocks whose meshes do not match: the pressure between them is uniform all the same.

use super::Entry;
use super::ladder::{Ladder, Measured};
use super::scenes::{body, hold, pair, solved};
use crate::body::{CellKind, Mesh, box_mesh, graded, rectangle};
use crate::closed_forms::{Elastic, uniform_strain};
use crate::error::Error;
use crate::report::{Criterion, VerifiedQuantity};
use crate::scene::Scene;

pub(super) const ENTRY: Entry = Entry {
    name: "two blocks that do not match, μ = 0.3",
    source: "closed form (E9); in 3D Hooke's law in one direction",
    floor: "",
    measure,
    drawn: Some(|| scene([CellKind::Quad4; 2], [5, 7])),
};

const MATERIAL: Elastic = Elastic {
    young: 1000.0,
    poisson: 0.3,
};

/// Shortening under a unit pressure on the top, the sides free to widen.
fn shortening(dimension: usize) -> Result<f64, Error> {
    match dimension {
        2 => Ok(uniform_strain(MATERIAL, [0.0, 1.0])?[1]),
        _ => Ok(1.0 / MATERIAL.young),
    }
}

/// A unit block that starts at a height, its cells graded.
fn block(kind: CellKind, low: f64, cells: usize) -> Result<Mesh, Error> {
    let side = |grading| graded(0.0, 1.0, cells, grading);
    let up = graded(low, low + 1.0, cells, 0.6)?;
    match kind.dimension() {
        2 => rectangle(&side(1.7)?, &up, kind),
        _ => box_mesh(&side(1.7)?, &side(0.8)?, &up, kind),
    }
}

/// Two unit blocks, the upper one's top lowered as far as a unit pressure does.
fn scene(kinds: [CellKind; 2], cells: [usize; 2]) -> Result<Scene, Error> {
    let up = kinds[0].dimension() - 1;
    let lowered = 2.0 * shortening(up + 1)?;
    let part = |at: usize, name, back, moved| -> Result<_, Error> {
        let mut block = body(name, block(kinds[at], at as f64, cells[at])?, MATERIAL);
        for (axis, side) in ["left", "front"].into_iter().enumerate().take(up) {
            block = hold(block, side, axis, 0.0);
        }
        Ok(hold(block, back, up, moved))
    };
    let bodies = [
        part(0, "lower", "bottom", 0.0)?,
        part(1, "upper", "top", -lowered)?,
    ];
    Ok(pair(bodies, ["top", "bottom"], 0.3))
}

fn measure(quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let mut meshes = vec![
        ([CellKind::Quad4; 2], [5, 7]),
        ([CellKind::Tri3, CellKind::Quad4], [5, 7]),
        ([CellKind::Quad4; 2], [25, 35]),
        ([CellKind::Hex8; 2], [3, 4]),
        ([CellKind::Hex8, CellKind::Tet4], [3, 4]),
    ];
    if !quick {
        meshes.push(([CellKind::Hex8; 2], [9, 12]));
    }
    let mut pressed = Ladder::new("pressure, worst contact");
    let mut sheared = Ladder::new("friction / pressure, worst");
    let mut moved = Ladder::new("displacement, worst node");
    for (kinds, cells) in meshes {
        let (solution, report, certified) = solved(&scene(kinds, cells)?)?;
        let pressures = report
            .contacts
            .iter()
            .map(|contact| Measured::number(contact.pressure.unwrap_or(f64::NAN), 1.0));
        let frictions = report.contacts.iter().flat_map(|contact| {
            let tractions = contact.friction_traction.iter().flatten();
            tractions.map(|q| Measured::field(q.abs()))
        });
        let dimension = kinds[0].dimension();
        let strain = shortening(dimension)?;
        let nodes = solution.bodies().iter().flat_map(|body| &body.mesh.nodes);
        let moves = solution
            .displacements()
            .iter()
            .flat_map(|u| u.chunks(dimension));
        let errors = nodes.zip(moves).map(|(node, u)| {
            let (up, found) = (node[dimension - 1], u[dimension - 1]);
            Measured::field((found + strain * up).abs() / (2.0 * strain))
        });
        let name = format!(
            "{} {} on {} {}",
            cells[1],
            kinds[1].name(),
            cells[0],
            kinds[0].name()
        );
        let size = 1.0 / cells[0] as f64;
        let all = [
            (&mut pressed, Measured::worst(pressures)),
            (&mut sheared, Measured::worst(frictions)),
            (&mut moved, Measured::worst(errors)),
        ];
        for (ladder, measured) in all {
            ladder.climb(&name, size, certified, measured);
        }
    }
    // Certified to 1e-12, and two digits for the condition of G, up to 35 contacts across.
    let exact = Criterion::EveryMesh { within: 1e-10 };
    Ok([pressed, sheared, moved]
        .map(|ladder| ladder.judge(exact))
        .into())
}
