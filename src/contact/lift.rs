//! Gaps are lifted so that no mean distance is less than the least distance on the contact's facets (C20).
//!
//! ```text
//! l_j = max_i (a_i − s_i d_ij)      a_i = max(0, least_i − mean_i),   s_i = a_i κ_i,   κ_i = 12 a_i / h_i²
//! ```
//!
//! Under a parabola of curvature κ the mean under a dual multiplier is κ h²/12 less than the gap at the
//! contact, everywhere alike: that shifts the sides by something of second order. Lifted alone, the contact
//! next to the apex would stand out of its neighbours, and the pressure there would be wrong by h/a of itself;
//! so all within the radius 1/κ are lifted as well, less with the distance d along the facets. What sticks out then has
//! the slope κ² h²/12, beside the κ a at the end of a contact that is a half-width a away: second order again. A lift
//! that a jump of the gap asks for reaches less far than a facet.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use nalgebra::Vector3;

/// A lift on its way from the contact that asks for it.
#[derive(Clone, Copy)]
struct Lift {
    contact: usize,
    /// What is left of it, in metre.
    height: f64,
    /// By how much it falls per distance.
    slope: f64,
}

/// The higher one first.
impl Ord for Lift {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_height = self.height.total_cmp(&other.height);
        by_height.then(other.contact.cmp(&self.contact))
    }
}

impl PartialOrd for Lift {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Lift {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Lift {}

/// What is added to each gap, in metre; `own` is what each one asks for itself, `at` the places of the contacts and
/// `patches` those that share a facet.
pub(super) fn lifts(own: Vec<f64>, at: &[Vector3<f64>], patches: &[Vec<usize>]) -> Vec<f64> {
    let mut lifts = vec![0.0; own.len()];
    if own.iter().all(|lift| *lift == 0.0) {
        return lifts;
    }
    let beside = beside(at, patches);
    let mut waiting: BinaryHeap<Lift> = (own.iter().enumerate())
        .filter(|(_, height)| **height > 0.0)
        .map(|(contact, &height)| Lift {
            contact,
            height,
            slope: slope(height, &beside[contact]),
        })
        .collect();
    let mut done = vec![false; own.len()];
    while let Some(lift) = waiting.pop() {
        if std::mem::replace(&mut done[lift.contact], true) {
            continue;
        }
        lifts[lift.contact] = lift.height;
        for &(contact, distance) in &beside[lift.contact] {
            let height = lift.height - lift.slope * distance;
            if height > 0.0 && !done[contact] {
                waiting.push(Lift {
                    contact,
                    height,
                    ..lift
                });
            }
        }
    }
    lifts
}

/// `s` of a lift at a contact with these beside it.
fn slope(lift: f64, beside: &[(usize, f64)]) -> f64 {
    let size = beside
        .iter()
        .map(|(_, distance)| *distance)
        .fold(0.0, f64::max);
    12.0 * (lift / size).powi(2)
}

/// The contacts on the facets around each one, with their distances in metre.
fn beside(at: &[Vector3<f64>], patches: &[Vec<usize>]) -> Vec<Vec<(usize, f64)>> {
    let mut beside = vec![Vec::new(); at.len()];
    for patch in patches {
        for &one in patch {
            let others = patch.iter().filter(|other| **other != one);
            beside[one].extend(others.map(|&other| (other, (at[one] - at[other]).norm())));
        }
    }
    beside
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROW: [[usize; 2]; 4] = [[0, 1], [1, 2], [2, 3], [3, 4]];

    fn row(bounds: [(f64, f64); 5], size: f64) -> Vec<f64> {
        let at = [0.0, 1.0, 2.0, 3.0, 4.0].map(|x| Vector3::new(size * x, 0.0, 0.0));
        let own = bounds.map(|(gap, least)| (least - gap).max(0.0));
        lifts(own.to_vec(), &at, &ROW.map(Vec::from))
    }

    #[test]
    fn a_lift_of_a_parabola_falls_by_a_part_of_the_radius_and_bounds_every_gap() {
        // y = κ x²/2 with κ = 0.1/m and nodes at −4, −2 … 4: κ h²/12 less under the dual multipliers, and only the
        // apex is below the least distance.
        let (curvature, size) = (0.1, 2.0);
        let low = curvature * size * size / 12.0;
        let bounds = [-2.0_f64, -1.0, 0.0, 1.0, 2.0].map(|k| {
            let y = |x: f64| curvature * x * x / 2.0;
            let nearest = size * (k.abs() - 1.0).max(0.0);
            (y(size * k) - low, y(nearest))
        });
        for (place, lift) in row(bounds, size).into_iter().enumerate() {
            let distance = size * place.abs_diff(2) as f64;
            assert!((lift - low * (1.0 - curvature * distance)).abs() < 1e-15);
            let (gap, least) = bounds[place];
            assert!(gap + lift >= least - 1e-15);
        }
    }

    #[test]
    fn a_lift_as_of_a_jump_stays_where_it_is() {
        let mut bounds = [(1.0, 0.0); 5];
        bounds[1] = (-0.25, 0.0);
        assert_eq!(row(bounds, 1.0), [0.0, 0.25, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn gaps_that_are_nowhere_too_small_stay() {
        let bounds = [
            (0.1, 0.1),
            (-0.2, -0.2),
            (0.3, -0.2),
            (0.3, 0.3),
            (0.0, 0.0),
        ];
        assert_eq!(row(bounds, 1.0), [0.0; 5]);
    }
}
