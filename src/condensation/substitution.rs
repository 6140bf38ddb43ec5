//! Forward and backward substitution, over the whole factor or its contact part.
//!
//! ```text
//! forward    L x = b       by columns:  x_j = b_j / L_jj,  then b_i −= L_ij x_j below
//! backward   Lᵀ x = b      by columns:  x_j = (b_j − Σ_{i>j} L_ij x_i) / L_jj
//! ```
//!
//! One right-hand side reads every entry of L once, so memory sets the speed. A
//! supernode works on a dense copy of the entries it touches.

use std::ops::Range;

use super::factor::Factor;

impl Factor {
    /// `x ← L⁻¹ x`.
    pub(crate) fn forward(&self, x: &mut [f64]) {
        self.forward_over(0..self.symbolic.n_supernodes(), self.unknowns(), x);
    }

    /// `x_o ← L⁻¹ x_o`, `x_c ← x_c − W x_o` with the border W (C17).
    pub(crate) fn forward_before_contact(&self, x: &mut [f64]) {
        let ordinary = self.unknowns() - self.contact_unknowns();
        self.forward_over(self.ordinary_supernodes(), ordinary, x);
    }

    /// `x ← L⁻¹ x` for an `x` that vanishes before the contact unknowns.
    pub(crate) fn forward_on_contact(&self, x: &mut [f64]) {
        let contact = self.first_contact_supernode()..self.symbolic.n_supernodes();
        self.forward_over(contact, self.unknowns(), x);
    }

    /// `x ← L⁻ᵀ x`.
    pub(crate) fn backward(&self, x: &mut [f64]) {
        self.backward_over(0..self.symbolic.n_supernodes(), self.unknowns(), x);
    }

    /// `x_o ← L⁻ᵀ (x_o − Wᵀ x_c)` with the border W (C17).
    pub(crate) fn backward_before_contact(&self, x: &mut [f64]) {
        let ordinary = self.unknowns() - self.contact_unknowns();
        self.backward_over(self.ordinary_supernodes(), ordinary, x);
    }

    /// The contact part of `L⁻ᵀ x`, which is `L_cc⁻ᵀ x_c`; `x` is overwritten.
    pub(crate) fn backward_on_contact<'x>(&self, x: &'x mut [f64]) -> &'x [f64] {
        let contact = self.first_contact_supernode()..self.symbolic.n_supernodes();
        self.backward_over(contact, self.unknowns(), x);
        &x[self.unknowns() - self.contact_unknowns()..]
    }

    /// Through the columns before `end` of some supernodes.
    fn forward_over(&self, supernodes: Range<usize>, end: usize, x: &mut [f64]) {
        let mut work = Vec::new();
        for index in supernodes {
            let supernode = self.supernode(index);
            let own = supernode.start..supernode.start + supernode.width;
            work.clear();
            work.extend_from_slice(&x[own.clone()]);
            work.resize(supernode.height(), 0.0);
            for j in 0..supernode.width_before(end) {
                let (above, below) = work.split_at_mut(j + 1);
                let column = supernode.column(j);
                let value = above[j] / column[j];
                above[j] = value;
                for (w, l) in below.iter_mut().zip(&column[j + 1..]) {
                    *w -= l * value;
                }
            }
            x[own].copy_from_slice(&work[..supernode.width]);
            for (&row, change) in supernode.pattern.iter().zip(&work[supernode.width..]) {
                x[row] += change;
            }
        }
    }

    /// Through the columns before `end` of some supernodes, last first.
    fn backward_over(&self, supernodes: Range<usize>, end: usize, x: &mut [f64]) {
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
            for (j, value) in top[..width].iter_mut().enumerate() {
                *value -= dot(&supernode.column(j)[supernode.width..], below);
            }
            for j in (0..width).rev() {
                let column = &supernode.column(j)[..supernode.width];
                top[j] = (top[j] - dot(&column[j + 1..], &top[j + 1..])) / column[j];
            }
            x[own].copy_from_slice(top);
        }
    }
}

/// Inner product in eight running sums, which the processor adds side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a_blocks, a_rest) = a.as_chunks::<8>();
    let (b_blocks, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (x, y) in a_blocks.iter().zip(b_blocks) {
        for lane in 0..8 {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}
