//! Shape functions of prisms: those of a triangle times those of a line.
//!
//! ```text
//! linear        λ_i ½ (1 + c ζ)
//! serendipity   ½ λ_i (1 + c ζ) (2 λ_i − 2 + c ζ) at corners,  2 λ_i λ_j (1 + c ζ) between two of a triangle,
//!               λ_i (1 − ζ²) between the triangles
//! ```
//!
//! on the triangle `λ_1 = ξ, λ_2 = η, λ_0 = 1 − ξ − η` times `−1 ≤ ζ ≤ 1`. Zienkiewicz & Taylor, The Finite
//! Element Method 1 (2000), sect. 8.10.

/// Value and derivatives of the shape function of a node between the corners `(i, j)` of a triangle (i = j
/// at one of them) at the height `c` = −1, 0 or 1.
pub(super) fn shape(
    linear: bool,
    ((i, j), c): ((usize, usize), f64),
    lambda: [f64; 4],
    zeta: f64,
) -> (f64, [f64; 3]) {
    let (up, [l, m]) = (1.0 + c * zeta, [lambda[i], lambda[j]]);
    // Value, and derivatives by λ_i, λ_j and ζ.
    let (value, [by_i, by_j, by_zeta]) = if linear {
        (0.5 * l * up, [0.5 * up, 0.0, 0.5 * c * l])
    } else if c == 0.0 {
        (
            l * (1.0 - zeta * zeta),
            [1.0 - zeta * zeta, 0.0, -2.0 * zeta * l],
        )
    } else if i == j {
        let last = 2.0 * l - 2.0 + c * zeta;
        let by_zeta = 0.5 * c * l * (last + up);
        (
            0.5 * l * up * last,
            [0.5 * up * (last + 2.0 * l), 0.0, by_zeta],
        )
    } else {
        (
            2.0 * l * m * up,
            [2.0 * m * up, 2.0 * l * up, 2.0 * c * l * m],
        )
    };
    let slope = |corner: usize, axis: usize| match corner {
        0 => -1.0,
        _ => f64::from(u8::from(corner == axis + 1)),
    };
    let along = |axis| by_i * slope(i, axis) + by_j * slope(j, axis);
    (value, [along(0), along(1), by_zeta])
}
