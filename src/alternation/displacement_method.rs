//! A Newton step by displacements, where most contacts stick.
//!
//! The force method has the reactions of all contacts that are not open as unknowns; the displacement method what moves, and
//! a contact that sticks does not. With the stiffness `S = G⁻¹` of the contact surface
//!
//! ```text
//! (D18)  Δt = S w        w: given where a contact sticks; elsewhere unknown, by (D4), and Δt = 0 where it is open
//! ```
//!
//! S is held in single precision. So a solution only corrects a step, which is refined by what (D4) itself leaves.

use std::ops::Range;

use faer::{Col, Mat};
use rayon::prelude::*;

use super::condition::Factored;
use super::laws::{self, Law, dot, of_contact};
use crate::problem::{ContactProblem, RoundedStiffness};

/// Unknown reactions from which on it is looked whether fewer displacements are,
const LARGE: usize = 1024;

/// and part of them that may be: what S costs must pay.
const FEW: f64 = 0.75;

/// The linear system of a step, with displacements as unknowns.
pub(super) struct DisplacementMethod {
    /// All contacts with their laws, none where open.
    contacts: Vec<Contact>,
    matrix: Factored,
}

/// Its unknowns, and its law unless it is open.
type Contact = (Range<usize>, Option<Law>);

impl DisplacementMethod {
    /// `None` where it would not pay, or G has no inverse. Roots are √ρ per unknown.
    pub(super) fn new(laws: &[Law], (problem, roots): (&ContactProblem, &[f64])) -> Option<Self> {
        let stuck = laws.iter().filter(|law| law.sticks());
        let moved = problem.unknowns() - stuck.map(|law| law.block.len()).sum::<usize>();
        let pressed = laws::free(laws);
        if pressed < LARGE || moved as f64 > FEW * pressed as f64 {
            return None;
        }
        let stiffness = problem.operator().rounded_stiffness()?;
        let mut laws = laws.iter().peekable();
        let contacts = (0..problem.contacts()).map(|contact| {
            let law = laws.next_if(|law| law.contact == contact);
            (problem.block(contact), law.cloned())
        });
        let contacts: Vec<Contact> = contacts.collect();
        Some(Self {
            matrix: Factored::new(matrix(&contacts, (stiffness, roots))),
            contacts,
        })
    }

    /// Reactions, so much along each direction in which they are free, for a right side of (D4); nearly.
    pub(super) fn solve(
        &self,
        (problem, roots): (&ContactProblem, &[f64]),
        right: &Col<f64>,
    ) -> Col<f64> {
        let Some(stiffness) = problem.operator().rounded_stiffness() else {
            return right * faer::Scale(f64::NAN);
        };
        let mut force = vec![0.0; problem.unknowns()];
        let carry = |force: &mut [f64], moved: &[(usize, f64)]| {
            let moved = moved.iter().map(|&(at, w)| (at, w / roots[at]));
            stiffness.add_product(force, &moved.collect::<Vec<_>>());
        };
        let (mut right, mut given, mut asked) = (right.iter(), Vec::new(), Vec::<f64>::new());
        for (block, law) in &self.contacts {
            let asked_of = right
                .by_ref()
                .take(law.as_ref().map_or(0, |law| law.directions().len()));
            match law {
                Some(law) if law.sticks() => given.extend(block.clone().zip(asked_of.copied())),
                _ => asked.extend(asked_of.chain(&[0.0; 3]).take(block.len())),
            }
        }
        carry(&mut force, &given);
        let scaled =
            |block: &Range<usize>, force: &[f64]| of_contact(block, |at| force[at] / roots[at]);
        let known = moving(&self.contacts).flat_map(|(block, law)| {
            let carried = scaled(block, &force);
            let rows = rows(law.as_ref(), block.len()).into_iter();
            rows.map(move |row| dot(row.force, carried))
        });
        let left = asked
            .into_iter()
            .zip(known)
            .map(|(asked, known)| asked - known);
        let found = self.matrix.solve(&left.collect());
        let unknowns = moving(&self.contacts).flat_map(|(block, _)| block.clone());
        carry(
            &mut force,
            &unknowns.zip(found.iter().copied()).collect::<Vec<_>>(),
        );
        let amounts = self.contacts.iter().flat_map(|(block, law)| {
            let change = scaled(block, &force);
            law.iter().flat_map(move |law| law.amounts(change))
        });
        amounts.collect()
    }

