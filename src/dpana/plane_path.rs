//! A path of states of plane contact, followed exactly from one change of a contact to the next.
//!
//! ```text
//!        u = û + λ h + G t
//!
//!        open    t = 0                           while  g₀ − u_N ≥ 0
//! (D10)  slip    u_N = g₀,  t_T = −μ t_N d       while  −t_N ≥ 0,  −d u_T ≥ 0        d = ±1
//!        stick   u_N = g₀,  u_T = 0              while  −μ t_N ∓ t_T ≥ 0
//! ```
//!
//! In the plane the laws have straight pieces only: while no contact changes what it does, `t` and `u`
//! are linear in λ. Where a condition is about to break its contact changes, and λ goes on, or turns
//! back where one λ has several states, whichever leads into the new piece: complementary pivoting
//! (Cottle, Pang, Stone, The Linear Complementarity Problem, 1992, §4.4).
//!
//! With `h = −1` along the normals nothing touches while λ is large, and the path brings the surfaces
//! together. It cannot come back to where it started, as `t = 0` is the only state there, nor
//! run off, as a positive definite G bounds all states: it ends at λ = 0, in a state of the problem, however
//! much friction there is.

use faer::linalg::solvers::Solve;
use faer::{Col, Mat};

use super::Outcome;
use super::condition::times;
use crate::condensation::ContactProblem;
use crate::kkt::ContactStatus;

/// G is taken larger by this part of its diagonal on the way: definite, where contacts stand twice too.
const SHIFT: f64 = 1e-12;

/// Changes of contacts on a path at most, per contact.
const CHANGES: usize = 1000;

/// Products of two numbers on a path at most: that of a minute.
const PRODUCTS: f64 = 1e12;

/// A condition that changes by less than this part of the fastest does not change.
const STILL: f64 = 1e-13;

/// What a contact does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Does {
    Open,
    /// With friction along this sign of its tangent; zero without a tangent.
    Slip(f64),
    Stick,
}

/// How a path ended.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum End {
    /// At the parameter asked for, with this reaction.
    Reached(Vec<f64>),
    /// Where it turned back.
    Turned(f64),
    /// Where it was left: no next piece, or too many.
    Lost(f64),
}

/// A path on its way.
pub(super) struct PlanePath<'a> {
    problem: &'a ContactProblem,
    /// h, in metre per unknown and unit of λ.
    drive: Col<f64>,
    does: Vec<Does>,
    /// λ.
    parameter: f64,
    /// Sign of the change of λ.
    way: f64,
    /// Contacts that changed so far, one after the other.
    pub(super) changes: usize,
}

/// The line that a piece is part of: values at the parameter, and their change with it.
struct Line {
    reaction: [Col<f64>; 2],
    displacement: [Col<f64>; 2],
}

/// A reaction along an unknown, with the friction that it brings along the next.
struct Column {
    contact: usize,
    unknown: usize,
    friction: f64,
}

/// One condition of (D10), not negative on its piece.
#[derive(Clone, Copy)]
struct Condition {
    contact: usize,
    /// What the contact does beyond it.
    beyond: Does,
    value: f64,
    rate: f64,
    /// Size of rates of its kind.
    scale: f64,
}

impl<'a> PlanePath<'a> {
    /// From surfaces far apart; none if a contact has two tangents, or bodies float.
    pub(super) fn of_approach(problem: &'a ContactProblem) -> Option<Self> {
        let mut drive = Col::zeros(problem.unknowns());
        let mut deepest = 0.0_f64;
        for (&n, gap) in problem.offsets().iter().zip(problem.initial_gap()) {
            drive[n] = -1.0;
            deepest = deepest.max(problem.free_displacement()[n] - gap);
        }
        Self::new(
            problem,
            drive,
            vec![Does::Open; problem.contacts()],
            2.0 * deepest,
        )
    }

