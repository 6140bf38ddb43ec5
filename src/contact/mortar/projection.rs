//! What one piece of a facet contributes: its covered area and its projection of the other side.
//!
//! ```text
//! D_i = ∫ N_i dA      M_ij = ∫ N_i N_j dA      B_ik = ∫ N_i N²_k dA      P = M⁻¹ B
//! ```
//!
//! all over the covered parts. `P` is the least-squares projection of side 2 onto the
//! facet's shape functions, so that `D_i P_ik = ∫ ψ_i N²_k dA` with the dual functions
//! `ψ = D M⁻¹ N`. Rows of `B` sum to `M 1`, hence rows of `P` sum to one.
//!
//! On quadratic facets the linear `φ_j` of (C16) stand for `N_i`, and their own nodes enter by
//! `∫ ψ_j N_k dA`. Around an axis `dA = 2πr ds`.

use nalgebra::Vector3;

use super::cover::Part;
use super::pieces::Piece;
use super::quadrature::{LINEAR, integrate, points_for};
use super::view::{Outline, View};
use crate::body::{MOST_FACET_NODES, Model, around};

/// Pivot of the scaled `M` below which the covered part is too small to tell slopes.
const PIVOT: f64 = 1e-14;

/// One facet's share of the coupling; arrays per node, zero past its last one.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Projection {
    /// `D_i`, in m² (2D: metre).
    pub(super) areas: [f64; 4],
    /// `∫ N_i n dA`, in m² (2D: metre).
    pub(super) vectors: [Vector3<f64>; 4],
    /// Nodes of the facet, with `D_j` at node j alone, or with `∫ ψ_j N_k dA` (C16).
    pub(super) own: Vec<(usize, [f64; 4])>,
    /// Nodes of side 2, ascending, with `D_i P_ik = ∫ ψ_i N²_k dA`.
    pub(super) columns: Vec<(usize, [f64; 4])>,
}

impl Projection {
    /// Integrates over the parts of a piece that `opposite` pieces cover.
    pub(super) fn new(
        view: &View,
        facet: &Outline,
        piece: &Piece<'_>,
        parts: &[Part],
        opposite: &[Piece<'_>],
        model: Model,
    ) -> Self {
        let nodes = piece.hat_count();
        let around = around(model);
        let mut mass = [[0.0; 4]; 4];
        let mut own = [[0.0; 4]; MOST_FACET_NODES];
        let mut projection = Self::default();
        for part in parts {
            let across = &opposite[part.opposite];
            let mut columns = [[0.0; 4]; MOST_FACET_NODES];
            let points = match piece.corners.nodes.len().max(across.corners.nodes.len()) {
                4 => points_for(facet.distortion().max(part.outline.distortion())),
                _ => LINEAR,
            };
            let higher =
                piece.is_quadratic() || across.is_quadratic() || model == Model::Axisymmetric;
            integrate(&part.polygon, points + usize::from(higher), |at, share| {
                let of_piece = facet.shape(at);
                let position = view.position(facet.within(at, facet.height(&of_piece)));
                let stretch = share * view.unit * around(position);
                let vector = view.vector(facet.area_vector(at)) * stretch;
                let area = vector.norm();
                let here = piece.hats(&of_piece);
                let there = across.shape(&part.outline.shape(at));
                if piece.is_quadratic() {
                    for (column, value) in own.iter_mut().zip(piece.shape(&of_piece)) {
                        for (entry, hat) in column.iter_mut().zip(here) {
                            *entry += hat * value * area;
                        }
                    }
                }
                for i in 0..nodes {
                    projection.areas[i] += here[i] * area;
                    projection.vectors[i] += vector * here[i];
                    for j in 0..nodes {
                        mass[i][j] += here[i] * here[j] * area;
                    }
                    for (column, value) in columns.iter_mut().zip(there) {
                        column[i] += here[i] * value * area;
                    }
                }
            });
            let nodes = across.facet.nodes.iter().copied();
            projection.columns.extend(nodes.zip(columns));
        }
        merge(&mut projection.columns);
        let facet = piece.facet.nodes.iter().copied();
        projection.own = facet.zip(own).collect();
        projection.solve(nodes, mass);
        if !piece.is_quadratic() {
            // Biorthogonality to the last bit.
            for (i, (_, column)) in projection.own.iter_mut().enumerate() {
                *column = [0.0; 4];
                column[i] = projection.areas[i];
            }
        }
        projection
    }

    /// Replaces the columns of `B` by those of `D P = D M⁻¹ B`.
    fn solve(&mut self, nodes: usize, mass: [[f64; 4]; 4]) {
        let total: f64 = self.areas.iter().sum();
        let factor = Factor::new(nodes, mass);
        for (_, column) in self.columns.iter_mut().chain(&mut self.own) {
            match &factor {
                Some(factor) => factor.solve(column),
                // All nodes see the mean of what covers so small a part.
                None => *column = [column.iter().sum::<f64>() / total; 4],
            }
            for (entry, area) in column.iter_mut().zip(self.areas) {
                *entry *= area;
            }
        }
    }
}

/// Adds up columns of the same node.
fn merge(columns: &mut Vec<(usize, [f64; 4])>) {
    columns.sort_by_key(|column| column.0);
    columns.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            for (sum, value) in kept.1.iter_mut().zip(next.1) {
                *sum += value;
            }
        }
        same
    });
}

