//! Friction half-step: tangential forces `q = t_T` on discs of given radius.
//!
//! ```text
//! (S8)  min ½ q·G_TT q + c·q   over   ‖q_i‖ ≤ R_i,        w = c + G_TT q: slip
//! (S9)  Newton: sticking contacts are free, slipping ones move along their circle,
//!       (E (G_TT + Λ) E) d = −E w,      Λ = −w·n/R on slipping contacts, E: projection
//! ```
//!
//! (S9) is solved by conjugate gradients, preconditioned by E D S⁻¹ D E with the inverse symbol and
//! D² = 1/(1 + 0.7 Λ/G_ii); its steps are drawn back on the discs, so that every iterate is admissible,
//! and must lower the energy or the residual; else a projected gradient of length 1/λ_max does.

use super::operator::HalfSpace;
use super::points::Points;
use super::vectors::{Pair, add_pair, dot_pair, norm_pair, sum, zero_pair};

/// Newton steps after which the half-step gives up.
const MOST_STEPS: usize = 80;

/// Conjugate gradient steps within one Newton step.
const MOST_INNER: usize = 200;

/// Least and largest tolerance of (S9), relative to its right side.
const INNER_TOLERANCE: [f64; 2] = [1e-3, 0.1];

/// Share of Λ/G_ii in D, fitted: rough surfaces take 122 applications with 0.7, 131 with 0.4, 134
/// with 1, 149 with 1.7.
const CURVATURE: f64 = 0.7;

/// A contact this close to its disc's edge, relative to R, is on it.
const ON_EDGE: f64 = 1e-9;

/// What the energy may rise by round-off, of its size.
const ENERGY_NOISE: f64 = 1e-13;

/// Curvature below which a direction costs no energy, relative to that of single forces: a uniform
/// force on all of a periodic surface. Only the discs end it.
const FLAT: f64 = 1e-12;

/// (S8) for one state of pressure.
pub(super) struct FrictionHalfStep<'a> {
    pub(super) operator: &'a HalfSpace,
    /// Contacts with a disc.
    pub(super) points: &'a Points,
    /// R > 0, in N.
    pub(super) bound: &'a [f64],
    /// c: slip without tangential forces, in metre.
    pub(super) constant: Pair,
    /// Length that residuals are relative to, in N.
    pub(super) scale: f64,
}

/// Tangential forces on the contacts, and the slip that they leave.
#[derive(Clone, Debug)]
pub(super) struct Rubbed {
    /// q, in N.
    pub(super) force: Pair,
    /// w, in metre.
    pub(super) slip: Pair,
    /// Natural map (K1), relative to the scale.
    pub(super) residual: f64,
    energy: f64,
}

/// The tangent space of the discs at a state.
pub(super) struct Tangent {
    /// Unit tangents of slipping contacts, zero elsewhere.
    along: Pair,
    sticks: Vec<bool>,
    /// Λ.
    curvature: Vec<f64>,
    damping: Vec<f64>,
}

