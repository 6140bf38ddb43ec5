//! What one contact does, and what its law says (D4), all scaled: `t/√ρ` and `√ρ (u − g)`.
//!
//! Along the direction d of a slip friction is what its bound says, whatever moves. It is taken out of the equations:
//!
//! ```text
//! (D17)  d · t_T = known − s' t_N:   unknown are t_N, which takes d · t_T along, and t_T across d
//! ```

use std::ops::Range;

use faer::Mat;
use rayon::prelude::*;

use crate::problem::{ContactProblem, Limits};
use crate::processor::add_column;

/// A diagonal entry of G below this part of the largest is round-off.
const NOTHING: f64 = f64::EPSILON;

/// Directions of a contact, normal first.
pub(super) const UNITS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

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

/// (D4) of one contact that is not open: `on_reaction · t + on_displacement · (u − g) = 0`, a row per direction in which
/// its reaction is free (D17).
#[derive(Clone)]
pub(super) struct Law {
    pub(super) contact: usize,
    pub(super) block: Range<usize>,
    free: usize,
    directions: [[f64; 3]; 3],
    on_reaction: [[f64; 3]; 3],
    on_displacement: [[f64; 3]; 3],
    bound: Option<Bound>,
}

/// Friction along a slip (D17).
#[derive(Clone, Copy)]
struct Bound {
    direction: [f64; 2],
    slope: f64,
    known: f64,
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
    /// The law by which its rates go on; none if it opens. `rates` are those of a trial, `growing` what its bound
    /// gains as μ changes.
    pub(super) fn law(
        self,
        rates: &Local,
        growing: f64,
        (contact, block): (usize, Range<usize>),
        pressing: f64,
    ) -> Option<Law> {
        let friction = rates.limits.friction;
        let slope = rates.limits.slope(pressing);
        let trial = [0, 1, 2].map(|k| rates.reaction[k] - rates.beyond[k]);
        let state = match self {
            Self::Touching(_) if trial[0] >= 0.0 => State::OPEN,
            Self::Touching(None) => rates.state(),
            Self::Touching(Some(direction)) => State::slip(direction, 0.0, friction),
            Self::Verge(direction) => {
                let along = direction[0] * trial[1] + direction[1] * trial[2];
                match along + slope * rates.reaction[0] > growing {
                    true => State::slip(direction, 1.0, slope),
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
        let bound = self.limits.bound(t[0]);
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
        let (direction, ratio) = match size > 0.0 {
            true => ([trial[1] / size, trial[2] / size], bound / size),
            false => ([1.0, 0.0], bound),
        };
        let slope = limits.slope(trial[0]);
        State {
            closed,
            tangents: Tangents::Slip {
                direction,
                bound,
                ratio,
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
        let mut law = Law {
            contact,
            free: block.len(),
            block,
            directions: UNITS,
            on_reaction: [[0.0; 3]; 3],
            on_displacement: UNITS,
            bound: None,
        };
        if !state.closed {
            (law.on_reaction[0], law.on_displacement[0]) = (UNITS[0], [0.0; 3]);
        }
        match state.tangents {
            Tangents::Free => return None,
            Tangents::Slip {
                direction: [x, y],
                ratio,
                slope,
                constant,
                ..
            } if law.free > 1 => {
                law.free -= 1;
                law.directions[0] = [1.0, -slope * x, -slope * y];
                law.directions[1] = [0.0, -y, x];
                let across = law.directions[1];
                law.on_reaction[1] = across.map(|e| (1.0 - ratio) * e);
                law.on_displacement[1] = across.map(|e| self.step * ratio * e);
                law.bound = Some(Bound {
                    direction: [x, y],
                    slope,
                    known: constant,
                });
            }
            _ => {}
        }
        Some(law)
    }
}

impl Law {
    /// Directions in which its reaction is free; at right angles.
    pub(super) fn directions(&self) -> &[[f64; 3]] {
        &self.directions[..self.free]
    }

    /// Whether its gap is closed: friction may need no pressure.
    pub(super) fn is_closed(&self) -> bool {
        self.on_displacement[0] != [0.0; 3]
    }

    /// Whether its contact does not move, whatever it carries.
    pub(super) fn sticks(&self) -> bool {
        self.on_reaction == [[0.0; 3]; 3] && self.on_displacement == UNITS && self.bound.is_none()
    }

    /// Its rows, on reactions and on displacements.
    pub(super) fn pairs(&self) -> impl Iterator<Item = ([f64; 3], [f64; 3])> {
        let rows = self.on_reaction.iter().zip(&self.on_displacement);
        rows.take(self.free)
            .map(|(force, motion)| (*force, *motion))
    }

    /// What changes of its reaction are at right angles to.
    pub(super) fn tie(&self) -> Option<[f64; 3]> {
        let bound = self.bound?;
        Some([bound.slope, bound.direction[0], bound.direction[1]])
    }

    /// How much of a change of its reaction is along each direction in which it is free.
    pub(super) fn amounts(&self, change: [f64; 3]) -> impl Iterator<Item = f64> {
        let along =
            move |direction: &[f64; 3]| dot(*direction, change) / dot(*direction, *direction);
        self.directions().iter().map(along)
    }

    /// Its rows for what moves it by so much, and changes its reaction.
    fn rows(&self, moved: [f64; 3], reaction: [f64; 3]) -> impl Iterator<Item = f64> {
        self.pairs()
            .map(move |(force, motion)| dot(force, reaction) + dot(motion, moved))
    }

    /// By what its reaction misses its bound along the slip (D17).
    pub(super) fn short_of_bound(&self, reaction: [f64; 3]) -> [f64; 3] {
        self.bound.map_or([0.0; 3], |bound| {
            let [x, y] = bound.direction;
            let along = x * reaction[1] + y * reaction[2];
            let short = bound.known - bound.slope * reaction[0] - along;
            [0.0, short * x, short * y]
        })
    }

    /// How its reaction changes along the slip as its bound gains so much.
    pub(super) fn grows(&self, by: f64) -> [f64; 3] {
        self.bound.map_or([0.0; 3], |bound| {
            [0.0, by * bound.direction[0], by * bound.direction[1]]
        })
    }

    /// Minus what a state leaves of its rows.
    fn missing(&self, at: Local) -> impl Iterator<Item = f64> {
        self.rows(at.beyond, at.reaction).map(|left| -left)
    }
}

/// What belongs to the unknowns of one contact.
#[inline(always)]
pub(super) fn of_contact(block: &Range<usize>, of: impl Fn(usize) -> f64) -> [f64; 3] {
    let mut own = [0.0; 3];
    let unknowns = own.iter_mut().zip(block.clone());
    unknowns.for_each(|(own, unknown)| *own = of(unknown));
    own
}

/// Rows of all laws for something that moves each unknown by `moved`, scaled.
pub(super) fn rows<'a>(
    laws: &'a [Law],
    moved: impl Fn(usize) -> f64 + 'a,
) -> impl Iterator<Item = f64> + 'a {
    laws.iter()
        .flat_map(move |law| law.rows(of_contact(&law.block, &moved), [0.0; 3]))
}

/// How far something that moves each unknown by `moved`, scaled, moves along each direction in which reactions are free.
pub(super) fn along<'a>(
    laws: &'a [Law],
    moved: impl Fn(usize) -> f64 + 'a,
) -> impl Iterator<Item = f64> + 'a {
    laws.iter().flat_map(move |law| {
        let local = of_contact(&law.block, &moved);
        law.directions()
            .iter()
            .map(move |direction| dot(*direction, local))
    })
}

/// Changes of reactions, scaled, by unknown, of so much along each direction in which they are free.
pub(super) fn spread<'a>(
    laws: &'a [Law],
    amounts: impl Iterator<Item = f64> + 'a,
) -> impl Iterator<Item = (usize, f64)> + 'a {
    let mut amounts = amounts;
    laws.iter().flat_map(move |law| {
        let mut change = [0.0; 3];
        for (direction, amount) in law.directions().iter().zip(&mut amounts) {
            (0..3).for_each(|k| change[k] += amount * direction[k]);
        }
        law.block.clone().zip(change)
    })
}

