//! A pair of sides that may touch, as a scene names it, and what it adds to the contact surface.

use nalgebra::Vector3;

use super::Obstacle;
use super::law::PairLaw;
use super::node::ContactNode;
use super::rigid_body::RigidMotion;
use crate::body::Facet;
use crate::error::{Error, check_finite};

/// A motion that has no more than this part of its size along a direction is across it.
const ALONG: f64 = 1e-12;

/// A part of a body's surface that may touch a rigid obstacle or another surface.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ContactPair {
    /// Where the scene says so, for messages, such as `contacts[0]`.
    pub place: String,
    /// Index of the body that the pair names first. Of the two sides that one carries the
    /// contacts that has fewer facets on which the other one ends, where neither ends one that is more than twice as fine,
    /// and else the first one; but a side that is more than a hundred times as stiff as the other
    /// never does.
    /// On flat faces either choice is exact for a uniform pressure;
    /// on curved ones the coarser side averages over the other's facets, while the finer
    /// one follows them in its pressures.
    pub body: usize,
    /// The assumed contact surface; it need only contain the true contact.
    pub facets: Vec<Facet>,
    /// What it may touch.
    pub opposite: Opposite,
    /// Coefficient of friction, `μ ≥ 0`.
    pub friction: f64,
    /// What the contacts obey beside it.
    pub law: PairLaw,
    /// Gaps are measured between the smooth surfaces that straight facets stand for, where
    /// these turn; else between the facets.
    pub rounded: bool,
    /// Added to all gaps before loading, in metre: clearance if positive, interference if negative.
    pub gap: f64,
    /// Supports may move its nodes along the obstacle, and friction acts against that motion.
    pub dragged: bool,
    /// Motions that the obstacle may make, of any size: along these, friction acts on nodes that supports hold as well.
    pub obstacle_motions: Vec<RigidMotion>,
}

/// The other side of a contact pair.
#[derive(Clone, Debug, PartialEq)]
pub enum Opposite {
    /// A rigid obstacle.
    Obstacle(Obstacle),
    /// The surface of a body: another one, or the other face of a crack in the same.
    Surface {
        /// Index of that body.
        body: usize,
        /// Its facets.
        facets: Vec<Facet>,
    },
}

impl ContactPair {
    /// The contact of `facets` of the body of that number with what is opposite, after Coulomb's law with a
    /// coefficient `friction >= 0`, without a gap but that of the geometry; turning facets are rounded.
    #[must_use]
    pub fn new(
        place: &str,
        body: usize,
        facets: Vec<Facet>,
        opposite: Opposite,
        friction: f64,
    ) -> Self {
        Self {
            place: place.to_owned(),
            body,
            facets,
            opposite,
            friction,
            law: PairLaw::default(),
            rounded: true,
            gap: 0.0,
            dragged: false,
            obstacle_motions: Vec::new(),
        }
    }

    /// Whether the obstacle may move along a direction there, by more than rounding of its motions.
    pub(super) fn moves_along(&self, position: [f64; 3], direction: &Vector3<f64>) -> bool {
        let mut motions = self.motions_at(position);
        motions.any(|moved| moved.dot(direction).abs() > ALONG * moved.norm())
    }

    /// Whether it may move across a normal there.
    pub(super) fn slides_along(&self, position: [f64; 3], normal: Vector3<f64>) -> bool {
        let mut motions = self.motions_at(position);
        motions.any(|moved| moved.cross(&normal).norm() > ALONG * moved.norm())
    }

    fn motions_at(&self, position: [f64; 3]) -> impl Iterator<Item = Vector3<f64>> {
        let motions = self.obstacle_motions.iter();
        motions.map(move |motion| Vector3::from(motion.at(position)))
    }

    /// Whether it is one of two bodies, whichever it names first.
    pub(crate) fn joins(&self, bodies: [usize; 2]) -> bool {
        match &self.opposite {
            Opposite::Obstacle(_) => false,
            Opposite::Surface { body, .. } => {
                [self.body, *body] == bodies || [*body, self.body] == bodies
            }
        }
    }

    pub(super) fn check(&self, dimension: usize) -> Result<(), Error> {
        if let Opposite::Obstacle(obstacle) = &self.opposite {
            obstacle.check(&self.place, dimension)?;
        }
        let place = format!("{}.friction", self.place);
        if self.friction.is_finite() && self.friction < 0.0 {
            return Err(Error::OutOfRange {
                place,
                value: self.friction,
                accepted: "friction >= 0",
            });
        }
        check_finite(&place, &[self.friction])?;
        self.law.check(&self.place, self.friction)?;
        check_finite(&format!("{}.gap", self.place), &[self.gap])
    }
}

/// How the two sides of a pair are coupled.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coupling {
    /// Index of the body whose facets carry the contacts.
    pub body: usize,
    /// They are those of the pair's second surface.
    pub second: bool,
    /// Number of facets, of both sides, that are rounded when gaps are measured.
    pub rounded: usize,
    /// Largest distance by which the smooth surface stands off one of them, in metre.
    pub largest_bulge: f64,
}

/// What one pair adds to the contact surface.
pub(super) struct PairSurface {
    pub(super) coupling: Coupling,
    pub(super) contacts: Vec<ContactNode>,
    pub(super) facets: Vec<Facet>,
    pub(super) left_out: Vec<usize>,
}

/// Refuses the number of a body that does not exist.
pub(super) fn check_pair_body(place: &str, body: usize, count: usize) -> Result<(), Error> {
    if body < count {
        return Ok(());
    }
    Err(Error::UnknownIndex {
        place: place.to_owned(),
        what: "body",
        index: body,
        count,
    })
}