/// Cholesky factor of `M`, scaled to a unit diagonal: parts near a corner or an edge
/// leave the far nodes tiny entries, which scaling makes harmless.
struct Factor {
    nodes: usize,
    scale: [f64; 4],
    lower: [[f64; 4]; 4],
}

impl Factor {
    /// None if the covered part determines less than one value per node.
    fn new(nodes: usize, mass: [[f64; 4]; 4]) -> Option<Self> {
        let mut scale = [0.0; 4];
        for i in 0..nodes {
            scale[i] = mass[i][i].sqrt().recip();
        }
        let mut lower = [[0.0; 4]; 4];
        for i in 0..nodes {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
                let entry = mass[i][j] * scale[i] * scale[j] - known;
                if i != j {
                    lower[i][j] = entry / lower[j][j];
                } else if entry > PIVOT {
                    lower[i][i] = entry.sqrt();
                } else {
                    return None;
                }
            }
        }
        Some(Self {
            nodes,
            scale,
            lower,
        })
    }

    fn solve(&self, column: &mut [f64; 4]) {
        for i in 0..self.nodes {
            let known: f64 = (0..i).map(|k| self.lower[i][k] * column[k]).sum();
            column[i] = (column[i] * self.scale[i] - known) / self.lower[i][i];
        }
        for i in (0..self.nodes).rev() {
            let known: f64 = (i + 1..self.nodes)
                .map(|k| self.lower[k][i] * column[k])
                .sum();
            column[i] = (column[i] - known) / self.lower[i][i];
        }
        for (entry, scale) in column.iter_mut().zip(self.scale) {
            *entry *= scale;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `M` and `D` of a line whose covered part is `[from, to]` of its length one.
    fn line(from: f64, to: f64) -> ([[f64; 4]; 4], [f64; 2]) {
        // ∫ x^k over the part; N = (1 − x, x).
        let moment = |k: i32| (to.powi(k + 1) - from.powi(k + 1)) / f64::from(k + 1);
        let (one, x, xx) = (moment(0), moment(1), moment(2));
        let mut mass = [[0.0; 4]; 4];
        mass[0][..2].copy_from_slice(&[one - 2.0 * x + xx, x - xx]);
        mass[1][..2].copy_from_slice(&[x - xx, xx]);
        (mass, [one - x, x])
    }

    #[test]
    fn dual_functions_of_a_whole_line_are_those_of_the_books() {
        // ψ = D M⁻¹ N with D = ½, M = 1/6 [[2, 1], [1, 2]]: ψ_1 = 2 N_1 − N_2, ψ_2 = 2 N_2 − N_1.
        let (mass, areas) = line(0.0, 1.0);
        let factor = Factor::new(2, mass).map(|factor| {
            [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]].map(|mut column| {
                factor.solve(&mut column);
                [areas[0] * column[0], areas[1] * column[1]]
            })
        });
        let expected = [[2.0, -1.0], [-1.0, 2.0]];
        for (row, expected) in factor
            .into_iter()
            .flatten()
            .flatten()
            .zip(expected.iter().flatten())
        {
            assert!((row - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn dual_functions_are_biorthogonal_over_whatever_is_covered() {
        // ∫ ψ_i N_j = Σ_k A_ik M_kj = δ_ij D_i, column by column: M⁻¹ applied to those of M.
        for (from, to) in [
            (0.0, 1.0),
            (0.2, 0.9),
            (0.0, 1e-5),
            (0.999, 1.0),
            (0.5, 0.501),
        ] {
            let (mass, areas) = line(from, to);
            let factor = Factor::new(2, mass);
            assert!(factor.is_some());
            for (j, column) in mass.iter().enumerate().take(2) {
                let mut column = *column;
                if let Some(factor) = &factor {
                    factor.solve(&mut column);
                }
                for (i, area) in areas.iter().enumerate() {
                    let expected = if i == j { *area } else { 0.0 };
                    // Between ½ and ½ + w both functions are nearly one: the scaled M has an eigenvalue of
                    // 2 w²/3 = 7e-7, which leaves ε/7e-7 = 3e-10.
                    let off = (area * column[i] - expected).abs();
                    assert!(off < 1e-9 * (to - from), "{from} {to} {off:e}");
                }
            }
        }
    }

    #[test]
    fn a_part_like_a_point_gives_all_nodes_its_mean() {
        // Covered [½, ½ + 1e-9]: one value is all it tells; side 2 is 30 % node 4, 70 % node 9.
        let (mass, areas) = line(0.5, 0.5 + 1e-9);
        assert!(Factor::new(2, mass).is_none());
        let share = |part: f64| [areas[0] * part, areas[1] * part, 0.0, 0.0];
        let mut projection = Projection {
            areas: [areas[0], areas[1], 0.0, 0.0],
            columns: vec![(4, share(0.3)), (9, share(0.7))],
            ..Projection::default()
        };
        projection.solve(2, mass);
        for (row, expected) in [(0, 0.3), (1, 0.7)] {
            let (_, column) = projection.columns[row];
            let means = [column[0] / areas[0], column[1] / areas[1]];
            assert!(means.iter().all(|mean| (mean - expected).abs() < 1e-15));
        }
    }
}
