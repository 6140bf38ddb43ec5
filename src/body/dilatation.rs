//! Volume change of nearly incompressible cells, without locking.
//!
//! As ν → ½ the λ-term of the energy, `½ ∫ λ θ² dV` with `θ = div u`, forbids any change
//! of volume. Taken at every quadrature point it leaves linear cells no room to deform.
//! From ν = 0.45 on it therefore sees a mean in place of θ:
//!
//! ```text
//! (B4)  Quad4, Hex8   mean over the cell:          λ V ḡ_a ḡ_bᵀ,    ḡ_a = (1/V) ∫ d_a dV
//! (B5)  other linear  mean around each node p:     λ V_p b_pa b_pbᵀ,
//!                     b_pa = (1/V_p) Σ_e (V_e/n) ∇N_a^e,   V_p = Σ_e V_e/n,
//!                     e: the nearly incompressible cells of one material around p, n nodes each
//! ```
//!
//! (B4) is the mean-dilatation B-bar form (Hughes, Int. J. Numer. Meth. Engng 15 (1980)
//! 1413–1418; Malkus & Hughes, Comput. Meth. Appl. Mech. Engng 15 (1978) 63–81). (B5) is the
//! average nodal pressure of Bonet & Burton (Commun. Numer. Meth. Engng 14 (1998)
//! 437–449): one volume constraint per node, where the plain simplex has one per cell,
//! two to six times as many. Its displacements converge as those of a compressible
//! body; its pressures are rougher than those of (B4), which is the better choice where
//! pressure matters. The μ-term stays as it is in both, so no deformation but a rigid one
//! is free of energy. In plane stress the thickness yields and nothing locks. In rings the
//! means are those of `d_a` (B10), which is `∇N_a` elsewhere.
//!
//! Quadratic cells keep θ at every quadrature point: they do not lock as linear ones do, though
//! towards ν = ½ coarse ones are stiffer, triangles most, and stresses lose accuracy first.

use nalgebra::Vector3;

use super::incidence::Incidence;
use super::modes::mapped;
use super::quadrature::Mapped;
use super::{Body, CellKind, Material, Model};

/// Which dilatation the λ-term of a cell sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dilatation {
    /// That of each quadrature point.
    Pointwise,
    /// The mean over the cell (B4).
    CellMean,
    /// The means around its nodes (B5).
    NodeMean,
}

impl Dilatation {
    pub(crate) fn of(body: &Body, kind: CellKind, material: &Material) -> Self {
        let plane_stress = matches!(body.model, Model::PlaneStress { .. });
        if plane_stress
            || body.has_modes(kind)
            || !material.is_nearly_incompressible()
            || !kind.is_linear()
        {
            Self::Pointwise
        } else if kind.is_tensor_product() {
            Self::CellMean
        } else {
            Self::NodeMean
        }
    }
}

impl Body {
    /// Whether some cell's energy sees a mean dilatation: another displacement, such as one from a
    /// coarser mesh, then has little to do with its stress.
    #[must_use]
    pub fn averages_dilatation(&self) -> bool {
        let mut cells = self.mesh.cells().zip(&self.material_of_cell);
        cells.any(|(cell, &material)| {
            let material = &self.materials[material];
            Dilatation::of(self, cell.kind, material) != Dilatation::Pointwise
        })
    }
}

/// Volume of a cell and `ḡ_a = (1/V) ∫ d_a dV` (B4).
pub(crate) fn mean_gradients(points: &[Mapped]) -> (f64, Vec<Vector3<f64>>) {
    let volume: f64 = points.iter().map(|point| point.volume).sum();
    let nodes = points.first().map_or(0, |point| point.gradients.len());
    let mut mean = vec![Vector3::zeros(); nodes];
    for point in points {
        for (a, sum) in mean.iter_mut().enumerate() {
            *sum += point.divergence(a) * (point.volume / volume);
        }
    }
    (volume, mean)
}

/// The cells of one material around one node, whose dilatation is averaged (B5).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch<'a> {
    /// `λ V_p`, in N·m (2D: for one metre of depth, N).
    pub(crate) stiffness: f64,
    /// Nodes of the cells, each once.
    pub(crate) nodes: &'a [usize],
    /// `b_pa` per entry of `nodes`, in 1/m.
    pub(crate) gradients: &'a [Vector3<f64>],
}

/// All patches of a body, material by material, centre by centre.
#[derive(Clone, Debug, Default)]
pub(crate) struct Patches {
    /// Material and centre of each patch, ascending.
    keys: Vec<[usize; 2]>,
    stiffness: Vec<f64>,
    offsets: Vec<usize>,
    nodes: Vec<usize>,
    gradients: Vec<Vector3<f64>>,
}

impl Patches {
    /// The patches of a body; none if no cell averages around nodes.
    pub(crate) fn new(body: &Body) -> Self {
        let mut patches = Self {
            offsets: vec![0],
            ..Self::default()
        };
        for (index, material) in body.materials.iter().enumerate() {
            let averaged = |cell: &usize| {
                let kind = body.mesh.cell(*cell).kind;
                body.material_of_cell[*cell] == index
                    && Dilatation::of(body, kind, material) == Dilatation::NodeMean
            };
            let cells: Vec<usize> = (0..body.mesh.cell_count()).filter(averaged).collect();
            if !cells.is_empty() {
                patches.append(body, index, &cells);
            }
        }
        patches
    }

