//! Contact forces that meet on one line, so that moments balance.
//!
//! A reaction `t n` at `x` on side 1 and `−P_k t n` at `x²_k` on side 2 have the moment
//! `−t v × n` together, `v = Σ_k P_k x²_k − x`. On plane faces `v` is along `n` by itself. On
//! faceted curved ones a small part across the normal is left; the least change of the
//! weights that removes it, with their sum kept, is
//!
//! ```text
//! min Σ_k δ_k²   s.t.  Σ_k δ_k = 0,  Σ_k δ_k τ_k = −v_T        τ_k = (x²_k − x̄²)_T
//! δ_k = −τ_k · (Σ_k τ_k τ_kᵀ)⁻¹ v_T
//! ```
//!
//! By duality a rigid rotation of both sides then opens no contact (C10).

use nalgebra::{Matrix2, Vector2, Vector3};

/// Largest change of a weight. Beyond it the sides are not nearly parallel there: the
/// weights stay, and the gap vector shows what is left.
const LARGEST: f64 = 0.1;

/// Spread of the positions, relative to the largest, that is none.
const RANK: f64 = 1e-10;

/// Corrects the weights in place; positions of side 2 in metre.
pub(super) fn align(
    weights: &mut [(usize, f64)],
    positions: &[[f64; 3]],
    from: [f64; 3],
    normal: Vector3<f64>,
    dimension: usize,
) {
    let axes = tangents(normal, dimension);
    let across = |vector: Vector3<f64>| Vector2::from(axes.map(|axis| axis.dot(&vector)));
    // Relative to x: large coordinates shall not cost digits.
    let offsets = weights
        .iter()
        .map(|(k, _)| Vector3::from(positions[*k]) - Vector3::from(from));
    let mut offsets: Vec<Vector2<f64>> = offsets.map(across).collect();
    let stray = offsets.iter().zip(weights.iter());
    let stray: Vector2<f64> = stray.map(|(offset, (_, weight))| offset * *weight).sum();
    let mean = offsets.iter().sum::<Vector2<f64>>() / offsets.len() as f64;
    let mut spread = Matrix2::zeros();
    for offset in &mut offsets {
        *offset -= mean;
        spread += *offset * offset.transpose();
    }
    let multiplier = solve(spread, stray);
    let changes = offsets.iter().map(|offset| -offset.dot(&multiplier));
    if changes.clone().any(|change| !(change.abs() <= LARGEST)) {
        return;
    }
    for ((_, weight), change) in weights.iter_mut().zip(changes) {
        *weight += change;
    }
}

/// Solves `spread · multiplier = stray` along the directions in which the positions spread.
fn solve(spread: Matrix2<f64>, stray: Vector2<f64>) -> Vector2<f64> {
    let eigen = spread.symmetric_eigen();
    let least = RANK * eigen.eigenvalues.max();
    let mut multiplier = Vector2::zeros();
    for (value, direction) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        if *value > least {
            multiplier += direction * (direction.dot(&stray) / value);
        }
    }
    multiplier
}

/// Two unit vectors across the normal; in 2D the second is zero.
fn tangents(normal: Vector3<f64>, dimension: usize) -> [Vector3<f64>; 2] {
    if dimension == 2 {
        return [Vector3::z().cross(&normal), Vector3::zeros()];
    }
    let mut least = Vector3::zeros();
    least[normal.abs().imin()] = 1.0;
    let first = normal.cross(&least).normalize();
    [first, normal.cross(&first)]
}
