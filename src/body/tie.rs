//! Displacements that depend on each other, as linear equations.
//!
//! ```text
//! (B16)  Σ a_k u_k = b
//!        d · u = b                         a support along a direction d
//!        u − U − Θ × (x − X) = 0           nodes that move as a rigid body, X: reference point
//!        u_B − R u_A = 0                   faces that a translation or rotation R maps onto each other
//! ```
//!
//! U and Θ are columns beyond the displacements, six per tie; Θ is multiplied by the largest `‖x − X‖`, so that
//! all coefficients are of the order of one. What follows from the equations is in `dependence.rs`.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};

use super::{Body, Model, held_by_axis};

/// Columns of a tie beyond the displacements.
pub(crate) const OF_TIE: usize = 6;

/// Part of the square of the length of a group below which it is a line.
const FLAT: f64 = 1e-12;

/// Nodes whose displacements depend on each other.
#[derive(Clone, Debug, PartialEq)]
pub enum Tie {
    /// Nodes that move as a rigid body.
    Rigid(RigidGroup),
    /// Nodes that move as others do.
    Pairs(TiedPairs),
}

/// Nodes that move as a rigid body, `u = U + Θ × (x − X)`, in small displacements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RigidGroup {
    /// Where the scene says so, for messages, such as `bodies[0].rigid_groups[0]`.
    pub place: String,
    /// The nodes; those of a solid do not all lie on a line.
    pub nodes: Vec<usize>,
    /// X, in metre.
    pub reference_point: [f64; 3],
    /// U in metre, per global axis; `None` leaves it free.
    pub displacement: [Option<f64>; 3],
    /// Θ in radian, per global axis, in 2D about z alone; `None` leaves it free.
    pub rotation: [Option<f64>; 3],
}

/// Nodes that move as others do, turned: `u_B = R u_A`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TiedPairs {
    /// Where the scene says so, for messages, such as `bodies[0].periodic[0]`.
    pub place: String,
    /// Nodes `[A, B]`.
    pub pairs: Vec<[usize; 2]>,
    /// Rows of R.
    pub rotation: [[f64; 3]; 3],
}

/// What states an equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The axis of an axisymmetric body.
    Axis,
    /// A support, by its number.
    Support(usize),
    /// A tie, by its number.
    Tie(usize),
}

/// An equation (B16).
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// Columns (`dimension · node + axis`, then six per tie) and coefficients; the unknown that the equation
    /// is about stands first.
    pub terms: Vec<(usize, f64)>,
    /// Right hand side, in metre.
    pub value: f64,
    /// What states it.
    pub by: Source,
}

impl Tie {
    /// Where the scene states it.
    #[must_use]
    pub fn place(&self) -> &str {
        match self {
            Self::Rigid(group) => &group.place,
            Self::Pairs(pairs) => &pairs.place,
        }
    }
}

impl RigidGroup {
    /// Largest distance of a node from the reference point, in metre.
    pub(crate) fn size(&self, body: &Body) -> f64 {
        let arms = self.nodes.iter().map(|&node| self.arm(body, node).norm());
        arms.fold(f64::MIN_POSITIVE, f64::max)
    }

    /// Whether every rotation of the group moves its nodes against each other.
    pub(crate) fn turns(&self, body: &Body) -> bool {
        let mean = self
            .nodes
            .iter()
            .map(|&node| self.arm(body, node))
            .sum::<Vector3<f64>>();
        let mean = mean / self.nodes.len() as f64;
        let arms = self.nodes.iter().map(|&node| self.arm(body, node) - mean);
        let spread: Matrix3<f64> = arms.map(|arm| arm * arm.transpose()).sum();
        let mut spread: [f64; 3] = spread.symmetric_eigenvalues().into();
        spread.sort_by(f64::total_cmp);
        let needed = if body.mesh.dimension == 2 { 2 } else { 1 };
        spread[needed] > FLAT * spread[2]
    }

    /// `x − X`.
    pub(crate) fn arm(&self, body: &Body, node: usize) -> Vector3<f64> {
        Vector3::from(body.mesh.nodes[node]) - Vector3::from(self.reference_point)
    }
}

impl Body {
    /// Some displacements depend on others.
    pub(crate) fn is_tied(&self) -> bool {
        !self.ties.is_empty() || self.supports.iter().any(|support| !support.axes.is_empty())
    }

