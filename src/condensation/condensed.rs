//! Bodies condensed onto the contact problem between them, and the way back.

use std::sync::Arc;
use std::time::Instant;

use faer::Mat;

use super::PartMotion;
use super::carried::Carried;
use super::condensed_body::CondensedBody;
use super::engine::{BodyFactor, By, Engine};
use super::factor::Precision;
use super::given::{Prescribed, checked, given, possible};
use super::grounding::Grounding;
use super::interface::Interface;
use super::laws::{friction, under_laws};
use super::load_case::Given;
use super::mumps::RankMemory;
use super::rigid_bodies::{floating, part_motions, rigid_parts};
use super::room::dense_bytes;
use super::supported::SupportedBody;
use super::work::{CondensationWork, Fallback};
use crate::body;
use crate::body::{Body, Dependence};
use crate::contact::{ContactPair, ContactSurface, RigidBody, RigidMotion};
use crate::error::{Error, check_length};
use crate::problem::{ContactProblem, Operator};
use crate::stage::{self, Stage};

/// Bodies, their contact surface, and the factors that join them; copies share the factors.
#[derive(Clone, Debug)]
pub struct Condensed {
    pub(super) surface: Arc<ContactSurface>,
    pub(super) problem: ContactProblem,
    pub(super) bodies: Vec<CondensedBody>,
    pub(super) interfaces: Arc<[Interface]>,
    pub(super) carried: Carried,
    dimension: usize,
    pub(super) work: CondensationWork,
}

/// A body with its stiffness and load, before it is condensed.
pub(super) fn supported<'a>(
    body: &'a Body,
    (prescribed, dependence): (Vec<Option<f64>>, Option<Dependence>),
    interface: &Interface,
) -> SupportedBody<'a> {
    let nodes: Vec<usize> = interface.nodes.iter().map(|node| node.node).collect();
    let tied = dependence.as_ref();
    SupportedBody {
        name: &body.name,
        nodes: &body.mesh.nodes,
        dimension: body.mesh.dimension,
        stiffness: body::stiffness(body),
        load: body::load_vector(body),
        grounding: Grounding::new(body, (&prescribed, tied), &nodes),
        given: Given {
            values: tied.map_or_else(Vec::new, |tied| tied.values(|_| 1.0)),
            prescribed,
        },
        dependence,
    }
}

/// The crate's own factors, in double precision.
const IN_DOUBLE: (Engine, Precision) = (Engine::Faer, Precision::Double);

impl Condensed {
    /// Condenses bodies onto the surfaces where they may touch obstacles or each other.
    ///
    /// # Errors
    ///
    /// What the check of a body, its supports and
    /// [`ContactSurface::new`] refuse, a stiffness that is not positive definite. A rigid
    /// motion that the supports leave free is none: see [`ContactProblem::floating`].
    pub fn new(bodies: &[Body], pairs: &[ContactPair]) -> Result<Self, Error> {
        Self::with_rigid(bodies, pairs, &[])
    }

    /// The same with rigid bodies that carry the obstacles of some pairs.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new), a motion or force that is not finite.
    pub fn with_rigid(
        bodies: &[Body],
        pairs: &[ContactPair],
        rigid: &[RigidBody],
    ) -> Result<Self, Error> {
        Self::with_engine(Engine::Faer, bodies, pairs, rigid)
    }

    /// The same by an engine of choice.
    ///
    /// # Errors
    ///
    /// Those of [`with_rigid`](Self::with_rigid), and what keeps [`Engine::Mumps`] from factorising: no
    /// [`Ranks`](super::Ranks) that were joined, ranks with another scene, too little memory.
    pub fn with_engine(
        engine: Engine,
        bodies: &[Body],
        pairs: &[ContactPair],
        rigid: &[RigidBody],
    ) -> Result<Self, Error> {
        Self::by((engine, Precision::Double), bodies, pairs, rigid)
    }

    /// The same with factors in single precision (C32) where that pays and (C24) can make up for it: û and G have
    /// seven digits, until contacts that are solved are [corrected](Self::correction).
    ///
    /// # Errors
    ///
    /// Those of [`with_rigid`](Self::with_rigid).
    pub fn rounded(
        bodies: &[Body],
        pairs: &[ContactPair],
        rigid: &[RigidBody],
    ) -> Result<Self, Error> {
        Self::by((Engine::Faer, Precision::Single), bodies, pairs, rigid)
    }

