//! A body that its supports do not hold, grounded so that it can be factorised.
//!
//! ```text
//! (C12)  K + Σ_d K_dd e_d e_dᵀ      d: one unknown per free mode, on which the modes are independent
//! ```
//!
//! The springs carry exactly what the loads and contact forces leave of (C3): nothing in
//! equilibrium. Their stiffness therefore changes neither reactions nor displacements,
//! once the rigid motion `R α` is added; it is only of the size of its neighbours, before nodes that move as a rigid body
//! are tied (B17): of these alone nothing but round-off would be left.

use std::borrow::Cow;

use faer::Mat;
use sprs::CsMat;

use crate::body;
use crate::body::{Body, Dependence, RigidMode};

/// Free modes of one body over its degrees of freedom, and the springs that hold them.
#[derive(Debug)]
pub(super) struct Grounding {
    /// Displacement per degree of freedom (`node · dimension + axis`) and mode.
    pub(super) modes: Mat<f64>,
    /// Degrees of freedom that a spring holds, one per mode.
    pub(super) springs: Vec<usize>,
    /// The modes in numbers, with the size of their part, in metre.
    pub(super) rigid: Vec<(RigidMode, f64)>,
}

impl Grounding {
    /// What `prescribed` leaves free of a body; nothing at all if it is held. Springs stand
    /// away from the nodes of the interface where they can.
    pub(super) fn new(
        body: &Body,
        (prescribed, tied): (&[Option<f64>], Option<&Dependence>),
        interface: &[usize],
    ) -> Self {
        let free = body::free_modes(body, prescribed);
        let axes = body.mesh.dimension;
        let mut modes = Mat::zeros(prescribed.len(), free.modes.len());
        for (k, mode) in free.modes.iter().enumerate() {
            let column = modes.col_as_slice_mut(k);
            for &node in &free.parts[mode.part] {
                let moved = mode.displacement(body.mesh.nodes[node]);
                for (axis, u) in moved[..axes].iter().enumerate() {
                    let dof = node * axes + axis;
                    if prescribed[dof].is_none() {
                        column[dof] = *u;
                    }
                }
            }
        }
        let independent = |dof: usize| tied.is_none_or(|tied| tied.of(dof).is_none());
        let free_dof = |dof: usize| prescribed[dof].is_none() && independent(dof);
        let springs = body::fixing_dofs(body, free_dof, &free, interface);
        let size = |mode: &RigidMode| {
            let nodes = free.parts[mode.part]
                .iter()
                .map(|&node| body.mesh.nodes[node]);
            let distance = |x: [f64; 3]| {
                let arm = (0..3).map(|axis| x[axis] - mode.centre[axis]);
                arm.fold(0.0, f64::hypot)
            };
            nodes.map(distance).fold(0.0, f64::max)
        };
        let rigid = free.modes.iter().map(|mode| (mode.clone(), size(mode)));
        let rigid = rigid.collect();
        Self {
            modes,
            springs,
            rigid,
        }
    }

    /// Of a body that is held.
    #[cfg(test)]
    pub(super) fn none() -> Self {
        Self {
            modes: Mat::new(),
            springs: Vec::new(),
            rigid: Vec::new(),
        }
    }

    /// (C12); the stiffness itself where the supports hold the body. `untied`: before any nodes were tied.
    pub(super) fn ground<'a>(
        &self,
        stiffness: &'a CsMat<f64>,
        untied: &CsMat<f64>,
    ) -> Cow<'a, CsMat<f64>> {
        if self.springs.is_empty() {
            return Cow::Borrowed(stiffness);
        }
        let mut grounded = stiffness.clone();
        for &dof in &self.springs {
            let own = untied.get(dof, dof).copied().unwrap_or_default();
            if let Some(entry) = grounded.get_mut(dof, dof) {
                *entry += entry.max(own);
            }
        }
        Cow::Owned(grounded)
    }
}
