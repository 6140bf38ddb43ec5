//! What the two sides of a pair give each other, by the cells of their bodies.
//!
//! ```text
//! (K11)  Σ_1 f + Σ_2 f = 0,   Σ_1 (x − c) × f + Σ_2 (x − c) × f = 0      f = K u − load,  c: between them
//! ```
//!
//! At an unknown that a support holds, and at nodes of several pairs, `K u − load` is not of this
//! pair alone: what the contacts of the pair say stands there, and with it whatever the cells have
//! besides. Friction across a gap, and facets of curved sides, leave a moment of friction × gap and of
//! force × sagitta. On bodies of revolution forces are those of rings, which have no moment.

use std::collections::BTreeSet;

use nalgebra::Vector3;

use super::super::body_state::BodyState;
use super::super::resultant::Resultant;
use super::super::sides::{block, global_force, shares};
use super::meeting::Meeting;
use super::seat::Seat;
use crate::body::Model;
use crate::kkt::certificate::length;

/// Part of the forces of cells, before they cancel, that is round-off.
const ROUNDED: f64 = 1e-12;

/// What the cells have beside the contacts' forces, per body and unknown, in newton.
pub(super) struct Unanswered {
    rest: Vec<Vec<f64>>,
    /// `Σ |K_ij u_j|`.
    inner: Vec<Vec<f64>>,
}

impl Unanswered {
    /// At the nodes of contact sides.
    pub(super) fn new(states: &[BodyState<'_>], meetings: &[Meeting]) -> Self {
        let mut nodes = vec![BTreeSet::new(); states.len()];
        for skin in meetings.iter().flat_map(|meeting| &meeting.skins) {
            nodes[skin.body].extend(skin.of_node.keys().copied());
        }
        let sums = states.iter().zip(&nodes).map(|(state, nodes)| {
            let contact = state.contact_forces();
            let mut rest = vec![0.0; contact.len()];
            let mut inner = vec![0.0; contact.len()];
            let (axes, held) = (state.dimension(), state.held());
            for unknown in nodes.iter().flat_map(|node| node * axes..(node + 1) * axes) {
                let Some(row) = state.stiffness.outer_view(unknown) else {
                    continue;
                };
                let (mut sum, mut size) = (0.0, 0.0);
                for (k, entry) in row.iter() {
                    let term = entry * state.displacement[k];
                    (sum, size) = (sum + term, size + term.abs());
                }
                inner[unknown] = size;
                if !held[unknown] {
                    rest[unknown] = sum - state.load[unknown] - contact[unknown];
                }
            }
            (rest, inner)
        });
        let (rest, inner) = sums.unzip();
        Self { rest, inner }
    }
}

/// Sums of both sides of a pair.
pub(super) struct Forces {
    /// About `centre`.
    pub(super) sides: [Resultant; 2],
    pub(super) centre: [f64; 3],
    /// Sum of the lengths of what was added, in newton.
    pub(super) total: f64,
    /// Largest distance from the centre, in metre.
    pub(super) reach: f64,
    /// What rounding may leave of the sum, in newton.
    rounded: f64,
    /// What friction across gaps and the facets of curved sides may leave of the moments, in N m.
    leaning: f64,
}

impl Forces {
    pub(super) fn new(
        states: &[BodyState<'_>],
        unanswered: &Unanswered,
        meeting: &Meeting,
        seats: &[Seat],
    ) -> Self {
        let mut sums = Self {
            sides: [Resultant::default(); 2],
            centre: centre(states, meeting),
            total: 0.0,
            reach: 0.0,
            rounded: 0.0,
            leaning: 0.0,
        };
        let Some(state) = states.first() else {
            return sums;
        };
        for seat in seats {
            let contact = &state.surface.nodes[seat.contact];
            let reaction = block(state.problem, seat.contact, state.reaction);
            let force = global_force(contact, reaction);
            let friction = reaction[1..].iter().fold(0.0_f64, |sum, t| sum.hypot(*t));
            sums.leaning += seat.leaning(length(force), friction);
            for share in shares(contact) {
                let side = usize::from(share.own == contact.second);
                let x = states[share.body].body.mesh.nodes[share.node];
                sums.add(side, x, force.map(|f| share.weight * f));
            }
        }
        for (side, skin) in meeting.skins.iter().enumerate() {
            let (axes, nodes) = (skin.dimension, &states[skin.body].body.mesh.nodes);
            let mut around: Vec<usize> = skin.of_node.keys().copied().collect();
            around.sort_unstable();
            for node in around {
                let unknowns = node * axes..(node + 1) * axes;
                let mut force = [0.0; 3];
                force[..axes].copy_from_slice(&unanswered.rest[skin.body][unknowns.clone()]);
                sums.add(side, nodes[node], force);
                let inner = &unanswered.inner[skin.body][unknowns];
                sums.rounded += ROUNDED * inner.iter().sum::<f64>();
            }
        }
        sums
    }

    fn add(&mut self, side: usize, x: [f64; 3], force: [f64; 3]) {
        let arm = [0, 1, 2].map(|axis| x[axis] - self.centre[axis]);
        self.sides[side].add(arm, force);
        self.total += length(force);
        self.reach = self.reach.max(length(arm));
    }

    /// Length of the sum of both forces, and what rounding may leave of it where all is right to
    /// `part`; in newton.
    pub(super) fn defect(&self, part: f64) -> [f64; 2] {
        let sum = [0, 1, 2].map(|axis| self.sides.iter().map(|side| side.force[axis]).sum());
        [length(sum), part * self.total + self.rounded]
    }

    /// The same of the moments, in newton metre; zero where rings have none.
    pub(super) fn moment_defect(&self, part: f64, model: Model) -> [f64; 2] {
        if model == Model::Axisymmetric {
            return [0.0; 2];
        }
        let sum = [0, 1, 2].map(|axis| self.sides.iter().map(|side| side.moment[axis]).sum());
        let rounded = (part * self.total + self.rounded) * self.reach;
        [length(sum), rounded + self.leaning]
    }
}

/// Mean of the sides' nodes, in metre.
fn centre(states: &[BodyState<'_>], meeting: &Meeting) -> [f64; 3] {
    let nodes = meeting.skins.iter().flat_map(|skin| {
        let nodes = &states[skin.body].body.mesh.nodes;
        let faces = skin.faces.iter().flat_map(|face| &face.nodes);
        faces.map(|&node| Vector3::from(nodes[node]))
    });
    let (sum, count) = nodes.fold((Vector3::zeros(), 0.0), |(sum, count), x| {
        (sum + x, count + 1.0)
    });
    (sum / f64::max(count, 1.0)).into()
}
