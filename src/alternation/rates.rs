//! How a solved state changes with what drives it: the derivative of reactions and motions.
//!
//! ```text
//!        open     ṫ = 0
//! (D16)  stick    u̇_N = ġ₀,  u̇_T = 0
//!        slip     u̇_N = ġ₀,  (1 − M) ṫ_T − d ṡ + ρ M u̇_T = 0       d, M of (D4), s(t_N, μ) of (L5)
//!        u̇ = û̇ + (Gt)˙ + G ṫ + R α̇,      Rᵀ ṫ + ė = 0
//! ```
//!
//! The matrix is that of a Newton step (D4): one factorisation serves every parameter, with a substitution for
//! each. A contact on the edge of what it does (touching without a force, or sliding not yet at its bound) goes
//! on in one way as a parameter grows and in another as it falls: its rates obey laws of contact
//! themselves, and there are two derivatives (Klatte, Kummer, Nonsmooth equations in optimization, 2002; for the
//! stability of quasi-variational inequalities of friction see Outrata, Kočvara, Zowe, 1998).

use faer::Col;

use super::Outcome;
use super::centred::Centred;
use super::condition::Factored;
use super::finish::{Finish, Point, Springs};
use super::laws::{self, Edge, Law, Local};
use crate::error::{Error, check_finite, check_length};
use crate::problem::ContactProblem;

/// A contact is on an edge within this part of the largest reaction, in roots of an energy.
const ON_EDGE: f64 = 1e-9;

/// Rates of contacts on an edge have settled when a step changes them by this part.
const SETTLED: f64 = 1e-11;

/// Most steps to settle them.
const STEPS: usize = 50;

/// What changes with a parameter, per unit of it, before contacts answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Of the displacement beyond the gaps, reactions held: `û̇ + (Gt)˙`, minus `ġ₀` along normals, per unknown.
    pub beyond: Vec<f64>,
    /// Of the coefficient, per contact.
    pub friction: Vec<f64>,
    /// Of the load on every free mode.
    pub load: Vec<f64>,
}

impl Drive {
    /// Nothing.
    #[must_use]
    pub fn none(problem: &ContactProblem) -> Self {
        Self {
            beyond: vec![0.0; problem.unknowns()],
            friction: vec![0.0; problem.contacts()],
            load: vec![0.0; problem.free_modes()],
        }
    }

    fn reversed(&self) -> Self {
        let minus = |values: &[f64]| values.iter().map(|value| -value).collect();
        Self {
            beyond: minus(&self.beyond),
            friction: minus(&self.friction),
            load: minus(&self.load),
        }
    }
}

/// Derivative of a state, per unit of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Rate {
    /// Of the reaction, per unknown.
    pub reaction: Vec<f64>,
    /// Of the displacement beyond the gaps `u − g₀`, per unknown.
    pub beyond: Vec<f64>,
    /// Of the amplitude of every free mode.
    pub motion: Vec<f64>,
}

/// Derivatives on both sides of a parameter's value.
#[derive(Clone, Debug, PartialEq)]
pub struct Sides<T> {
    /// As the parameter grows.
    pub growing: T,
    /// As it falls, where that is another one.
    pub falling: Option<T>,
}

impl<T> Sides<T> {
    /// The same of what is made of both.
    pub fn map<U>(self, make: impl Fn(T) -> U) -> Sides<U> {
        Sides {
            growing: make(self.growing),
            falling: self.falling.map(make),
        }
    }
}

/// The laws of a solved state, linear around it (D16), as those of the problem that is solved in its place (D15).
pub struct Linearised<'a> {
    centred: &'a Centred<'a>,
    problem: &'a ContactProblem,
    finish: Finish<'a>,
    contacts: Vec<Linear>,
    /// None while contacts are on an edge.
    system: Option<System>,
    factorisations: usize,
}

/// One contact near its state.
struct Linear {
    law: Option<Law>,
    /// Normal reaction, scaled.
    pressing: f64,
    /// What the bound of its friction gains per unit of μ, scaled.
    per_friction: f64,
    edge: Option<Edge>,
}

