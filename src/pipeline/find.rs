//! The value of a parameter at which a total is what was measured.

use super::Solution;
use super::cases::Stated;
use super::quantities::Variation;
use super::total::Total;
use crate::alternation::{Outcome, Status};
use crate::error::{Error, check_finite};
use crate::report::Found;
use crate::scene::Scene;

/// The total is met to this part of the largest that was seen.
const MET: f64 = 1e-10;

/// A total that changes by more than this part of the largest between two parameters that can hardly be told
/// apart jumps.
const JUMP: f64 = 1e-6;

/// Pieces of the range in which a change of sign is looked for.
const PIECES: usize = 8;

/// Most states between the ends of a piece; halving alone takes fifty.
const STATES: usize = 100;

/// What is looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    /// Quantity that varies, named as in [`Variation`].
    pub parameter: String,
    /// Its least and largest value.
    pub between: [f64; 2],
    /// Column of the table of [`cases`](super::cases()), or a displacement such as `u_x@0.5,0`.
    pub total: String,
    /// What it should be.
    pub target: f64,
}

/// Finds the value of a parameter at which a total has a given value, by Newton's method inside a bracket, on one
/// factorisation; the state there is solved and certified like any other.
///
/// ```
/// use dpana::{Scene, Search, find};
///
/// # fn main() -> Result<(), dpana::Error> {
/// let scene = r#"{
///     "bodies": [{ "mesh": { "rectangle": { "x": [0, 2], "y": [0, 1], "cells": [8, 4] } },
///                  "model": "plane_strain",
///                  "materials": [{ "young": 1000, "poisson": 0 }],
///                  "supports": [{ "group": "top", "displacement": [0.5, -0.01] }] }],
///     "contacts": [{ "group": "bottom", "friction": 0.25,
///                    "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }] }"#;
/// // Which friction pulls with 4 N? It slides all over: μ N, N being 20 N and a little.
/// let search = Search { parameter: "friction".to_owned(), between: [0.0, 1.0],
///                       total: "friction_x".to_owned(), target: -4.0 };
/// let (found, solution) = find(&Scene::from_json(scene, "")?, &search)?;
/// let totals = solution.report()?.totals;
/// assert!((found.value * totals.normal - 4.0).abs() < 1e-8);
/// # Ok(())
/// # }
/// ```
///
/// Of several such values it finds one.
///
/// # Errors
///
/// Those of [`cases`](super::cases()); [`Error::OutOfReach`] with the range of totals seen,
/// [`Error::Jumps`], and a state on the way that is not certified.
pub fn find(scene: &Scene, search: &Search) -> Result<(Found, Solution), Error> {
    let at_scene = |error| scene.locate(error);
    let [from, to] = search.between;
    check_finite("between", &search.between).map_err(at_scene)?;
    check_finite("target", &[search.target]).map_err(at_scene)?;
    if from >= to {
        return Err(at_scene(Error::NotAccepted {
            place: "between".to_owned(),
            found: format!("{from} to {to}"),
            accepted: "a smaller value, then a larger one".to_owned(),
        }));
    }
    let varied = Variation {
        name: search.parameter.clone(),
        values: vec![from, to],
    };
    let mut hunt = Hunt {
        stated: Stated::new(scene, &[varied])?,
        total: Total::parse(&search.total).map_err(at_scene)?,
        search,
        near: None,
        seen: [f64::INFINITY, f64::NEG_INFINITY],
        states: 0,
    };
    hunt.run().map_err(at_scene)
}

/// States so far.
struct Hunt<'a> {
    stated: Stated,
    total: Total,
    search: &'a Search,
    near: Option<Outcome>,
    seen: [f64; 2],
    states: usize,
}

/// A state at a value of the parameter.
struct At {
    value: f64,
    /// Total minus target.
    off: f64,
    solution: Solution,
}

