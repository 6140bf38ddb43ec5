//! What `*DLOAD` and `*DSLOAD` set on faces and elements; where no set is stated, on all elements.

use super::load::{Given, Reader, Slot};
use super::statement::Notes;
use crate::error::Error;
use crate::mesh_file::abaqus::{Row, Space, bare};

impl Reader<'_> {
    /// Pressure on a surface.
    pub(super) fn surface_pressure(&self, row: Row<'_, '_>) -> Result<Vec<Given>, Error> {
        let label = bare(row.word(1));
        if label != "P" {
            return Err(row.error(format!("load `{label}` is not read; accepted: P")));
        }
        let sides = self.contents.surface(row, row.word(0))?;
        let pressure = row.number(2, "a pressure", None)?;
        Ok(sides
            .1
            .iter()
            .map(|&side| (Slot::SurfacePressure(side), pressure))
            .collect())
    }

    /// Pressure on faces, force per volume, weight, spin.
    pub(super) fn distributed(
        &self,
        row: Row<'_, '_>,
        notes: &mut Notes,
    ) -> Result<Vec<Given>, Error> {
        let label = bare(row.word(1));
        let cells = match row.word(0) {
            "" if !label.starts_with('P') => self.all_cells(row, &label, notes),
            word => self.contents.cells.members(row, word)?,
        };
        let value = row.number(2, "a load", None)?;
        let along = |axis: usize| {
            Ok(cells
                .iter()
                .map(|&c| (Slot::Weight(c, axis), value))
                .collect())
        };
        match label.as_str() {
            "BX" => along(0),
            "BY" => along(1),
            "BZ" if self.dimension() == 3 => along(2),
            "GRAV" => self.weight(row, &cells, value),
            "CENTRIF" => self.spin(row, &cells, value),
            _ if label.len() == 2 && label.starts_with('P') => cells
                .into_iter()
                .map(|cell| {
                    let side = self.contents.side(cell, &label, 'P', &self.outer);
                    Ok((Slot::Pressure(side.map_err(|e| row.error(e))?), value))
                })
                .collect(),
            _ => Err(row.error(format!(
                "load `{label}` is not read; accepted: P1 to P6, GRAV, CENTRIF, BX, BY, BZ"
            ))),
        }
    }

    /// The elements of a load on the whole model, for which no set is stated; what has no density has no weight.
    fn all_cells(&self, row: Row<'_, '_>, label: &str, notes: &mut Notes) -> Vec<usize> {
        let all = 0..self.contents.elements.len();
        let dense = |cell: &usize| self.materials.of(*cell).density.is_some();
        if !["GRAV", "CENTRIF"].contains(&label) || !all.clone().any(|cell| dense(&cell)) {
            return all.collect();
        }
        let heavy: Vec<usize> = all.clone().filter(dense).collect();
        if heavy.len() < all.len() {
            notes.add(
                row.card,
                "elements without *DENSITY are left out of the whole model",
            );
        }
        heavy
    }

    fn weight(&self, row: Row<'_, '_>, cells: &[usize], gravity: f64) -> Result<Vec<Given>, Error> {
        let mut direction = [0.0; 3];
        for (axis, component) in direction.iter_mut().enumerate() {
            *component = row.number(3 + axis, "a direction", 0.0)?;
        }
        let length = direction.iter().fold(0.0_f64, |sum, x| sum.hypot(*x));
        if (length - 1.0).abs() > 1e-6 {
            let reason = format!("direction of length {length}; expected one of length 1");
            return Err(row.error(reason));
        }
        let mut given = Vec::new();
        for &cell in cells {
            let density = self.density(row, cell)?;
            let axes = direction.iter().take(self.dimension()).enumerate();
            given.extend(axes.map(|(axis, n)| (Slot::Gravity(cell, axis), density * gravity * n)));
        }
        Ok(given)
    }

    fn density(&self, row: Row<'_, '_>, cell: usize) -> Result<f64, Error> {
        let material = self.materials.of(cell);
        let missing = || row.error(format!("material `{}` has no *DENSITY", material.name));
        material.density.ok_or_else(missing)
    }

    /// Square of an angular velocity, a point of the axis, its direction.
    fn spin(&self, row: Row<'_, '_>, cells: &[usize], squared: f64) -> Result<Vec<Given>, Error> {
        let mut line = [0.0; 6];
        for (at, number) in line.iter_mut().enumerate() {
            *number = row.number(3 + at, "a coordinate", 0.0)?;
        }
        let [x, _, _, a, b, c] = line;
        if squared < 0.0 || [a, b, c] == [0.0; 3] {
            let reason = "expected the square of an angular velocity from 0, a point and a direction of the axis";
            return Err(row.error(reason));
        }
        let astray = match self.parts.parts.first().map(|part| part.space) {
            Some(Space::Solid) | None => None,
            Some(Space::Axisymmetric) => {
                (x != 0.0 || a != 0.0 || c != 0.0).then_some("the y axis, of which these are rings")
            }
            Some(_) => (a != 0.0 || b != 0.0).then_some("an axis along z, across the plane"),
        };
        if let Some(accepted) = astray {
            return Err(row.error(format!("another axis; expected {accepted}")));
        }
        for &cell in cells {
            self.density(row, cell)?;
        }
        let line = line.map(|x| (x + 0.0).to_bits());
        Ok(cells
            .iter()
            .map(|&cell| (Slot::Spin(cell, line), squared))
            .collect())
    }
}
