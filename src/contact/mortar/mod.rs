//! MORTAR: how the contact nodes of one deformable side see the other side.
//!
//! ```text
//! (C7)   ∫ ψ_i N_j dA = δ_ij D_i,   D_i = ∫ N_i dA          over the covered part of each facet
//! (C8)   P_e = M_e⁻¹ B_e            M_e = ∫ N_i N_j dA,  B_e = ∫ N_i N²_k dA
//! (C9)   P_i = Σ_e D_ei P_ei / D_i,   n_i ∥ Σ_e ∫ N_i (n − n²) dA
//! (C10)  Σ_k P_ik x²_k − x_i ∥ n_i
//! (C20)  g_i = (Σ_k P_ik x²_k − x_i) · n_i − Σ_e ∫ ψ_i b' dA / D_i + l_i,   l_i ≥ min γ − Σ_e ∫ ψ_i γ dA / D_i
//! ```
//!
//! The dual multipliers `ψ_i = Σ_j A_ij N_j`, `A = D_e M_e⁻¹`, live on side 1 and make the
//! coupling a row per contact node: `u_i − Σ_k P_ik u²_k` is the relative displacement
//! that belongs to the nodal reaction `t_i`, and side 2 feels `−P_ik t_i`. Since
//! `∫ ψ_i N²_k dA = D_i (P_e)_ik`, the mortar weights are a facet-wise least-squares
//! projection (C8), averaged at the nodes (C9). What is integrated is only the part of a
//! facet that the other side covers, so a face that overhangs still carries a constant
//! pressure exactly. Where the cover ends within a facet the `N_i` are those of the covered part (C19).
//!
//! The normal is that of the mean surface of both sides, the same from either of them; where these are far
//! apart, or far from parallel, that of the gap (C10). A dual
//! multiplier has two signs, so the mean of a gap under it may be less than the gap is anywhere: then
//! bodies would be pressed apart that do not touch. It is lifted by what the mean of γ lacks to the least γ
//! on the contact's facets (C20), the distance between the smooth surfaces (C18) along the facets' normals: of a fit
//! on curved facets, where γ is the same everywhere, nothing, although seen along one normal it is not.
//!
//! (C10) is what keeps moments: forces and reactions meet on one line. On a symmetry plane the mirror
//! image does that, and across the plane the weights stay as they are.
//!
//! Quadratic facets of side 1 carry the dual multipliers of the linear `φ_j` at their corners
//! (C16); those of side 2 enter by their own `N²_k`.
//!
//! | step | file |
//! |---|---|
//! | facets fit for contact, in linear pieces | `check`, `pieces` |
//! | what lies over a facet, at any distance | `coverage`, `search` |
//! | a facet's plane, the others seen in it | `view` |
//! | polygons: intersection, difference, area | `polygon` |
//! | the parts of a facet and what covers them | `cover`, `seen`, `flush` |
//! | bodies that are in each other | `overlap` |
//! | Gauss points over a polygon | `quadrature` |
//! | functions on facets that are covered in part (C19) | `patch`; in 2D `trim`, `join` |
//! | the same in 3D (C21) | `tiling`: `tile`, `standing`, `spread`; of equals the first: `ties` |
//! | integrals and projection of a patch (C7), (C8) | `projection` |
//! | sum over the patches (C9), gaps (C20) | `coupling` |
//! | forces that meet on one line (C10) | `alignment` |
//!
//! Dual multipliers: Wohlmuth, SIAM J. Numer. Anal. 38 (2000) 989–1012. Clipped polygons:
//! Puso & Laursen, Comput. Methods Appl. Mech. Engrg. 193 (2004) 601–629. Covered parts:
//! Cichosz & Bischoff, Comput. Methods Appl. Mech. Engrg. 200 (2011) 1317–1332.

mod alignment;
mod check;
mod coupling;
mod cover;
mod coverage;
mod flush;
mod join;
mod overlap;
mod patch;
mod pieces;
mod polygon;
mod projection;
mod quadrature;
mod search;
mod seen;
mod spread;
mod standing;
#[cfg(test)]
mod tests;
mod ties;
mod tile;
mod tiling;
mod trim;
mod view;

pub(in crate::contact) use check::Surface;
pub(in crate::contact) use coupling::average;
#[cfg(test)]
pub(in crate::contact) use coupling::couple;
pub(in crate::contact) use coverage::{Coverage, Ends};
pub(in crate::contact) use overlap::Overlaps;

use super::lift::Distances;

/// The contacts of side 1, each with the nodes of side 2 that it meets.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Mortar {
    /// Contacts in the order in which the facets of side 1 name them.
    pub nodes: Vec<MortarNode>,
}

/// A contact of side 1 and its share of side 2.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MortarNode {
    /// Node of side 1's mesh: a corner.
    pub node: usize,
    /// The corner is beyond the cover: the contact stands at the end of the cover, where its own
    /// nodes have their mean.
    pub moved: bool,
    /// The nodes of side 1's mesh that it moves with and their weights, which sum to one (C16);
    /// its own node alone where its facets are linear and it has not moved.
    pub own: Vec<(usize, f64)>,
    /// `D_i = ∫ N_i dA` over what the other side covers, in m² (2D: in metre).
    pub weight: f64,
    /// Unit normal towards the other side: that of the mean surface of both sides (C9).
    pub normal: [f64; 3],
    /// Nodes of side 2's mesh, ascending, with their weights `P_ik`, which sum to one.
    pub opposite: Vec<(usize, f64)>,
    /// Mean of what facets leave of the gap (C18), in metre.
    pub bulge: f64,
    /// Mean of what facets leave of the gap once it is pressed (C23), or zero if nothing is rounded, in metre.
    pub taken: f64,
    /// Distances of the sides under its dual function and on its facets (C20).
    distances: Distances,
    /// `Σ_k P_ik x²_k − x_i`, in metre, where `x_i` is the mean of its own nodes.
    pub gap_vector: [f64; 3],
    /// The gap (C20) in metre; negative where the sides overlap.
    pub initial_gap: f64,
    /// Share of the node's tributary area that the other side covers, at most 1.
    pub covered: f64,
}