impl FrictionHalfStep<'_> {
    /// Newton steps from `force` until the natural map is below `tolerance`.
    pub(super) fn solve(&self, mut force: Pair, tolerance: f64) -> Rubbed {
        self.draw_back(&mut force);
        let product = self.product(&force);
        let mut state = self.measure(force, product);
        for _ in 0..MOST_STEPS {
            if state.residual <= tolerance {
                break;
            }
            let tangent = self.tangent(&state);
            let wanted =
                (0.3 * tolerance / state.residual).clamp(INNER_TOLERANCE[0], INNER_TOLERANCE[1]);
            let mut right = state.slip.clone();
            right
                .iter_mut()
                .flatten()
                .for_each(|entry| *entry = -*entry);
            let (step, product) = self.newton(&tangent, right, wanted);
            let next = self.search(&state, &tangent, &step, &product);
            match next.or_else(|| self.projected_gradient(&state)) {
                Some(next) => state = next,
                None => break,
            }
        }
        state
    }

    pub(super) fn product(&self, force: &Pair) -> Pair {
        self.operator.tangential(force, self.points, self.points)
    }

    /// The state of forces whose `G_TT q` is `product`.
    pub(super) fn measure(&self, force: Pair, product: Pair) -> Rubbed {
        let mut slip = product;
        add_pair(&mut slip, 1.0, &self.constant);
        let step = 1.0 / self.operator.diagonal()[1];
        let defect = sum(self.bound.len(), |at| {
            let (q, w) = (pick(&force, at), pick(&slip, at));
            let trial = [q[0] - step * w[0], q[1] - step * w[1]];
            let length = trial[0].hypot(trial[1]);
            let factor = if length > self.bound[at] {
                self.bound[at] / length
            } else {
                1.0
            };
            let defect = [q[0] - factor * trial[0], q[1] - factor * trial[1]];
            defect[0] * defect[0] + defect[1] * defect[1]
        });
        let energy = 0.5 * (dot_pair(&force, &slip) + dot_pair(&force, &self.constant));
        Rubbed {
            force,
            slip,
            residual: defect.sqrt() / self.scale,
            energy,
        }
    }

    /// Contacts beyond their disc go to its edge.
    fn draw_back(&self, force: &mut Pair) {
        let [x, y] = force;
        for ((x, y), bound) in x.iter_mut().zip(y).zip(self.bound) {
            let length = x.hypot(*y);
            if length > *bound {
                (*x, *y) = (*x * bound / length, *y * bound / length);
            }
        }
    }

    pub(super) fn tangent(&self, state: &Rubbed) -> Tangent {
        let contacts = self.bound.len();
        let mut tangent = Tangent {
            along: zero_pair(contacts),
            sticks: vec![true; contacts],
            curvature: vec![0.0; contacts],
            damping: vec![1.0; contacts],
        };
        let step = 1.0 / self.operator.diagonal()[1];
        for at in 0..contacts {
            let ([q_x, q_y], [w_x, w_y]) = (pick(&state.force, at), pick(&state.slip, at));
            let (length, bound) = (q_x.hypot(q_y), self.bound[at]);
            if length < bound * (1.0 - ON_EDGE) {
                continue;
            }
            let [n_x, n_y] = [q_x / length, q_y / length];
            let multiplier = -(w_x * n_x + w_y * n_y);
            if multiplier < 0.0 {
                continue;
            }
            tangent.sticks[at] = false;
            (tangent.along[0][at], tangent.along[1][at]) = (-n_y, n_x);
            tangent.curvature[at] = multiplier / bound;
            tangent.damping[at] = (1.0 + CURVATURE * step * multiplier / bound).sqrt().recip();
        }
        tangent
    }

    /// Solves (S9) for a right side; gives the step, and `G_TT` times it.
    pub(super) fn newton(&self, tangent: &Tangent, right: Pair, tolerance: f64) -> (Pair, Pair) {
        let contacts = self.bound.len();
        let (mut step, mut product) = (zero_pair(contacts), zero_pair(contacts));
        let mut residual = right;
        tangent.project(&mut residual);
        let enough = tolerance * norm_pair(&residual);
        let (mut direction, mut last) = (zero_pair(contacts), 0.0);
        for _ in 0..MOST_INNER {
            if norm_pair(&residual) <= enough {
                break;
            }
            let pushed = self.precondition(tangent, &residual);
            let now = dot_pair(&residual, &pushed);
            let turn = if last > 0.0 { now / last } else { 0.0 };
            last = now;
            for (direction, pushed) in direction.iter_mut().flatten().zip(pushed.iter().flatten()) {
                *direction = pushed + turn * *direction;
            }
            let of_direction = self.product(&direction);
            let mut image = of_direction.clone();
            tangent.bend(&mut image, &direction);
            let curvature = dot_pair(&direction, &image);
            let size = dot_pair(&direction, &direction);
            let flat = curvature <= FLAT * self.operator.diagonal()[1] * size;
            if !(size > 0.0 && curvature.is_finite()) {
                break;
            }
            let length = match flat {
                true => self.beyond() / (size / contacts as f64).sqrt(),
                false => now / curvature,
            };
            add_pair(&mut step, length, &direction);
            add_pair(&mut product, length, &of_direction);
            add_pair(&mut residual, -length, &image);
            if flat {
                break;
            }
        }
        (step, product)
    }

    /// A length that leaves every disc.
    fn beyond(&self) -> f64 {
        4.0 * self
            .bound
            .iter()
            .fold(0.0_f64, |most, bound| most.max(*bound))
    }

    fn precondition(&self, tangent: &Tangent, residual: &Pair) -> Pair {
        let mut pushed = residual.clone();
        tangent.damp(&mut pushed);
        pushed = self.operator.inverse_tangential(&pushed, self.points);
        tangent.damp(&mut pushed);
        tangent.project(&mut pushed);
        pushed
    }

    /// The longest of some shares of a Newton step, drawn back, that lowers energy or residual.
    fn search(
        &self,
        state: &Rubbed,
        tangent: &Tangent,
        step: &Pair,
        product: &Pair,
    ) -> Option<Rubbed> {
        let mut before = state.slip.clone();
        add_pair(&mut before, -1.0, &self.constant);
        let mut share = 1.0;
        for _ in 0..5 {
            let (mut force, mut image) = (state.force.clone(), before.clone());
            add_pair(&mut force, share, step);
            add_pair(&mut image, share, product);
            let correction = self.onto_discs(tangent, &mut force);
            if correction.iter().flatten().any(|entry| *entry != 0.0) {
                add_pair(&mut image, 1.0, &self.product(&correction));
            }
            let next = self.measure(force, image);
            let noise = ENERGY_NOISE * state.energy.abs();
            if next.energy <= state.energy - noise || next.residual < 0.7 * state.residual {
                return Some(next);
            }
            share *= 0.3;
        }
        None
    }

    /// Slipping contacts back to their circle, others at most to their edge; gives what that changed.
    fn onto_discs(&self, tangent: &Tangent, force: &mut Pair) -> Pair {
        let mut correction = zero_pair(self.bound.len());
        for at in 0..self.bound.len() {
            let [x, y] = pick(force, at);
            let length = x.hypot(y);
            let slips = !tangent.sticks[at] && length > 0.0;
            if slips || length > self.bound[at] {
                let factor = self.bound[at] / length;
                (force[0][at], force[1][at]) = (x * factor, y * factor);
                (correction[0][at], correction[1][at]) = (x * (factor - 1.0), y * (factor - 1.0));
            }
        }
        correction
    }

    fn projected_gradient(&self, state: &Rubbed) -> Option<Rubbed> {
        let mut force = state.force.clone();
        add_pair(&mut force, -1.0 / self.operator.largest()[1], &state.slip);
        self.draw_back(&mut force);
        let product = self.product(&force);
        let next = self.measure(force, product);
        let better = next.energy < state.energy || next.residual < state.residual;
        better.then_some(next)
    }
}

