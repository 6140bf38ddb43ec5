//! The contact problem of a half-space: plain numbers, one contact per cell.

use std::sync::Arc;

use super::operator::{HalfSpace, Surroundings};
use super::outcome::HalfSpaceOutcome;
use super::range::check_range;
use super::vectors::{Pair, zero_pair};
use crate::error::{Error, check_finite, check_length};

/// Largest number of metre or newton.
const LARGEST: f64 = 1e50;

/// How the other side is pressed on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Press {
    /// By how much it comes closer, in metre.
    Approach(f64),
    /// With what force, `Σ −t_N`, in N; the approach is a result.
    Load(f64),
}

/// How the other side is dragged along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drag {
    /// By how much it moves along x and y, in metre.
    Shift([f64; 2]),
    /// What force it gives to the half-space along x and y, `Σ t_T`, in N; the shift is a result.
    Force([f64; 2]),
}

/// Find reactions `t` on the cells and displacements `u = û + G t` with (L1)–(L3).
#[derive(Clone, Debug)]
pub struct HalfSpaceProblem {
    pub(super) operator: Arc<HalfSpace>,
    pub(super) friction: Vec<f64>,
    pub(super) initial_gap: Vec<f64>,
    pub(super) press: Press,
    pub(super) drag: Drag,
    pub(super) reference: Pair,
}

impl HalfSpaceProblem {
    /// A problem that starts without slip and without drag.
    ///
    /// - `initial_gap`: in metre per cell, before loading and without approach;
    /// - `friction`: coefficient `μ ≥ 0`, one per cell or one for all.
    ///
    /// # Errors
    ///
    /// A length that does not fit, a NaN or a number beyond 1e50, a negative coefficient, a load that
    /// pulls, an approach on a periodic surface, whose mean no pressure moves.
    pub fn new(
        operator: Arc<HalfSpace>,
        initial_gap: Vec<f64>,
        friction: &[f64],
        press: Press,
    ) -> Result<Self, Error> {
        let cells = operator.grid().len();
        check_length("initial_gap", cells, initial_gap.len())?;
        check_size("initial_gap", &initial_gap)?;
        check_press(press, operator.surroundings())?;
        Ok(Self {
            friction: friction_per_cell(friction, cells)?,
            initial_gap,
            press,
            drag: Drag::Shift([0.0; 2]),
            reference: zero_pair(cells),
            operator,
        })
    }

    /// The same problem, dragged.
    ///
    /// # Errors
    ///
    /// A NaN or infinity.
    pub fn dragged(mut self, drag: Drag) -> Result<Self, Error> {
        match drag {
            Drag::Shift(shift) => check_size("shift", &shift)?,
            Drag::Force(force) => check_size("force", &force)?,
        }
        self.drag = drag;
        Ok(self)
    }

    /// The same problem, pressed otherwise.
    ///
    /// # Errors
    ///
    /// As [`HalfSpaceProblem::new`].
    pub fn pressed(mut self, press: Press) -> Result<Self, Error> {
        check_press(press, self.operator.surroundings())?;
        self.press = press;
        Ok(self)
    }

    /// The same problem with other coefficients of friction, one per cell or one for all.
    ///
    /// # Errors
    ///
    /// As [`HalfSpaceProblem::new`].
    pub fn with_friction(mut self, friction: &[f64]) -> Result<Self, Error> {
        self.friction = friction_per_cell(friction, self.friction.len())?;
        Ok(self)
    }

    /// The same problem, whose slip counts from `reference` on: relative displacement along x and y
    /// that the contacts had before, in metre per cell (C13).
    ///
    /// # Errors
    ///
    /// A length that does not fit, a NaN or infinity.
    pub fn after(mut self, reference: [Vec<f64>; 2]) -> Result<Self, Error> {
        for (part, place) in reference.iter().zip(["reference[0]", "reference[1]"]) {
            check_length(place, self.operator.grid().len(), part.len())?;
            check_size(place, part)?;
        }
        self.reference = reference;
        Ok(self)
    }

