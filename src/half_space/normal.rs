//! Normal half-step: pressing forces `p = −t_N` under given friction.
//!
//! ```text
//! (S7)  min ½ p·G_NN p + c·p   over   p ≥ 0   (and Σ p = P if the load is given)
//!       g = c + G_NN p − δ ≥ 0,   p g = 0;    δ: mean of g on the pressed set, if the load is given
//! ```
//!
//! Conjugate gradients on the pressed set, of which negative forces are cut off and to which cells
//! with a negative gap come: Polonsky & Keer, Wear 231 (1999) 206–219; here with the inverse symbol
//! for preconditioner. That is fast and not proven, so every step must lower the energy of (S7), else,
//! and after twenty changes of the set in a row, the step is a projected gradient of length 1/λ_max,
//! which contracts the energy's distance from its minimum (Dostál, Optimal Quadratic Programming
//! Algorithms, 2009, section 5.3): together they converge.

use super::operator::HalfSpace;
use super::points::Points;
use super::vectors::{add, dot, sum, total};

/// Steps after which the half-step gives up; the outer loop judges what it is left with.
const MOST_STEPS: usize = 2000;

/// Part of the diagonal step that a released contact gets: from half on, neighbours overshoot.
const RELEASE: f64 = 0.3;

/// Changes of the pressed set in a row before a projected gradient is due.
const CHANGES: usize = 20;

/// What the energy may rise by round-off, of the size of its terms.
const ENERGY_NOISE: f64 = 1e-13;

/// (S7) for one state of friction.
pub(super) struct NormalHalfStep<'a> {
    pub(super) operator: &'a HalfSpace,
    /// c: gap of every cell without pressing forces, in metre.
    pub(super) constant: &'a [f64],
    /// P, in N, where it is given.
    pub(super) load: Option<f64>,
}

/// Pressing forces on the grid, and what they leave of the gap.
#[derive(Clone, Debug)]
pub(super) struct Pressed {
    /// p per cell, in N.
    pub(super) force: Vec<f64>,
    /// `c + G_NN p` per cell, in metre.
    pub(super) gap: Vec<f64>,
    /// δ, in metre; zero where it is part of `c`.
    pub(super) approach: f64,
    /// Cells with p > 0.
    pub(super) points: Points,
    /// Natural map (K1), relative to ‖p‖.
    pub(super) residual: f64,
    energy: f64,
}

/// What conjugate gradients remember.
struct Memory {
    points: Points,
    direction: Vec<f64>,
    residual: Vec<f64>,
    product: f64,
}

