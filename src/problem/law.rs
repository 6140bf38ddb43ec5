//! Laws of contact beyond Coulomb's: the convex set of reactions that a pressure allows.
//!
//! ```text
//! (L4)  t_N ≤ c,   u_N ≤ g₀,   (t_N − c) (u_N − g₀) = 0        c: tension that the contact bears
//!       t_N free,  u_N = g₀                                    bilateral
//! (L5)  ‖E t_T‖ ≤ s,   s = min(a + μ p, τ),   p = −t_N         slip along the outward normal of that set, against t_T
//!       u_T = 0 while pressed (bilateral: always)              sticks
//!
//!   ‖E t_T‖                                E = 1, or E = diag(1, μ/μ₂) along and across the direction of an ellipse
//!      τ |          ______________
//!        |        ／               slope μ
//!      a |      ／
//!        |    ／|
//!        +---+--+------------------- p
//!           −c  0
//! ```
//!
//! | law | numbers |
//! |---|---|
//! | Coulomb | none of these: a, c = 0, τ = ∞ |
//! | shear cap | τ |
//! | given bound (Tresca) | a, with μ = 0: it holds at contacts that are open too |
//! | cohesion | c, and a ≥ μ c; a contact that parts goes on pulling by c, as the set of no pressure knows no past |
//! | rough | sticks; where normals and tangents are strongly coupled there may be no such state, where a large μ has one |
//! | no separation | bilateral; friction where pressed |
//! | bonded | bilateral, sticks |
//! | orthotropic | the ellipse: friction μ along its direction, μ₂ across |
//!
//! A compliance of the surface itself stands in series with the bodies: a diagonal that is added to G, so that the
//! displacement of (C1) is that of what obeys the law, without the layer.

use super::ContactProblem;
use crate::error::{Error, check_length};

/// What one contact obeys beside its coefficient of friction; the default adds nothing to Coulomb's law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// `u_N = g₀`, and `t_N` has either sign.
    pub bilateral: bool,
    /// No slip while pressed; if bilateral, ever. The coefficient is not read.
    pub sticks: bool,
    /// c, in newton.
    pub tension: f64,
    /// a, in newton.
    pub shear: f64,
    /// τ, in newton; infinite without.
    pub cap: f64,
    /// Friction that differs along and across a direction.
    pub ellipse: Option<Ellipse>,
    /// Of the surface itself, normal and tangential, in m/N.
    pub compliance: [f64; 2],
}

/// Friction of orthotropic surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// Unit vector along which the contact's coefficient holds, in its own tangents.
    pub direction: [f64; 2],
    /// μ₂/μ: the coefficient across is so many times as large.
    pub ratio: f64,
}

impl Default for Law {
    fn default() -> Self {
        Self {
            bilateral: false,
            sticks: false,
            tension: 0.0,
            shear: 0.0,
            cap: f64::INFINITY,
            ellipse: None,
            compliance: [0.0; 2],
        }
    }
}

impl Law {
    /// Reactions are in Coulomb's cone: limit analysis of that cone bounds them.
    #[must_use]
    pub fn is_within_coulomb(&self) -> bool {
        let bound = [self.tension, self.shear] == [0.0; 2];
        bound && !self.bilateral && !self.sticks
    }

    /// Refuses numbers that are none, and sets that are not convex; `friction` is μ.
    fn check(&self, place: &str, friction: f64) -> Result<(), Error> {
        let [normal, tangential] = self.compliance;
        let refuse = |key: &str, value: f64, accepted| {
            Err(Error::OutOfRange {
                place: format!("{place}.{key}"),
                value,
                accepted,
            })
        };
        for (key, value) in [
            ("tension", self.tension),
            ("shear", self.shear),
            ("compliance[0]", normal),
            ("compliance[1]", tangential),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return refuse(key, value, "0 <= number < infinity");
            }
        }
        if self.cap.is_nan() || self.cap < self.shear {
            return refuse("cap", self.cap, "a cap >= shear");
        }
        if self.shear < friction * self.tension {
            let accepted = "shear >= friction × tension, so that what pulls can still hold";
            return refuse("shear", self.shear, accepted);
        }
        match self.ellipse {
            Some(ellipse) => ellipse.check(place),
            None => Ok(()),
        }
    }
}

impl Ellipse {
    fn check(&self, place: &str) -> Result<(), Error> {
        let [x, y] = self.direction;
        let size = x.hypot(y);
        // False for NaN.
        let unit = (size - 1.0).abs() < 1e-9;
        if !unit {
            return Err(Error::OutOfRange {
                place: format!("{place}.ellipse.direction"),
                value: size,
                accepted: "a direction of length 1",
            });
        }
        if !(self.ratio > 0.0 && self.ratio.is_finite()) {
            return Err(Error::OutOfRange {
                place: format!("{place}.ellipse.ratio"),
                value: self.ratio,
                accepted: "0 < ratio < infinity",
            });
        }
        Ok(())
    }
}