/// Number of directions in which reactions are free.
pub(super) fn free(laws: &[Law]) -> usize {
    laws.iter().map(|law| law.free).sum()
}

/// The matrix of all laws, with room for `more` rows and columns: a column per direction, for contacts that reactions
/// move by `part` of what G says, and by `softness` on their own.
pub(super) fn matrix(
    laws: &[Law],
    (problem, roots): (&ContactProblem, &[f64]),
    (part, softness): (f64, f64),
    more: usize,
) -> Mat<f64> {
    let size = free(laws) + more;
    let mut matrix = Mat::zeros(size, size);
    let unknowns = each_direction(laws);
    let columns = matrix.as_mut().par_col_iter_mut().zip(&unknowns);
    columns.for_each(|(column, &unknown)| {
        let entries = column_of(laws, (problem, roots), (part, softness), unknown);
        column
            .iter_mut()
            .zip(entries)
            .for_each(|(entry, value)| *entry = value);
    });
    matrix
}

/// Largest column sum of the matrix of all laws.
pub(super) fn largest_sum(laws: &[Law], scaled: (&ContactProblem, &[f64])) -> f64 {
    let unknowns = each_direction(laws);
    let sums = unknowns.par_iter().map(|&unknown| {
        let column = column_of(laws, scaled, (1.0, 0.0), unknown);
        column.map(f64::abs).sum::<f64>()
    });
    sums.reduce(|| 0.0, f64::max)
}

/// The law and the direction of every unknown.
fn each_direction(laws: &[Law]) -> Vec<(&Law, [f64; 3])> {
    let directions = laws.iter().flat_map(|law| {
        let each = law.directions().iter();
        each.map(move |direction| (law, *direction))
    });
    directions.collect()
}

/// What a reaction along one direction does to the rows of all laws.
fn column_of<'a>(
    laws: &'a [Law],
    (problem, roots): (&'a ContactProblem, &'a [f64]),
    (part, softness): (f64, f64),
    (own, direction): (&'a Law, [f64; 3]),
) -> impl Iterator<Item = f64> + 'a {
    let mut moved = vec![0.0; roots.len()];
    for (at, along) in own.block.clone().zip(direction) {
        if along != 0.0 {
            let force = part * roots[at] * along;
            add_column(&mut moved, force, problem.compliance().col_as_slice(at));
        }
    }
    laws.iter().flat_map(move |law| {
        let (mut moved, mut reaction) =
            (of_contact(&law.block, |at| roots[at] * moved[at]), [0.0; 3]);
        if law.contact == own.contact {
            reaction = direction;
            (0..3).for_each(|k| moved[k] += softness * direction[k]);
        }
        law.rows(moved, reaction)
    })
}

/// Minus what a state leaves of all rows.
pub(super) fn missing<'a>(
    laws: &'a [Law],
    local: impl Fn(usize) -> Local + 'a,
) -> impl Iterator<Item = f64> + 'a {
    laws.iter()
        .flat_map(move |law| law.missing(local(law.contact)))
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

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
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
        let law = at(0.0).law(0, 0..3).unwrap();
        let size = |h: f64| {
            let short = law.short_of_bound(at(h).reaction);
            law.missing(at(h))
                .chain(short)
                .fold(0.0_f64, |size, x| size.hypot(x))
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
