//! What every compliance of a contact surface offers, with a matrix or without.

use std::fmt::Debug;
use std::ops::Range;

/// G of a contact surface, symmetric positive semi-definite, in m/N: displacements by forces.
///
/// Unknowns follow the contacts, normal first in every block.
pub trait Compliance: Debug {
    /// Number of unknowns.
    fn size(&self) -> usize;

    /// `u + G t` in place of `u`, in metre, for a force per unknown, in N.
    fn add_product(&self, force: &[f64], displacement: &mut [f64]);

    /// Compliance of a contact under forces on itself, rows and columns normal first; zero where its
    /// block of unknowns has no tangent.
    fn diagonal_block(&self, block: Range<usize>) -> [[f64; 3]; 3];

    /// About `G_ss⁻¹ r` on some unknowns s in rising order: what conjugate gradients on them may start
    /// from.
    fn precondition(&self, on: &[usize], residual: &[f64]) -> Vec<f64>;

    /// `G t`, in metre per unknown.
    fn apply(&self, force: &[f64]) -> Vec<f64> {
        let mut displacement = vec![0.0; self.size()];
        self.add_product(force, &mut displacement);
        displacement
    }

    /// Displacement of some unknowns by forces on some others alone, both in rising order.
    fn apply_block(&self, to: &[usize], of: &[usize], force: &[f64]) -> Vec<f64> {
        let mut whole = vec![0.0; self.size()];
        of.iter().zip(force).for_each(|(&at, t)| whole[at] = *t);
        let moved = self.apply(&whole);
        to.iter().map(|&at| moved[at]).collect()
    }
}
