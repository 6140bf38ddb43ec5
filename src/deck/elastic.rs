//! Constants of elasticity and of thermal expansion.
//!
//! ```text
//! ISO                      E, ν
//! ENGINEERING CONSTANTS    E1, E2, E3, ν12, ν13, ν23, G12, G13, G23
//! ORTHO                    D1111, D1122, D2222, D1133, D2233, D3333, D1212, D1313, D2323
//! ```
//!
//! The last is the stiffness, whose inverse holds 1 / Ei and −νij / Ei. Each is one set for all temperatures.

use nalgebra::Matrix3;

use crate::error::Error;
use crate::mesh_file::abaqus::Card;
use crate::scene::SceneOrthotropic;

/// Constants of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Elastic {
    /// Young's modulus and Poisson's ratio.
    Isotropic([f64; 2]),
    /// E1, E2, E3, ν12, ν13, ν23, G12, G13, G23.
    Orthotropic([f64; 9]),
}

impl Default for Elastic {
    fn default() -> Self {
        Self::Isotropic([0.0; 2])
    }
}

impl Elastic {
    /// The smallest of Young's moduli.
    pub(super) fn young(self) -> f64 {
        match self {
            Self::Isotropic([young, _]) => young,
            Self::Orthotropic(all) => all[0].min(all[1]).min(all[2]),
        }
    }

    /// As those of an orthotropic material along the global axes, without expansion.
    pub(super) fn constants(self) -> SceneOrthotropic {
        let (young, poisson, shear) = match self {
            Self::Isotropic([young, poisson]) => {
                let shear = young / (2.0 * (1.0 + poisson));
                ([young; 3], [poisson; 3], [shear; 3])
            }
            Self::Orthotropic([e1, e2, e3, n12, n13, n23, g12, g13, g23]) => {
                ([e1, e2, e3], [n12, n13, n23], [g12, g13, g23])
            }
        };
        SceneOrthotropic {
            young,
            poisson,
            shear,
            expansion: None,
            axes: None,
        }
    }
}

/// The constants of `*ELASTIC`.
pub(super) fn elastic(card: &Card<'_>) -> Result<Elastic, Error> {
    card.only(&["TYPE"])?;
    let kinds = [
        "ISO",
        "ISOTROPIC",
        "ENGINEERINGCONSTANTS",
        "ORTHO",
        "ORTHOTROPIC",
    ];
    card.one_of("TYPE", &kinds)?;
    match card.get("TYPE").unwrap_or("ISO") {
        "ISO" | "ISOTROPIC" => isotropic(card).map(Elastic::Isotropic),
        "ENGINEERINGCONSTANTS" => nine(card).map(Elastic::Orthotropic),
        _ => {
            let singular = || card.error("a stiffness that is not positive definite");
            let constants = inverse(nine(card)?).ok_or_else(singular)?;
            Ok(Elastic::Orthotropic(constants))
        }
    }
}

fn isotropic(card: &Card<'_>) -> Result<[f64; 2], Error> {
    let row = card.row("Young's modulus and Poisson's ratio, the same at every temperature")?;
    let young = row.number(0, "Young's modulus", None)?;
    let poisson = row.number(1, "Poisson's ratio", None)?;
    if young <= 0.0 || poisson <= -1.0 || poisson >= 0.5 {
        return Err(row.error(format!(
            "moduli {young}, {poisson}; expected E > 0 and -1 < ν < 0.5"
        )));
    }
    Ok([young, poisson])
}

/// Nine constants on two lines, a temperature behind them left aside.
fn nine(card: &Card<'_>) -> Result<[f64; 9], Error> {
    let rows: Vec<_> = card.rows(0).collect();
    let [first, second] = rows[..] else {
        let reason = "expected two lines with nine constants, the same at every temperature";
        return Err(card.error(reason));
    };
    let mut constants = [0.0; 9];
    for (at, constant) in constants.iter_mut().enumerate() {
        let row = if at < 8 { first } else { second };
        *constant = row.number(at % 8, "an elastic constant", None)?;
    }
    Ok(constants)
}

/// Engineering constants of a stiffness; none where it is not positive.
fn inverse([d11, d12, d22, d13, d23, d33, g12, g13, g23]: [f64; 9]) -> Option<[f64; 9]> {
    let stiffness = Matrix3::new(d11, d12, d13, d12, d22, d23, d13, d23, d33);
    let s = stiffness.cholesky()?.inverse();
    let [e1, e2, e3] = [0, 1, 2].map(|k| 1.0 / s[(k, k)]);
    let (n12, n13, n23) = (-s[(0, 1)] * e1, -s[(0, 2)] * e1, -s[(1, 2)] * e2);
    Some([e1, e2, e3, n12, n13, n23, g12, g13, g23])
}

/// Thermal expansion along each axis, of `*EXPANSION`; where it is measured from plays no part, as it is the same at
/// every temperature.
pub(super) fn expansion(card: &Card<'_>) -> Result<[f64; 3], Error> {
    card.only(&["TYPE", "ZERO"])?;
    card.one_of("TYPE", &["ISO", "ISOTROPIC", "ORTHO", "ORTHOTROPIC"])?;
    let row = card.row("thermal expansion, the same at every temperature")?;
    let number = |at: usize| row.number(at, "a thermal expansion", None);
    match card
        .get("TYPE")
        .is_some_and(|kind| kind.starts_with("ORTHO"))
    {
        true => Ok([number(0)?, number(1)?, number(2)?]),
        false => Ok([number(0)?; 3]),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_stiffness_is_that_of_its_engineering_constants() {
        // Isotropic, E = 1, ν = 1/4: D1111 = λ + 2G = 1.2, D1122 = λ = 0.4, D1212 = G = 0.4.
        let found = inverse([1.2, 0.4, 1.2, 0.4, 0.4, 1.2, 0.4, 0.4, 0.4]).unwrap();
        let expected = [1.0, 1.0, 1.0, 0.25, 0.25, 0.25, 0.4, 0.4, 0.4];
        assert!(
            found
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-14),
            "{found:?}"
        );
        // S = diag(1, 1/2, 1/4) with S12 = −0.1: E = 1, 2, 4 and ν12 = 0.1.
        let d = Matrix3::new(1.0, -0.1, 0.0, -0.1, 0.5, 0.0, 0.0, 0.0, 0.25)
            .try_inverse()
            .unwrap();
        let of = |i: usize, j: usize| d[(i, j)];
        let found = inverse([
            of(0, 0),
            of(0, 1),
            of(1, 1),
            of(0, 2),
            of(1, 2),
            of(2, 2),
            5.0,
            6.0,
            7.0,
        ]);
        let expected = [1.0, 2.0, 4.0, 0.1, 0.0, 0.0, 5.0, 6.0, 7.0];
        assert!(
            found
                .unwrap()
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-13)
        );
        assert!(inverse([1.0, 2.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]).is_none());
    }
}
