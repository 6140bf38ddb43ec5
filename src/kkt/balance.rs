//! Equilibrium of a whole body, from its recovered displacement.
//!
//! ```text
//! (K4)  K u = f + c + s      f loads, c contact forces, s support reactions, at every node
//!       Σ f + Σ c + Σ s = 0,   Σ x × (f + c + s) = 0
//! ```
//!
//! K holds the springs of a foundation, whose forces count as of supports. Where a displacement is free, `s` must vanish: what is left of it is the residual. On an
//! axisymmetric body nodal forces are those of whole rings: across the axis they are no resultant,
//! and only the sums along it have to vanish.

use super::body_state::BodyState;
use super::certificate::{Defect, Worst, length};
use super::resultant::{Resultant, nodal_lengths};
use crate::body;
use crate::body::Model;
use crate::error::Error;

/// A body is in equilibrium if what nothing carries is less than this part of the largest force on it,
/// and where a support is, to this part of the largest displacement,
const UNCARRIED: f64 = 1e-6;

/// or if it is less than this part of the forces of the cells themselves: rounding, however they cancel,
const ROUNDED: f64 = 1e-12;

/// as long as the sum of all forces is less than this part of what acts: of a body thousands of times as long as thick,
/// rounding may be larger than all of it. Contact forces that are themselves rounding do not count, nor, where supports move
/// the body, loads below the last digit of the forces of the cells.
const UNANSWERED: f64 = 1e-3;

/// A residual with the node where it is worst.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorstNode {
    /// Size in physical units.
    pub value: f64,
    /// The same, divided by the scale of that unit.
    pub scaled: f64,
    /// Node of the mesh.
    pub node: usize,
}

/// Equilibrium (K4) of one body, measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Balance {
    /// Largest force that nothing carries at a free displacement, in newton; scaled by
    /// the largest nodal load, contact force or support reaction.
    pub equilibrium: WorstNode,
    /// `Σ |K_ij u_j|` at that node, in newton: forces of the cells before they cancel.
    pub inner: f64,
    /// Largest departure from a given displacement, in metre; scaled by the largest displacement.
    pub support: WorstNode,
    /// Given forces.
    pub loads: Resultant,
    /// Contact forces on the body.
    pub contact: Resultant,
    /// Support reactions on the body, and forces of the springs that hold it (B13).
    pub supports: Resultant,
    /// Length of the sum of all forces.
    pub force_defect: Defect,
    /// The same as a part of loads or contact forces; zero where there are none.
    pub unanswered: f64,
    /// Length of the sum of all moments; scaled by the sum of forces at the farthest node.
    pub moment_defect: Defect,
}

impl Balance {
    /// Whether the recovered body is in equilibrium at all: it is not where the cells leave the
    /// stiffness no digits.
    #[must_use]
    pub fn holds(&self) -> bool {
        let carried =
            self.equilibrium.scaled <= UNCARRIED || self.equilibrium.value <= ROUNDED * self.inner;
        carried && self.unanswered <= UNANSWERED && self.support.scaled <= UNCARRIED
    }
}

