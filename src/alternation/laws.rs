//! What one contact does, and what its law says (D4), all scaled: `t/√ρ` and `√ρ (u − g)`.

use std::ops::Range;

use crate::problem::{ContactProblem, Limits};

/// A diagonal entry of G below this part of the largest is round-off.
const NOTHING: f64 = f64::EPSILON;

/// A contact's reaction and its displacement beyond what is free, normal first.
#[derive(Clone, Copy)]
pub(super) struct Local {
    pub(super) reaction: [f64; 3],
    pub(super) beyond: [f64; 3],
    /// Of friction, between scaled reactions.
    pub(super) limits: Limits,
    /// Length of the step to the trial point: 1/(1 + σ).
    pub(super) step: f64,
}

/// What a contact does, read off its trial point.
#[derive(Clone, Copy, Debug, PartialEq)]
struct State {
    /// Its gap is closed; open, it has tangents only where friction needs no pressure.
    closed: bool,
    tangents: Tangents,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Tangents {
    /// No friction is possible without pressure.
    Free,
    Stick,
    Slip {
        direction: [f64; 2],
        bound: f64,
        /// γ, below one.
        ratio: f64,
        /// The bound is `constant − slope t_N`.
        slope: f64,
        constant: f64,
    },
}

/// (D4) of one contact that is not open: `on_reaction · t + on_displacement · (u − g) = known`, a row per unknown.
#[derive(Clone)]
pub(super) struct Law {
    pub(super) contact: usize,
    pub(super) block: Range<usize>,
    on_reaction: [[f64; 3]; 3],
    on_displacement: [[f64; 3]; 3],
    known: [f64; 3],
    /// What more of μ asks for.
    on_friction: [f64; 3],
}

/// A contact that may do one thing or another next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Edge {
    /// Neither pressed nor apart; with the direction of the friction that it would have, if it slides.
    Touching(Option<[f64; 2]>),
    /// Friction along this direction is all that its bound allows, and nothing slides.
    Verge([f64; 2]),
}

impl Edge {
    /// The law by which its rates go on; none if it opens. `rates` are those of a trial, `shrinking` what its bound
    /// loses as μ changes.
    pub(super) fn law(
        self,
        rates: &Local,
        shrinking: f64,
        (contact, block): (usize, Range<usize>),
        pressing: f64,
    ) -> Option<Law> {
        let friction = rates.limits.friction;
        let trial = [0, 1, 2].map(|k| rates.reaction[k] - rates.beyond[k]);
        let state = match self {
            Self::Touching(_) if trial[0] >= 0.0 => State::OPEN,
            Self::Touching(None) => rates.state(),
            Self::Touching(Some(direction)) => State::slip(direction, 0.0, friction),
            Self::Verge(direction) => {
                let along = direction[0] * trial[1] + direction[1] * trial[2];
                match along + friction * rates.reaction[0] + shrinking > 0.0 {
                    true => State::slip(direction, 1.0, friction),
                    false => State::STICK,
                }
            }
        };
        let pressed = Local {
            reaction: [pressing, 0.0, 0.0],
            ..*rates
        };
        pressed.law_of(state, contact, block)
    }
}

impl State {
    const OPEN: Self = Self {
        closed: false,
        tangents: Tangents::Free,
    };
    const STICK: Self = Self {
        closed: true,
        tangents: Tangents::Stick,
    };

    /// Slip where the bound is not asked for.
    fn slip(direction: [f64; 2], ratio: f64, friction: f64) -> Self {
        let tangents = Tangents::Slip {
            direction,
            bound: 0.0,
            ratio,
            slope: friction,
            constant: 0.0,
        };
        Self {
            closed: true,
            tangents,
        }
    }
}

impl Local {
    /// The edge on which the contact is, within a `tolerance` for what it carries and where it is.
    pub(super) fn edge(&self, tolerance: f64) -> Option<Edge> {
        let small = |x: f64| x.abs() <= tolerance;
        let (t, w) = (self.reaction, self.beyond);
        let (friction, slip) = (t[1].hypot(t[2]), w[1].hypot(w[2]));
        if small(t[0]) && small(w[0]) {
            let slides = slip > tolerance;
            return Some(Edge::Touching(slides.then(|| [-w[1] / slip, -w[2] / slip])));
        }
        let bound = -self.limits.friction * t[0];
        let verge = bound > tolerance && small(friction - bound) && small(slip);
        verge.then(|| Edge::Verge([t[1] / friction, t[2] / friction]))
    }

