//! One scene, two operators: where half-spaces in place of the bodies are good enough.
//!
//! ```text
//! (M8)  u = G t + R α,   Rᵀ (t − t_scene) = 0      G: half-spaces of the bodies' materials; R: rigid motions
//! ```
//!
//! The same contacts with the same gaps and laws carry the same resultants: what differs is what the
//! shape of the bodies, their supports and loads do to their compliance, and a mesh that is too coarse.
//! Every contact's force is spread over a square (in 2D a strip) of the contact's area.

use std::ops::Range;

use faer::Mat;

use crate::alternation::{Outcome, Settings, Status, solve};
use crate::body::{Body, Model};
use crate::contact::ContactNode;
use crate::error::Error;
use crate::half_space::{ElasticHalf, Influence};
use crate::kkt::ContactStatus;
use crate::pipeline::{Solution, solve as solve_scene};
use crate::problem::{ContactProblem, Floating, Operator};
use crate::report::{Cell, Table};
use crate::scene::Scene;

/// Least cosine between a contact's normal and their mean: steeper surfaces are no half-space.
const FLAT: f64 = 0.9;

/// Difference of pressures, relative to the peak, up to which a half-space counts as good enough.
const GOOD: f64 = 0.05;

/// Logarithmic displacements vanish this many lengths of the contact surface away.
const DATUM: f64 = 10.0;

/// A scene beside the same contacts on half-spaces.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfSpaceFit {
    /// How the scene ended, and the contacts on half-spaces.
    pub status: [Status; 2],
    /// Largest difference of pressures, relative to the scene's peak.
    pub worst: f64,
    /// Where it is, in metre.
    pub worst_at: [f64; 3],
    /// Root mean square of the difference over the area that touches in either, relative to the peak.
    pub mean: f64,
    /// Part of that area where the difference is at most a twentieth.
    pub good: f64,
    /// Area in contact of the scene and on half-spaces, in m².
    pub area: [f64; 2],
    /// Peak pressure of both, in Pa.
    pub peak: [f64; 2],
    /// The difference as a field, a row per contact: position, pressures, shears in Pa, their difference
    /// relative to the peak, states.
    pub contacts: Table,
}

impl HalfSpaceFit {
    /// Whether both were certified.
    #[must_use]
    pub fn certified(&self) -> bool {
        self.status == [Status::Certified; 2]
    }

    /// What it says, in words.
    #[must_use]
    pub fn sentence(&self) -> String {
        let [x, y, z] = self.worst_at;
        format!(
            "on half-spaces pressure is off by {:.1} % of its peak root mean square, at worst by {:.1} % at \
             ({x:.4e}, {y:.4e}, {z:.4e}); at most 5 % off over {:.0} % of the contact; area {:.4e} for {:.4e}, \
             peak {:.4e} for {:.4e}",
            100.0 * self.mean,
            100.0 * self.worst,
            100.0 * self.good,
            self.area[1],
            self.area[0],
            self.peak[1],
            self.peak[0],
        )
    }
}

/// Solves a scene, and its contacts again on half-spaces under the same resultants (M8).
///
/// # Errors
///
/// Whatever is wrong with the scene; one that half-spaces cannot stand for, with what is in the way: load
/// steps, several contacts, axisymmetric bodies or plane stress, several materials in a body, supports at
/// the contact surface (such as a plane of symmetry), a contact surface that is not almost flat.
pub fn half_space_fit(scene: &Scene) -> Result<HalfSpaceFit, Error> {
    let solution = match scene.steps.is_some() || scene.contacts.len() != 1 {
        true => refuse(
            "scene",
            "steps or several contacts",
            "one state of one contact",
        )
        .map_err(|error| scene.locate(error)),
        false => solve_scene(scene),
    }?;
    fit(&solution).map_err(|error| scene.locate(error))
}

fn fit(solution: &Solution) -> Result<HalfSpaceFit, Error> {
    let problem = Halves::new(solution)?.problem(solution)?;
    let outcome = solve(&problem, &Settings::default())?;
    Ok(compare(solution, &outcome))
}

fn refuse<T>(place: &str, found: &str, accepted: &str) -> Result<T, Error> {
    Err(Error::NotAccepted {
        place: place.to_owned(),
        found: found.to_owned(),
        accepted: format!("{accepted}, to compare with half-spaces"),
    })
}

/// The contact surface as a plane between half-spaces.
struct Halves<'a> {
    nodes: &'a [ContactNode],
    influence: Influence,
    plane: bool,
    /// Normal and two tangents of the plane.
    basis: [[f64; 3]; 3],
    centre: [f64; 3],
    /// Largest distance from the centre.
    extent: f64,
}

