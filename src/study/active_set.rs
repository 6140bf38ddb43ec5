//! Whole bodies in contact, factorised anew in every step, as finite-element codes do: the primal–dual active set with
//! Lagrange multipliers, and the same with springs.
//!
//! ```text
//! (M9)  K u − Bᵀ t = f                           all nodes of all bodies, multipliers t of the contacts that are not open
//!       w = B u + given + t/ε                    1/ε = 0: multipliers; else a penalty
//!       pressed   w_N = g₀                       where t_N − c (w_N − g₀) < 0
//!       sticks    w_T = 0                        where ‖p‖ ≤ −μ t_N,   p = t_T − c w_T
//!       slips     t_T − β (1 − d dᵀ)(t_T − c w_T) = −μ t_N d           d = p/‖p‖,   β = −μ t_N/‖p‖
//! ```
//!
//! On the right t_N is held until contacts do the same twice, also of those that open meanwhile, then taken anew
//! (Tresca's problem, again and again); where contacts still do the same it is the unknown itself. Consistent from rest, or with
//! that of the step before, the sets go round in circles on the square at μ = 1.
//!
//! Semi-smooth Newton steps (Alart, Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353–375; Hüeber, Stadler,
//! Wohlmuth, SIAM J. Sci. Comput. 30 (2008) 572–596). c is the stiffness of the contact's own node, in the tangents at most
//! 3/2 −μ t_N/‖w_T‖, so that what slips the wrong way sticks first. Friction makes the matrix unsymmetric, so each step
//! is a sparse LU decomposition: faer's, ordered by COLAMD.

use std::ops::Range;
use std::time::Instant;

use faer::Mat;
use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};

use super::exact::{BETWEEN, disc};
use super::penalty::springs;
use super::variant::Run;
use crate::alternation::{Outcome, Settings, SweepRecord};
use crate::condensation::Condensed;
use crate::contact::ContactNode;
use crate::error::Error;
use crate::problem::ContactProblem;

/// Larger bodies are not factorised in every step.
const MOST: usize = 40_000;

/// A reaction that changes by less than this part of it is the answer of springs, which no residual tells.
const STILL: f64 = 1e-12;

/// K of all bodies without what supports hold, and B (M9).
#[derive(Clone, Debug)]
pub(super) struct WholeBodies {
    /// `(row, column, entry)` of K, in N/m.
    stiffness: Vec<(usize, usize, f64)>,
    /// `f − K u_p`, in newton.
    load: Vec<f64>,
    /// `(unknown, coefficient)` per unknown of the contact problem.
    rows: Vec<Vec<(usize, f64)>>,
    /// What supports and obstacles give of w, in metre per unknown of the contact problem.
    given: Vec<f64>,
    /// c, in N/m per contact.
    scale: Vec<f64>,
}

impl WholeBodies {
    /// Of bodies of two or three axes that their supports hold by single displacements; none of others, and of those
    /// that are too large.
    pub(super) fn new(condensed: &Condensed, axes: usize) -> Option<Self> {
        let bodies = condensed.bodies();
        let simple = bodies.iter().all(|body| body.equations().0.is_empty());
        let problem = condensed.problem();
        if !simple || problem.floating().is_some() || problem.laws().is_some() {
            return None;
        }
        let mut number = Vec::new();
        let (mut load, mut count) = (Vec::new(), 0);
        for body in bodies {
            let own = body.prescribed().iter().map(|held| {
                let free = held.is_none().then_some(count);
                count += usize::from(free.is_some());
                free
            });
            number.push(own.collect::<Vec<Option<usize>>>());
        }
        if count > MOST {
            return None;
        }
        let mut stiffness = Vec::new();
        for (body, number) in bodies.iter().zip(&number) {
            let free = number.iter().zip(body.load());
            load.extend(free.filter_map(|(at, force)| at.map(|_| *force)));
            for (entry, (i, j)) in body.stiffness() {
                match (number[i], number[j]) {
                    (Some(row), Some(column)) => stiffness.push((row, column, *entry)),
                    (Some(row), None) => load[row] -= entry * body.prescribed()[j].unwrap_or(0.0),
                    _ => {}
                }
            }
        }
        let mut diagonal = vec![0.0; count];
        for &(row, column, entry) in &stiffness {
            diagonal[row] += if row == column { entry } else { 0.0 };
        }
        let none = vec![0.0; problem.unknowns()];
        let mut whole = Self {
            stiffness,
            load,
            rows: vec![Vec::new(); problem.unknowns()],
            given: problem
                .total_displacement(&none)
                .iter()
                .map(|u| -u)
                .collect(),
            scale: Vec::new(),
        };
        for (node, block) in condensed.surface().nodes.iter().zip(problem.blocks()) {
            whole.see(node, block.clone(), condensed, (&number, axes));
            let touched = whole.rows[block].iter().flatten();
            let stiffest = touched.map(|(at, _)| diagonal[*at]).fold(0.0, f64::max);
            whole
                .scale
                .push(if stiffest > 0.0 { stiffest } else { 1.0 });
        }
        Some(whole)
    }

