//! THE SCENE: whether the bodies themselves are in the state that the condensed problem says.
//!
//! ```text
//! (K11)  Σ_1 (K u − f) + Σ_2 (K u − f) = 0        what one side gives the other receives, moments too
//! (K12)  g₀ and weights of the contacts            are those of the meshes where they stand
//! (K13)  g = d + (u² − u¹) · m                     no body is in another, and what presses touches
//! (K14)  Σ_1 f, Σ_1 x × f                          are of pressures and friction on what touches
//! ```
//!
//! From recovered displacements, stiffnesses and meshes alone. How the sides see each other it finds itself: from
//! contacts it takes what it holds against the meshes, from the reaction which of them press.
//! Every measure comes with what explains it: rounding, and what facets and cells do not resolve.

mod distances;
mod forces;
mod hull;
mod measure;
mod meeting;
mod reach;
mod rigid;
mod seat;
mod skin;
mod supported;
mod tile;
mod tree;
mod triangles;

pub use measure::Measure;

use super::body_state::BodyState;
use super::resultant::nodal_lengths;
use super::sides::{block, check_sides};
use crate::body::Body;
use crate::contact::{ContactPair, ContactSurface, RigidMotion};
use crate::error::{Error, check_length};
use crate::problem::Law;
use distances::Distances;
use forces::{Forces, Unanswered};
use meeting::Meeting;
use reach::Touching;
use seat::Seat;
use supported::Supported;

/// Part of the forces exchanged, and of the largest displacement, that is round-off,
const ROUNDED: f64 = 1e-9;

/// or of the farthest coordinate,
const COORDINATE: f64 = 256.0 * f64::EPSILON;

/// or as many times the residual that the laws were solved to.
const RESIDUAL: f64 = 100.0;

/// Part of the largest reaction of a pair, friction too, below which a contact presses on nothing.
const PRESSED: f64 = 1e-9;

/// How the sides of all pairs lie before loading: nothing that acts changes it.
#[derive(Clone, Debug)]
pub struct SceneGeometry {
    meetings: Vec<Meeting>,
    /// Contacts of each pair.
    seats: Vec<Vec<Seat>>,
    supported: Supported,
    /// Farthest coordinate, in metre.
    extent: f64,
}

/// What acts on the pairs beside what the bodies know.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// Motion of the obstacle per pair; missing ones stand still.
    pub obstacles: &'a [RigidMotion],
    /// What is added to all gaps of a pair, in metre; missing ones are zero.
    pub openings: &'a [f64],
    /// The residual that the laws were solved to.
    pub residual: f64,
    /// How far the bodies are from the contact problem at the contacts, in metre.
    pub departure: f64,
}

/// (K11) to (K14) of one pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairFit {
    /// Length of the sum of both sides' forces, in newton.
    pub force: Measure,
    /// Length of the sum of both sides' moments about a point between them, in newton metre.
    pub moment: Measure,
    /// Depth of a side in the other, in metre.
    pub overlap: Measure,
    /// Distance across which something presses, in metre.
    pub distance: Measure,
    /// How far a contact's gap before loading, or its weights, are from the meshes, in metre.
    pub misplacement: Measure,
    /// How far the resultant is outside of what touches, in metre.
    pub reach: Measure,
}

impl PairFit {
    /// The measures with their names.
    #[must_use]
    pub fn measures(&self) -> [(&'static str, Measure); 6] {
        [
            ("force", self.force),
            ("moment", self.moment),
            ("overlap", self.overlap),
            ("distance", self.distance),
            ("misplacement", self.misplacement),
            ("reach", self.reach),
        ]
    }

    /// The name of the first measure of which not all has a reason.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, Measure)> {
        let mut measures = self.measures().into_iter();
        measures.find(|(_, measure)| !measure.holds())
    }
}

impl SceneGeometry {
    /// Looks at the meshes of all pairs.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownIndex`] if a contact stands at a body or node that does not exist; supports that contradict
    /// each other.
    pub fn new(
        bodies: &[Body],
        pairs: &[ContactPair],
        surface: &ContactSurface,
    ) -> Result<Self, Error> {
        check_sides(surface, bodies)?;
        let mut meetings: Vec<Meeting> = pairs
            .iter()
            .map(|pair| Meeting::new(bodies, pair))
            .collect();
        let supported = Supported::new(bodies, &meetings)?;
        for skin in meetings.iter_mut().flat_map(|meeting| &mut meeting.skins) {
            let body = skin.body;
            skin.see_images(|node| supported.at(body, node));
        }
        let mut seats = vec![Vec::new(); pairs.len()];
        for (number, contact) in surface.nodes.iter().enumerate() {
            let Some(of_pair) = seats.get_mut(contact.pair) else {
                return Err(Error::UnknownIndex {
                    place: format!("contact nodes[{number}]"),
                    what: "pair",
                    index: contact.pair,
                    count: pairs.len(),
                });
            };
            let meeting = &meetings[contact.pair];
            of_pair.push(Seat::new(number, contact, meeting, bodies, &supported));
        }
        let nodes = bodies.iter().flat_map(|body| &body.mesh.nodes).flatten();
        Ok(Self {
            meetings,
            seats,
            supported,
            extent: nodes.fold(0.0, |most, x| x.abs().max(most)),
        })
    }

