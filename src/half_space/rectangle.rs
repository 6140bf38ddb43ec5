//! Displacements by a constant traction on a rectangle (Boussinesq, Cerruti), or on a strip (Flamant).
//!
//! Displacement at a distance (x, y) of a force that is spread evenly over one cell:
//!
//! ```text
//! (S3)  G_NN = a/2π ∫ 1/r,                 a = direct, b = lateral, c = coupling
//!       G_xx = 1/2π ∫ (a/r + b x²/r³),     G_yy alike with y²
//!       G_xy = 1/2π ∫ b xy/r³
//!       G_xN = c/4π ∫ x/r² = −G_Nx,        G_yN alike with y
//! (S4)  strip, infinite along y:
//!       G_NN = G_xx = −a/π ∫ ln(|x|/D),    G_yy = −(a + b)/π ∫ ln(|x|/D),    G_xN = c/4 ∫ sgn x
//! ```
//!
//! ∫ is the mean over the cell. Antiderivatives at the four corners: Love, Phil. Trans. R. Soc. A 228
//! (1929) 377–420; Johnson, Contact Mechanics (1985), sections 2.3, 3.2 and 3.6.

use std::f64::consts::PI;

#[cfg(feature = "cli")]
use super::compliance::ElasticHalf;
use super::compliance::SurfaceCompliance;
#[cfg(feature = "cli")]
use crate::error::Error;

/// The kernels that differ, in this order: NN, xx, yy, xy, xN, yN.
pub(super) const KERNELS: usize = 6;

/// What a study needs: displacement by forces on patches anywhere: rows and columns normal, x, y, in m/N.
#[cfg(feature = "cli")]
pub(crate) struct Influence(SurfaceCompliance);

#[cfg(feature = "cli")]
impl Influence {
    /// Of one half-space on a rigid body, or of two.
    pub(crate) fn new(material: ElasticHalf, other: Option<ElasticHalf>) -> Result<Self, Error> {
        Ok(Self(SurfaceCompliance::new(material, other)?))
    }

    /// (S3) at an offset in metre from the middle of a rectangle.
    pub(crate) fn of_rectangle(&self, sides: [f64; 2], offset: [f64; 2]) -> [[f64; 3]; 3] {
        // An edge just there has a logarithm times zero.
        let beside = [0, 1].map(|axis| {
            let half = 0.5 * sides[axis];
            match (offset[axis].abs() - half).abs() < 1e-9 * half {
                true => offset[axis] + 2e-9 * half,
                false => offset[axis],
            }
        });
        arranged(rectangle(&self.0, sides, beside))
    }

    /// (S4) at a distance in metre from the middle of a strip; displacements vanish at `datum`.
    pub(crate) fn of_strip(&self, width: f64, datum: f64, offset: f64) -> [[f64; 3]; 3] {
        arranged(strip(&self.0, width, datum, offset))
    }
}

/// Kernels as a matrix.
pub(super) fn arranged([nn, xx, yy, xy, xn, yn]: [f64; KERNELS]) -> [[f64; 3]; 3] {
    [[nn, -xn, -yn], [xn, xx, xy], [yn, xy, yy]]
}

/// Antiderivatives of 1/r, x²/r³, y²/r³, xy/r³, x/r², y/r² at a corner, neither coordinate zero.
fn antiderivatives([x, y]: [f64; 2]) -> [f64; KERNELS] {
    let r = x.hypot(y);
    // ln(y + r) with y < 0 cancels: (y + r)(r − y) = x².
    let log_sum = |along: f64, across: f64| match along > 0.0 {
        true => (along + r).ln(),
        false => 2.0 * across.abs().ln() - (r - along).ln(),
    };
    let (log_y, log_x, log_r) = (log_sum(y, x), log_sum(x, y), r.ln());
    [
        x * log_y + y * log_x,
        y * log_x,
        x * log_y,
        -r,
        y * log_r + x * (y / x).atan(),
        x * log_r + y * (x / y).atan(),
    ]
}

/// (S3) per unit force on one rectangle of the given sides, in m/N.
pub(super) fn rectangle(
    compliance: &SurfaceCompliance,
    sides: [f64; 2],
    [x, y]: [f64; 2],
) -> [f64; KERNELS] {
    let [half_x, half_y] = sides.map(|side| 0.5 * side);
    let mut mean = [0.0; KERNELS];
    for (sign_x, sign_y) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        let corner = antiderivatives([x + sign_x * half_x, y + sign_y * half_y]);
        for (mean, corner) in mean.iter_mut().zip(corner) {
            *mean += sign_x * sign_y * corner;
        }
    }
    let area = sides[0] * sides[1];
    let SurfaceCompliance {
        direct,
        lateral,
        coupling,
    } = compliance;
    let [inverse, xx, yy, xy, x, y] = mean.map(|integral| integral / (2.0 * PI * area));
    [
        direct * inverse,
        direct * inverse + lateral * xx,
        direct * inverse + lateral * yy,
        lateral * xy,
        0.5 * coupling * x,
        0.5 * coupling * y,
    ]
}

/// (S4) per unit force and length on one strip of the given width, in m²/N; `datum` is D, in metre.
pub(super) fn strip(
    compliance: &SurfaceCompliance,
    width: f64,
    datum: f64,
    x: f64,
) -> [f64; KERNELS] {
    let (right, left) = (x + 0.5 * width, x - 0.5 * width);
    let logarithm = |x: f64| x * (x / datum).abs().ln() - x;
    let mean = -(logarithm(right) - logarithm(left)) / width;
    let direct = compliance.direct * mean / PI;
    let along = (compliance.direct + compliance.lateral) * mean / PI;
    let coupling = 0.25 * compliance.coupling * (right.abs() - left.abs()) / width;
    [direct, direct, along, 0.0, coupling, 0.0]
}
