//! The finish: semismooth Newton on the laws of contact, in stiffness form.
//!
//! With `t = S (u − û)` the displacement is the unknown, and each contact's state
//! takes its equations from the point `p = t − ρ (u − g)` of the natural map
//! (Alart, Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353–375):
//!
//! ```text
//!        open     p_N ≥ 0                t = 0                                       unknown: u
//!        stick    ‖p_T‖ ≤ −μ t_N         u_N = g₀,  u_T = 0                          unknown: none
//! (D4)   slip     ‖p_T‖ > −μ t_N         u_N = g₀,                                   unknown: u_T
//!                     (1 − M) t_T + μ d t_N + ρ M u_T = 0
//!                     d = p_T/‖p_T‖,   M = γ (1 − d dᵀ),   γ = −μ t_N/‖p_T‖
//! ```
//!
//! Reactions are kept and corrected by `S δu` with small `δu`, so that the digits of
//! the result are those of `u = û + G t`, whatever the condition of S. Between bodies that
//! float S is that of (D5), and every step restores their equilibrium.

use std::ops::Range;

use faer::linalg::matmul::matmul;
use faer::linalg::solvers::Solve;
use faer::{Accum, Col, ColMut, ColRef, Mat, Par};
use nalgebra::Matrix3;

use super::iterate::{Iterate, Step};
use super::stiffness::Stiffness;
use crate::problem::ContactProblem;

/// A slip is followed this far to its end: the contact is then on the side of stick.
const BEYOND: f64 = 1.0 + 1e-6;

/// One contact's state and what (D4) needs of it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Open,
    Stick,
    Slip {
        direction: [f64; 2],
        /// γ: the bound over ‖p_T‖, below one.
        ratio: f64,
    },
}

/// Newton steps on one problem.
pub(super) struct Finish<'a> {
    problem: &'a ContactProblem,
    stiffness: Stiffness<'a>,
}

impl<'a> Finish<'a> {
    /// `None` where the compliance has no inverse.
    pub(super) fn new(problem: &'a ContactProblem) -> Option<Self> {
        Some(Self {
            problem,
            stiffness: Stiffness::new(problem)?,
        })
    }

    /// One step from an iterate; `None` if the matrix of (D4) is singular. What each contact does is
    /// read off the iterate's reaction and `seen`, a displacement: its own, or that of a neighbour.
    pub(super) fn step(&self, state: &Iterate, seen: &[f64]) -> Option<Step> {
        let (reaction, displacement) = (&state.reaction, &state.verdict.displacement);
        let laws: Vec<Law> = (0..self.problem.contacts())
            .map(|contact| self.law(contact, self.state(contact, reaction, seen)))
            .collect();
        let mut change = self.closing(&laws, displacement);
        let balanced = self.stiffness.balanced(reaction);
        let held = self.reaction_after(&balanced, &change);
        let unknowns: Vec<usize> = laws.iter().flat_map(|law| law.unknowns.clone()).collect();
        let matrix = self.matrix(&laws, &unknowns);
        let right = right_side(&laws, &held, displacement);
        let solution = matrix.partial_piv_lu().solve(&right);
        for (&unknown, &value) in unknowns.iter().zip(solution.iter()) {
            change[unknown] = value;
        }
        let mut next = self.reaction_after(&balanced, &change);
        self.snap(&laws, &mut next);
        let moved = self.stiffness.motion(&change, reaction);
        let motion: Vec<f64> = state.motion.iter().zip(moved).map(|(a, m)| a + m).collect();
        let finite = next.iter().chain(&motion).all(|x| x.is_finite());
        finite.then(|| Step {
            first_stick: self.first_stick(&laws, displacement, &change),
            reaction: next,
            motion,
        })
    }

    fn block(&self, contact: usize) -> Range<usize> {
        self.problem.offsets()[contact]..self.problem.offsets()[contact + 1]
    }

    fn state(&self, contact: usize, reaction: &[f64], displacement: &[f64]) -> State {
        let (block, g) = (self.block(contact), self.problem.compliance());
        let n = block.start;
        let penetration = displacement[n] - self.problem.initial_gap()[contact];
        if reaction[n] * g[(n, n)] >= penetration {
            return State::Open;
        }
        let step = self.tangential_step(contact);
        let mut point = [0.0; 2];
        for (p, unknown) in point.iter_mut().zip(n + 1..block.end) {
            *p = reaction[unknown] - step * displacement[unknown];
        }
        let size = point[0].hypot(point[1]);
        let bound = -self.problem.friction()[contact] * reaction[n].min(0.0);
        if size <= bound {
            return State::Stick;
        }
        State::Slip {
            direction: point.map(|p| p / size),
            ratio: bound / size,
        }
    }

    /// ρ of the tangential natural map: tangents over the trace of G_TT, in N/m.
    fn tangential_step(&self, contact: usize) -> f64 {
        let tangents = self.block(contact).skip(1);
        let (count, trace) = tangents.fold((0.0, 0.0), |(count, trace), unknown| {
            (
                count + 1.0,
                trace + self.problem.compliance()[(unknown, unknown)],
            )
        });
        if trace > 0.0 { count / trace } else { 0.0 }
    }

