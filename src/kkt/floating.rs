//! Equilibrium of the bodies that contact alone holds.
//!
//! ```text
//! (K8)  Rᵀ t + e = 0
//! ```

use faer::MatRef;

use super::natural_map::largest;
use super::resultant::Defect;
/// Largest departure from (K8) over the free modes, in newton; scaled by the largest sum of
/// all forces on a mode, each counted positive.
pub(super) fn unanswered(modes: MatRef<'_, f64>, load: &[f64], reaction: &[f64]) -> Defect {
    let (mut left, mut total) = (Vec::new(), Vec::new());
    for (k, e) in load.iter().enumerate() {
        let (mut sum, mut size) = (*e, e.abs());
        for (r, t) in modes.col(k).iter().zip(reaction) {
            sum += r * t;
            size += (r * t).abs();
        }
        left.push(sum);
        total.push(size);
    }
    Defect::over(largest(&left), largest(&total))
}
