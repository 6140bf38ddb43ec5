//! Two-dimensional convolution by fast Fourier transforms, of which the zeros are left out.
//!
//! ```text
//! 1  rows that hold a point       real transform of the padded row           spectrum[component][row][wave]
//! 2  blocks of eight columns      gather, transform, times symbol, back      returned[block][component][row][8]
//! 3  rows that are asked for      gather, real transform back
//! ```
//!
//! A padded row is transformed only if a point stands on it; the zero rows below the grid are never
//! touched by rows, and the symbol meets a column while it is in the cache. Every row and every block
//! is one task with one order of additions: the bits are the same on any number of threads.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use super::points::Points;

pub(super) type Wave = Complex<f64>;

/// Columns that one task transforms together: eight complex numbers fill two cache lines.
const BLOCK: usize = 8;

/// Plans for one grid, and the memory that applications share.
pub(super) struct Transforms {
    cells: [usize; 2],
    padded: [usize; 2],
    row_forward: Arc<dyn RealToComplex<f64>>,
    row_back: Arc<dyn ComplexToReal<f64>>,
    column_forward: Arc<dyn Fft<f64>>,
    column_back: Arc<dyn Fft<f64>>,
    /// Spectrum and what returns of it, as many as there were applications at one time.
    spaces: Mutex<Vec<[Vec<Wave>; 2]>>,
    done: AtomicUsize,
}

/// What is convolved with what: components are normal, x, y.
pub(super) struct Convolution<'a> {
    pub(super) inputs: [Option<&'a [f64]>; 3],
    pub(super) from: &'a Points,
    pub(super) outputs: [bool; 3],
    pub(super) to: &'a Points,
}

impl Convolution<'_> {
    /// Components that go in, and those that come out.
    fn components(&self) -> [Vec<usize>; 2] {
        let of = |there: [bool; 3]| (0..3).filter(|&c| there[c]).collect();
        [self.inputs.map(|input| input.is_some()), self.outputs].map(of)
    }
}

/// Turns the three transformed components of one wave number along x into those of the result.
pub(super) type Mix<'a> = &'a (dyn Fn(usize, [&mut [Wave]; 3]) + Sync);

impl Transforms {
    pub(super) fn new(cells: [usize; 2], padded: [usize; 2]) -> Self {
        let mut rows = RealFftPlanner::new();
        let mut columns = FftPlanner::new();
        Self {
            cells,
            padded,
            row_forward: rows.plan_fft_forward(padded[0]),
            row_back: rows.plan_fft_inverse(padded[0]),
            column_forward: columns.plan_fft_forward(padded[1]),
            column_back: columns.plan_fft_inverse(padded[1]),
            spaces: Mutex::default(),
            done: AtomicUsize::new(0),
        }
    }

    /// Wave numbers along x that a real row has.
    pub(super) fn waves(&self) -> usize {
        self.padded[0] / 2 + 1
    }

    /// Two-dimensional transforms so far.
    pub(super) fn done(&self) -> usize {
        self.done.load(Ordering::Relaxed)
    }

    /// The asked components on `to`, of the given ones on `from`; nothing for the others.
    pub(super) fn convolve(&self, asked: &Convolution, mix: Mix) -> [Vec<f64>; 3] {
        let [inputs, outputs] = asked.components();
        self.done
            .fetch_add(inputs.len() + outputs.len(), Ordering::Relaxed);
        let mut space = self.spaces().pop().unwrap_or_default();
        let [spectrum, returned] = &mut space;
        let blocks = self.waves().div_ceil(BLOCK);
        grow(spectrum, inputs.len() * self.cells[1] * self.waves());
        grow(returned, outputs.len() * self.cells[1] * blocks * BLOCK);
        self.forward_rows(asked, &inputs, spectrum);
        let size = outputs.len() * self.cells[1] * BLOCK;
        let tasks = returned.par_chunks_mut(size).take(blocks).enumerate();
        tasks.for_each_init(
            || Columns::new(self),
            |columns, (block, returned)| {
                columns.gather(asked, &inputs, spectrum, block);
                columns.mix(block, &inputs, &outputs, mix);
                columns.give_back(asked, &outputs, returned);
            },
        );
        let result = self.rows_back(asked, &outputs, returned);
        self.spaces().push(space);
        result
    }

    /// A panic elsewhere leaves numbers that are overwritten here.
    fn spaces(&self) -> MutexGuard<'_, Vec<[Vec<Wave>; 2]>> {
        self.spaces.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn forward_rows(&self, asked: &Convolution, inputs: &[usize], spectrum: &mut [Wave]) {
        let [waves, rows] = [self.waves(), self.cells[1]];
        let lines = spectrum.par_chunks_mut(waves).take(inputs.len() * rows);
        lines.enumerate().for_each_init(
            || {
                let plan = &self.row_forward;
                (plan.make_input_vec(), plan.make_scratch_vec())
            },
            |(line, scratch), (task, spectrum)| {
                let (component, row) = (inputs[task / rows], task % rows);
                let Some(input) = asked.inputs[component].filter(|_| asked.from.has_row(row))
                else {
                    return;
                };
                line.fill(0.0);
                let values = asked.from.row(row, input);
                for (column, value) in asked.from.columns(row).zip(values) {
                    line[column] = *value;
                }
                // Lengths are the plan's own: nothing can fail.
                let plan = &self.row_forward;
                let _ = plan.process_with_scratch(line, spectrum, scratch);
            },
        );
    }

