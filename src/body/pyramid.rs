//! Shape functions of pyramids: rational, so that they are those of triangles and quadrilaterals on the faces.
//!
//! With `t = 1 − z`, `u = x/t`, `v = y/t` on `|x|, |y| ≤ t`, the base at z = 0 and the apex at z = 1:
//!
//! ```text
//! linear      ¼ t (1 + a u) (1 + b v) at the corner (a, b) of the base,  z at the apex
//! quadratic   (a x + b y − 1) times that,  z (2 z − 1)
//!             ½ t² (1 − u²) (1 + b v) half way along x,  z t (1 + a u) (1 + b v) half way up
//! ```
//!
//! Bedrosian, Int. J. Numer. Meth. Engng 35 (1992) 95–108. At the apex their derivatives depend on the way there.
//! Seen over (u, v, t) all are polynomials, and so are their derivatives along x, y and z: a product of
//! Gauss rules in u and v with one for `t² dt` integrates those of cells with straight sides exactly.

/// Value and derivatives of the shape function of a node.
pub(super) fn shape(linear: bool, node: &[f64; 3], [x, y, z]: [f64; 3]) -> (f64, [f64; 3]) {
    let t = 1.0 - z;
    let (u, v) = if t > 0.0 { (x / t, y / t) } else { (0.0, 0.0) };
    if node[2] == 1.0 {
        return match linear {
            true => (z, [0.0, 0.0, 1.0]),
            false => (z * (2.0 * z - 1.0), [0.0, 0.0, 4.0 * z - 1.0]),
        };
    }
    // Its corner of the base, 0 along a side.
    let [a, b] = [node[0], node[1]].map(|c| if c == 0.0 { 0.0 } else { c.signum() });
    let (p, q) = (1.0 + a * u, 1.0 + b * v);
    let whole = t * p * q;
    let slopes = [a * q, b * p, a * b * u * v - 1.0];
    if linear {
        return (0.25 * whole, slopes.map(|slope| 0.25 * slope));
    }
    if node[2] > 0.0 {
        let [along, across, up] = slopes.map(|slope| z * slope);
        return (z * whole, [along, across, up + whole]);
    }
    let bubble = |u: f64| 1.0 - u * u;
    match (a == 0.0, b == 0.0) {
        (true, _) => side(t, [u, b, q], bubble(u)),
        (_, true) => {
            let (value, [across, along, up]) = side(t, [v, a, p], bubble(v));
            (value, [along, across, up])
        }
        _ => {
            let last = a * x + b * y - 1.0;
            let [along, across, up] = slopes.map(|slope| 0.25 * slope * last);
            let corner = 0.25 * whole;
            (last * corner, [along + a * corner, across + b * corner, up])
        }
    }
}

/// Half way along a side of the base: value, and derivatives along the side, across it and up.
fn side(t: f64, [u, b, q]: [f64; 3], bubble: f64) -> (f64, [f64; 3]) {
    let up = -t * (q + 0.5 * bubble - 0.5 * bubble * q);
    (
        0.5 * t * t * bubble * q,
        [-t * u * q, 0.5 * b * t * bubble, up],
    )
}
