//! Where the work of a load step went.
//!
//! ```text
//! (K9)   loads + supports + obstacles + fits = elastic + dissipation + closure
//!
//!        loads       Σ ½ (f⁰ + f) · Δu          f⁰, f: before and after the step
//!        supports    Σ ½ (s⁰ + s) · Δu_p        s: support reactions (K4)
//!        obstacles   Σ ½ (t⁰ + t) · Δd          d: motion of a rigid other side (C14)
//!        fits        Σ ½ (t⁰ + t)_N min(g₀, 0)   of the step that assembles the bodies; g₀ where sides are bonded
//!                    Σ ½ (t⁰ + t)_N Δg₀          of later ones, where a gap is changed
//!        elastic     Δ ½ u · K u + Δ ½ t · C t     C: compliance of the surfaces themselves
//!        dissipation Σ ½ μ (|t_N⁰| + |t_N|) ‖Δu_T‖   over contacts that end pressed; never negative; of other laws
//!                    ½ (s⁰ + s) ‖E⁻¹ Δu_T‖          (L5), over all
//! (K10)  closure     −Σ ½ (t⁰ + t) · Δ(u_N, u_T) + fits − dissipation
//! ```
//!
//! A fit is work that somebody does once: bodies that overlap before loading are forced apart by the first
//! step, as if the other side came in by the overlap; sides that are bonded over a gap are pulled together.
//!
//! Heat and initial stress count as loads, by their nodal forces (B12); `½ u · K u`, which holds the springs of a
//! foundation, then differs from the energy of the stresses by what the loads alone tell.
//!
//! As K is symmetric the trapezoidal rule gives Δ elastic exactly, so the closure is (K10) up to
//! round-off: what the two ends of a step do not tell of the way between them. It vanishes where
//! loads grow in proportion and every contact keeps its state and direction; it is left by
//! contacts that begin to slip, turn, open or close within the step, and falls with its size.

use super::body_state::BodyState;
use super::law::JudgedLaw;
use super::sides::block;
use crate::error::{Error, check_length};
use crate::problem::{ContactProblem, Law};

/// Work and energy of a load step (K9), in joule.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Work of the given forces.
    pub loads: f64,
    /// Work of the moved supports.
    pub supports: f64,
    /// Work of the moved obstacles.
    pub obstacles: f64,
    /// Work of forcing bodies together that overlap before loading.
    pub fits: f64,
    /// Change of the elastic energy.
    pub elastic: f64,
    /// What friction dissipated, never negative.
    pub dissipation: f64,
    /// What the ends of the step leave unexplained.
    pub closure: f64,
}

/// What the ledger needs of the bodies in one state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Account {
    bodies: Vec<BodyAccount>,
    elastic: f64,
}

#[derive(Clone, Debug, PartialEq)]
struct BodyAccount {
    displacement: Vec<f64>,
    load: Vec<f64>,
    /// Zero where free.
    support: Vec<f64>,
}

/// The contacts before and after a step.
#[derive(Clone, Copy, Debug)]
pub struct ContactStep<'a> {
    /// The problem of the step.
    pub problem: &'a ContactProblem,
    /// Reaction before and after, in newton per unknown.
    pub reaction: [&'a [f64]; 2],
    /// The judge's displacement after, from the reference on, in metre per unknown.
    pub displacement: &'a [f64],
    /// Motion of the other side during the step, in metre per unknown.
    pub moved: &'a [f64],
    /// How far a changed gap moves the contact, in metre per contact.
    pub opened: &'a [f64],
    /// The step begins before the bodies are assembled.
    pub assembles: bool,
}

