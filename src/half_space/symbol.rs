//! Symbols: the kernels' Fourier transforms, kept for a quarter of the wave numbers.
//!
//! ```text
//! (S5)  bounded    transform of (S3) or (S4) on the padded grid: the convolution is exact
//! (S6)  periodic   NN  a/k          xx  (a + b)/k − b kx²/k³      xy  −b kx ky/k³
//!                  xN  −i c kx/2k²   at the wave numbers of the grid, zero for k = 0
//! ```
//!
//! NN, xx, yy are even in kx and ky, xy is odd in both: real. xN is odd in kx, yN in ky: imaginary, and
//! their imaginary part is kept. Odd kernels vanish at the Nyquist wave, which has no sign.

use std::f64::consts::PI;

use rayon::prelude::*;
use realfft::RealFftPlanner;

use super::compliance::SurfaceCompliance;
use super::grid::Grid;
use super::rectangle::KERNELS;
use super::transform::Wave;

/// Whether NN, xx, yy, xy, xN, yN are odd along x and y.
const ODD: [[bool; 2]; KERNELS] = [
    [false, false],
    [false, false],
    [false, false],
    [true, true],
    [true, false],
    [false, true],
];

/// One number per kernel and quarter wave, contiguous along ky, divided by the size of the transform.
pub(super) struct Symbols {
    pub(super) kernels: [Vec<f64>; KERNELS],
    padded: [usize; 2],
    /// Below it a symbol is taken for its floor when it is inverted.
    floors: [f64; 2],
}

impl Symbols {
    /// (S5), from the influence of a cell on one `columns` and `rows` away.
    pub(super) fn bounded(
        padded: [usize; 2],
        influence: &(dyn Fn([usize; 2]) -> [f64; KERNELS] + Sync),
    ) -> Self {
        let [waves, offsets] = padded.map(|length| length / 2 + 1);
        let table = |row: usize| -> Vec<[f64; KERNELS]> {
            (0..waves).map(|column| influence([column, row])).collect()
        };
        let table: Vec<Vec<[f64; KERNELS]>> = (0..offsets).into_par_iter().map(table).collect();
        let kernels = std::array::from_fn(|kernel| {
            let rows = table.par_iter().map(|row| {
                let row: Vec<f64> = row.iter().map(|entry| entry[kernel]).collect();
                half_transform(&row, padded[0], ODD[kernel][0])
            });
            let rows: Vec<Vec<f64>> = rows.collect();
            let odd = ODD[kernel] == [true, true];
            let sign = if odd { -1.0 } else { 1.0 };
            let scale = sign / (padded[0] * padded[1]) as f64;
            let columns = (0..waves).into_par_iter().flat_map_iter(|wave| {
                let column: Vec<f64> = rows.iter().map(|row| scale * row[wave]).collect();
                half_transform(&column, padded[1], ODD[kernel][1])
            });
            columns.collect()
        });
        Self::with_floors(kernels, padded)
    }

    /// (S6) for forces on cells of the grid.
    pub(super) fn periodic(grid: &Grid, compliance: &SurfaceCompliance) -> Self {
        let SurfaceCompliance {
            direct,
            lateral,
            coupling,
        } = *compliance;
        let scale = 1.0 / (grid.len() as f64 * grid.cell_area());
        let [waves, rows] = grid.cells.map(|cells| cells / 2 + 1);
        let number = |axis: usize, at: usize| {
            2.0 * PI * at as f64 / (grid.cells[axis] as f64 * grid.spacing[axis])
        };
        let nyquist = |axis: usize, at: usize| at > 0 && 2 * at == grid.cells[axis];
        let mut kernels = std::array::from_fn(|_| Vec::with_capacity(waves * rows));
        for (column, row) in (0..waves).flat_map(|column| (0..rows).map(move |row| (column, row))) {
            let [kx, ky] = [number(0, column), number(1, row)];
            let (k, odd_x, odd_y) = (kx.hypot(ky), !nyquist(0, column), !nyquist(1, row));
            let inverse = if k > 0.0 { scale / k } else { 0.0 };
            let [x, y] = if k > 0.0 { [kx / k, ky / k] } else { [0.0; 2] };
            let if_odd = |there: bool, value: f64| if there { value } else { 0.0 };
            let values = [
                direct * inverse,
                (direct + lateral * (1.0 - x * x)) * inverse,
                (direct + lateral * (1.0 - y * y)) * inverse,
                if_odd(odd_x && odd_y, -lateral * x * y * inverse),
                if_odd(odd_x, -0.5 * coupling * x * inverse),
                if_odd(odd_y, -0.5 * coupling * y * inverse),
            ];
            for (kernel, value) in kernels.iter_mut().zip(values) {
                kernel.push(value);
            }
        }
        Self::with_floors(kernels, grid.cells)
    }

    /// A symbol that padding bent below the least of its own kind, or that is zero as the mean of a
    /// periodic surface is, is inverted as that of the longest wave.
    fn with_floors(kernels: [Vec<f64>; KERNELS], padded: [usize; 2]) -> Self {
        let least = |kernel: &[f64]| {
            let positive = kernel.iter().filter(|value| **value > 0.0);
            positive.fold(f64::INFINITY, |least, value| least.min(*value))
        };
        let tangential = least(&kernels[1]).min(least(&kernels[2]));
        let floors = [least(&kernels[0]), tangential];
        Self {
            kernels,
            padded,
            floors,
        }
    }

    /// Largest eigenvalues that the normal and the tangential part can have on any set of cells.
    pub(super) fn largest(&self) -> [f64; 2] {
        let size = (self.padded[0] * self.padded[1]) as f64;
        let [nn, xx, yy, xy, ..] = &self.kernels;
        let normal = nn.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let tangential = (0..xx.len()).fold(0.0_f64, |most, at| {
            let half = 0.5 * (xx[at] - yy[at]).hypot(2.0 * xy[at]);
            most.max((0.5 * (xx[at] + yy[at])).abs() + half)
        });
        [normal * size, tangential * size]
    }

