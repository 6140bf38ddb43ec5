//! Claims about the elastic half-space: closed forms, work, grids, input.
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../program/mod.rs"]
mod program;

mod answers;
mod cone_programs;
mod grids;
mod histories;
mod published;
mod rolling;
mod scenes;
mod work;

use std::sync::Arc;

use dpana::half_space::{ElasticHalf, Grid, HalfSpace, Surroundings};

pub(crate) const RUBBER: ElasticHalf = ElasticHalf {
    young: 2.0,
    poisson: 0.3,
};

/// Two half-spaces of it: pressure and friction do not know of each other, nor do x and y.
pub(crate) const CORK: ElasticHalf = ElasticHalf {
    young: 2.0,
    poisson: 0.0,
};

pub(crate) fn modulus(material: ElasticHalf) -> f64 {
    material.young / (1.0 - material.poisson * material.poisson)
}

/// A half-space on a rigid body, on a grid of given sides.
pub(crate) fn half_space(
    cells: [usize; 2],
    sides: [f64; 2],
    surroundings: Surroundings,
    material: ElasticHalf,
) -> Arc<HalfSpace> {
    let spacing = [0, 1].map(|axis| sides[axis] / cells[axis] as f64);
    let grid = Grid::new(cells, spacing).unwrap();
    Arc::new(HalfSpace::new(grid, surroundings, material, None).unwrap())
}