/// Measures (K4).
///
/// # Errors
///
/// [`Error::Length`] if arrays do not belong together, [`Error::UnknownIndex`] if a
/// contact stands at a node that the mesh does not have.
pub fn balance(state: &BodyState<'_>) -> Result<Balance, Error> {
    state.check()?;
    let contact = state.contact_forces();
    let support = state.support_reactions(&contact);
    let [held, loose] = state.explained(&support);

    let (nodes, dimension) = (&state.body.mesh.nodes, state.dimension());
    // The ground answers springs as it answers supports.
    let held = match body::foundation_forces(state.body, state.displacement) {
        Some(springs) => held.iter().zip(springs).map(|(s, k)| s + k).collect(),
        None => held,
    };
    let parts = [state.load, &contact, &held];
    // The largest nodal force of each, and the sum of all.
    let sizes = parts.map(|part| {
        nodal_lengths(part, dimension).fold((0.0_f64, 0.0), |(most, sum), size| {
            (most.max(size), sum + size)
        })
    });
    let force = sizes.iter().fold(0.0_f64, |most, size| most.max(size.0));
    let [acting, pressing, holding] = sizes.map(|(_, sum)| sum);
    let total = acting + pressing + holding;
    let [loads, contact, supports] = parts.map(|part| Resultant::of(nodes, part, dimension));
    let motion = nodal_lengths(state.displacement, dimension).fold(0.0, f64::max);
    let reach = nodes.iter().map(|&x| length(x)).fold(0.0, f64::max);
    let [forces, moments] = match state.body.model {
        Model::Axisymmetric => [parts.map(axial), [[0.0; 3]; 3]],
        _ => [
            [loads.force, contact.force, supports.force],
            [loads.moment, contact.moment, supports.moment],
        ],
    };
    let equilibrium = worst_node(&loose, force, dimension);
    let force_defect = Defect::of(&forces, total);
    let inner = state.inner_force(equilibrium.node);
    let mut motions = state.prescribed.iter().flatten().chain(state.values);
    let moved = motions.any(|u| *u != 0.0);
    let given = if pressing > ROUNDED * inner {
        acting.max(pressing)
    } else if acting > f64::EPSILON * inner || !moved {
        acting
    } else {
        0.0
    };
    Ok(Balance {
        inner,
        equilibrium,
        support: worst_node(&state.support_departure(), motion, dimension),
        loads,
        contact,
        supports,
        unanswered: match given > 0.0 {
            true => force_defect.value / given,
            false => 0.0,
        },
        force_defect,
        moment_defect: Defect::of(&moments, total * reach),
    })
}

fn worst_node(values: &[f64], scale: f64, dimension: usize) -> WorstNode {
    let mut worst = Worst::default();
    for (node, value) in nodal_lengths(values, dimension).enumerate() {
        worst.raise(value, node);
    }
    let worst = worst.over(scale);
    WorstNode {
        value: worst.value,
        scaled: worst.scaled,
        node: worst.contact,
    }
}