    /// The rows of B of one contact.
    fn see(
        &mut self,
        node: &ContactNode,
        block: Range<usize>,
        condensed: &Condensed,
        (number, axes): (&[Vec<Option<usize>>], usize),
    ) {
        let own = node
            .own
            .iter()
            .map(|(at, weight)| (node.body, *at, *weight));
        let other = node.opposite.iter().flat_map(|other| {
            let nodes = other.nodes.iter();
            nodes.map(|(at, weight)| (other.body, *at, -weight))
        });
        for (body, at, weight) in own.chain(other) {
            let held = condensed.bodies()[body].prescribed();
            for (row, axis) in block.clone().zip(&node.frame) {
                for (k, direction) in axis[..axes].iter().enumerate() {
                    let (dof, coefficient) = (at * axes + k, weight * direction);
                    match number[body][dof] {
                        Some(unknown) if coefficient != 0.0 => {
                            self.rows[row].push((unknown, coefficient));
                        }
                        None => self.given[row] += coefficient * held[dof].unwrap_or(0.0),
                        Some(_) => {}
                    }
                }
            }
        }
    }

    /// Steps (M9) from rest; springs of so many times the contacts' own stiffness in place of multipliers if given.
    ///
    /// # Errors
    ///
    /// Settings outside their range.
    pub(super) fn solve(
        &self,
        problem: &ContactProblem,
        settings: &Settings,
        parameter: Option<f64>,
    ) -> Result<Outcome, Error> {
        settings.validate()?;
        let soft = match parameter {
            Some(parameter) => springs(problem, parameter),
            None => vec![0.0; problem.unknowns()],
        };
        let mut run = Run::new(problem, settings);
        // At rest nothing is pressed, and the bodies have moved by their loads alone.
        let mut moved = self.step(problem, &soft, None);
        while run.goes_on() {
            run.work.sweeps += 1;
            run.record = SweepRecord::default();
            let start = Instant::now();
            let Some(at) = moved else {
                run.given_up = true;
                break;
            };
            moved = self.step(problem, &soft, Some(&at));
            if let Some(next) = &moved {
                let change = next.reaction.iter().zip(&run.reaction);
                let change = change.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                let size = next.reaction.iter().map(|t| t.abs()).fold(0.0, f64::max);
                run.given_up = next.settled && change <= STILL * size;
                run.reaction.clone_from(&next.reaction);
            }
            run.work.newton_steps += 1;
            run.record.newton_steps = 1;
            run.measure();
            run.end(start);
        }
        Ok(run.into_outcome())
    }

    /// The next state; none where the matrix is singular. Without a displacement before, all contacts are open.
    fn step(
        &self,
        problem: &ContactProblem,
        soft: &[f64],
        before: Option<&Moved>,
    ) -> Option<Moved> {
        let bodies = self.load.len();
        let mut next = Moved {
            bounds: vec![0.0; problem.contacts()],
            ..Moved::default()
        };
        let mut system = System {
            whole: self,
            soft,
            entries: Vec::with_capacity(self.stiffness.len() + 64 * problem.unknowns()),
            right: self.load.clone(),
            unit: vec![0.0; bodies],
            column: vec![None; problem.unknowns()],
        };
        let entries = self.stiffness.iter();
        system
            .entries
            .extend(entries.map(|&(row, column, entry)| Triplet::new(row, column, entry)));
        if let Some(before) = before {
            let under = |bounds: &[f64]| -> Vec<Contact> {
                let contacts = bounds.iter().enumerate();
                let contact =
                    |(at, bound): (usize, &f64)| Contact::new(self, problem, (at, *bound), before);
                contacts.map(contact).collect()
            };
            let states = |contacts: &[Contact]| -> Vec<Does> {
                contacts.iter().map(|contact| contact.does).collect()
            };
            next.bounds.clone_from(&before.bounds);
            let mut contacts = under(&next.bounds);
            if states(&contacts) == before.states {
                let normals = problem.normals().iter().zip(problem.friction());
                let bounds = normals.map(|(&n, mu)| -mu * before.reaction[n].min(0.0));
                next.bounds = bounds.collect();
                contacts = under(&next.bounds);
                next.settled = states(&contacts) == before.states;
            }
            next.states = states(&contacts);
            for contact in &contacts {
                system.add(contact, next.settled);
            }
        }
        let size = system.right.len();
        let matrix =
            SparseColMat::<usize, f64>::try_new_from_triplets(size, size, &system.entries).ok()?;
        let right = Mat::from_fn(size, 1, |i, _| system.right[i]);
        let solved = matrix.sp_lu().ok()?.solve(&right);
        let unknown = |at: usize| solved[(at, 0)];
        if !(0..size).all(|at| unknown(at).is_finite()) {
            return None;
        }
        let multipliers = system.column.iter();
        next.reaction = multipliers
            .map(|at| at.map_or(0.0, |at| system.unit[at] * unknown(at)))
            .collect();
        let rows = self.rows.iter().zip(&self.given);
        next.seen = rows
            .zip(next.reaction.iter().zip(soft))
            .map(|((row, given), (t, soft))| {
                given + row.iter().map(|&(at, b)| b * unknown(at)).sum::<f64>() + t * soft
            })
            .collect();
        Some(next)
    }
}