impl ContactProblem {
    /// The same contacts under laws of their own, one per contact; their compliance is added to G.
    ///
    /// Laws that add nothing to Coulomb's leave the problem as it is.
    ///
    /// ```
    /// use dpana::alternation::{Settings, solve};
    /// use dpana::faer::mat;
    /// use dpana::problem::{Law, Operator};
    /// use dpana::{ContactProblem, Status};
    ///
    /// # fn main() -> Result<(), dpana::Error> {
    /// // Pulled by 1 m against 1 m/N: glue of 0.25 N gives way, and pulls on.
    /// let operator = Operator::from_compliance(mat![[1.0]])?;
    /// let problem = ContactProblem::new(&[0], vec![0.0], vec![0.0], vec![-1.0], operator)?;
    /// let glue = Law { tension: 0.25, ..Law::default() };
    /// let outcome = solve(&problem.with_laws(vec![glue])?, &Settings::default())?;
    /// assert_eq!((outcome.status, outcome.reaction[0]), (Status::Certified, 0.25));
    /// assert_eq!(outcome.verdict.displacement[0], -0.75);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// A length that does not fit, a NaN, a number out of its range, a set that is not convex.
    pub fn with_laws(&self, laws: Vec<Law>) -> Result<Self, Error> {
        check_length("laws", self.contacts(), laws.len())?;
        for (contact, (law, friction)) in laws.iter().zip(self.friction()).enumerate() {
            law.check(&format!("laws[{contact}]"), *friction)?;
        }
        if laws.iter().all(|law| *law == Law::default()) {
            return Ok(self.under(None));
        }
        let layers = laws.iter().any(|law| law.compliance != [0.0; 2]);
        let problem = self.under(Some(laws.into()));
        if !layers {
            return Ok(problem);
        }
        let mut compliance = self.compliance().clone();
        for (k, layer) in problem.layers().into_iter().enumerate() {
            compliance[(k, k)] += layer;
        }
        Ok(problem.with_operator(super::Operator::from_bodies(compliance)?))
    }

    /// Refuses coefficients that make the set of a law concave.
    pub(super) fn check_laws(&self, friction: &[f64]) -> Result<(), Error> {
        let laws = self.laws().unwrap_or_default().iter().zip(friction);
        laws.enumerate()
            .try_for_each(|(contact, (law, mu))| law.check(&format!("laws[{contact}]"), *mu))
    }

    /// Compliance of the surface itself per unknown, in m/N.
    #[must_use]
    pub fn layers(&self) -> Vec<f64> {
        let mut layers = vec![0.0; self.unknowns()];
        for (law, block) in self.laws().unwrap_or_default().iter().zip(self.blocks()) {
            let [normal, tangential] = law.compliance;
            layers[block.clone()].fill(tangential);
            layers[block.start] = normal;
        }
        layers
    }

    /// What of a displacement under a reaction is the bodies' own, in metre per unknown: without the layers.
    #[must_use]
    pub fn displacement_of_bodies(&self, displacement: &[f64], reaction: &[f64]) -> Vec<f64> {
        if self.laws().is_none() {
            return displacement.to_vec();
        }
        let layers = self.layers();
        let given = layers.iter().zip(reaction).map(|(c, t)| c * t);
        displacement.iter().zip(given).map(|(u, w)| u - w).collect()
    }

    fn law(&self, contact: usize) -> Option<&Law> {
        self.laws().map(|laws| &laws[contact])
    }

    /// Whether the contact's normal reaction has either sign.
    pub(crate) fn is_bilateral(&self, contact: usize) -> bool {
        self.law(contact).is_some_and(|law| law.bilateral)
    }

    /// Whether nothing bounds the contact's friction while it is pressed.
    pub(crate) fn sticks(&self, contact: usize) -> bool {
        self.law(contact).is_some_and(|law| law.sticks)
    }

    /// Bounds and slope of (L5) in numbers, for a solver; tension and ellipse are not among them.
    pub(crate) fn limits(&self, contact: usize) -> Limits {
        let friction = self.friction()[contact];
        match self.law(contact) {
            None => Limits::coulomb(friction),
            Some(law) if law.sticks => Limits {
                friction: f64::INFINITY,
                shear: if law.bilateral { f64::INFINITY } else { 0.0 },
                cap: f64::INFINITY,
                bilateral: law.bilateral,
            },
            Some(law) => Limits {
                friction,
                shear: law.shear,
                cap: law.cap,
                bilateral: law.bilateral,
            },
        }
    }

    /// Radius of the contact's disc of friction under a normal reaction, in newton; infinite where it sticks.
    pub(crate) fn friction_bound(&self, contact: usize, normal_reaction: f64) -> f64 {
        self.limits(contact).bound(normal_reaction)
    }
}

impl ContactProblem {
    /// `s` of (L5) at a contact under a normal reaction, in newton: the largest friction along an ellipse's
    /// direction; infinite where nothing bounds it.
    ///
    /// # Panics
    ///
    /// If there is no such contact.
    #[must_use]
    pub fn stated_bound(&self, contact: usize, normal_reaction: f64) -> f64 {
        let Some(law) = self
            .law(contact)
            .filter(|law| !law.sticks && !law.bilateral)
        else {
            return self.friction_bound(contact, normal_reaction);
        };
        let signed = law.shear - self.friction()[contact] * normal_reaction;
        signed.max(0.0).min(law.cap)
    }
}

/// `s` of (L5) as a function of the normal reaction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    /// μ; infinite where a pressed contact sticks.
    pub(crate) friction: f64,
    pub(crate) shear: f64,
    pub(crate) cap: f64,
    pub(crate) bilateral: bool,
}

impl Limits {
    pub(crate) fn coulomb(friction: f64) -> Self {
        Self {
            friction,
            shear: 0.0,
            cap: f64::INFINITY,
            bilateral: false,
        }
    }

    pub(crate) fn bound(&self, normal_reaction: f64) -> f64 {
        if normal_reaction < 0.0 {
            (self.shear - self.friction * normal_reaction).min(self.cap)
        } else {
            self.shear
        }
    }

    /// `ds/dp`, without the corner where it changes.
    pub(crate) fn slope(&self, normal_reaction: f64) -> f64 {
        let uncapped = self.shear - self.friction * normal_reaction < self.cap;
        if normal_reaction < 0.0 && uncapped {
            self.friction
        } else {
            0.0
        }
    }
}
