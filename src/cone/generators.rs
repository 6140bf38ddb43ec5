//! Sets of reactions as images of the cones that a cone program knows.
//!
//! ```text
//! (H3)  K_i = { t_N ≤ 0, ‖t_T‖ ≤ −μ_i t_N } = T_i (cone of z_i)        v ∈ K_i* ⇔ T_iᵀ v ∈ cone of z_i
//!
//! tangents   cone of z_i        T_i z_i
//! none       z ≥ 0              t_N = −c z
//! one        z₊, z₋ ≥ 0         t_N = −c (z₊ + z₋),   t_T = −c μ (z₊ − z₋)
//! two        z_0 ≥ ‖(z_1, z_2)‖ t_N = −c z_0,         t_T = c μ (z_1, z_2)
//!
//! (H10)  of (L5): K_i and a disc,  t_T = … + c y,  ‖c y‖ ≤ a;   a cap,  ‖t_T‖ ≤ τ;   t_N of either sign,  … + c w,  w ≥ 0;
//!       t_T without a bound where it sticks
//! ```
//!
//! The scale `c_i > 0` is free. A contact with tangents but μ = 0 counts as one without.
//! Two inequalities instead of a two-dimensional cone make plane programs linear ones.

use faer::{Mat, MatRef};

use super::clarabel::ConeSizes;
use crate::problem::ContactProblem;

/// The map T over all contacts, with what bounds its `z`: `rows z + s = right`, s in the cones.
#[derive(Clone, Debug)]
pub(super) struct Generators {
    rays: Vec<Ray>,
    cones: ConeSizes,
    /// Entries per column, as they are pushed.
    rows: Vec<Vec<(usize, f64)>>,
    right: Vec<f64>,
    solid: usize,
}

/// A column of T: at most two entries, `(unknown of t, factor)`; one alone is padded with zero.
type Ray = [(usize, f64); 2];

/// `‖t_T‖` of a contact is bounded: that of some rays, or of all that it has.
struct Disc {
    /// Ray, axis of the tangents and factor.
    parts: Vec<(usize, usize, f64)>,
    tangents: usize,
    radius: f64,
}

impl Generators {
    /// Of the contacts of a problem, without tension and ellipses, with `c` per contact.
    pub(super) fn new(problem: &ContactProblem, scale: &[f64]) -> Self {
        let (mut rays, mut solid) = (Vec::new(), Vec::new());
        for (block, (contact, c)) in problem.blocks().zip(scale.iter().enumerate()) {
            let limits = problem.limits(contact);
            let (normal, bound) = (block.start, c * limits.friction);
            match block.len() - 1 {
                1 if bound > 0.0 && bound.is_finite() => {
                    rays.push([(normal, -c), (normal + 1, -bound)]);
                    rays.push([(normal, -c), (normal + 1, bound)]);
                }
                2 if bound > 0.0 && bound.is_finite() => {
                    solid.push([(normal, -c), (normal, 0.0)]);
                    solid.extend([1, 2].map(|t| [(normal + t, bound), (normal, 0.0)]));
                }
                _ => rays.push([(normal, -c), (normal, 0.0)]),
            }
            if limits.bilateral {
                rays.push([(normal, *c), (normal, 0.0)]);
            }
        }
        let (nonnegative, coned) = (rays.len(), rays.len() + solid.len());
        let mut second_order = vec![3; solid.len() / 3];
        rays.append(&mut solid);
        let mut rows: Vec<_> = (0..coned).map(|z| vec![(z, -1.0)]).collect();
        let mut right = vec![0.0; coned];
        if problem.laws().is_some() {
            let discs = discs(problem, scale, &mut rays);
            rows.resize(rays.len(), Vec::new());
            for disc in discs {
                let first = right.len();
                for (z, axis, factor) in disc.parts {
                    rows[z].push((first + 1 + axis, -factor));
                }
                right.push(disc.radius);
                right.resize(first + 1 + disc.tangents, 0.0);
                second_order.push(1 + disc.tangents);
            }
        }
        let cones = ConeSizes {
            zero: 0,
            nonnegative,
            second_order,
        };
        Self {
            rays,
            cones,
            rows,
            right,
            solid: coned - nonnegative,
        }
    }

    /// Entries of a column of what bounds z, in ascending rows.
    pub(super) fn rows(&self, column: usize) -> &[(usize, f64)] {
        &self.rows[column]
    }

    /// The right side of what bounds z.
    pub(super) fn right(&self) -> &[f64] {
        &self.right
    }

