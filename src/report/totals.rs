//! Totals over the contact surface, and pair by pair.

use serde::Serialize;

use super::ReportParts;
use super::certificate::{ReportedDefect, ReportedResultant, in_dimension};
use super::contacts::ContactForce;
use super::fit::ReportedPairFit;
use crate::body::Body;
use crate::contact::{ContactNode, Coupling};
use crate::kkt;
use crate::kkt::ContactStatus;

/// Totals over contacts; vectors in global axes, forces act on the first surface of a pair.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Totals {
    /// Contacts without reaction.
    pub open: usize,
    /// Pressed contacts that friction holds.
    pub stick: usize,
    /// Pressed contacts that slide.
    pub slip: usize,
    /// `Σ −t_N ≥ 0`, in newton; negative where laws bear more tension than there is pressure.
    pub normal: f64,
    /// Sum of the friction forces, in newton.
    pub friction: Vec<f64>,
    /// Sum of the contact forces, normal and friction, in newton.
    pub contact_force: Vec<f64>,
    /// Moment of the contact forces about the origin, in newton metre; in 2D its single component.
    pub moment: Vec<f64>,
    /// Area of the pressed contacts, in m².
    pub contact_area: f64,
    /// Area of the pressed contacts that slide, in m².
    pub slip_area: f64,
    /// Largest pressure, in pascal.
    pub peak_pressure: f64,
    /// The same for each contact pair; a pair's own totals have none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pairs: Vec<PairTotals>,
}

/// Totals over the contacts of one pair.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PairTotals {
    /// Where the scene says so, such as `contacts[0]`.
    pub place: String,
    /// The law of its contacts in words; absent for Coulomb's with one coefficient.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub law: Option<String>,
    /// Totals over its contacts.
    #[serde(flatten)]
    pub totals: Totals,
    /// What the opposite body receives; `null` for a rigid obstacle.
    pub exchange: Option<ReportedExchange>,
    /// Which of its sides carries the contacts, and what is rounded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coupling: Option<ReportedCoupling>,
    /// Whether its sides are in the state that is reported, by meshes and displacements.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fit: Option<ReportedPairFit>,
}

/// How the two sides of a pair see each other; see [`Coupling`].
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedCoupling {
    /// Name of the body whose facets carry the contacts.
    pub carried_by: String,
    /// Facets that gaps take for smooth; none if every facet stands for itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rounded: Option<Rounded>,
}

/// Facets between which gaps are measured as between smooth surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Rounded {
    /// Their number, on both sides.
    pub facets: usize,
    /// The farthest that the smooth surface stands off one of them, in metre.
    pub largest_bulge: f64,
}

impl ReportedCoupling {
    fn new(coupling: &Coupling, bodies: &[Body]) -> Self {
        let name = bodies.get(coupling.body).map(|body| body.name.clone());
        Self {
            carried_by: name.unwrap_or_default(),
            rounded: (coupling.rounded > 0).then_some(Rounded {
                facets: coupling.rounded,
                largest_bulge: coupling.largest_bulge,
            }),
        }
    }
}

/// What the opposite body of a pair receives, and what is left of action and reaction; see
/// [`kkt::Exchange`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReportedExchange {
    /// Contact forces on the opposite body.
    pub opposite: ReportedResultant,
    /// Length of the sum of the forces on both sides, in newton.
    pub force_defect: ReportedDefect,
    /// Length of the sum of the moments on both sides, in newton metre; up to gap × friction.
    pub moment_defect: ReportedDefect,
}

/// Sums while contacts are met.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    open: usize,
    stick: usize,
    slip: usize,
    pub(super) normal: f64,
    pub(super) friction: [f64; 3],
    pub(super) contact: kkt::Resultant,
    stick_area: f64,
    slip_area: f64,
    peak_pressure: f64,
}

