//! Forces where displacements depend on each other, and the motion of rigid groups.
//!
//! ```text
//! (K22)  C (u, U, Θ) = b,   s = Cᵀ λ       C: the equations (B16) as they are stated,  s: support reactions (K4)
//! ```
//!
//! λ and the motion of rigid groups are those that leave least, by conjugate gradients on the equations
//! themselves (CGLS: Björck, Numerical Methods for Least Squares Problems (1996), algorithm 7.4.1); what the
//! solver eliminated is not looked at. Of several λ it is the shortest.

use super::body_state::BodyState;
use crate::body::{Equation, OF_TIE, Source, Tie};

/// Rounds at most: as many as C has singular values far from each other.
const ROUNDS: usize = 200;

/// Part of the first gradient that is round-off.
const NOTHING: f64 = 1e-16;

/// Forces of supports and ties.
pub(super) struct TieForces {
    /// λ per equation, in newton.
    multipliers: Vec<f64>,
    /// What no equation explains, per unknown, in newton.
    pub(super) rest: Vec<f64>,
}

/// How a rigid group has moved, and what holds it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GroupState {
    /// Number of its tie in the body.
    pub tie: usize,
    /// Displacement of the reference point, in metre.
    pub displacement: [f64; 3],
    /// Rotation, in radian.
    pub rotation: [f64; 3],
    /// Force of the support of its reference point on the body, in newton.
    pub force: [f64; 3],
    /// Moment of it about the reference point, in newton metre.
    pub moment: [f64; 3],
}

impl BodyState<'_> {
    /// Reactions per unknown, in newton, as far as supports and ties explain them, and the rest.
    pub(super) fn explained(&self, reactions: &[f64]) -> [Vec<f64>; 2] {
        let rest = match self.equations.is_empty() {
            false => TieForces::new(self, reactions).rest,
            true => {
                let unknowns = reactions.iter().zip(self.prescribed);
                let rest = unknowns.map(|(s, given)| if given.is_none() { *s } else { 0.0 });
                rest.collect()
            }
        };
        let held = reactions.iter().zip(&rest).map(|(s, rest)| s - rest);
        [held.collect(), rest]
    }

    /// Displacement minus the given one, zero where free, in metre.
    pub(super) fn support_departure(&self) -> Vec<f64> {
        if !self.equations.is_empty() {
            return departure(self);
        }
        let pairs = self.prescribed.iter().zip(self.displacement);
        pairs
            .map(|(given, u)| given.map_or(0.0, |given| u - given))
            .collect()
    }
}

impl TieForces {
    /// The least part of reactions per unknown, in newton, that no equation explains.
    pub(super) fn new(state: &BodyState<'_>, reactions: &[f64]) -> Self {
        let (equations, columns) = (state.equations, columns(state));
        let mut rest = reactions.to_vec();
        rest.resize(columns, 0.0);
        let multipliers = least_squares(
            &mut rest,
            |along| transposed(equations, along, columns),
            |rest| product(equations, rest),
        );
        rest.truncate(reactions.len());
        Self { multipliers, rest }
    }

    /// Visits `(unknown, force)` of the equations that a source states.
    pub(super) fn visit(
        &self,
        state: &BodyState<'_>,
        by: Source,
        mut visit: impl FnMut(usize, f64),
    ) {
        let equations = state.equations.iter().zip(&self.multipliers);
        for (equation, force) in equations.filter(|(equation, _)| equation.by == by) {
            let terms = equation.terms.iter();
            let within = terms.filter(|(column, _)| *column < state.load.len());
            within.for_each(|(column, a)| visit(*column, a * force));
        }
    }
}

/// Motion of all ties (columns beyond the displacements), and what is left of the equations, in metre.
fn motions(state: &BodyState<'_>) -> (Vec<f64>, Vec<f64>) {
    let (equations, first) = (state.equations, state.load.len());
    let mut moved = state.displacement.to_vec();
    moved.resize(columns(state), 0.0);
    let known = product(equations, &moved);
    let mut rest: Vec<f64> = state
        .values
        .iter()
        .zip(known)
        .map(|(b, known)| b - known)
        .collect();
    let motions = least_squares(
        &mut rest,
        |along| {
            moved[..first].fill(0.0);
            moved[first..].copy_from_slice(along);
            product(equations, &moved)
        },
        |rest| transposed(equations, rest, columns(state)).split_off(first),
    );
    (motions, rest)
}

