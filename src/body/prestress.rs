//! Stress that a body has without being displaced: from heat, and given.
//!
//! ```text
//! (B12)  σ = λ (θ − 3 α T) I + 2 μ (ε − α T I) + σ_i = λ θ I + 2 μ ε + σ₀,      λ̂ and R for λ and 2 μ of (B14)
//!        f_a = −∫ σ₀ ∇N_a dV                               its nodal forces; rings: − ∫ σ₀_θθ N_a / r dV e_r
//! ```
//!
//! T is the temperature above that at which the body is free of stress, interpolated between nodes. In
//! plane stress λ is that of the model and takes 2 α T. Where the energy sees a mean dilatation ((B4), (B5))
//! the λ-term sees the same mean of T, so that no change of volume is forced which the cell cannot follow.

use nalgebra::Vector3;

use super::condensed_cell::Condensed;
use super::dilatation::Dilatation;
use super::load::NodalForces;
use super::modes::mapped;
use super::quadrature::rule;
use super::{Body, Load, Model};

/// σ₀ of a body under its loads.
#[derive(Clone, Debug)]
pub(super) struct Prestress<'a> {
    body: &'a Body,
    /// First entry of each cell in `rise`.
    first: Vec<usize>,
    /// T per cell and node of it.
    rise: Vec<f64>,
    /// Mean of T that the λ-term of a cell sees; none where it sees T itself.
    bulk: Vec<Option<f64>>,
    /// σ_i per cell, in pascal.
    given: Vec<[f64; 6]>,
}

impl<'a> Prestress<'a> {
    /// That of some loads on a body; none if no load has any.
    pub(super) fn new(body: &'a Body, loads: &[Load]) -> Option<Self> {
        if !loads.iter().any(Load::stresses) {
            return None;
        }
        let mesh = &body.mesh;
        let mut first = vec![0];
        for cell in mesh.cells() {
            first.push(first[first.len() - 1] + cell.nodes.len());
        }
        let mut stress = Self {
            body,
            rise: vec![0.0; first[mesh.cell_count()]],
            first,
            bulk: vec![None; mesh.cell_count()],
            given: vec![[0.0; 6]; mesh.cell_count()],
        };
        for load in loads {
            match load {
                Load::Temperature { cells, rise } => {
                    for &cell in cells {
                        let nodes = mesh.cell(cell).nodes;
                        let entries = &mut stress.rise[stress.first[cell]..];
                        for (entry, node) in entries.iter_mut().zip(nodes) {
                            *entry += rise[*node];
                        }
                    }
                }
                Load::InitialStress { cells, stress: add } => {
                    for &cell in cells {
                        for (entry, add) in stress.given[cell].iter_mut().zip(add) {
                            *entry += add;
                        }
                    }
                }
                _ => {}
            }
        }
        stress.take_means();
        Some(stress)
    }

    /// σ₀ in a cell at a point where its shape functions are known, in pascal.
    pub(super) fn at(&self, cell: usize, shape: &[f64]) -> [f64; 6] {
        let (mesh, model) = (&self.body.mesh, self.body.model);
        let material = &self.body.materials[self.body.material_of_cell[cell]];
        let rise: f64 = shape
            .iter()
            .zip(self.of_nodes(cell))
            .map(|(n, t)| n * t)
            .sum();
        let bulk = self.bulk[cell].unwrap_or(rise);
        let nodes = mesh.cell(cell).nodes.iter().zip(shape);
        let position = nodes
            .map(|(node, n)| Vector3::from(mesh.nodes[*node]) * *n)
            .sum();
        let strain = material.free_strain(position);
        let axes = match model {
            Model::PlaneStress { .. } => 2,
            _ => 3,
        };
        let theta = bulk * strain[..axes].iter().sum::<f64>();
        let elasticity = material.elasticity(model, position);
        let heat = elasticity.stress(model, strain.map(|alpha| rise * alpha), theta);
        std::array::from_fn(|k| self.given[cell][k] - heat[k])
    }