    /// (D4) of one contact.
    fn law(&self, contact: usize, state: State) -> Law {
        let block = self.block(contact);
        let (mut unknowns, mut on_reaction, mut on_displacement) =
            (block.clone(), Matrix3::identity(), Matrix3::zeros());
        match state {
            State::Open => {}
            State::Stick => unknowns = block.end..block.end,
            State::Slip { direction, ratio } => {
                unknowns.start += 1;
                let (mu, step) = (
                    self.problem.friction()[contact],
                    self.tangential_step(contact),
                );
                on_reaction = Matrix3::zeros();
                for a in 0..unknowns.len() {
                    on_reaction[(a, 0)] = mu * direction[a];
                    for b in 0..unknowns.len() {
                        let unit = if a == b { 1.0 } else { 0.0 };
                        let m = ratio * (unit - direction[a] * direction[b]);
                        on_reaction[(a, 1 + b)] = unit - m;
                        on_displacement[(a, 1 + b)] = step * m;
                    }
                }
            }
        }
        Law {
            contact,
            block,
            state,
            unknowns,
            on_reaction,
            on_displacement,
        }
    }

    /// Part of `change` after which the first slip has ended, where bodies float.
    ///
    /// While every contact of an interface slips the bodies drift on freely, and (D4) is singular or
    /// nearly so: the step is right in its direction only.
    fn first_stick(&self, laws: &[Law], displacement: &[f64], change: &[f64]) -> Option<f64> {
        self.problem.floating()?;
        let slips = |law: &&Law| matches!(law.state, State::Slip { .. });
        let slipping = laws.iter().filter(slips);
        let parts = slipping.filter_map(|law| {
            let tangents = law.block.start + 1..law.block.end;
            let (mut square, mut turn) = (0.0, 0.0);
            for (u, c) in displacement[tangents.clone()].iter().zip(&change[tangents]) {
                square += u * u;
                turn -= u * c;
            }
            (turn > square).then(|| BEYOND * square / turn)
        });
        parts.reduce(f64::min)
    }

    /// `δu` that closes the gap of pressed contacts and undoes the slip of sticking ones.
    fn closing(&self, laws: &[Law], displacement: &[f64]) -> Vec<f64> {
        let mut change = vec![0.0; displacement.len()];
        for law in laws.iter().filter(|law| law.state != State::Open) {
            let n = law.block.start;
            change[n] = self.problem.initial_gap()[law.contact] - displacement[n];
            if law.state == State::Stick {
                for unknown in n + 1..law.block.end {
                    change[unknown] = -displacement[unknown];
                }
            }
        }
        change
    }

    /// `t + S δu`.
    fn reaction_after(&self, reaction: &[f64], change: &[f64]) -> Vec<f64> {
        let mut next = reaction.to_vec();
        matmul(
            ColMut::from_slice_mut(&mut next),
            Accum::Add,
            self.stiffness.matrix.as_ref(),
            ColRef::from_slice(change),
            1.0,
            Par::Seq,
        );
        next
    }

    /// Matrix of (D4) for `δu` at the unknowns.
    fn matrix(&self, laws: &[Law], unknowns: &[usize]) -> Mat<f64> {
        let mut matrix = Mat::zeros(unknowns.len(), unknowns.len());
        for (j, &unknown) in unknowns.iter().enumerate() {
            let (stiffness, column) = (
                self.stiffness.matrix.col_as_slice(unknown),
                matrix.col_as_slice_mut(j),
            );
            let mut rows = column.iter_mut();
            for law in laws {
                for (row, entry) in (0..law.unknowns.len()).zip(&mut rows) {
                    *entry = law.reaction_row(row, stiffness);
                    if law.block.contains(&unknown) {
                        *entry += law.on_displacement[(row, unknown - law.block.start)];
                    }
                }
            }
        }
        matrix
    }

    /// What holds exactly at a solution is made exact: no reaction when open, friction on its disc when slipping.
    fn snap(&self, laws: &[Law], reaction: &mut [f64]) {
        for law in laws {
            match law.state {
                State::Stick => {}
                State::Open => reaction[law.block.clone()].fill(0.0),
                State::Slip { .. } => {
                    let normal = reaction[law.block.start].min(0.0);
                    let tangents = &mut reaction[law.unknowns.clone()];
                    let size = tangents.iter().fold(0.0_f64, |size, t| size.hypot(*t));
                    let bound = -self.problem.friction()[law.contact] * normal;
                    if size > 0.0 {
                        tangents.iter_mut().for_each(|t| *t *= bound / size);
                    }
                }
            }
        }
    }
}

/// (D4) of one contact: `on_reaction · t + on_displacement · u = 0` on its block, a row
/// per unknown.
struct Law {
    contact: usize,
    block: Range<usize>,
    state: State,
    unknowns: Range<usize>,
    on_reaction: Matrix3<f64>,
    on_displacement: Matrix3<f64>,
}

impl Law {
    /// A row of `on_reaction` times this block of `reaction`.
    fn reaction_row(&self, row: usize, reaction: &[f64]) -> f64 {
        let block = reaction[self.block.clone()].iter().enumerate();
        block.map(|(k, t)| self.on_reaction[(row, k)] * t).sum()
    }

    /// A row of `on_displacement` times this block of `displacement`.
    fn displacement_row(&self, row: usize, displacement: &[f64]) -> f64 {
        let block = displacement[self.block.clone()].iter().enumerate();
        block.map(|(k, u)| self.on_displacement[(row, k)] * u).sum()
    }
}

/// Minus the residual of (D4) with closed gaps and returned stick contacts.
fn right_side(laws: &[Law], held: &[f64], displacement: &[f64]) -> Col<f64> {
    let rows = laws.iter().flat_map(|law| {
        let residual = |row| law.reaction_row(row, held) + law.displacement_row(row, displacement);
        (0..law.unknowns.len()).map(move |row| -residual(row))
    });
    rows.collect()
}
