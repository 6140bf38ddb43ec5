//! How wrong the stress is: cell by cell against a smoother one that is recovered from it.
//!
//! ```text
//! (B9)  η² = ∫ (σ* − σ) : C⁻¹ : (σ* − σ) dV,     σ* = Σ N_a σ*_a,     ‖σ‖² = ∫ σ : C⁻¹ : σ dV
//!       σ*_a   mean over the cells of one material around node a, weighted by their volume, of the
//!              stress at their centres; of quadratic cells extrapolated from where it is best
//! ```
//!
//! Where the solution is smooth σ* is closer to it than σ by an order of the cell size, so that η
//! is the energy norm of the error (Zienkiewicz, Zhu, Int. J. Numer. Meth. Engng 24 (1987) 337–357).
//! Next to supports, corners and the ends of the contact it is a measure, not a bound.

use super::modes::mapped;
use super::prestress::Prestress;
use super::quadrature::{positions, rule};
use super::stress::{
    amplitudes, dilatations, gradient_of, stress_at_nodes, stress_of, sum as plus,
};
use super::{Body, Model, cell_stress};

/// What (B9) finds in a body; both squared energy norms, in joule.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct StressRecovery {
    /// η², an estimate of the error.
    pub error: f64,
    /// ‖σ‖², twice the elastic energy.
    pub energy: f64,
}

/// Estimates the error of the stress of a displacement (B9).
///
/// `displacement` in metre, entry `dimension · node + axis`.
#[must_use]
pub(crate) fn stress_recovery(body: &Body, displacement: &[f64]) -> StressRecovery {
    let (centres, smooth) = recovered_stress(body, displacement);
    let prestress = Prestress::new(body, &body.loads);
    let dilatations = dilatations(body, displacement);
    let mut sum = StressRecovery::default();
    for (index, smooth) in smooth.iter().enumerate() {
        let cell = body.mesh.cell(index);
        let material = &body.materials[body.material_of_cell[index]];
        let constant = cell.kind.has_constant_strain() && body.model != Model::Axisymmetric;
        let of_cell = if !constant {
            let mean = (index, dilatations[index]);
            by_points(body, displacement, prestress.as_ref(), mean, smooth)
        } else {
            let centre = body.mesh.centroid(index).into();
            let square = |stress: &[f64; 6]| material.energy(centre, stress);
            in_simplex(square, body.mesh.volume(index), &centres[index], smooth)
        };
        sum.error += body.model.depth() * of_cell.error;
        sum.energy += body.model.depth() * of_cell.energy;
    }
    sum
}

/// Stress at the centre of every cell, and σ* at the nodes of each.
pub(super) fn recovered_stress(
    body: &Body,
    displacement: &[f64],
) -> (Vec<[f64; 6]>, Vec<Vec<[f64; 6]>>) {
    let centres = cell_stress(body, displacement);
    let prestress = Prestress::new(body, &body.loads);
    let dilatations = dilatations(body, displacement);
    let volumes: Vec<f64> = (0..centres.len())
        .map(|cell| body.mesh.volume(cell))
        .collect();
    let mut by_material: Vec<usize> = (0..centres.len()).collect();
    by_material.sort_by_key(|&cell| body.material_of_cell[cell]);
    let mut recovered = vec![([0.0; 6], 0.0); body.mesh.nodes.len()];
    let mut smooth = vec![Vec::new(); centres.len()];
    let same = |a: &usize, b: &usize| body.material_of_cell[*a] == body.material_of_cell[*b];
    for cells in by_material.chunk_by(same) {
        let at_nodes = |cell: usize| {
            stress_at_nodes(
                body,
                displacement,
                prestress.as_ref(),
                (cell, dilatations[cell], &centres[cell]),
            )
        };
        recover(body, cells, at_nodes, &volumes, &mut recovered);
        for &index in cells {
            let nodes = body.mesh.cell(index).nodes.iter();
            smooth[index] = nodes.map(|node| recovered[*node].0).collect();
        }
    }
    (centres, smooth)
}

