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
//! the result are those of `u = û + G t`, whatever the condition of S.

use faer::linalg::matmul::matmul;
use faer::linalg::solvers::Solve;
use faer::{Accum, Col, Mat, get_global_parallelism};

use crate::condensation::ContactProblem;

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
    stiffness: &'a Mat<f64>,
}

impl<'a> Finish<'a> {
    /// `None` where the compliance has no inverse.
    pub(super) fn new(problem: &'a ContactProblem) -> Option<Self> {
        Some(Self {
            problem,
            stiffness: problem.operator().stiffness()?,
        })
    }

    /// The reaction after one step from a reaction and its displacement; `None` if the step is singular.
    pub(super) fn step(&self, reaction: &[f64], displacement: &[f64]) -> Option<Vec<f64>> {
        let states: Vec<State> = (0..self.problem.contacts())
            .map(|contact| self.state(contact, reaction, displacement))
            .collect();
        let unknowns = self.unknowns(&states);
        let mut change = self.prescribed_change(&states, displacement);
        let held = self.reaction_change(reaction, &change);
        let (matrix, right) = self.equations(&states, &unknowns, &held, displacement);
        let solution = matrix.partial_piv_lu().solve(&right);
        for (&unknown, &value) in unknowns.iter().zip(solution.iter()) {
            change[unknown] = value;
        }
        let next = self.reaction_change(reaction, &change);
        let next = self.snap(&states, next.iter().copied().collect());
        next.iter().all(|t| t.is_finite()).then_some(next)
    }

    fn block(&self, contact: usize) -> std::ops::Range<usize> {
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

    fn unknowns(&self, states: &[State]) -> Vec<usize> {
        let of_contact = |(contact, state): (usize, &State)| {
            let block = self.block(contact);
            match state {
                State::Open => block,
                State::Stick => block.end..block.end,
                State::Slip { .. } => block.start + 1..block.end,
            }
        };
        states.iter().enumerate().flat_map(of_contact).collect()
    }

    /// `δu` of closed contacts: the gap closes, a stick contact returns.
    fn prescribed_change(&self, states: &[State], displacement: &[f64]) -> Vec<f64> {
        let mut change = vec![0.0; displacement.len()];
        for (contact, state) in states.iter().enumerate() {
            let block = self.block(contact);
            if *state != State::Open {
                change[block.start] =
                    self.problem.initial_gap()[contact] - displacement[block.start];
            }
            if *state == State::Stick {
                for unknown in block.skip(1) {
                    change[unknown] = -displacement[unknown];
                }
            }
        }
        change
    }

    /// `t + S δu`.
    fn reaction_change(&self, reaction: &[f64], change: &[f64]) -> Col<f64> {
        let mut next = Col::from_fn(reaction.len(), |i| reaction[i]);
        let change = Col::from_fn(change.len(), |i| change[i]);
        let par = get_global_parallelism();
        matmul(
            next.as_mut(),
            Accum::Add,
            self.stiffness,
            change.as_ref(),
            1.0,
            par,
        );
        next
    }

    /// Matrix and right-hand side of (D4) for `δu` at the unknowns.
    fn equations(
        &self,
        states: &[State],
        unknowns: &[usize],
        held: &Col<f64>,
        displacement: &[f64],
    ) -> (Mat<f64>, Col<f64>) {
        let size = unknowns.len();
        let mut rows: Vec<[(usize, f64); 3]> = Vec::with_capacity(size);
        let mut right = Col::zeros(size);
        let mut diagonal: Vec<[(usize, f64); 2]> = Vec::with_capacity(size);
        for (contact, state) in states.iter().enumerate() {
            let block = self.block(contact);
            let n = block.start;
            match *state {
                State::Stick => {}
                State::Open => {
                    for unknown in block {
                        right[rows.len()] = -held[unknown];
                        rows.push([(unknown, 1.0), (n, 0.0), (n, 0.0)]);
                        diagonal.push([(0, 0.0); 2]);
                    }
                }
                State::Slip { direction, ratio } => {
                    let tangents = block.len() - 1;
                    let (mu, step) = (
                        self.problem.friction()[contact],
                        self.tangential_step(contact),
                    );
                    let first = rows.len();
                    for a in 0..tangents {
                        let mut row = [(n, mu * direction[a]), (n, 0.0), (n, 0.0)];
                        let mut own = [(0, 0.0); 2];
                        for b in 0..tangents {
                            let unit = f64::from(u8::from(a == b));
                            let m = ratio * (unit - direction[a] * direction[b]);
                            row[1 + b] = (n + 1 + b, unit - m);
                            own[b] = (first + b, step * m);
                            right[first + a] -= step * m * displacement[n + 1 + b];
                        }
                        right[first + a] -= row.iter().map(|&(k, c)| c * held[k]).sum::<f64>();
                        rows.push(row);
                        diagonal.push(own);
                    }
                }
            }
        }
        let mut matrix = Mat::from_fn(size, size, |i, j| {
            rows[i]
                .iter()
                .map(|&(k, c)| c * self.stiffness[(unknowns[j], k)])
                .sum()
        });
        for (i, own) in diagonal.iter().enumerate() {
            for &(j, value) in own {
                matrix[(i, j)] += value;
            }
        }
        (matrix, right)
    }

    /// What holds exactly at a solution is made exact: no reaction when open, friction on its disc when slipping.
    fn snap(&self, states: &[State], mut reaction: Vec<f64>) -> Vec<f64> {
        for (contact, state) in states.iter().enumerate() {
            let block = self.block(contact);
            match *state {
                State::Open => reaction[block].fill(0.0),
                State::Stick => {}
                State::Slip { .. } => {
                    let bound = -self.problem.friction()[contact] * reaction[block.start].min(0.0);
                    let tangents = &mut reaction[block.start + 1..block.end];
                    let size = tangents.iter().fold(0.0_f64, |size, t| size.hypot(*t));
                    if size > 0.0 {
                        tangents.iter_mut().for_each(|t| *t *= bound / size);
                    }
                }
            }
        }
        reaction
    }
}
