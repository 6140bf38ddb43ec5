//! Gauss points over a polygon.
//!
//! ```text
//! ∫ f over a triangle = 2A ∫∫ f(a + u (1−v) (b−a) + v (c−a)) (1−v) du dv,   0 ≤ u, v ≤ 1
//! ```
//!
//! with `n` Gauss–Legendre points along `u` and `v`: exact for polynomials of degree
//! `2n − 2`. On triangles, lines and parallelograms the integrands of (C8) are
//! polynomials (degree 2 and 4), and those of (C20) where facets are round (degree 3 and 5). On other quadrilaterals shape functions are not: they
//! have a branch point where the Jacobian of the facet's plane, continued beyond the
//! facet, vanishes, and Gauss errors fall by `ρ²` per point, `ρ = s + √(s² − 1)`, `s` the
//! distance of that point in half-widths of the facet.

use std::sync::LazyLock;

use super::polygon::{Point, cross, fan};

/// Most Gauss points per direction.
const MOST: usize = 12;

/// Accuracy that the number of points aims at.
const ACCURACY: f64 = 1e-13;

/// Points per direction when everything is linear: exact to degree 2.
pub(super) const LINEAR: usize = 2;

/// Points per direction for shape functions on facets of the given distortion, the
/// [largest](super::view::Outline::distortion) of both sides.
pub(super) fn points_for(distortion: f64) -> usize {
    // Degree 4 for parallelograms; round-off in the corners is no distortion.
    let least = 3;
    if distortion < ACCURACY {
        return least;
    }
    let s = 1.0 / distortion.min(1.0);
    let rate = (s + (s * s - 1.0).sqrt()).ln();
    let more = (-ACCURACY.ln() / rate - 1.0) / 2.0;
    least + more.clamp(1.0, (MOST - least) as f64).ceil() as usize
}

/// Calls `visit` with every point and its share of the polygon's area.
pub(super) fn integrate(polygon: &[Point], points: usize, mut visit: impl FnMut(Point, f64)) {
    static RULES: LazyLock<Vec<Vec<(f64, f64)>>> =
        LazyLock::new(|| (0..=MOST).map(gauss_legendre).collect());
    let rule = &RULES[points.min(MOST)];
    for [a, b, c] in fan(polygon) {
        let twice = cross(b - a, c - a);
        for &(v, weight_v) in rule {
            for &(u, weight_u) in rule {
                let at = a + (b - a) * (u * (1.0 - v)) + (c - a) * v;
                visit(at, twice * (1.0 - v) * weight_u * weight_v);
            }
        }
    }
}

/// Points and weights on the unit interval, by Newton's method on the Legendre polynomial.
fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let point = |index: usize| {
        let n = count as f64;
        let mut x = (std::f64::consts::PI * (index as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (value, derivative) = legendre(count, x);
            x -= value / derivative;
            slope = derivative;
        }
        ((1.0 - x) / 2.0, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(point).collect()
}

/// Legendre polynomial and its derivative, by the three-term recurrence.
fn legendre(degree: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=degree {
        let k = k as f64;
        (before, value) = (
            value,
            ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k,
        );
    }
    (value, degree as f64 * (x * value - before) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_monomial_over_a_triangle_is_integrated_exactly() {
        // ∫ x^p y^q over the unit triangle = p! q! / (p + q + 2)!.
        let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
        let triangle = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
        for points in 2..=MOST {
            for p in 0..=2 * points - 2 {
                let q = 2 * points - 2 - p;
                let mut sum = 0.0;
                integrate(&triangle, points, |at, area| {
                    sum += area * at.x.powi(p as i32) * at.y.powi(q as i32);
                });
                let exact = factorial(p) * factorial(q) / factorial(p + q + 2);
                assert!(
                    (sum - exact).abs() < 1e-15,
                    "{points} {p} {q}: {sum} {exact}"
                );
            }
        }
    }

    #[test]
    fn distorted_facets_get_more_points() {
        let found = [0.0, 1e-15, 1e-6, 0.1, 0.5, 1.0, 7.0].map(points_for);
        assert_eq!(found[..2], [3, 3]);
        assert!(
            found.is_sorted() && found[3] <= 8 && found[6] == MOST,
            "{found:?}"
        );
    }
}
