//! What one patch of side 1 contributes: its covered area and its projection of the other side.
//!
//! ```text
//! D_i = ∫ φ_i dA      M_ij = ∫ φ_i φ_j dA      B_ik = ∫ φ_i N²_k dA      P = M⁻¹ B
//! ```
//!
//! all over the covered parts. `P` is the least-squares projection of side 2 onto the
//! patch's functions (C19), so that `D_i P_ik = ∫ ψ_i N²_k dA` with the dual functions
//! `ψ = D M⁻¹ φ`. Rows of `B` sum to `M 1`, hence rows of `P` sum to one.
//!
//! The nodes of side 1 enter in the same way, by `∫ ψ_i N_k dA`: on a single linear facet that is `D_i`
//! times the place where the contact stands, and on one that is wholly covered the node alone. So do
//! what facets leave of the gap (C18), and both sides' normals. Around an axis `dA = 2πr ds`.
//!
//! A curved facet has dual functions of their own on each of its pieces: what is seen along the normals of two pieces
//! does not go on from one to the other, and a single projection would go across. They are biorthogonal on each
//! piece, hence on the facet.

use std::borrow::Cow;

use nalgebra::Vector3;

use super::cover::Part;
use super::coverage::Coverage;
use super::patch::{MOST_CONTACTS, Member, Patch};
use super::pieces::Piece;
use super::polygon::{Point, centroid, turning};
use super::quadrature::{LINEAR, integrate, points_for};
use super::seen::Seen;
use super::ties::EQUAL;
use super::view::Outline;
use crate::body::{Facet, MOST_FACET_NODES, Mesh, Model, around};

/// Pivot of the scaled `M` below which the covered part is too small to tell slopes.
const PIVOT: f64 = 1e-14;

/// A value per contact of a patch, zero past the last one.
type PerContact = [f64; MOST_CONTACTS];

/// One patch's share of the coupling.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Projection {
    /// `D_i`, in m² (2D: metre).
    pub(super) areas: PerContact,
    /// `∫ φ_i (n − n²) dA`, in m² (2D: metre).
    pub(super) vectors: [Vector3<f64>; MOST_CONTACTS],
    /// Nodes of side 1 with `∫ ψ_i N_k dA`, in m² (2D: metre).
    pub(super) own: Vec<(usize, PerContact)>,
    /// Nodes of side 2, ascending, with `D_i P_ik = ∫ ψ_i N²_k dA`.
    pub(super) columns: Vec<(usize, PerContact)>,
    /// `∫ ψ_i b dA`, b of both sides (C18), in m³ (2D: m²).
    pub(super) bulges: PerContact,
    /// `∫ ψ_i b' dA` (C23), in m³ (2D: m²).
    pub(super) pressed: PerContact,
    /// `∫ ψ_i γ dA`, γ the distance of the smooth surfaces along the normal of the piece, in m³ (2D: m²).
    pub(super) distances: PerContact,
    /// Least γ in metre: of all points where it is integrated and of the ends of parts.
    pub(super) least: f64,
    /// Largest value of each contact's function at the ends of parts, and γ there, in metre.
    pub(super) here: [[f64; 2]; MOST_CONTACTS],
}

impl Default for Projection {
    fn default() -> Self {
        Self {
            areas: [0.0; MOST_CONTACTS],
            vectors: [Vector3::zeros(); MOST_CONTACTS],
            own: Vec::new(),
            columns: Vec::new(),
            bulges: [0.0; MOST_CONTACTS],
            pressed: [0.0; MOST_CONTACTS],
            distances: [0.0; MOST_CONTACTS],
            least: f64::INFINITY,
            here: [[0.0; 2]; MOST_CONTACTS],
        }
    }
}

