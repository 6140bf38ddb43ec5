//! One sweep: a normal half-step and a friction half-step.

use super::coupled::Coupled;
use super::friction::FrictionHalfStep;
use super::normal::{NormalHalfStep, Pressed};
use super::outcome::HalfSpaceState;
use super::points::Points;
use super::problem::{Drag, HalfSpaceProblem, Press};
use super::vectors::{Pair, add, norm, norm_pair, total, zero_pair};
use crate::error::Error;

/// A contact this close to the edge of its disc, relative to the radius, is scaled with it.
const ON_EDGE: f64 = 1e-9;

/// Where the outer loop stands.
#[derive(Clone, Debug)]
pub(super) struct Iterate {
    /// p per cell, in N.
    pressing: Vec<f64>,
    /// `G_NT q` per cell, in metre.
    raised: Vec<f64>,
    /// Contacts with a disc, their q and radius in N, and their slip in metre.
    contact: Points,
    rubbing: Pair,
    bound: Vec<f64>,
    slip: Pair,
    approach: f64,
    shift: [f64; 2],
}

impl Iterate {
    /// Nothing pressed.
    pub(super) fn new(problem: &HalfSpaceProblem) -> Self {
        let cells = problem.friction.len();
        Self {
            pressing: vec![0.0; cells],
            raised: vec![0.0; cells],
            contact: Points::select(problem.operator.grid(), |_| false),
            rubbing: zero_pair(0),
            bound: Vec::new(),
            slip: zero_pair(0),
            approach: 0.0,
            shift: match problem.drag {
                Drag::Shift(shift) => shift,
                Drag::Force(_) => [0.0; 2],
            },
        }
    }

    /// The forces of a coarser grid, spread over the cells of a finer one.
    pub(super) fn refined(&self, coarse: &HalfSpaceProblem, fine: &HalfSpaceProblem) -> Self {
        let (from, to) = (coarse.operator.grid(), fine.operator.grid());
        let ratio = [0, 1].map(|axis| to.cells[axis] / from.cells[axis]);
        let share = 1.0 / (ratio[0] * ratio[1]) as f64;
        let coarse_of = |cell: usize| {
            let [column, row] = [cell % to.cells[0], cell / to.cells[0]];
            column / ratio[0] + from.cells[0] * (row / ratio[1])
        };
        let spread = |field: &[f64], share: f64| -> Vec<f64> {
            (0..to.len())
                .map(|cell| share * field[coarse_of(cell)])
                .collect()
        };
        let of_points = |values: &[f64]| self.contact.scatter(values, from.len());
        let bound = spread(&of_points(&self.bound), share);
        let contact = Points::select(to, |cell| bound[cell] > 0.0);
        let on_contact =
            |values: &Vec<f64>, share| contact.gather(&spread(&of_points(values), share));
        Self {
            pressing: spread(&self.pressing, share),
            raised: spread(&self.raised, 1.0),
            rubbing: [0, 1].map(|axis| on_contact(&self.rubbing[axis], share)),
            slip: [0, 1].map(|axis| on_contact(&self.slip[axis], 1.0)),
            bound: contact.gather(&bound),
            contact,
            approach: self.approach,
            shift: self.shift,
        }
    }

    /// Tangential forces on new contacts: slipping ones grow and shrink with their radius.
    fn scaled(&self, contact: &Points, bound: &[f64]) -> Pair {
        let mut force = [0, 1].map(|axis| contact.carry(&self.contact, &self.rubbing[axis]));
        let before = contact.carry(&self.contact, &self.bound);
        for at in 0..bound.len() {
            let length = force[0][at].hypot(force[1][at]);
            if length > 0.0 && length >= before[at] * (1.0 - ON_EDGE) {
                force
                    .iter_mut()
                    .for_each(|part| part[at] *= bound[at] / length);
            }
        }
        force
    }