    /// Number of displacements.
    pub(crate) fn unknowns(&self) -> usize {
        self.mesh.dimension * self.mesh.nodes.len()
    }

    /// Motions that a rigid group has in the space of the body: columns of its tie.
    pub(crate) fn group_motions(&self) -> &'static [usize] {
        match self.model {
            Model::Solid => &[0, 1, 2, 3, 4, 5],
            Model::Axisymmetric => &[1],
            _ => &[0, 1, 5],
        }
    }
}

/// All equations (B16) of supports and ties; those of one unknown first.
pub(crate) fn equations(body: &Body) -> Vec<Equation> {
    let mut equations: Vec<Equation> = held_by_axis(body)
        .into_iter()
        .map(|unknown| Equation {
            terms: vec![(unknown, 1.0)],
            value: 0.0,
            by: Source::Axis,
        })
        .collect();
    for index in 0..body.supports.len() {
        add_support(body, index, &mut equations);
    }
    for (index, tie) in body.ties.iter().enumerate() {
        let first = body.unknowns() + OF_TIE * index;
        match tie {
            Tie::Rigid(group) => add_group(body, group, index, first, &mut equations),
            Tie::Pairs(pairs) => add_pairs(body, pairs, index, &mut equations),
        }
    }
    equations.sort_by_key(|equation| equation.terms.len() > 1);
    equations
}

fn add_support(body: &Body, index: usize, equations: &mut Vec<Equation>) {
    let (support, axes) = (&body.supports[index], body.mesh.dimension);
    for (at, &node) in support.nodes.iter().enumerate() {
        for (k, value) in support.given(at).into_iter().enumerate().take(axes) {
            let Some(value) = value else { continue };
            let direction = support.direction(at, k);
            let terms = (0..axes).map(|axis| (axes * node + axis, direction[axis]));
            let mut terms: Vec<(usize, f64)> = terms.filter(|(_, a)| *a != 0.0).collect();
            terms.sort_by(|(_, a), (_, b)| b.abs().total_cmp(&a.abs()));
            let by = Source::Support(index);
            equations.push(Equation { terms, value, by });
        }
    }
}

fn add_group(
    body: &Body,
    group: &RigidGroup,
    index: usize,
    first: usize,
    equations: &mut Vec<Equation>,
) {
    let (axes, size, by) = (body.mesh.dimension, group.size(body), Source::Tie(index));
    let turned = group.rotation.map(|angle| angle.map(|angle| size * angle));
    let given = [group.displacement, turned].concat();
    for &motion in body.group_motions() {
        if let Some(value) = given[motion] {
            let terms = vec![(first + motion, 1.0)];
            equations.push(Equation { terms, value, by });
        }
    }
    for &node in &group.nodes {
        let arm = group.arm(body, node) / size;
        for axis in 0..axes {
            // (Θ × r)_k = Θ · (r × e_k).
            let turn = arm.cross(&Vector3::ith(axis, 1.0));
            let mut terms = vec![(axes * node + axis, 1.0)];
            for &motion in body.group_motions() {
                let moves = if motion < 3 {
                    f64::from(u8::from(motion == axis))
                } else {
                    turn[motion - 3]
                };
                if moves != 0.0 {
                    terms.push((first + motion, -moves));
                }
            }
            let value = 0.0;
            equations.push(Equation { terms, value, by });
        }
    }
}

fn add_pairs(body: &Body, pairs: &TiedPairs, index: usize, equations: &mut Vec<Equation>) {
    let (axes, by) = (body.mesh.dimension, Source::Tie(index));
    for [a, b] in &pairs.pairs {
        for axis in 0..axes {
            let mut terms = BTreeMap::from([(axes * b + axis, 1.0)]);
            for (other, turned) in pairs.rotation[axis][..axes].iter().enumerate() {
                *terms.entry(axes * a + other).or_insert(0.0) -= turned;
            }
            let mut terms: Vec<_> = terms.into_iter().filter(|(_, c)| *c != 0.0).collect();
            terms.sort_by_key(|(column, _)| *column != axes * b + axis);
            if !terms.is_empty() {
                let value = 0.0;
                equations.push(Equation { terms, value, by });
            }
        }
    }
}
