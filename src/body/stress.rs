//! Stress in the cells and at the nodes, for reports.
//!
//! ```text
//! σ = λ θ I + 2 μ ε(u)      ε at the centre of the cell, θ the dilatation that its energy holds
//! ```
//!
//! With (B14) λ̂ and R stand for λ and 2 μ. Heat and initial stress add theirs (B12). At nodes of quadratic cells it is extrapolated from where it is most exact.
//!
//! In nearly incompressible cells θ is the mean of (B4) or (B5): with `tr ε` in its
//! place the pressure would be noise times λ.

use nalgebra::{DVector, Matrix3, Vector3};

use super::condensed_cell::Condensed;
use super::dilatation::{Dilatation, Patches, mean_gradients};
use super::material::Elasticity;
use super::modes::{Modes, mapped};
use super::prestress::Prestress;
use super::quadrature::{Mapped, positions};
use super::reference::{Family, Point};
use super::{Body, Cell, Model};

/// Stress at the centre of each cell, in pascal, in the order xx, yy, zz, yz, xz, xy; z is
/// the direction around the axis of axisymmetric bodies.
///
/// `displacement` in metre, entry `dimension · node + axis`.
#[must_use]
pub(crate) fn cell_stress(body: &Body, displacement: &[f64]) -> Vec<[f64; 6]> {
    let mut stresses = Vec::with_capacity(body.mesh.cell_count());
    for_each_cell(body, displacement, |_, _, stress| stresses.push(stress));
    stresses
}

/// Strain at the centre of each cell, in the order xx, yy, zz, yz, xz, xy, half of the angle for the
/// last three; heat is part of it.
#[must_use]
pub(crate) fn cell_strain(body: &Body, displacement: &[f64]) -> Vec<[f64; 6]> {
    let mut strains = Vec::with_capacity(body.mesh.cell_count());
    for_each_cell(body, displacement, |_, gradient, _| {
        let e = (gradient + gradient.transpose()) / 2.0;
        strains.push([
            e[(0, 0)],
            e[(1, 1)],
            e[(2, 2)],
            e[(1, 2)],
            e[(0, 2)],
            e[(0, 1)],
        ]);
    });
    strains
}

/// Shows every cell with the gradient `∂u_i/∂x_j` and the stress at its centre, in pascal.
pub(super) fn for_each_cell(
    body: &Body,
    displacement: &[f64],
    mut each: impl FnMut(usize, &Matrix3<f64>, [f64; 6]),
) {
    let field = Field { body, displacement };
    let prestress = Prestress::new(body, &body.loads);
    let dilatations = dilatations(body, displacement);
    for (at, cell) in body.mesh.cells().enumerate() {
        let reference = cell.kind.reference();
        let centre = reference.centre();
        let amplitudes = amplitudes(body, displacement, prestress.as_ref(), at);
        let gradient = field.gradient(cell, centre, &amplitudes);
        let stress = field.stress(at, &gradient, dilatations[at], centre);
        let given = prestress
            .as_ref()
            .map(|given| given.at(at, &reference.shape(centre)));
        each(
            at,
            &gradient,
            given.map_or(stress, |given| sum(stress, given)),
        );
    }
}

/// The mean dilatation that the energy of each cell sees ((B4), (B5)); none where it sees that of each point.
pub(super) fn dilatations(body: &Body, displacement: &[f64]) -> Vec<Option<f64>> {
    let field = Field { body, displacement };
    let patches = Patches::new(body);
    let around_nodes: Vec<f64> = patches
        .iter()
        .map(|patch| field.divergence(patch.nodes, patch.gradients))
        .collect();
    let cells = body.mesh.cells().zip(&body.material_of_cell);
    let means =
        cells.map(
            |(cell, &index)| match Dilatation::of(body, cell.kind, &body.materials[index]) {
                Dilatation::Pointwise => None,
                Dilatation::CellMean => Some(field.mean_dilatation(cell)),
                Dilatation::NodeMean => {
                    let nodes = cell.nodes.iter();
                    let around = nodes.filter_map(|node| patches.find(index, *node));
                    Some(
                        around.map(|patch| around_nodes[patch]).sum::<f64>()
                            / cell.nodes.len() as f64,
                    )
                }
            },
        );
    means.collect()
}

