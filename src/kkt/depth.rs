//! Displacements in twice the digits, for where plain sums lose what the judge looks for.
//!
//! A slender body would move by kilometres without its contacts: `û` and `G t` then agree in most of
//! their digits, and the rounding of either hides `u = û + G t + R α`; a body that falls by a metre and indents
//! what it falls on by a picometre leaves no digits to `u_N − g₀`. Products and sums whose
//! rounding errors are summed beside them give it as if computed in twice the precision
//! (Ogita, Rump, Oishi, SIAM J. Sci. Comput. 26 (2005) 1955–1988, algorithm 5.3).

use crate::problem::ContactProblem;
use crate::processor::widest;

/// A sum and what rounding has taken from it.
#[derive(Clone, Copy, Debug, Default)]
struct Deep {
    sum: f64,
    lost: f64,
}

impl Deep {
    #[inline(always)]
    fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        let back = sum - self.sum;
        self.lost += (self.sum - (sum - back)) + (term - back);
        self.sum = sum;
    }

    #[inline(always)]
    fn add_product(&mut self, left: f64, right: f64) {
        let product = left * right;
        self.add(product);
        self.lost += left.mul_add(right, -product);
    }
}

/// Where contacts are, with the digits of [`deep_place`].
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// `u`, in metre per unknown.
    pub(super) displacement: Vec<f64>,
    /// `u_N − g₀` and `u_T`, in metre per unknown.
    pub(super) beyond: Vec<f64>,
}

impl Place {
    /// What a displacement is beyond the gaps.
    pub(super) fn of(problem: &ContactProblem, displacement: Vec<f64>) -> Self {
        let mut beyond = displacement.clone();
        for (&n, gap) in problem.offsets().iter().zip(problem.initial_gap()) {
            beyond[n] -= gap;
        }
        Self {
            displacement,
            beyond,
        }
    }
}

/// `û + G t + R (α + β)`, and the same without the gaps, where β is what the rounding of α left out.
pub(super) fn deep_place(problem: &ContactProblem, reaction: &[f64], motion: [&[f64]; 2]) -> Place {
    let mut sums = vec![Deep::default(); reaction.len()];
    for (sum, free) in sums.iter_mut().zip(problem.free_displacement()) {
        sum.add(*free);
    }
    let modes = problem.floating().map(|floating| floating.modes());
    let moved = motion.into_iter().flat_map(|part| {
        let columns = modes.iter().flat_map(|modes| modes.col_iter());
        columns.zip(part)
    });
    let columns = problem.compliance().col_iter().zip(reaction).chain(moved);
    for (column, &amount) in columns.filter(|(_, amount)| **amount != 0.0) {
        widest(
            #[inline(always)]
            || {
                for (sum, entry) in sums.iter_mut().zip(column.iter()) {
                    sum.add_product(*entry, amount);
                }
            },
        );
    }
    let rounded = |sums: &[Deep]| sums.iter().map(|sum| sum.sum + sum.lost).collect();
    let displacement = rounded(&sums);
    for (&n, gap) in problem.offsets().iter().zip(problem.initial_gap()) {
        sums[n].add(-gap);
    }
    Place {
        displacement,
        beyond: rounded(&sums),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::mat;

    use super::*;
    use crate::problem::{Floating, Operator};

    #[test]
    fn what_plain_sums_lose_is_kept() {
        // û + G t + R α = 1 − 1e16 + 1e16 + ½ R, with R = (1, 0); plain sums lose the 1.
        let operator = Operator::from_compliance(mat![[1e16, 1e16], [1e16, 1e16]]).unwrap();
        let zero = vec![0.0; 2];
        let problem =
            ContactProblem::new(&[0, 0], zero.clone(), zero, vec![1.0; 2], operator).unwrap();
        let floating = Floating::new(mat![[1.0], [0.0]], vec![0.0]).unwrap();
        let problem = problem.float(floating).unwrap();
        let found = deep_place(&problem, &[-1.0, 1.0], [&[0.5], &[0.0]]);
        assert_eq!(found.displacement, [1.5, 1.0]);
    }

    #[test]
    fn an_indentation_far_below_the_digits_of_a_motion_is_kept() {
        // u_N − g₀ = t + (1 + 2⁻⁶⁰) − 1 with t = −2⁻⁶¹: neither 1 + 2⁻⁶⁰ nor u_N is a double.
        let tiny = 2.0_f64.powi(-61);
        let operator = Operator::from_compliance(mat![[1.0]]).unwrap();
        let problem = ContactProblem::new(&[0], vec![0.0], vec![1.0], vec![0.0], operator).unwrap();
        let floating = Floating::new(mat![[1.0]], vec![tiny]).unwrap();
        let problem = problem.float(floating).unwrap();
        let found = deep_place(&problem, &[-tiny], [&[1.0], &[2.0 * tiny]]);
        assert_eq!((found.displacement[0], found.beyond[0]), (1.0, tiny));
    }

    #[test]
    fn a_product_keeps_its_second_half() {
        // (1 + 2⁻³⁰)² − 1 − 2⁻²⁹ = 2⁻⁶⁰, which a plain product rounds off.
        let tiny = 2.0_f64.powi(-30);
        let operator = Operator::from_compliance(mat![[1.0 + tiny]]).unwrap();
        let free = vec![-1.0 - 2.0 * tiny];
        let problem = ContactProblem::new(&[0], vec![0.0], vec![0.0], free, operator).unwrap();
        assert_eq!(
            deep_place(&problem, &[1.0 + tiny], [&[], &[]]).displacement,
            [tiny * tiny]
        );
    }
}