    /// The iterate of a state given by the user; reactions that pull count as none.
    pub(super) fn near(problem: &HalfSpaceProblem, near: &HalfSpaceState) -> Self {
        let [normal, x, y] = near.reaction.clone();
        let pressing = normal.iter().map(|t_n| (-t_n).max(0.0)).collect();
        let shift = match problem.drag {
            Drag::Shift(shift) => shift,
            Drag::Force(_) => near.shift,
        };
        let force = [pressing, x, y];
        Self::of(problem, &Coupled::new(problem, force, near.approach, shift))
    }

    /// The iterate as Newton's method takes it, with fresh products.
    pub(super) fn coupled(&self, problem: &HalfSpaceProblem) -> Coupled {
        let cells = problem.friction.len();
        let [x, y] = [0, 1].map(|axis| self.contact.scatter(&self.rubbing[axis], cells));
        Coupled::new(
            problem,
            [self.pressing.clone(), x, y],
            self.approach,
            self.shift,
        )
    }

    /// The iterate of a state that Newton's method left.
    pub(super) fn of(problem: &HalfSpaceProblem, state: &Coupled) -> Self {
        let [pressing, x, y] = &state.force;
        let radius = |cell: usize| problem.friction[cell] * pressing[cell];
        let contact = Points::select(problem.operator.grid(), |cell| radius(cell) > 0.0);
        let rubbing = [contact.gather(x), contact.gather(y)];
        let whole = problem.operator.whole();
        Self {
            pressing: pressing.clone(),
            raised: problem
                .operator
                .normal_of_tangential(&rubbing, &contact, whole),
            bound: contact.cells().iter().map(|&cell| radius(cell)).collect(),
            slip: [0, 1].map(|axis| contact.gather(&state.slip[axis])),
            contact,
            rubbing,
            approach: state.approach,
            shift: state.shift,
        }
    }

    /// As the user sees it.
    pub(super) fn state(&self, problem: &HalfSpaceProblem) -> HalfSpaceState {
        let cells = problem.friction.len();
        let [x, y] = [0, 1].map(|axis| self.contact.scatter(&self.rubbing[axis], cells));
        HalfSpaceState {
            // Without negative zeros.
            reaction: [self.pressing.iter().map(|p| 0.0 - p).collect(), x, y],
            approach: self.approach,
            shift: self.shift,
        }
    }
}

impl HalfSpaceProblem {
    /// The same problem on a grid half as fine, if there is one.
    pub(super) fn coarser(&self) -> Result<Option<Self>, Error> {
        let Some(operator) = self.operator.coarser() else {
            return Ok(None);
        };
        let (from, to) = (self.operator.grid(), operator.grid());
        let ratio = [0, 1].map(|axis| from.cells[axis] / to.cells[axis]);
        let mean = |field: &[f64]| -> Vec<f64> {
            let of = |cell: usize| {
                let [column, row] = [cell % to.cells[0] * ratio[0], cell / to.cells[0] * ratio[1]];
                let parts = (0..ratio[1]).flat_map(|j| (0..ratio[0]).map(move |i| (i, j)));
                let sum: f64 = parts
                    .map(|(i, j)| field[column + i + from.cells[0] * (row + j)])
                    .sum();
                sum / (ratio[0] * ratio[1]) as f64
            };
            (0..to.len()).map(of).collect()
        };
        let coarse = Self::new(
            operator.clone(),
            mean(&self.initial_gap),
            &mean(&self.friction),
            self.press,
        )?;
        let coarse = coarse.dragged(self.drag)?;
        coarse
            .after([0, 1].map(|axis| mean(&self.reference[axis])))
            .map(Some)
    }

