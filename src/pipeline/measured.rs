//! What the judge finds of the bodies themselves, and the status that is left of a solved problem.

use crate::alternation::{Outcome, Shortfall, Status};
use crate::body::Body;
use crate::condensation::Condensed;
use crate::error::Error;
use crate::kkt;
use crate::kkt::{Balance, BodyState, PairFit, RigidBalance, SceneGeometry, Surroundings, Worst};

/// Part of the largest displacement by which contacts of recovered bodies may move otherwise than the
/// condensed problem says.
const FOLLOWED: f64 = 1e-6;

/// Part of the largest displacement without contact forces that is round-off: what a slender body would move by is
/// many times what it does, and û + G t has no gap finer than that.
const ROUNDED: f64 = 16.0 * f64::EPSILON;

/// What acts on the contact pairs beside loads and supports.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Acting {
    /// Motion of the obstacle per pair, in metre; missing ones stand still, rigid bodies move their own.
    pub obstacles: Vec<[f64; 3]>,
    /// What is added to all gaps of a pair, in metre; missing ones are zero.
    pub openings: Vec<f64>,
}

/// Recovered bodies, measured.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Equilibrium of each whole body.
    pub balances: Vec<Balance>,
    /// Equilibrium of each rigid body.
    pub rigid: Vec<RigidBalance>,
    /// How far the bodies are from the condensed problem at the contacts.
    pub departure: Worst,
    /// Whether that is round-off.
    follows: bool,
    /// Whether the sides of each pair are in the state that is reported.
    pub fits: Vec<PairFit>,
}

impl Measured {
    /// Measures the displacements, in metre per body and unknown, that were recovered from an outcome.
    ///
    /// # Errors
    ///
    /// Parts that do not belong together.
    pub fn new(
        bodies: &[Body],
        condensed: &Condensed,
        geometry: &SceneGeometry,
        acting: &Acting,
        (outcome, displacements): (&Outcome, &[Vec<f64>]),
    ) -> Result<Self, Error> {
        let states = BodyState::of_bodies(bodies, condensed, &outcome.reaction, displacements);
        let problem = condensed.problem();
        let said = problem.displacement_of_bodies(&outcome.verdict.displacement, &outcome.reaction);
        let departure = kkt::surface_departure(
            bodies,
            displacements,
            condensed.surface(),
            problem,
            &problem.total_displacement(&said),
            &condensed.found_sides(&outcome.motion),
        )?;
        let rigid = condensed
            .rigid_bodies()
            .iter()
            .zip(condensed.rigid_forces());
        let free = problem.free_displacement().iter();
        let free = free.fold(0.0, |most: f64, u| most.max(u.abs()));
        let rounding = geometry.rounding().max(ROUNDED * free);
        let follows = departure.scaled <= FOLLOWED || departure.value <= rounding;
        Ok(Self {
            rigid: rigid
                .map(|(body, given)| kkt::rigid_balance(&states, body, given))
                .collect::<Result<_, _>>()?,
            balances: states.iter().map(kkt::balance).collect::<Result<_, _>>()?,
            departure,
            follows,
            fits: geometry.fit(
                &states,
                &Surroundings {
                    obstacles: &condensed.pair_motions(&acting.obstacles, &outcome.motion),
                    openings: &acting.openings,
                    residual: outcome.verdict.certificate.residual(),
                    departure: if follows {
                        departure.value.max(ROUNDED * free)
                    } else {
                        0.0
                    },
                },
            )?,
        })
    }

    /// How the solve ended: what the bodies are not in has no certificate.
    #[must_use]
    pub fn status(&self, outcome: &Outcome) -> (Status, Option<Shortfall>) {
        if outcome.status != Status::Certified {
            return (outcome.status, outcome.shortfall);
        }
        if let Some(body) = self.balances.iter().position(|balance| !balance.holds()) {
            let balance = &self.balances[body];
            let part = balance.equilibrium.scaled.max(balance.unanswered);
            let shortfall = Shortfall::OutOfBalance { body, part };
            return (Status::NotConverged, Some(shortfall));
        }
        let fits = self.fits.iter().all(|fit| fit.fault().is_none());
        match self.follows && fits && self.rigid.iter().all(RigidBalance::holds) {
            true => (Status::Certified, None),
            false => (Status::CouplingFault, None),
        }
    }
}
