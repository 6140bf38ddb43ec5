//! One Newton step on the laws of contact, whole, without a line search.
//!
//! Each contact takes its equations from the trial point `p = t − ρ (u − g)` of the natural map
//! (Alart, Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353–375); the disc is that of the trial point too,
//! so that a contact which is about to close has one:
//!
//! ```text
//!        open     p_N ≥ 0                t = 0
//! (D4)   stick    ‖p_T‖ ≤ −μ p_N         u_N = g₀,  u_T = 0
//!        slip     ‖p_T‖ > −μ p_N         u_N = g₀,  (1 − M) t_T + μ d t_N + ρ M u_T = 0
//!                                        d = p_T/‖p_T‖,   M = γ (1 − d dᵀ),   γ = −μ p_N/‖p_T‖
//! ```
//!
//! With another law `s` of problem::L5 stands for −μ p_N, and a contact that is open, but for a bound without
//! pressure, has the tangents of stick or slip; one that is bilateral is never open.
//!
//! ```text
//! (D5)   u = û + G t + σ C (t − t_k) + R α,      Rᵀ t + e = σ (α − α_k)
//! ```
//!
//! Unknown are the reactions of contacts that are not open, and the rigid motions of bodies that float. With the
//! softness σ = 0 this is a step of the finish; else springs C = 1/ρ stand at every contact and hold every rigid
//! motion (R orthonormal in ρ), anchored where the proximal loop is. All is scaled to `t/√ρ` and `√ρ u`:
//! no unit and no size of a contact is seen.

use faer::{Col, Mat};

use super::condition::{self, Factored, add_columns};
use super::displacement_method::DisplacementMethod;
use super::iterate::{Iterate, Motion};
use super::laws::{self, Law, Local, roots};
use crate::problem::ContactProblem;
use crate::problem::velocity_basis::VelocityBasis;

/// A reaction, with the displacement beyond the gaps that goes with it.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub(super) reaction: Vec<f64>,
    pub(super) beyond: Vec<f64>,
    /// Rigid motion since the anchor, along the velocities of [`Finish`].
    pub(super) drift: Vec<f64>,
}

/// Springs of (D5).
#[derive(Clone, Copy, Debug)]
pub(super) struct Springs<'a> {
    /// σ.
    pub(super) softness: f64,
    /// t_k, in newton per unknown.
    pub(super) anchor: &'a [f64],
}

/// Newton steps on one problem.
pub(super) struct Finish<'a> {
    problem: &'a ContactProblem,
    /// √ρ per unknown.
    pub(super) roots: Vec<f64>,
    rigid: Option<Rigid>,
    last: Option<System>,
}

/// The linear system of a step, factored.
enum System {
    /// Reactions are unknown.
    Force(Factored),
    /// Displacements are (D18).
    Displacement(DisplacementMethod),
}

/// Rounds of refinement by (D18) at most, part of what one found that it may leave, and part of the first that is solved.
const ROUNDS: usize = 8;
const LEFT: f64 = 0.1;
const SOLVED: f64 = 1e-8;

/// What may be left of a step by (D18), as a part of the first or of all reactions, where no round gets further.
const ENOUGH: [f64; 2] = [1e-8, 1e-13];

/// What bodies that float do as a whole.
struct Rigid {
    basis: VelocityBasis,
    /// Displacement of every unknown along each velocity.
    velocities: Mat<f64>,
    /// e along the velocities.
    load: Vec<f64>,
}

impl<'a> Finish<'a> {
    /// `None` where the rigid motions have no basis.
    pub(super) fn new(problem: &'a ContactProblem) -> Option<Self> {
        let roots = roots(problem);
        let rigid = match problem.floating() {
            None => None,
            Some(floating) => {
                let (modes, rows) = (floating.modes(), problem.unknowns());
                let scaled = Mat::from_fn(rows, modes.ncols(), |i, j| roots[i] * modes[(i, j)]);
                let basis = VelocityBasis::new(scaled.as_ref())?;
                let q = basis.velocities();
                Some(Rigid {
                    velocities: Mat::from_fn(rows, q.ncols(), |i, j| q[(i, j)] / roots[i]),
                    load: basis.load(floating.load()),
                    basis,
                })
            }
        };
        Some(Self {
            problem,
            roots,
            rigid,
            last: None,
        })
    }