    /// Number of entries of `z`.
    pub(super) fn size(&self) -> usize {
        self.rays.len()
    }

    /// Number of entries of `z` that stand in second-order cones of their own, behind those that are not negative.
    pub(super) fn solid(&self) -> usize {
        self.solid
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

/// Discs of (H10), with rays that are added for friction without pressure and for tangents without a bound.
fn discs(problem: &ContactProblem, scale: &[f64], rays: &mut Vec<Ray>) -> Vec<Disc> {
    let of_cones = rays.clone();
    let (mut added, mut capped) = (Vec::new(), Vec::new());
    for (block, (contact, &c)) in problem.blocks().zip(scale.iter().enumerate()) {
        let limits = problem.limits(contact);
        let (tangents, first) = (block.start + 1..block.end, rays.len());
        if limits.shear > 0.0 || limits.friction.is_infinite() {
            rays.extend(tangents.clone().map(|t| [(t, c), (t, 0.0)]));
        }
        let own = (first..rays.len()).enumerate();
        let own: Vec<_> = own.map(|(axis, ray)| (ray, axis, 1.0)).collect();
        let tangents = tangents.len();
        if limits.cap.is_finite() && tangents > 0 {
            let entries = of_cones.iter().enumerate().flat_map(|(ray, entries)| {
                entries
                    .iter()
                    .map(move |(at, factor)| (ray, *at, factor / c))
            });
            let of_friction = entries.filter_map(|(ray, at, factor)| {
                let axis = at.checked_sub(block.start + 1)?;
                (axis < tangents && factor != 0.0).then_some((ray, axis, factor))
            });
            capped.push(Disc {
                parts: of_friction.chain(own.iter().copied()).collect(),
                tangents,
                radius: limits.cap / c,
            });
        }
        if limits.friction.is_finite() && !own.is_empty() {
            added.push(Disc {
                parts: own,
                tangents,
                radius: limits.shear / c,
            });
        }
    }
    added.append(&mut capped);
    added
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::problem::{Law, Operator};

    /// A 3D contact, a frictionless one with an idle tangent, a plane one, a bare one.
    fn generators() -> Generators {
        Generators::new(&problem(), &[2.0, 1.0, 4.0, 1.0])
    }

    fn problem() -> ContactProblem {
        let operator = Operator::from_compliance(Mat::identity(8, 8)).unwrap();
        let friction = vec![0.5, 0.0, 0.25, 0.7];
        ContactProblem::new(
            &[2, 1, 1, 0],
            friction,
            vec![0.0; 4],
            vec![0.0; 8],
            operator,
        )
        .unwrap()
    }

    #[test]
    fn a_law_s_set_is_a_cone_a_disc_and_a_cap() {
        // The first bears 3 N more than its friction and 4 N at most, the third sticks and holds on.
        let mut laws = vec![Law::default(); 4];
        (laws[0].shear, laws[0].cap) = (3.0, 4.0);
        (laws[2].bilateral, laws[2].sticks) = (true, true);
        let found = Generators::new(&problem().with_laws(laws).unwrap(), &[2.0; 4]);
        // Rows: 0 the second, 1–2 the third, 3 the fourth, 4–6 friction, then the disc and the cap of the first.
        let cones = found.cones();
        assert_eq!(
            (cones.nonnegative, &cones.second_order[..]),
            (4, &[3, 3, 3][..])
        );
        assert_eq!(found.right()[7..], [1.5, 0.0, 0.0, 2.0, 0.0, 0.0]);
        // Friction −0.5·2·(3, −4) by its cone, and 2·(0.5, 0) by its disc.
        let z = [0.0, 0.0, 3.0, 0.0, 5.0, 3.0, -4.0, 0.5, 0.0, 7.0];
        let t = found.reaction(&z, 8);
        assert_eq!(t, [-10.0, 4.0, -4.0, 0.0, 0.0, 6.0, 14.0, 0.0]);
        // s of the cap is t_T by c.
        let s = |row: usize| -> f64 {
            let columns = (0..z.len()).flat_map(|k| found.rows(k).iter().map(move |e| (k, e)));
            let own = columns.filter(|(_, (at, _))| *at == row);
            found.right()[row] - own.map(|(k, (_, a))| a * z[k]).sum::<f64>()
        };
        assert_eq!([10, 11, 12].map(s), [2.0, 2.0, -2.0]);
        assert_eq!([7, 8, 9].map(s), [1.5, 0.5, 0.0]);
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
