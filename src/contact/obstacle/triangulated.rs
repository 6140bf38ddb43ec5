//! A surface of triangles in space, as from an STL file; outward is where their corners run counterclockwise.
//!
//! ```text
//! d = ± ‖x − q‖      q: nearest point; the sign is that of (x − q) · n
//! ```
//!
//! with the pseudonormal n: that of a triangle, the sum of two at an edge, the sum weighted by angles at a
//! corner. (Bærentzen, Aanæs, IEEE Trans. Vis. Comput. Graphics 11 (2005) 243–253.) Nothing is beyond the rim of
//! an open surface, nor beyond an edge that turns away by more than 60°.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::{Closest, SHARP};
use crate::error::{Error, check_finite};

/// Part of a triangle's size that is round-off.
const ROUNDED: f64 = 1e-9;

/// Triangles in a leaf of the tree.
const LEAF: usize = 8;

/// Triangles with what is known of their edges and corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangulated {
    points: Vec<Vector3<f64>>,
    triangles: Vec<[usize; 3]>,
    normals: Vec<Vector3<f64>>,
    /// Other triangles at each edge, which runs from a corner to the next, and at each corner.
    edges: Vec<[Vec<usize>; 3]>,
    corners: Vec<Vec<usize>>,
    /// Corners on an edge of a single triangle.
    rims: Vec<bool>,
    boxes: Vec<Branch>,
    order: Vec<usize>,
}

#[derive(Clone, Debug, PartialEq)]
struct Branch {
    low: Vector3<f64>,
    high: Vector3<f64>,
    range: [usize; 2],
    halves: Option<[usize; 2]>,
}

/// Where in a triangle its nearest point is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Face,
    Edge(usize),
    Corner(usize),
}

impl Triangulated {
    /// Of triangles between points, in metre; points at one place are one.
    ///
    /// # Errors
    ///
    /// No triangles, a point that there is not, a NaN or infinity, two triangles at an edge that look to different sides.
    /// Triangles without an area are left out: what is thinner than round-off looks anywhere.
    pub fn new(place: &str, points: &[[f64; 3]], triangles: &[[usize; 3]]) -> Result<Self, Error> {
        let (points, number) = welded(place, points)?;
        let mut kept = Vec::with_capacity(triangles.len());
        let mut normals = Vec::with_capacity(triangles.len());
        for triangle in triangles {
            if let Some(&index) = triangle.iter().find(|&&corner| corner >= number.len()) {
                return Err(Error::UnknownIndex {
                    place: place.to_owned(),
                    what: "point",
                    index,
                    count: number.len(),
                });
            }
            let corners = triangle.map(|corner| number[corner]);
            let [a, b, c] = corners.map(|corner| points[corner]);
            let across = (b - a).cross(&(c - a));
            let longest = [b - a, c - b, a - c].map(|edge| edge.norm_squared());
            let longest = longest.into_iter().fold(0.0, f64::max);
            if let Some(normal) = across.try_normalize(ROUNDED * longest) {
                kept.push(corners);
                normals.push(normal);
            }
        }
        if kept.is_empty() {
            return Err(Error::Empty {
                place: format!("{place}: triangles with an area"),
            });
        }
        let surface = Self::joined(points, kept, normals);
        match surface.turned_over() {
            None => Ok(surface),
            Some(edge) => Err(Error::NotAccepted {
                place: place.to_owned(),
                found: format!(
                    "two triangles that look to different sides at the edge from {:?} to {:?}",
                    edge[0], edge[1]
                ),
                accepted: "triangles whose corners all run counterclockwise seen from outside: turn one of the two, and \
                           those that go on from it"
                    .to_owned(),
            }),
        }
    }

    /// An edge that both of its triangles run along the same way, by its ends.
    fn turned_over(&self) -> Option<[[f64; 3]; 2]> {
        let runs = |number: usize, ends: [usize; 2]| {
            let corners = self.triangles[number];
            (0..3).any(|k| [corners[k], corners[(k + 1) % 3]] == ends)
        };
        let sorted = |number: usize| {
            let mut corners = self.triangles[number];
            corners.sort_unstable();
            corners
        };
        let edges = self.edges.iter().enumerate();
        let mut edges =
            edges.flat_map(|(number, edges)| (0..3).map(move |k| (number, k, &edges[k])));
        edges.find_map(|(number, k, others)| {
            let [other] = others[..] else { return None };
            let ends = [k, (k + 1) % 3].map(|k| self.triangles[number][k]);
            // What stands twice in a file looks one way.
            let against = runs(other, ends) && sorted(number) != sorted(other);
            against.then(|| ends.map(|end| self.points[end].into()))
        })
    }