impl Hunt<'_> {
    fn run(&mut self) -> Result<(Found, Solution), Error> {
        let [from, to] = self.search.between;
        let mut low = self.at(from)?;
        if low.off == 0.0 {
            return self.found(low);
        }
        // The ends first: totals are mostly monotone.
        let mut high = self.at(to)?;
        for piece in 1..PIECES {
            if low.off * high.off <= 0.0 {
                break;
            }
            let next = self.at(from + (to - from) * piece as f64 / PIECES as f64)?;
            match low.off * next.off <= 0.0 {
                true => high = next,
                false => low = next,
            }
        }
        if low.off * high.off > 0.0 {
            let [lowest, highest] = self.seen;
            return Err(Error::OutOfReach {
                place: self.place(),
                from,
                to,
                target: self.search.target,
                lowest,
                highest,
            });
        }
        self.within(low, high)
    }

    /// Newton's method, kept between two totals of opposite sign.
    fn within(&mut self, mut low: At, mut high: At) -> Result<(Found, Solution), Error> {
        for _ in 0..STATES {
            let nearer = if low.off.abs() < high.off.abs() {
                &low
            } else {
                &high
            };
            if nearer.off.abs() <= MET * self.largest() {
                let nearer = if low.off.abs() < high.off.abs() {
                    low
                } else {
                    high
                };
                return self.found(nearer);
            }
            let width = high.value - low.value;
            if width <= 4.0 * f64::EPSILON * low.value.abs().max(high.value.abs()) {
                break;
            }
            let (before, from) = (nearer.off.abs(), nearer.value);
            let step = self.slope(nearer)?;
            let step = step.map(|slope| from - nearer.off / slope);
            let inside = |value: &f64| *value > low.value && *value < high.value;
            let middle = low.value + 0.5 * width;
            let next = self.at(step.filter(inside).unwrap_or(middle))?;
            let settles = next.off.abs() <= 0.5 * before;
            self.narrow(&mut low, &mut high, next);
            // A step that gains little and leaves most of the bracket is followed by its middle.
            if !settles && high.value - low.value > 0.5 * width {
                let next = self.at(low.value + 0.5 * (high.value - low.value))?;
                self.narrow(&mut low, &mut high, next);
            }
        }
        if (high.off - low.off).abs() > JUMP * self.largest() {
            return Err(Error::Jumps {
                place: self.place(),
                at: low.value,
                below: low.off + self.search.target,
                above: high.off + self.search.target,
                target: self.search.target,
            });
        }
        self.found(if low.off.abs() < high.off.abs() {
            low
        } else {
            high
        })
    }

    fn narrow(&self, low: &mut At, high: &mut At, next: At) {
        match low.off * next.off <= 0.0 {
            true => *high = next,
            false => *low = next,
        }
    }

    fn largest(&self) -> f64 {
        self.seen[0].abs().max(self.seen[1].abs())
    }

    fn place(&self) -> String {
        format!("{}, {}", self.search.parameter, self.search.total)
    }

    /// Solves at a value.
    fn at(&mut self, value: f64) -> Result<At, Error> {
        let solution = self.stated.solved(&[value], self.near.as_ref())?;
        if solution.status() != Status::Certified {
            return Err(Error::NotAccepted {
                place: format!("{} = {value}", self.search.parameter),
                found: "a state without certificate".to_owned(),
                accepted: "a range in which every state is certified; `dpana cases` shows where"
                    .to_owned(),
            });
        }
        let total = self.total.value(&solution)?;
        self.near = Some(solution.outcome.clone());
        self.seen = [self.seen[0].min(total), self.seen[1].max(total)];
        self.states += 1;
        Ok(At {
            value,
            off: total - self.search.target,
            solution,
        })
    }

    /// Derivative of the total; none where it has none.
    fn slope(&self, at: &At) -> Result<Option<f64>, Error> {
        let slope = self.total.rate(&at.solution, &self.search.parameter)?;
        Ok(slope.filter(|slope| slope.is_finite() && *slope != 0.0))
    }

    fn found(&self, at: At) -> Result<(Found, Solution), Error> {
        let found = Found {
            parameter: self.search.parameter.clone(),
            value: at.value,
            total: self.search.total.clone(),
            target: self.search.target,
            reached: at.off + self.search.target,
            derivative: self.slope(&at)?,
            states: self.states,
        };
        Ok((found, at.solution))
    }
}