impl Rubbed {
    /// A state of which only forces and slip are known.
    pub(super) fn new(force: Pair, slip: Pair) -> Self {
        Self {
            force,
            slip,
            residual: f64::INFINITY,
            energy: 0.0,
        }
    }
}

impl Tangent {
    /// E: all of sticking contacts, what is along the circle of slipping ones.
    pub(super) fn project(&self, pair: &mut Pair) {
        let [x, y] = pair;
        for at in (0..x.len()).filter(|&at| !self.sticks[at]) {
            let [t_x, t_y] = pick(&self.along, at);
            let along = t_x * x[at] + t_y * y[at];
            (x[at], y[at]) = (along * t_x, along * t_y);
        }
    }

    /// Adds Λ times `direction` and projects.
    fn bend(&self, image: &mut Pair, direction: &Pair) {
        for (image, direction) in image.iter_mut().zip(direction) {
            for ((image, direction), curvature) in
                image.iter_mut().zip(direction).zip(&self.curvature)
            {
                *image += curvature * direction;
            }
        }
        self.project(image);
    }

    fn damp(&self, pair: &mut Pair) {
        for part in pair {
            for (entry, damping) in part.iter_mut().zip(&self.damping) {
                *entry *= damping;
            }
        }
    }
}

pub(super) fn pick(pair: &Pair, at: usize) -> [f64; 2] {
    [pair[0][at], pair[1][at]]
}
