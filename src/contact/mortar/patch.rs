//! Where the pressures of some contacts live: a facet, or several that are joined.
//!
//! ```text
//! (C19)  φ_i = Σ_c V_ic h_c          h_c: linear on a facet, one at its corner c
//!        φ_i(y_j) = δ_ij             y_j: where contact j stands
//! ```
//!
//! The functions of a patch are linear on each of its facets and add up to one. Where the other side covers
//! all of a facet its contacts stand at the corners and the functions are those of the corners, `V = 1`.
//! Otherwise `trim` says where they stand, and `join` which facets share them.

/// Most contacts of a patch.
pub(super) const MOST_CONTACTS: usize = 4;

/// What tells the contacts of a side apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Stand {
    /// The corner at which it stands, or would without the end of the cover.
    pub(super) node: usize,
    /// The facet that is covered in part, on which it has moved to the end of the cover.
    pub(super) moved: Option<usize>,
}

impl Stand {
    /// At a corner.
    pub(super) fn at(node: usize) -> Self {
        Self { node, moved: None }
    }
}

/// A facet of a patch.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Member {
    /// Number of the facet on its side.
    pub(super) facet: usize,
    /// `V`: values of each function at the facet's corners.
    pub(super) values: [[f64; 4]; MOST_CONTACTS],
}

/// Facets with the functions of some contacts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Patch {
    pub(super) stands: Vec<Stand>,
    pub(super) members: Vec<Member>,
    /// `h_c(y_i)` where the patch is a single facet: corners' shares in where each contact stands.
    pub(super) shares: Option<[[f64; 4]; MOST_CONTACTS]>,
}

impl Patch {
    /// A facet whose contacts stand at its corners.
    pub(super) fn whole(facet: usize, corners: &[usize]) -> Self {
        let mut one = [[0.0; 4]; MOST_CONTACTS];
        for (corner, row) in one.iter_mut().enumerate().take(corners.len()) {
            row[corner] = 1.0;
        }
        Self {
            stands: corners.iter().map(|&node| Stand::at(node)).collect(),
            members: vec![Member { facet, values: one }],
            shares: Some(one),
        }
    }
}

impl Member {
    /// Values of the functions where those of the corners are `hats`.
    pub(super) fn functions(&self, hats: &[f64; 4]) -> [f64; MOST_CONTACTS] {
        self.values
            .map(|row| row.iter().zip(hats).map(|(value, hat)| value * hat).sum())
    }
}
