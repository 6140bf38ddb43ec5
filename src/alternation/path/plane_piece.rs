//! One piece of a path of plane contact: what every contact does, the line that follows from it, and the
//! conditions under which the contacts go on doing it (D10).

use faer::linalg::solvers::Solve;
use faer::{Col, Mat};

use crate::alternation::condition::times;
use crate::problem::ContactProblem;

/// G is taken larger by this part of its diagonal on the way: definite, where contacts stand twice too.
const SHIFT: f64 = 1e-12;

/// What a contact does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Does {
    Open,
    /// With friction along this sign of its tangent; zero where nothing holds it.
    Slip(f64),
    Stick,
}

/// What every contact does while λ changes.
pub(super) struct Piece<'a> {
    pub(super) problem: &'a ContactProblem,
    /// h, in metre per unknown and unit of λ.
    pub(super) drive: Col<f64>,
    pub(super) does: Vec<Does>,
}

/// The line that a piece is part of: values at some λ, and their change with it.
pub(super) struct Line {
    reaction: [Col<f64>; 2],
    displacement: [Col<f64>; 2],
}

/// One condition of (D10), not negative on its piece.
#[derive(Clone, Copy)]
pub(super) struct Condition {
    pub(super) contact: usize,
    /// What the contact does beyond it.
    pub(super) beyond: Does,
    pub(super) value: f64,
    pub(super) rate: f64,
    /// Size of rates of its kind.
    pub(super) scale: f64,
}

/// A reaction along an unknown, with the friction that it brings along the next.
struct Column {
    contact: usize,
    unknown: usize,
    friction: f64,
}

impl Piece<'_> {
    /// The line of what the contacts do, from λ on; none if it is not finite.
    pub(super) fn line(&self, parameter: f64) -> Option<Line> {
        let columns = self.columns();
        let closing = self.closing(&columns, parameter);
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
                free[k] + parameter * self.drive[k] + at(k, 0)
            }),
            Col::from_fn(free.len(), |k| self.drive[k] + at(k, 1)),
        ];
        Some(Line {
            reaction,
            displacement,
        })
    }

    /// The reaction at a λ under G as it is, corrected by what the shift did.
    pub(super) fn last(&self, parameter: f64) -> Vec<f64> {
        let columns = self.columns();
        let factor = self.matrix(&columns).partial_piv_lu();
        let shifted = factor.solve(self.closing(&columns, parameter));
        let off = Col::from_fn(columns.len(), |i| self.own(columns[i].unknown) * shifted[i]);
        let reaction = self.reaction(&columns, &(&shifted + factor.solve(off)));
        reaction.iter().copied().collect()
    }

    /// Products of two numbers that its line takes.
    pub(super) fn products(&self) -> f64 {
        let columns = self.columns().len() as f64;
        columns.powi(3) / 3.0 + 2.0 * (self.drive.nrows() as f64).powi(2)
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
    fn closing(&self, columns: &[Column], parameter: f64) -> Col<f64> {
        Col::from_fn(columns.len(), |i| {
            let (k, contact) = (columns[i].unknown, columns[i].contact);
            let normal = k == self.problem.offsets()[contact];
            let gap = if normal {
                self.problem.initial_gap()[contact]
            } else {
                0.0
            };
            gap - self.problem.free_displacement()[k] - parameter * self.drive[k]
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
    pub(super) fn conditions(&self, line: &Line, contact: usize) -> [Option<Condition>; 2] {
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
pub(super) fn is_rough(problem: &ContactProblem, contact: usize) -> bool {
    let ends = &problem.offsets()[contact..contact + 2];
    ends[1] > ends[0] + 1 && problem.friction()[contact] > 0.0
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::{Mat, col};

    use super::*;
    use crate::problem::Operator;

    #[test]
    fn a_sticking_contact_carries_what_moves_it_until_its_disc_is_full() {
        // G = 1, u = û + λ h + t = 0 with û = (1, 0), h = (0, 1): t = (−1, −λ), and μ = ½ ends it at λ = ½.
        let operator = Operator::from_compliance(Mat::identity(2, 2)).unwrap();
        let problem =
            ContactProblem::new(&[1], vec![0.5], vec![0.0], vec![1.0, 0.0], operator).unwrap();
        let piece = Piece {
            problem: &problem,
            drive: col![0.0, 1.0],
            does: vec![Does::Stick],
        };
        let line = piece.line(0.25).unwrap();
        let edges = piece.conditions(&line, 0).map(Option::unwrap);
        let close =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-11, "{found}");
        // −μ t_N ∓ t_T at λ = ¼.
        assert_eq!(edges[1].beyond, Does::Slip(-1.0));
        close(edges[1].value, 0.25);
        close(edges[1].rate, -1.0);
        close(edges[0].value, 0.75);
        close(piece.last(0.25)[1], -0.25);
    }

    #[test]
    fn a_slipping_contact_sticks_where_its_motion_turns_and_an_open_one_closes() {
        // G = 1, û = (1, 0), h = (0, 1), μ = ½, friction against u_T > 0: t = (−1, −½), u_T = λ − ½.
        let of = |free: Vec<f64>, drive, does| {
            let operator = Operator::from_compliance(Mat::identity(2, 2)).unwrap();
            let problem = ContactProblem::new(&[1], vec![0.5], vec![0.0], free, operator).unwrap();
            let piece = Piece {
                problem: &problem,
                drive,
                does: vec![does],
            };
            piece.conditions(&piece.line(0.75).unwrap(), 0)
        };
        let close =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-11, "{found}");
        let slips = of(vec![1.0, 0.0], col![0.0, 1.0], Does::Slip(-1.0)).map(Option::unwrap);
        assert_eq!(slips.map(|edge| edge.beyond), [Does::Open, Does::Stick]);
        close(slips[0].value, 1.0);
        close(slips[1].value, 0.25);
        close(slips[1].rate, 1.0);
        // û = (−1, 2) with h = (1, 0): a gap of 1 − λ, and it will slip against u_T = 2.
        let [open, none] = of(vec![-1.0, 2.0], col![1.0, 0.0], Does::Open);
        let open = open.unwrap();
        assert!(none.is_none() && open.beyond == Does::Slip(-1.0));
        close(open.value, 0.25);
        close(open.rate, -1.0);
    }
}