    fn by(
        wanted: (Engine, Precision),
        bodies: &[Body],
        pairs: &[ContactPair],
        rigid: &[RigidBody],
    ) -> Result<Self, Error> {
        let start = Instant::now();
        let prescribed = checked(bodies)?;
        let surface = Arc::new(ContactSurface::new(bodies, pairs, &prescribed)?);
        let given = (pairs, rigid, prescribed);
        Self::on_surface(wanted, bodies, given, surface, start)
    }

    /// The same bodies with factors in double precision, instead of these; with the sign that asks for it, if any.
    ///
    /// # Errors
    ///
    /// Those of [`with_rigid`](Self::with_rigid).
    pub fn in_double(
        self,
        bodies: &[Body],
        pairs: &[ContactPair],
        sign: impl Into<Option<Fallback>>,
    ) -> Result<Self, Error> {
        let start = Instant::now();
        let (surface, before) = (Arc::clone(&self.surface), self.work);
        let rigid = self.carried.bodies().to_vec();
        // Before there are others.
        drop(self);
        let given = (pairs, &rigid[..], checked(bodies)?);
        let mut found = Self::on_surface(IN_DOUBLE, bodies, given, surface, start)?;
        found.work = before.again(found.work);
        found.work.fallback = sign.into().or(before.fallback);
        Ok(found)
    }

    /// Whether a factor is in single precision (C32).
    #[must_use]
    pub fn is_rounded(&self) -> bool {
        self.work.single_factors > 0
    }

    /// The same bodies on a contact surface that is found already, and maybe changed since.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new).
    pub fn on(
        bodies: &[Body],
        pairs: &[ContactPair],
        surface: ContactSurface,
    ) -> Result<Self, Error> {
        let start = Instant::now();
        let prescribed = bodies
            .iter()
            .map(body::prescribed)
            .collect::<Result<_, _>>()?;
        let (given, surface) = ((pairs, &[][..], prescribed), Arc::new(surface));
        Self::on_surface(IN_DOUBLE, bodies, given, surface, start)
    }

    fn on_surface(
        (engine, wanted): (Engine, Precision),
        bodies: &[Body],
        (pairs, rigid, prescribed): (&[ContactPair], &[RigidBody], Prescribed),
        surface: Arc<ContactSurface>,
        start: Instant,
    ) -> Result<Self, Error> {
        stage::found(surface.nodes.len(), dense_bytes(&surface)?);
        let dimension = bodies.first().map_or(3, |body| body.mesh.dimension);
        let mut work = CondensationWork::default();
        let given = given(bodies, &surface, prescribed, engine)?;
        let wanted = if rigid.is_empty() {
            wanted
        } else {
            Precision::Double
        };
        let precision = possible(wanted, bodies, &given);
        let (mut condensed, mut interfaces) = (Vec::new(), Vec::new());
        let mut compliances = Vec::new();
        for (index, (body, (prescribed, tied, interface))) in bodies.iter().zip(given).enumerate() {
            Stage::Assembly.begin();
            let by = match engine {
                Engine::Faer => By::Faer(precision),
                Engine::Mumps => By::Mumps(body, index),
            };
            let supported = supported(body, (prescribed, tied), &interface);
            let (body, compliance) = supported.condense(&interface, by, &mut work)?;
            condensed.push(body);
            interfaces.push(interface);
            compliances.push(compliance);
        }
        let before = work.ordering_seconds + work.factorisation_seconds + work.condensation_seconds;
        work.assembly_seconds = start.elapsed().as_secs_f64() - before;
        Stage::Condensation.begin();
        let start = Instant::now();
        let mut problem = join(&surface, pairs, &interfaces, &condensed, compliances)?;
        let groundings: Vec<_> = condensed.iter().map(CondensedBody::grounding).collect();
        let loads: Vec<_> = condensed.iter().map(|body| body.load()).collect();
        let carried = Carried::new(rigid, bodies, &surface);
        if let Some(floating) = floating(&surface, &groundings, &loads, dimension, &carried)? {
            problem = problem.float(floating)?;
        }
        work.condensation_seconds += start.elapsed().as_secs_f64();
        let mut condensed = Self {
            surface,
            problem,
            bodies: condensed,
            interfaces: interfaces.into(),
            carried,
            dimension,
            work,
        };
        if !rigid.is_empty() {
            condensed.place_rigid()?;
        }
        Ok(condensed)
    }