    /// Both half-steps; gives the residual of the laws at all contacts.
    /// Only a share of what friction lifts is passed on to the next sweep.
    pub(super) fn sweep(&self, iterate: &mut Iterate, target: f64, share: f64) -> f64 {
        let (given, load) = match self.press {
            Press::Load(load) => (0.0, Some(load)),
            Press::Approach(approach) => (approach, None),
        };
        let mut constant = self.initial_gap.clone();
        constant.iter_mut().for_each(|gap| *gap -= given);
        add(&mut constant, -1.0, &iterate.raised);
        let half = NormalHalfStep {
            operator: &self.operator,
            constant: &constant,
            load,
        };
        let pressed = half.solve(std::mem::take(&mut iterate.pressing), target);
        iterate.approach = given + pressed.approach;
        if !self.has_friction() {
            iterate.pressing = pressed.force;
            return pressed.residual;
        }
        let of_friction = self.rub(iterate, &pressed, target);
        let (contact, whole) = (&iterate.contact, self.operator.whole());
        let raised = self
            .operator
            .normal_of_tangential(&iterate.rubbing, contact, whole);
        let mut gap = pressed.gap;
        add(&mut gap, 1.0, &iterate.raised);
        add(&mut gap, -1.0, &raised);
        for (before, now) in iterate.raised.iter_mut().zip(&raised) {
            *before += share * (now - *before);
        }
        let pressed = half.measure(pressed.force, gap, pressed.points);
        iterate.pressing = pressed.force;
        iterate.approach = given + pressed.approach;
        pressed.residual.hypot(of_friction)
    }

    /// The friction half-step under new pressing forces; gives its residual.
    fn rub(&self, iterate: &mut Iterate, pressed: &Pressed, target: f64) -> f64 {
        let radius = |cell: usize| self.friction[cell] * pressed.force[cell];
        let contact = Points::select(self.operator.grid(), |cell| radius(cell) > 0.0);
        let bound: Vec<f64> = contact.cells().iter().map(|&cell| radius(cell)).collect();
        if contact.is_empty() {
            (iterate.rubbing, iterate.slip) = (zero_pair(0), zero_pair(0));
            (iterate.contact, iterate.bound) = (contact, bound);
            return 0.0;
        }
        let force = iterate.scaled(&contact, &bound);
        let pressing = pressed.points.gather(&pressed.force);
        let mut constant = self
            .operator
            .tangential_of_normal(&pressing, &pressed.points, &contact);
        for (part, reference) in constant.iter_mut().zip(&self.reference) {
            for (entry, &cell) in part.iter_mut().zip(contact.cells()) {
                *entry = -*entry - reference[cell];
            }
        }
        for (part, shift) in constant.iter_mut().zip(iterate.shift) {
            part.iter_mut().for_each(|entry| *entry -= shift);
        }
        let mut half = FrictionHalfStep {
            operator: &self.operator,
            points: &contact,
            bound: &bound,
            constant,
            scale: norm(&pressing).hypot(norm_pair(&force)),
        };
        let rubbed = match self.drag {
            Drag::Shift(_) => half.solve(force, target),
            Drag::Force(wanted) => {
                let (rubbed, moved) = half.solve_under(wanted, force, target);
                iterate.shift = [0, 1].map(|axis| iterate.shift[axis] + moved[axis]);
                rubbed
            }
        };
        (iterate.rubbing, iterate.slip) = (rubbed.force, rubbed.slip);
        (iterate.contact, iterate.bound) = (contact, bound);
        rubbed.residual
    }

    /// What a given force lacks, relative to what friction can carry, and by how much it exceeds that.
    pub(super) fn missing(&self, iterate: &Iterate) -> [f64; 2] {
        let Drag::Force([x, y]) = self.drag else {
            return [0.0; 2];
        };
        let most = total(&iterate.bound);
        let missing = (x - total(&iterate.rubbing[0])).hypot(y - total(&iterate.rubbing[1]));
        let wanted = x.hypot(y);
        match missing > 0.0 {
            true => [missing / most.max(wanted), (wanted - most) / wanted],
            false => [0.0; 2],
        }
    }
}
