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

use crate::error::Error;

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
    pub(super) fn check(&self, place: &str, friction: f64) -> Result<(), Error> {
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
