//! Gaps are bounded from below by the least distance on the contact's facets (C20).
//!
//! ```text
//! g_i += max( l_i, q l_j, q² l_k, … )       l = max(0, least − g),   j beside i, k beside j, …
//! ```
//!
//! Under a parabola of curvature κ the mean under a dual multiplier is κ h²/12 less than the gap at the
//! contact, everywhere alike: that shifts the sides by something of second order. Lifted alone, the contact
//! next to the apex would stand out of its neighbours, and the pressure there would be wrong by h/a of itself;
//! so those around it are lifted as well, each by a little less than the one before.

/// q: what is left of a lift from one contact to the next.
const DECAY: f64 = 15.0 / 16.0;

/// Part of the largest lift that is not handed on.
const LEAST: f64 = 1e-6;

/// What is added to each gap, in metre; `bounds` are the gaps with the least distances that bound them, `patches`
/// the contacts that share a facet.
pub(super) fn lifts(bounds: impl Iterator<Item = (f64, f64)>, patches: &[Vec<usize>]) -> Vec<f64> {
    let mut lifts: Vec<f64> = bounds.map(|(gap, least)| (least - gap).max(0.0)).collect();
    let largest = lifts.iter().copied().fold(0.0, f64::max);
    if largest > 0.0 {
        while hand_on(&mut lifts, patches, LEAST * largest) {}
    }
    lifts
}

/// Hands lifts on along all patches, there and back; whether any has changed.
fn hand_on(lifts: &mut [f64], patches: &[Vec<usize>], least: f64) -> bool {
    let mut changed = false;
    for patch in patches.iter().chain(patches.iter().rev()) {
        let most = patch.iter().map(|&node| lifts[node]).fold(0.0, f64::max) * DECAY;
        for &node in patch.iter().filter(|_| most > least) {
            changed |= lifts[node] < most;
            lifts[node] = lifts[node].max(most);
        }
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROW: [[usize; 2]; 4] = [[0, 1], [1, 2], [2, 3], [3, 4]];

    #[test]
    fn a_lift_is_handed_on_both_ways_and_bounds_every_gap() {
        // y = x²/2 at x = −2 … 2, a twelfth less under the dual multipliers: only the apex is below the least.
        let gaps = [-2.0_f64, -1.0, 0.0, 1.0, 2.0].map(|x| x * x / 2.0 - 1.0 / 12.0);
        let least = [0.5, 0.0, 0.0, 0.0, 0.5];
        let found = lifts(gaps.into_iter().zip(least), &ROW.map(Vec::from));
        for (place, lift) in found.into_iter().enumerate() {
            let steps = place.abs_diff(2) as i32;
            assert!((lift - DECAY.powi(steps) / 12.0).abs() < 1e-15);
            assert!(gaps[place] + lift >= least[place] - 1e-15);
        }
    }

    #[test]
    fn gaps_that_are_nowhere_too_small_stay() {
        let bounds = [(0.1, 0.1), (-0.2, -0.2), (0.3, -0.2)];
        assert_eq!(
            lifts(bounds.into_iter(), &[vec![0, 1], vec![1, 2]]),
            [0.0; 3]
        );
    }
}
