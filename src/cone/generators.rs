//! Coulomb's cones as images of the cones that a cone program knows.
//!
//! ```text
//! (H3)  K_i = { t_N ≤ 0, ‖t_T‖ ≤ −μ_i t_N } = T_i (cone of z_i)        v ∈ K_i* ⇔ T_iᵀ v ∈ cone of z_i
//!
//! tangents   cone of z_i        T_i z_i
//! none       z ≥ 0              t_N = −c z
//! one        z₊, z₋ ≥ 0         t_N = −c (z₊ + z₋),   t_T = −c μ (z₊ − z₋)
//! two        z_0 ≥ ‖(z_1, z_2)‖ t_N = −c z_0,         t_T = c μ (z_1, z_2)
//! ```
//!
//! The scale `c_i > 0` is free. A contact with tangents but μ = 0 counts as one without.
//! Two inequalities instead of a two-dimensional cone make plane programs linear ones.

use faer::{Mat, MatRef};

use super::clarabel::ConeSizes;

/// The map T over all contacts, its `z` ordered as a cone program wants its rows.
#[derive(Clone, Debug)]
pub(super) struct Generators {
    rays: Vec<Ray>,
    cones: ConeSizes,
}

/// A column of T: at most two entries, `(unknown of t, factor)`; one alone is padded with zero.
type Ray = [(usize, f64); 2];

impl Generators {
    /// For blocks that begin at `offsets` (their end appended), with μ and `c` per contact.
    pub(super) fn new(offsets: &[usize], friction: &[f64], scale: &[f64]) -> Self {
        let (mut rays, mut solid) = (Vec::new(), Vec::new());
        let mut second_order = Vec::new();
        for (contact, block) in offsets.windows(2).enumerate() {
            let (c, bound) = (scale[contact], scale[contact] * friction[contact]);
            let normal = block[0];
            match block[1] - normal - 1 {
                1 if bound > 0.0 => {
                    rays.push([(normal, -c), (normal + 1, -bound)]);
                    rays.push([(normal, -c), (normal + 1, bound)]);
                }
                2 if bound > 0.0 => {
                    solid.push([(normal, -c), (normal, 0.0)]);
                    solid.extend([1, 2].map(|t| [(normal + t, bound), (normal, 0.0)]));
                    second_order.push(3);
                }
                _ => rays.push([(normal, -c), (normal, 0.0)]),
            }
        }
        let cones = ConeSizes {
            zero: 0,
            nonnegative: rays.len(),
            second_order,
        };
        rays.append(&mut solid);
        Self { rays, cones }
    }

    /// Number of entries of `z`.
    pub(super) fn size(&self) -> usize {
        self.rays.len()
    }

    /// The cones of `z`.
    pub(super) fn cones(&self) -> &ConeSizes {
        &self.cones
    }

    /// `t = T z`, for `unknowns` entries of `t`.
    pub(super) fn reaction(&self, z: &[f64], unknowns: usize) -> Vec<f64> {
        let mut reaction = vec![0.0; unknowns];
        for (ray, z) in self.rays.iter().zip(z) {
            for (unknown, factor) in ray {
                reaction[*unknown] += factor * z;
            }
        }
        reaction
    }

    /// `Tᵀ v`.
    pub(super) fn transpose(&self, v: &[f64]) -> Vec<f64> {
        let work = |ray: &Ray| {
            ray.iter()
                .map(|(unknown, factor)| factor * v[*unknown])
                .sum()
        };
        self.rays.iter().map(work).collect()
    }

    /// Upper triangle of `Tᵀ G T`.
    pub(super) fn form(&self, g: MatRef<'_, f64>) -> Mat<f64> {
        Mat::from_fn(self.size(), self.size(), |a, b| {
            if a > b {
                return 0.0;
            }
            let [(i, x), (j, y)] = self.rays[a];
            let [(k, z), (l, w)] = self.rays[b];
            x * (z * g[(i, k)] + w * g[(i, l)]) + y * (z * g[(j, k)] + w * g[(j, l)])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A 3D contact, a frictionless one with an idle tangent, a plane one, a bare one.
    fn generators() -> Generators {
        Generators::new(
            &[0, 3, 5, 7, 8],
            &[0.5, 0.0, 0.25, 0.7],
            &[2.0, 1.0, 4.0, 1.0],
        )
    }

    #[test]
    fn rays_of_the_program_s_cones_are_rays_of_coulomb_s() {
        // Rows: 0 frictionless, 1–2 plane, 3 bare, 4–6 in space.
        let found = generators().reaction(&[1.0, 3.0, 0.0, 2.0, 5.0, 3.0, -4.0], 8);
        // In space t_N = −2·5, t_T = 2·0.5·(3, −4): on the disc; plane t_N = −4·3, t_T = −0.25·12.
        assert_eq!(found, [-10.0, 3.0, -4.0, -1.0, 0.0, -12.0, -3.0, -2.0]);
        assert_eq!(generators().cones().nonnegative, 4);
    }

    #[test]
    fn the_form_is_the_work_of_the_rays_on_each_other() {
        let g = Mat::from_fn(8, 8, |i, j| 1.0 / (1 + i + j) as f64);
        let form = generators().form(g.as_ref());
        let z = [1.0, 3.0, 0.5, 2.0, 5.0, 3.0, -4.0];
        let t = generators().reaction(&z, 8);
        let work: f64 = (0..64)
            .map(|k| t[k / 8] * g[(k / 8, k % 8)] * t[k % 8])
            .sum();
        let same: f64 = (0..49)
            .map(|k| (k / 7, k % 7))
            .map(|(a, b)| z[a] * form[(a.min(b), a.max(b))] * z[b])
            .sum();
        assert!((work - same).abs() < 1e-12 * work);
    }

    #[test]
    fn the_transposed_map_does_the_same_work() {
        let (z, v) = (
            [1.0, 3.0, 0.5, 2.0, 5.0, 3.0, -4.0],
            [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8],
        );
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (t, s) = (generators().reaction(&z, 8), generators().transpose(&v));
        assert!((dot(&t, &v) - dot(&z, &s)).abs() < 1e-14);
    }
}