    /// `−∫ σ₀ ∇N_a dV` of a cell, entry `dimension · node + axis`, then of its modes (B15), for one metre of depth.
    pub(super) fn forces(&self, index: usize) -> Vec<f64> {
        let cell = self.body.mesh.cell(index);
        let axes = self.body.mesh.dimension;
        let mut forces = Vec::new();
        for (point, reference) in mapped(self.body, cell)
            .iter()
            .zip(rule(cell.kind, self.body.model))
        {
            let [xx, yy, zz, yz, xz, xy] = self.at(index, &reference.shape);
            let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
            forces.resize(axes * point.gradients.len(), 0.0);
            for (a, (force, gradient)) in forces.chunks_mut(axes).zip(&point.gradients).enumerate()
            {
                for (entry, row) in force.iter_mut().zip(rows) {
                    *entry -=
                        point.volume * row.iter().zip(gradient).map(|(s, g)| s * g).sum::<f64>();
                }
                force[0] -= point.volume * zz * point.hoop.get(a).copied().unwrap_or(0.0);
            }
        }
        forces
    }

    /// T at the nodes of a cell.
    fn of_nodes(&self, cell: usize) -> &[f64] {
        &self.rise[self.first[cell]..self.first[cell + 1]]
    }

    /// The means of T that averaged dilatations see.
    fn take_means(&mut self) {
        let (body, mesh) = (self.body, &self.body.mesh);
        let kinds = mesh.cells().zip(&body.material_of_cell);
        let kinds = kinds
            .map(|(cell, &material)| Dilatation::of(body, cell.kind, &body.materials[material]));
        let kinds: Vec<Dilatation> = kinds.collect();
        if kinds.iter().all(|kind| *kind == Dilatation::Pointwise) {
            return;
        }
        let means: Vec<[f64; 2]> = (0..kinds.len()).map(|cell| self.mean(cell)).collect();
        for (cell, kind) in kinds.iter().enumerate() {
            if *kind == Dilatation::CellMean {
                self.bulk[cell] = Some(means[cell][0]);
            }
        }
        for material in 0..body.materials.len() {
            let averaged = |cell: &usize| {
                kinds[*cell] == Dilatation::NodeMean && body.material_of_cell[*cell] == material
            };
            let cells: Vec<usize> = (0..kinds.len()).filter(averaged).collect();
            let mut around = vec![[0.0; 2]; mesh.nodes.len()];
            for &cell in &cells {
                let [mean, volume] = means[cell];
                for &node in mesh.cell(cell).nodes {
                    around[node][0] += mean * volume;
                    around[node][1] += volume;
                }
            }
            for &cell in &cells {
                let nodes = mesh.cell(cell).nodes;
                let sum: f64 = nodes.iter().map(|n| around[*n][0] / around[*n][1]).sum();
                self.bulk[cell] = Some(sum / nodes.len() as f64);
            }
        }
    }

    /// Mean of T over a cell, and its volume.
    fn mean(&self, index: usize) -> [f64; 2] {
        let cell = self.body.mesh.cell(index);
        let points = mapped(self.body, cell);
        let (mut sum, mut volume) = (0.0, 0.0);
        for (point, reference) in points.iter().zip(rule(cell.kind, self.body.model)) {
            let rise = reference.shape.iter().zip(self.of_nodes(index));
            sum += point.volume * rise.map(|(n, t)| n * t).sum::<f64>();
            volume += point.volume;
        }
        [sum / volume, volume]
    }
}

impl Load {
    /// Whether the load has a stress of its own (B12).
    #[must_use]
    pub(crate) fn stresses(&self) -> bool {
        matches!(self, Self::Temperature { .. } | Self::InitialStress { .. })
    }
}