    fn state(&self) -> State {
        let trial = [0, 1, 2].map(|k| self.reaction[k] - self.step * self.beyond[k]);
        let limits = &self.limits;
        let closed = limits.bilateral || trial[0] < 0.0;
        let (size, bound) = (trial[1].hypot(trial[2]), limits.bound(trial[0]));
        if !closed && bound == 0.0 {
            return State {
                closed,
                tangents: Tangents::Free,
            };
        }
        let rough = limits.friction > 0.0 || limits.shear > 0.0;
        if rough && size <= bound {
            return State {
                closed,
                tangents: Tangents::Stick,
            };
        }
        let size = if size > 0.0 { size } else { 1.0 };
        let slope = limits.slope(trial[0]);
        State {
            closed,
            tangents: Tangents::Slip {
                direction: [trial[1] / size, trial[2] / size],
                bound,
                ratio: bound / size,
                slope,
                constant: bound + slope * trial[0],
            },
        }
    }

    /// What the natural map leaves, per unknown, as roots of an energy.
    pub(super) fn defect(&self) -> [f64; 3] {
        let (t, w) = (self.reaction, self.beyond.map(|w| self.step * w));
        let state = self.state();
        let normal = if state.closed { w[0] } else { t[0] };
        let left = match state.tangents {
            Tangents::Free => t,
            Tangents::Stick => [normal, w[1], w[2]],
            Tangents::Slip {
                direction, bound, ..
            } => [
                normal,
                t[1] - bound * direction[0],
                t[2] - bound * direction[1],
            ],
        };
        left.map(|left| left / self.step.sqrt())
    }

    /// The law of what a contact does; none if it is open.
    pub(super) fn law(&self, contact: usize, block: Range<usize>) -> Option<Law> {
        self.law_of(self.state(), contact, block)
    }

    fn law_of(&self, state: State, contact: usize, block: Range<usize>) -> Option<Law> {
        let mut on_friction = [0.0; 3];
        let (mut on_reaction, mut on_displacement) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
        let mut known = [0.0; 3];
        match state.closed {
            true => on_displacement[0][0] = 1.0,
            false => on_reaction[0][0] = 1.0,
        }
        match state.tangents {
            Tangents::Free => return None,
            Tangents::Stick => (on_displacement[1][1], on_displacement[2][2]) = (1.0, 1.0),
            Tangents::Slip {
                direction,
                ratio,
                slope,
                constant,
                ..
            } => {
                on_friction = [0, 1, 2].map(|k| match k {
                    0 => 0.0,
                    k => direction[k - 1] * self.reaction[0],
                });
                for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let unit = if a == b { 1.0 } else { 0.0 };
                    let m = ratio * (unit - direction[a] * direction[b]);
                    on_reaction[1 + a][0] = slope * direction[a];
                    on_reaction[1 + a][1 + b] = unit - m;
                    on_displacement[1 + a][1 + b] = self.step * m;
                    known[1 + a] = constant * direction[a];
                }
            }
        }
        Some(Law {
            contact,
            block,
            on_reaction,
            on_displacement,
            known,
            on_friction,
        })
    }
}

impl Law {
    /// Minus what a state leaves of the law.
    pub(super) fn missing(&self, at: &Local) -> [f64; 3] {
        [0, 1, 2].map(|row| {
            let forces = dot(self.on_reaction[row], at.reaction);
            self.known[row] - forces - dot(self.on_displacement[row], at.beyond)
        })
    }

    /// Minus what displacements and friction that change ask of its rows.
    pub(super) fn asked(&self, moved: [f64; 3], friction: f64) -> [f64; 3] {
        [0, 1, 2]
            .map(|row| -dot(self.on_displacement[row], moved) - friction * self.on_friction[row])
    }

    /// Its rows for a unit of something that moves the contact, and that may be one of its own reactions.
    pub(super) fn rows(&self, moved: [f64; 3], own: Option<usize>) -> [f64; 3] {
        [0, 1, 2].map(|row| {
            let force = own.map_or(0.0, |own| self.on_reaction[row][own]);
            force + dot(self.on_displacement[row], moved)
        })
    }
}

/// Rows of all laws for something that moves each unknown by `moved`, scaled, and that may be the own reaction of one,
/// which moves it by so much more.
pub(super) fn rows<'a>(
    laws: &'a [Law],
    moved: impl Fn(usize) -> f64 + 'a,
    own: Option<(usize, f64)>,
) -> impl Iterator<Item = f64> + 'a {
    laws.iter().flat_map(move |law| {
        let (mut local, mut place) = ([0.0; 3], None);
        for (at, unknown) in law.block.clone().enumerate() {
            local[at] = moved(unknown);
            if let Some((_, more)) = own.filter(|(own, _)| *own == unknown) {
                local[at] += more;
                place = Some(at);
            }
        }
        law.rows(local, place).into_iter().take(law.block.len())
    })
}

/// Minus what a state leaves of all laws.
pub(super) fn missing<'a>(
    laws: &'a [Law],
    local: impl Fn(usize) -> Local + 'a,
) -> impl Iterator<Item = f64> + 'a {
    laws.iter().flat_map(move |law| {
        let missing = law.missing(&local(law.contact)).into_iter();
        missing.take(law.block.len())
    })
}

