//! The judge's residuals and the balance of the bodies, under their stable names.

use serde::Serialize;

use super::ReportParts;
use crate::body::Body;
use crate::kkt;

/// Every law on the original problem, measured; see [`kkt::Certificate`].
///
/// A residual that is infinite (the state is not finite) is written as `null`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedCertificate {
    /// Natural-map residual, relative to the reaction: the stopping test.
    pub natural_map: f64,
    /// Largest load on a free rigid motion that contact does not answer, in newton; absent
    /// where supports hold every body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub equilibrium: Option<ReportedDefect>,
    /// Largest penetration, in metre.
    pub penetration: ReportedWorst,
    /// Largest normal reaction that pulls, in newton.
    pub tension: ReportedWorst,
    /// Largest work of a normal reaction across its gap, in joule.
    pub complementarity: ReportedWorst,
    /// Largest excess of a friction force over its bound, in newton.
    pub disc_excess: ReportedWorst,
    /// Largest defect of the friction law's dissipation, in joule.
    pub dissipation_defect: ReportedWorst,
    /// Bipotential gap, in joule.
    pub bipotential_gap: f64,
    /// Energy of the reaction, in joule: what the bipotential gap is compared with.
    pub reaction_energy: f64,
    /// Condition of the compliance, an estimate from below: a residual leaves single reactions wrong by
    /// up to as many times it. `null` where forces cannot be told apart; absent where it was not needed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub condition: Option<f64>,
    /// Largest difference between the displacement of a contact in the recovered bodies and
    /// in the condensed problem, in metre.
    pub recovered: ReportedWorst,
    /// Equilibrium of each whole body.
    pub bodies: Vec<ReportedBalance>,
}

/// A residual with the contact where it is worst.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedWorst {
    /// Size of the violation in physical units.
    pub value: f64,
    /// The same, relative to the load.
    pub scaled: f64,
    /// Contact, as an index into `contacts`.
    pub contact: usize,
}

/// A residual with the mesh node where it is worst.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReportedWorstNode {
    /// Size of the violation in physical units.
    pub value: f64,
    /// The same, relative to the load.
    pub scaled: f64,
    /// Node of the mesh, from 0.
    pub node: usize,
}

/// Equilibrium of a whole body, measured; see [`kkt::Balance`].
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedBalance {
    /// Name of the body.
    pub name: String,
    /// Largest nodal force that nothing carries, in newton.
    pub equilibrium: ReportedWorstNode,
    /// Largest departure from a given displacement, in metre.
    pub support: ReportedWorstNode,
    /// Given forces.
    pub loads: ReportedResultant,
    /// Contact forces on the body.
    pub contact: ReportedResultant,
    /// Support reactions on the body.
    pub supports: ReportedResultant,
    /// Length of the sum of all forces, in newton.
    pub force_defect: ReportedDefect,
    /// Length of the sum of all moments, in newton metre.
    pub moment_defect: ReportedDefect,
}

/// Sum of forces and of their moments.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReportedResultant {
    /// Force in global axes, in newton.
    pub force: Vec<f64>,
    /// Moment about the origin, in newton metre; in 2D its single component.
    pub moment: Vec<f64>,
}

/// What is left of a sum that should vanish.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReportedDefect {
    /// Size in physical units.
    pub value: f64,
    /// The same, relative to what was added.
    pub scaled: f64,
}

impl ReportedCertificate {
    pub(super) fn new(parts: &ReportParts<'_>) -> Self {
        let measured = &parts.outcome.verdict.certificate;
        let bodies = parts.bodies.iter().zip(parts.balances);
        Self {
            natural_map: measured.natural_map,
            equilibrium: (parts.problem.free_modes() > 0).then(|| measured.equilibrium.into()),
            penetration: measured.penetration.into(),
            tension: measured.tension.into(),
            complementarity: measured.complementarity.into(),
            disc_excess: measured.disc_excess.into(),
            dissipation_defect: measured.dissipation_defect.into(),
            bipotential_gap: measured.bipotential_gap,
            reaction_energy: measured.reaction_energy,
            condition: parts.outcome.condition,
            recovered: parts.departure.into(),
            bodies: bodies
                .map(|(body, balance)| ReportedBalance::new(body, balance))
                .collect(),
        }
    }
}

impl ReportedBalance {
    fn new(body: &Body, measured: &kkt::Balance) -> Self {
        let dimension = body.mesh.dimension;
        Self {
            name: body.name.clone(),
            equilibrium: measured.equilibrium.into(),
            support: measured.support.into(),
            loads: ReportedResultant::new(&measured.loads, dimension),
            contact: ReportedResultant::new(&measured.contact, dimension),
            supports: ReportedResultant::new(&measured.supports, dimension),
            force_defect: measured.force_defect.into(),
            moment_defect: measured.moment_defect.into(),
        }
    }
}

impl ReportedResultant {
    pub(super) fn new(sum: &kkt::Resultant, dimension: usize) -> Self {
        Self {
            force: in_dimension(sum.force, dimension),
            moment: match dimension {
                2 => vec![sum.moment[2]],
                _ => sum.moment.to_vec(),
            },
        }
    }
}

impl From<kkt::Worst> for ReportedWorst {
    fn from(worst: kkt::Worst) -> Self {
        let kkt::Worst {
            value,
            scaled,
            contact,
        } = worst;
        Self {
            value,
            scaled,
            contact,
        }
    }
}

impl From<kkt::WorstNode> for ReportedWorstNode {
    fn from(worst: kkt::WorstNode) -> Self {
        let kkt::WorstNode {
            value,
            scaled,
            node,
        } = worst;
        Self {
            value,
            scaled,
            node,
        }
    }
}

impl From<kkt::Defect> for ReportedDefect {
    fn from(defect: kkt::Defect) -> Self {
        let kkt::Defect { value, scaled } = defect;
        Self { value, scaled }
    }
}

/// A vector in global axes with as many components as the bodies have dimensions.
pub(super) fn in_dimension(vector: [f64; 3], dimension: usize) -> Vec<f64> {
    vector.into_iter().take(dimension).collect()
}