impl Account {
    /// Of bodies in equilibrium.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] or [`Error::UnknownIndex`] if the arrays do not belong together.
    pub fn new(states: &[BodyState<'_>]) -> Result<Self, Error> {
        let mut account = Self::default();
        for state in states {
            state.check()?;
            let contact = state.contact_forces();
            let support = state.held_reactions(&contact);
            // K u is what acts (K4).
            let acting = support.iter().zip(state.load).zip(&contact);
            let acting = acting.map(|((s, f), c)| s + f + c);
            let work = state.displacement.iter().zip(acting);
            account.elastic += work.map(|(u, force)| 0.5 * u * force).sum::<f64>();
            account.bodies.push(BodyAccount {
                displacement: state.displacement.to_vec(),
                load: state.load.to_vec(),
                support,
            });
        }
        Ok(account)
    }

    /// Elastic energy `½ u · K u` of all bodies, in joule.
    #[must_use]
    pub fn elastic(&self) -> f64 {
        self.elastic
    }

    /// The same bodies without load and displacement.
    #[must_use]
    pub fn at_rest(&self) -> Self {
        let bodies = self.bodies.iter().map(|body| {
            let zero = vec![0.0; body.load.len()];
            BodyAccount {
                displacement: zero.clone(),
                load: zero.clone(),
                support: zero,
            }
        });
        Self {
            bodies: bodies.collect(),
            elastic: 0.0,
        }
    }
}

impl Ledger {
    /// (K9) of a step between two states of the bodies.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] if states and contacts do not belong together.
    pub fn new(
        before: &Account,
        after: &Account,
        contacts: &ContactStep<'_>,
    ) -> Result<Self, Error> {
        check_length("bodies", before.bodies.len(), after.bodies.len())?;
        let unknowns = contacts.problem.unknowns();
        for (place, values) in [
            ("reaction before", contacts.reaction[0]),
            ("reaction", contacts.reaction[1]),
            ("displacement", contacts.displacement),
            ("motion of the other side", contacts.moved),
        ] {
            check_length(place, unknowns, values.len())?;
        }
        let opened = contacts.opened.len();
        check_length("changed gaps", contacts.problem.contacts(), opened)?;
        let mut ledger = Self {
            elastic: after.elastic - before.elastic + contacts.layers(),
            ..Self::default()
        };
        for (before, after) in before.bodies.iter().zip(&after.bodies) {
            check_length("load", before.load.len(), after.load.len())?;
            for k in 0..after.load.len() {
                let moved = after.displacement[k] - before.displacement[k];
                ledger.loads += 0.5 * (before.load[k] + after.load[k]) * moved;
                ledger.supports += 0.5 * (before.support[k] + after.support[k]) * moved;
            }
        }
        let means = contacts.reaction[0].iter().zip(contacts.reaction[1]);
        for ((before, after), moved) in means.zip(contacts.moved) {
            ledger.obstacles += 0.5 * (before + after) * moved;
        }
        ledger.fits = contacts.fits();
        ledger.dissipation = contacts.dissipation();
        let work = ledger.loads + ledger.supports + ledger.obstacles + ledger.fits;
        ledger.closure = work - ledger.elastic - ledger.dissipation;
        Ok(ledger)
    }

    /// Both steps together.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let (own, other) = (self.entries(), other.entries());
        Self::from(std::array::from_fn(|k| own[k] + other[k]))
    }

    /// The entries in the order of (K9).
    #[must_use]
    pub fn entries(&self) -> [f64; 7] {
        [
            self.loads,
            self.supports,
            self.obstacles,
            self.fits,
            self.elastic,
            self.dissipation,
            self.closure,
        ]
    }
}

impl From<[f64; 7]> for Ledger {
    fn from(entries: [f64; 7]) -> Self {
        let [
            loads,
            supports,
            obstacles,
            fits,
            elastic,
            dissipation,
            closure,
        ] = entries;
        Self {
            loads,
            supports,
            obstacles,
            fits,
            elastic,
            dissipation,
            closure,
        }
    }
}