/// The laws of contacts that are not open, factorised.
struct System {
    laws: Vec<Law>,
    matrix: Factored,
}

impl<'a> Linearised<'a> {
    /// Around a certified outcome of the problem; none where the rigid motions have no basis.
    ///
    /// # Errors
    ///
    /// An outcome that is not of the problem's length.
    pub fn new(centred: &'a Centred<'a>, outcome: &Outcome) -> Result<Option<Self>, Error> {
        let (reaction, beyond) = (&outcome.reaction, &outcome.verdict.beyond);
        let problem = centred.solved();
        check_length("reaction", problem.unknowns(), reaction.len())?;
        check_length("displacement", problem.unknowns(), beyond.len())?;
        let stated = reaction;
        let reaction = &centred.reaction(stated);
        let beyond = &centred.displacement(beyond);
        let Some(finish) = Finish::new(problem) else {
            return Ok(None);
        };
        let at = |contact| local(&finish, contact, reaction, beyond);
        let largest = (0..problem.contacts()).fold(0.0, |most: f64, contact| {
            let local = at(contact);
            local
                .reaction
                .iter()
                .fold(most, |most, t| most.max(t.abs()))
        });
        let contacts = (0..problem.contacts()).map(|contact| {
            let local = at(contact);
            Linear {
                law: local.law(contact, problem.block(contact)),
                pressing: local.reaction[0],
                per_friction: per_friction(centred.stated(), contact, stated)
                    / finish.tangential_root(contact),
                edge: local.edge(ON_EDGE * largest),
            }
        });
        let contacts: Vec<Linear> = contacts.collect();
        let mut linearised = Self {
            centred,
            problem,
            finish,
            contacts,
            system: None,
            factorisations: 0,
        };
        if linearised.edges() == 0 {
            let laws = linearised.contacts.iter().filter_map(|c| c.law.clone());
            linearised.system = Some(linearised.factorised(laws.collect()));
            linearised.factorisations = 1;
        }
        Ok(Some(linearised))
    }

    /// Number of contacts on the edge of what they do.
    #[must_use]
    pub fn edges(&self) -> usize {
        let edges = self
            .contacts
            .iter()
            .filter(|contact| contact.edge.is_some());
        edges.count()
    }

    /// Matrices factorised so far: one, unless contacts are on an edge.
    #[must_use]
    pub fn factorisations(&self) -> usize {
        self.factorisations
    }

    /// The derivative along a drive; none where the laws do not determine it.
    ///
    /// # Errors
    ///
    /// A drive that is not of the problem's length or not finite.
    pub fn along(&mut self, drive: &Drive) -> Result<Option<Sides<Rate>>, Error> {
        let (unknowns, contacts) = (self.problem.unknowns(), self.problem.contacts());
        for (place, expected, entries) in [
            ("drive.beyond", unknowns, &drive.beyond),
            ("drive.friction", contacts, &drive.friction),
            ("drive.load", self.problem.free_modes(), &drive.load),
        ] {
            check_length(place, expected, entries.len())?;
            check_finite(place, entries)?;
        }
        let drive = &Drive {
            beyond: self.centred.displacement(&drive.beyond),
            ..drive.clone()
        };
        if let Some(system) = &self.system {
            let falling = None;
            let found = self.answer(system, drive).map(|at| self.rate(at));
            return Ok(found.map(|growing| Sides { growing, falling }));
        }
        let growing = self.settled(drive);
        let falling = self.settled(&drive.reversed());
        Ok(growing.zip(falling).map(|(growing, falling)| Sides {
            growing: self.rate(growing),
            falling: Some(reversed(self.rate(falling))),
        }))
    }

    /// Steps until every contact on an edge goes on as its rates say.
    fn settled(&mut self, drive: &Drive) -> Option<Point> {
        let mut at = self.held(drive);
        for _ in 0..STEPS {
            let laws = (0..self.contacts.len()).filter_map(|k| self.law(k, &at, drive));
            let system = self.factorised(laws.collect());
            self.factorisations += 1;
            let next = self.answer(&system, drive)?;
            let change = self.size(next.reaction.iter().zip(&at.reaction).map(|(a, b)| a - b));
            let size = self.size(next.reaction.iter().copied());
            at = next;
            if change <= SETTLED * size {
                return Some(at);
            }
        }
        None
    }

