//! What the judge says: residuals, states of the contacts, the certificate.

/// What a contact does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ContactStatus {
    /// No reaction.
    Open,
    /// Pressed, and the reaction is inside the friction disc (or the slip vanishes).
    Stick,
    /// Pressed, and slipping at the edge of the friction disc; pressed contacts with
    /// `μ = 0`, whose disc is a point, slide freely and count here.
    Slip,
}

/// A residual with the contact where it is worst.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Worst {
    /// Size of the violation in physical units, never negative.
    pub value: f64,
    /// The same, divided by the load's scale of that unit.
    pub scaled: f64,
    /// Contact where it happens.
    pub contact: usize,
}

impl Worst {
    /// Takes the violation of one contact if it is the largest so far.
    ///
    /// A NaN counts as infinite: comparisons with NaN are false, and a broken contact
    /// would score zero.
    pub(super) fn raise(&mut self, violation: f64, contact: usize) {
        let violation = infinite_if_nan(violation);
        if violation > self.value {
            (self.value, self.contact) = (violation, contact);
        }
    }

    /// Divides by the load's scale.
    #[must_use]
    pub(super) fn over(self, scale: f64) -> Self {
        let scaled = ratio(self.value, scale);
        Self { scaled, ..self }
    }
}

/// Every law on the original problem, measured; infinite where a state is not finite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Certificate {
    /// Natural-map residual, relative to the reaction with a load-scale floor.
    pub natural_map: f64,
    /// Largest load on a free rigid mode that the reactions do not answer, in newton (K8).
    pub equilibrium: Defect,
    /// Largest `u_N − g₀ > 0`, in metre (L1).
    pub penetration: Worst,
    /// Largest `t_N > 0`, in newton (L1).
    pub tension: Worst,
    /// Largest `|t_N (u_N − g₀)|`, in joule (L1).
    pub complementarity: Worst,
    /// Largest `‖t_T‖ + μ t_N > 0`, in newton (L2).
    pub disc_excess: Worst,
    /// Largest `|−μ t_N ‖u_T‖ + t_T · u_T|`, in joule (L3).
    pub dissipation_defect: Worst,
    /// `η = Σ [t_N (u_N − g₀) + t_T · u_T − μ t_N ‖u_T‖]`, in joule.
    pub bipotential_gap: f64,
    /// `½ t · G t`, in joule: what `bipotential_gap` is compared with.
    pub reaction_energy: f64,
}

/// What is left of a sum that should vanish.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Defect {
    /// Length of the sum, in newton or newton metre.
    pub value: f64,
    /// The same, divided by the sum of the lengths of what was added.
    pub scaled: f64,
}

impl Defect {
    /// The length of a sum of vectors, compared with `scale`.
    pub(super) fn of(parts: &[[f64; 3]], scale: f64) -> Self {
        let sum = [0, 1, 2].map(|axis| parts.iter().map(|part| part[axis]).sum());
        Self::over(infinite_if_nan(length(sum)), scale)
    }

    pub(super) fn over(value: f64, scale: f64) -> Self {
        let scaled = ratio(value, scale);
        Self { value, scaled }
    }
}

impl Certificate {
    /// The stopping test: the larger of natural map and equilibrium, both relative.
    #[must_use]
    pub fn residual(&self) -> f64 {
        self.natural_map.max(self.equilibrium.scaled)
    }
}

/// A contact state and its certificate.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Verdict {
    /// Displacement `u = û + G t + R α` per unknown, in metre.
    pub displacement: Vec<f64>,
    /// The same beyond the gaps, `u_N − g₀` and `u_T`, in metre: where both are large, this has their digits.
    pub beyond: Vec<f64>,
    /// What each contact does.
    pub status: Vec<ContactStatus>,
    /// The residuals.
    pub certificate: Certificate,
}

/// Length of a vector.
pub(super) fn length([x, y, z]: [f64; 3]) -> f64 {
    let square = x * x + y * y + z * z;
    // `hypot` takes its time; it is for squares that leave the range of numbers.
    match square.is_normal() || [x, y, z] == [0.0; 3] {
        true => square.sqrt(),
        false => x.hypot(y).hypot(z),
    }
}

/// `part / whole`, and 0/0 = 0: nothing is violated where nothing acts.
pub(super) fn ratio(part: f64, whole: f64) -> f64 {
    if part == 0.0 {
        return 0.0;
    }
    infinite_if_nan(part / whole)
}

pub(super) fn infinite_if_nan(value: f64) -> f64 {
    if value.is_nan() { f64::INFINITY } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_contact_is_the_largest_violation_and_a_nan_beats_them_all() {
        let mut worst = Worst::default();
        for (contact, violation) in [-3.0, 2.0, 5.0, 4.0].into_iter().enumerate() {
            worst.raise(violation, contact);
        }
        assert_eq!((worst.value, worst.contact), (5.0, 2));
        worst.raise(f64::NAN, 1);
        assert_eq!((worst.over(10.0).scaled, worst.contact), (f64::INFINITY, 1));
    }

    #[test]
    fn nothing_over_nothing_is_nothing() {
        assert_eq!(ratio(0.0, 0.0), 0.0);
        assert_eq!(ratio(1.0, 0.0), f64::INFINITY);
        assert_eq!(ratio(f64::NAN, 1.0), f64::INFINITY);
    }
}
