//! A total to a given accuracy: the scene on finer and finer meshes.

use std::path::PathBuf;

use super::total::Total;
use super::{Solution, solve};
use crate::alternation::Status;
use crate::error::Error;
use crate::report::{Accuracy, AccuracyLevel};
use crate::scene::Scene;

/// Most meshes of a family.
const MESHES: usize = 10;

/// By how much a factor grows when cells are split, in 2D and 3D: nested dissection, n log n and n^(4/3).
const FACTOR: [usize; 2] = [5, 16];

/// G, the factor that it comes from, its inverse and a Newton matrix.
const DENSE: usize = 4;

/// What is asked of the meshes.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// A column of the table of [`cases`](super::cases()), `energy`, or a displacement such as `u_x@0.5,0`.
    pub of: String,
    /// Largest error, relative to it.
    pub within: f64,
    /// Bytes that a solve may take; finer meshes are not tried.
    pub memory: usize,
    /// Mesh files of the family from coarse to fine; cells are split where there are none.
    pub meshes: Vec<PathBuf>,
}

/// Solves a scene on ever finer meshes until a total is as accurate as requested, or memory or meshes run out;
/// returns the finest state, and the total with its error.
///
/// Every cell is split into halves along each axis, so that curved cells stay curved; a polygon of linear
/// cells stays a polygon, and so does what its answer goes to. A displacement is that of the first mesh's node nearest to the
/// point, on all meshes.
///
/// ```
/// use dpana::{Request, Scene, solve_within};
///
/// # fn main() -> Result<(), dpana::Error> {
/// let scene = r#"{
///     "bodies": [{ "mesh": { "rectangle": { "x": [0, 2], "y": [0, 1], "cells": [4, 2] } },
///                  "model": "plane_strain",
///                  "materials": [{ "young": 1000, "poisson": 0.3 }],
///                  "supports": [{ "group": "top", "displacement": [0, -0.01] }] }],
///     "contacts": [{ "group": "bottom", "friction": 0.25,
///                    "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }] }"#;
/// let request = Request { of: "normal".to_owned(), within: 0.05, memory: 1 << 30, meshes: vec![] };
/// let (_, accuracy) = solve_within(&Scene::from_json(scene, "")?, &request, |_| ())?;
/// assert!(accuracy.reached && accuracy.error <= 0.05 * accuracy.value);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
///
/// Whatever is wrong with the scene or the request, and a mesh on which the state is not certified.
pub fn solve_within(
    scene: &Scene,
    request: &Request,
    mut each: impl FnMut(&AccuracyLevel),
) -> Result<(Solution, Accuracy), Error> {
    let mut total = Total::parse(&request.of).map_err(|error| scene.locate(error))?;
    check(request)?;
    let mut scene = match request.meshes.first() {
        None => scene.clone(),
        Some(first) => scene.with_mesh_file(first)?,
    };
    let mut levels = Vec::new();
    loop {
        let solution = solve(&scene)?;
        if solution.status() != Status::Certified {
            return Err(scene.locate(Error::NotAccepted {
                place: "accuracy".to_owned(),
                found: format!("a state without certificate on mesh {}", levels.len() + 1),
                accepted: "states that are certified; `dpana solve` says what is wrong".to_owned(),
            }));
        }
        if levels.is_empty() {
            total = total.kept(&solution).map_err(|error| scene.locate(error))?;
        }
        let level = AccuracyLevel {
            cells: solution
                .bodies()
                .iter()
                .map(|body| body.mesh.cell_count())
                .sum(),
            contact_unknowns: solution.condensed().problem().unknowns(),
            value: total
                .value(&solution)
                .map_err(|error| scene.locate(error))?,
            grain: total.grain(&solution),
        };
        each(&level);
        levels.push(level);
        let dimension = solution.bodies()[0].mesh.dimension;
        let mut accuracy = Accuracy::new(&request.of, request.within, dimension, levels.clone());
        if accuracy.reached {
            return Ok((solution, accuracy));
        }
        accuracy.stopped = stopped(request, &solution, levels.len());
        if accuracy.stopped.is_some() {
            return Ok((solution, accuracy));
        }
        scene = match request.meshes.get(levels.len()) {
            Some(next) => scene.with_mesh_file(next)?,
            None => scene.with_halved_cells()?,
        };
    }
}

/// Why there is no finer mesh.
fn stopped(request: &Request, solution: &Solution, solved: usize) -> Option<String> {
    if !request.meshes.is_empty() {
        return (solved == request.meshes.len()).then(|| "no more meshes were given".to_owned());
    }
    if solved == MESHES {
        return Some(format!("{MESHES} meshes"));
    }
    let dimension = solution.bodies()[0].mesh.dimension;
    let work = solution.condensed().work();
    let contact = solution.condensed().problem().unknowns() << (dimension - 1);
    let factor = FACTOR[dimension - 2] * work.factor_bytes;
    let bytes = 8 * DENSE * contact * contact + factor;
    (bytes > request.memory).then(|| {
        let [needed, most] = [bytes, request.memory].map(|bytes| bytes as f64 * 1e-9);
        format!("the next mesh takes about {needed:.3} GB of the {most:.3} GB there are")
    })
}

fn check(request: &Request) -> Result<(), Error> {
    if !(request.within > 0.0 && request.within < 1.0) {
        return Err(Error::OutOfRange {
            place: "accuracy".to_owned(),
            value: request.within,
            accepted: "more than 0 and less than 1 (100 %)",
        });
    }
    match request.meshes.len() {
        1 | 2 => Err(Error::NotAccepted {
            place: "meshes".to_owned(),
            found: format!("{} mesh files", request.meshes.len()),
            accepted: "three at least: two changes tell a rate".to_owned(),
        }),
        _ => Ok(()),
    }
}
