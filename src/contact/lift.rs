//! Gaps are lifted so that no mean distance is less than the least distance on the contact's facets (C20).
//!
//! ```text
//! l_i = max( a_i, min(a, c_i) )      a_i = max(0, least_i − mean_i),  c_i = max(0, γ_i − mean_i),  a = max_i a_i
//! ```
//!
//! γ_i is the distance where the contact stands. Under a parabola of curvature κ the mean under a dual multiplier is
//! κ h²/12 less than that, everywhere alike. Lifted alone, the contact next to the apex would stand out of its
//! neighbours, and the pressure there would be wrong by h/a of itself; so each one is lifted by what its own mean is
//! off, up to the most that any asks for: a shift of the sides of second order. On plane sides nothing is off, and
//! where no contact asks nothing is lifted.

/// Part of a gap, or of a mean, by which a contact lacks nothing.
const ROUNDED: f64 = 1e-12;

/// A contact's mean distance, the least one on its facets, and the one where it stands, in metre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Distances {
    pub(super) mean: f64,
    pub(super) least: f64,
    pub(super) here: f64,
}

impl Distances {
    /// Distances of a contact whose gap is no mean.
    pub(super) fn plain(gap: f64) -> Self {
        Self {
            mean: gap,
            least: gap,
            here: gap,
        }
    }

    /// Of contacts whose facets are about so large, in metre.
    fn asks(&self, size: f64) -> f64 {
        let lacking = self.least - self.mean;
        let rounded = ROUNDED * (size + self.mean.abs());
        if lacking > rounded { lacking } else { 0.0 }
    }
}

/// What is added to each gap, in metre; `size` is that of the whole surface.
pub(super) fn lifts(contacts: &[Distances], size: f64) -> Vec<f64> {
    let most = contacts
        .iter()
        .map(|one| one.asks(size))
        .fold(0.0, f64::max);
    let lift = |one: &Distances| one.asks(size).max(most.min(one.here - one.mean));
    contacts.iter().map(|one| lift(one).max(0.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn under_a_parabola_all_contacts_are_lifted_alike_and_no_gap_is_too_small() {
        // y = κ x²/2 with nodes at −4, −2 … 4: κ h²/12 less under the dual multipliers, and only the apex is below
        // the least distance.
        let (curvature, size) = (0.1, 2.0);
        let low = curvature * size * size / 12.0;
        let contacts = [-2.0_f64, -1.0, 0.0, 1.0, 2.0].map(|k| {
            let y = |x: f64| curvature * x * x / 2.0;
            Distances {
                mean: y(size * k) - low,
                least: y(size * (k.abs() - 1.0).max(0.0)),
                here: y(size * k),
            }
        });
        for (one, lift) in contacts.iter().zip(lifts(&contacts, 8.0)) {
            assert!((lift - low).abs() < 1e-15);
            assert!(one.mean + lift >= one.least - 1e-15);
        }
    }

    #[test]
    fn on_plane_sides_and_where_nobody_asks_nothing_is_lifted() {
        let plane = Distances::plain(0.25);
        let round = Distances {
            mean: -0.1,
            least: 0.0,
            here: 0.0,
        };
        assert_eq!(lifts(&[plane, round, plane], 1.0), [0.0, 0.1, 0.0]);
        let steep = Distances {
            mean: 0.5,
            least: 0.25,
            here: 0.75,
        };
        assert_eq!(lifts(&[plane, steep], 1.0), [0.0; 2]);
        let rounded = Distances {
            least: 0.25 + 1e-16,
            ..plane
        };
        assert_eq!(lifts(&[rounded, steep], 1.0), [0.0; 2]);
    }
}
