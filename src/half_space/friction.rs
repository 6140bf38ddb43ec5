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
use super::vectors::{Pair, add_pair, dot_pair, largest, norm_pair, scaled, sum, zero_pair};

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
    pub(super) slips: Vec<bool>,
    /// n: out of the discs of slipping contacts, zero where there is none.
    pub(super) outward: Pair,
    /// Λ.
    pub(super) curvature: Vec<f64>,
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
            let tangent = self.tangent(&state.force, &state.slip);
            let wanted =
                (0.3 * tolerance / state.residual).clamp(INNER_TOLERANCE[0], INNER_TOLERANCE[1]);
            let right = state.slip.each_ref().map(|w| scaled(w, -1.0));
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
            let admissible = onto_disc(trial, self.bound[at]);
            (q[0] - admissible[0]).powi(2) + (q[1] - admissible[1]).powi(2)
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
        for (at, bound) in self.bound.iter().enumerate() {
            put(force, at, onto_disc(pick(force, at), *bound));
        }
    }

    /// The tangent space at such forces and slips.
    pub(super) fn tangent(&self, force: &Pair, slip: &Pair) -> Tangent {
        let mut tangent = Tangent::new(self.bound.len());
        let own = self.operator.diagonal()[1];
        for (at, &bound) in self.bound.iter().enumerate() {
            let ([q_x, q_y], [w_x, w_y]) = (pick(force, at), pick(slip, at));
            let length = q_x.hypot(q_y);
            let multiplier = -(w_x * q_x + w_y * q_y) / length;
            if length >= bound * (1.0 - ON_EDGE) && multiplier >= 0.0 {
                tangent.slip(at, [q_x / length, q_y / length], multiplier / bound, own);
            }
        }
        tangent
    }

    /// Solves (S9) for a right side; gives the step, and `G_TT` times it.
    pub(super) fn newton(&self, tangent: &Tangent, right: Pair, tolerance: f64) -> (Pair, Pair) {
        let contacts = self.bound.len();
        let (mut step, mut product) = (zero_pair(contacts), zero_pair(contacts));
        let mut residual = right;
        tangent.project_pair(&mut residual);
        let enough = tolerance * norm_pair(&residual);
        let (mut direction, mut last) = (zero_pair(contacts), 0.0);
        for _ in 0..MOST_INNER {
            if norm_pair(&residual) <= enough {
                break;
            }
            let pushed = tangent.inverse(self.operator, &residual, self.points);
            let now = dot_pair(&residual, &pushed);
            let turn = if last > 0.0 { now / last } else { 0.0 };
            last = now;
            for (direction, pushed) in direction.iter_mut().flatten().zip(pushed.iter().flatten()) {
                *direction = pushed + turn * *direction;
            }
            let of_direction = self.product(&direction);
            let mut image = of_direction.clone();
            let [x, y] = &direction;
            tangent.bend(image.each_mut(), [x, y]);
            tangent.project_pair(&mut image);
            let curvature = dot_pair(&direction, &image);
            let size = dot_pair(&direction, &direction);
            let flat = curvature <= FLAT * self.operator.diagonal()[1] * size;
            if !(size > 0.0 && curvature.is_finite()) {
                break;
            }
            let length = match flat {
                // Out of every disc.
                true => 4.0 * largest(self.bound) / (size / contacts as f64).sqrt(),
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
            let slips = tangent.slips[at] && length > 0.0;
            if slips || length > self.bound[at] {
                let factor = self.bound[at] / length;
                put(force, at, [x * factor, y * factor]);
                put(
                    &mut correction,
                    at,
                    [x * (factor - 1.0), y * (factor - 1.0)],
                );
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

impl Tangent {
    /// All stick.
    pub(super) fn new(contacts: usize) -> Self {
        Self {
            slips: vec![false; contacts],
            outward: zero_pair(contacts),
            curvature: vec![0.0; contacts],
            damping: vec![1.0; contacts],
        }
    }

    /// A contact slips, with Λ and the compliance of its own force.
    pub(super) fn slip(&mut self, at: usize, outward: [f64; 2], curvature: f64, own: f64) {
        self.slips[at] = true;
        put(&mut self.outward, at, outward);
        self.curvature[at] = curvature;
        self.damping[at] = (1.0 + CURVATURE * curvature / own).sqrt().recip();
    }

    /// E: all of sticking contacts, what is along the circle of slipping ones.
    pub(super) fn project(&self, [x, y]: [&mut [f64]; 2]) {
        for at in (0..x.len()).filter(|&at| self.slips[at]) {
            let [n_x, n_y] = pick(&self.outward, at);
            let along = n_x * y[at] - n_y * x[at];
            (x[at], y[at]) = (-along * n_y, along * n_x);
        }
    }

    /// E D S⁻¹ D E.
    pub(super) fn inverse(&self, operator: &HalfSpace, right: &Pair, points: &Points) -> Pair {
        let damped = |part: &Vec<f64>| {
            let pairs = part.iter().zip(&self.damping);
            pairs.map(|(entry, damping)| entry * damping).collect()
        };
        let pair = operator.inverse_tangential(&right.each_ref().map(damped), points);
        let mut pair = pair.each_ref().map(damped);
        self.project_pair(&mut pair);
        pair
    }

    pub(super) fn project_pair(&self, [x, y]: &mut Pair) {
        self.project([x, y]);
    }

    /// Adds Λ times `direction`.
    pub(super) fn bend(&self, image: [&mut Vec<f64>; 2], direction: [&[f64]; 2]) {
        for (image, direction) in image.into_iter().zip(direction) {
            let pairs = image.iter_mut().zip(direction).zip(&self.curvature);
            pairs.for_each(|((image, direction), curvature)| *image += curvature * direction);
        }
    }
}

/// The nearest on a disc.
pub(super) fn onto_disc([x, y]: [f64; 2], radius: f64) -> [f64; 2] {
    let length = x.hypot(y);
    match length > radius {
        true => [x * radius / length, y * radius / length],
        false => [x, y],
    }
}

pub(super) fn pick(pair: &Pair, at: usize) -> [f64; 2] {
    [pair[0][at], pair[1][at]]
}

pub(super) fn put(pair: &mut Pair, at: usize, [x, y]: [f64; 2]) {
    (pair[0][at], pair[1][at]) = (x, y);
}