/// Stress at the nodes: the mean of the cells around each, weighted by their volume, in pascal.
///
/// `displacement` in metre, entry `dimension · node + axis`, `cell_stress` as from [`cell_stress`].
#[must_use]
pub(crate) fn nodal_stress(
    body: &Body,
    displacement: &[f64],
    cell_stress: &[[f64; 6]],
) -> Vec<[f64; 6]> {
    let prestress = Prestress::new(body, &body.loads);
    let dilatations = dilatations(body, displacement);
    let mut sums = vec![([0.0; 6], 0.0); body.mesh.nodes.len()];
    for (index, stress) in cell_stress.iter().enumerate() {
        let volume = body.mesh.volume(index);
        let of_nodes = stress_at_nodes(
            body,
            displacement,
            prestress.as_ref(),
            (index, dilatations[index], stress),
        );
        for (node, stress) in body.mesh.cell(index).nodes.iter().zip(of_nodes) {
            let (sum, weight) = &mut sums[*node];
            for (total, component) in sum.iter_mut().zip(stress) {
                *total += volume * component;
            }
            *weight += volume;
        }
    }
    let mean = |(sum, weight): ([f64; 6], f64)| sum.map(|total| total / weight);
    sums.into_iter().map(mean).collect()
}

/// What one cell has for the stress at its nodes, in pascal: that of its `centre` if it is linear without modes. Of
/// another one a linear function through the points where a quadratic displacement has
/// nearly the strain of a cubic one (Barlow, Int. J. Numer. Meth. Engng 10 (1976) 243–251).
pub(super) fn stress_at_nodes(
    body: &Body,
    displacement: &[f64],
    prestress: Option<&Prestress<'_>>,
    (index, theta, centre): (usize, Option<f64>, &[f64; 6]),
) -> Vec<[f64; 6]> {
    let cell = body.mesh.cell(index);
    if cell.kind.is_linear() && !body.has_modes(cell.kind) {
        return vec![*centre; cell.nodes.len()];
    }
    let field = Field { body, displacement };
    let amplitudes = amplitudes(body, displacement, prestress, index);
    let linear = cell.kind.linear().reference();
    let middle = linear.centre();
    // The points are the corners, drawn in towards the centre.
    let line = 1.0 / 3.0_f64.sqrt();
    let inward = match (linear.family, linear.dimension) {
        (Family::Simplex, 2) | (Family::Pyramid, _) => [0.5; 3],
        (Family::Simplex, _) => [1.0 / 5.0_f64.sqrt(); 3],
        (Family::Prism, _) => [0.5, 0.5, line],
        _ => [line; 3],
    };
    let scaled = |at: &[f64; 3], by: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|axis| middle[axis] + by[axis] * (at[axis] - middle[axis]))
    };
    let points = linear.nodes.iter().map(|corner| {
        let at = scaled(corner, inward);
        let gradient = field.gradient(cell, at, &amplitudes);
        let stress = field.stress(index, &gradient, theta, at);
        match prestress {
            Some(prestress) => sum(
                stress,
                prestress.at(index, &cell.kind.reference().shape(at)),
            ),
            None => stress,
        }
    });
    let points: Vec<[f64; 6]> = points.collect();
    let nodes = cell.kind.reference().nodes.iter();
    let extrapolated = nodes.map(|node| {
        let shape = linear.extrapolation(scaled(node, inward.map(|by| 1.0 / by)));
        std::array::from_fn(|k| shape.iter().zip(&points).map(|(n, s)| n * s[k]).sum())
    });
    extrapolated.collect()
}