    fn joined(
        points: Vec<Vector3<f64>>,
        triangles: Vec<[usize; 3]>,
        normals: Vec<Vector3<f64>>,
    ) -> Self {
        let mut at_edge: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
        let mut corners = vec![Vec::new(); points.len()];
        for (number, triangle) in triangles.iter().enumerate() {
            for k in 0..3 {
                at_edge.entry(edge(triangle, k)).or_default().push(number);
                corners[triangle[k]].push(number);
            }
        }
        let mut rims = vec![false; points.len()];
        for (ends, _) in at_edge.iter().filter(|(_, at)| at.len() == 1) {
            ends.iter().for_each(|&end| rims[end] = true);
        }
        let edges = triangles.iter().enumerate().map(|(number, triangle)| {
            [0, 1, 2].map(|k| {
                let mut others = at_edge[&edge(triangle, k)].clone();
                others.retain(|&other| other != number);
                others
            })
        });
        let mut surface = Self {
            edges: edges.collect(),
            order: (0..triangles.len()).collect(),
            points,
            triangles,
            normals,
            corners,
            rims,
            boxes: Vec::new(),
        };
        surface.grow([0, surface.order.len()]);
        surface
    }

    /// The triangles, by numbers of points.
    #[must_use]
    pub fn triangles(&self) -> &[[usize; 3]] {
        &self.triangles
    }

    /// The points, in metre.
    pub fn points(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.points.iter().map(|&point| point.into())
    }

    /// A box around triangles, and those within it.
    fn grow(&mut self, range: [usize; 2]) -> usize {
        let (triangles, points) = (&self.triangles, &self.points);
        let items = &mut self.order[range[0]..range[1]];
        let corners = || {
            items
                .iter()
                .flat_map(|&item| triangles[item].map(|corner| points[corner]))
        };
        let (mut low, mut high) = (
            Vector3::repeat(f64::INFINITY),
            Vector3::repeat(f64::NEG_INFINITY),
        );
        for corner in corners() {
            (low, high) = (low.inf(&corner), high.sup(&corner));
        }
        let number = self.boxes.len();
        if items.len() > LEAF {
            let axis = (high - low).imax();
            let middle =
                |item: &usize| -> f64 { triangles[*item].iter().map(|&c| points[c][axis]).sum() };
            let half = items.len() / 2;
            items.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
        }
        let halves = (items.len() > LEAF).then(|| range[0] + items.len() / 2);
        self.boxes.push(Branch {
            low,
            high,
            range,
            halves: None,
        });
        if let Some(middle) = halves {
            let halves = [self.grow([range[0], middle]), self.grow([middle, range[1]])];
            self.boxes[number].halves = Some(halves);
        }
        number
    }

    /// The surface from a position.
    pub(super) fn closest(&self, position: [f64; 3]) -> Closest {
        let x = Vector3::from(position);
        let mut best = (f64::INFINITY, 0, x, Part::Face);
        let mut open = vec![0];
        while let Some(number) = open.pop() {
            let branch = &self.boxes[number];
            let outside = (branch.low - x)
                .sup(&(x - branch.high))
                .sup(&Vector3::zeros());
            if outside.norm_squared() > best.0 {
                continue;
            }
            if let Some(halves) = branch.halves {
                open.extend(halves);
                continue;
            }
            for &triangle in &self.order[branch.range[0]..branch.range[1]] {
                let (foot, part) = self.foot(triangle, x);
                let square = (x - foot).norm_squared();
                if square < best.0 {
                    best = (square, triangle, foot, part);
                }
            }
        }
        let (_, triangle, foot, part) = best;
        self.seen(x, triangle, foot, part)
    }

    fn seen(&self, x: Vector3<f64>, triangle: usize, foot: Vector3<f64>, part: Part) -> Closest {
        let own = self.normals[triangle];
        let apart = x - foot;
        let length = apart.norm();
        let [a, b, _] = self.triangles[triangle].map(|corner| self.points[corner]);
        let rounded = ROUNDED * (b - a).norm();
        let around = self.around(triangle, part);
        let mut normals = around.iter().map(|&triangle| self.normals[triangle]);
        let upright = normals.find(|normal| apart.cross(normal).norm() <= rounded);
        if let Some(normal) = upright {
            return Closest::new(apart.dot(&normal), -normal);
        }
        let outside = apart.dot(&self.pseudonormal(triangle, part)) >= 0.0;
        let sharp = around.iter().any(|&k| {
            around
                .iter()
                .any(|&l| self.normals[k].dot(&self.normals[l]) < SHARP)
        });
        let rim = match part {
            Part::Face => false,
            Part::Edge(k) => self.edges[triangle][k].is_empty(),
            Part::Corner(k) => self.rims[self.triangles[triangle][k]],
        };
        // Within a face only rounding is off the normal.
        if part == Part::Face {
            return Closest::new(apart.dot(&own), -own);
        }
        let sign = if outside { 1.0 } else { -1.0 };
        Closest {
            beyond: rim || (outside && sharp),
            ..Closest::new(sign * length, -apart * (sign / length))
        }
    }

