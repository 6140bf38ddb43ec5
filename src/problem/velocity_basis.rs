//! Rigid motions as the contacts feel them, free of units.
//!
//! ```text
//! R C⁻¹ = Q Σ Vᵀ      C: size of each mode on the contacts
//! β = Σ Vᵀ C α        so that R α = Q β, ‖β‖ = ‖R α‖,  and  Rᵀ t + e = 0  ⇔  Qᵀ t + e' = 0,  e' = Σ⁻¹ Vᵀ C⁻¹ e
//! ```
//!
//! Singular directions without a singular value are idle: they move no contact, and no
//! contact can answer a load on them.

use faer::{Mat, MatRef};

/// A singular value below this part of the largest moves no contact.
const RANK: f64 = 1e-10;

/// A mode smaller than this part of the largest is round-off, whatever unit its amplitude has.
const NOISE: f64 = 1e-13;

/// Orthonormal velocities Q of the contacts, and the motions behind them.
#[derive(Clone, Debug)]
pub(crate) struct VelocityBasis {
    /// Q, unknowns × rank.
    pub(crate) velocities: Mat<f64>,
    /// `C⁻¹ V Σ⁻¹`: amplitudes α of the columns of Q.
    moving: Mat<f64>,
    /// `C⁻¹ V` of the idle directions.
    idle: Mat<f64>,
    /// C.
    sizes: Vec<f64>,
}

impl VelocityBasis {
    /// Splits the modes R; `None` if the singular value decomposition does not converge.
    pub(crate) fn new(modes: MatRef<'_, f64>) -> Option<Self> {
        let (unknowns, count) = (modes.nrows(), modes.ncols());
        let sizes = sizes(modes);
        // Rows of zeros so that all of V comes out, also with fewer unknowns than modes.
        let scaled = Mat::from_fn(unknowns.max(count), count, |i, j| {
            if i < unknowns {
                modes[(i, j)] / sizes[j]
            } else {
                0.0
            }
        });
        let svd = scaled.thin_svd().ok()?;
        let values: Vec<f64> = svd.S().column_vector().iter().copied().collect();
        let largest = values.first().copied().unwrap_or(0.0);
        let rank = values
            .iter()
            .take_while(|&&value| value > RANK * largest)
            .count();
        let v = svd.V();
        Some(Self {
            velocities: svd.U().get(..unknowns, ..rank).to_owned(),
            moving: Mat::from_fn(count, rank, |k, j| v[(k, j)] / (values[j] * sizes[k])),
            idle: Mat::from_fn(count, count - rank, |k, j| v[(k, rank + j)] / sizes[k]),
            sizes,
        })
    }

    /// Number of independent velocities.
    pub(crate) fn rank(&self) -> usize {
        self.moving.ncols()
    }

    /// Q.
    pub(crate) fn velocities(&self) -> MatRef<'_, f64> {
        self.velocities.as_ref()
    }

    /// α of `β`.
    pub(crate) fn amplitudes(&self, beta: &[f64]) -> Vec<f64> {
        product(self.moving.as_ref(), beta)
    }

    /// `e'` of a load resultant.
    pub(crate) fn load(&self, resultant: &[f64]) -> Vec<f64> {
        product(self.moving.transpose(), resultant)
    }

    /// The load on the idle directions.
    pub(crate) fn idle_load(&self, resultant: &[f64]) -> Vec<f64> {
        product(self.idle.transpose(), resultant)
    }

    /// α of the idle motion that goes with a load on the idle directions.
    pub(crate) fn idle_amplitudes(&self, idle_load: &[f64]) -> Vec<f64> {
        product(self.idle.as_ref(), idle_load)
    }

    /// Size of a load resultant, comparable to that on the idle directions.
    pub(crate) fn load_size(&self, resultant: &[f64]) -> f64 {
        norm(resultant.iter().zip(&self.sizes).map(|(e, c)| e / c))
    }

    /// Largest amplitude, each measured by the size of its mode.
    pub(crate) fn largest_amplitude(&self, amplitudes: &[f64]) -> f64 {
        let sized = amplitudes.iter().zip(&self.sizes);
        sized.fold(0.0, |largest, (a, c)| largest.max((a * c).abs()))
    }
}

/// Largest entry of each column; of a column that is nothing but round-off, the largest of all.
fn sizes(modes: MatRef<'_, f64>) -> Vec<f64> {
    let mut sizes: Vec<f64> = modes.col_iter().map(|column| column.norm_max()).collect();
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    for size in &mut sizes {
        if *size <= NOISE * largest {
            *size = if largest > 0.0 { largest } else { 1.0 };
        }
    }
    sizes
}

/// `A x`.
pub(crate) fn product(a: MatRef<'_, f64>, x: &[f64]) -> Vec<f64> {
    let mut result = vec![0.0; a.nrows()];
    for (column, &x) in a.col_iter().zip(x) {
        for (sum, entry) in result.iter_mut().zip(column.iter()) {
            *sum += entry * x;
        }
    }
    result
}

/// Euclidean norm, without overflow for the sizes that loads come in.
pub(crate) fn norm(entries: impl Iterator<Item = f64>) -> f64 {
    entries.fold(0.0, f64::hypot)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use faer::mat;

    #[test]
    fn the_basis_moves_the_contacts_as_the_modes_do() {
        let modes = mat![[0.0, -1.0, 2e3], [1.0, 0.0, 0.5e3], [0.0, -1.0, -2e3]];
        let basis = VelocityBasis::new(modes.as_ref()).unwrap();
        assert_eq!(basis.rank(), 3);
        let beta = [0.3, -0.2, 0.7];
        let expected = product(basis.velocities.as_ref(), &beta);
        let found = product(modes.as_ref(), &basis.amplitudes(&beta));
        assert!(
            expected
                .iter()
                .zip(&found)
                .all(|(a, b)| (a - b).abs() < 1e-14)
        );
        // Work does not change: e·α = e'·β.
        let e = [4.0, -3.0, 7e3];
        let work: f64 = e
            .iter()
            .zip(basis.amplitudes(&beta))
            .map(|(e, a)| e * a)
            .sum();
        let same: f64 = basis.load(&e).iter().zip(beta).map(|(e, b)| e * b).sum();
        assert!((work - same).abs() < 1e-12);
    }

    #[test]
    fn motions_that_no_contact_feels_are_idle() {
        // Two frictionless contacts on a line: only normal unknowns, x and everything
        // out of the plane of the normals is free. 6e-17 is what cos 90° leaves.
        let modes = mat![[6e-17, -1.0, 1.0], [6e-17, -1.0, -1.0]];
        let basis = VelocityBasis::new(modes.as_ref()).unwrap();
        assert_eq!(basis.rank(), 2);
        let idle = basis.idle_load(&[5.0, 0.0, 0.0]);
        let motion = basis.idle_amplitudes(&idle);
        assert!(motion[0].abs() > 1.0 && motion[1].abs() < 1e-12 && motion[2].abs() < 1e-12);
    }

    #[test]
    fn no_contact_and_no_mode_are_fine() {
        let basis = VelocityBasis::new(Mat::<f64>::zeros(0, 3).as_ref()).unwrap();
        assert_eq!(
            (basis.rank(), basis.idle_load(&[1.0, 2.0, 3.0]).len()),
            (0, 3)
        );
        let basis = VelocityBasis::new(Mat::<f64>::zeros(4, 0).as_ref()).unwrap();
        assert_eq!(basis.rank(), 0);
    }
}
