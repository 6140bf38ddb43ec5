//! MECHANICS: a linear elastic body in small strain.
//!
//! ```text
//! (B1)  ∫ ε(v) : C ε(u) dV = ∫ v · b dV + ∫ v · p dA + Σ v · P      for all v that vanish on the supports
//! (B2)  K u = f + (contact and support reactions)
//! (B3)  K_ab = λ A_ab + μ (A_abᵀ + tr A_ab I),   A_ab = ∫ ∇N_a ∇N_bᵀ dV        stiffness.rs
//! (B4)  λ V ḡ_a ḡ_bᵀ,  (B5)  λ V_p b_pa b_pbᵀ    for λ A_ab where ν ≥ 0.45     dilatation.rs
//! (B6)  f_a = ∫ N_a b dV + ∫ N_a p dA + P_a                                    load.rs
//! (B7)  u(x) = a + ω × (x − c)                   what supports have to hold    rigid.rs
//! (B8)  mean of u_j · u_k = δ_jk                  what they leave free          rigid_modes.rs
//! (B9)  η² = ∫ (σ* − σ) : C⁻¹ : (σ* − σ) dV        how wrong the stress is       recovery.rs
//! (B10) div (N_a u_a) = d_a · u_a                 rings strain around the axis  quadrature.rs
//! (B11) K_ab of a ring                                                          stiffness.rs
//! (B12) σ = λ θ I + 2 μ ε + σ₀                    heat and initial stress           prestress.rs
//! (B13) K_ab += ∫ N_a N_b k dA                    springs to the ground            foundation.rs
//! (B14) C = λ̂ I⊗I + R                             constants that differ with direction  orthotropic.rs
//! (B15) K = K_uu − K_uα K_αα⁻¹ K_αu                cells that bend as beams do           modes.rs
//! (B16) Σ a_k u_k = b                             what depends on what             tie.rs
//! (B17) u = T q + E b                             what is left of the unknowns     dependence.rs
//! (B18) ∫ (σ̂ − σ) : C⁻¹ : (σ̂ − σ) dV               a bound of how wrong it is     equilibrated/
//! ```
//!
//! In order: the check of a body, its supports and the motions that they leave free, then stiffness and load
//! vector, and the stress of the displacement found.
//!
//! Plane bodies are 1 m deep in plane strain and as deep as their thickness in
//! plane stress; every force below is for that depth. Forces on an axisymmetric body are
//! those of the whole circumference.
//!
//! A kind of cell is an entry of the table in `kinds.rs`; its shape functions are those of its
//! family in `reference.rs`, its points of quadrature in `gauss.rs`.

mod affine;
mod applied;
mod axis;
mod boundary;
mod cell;
mod check;
mod condensed_cell;
mod cut;
mod dependence;
mod dilatation;
mod element;
mod entries;
mod equilibrated;
mod extremes;
mod facet;
mod fixing;
mod foundation;
mod gauss;
mod incidence;
mod inertia;
mod kinds;
mod load;
mod material;
mod mesh;
mod modes;
mod orthotropic;
mod part;
mod prestress;
mod prism;
mod pyramid;
mod quadrature;
mod recovery;
mod reference;
mod refined;
mod rigid;
mod rigid_modes;
mod sparsity;
mod split;
mod spread;
mod stiffness;
mod stress;
mod structured;
mod support;
#[cfg(test)]
pub(crate) mod tests;
mod tie;
mod turned;

pub use affine::Affine;
pub(crate) use axis::Axis;
pub use axis::Line;
pub(crate) use axis::held_by_axis;
pub(crate) use check::check;
pub(crate) use dependence::{Dependence, dependence};
pub(crate) use extremes::extremes;
pub use extremes::{Extreme, Extremes};
pub(crate) use facet::FacetGeometry;
pub(crate) use facet::{FacetPoint, FacetReference, around};
pub(crate) use kinds::MOST_FACET_NODES;