    /// The law by which a contact's rates go on.
    fn law(&self, contact: usize, rates: &Point, drive: &Drive) -> Option<Law> {
        let linear = &self.contacts[contact];
        let Some(edge) = linear.edge else {
            return linear.law.clone();
        };
        let local = local(&self.finish, contact, &rates.reaction, &rates.beyond);
        let growing = self.growing(contact, drive);
        let place = (contact, self.problem.block(contact));
        edge.law(&local, growing, place, linear.pressing)
    }

    /// What the bound of friction gains, scaled.
    fn growing(&self, contact: usize, drive: &Drive) -> f64 {
        drive.friction[contact] * self.contacts[contact].per_friction
    }

    fn factorised(&self, laws: Vec<Law>) -> System {
        let matrix = Factored::new(self.finish.matrix(&laws, 0.0));
        System { laws, matrix }
    }

    /// What is driven while no reaction changes.
    fn held(&self, drive: &Drive) -> Point {
        Point {
            reaction: vec![0.0; self.problem.unknowns()],
            beyond: drive.beyond.clone(),
            drift: vec![0.0; self.finish.along(&drive.load).len()],
        }
    }

    fn answer(&self, system: &System, drive: &Drive) -> Option<Point> {
        let mut at = self.held(drive);
        let grows = |law: &Law| law.grows(self.growing(law.contact, drive));
        let changes = system.laws.iter().map(|law| (law, grows(law)));
        self.finish.add_to(&mut at, changes);
        let asked = laws::missing(&system.laws, |contact| {
            local(&self.finish, contact, &at.reaction, &at.beyond)
        });
        let load = self.finish.along(&drive.load).into_iter();
        let rest = load.zip(self.finish.carried(&at.reaction));
        let rest = rest.map(|(e, carried)| -(e + carried));
        let right: Col<f64> = asked.chain(rest).collect();
        let solution = system.matrix.solve(&right);
        if !solution.iter().all(|x| x.is_finite()) {
            return None;
        }
        self.finish.add(&mut at, &system.laws, &solution);
        for law in system.laws.iter().filter(|law| law.is_closed()) {
            // But for rounding.
            at.beyond[law.block.start] = 0.0;
        }
        Some(at)
    }

    fn rate(&self, mut at: Point) -> Rate {
        self.centred.turn_back(&mut at.reaction);
        self.centred.turn_back_displacement(&mut at.beyond);
        Rate {
            motion: self.finish.amplitudes(&at.drift),
            reaction: at.reaction,
            beyond: at.beyond,
        }
    }

    fn size(&self, reaction: impl Iterator<Item = f64>) -> f64 {
        let scaled = reaction.zip(&self.finish.roots).map(|(t, root)| t / root);
        scaled.fold(0.0, f64::hypot)
    }
}

/// What the bound of a contact's friction gains per unit of μ, in newton: nothing where a cap bounds it.
fn per_friction(stated: &ContactProblem, contact: usize, reaction: &[f64]) -> f64 {
    let (limits, normal) = (stated.limits(contact), reaction[stated.normals()[contact]]);
    let of_pressure = limits.shear - limits.friction * normal;
    match of_pressure > 0.0 && of_pressure < limits.cap {
        true => -normal,
        false => 0.0,
    }
}

fn local(finish: &Finish<'_>, contact: usize, reaction: &[f64], beyond: &[f64]) -> Local {
    let springs = Springs {
        softness: 0.0,
        anchor: reaction,
    };
    finish.local(contact, reaction, beyond, springs)
}

fn reversed(rate: Rate) -> Rate {
    let minus = |values: Vec<f64>| values.into_iter().map(|value| -value).collect();
    Rate {
        reaction: minus(rate.reaction),
        beyond: minus(rate.beyond),
        motion: minus(rate.motion),
    }
}
