//! A basis of the rigid motions that the supports leave free.
//!
//! ```text
//! (B8)  u(x) = a + ω × (x − c),     mean over the nodes of u_j · u_k = δ_jk
//! ```
//!
//! Modes are free of units of rotation: each displaces its part by one in the root mean square, so that
//! amplitudes of translations and rotations compare.

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::Body;
use super::rigid::{Motion, Part, parts};

/// A rigid motion of a part of a body; amplitudes are in metre.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RigidMode {
    /// Displacement of the centre, per amplitude.
    pub translation: [f64; 3],
    /// Rotation about the centre, in 1/m per amplitude.
    pub rotation: [f64; 3],
    /// Mean position of the part's nodes, in metre.
    pub centre: [f64; 3],
    /// Number of the connected part in the body; modes of one part stand together.
    pub part: usize,
}

impl RigidMode {
    /// Displacement at a position of the part, per amplitude.
    #[must_use]
    pub(crate) fn displacement(&self, position: [f64; 3]) -> [f64; 3] {
        let arm = Vector3::from(position) - Vector3::from(self.centre);
        (Vector3::from(self.translation) + Vector3::from(self.rotation).cross(&arm)).into()
    }
}

/// All free rigid motions of a body, and who takes part in them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FreeModes {
    /// The basis (B8): none where the supports hold every part.
    pub modes: Vec<RigidMode>,
    /// Nodes of each connected part.
    pub parts: Vec<Vec<usize>>,
}

/// Basis (B8) of the rigid motions that the prescribed components (as from
/// [`prescribed`](super::prescribed())) leave free: up to six per connected part, three in 2D.
///
/// Where a part is entirely free, the first modes are the translations along the axes.
/// The body has passed [`check`](super::check()).
#[must_use]
pub(crate) fn free_modes(body: &Body, prescribed: &[Option<f64>]) -> FreeModes {
    let parts = parts(body);
    let mut modes = Vec::new();
    for (index, nodes) in parts.iter().enumerate() {
        let part = Part::new(body, nodes);
        let metric = metric(body, &part, nodes);
        for motion in orthonormal(&part.free_basis(nodes, prescribed), &metric) {
            let (translation, rotation) = part.split(motion);
            modes.push(RigidMode {
                translation: translation.into(),
                rotation: rotation.into(),
                centre: part.centre.into(),
                part: index,
            });
        }
    }
    FreeModes { modes, parts }
}

/// `M` with `a·M b` = mean over the nodes of the product of two motions `(a, ω L)`.
///
/// Rotation about the mean position does not mix with translation:
/// `mean (ω × r)·(ω × r) = ω · (tr J I − J) ω`, `J = mean r rᵀ`.
fn metric(body: &Body, part: &Part<'_>, nodes: &[usize]) -> SMatrix<f64, 6, 6> {
    let mut second = Matrix3::zeros();
    for &node in nodes {
        let arm = (Vector3::from(body.mesh.nodes[node]) - part.centre) / part.size;
        second += arm * arm.transpose();
    }
    second /= nodes.len() as f64;
    let inertia = Matrix3::identity() * second.trace() - second;
    let mut metric = SMatrix::<f64, 6, 6>::identity();
    metric.fixed_view_mut::<3, 3>(3, 3).copy_from(&inertia);
    metric
}

/// The same span, orthonormal in `metric` (Gram–Schmidt, twice to be orthogonal to round-off).
fn orthonormal(motions: &[Motion], metric: &SMatrix<f64, 6, 6>) -> Vec<Motion> {
    let mut basis: Vec<Motion> = Vec::new();
    for &motion in motions {
        let left = (0..2).fold(motion, |left, _| {
            basis
                .iter()
                .fold(left, |left, mode| left - mode * mode.dot(&(metric * left)))
        });
        basis.push(left / left.dot(&(metric * left)).sqrt());
    }
    basis
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::tests::samples::{block, support};
    use crate::body::{CellKind, prescribed};

    fn modes_of(body: &Body) -> FreeModes {
        free_modes(body, &prescribed(body).unwrap())
    }

    fn products(body: &Body, found: &FreeModes) -> Vec<Vec<f64>> {
        let mean = |a: &RigidMode, b: &RigidMode| {
            if a.part != b.part {
                return 0.0;
            }
            let nodes = &found.parts[a.part];
            let at = |node: &usize| {
                let x = body.mesh.nodes[*node];
                Vector3::from(a.displacement(x)).dot(&Vector3::from(b.displacement(x)))
            };
            nodes.iter().map(at).sum::<f64>() / nodes.len() as f64
        };
        found
            .modes
            .iter()
            .map(|a| found.modes.iter().map(|b| mean(a, b)).collect())
            .collect()
    }

    #[test]
    fn a_free_body_has_six_orthonormal_motions_and_a_plane_one_three() {
        for (kind, count) in [(CellKind::Hex8, 6), (CellKind::Quad4, 3)] {
            let mut body = block(kind);
            for x in &mut body.mesh.nodes {
                *x = [1e-3 * x[0] + 5.0, 1e-3 * x[1] - 3.0, 1e-3 * x[2]];
            }
            let found = modes_of(&body);
            assert_eq!(found.modes.len(), count);
            assert_eq!(found.modes[0].translation, [1.0, 0.0, 0.0]);
            for (j, row) in products(&body, &found).iter().enumerate() {
                for (k, product) in row.iter().enumerate() {
                    let expected = f64::from(u8::from(j == k));
                    // Coordinates near 5 of a body of 1e-3: arms are known to ε · 5e3 = 1e-12.
                    assert!((product - expected).abs() < 1e-11, "{j} {k} {product}");
                }
            }
        }
    }

    #[test]
    fn free_motions_of_a_partly_held_body_leave_its_supports_alone() {
        // Rollers under the base of a solid: two translations and the turn about the vertical are left.
        let mut body = block(CellKind::Hex8);
        let base: Vec<usize> = (0..body.mesh.nodes.len())
            .filter(|&node| body.mesh.nodes[node][2] == 0.0)
            .collect();
        body.supports = vec![support(&base, &[2])];
        let found = modes_of(&body);
        assert_eq!(found.modes.len(), 3);
        for mode in &found.modes {
            for &node in &base {
                assert!(mode.displacement(body.mesh.nodes[node])[2].abs() < 1e-12);
            }
        }
        body.supports.push(support(&base[..2], &[0, 1]));
        assert!(modes_of(&body).modes.is_empty());
    }

    #[test]
    fn every_part_has_its_own_motions() {
        let mut body = block(CellKind::Tri3);
        let first = body.mesh.nodes.len();
        for x in [[5.0, 5.0, 0.0], [6.0, 5.0, 0.0], [5.0, 8.0, 0.0]] {
            body.mesh.nodes.push(x);
        }
        let corners = [first, first + 1, first + 2];
        body.mesh.push_cell(CellKind::Tri3, &corners);
        body.supports = vec![support(&[first], &[0, 1])];
        let found = modes_of(&body);
        let of_part: Vec<usize> = found.modes.iter().map(|mode| mode.part).collect();
        assert_eq!(of_part, [0, 0, 0, 1]);
        assert_eq!(found.parts[1], corners);
        // The hinge of the second part stays, its other corners turn about it.
        let hinge = &found.modes[3];
        assert!(Vector3::from(hinge.displacement([5.0, 5.0, 0.0])).norm() < 1e-12);
        // Distances 0, 1, 3 from the hinge: ω² (0 + 1 + 9)/3 = 1.
        assert!((hinge.rotation[2].abs() - 0.3_f64.sqrt()).abs() < 1e-12);
    }
}