    fn rows_back(
        &self,
        asked: &Convolution,
        outputs: &[usize],
        returned: &[Wave],
    ) -> [Vec<f64>; 3] {
        let mut result = asked
            .outputs
            .map(|there| vec![0.0; if there { asked.to.len() } else { 0 }]);
        let rows = self.cells[1];
        for (place, &component) in outputs.iter().enumerate() {
            let parts = asked.to.rows_mut(&mut result[component]);
            let tasks = parts.into_par_iter().enumerate();
            tasks.filter(|(_, part)| !part.is_empty()).for_each_init(
                || {
                    let plan = &self.row_back;
                    let (waves, line) = (plan.make_input_vec(), plan.make_output_vec());
                    (waves, line, plan.make_scratch_vec())
                },
                |(waves, line, scratch), (row, part)| {
                    let size = outputs.len() * rows * BLOCK;
                    for (block, waves) in waves.chunks_mut(BLOCK).enumerate() {
                        let start = block * size + (place * rows + row) * BLOCK;
                        waves.copy_from_slice(&returned[start..start + waves.len()]);
                    }
                    // Real by symmetry; what round-off leaves is refused by the transform.
                    waves[0].im = 0.0;
                    if self.padded[0].is_multiple_of(2) {
                        waves[self.padded[0] / 2].im = 0.0;
                    }
                    let _ = self.row_back.process_with_scratch(waves, line, scratch);
                    for (value, column) in part.iter_mut().zip(asked.to.columns(row)) {
                        *value = line[column];
                    }
                },
            );
        }
        result
    }
}

fn grow(memory: &mut Vec<Wave>, size: usize) {
    if memory.len() < size {
        memory.resize(size, Wave::default());
    }
}

/// Eight columns of every component, and what their transforms need.
struct Columns<'a> {
    plans: &'a Transforms,
    values: [Vec<Wave>; 3],
    scratch: Vec<Wave>,
}

impl<'a> Columns<'a> {
    fn new(plans: &'a Transforms) -> Self {
        let forward = plans.column_forward.get_inplace_scratch_len();
        let back = plans.column_back.get_inplace_scratch_len();
        let column = vec![Wave::default(); BLOCK * plans.padded[1]];
        Self {
            plans,
            values: [column.clone(), column.clone(), column],
            scratch: vec![Wave::default(); forward.max(back)],
        }
    }

    /// Fills the columns of a block, zero where no point stands.
    fn gather(&mut self, asked: &Convolution, inputs: &[usize], spectrum: &[Wave], block: usize) {
        let [waves, rows] = [self.plans.waves(), self.plans.cells[1]];
        let (first, length) = (block * BLOCK, self.plans.padded[1]);
        let width = BLOCK.min(waves - first);
        for (place, &component) in inputs.iter().enumerate() {
            let values = &mut self.values[component];
            for column in values.chunks_mut(length) {
                column[rows..].fill(Wave::default());
            }
            for row in 0..rows {
                let start = (place * rows + row) * waves + first;
                let there = asked.from.has_row(row);
                for column in 0..width {
                    values[column * length + row] = match there {
                        true => spectrum[start + column],
                        false => Wave::default(),
                    };
                }
            }
        }
    }

    fn mix(&mut self, block: usize, inputs: &[usize], outputs: &[usize], mix: Mix) {
        let (plans, length) = (self.plans, self.plans.padded[1]);
        let first = block * BLOCK;
        for column in 0..BLOCK.min(plans.waves() - first) {
            let at = column * length..(column + 1) * length;
            let parts = self.values.each_mut();
            let mut parts = parts.map(|values| &mut values[at.clone()]);
            for &input in inputs {
                let plan = &plans.column_forward;
                plan.process_with_scratch(parts[input], &mut self.scratch);
            }
            mix(first + column, parts.each_mut().map(|part| &mut **part));
            for &output in outputs {
                let plan = &plans.column_back;
                plan.process_with_scratch(parts[output], &mut self.scratch);
            }
        }
    }

    fn give_back(&self, asked: &Convolution, outputs: &[usize], returned: &mut [Wave]) {
        let (rows, length) = (self.plans.cells[1], self.plans.padded[1]);
        for (place, &component) in outputs.iter().enumerate() {
            let values = &self.values[component];
            for row in (0..rows).filter(|&row| asked.to.has_row(row)) {
                let start = (place * rows + row) * BLOCK;
                for (column, returned) in returned[start..start + BLOCK].iter_mut().enumerate() {
                    *returned = values[column * length + row];
                }
            }
        }
    }
}