/// `σ*_a` at the nodes of some cells, with the volume around; other nodes keep what they have.
fn recover(
    body: &Body,
    cells: &[usize],
    at_nodes: impl Fn(usize) -> Vec<[f64; 6]>,
    volumes: &[f64],
    recovered: &mut [([f64; 6], f64)],
) {
    let nodes = || cells.iter().flat_map(|&cell| body.mesh.cell(cell).nodes);
    for node in nodes() {
        recovered[*node] = ([0.0; 6], 0.0);
    }
    for &cell in cells {
        for (node, stress) in body.mesh.cell(cell).nodes.iter().zip(at_nodes(cell)) {
            let (mean, weight) = &mut recovered[*node];
            *weight += volumes[cell];
            for (mean, component) in mean.iter_mut().zip(&stress) {
                *mean += volumes[cell] / *weight * (component - *mean);
            }
        }
    }
}

/// σ is constant and `σ* − σ = Σ N_a d_a`, with `∫ N_a N_b dV = V (1 + δ_ab)/(n (n + 1))` for n nodes.
fn in_simplex(
    square: impl Fn(&[f64; 6]) -> f64,
    volume: f64,
    stress: &[f64; 6],
    smooth: &[[f64; 6]],
) -> StressRecovery {
    let differences: Vec<[f64; 6]> = smooth.iter().map(|s| minus(s, stress)).collect();
    let mut sum = [0.0; 6];
    let mut own = 0.0;
    for difference in &differences {
        own += square(difference);
        for (total, d) in sum.iter_mut().zip(difference) {
            *total += d;
        }
    }
    let nodes = smooth.len() as f64;
    StressRecovery {
        error: volume * (square(&sum) + own) / (nodes * (nodes + 1.0)),
        energy: volume * square(stress),
    }
}

/// By the cell's quadrature points, at which its stress differs.
fn by_points(
    body: &Body,
    displacement: &[f64],
    prestress: Option<&Prestress<'_>>,
    (index, theta): (usize, Option<f64>),
    smooth: &[[f64; 6]],
) -> StressRecovery {
    let cell = body.mesh.cell(index);
    let material = &body.materials[body.material_of_cell[index]];
    let nodes = positions(&body.mesh, cell.nodes);
    let points = rule(cell.kind, body.model).iter().zip(mapped(body, cell));
    let amplitudes = amplitudes(body, displacement, prestress, index);
    let mut sum = StressRecovery::default();
    for (point, mapped) in points {
        let position = point.in_space(&nodes);
        let gradient = gradient_of(body, displacement, cell, &amplitudes, &mapped);
        let elasticity = material.elasticity(body.model, position);
        let mut stress = stress_of(&elasticity, body.model, &gradient, theta);
        if let Some(prestress) = prestress {
            stress = plus(stress, prestress.at(index, &point.shape));
        }
        let mut at_point = [0.0; 6];
        for (shape, of_node) in point.shape.iter().zip(smooth) {
            for (total, component) in at_point.iter_mut().zip(of_node) {
                *total += shape * component;
            }
        }
        sum.error += mapped.volume * material.energy(position, &minus(&at_point, &stress));
        sum.energy += mapped.volume * material.energy(position, &stress);
    }
    sum
}