    /// Adds one patch around every node of `cells`, which share a material.
    fn append(&mut self, body: &Body, material: usize, cells: &[usize]) {
        let mesh = &body.mesh;
        let lambda = body.materials[material].lambda(body.model);
        let lists = cells.iter().map(|cell| mesh.cell(*cell).nodes);
        let around = Incidence::new(mesh.nodes.len(), lists);
        // Place of each node within the patch under construction.
        let mut place = vec![usize::MAX; mesh.nodes.len()];
        for centre in 0..mesh.nodes.len() {
            let start = self.nodes.len();
            let mut patch_volume = 0.0;
            for &member in around.of(centre) {
                let cell = mesh.cell(cells[member]);
                let (volume, mean) = mean_gradients(&mapped(body, cell));
                let share = volume / cell.nodes.len() as f64;
                patch_volume += share;
                for (&node, gradient) in cell.nodes.iter().zip(&mean) {
                    if place[node] == usize::MAX {
                        place[node] = self.nodes.len();
                        self.nodes.push(node);
                        self.gradients.push(Vector3::zeros());
                    }
                    self.gradients[place[node]] += gradient * share;
                }
            }
            if self.nodes.len() == start {
                continue;
            }
            for (node, gradient) in self.nodes.iter().zip(&mut self.gradients).skip(start) {
                place[*node] = usize::MAX;
                *gradient /= patch_volume;
            }
            self.keys.push([material, centre]);
            self.stiffness.push(lambda * patch_volume);
            self.offsets.push(self.nodes.len());
        }
    }

    /// All patches in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Patch<'_>> + Clone {
        (0..self.keys.len()).map(|index| {
            let range = self.offsets[index]..self.offsets[index + 1];
            Patch {
                stiffness: self.stiffness[index],
                nodes: &self.nodes[range.clone()],
                gradients: &self.gradients[range],
            }
        })
    }

    /// Number of the patch of a material around a node.
    pub(crate) fn find(&self, material: usize, centre: usize) -> Option<usize> {
        self.keys.binary_search(&[material, centre]).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::tests::samples::{block, distorted};

    #[test]
    fn only_nearly_incompressible_cells_that_feel_it_average() {
        let mut body = block(CellKind::Quad4);
        let mut of = |kind, model, poisson| {
            body.model = model;
            Dilatation::of(&body, kind, &Material::new(1.0, poisson))
        };
        let plate = Model::PlaneStress { thickness: 1.0 };
        assert_eq!(
            of(CellKind::Quad4, Model::PlaneStrain, 0.44),
            Dilatation::Pointwise
        );
        assert_eq!(
            of(CellKind::Quad4, Model::PlaneStrain, 0.45),
            Dilatation::CellMean
        );
        assert_eq!(of(CellKind::Hex8, Model::Solid, 0.49), Dilatation::CellMean);
        assert_eq!(of(CellKind::Tet4, Model::Solid, 0.49), Dilatation::NodeMean);
        assert_eq!(of(CellKind::Tri3, plate, 0.49), Dilatation::Pointwise);
    }

    #[test]
    fn patches_share_the_volume_and_give_a_uniform_dilatation() {
        // Σ V_p = V = 2 m² (m³); u = x has θ = dimension, so b_p · x = dimension in every patch.
        for kind in [
            CellKind::Tri3,
            CellKind::Tet4,
            CellKind::Prism6,
            CellKind::Pyramid5,
        ] {
            let mut body = distorted(kind);
            body.materials[0].poisson = 0.49;
            let lambda = body.materials[0].lame(body.model).lambda;
            let patches = Patches::new(&body);
            let volume: f64 = patches.iter().map(|patch| patch.stiffness / lambda).sum();
            assert!((volume - 2.0).abs() < 1e-13);
            for patch in patches.iter() {
                let terms = patch.nodes.iter().zip(patch.gradients);
                let theta: f64 = terms
                    .map(|(a, b)| b.dot(&Vector3::from(body.mesh.nodes[*a])))
                    .sum();
                assert!((theta - kind.dimension() as f64).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn each_material_averages_among_its_own_cells() {
        // Two incompressible halves and a node on their border: it is the centre of two patches.
        let mut body = block(CellKind::Tri3);
        let soft = Material::new(1.0, 0.49);
        body.materials = vec![soft, soft, Material::new(1.0, 0.3)];
        body.material_of_cell = (0..body.mesh.cell_count()).map(|cell| cell % 3).collect();
        let patches = Patches::new(&body);
        let around = |material: usize, node: usize| {
            let cells = body.mesh.cells().zip(&body.material_of_cell);
            cells
                .filter(|(cell, of)| **of == material && cell.nodes.contains(&node))
                .count()
        };
        for node in 0..body.mesh.nodes.len() {
            for material in 0..2 {
                assert_eq!(
                    patches.find(material, node).is_some(),
                    around(material, node) > 0
                );
            }
            assert_eq!(patches.find(2, node), None);
        }
    }
}