/// Sum of nodal forces along the axis: those around it balance ring by ring.
fn axial(forces: &[f64]) -> [f64; 3] {
    [0.0, forces.iter().skip(1).step_by(2).sum(), 0.0]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::mat;
    use sprs::{CsMat, TriMat};

    use super::*;
    use crate::body::{Body, Mesh};
    use crate::contact::{ContactNode, ContactSurface};
    use crate::kkt::tests::samples::lid_on_box;
    use crate::problem::{ContactProblem, Operator};

    /// A spring of 4 N/m from a held node (3, 1) down to a contact node (3, 0), which a
    /// load of 10 N pushes 0.5 m down onto a plane: the spring takes 2 N, the plane 8 N.
    struct Spring {
        body: Body,
        stiffness: CsMat<f64>,
        surface: ContactSurface,
        problem: ContactProblem,
    }

    const LOAD: [f64; 4] = [0.0, 0.0, 0.0, -10.0];
    const PRESCRIBED: [Option<f64>; 4] = [Some(0.0), Some(0.0), None, None];

    impl Spring {
        fn new() -> Self {
            let mut entries = TriMat::new((4, 4));
            for (row, column, k) in [(1, 1, 4.0), (1, 3, -4.0), (3, 1, -4.0), (3, 3, 4.0)] {
                entries.add_triplet(row, column, k);
            }
            let contact = ContactNode {
                body: 0,
                node: 1,
                own: vec![(1, 1.0)],
                opposite: None,
                pair: 0,
                position: [3.0, 0.0, 0.0],
                frame: [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
                tangents: 0,
                initial_gap: 0.5,
                area: 1.0,
                bulge: 0.0,
                second: false,
                rim: false,
            };
            let operator = Operator::from_compliance(mat![[0.25]]).unwrap();
            Self {
                body: Body::new(
                    "spring",
                    Mesh::new(2, vec![[3.0, 1.0, 0.0], [3.0, 0.0, 0.0]]),
                    Model::PlaneStrain,
                    vec![],
                ),
                stiffness: entries.to_csr(),
                surface: ContactSurface {
                    nodes: vec![contact],
                    ..Default::default()
                },
                problem: ContactProblem::new(&[0], vec![0.0], vec![0.5], vec![2.5], operator)
                    .unwrap(),
            }
        }

        fn balance(&self, reaction: f64, displacement: &[f64]) -> Result<Balance, Error> {
            balance(&BodyState {
                index: 0,
                body: &self.body,
                stiffness: &self.stiffness,
                load: &LOAD,
                prescribed: &PRESCRIBED,
                equations: &[],
                values: &[],
                surface: &self.surface,
                problem: &self.problem,
                reaction: &[reaction],
                displacement,
            })
        }
    }

    #[test]
    fn the_spring_and_the_plane_share_the_load() {
        let found = Spring::new().balance(-8.0, &[0.0, 0.0, 0.0, -0.5]).unwrap();
        assert_eq!(found.loads.force, [0.0, -10.0, 0.0]);
        assert_eq!(found.contact.force, [0.0, 8.0, 0.0]);
        assert_eq!(found.supports.force, [0.0, 2.0, 0.0]);
        // All act along x = 3.
        assert_eq!(found.contact.moment, [0.0, 0.0, 24.0]);
        assert_eq!((found.equilibrium.value, found.support.value), (0.0, 0.0));
        assert_eq!(
            (found.force_defect.value, found.moment_defect.value),
            (0.0, 0.0)
        );
    }

    #[test]
    fn a_missing_contact_force_is_found_at_its_node() {
        // K u − f − c = −2 + 10 − 3 = 5 N at node 1; largest nodal force: the load.
        let found = Spring::new().balance(-3.0, &[0.0, 0.0, 0.0, -0.5]).unwrap();
        let expected = WorstNode {
            value: 5.0,
            scaled: 0.5,
            node: 1,
        };
        assert_eq!(found.equilibrium, expected);
        // −10 + 3 + 2 = −5 N of 15 N; moment 3 m · 5 N of 15 N · √10 m.
        assert_eq!(
            (found.force_defect.value, found.force_defect.scaled),
            (5.0, 5.0 / 15.0)
        );
        assert!((found.moment_defect.scaled - 1.0 / 10.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn a_support_that_gives_way_is_measured() {
        let found = Spring::new().balance(-8.0, &[0.1, 0.0, 0.0, -0.5]).unwrap();
        assert_eq!(
            found.support,
            WorstNode {
                value: 0.1,
                scaled: 0.2,
                node: 0
            }
        );
    }

    #[test]
    fn a_body_on_the_other_side_receives_the_weighted_opposite() {
        // The lid presses 8 N down and drags 2 N along −x: ¾ at the near node, ¼ at the far.
        let (bodies, surface, problem) = lid_on_box(0.0);
        let stiffness = TriMat::new((4, 4)).to_csr();
        let found = balance(&BodyState {
            index: 1,
            body: &bodies[1],
            stiffness: &stiffness,
            load: &[0.0; 4],
            prescribed: &[Some(0.0); 4],
            equations: &[],
            values: &[],
            surface: &surface,
            problem: &problem,
            reaction: &[-8.0, 2.0],
            displacement: &[0.0; 4],
        })
        .unwrap();
        assert_eq!(found.contact.force, [-2.0, -8.0, 0.0]);
        // −¼ · 8 N at x = 4 m; the support answers.
        assert_eq!(found.contact.moment, [0.0, 0.0, -8.0]);
        assert_eq!(found.supports.force, [2.0, 8.0, 0.0]);
        assert_eq!(found.force_defect.value, 0.0);
    }

    #[test]
    fn a_nan_is_an_infinite_residual() {
        let found = Spring::new()
            .balance(f64::NAN, &[0.0, 0.0, 0.0, -0.5])
            .unwrap();
        assert_eq!(found.equilibrium.value, f64::INFINITY);
        assert_eq!(found.force_defect.scaled, f64::INFINITY);
    }

    #[test]
    fn arrays_of_another_body_and_unknown_nodes_are_refused() {
        let mut spring = Spring::new();
        assert!(matches!(
            spring.balance(0.0, &[0.0; 3]),
            Err(Error::Length { .. })
        ));
        spring.surface.nodes[0].own[0].0 = 7;
        assert!(matches!(
            spring.balance(0.0, &[0.0; 4]),
            Err(Error::UnknownIndex { .. })
        ));
    }
}