    /// The triangles that meet at a part of one, itself first.
    fn around(&self, triangle: usize, part: Part) -> Vec<usize> {
        let others = match part {
            Part::Face => &[][..],
            Part::Edge(k) => &self.edges[triangle][k],
            Part::Corner(k) => &self.corners[self.triangles[triangle][k]],
        };
        let others = others.iter().copied().filter(|&other| other != triangle);
        std::iter::once(triangle).chain(others).collect()
    }

    fn pseudonormal(&self, triangle: usize, part: Part) -> Vector3<f64> {
        let around = self.around(triangle, part);
        let Part::Corner(k) = part else {
            return around.iter().map(|&triangle| self.normals[triangle]).sum();
        };
        let corner = self.triangles[triangle][k];
        let weighted = around.iter().map(|&triangle| {
            let others = self.triangles[triangle]
                .into_iter()
                .filter(|&other| other != corner);
            let mut arms = others.map(|other| self.points[other] - self.points[corner]);
            let angle = match (arms.next(), arms.next()) {
                (Some(first), Some(second)) => first.angle(&second),
                _ => 0.0,
            };
            self.normals[triangle] * angle
        });
        weighted.sum()
    }

    /// The nearest point of a triangle. (Ericson, Real-Time Collision Detection, 2005, 5.1.5.)
    fn foot(&self, triangle: usize, x: Vector3<f64>) -> (Vector3<f64>, Part) {
        let [a, b, c] = self.triangles[triangle].map(|corner| self.points[corner]);
        let (ab, ac) = (b - a, c - a);
        let [from_a, from_b, from_c] = [x - a, x - b, x - c];
        let (d1, d2) = (ab.dot(&from_a), ac.dot(&from_a));
        if d1 <= 0.0 && d2 <= 0.0 {
            return (a, Part::Corner(0));
        }
        let (d3, d4) = (ab.dot(&from_b), ac.dot(&from_b));
        if d3 >= 0.0 && d4 <= d3 {
            return (b, Part::Corner(1));
        }
        let (d5, d6) = (ab.dot(&from_c), ac.dot(&from_c));
        if d6 >= 0.0 && d5 <= d6 {
            return (c, Part::Corner(2));
        }
        let (of_c, of_b, of_a) = (d1 * d4 - d3 * d2, d5 * d2 - d1 * d6, d3 * d6 - d5 * d4);
        if of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            return (a + ab * (d1 / (d1 - d3)), Part::Edge(0));
        }
        if of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            return (a + ac * (d2 / (d2 - d6)), Part::Edge(2));
        }
        if of_a <= 0.0 && d4 >= d3 && d5 >= d6 {
            return (
                b + (c - b) * ((d4 - d3) / (d4 - d3 + d5 - d6)),
                Part::Edge(1),
            );
        }
        let sum = of_a + of_b + of_c;
        (a + ab * (of_b / sum) + ac * (of_c / sum), Part::Face)
    }
}

/// The ends of an edge of a triangle, the same from both sides.
fn edge(triangle: &[usize; 3], k: usize) -> [usize; 2] {
    let (first, second) = (triangle[k], triangle[(k + 1) % 3]);
    [first.min(second), first.max(second)]
}

