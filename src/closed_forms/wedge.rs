//! A wedge pulled up its slope by a horizontal force.

use super::range::{not_negative, within};
use crate::error::Error;

/// The horizontal pull F over the weight W at which a block begins to slide up a slope of tangent
/// `slope` (E10); on the level, slope 0, it is μ. A body of any stiffness, as statics decides alone.
///
/// # Errors
///
/// [`Error::OutOfRange`] unless slope and μ are not negative and `μ slope < 1`: from there on no
/// pull moves it.
pub fn wedge_pull(slope: f64, friction: f64) -> Result<f64, Error> {
    let (slope, friction) = (
        not_negative("slope", slope)?,
        not_negative("friction", friction)?,
    );
    let locked = friction * slope;
    within(
        "friction × slope",
        locked,
        locked < 1.0,
        "less than 1, beyond which no pull moves the wedge",
    )?;
    Ok((slope + friction) / (1.0 - locked))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::quadrature::assert_close;
    use super::*;

    #[test]
    fn the_published_pulls() {
        // NAFEMS CGS-4, to seven digits.
        for (friction, published) in [
            (0.0, 0.1),
            (0.1, 0.202_020_2),
            (0.2, 0.306_122_4),
            (0.3, 0.412_371_1),
        ] {
            assert!((wedge_pull(0.1, friction).unwrap() - published).abs() < 1e-7);
        }
    }

    #[test]
    fn it_is_the_sum_of_slope_and_angle_of_friction() {
        let (slope, friction) = (0.7_f64, 0.4_f64);
        let angle = slope.atan() + friction.atan();
        assert_close(wedge_pull(slope, friction).unwrap(), angle.tan(), 1e-14);
        assert_eq!(wedge_pull(0.0, 0.3).unwrap(), 0.3);
    }

    #[test]
    fn a_wedge_that_locks_is_refused() {
        assert!(wedge_pull(2.0, 0.5).is_err());
        assert!(wedge_pull(-0.1, 0.5).is_err() && wedge_pull(0.1, f64::NAN).is_err());
    }
}
