//! Integrals of pressures, for tests: their ends have square-root or inverse square-root behaviour.

use std::f64::consts::FRAC_PI_2;

/// ∫ f dx from −a to a. Substituting x = a sin θ makes such integrands smooth; the midpoint rule
/// never meets an end. In θ smooth integrands are periodic and come out to round-off, which the
/// difference under a root raises to 1e-11; a kink, as of |r| in the middle, leaves step²/24 = 1e-9, a root
/// inside, as where a zone of stick ends, step^(3/2) = 2e-6.
pub(super) fn over_width(a: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (count, mut sum) = (20_000, 0.0);
    let step = 2.0 * FRAC_PI_2 / f64::from(count);
    for k in 0..count {
        let angle = -FRAC_PI_2 + (f64::from(k) + 0.5) * step;
        sum += f(a * angle.sin()) * a * angle.cos() * step;
    }
    sum
}

/// ∫ f 2πr dr from 0 to a.
pub(super) fn over_disc(a: f64, f: impl Fn(f64) -> f64) -> f64 {
    over_width(a, |r| f(r.abs()) * 2.0 * FRAC_PI_2 * r.abs())
}

/// Fails unless the two agree to a relative tolerance.
pub(super) fn assert_close(found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs();
    assert!(
        error <= tolerance * expected.abs(),
        "{found} against {expected}"
    );
}
