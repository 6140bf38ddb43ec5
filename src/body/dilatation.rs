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

use super::cell::MOST_NODES;
use super::incidence::Incidence;
use super::quadrature::{Mapped, mapped};
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

/// Volume of a cell and `ḡ_a = (1/V) ∫ ∇N_a dV` (B4).
pub(crate) fn mean_gradients(points: &[Mapped]) -> (f64, [Vector3<f64>; MOST_NODES]) {
    let volume: f64 = points.iter().map(|point| point.volume).sum();
    let mut mean = [Vector3::zeros(); MOST_NODES];
    for point in points {
        for (sum, gradient) in mean.iter_mut().zip(&point.gradients) {
            *sum += gradient * (point.volume / volume);
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
                let [point, ..] = mapped(mesh, cell);
                let share = point.volume / cell.nodes.len() as f64;
                patch_volume += share;
                for (&node, gradient) in cell.nodes.iter().zip(&point.gradients) {
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
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::samples::{body, facets, solve};
    use crate::body::{Load, Mesh, Support, box_mesh, graded, load_vector, rectangle, stiffness};

    fn cook(kind: CellKind, n: usize, poisson: f64, plain: bool) -> (f64, Body, Vec<f64>) {
        let c = graded(0.0, 1.0, n, 1.0).unwrap();
        let mut mesh = rectangle(&c, &c, kind).unwrap();
        for p in &mut mesh.nodes {
            let [s, t, _] = *p;
            let lo = 44.0 * s;
            let hi = 44.0 + 16.0 * s;
            *p = [48.0 * s, lo + (hi - lo) * t, 0.0];
        }
        let mut body = body(mesh, Model::PlaneStrain, poisson);
        body.materials[0].young = 250.0;
        if plain {
            body.materials[0] = Material {
                young: 250.0 / (1.0 - poisson * poisson),
                poisson: poisson / (1.0 - poisson),
            };
            body.model = Model::PlaneStress { thickness: 1.0 };
        }
        let nodes = facets(&body.mesh, "left")
            .iter()
            .flat_map(|f| f.nodes.clone())
            .collect();
        body.supports = vec![Support {
            place: "l".into(),
            nodes,
            displacement: [Some(0.0), Some(0.0), None],
        }];
        let f = facets(&body.mesh, "right");
        body.loads = vec![Load::Traction {
            facets: f,
            traction: [0.0, 100.0 / 16.0, 0.0],
        }];
        let u = solve(&body);
        let last = body.mesh.nodes.len() - 1;
        (u[2 * last + 1], body, u)
    }

    fn cylinder(kind: CellKind, n: usize, poisson: f64, plain: bool) -> (f64, Body, Vec<f64>) {
        let r = graded(1.0, 2.0, n, 1.0).unwrap();
        let t = graded(0.0, std::f64::consts::FRAC_PI_2, n, 1.0).unwrap();
        let z = graded(0.0, 0.2, 1, 1.0).unwrap();
        let solid = kind.dimension() == 3;
        let mut mesh = if solid {
            box_mesh(&r, &t, &z, kind).unwrap()
        } else {
            rectangle(&r, &t, kind).unwrap()
        };
        for p in &mut mesh.nodes {
            let [r, t, z] = *p;
            *p = [r * t.cos(), r * t.sin(), z];
        }
        let mut body = body(
            mesh,
            if solid {
                Model::Solid
            } else {
                Model::PlaneStrain
            },
            poisson,
        );
        if plain {
            body.materials[0] = Material {
                young: 10.0 / (1.0 - poisson * poisson),
                poisson: poisson / (1.0 - poisson),
            };
            body.model = Model::PlaneStress { thickness: 1.0 };
        }
        let mut hold = |name: &str, axis: usize| {
            let nodes = facets(&body.mesh, name)
                .iter()
                .flat_map(|f| f.nodes.clone())
                .collect();
            let mut displacement = [None; 3];
            displacement[axis] = Some(0.0);
            body.supports.push(Support {
                place: name.into(),
                nodes,
                displacement,
            });
        };
        if solid {
            hold("front", 1);
            hold("back", 0);
            hold("bottom", 2);
            hold("top", 2);
        } else {
            hold("bottom", 1);
            hold("top", 0);
        }
        let f = facets(&body.mesh, "left");
        body.loads = vec![Load::Pressure {
            facets: f,
            pressure: 1.0,
        }];
        let u = solve(&body);
        (u[0], body, u)
    }

    #[test]
    fn explore() {
        for kind in CellKind::ALL {
            for poisson in [0.3, 0.4999, 0.499999] {
                let exact = (1.0 + poisson) / (10.0 * 3.0) * ((1.0 - 2.0 * poisson) + 4.0);
                for n in [4, 8, 16] {
                    if n == 16 && kind.dimension() == 3 {
                        continue;
                    }
                    let a = cylinder(kind, n, poisson, false).0 / exact;
                    let b = if kind.dimension() == 2 {
                        cylinder(kind, n, poisson, true).0 / exact
                    } else {
                        0.0
                    };
                    eprintln!("cyl {kind:?} {poisson} {n}: {a:.5} plain {b:.5}");
                }
            }
        }
        for kind in [CellKind::Tri3, CellKind::Quad4] {
            for poisson in [0.3, 0.4999, 0.499999] {
                for n in [4, 8, 16, 32] {
                    let (a, body, u) = cook(kind, n, poisson, false);
                    let b = cook(kind, n, poisson, true).0;
                    let s = crate::body::cell_stress(&body, &u);
                    let p: Vec<f64> = s.iter().map(|s| (s[0] + s[1] + s[2]) / 3.0).collect();
                    let lo = p.iter().fold(1e9_f64, |m, x| m.min(*x));
                    let hi = p.iter().fold(-1e9_f64, |m, x| m.max(*x));
                    eprintln!(
                        "cook {kind:?} {poisson} {n}: {a:.5} plain {b:.5} pressure {lo:.3} {hi:.3}"
                    );
                }
            }
        }
    }
}
