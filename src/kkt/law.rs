//! Laws beyond Coulomb's, as the judge reads them off the problem: bounds, and lengths in the tangent plane.
//!
//! ```text
//! (L4)  t_N ≤ c,  u_N ≤ g₀,  (t_N − c) (u_N − g₀) = 0;   bilateral:  u_N = g₀
//! (L5)  ‖E t_T‖ ≤ s = min(a + μ p, τ),                   sticks:     u_T = 0 while pressed
//!       s ‖E⁻¹ u_T‖ + t_T · u_T = 0                      slip along the normal of the set, with all its dissipation
//! ```
//!
//! Written apart from the solver, which moves a set to the cone that it knows: here the set stays as it is stated.

use crate::problem::Law;

/// `‖v‖` in the tangent plane.
fn length([v_1, v_2]: [f64; 2]) -> f64 {
    v_1.hypot(v_2)
}

/// The law of one contact; the default is Coulomb's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct JudgedLaw(Option<Law>);

impl JudgedLaw {
    /// Coulomb's alone.
    pub(super) const COULOMB: Self = Self(None);

    pub(super) fn new(law: Option<&Law>) -> Self {
        Self(law.copied())
    }

    pub(super) fn is_bilateral(&self) -> bool {
        self.0.is_some_and(|law| law.bilateral)
    }

    pub(super) fn sticks(&self) -> bool {
        self.0.is_some_and(|law| law.sticks)
    }

    /// c, in newton.
    pub(super) fn tension(&self) -> f64 {
        self.0.map_or(0.0, |law| law.tension)
    }

    /// Radius `s` in newton under a normal reaction, for μ.
    pub(super) fn radius(&self, friction: f64, normal_reaction: f64) -> f64 {
        let Some(law) = self.0 else {
            return -friction * normal_reaction.min(0.0);
        };
        let least = if law.bilateral { 0.0 } else { -law.tension };
        let pressing = f64::max(-normal_reaction, least);
        (law.shear + friction * pressing).min(law.cap)
    }

    /// `E t_T`: a force of the tangent plane where the set is a disc.
    pub(super) fn rounded(&self, force: [f64; 2]) -> [f64; 2] {
        self.stretched(force, f64::recip)
    }

    /// `E⁻¹ u_T`: a displacement of the tangent plane beside such a force.
    pub(super) fn squeezed(&self, displacement: [f64; 2]) -> [f64; 2] {
        self.stretched(displacement, |ratio| ratio)
    }

    /// A force of the tangent plane from one where the set is a disc.
    pub(super) fn unrounded(&self, [along, across]: [f64; 2]) -> [f64; 2] {
        match self.0.and_then(|law| law.ellipse) {
            None => [along, across],
            Some(ellipse) => {
                let ([c, s], across) = (ellipse.direction, ellipse.ratio * across);
                [c * along - s * across, s * along + c * across]
            }
        }
    }

    /// Components along and across the ellipse's direction, the last one times a factor of its ratio.
    fn stretched(&self, vector: [f64; 2], factor: impl Fn(f64) -> f64) -> [f64; 2] {
        match self.0.and_then(|law| law.ellipse) {
            None => vector,
            Some(ellipse) => {
                let ([c, s], [x, y]) = (ellipse.direction, vector);
                [c * x + s * y, factor(ellipse.ratio) * (c * y - s * x)]
            }
        }
    }

    /// Work that the set does at most against a velocity, and how far the velocity is from one against which it
    /// does no more than that, for μ.
    pub(super) fn resistance(&self, friction: f64, normal: f64, tangents: [f64; 2]) -> [f64; 2] {
        let slip = length(self.squeezed(tangents));
        let Some(law) = self.0 else {
            return [0.0, normal + friction * slip];
        };
        let along = if law.bilateral { normal.abs() } else { normal };
        if law.sticks {
            return [0.0, along.max(slip)];
        }
        let at = |pressing: f64| normal * pressing + slip * (law.shear + friction * pressing);
        if law.bilateral || law.cap.is_infinite() || friction == 0.0 {
            return [at(-law.tension), along + friction * slip];
        }
        let capped = (law.cap - law.shear) / friction;
        [at(-law.tension).max(at(capped)), along]
    }

    /// What slip dissipates at most under a radius, in joule; nothing slips where it sticks.
    pub(super) fn dissipation(&self, radius: f64, slip: [f64; 2]) -> f64 {
        match self.sticks() {
            true => 0.0,
            false => radius * length(self.squeezed(slip)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::Ellipse;

    #[test]
    fn radii_grow_from_glue_s_bound_to_the_cap() {
        // a = 2, μ = ½, c = 1, τ = 4: p = −1 leaves 1.5, and from p = 4 on nothing is added.
        let law = JudgedLaw::new(Some(&Law {
            tension: 1.0,
            shear: 2.0,
            cap: 4.0,
            ..Law::default()
        }));
        let radii = [2.0, 1.0, 0.0, -2.0, -4.0, -9.0].map(|t| law.radius(0.5, t));
        assert_eq!(radii, [1.5, 1.5, 2.0, 3.0, 4.0, 4.0]);
        // Sliding and opening by ½: 2 − ½ · 1 at p = −1, and ½ · 1 of the normal; never more than 4 of friction.
        assert_eq!(law.resistance(0.5, -0.5, [1.0, 0.0]), [2.0, -0.5]);
    }

    #[test]
    fn an_ellipse_s_forces_and_velocities_keep_their_work() {
        let law = JudgedLaw::new(Some(&Law {
            ellipse: Some(Ellipse {
                direction: [0.6, 0.8],
                ratio: 3.0,
            }),
            ..Law::default()
        }));
        let (t, u) = ([2.0, -1.0], [0.3, 0.7]);
        let ([a, b], [x, y]) = (law.rounded(t), law.squeezed(u));
        assert!((a * x + b * y - (t[0] * u[0] + t[1] * u[1])).abs() < 1e-15);
        let back = law.unrounded([a, b]);
        assert!((back[0] - t[0]).abs() < 1e-15 && (back[1] - t[1]).abs() < 1e-15);
    }
}