    /// Moves rigid bodies by what is given of their motion.
    fn place_rigid(&mut self) -> Result<(), Error> {
        let none = vec![0.0; self.problem.unknowns()];
        let free = self.problem.free_displacement().to_vec();
        self.problem = self.problem.step(free, self.reference(&[], &none))?;
        Ok(())
    }

    /// The contact surface.
    #[must_use]
    pub fn surface(&self) -> &ContactSurface {
        &self.surface
    }

    /// The condensed contact problem, one contact per contact node.
    #[must_use]
    pub fn problem(&self) -> &ContactProblem {
        &self.problem
    }

    /// The bodies, in the order they were given.
    #[must_use]
    pub fn bodies(&self) -> &[CondensedBody] {
        &self.bodies
    }

    /// How the bodies' free parts move under an amplitude per free mode, in metre; rigid bodies come last,
    /// numbered after the others.
    #[must_use]
    pub fn motions(&self, motion: &[f64]) -> Vec<PartMotion> {
        let groundings: Vec<_> = self.bodies.iter().map(CondensedBody::grounding).collect();
        let mut parts = part_motions(&groundings, motion);
        parts.extend(rigid_parts(
            &self.carried,
            self.bodies.len(),
            self.of_rigid(motion),
        ));
        parts
    }

    /// The amplitudes of rigid bodies, which come last.
    fn of_rigid<'a>(&self, motion: &'a [f64]) -> &'a [f64] {
        let elastic = motion.len().saturating_sub(self.carried.modes());
        &motion[elastic..]
    }

    /// The rigid bodies, with what is locked.
    #[must_use]
    pub fn rigid_bodies(&self) -> &[RigidBody] {
        self.carried.bodies()
    }

    /// Their motion under an amplitude per free mode of the problem, in metre.
    #[must_use]
    pub fn rigid_motions(&self, motion: &[f64]) -> Vec<RigidMotion> {
        self.carried.motions(self.of_rigid(motion))
    }

    /// Locks the cuts of rigid bodies at a shortening per body, in metre, and frees all others: what is given of them
    /// acts from the next [`act`](Self::act) on.
    ///
    /// # Errors
    ///
    /// None for the bodies that were condensed.
    pub fn lock(&mut self, locked: &[Option<f64>]) -> Result<(), Error> {
        if !self.carried.lock(locked) {
            return Ok(());
        }
        let groundings: Vec<_> = self.bodies.iter().map(CondensedBody::grounding).collect();
        let loads: Vec<_> = self.bodies.iter().map(|body| body.load()).collect();
        let (surface, dimension) = (&self.surface, self.dimension);
        let floating = floating(surface, &groundings, &loads, dimension, &self.carried)?;
        self.problem = self.problem.clone().floating_as(floating);
        Ok(())
    }

    /// Shortening per rigid body at which its cut is locked, in metre.
    #[must_use]
    pub fn locked(&self) -> &[Option<f64>] {
        self.carried.locked()
    }

    /// What is locked after a state at an instant of a history, under an amplitude per free mode, and the amplitudes
    /// of the modes that are then left.
    #[must_use]
    pub fn locks_from(&self, at: f64, motion: &[f64]) -> (Vec<Option<f64>>, Vec<f64>) {
        let rigid = self.of_rigid(motion);
        let moved = self.carried.motions(rigid);
        let bodies = self.rigid_bodies().iter().zip(&moved).zip(self.locked());
        let locked: Vec<_> = bodies
            .map(|((body, moved), locked)| {
                let from = body.cut?.locked_from?;
                locked.or((at >= from).then(|| body.shortening(moved)))
            })
            .collect();
        let mut left = motion[..motion.len() - rigid.len()].to_vec();
        left.extend(self.carried.unlocked(rigid, &locked));
        (locked, left)
    }

    /// Given force, in newton, and moment, in newton metre, on the free components of each.
    #[must_use]
    pub fn rigid_forces(&self) -> Vec<[f64; 6]> {
        let bodies = 0..self.carried.bodies().len();
        bodies.map(|body| self.carried.forces(body)).collect()
    }

    /// Displacement of each contact's other side in global axes, in metre, where that is rigid: of plain
    /// obstacles from their motion per contact pair, of rigid bodies under an amplitude per free mode.
    #[must_use]
    pub fn other_sides(&self, obstacles: &[[f64; 3]], motion: &[f64]) -> Vec<[f64; 3]> {
        let mut moved = self.surface.obstacle_motions(obstacles);
        self.carried.put(&self.rigid_motions(motion), &mut moved);
        moved
    }

    /// The part of it that the contact problem finds: that of the free components of rigid bodies; empty where there
    /// are none.
    #[must_use]
    pub fn found_sides(&self, motion: &[f64]) -> Vec<[f64; 3]> {
        if self.carried.modes() == 0 {
            return Vec::new();
        }
        let mut moved = vec![[0.0; 3]; self.surface.nodes.len()];
        let motions = self.carried.freely(self.of_rigid(motion));
        self.carried.put(&motions, &mut moved);
        moved
    }

    /// Motion of the obstacle per contact pair, from that of plain ones, in metre, and an amplitude per free
    /// mode; as many as there are entries in `obstacles`, and at least as pairs with rigid bodies need.
    #[must_use]
    pub fn pair_motions(&self, obstacles: &[[f64; 3]], motion: &[f64]) -> Vec<RigidMotion> {
        let along = |translation: &[f64; 3]| RigidMotion {
            translation: *translation,
            ..RigidMotion::default()
        };
        let mut pairs: Vec<RigidMotion> = obstacles.iter().map(along).collect();
        let carried = self.carried.bodies().iter().flat_map(|body| &body.pairs);
        let needed = carried.map(|pair| pair + 1).max().unwrap_or(0);
        pairs.resize(needed.max(pairs.len()), RigidMotion::default());
        self.carried
            .put_pairs(&self.rigid_motions(motion), &mut pairs);
        pairs
    }

    /// What it took.
    #[must_use]
    pub fn work(&self) -> CondensationWork {
        self.work
    }

    /// Memory of every rank for the factors of all bodies; empty where one process factorises.
    #[must_use]
    pub fn ranks(&self) -> Vec<RankMemory> {
        let mut sum = Vec::new();
        for body in &self.bodies {
            let memory = body.factored.factor.memory();
            sum.resize(memory.len().max(sum.len()), RankMemory::default());
            for (sum, memory) in sum.iter_mut().zip(memory) {
                sum.estimated += memory.estimated;
                sum.used += memory.used;
            }
        }
        sum
    }

    /// Displacement of every node of every body under the load and a contact reaction
    /// (C6), in metre.
    ///
    /// `reaction` is in newton, per unknown of the contact problem, `motion` in metre, per
    /// free mode; the result is in global axes, per body and degree of freedom.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] if reaction or motion do not fit the contact problem, [`Error::NotAccepted`] where
    /// ranks do not solve any more.
    pub fn recover(&self, reaction: &[f64], motion: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        check_length("reaction", self.problem.unknowns(), reaction.len())?;
        check_length("motion", self.problem.free_modes(), motion.len())?;
        let mut motions = motion;
        let bodies = self.bodies.iter().zip(self.interfaces.iter());
        let recovered = bodies.map(|(body, interface)| {
            let (own, rest) = motions.split_at(body.grounding().modes.ncols());
            motions = rest;
            body.recover(&interface.forces(reaction), own)
        });
        recovered.collect()
    }
}