impl ContactStep<'_> {
    fn fits(&self) -> f64 {
        let gaps = self.problem.initial_gap().iter().zip(self.opened);
        gaps.enumerate()
            .map(|(i, (gap, opened))| {
                let moved = match self.assembles {
                    true if self.problem.is_bilateral(i) => *gap,
                    true => gap.min(0.0),
                    false => *opened,
                };
                let [before, after] = self.reaction.map(|t| block(self.problem, i, t)[0]);
                0.5 * (before + after) * moved
            })
            .sum()
    }

    /// Change of the energy that the surfaces' own compliance holds, in joule.
    fn layers(&self) -> f64 {
        if self.problem.laws().is_none() {
            return 0.0;
        }
        let [before, after] = self.reaction;
        let layers = self
            .problem
            .layers()
            .into_iter()
            .zip(before.iter().zip(after));
        layers
            .map(|(c, (before, after))| 0.5 * c * (after * after - before * before))
            .sum()
    }

    fn dissipation_under(&self, contact: usize, friction: f64, law: JudgedLaw) -> f64 {
        let radii = self
            .reaction
            .map(|t| law.radius(friction, block(self.problem, contact, t)[0]));
        let slip = &block(self.problem, contact, self.displacement)[1..];
        let along = |k: usize| slip.get(k).copied().unwrap_or(0.0);
        law.dissipation(0.5 * (radii[0] + radii[1]), [along(0), along(1)])
    }

    fn dissipation(&self) -> f64 {
        let friction = self.problem.friction().iter().enumerate();
        let laws = self.problem.laws();
        friction
            .map(|(i, mu)| {
                if let Some(laws) = laws.filter(|laws| laws[i] != Law::default()) {
                    return self.dissipation_under(i, *mu, JudgedLaw::new(Some(&laws[i])));
                }
                let [before, after] = self.reaction.map(|t| block(self.problem, i, t)[0].min(0.0));
                let slip = &block(self.problem, i, self.displacement)[1..];
                let slip = slip.iter().fold(0.0, |size: f64, u| size.hypot(*u));
                match after < 0.0 {
                    true => -0.5 * mu * (before + after) * slip,
                    false => 0.0,
                }
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::problem::Operator;
    use faer::Mat;

    /// One contact with μ = 0.5 that slips by 0.5 m while its obstacle follows it by 0.1 m.
    fn ledger(before: [f64; 2], after: [f64; 2]) -> Ledger {
        let operator = Operator::from_compliance(Mat::identity(2, 2)).unwrap();
        let problem = ContactProblem::new(&[1], vec![0.5], vec![0.0], vec![0.0; 2], operator);
        let none = Account::default();
        let contacts = ContactStep {
            problem: &problem.unwrap(),
            reaction: [&before, &after],
            displacement: &[0.0, 0.5],
            moved: &[0.1, 0.0],
            opened: &[0.0],
            assembles: false,
        };
        Ledger::new(&none, &none, &contacts).unwrap()
    }

    #[test]
    fn the_energy_of_a_fit_is_work_that_assembled_it() {
        // Pressed out of an overlap of 0.2 m by 3 N, G = 1 m/N of which u_N = −0.2 is left.
        let operator = Operator::from_compliance(Mat::identity(1, 1)).unwrap();
        let problem = ContactProblem::new(&[0], vec![0.0], vec![-0.2], vec![0.0], operator);
        let found = |assembles| {
            let none = Account::default();
            let contacts = ContactStep {
                problem: problem.as_ref().unwrap(),
                reaction: [&[0.0], &[-3.0]],
                displacement: &[-0.2],
                moved: &[0.0],
                opened: &[0.0],
                assembles,
            };
            Ledger::new(&none, &none, &contacts).unwrap().fits
        };
        assert!((found(true) - 0.3).abs() < 1e-15);
        assert_eq!(found(false), 0.0);
    }

    #[test]
    fn what_pulls_sides_together_over_a_gap_works_too() {
        // Bonded over 0.2 m with 3 N; without a bond such a gap only lets the sides be.
        let operator = Operator::from_compliance(Mat::identity(1, 1)).unwrap();
        let problem = ContactProblem::new(&[0], vec![0.0], vec![0.2], vec![0.0], operator).unwrap();
        let bonded = Law {
            bilateral: true,
            ..Law::default()
        };
        let bonded = problem.with_laws(vec![bonded]).unwrap();
        for (problem, expected) in [(bonded, 0.3), (problem, 0.0)] {
            let none = Account::default();
            let contacts = ContactStep {
                problem: &problem,
                reaction: [&[0.0], &[3.0]],
                displacement: &[0.2],
                moved: &[0.0],
                opened: &[0.0],
                assembles: true,
            };
            let found = Ledger::new(&none, &none, &contacts).unwrap().fits;
            assert!((found - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn slip_under_a_growing_bound_dissipates_the_mean_of_its_ends() {
        let found = ledger([-2.0, -1.0], [-4.0, -2.0]);
        // ½ (1 + 2) N · 0.5 m; the obstacle presses with −½ (2 + 4) N over 0.1 m.
        assert!((found.dissipation - 0.75).abs() < 1e-15);
        assert!((found.obstacles + 0.3).abs() < 1e-15);
        assert!((found.closure + 0.3 + 0.75).abs() < 1e-15);
    }

    #[test]
    fn a_contact_that_ends_open_moves_freely() {
        assert_eq!(ledger([-2.0, -1.0], [0.0, 0.0]).dissipation, 0.0);
    }

    #[test]
    fn friction_that_turns_within_a_step_gives_nothing_back() {
        // Slid the other way before: 1 N · 0.5 m, though the mean force is zero.
        let found = ledger([-2.0, 1.0], [-2.0, -1.0]);
        assert!((found.dissipation - 0.5).abs() < 1e-15);
    }

    #[test]
    fn two_steps_add_up() {
        let one = ledger([-2.0, -1.0], [-4.0, -2.0]);
        let both = one.plus(&one);
        assert_eq!(both.dissipation, 2.0 * one.dissipation);
        assert_eq!(both.closure, 2.0 * one.closure);
    }
}