    /// An iterate, with springs anchored there.
    pub(super) fn point(&self, state: &Iterate) -> Point {
        Point {
            reaction: state.reaction.clone(),
            beyond: state.verdict.beyond.clone(),
            drift: vec![0.0; self.velocities()],
        }
    }

    /// The motion after a drift.
    pub(super) fn moved(&self, motion: &Motion, drift: &[f64]) -> Motion {
        match &self.rigid {
            None => Motion::default(),
            Some(_) => motion.plus(&self.amplitudes(drift)),
        }
    }

    /// A drift, in amplitudes of the free modes.
    pub(super) fn amplitudes(&self, drift: &[f64]) -> Vec<f64> {
        let rigid = self.rigid.as_ref();
        rigid.map_or_else(Vec::new, |rigid| rigid.basis.amplitudes(drift))
    }

    /// What a state misses of the laws, as the root of an energy.
    pub(super) fn missed(&self, state: &Iterate) -> f64 {
        let springs = Springs {
            softness: 0.0,
            anchor: &state.reaction,
        };
        self.residual(&self.point(state), springs)
    }

    /// Size of a reaction, in the unit of [`residual`](Self::residual).
    pub(super) fn size(&self, reaction: &[f64]) -> f64 {
        let scaled = reaction.iter().zip(&self.roots).map(|(t, root)| t / root);
        scaled.fold(0.0, f64::hypot)
    }

    /// Products of two numbers that the last step took.
    pub(super) fn products(&self) -> f64 {
        self.last.as_ref().map_or(0.0, |system| match system {
            System::Force(matrix) => matrix.products(),
            System::Displacement(system) => system.products(),
        })
    }

    /// Condition of the matrix of the last step; none before the first, and of a least step.
    pub(super) fn condition(&self) -> Option<f64> {
        self.last.as_ref().map(|system| match system {
            System::Force(matrix) => matrix.condition(),
            System::Displacement(system) => {
                let laws = system.laws();
                let size = laws::largest_sum(&laws, self.scaled());
                let solve = |right: &Col<f64>| system.solve(self.scaled(), right);
                condition::condition(size, laws::free(&laws), solve)
            }
        })
    }

    /// One step, the least one where some motion of bodies that float changes nothing; `None` if there is none. What each contact
    /// does is read off the reaction and `seen`, a displacement beyond the gaps: the point's own, or that of a neighbour.
    pub(super) fn step(
        &mut self,
        from: &Point,
        seen: &[f64],
        springs: Springs<'_>,
    ) -> Option<Point> {
        let laws: Vec<Law> = (0..self.problem.contacts())
            .filter_map(|contact| {
                let local = self.local(contact, &from.reaction, seen, springs);
                local.law(contact, self.problem.block(contact))
            })
            .collect();
        let mut next = self.opened(from, &laws);
        let short = |law: &Law| {
            let local = self.local(law.contact, &next.reaction, &next.beyond, springs);
            law.short_of_bound(local.reaction)
        };
        let short: Vec<[f64; 3]> = laws.iter().map(short).collect();
        self.add_to(&mut next, laws.iter().zip(short));
        // Before there is another as large.
        self.last = None;
        if self.rigid.is_none()
            && springs.softness == 0.0
            && let Some(next) = self.by_displacements(&laws, &next, springs)
        {
            return Some(next);
        }
        let matrix = Factored::new(self.matrix(&laws, springs.softness));
        let right = self.right_side(&laws, &next, springs);
        // Between bodies that are held springs tell better what to make of it.
        let singular = self.rigid.is_some() && matrix.is_singular();
        let solution = match singular {
            true => condition::least_solution(&self.matrix(&laws, springs.softness), &right),
            false => Some(matrix.solve(&right)),
        };
        self.last = (!singular).then_some(System::Force(matrix));
        let solution = solution.filter(|found| found.iter().all(|x| x.is_finite()))?;
        self.add(&mut next, &laws, &solution);
        Some(next)
    }