    /// From a state with λ = 1 of a problem that is given with λ = 0, driven by `drive` in metre per
    /// unknown; none if a contact has two tangents, or bodies float.
    pub(super) fn back(
        problem: &'a ContactProblem,
        outcome: &Outcome,
        drive: &[f64],
    ) -> Option<Self> {
        let does = outcome.verdict.status.iter().enumerate();
        let does = does.map(|(contact, status)| match status {
            ContactStatus::Open => Does::Open,
            ContactStatus::Stick => Does::Stick,
            ContactStatus::Slip => {
                let friction = outcome.reaction.get(problem.offsets()[contact] + 1);
                match friction {
                    Some(t) if is_rough(problem, contact) => Does::Slip(t.signum()),
                    _ => Does::Slip(0.0),
                }
            }
        });
        let drive = Col::from_fn(drive.len(), |k| drive[k]);
        Self::new(problem, drive, does.collect(), 1.0)
    }

    fn new(
        problem: &'a ContactProblem,
        drive: Col<f64>,
        does: Vec<Does>,
        parameter: f64,
    ) -> Option<Self> {
        let plane = problem
            .offsets()
            .windows(2)
            .all(|ends| ends[1] - ends[0] <= 2);
        (plane && problem.floating().is_none()).then(|| Self {
            problem,
            drive,
            does,
            parameter,
            way: -1.0,
            changes: 0,
        })
    }

    /// Follows the path down to λ = 0, round its turns if it may turn.
    pub(super) fn follow(&mut self, turning: bool) -> End {
        let mut products = 0.0;
        let Some(mut line) = self.line(&mut products) else {
            return End::Lost(self.parameter);
        };
        loop {
            let Some((stride, next)) = self.first_to_break(&line) else {
                return End::Lost(self.parameter);
            };
            let Some(next) = next else {
                self.parameter = 0.0;
                return End::Reached(self.last());
            };
            if self.changes == CHANGES * self.problem.contacts() || products > PRODUCTS {
                return End::Lost(self.parameter);
            }
            self.changes += 1;
            self.parameter += self.way * stride;
            let before = std::mem::replace(&mut self.does[next.contact], next.beyond);
            let Some(new) = self.line(&mut products) else {
                return End::Lost(self.parameter);
            };
            let conditions = self.conditions(&new, next.contact);
            // An open contact closes into the slip that its motion asks for.
            let open = next.beyond == Does::Open;
            let mut conditions = conditions.into_iter().flatten();
            let Some(entered) = conditions.find(|edge| open || edge.beyond == before) else {
                return End::Lost(self.parameter);
            };
            if entered.rate == 0.0 {
                return End::Lost(self.parameter);
            }
            let way = entered.rate.signum();
            if way != self.way && !turning {
                return End::Turned(self.parameter);
            }
            (self.way, line) = (way, new);
        }
    }

    /// The condition that breaks first on the way, and the distance to it; or to λ = 0. None if λ
    /// grows without end.
    fn first_to_break(&self, line: &Line) -> Option<(f64, Option<Condition>)> {
        let mut first = (self.way < 0.0).then_some((self.parameter, None));
        for contact in 0..self.problem.contacts() {
            for condition in self.conditions(line, contact).into_iter().flatten() {
                let rate = self.way * condition.rate;
                if rate >= -STILL * condition.scale {
                    continue;
                }
                let distance = condition.value.max(0.0) / -rate;
                if first.is_none_or(|(nearest, _)| distance < nearest) {
                    first = Some((distance, Some(condition)));
                }
            }
        }
        first
    }

    /// The line of what the contacts do; none if it is not finite.
    fn line(&self, products: &mut f64) -> Option<Line> {
        let columns = self.columns();
        *products += (columns.len() as f64).powi(3) / 3.0 + (self.drive.nrows() as f64).powi(2);
        let closing = self.closing(&columns);
        let right = Mat::from_fn(columns.len(), 2, |i, part| match part {
            0 => closing[i],
            _ => -self.drive[columns[i].unknown],
        });
        let found = self.matrix(&columns).partial_piv_lu().solve(right);
        let finite = found.col_iter().flat_map(|column| column.iter());
        if !finite.into_iter().all(|x| x.is_finite()) {
            return None;
        }
        let reaction = [0, 1].map(|part| self.reaction(&columns, &found.col(part).to_owned()));
        let (free, g) = (self.problem.free_displacement(), self.problem.compliance());
        let moved = [0, 1].map(|part| times(g, &reaction[part]));
        let at = |k: usize, part: usize| moved[part][k] + self.own(k) * reaction[part][k];
        let displacement = [
            Col::from_fn(free.len(), |k| {
                free[k] + self.parameter * self.drive[k] + at(k, 0)
            }),
            Col::from_fn(free.len(), |k| self.drive[k] + at(k, 1)),
        ];
        Some(Line {
            reaction,
            displacement,
        })
    }