    /// The same problem after a solved one: slip counts from where that left the contacts, and open
    /// ones begin a new slip where they stand.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] if the outcome is not of the problem's cells.
    pub fn following(self, outcome: &HalfSpaceOutcome) -> Result<Self, Error> {
        let total = self.moved_so_far(outcome);
        self.after(total)
    }

    /// Relative displacement along x and y since the first step, in metre per cell.
    pub(super) fn moved_so_far(&self, outcome: &HalfSpaceOutcome) -> Pair {
        [0, 1].map(|axis| {
            let pairs = outcome.slip[axis].iter().zip(&self.reference[axis]);
            pairs.map(|(slip, before)| slip + before).collect()
        })
    }

    /// The operator `G`.
    #[must_use]
    pub fn operator(&self) -> &Arc<HalfSpace> {
        &self.operator
    }

    /// Gap before loading, in metre per cell.
    #[must_use]
    pub fn initial_gap(&self) -> &[f64] {
        &self.initial_gap
    }

    /// Coefficient of friction per cell.
    #[must_use]
    pub fn friction(&self) -> &[f64] {
        &self.friction
    }

    /// How the other side is pressed on.
    #[must_use]
    pub fn press(&self) -> Press {
        self.press
    }

    /// How the other side is dragged.
    #[must_use]
    pub fn drag(&self) -> Drag {
        self.drag
    }

    /// Cells at the border that press under such normal reactions, where a contact would go on with the body;
    /// none of a periodic grid, nor of a flat punch that ends with the grid.
    pub(super) fn pressing_at_border(&self, normal: &[f64]) -> usize {
        let grid = self.operator.grid();
        let edge: Vec<usize> = (0..grid.len())
            .filter(|&cell| grid.at_border(cell))
            .collect();
        let pressing = edge.iter().filter(|&&cell| normal[cell] < 0.0).count();
        let level = |cell: &usize| self.initial_gap[*cell] == self.initial_gap[edge[0]];
        let punch = normal.iter().all(|t_n| *t_n < 0.0) && edge.iter().all(level);
        match self.operator.surroundings() == Surroundings::Periodic || punch {
            true => 0,
            false => pressing,
        }
    }

    /// Whether any contact has friction.
    pub(super) fn has_friction(&self) -> bool {
        self.friction.iter().any(|&mu| mu > 0.0)
    }
}

/// Finite, and small enough for squares of products.
fn check_size(place: &str, values: &[f64]) -> Result<(), Error> {
    check_finite(place, values)?;
    let Some(at) = values.iter().position(|value| value.abs() > LARGEST) else {
        return Ok(());
    };
    let place = match values.len() {
        1 => place.to_owned(),
        _ => format!("{place}[{at}]"),
    };
    check_range(
        place,
        values[at],
        false,
        "at most 1e50: choose larger units",
    )
}

fn friction_per_cell(friction: &[f64], cells: usize) -> Result<Vec<f64>, Error> {
    check_finite("friction", friction)?;
    if let Some(at) = friction.iter().position(|&mu| mu < 0.0) {
        check_range(
            format!("friction[{at}]"),
            friction[at],
            false,
            "friction >= 0",
        )?;
    }
    let friction = match friction {
        [all] => vec![*all; cells],
        each => each.to_vec(),
    };
    check_length("friction", cells, friction.len())?;
    Ok(friction)
}

fn check_press(press: Press, surroundings: Surroundings) -> Result<(), Error> {
    match press {
        Press::Load(load) => {
            check_size("load", &[load])?;
            check_range(
                "load",
                load,
                load >= 0.0,
                "load >= 0: the sum of what presses",
            )
        }
        Press::Approach(_) if surroundings == Surroundings::Periodic => Err(Error::NotAccepted {
            place: "approach".to_owned(),
            found: "an approach on a periodic half-space".to_owned(),
            accepted: "a load: a mean pressure moves no periodic half-space by a finite amount"
                .to_owned(),
        }),
        Press::Approach(approach) => check_size("approach", &[approach]),
    }
}
