//! Fields of a half-space's grid as VTK image.

use super::document::{Document, Section};
use crate::half_space::HalfSpaceProblem;
use crate::report::half_space::HalfSpaceField;

/// The cells of the grid with their fields, one layer below z = 0.
#[must_use]
pub fn half_space_vti(problem: &HalfSpaceProblem, fields: &[HalfSpaceField]) -> String {
    let grid = problem.operator().grid();
    let origin = [0, 1].map(|axis| -0.5 * grid.cells[axis] as f64 * grid.spacing[axis]);
    let mut document = Document::image(origin, grid.spacing, grid.cells);
    document.section(Section::Cells, |document| {
        for field in fields {
            document.reals(field.name, 1, field.values.iter().copied());
        }
    });
    document.finish_image()
}
