//! The stiffness matrix.
//!
//! ```text
//! (B3)  K_ab = λ A_ab + μ (A_abᵀ + tr A_ab I),      A_ab = ∫ ∇N_a ∇N_bᵀ dV
//! ```
//!
//! per pair of nodes, from `∫ λ div u div v + 2 μ ε(u) : ε(v) dV`. Nearly incompressible
//! cells put a mean in place of `λ A_ab` ((B4), (B5)). Rings strain around the axis too:
//!
//! ```text
//! (B11)  ε_θ = u_r / r:   λ ∫ d_a d_bᵀ dV  for  λ A_ab  with d of (B10),
//!                         and K_ab + 2 μ ∫ N_a N_b / r² dV e_r e_rᵀ
//! ```

use nalgebra::Matrix3;
use rayon::prelude::*;

use super::Body;
use super::condensed_cell::Condensed;
use super::dilatation::Patches;
use super::element::Element;
use super::foundation::{Foundation, add_foundation};
use super::sparsity::BlockMatrix;

/// Cells whose blocks are formed at a time, by all threads; one adds them up, in order.
const RUN: usize = 2048;

/// Stiffness matrix of the body without supports, in N/m: symmetric, both triangles, rows
/// `dimension · node + axis` with ascending columns.
///
/// The body has passed [`check`](super::check()).
#[must_use]
pub(crate) fn stiffness(body: &Body) -> sprs::CsMat<f64> {
    part_of_stiffness(body, 0, 1)
}

/// What one of several runs of cells adds to it; the parts of all runs add up to the whole. Springs to the
/// ground are in the first.
#[must_use]
pub(crate) fn part_of_stiffness(body: &Body, part: usize, parts: usize) -> sprs::CsMat<f64> {
    let mesh = &body.mesh;
    let patches = Patches::new(body);
    let of_part = |count: usize| count * part / parts..count * (part + 1) / parts;
    let cells = of_part(mesh.cell_count());
    let patched = of_part(patches.iter().count());
    let patches = || patches.iter().skip(patched.start).take(patched.len());
    let springs = body.foundation.iter().filter(|_| part == 0);
    let lists = cells.clone().map(|cell| mesh.cell(cell).nodes);
    let lists = lists.chain(patches().map(|patch| patch.nodes));
    let lists = lists.chain(springs.flat_map(Foundation::joined));
    let mut matrix = BlockMatrix::new(mesh.dimension, mesh.nodes.len(), lists);
    for run in cells.collect::<Vec<_>>().chunks(RUN) {
        let formed: Vec<_> = run.par_iter().map(|&cell| blocks(body, cell)).collect();
        for (&cell, blocks) in run.iter().zip(formed) {
            let nodes = mesh.cell(cell).nodes;
            for ((a, b), block) in pairs(nodes.len()).zip(&blocks) {
                matrix.add(nodes[a], nodes[b], block);
            }
        }
    }
    let depth = body.model.depth();
    for patch in patches() {
        for (a, (row, b_a)) in patch.nodes.iter().zip(patch.gradients).enumerate() {
            for (column, b_b) in patch.nodes.iter().zip(patch.gradients).take(a + 1) {
                matrix.add(
                    *row,
                    *column,
                    &(b_a * b_b.transpose() * (depth * patch.stiffness)),
                );
            }
        }
    }
    if part == 0 {
        add_foundation(body, &mut matrix);
    }
    matrix.into_rows()
}

/// (B3) of one cell for its pairs of nodes, with (B4) where its dilatation is the cell's mean.
fn blocks(body: &Body, index: usize) -> Vec<Matrix3<f64>> {
    let pairs = pairs(body.mesh.cell(index).nodes.len());
    let depth = body.model.depth();
    if let Some(condensed) = Condensed::of(body, index) {
        let (axes, stiffness) = (body.mesh.dimension, condensed.stiffness * depth);
        let entry = |(a, b): (usize, usize), i, j| match usize::max(i, j) < axes {
            true if a == b => stiffness[(axes * a + i.max(j), axes * b + i.min(j))],
            true => stiffness[(axes * a + i, axes * b + j)],
            false => 0.0,
        };
        let block = |pair| Matrix3::from_fn(|i, j| entry(pair, i, j));
        return pairs.map(block).collect();
    }
    let element = Element::new(body, index);
    pairs.map(|(a, b)| element.block(a, b) * depth).collect()
}

