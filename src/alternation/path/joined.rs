//! The last resort between bodies that are held: contacts that each stand alone, and are joined little by little
//! into the problem.
//!
//! ```text
//!        u = û + G_θ s,    G_θ = (1 − θ) C + θ G      C: every contact's own compliance 1/ρ, and nothing between them
//!
//! (D13)  F(s, θ) = 0       the laws (D4)
//!        path              ∂F/∂s ds + ∂F/∂θ dθ = 0,   dθ has the sign of det ∂F/∂s
//! ```
//!
//! At θ = 0 no contact feels another: its state follows from û, and is the only one. A positive definite G bounds
//! all states at every θ alike (½ t · G t + û · t ≤ 0), so that the path which starts there can neither run off nor
//! come back to θ = 0: it ends at θ = 1, in a state of the problem, however much friction there is. On its way θ goes
//! back wherever one θ has several states; the sign of the determinant tells the way on where a contact changes what
//! it does and the path has a corner (Allgower, Georg, Numerical Continuation Methods, Springer 1990, ch. 2).
//!
//! The path is followed by tangents and Newton steps across them. It is left, as lost, after three thousand steps,
//! or after the products of two numbers that a minute has time for, or when the time of the solve is over.

use faer::Col;

use crate::alternation::condition::{Factored, times};
use crate::alternation::laws::{self, Law, Local, roots};
use crate::alternation::settings::Clock;
use crate::problem::ContactProblem;

/// Steps on a path at most, and products of two numbers.
const STEPS: usize = 3000;
const PRODUCTS: f64 = 1e12;

/// First stride along the path, largest one, and the least, which only a corner needs; in units of θ and of the
/// reactions at θ = 0.
const STRIDE: (f64, f64, f64) = (0.05, 0.3, 1e-5);

/// A stride that fails is a third of it the next time.
const SHORTER: f64 = 3.0;

/// So many least strides lead on from a corner.
const ONWARD: f64 = 100.0;

/// Newton steps across the path at most, and how few allow twice the stride.
const ACROSS: (usize, usize) = (8, 3);

/// What counts as on the path, and how far from its tangent a stride may end, as a part of the stride.
const CLOSE: f64 = 1e-11;
const ASIDE: f64 = 0.5;

/// Tangents with a larger cosine between them are one.
const SAME: f64 = 0.9999;

/// θ beyond these ends is not on the way to 1.
const ENDS: (f64, f64) = (-0.1, 1.0);

/// A place on the path, or a direction.
#[derive(Clone, Debug)]
struct Place {
    /// s, scaled: `s/√ρ`.
    reaction: Vec<f64>,
    /// θ.
    part: f64,
}

/// The laws at a place, linear.
struct Piece {
    /// The place, with contacts that are open made to carry nothing.
    at: Place,
    /// Of contacts that are not open.
    laws: Vec<Law>,
    matrix: Factored,
    /// Minus F.
    missing: Col<f64>,
    /// ∂F/∂θ.
    rate: Col<f64>,
}

impl Piece {
    /// Changes of reactions by unknown, of a solution.
    fn spread<'a>(&'a self, solution: &'a Col<f64>) -> impl Iterator<Item = (usize, f64)> + 'a {
        laws::spread(&self.laws, solution.iter().copied())
    }
}

/// A path on its way.
pub(super) struct JoinedPath<'a> {
    problem: &'a ContactProblem,
    /// √ρ per unknown.
    roots: Vec<f64>,
    /// Size of the reactions at θ = 0.
    size: f64,
    place: Place,
    clock: Clock,
    /// Steps so far.
    pub(super) steps: usize,
    products: f64,
}