impl NodalForces<'_> {
    /// f_a of (B12).
    pub(super) fn add_prestress(&mut self, loads: &[Load]) {
        let Some(prestress) = Prestress::new(self.body, loads) else {
            return;
        };
        let depth = self.body.model.depth();
        for index in 0..self.body.mesh.cell_count() {
            let mut forces = prestress.forces(index);
            if let Some(condensed) = Condensed::of(self.body, index) {
                forces = condensed.forces(&forces).as_slice().to_vec();
            }
            let axes = self.body.mesh.dimension;
            for (node, force) in self
                .body
                .mesh
                .cell(index)
                .nodes
                .iter()
                .zip(forces.chunks(axes))
            {
                let force = std::array::from_fn(|k| force.get(k).copied().unwrap_or(0.0));
                self.add(*node, force, depth);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::tests::samples::{block, distorted, hold, solve};
    use crate::body::{CellKind, cell_stress, load_vector, nodal_stress, stress_recovery};

    /// Distorted blocks of every kind in every model, with and without averaged dilatation, α = 1e-2.
    fn bodies() -> Vec<Body> {
        let mut bodies = Vec::new();
        for kind in CellKind::all() {
            for poisson in [0.3, 0.4999] {
                let mut body = distorted(kind);
                body.materials[0].poisson = poisson;
                body.materials[0].expansion = 1e-2;
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

    fn warm(body: &mut Body, rise: impl Fn(&[f64; 3]) -> f64) {
        body.loads = vec![Load::Temperature {
            cells: (0..body.mesh.cell_count()).collect(),
            rise: body.mesh.nodes.iter().map(rise).collect(),
        }];
    }

    /// Rollers on left, bottom and front, so that the block may grow.
    fn on_rollers(body: &mut Body) {
        let axes = body.mesh.dimension;
        for (side, axis) in [("left", 0), ("bottom", axes - 1), ("front", 1)]
            .into_iter()
            .take(axes)
        {
            hold(body, side, axis);
        }
    }

    #[test]
    fn a_body_that_may_grow_grows_by_its_expansion_without_stress() {
        // u = α T x in 3D and plane stress; in plane strain (1 + ν) α T x and σ_zz = −E α T.
        for mut body in bodies() {
            warm(&mut body, |_| 3.0);
            on_rollers(&mut body);
            let u = solve(&body);
            let poisson = body.materials[0].poisson;
            let (grow, out) = match body.model {
                Model::PlaneStrain => (1.0 + poisson, -10.0 * 0.03),
                _ => (1.0, 0.0),
            };
            let axes = body.mesh.dimension;
            for (u, x) in u.chunks(axes).zip(&body.mesh.nodes) {
                for axis in 0..axes {
                    let expected = grow * 0.03 * x[axis];
                    assert!((u[axis] - expected).abs() < 1e-10, "{:?}", body.model);
                }
            }
            let cells = cell_stress(&body, &u);
            // λ is 1.7e4 at ν = 0.4999, times digits of the strain.
            for stress in cells.iter().chain(&nodal_stress(&body, &u, &cells)) {
                let expected = [0.0, 0.0, out, 0.0, 0.0, 0.0];
                let near = stress
                    .iter()
                    .zip(expected)
                    .all(|(s, e)| (s - e).abs() < 1e-6);
                assert!(near, "{:?} {stress:?}", body.model);
            }
            let found = stress_recovery(&body, &u);
            assert!(found.error < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn a_linear_temperature_bends_a_free_plate_without_stress() {
        // T = x: u = (α (x² − y²)/2, α x y) is free of stress in plane stress; quadratic cells hold it.
        for kind in [CellKind::Tri6, CellKind::Quad8, CellKind::Quad9] {
            let mut body = block(kind);
            body.model = Model::PlaneStress { thickness: 0.1 };
            body.materials[0].expansion = 1e-2;
            warm(&mut body, |x| x[0]);
            let u: Vec<f64> = body
                .mesh
                .nodes
                .iter()
                .flat_map(|[x, y, _]| [0.005 * (x * x - y * y), 0.01 * x * y])
                .collect();
            let stiffness = crate::body::stiffness(&body);
            let load = load_vector(&body);
            for (row, f) in stiffness.outer_iterator().zip(load) {
                let ku: f64 = row.iter().map(|(j, k)| k * u[j]).sum();
                assert!((ku - f).abs() < 1e-14, "{kind:?} {ku} {f}");
            }
        }
    }

    #[test]
    fn a_clamped_body_carries_its_heat_and_its_initial_stress() {
        // u = 0: σ = σ_i − (3λ + 2μ) α T I, with the nodal forces of the same stress.
        for mut body in bodies() {
            warm(&mut body, |_| 3.0);
            let given = match body.model {
                Model::Solid => [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
                Model::PlaneStress { .. } => [1.0, 2.0, 0.0, 0.0, 0.0, 6.0],
                _ => [1.0, 2.0, 3.0, 0.0, 0.0, 6.0],
            };
            body.loads.push(Load::InitialStress {
                cells: (0..body.mesh.cell_count()).collect(),
                stress: given,
            });
            let u = vec![0.0; body.mesh.dimension * body.mesh.nodes.len()];
            let axes = if matches!(body.model, Model::PlaneStress { .. }) {
                2
            } else {
                3
            };
            let lame = body.materials[0].lame(body.model);
            let heat = 0.03 * (axes as f64 * lame.lambda + 2.0 * lame.shear);
            let expected: [f64; 6] =
                std::array::from_fn(|k| given[k] - if k < axes { heat } else { 0.0 });
            for stress in cell_stress(&body, &u) {
                let near = stress.iter().zip(expected);
                assert!(
                    near.clone()
                        .all(|(s, e)| (s - e).abs() < 1e-10 * (1.0 + heat))
                );
            }
        }
    }
}