/// The points, each place once, and where each of the given ones went.
fn welded(place: &str, points: &[[f64; 3]]) -> Result<(Vec<Vector3<f64>>, Vec<usize>), Error> {
    let (mut kept, mut number) = (Vec::new(), Vec::with_capacity(points.len()));
    let mut at_place: HashMap<[u64; 3], usize> = HashMap::new();
    for (at, point) in points.iter().enumerate() {
        check_finite(&format!("{place}: point {at}"), point)?;
        // Zero has one sign.
        let key = point.map(|x| (x + 0.0).to_bits());
        number.push(*at_place.entry(key).or_insert_with(|| {
            kept.push(Vector3::from(*point));
            kept.len() - 1
        }));
    }
    Ok((kept, number))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// The cube from −1 to 1.
    fn cube() -> Triangulated {
        let points: Vec<[f64; 3]> = (0..8)
            .map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 }))
            .collect();
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let halves = faces
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        Triangulated::new("cube", &points, &halves.collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn triangles_that_look_to_different_sides_are_refused_by_their_edge() {
        let square = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let of = |triangles: &[[usize; 3]]| Triangulated::new("face", &square, triangles);
        assert!(of(&[[0, 1, 2], [0, 2, 3]]).is_ok());
        // What stands twice looks one way.
        assert!(of(&[[0, 1, 2], [0, 1, 2]]).is_ok());
        let refused = of(&[[0, 1, 2], [0, 3, 2]]).unwrap_err().to_string();
        assert!(
            refused.contains("from [1.0, 1.0, 0.0] to [0.0, 0.0, 0.0]"),
            "{refused}"
        );
    }

    #[test]
    fn a_cube_is_seen_at_its_faces_and_not_beyond_its_edges() {
        let cube = cube();
        for axis in 0..3 {
            for sign in [-1.0, 1.0] {
                for (height, distance) in [(1.5, 0.5), (0.9, -0.1)] {
                    let mut x = [0.3, -0.2, 0.1];
                    x[axis] = sign * height;
                    let seen = cube.closest(x);
                    assert!(
                        (seen.distance - distance).abs() < 1e-14 && !seen.beyond,
                        "{x:?}"
                    );
                    assert_eq!(seen.direction[axis], -sign);
                }
            }
        }
        let edge = cube.closest([1.3, 1.4, 0.2]);
        assert!((edge.distance - 0.5).abs() < 1e-14 && edge.beyond);
        assert!(cube.closest([1.1, 1.1, 1.1]).beyond);
        // Over the diagonal of a face, and over the very edge, the face is seen.
        assert_eq!(cube.closest([0.0, 0.0, 2.0]).distance, 1.0);
        assert!(!cube.closest([1.0, 0.0, 2.0]).beyond);
    }

    #[test]
    fn slivers_are_left_out() {
        // The second triangle is thinner than round-off, and its normal lies in the plane of the first.
        let points = [
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
            [1.0, 0.0, 1e-12],
        ];
        let surface = Triangulated::new("part", &points, &[[0, 1, 2], [0, 3, 1]]).unwrap();
        assert_eq!(surface.triangles(), [[0, 1, 2]]);
        assert!(Triangulated::new("part", &points, &[[0, 3, 1]]).is_err());
    }

    #[test]
    fn a_fine_ball_is_nearly_round_from_all_sides() {
        // Triangles over a sphere of radius 2: the sagitta is 2 (1 − cos(π/n)) at most, twice.
        let n = 24;
        let at = |i: usize, j: usize| {
            let (theta, phi) = (
                std::f64::consts::PI * i as f64 / n as f64,
                std::f64::consts::TAU * (j % (2 * n)) as f64 / (2 * n) as f64,
            );
            // At the far pole the sine is rounding.
            let r = if i == n { 0.0 } else { 2.0 * theta.sin() };
            [r * phi.cos(), r * phi.sin(), 2.0 * theta.cos()]
        };
        let mut points = Vec::new();
        let mut triangles = Vec::new();
        for i in 0..n {
            for j in 0..2 * n {
                let first = points.len();
                points.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            }
        }
        let ball = Triangulated::new("ball", &points, &triangles).unwrap();
        let sagitta = 4.0 * (1.0 - (std::f64::consts::PI / n as f64).cos());
        for k in 0..300 {
            let k = f64::from(k);
            let out = Vector3::new((1.7 * k).sin(), (2.3 * k).cos(), (0.9 * k).sin()).normalize();
            for distance in [0.5, -0.3] {
                let seen = ball.closest((out * (2.0 + distance)).into());
                assert!(
                    (seen.distance - distance).abs() < sagitta && !seen.beyond,
                    "{seen:?}"
                );
                assert!(Vector3::from(seen.direction).dot(&out) < -0.98);
            }
        }
    }

    #[test]
    fn an_open_sheet_ends_at_its_rim() {
        let points = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ];
        let sheet = Triangulated::new("sheet", &points, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        assert!(sheet.closest([1.1, 0.5, 0.1]).beyond && !sheet.closest([1.0, 0.5, 0.1]).beyond);
        assert_eq!(sheet.closest([0.5, 0.5, -0.25]).distance, -0.25);
        assert!(Triangulated::new("none", &points, &[[0, 0, 1]]).is_err());
        assert!(Triangulated::new("far", &points, &[[0, 1, 9]]).is_err());
    }
}