    /// The step by (D18); `None` where that would not pay, or does not solve it.
    fn by_displacements(
        &mut self,
        laws: &[Law],
        from: &Point,
        springs: Springs<'_>,
    ) -> Option<Point> {
        let system = DisplacementMethod::new(laws, self.scaled())?;
        let mut at = from.clone();
        let mut right = self.right_side(laws, &at, springs);
        let first = right.norm_l2();
        let mut left = first;
        for _ in 0..ROUNDS {
            if left <= SOLVED * first {
                break;
            }
            let mut next = at.clone();
            self.add(&mut next, laws, &system.solve(self.scaled(), &right));
            right = self.right_side(laws, &next, springs);
            let now = right.norm_l2();
            if now.is_nan() || now > LEFT * left {
                break;
            }
            (at, left) = (next, now);
        }
        let enough = (ENOUGH[0] * first).max(ENOUGH[1] * self.size(&at.reaction));
        self.last = Some(System::Displacement(system));
        (left <= enough).then_some(at)
    }

    /// The problem and √ρ.
    fn scaled(&self) -> (&'a ContactProblem, &[f64]) {
        (self.problem, &self.roots)
    }

    /// Adds scaled reactions to those of contacts.
    pub(super) fn add_to<'l>(
        &self,
        point: &mut Point,
        changes: impl Iterator<Item = (&'l Law, [f64; 3])>,
    ) {
        let changes = changes.flat_map(|(law, change)| law.block.clone().zip(change));
        self.push(
            point,
            changes.map(|(at, scaled)| (at, self.roots[at] * scaled)),
        );
    }

    /// Adds scaled reactions, so much along each direction in which they are free, and a drift behind them.
    pub(super) fn add(&self, point: &mut Point, laws: &[Law], solution: &Col<f64>) {
        let changes = laws::spread(laws, solution.iter().copied());
        self.push(
            point,
            changes.map(|(at, scaled)| (at, self.roots[at] * scaled)),
        );
        if let Some(rigid) = &self.rigid {
            let drift = solution.iter().skip(laws::free(laws));
            for (k, along) in drift.enumerate() {
                point.drift[k] += along;
                add(&mut point.beyond, *along, rigid.velocities.col_as_slice(k));
            }
        }
    }

    /// A load on the free modes, along the velocities.
    pub(super) fn along(&self, load: &[f64]) -> Vec<f64> {
        let rigid = self.rigid.as_ref();
        rigid.map_or_else(Vec::new, |rigid| rigid.basis.load(load))
    }

    /// How far a point is from (D4) and (D5), as the root of an energy: sizes of the contacts do not weigh.
    pub(super) fn residual(&self, at: &Point, springs: Springs<'_>) -> f64 {
        let local = |contact| self.local(contact, &at.reaction, &at.beyond, springs);
        let residual = laws::residual(self.problem, local);
        let softer = (1.0 + springs.softness).sqrt();
        let rest = self.imbalance(at, springs.softness);
        rest.iter().fold(residual, |sum, e| sum.hypot(e / softer))
    }

    /// `Rᵀ t + e − σ (α − α_k)` along the velocities.
    fn imbalance(&self, at: &Point, softness: f64) -> Vec<f64> {
        let load = self.rigid.iter().flat_map(|rigid| &rigid.load);
        let parts = load.zip(self.carried(&at.reaction)).zip(&at.drift);
        parts
            .map(|((e, carried), drift)| e + carried - softness * drift)
            .collect()
    }

    /// `Rᵀ t` along the velocities.
    pub(super) fn carried(&self, reaction: &[f64]) -> Vec<f64> {
        let velocities = self.rigid.iter().flat_map(|rigid| {
            let each = 0..rigid.velocities.ncols();
            each.map(|k| rigid.velocities.col_as_slice(k))
        });
        let along = velocities.map(|column| column.iter().zip(reaction).map(|(v, t)| v * t).sum());
        along.collect()
    }

    /// Number of independent rigid motions.
    fn velocities(&self) -> usize {
        self.rigid.as_ref().map_or(0, |rigid| rigid.load.len())
    }

    /// A contact under springs.
    pub(super) fn local(
        &self,
        contact: usize,
        reaction: &[f64],
        beyond: &[f64],
        springs: Springs<'_>,
    ) -> Local {
        let mut local = Local {
            reaction: [0.0; 3],
            beyond: [0.0; 3],
            limits: laws::scaled_limits(self.problem, &self.roots, contact),
            step: (1.0 + springs.softness).recip(),
        };
        for (k, unknown) in self.problem.block(contact).enumerate() {
            let (t, root) = (reaction[unknown], self.roots[unknown]);
            let spring = springs.softness * (t - springs.anchor[unknown]) / root;
            local.reaction[k] = t / root;
            local.beyond[k] = root * beyond[unknown] + spring;
        }
        local
    }

