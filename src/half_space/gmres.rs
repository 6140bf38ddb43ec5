//! GMRES, preconditioned on the right (Saad & Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856–869).

use super::vectors::{add, dot, norm, scaled};

/// Steps without restart; all their directions are kept.
const MOST_STEPS: usize = 80;

/// A system of equations by its products.
pub(super) trait Linear {
    fn apply(&self, unknown: &[f64]) -> Vec<f64>;
    fn precondition(&self, right: &[f64]) -> Vec<f64>;
}

/// The unknowns whose residual is below `tolerance` of the right side, or the best of the last step;
/// nothing where the right side is zero or not finite.
pub(super) fn gmres(system: &impl Linear, right: &[f64], tolerance: f64) -> Option<Vec<f64>> {
    let size = norm(right);
    if size == 0.0 || !size.is_finite() {
        return None;
    }
    let mut directions = vec![scaled(right, 1.0 / size)];
    let mut triangle: Vec<Vec<f64>> = Vec::new();
    let mut turns: Vec<[f64; 2]> = Vec::new();
    let mut rest = vec![size];
    for step in 0..MOST_STEPS {
        let mut next = system.apply(&system.precondition(&directions[step]));
        let mut column = Vec::with_capacity(step + 2);
        for direction in &directions {
            let along = dot(&next, direction);
            add(&mut next, -along, direction);
            column.push(along);
        }
        let length = norm(&next);
        for (at, [cos, sin]) in turns.iter().enumerate() {
            let (upper, lower) = (column[at], column[at + 1]);
            column[at] = cos * upper + sin * lower;
            column[at + 1] = cos * lower - sin * upper;
        }
        let hypotenuse = column[step].hypot(length);
        if hypotenuse == 0.0 || !hypotenuse.is_finite() {
            break;
        }
        let [cos, sin] = [column[step] / hypotenuse, length / hypotenuse];
        column[step] = hypotenuse;
        triangle.push(column);
        turns.push([cos, sin]);
        let last = rest[step];
        rest[step] = cos * last;
        rest.push(-sin * last);
        if length == 0.0 || (sin * last).abs() <= tolerance * size {
            break;
        }
        directions.push(scaled(&next, 1.0 / length));
    }
    let mut weights = vec![0.0; triangle.len()];
    for row in (0..triangle.len()).rev() {
        let known: f64 = (row + 1..triangle.len())
            .map(|at| triangle[at][row] * weights[at])
            .sum();
        weights[row] = (rest[row] - known) / triangle[row][row];
    }
    let mut sum = vec![0.0; right.len()];
    for (direction, weight) in directions.iter().zip(&weights) {
        add(&mut sum, *weight, direction);
    }
    Some(system.precondition(&sum))
}
