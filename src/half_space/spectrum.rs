//! Power spectrum of a surface.
//!
//! ```text
//! (S15)  C(q) = (L_x L_y/4π²) ⟨|a_k|²⟩ over the waves k with |k| about q,   h = Σ_k a_k exp(i k·x)
//!        ∫ C d²q = ⟨h²⟩
//! ```
//!
//! Of a line C(q) = (L_x/2π) ⟨|a_k|²⟩, with ∫ C dq over both signs. What is not periodic would show its
//! edges: it is seen through a Hann window of mean square one. Persson et al., J. Phys.: Condens.
//! Matter 17 (2005) R1–R62; Jacobs, Junge, Pastewka, Surf. Topogr. 5 (2017) 013001.

use std::f64::consts::PI;

use rustfft::num_complex::Complex;

use super::grid::Grid;
use super::operator::Surroundings;
use super::rough::transform;
use crate::error::{Error, check_finite, check_length};

/// Waves of about one length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectrumRing {
    /// Mean |k| = 2π/length, in 1/m.
    pub wave_number: f64,
    /// C (S15), in m⁴; of a line, in m³.
    pub power: f64,
    /// How many waves it is the mean of, k and −k both counted.
    pub waves: usize,
}

/// The spectrum of heights or gaps per cell, in metre; rings are as wide as the longest wave's number, and
/// the first is about that.
///
/// # Errors
///
/// [`Error::Length`] unless there is a height per cell; [`Error::NotFinite`].
pub fn power_spectrum(
    grid: &Grid,
    surroundings: Surroundings,
    heights: &[f64],
) -> Result<Vec<SpectrumRing>, Error> {
    check_length("heights", grid.len(), heights.len())?;
    check_finite("heights", heights)?;
    let [columns, rows] = grid.cells;
    let mean = heights.iter().sum::<f64>() / grid.len() as f64;
    let seen = heights.iter().enumerate().map(|(cell, height)| {
        let window = match surroundings {
            Surroundings::Periodic => 1.0,
            Surroundings::Free | Surroundings::Plane => {
                hann(cell % columns, columns) * hann(cell / columns, rows)
            }
        };
        Complex::new(window * (height - mean), 0.0)
    });
    let mut waves: Vec<_> = seen.collect();
    transform(&mut waves, grid.cells);
    // Wave numbers of one turn over the sides; none across a line.
    let turn = [0, 1].map(|axis| match grid.cells[axis] {
        1 => 0.0,
        cells => 2.0 * PI / (cells as f64 * grid.spacing[axis]),
    });
    let turns = turn.into_iter().filter(|k| *k > 0.0);
    let longest = turns.clone().fold(f64::INFINITY, f64::min);
    let unit: f64 = turns.product();
    let scale = 1.0 / (unit * (grid.len() as f64).powi(2));
    let mut rings: Vec<(f64, f64, usize)> = Vec::new();
    for (at, amplitude) in waves.iter().enumerate().skip(1) {
        let along = [signed(at % columns, columns), signed(at / columns, rows)];
        let k = (along[0] * turn[0]).hypot(along[1] * turn[1]);
        let ring = (k / longest).round() as usize - 1;
        if rings.len() <= ring {
            rings.resize(ring + 1, (0.0, 0.0, 0));
        }
        let (sum, power, count) = &mut rings[ring];
        (*sum, *power, *count) = (*sum + k, *power + amplitude.norm_sqr(), *count + 1);
    }
    let some = rings.into_iter().filter(|(.., count)| *count > 0);
    let mean = |(sum, power, waves): (f64, f64, usize)| SpectrumRing {
        wave_number: sum / waves as f64,
        power: scale * power / waves as f64,
        waves,
    };
    Ok(some.map(mean).collect())
}

/// A wave's number, negative in the upper half.
fn signed(at: usize, count: usize) -> f64 {
    let turns = if 2 * at > count { count } else { 0 };
    at as f64 - turns as f64
}

/// √(8/3) sin² over the middle of the cells; one for a single cell.
fn hann(at: usize, count: usize) -> f64 {
    match count {
        1 => 1.0,
        _ => (8.0_f64 / 3.0).sqrt() * (PI * (at as f64 + 0.5) / count as f64).sin().powi(2),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::rough::SelfAffine;
    use super::*;

    #[test]
    fn the_power_of_all_waves_is_the_mean_square_of_the_heights() {
        for cells in [[32, 24], [9, 15], [40, 1], [1, 7]] {
            let grid = Grid::new(cells, [0.3, 0.2]).unwrap();
            let heights = grid.sample(|[x, y]| (3.0 * x + y * y).sin() + 0.3 * x);
            let mean = heights.iter().sum::<f64>() / grid.len() as f64;
            let square = heights.iter().map(|h| (h - mean).powi(2)).sum::<f64>();
            let rings = power_spectrum(&grid, Surroundings::Periodic, &heights).unwrap();
            let sides = [0, 1].map(|a| cells[a] as f64 * grid.spacing[a]);
            let unit: f64 = (0..2)
                .filter(|&a| cells[a] > 1)
                .map(|a| 2.0 * PI / sides[a])
                .product();
            let all: f64 = rings.iter().map(|r| r.power * r.waves as f64 * unit).sum();
            assert!((all / (square / grid.len() as f64) - 1.0).abs() < 1e-12);
            assert_eq!(rings.iter().map(|r| r.waves).sum::<usize>(), grid.len() - 1);
        }
    }

    #[test]
    fn a_self_affine_surface_falls_by_its_exponent_between_roll_off_and_cut_off() {
        let grid = Grid::new([256, 256], [1.0 / 256.0; 2]).unwrap();
        let surface = SelfAffine {
            hurst: 0.7,
            roll_off: 0.125,
            cut_off: 1.0 / 64.0,
            slope: 0.1,
            seed: 1,
        };
        let heights = surface.heights(&grid).unwrap();
        let rings = power_spectrum(&grid, Surroundings::Periodic, &heights).unwrap();
        let at = |waves: usize| rings[waves - 1];
        // C ~ q^−2(1+H) between, flat below, nothing above; a ring's mean is off by its width squared.
        let fall =
            (at(56).power / at(14).power).ln() / (at(56).wave_number / at(14).wave_number).ln();
        assert!((fall + 3.4).abs() < 0.02, "{fall}");
        assert!((at(3).power / at(6).power - 1.0).abs() < 1e-9);
        assert!(at(70).power < 1e-25 * at(14).power);
        // Through a window, a ramp does not hide what it bears.
        let tilted = grid.sample(|[x, _]| 0.05 * x);
        let tilted: Vec<f64> = tilted.iter().zip(&heights).map(|(a, b)| a + b).collect();
        let seen = power_spectrum(&grid, Surroundings::Free, &tilted).unwrap();
        let fall = (seen[55].power / seen[13].power).ln() / (56.0_f64 / 14.0).ln();
        assert!((fall + 3.4).abs() < 0.2, "{fall}");
    }
}