/// The sides at a point of a part.
struct Meeting {
    /// Values of the corners' functions and of the shape functions on side 1, and of those on side 2.
    hats: [f64; 4],
    own: [f64; MOST_FACET_NODES],
    across: [f64; MOST_FACET_NODES],
    /// b of both sides (C18), in metre.
    bulge: f64,
    /// The same of what is pressed together (C23), in metre.
    pressed: f64,
    /// Sum of the unit normal of side 1 and of the opposite one of side 2.
    normal: Vector3<f64>,
    /// γ, in metre.
    distance: f64,
}

/// A piece of side 1 and one part of it that is covered.
struct Place<'a> {
    coverage: &'a Coverage<'a>,
    piece: &'a Piece<'a>,
    seen: &'a Seen,
    part: &'a Part,
}

impl Place<'_> {
    /// The piece that covers it.
    fn across(&self) -> &Piece<'_> {
        &self.coverage.two.pieces[self.part.opposite]
    }

    /// Gauss points per direction that its integrals need.
    fn points(&self, model: Model) -> usize {
        let (piece, across) = (self.piece, self.across());
        let outlines = [&self.seen.outline, &self.part.outline];
        let points = match piece.corners.nodes.len().max(across.corners.nodes.len()) {
            4 => points_for(
                outlines
                    .map(Outline::distortion)
                    .into_iter()
                    .fold(0.0, f64::max),
            ),
            _ => LINEAR,
        };
        let higher = piece.is_quadratic() || across.is_quadratic() || model == Model::Axisymmetric;
        points + usize::from(higher || self.is_round())
    }

    fn is_curved(&self) -> bool {
        self.is_round() || self.piece.is_quadratic() || self.across().is_quadratic()
    }

    fn is_round(&self) -> bool {
        let (one, two) = (self.coverage.one, self.coverage.two);
        one.bulges.is_round(self.piece.number) || two.bulges.is_round(self.across().number)
    }

    /// What is integrated over, for triangles between its first point and its edges. What bulges or is curved is no
    /// polynomial: in space they go around the middle, so that it does not matter which corner comes first.
    fn polygon(&self) -> Cow<'_, [Point]> {
        let corners = self.corners();
        match (corners.first(), &corners) {
            (Some(first), Cow::Owned(corners)) => {
                let around = corners.iter().chain([first]);
                let middle = centroid(corners);
                std::iter::once(&middle).chain(around).copied().collect()
            }
            _ => corners,
        }
    }

    /// The corners of what is covered; where these triangles go around the middle, without those on straight edges,
    /// which clipping leaves or not.
    fn corners(&self) -> Cow<'_, [Point]> {
        let corners = &self.part.polygon;
        match self.is_curved() && self.coverage.one.mesh.dimension == 3 {
            true => Cow::Owned(turning(corners)),
            false => Cow::Borrowed(corners),
        }
    }

    /// Both sides at a point of the piece's plane.
    fn at(&self, at: Point) -> Meeting {
        let (piece, across) = (self.piece, self.across());
        let (of_piece, of_across) = (self.seen.outline.shape(at), self.part.outline.shape(at));
        let (own, there) = (piece.shape(&of_piece), across.shape(&of_across));
        let (one, two) = (self.coverage.one, self.coverage.two);
        let (hats, hats_across) = (piece.hats(&of_piece), across.hats(&of_across));
        let bulge =
            one.bulges.height(piece.number, &hats) + two.bulges.height(across.number, &hats_across);
        let view = &self.seen.view;
        let height = |mesh: &Mesh, facet: &Facet, shape: &[f64]| -> f64 {
            let terms = facet.nodes.iter().zip(shape);
            terms
                .map(|(node, value)| view.height(mesh.nodes[*node]) * value)
                .sum()
        };
        let apart = height(two.mesh, across.facet, &there) - height(one.mesh, piece.facet, &own);
        let own_normal = piece.normal(one.mesh, &of_piece);
        let flat = || view.vector(self.seen.outline.area_vector(at)).normalize();
        let two_normal = across.normal(two.mesh, &of_across);
        let opposite = || Vector3::from(two.geometries[self.part.opposite].normal);
        Meeting {
            normal: own_normal.unwrap_or_else(flat) - two_normal.unwrap_or_else(opposite),
            hats,
            own,
            across: there,
            bulge,
            pressed: bulge - self.flattened([&hats, &hats_across]),
            distance: apart - one.bulges.taken(bulge),
        }
    }
}