/// Each pair of nodes once.
fn pairs(nodes: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..nodes).flat_map(|a| (0..=a).map(move |b| (a, b)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use nalgebra::Vector3;

    use super::*;
    use crate::body::material::Lame;
    use crate::body::tests::samples::{block, distorted, facets, hold, mixed, solve};
    use crate::body::{CellKind, Load, Model};

    /// Distorted blocks of every kind in every model, with and without averaged dilatation.
    fn bodies() -> Vec<Body> {
        let mut bodies = Vec::new();
        for mut body in [mixed(false), mixed(true)] {
            bodies.push(body.clone());
            body.materials[0].poisson = 0.4999;
            bodies.push(body);
        }
        for kind in CellKind::all() {
            for poisson in [0.3, 0.4999, -0.5] {
                let mut body = distorted(kind);
                body.materials[0].poisson = poisson;
                if matches!(kind, CellKind::Quad4 | CellKind::Hex8) {
                    let formulation = crate::body::Formulation::IncompatibleModes;
                    bodies.push(Body {
                        formulation,
                        ..body.clone()
                    });
                }
                if kind.dimension() == 2 {
                    let mut plate = body.clone();
                    plate.model = Model::PlaneStress { thickness: 0.1 };
                    bodies.push(plate);
                }
                bodies.push(body);
            }
        }
        bodies
    }

    /// Nodal values of `u = c + H x`.
    fn linear(body: &Body, c: Vector3<f64>, h: Matrix3<f64>) -> Vec<f64> {
        let value = |x: &[f64; 3]| c + h * Vector3::from(*x);
        let values = body.mesh.nodes.iter().map(value);
        let axes = body.mesh.dimension;
        values
            .flat_map(|u| (0..axes).map(move |axis| u[axis]))
            .collect()
    }

    fn product(matrix: &sprs::CsMat<f64>, vector: &[f64]) -> Vec<f64> {
        let row = |row: sprs::CsVecView<'_, f64>| row.iter().map(|(j, k)| k * vector[j]).sum();
        matrix.outer_iterator().map(row).collect()
    }

    #[test]
    fn the_matrix_is_symmetric_to_the_last_bit() {
        for body in bodies() {
            let matrix = stiffness(&body);
            assert_eq!(matrix.rows(), body.mesh.dimension * body.mesh.nodes.len());
            assert!(matrix.is_csr() && matrix == matrix.transpose_view().to_csr());
        }
    }

    #[test]
    fn rigid_motions_need_no_force() {
        // u = c + ω × x with ω = (0.3, −0.7, 1.1), in 2D only the turn about z.
        for body in bodies() {
            let [x, y, z] = if body.mesh.dimension == 3 {
                [0.3, -0.7, 1.1]
            } else {
                [0.0, 0.0, 1.1]
            };
            let spin = Matrix3::new(0.0, -z, y, z, 0.0, -x, -y, x, 0.0);
            let motion = linear(&body, Vector3::new(1.0, 2.0, 3.0), spin);
            let matrix = stiffness(&body);
            let largest = matrix.data().iter().fold(0.0_f64, |m, k| m.max(k.abs()));
            let forces = product(&matrix, &motion);
            assert!(forces.iter().all(|f| f.abs() < 1e-13 * largest));
        }
    }

    #[test]
    fn a_linear_displacement_leaves_inner_nodes_without_force() {
        // Patch test: uniform stress on distorted cells is in equilibrium. Volume change and shear.
        let h = Matrix3::new(0.3, 0.1, -0.2, 0.4, -0.6, 0.1, 0.2, 0.5, 0.8);
        for body in bodies() {
            let displacement = linear(&body, Vector3::zeros(), h);
            let matrix = stiffness(&body);
            let largest = matrix.data().iter().fold(0.0_f64, |m, k| m.max(k.abs()));
            let forces = product(&matrix, &displacement);
            let axes = body.mesh.dimension;
            let surface: Vec<usize> = body
                .mesh
                .boundary_facets()
                .iter()
                .flat_map(|f| f.nodes.clone())
                .collect();
            let inner = (0..body.mesh.nodes.len()).filter(|node| !surface.contains(node));
            for node in inner {
                assert!(
                    forces[axes * node..axes * (node + 1)]
                        .iter()
                        .all(|f| f.abs() < 1e-13 * largest)
                );
            }
        }
    }

    #[test]
    fn energy_of_a_linear_displacement_is_that_of_its_strain() {
        // ½ u·K u = ½ V depth (λ θ² + 2 μ ε:ε), V = 2; exact on distorted cells for any form of θ.
        let h = Matrix3::new(0.3, 0.1, 0.0, 0.4, -0.6, 0.0, 0.0, 0.0, 0.0);
        let strain = (h + h.transpose()) / 2.0;
        for body in bodies() {
            let displacement = linear(&body, Vector3::zeros(), h);
            let forces = product(&stiffness(&body), &displacement);
            let found: f64 = forces.iter().zip(&displacement).map(|(f, u)| f * u).sum();
            let Lame { lambda, shear } = body.materials[0].lame(body.model);
            let density = lambda * h.trace().powi(2) + 2.0 * shear * strain.norm_squared();
            let expected = 2.0 * body.model.depth() * density;
            assert!(
                (found - expected).abs() < 1e-12 * expected,
                "{found} {expected}"
            );
        }
    }

    /// Symmetry planes left, bottom (and front), pulled at the right with 3 Pa.
    fn bar(kind: CellKind) -> Body {
        let mut body = block(kind);
        let planes = [("left", 0), ("bottom", kind.dimension() - 1), ("front", 1)];
        for (name, axis) in planes.into_iter().take(kind.dimension()) {
            hold(&mut body, name, axis);
        }
        let facets = facets(&body.mesh, "right");
        body.loads = vec![Load::Pressure {
            facets,
            pressure: -3.0,
        }];
        body
    }

    #[test]
    fn a_bar_under_uniform_tension_stretches_by_its_modulus() {
        // u_x = σ x / E', u_y = −ν' σ y / E' with (E', ν') = (E, ν) in 3D and plane stress,
        // (E/(1−ν²), ν/(1−ν)) in plane strain; σ = 3, E = 10.
        for kind in CellKind::all() {
            for poisson in [0.3, 0.4999] {
                let mut body = bar(kind);
                body.materials[0].poisson = poisson;
                let mut cases = vec![(body.clone(), 10.0, poisson)];
                if kind.dimension() == 2 {
                    cases[0].1 = 10.0 / (1.0 - poisson * poisson);
                    cases[0].2 = poisson / (1.0 - poisson);
                    body.model = Model::PlaneStress { thickness: 0.2 };
                    cases.push((body, 10.0, poisson));
                }
                for (body, young, ratio) in cases {
                    let found = solve(&body);
                    let [x, y] = [3.0 / young, -ratio * 3.0 / young];
                    let expected = linear(
                        &body,
                        Vector3::zeros(),
                        Matrix3::from_diagonal(&Vector3::new(x, y, y)),
                    );
                    // The condition of K is λ/μ = 5000 at ν = 0.4999 times some hundred for the cells: 1e6 ε.
                    let close = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-10;
                    assert!(found.iter().zip(&expected).all(close), "{kind:?} {poisson}");
                }
            }
        }
    }

    #[test]
    fn cells_of_two_materials_in_a_row_stretch_each_by_its_own_modulus() {
        // Springs in series: halves of 1 m with E = 10 and 30, ν = 0: 3/10 + 3/30 = 0.4 m.
        for kind in CellKind::all() {
            let mut body = bar(kind);
            body.materials = [10.0, 30.0]
                .map(|young| crate::body::Material::new(young, 0.0))
                .into();
            let mut nodes = std::mem::take(&mut body.mesh.nodes);
            let mut columns: Vec<f64> = nodes.iter().map(|x| x[0]).collect();
            columns.sort_by(f64::total_cmp);
            columns.dedup();
            let step = 2.0 / (columns.len() - 1) as f64;
            for x in &mut nodes {
                x[0] = step * columns.iter().position(|c| *c == x[0]).unwrap() as f64;
            }
            body.mesh.nodes = nodes;
            let stiff = |cell: usize| usize::from(body.mesh.centroid(cell)[0] > 1.0);
            body.material_of_cell = (0..body.mesh.cell_count()).map(stiff).collect();
            let found = solve(&body);
            for (node, x) in body.mesh.nodes.iter().enumerate() {
                let expected = 0.3 * x[0].min(1.0) + 0.1 * (x[0] - 1.0).max(0.0);
                assert!((found[body.mesh.dimension * node] - expected).abs() < 1e-12);
            }
        }
    }
}