/// Stress of a displacement gradient with the dilatation `theta` given apart, or else its own, in pascal.
pub(super) fn stress_of(
    elasticity: &Elasticity,
    model: Model,
    gradient: &Matrix3<f64>,
    theta: Option<f64>,
) -> [f64; 6] {
    let strain = (gradient + gradient.transpose()) / 2.0;
    let [xx, yy, zz] = [strain[(0, 0)], strain[(1, 1)], strain[(2, 2)]];
    let [yz, xz, xy] = [strain[(1, 2)], strain[(0, 2)], strain[(0, 1)]];
    let theta = theta.unwrap_or_else(|| gradient.trace());
    elasticity.stress(model, [xx, yy, zz, yz, xz, xy], theta)
}

/// Two stresses together, in pascal.
pub(super) fn sum(a: [f64; 6], b: [f64; 6]) -> [f64; 6] {
    std::array::from_fn(|k| a[k] + b[k])
}

/// Von Mises' equivalent stress `√(3/2 s : s)`, in pascal, of a stress in the order
/// xx, yy, zz, yz, xz, xy.
#[must_use]
pub(crate) fn von_mises([xx, yy, zz, yz, xz, xy]: [f64; 6]) -> f64 {
    let differences = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    (0.5 * differences + 3.0 * (yz * yz + xz * xz + xy * xy)).sqrt()
}

/// Principal values, largest first, in pascal, of a stress in the order xx, yy, zz, yz, xz, xy.
#[must_use]
pub(crate) fn principal(stress: [f64; 6]) -> [f64; 3] {
    // The iteration for eigenvalues would not end.
    if stress.iter().any(|component| !component.is_finite()) {
        return [f64::NAN; 3];
    }
    let [xx, yy, zz, yz, xz, xy] = stress;
    let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let mut values: [f64; 3] = tensor.symmetric_eigenvalues().into();
    values.sort_unstable_by(|a, b| b.total_cmp(a));
    values
}

/// `∂u_i/∂x_j` at a point of a cell whose modes have the `amplitudes`; of a ring also `u_r/r`, around the axis.
pub(super) fn gradient_of(
    body: &Body,
    displacement: &[f64],
    cell: Cell<'_>,
    amplitudes: &[Vector3<f64>],
    mapped: &Mapped,
) -> Matrix3<f64> {
    let field = Field { body, displacement };
    let moved = || {
        cell.nodes
            .iter()
            .map(|node| field.at(*node))
            .chain(amplitudes.iter().copied())
    };
    let terms = moved().zip(&mapped.gradients);
    let mut gradient: Matrix3<f64> = terms.map(|(u, gradient)| u * gradient.transpose()).sum();
    let hoop = moved().zip(&mapped.hoop).map(|(u, hoop)| u.x * hoop);
    gradient[(2, 2)] += hoop.sum::<f64>();
    gradient
}

/// α of a cell under a displacement of the body, in metre; none if it has no modes.
pub(super) fn amplitudes(
    body: &Body,
    displacement: &[f64],
    prestress: Option<&Prestress<'_>>,
    index: usize,
) -> Vec<Vector3<f64>> {
    let Some(condensed) = Condensed::of(body, index) else {
        return Vec::new();
    };
    let axes = body.mesh.dimension;
    let nodes = body.mesh.cell(index).nodes.iter();
    let own = nodes.flat_map(|node| &displacement[axes * node..axes * (node + 1)]);
    let own = DVector::from_iterator(condensed.stiffness.nrows(), own.copied());
    let forces = match prestress {
        Some(prestress) => prestress.forces(index),
        None => vec![0.0; own.len() + axes * axes],
    };
    let amplitudes = condensed.amplitudes(&own, &forces);
    let of_modes = amplitudes.as_slice().chunks(axes);
    let vector = |alpha: &[f64]| Vector3::from_fn(|k, _| alpha.get(k).copied().unwrap_or(0.0));
    of_modes.map(vector).collect()
}

/// A displacement of a body's nodes.
struct Field<'a> {
    body: &'a Body,
    displacement: &'a [f64],
}

