//! How much of a contact sticks that is pressed straight on: Goodman and Spence.
//!
//! Pressure draws the two surfaces sideways by different amounts, friction holds the middle. While
//! the contact grows with the load the ratio of the part that sticks to the contact stays the same,
//! for every punch whose shape is a power, the flat one included. What friction does to the pressure
//! is neglected (uncoupled): good for small β.

use super::elliptic::of_complement;
use super::range::{positive, within};
use crate::error::Error;

/// Coefficient of friction with which a part c/a of a plane contact sticks (E8); β > 0 is the
/// amount of [`Elastic::dundurs_beta`](super::Elastic::dundurs_beta).
///
/// # Errors
///
/// [`Error::OutOfRange`] unless `β > 0` and `0 < c/a < 1`.
pub fn friction_of_stick_line(beta: f64, stick_ratio: f64) -> Result<f64, Error> {
    Ok(positive("beta", beta)? * line(open_unit(stick_ratio)?))
}

/// Coefficient of friction with which a part c/a of a round contact's radius sticks (E8).
///
/// # Errors
///
/// [`Error::OutOfRange`] unless `β > 0` and `0 < c/a < 1`.
pub fn friction_of_stick_sphere(beta: f64, stick_ratio: f64) -> Result<f64, Error> {
    Ok(positive("beta", beta)? * sphere(open_unit(stick_ratio)?))
}

/// The part c/a of a plane contact that sticks (E8). Zero and one where they round to that.
///
/// # Errors
///
/// [`Error::OutOfRange`] unless β and μ are positive.
pub fn stick_ratio_line(beta: f64, friction: f64) -> Result<f64, Error> {
    Ok(inverse(
        line,
        positive("friction", friction)? / positive("beta", beta)?,
    ))
}

/// The part c/a of a round contact's radius that sticks (E8). Zero and one where they round to that.
///
/// # Errors
///
/// [`Error::OutOfRange`] unless β and μ are positive.
pub fn stick_ratio_sphere(beta: f64, friction: f64) -> Result<f64, Error> {
    Ok(inverse(
        sphere,
        positive("friction", friction)? / positive("beta", beta)?,
    ))
}

fn open_unit(ratio: f64) -> Result<f64, Error> {
    within(
        "stick_ratio",
        ratio,
        ratio > 0.0 && ratio < 1.0,
        "0 < c/a < 1",
    )
}

/// μ/β of a plane contact.
fn line(c: f64) -> f64 {
    of_complement(((1.0 - c) * (1.0 + c)).sqrt()) / of_complement(c)
}

/// μ/β of a round contact.
fn sphere(c: f64) -> f64 {
    c.atanh() / (c * of_complement(c))
}

/// Where a function that grows from 0 at 0 to infinity at 1 has a value: by bisection until no
/// number lies between.
fn inverse(f: impl Fn(f64) -> f64, value: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return if low == 0.0 { 0.0 } else { high };
        }
        if f(middle) < value {
            low = middle;
        } else {
            high = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::quadrature::assert_close;
    use super::*;

    #[test]
    fn friction_equal_to_the_coupling_holds_a_plane_contact_to_the_lemniscate() {
        // K(c) = K(√(1−c²)) where c² = 1/2.
        assert_close(stick_ratio_line(0.2, 0.2).unwrap(), 0.5_f64.sqrt(), 1e-14);
        // c and √(1−c²) exchanged turn μ/β upside down.
        let product =
            friction_of_stick_line(1.0, 0.6).unwrap() * friction_of_stick_line(1.0, 0.8).unwrap();
        assert_close(product, 1.0, 1e-14);
    }

    #[test]
    fn little_friction_holds_exponentially_little() {
        // K(c) → π/2, K(√(1−c²)) → ln(4/c), artanh(c)/c → 1.
        let ratio = 0.02_f64;
        let plane = 4.0 * (-std::f64::consts::FRAC_PI_2 / ratio).exp();
        assert_close(stick_ratio_line(1.0, ratio).unwrap(), plane, 1e-12);
        let round = 4.0 * (-1.0 / ratio).exp();
        assert_close(stick_ratio_sphere(1.0, ratio).unwrap(), round, 1e-12);
        assert_eq!(stick_ratio_sphere(1.0, 1e-6).unwrap(), 0.0);
    }

    #[test]
    fn the_ratio_inverts_the_coefficient_and_grows_with_it() {
        let mut before = [0.0; 2];
        for friction in [0.05, 0.1, 0.2, 0.4, 0.8] {
            let found = [
                stick_ratio_line(0.3, friction).unwrap(),
                stick_ratio_sphere(0.3, friction).unwrap(),
            ];
            assert!(found[0] > before[0] && found[1] > before[1]);
            let back = friction_of_stick_line(0.3, found[0]).unwrap();
            assert_close(back, friction, 1e-12);
            let back = friction_of_stick_sphere(0.3, found[1]).unwrap();
            assert_close(back, friction, 1e-12);
            before = found;
        }
    }

    #[test]
    fn what_has_no_part_that_sticks_or_slips_is_refused() {
        assert!(stick_ratio_line(0.0, 0.3).is_err());
        assert!(stick_ratio_sphere(0.3, f64::NAN).is_err());
        assert!(friction_of_stick_line(0.3, 1.0).is_err());
        assert!(friction_of_stick_sphere(0.3, 0.0).is_err());
    }
}
