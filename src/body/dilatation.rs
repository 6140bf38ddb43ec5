//! Volume change of nearly incompressible cells, without locking.
//!
//! As ν → ½ the λ-term of the energy, `½ ∫ λ θ² dV` with `θ = div u`, forbids any change
//! of volume. Taken at every quadrature point it leaves linear cells no room to deform.
//! From ν = 0.45 on it therefore sees a mean in place of θ:
//!
//! ```text
//! (B4)  Quad4, Hex8   mean over the cell:          λ V ḡ_a ḡ_bᵀ,    ḡ_a = (1/V) ∫ ∇N_a dV
//! (B5)  Tri3, Tet4    mean around each node p:     λ V_p b_pa b_pbᵀ,
//!                     b_pa = (1/V_p) Σ_e (V_e/n) ∇N_a^e,   V_p = Σ_e V_e/n,
//!                     e: the nearly incompressible cells of one material around p, n nodes each
//! ```
//!
//! (B4) is the mean-dilatation B-bar form (Hughes, Int. J. Numer. Meth. Engng 15 (1980)
//! 1413–1418; Malkus & Hughes, Comput. Meth. Appl. Mech. Engng 15 (1978) 63–81). (B5) is the
//! average nodal pressure of Bonet & Burton (Commun. Numer. Meth. Engng 14 (1998)
//! 437–449): one volume constraint per node, where the plain simplex has one per cell,
//! two to five times as many. The μ-term stays as it is in both, so no deformation but a
//! rigid one is free of energy. In plane stress the thickness yields and nothing locks.

use nalgebra::Vector3;

use super::incidence::Incidence;
use super::quadrature::{positions, rule};
use super::{Body, CellKind, Material, Model};

/// Poisson's ratio from which volume change is averaged.
const NEARLY_INCOMPRESSIBLE: f64 = 0.45;

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
    pub(crate) fn of(kind: CellKind, model: Model, material: &Material) -> Self {
        let plane_stress = matches!(model, Model::PlaneStress { .. });
        if plane_stress || material.poisson < NEARLY_INCOMPRESSIBLE {
            Self::Pointwise
        } else if kind.is_tensor_product() {
            Self::CellMean
        } else {
            Self::NodeMean
        }
    }
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
                    && Dilatation::of(kind, body.model, material) == Dilatation::NodeMean
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
        let lambda = body.materials[material].lame(body.model).lambda;
        let lists = cells.iter().map(|cell| mesh.cell(*cell).nodes);
        let around = Incidence::new(mesh.nodes.len(), lists);
        // Place of each node within the patch under construction.
        let mut place = vec![usize::MAX; mesh.nodes.len()];
        for centre in 0..mesh.nodes.len() {
            let start = self.nodes.len();
            let mut patch_volume = 0.0;
            for &member in around.of(centre) {
                let cell = mesh.cell(cells[member]);
                let mapped = rule(cell.kind)[0].map(cell.kind, &positions(mesh, cell.nodes));
                let share = mapped.volume / cell.nodes.len() as f64;
                patch_volume += share;
                for (&node, gradient) in cell.nodes.iter().zip(&mapped.gradients) {
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