    /// What rounding of coordinates leaves of a distance, in metre.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        COORDINATE * self.extent
    }

    /// Measures (K11) to (K14), pair by pair.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] if arrays do not belong together.
    pub fn fit(
        &self,
        states: &[BodyState<'_>],
        surroundings: &Surroundings<'_>,
    ) -> Result<Vec<PairFit>, Error> {
        for state in states {
            state.check()?;
        }
        let contacts = self.seats.iter().map(Vec::len).sum();
        if let Some(state) = states.first() {
            check_length("contact nodes", contacts, state.surface.nodes.len())?;
        }
        let unanswered = Unanswered::new(states, &self.meetings);
        let pairs = (0..self.meetings.len())
            .map(|pair| self.fit_pair(pair, states, surroundings, &unanswered));
        Ok(pairs.collect())
    }

    fn fit_pair(
        &self,
        pair: usize,
        states: &[BodyState<'_>],
        surroundings: &Surroundings<'_>,
        unanswered: &Unanswered,
    ) -> PairFit {
        let (meeting, seats) = (&self.meetings[pair], &self.seats[pair]);
        let (Some(state), Some(first)) = (states.first(), seats.first()) else {
            return PairFit::default();
        };
        let part = ROUNDED + RESIDUAL * surroundings.residual;
        let displacements: Vec<&[f64]> = states.iter().map(|state| state.displacement).collect();
        let lengths = displacements.iter();
        let motion = lengths.flat_map(|u| nodal_lengths(u, state.dimension()));
        let rounded = part * motion.fold(0.0, f64::max) + self.rounding() + surroundings.departure;
        let opening = surroundings.openings.get(pair).copied().unwrap_or_default();
        let moved = surroundings
            .obstacles
            .get(pair)
            .copied()
            .unwrap_or_default();
        let side = usize::from(state.surface.nodes[first.contact].second);
        let distances = Distances::new(meeting, side, &displacements, moved, opening);
        let pressed = pressed(state, seats);
        let layers = state.problem.layers();
        let mut fit = PairFit::default();
        for (seat, &pressed) in seats.iter().zip(&pressed) {
            // What a layer of the surfaces gives is no overlap.
            let normal = state.problem.normals()[seat.contact];
            let given = layers[normal] * state.reaction[normal];
            let around = distances.around(&seat.faces).apart(given);
            fit.misplacement.take(seat.unshared);
            fit.overlap.take(around.overlap(rounded, seat.contact));
            if pressed {
                fit.distance.take(around.distance(rounded, seat.contact));
            }
            if pressed || around.touches(rounded) {
                let gap = state.problem.initial_gap()[seat.contact] - opening;
                fit.misplacement
                    .take(seat.misplacement(gap, rounded, pressed));
            }
        }
        if meeting.skins.len() == 2 {
            let forces = Forces::new(states, unanswered, meeting, seats);
            let at = first.contact;
            let [value, explained] = forces.defect(part);
            fit.force = Measure::new(value, explained, at);
            let [value, explained] = forces.moment_defect(part, state.body.model);
            fit.moment = Measure::new(value, explained, at);
            let laws = state.problem.laws().unwrap_or_default();
            let friction = seats.iter().map(|seat| {
                let ellipse = laws.get(seat.contact).and_then(|law| law.ellipse);
                let widest = ellipse.map_or(1.0, |ellipse| ellipse.ratio.max(1.0));
                state.problem.friction()[seat.contact] * widest
            });
            let faces = seats.iter().zip(&pressed).filter(|(_, pressed)| **pressed);
            let touching = Touching {
                meeting,
                side,
                faces: faces.flat_map(|(seat, _)| &seat.faces).copied().collect(),
                friction: friction.fold(0.0, f64::max),
                supported: &self.supported,
            };
            let mut laws = seats.iter().filter_map(|seat| laws.get(seat.contact));
            let within = laws.all(Law::is_within_coulomb);
            let within = within && self.is_felt(state, seats);
            if within && state.body.model != crate::body::Model::Axisymmetric {
                fit.reach = touching.reach(&forces, part, at);
            }
        }
        fit
    }

    /// Whether forces of a pair move its contacts by more than rounding of where they stand: what came back to nothing has
    /// no resultant.
    fn is_felt(&self, state: &BodyState<'_>, seats: &[Seat]) -> bool {
        let compliance = state.problem.compliance();
        let unknowns = seats
            .iter()
            .flat_map(|seat| state.problem.block(seat.contact));
        let mut moved = unknowns.map(|k| compliance[(k, k)] * state.reaction[k].abs());
        moved.any(|moved| moved > self.rounding())
    }
}

/// Which contacts press.
fn pressed(state: &BodyState<'_>, seats: &[Seat]) -> Vec<bool> {
    let laws = state.problem.laws();
    // Along the normal, and the most along any axis.
    let force = |seat: &Seat| {
        let force = block(state.problem, seat.contact, state.reaction);
        let tension = laws.map_or(0.0, |laws| laws[seat.contact].tension);
        // What glue bears of itself tells nothing of where the sides are.
        let normal = force[0] - tension;
        let most = force[1..]
            .iter()
            .fold(normal.abs(), |most, t| most.max(t.abs()));
        [normal.abs(), most]
    };
    let forces: Vec<[f64; 2]> = seats.iter().map(force).collect();
    let most = forces
        .iter()
        .fold(0.0_f64, |most, [_, force]| most.max(*force));
    let normals = forces.iter().map(|[normal, _]| *normal);
    normals.map(|normal| normal > PRESSED * most).collect()
}