impl<'a> JoinedPath<'a> {
    /// From contacts that stand alone; none if bodies float, or nothing presses.
    pub(super) fn new(problem: &'a ContactProblem, clock: Clock) -> Option<Self> {
        let mut path = Self {
            problem,
            roots: roots(problem),
            size: 0.0,
            place: Place {
                reaction: vec![0.0; problem.unknowns()],
                part: 0.0,
            },
            clock,
            steps: 0,
            products: 0.0,
        };
        let beyond = path.beyond(&path.place);
        let mut alone = vec![0.0; problem.unknowns()];
        for contact in 0..problem.contacts() {
            let defect = path.local(contact, &path.place, &beyond).defect();
            for (unknown, defect) in problem.block(contact).zip(defect) {
                alone[unknown] = -defect;
            }
        }
        path.place.reaction = alone;
        path.size = norm(&path.place.reaction);
        (problem.floating().is_none() && path.size > 0.0).then_some(path)
    }

    /// The reaction at θ = 1, in newton per unknown; none if the path is lost.
    pub(super) fn follow(&mut self) -> Option<Vec<f64>> {
        let start = self.place.clone();
        let mut along = self.tangent(&start)?;
        let mut stride = STRIDE.0;
        while !self.is_too_far() {
            self.steps += 1;
            let guess = self.ahead(&along, stride);
            let reached = self.across(&guess, &along);
            let reached = reached.filter(|(at, _)| self.distance(at, &guess) <= ASIDE * stride);
            if let Some((at, steps)) = reached {
                if at.part >= 1.0 {
                    // Too far beyond the end to come back to it: a shorter stride is nearer.
                    if let Some(reaction) = self.arrival(&at) {
                        return Some(reaction);
                    }
                } else if let Some(tangent) = self.tangent(&at) {
                    (self.place, along) = (at, tangent);
                    let longer = if steps <= ACROSS.1 { 2.0 } else { 1.0 };
                    stride = (longer * stride).min(STRIDE.1);
                    continue;
                }
            }
            stride /= SHORTER;
            if stride < STRIDE.2 {
                along = self.round_corner(&along)?;
                stride = ONWARD * STRIDE.2;
            }
        }
        None
    }

    fn is_too_far(&self) -> bool {
        let on_the_way = (ENDS.0..=ENDS.1).contains(&self.place.part);
        let spent = self.steps >= STEPS || self.products > PRODUCTS;
        !on_the_way || spent || self.clock.over().is_some()
    }

    /// The tangent beyond a corner: that of the piece just ahead, or, of what just began, that behind.
    fn round_corner(&mut self, along: &Place) -> Option<Place> {
        let least = SHORTER * STRIDE.2;
        let ahead = self.ahead(along, least);
        let tangent = self.tangent(&ahead)?;
        match self.along(&tangent, along) > SAME {
            true => {
                let behind = self.ahead(along, -least);
                self.tangent(&behind)
            }
            false => Some(tangent),
        }
    }

    /// Newton steps from a place to θ = 1, in newton.
    fn arrival(&mut self, at: &Place) -> Option<Vec<f64>> {
        let end = |reaction| Place {
            reaction,
            part: 1.0,
        };
        let guess = end(at.reaction.clone());
        let (found, _) = self.across(&guess, &end(vec![0.0; self.roots.len()]))?;
        let scaled = found.reaction.iter().zip(&self.roots);
        Some(scaled.map(|(s, root)| s * root).collect())
    }

    /// The direction of the path, of unit length.
    fn tangent(&mut self, at: &Place) -> Option<Place> {
        let piece = self.piece(at);
        let rates = piece.matrix.solve(&piece.rate);
        let mut along = Place {
            reaction: vec![0.0; self.roots.len()],
            part: 1.0,
        };
        for (unknown, rate) in piece.spread(&rates) {
            along.reaction[unknown] = -rate;
        }
        let length = (norm(&along.reaction) / self.size).hypot(1.0);
        let way = piece.matrix.sign() / length;
        along.reaction.iter_mut().for_each(|s| *s *= way);
        along.part = way;
        way.is_normal().then_some(along)
    }