    /// √ρ of a contact's tangents; 1 where there is none.
    pub(super) fn tangential_root(&self, contact: usize) -> f64 {
        match self.roots[self.problem.block(contact)] {
            [_, tangential, ..] => tangential,
            _ => 1.0,
        }
    }

    /// A point whose open contacts carry nothing.
    fn opened(&self, from: &Point, laws: &[Law]) -> Point {
        let mut next = from.clone();
        let mut pressed = laws.iter().map(|law| law.contact).peekable();
        let opened = (0..self.problem.contacts()).filter(|at| pressed.next_if_eq(at).is_none());
        let opened = opened.flat_map(|contact| self.problem.block(contact));
        self.push(&mut next, opened.map(|at| (at, -from.reaction[at])));
        next
    }

    /// Adds to reactions, per unknown in newton.
    fn push(&self, point: &mut Point, changes: impl Iterator<Item = (usize, f64)>) {
        let changes: Vec<(usize, f64)> = changes.filter(|(_, by)| *by != 0.0).collect();
        for &(unknown, by) in &changes {
            point.reaction[unknown] += by;
        }
        add_columns(&mut point.beyond, self.problem.compliance(), &changes);
    }

    /// Matrix of (D4) with (D5): reactions of contacts that are not open, as far as they are free, then rigid motions.
    pub(super) fn matrix(&self, laws: &[Law], softness: f64) -> Mat<f64> {
        let (reactions, motions) = (laws::free(laws), self.velocities());
        let scaled = (self.problem, &self.roots[..]);
        let mut matrix = laws::matrix(laws, scaled, (1.0, softness), motions);
        if let Some(rigid) = &self.rigid {
            for k in 0..motions {
                let velocity = rigid.velocities.col_as_slice(k);
                let moved = |at: usize| self.roots[at] * velocity[at];
                let column = matrix.col_as_slice_mut(reactions + k);
                fill(column, laws::rows(laws, moved));
                column[reactions + k] = -softness;
                for (j, along) in laws::along(laws, moved).enumerate() {
                    matrix[(reactions + k, j)] = along;
                }
            }
        }
        matrix
    }

    /// Minus the residual of (D4) and (D5).
    fn right_side(&self, laws: &[Law], at: &Point, springs: Springs<'_>) -> Col<f64> {
        let local = |contact| self.local(contact, &at.reaction, &at.beyond, springs);
        let rest = self.imbalance(at, springs.softness).into_iter();
        laws::missing(laws, local).chain(rest.map(|e| -e)).collect()
    }
}

/// The first entries of a column.
fn fill(column: &mut [f64], rows: impl Iterator<Item = f64>) {
    let entries = column.iter_mut().zip(rows);
    entries.for_each(|(entry, value)| *entry = value);
}

