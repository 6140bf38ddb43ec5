//! Forward and backward substitution, over the whole factor or its contact part.
//!
//! ```text
//! forward    L x = b       by columns:  x_j = b_j / L_jj,  then b_i −= L_ij x_j below
//! backward   Lᵀ x = b      by columns:  x_j = (b_j − Σ_{i>j} L_ij x_i) / L_jj
//! ```
//!
//! One right-hand side reads every entry of L once, so memory sets the speed. A
//! supernode works on a dense copy of the entries it touches, in double precision whatever L is stored in.

use std::ops::Range;

use super::supernodes::{Lower, Number};
use crate::processor::{add, dot, widest};

impl<T: Number> Lower<'_, T> {
    /// Through the columns before `end` of some supernodes.
    pub(super) fn forward_over(&self, supernodes: Range<usize>, end: usize, x: &mut [f64]) {
        let mut work = Vec::new();
        for index in supernodes {
            let supernode = self.supernode(index);
            let own = supernode.start..supernode.start + supernode.width;
            work.clear();
            work.extend_from_slice(&x[own.clone()]);
            work.resize(supernode.height(), 0.0);
            widest(
                #[inline(always)]
                || {
                    for j in 0..supernode.width_before(end) {
                        let (above, below) = work.split_at_mut(j + 1);
                        let column = supernode.column(j);
                        let pivot: f64 = column[j].into();
                        let value = above[j] / pivot;
                        above[j] = value;
                        add(below, -value, &column[j + 1..]);
                    }
                },
            );
            x[own].copy_from_slice(&work[..supernode.width]);
            for (&row, change) in supernode.pattern.iter().zip(&work[supernode.width..]) {
                x[row] += change;
            }
        }
    }

    /// Through the columns before `end` of some supernodes, last first.
    pub(super) fn backward_over(&self, supernodes: Range<usize>, end: usize, x: &mut [f64]) {
        let mut work = Vec::new();
        for index in supernodes.rev() {
            let supernode = self.supernode(index);
            let width = supernode.width_before(end);
            let own = supernode.start..supernode.start + supernode.width;
            work.clear();
            work.extend_from_slice(&x[own.clone()]);
            work.extend(supernode.pattern.iter().map(|&row| x[row]));
            let (top, below) = work.split_at_mut(supernode.width);
            // All of the supernode once in the order of memory, its triangle from the cache.
            widest(
                #[inline(always)]
                || {
                    for (j, value) in top[..width].iter_mut().enumerate() {
                        *value -= dot(&supernode.column(j)[supernode.width..], below);
                    }
                    for j in (0..width).rev() {
                        let column = &supernode.column(j)[..supernode.width];
                        let pivot: f64 = column[j].into();
                        top[j] = (top[j] - dot(&column[j + 1..], &top[j + 1..])) / pivot;
                    }
                },
            );
            x[own].copy_from_slice(top);
        }
    }
}