    /// Newton steps from a guess onto the path, at right angles to `along`, and their number.
    fn across(&mut self, guess: &Place, along: &Place) -> Option<(Place, usize)> {
        let mut at = guess.clone();
        for steps in 0..=ACROSS.0 {
            if steps > 0 && self.residual(&at) <= CLOSE * self.size {
                return Some((at, steps));
            }
            let piece = self.piece(&at);
            at.clone_from(&piece.at);
            let [found, rates] =
                [&piece.missing, &piece.rate].map(|right| piece.matrix.solve(right));
            let of = |column: &Col<f64>| {
                let changes = piece.spread(column);
                changes.map(|(k, s)| along.reaction[k] * s).sum::<f64>() / self.size.powi(2)
            };
            let aside = self.along(&at, along) - self.along(guess, along);
            let part = -(aside + of(&found)) / (along.part - of(&rates));
            if !part.is_finite() {
                return None;
            }
            at.part += part;
            let change = &found - &rates * faer::Scale(part);
            for (unknown, by) in piece.spread(&change) {
                at.reaction[unknown] += by;
            }
        }
        None
    }

    fn piece(&mut self, from: &Place) -> Piece {
        let mut at = from.clone();
        let beyond = self.beyond(&at);
        let laws: Vec<Law> = (0..self.problem.contacts())
            .filter_map(|contact| {
                let local = self.local(contact, &at, &beyond);
                local.law(contact, self.problem.block(contact))
            })
            .collect();
        let mut kept = laws.iter().flat_map(|law| law.block.clone()).peekable();
        for unknown in 0..at.reaction.len() {
            if kept.next_if_eq(&unknown).is_none() {
                at.reaction[unknown] = 0.0;
            }
        }
        for law in &laws {
            let reaction = self.local(law.contact, &at, &beyond).reaction;
            let change = law.block.clone().zip(law.short_of_bound(reaction));
            change.for_each(|(unknown, by)| at.reaction[unknown] += by);
        }
        let (joined, beyond) = (self.joined(&at), self.beyond(&at));
        let missing = laws::missing(&laws, |contact| self.local(contact, &at, &beyond)).collect();
        let rate = laws::rows(&laws, |k| joined[k] - at.reaction[k]).collect();
        let scaled = (self.problem, &self.roots[..]);
        let matrix = Factored::new(laws::matrix(&laws, scaled, (at.part, 1.0 - at.part), 0));
        self.products += matrix.products() + 2.0 * (self.roots.len() as f64).powi(2);
        Piece {
            at,
            laws,
            matrix,
            missing,
            rate,
        }
    }

    /// `G s`, scaled.
    fn joined(&self, at: &Place) -> Vec<f64> {
        let reaction = Col::from_fn(self.roots.len(), |k| self.roots[k] * at.reaction[k]);
        let moved = times(self.problem.compliance(), &reaction);
        let scaled = moved.iter().zip(&self.roots);
        scaled.map(|(u, root)| u * root).collect()
    }

    /// Displacement beyond the gaps, scaled.
    fn beyond(&self, at: &Place) -> Vec<f64> {
        let joined = self.joined(at);
        let free = self.problem.free_displacement().to_vec();
        let mut beyond = self.problem.beyond(free);
        for (k, w) in beyond.iter_mut().enumerate() {
            let moved = (1.0 - at.part) * at.reaction[k] + at.part * joined[k];
            *w = self.roots[k] * *w + moved;
        }
        beyond
    }

    fn local(&self, contact: usize, at: &Place, beyond: &[f64]) -> Local {
        let block = self.problem.block(contact);
        let mut local = Local {
            reaction: [0.0; 3],
            beyond: [0.0; 3],
            limits: laws::scaled_limits(self.problem, &self.roots, contact),
            step: 1.0,
        };
        for (k, unknown) in block.enumerate() {
            (local.reaction[k], local.beyond[k]) = (at.reaction[unknown], beyond[unknown]);
        }
        local
    }

    /// Size of F.
    fn residual(&self, at: &Place) -> f64 {
        let beyond = self.beyond(at);
        laws::residual(self.problem, |contact| self.local(contact, at, &beyond))
    }

    /// From here along a direction.
    fn ahead(&self, along: &Place, stride: f64) -> Place {
        let pairs = self.place.reaction.iter().zip(&along.reaction);
        Place {
            reaction: pairs.map(|(s, v)| s + stride * v).collect(),
            part: self.place.part + stride * along.part,
        }
    }

