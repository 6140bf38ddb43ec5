//! Functions of three or four contacts that stand anywhere on a face.
//!
//! ```text
//! (C21)  φ_i(x) = 1/n + (z_i − z̄) · T⁻¹ (x − z̄) + σ_i (s(x) − s̄)      T = Σ_i (z_i − z̄)(z_i − z̄)ᵀ
//!        Σ_i φ_i = 1,   Σ_i z_i φ_i(x) = x                           z_i: where contact i stands
//! ```
//!
//! Of three contacts they are those of the triangle between them. Four have one function more than what
//! is linear has values: `σ` is the combination of the z_i that vanishes, `Σ σ_i = 0`, `Σ σ_i z_i = 0`, and
//! `s = ξη/2` in the parallelogram that is nearest to them, less its mean on the cover; on a
//! parallelogram all of it is its bilinear functions. Whatever they are between the contacts, they
//! give the dual functions their resultants: `∫ ψ_i x dA = D_i z_i`, on both sides.

use nalgebra::{Matrix2, Matrix2x1};

use super::patch::MOST_CONTACTS;
use super::polygon::{Point, cross};

/// Area between contacts, relative to that of their cover, below which they are on one line.
const ON_LINE: f64 = 0.05;

/// The functions of some contacts.
pub(super) struct Spread {
    points: Vec<Point>,
    mean: Point,
    /// T⁻¹.
    inverse: Matrix2<f64>,
    twist: Option<Twist>,
}

/// What four contacts have beyond linear functions.
struct Twist {
    /// σ.
    signs: [f64; MOST_CONTACTS],
    /// Half the parallelogram's mid-lines.
    axes: [Point; 2],
    /// s̄.
    mean: f64,
}

impl Spread {
    /// Of contacts at three or four points, counter-clockwise, for a cover of so large an area; none if they are
    /// fewer, on one line, or four that are not the corners of a convex quadrilateral.
    pub(super) fn new(points: &[Point], area: f64) -> Option<Self> {
        if points.len() < 3 {
            return None;
        }
        let mean = points.iter().sum::<Point>() / points.len() as f64;
        let offsets = points.iter().map(|at| at - mean);
        let moment: Matrix2<f64> = offsets.map(|at| at * at.transpose()).sum();
        let least = ON_LINE * area;
        let turn = |at: usize| {
            let corner = |k: usize| points[(at + k) % points.len()];
            cross(corner(1) - corner(0), corner(2) - corner(1))
        };
        if (0..points.len()).any(|at| turn(at) <= least) {
            return None;
        }
        let twist = match *points {
            [a, b, c, d] => Some(Twist::new([a, b, c, d])),
            _ => None,
        };
        Some(Self {
            points: points.to_vec(),
            mean,
            inverse: moment.try_inverse()?,
            twist,
        })
    }

    /// The same, with s̄ as the mean of s on the cover.
    pub(super) fn balanced(mut self, mean: impl Fn(&dyn Fn(Point) -> f64) -> f64) -> Self {
        if let Some(twist) = &mut self.twist {
            let centre = self.mean;
            twist.mean = mean(&|at| twist.value(at - centre));
        }
        self
    }

    /// What is linear of the functions.
    pub(super) fn linear(&self, at: Point) -> [f64; MOST_CONTACTS] {
        let slope: Matrix2x1<f64> = self.inverse * (at - self.mean);
        let mut values = [0.0; MOST_CONTACTS];
        for (value, point) in values.iter_mut().zip(&self.points) {
            *value = (self.points.len() as f64).recip() + (point - self.mean).dot(&slope);
        }
        values
    }

    /// The functions (C21).
    pub(super) fn values(&self, at: Point) -> [f64; MOST_CONTACTS] {
        let mut values = self.linear(at);
        if let Some(twist) = &self.twist {
            let twisted = twist.value(at - self.mean) - twist.mean;
            for (value, sign) in values.iter_mut().zip(twist.signs) {
                *value += sign * twisted;
            }
        }
        values
    }
}

impl Twist {
    fn new([a, b, c, d]: [Point; 4]) -> Self {
        let area = |p: Point, q: Point, r: Point| cross(q - p, r - p);
        let signs = [area(b, c, d), -area(a, c, d), area(a, b, d), -area(a, b, c)];
        let norm = signs.iter().map(|sign| sign * sign).sum::<f64>().sqrt();
        Self {
            signs: signs.map(|sign| sign / norm),
            axes: [(b + c - a - d) / 4.0, (c + d - a - b) / 4.0],
            mean: 0.0,
        }
    }

    /// s, at an offset from the centre.
    fn value(&self, offset: Point) -> f64 {
        let [a, b] = self.axes;
        let area = cross(a, b);
        cross(offset, b) * cross(a, offset) / (2.0 * area * area)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(of: &[[f64; 2]]) -> Vec<Point> {
        of.iter().map(|at| Point::from(*at)).collect()
    }

    const TRIANGLE: &[[f64; 2]] = &[[0.1, 0.2], [1.3, 0.1], [0.4, 0.9]];
    const SKEW: &[[f64; 2]] = &[[0.1, 0.2], [1.3, 0.1], [0.9, 0.6], [0.2, 0.8]];
    const SLANTED: &[[f64; 2]] = &[[0.0, 0.0], [2.0, 0.0], [2.5, 1.0], [0.5, 1.0]];

    #[test]
    fn they_add_up_to_one_and_reproduce_the_point() {
        for corners in [TRIANGLE, SKEW, SLANTED] {
            let points = points(corners);
            let spread = Spread::new(&points, 0.5).map(|spread| spread.balanced(|_| 0.07));
            for at in [[0.5, 0.4], [3.0, -1.0]].map(Point::from) {
                let values = spread.as_ref().map_or([f64::NAN; 4], |s| s.values(at));
                let terms = points.iter().zip(values);
                let found: Point = terms.map(|(point, value)| point * value).sum();
                assert!((found - at).norm() < 1e-14, "{found}");
                assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn on_a_triangle_and_a_parallelogram_they_are_those_of_the_corners() {
        for corners in [TRIANGLE, SLANTED] {
            let points = points(corners);
            let spread = Spread::new(&points, 1.0);
            for (i, at) in points.iter().enumerate() {
                let values = spread.as_ref().map_or([f64::NAN; 4], |s| s.values(*at));
                for (j, value) in values.iter().enumerate().take(points.len()) {
                    let expected = if i == j { 1.0 } else { 0.0 };
                    assert!((value - expected).abs() < 1e-14);
                }
            }
        }
    }

    #[test]
    fn contacts_on_one_line_have_none() {
        let line = points(&[[0.0, 0.0], [1.0, 1e-4], [2.0, 0.0]]);
        assert!(Spread::new(&line, 0.5).is_none() && Spread::new(&line[..2], 0.5).is_none());
        let inverted = points(&[[0.0, 0.0], [1.0, 0.0], [0.2, 0.1], [0.0, 1.0]]);
        assert!(Spread::new(&inverted, 0.5).is_none());
    }
}