fn add(sum: &mut [f64], by: f64, column: &[f64]) {
    for (sum, entry) in sum.iter_mut().zip(column) {
        *sum += by * entry;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::mat;

    use super::*;
    use crate::kkt::Judge;
    use crate::problem::{Floating, Operator};

    /// One contact with G = [[1, −1], [−1, 2]], K = G⁻¹ = [[2, 1], [1, 1]], μ = 1/2: ρ = (1, 1/2).
    fn contact(free: [f64; 2]) -> ContactProblem {
        let operator = Operator::from_compliance(mat![[1.0, -1.0], [-1.0, 2.0]]).unwrap();
        ContactProblem::new(&[1], vec![0.5], vec![0.0], free.to_vec(), operator).unwrap()
    }

    /// A step without springs.
    fn step(problem: &ContactProblem, reaction: Vec<f64>, motion: Vec<f64>) -> Point {
        let state = Iterate::new(&Judge::new(problem), reaction, Motion::of(motion));
        let mut finish = Finish::new(problem).unwrap();
        let springs = Springs {
            softness: 0.0,
            anchor: &state.reaction,
        };
        let from = finish.point(&state);
        finish.step(&from, &from.beyond, springs).unwrap()
    }

    fn assert_close(found: &[f64], expected: &[f64]) {
        let pairs = found.iter().zip(expected);
        assert!(
            pairs.clone().all(|(a, b)| (a - b).abs() < 1e-14),
            "{found:?}"
        );
    }

    #[test]
    fn a_contact_at_rest_slips_in_one_step() {
        // p = −(1 · 0.25, ½ · 0.5): 0.25 is more than μ · 0.25. u_N = 0.25 + t_N − t_T = 0, t_T = ½ t_N.
        let found = step(&contact([0.25, 0.5]), vec![0.0; 2], Vec::new());
        assert_close(&found.reaction, &[-0.5, -0.25]);
        // u_T = 0.5 − t_N + 2 t_T.
        assert_close(&found.beyond, &[0.0, 0.5]);
    }

    #[test]
    fn a_contact_that_is_about_to_close_has_a_disc_and_sticks() {
        // Nothing presses yet; the trial point (−1, −0.05) does, and its disc of radius ½ holds: t = −K û.
        let found = step(&contact([1.0, 0.1]), vec![0.0; 2], Vec::new());
        assert_close(&found.reaction, &[-2.1, -1.1]);
        assert_close(&found.beyond, &[0.0; 2]);
    }

    #[test]
    fn an_open_contact_lets_go() {
        let found = step(&contact([-3.0, 0.1]), vec![-1.0, 0.2], Vec::new());
        assert_eq!(found.reaction, [0.0; 2]);
        assert_close(&found.beyond, &[-3.0, 0.1]);
    }

    /// Two smooth contacts of compliance ½ and ¼ m/N under a rigid lid that sinks by α and
    /// tilts by β: u = G t + (α + β, α − β). It carries 6 N and 2 N on the modes.
    fn lid() -> ContactProblem {
        let operator = Operator::from_compliance(mat![[0.5, 0.0], [0.0, 0.25]]).unwrap();
        let problem =
            ContactProblem::new(&[0, 0], vec![0.0; 2], vec![0.0; 2], vec![0.0; 2], operator);
        let modes = mat![[1.0, 1.0], [1.0, -1.0]];
        let floating = Floating::new(modes, vec![6.0, 2.0]).unwrap();
        problem.unwrap().float(floating).unwrap()
    }

    #[test]
    fn a_lid_finds_its_equilibrium_and_its_motion() {
        // t_1 + t_2 + 6 = 0 and t_1 − t_2 + 2 = 0; α + β = ½ · 4, α − β = ¼ · 2.
        let problem = lid();
        let start = vec![0.375, 0.125];
        let found = step(&problem, vec![-1.0; 2], start.clone());
        assert_close(&found.reaction, &[-4.0, -2.0]);
        let finish = Finish::new(&problem).unwrap();
        let moved = finish.moved(&Motion::of(start), &found.drift);
        assert_close(&moved.amplitudes, &[1.25, 0.75]);
    }

    #[test]
    fn nothing_is_missed_at_a_solution_and_the_root_of_an_energy_elsewhere() {
        let problem = contact([0.25, 0.5]);
        let (judge, finish) = (Judge::new(&problem), Finish::new(&problem).unwrap());
        let missed = |reaction: &[f64]| {
            finish.missed(&Iterate::new(&judge, reaction.to_vec(), Motion::default()))
        };
        assert!(missed(&[-0.5, -0.25]) < 1e-15);
        // At rest ρ_N u_N = ¼ and the friction that is missing is μ ¼: ¼/√ρ_N and ⅛/√ρ_T.
        let expected = f64::hypot(0.25, 0.125 * 2.0_f64.sqrt());
        assert!((missed(&[0.0, 0.0]) - expected).abs() < 1e-15);
    }

    #[test]
    fn springs_give_way_by_what_they_carry() {
        // One smooth contact of 1 m/N, û = 1 m, with a spring of σ = 1: (1 + 1) t + 1 = 0.
        let operator = Operator::from_compliance(mat![[1.0]]).unwrap();
        let problem = ContactProblem::new(&[0], vec![0.0], vec![0.0], vec![1.0], operator).unwrap();
        let state = Iterate::new(&Judge::new(&problem), vec![0.0], Motion::default());
        let mut finish = Finish::new(&problem).unwrap();
        let springs = Springs {
            softness: 1.0,
            anchor: &[0.0],
        };
        let from = finish.point(&state);
        let found = finish.step(&from, &from.beyond, springs).unwrap();
        assert_close(&found.reaction, &[-0.5]);
        assert!(finish.residual(&found, springs) < 1e-15);
    }
}