/// A state of (M9).
#[derive(Default)]
struct Moved {
    /// w, in metre.
    seen: Vec<f64>,
    reaction: Vec<f64>,
    states: Vec<Does>,
    /// Contacts did in this step what they did before, also after their bounds were taken anew.
    settled: bool,
    /// −μ t_N as this step had it, per contact.
    bounds: Vec<f64>,
}

/// Whether a contact is pressed, and whether it slips.
type Does = (bool, bool);

/// What a contact does in the next step.
struct Contact {
    block: Range<usize>,
    does: Does,
    gap: f64,
    friction: f64,
    bound: f64,
    /// c, and what stands for it in the tangents.
    scale: f64,
    along: f64,
    /// d.
    direction: [f64; 2],
    /// β (1 − d dᵀ).
    slope: [[f64; 2]; 2],
}

impl Contact {
    fn new(
        whole: &WholeBodies,
        problem: &ContactProblem,
        (contact, bound): (usize, f64),
        at: &Moved,
    ) -> Self {
        let (block, scale) = (problem.block(contact), whole.scale[contact]);
        let (reaction, seen, normal) = (&at.reaction, &at.seen, block.start);
        let (gap, friction) = (problem.initial_gap()[contact], problem.friction()[contact]);
        let tangents = block.start + 1..block.end;
        let slip = tangents.clone().fold(0.0, |s: f64, t| s.hypot(seen[t]));
        let along = match bound > 0.0 && slip > 0.0 {
            true => scale.min(BETWEEN * bound / slip),
            false => scale,
        };
        let mut point = [0.0; 2];
        for (p, t) in point.iter_mut().zip(tangents) {
            *p = reaction[t] - along * seen[t];
        }
        let size = point[0].hypot(point[1]);
        let slips = friction == 0.0 || size > bound;
        Self {
            block,
            does: (reaction[normal] - scale * (seen[normal] - gap) < 0.0, slips),
            gap,
            friction,
            bound,
            scale,
            along,
            direction: point.map(|p| if size > 0.0 { p / size } else { 0.0 }),
            slope: if size > bound {
                disc(point, bound).1
            } else {
                Default::default()
            },
        }
    }
}

/// (M9) as it is factorised; multipliers in the unit of c, so that all entries have one size.
struct System<'a> {
    whole: &'a WholeBodies,
    soft: &'a [f64],
    entries: Vec<Triplet<usize, usize, f64>>,
    right: Vec<f64>,
    unit: Vec<f64>,
    /// Column of the multiplier of each unknown of the contact problem.
    column: Vec<Option<usize>>,
}

impl System<'_> {
    /// The rows of a contact; consistent where all contacts have settled. Until then a contact that opens keeps the friction
    /// that is given.
    fn add(&mut self, contact: &Contact, settled: bool) {
        let (closed, slips) = contact.does;
        let given = contact.bound > 0.0 && !settled;
        let (normal, c) = (contact.block.start, contact.scale);
        let tangents: Vec<usize> = contact.block.clone().skip(1).collect();
        let kept = closed.then_some(normal).into_iter();
        let kept = kept.chain(tangents.iter().copied().filter(|_| closed || given));
        for unknown in kept {
            let column = self.right.len();
            self.column[unknown] = Some(column);
            self.unit.push(c);
            self.right.push(0.0);
            for &(at, b) in &self.whole.rows[unknown] {
                self.entries.push(Triplet::new(at, column, -c * b));
            }
        }
        if let Some(row) = self.column[normal] {
            self.see(row, normal, c);
            self.right[row] += c * contact.gap;
        }
        for (i, &unknown) in tangents.iter().enumerate() {
            let Some(row) = self.column[unknown] else {
                continue;
            };
            if !slips {
                self.see(row, unknown, c);
                continue;
            }
            self.entries.push(Triplet::new(row, row, c));
            match self.column[normal].filter(|_| settled) {
                Some(column) => {
                    let entry = contact.friction * c * contact.direction[i];
                    self.entries.push(Triplet::new(row, column, entry));
                }
                None => self.right[row] += contact.bound * contact.direction[i],
            }
            for (k, &other) in tangents.iter().enumerate() {
                let slope = contact.slope[i][k];
                if let Some(column) = self.column[other] {
                    self.entries.push(Triplet::new(row, column, -slope * c));
                }
                self.see(row, other, slope * contact.along);
            }
        }
    }

    /// Adds `factor · w` of an unknown to a row.
    fn see(&mut self, row: usize, unknown: usize, factor: f64) {
        if factor == 0.0 {
            return;
        }
        for &(at, b) in &self.whole.rows[unknown] {
            self.entries.push(Triplet::new(row, at, factor * b));
        }
        if let Some(column) = self.column[unknown].filter(|_| self.soft[unknown] > 0.0) {
            let entry = factor * self.soft[unknown] * self.unit[column];
            self.entries.push(Triplet::new(row, column, entry));
        }
        self.right[row] -= factor * self.whole.given[unknown];
    }
}