impl<'a> Halves<'a> {
    fn new(solution: &'a Solution) -> Result<Self, Error> {
        let nodes = solution.condensed().surface().nodes.as_slice();
        let bodies = solution.bodies();
        let Some(first) = nodes.first() else {
            return refuse("contacts[0]", "no contact", "a contact surface");
        };
        if nodes.iter().any(|node| is_supported(node, bodies)) {
            let found = "a support at the contact surface";
            let accepted = "no support there, and a body cut at a plane of symmetry drawn whole";
            return refuse("supports", found, accepted);
        }
        let plane = match bodies[first.body].model {
            Model::PlaneStrain => true,
            Model::Solid => false,
            Model::PlaneStress { .. } | Model::Axisymmetric => {
                return refuse("model", "another model", "plane_strain or solid");
            }
        };
        let material = half(&bodies[first.body])?;
        let other = first.opposite.as_ref();
        let other = other.map(|other| half(&bodies[other.body])).transpose()?;
        let total: f64 = nodes.iter().map(|node| node.area).sum();
        let mean = |of: &dyn Fn(&ContactNode) -> [f64; 3]| {
            nodes
                .iter()
                .fold([0.0; 3], |sum, node| add(sum, node.area / total, of(node)))
        };
        let normal = unit(mean(&|node| node.frame[0]));
        let centre = mean(&|node| node.position);
        if nodes.iter().any(|node| dot(node.frame[0], normal) < FLAT) {
            return refuse(
                "contacts[0]",
                "a surface that turns",
                "one that is almost flat",
            );
        }
        let along = first.frame[1];
        let along = unit(add(along, -dot(along, normal), normal));
        let away = |node: &ContactNode| {
            let from = add(node.position, -1.0, centre);
            dot(from, from).sqrt()
        };
        Ok(Self {
            influence: Influence::new(material, other)?,
            plane,
            basis: [normal, along, cross(normal, along)],
            centre,
            extent: nodes.iter().map(away).fold(f64::MIN_POSITIVE, f64::max),
            nodes,
        })
    }

    /// The scene's contacts on half-spaces, under the scene's resultants.
    fn problem(&self, solution: &Solution) -> Result<ContactProblem, Error> {
        let (of_scene, reaction) = (solution.condensed().problem(), &solution.outcome().reaction);
        let blocks: Vec<Range<usize>> = of_scene.blocks().collect();
        let tangents: Vec<usize> = blocks.iter().map(|block| block.len() - 1).collect();
        let problem = ContactProblem::new(
            &tangents,
            of_scene.friction().to_vec(),
            of_scene.initial_gap().to_vec(),
            vec![0.0; of_scene.unknowns()],
            Operator::from_compliance(self.compliance(&blocks))?,
        )?;
        let modes = self.modes(&blocks, tangents.iter().any(|count| *count > 0));
        let load = modes.col_iter().map(|mode| {
            let work = mode.iter().zip(reaction).map(|(r, t)| r * t);
            -work.sum::<f64>()
        });
        let load = load.collect();
        problem.float(Floating::new(modes, load)?)
    }

    /// G (M8) over the unknowns of the blocks, in m/N.
    fn compliance(&self, blocks: &[Range<usize>]) -> Mat<f64> {
        let unknowns = blocks.last().map_or(0, |last| last.end);
        let mut compliance = Mat::zeros(unknowns, unknowns);
        for i in 0..blocks.len() {
            for j in 0..=i {
                // Squares of two sizes feel each other alike only far away.
                let (one, other) = (self.moved(i, j), self.moved(j, i));
                for (a, row) in blocks[i].clone().enumerate() {
                    for (b, column) in blocks[j].clone().enumerate() {
                        let between = |moved: [[f64; 3]; 3], [to, from]: [[f64; 3]; 2]| {
                            (0..3).map(|k| to[k] * dot(moved[k], from)).sum::<f64>()
                        };
                        let [to, from] = [self.seen(i, a), self.seen(j, b)];
                        let entry = 0.5 * (between(one, [to, from]) + between(other, [from, to]));
                        compliance[(row, column)] = entry;
                        compliance[(column, row)] = entry;
                    }
                }
            }
        }
        compliance
    }

    /// A row of a contact's frame in the plane's basis.
    fn seen(&self, contact: usize, row: usize) -> [f64; 3] {
        let axis = self.nodes[contact].frame[row];
        self.basis.map(|of_plane| dot(axis, of_plane))
    }

    /// Displacement at a contact by unit forces on another, both in the plane's basis.
    fn moved(&self, at: usize, of: usize) -> [[f64; 3]; 3] {
        let from = add(self.nodes[at].position, -1.0, self.nodes[of].position);
        let [x, y] = [dot(from, self.basis[1]), dot(from, self.basis[2])];
        let area = self.nodes[of].area;
        match self.plane {
            true => self.influence.of_strip(area, DATUM * self.extent, x),
            false => self.influence.of_rectangle([area.sqrt(); 2], [x, y]),
        }
    }

