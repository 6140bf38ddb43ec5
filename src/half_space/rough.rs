//! Random self-affine surfaces.
//!
//! ```text
//! (S12)  h = Σ_k a(|k|) cos(k·x + φ_k),     a = max(|k|, k_r)^−(1+H)  for 0 < |k| ≤ k_s, else 0
//! ```
//!
//! k_r and k_s are the waves of roll-off and cut-off, H the Hurst exponent, φ_k a phase that the wave
//! and the seed alone decide: a finer grid samples the same surface. Persson et al., J. Phys.: Condens.
//! Matter 17 (2005) R1–R62, for the spectrum.

use std::f64::consts::PI;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::grid::Grid;
use super::range::check_range;
use crate::error::{Error, check_finite};

/// What decides a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfAffine {
    /// H, from 0 to 1.
    pub hurst: f64,
    /// Longest wave that the power law holds for, in metre; longer ones are as high as it.
    pub roll_off: f64,
    /// Shortest wave, in metre; at least two cells.
    pub cut_off: f64,
    /// Root mean square of the slope.
    pub slope: f64,
    /// Number of the sample.
    pub seed: u64,
}

impl SelfAffine {
    /// Heights of the cells, in metre, with mean zero.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for an exponent outside 0 to 1, waves that are not positive, a cut-off
    /// above the roll-off or below two cells, a slope that is negative; [`Error::NotFinite`].
    pub fn heights(&self, grid: &Grid) -> Result<Vec<f64>, Error> {
        self.check(grid)?;
        let [columns, rows] = grid.cells;
        let size = [0, 1].map(|axis| grid.cells[axis] as f64 * grid.spacing[axis]);
        let mut waves = vec![Complex::default(); grid.len()];
        let mut square = 0.0;
        let most = [0, 1].map(|axis| ((grid.cells[axis] - 1) / 2) as i64);
        for row in 0..=most[1] {
            for column in -most[0]..=most[0] {
                // The other half of the waves is the conjugate of this one.
                if row == 0 && column <= 0 {
                    continue;
                }
                let k = (column as f64 / size[0]).hypot(row as f64 / size[1]);
                if k > 1.0 / self.cut_off {
                    continue;
                }
                let amplitude = k.max(1.0 / self.roll_off).powf(-1.0 - self.hurst);
                let wave = Complex::from_polar(amplitude, self.phase(column, row));
                square += 2.0 * (2.0 * PI * k * amplitude).powi(2);
                let at = |column: i64, row: i64| {
                    column.rem_euclid(columns as i64) as usize
                        + columns * row.rem_euclid(rows as i64) as usize
                };
                waves[at(column, row)] = wave;
                waves[at(-column, -row)] = wave.conj();
            }
        }
        let factor = match square > 0.0 {
            true => self.slope / square.sqrt(),
            false => 0.0,
        };
        transform(&mut waves, grid.cells);
        Ok(waves.iter().map(|wave| factor * wave.re).collect())
    }

    fn check(&self, grid: &Grid) -> Result<(), Error> {
        let numbers = [self.hurst, self.roll_off, self.cut_off, self.slope];
        check_finite("surface", &numbers)?;
        let across = if grid.cells[1] > 1 {
            grid.spacing[1]
        } else {
            0.0
        };
        let coarsest = grid.spacing[0].max(across);
        // What is computed as two cells may be below by round-off.
        let shortest = 2.0 * coarsest * (1.0 - 1e-12);
        let (hurst, cut_off, roll_off) = (self.hurst, self.cut_off, self.roll_off);
        for (field, value, good, accepted) in [
            (
                "hurst",
                hurst,
                (0.0..=1.0).contains(&hurst),
                "0 <= hurst <= 1",
            ),
            (
                "cut_off",
                cut_off,
                cut_off >= shortest,
                "cut_off >= two cells",
            ),
            (
                "roll_off",
                roll_off,
                roll_off >= cut_off,
                "roll_off >= cut_off",
            ),
            ("slope", self.slope, self.slope >= 0.0, "slope >= 0"),
        ] {
            check_range(format!("surface.{field}"), value, good, accepted)?;
        }
        Ok(())
    }

    /// φ of a wave, in radian, from its numbers and the seed.
    fn phase(&self, column: i64, row: i64) -> f64 {
        let bits = scattered(scattered(scattered(self.seed) ^ column as u64) ^ row as u64);
        2.0 * PI * (bits >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A number without pattern for every number (SplitMix64).
pub(super) fn scattered(number: u64) -> u64 {
    let mixed = number.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    mixed ^ (mixed >> 31)
}

/// Sum of waves at every cell, in place.
pub(super) fn transform(waves: &mut [Complex<f64>], [columns, rows]: [usize; 2]) {
    let mut planner = FftPlanner::new();
    planner.plan_fft_inverse(columns).process(waves);
    let plan = planner.plan_fft_inverse(rows);
    let mut line = vec![Complex::default(); rows];
    for column in 0..columns {
        for (row, entry) in line.iter_mut().enumerate() {
            *entry = waves[column + columns * row];
        }
        plan.process(&mut line);
        for (row, entry) in line.iter().enumerate() {
            waves[column + columns * row] = *entry;
        }
    }
}