    /// How far a place is along a direction; of two directions, the cosine between them.
    fn along(&self, at: &Place, along: &Place) -> f64 {
        let pairs = at.reaction.iter().zip(&along.reaction);
        let reactions: f64 = pairs.map(|(s, v)| s * v).sum();
        reactions / self.size.powi(2) + at.part * along.part
    }

    fn distance(&self, one: &Place, other: &Place) -> f64 {
        let pairs = one.reaction.iter().zip(&other.reaction);
        let apart = pairs.fold(0.0_f64, |sum, (a, b)| sum.hypot(a - b));
        (apart / self.size).hypot(one.part - other.part)
    }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().fold(0.0, |size: f64, x| size.hypot(*x))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::time::Duration;

    use faer::{Mat, mat};

    use super::*;
    use crate::alternation::Settings;
    use crate::problem::Operator;

    /// One contact in the plane.
    fn contact(compliance: Mat<f64>, friction: f64, free: [f64; 2]) -> ContactProblem {
        let operator = Operator::from_compliance(compliance).unwrap();
        ContactProblem::new(&[1], vec![friction], vec![0.0], free.to_vec(), operator).unwrap()
    }

    fn assert_reaches(problem: &ContactProblem, expected: [f64; 2]) {
        let mut path = JoinedPath::new(problem, Clock::endless()).unwrap();
        let found = path.follow().unwrap();
        let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
        assert!(off < 1e-10, "{found:?}");
    }

    #[test]
    fn a_contact_that_slips_alone_slips_when_it_feels_its_friction() {
        // G = [[1, −1], [−1, 2]], û = (0.25, 0.5), μ = ½: u_N = 0.25 + t_N − t_T = 0 with t_T = ½ t_N.
        assert_reaches(
            &contact(mat![[1.0, -1.0], [-1.0, 2.0]], 0.5, [0.25, 0.5]),
            [-0.5, -0.25],
        );
    }

    #[test]
    fn a_path_goes_round_its_corner_where_friction_wedges_a_contact() {
        // μ = 1.5: slip along + needs t_N (1 − μ θ) = −0.1, which has no end before θ = 1; so it turns into stick on
        // the way, and ends in t = −K û = −(2 · 0.1 + 0.5, 0.1 + 0.5).
        assert_reaches(
            &contact(mat![[1.0, -1.0], [-1.0, 2.0]], 1.5, [0.1, 0.5]),
            [-0.7, -0.6],
        );
    }

    #[test]
    fn two_contacts_that_press_each_other_apart_end_with_one_of_them_open() {
        // Smooth, G = [[1, c], [c, 1]], û = (1, ½), c = 0.8: alone (−1, −½); joined, 0.5 − 0.8 < 0 opens the second.
        let operator = Operator::from_compliance(mat![[1.0, 0.8], [0.8, 1.0]]).unwrap();
        let zero = vec![0.0; 2];
        let problem =
            ContactProblem::new(&[0, 0], zero.clone(), zero, vec![1.0, 0.5], operator).unwrap();
        assert_reaches(&problem, [-1.0, 0.0]);
    }

    #[test]
    fn a_path_has_an_end_in_time_and_none_where_nothing_presses() {
        let apart = contact(Mat::identity(2, 2), 0.5, [-1.0, 0.5]);
        assert!(JoinedPath::new(&apart, Clock::endless()).is_none());
        let problem = contact(mat![[1.0, -1.0], [-1.0, 2.0]], 1.5, [0.1, 0.5]);
        let over = Settings {
            time_limit: Some(Duration::ZERO),
            ..Settings::default()
        };
        let mut path = JoinedPath::new(&problem, Clock::start(&over)).unwrap();
        assert!(path.follow().is_none() && path.steps == 0);
        let mut spent = JoinedPath::new(&problem, Clock::endless()).unwrap();
        spent.products = PRODUCTS;
        assert!(spent.follow().is_none() && spent.steps <= 1);
    }
}