    /// The reaction at λ = 0 under G as it is, corrected by what the shift did.
    fn last(&self) -> Vec<f64> {
        let columns = self.columns();
        let factor = self.matrix(&columns).partial_piv_lu();
        let shifted = factor.solve(self.closing(&columns));
        let off = Col::from_fn(columns.len(), |i| self.own(columns[i].unknown) * shifted[i]);
        let reaction = self.reaction(&columns, &(&shifted + factor.solve(off)));
        reaction.iter().copied().collect()
    }

    fn columns(&self) -> Vec<Column> {
        let mut columns = Vec::new();
        for (contact, does) in self.does.iter().enumerate() {
            let unknown = self.problem.offsets()[contact];
            let mut add = |unknown, friction| {
                columns.push(Column {
                    contact,
                    unknown,
                    friction,
                })
            };
            match *does {
                Does::Open => {}
                Does::Slip(d) => add(unknown, -self.problem.friction()[contact] * d),
                Does::Stick => {
                    add(unknown, 0.0);
                    add(unknown + 1, 0.0);
                }
            }
        }
        columns
    }

    /// What G is taken larger by on its diagonal.
    fn own(&self, unknown: usize) -> f64 {
        SHIFT * self.problem.compliance()[(unknown, unknown)]
    }

    /// Displacements at the columns' unknowns per reaction along the columns.
    fn matrix(&self, columns: &[Column]) -> Mat<f64> {
        let g = self.problem.compliance();
        Mat::from_fn(columns.len(), columns.len(), |i, j| {
            let (row, column) = (columns[i].unknown, columns[j].unknown);
            let mut moved = g[(row, column)];
            if columns[j].friction != 0.0 {
                moved += columns[j].friction * g[(row, column + 1)];
            }
            if i == j { moved + self.own(row) } else { moved }
        })
    }

    /// What closes gaps and undoes slips at the columns' unknowns.
    fn closing(&self, columns: &[Column]) -> Col<f64> {
        Col::from_fn(columns.len(), |i| {
            let (k, contact) = (columns[i].unknown, columns[i].contact);
            let normal = k == self.problem.offsets()[contact];
            let gap = if normal {
                self.problem.initial_gap()[contact]
            } else {
                0.0
            };
            gap - self.problem.free_displacement()[k] - self.parameter * self.drive[k]
        })
    }

    /// Along the columns by this much.
    fn reaction(&self, columns: &[Column], along: &Col<f64>) -> Col<f64> {
        let mut reaction = Col::zeros(self.problem.unknowns());
        for (column, t) in columns.iter().zip(along.iter()) {
            reaction[column.unknown] += t;
            if column.friction != 0.0 {
                reaction[column.unknown + 1] += column.friction * t;
            }
        }
        reaction
    }

    /// The conditions of what a contact does.
    fn conditions(&self, line: &Line, contact: usize) -> [Option<Condition>; 2] {
        let n = self.problem.offsets()[contact];
        let (mu, rough) = (
            self.problem.friction()[contact],
            is_rough(self.problem, contact),
        );
        let ([t, t_rate], [u, u_rate]) = (&line.reaction, &line.displacement);
        let of_forces = |beyond, of: &dyn Fn(&Col<f64>) -> f64| Condition {
            contact,
            beyond,
            value: of(t),
            rate: of(t_rate),
            scale: (1.0 + mu) * t_rate.norm_max(),
        };
        let of_motions = |beyond, value, rate| Condition {
            contact,
            beyond,
            value,
            rate,
            scale: self.drive.norm_max(),
        };
        match self.does[contact] {
            Does::Open => {
                // It will slip the way it moves, against its friction.
                let slip = match rough {
                    true if u[n + 1] > 0.0 => Does::Slip(-1.0),
                    true => Does::Slip(1.0),
                    false => Does::Slip(0.0),
                };
                let gap = self.problem.initial_gap()[contact] - u[n];
                [Some(of_motions(slip, gap, -u_rate[n])), None]
            }
            Does::Slip(d) => [
                Some(of_forces(Does::Open, &|t| -t[n])),
                rough.then(|| of_motions(Does::Stick, -d * u[n + 1], -d * u_rate[n + 1])),
            ],
            Does::Stick => {
                [1.0, -1.0].map(|d| Some(of_forces(Does::Slip(d), &|t| -mu * t[n] - d * t[n + 1])))
            }
        }
    }
}