    /// Means over all waves of NN, xx, yy: the diagonal of a periodic operator.
    pub(super) fn means(&self) -> [f64; 3] {
        let [waves, rows] = self.padded.map(|length| length / 2 + 1);
        let twice = |axis: usize, at: usize| match at == 0 || 2 * at == self.padded[axis] {
            true => 1.0,
            false => 2.0,
        };
        [0, 1, 2].map(|kernel| {
            let all = (0..waves * rows).map(|at| (at / rows, at % rows, self.kernels[kernel][at]));
            all.map(|(column, row, value)| twice(0, column) * twice(1, row) * value)
                .sum()
        })
    }

    /// Calls for every wave along y of a column: its place, its place in the quarter, its sign.
    fn each(&self, column: usize, mut act: impl FnMut(usize, usize, f64)) {
        let (length, rows) = (self.padded[1], self.padded[1] / 2 + 1);
        for row in 0..rows {
            act(row, column * rows + row, 1.0);
        }
        for row in rows..length {
            act(row, column * rows + length - row, -1.0);
        }
    }

    /// `u_N = NN f_N − i (xN f_x + yN f_y)`, `u_x = xx f_x + xy f_y + i xN f_N`, `u_y` alike.
    pub(super) fn full(&self, column: usize, [normal, x, y]: [&mut [Wave]; 3]) {
        let [nn, xx, yy, xy, xn, yn] = &self.kernels;
        self.each(column, |row, at, sign| {
            let (f_n, f_x, f_y) = (normal[row], x[row], y[row]);
            let (cross, of_y) = (sign * xy[at], sign * yn[at]);
            normal[row] = f_n * nn[at] - turned(f_x * xn[at] + f_y * of_y);
            x[row] = f_x * xx[at] + f_y * cross + turned(f_n * xn[at]);
            y[row] = f_y * yy[at] + f_x * cross + turned(f_n * of_y);
        });
    }

    pub(super) fn normal(&self, column: usize, [normal, ..]: [&mut [Wave]; 3]) {
        let nn = &self.kernels[0];
        self.each(column, |row, at, _| normal[row] *= nn[at]);
    }

    pub(super) fn tangential(&self, column: usize, [_, x, y]: [&mut [Wave]; 3]) {
        let [_, xx, yy, xy, ..] = &self.kernels;
        self.each(column, |row, at, sign| {
            let (f_x, f_y, cross) = (x[row], y[row], sign * xy[at]);
            x[row] = f_x * xx[at] + f_y * cross;
            y[row] = f_y * yy[at] + f_x * cross;
        });
    }

    pub(super) fn normal_of_tangential(&self, column: usize, [normal, x, y]: [&mut [Wave]; 3]) {
        let [.., xn, yn] = &self.kernels;
        self.each(column, |row, at, sign| {
            normal[row] = -turned(x[row] * xn[at] + y[row] * (sign * yn[at]));
        });
    }

    pub(super) fn tangential_of_normal(&self, column: usize, [normal, x, y]: [&mut [Wave]; 3]) {
        let [.., xn, yn] = &self.kernels;
        self.each(column, |row, at, sign| {
            x[row] = turned(normal[row] * xn[at]);
            y[row] = turned(normal[row] * (sign * yn[at]));
        });
    }

    pub(super) fn inverse_normal(&self, column: usize, [normal, ..]: [&mut [Wave]; 3]) {
        let (nn, size) = (&self.kernels[0], (self.padded[0] * self.padded[1]) as f64);
        let scale = 1.0 / (size * size);
        self.each(column, |row, at, _| {
            normal[row] *= scale / nn[at].max(self.floors[0]);
        });
    }

    pub(super) fn inverse_tangential(&self, column: usize, [_, x, y]: [&mut [Wave]; 3]) {
        let [_, xx, yy, xy, ..] = &self.kernels;
        let size = (self.padded[0] * self.padded[1]) as f64;
        let (scale, floor) = (1.0 / (size * size), self.floors[1]);
        self.each(column, |row, at, sign| {
            let (f_x, f_y, cross) = (x[row], y[row], sign * xy[at]);
            let (along, across) = (xx[at].max(floor), yy[at].max(floor));
            let determinant = along * across - cross * cross;
            if determinant < 0.5 * floor * floor {
                x[row] = f_x * (scale / along);
                y[row] = f_y * (scale / across);
                return;
            }
            let scale = scale / determinant;
            x[row] = (f_x * across - f_y * cross) * scale;
            y[row] = (f_y * along - f_x * cross) * scale;
        });
    }
}

/// Times the imaginary unit.
fn turned(value: Wave) -> Wave {
    Wave::new(-value.im, value.re)
}

/// Transform of a row that is even or odd about its start, from its first half: real or imaginary part.
fn half_transform(half: &[f64], length: usize, odd: bool) -> Vec<f64> {
    let mut row = vec![0.0; length];
    for (at, &value) in half.iter().enumerate() {
        let mirror = (length - at) % length;
        match odd {
            true if mirror == at => row[at] = 0.0,
            true => (row[at], row[mirror]) = (value, -value),
            false => (row[at], row[mirror]) = (value, value),
        }
    }
    let plan = RealFftPlanner::new().plan_fft_forward(length);
    let mut waves = plan.make_output_vec();
    // Lengths are the plan's own: nothing can fail.
    let _ = plan.process(&mut row, &mut waves);
    let part = |wave: &Wave| if odd { wave.im } else { wave.re };
    waves.iter().map(part).collect()
}
