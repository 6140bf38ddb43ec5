//! One sweep: a normal half-step and a friction half-step.

use super::coupled::{Coupled, Held};
use super::friction::FrictionHalfStep;
use super::normal::{NormalHalfStep, Pressed};
use super::outcome::HalfSpaceState;
use super::points::Points;
use super::problem::{Drag, HalfSpaceProblem, Press};
use super::vectors::{Pair, add, dot, norm, norm_pair, total};
use crate::error::Error;

/// A contact this close to the edge of its disc, relative to the radius, is scaled with it.
const ON_EDGE: f64 = 1e-9;

/// Where the outer loop stands.
#[derive(Clone, Debug)]
pub(super) struct Iterate {
    held: Held,
    /// `G_NT q` per cell, in metre.
    raised: Vec<f64>,
}

impl Iterate {
    /// Nothing pressed.
    pub(super) fn new(problem: &HalfSpaceProblem) -> Self {
        let none = vec![0.0; problem.friction.len()];
        let held = Held {
            force: [none.clone(), none.clone(), none.clone()],
            approach: 0.0,
            shift: problem.shift_or([0.0; 2]),
        };
        Self { held, raised: none }
    }

    /// The forces of a coarser grid, spread over the cells of a finer one.
    pub(super) fn refined(&self, coarse: &HalfSpaceProblem, fine: &HalfSpaceProblem) -> Self {
        let (from, to) = (coarse.operator.grid(), fine.operator.grid());
        let (share, within) = (from.len() as f64 / to.len() as f64, to.within(from));
        let spread = |field: &[f64], share: f64| -> Vec<f64> {
            within.iter().map(|&cell| share * field[cell]).collect()
        };
        let force = self.held.force.each_ref();
        Self {
            held: Held {
                force: force.map(|part| spread(part, share)),
                ..self.held
            },
            raised: spread(&self.raised, 1.0),
        }
    }

    /// The iterate of a state given by the user; reactions that pull count as none.
    pub(super) fn near(problem: &HalfSpaceProblem, near: &HalfSpaceState) -> Self {
        let [normal, x, y] = near.reaction.clone();
        let pressing = normal.iter().map(|t_n| (-t_n).max(0.0)).collect();
        let held = Held {
            force: [pressing, x, y],
            approach: near.approach,
            shift: problem.shift_or(near.shift),
        };
        Self::of(problem, held)
    }

    /// The iterate of such forces; without a disc there is no friction.
    pub(super) fn of(problem: &HalfSpaceProblem, mut held: Held) -> Self {
        let (operator, cells) = (&problem.operator, problem.friction.len());
        let [pressing, x, y] = &held.force;
        let contact = problem.discs(pressing);
        let rubbing = [contact.gather(x), contact.gather(y)];
        let raised = operator.normal_of_tangential(&rubbing, &contact, operator.whole());
        for (field, part) in held.force[1..].iter_mut().zip(&rubbing) {
            *field = contact.scatter(part, cells);
        }
        Self { held, raised }
    }

    /// The iterate as Newton's method takes it, with fresh products.
    pub(super) fn coupled(&self, problem: &HalfSpaceProblem) -> Coupled {
        Coupled::new(problem, self.held.clone())
    }

    /// As the user sees it.
    pub(super) fn state(&self) -> HalfSpaceState {
        let [pressing, x, y] = self.held.force.clone();
        HalfSpaceState {
            // Without negative zeros.
            reaction: [pressing.iter().map(|p| 0.0 - p).collect(), x, y],
            approach: self.held.approach,
            shift: self.held.shift,
        }
    }
}

impl HalfSpaceProblem {
    /// The shift that is given, or another.
    fn shift_or(&self, other: [f64; 2]) -> [f64; 2] {
        match self.drag {
            Drag::Shift(shift) => shift,
            Drag::Force(_) => other,
        }
    }

