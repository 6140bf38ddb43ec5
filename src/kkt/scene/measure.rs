//! A size, and how much of it has a reason.

use crate::kkt::certificate::infinite_if_nan;

/// A departure, what explains it, and the contact where it is worst.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measure {
    /// Size in physical units, never negative.
    pub value: f64,
    /// How large it may be: rounding, and what the mesh does not resolve.
    pub explained: f64,
    /// Contact where it happens.
    pub contact: usize,
}

impl Measure {
    /// A NaN counts as infinite, and explains nothing.
    pub(super) fn new(value: f64, explained: f64, contact: usize) -> Self {
        Self {
            value: infinite_if_nan(value),
            explained: if explained.is_nan() { 0.0 } else { explained },
            contact,
        }
    }

    /// Whether all of it has a reason.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.value.is_finite() && self.value <= self.explained
    }

    /// What has no reason.
    fn excess(&self) -> f64 {
        match self.value.is_finite() {
            true => (self.value - self.explained).max(0.0),
            false => f64::INFINITY,
        }
    }

    /// Takes another measure if more of it has no reason, or with all explained if it is larger.
    pub(super) fn take(&mut self, other: Self) {
        let other = Self::new(other.value, other.explained, other.contact);
        let [mine, its] = [&*self, &other].map(|one| (one.excess(), one.value));
        if its > mine {
            *self = other;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_reason_counts_before_what_is_large() {
        let mut worst = Measure::default();
        worst.take(Measure::new(5.0, 9.0, 1));
        worst.take(Measure::new(3.0, 4.0, 2));
        assert_eq!((worst.contact, worst.holds()), (1, true));
        worst.take(Measure::new(0.5, 0.25, 3));
        assert_eq!((worst.contact, worst.holds()), (3, false));
        worst.take(Measure::new(f64::NAN, f64::NAN, 4));
        assert_eq!((worst.value, worst.contact), (f64::INFINITY, 4));
    }

    #[test]
    fn infinity_explains_no_infinity() {
        assert!(!Measure::new(f64::INFINITY, f64::INFINITY, 0).holds());
    }
}