/// Whether friction holds a contact at all.
fn is_rough(problem: &ContactProblem, contact: usize) -> bool {
    let ends = &problem.offsets()[contact..contact + 2];
    ends[1] > ends[0] + 1 && problem.friction()[contact] > 0.0
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::mat;

    use super::*;
    use crate::condensation::Operator;
    use crate::dpana::{Settings, solve};

    /// One contact, K = G⁻¹ = [[2, 1], [1, 1]]; more than one state for some loads if μ > 1.
    fn contact(friction: f64, free: [f64; 2]) -> ContactProblem {
        let operator = Operator::from_compliance(mat![[1.0, -1.0], [-1.0, 2.0]]).unwrap();
        ContactProblem::new(&[1], vec![friction], vec![0.0], free.to_vec(), operator).unwrap()
    }

    #[test]
    fn an_approach_ends_in_a_state_that_sticks() {
        // û = (1, 0.2): t = −K û = (−2.2, −1.2), |t_T| <= 1.5 · 2.2.
        let problem = contact(1.5, [1.0, 0.2]);
        let mut path = PlanePath::of_approach(&problem).unwrap();
        let End::Reached(reaction) = path.follow(true) else {
            unreachable!()
        };
        assert!(
            (reaction[0] + 2.2).abs() < 1e-14 && (reaction[1] + 1.2).abs() < 1e-14,
            "{reaction:?}"
        );
    }

    #[test]
    fn an_approach_goes_round_its_turn() {
        // û = (−0.1, 0.5) is open, slips with t = (−0.2, −0.3), or sticks (references, item 12, μ > 1). Closing
        // gaps from afar, n = −0.1 − λ, never touches.
        let problem = contact(1.5, [-0.1, 0.5]);
        let mut path = PlanePath::of_approach(&problem).unwrap();
        assert_eq!(path.follow(true), End::Reached(vec![0.0, 0.0]));
        // From û = (0.1, 0.5) every approach passes n = 0, where the open contact starts to slip along its
        // friction: u_N = n − λ + t_N − t_T = 0 with t_T = 1.5 t_N gives t_N = 2 (n − λ) < 0 only while λ
        // grows again, up to where it sticks (τ = 4 |n − λ|: λ = 0.225), and on to t = −K û.
        let problem = contact(1.5, [0.1, 0.5]);
        let mut path = PlanePath::of_approach(&problem).unwrap();
        let End::Reached(reaction) = path.follow(true) else {
            unreachable!()
        };
        assert!(
            (reaction[0] + 0.7).abs() < 1e-14 && (reaction[1] + 0.6).abs() < 1e-14,
            "{reaction:?}"
        );
        assert_eq!(path.changes, 2);
    }

    #[test]
    fn a_way_back_stops_where_the_state_turns() {
        // From û = (0.1, 0.5), sticking, to (−0.1, 0.3): n = −0.1 + 0.2 λ, τ = 0.3 + 0.2 λ. It sticks
        // while τ >= 4 |n|, to λ = 0.1, and slips from there on with more load only.
        let end = contact(1.5, [0.1, 0.5]);
        let outcome = solve(&end, &Settings::default()).unwrap();
        let start = contact(1.5, [-0.1, 0.3]);
        let mut path = PlanePath::back(&start, &outcome, &[0.2, 0.2]).unwrap();
        let End::Turned(part) = path.follow(false) else {
            unreachable!()
        };
        // The end is certified to 1e-12 and its gaps are shifted by as much; λ moves five times as fast as n.
        assert!((part - 0.1).abs() < 1e-11, "{part}");
    }

    #[test]
    fn contacts_in_space_have_no_plane_path() {
        let operator = Operator::from_compliance(Mat::identity(3, 3)).unwrap();
        let problem = ContactProblem::new(&[2], vec![0.5], vec![0.0], vec![0.0; 3], operator);
        assert!(PlanePath::of_approach(&problem.unwrap()).is_none());
    }
}