    /// The same problem on a grid half as fine, if there is one.
    pub(super) fn coarser(&self) -> Result<Option<Self>, Error> {
        let Some(operator) = self.operator.coarser() else {
            return Ok(None);
        };
        let (from, to) = (self.operator.grid(), operator.grid());
        let (share, within) = (to.len() as f64 / from.len() as f64, from.within(to));
        let mean = |field: &[f64]| -> Vec<f64> {
            let mut mean = vec![0.0; to.len()];
            for (&cell, value) in within.iter().zip(field) {
                mean[cell] += share * value;
            }
            mean
        };
        let (gap, friction) = (mean(&self.initial_gap), mean(&self.friction));
        let coarse = Self::new(operator.clone(), gap, &friction, self.press)?;
        let reference = self.reference.each_ref().map(|part| mean(part));
        coarse.dragged(self.drag)?.after(reference).map(Some)
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
        let mut pressed = half.solve(iterate.held.force[0].clone(), target);
        let mut of_friction = 0.0;
        if self.has_friction() {
            let raised;
            (of_friction, raised) = self.rub(iterate, &pressed, target);
            let mut gap = pressed.gap;
            add(&mut gap, 1.0, &iterate.raised);
            add(&mut gap, -1.0, &raised);
            for (before, now) in iterate.raised.iter_mut().zip(&raised) {
                *before += share * (now - *before);
            }
            pressed = half.measure(pressed.force, gap, pressed.points);
        }
        iterate.held.force[0] = pressed.force;
        iterate.held.approach = given + pressed.approach;
        pressed.residual.hypot(of_friction)
    }

    /// The friction half-step under new pressing forces; gives its residual, and what it lifts.
    fn rub(&self, iterate: &mut Iterate, pressed: &Pressed, target: f64) -> (f64, Vec<f64>) {
        let (operator, cells) = (&self.operator, self.friction.len());
        let contact = self.discs(&pressed.force);
        if contact.is_empty() {
            iterate.held.force[1..]
                .iter_mut()
                .for_each(|part| part.fill(0.0));
            return (0.0, vec![0.0; cells]);
        }
        let (bound, force) = self.scaled(iterate, &contact, &pressed.force);
        let pressing = pressed.points.gather(&pressed.force);
        let mut constant = operator.tangential_of_normal(&pressing, &pressed.points, &contact);
        let given = self.reference.iter().zip(iterate.held.shift);
        for (part, (reference, shift)) in constant.iter_mut().zip(given) {
            for (entry, &cell) in part.iter_mut().zip(contact.cells()) {
                *entry = -*entry - reference[cell] - shift;
            }
        }
        let mut half = FrictionHalfStep {
            operator,
            points: &contact,
            bound: &bound,
            constant,
            scale: norm(&pressing).hypot(norm_pair(&force)),
        };
        let rubbed = match self.drag {
            Drag::Shift(_) => half.solve(force, target),
            Drag::Force(wanted) => {
                let (rubbed, moved) = half.solve_under(wanted, force, target);
                iterate.held.shift = [0, 1].map(|axis| iterate.held.shift[axis] + moved[axis]);
                rubbed
            }
        };
        let raised = operator.normal_of_tangential(&rubbed.force, &contact, operator.whole());
        for (field, part) in iterate.held.force[1..].iter_mut().zip(&rubbed.force) {
            *field = contact.scatter(part, cells);
        }
        (rubbed.residual, raised)
    }

    /// Cells whose disc has a radius under such pressing forces.
    fn discs(&self, pressing: &[f64]) -> Points {
        Points::select(self.operator.grid(), |cell| {
            self.friction[cell] * pressing[cell] > 0.0
        })
    }

    /// Radii of new contacts, and their tangential forces: slipping ones grow and shrink with the radius.
    fn scaled(&self, iterate: &Iterate, contact: &Points, pressing: &[f64]) -> (Vec<f64>, Pair) {
        let radii = |pressing: &[f64]| -> Vec<f64> {
            let of = |&cell: &usize| self.friction[cell] * pressing[cell];
            contact.cells().iter().map(of).collect()
        };
        let [pressed, x, y] = &iterate.held.force;
        let (before, bound) = (radii(pressed), radii(pressing));
        let mut force = [contact.gather(x), contact.gather(y)];
        for at in 0..bound.len() {
            let length = force[0][at].hypot(force[1][at]);
            if length > 0.0 && length >= before[at] * (1.0 - ON_EDGE) {
                force
                    .iter_mut()
                    .for_each(|part| part[at] *= bound[at] / length);
            }
        }
        (bound, force)
    }

    /// What a given force lacks, relative to what friction can carry, and by how much it exceeds that.
    pub(super) fn missing(&self, iterate: &Iterate) -> [f64; 2] {
        let Drag::Force([x, y]) = self.drag else {
            return [0.0; 2];
        };
        let most = dot(&self.friction, &iterate.held.force[0]);
        let missing = (x - total(&iterate.held.force[1])).hypot(y - total(&iterate.held.force[2]));
        let wanted = x.hypot(y);
        match missing > 0.0 {
            true => [missing / most.max(wanted), (wanted - most) / wanted],
            false => [0.0; 2],
        }
    }
}
