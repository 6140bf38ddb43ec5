//! A bound of the error of the stress: against one that is in equilibrium at every point.
//!
//! ```text
//! (B18)  ∫ (σ − σ*) : C⁻¹ : (σ − σ*) dV + ∫ (σ̂ − σ*) : C⁻¹ : (σ̂ − σ*) dV = ∫ (σ̂ − σ) : C⁻¹ : (σ̂ − σ) dV
//!        σ of the displacement found, σ* exact, σ̂ with div σ̂ + b = 0 and σ̂ n = t
//! ```
//!
//! The hypercircle of Prager, Synge, Quart. Appl. Math. 5 (1947) 241–269. σ̂ is made cell by cell: tractions
//! on the edges that hold every cell (`tractions.rs`), then the stress in each that goes with them and is closest to σ
//! (`local.rs`). No constant is unknown in it and nothing is neglected but rounding, and quadrature where σ is no
//! polynomial (quadrilaterals that are no parallelograms, rings).
//!
//! On the contact t is the one chosen here, whose resultants around every node are its reaction: σ* is the exact
//! stress of the body under these tractions.

mod bernstein;
mod edges;
mod field;
mod given;
mod least;
mod local;
mod tractions;

use bernstein::Bernstein;
use edges::Edges;
use field::Field;
use given::Given;
use local::Local;
use tractions::{Tractions, Unbalanced};

use super::dilatation::Dilatation;
use super::{Body, Facet, Load, Model};
use crate::error::Error;

/// Nodes between corners are where straight sides have them to this part of the side.
const STRAIGHT: f64 = 1e-9;

/// `∫ (σ̂ − σ) : C⁻¹ : (σ̂ − σ) dV` of (B18), in joule: a bound of the square of the error of the stress in the energy
/// norm.
///
/// `displacement` in metre, entry `dimension · node + axis`, in equilibrium with the loads and what acts on the
/// `contact` facets and supports.
///
/// # Errors
///
/// [`Error::NotAccepted`] for bodies in 3D, curved cells, forces and supports of single nodes, springs, ties, incompatible
/// modes and averaged dilatations.
pub(crate) fn stress_error_bound(
    body: &Body,
    displacement: &[f64],
    contact: &[Facet],
) -> Result<f64, Error> {
    check(body)?;
    let quadratic = body.mesh.cells().any(|cell| !cell.kind.is_linear());
    let field = Field::new(body, displacement);
    let given = Given::new(body);
    let edges = Edges::new(body, contact);
    let of_tractions = if quadratic { 2 } else { 1 };
    let tractions = Tractions::new(&field, &given, &edges, of_tractions);
    let mut tractions = tractions.map_err(|Unbalanced(node)| {
        let [x, y, _] = body.mesh.nodes[node];
        refused(
            body,
            format!("a force on the single node {node} at ({x}, {y})"),
            "supports of whole edges",
        )
    })?;
    let degree = of_tractions + 1;
    let shapes = [degree, degree - 1].map(Bernstein::new);
    let distorted = |index: usize| {
        refused(
            body,
            format!("cell {index}, in which no stress holds the forces"),
            "cells that are less distorted",
        )
    };
    let cells = 0..body.mesh.cell_count();
    let local = |index| Local::new(&field, &given, index, &shapes);
    let energies = cells.clone().map(|index| {
        let energy = local(index).energy(&tractions);
        energy.ok_or_else(|| distorted(index))
    });
    let energies: Vec<_> = energies.collect::<Result<_, _>>()?;
    tractions.relax(&energies);
    let errors = cells.map(|index| {
        let error = local(index).error(&tractions);
        error.ok_or_else(|| distorted(index))
    });
    let sum: f64 = errors.sum::<Result<f64, Error>>()?;
    let around = match body.model {
        Model::Axisymmetric => 2.0 * std::f64::consts::PI,
        _ => body.model.depth(),
    };
    Ok(sum * around)
}

fn refused(body: &Body, found: String, accepted: &str) -> Error {
    Error::NotAccepted {
        place: format!("bound of the stress error: {}", body.name),
        found,
        accepted: accepted.to_owned(),
    }
}

/// What the bound does not know.
fn check(body: &Body) -> Result<(), Error> {
    let point = |load: &Load| matches!(load, Load::PointForce { .. } | Load::AtReference { .. });
    let averaged = || {
        let mut cells = body.mesh.cells().zip(&body.material_of_cell);
        cells.any(|(cell, &of)| {
            let dilatation = Dilatation::of(body, cell.kind, &body.materials[of]);
            dilatation != Dilatation::Pointwise || body.has_modes(cell.kind)
        })
    };
    let found = if body.model == Model::Solid {
        Some(("a body in 3D", "plane and axisymmetric bodies"))
    } else if body.is_tied() {
        Some(("ties or turned supports", "supports along the axes"))
    } else if !body.foundation.is_empty() {
        Some(("springs", "supports and loads"))
    } else if body.loads.iter().any(point) {
        Some(("a force at a node, whose energy has no bound", "tractions"))
    } else if averaged() {
        Some((
            "averaged dilatations or incompatible modes",
            "the standard formulation with Poisson's ratio below 0.45, or quadratic cells",
        ))
    } else if curved(body) {
        Some(("curved cells", "cells with straight sides"))
    } else {
        None
    };
    match found {
        Some((found, accepted)) => Err(refused(body, found.to_owned(), accepted)),
        None => Ok(()),
    }
}

/// Whether some node between corners is not where straight sides have it.
fn curved(body: &Body) -> bool {
    let nodes = &body.mesh.nodes;
    body.mesh.cells().any(|cell| {
        let linear = cell.kind.linear();
        let size = {
            let [a, b] = [nodes[cell.nodes[0]], nodes[cell.nodes[1]]];
            (a[0] - b[0]).hypot(a[1] - b[1])
        };
        (linear.node_count()..cell.nodes.len()).any(|local| {
            let shape = linear.reference().shape(cell.kind.position(local));
            let straight = |axis: usize| {
                let corners = cell.nodes.iter().zip(&shape);
                corners.map(|(node, n)| nodes[*node][axis] * n).sum::<f64>()
            };
            let node = nodes[cell.nodes[local]];
            (0..2).any(|axis| (node[axis] - straight(axis)).abs() > STRAIGHT * size)
        })
    })
}
