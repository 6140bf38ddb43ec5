//! Polynomials of triangles and edges by Bernstein's coefficients, which stand at points of the domain.
//!
//! ```text
//! B_α = n!/(α₀! α₁! α₂!) λ₀^α₀ λ₁^α₁ λ₂^α₂,     |α| = n
//! ∂_v Σ c_α B_α = n Σ_β (Σ_l ∂_v λ_l c_(β + e_l)) B_β,     |β| = n − 1
//! ```
//!
//! On an edge only the coefficients of that edge count. Farin, Comput. Aided Geom. Design 3 (1986) 83–127.

/// Bernstein's polynomials of one degree on a triangle.
pub(super) struct Bernstein {
    pub(super) degree: usize,
    /// α of each.
    pub(super) indices: Vec<[usize; 3]>,
}

impl Bernstein {
    pub(super) fn new(degree: usize) -> Self {
        let rows = (0..=degree).flat_map(|i2| (0..=degree - i2).map(move |i1| (i1, i2)));
        let indices = rows.map(|(i1, i2)| [degree - i1 - i2, i1, i2]).collect();
        Self { degree, indices }
    }

    pub(super) fn len(&self) -> usize {
        self.indices.len()
    }

    /// Where α stands.
    pub(super) fn at(&self, [_, i1, i2]: [usize; 3]) -> usize {
        i2 * (2 * self.degree + 3 - i2) / 2 + i1
    }

    /// Their values at a point.
    pub(super) fn values(&self, lambda: [f64; 3]) -> Vec<f64> {
        let value = |alpha: &[usize; 3]| {
            let powers = alpha.iter().zip(lambda);
            let product: f64 = powers.map(|(&a, l)| l.powi(a as i32)).product();
            let parts: f64 = alpha.iter().map(|&a| factorial(a)).product();
            factorial(self.degree) / parts * product
        };
        self.indices.iter().map(value).collect()
    }

    /// Coefficients of a derivative: `β` of the lower degree has the sum of these factors times coefficients.
    pub(super) fn slope(&self, beta: [usize; 3], along: [f64; 3]) -> [(usize, f64); 3] {
        std::array::from_fn(|l| {
            let mut alpha = beta;
            alpha[l] += 1;
            (self.at(alpha), self.degree as f64 * along[l])
        })
    }
}

fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}

/// Values of the polynomials of a degree on an edge, `s` from 0 to 1.
pub(super) fn on_edge(degree: usize, s: f64) -> Vec<f64> {
    let value = |j: usize| {
        let choose = factorial(degree) / (factorial(j) * factorial(degree - j));
        choose * s.powi(j as i32) * (1.0 - s).powi((degree - j) as i32)
    };
    (0..=degree).map(value).collect()
}

/// Coefficients on an edge times a linear function with these values at its ends: of one degree more.
pub(super) fn times(coefficients: &[f64], ends: [f64; 2]) -> Vec<f64> {
    let degree = coefficients.len();
    let at = |j: usize| coefficients.get(j).copied().unwrap_or(0.0);
    let term = |j: usize| {
        let before = if j > 0 { at(j - 1) } else { 0.0 };
        let (left, right) = ((degree - j) as f64 * ends[0], j as f64 * ends[1]);
        (left * at(j) + right * before) / degree as f64
    };
    (0..=degree).map(term).collect()
}

/// The same polynomial, by the coefficients of a higher degree.
pub(super) fn raised(mut coefficients: Vec<f64>, degree: usize) -> Vec<f64> {
    while coefficients.len() <= degree {
        coefficients = times(&coefficients, [1.0; 2]);
    }
    coefficients
}

/// Gauss points and weights of a line from 0 to 1, exact to degree 11.
pub(super) const LINE: [(f64, f64); 6] = [
    (0.033_765_242_898_423_98, 0.085_662_246_189_585_17),
    (0.169_395_306_766_867_74, 0.180_380_786_524_069_3),
    (0.380_690_406_958_401_56, 0.233_956_967_286_345_52),
    (0.619_309_593_041_598_5, 0.233_956_967_286_345_52),
    (0.830_604_693_233_132_3, 0.180_380_786_524_069_3),
    (0.966_234_757_101_576, 0.085_662_246_189_585_17),
];

/// Points of a triangle by barycentric coordinates and their shares of its area, exact to degree 10: those of a
/// square, one side of which shrinks to a corner.
pub(super) fn in_triangle() -> impl Iterator<Item = ([f64; 3], f64)> {
    LINE.into_iter().flat_map(|(x, across)| {
        LINE.into_iter().map(move |(y, up)| {
            let lambda = [(1.0 - x) * (1.0 - y), x * (1.0 - y), y];
            (lambda, 2.0 * across * up * (1.0 - y))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_one_in_sum_and_their_slopes_those_of_a_difference() {
        for degree in 1..5 {
            let (own, lower) = (Bernstein::new(degree), Bernstein::new(degree - 1));
            let coefficients: Vec<f64> = (0..own.len()).map(|k| (k as f64).sin()).collect();
            let value = |lambda: [f64; 3]| -> f64 {
                let values = own.values(lambda);
                assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                values.iter().zip(&coefficients).map(|(b, c)| b * c).sum()
            };
            for (at, alpha) in own.indices.iter().enumerate() {
                assert_eq!(own.at(*alpha), at);
            }
            // Along λ₀ − λ₂.
            let slope = |beta: &[usize; 3]| -> f64 {
                let terms = own.slope(*beta, [1.0, 0.0, -1.0]);
                terms.iter().map(|(at, by)| by * coefficients[*at]).sum()
            };
            let at = [0.3, 0.2, 0.5];
            let slopes = lower.indices.iter().map(slope);
            let found: f64 = slopes.zip(lower.values(at)).map(|(c, b)| c * b).sum();
            let h = 1e-5;
            let difference = value([0.3 + h, 0.2, 0.5 - h]) - value([0.3 - h, 0.2, 0.5 + h]);
            assert!((found - difference / (2.0 * h)).abs() < 1e-8, "{degree}");
        }
    }

    #[test]
    fn points_integrate_powers_exactly() {
        // ∫ λ₁^a λ₂^b dA = 2 A a! b!/(a + b + 2)!.
        for (a, b) in [(0, 0), (3, 2), (6, 4), (1, 9)] {
            let terms = in_triangle().map(|([_, l1, l2], share)| share * l1.powi(a) * l2.powi(b));
            let [a, b] = [a, b].map(|n| n as usize);
            let exact = 2.0 * factorial(a) * factorial(b) / factorial(a + b + 2);
            assert!((terms.sum::<f64>() / exact - 1.0).abs() < 1e-13, "{a} {b}");
        }
        // (1 − s)(2 + s) raised is itself.
        let product = raised(times(&[1.0, 0.0], [2.0, 3.0]), 4);
        let at = |s: f64| -> f64 { on_edge(4, s).iter().zip(&product).map(|(b, c)| b * c).sum() };
        assert!((at(0.3) - 0.7 * 2.3).abs() < 1e-15);
    }
}
