//! MORTAR: how the contact nodes of one deformable side see the other side.
//!
//! ```text
//! (C7)   ∫ ψ_i N_j dA = δ_ij D_i,   D_i = ∫ N_i dA          over the covered part of each facet
//! (C8)   P_e = M_e⁻¹ B_e            M_e = ∫ N_i N_j dA,  B_e = ∫ N_i N²_k dA
//! (C9)   P_i = Σ_e D_ei P_ei / D_i,   g_i = (Σ_k P_ik x²_k − x_i) · n_i
//! (C10)  Σ_k P_ik x²_k − x_i = g_i n_i
//! ```
//!
//! The dual multipliers `ψ_i = Σ_j A_ij N_j`, `A = D_e M_e⁻¹`, live on side 1 and make the
//! coupling a row per contact node: `u_i − Σ_k P_ik u²_k` is the relative displacement
//! that belongs to the nodal reaction `t_i`, and side 2 feels `−P_ik t_i`. Since
//! `∫ ψ_i N²_k dA = D_i (P_e)_ik`, the mortar weights are a facet-wise least-squares
//! projection (C8), averaged at the nodes (C9). What is integrated is only the part of a
//! facet that the other side covers, so a face that overhangs still carries a constant
//! pressure exactly.
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
//! | what lies over a facet, at any distance | `search` |
//! | a facet's plane, the others seen in it | `view` |
//! | polygons: intersection, difference, area | `polygon` |
//! | the parts of a facet and what covers them | `cover` |
//! | bodies that are in each other | `overlap` |
//! | Gauss points over a polygon | `quadrature` |
//! | integrals and projection of a facet (C7), (C8) | `projection` |
//! | sum over the facets (C9) | `coupling` |
//! | forces that meet on one line (C10) | `alignment` |
//!
//! Dual multipliers: Wohlmuth, SIAM J. Numer. Anal. 38 (2000) 989–1012. Clipped polygons:
//! Puso & Laursen, Comput. Methods Appl. Mech. Engrg. 193 (2004) 601–629. Covered parts:
//! Cichosz & Bischoff, Comput. Methods Appl. Mech. Engrg. 200 (2011) 1317–1332.

mod alignment;
mod check;
mod coupling;
mod cover;
mod overlap;
mod pieces;
mod polygon;
mod projection;
mod quadrature;
mod search;
#[cfg(test)]
mod tests;
mod view;

pub(in crate::contact) use coupling::average;
#[cfg(test)]
pub(in crate::contact) use coupling::couple;

/// The contact nodes of side 1, each with the nodes of side 2 that it meets.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Mortar {
    /// Contact nodes in the order in which the facets of side 1 name them.
    pub nodes: Vec<MortarNode>,
}

/// A node of side 1 and its share of side 2.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MortarNode {
    /// Node of side 1's mesh: a corner.
    pub node: usize,
    /// The nodes of side 1's mesh that it moves with and their weights, which sum to one (C16);
    /// its own node alone where its facets are linear.
    pub own: Vec<(usize, f64)>,
    /// `D_i = ∫ N_i dA` over what the other side covers, in m² (2D: in metre).
    pub weight: f64,
    /// Unit normal towards the other side: the mean over the covered facets around the node.
    pub normal: [f64; 3],
    /// Nodes of side 2's mesh, ascending, with their weights `P_ik`, which sum to one.
    pub opposite: Vec<(usize, f64)>,
    /// `Σ_k P_ik x²_k − x_i`, in metre, where `x_i` is the mean of its own nodes.
    pub gap_vector: [f64; 3],
    /// The gap vector along the normal, in metre; negative where the sides overlap.
    pub initial_gap: f64,
    /// Share of the node's tributary area that the other side covers, at most 1.
    pub covered: f64,
}