    /// Laws of the contacts that are not open.
    pub(super) fn laws(&self) -> Vec<Law> {
        self.contacts
            .iter()
            .filter_map(|(_, law)| law.clone())
            .collect()
    }

    /// Products of two numbers that its elimination took.
    pub(super) fn products(&self) -> f64 {
        self.matrix.products()
    }
}

/// Contacts that do not stick.
fn moving(contacts: &[Contact]) -> impl Iterator<Item = &Contact> {
    contacts
        .iter()
        .filter(|(_, law)| !law.as_ref().is_some_and(Law::sticks))
}

/// An equation of a contact that moves: `force · Δt + motion · w` is given.
struct Row {
    force: [f64; 3],
    motion: [f64; 3],
}

/// The law's rows, and those that keep Δt to the directions in which it is free.
fn rows(law: Option<&Law>, unknowns: usize) -> Vec<Row> {
    let still = |force| Row {
        force,
        motion: [0.0; 3],
    };
    match law {
        None => laws::UNITS[..unknowns].iter().copied().map(still).collect(),
        Some(law) => {
            let rows = law.pairs().map(|(force, motion)| Row { force, motion });
            rows.chain(law.tie().map(still)).collect()
        }
    }
}

/// Equations of the contacts that move, a column per unknown of theirs.
fn matrix(contacts: &[Contact], (stiffness, roots): (&RoundedStiffness, &[f64])) -> Mat<f64> {
    let unknowns: Vec<usize> = moving(contacts)
        .flat_map(|(block, _)| block.clone())
        .collect();
    let rows = moving(contacts).flat_map(|(block, law)| {
        let rows = rows(law.as_ref(), block.len()).into_iter();
        rows.map(move |row| (block, row))
    });
    let rows: Vec<(&Range<usize>, Row)> = rows.collect();
    let mut matrix = Mat::zeros(unknowns.len(), unknowns.len());
    let columns = matrix.as_mut().par_col_iter_mut().zip(&unknowns);
    columns.for_each(|(column, &unknown)| {
        for (entry, (block, row)) in column.iter_mut().zip(&rows) {
            let scaled = |at: usize| roots[at] * roots[unknown];
            let carried = of_contact(block, |at| stiffness.entry(at, unknown) / scaled(at));
            let itself = block.contains(&unknown);
            let moved = if itself {
                row.motion[unknown - block.start]
            } else {
                0.0
            };
            *entry = dot(row.force, carried) + moved;
        }
    });
    matrix
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::alternation::condition::times;
    use crate::alternation::laws::Local;
    use crate::problem::{Limits, Operator};

    #[test]
    fn it_solves_what_the_force_method_solves_to_the_digits_of_single_precision() {
        // 400 contacts in space, every tenth slides, every twenty-fifth is open; G_ij = 2^−|i − j|.
        let contacts = 400;
        let unknowns = 3 * contacts;
        let g = |i: usize, j: usize| 0.5_f64.powi(i.abs_diff(j) as i32);
        let operator = Operator::from_compliance(Mat::from_fn(unknowns, unknowns, g)).unwrap();
        let zero = vec![0.0; contacts];
        let problem = ContactProblem::new(
            &vec![2; contacts],
            zero.clone(),
            zero,
            vec![0.0; unknowns],
            operator,
        );
        let problem = problem.unwrap();
        let roots = laws::roots(&problem);
        let of = |sliding: usize| {
            let law = |contact: usize| {
                let slides = contact.is_multiple_of(sliding);
                let local = Local {
                    reaction: [if contact % 25 == 3 { 1.0 } else { -1.0 }, 0.0, 0.0],
                    beyond: [
                        0.0,
                        if slides { 0.6 } else { 0.0 },
                        if slides { -0.8 } else { 0.1 },
                    ],
                    limits: Limits::coulomb(0.4),
                    step: 1.0,
                };
                local.law(contact, problem.block(contact))
            };
            (0..contacts).filter_map(law).collect::<Vec<Law>>()
        };
        let laws = of(10);
        let system = DisplacementMethod::new(&laws, (&problem, &roots)).unwrap();
        let matrix = laws::matrix(&laws, (&problem, &roots), (1.0, 0.0), 0);
        let expected = Col::from_fn(laws::free(&laws), |k| (k as f64).sin());
        let found = system.solve((&problem, &roots), &times(&matrix, &expected));
        let off = (&found - &expected).norm_max();
        assert!(off < 1e-5, "{off:e}");
        // Where most contacts slide it would not pay.
        assert!(DisplacementMethod::new(&of(1), (&problem, &roots)).is_none());
    }
}
