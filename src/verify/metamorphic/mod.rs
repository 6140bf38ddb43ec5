//! METAMORPHIC BATTERY: what must not change an answer does not.
//!
//! Random scenes of two or three blocks (2D, axisymmetric, 3D; linear and quadratic cells; meshes that do not match and
//! blocks that cover each other in part; stiffness over six decades; flat and round sides; fits and gaps; friction)
//! are solved as they are, then after each of the changes below. The answer has to be the same, or to follow by a
//! known map: to rounding where the discrete problem is the same, to what the mesh resolves where it is not.

mod changes;
mod stack;

use changes::{CHANGES, Changed, OF_MESH};
use stack::Stack;

use crate::alternation::Status;
use crate::body::Body;
use crate::error::Error;
use crate::kkt::PairFit;
use crate::pipeline::{Solution, solve};
use crate::random::Random;
use crate::report::{MetamorphicBattery, MetamorphicChange, PairTotals};
use crate::scene::Scene;

/// What is compared of a solved scene.
struct Answer {
    status: Status,
    /// Why, where it is not certified.
    why: String,
    /// Per body and node.
    displacements: Vec<Vec<[f64; 3]>>,
    /// On the first side of each pair.
    forces: Vec<[f64; 3]>,
    /// Names of the bodies that carry the contacts of each pair.
    carriers: Vec<String>,
}

/// Solves `scenes` random scenes and every change of each; `each` sees what did not hold.
///
/// The same seed gives the same scenes.
///
/// # Errors
///
/// None unless the battery itself is broken: what does not hold is told in the result.
pub fn metamorphic(
    seed: u64,
    scenes: usize,
    mut each: impl FnMut(&str),
) -> Result<MetamorphicBattery, Error> {
    let mut battery = MetamorphicBattery::new(scenes, CHANGES.map(|(name, _)| name));
    for number in 0..scenes {
        let mut random = Random::stream(seed, number as u64);
        let stack = Stack::random(&mut random);
        let mut wrong = Vec::new();
        let before = Answer::of(&stack.scene()?)?;
        if before.status == Status::Certified {
            for ((_, change), told) in CHANGES.iter().zip(&mut battery.changes) {
                if let Some(changed) = change(&stack, stack.scene()?, &mut random)? {
                    wrong.extend(compare(&before, &changed, told)?);
                }
            }
        } else {
            wrong.push(format!("{:?} {}", before.status, before.why));
        }
        for wrong in wrong {
            let wrong = format!("{number} of {seed}, {stack}: {wrong}");
            each(&wrong);
            battery.wrong.push(wrong);
        }
    }
    battery.passed = battery.wrong.is_empty();
    Ok(battery)
}

/// Solves a changed scene; what does not hold, in words.
fn compare(
    before: &Answer,
    changed: &Changed,
    told: &mut MetamorphicChange,
) -> Result<Option<String>, Error> {
    let after = match Answer::of(&changed.scene) {
        Ok(after) => after,
        // A part of a surface may hang over the other side.
        Err(_) if changed.may_be_refused => {
            told.refused += 1;
            return Ok(None);
        }
        Err(error) => return Err(error),
    };
    let difference = before.difference(&after, changed);
    let within = match before.is_carried_like(&after) {
        true => changed.within,
        false => OF_MESH.max(changed.within),
    };
    told.tried += 1;
    if changed.may_be_refused && after.status == Status::CouplingFault {
        told.refused += 1;
        return Ok(None);
    }
    if within == changed.within {
        told.largest_difference = told.largest_difference.max(difference);
    }
    let holds = after.status == Status::Certified && difference <= within;
    let (name, status, why) = (told.name, after.status, &after.why);
    Ok((!holds).then(|| format!("{name}: {status:?} {difference:.1e} {why}")))
}

impl Answer {
    fn of(scene: &Scene) -> Result<Self, Error> {
        let solution = solve(scene)?;
        let report = solution.report()?;
        let pairs = &report.totals.pairs;
        let carrier = |pair: &PairTotals| {
            pair.coupling
                .as_ref()
                .map(|coupling| coupling.carried_by.clone())
        };
        Ok(Self {
            status: solution.status(),
            why: why(&solution),
            displacements: displacements(&solution),
            forces: (pairs.iter().map(|pair| padded(&pair.totals.contact_force))).collect(),
            carriers: pairs.iter().filter_map(carrier).collect(),
        })
    }

    /// Whether the same bodies carry the contacts, so that the discrete problem is the same.
    fn is_carried_like(&self, other: &Self) -> bool {
        let parts = other.carriers.len() / self.carriers.len().max(1);
        let each = self.carriers.iter().flat_map(|name| vec![name; parts]);
        each.eq(&other.carriers)
    }

    /// Largest difference from what was expected, relative to the largest displacement and to the largest force.
    fn difference(&self, after: &Self, changed: &Changed) -> f64 {
        let sums = after.forces.chunks(changed.parts).map(|parts| {
            let sum = |k: usize| parts.iter().map(|force| force[k]).sum();
            [0, 1, 2].map(sum)
        });
        let expected = self.forces.iter().map(|&force| (changed.force)(force));
        let of_forces = relative(expected.zip(sums));
        let Some(map) = &changed.displacement else {
            return of_forces;
        };
        let bodies = self.displacements.iter().zip(&changed.bodies).enumerate();
        let nodes = bodies.flat_map(|(old, (before, &new))| {
            let at = move |node| changed.nodes.get(old).map_or(node, |order| order[node]);
            let after = &after.displacements[new];
            (before.iter().enumerate()).map(move |(node, &u)| (map(u), after[at(node)]))
        });
        of_forces.max(relative(nodes))
    }
}

/// Why a solution is not certified.
fn why(solution: &Solution) -> String {
    let faults = solution.fits().iter().filter_map(PairFit::fault);
    let faults: Vec<_> = faults.map(|(name, by)| format!("{name} {by:?}")).collect();
    match solution.outcome().shortfall {
        Some(reason) => format!("{reason:?}"),
        None => faults.join(", "),
    }
}

/// Largest distance over the largest first.
fn relative(pairs: impl Iterator<Item = ([f64; 3], [f64; 3])>) -> f64 {
    let size = |v: [f64; 3]| v.iter().fold(0.0_f64, |sum, x| sum.hypot(*x));
    let (mut apart, mut largest) = (0.0_f64, 0.0_f64);
    for (expected, found) in pairs {
        largest = largest.max(size(expected));
        apart = apart.max(size([0, 1, 2].map(|k| expected[k] - found[k])));
    }
    if apart == 0.0 { 0.0 } else { apart / largest }
}

fn displacements(solution: &Solution) -> Vec<Vec<[f64; 3]>> {
    let of_body =
        |(u, body): (&Vec<f64>, &Body)| u.chunks_exact(body.mesh.dimension).map(padded).collect();
    let bodies = solution.displacements().iter().zip(solution.bodies());
    bodies.map(of_body).collect()
}

fn padded(given: &[f64]) -> [f64; 3] {
    [0, 1, 2].map(|k| given.get(k).copied().unwrap_or(0.0))
}