impl Totals {
    /// `exchanges` are per pair, `forces` per contact.
    pub(super) fn new(
        parts: &ReportParts<'_>,
        exchanges: &[kkt::Exchange],
        forces: &[ContactForce],
    ) -> Self {
        let all = Sums::of(parts, forces, None);
        let of_pairs = (0..parts.pairs.len()).map(|pair| Sums::of(parts, forces, Some(pair)));
        let dimension = parts.dimension();
        let fits = parts.fits.iter().map(|fit| Some(fit.into()));
        let fits = fits.chain(std::iter::repeat(None));
        let couplings = parts.surface.couplings.iter();
        let couplings = couplings.map(|one| Some(ReportedCoupling::new(one, parts.bodies)));
        let judged = couplings.chain(std::iter::repeat(None)).zip(fits);
        let pairs = parts.pairs.iter().zip(of_pairs).zip(exchanges).zip(judged);
        let pairs = pairs.map(|(((pair, sums), exchange), (coupling, fit))| PairTotals {
            place: pair.place.clone(),
            law: pair.law.words(pair.friction),
            totals: sums.totals(dimension, Vec::new()),
            exchange: ReportedExchange::new(exchange, dimension),
            coupling,
            fit,
        });
        all.totals(dimension, pairs.collect())
    }
}

impl ReportedExchange {
    fn new(measured: &kkt::Exchange, dimension: usize) -> Option<Self> {
        Some(Self {
            opposite: ReportedResultant::new(&measured.opposite?, dimension),
            force_defect: measured.force_defect.into(),
            moment_defect: measured.moment_defect.into(),
        })
    }
}

impl Sums {
    /// Over the contacts of one pair, or of all; what a bolt carries across its cut is inside of a body, and only counted.
    pub(super) fn of(
        parts: &ReportParts<'_>,
        forces: &[ContactForce],
        pair: Option<usize>,
    ) -> Self {
        let mut sums = Self::default();
        let cuts = parts.rigid.bodies.iter().filter(|body| body.cut.is_some());
        let cuts: Vec<usize> = cuts.flat_map(|body| body.pairs.iter().copied()).collect();
        let contacts = parts.surface.nodes.iter().zip(forces);
        for ((contact, force), &status) in contacts.zip(&parts.outcome.verdict.status) {
            if pair.is_none_or(|pair| pair == contact.pair) {
                sums.count(status);
                if pair.is_some() || !cuts.contains(&contact.pair) {
                    let centre = contact.centre(&parts.bodies[contact.body].mesh.nodes);
                    sums.add(contact, centre, force, status);
                }
            }
        }
        sums
    }

    fn count(&mut self, status: ContactStatus) {
        match status {
            ContactStatus::Open => self.open += 1,
            ContactStatus::Stick => self.stick += 1,
            ContactStatus::Slip => self.slip += 1,
        }
    }

    /// `centre`: where its force acts, in metre.
    fn add(
        &mut self,
        contact: &ContactNode,
        centre: [f64; 3],
        force: &ContactForce,
        status: ContactStatus,
    ) {
        match status {
            ContactStatus::Open => {}
            ContactStatus::Stick => self.stick_area += contact.area,
            ContactStatus::Slip => self.slip_area += contact.area,
        }
        self.normal += force.pressing;
        let sign = if contact.second { -1.0 } else { 1.0 };
        for (sum, friction) in self.friction.iter_mut().zip(force.friction) {
            *sum += sign * friction;
        }
        let total = force.total.map(|f| sign * f);
        self.contact.add(centre, total);
        if contact.area > 0.0 {
            self.peak_pressure = self.peak_pressure.max(force.pressing / contact.area);
        }
    }

    fn totals(&self, dimension: usize, pairs: Vec<PairTotals>) -> Totals {
        let ReportedResultant { force, moment } = ReportedResultant::new(&self.contact, dimension);
        Totals {
            open: self.open,
            stick: self.stick,
            slip: self.slip,
            normal: self.normal,
            friction: in_dimension(self.friction, dimension),
            contact_force: force,
            moment,
            contact_area: self.stick_area + self.slip_area,
            slip_area: self.slip_area,
            peak_pressure: self.peak_pressure,
            pairs,
        }
    }
}
