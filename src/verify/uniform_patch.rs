//! The square of SSNV128 without friction: its stress is uniform on any mesh.

use super::Entry;
use super::ladder::{Ladder, Measured};
use super::scenes::solved;
use super::ssnv128::{MATERIAL, PRESSURE, SIDE, scene, square};
use crate::body::CellKind;
use crate::closed_forms::uniform_strain;
use crate::error::Error;
use crate::report::{Criterion, VerifiedQuantity};

pub(super) const ENTRY: Entry = Entry {
    name: "uniform patch, a square on a smooth plane",
    source: "closed form (E9)",
    floor: "",
    measure,
    drawn: Some(|| Ok(scene(square(8, [3.0, 0.5], CellKind::Quad4)?, 0.0))),
};

fn measure(_quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let [along, _] = uniform_strain(MATERIAL, PRESSURE)?;
    let mut moved = Ladder::new("u_x, worst node");
    let mut pressed = Ladder::new("pressure, worst contact");
    for (cells, cell) in [
        (3, CellKind::Quad4),
        (8, CellKind::Tri3),
        (32, CellKind::Quad4),
        (32, CellKind::Tri3),
    ] {
        let (solution, report, certified) = solved(&scene(square(cells, [3.0, 0.5], cell)?, 0.0))?;
        let nodes = solution.bodies().iter().flat_map(|body| &body.mesh.nodes);
        let moves = solution.displacements().iter().flat_map(|u| u.chunks(2));
        // Relative to the largest displacement, that of the pushed side.
        let errors = nodes.zip(moves).map(|(node, u)| {
            let exact = along * (SIDE - node[0]);
            Measured::field((u[0] - exact).abs() / (along * SIDE))
        });
        let u_x = Measured::worst(errors);
        let pressures = report
            .contacts
            .iter()
            .map(|contact| Measured::number(contact.pressure.unwrap_or(f64::NAN), PRESSURE[1]));
        let name = format!("{cells} × {cells} {}, graded", cell.name());
        let size = 1.0 / cells as f64;
        moved.climb(&name, size, certified, u_x);
        pressed.climb(&name, size, certified, Measured::worst(pressures));
    }
    // Round-off: K of 32 × 32 graded cells has a condition of some thousands; pressures are reactions over shares
    // that are a fifth of the others, a digit more.
    Ok(vec![
        moved.judge(Criterion::EveryMesh { within: 1e-12 }),
        pressed.judge(Criterion::EveryMesh { within: 1e-11 }),
    ])
}