pub(crate) use equilibrated::stress_error_bound;
pub(crate) use fixing::fixing_dofs;
pub(crate) use foundation::foundation_forces;
pub use foundation::{Foundation, Ground};
pub use kinds::CellKind;
pub(crate) use load::{load_vector, nodal_forces};
pub(crate) use mesh::Cell;
pub use mesh::{Facet, Group, Mesh};
pub use orthotropic::{MaterialAxes, Orthotropic};
pub(crate) use recovery::stress_recovery;
pub(crate) use rigid_modes::{RigidMode, free_modes};
pub use spread::Wrench;
pub(crate) use stiffness::{part_of_stiffness, stiffness};
pub(crate) use stress::{cell_strain, cell_stress, nodal_stress, principal, von_mises};
pub use structured::{box_mesh, graded, mixed_box, rectangle};
pub(crate) use support::prescribed;
pub(crate) use support::prescribed_by;
pub(crate) use tie::OF_TIE;
pub use tie::{Equation, RigidGroup, Source, Tie, TiedPairs};

use crate::error::Error;

/// How strain and stress live in the body's dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Model {
    /// 2D, no strain out of the plane, 1 m deep.
    PlaneStrain,
    /// 2D, no stress out of the plane.
    PlaneStress {
        /// Depth of the plate, in metre.
        thickness: f64,
    },
    /// 2D, the section `x = r ≥ 0`, `y = z` of a body of revolution about the y axis, which turns
    /// about it neither as a whole nor in itself. Nodes on the axis stay there.
    Axisymmetric,
    /// 3D.
    Solid,
}

/// What the displacement of a cell is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Formulation {
    /// Of shape functions alone.
    #[default]
    Standard,
    /// Of quadrilaterals of four nodes and hexahedra of eight also of incompatible modes (B15), with which they bend as
    /// beams do; other cells as in `Standard`.
    IncompatibleModes,
}

/// A linear elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// Young's modulus `E > 0`, in pascal.
    pub young: f64,
    /// Poisson's ratio, `-1 < ν < 0.5`.
    pub poisson: f64,
    /// Thermal expansion α, in 1/kelvin.
    pub expansion: f64,
    /// Mass density `ρ ≥ 0`, in kg/m³.
    pub density: f64,
    /// Constants that differ with direction: they stand for all but the density.
    pub orthotropic: Option<Orthotropic>,
}

/// Nodes whose displacement is given, component by component.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Support {
    /// Where the scene says so, for messages, such as `bodies[0].supports[1]`.
    pub place: String,
    /// The supported nodes.
    pub nodes: Vec<usize>,
    /// Prescribed displacement per axis, in metre; `None` leaves the component free.
    pub displacement: [Option<f64>; 3],
    /// Added to it per node, in metre, as of a rotation; none at all where all nodes move alike.
    pub offsets: Vec<[f64; 3]>,
    /// Orthonormal directions of the components per node; none at all where they are the global axes.
    pub axes: Vec<[[f64; 3]; 3]>,
}

impl Support {
    /// A support of nodes along the global axes, with the components of their displacement that it gives, in metre.
    #[must_use]
    pub fn new(place: &str, nodes: Vec<usize>, displacement: [Option<f64>; 3]) -> Self {
        Self {
            place: place.to_owned(),
            nodes,
            displacement,
            offsets: Vec::new(),
            axes: Vec::new(),
        }
    }
}