/// Of a contact's function and γ at two points, those where the function is larger; of equals the least γ.
pub(super) fn nearer(known: &mut [f64; 2], other: [f64; 2]) {
    if other[0] > known[0] + EQUAL || (other[0] >= known[0] - EQUAL && other[1] < known[1]) {
        *known = other;
    }
}

impl Place<'_> {
    /// What linear displacements that make two lines one take off the sagittas of both (C23), in metre.
    fn flattened(&self, hats: [&[f64; 4]; 2]) -> f64 {
        let (surfaces, pieces) = (
            [self.coverage.one, self.coverage.two],
            [self.piece, self.across()],
        );
        // What follows its curve does not tell a curvature.
        let curved = |side: usize| surfaces[side].pieces_of[pieces[side].number].len() > 1;
        if surfaces[0].mesh.dimension != 2 || curved(0) || curved(1) {
            return 0.0;
        }
        let length = |side: usize| {
            let (mesh, nodes) = (surfaces[side].mesh, &pieces[side].corners.nodes);
            (Vector3::from(mesh.nodes[nodes[1]]) - Vector3::from(mesh.nodes[nodes[0]])).norm()
        };
        let lengths = [length(0), length(1)];
        let curvature = |side: usize| {
            surfaces[side]
                .bulges
                .curvature(pieces[side].number, lengths[side])
        };
        let relative = (curvature(0) + curvature(1)).max(0.0);
        let all = surfaces[0].compliance + surfaces[1].compliance;
        let straight = (0..2).filter(|side| !pieces[*side].is_quadratic());
        let lost = straight.map(|side| {
            let share = surfaces[side].compliance / all;
            share * relative * lengths[side].powi(2) * hats[side][0] * hats[side][1] / 2.0
        });
        lost.sum()
    }
}

/// Integrals over a patch, before `M` is divided out of them.
#[derive(Default)]
struct Integrals {
    mass: [PerContact; MOST_CONTACTS],
    sums: Projection,
}

impl Integrals {
    /// Adds what covers a part, where the functions have the values of `member` at the corners.
    fn add(&mut self, place: &Place<'_>, member: &Member, model: Model) {
        let seen = place.seen;
        let around = around(model);
        let (mut own, mut across) = ([[0.0; 4]; MOST_FACET_NODES], [[0.0; 4]; MOST_FACET_NODES]);
        let mut least = self.sums.least;
        integrate(&place.polygon(), place.points(model), |at, share| {
            let of_piece = seen.outline.shape(at);
            let within = seen.outline.within(at, seen.outline.height(&of_piece));
            let stretch = share * seen.view.unit * around(seen.view.position(within));
            let vector = seen.view.vector(seen.outline.area_vector(at)) * stretch;
            let area = vector.norm();
            let met = place.at(at);
            let here = member.functions(&met.hats);
            least = least.min(met.distance);
            for (i, value) in here.into_iter().enumerate() {
                let weight = value * area;
                self.sums.areas[i] += weight;
                self.sums.vectors[i] += met.normal * weight;
                self.sums.bulges[i] += met.bulge * weight;
                self.sums.pressed[i] += met.pressed * weight;
                self.sums.distances[i] += met.distance * weight;
                for (entry, other) in self.mass[i].iter_mut().zip(here) {
                    *entry += weight * other;
                }
                let columns = own.iter_mut().chain(&mut across);
                for (column, shape) in columns.zip(met.own.iter().chain(&met.across)) {
                    column[i] += shape * weight;
                }
            }
        });
        self.sums.least = least;
        for at in place.corners().iter() {
            let met = place.at(*at);
            self.sums.least = self.sums.least.min(met.distance);
            let functions = member.functions(&met.hats).into_iter();
            for (nearest, value) in self.sums.here.iter_mut().zip(functions) {
                nearer(nearest, [value, met.distance]);
            }
        }
        let nodes = |piece: &Piece<'_>| piece.facet.nodes.clone().into_iter();
        self.sums.own.extend(nodes(place.piece).zip(own));
        self.sums.columns.extend(nodes(place.across()).zip(across));
    }

