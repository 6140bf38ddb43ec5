//! Bodies and cells a thousand times as long as high, and the other way round.

use super::case::Case;
use super::friction::elastic;
use crate::body::{CellKind, graded, rectangle};
use crate::error::Error;
use crate::scene::{Scene, SceneLoad, SceneSupport};
use crate::verify::scenes::{body, hold, on, plane};

/// Size, cells and pressures (left, top) of a block.
struct Shape {
    name: &'static str,
    size: [f64; 2],
    cells: [usize; 2],
    pressure: [f64; 2],
}

const SHAPES: [Shape; 5] = [
    Shape {
        name: "beam 1000 : 1",
        size: [40.0, 0.04],
        cells: [100, 4],
        pressure: [1e5, 5e7],
    },
    Shape {
        name: "beam 1000 : 1, pushed",
        size: [40.0, 0.04],
        cells: [100, 4],
        pressure: [15e7, 5e4],
    },
    Shape {
        name: "tower 1 : 1000",
        size: [0.04, 40.0],
        cells: [16, 64],
        pressure: [1e6, 5e7],
    },
    Shape {
        name: "cells 1000 : 1",
        size: [0.04, 4e-5],
        cells: [32, 32],
        pressure: [15e7, 5e7],
    },
    Shape {
        name: "cells 1 : 1000",
        size: [0.04, 40.0],
        cells: [32, 32],
        pressure: [15e7, 5e7],
    },
];

/// A block on a plane, held at its right and at its lower right corner.
fn scene(shape: &Shape, friction: f64) -> Result<Scene, Error> {
    let lines = |axis: usize| graded(0.0, shape.size[axis], shape.cells[axis], 1.0);
    let mesh = rectangle(&lines(0)?, &lines(1)?, CellKind::Quad4)?;
    let mut block = hold(body("block", mesh, elastic(1.3e11, 0.3)), "right", 0, 0.0);
    block.supports.push(SceneSupport::At {
        at: vec![shape.size[0], 0.0],
        displacement: vec![None, Some(0.0)],
    });
    for (group, pressure) in ["left", "top"].into_iter().zip(shape.pressure) {
        let group = group.into();
        block.loads.push(SceneLoad::Pressure { pressure, group });
    }
    Ok(on(plane(&[0.0, 1.0]), block, "bottom", friction))
}

pub(super) fn cases() -> Result<Vec<Case>, Error> {
    let mut cases = Vec::new();
    for shape in &SHAPES {
        for friction in [0.0, 0.3, 1.0, 5.0] {
            let name = format!("{}, mu {friction}", shape.name);
            let load = shape.pressure[1] * shape.size[0];
            let case = Case::scene("aspect ratio", name, scene(shape, friction)?);
            // A beam's compliance is bending, 1e9 to 1e12 times what its contacts feel of each other:
            // forces keep the digits that are left of 16.
            cases.push(case.knows("normal and corner force", 1e-4, move |answer| {
                Ok(((answer.held(0, 1) - answer.normal()) / load - 1.0).abs())
            }));
        }
    }
    Ok(cases)
}
