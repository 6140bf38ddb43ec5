//! The complete elliptic integral of the first kind.

use std::f64::consts::FRAC_PI_2;

/// `K(k) = ∫ dθ/√(1 − k² sin² θ)` from 0 to π/2 (E7), of `0 < k' <= 1`, k = √(1 − k'²): exact also where that modulus rounds to one.
pub(super) fn of_complement(complement: f64) -> f64 {
    FRAC_PI_2 / mean(1.0, complement)
}

/// Arithmetic–geometric mean of two positive numbers. Their distance is squared in every step once
/// it is small; before, their ratio is halved in digits: from 1e-308 that takes 14 steps.
fn mean(mut larger: f64, mut smaller: f64) -> f64 {
    while larger - smaller > 2.0 * f64::EPSILON * larger {
        (larger, smaller) = (0.5 * (larger + smaller), (larger * smaller).sqrt());
    }
    0.5 * (larger + smaller)
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::assert_close;
    use super::*;

    fn of_modulus(modulus: f64) -> f64 {
        of_complement(((1.0 - modulus) * (1.0 + modulus)).sqrt())
    }

    #[test]
    fn known_values() {
        assert_eq!(of_modulus(0.0), FRAC_PI_2);
        // Γ(1/4)²/(4 √π), modulus 1/√2; Abramowitz & Stegun 17.3.
        let lemniscate = of_modulus(0.5_f64.sqrt());
        assert_close(lemniscate, 1.854_074_677_301_371_9, 1e-15);
    }

    #[test]
    fn it_is_the_integral() {
        // The trapezoidal rule converges geometrically on a period.
        for modulus in [0.1, 0.5, 0.9, 0.99] {
            let count = 2000;
            let integrand = |i: i32| {
                let angle = FRAC_PI_2 * (f64::from(i) + 0.5) / f64::from(count);
                1.0 / (1.0 - (modulus * angle.sin()).powi(2)).sqrt()
            };
            let sum: f64 = (0..count).map(integrand).sum();
            assert_close(
                of_modulus(modulus),
                sum * FRAC_PI_2 / f64::from(count),
                1e-13,
            );
        }
    }

    #[test]
    fn it_grows_like_a_logarithm_towards_one() {
        for complement in [1e-8, 1e-100, 1e-300_f64] {
            assert_close(of_complement(complement), (4.0 / complement).ln(), 1e-14);
        }
    }
}