    /// The integrals with `M` of so many contacts divided out of them; zero without an area.
    fn solved(mut self, contacts: usize) -> Projection {
        if self.sums.areas.iter().sum::<f64>() <= 0.0 {
            return Projection::default();
        }
        merge(&mut self.sums.columns);
        self.sums.solve(contacts, self.mass);
        self.sums
    }
}

impl Projection {
    /// Integrates over all of a patch that is covered; none if that has no area.
    pub(super) fn new(coverage: &Coverage<'_>, patch: &Patch, model: Model) -> Option<Self> {
        let members = patch.members.iter();
        let pieces: Vec<_> = members
            .flat_map(|member| coverage.of(member.facet).map(move |of| (member, of)))
            .collect();
        let together = if patch.members.len() == 1 {
            1
        } else {
            pieces.len()
        };
        let mut sums = Self::default();
        for pieces in pieces.chunks(together.max(1)) {
            let mut integrals = Integrals::default();
            for (member, (piece, seen)) in pieces {
                for part in &seen.parts {
                    let place = Place {
                        coverage,
                        piece,
                        seen,
                        part,
                    };
                    integrals.add(&place, member, model);
                }
            }
            sums.add(integrals.solved(patch.stands.len()));
        }
        if sums.areas.iter().sum::<f64>() <= 0.0 {
            return None;
        }
        merge(&mut sums.columns);
        match (patch.shares, &patch.members[..]) {
            (Some(shares), [member]) if coverage.one.is_linear(member.facet) => {
                sums.stand(coverage.one.corners_of(member.facet), &shares);
            }
            _ => merge(&mut sums.own),
        }
        Some(sums)
    }

    fn add(&mut self, other: Self) {
        for contact in 0..MOST_CONTACTS {
            self.areas[contact] += other.areas[contact];
            self.vectors[contact] += other.vectors[contact];
            self.bulges[contact] += other.bulges[contact];
            self.pressed[contact] += other.pressed[contact];
            self.distances[contact] += other.distances[contact];
        }
        self.own.extend(other.own);
        self.columns.extend(other.columns);
        self.least = self.least.min(other.least);
        for (here, other) in self.here.iter_mut().zip(other.here) {
            nearer(here, other);
        }
    }

    /// Replaces the columns of `B` by those of `D P = D M⁻¹ B`.
    fn solve(&mut self, contacts: usize, mass: [PerContact; MOST_CONTACTS]) {
        let total: f64 = self.areas.iter().sum();
        let factor = Factor::new(contacts, mass);
        let nodes = self.columns.iter_mut().chain(&mut self.own);
        let columns = nodes.map(|(_, column)| column);
        for column in columns.chain([&mut self.bulges, &mut self.pressed, &mut self.distances]) {
            match &factor {
                Some(factor) => factor.solve(column),
                // All contacts see the mean of what covers so small a part.
                None => *column = [column.iter().sum::<f64>() / total; MOST_CONTACTS],
            }
            for (entry, area) in column.iter_mut().zip(self.areas) {
                *entry *= area;
            }
        }
    }

    /// On a linear facet the own nodes are known to the last bit: where the contacts stand.
    fn stand(&mut self, corners: &[usize], shares: &[[f64; 4]; MOST_CONTACTS]) {
        let of = |corner: usize| -> PerContact {
            std::array::from_fn(|contact| self.areas[contact] * shares[contact][corner])
        };
        let corners = corners.iter().enumerate();
        self.own = corners.map(|(corner, &node)| (node, of(corner))).collect();
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
