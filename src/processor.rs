//! Loops compiled for the processor that runs them.
//!
//! A build is for every processor of its kind. The loops in which most time goes are compiled for newer ones as well, with wider
//! registers and with `mul_add` as one instruction, and chosen between when the program runs. Nothing is fused but what says so:
//! every processor has the same bits.

use pulp::Arch;

/// Does some work with the widest registers there are; it has to be `#[inline(always)]`, and all that it calls.
#[inline]
pub(crate) fn widest<T>(work: impl FnOnce() -> T) -> T {
    Arch::new().dispatch(work)
}

/// Inner product in eight running sums, which a processor adds side by side.
#[inline(always)]
pub(crate) fn dot<T: Copy + Into<f64>>(a: &[T], b: &[f64]) -> f64 {
    let (a_blocks, a_rest) = a.as_chunks::<8>();
    let (b_blocks, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (x, y) in a_blocks.iter().zip(b_blocks) {
        for lane in 0..8 {
            let x: f64 = x[lane].into();
            sums[lane] += x * y[lane];
        }
    }
    let rest = a_rest.iter().zip(b_rest);
    let rest: f64 = rest.map(|(&x, y)| Into::<f64>::into(x) * y).sum();
    sums.iter().sum::<f64>() + rest
}

/// Adds a multiple of a column to a sum.
#[inline(always)]
pub(crate) fn add<T: Copy + Into<f64>>(sum: &mut [f64], part: f64, column: &[T]) {
    for (sum, &entry) in sum.iter_mut().zip(column) {
        let entry: f64 = entry.into();
        *sum += part * entry;
    }
}

/// The same with the widest registers.
pub(crate) fn add_column<T: Copy + Into<f64>>(sum: &mut [f64], part: f64, column: &[T]) {
    widest(
        #[inline(always)]
        || add(sum, part, column),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_entry_counts_once_whatever_the_length() {
        for length in [0, 1, 7, 8, 9, 24, 29] {
            let a: Vec<f64> = (0..length).map(f64::from).collect();
            let expected = f64::from(length * (length - 1) * (2 * length - 1) / 6);
            assert_eq!(
                widest(
                    #[inline(always)]
                    || dot(&a, &a)
                ),
                expected
            );
            let mut sum = a.clone();
            add_column(&mut sum, 2.0, &a);
            assert!(sum.iter().zip(&a).all(|(sum, a)| *sum == 3.0 * a));
        }
    }

    #[test]
    fn nothing_is_fused_but_what_says_so() {
        // (1 + 2⁻³⁰)² rounds off 2⁻⁶⁰.
        let a = [1.0 + 2.0_f64.powi(-30); 8];
        let mut sum = [-1.0 - 2.0_f64.powi(-29); 8];
        add_column(&mut sum, a[0], &a);
        assert_eq!(sum, [0.0; 8]);
        let fused = widest(
            #[inline(always)]
            || a[0].mul_add(a[0], -1.0 - 2.0_f64.powi(-29)),
        );
        assert_eq!(fused, 2.0_f64.powi(-60));
    }
}
