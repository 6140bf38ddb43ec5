//! Equilibrium of the bodies that contact alone holds.
//!
//! ```text
//! (K8)  Rᵀ t + e = 0
//! ```

use faer::MatRef;

use super::certificate::Defect;
use super::natural_map::largest;

/// Largest departure from (K8) over the free modes, in newton; scaled by the largest sum of
/// all forces that a mode moves, each counted positive, whatever their directions: across them reactions are
/// known no better. Modes are compared at amplitudes that move the bodies by one metre: `sizes` says how far one of
/// the given amplitudes does; contacts begin at `offsets`, their end appended.
pub(super) fn unanswered(
    modes: MatRef<'_, f64>,
    (load, sizes): (&[f64], &[f64]),
    (offsets, reaction): (&[usize], &[f64]),
) -> Defect {
    let (mut left, mut total) = (Vec::new(), Vec::new());
    for (k, e) in load.iter().enumerate() {
        let mode = modes.col(k);
        let (mut sum, mut size) = (*e, e.abs());
        for block in offsets.windows(2) {
            let (mut moved, mut force) = (0.0_f64, 0.0_f64);
            for unknown in block[0]..block[1] {
                sum += mode[unknown] * reaction[unknown];
                moved = moved.hypot(mode[unknown]);
                force = force.hypot(reaction[unknown]);
            }
            size += moved * force;
        }
        left.push(sum / sizes[k]);
        total.push(size / sizes[k]);
    }
    Defect::over(largest(&left), largest(&total))
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::mat;

    #[test]
    fn what_reactions_leave_of_a_load_is_measured_against_all_forces() {
        // A lid on two contacts, sinking and tilting: −4 − 2 + 6 = 0, −4 + 2 + 3 = 1 of 4 + 2 + 6.
        let modes = mat![[1.0, 1.0], [1.0, -1.0]];
        let reaction = (&[0, 1, 2][..], &[-4.0, -2.0][..]);
        let found = unanswered(modes.as_ref(), (&[6.0, 3.0], &[1.0; 2]), reaction);
        assert_eq!((found.value, found.scaled), (1.0, 1.0 / 12.0));
    }

    #[test]
    fn rounding_of_friction_is_small_beside_what_presses() {
        // Pressed by 8 N, free to slide: 1e-13 N of friction that nothing answers.
        let found = unanswered(
            mat![[0.0], [1.0]].as_ref(),
            (&[0.0], &[1.0]),
            (&[0, 2], &[-8.0, 1e-13]),
        );
        assert_eq!((found.value, found.scaled), (1e-13, 1e-13 / 8.0));
    }

    #[test]
    fn nothing_to_answer_is_answered() {
        let modes = mat![[1.0], [1.0]];
        let found = unanswered(modes.as_ref(), (&[0.0], &[1.0]), (&[0, 1, 2], &[0.0; 2]));
        assert_eq!((found.value, found.scaled), (0.0, 0.0));
    }

    #[test]
    fn a_mode_stated_at_a_large_amplitude_does_not_drown_the_others() {
        // The same lid, sinking stated in 1e81 m.
        let modes = mat![[1e81, 1.0], [1e81, -1.0]];
        let reaction = (&[0, 1, 2][..], &[-4.0, -2.0][..]);
        let found = unanswered(modes.as_ref(), (&[6e81, 3.0], &[1e81, 1.0]), reaction);
        assert_eq!(found.scaled, 1.0 / 12.0);
    }
}