/// What the natural map leaves of all contacts, as the root of an energy.
pub(super) fn residual(problem: &ContactProblem, local: impl Fn(usize) -> Local) -> f64 {
    problem
        .blocks()
        .enumerate()
        .fold(0.0, |sum, (contact, block)| {
            let defect = local(contact).defect().into_iter();
            defect.take(block.len()).fold(sum, f64::hypot)
        })
}

/// What bounds a contact's friction, between reactions scaled by the roots.
pub(super) fn scaled_limits(problem: &ContactProblem, roots: &[f64], contact: usize) -> Limits {
    let limits = problem.limits(contact);
    match roots[problem.block(contact)] {
        [normal, tangential, ..] => Limits {
            friction: limits.friction * normal / tangential,
            shear: limits.shear / tangential,
            cap: limits.cap / tangential,
            ..limits
        },
        _ => Limits {
            bilateral: limits.bilateral,
            ..Limits::coulomb(0.0)
        },
    }
}

/// √ρ: the root of a contact's own stiffness along its normal, and over its tangents; a contact that its own reaction
/// does not move takes the largest.
pub(super) fn roots(problem: &ContactProblem) -> Vec<f64> {
    let g = problem.compliance();
    let largest = (0..problem.unknowns()).fold(0.0_f64, |most, k| most.max(g[(k, k)]));
    let mut roots = Vec::with_capacity(problem.unknowns());
    for ends in problem.offsets().windows(2) {
        let tangents = ends[0] + 1..ends[1];
        let trace: f64 = tangents.clone().map(|k| g[(k, k)]).sum();
        roots.push(g[(ends[0], ends[0])]);
        roots.extend(tangents.clone().map(|_| trace / tangents.len() as f64));
    }
    let felt = roots.iter().copied().filter(|c| *c > NOTHING * largest);
    let least = felt.reduce(f64::min).unwrap_or(1.0);
    for root in &mut roots {
        let compliance = if *root > NOTHING * largest {
            *root
        } else {
            least
        };
        *root = compliance.sqrt().recip();
    }
    roots
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With μ = ½ between scaled numbers, without springs.
    fn local(reaction: [f64; 3], beyond: [f64; 3]) -> Local {
        Local {
            reaction,
            beyond,
            limits: Limits::coulomb(0.5),
            step: 1.0,
        }
    }

    #[test]
    fn a_trial_point_tells_what_a_contact_does_and_what_it_misses() {
        // p_N = −1 + 2 > 0: open, and 1 is pressed for nothing.
        let open = local([-1.0, 0.0, 0.0], [-2.0, 0.0, 0.0]);
        assert!(open.law(0, 0..3).is_none());
        assert_eq!(open.defect(), [-1.0, 0.0, 0.0]);
        // p = (−4, 1, 0) is in its disc of 2: overlap and slip are what is wrong.
        let stick = local([-3.0, 1.5, 0.0], [1.0, 0.5, 0.0]);
        assert_eq!(stick.defect(), [1.0, 0.5, 0.0]);
        // p_T = (3, 4) on a disc of 2: friction should be (1.2, 1.6).
        let slip = local([-4.0, 3.0, 3.0], [0.0, 0.0, -1.0]);
        let left = slip.defect();
        assert!((left[1] - 1.8).abs() < 1e-15 && (left[2] - 1.4).abs() < 1e-15);
    }

    #[test]
    fn the_law_of_slip_is_kept_by_a_solution_and_by_its_neighbours_to_first_order() {
        // t = (−4, 1.2, 1.6) slips by (−1.8, −2.4): p_T = (3, 4). Pressed by 2 h more it rubs by h more; it
        // slips by 5 h more, along a direction turned by h.
        let at = |h: f64| {
            let (sin, cos) = h.sin_cos();
            let d = [0.6 * cos - 0.8 * sin, 0.8 * cos + 0.6 * sin];
            let (t, u) = (2.0 + h, 3.0 + 5.0 * h);
            let reaction = [-4.0 - 2.0 * h, t * d[0], t * d[1]];
            local(reaction, [0.0, -u * d[0], -u * d[1]])
        };
        let law = at(0.0).law(0, 0..3);
        let size = |h: f64| {
            let missing = law
                .as_ref()
                .map_or([f64::NAN; 3], |law| law.missing(&at(h)));
            missing.iter().fold(0.0_f64, |size, x| size.hypot(*x))
        };
        assert!(size(0.0) < 1e-14);
        // Second order: a tenth of the step misses a hundredth.
        let (far, near) = (size(1e-3), size(1e-4));
        assert!(
            far < 1e-4 && (far / near - 100.0).abs() < 2.0,
            "{far:e} {near:e}"
        );
    }
}