/// What is left of the equations, at the unknown that each is about, in metre.
fn departure(state: &BodyState<'_>) -> Vec<f64> {
    let mut departure = vec![0.0; state.load.len()];
    for (equation, rest) in state.equations.iter().zip(motions(state).1) {
        let about = equation.terms.first().map(|(column, _)| *column);
        if let Some(worst) = about.and_then(|column| departure.get_mut(column)) {
            *worst = f64::max(*worst, rest.abs());
        }
    }
    departure
}

/// Motions and reactions of all rigid groups of a body.
pub(crate) fn group_states(state: &BodyState<'_>) -> Vec<GroupState> {
    if state.equations.is_empty() {
        return Vec::new();
    }
    let reactions = state.support_reactions(&state.contact_forces());
    let (forces, (moved, _)) = (TieForces::new(state, &reactions), motions(state));
    let ties = state.body.ties.iter().enumerate();
    let groups = ties.filter_map(|(tie, of)| match of {
        Tie::Rigid(group) => Some((tie, group)),
        Tie::Pairs(_) => None,
    });
    let states = groups.map(|(tie, group)| {
        let axes = state.dimension();
        let mut sum = super::Resultant::default();
        forces.visit(state, Source::Tie(tie), |unknown, force| {
            let mut along = [0.0; 3];
            along[unknown % axes] = force;
            sum.add(group.arm(state.body, unknown / axes).into(), along);
        });
        let motion = &moved[OF_TIE * tie..OF_TIE * (tie + 1)];
        let size = group.size(state.body);
        GroupState {
            tie,
            displacement: [motion[0], motion[1], motion[2]],
            rotation: [motion[3] / size, motion[4] / size, motion[5] / size],
            force: sum.force,
            moment: sum.moment,
        }
    });
    states.collect()
}

fn columns(state: &BodyState<'_>) -> usize {
    state.load.len() + OF_TIE * state.body.ties.len()
}

/// `C x`.
fn product(equations: &[Equation], x: &[f64]) -> Vec<f64> {
    let rows = equations.iter().map(|equation| {
        let terms = equation.terms.iter();
        terms.map(|&(column, a)| a * x[column]).sum()
    });
    rows.collect()
}

/// `Cᵀ y`.
fn transposed(equations: &[Equation], y: &[f64], columns: usize) -> Vec<f64> {
    let mut sum = vec![0.0; columns];
    for (equation, y) in equations.iter().zip(y) {
        equation
            .terms
            .iter()
            .for_each(|&(column, a)| sum[column] += a * y);
    }
    sum
}

/// x of `min ‖rest − A x‖`; what is left stands in `rest`.
fn least_squares(
    rest: &mut [f64],
    mut forward: impl FnMut(&[f64]) -> Vec<f64>,
    backward: impl Fn(&[f64]) -> Vec<f64>,
) -> Vec<f64> {
    let mut gradient = backward(rest);
    let mut solution = vec![0.0; gradient.len()];
    let mut along = gradient.clone();
    let mut size = dot(&gradient, &gradient);
    let enough = NOTHING * NOTHING * size;
    for _ in 0..ROUNDS {
        let image = forward(&along);
        let step = size / dot(&image, &image);
        if !(step.is_finite() && size > enough) {
            break;
        }
        add(&mut solution, step, &along);
        add(rest, -step, &image);
        gradient = backward(rest);
        let before = std::mem::replace(&mut size, dot(&gradient, &gradient));
        along.iter_mut().for_each(|p| *p *= size / before);
        add(&mut along, 1.0, &gradient);
    }
    solution
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn add(sum: &mut [f64], factor: f64, other: &[f64]) {
    for (entry, x) in sum.iter_mut().zip(other) {
        *entry += factor * x;
    }
}