fn minus(a: &[f64; 6], b: &[f64; 6]) -> [f64; 6] {
    std::array::from_fn(|k| a[k] - b[k])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::tests::samples::{distorted, mixed};
    use crate::body::{CellKind, Material, stiffness};
    use nalgebra::{Matrix3, Vector3};

    fn nodal(body: &Body, u: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Vec<f64> {
        let axes = body.mesh.dimension;
        let values = body.mesh.nodes.iter().map(|x| u(Vector3::from(*x)));
        values
            .flat_map(|u| u.iter().take(axes).copied().collect::<Vec<_>>())
            .collect()
    }

    #[test]
    fn a_linear_displacement_has_no_error_and_its_own_energy() {
        let h = Matrix3::new(1.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0);
        let with_modes = [CellKind::Quad4, CellKind::Hex8].map(|kind| Body {
            formulation: crate::body::Formulation::IncompatibleModes,
            ..distorted(kind)
        });
        let bodies = CellKind::all().map(distorted).chain(with_modes);
        for mut body in bodies.chain([mixed(false), mixed(true)]) {
            let kind = body.mesh.cell(0).kind;
            for poisson in [0.25, 0.4999] {
                body.materials[0].poisson = poisson;
                let u = nodal(&body, |x| h * x);
                let found = stress_recovery(&body, &u);
                // Squares of (ε λ/μ)², λ/μ = 5000 at ν = 0.4999: 1e-24, and some for distorted patches.
                assert!(found.error < 1e-20 * found.energy, "{kind:?} {found:?}");
                // u · K u, by another way.
                let k = stiffness(&body);
                let ku = k.iter().map(|(entry, (i, j))| u[i] * entry * u[j]);
                let twice: f64 = ku.sum();
                assert!(
                    (found.energy / twice - 1.0).abs() < 1e-12,
                    "{kind:?} {poisson}"
                );
            }
        }
    }

    #[test]
    fn a_stress_that_jumps_between_materials_is_no_error() {
        // Two quads in a row, E = 1 and 3, under one traction: the strain jumps, ν = 0.
        let mut body = distorted(CellKind::Quad4);
        let positions = (0..6).map(|k| [f64::from(k % 3), f64::from(k / 3), 0.0]);
        body.mesh = crate::body::Mesh::new(2, positions.collect());
        body.mesh.push_cell(CellKind::Quad4, &[0, 1, 4, 3]);
        body.mesh.push_cell(CellKind::Quad4, &[1, 2, 5, 4]);
        let material = |young| Material::new(young, 0.0);
        body.materials = vec![material(1.0), material(3.0)];
        body.material_of_cell = vec![0, 1];
        // ε_xx = 3 and 1; σ_xx = 3 in both, and σ_yy = E ε_yy jumps from 1 to 3.
        let u = nodal(&body, |x| {
            let along = if x[0] < 1.5 {
                3.0 * x[0]
            } else {
                3.0 + (x[0] - 1.0)
            };
            Vector3::new(along, x[1], 0.0)
        });
        let found = stress_recovery(&body, &u);
        // The square of a few ε.
        assert!(found.error < 1e-28, "{found:?}");
        // σ : ε = 3·3 + 1·1 and 3·1 + 3·1.
        assert!((found.energy - 16.0).abs() < 1e-12);
    }

    #[test]
    fn the_error_of_two_triangles_is_that_of_their_jump() {
        // A square cut along a diagonal, ν = 0, E = 1, ε_xx = 0 and 1. On the two shared nodes
        // σ* = 1/2, on the others σ itself: d = ±1/2 at two of three nodes, V = 1/2, so that
        // η² = 2 · (1/2) (1² + 2/4)/12 = 1/8.
        let mut body = distorted(CellKind::Tri3);
        let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        body.mesh = crate::body::Mesh::new(2, corners);
        body.mesh.push_cell(CellKind::Tri3, &[0, 1, 2]);
        body.mesh.push_cell(CellKind::Tri3, &[0, 2, 3]);
        body.materials = vec![Material::new(1.0, 0.0)];
        body.material_of_cell = vec![0, 0];
        // u_x = 1 at node 1 only: in the first triangle ε_xx = 1 and ε_xy = −1/2, else 0.
        let found = stress_recovery(&body, &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        // |σ|² of the jump is 1 + 2/4 = 3/2 of that of ε_xx alone; the energy is V 3/2.
        assert!((found.error - 1.5 / 8.0).abs() < 1e-15, "{found:?}");
        assert!((found.energy - 0.75).abs() < 1e-15);
    }
}
