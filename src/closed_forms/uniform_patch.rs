//! Uniform stress in plane strain.

use super::Elastic;
use super::range::within;
use crate::error::Error;

/// Strains `[ε_x, ε_y]` under pressures `[p_x, p_y]` in pascal on the sides of a rectangle without
/// friction, as shortenings: positive where it gets shorter (E9). All linear cells hold it exactly.
///
/// # Errors
///
/// [`Error::OutOfRange`] for a material or a pressure that is none.
pub fn uniform_strain(material: Elastic, pressure: [f64; 2]) -> Result<[f64; 2], Error> {
    let modulus = material.contact_modulus(None)?;
    for value in pressure {
        within("pressure", value, value.is_finite(), "a finite number")?;
    }
    // ν (1 + ν)/E = ν/(1 − ν) · (1 − ν²)/E.
    let across = material.poisson / (1.0 - material.poisson);
    let [p_x, p_y] = pressure;
    Ok([p_x - across * p_y, p_y - across * p_x].map(|stress| stress / modulus))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::quadrature::assert_close;
    use super::*;

    const STONE: Elastic = Elastic {
        young: 1.3e11,
        poisson: 0.2,
    };

    #[test]
    fn the_square_without_friction_moves_as_computed_independently() {
        // SSNV128 with μ = 0: 0.04 m under 150 MPa along x, 50 MPa along y; eleven digits.
        let [along, _] = uniform_strain(STONE, [15e7, 5e7]).unwrap();
        assert_close(0.04 * along, 4.061_538_461_5e-5, 1e-10);
    }

    #[test]
    fn it_is_hookes_law_with_a_pressure_that_stops_the_third_strain() {
        let (p_x, p_y) = (3.0, -7.0);
        let p_z = 0.2 * (p_x + p_y);
        let hooke = |one: f64, two: f64, three: f64| (one - 0.2 * (two + three)) / 1.3e11;
        let [along, across] = uniform_strain(STONE, [p_x, p_y]).unwrap();
        assert_close(along, hooke(p_x, p_y, p_z), 1e-14);
        assert_close(across, hooke(p_y, p_x, p_z), 1e-14);
    }

    #[test]
    fn a_pressure_that_is_none_is_refused() {
        assert!(uniform_strain(STONE, [f64::NAN, 0.0]).is_err());
    }
}
