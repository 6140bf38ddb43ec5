//! A half-step's program on its working set.
//!
//! A contact that is predicted open has no variable, one predicted firmly pressed or
//! stuck has no cone and is eliminated, the others keep their cones. A wrong
//! prediction costs time, never the answer: each half-step checks all contacts and
//! gives whoever breaks its prediction the cone back.

use faer::MatRef;

use super::clarabel::ConeProgram;
use super::elimination::{Elimination, gather};

/// A contact's place in the program of a half-step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// No variable: its reaction is zero.
    Absent,
    /// A variable without a cone: firmly pressed, or firmly stuck.
    Free,
    /// A variable in its cone.
    Cone,
}

/// What a half-step took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HalfStepWork {
    /// Programs handed to the cone solver.
    pub programs: usize,
    /// Interior-point iterations over these.
    pub iterations: usize,
    /// Largest number of contacts that had a cone.
    pub cones: usize,
}

/// `min ½ x·P x + q·x` over the unknowns of a working set; all other unknowns are zero.
pub(super) struct ReducedProgram {
    free: Vec<usize>,
    cone: Vec<usize>,
    elimination: Option<Elimination>,
    program: Option<ConeProgram>,
}

/// The cones of a program.
pub(super) enum Cones<'a> {
    /// `x ≤ 0`.
    Nonpositive,
    /// Discs of the given dimensions.
    Discs(&'a [usize]),
}

impl ReducedProgram {
    /// Sets up the program; `None` if the form is singular on the free unknowns.
    pub(super) fn new(
        form: MatRef<'_, f64>,
        free: Vec<usize>,
        cone: Vec<usize>,
        cones: &Cones<'_>,
    ) -> Option<Self> {
        let set_up = |quadratic: MatRef<'_, f64>| match cones {
            Cones::Nonpositive => ConeProgram::nonpositive(quadratic),
            Cones::Discs(dimensions) => ConeProgram::discs(quadratic, dimensions),
        };
        let elimination = if free.is_empty() {
            None
        } else {
            Some(Elimination::new(form, &free, &cone)?)
        };
        let program = match &elimination {
            _ if cone.is_empty() => None,
            Some(elimination) => Some(set_up(elimination.reduced.as_ref())?),
            None => Some(set_up(gather(form, &cone, &cone).as_ref())?),
        };
        Some(Self {
            free,
            cone,
            elimination,
            program,
        })
    }

    /// Writes the minimiser into `x` at the working set's unknowns and returns the iterations.
    ///
    /// `linear` is q for every unknown of the form, `bounds` one number per disc.
    pub(super) fn minimise(
        &mut self,
        linear: &[f64],
        bounds: &[f64],
        tolerance: f64,
        x: &mut [f64],
    ) -> Option<usize> {
        let mut cone_linear: Vec<f64> = self.cone.iter().map(|&i| linear[i]).collect();
        let mut free_part = None;
        if let Some(elimination) = &self.elimination {
            let free_linear: Vec<f64> = self.free.iter().map(|&i| linear[i]).collect();
            let (y, reduced) = elimination.reduce(&free_linear, &cone_linear);
            cone_linear = reduced;
            free_part = Some((elimination, y));
        }
        let (mut cone_x, mut iterations) = (Vec::new(), 0);
        if let Some(program) = &mut self.program {
            let solution = program.solve(&cone_linear, bounds, tolerance)?;
            (cone_x, iterations) = (solution.x, solution.iterations);
        }
        for (&unknown, &value) in self.cone.iter().zip(&cone_x) {
            x[unknown] = value;
        }
        if let Some((elimination, y)) = free_part {
            for (&unknown, value) in self.free.iter().zip(elimination.recover(&y, &cone_x)) {
                x[unknown] = value;
            }
        }
        Some(iterations)
    }

    /// Whether a cone program is part of it.
    pub(super) fn has_cones(&self) -> bool {
        self.program.is_some()
    }
}
