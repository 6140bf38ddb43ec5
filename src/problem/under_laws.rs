//! A problem whose contacts obey laws of their own (L4), (L5).

use super::{Compliance, ContactProblem, Law, Limits, Operator};
use crate::error::{Error, check_length};

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
        Ok(problem.with_operator(Operator::from_bodies(compliance)?))
    }
}

impl<O: Compliance> ContactProblem<O> {
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
