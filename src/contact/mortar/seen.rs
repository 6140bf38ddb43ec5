//! What is seen from a piece of side 1.

use super::cover::Part;
use super::view::{Outline, View};

/// A piece of side 1 and what covers it.
pub(super) struct Seen {
    pub(super) view: View,
    pub(super) outline: Outline,
    pub(super) parts: Vec<Part>,
}

impl Seen {
    /// Distances to what covers the parts, in metre.
    pub(super) fn distances(&self) -> impl Iterator<Item = f64> {
        let parts = self.parts.iter();
        parts.map(|part| part.distance * self.view.size)
    }
}
