//! What is told of half-spaces: totals and certificate of every step, fields as arrays.

use std::fmt::Write;

use serde::Serialize;

use super::table::{Cell, Table};
use crate::error::Error;
use crate::half_space::{
    HalfSpaceOutcome, HalfSpaceProblem, HalfSpaceStatus, clusters, power_spectrum,
};

/// The whole report of a scene of half-spaces.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HalfSpaceReport {
    /// Title of the scene.
    pub title: String,
    /// Units of the scene.
    pub units: String,
    /// The steps, at least one.
    pub steps: Vec<HalfSpaceStep>,
}

/// Totals and certificate of one step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HalfSpaceStep {
    /// Number, from 1.
    pub step: usize,
    /// `certified`, `not_converged` or `no_equilibrium`.
    pub status: &'static str,
    /// Natural map, relative to the reactions.
    pub residual: f64,
    /// Departure from given resultants, relative.
    pub resultant_defect: f64,
    /// Departure of the convolution from direct summation, relative.
    pub operator_defect: f64,
    /// `Σ −t_N`, in N.
    pub load: f64,
    /// Approach, in metre.
    pub approach: f64,
    /// `Σ t_T`, in N.
    pub force: [f64; 2],
    /// Shift of the other side, in metre.
    pub shift: [f64; 2],
    /// Cells that are open.
    pub open: usize,
    /// Cells that stick.
    pub stick: usize,
    /// Cells that slip.
    pub slip: usize,
    /// Area in contact, in m², and as part of the grid.
    pub contact_area: f64,
    /// The same as part of the grid.
    pub area_fraction: f64,
    /// Clusters of cells in contact.
    pub clusters: usize,
    /// Area of the largest, in m².
    pub largest_cluster: f64,
    /// Largest pressure, in Pa.
    pub peak_pressure: f64,
    /// Cells at the border of a grid that is not periodic that press.
    pub at_border: usize,
    /// What to know before the numbers are used, such as that the grid is too small.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Outer iterations.
    pub outer: usize,
    /// Applications of G.
    pub applications: f64,
    /// Steps of one cell until rolling was steady.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rolled: Option<usize>,
}

/// A field of the cells, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfSpaceField {
    /// Such as `pressure`.
    pub name: &'static str,
    /// A number per cell.
    pub values: Vec<f64>,
}

impl HalfSpaceStep {
    /// Sums up an outcome; `rolled`: steps of rolling, if it rolled.
    #[must_use]
    pub fn new(
        number: usize,
        problem: &HalfSpaceProblem,
        outcome: &HalfSpaceOutcome,
        rolled: Option<usize>,
    ) -> Self {
        let (operator, certificate) = (problem.operator(), &outcome.certificate);
        let (grid, normal) = (operator.grid(), &outcome.state.reaction[0]);
        let area = grid.cell_area();
        let found = clusters(grid, operator.surroundings(), |cell| normal[cell] < 0.0);
        let sum = |component: usize| outcome.state.reaction[component].iter().sum::<f64>();
        let pressed = certificate.stick + certificate.slip;
        Self {
            step: number,
            status: match outcome.status {
                HalfSpaceStatus::Certified => "certified",
                HalfSpaceStatus::NotConverged => "not_converged",
                HalfSpaceStatus::NoEquilibrium => "no_equilibrium",
            },
            residual: certificate.residual,
            resultant_defect: certificate.resultant_defect,
            operator_defect: certificate.operator_defect,
            load: 0.0 - sum(0),
            approach: outcome.state.approach,
            force: [sum(1), sum(2)],
            shift: outcome.state.shift,
            open: certificate.open,
            stick: certificate.stick,
            slip: certificate.slip,
            contact_area: pressed as f64 * area,
            area_fraction: pressed as f64 / grid.len() as f64,
            clusters: found.len(),
            largest_cluster: found.first().map_or(0.0, |cells| *cells as f64 * area),
            peak_pressure: normal.iter().fold(0.0_f64, |most, t_n| most.max(-t_n)) / area,
            at_border: outcome.at_border,
            notes: at_border(outcome.at_border).into_iter().collect(),
            outer: outcome.work.outer,
            applications: outcome.work.applications(),
            rolled,
        }
    }

    /// The step as a row of a table.
    pub(crate) fn row(&self) -> Vec<(String, Cell)> {
        let counts = [
            ("step", self.step),
            ("open", self.open),
            ("stick", self.stick),
            ("slip", self.slip),
            ("clusters", self.clusters),
            ("at_border", self.at_border),
        ];
        let numbers = [
            ("load", self.load),
            ("approach", self.approach),
            ("force_x", self.force[0]),
            ("force_y", self.force[1]),
            ("shift_x", self.shift[0]),
            ("shift_y", self.shift[1]),
            ("contact_area", self.contact_area),
            ("area_fraction", self.area_fraction),
            ("largest_cluster", self.largest_cluster),
            ("peak_pressure", self.peak_pressure),
            ("residual", self.residual),
            ("applications", self.applications),
        ];
        let counts = counts.map(|(name, count)| (name.to_owned(), Cell::Count(count)));
        let numbers = numbers.map(|(name, value)| (name.to_owned(), Cell::Number(value)));
        let status = ("status".to_owned(), Cell::Word(self.status.into()));
        counts.into_iter().chain(numbers).chain([status]).collect()
    }