/// The contact problem of all bodies together (C11).
fn join(
    surface: &ContactSurface,
    pairs: &[ContactPair],
    interfaces: &[Interface],
    bodies: &[CondensedBody],
    compliances: Vec<Mat<f64>>,
) -> Result<ContactProblem, Error> {
    let tangents: Vec<usize> = surface.nodes.iter().map(|node| node.tangents).collect();
    let unknowns = tangents.iter().map(|count| 1 + count).sum();
    let mut free_displacement = vec![0.0; unknowns];
    for (interface, body) in interfaces.iter().zip(bodies) {
        let action = &body.action;
        interface.add_displacement(action, &action.free_displacement, &mut free_displacement);
    }
    let mut compliances = compliances.into_iter();
    let operator = match (interfaces, compliances.next()) {
        ([interface], Some(own)) if interface.is_identity() => {
            let factor = bodies.first().map(|body| &body.factored.factor);
            Operator::of_body(own, factor.and_then(BodyFactor::trailing_block))
        }
        (_, first) => {
            let mut compliance = Mat::zeros(unknowns, unknowns);
            let compliances = first.into_iter().chain(compliances);
            for (interface, own) in interfaces.iter().zip(compliances) {
                interface.add_compliance(&own, &mut compliance);
            }
            Operator::from_bodies(compliance)?
        }
    };
    let initial_gap = surface
        .nodes
        .iter()
        .map(|node| node.initial_gap + pairs[node.pair].gap)
        .collect();
    let friction = friction(surface, pairs);
    let problem = ContactProblem::new(
        &tangents,
        friction,
        initial_gap,
        free_displacement,
        operator,
    );
    under_laws(problem?, surface, pairs)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::tests::samples::{body, distorted, facets};
    use crate::body::{CellKind, Facet, Load, Material, Mesh, Model, Support, graded, rectangle};
    use crate::contact::{ContactNode, Obstacle, Opposite};
    use faer::linalg::solvers::Solve;
    use nalgebra::{Rotation3, Vector3};

    const KINDS: [CellKind; 4] = [
        CellKind::Tri3,
        CellKind::Quad4,
        CellKind::Tet4,
        CellKind::Hex8,
    ];

    /// The distorted block above a plane 1 mm away, held at its right side, pressed on top.
    fn pressed(kind: CellKind) -> (Body, ContactPair) {
        let mut body = distorted(kind);
        let right = facets(&body.mesh, "right");
        // Contacts of quadratic facets beside it would be dragged along.
        let across = if kind.is_linear() { 0.01 } else { 0.0 };
        body.supports.push(Support::new(
            "supports[0]",
            right.into_iter().flat_map(|facet| facet.nodes).collect(),
            [Some(0.0), Some(across), Some(0.0)],
        ));
        body.loads.push(Load::Pressure {
            facets: facets(&body.mesh, "top"),
            pressure: 0.7,
        });
        let vertical = kind.dimension() - 1;
        let mut normal = [0.0; 3];
        normal[vertical] = 2.0;
        let pair = ContactPair::new(
            "contacts[0]",
            0,
            facets(&body.mesh, "bottom"),
            Opposite::Obstacle(Obstacle::Plane {
                point: normal.map(|component| -0.0005 * component),
                normal,
            }),
            0.4,
        );
        (body, pair)
    }

    fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
        values.into_iter().fold(0.0, |m, x| x.abs().max(m))
    }

    /// ε times the condition of K, some thousand, and a digit for distorted and quadratic cells.
    fn assert_close(found: &[f64], expected: &[f64]) {
        let scale = largest(expected.iter().copied());
        let difference = largest(found.iter().zip(expected).map(|(a, b)| a - b));
        assert!(difference <= 1e-11 * scale, "{difference:e} of {scale:e}");
    }

    /// A reaction with every sign, in newton.
    fn some_reaction(count: usize) -> Vec<f64> {
        (0..count).map(|i| ((5 * i) % 7) as f64 - 3.0).collect()
    }

    /// `K u − f − contact forces` (B2) per degree of freedom, in newton.
    fn unbalanced(
        condensed: &Condensed,
        body: &Body,
        reaction: &[f64],
        displacement: &[f64],
    ) -> Vec<f64> {
        let mut rest: Vec<f64> = condensed.bodies()[0].load().iter().map(|f| -f).collect();
        for (&value, (row, column)) in condensed.bodies()[0].stiffness() {
            rest[row] += value * displacement[column];
        }
        let axes = body.mesh.dimension;
        let offsets = condensed.problem().offsets();
        for (contact, &first) in condensed.surface().nodes.iter().zip(offsets) {
            for row in 0..=contact.tangents {
                for &(node, weight) in &contact.own {
                    for axis in 0..axes {
                        rest[node * axes + axis] -=
                            weight * contact.frame[row][axis] * reaction[first + row];
                    }
                }
            }
        }
        rest
    }

    #[test]
    fn the_recovered_body_is_in_equilibrium_with_load_and_contact_forces() {
        for kind in CellKind::all() {
            let (body, pair) = pressed(kind);
            let condensed = Condensed::new(std::slice::from_ref(&body), &[pair]).unwrap();
            let reaction = some_reaction(condensed.problem().unknowns());
            let displacement = condensed.recover(&reaction, &[]).unwrap().remove(0);
            let rest = unbalanced(&condensed, &body, &reaction, &displacement);
            let free = rest.iter().zip(condensed.bodies()[0].prescribed());
            let free = free.filter(|(_, u)| u.is_none()).map(|(r, _)| *r);
            assert!(largest(free) < 1e-12, "{kind:?}");
            for (u, prescribed) in displacement.iter().zip(condensed.bodies()[0].prescribed()) {
                assert!(prescribed.is_none_or(|prescribed| prescribed == *u));
            }
        }
    }

    #[test]
    fn contacts_move_as_the_recovered_body_does() {
        // (C1) with the displacements of the nodes that a contact moves with (C16).
        for kind in CellKind::all() {
            let (body, pair) = pressed(kind);
            let condensed = Condensed::new(std::slice::from_ref(&body), &[pair]).unwrap();
            let problem = condensed.problem();
            let reaction = some_reaction(problem.unknowns());
            let displacement = condensed.recover(&reaction, &[]).unwrap().remove(0);
            let moved = |contact: &ContactNode, row: usize| {
                let axes = body.mesh.dimension;
                let along = |node: usize| -> f64 {
                    let of_node = displacement[node * axes..][..axes].iter();
                    of_node.zip(contact.frame[row]).map(|(u, n)| u * n).sum()
                };
                let own = contact.own.iter();
                own.map(|&(node, weight)| weight * along(node)).sum::<f64>()
            };
            let contacts = condensed.surface().nodes.iter();
            let found: Vec<f64> = contacts
                .flat_map(|contact| (0..=contact.tangents).map(|row| moved(contact, row)))
                .collect();
            assert_close(&found, &problem.displacement(&reaction));
        }
    }

    #[test]
    fn a_solid_of_quadratic_cells_is_condensed_onto_its_contacts_and_not_onto_its_nodes() {
        for kind in CellKind::all() {
            for friction in [0.0, 0.4] {
                let (body, mut pair) = pressed(kind);
                pair.friction = friction;
                let condensed = Condensed::new(&[body], &[pair]).unwrap();
                let (found, contacts) = (
                    condensed.work().condensed_unknowns,
                    condensed.problem().unknowns(),
                );
                // In the plane two nodes per contact move with it, less one: that is left as it is.
                match kind.dimension() == 3 || kind.is_linear() {
                    true => assert_eq!(found, contacts, "{kind:?}"),
                    false => assert!(found < 2 * contacts, "{kind:?}"),
                }
            }
        }
    }

    #[test]
    fn a_scene_turned_in_space_has_the_same_contact_problem() {
        // Supports stay along axes under a turn only if they hold all of them, and tangents
        // turn along in 2D only: in 3D the scene is without friction.
        for kind in KINDS {
            let axis = match kind.dimension() {
                2 => Vector3::new(0.0, 0.0, 0.6),
                _ => Vector3::new(0.7, -0.4, 0.2),
            };
            let turn = |v: [f64; 3]| (Rotation3::new(axis) * Vector3::from(v)).into();
            let (mut body, mut pair) = pressed(kind);
            body.supports[0].displacement = [Some(0.0); 3];
            if kind.dimension() == 3 {
                pair.friction = 0.0;
            }
            let straight =
                Condensed::new(std::slice::from_ref(&body), std::slice::from_ref(&pair)).unwrap();
            body.mesh
                .nodes
                .iter_mut()
                .for_each(|node| *node = turn(*node));
            let mut turned_pair = pair;
            if let Opposite::Obstacle(Obstacle::Plane { point, normal }) = &mut turned_pair.opposite
            {
                (*point, *normal) = (turn(*point), turn(*normal));
            }
            let turned = Condensed::new(std::slice::from_ref(&body), &[turned_pair]).unwrap();
            let (a, b) = (straight.problem(), turned.problem());
            assert_close(b.initial_gap(), a.initial_gap());
            assert_close(b.free_displacement(), a.free_displacement());
            for column in 0..a.unknowns() {
                assert_close(
                    b.compliance().col_as_slice(column),
                    a.compliance().col_as_slice(column),
                );
            }
        }
    }

    #[test]
    fn a_surface_grown_over_the_sides_gives_the_same_problem_to_the_last_bit() {
        let (body, pair) = pressed(CellKind::Hex8);
        let mut grown = pair.clone();
        for side in ["left", "front", "top"] {
            grown.facets.extend(facets(&body.mesh, side));
        }
        let small = Condensed::new(std::slice::from_ref(&body), &[pair]).unwrap();
        let large = Condensed::new(std::slice::from_ref(&body), &[grown]).unwrap();
        assert_eq!(
            small.problem().free_displacement(),
            large.problem().free_displacement()
        );
        assert_eq!(small.problem().compliance(), large.problem().compliance());
    }

    #[test]
    fn a_square_pressed_on_a_smooth_bed_is_a_uniform_patch() {
        // SSNV128 with no friction: u_x(x = 0) = a [(1−ν²) σ_x − ν (1+ν) σ_y] / E
        //   = 0.04 (0.96 · 15e7 − 0.24 · 5e7) / 1.3e11 = 4.0615384615e-5 m, pressure σ_y below.
        let side = graded(0.0, 0.04, 8, 3.0).unwrap();
        let mesh = rectangle(&side, &side, CellKind::Quad4).unwrap();
        let mut square = body(mesh, Model::PlaneStrain, 0.2);
        square.materials[0].young = 1.3e11;
        let mut hold = |nodes: Vec<usize>, displacement| {
            square
                .supports
                .push(Support::new("supports", nodes, displacement));
        };
        hold((8..81).step_by(9).collect(), [Some(0.0), None, None]);
        hold(vec![8], [None, Some(0.0), None]);
        for (side, pressure) in [("top", 5e7), ("left", 15e7)] {
            square.loads.push(Load::Pressure {
                facets: facets(&square.mesh, side),
                pressure,
            });
        }
        let pair = ContactPair::new(
            "contacts[0]",
            0,
            facets(&square.mesh, "bottom"),
            Opposite::Obstacle(Obstacle::Plane {
                point: [0.0; 3],
                normal: [0.0, 1.0, 0.0],
            }),
            0.0,
        );
        let condensed = Condensed::new(&[square], &[pair]).unwrap();
        assert_eq!(condensed.surface().left_out, [(0, 8)]);
        // Every contact closes: S t = −û, for the gap is zero.
        let problem = condensed.problem();
        let free = problem.free_displacement();
        let free = Mat::from_fn(free.len(), 1, |i, _| -free[i]);
        let reaction = problem.operator().stiffness().unwrap() * free;
        for (contact, force) in condensed
            .surface()
            .nodes
            .iter()
            .zip(reaction.col_as_slice(0))
        {
            // ε times the conditions of K and of G, a thousand and ten for 8 cells graded 3 : 1.
            assert!((-force / contact.area / 5e7 - 1.0).abs() < 1e-11);
        }
        let displacement = condensed
            .recover(reaction.col_as_slice(0), &[])
            .unwrap()
            .remove(0);
        for node in (0..81).step_by(9) {
            let expected = 0.04 * (0.96 * 15e7 - 0.24 * 5e7) / 1.3e11;
            assert!((displacement[2 * node] / expected - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn one_factorisation_serves_a_condensation() {
        let (body, pair) = pressed(CellKind::Quad4);
        let condensed = Condensed::new(std::slice::from_ref(&body), &[pair]).unwrap();
        let work = condensed.work();
        // 5 × 3 nodes, 3 of them held: 24 unknowns; L has at least a triangle of the contact block.
        assert_eq!((work.factorisations, work.unknowns), (1, 24));
        assert!(work.factor_entries >= 8 * 9 / 2);
    }

    #[test]
    fn a_reaction_of_the_wrong_length_is_refused() {
        let (body, pair) = pressed(CellKind::Quad4);
        let condensed = Condensed::new(std::slice::from_ref(&body), &[pair]).unwrap();
        assert!(condensed.recover(&[0.0], &[]).is_err());
    }

    #[test]
    fn reactions_in_equilibrium_bend_a_floating_body_as_if_nothing_grounded_it() {
        // (C3), (C12): K u = f + contact forces at every unknown once Rᵀ t + e = 0.
        for kind in KINDS {
            let (mut body, pair) = pressed(kind);
            body.supports.clear();
            let condensed = Condensed::new(std::slice::from_ref(&body), &[pair]).unwrap();
            let floating = condensed.problem().floating().unwrap();
            let modes = floating.modes();
            assert_eq!(modes.ncols(), if kind.dimension() == 2 { 3 } else { 6 });
            // A reaction in equilibrium: t − R (RᵀR)⁻¹ (Rᵀ t + e).
            let reaction = some_reaction(condensed.problem().unknowns());
            let reaction = Mat::from_fn(reaction.len(), 1, |i, _| reaction[i]);
            let load = Mat::from_fn(modes.ncols(), 1, |k, _| floating.load()[k]);
            let rest = modes.transpose() * &reaction + load;
            let gram = modes.transpose() * modes;
            let reaction = reaction - modes * gram.partial_piv_lu().solve(&rest);

            let motion: Vec<f64> = (0..modes.ncols()).map(|k| 0.1 * k as f64).collect();
            let reaction = reaction.col_as_slice(0);
            let displacement = condensed.recover(reaction, &motion).unwrap().remove(0);
            let rest = unbalanced(&condensed, &body, reaction, &displacement);
            // Forces of newtons from rigid motions of up to half a metre, which K, of 10 Pa, has to take for nothing.
            assert!(largest(rest) < 1e-11, "{kind:?}");
        }
    }

    #[test]
    fn two_cells_that_share_one_node_are_a_hinge_and_refused() {
        // The second cell can turn about node 2: no rigid motion of the whole, but no stiffness.
        let at = [[0, 0], [1, 0], [1, 1], [0, 1], [2, 1], [2, 2], [1, 2]];
        let nodes = at.map(|[x, y]| [f64::from(x), f64::from(y), 0.0]);
        let mut mesh = Mesh::new(2, nodes.to_vec());
        mesh.push_cell(CellKind::Quad4, &[0, 1, 2, 3]);
        mesh.push_cell(CellKind::Quad4, &[2, 4, 5, 6]);
        let mut hinged = body(mesh, Model::PlaneStrain, 0.3);
        hinged
            .supports
            .push(Support::new("supports[0]", vec![0, 3], [Some(0.0); 3]));
        let pair = ContactPair::new(
            "contacts[0]",
            0,
            vec![Facet { nodes: vec![2, 4] }],
            Opposite::Obstacle(Obstacle::Plane {
                point: [0.0; 3],
                normal: [0.0, 1.0, 0.0],
            }),
            0.5,
        );
        let found = Condensed::new(&[hinged], &[pair]).unwrap_err();
        assert!(
            matches!(found, Error::NotPositiveDefinite { .. }),
            "{found}"
        );
    }

    #[test]
    fn a_stiff_block_on_a_soft_stem_is_not_mistaken_for_a_free_body() {
        // Cells at the supported end are 1e9 times softer than the others.
        for kind in KINDS {
            let (mut body, pair) = pressed(kind);
            let soft = body.materials[0];
            body.materials.push(Material {
                young: 1e9 * soft.young,
                ..soft
            });
            for (cell, material) in body.material_of_cell.iter_mut().enumerate() {
                *material = usize::from(body.mesh.centroid(cell)[0] < 1.2);
            }
            assert!(
                Condensed::new(std::slice::from_ref(&body), &[pair]).is_ok(),
                "{kind:?}"
            );
        }
    }
}