    /// R: rigid motions that the contacts feel, per unknown.
    fn modes(&self, blocks: &[Range<usize>], rough: bool) -> Mat<f64> {
        let [normal, along, across] = self.basis;
        let mut motions = vec![(normal, false), (across, true)];
        if !self.plane {
            motions.push((along, true));
        }
        if rough {
            motions.push((along, false));
        }
        if rough && !self.plane {
            motions.extend([(across, false), (normal, true)]);
        }
        let mut modes = Mat::zeros(blocks.last().map_or(0, |last| last.end), motions.len());
        for (node, block) in self.nodes.iter().zip(blocks) {
            let from = add(node.position, -1.0, self.centre);
            for (column, &(axis, turns)) in motions.iter().enumerate() {
                let moved = match turns {
                    true => cross(axis, from).map(|part| part / self.extent),
                    false => axis,
                };
                for (a, row) in block.clone().enumerate() {
                    modes[(row, column)] = dot(node.frame[a], moved);
                }
            }
        }
        modes
    }
}

/// Whether a support holds a node of a contact, on either side.
fn is_supported(contact: &ContactNode, bodies: &[Body]) -> bool {
    let holds = |body: usize, node: usize| {
        let mut supports = bodies[body].supports.iter();
        supports.any(|support| support.nodes.contains(&node))
    };
    let other = contact.opposite.iter();
    let mut other = other.flat_map(|other| other.nodes.iter().map(|node| (other.body, node.0)));
    holds(contact.body, contact.node) || other.any(|(body, node)| holds(body, node))
}

/// The half-space of a body's only material.
fn half(body: &Body) -> Result<ElasticHalf, Error> {
    match body.materials[..] {
        [material] => Ok(ElasticHalf {
            young: material.young,
            poisson: material.poisson,
        }),
        _ => refuse("materials", "several materials", "one per body"),
    }
}

fn compare(solution: &Solution, halves: &Outcome) -> HalfSpaceFit {
    let (problem, scene) = (solution.condensed().problem(), solution.outcome());
    let nodes = &solution.condensed().surface().nodes;
    let pressure =
        |outcome: &Outcome, at: usize| -outcome.reaction[problem.normals()[at]] / nodes[at].area;
    let shear = |outcome: &Outcome, at: usize| {
        let tangents = &outcome.reaction[problem.block(at)][1..];
        tangents.iter().fold(0.0, |sum: f64, t| sum.hypot(*t)) / nodes[at].area
    };
    let both = [scene, halves];
    let peak = both
        .map(|outcome| (0..nodes.len()).fold(0.0_f64, |most, at| most.max(pressure(outcome, at))));
    let mut fit = HalfSpaceFit {
        status: both.map(|outcome| outcome.status),
        worst: 0.0,
        worst_at: [0.0; 3],
        mean: 0.0,
        good: 0.0,
        area: [0.0; 2],
        peak,
        contacts: Table::default(),
    };
    let mut touched = 0.0;
    for (at, node) in nodes.iter().enumerate() {
        let pressures = both.map(|outcome| pressure(outcome, at));
        let states = both.map(|outcome| outcome.verdict.status[at]);
        let off = if peak[0] > 0.0 {
            (pressures[1] - pressures[0]) / peak[0]
        } else {
            0.0
        };
        for (area, state) in fit.area.iter_mut().zip(states) {
            *area += if state == ContactStatus::Open {
                0.0
            } else {
                node.area
            };
        }
        if states != [ContactStatus::Open; 2] {
            touched += node.area;
            fit.mean += node.area * off * off;
            fit.good += if off.abs() <= GOOD { node.area } else { 0.0 };
        }
        if off.abs() > fit.worst {
            (fit.worst, fit.worst_at) = (off.abs(), node.position);
        }
        let [x, y, z] = node.position;
        let numbers = [
            ("x", x),
            ("y", y),
            ("z", z),
            ("pressure", pressures[0]),
            ("half_space_pressure", pressures[1]),
            ("difference", off),
            ("shear", shear(scene, at)),
            ("half_space_shear", shear(halves, at)),
        ];
        let numbers = numbers.map(|(name, value)| (name.to_owned(), Cell::Number(value)));
        let words = ["state", "half_space_state"].into_iter().zip(states);
        let words = words.map(|(name, state)| (name.to_owned(), Cell::Word(word(state).into())));
        fit.contacts.add(numbers.into_iter().chain(words));
    }
    if touched > 0.0 {
        fit.mean = (fit.mean / touched).sqrt();
        fit.good /= touched;
    }
    fit
}

fn word(state: ContactStatus) -> &'static str {
    match state {
        ContactStatus::Open => "open",
        ContactStatus::Stick => "stick",
        ContactStatus::Slip => "slip",
    }
}

fn add(a: [f64; 3], factor: f64, b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] + factor * b[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|part| part / length)
}