/// A given force on the body.
#[derive(Clone, Debug, PartialEq)]
pub enum Load {
    /// Force per area along the inward normal (positive presses), in pascal.
    Pressure {
        /// Loaded facets.
        facets: Vec<Facet>,
        /// Pressure, in pascal.
        pressure: f64,
    },
    /// Force per area in global axes, in pascal.
    Traction {
        /// Loaded facets.
        facets: Vec<Facet>,
        /// Traction, in pascal.
        traction: [f64; 3],
    },
    /// Force per volume in global axes, in N/m³.
    BodyForce {
        /// Loaded cells.
        cells: Vec<usize>,
        /// Force density, in N/m³.
        density: [f64; 3],
    },
    /// Force at a node in global axes, in newton (plane: per metre of depth; axisymmetric: on the
    /// whole ring through the node).
    PointForce {
        /// Loaded node.
        node: usize,
        /// Force, in newton.
        force: [f64; 3],
    },
    /// Force per area along the inward normal that varies with position, in pascal.
    VaryingPressure {
        /// Loaded facets.
        facets: Vec<Facet>,
        /// Pressure, in pascal.
        pressure: Affine,
    },
    /// Force per area in global axes that varies with position, in pascal.
    VaryingTraction {
        /// Loaded facets.
        facets: Vec<Facet>,
        /// Traction per axis, in pascal.
        traction: [Affine; 3],
    },
    /// A force and a moment, spread as tractions.
    Spread {
        /// Loaded facets.
        facets: Vec<Facet>,
        /// What the tractions sum up to.
        wrench: Wrench,
    },
    /// A force and a moment at the reference point of a rigid group: any forces on its nodes with that
    /// resultant are the same.
    AtReference {
        /// Where the scene states the group.
        place: String,
        /// Nodes of the group.
        nodes: Vec<usize>,
        /// What their forces sum up to.
        wrench: Wrench,
    },
    /// Weight: force per volume of the density times an acceleration.
    Gravity {
        /// Loaded cells.
        cells: Vec<usize>,
        /// Acceleration in global axes, in m/s².
        acceleration: [f64; 3],
    },
    /// Force per volume of a steady spin, away from its axis.
    Centrifugal {
        /// Loaded cells.
        cells: Vec<usize>,
        /// The axis: along z in 2D, the body's own if it is axisymmetric.
        axis: Line,
        /// Square of the angular velocity, in 1/s².
        speed_squared: f64,
    },
    /// Heat.
    Temperature {
        /// Heated cells.
        cells: Vec<usize>,
        /// Temperature above that without stress per node of the mesh, in kelvin.
        rise: Vec<f64>,
    },
    /// Stress that is there without any displacement.
    InitialStress {
        /// Stressed cells.
        cells: Vec<usize>,
        /// Stress in the order xx, yy, zz, yz, xz, xy, in pascal.
        stress: [f64; 6],
    },
}

/// An elastic body: mesh, material, supports and loads.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Body {
    /// Name for messages and reports.
    pub name: String,
    /// Nodes, cells and named groups.
    pub mesh: Mesh,
    /// Plane strain, plane stress, axisymmetric or 3D.
    pub model: Model,
    /// The materials.
    pub materials: Vec<Material>,
    /// Index into `materials` per cell.
    pub material_of_cell: Vec<usize>,
    /// Prescribed displacements.
    pub supports: Vec<Support>,
    /// Given forces.
    pub loads: Vec<Load>,
    /// Springs to the ground.
    pub foundation: Vec<Foundation>,
    /// What the displacement of a cell is made of.
    pub formulation: Formulation,
    /// Displacements that depend on each other.
    pub ties: Vec<Tie>,
}

impl Body {
    /// A body on a mesh, every cell of the first of its `materials`, with nothing on it yet.
    #[must_use]
    pub fn new(name: &str, mesh: Mesh, model: Model, materials: Vec<Material>) -> Self {
        Self {
            name: name.to_owned(),
            material_of_cell: vec![0; mesh.cell_count()],
            mesh,
            model,
            materials,
            supports: Vec::new(),
            loads: Vec::new(),
            foundation: Vec::new(),
            formulation: Formulation::Standard,
            ties: Vec::new(),
        }
    }

    /// Stiffness matrix without supports (B3), in N/m: symmetric, both triangles, rows
    /// `dimension · node + axis` with ascending columns.
    ///
    /// # Errors
    ///
    /// The first thing that is wrong with the body, with its place, value and what is accepted.
    pub fn stiffness(&self) -> Result<sprs::CsMat<f64>, Error> {
        check(self)?;
        Ok(stiffness(self))
    }

    /// Prescribed displacement per unknown `dimension · node + axis`, in metre; `None` where free.
    ///
    /// # Errors
    ///
    /// Those of [`Body::stiffness`], and supports that contradict each other.
    pub fn prescribed(&self) -> Result<Vec<Option<f64>>, Error> {
        check(self)?;
        prescribed(self)
    }

    /// Number of rigid motions that the supports leave free (B8): contact alone holds these.
    ///
    /// # Errors
    ///
    /// Those of [`Body::prescribed`].
    pub fn free_motions(&self) -> Result<usize, Error> {
        Ok(free_modes(self, &self.prescribed()?).modes.len())
    }
}