    /// Whether the judge certified the step.
    #[must_use]
    pub fn certified(&self) -> bool {
        self.status == "certified"
    }
}

impl HalfSpaceReport {
    /// As JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Plain numbers and words: nothing in it can fail to be written.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// A row per step: load, area and approach are columns, from which stiffness follows.
    #[must_use]
    pub fn table(&self) -> Table {
        let mut table = Table::default();
        for step in &self.steps {
            table.add(step.row());
        }
        table
    }

    /// A few lines per step, for people.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = format!("{}\n", self.title);
        for step in &self.steps {
            let pressed = step.stick + step.slip;
            // Writing to a string cannot fail.
            let _ = write!(
                text,
                "step {}: {}, residual {:.1e}, operator {:.1e}\n  \
                 load {:.6e}, approach {:.6e}, force ({:.6e}, {:.6e}), shift ({:.6e}, {:.6e})\n  \
                 {pressed} cells in {} clusters touch ({:.2} %), {} stick, {} slip, peak pressure {:.6e}\n  \
                 {} outer iterations, {:.0} applications of G{}\n",
                step.step,
                step.status.replace('_', " "),
                step.residual,
                step.operator_defect,
                step.load,
                step.approach,
                step.force[0],
                step.force[1],
                step.shift[0],
                step.shift[1],
                step.clusters,
                100.0 * step.area_fraction,
                step.stick,
                step.slip,
                step.peak_pressure,
                step.outer,
                step.applications,
                step.rolled.map_or(String::new(), |n| format!(
                    ", steady after {n} cells of rolling"
                )),
            );
            for note in &step.notes {
                let _ = writeln!(text, "  note: {note}");
            }
        }
        text
    }
}

/// The note on contact that reaches the border of the grid.
fn at_border(cells: usize) -> Option<String> {
    let (several, press) = if cells == 1 { ("", "es") } else { ("s", "") };
    (cells > 0).then(|| {
        format!(
            "{cells} cell{several} at the border of the grid press{press}: the contact is cut off there and \
             pressures near it are wrong; enlarge `half_space.size`, with as many more `cells`, unless the \
             body ends with the grid"
        )
    })
}

/// Pressure and shear in Pa, gap and slip in metre, at every cell.
#[must_use]
pub fn half_space_fields(
    problem: &HalfSpaceProblem,
    outcome: &HalfSpaceOutcome,
) -> Vec<HalfSpaceField> {
    let area = problem.operator().grid().cell_area();
    let [normal, x, y] = &outcome.state.reaction;
    let field = |name, values: &[f64], factor: f64| HalfSpaceField {
        name,
        values: values.iter().map(|value| 0.0 + factor * value).collect(),
    };
    vec![
        field("pressure", normal, -1.0 / area),
        field("shear_x", x, 1.0 / area),
        field("shear_y", y, 1.0 / area),
        field("gap", &outcome.gap, 1.0),
        field("slip_x", &outcome.slip[0], 1.0),
        field("slip_y", &outcome.slip[1], 1.0),
    ]
}

/// Power spectrum of the gap before loading, a ring of waves per row: wave number in 1/m, power in m⁴ (of a
/// line m³), number of waves.
///
/// # Errors
///
/// None once the problem stands.
pub fn spectrum_table(problem: &HalfSpaceProblem) -> Result<Table, Error> {
    let operator = problem.operator();
    let (grid, around) = (operator.grid(), operator.surroundings());
    let mut table = Table::default();
    for ring in power_spectrum(grid, around, problem.initial_gap())? {
        let row = [
            ("wave_number", Cell::Number(ring.wave_number)),
            ("power", Cell::Number(ring.power)),
            ("waves", Cell::Count(ring.waves)),
        ];
        table.add(row.map(|(name, cell)| (name.to_owned(), cell)));
    }
    Ok(table)
}

/// A field as a NumPy array of rows along x, version 1.0.
#[must_use]
pub fn npy(problem: &HalfSpaceProblem, field: &HalfSpaceField) -> Vec<u8> {
    let [columns, rows] = problem.operator().grid().cells;
    let header =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    // Numbers start at a multiple of 64 bytes, behind 10 bytes, the header and a line's end.
    let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(format!("{header:<width$}\n", width = length - 1).as_bytes());
    bytes.extend(field.values.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}