impl Field<'_> {
    fn at(&self, node: usize) -> Vector3<f64> {
        let axes = self.body.mesh.dimension;
        let entries = &self.displacement[axes * node..axes * (node + 1)];
        Vector3::from_fn(|axis, _| entries.get(axis).copied().unwrap_or(0.0))
    }

    /// `Σ_a g_a · u_a`.
    fn divergence(&self, nodes: &[usize], gradients: &[Vector3<f64>]) -> f64 {
        let terms = nodes.iter().zip(gradients);
        terms
            .map(|(node, gradient)| gradient.dot(&self.at(*node)))
            .sum()
    }

    /// `∂u_i/∂x_j` at a reference position of a cell; of a ring also `u_r/r`, around the axis.
    fn gradient(&self, cell: Cell<'_>, at: [f64; 3], amplitudes: &[Vector3<f64>]) -> Matrix3<f64> {
        let positions = positions(&self.body.mesh, cell.nodes);
        let point = Point::at(cell.kind.reference(), at, 1.0);
        let modes = Modes::of(self.body, cell);
        let mapped = point.map_with(self.body.model, &positions, modes.as_ref());
        gradient_of(self.body, self.displacement, cell, amplitudes, &mapped)
    }

    /// Stress of a gradient at a reference position of a cell, in pascal.
    fn stress(
        &self,
        cell: usize,
        gradient: &Matrix3<f64>,
        theta: Option<f64>,
        at: [f64; 3],
    ) -> [f64; 6] {
        let body = self.body;
        let material = &body.materials[body.material_of_cell[cell]];
        let position = body.mesh.in_space(cell, at);
        stress_of(
            &material.elasticity(body.model, position),
            body.model,
            gradient,
            theta,
        )
    }

    /// Mean of the divergence over a cell (B4).
    fn mean_dilatation(&self, cell: Cell<'_>) -> f64 {
        let (_, mean) = mean_gradients(&mapped(self.body, cell));
        self.divergence(cell.nodes, &mean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::CellKind;

    #[test]
    fn principal_stresses_are_sorted_from_pull_to_push() {
        // Shear of 3 Pa in the plane xy: ±3; in the plane yz about a mean of 1 Pa: 1 ± 2.
        assert_eq!(principal([5.0, 0.0, 0.0, 0.0, 0.0, 0.0]), [5.0, 0.0, 0.0]);
        let near = |found: [f64; 3], expected: [f64; 3]| {
            let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-14, "{found:?}");
        };
        near(
            principal([0.0, 0.0, -1.0, 0.0, 0.0, 3.0]),
            [3.0, -1.0, -3.0],
        );
        assert!(principal([f64::NAN; 6])[0].is_nan());
        near(principal([0.5, 1.0, 1.0, 2.0, 0.0, 0.0]), [3.0, 0.5, -1.0]);
    }

    use crate::body::tests::samples::{block, distorted};

    /// Nodal values of `u = H x`.
    fn linear(body: &Body, h: Matrix3<f64>) -> Vec<f64> {
        let axes = body.mesh.dimension;
        let at = |x: &[f64; 3]| {
            (h * Vector3::from(*x))
                .iter()
                .take(axes)
                .copied()
                .collect::<Vec<_>>()
        };
        body.mesh.nodes.iter().flat_map(at).collect()
    }

    fn assert_stress(found: &[[f64; 6]], expected: [f64; 6], tolerance: f64) {
        for stress in found {
            for (component, expected) in stress.iter().zip(expected) {
                assert!(
                    (component - expected).abs() < tolerance,
                    "{stress:?} {expected:?}"
                );
            }
        }
    }

    #[test]
    fn a_linear_displacement_has_one_stress_in_all_cells_and_nodes() {
        // ν = 1/4, E = 10: λ = μ = 4. u = (x + 2y, 3y): ε_xx = 1, ε_yy = 3, ε_xy = 1, θ = 4;
        // σ = (16 + 8, 16 + 24, 16, 0, 0, 8) in plane strain and 3D.
        let h = Matrix3::new(1.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0);
        for kind in CellKind::all() {
            let mut body = distorted(kind);
            body.materials[0].poisson = 0.25;
            let cells = cell_stress(&body, &linear(&body, h));
            assert_stress(&cells, [24.0, 40.0, 16.0, 0.0, 0.0, 8.0], 1e-12);
            let nodes = nodal_stress(&body, &linear(&body, h), &cells);
            assert_stress(&nodes, [24.0, 40.0, 16.0, 0.0, 0.0, 8.0], 1e-12);
        }
    }

    #[test]
    fn quadratic_cells_have_the_stress_of_a_quadratic_displacement_at_their_nodes() {
        // u = (x² + x y, y²), λ = μ = 4: ε_xx = 2x + y, ε_yy = 2y, ε_xy = x/2, θ = 2x + 3y.
        for kind in CellKind::QUADRATIC {
            let mut body = block(kind);
            body.materials[0].poisson = 0.25;
            let axes = kind.dimension();
            let u = body.mesh.nodes.iter();
            let u = u.flat_map(|[x, y, _]| [x * x + x * y, y * y, 0.0].into_iter().take(axes));
            let u: Vec<f64> = u.collect();
            let nodes = nodal_stress(&body, &u, &cell_stress(&body, &u));
            for (stress, [x, y, _]) in nodes.iter().zip(&body.mesh.nodes) {
                let mean = 4.0 * (2.0 * x + 3.0 * y);
                let (xx, yy) = (8.0 * (2.0 * x + y), 16.0 * y);
                let expected = [mean + xx, mean + yy, mean, 0.0, 0.0, 4.0 * x];
                assert_stress(std::slice::from_ref(stress), expected, 1e-12);
            }
        }
    }

    #[test]
    fn a_plate_has_no_stress_through_its_thickness() {
        // λ = 8/3, μ = 4: σ_xx = 32/3 + 8, σ_yy = 32/3 + 24, σ_xy = 8.
        let h = Matrix3::new(1.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0);
        for kind in [CellKind::Tri3, CellKind::Quad4] {
            let mut body = distorted(kind);
            body.materials[0].poisson = 0.25;
            body.model = Model::PlaneStress { thickness: 0.3 };
            let found = cell_stress(&body, &linear(&body, h));
            let expected = [32.0 / 3.0 + 8.0, 32.0 / 3.0 + 24.0, 0.0, 0.0, 0.0, 8.0];
            assert_stress(&found, expected, 1e-12);
        }
    }

    #[test]
    fn averaged_dilatations_keep_the_stress_of_a_linear_displacement() {
        // ν = 0.4999: λ = E ν/((1+ν)(1−2ν)), μ = E/(2(1+ν)); the shape of σ as above.
        let h = Matrix3::new(1.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0);
        let (lambda, mu) = (10.0 * 0.4999 / (1.4999 * 0.0002), 10.0 / 2.9998);
        let p = 4.0 * lambda;
        for kind in CellKind::all() {
            let mut body = distorted(kind);
            body.materials[0].poisson = 0.4999;
            let found = cell_stress(&body, &linear(&body, h));
            let expected = [p + 2.0 * mu, p + 6.0 * mu, p, 0.0, 0.0, 2.0 * mu];
            assert_stress(&found, expected, 1e-13 * p * 10.0);
        }
    }

    #[test]
    fn von_mises_of_tension_is_the_tension_and_of_shear_root_three_times_it() {
        assert_eq!(von_mises([5.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 5.0);
        assert_eq!(von_mises([7.0, 7.0, 7.0, 0.0, 0.0, 0.0]), 0.0);
        assert!((von_mises([0.0, 0.0, 0.0, 0.0, 0.0, 2.0]) - 2.0 * 3.0_f64.sqrt()).abs() < 1e-15);
    }
}