impl NormalHalfStep<'_> {
    /// Steps from `force` until the natural map is below `tolerance`.
    pub(super) fn solve(&self, force: Vec<f64>, tolerance: f64) -> Pressed {
        let mut state = self.state(self.start(force));
        let (mut memory, mut changes) = (None, 0);
        for _ in 0..MOST_STEPS {
            if state.residual <= tolerance || state.force.is_empty() {
                break;
            }
            let (next, kept) = self.conjugate(&state, memory.take());
            let noise = ENERGY_NOISE * next.energy.abs().max(state.energy.abs());
            let changed = next.points != state.points;
            changes = if changed { changes + 1 } else { 0 };
            if next.energy <= state.energy + noise && changes < CHANGES {
                (state, memory) = (next, kept);
                continue;
            }
            let next = self.projected_gradient(&state);
            changes = 0;
            if next.energy >= state.energy && next.residual >= state.residual {
                break;
            }
            state = next;
        }
        state
    }

    /// A start that has something pressed, if anything can be.
    fn start(&self, mut force: Vec<f64>) -> Vec<f64> {
        let diagonal = self.operator.diagonal()[0];
        let sum = total(&force);
        match self.load {
            Some(load) if sum > 0.0 => force.iter_mut().for_each(|p| *p *= load / sum),
            Some(load) => force.fill(load / self.constant.len() as f64),
            None if sum > 0.0 => {}
            None => {
                let pushed = |c: &f64| (-c).max(0.0) / (20.0 * diagonal);
                force = self.constant.iter().map(pushed).collect();
            }
        }
        force
    }

    /// The state of forces, with fresh products.
    fn state(&self, force: Vec<f64>) -> Pressed {
        let operator = self.operator;
        let points = Points::select(operator.grid(), |cell| force[cell] > 0.0);
        let on = points.gather(&force);
        let mut gap = match points.is_empty() {
            true => vec![0.0; force.len()],
            false => operator.normal(&on, &points, operator.whole()),
        };
        add(&mut gap, 1.0, self.constant);
        self.measure(force, gap, points)
    }

    /// The state of forces with a given `c + G_NN p`.
    pub(super) fn measure(&self, force: Vec<f64>, gap: Vec<f64>, points: Points) -> Pressed {
        let step = 1.0 / self.operator.diagonal()[0];
        let cells = points.cells();
        let approach = match self.load {
            Some(_) if !cells.is_empty() => {
                sum(cells.len(), |at| gap[cells[at]]) / cells.len() as f64
            }
            // Nothing presses: the surfaces just touch.
            Some(_) => gap.iter().copied().fold(f64::INFINITY, f64::min),
            None => 0.0,
        };
        let defect = sum(force.len(), |at| {
            let defect = force[at].min(step * (gap[at] - approach));
            defect * defect
        });
        let size = sum(cells.len(), |at| force[cells[at]] * force[cells[at]]);
        let energy = sum(cells.len(), |at| {
            0.5 * force[cells[at]] * (gap[cells[at]] + self.constant[cells[at]])
        });
        let residual = match (defect > 0.0, size > 0.0) {
            (false, _) => 0.0,
            (true, true) => (defect / size).sqrt(),
            (true, false) => f64::INFINITY,
        };
        Pressed {
            force,
            gap,
            approach,
            points,
            residual,
            energy,
        }
    }

    /// One step of conjugate gradients, cut off at zero, and contacts released.
    fn conjugate(&self, state: &Pressed, memory: Option<Memory>) -> (Pressed, Option<Memory>) {
        let points = &state.points;
        let of = |&cell: &usize| state.gap[cell] - state.approach;
        let residual = points.cells().iter().map(of).collect();
        let memory = self.direction(points, residual, memory);
        let whole = self.operator.whole();
        let product = self.operator.normal(&memory.direction, points, whole);
        let on = points.gather(&product);
        let curvature = dot(&memory.direction, &on);
        let length = match curvature > 0.0 {
            true => dot(&memory.residual, &memory.direction) / curvature,
            // One contact under a given load has no direction; release still runs.
            false => 0.0,
        };
        let mut force = state.force.clone();
        let mut cut = false;
        for (&cell, direction) in points.cells().iter().zip(&memory.direction) {
            force[cell] -= length * direction;
            if force[cell] < 0.0 {
                force[cell] = 0.0;
                cut = true;
            }
        }
        let released = self.release(state, &mut force);
        if !(cut || released) {
            let mut gap = state.gap.clone();
            add(&mut gap, -length, &product);
            return (self.measure(force, gap, points.clone()), Some(memory));
        }
        if let Some(load) = self.load {
            let factor = load / total(&force);
            force.iter_mut().for_each(|p| *p *= factor);
        }
        (self.state(force), Some(memory).filter(|_| !released))
    }

    /// The next direction: preconditioned, conjugate to the last (Polak–Ribière), without a sum if the
    /// load is given.
    fn direction(&self, points: &Points, residual: Vec<f64>, memory: Option<Memory>) -> Memory {
        let mut direction = self.operator.inverse_normal(&residual, points);
        let product = dot(&residual, &direction);
        if let Some(last) = memory {
            let [before, along] =
                [&last.residual, &last.direction].map(|part| points.carry(&last.points, part));
            let turn = (product - dot(&before, &direction)) / last.product;
            add(&mut direction, turn.max(0.0), &along);
        }
        if self.load.is_some() {
            let mean = total(&direction) / direction.len() as f64;
            direction.iter_mut().for_each(|entry| *entry -= mean);
        }
        Memory {
            points: points.clone(),
            direction,
            residual,
            product,
        }
    }

    /// Gives a force to cells without one whose gap is negative.
    fn release(&self, state: &Pressed, force: &mut [f64]) -> bool {
        let step = RELEASE / self.operator.diagonal()[0];
        let mut released = false;
        for (force, gap) in force.iter_mut().zip(&state.gap) {
            let gap = gap - state.approach;
            if *force <= 0.0 && gap < 0.0 {
                *force -= step * gap;
                released = true;
            }
        }
        released
    }

    /// A step of length 1/λ_max down the gradient, projected on `p ≥ 0`, `Σ p = P`.
    fn projected_gradient(&self, state: &Pressed) -> Pressed {
        let mut force = state.force.clone();
        add(&mut force, -1.0 / self.operator.largest()[0], &state.gap);
        let shift = self.load.map_or(0.0, |load| simplex_shift(&force, load));
        force.iter_mut().for_each(|p| *p = (*p - shift).max(0.0));
        self.state(force)
    }
}

/// The s with `Σ max(0, v − s) = load`: cells that fall below are left out until none does (Michelot,
/// J. Optim. Theory Appl. 50 (1986) 195–200).
fn simplex_shift(values: &[f64], load: f64) -> f64 {
    let mut shift = (total(values) - load) / values.len() as f64;
    loop {
        let above: Vec<f64> = values.iter().copied().filter(|&v| v > shift).collect();
        let next = (total(&above) - load) / above.len().max(1) as f64;
        if above.is_empty() || next <= shift {
            return shift;
        }
        shift = next;
    }
}
