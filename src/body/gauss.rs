//! Gauss rules of reference cells and facets.
//!
//! Two points per axis integrate the volume, `∫ N_a dV` and `∫ ∇N_a dV` of every linear
//! cell exactly, warped hexahedra included; quadratic cells have three, and simplices six
//! (degree 4: Dunavant, Int. J. Numer. Meth. Engng 21 (1985) 1129–1148) and four (degree 2).
//! Straight-sided ones are integrated exactly with these, but for the rings' `1/r`.

use super::reference::{Family, Point, Reference};

/// The points of a reference cell or facet.
pub(super) fn points(cell: &Reference) -> Vec<Point> {
    let point = |(at, weight)| Point::at(cell, at, weight);
    match (cell.family, cell.dimension) {
        (Family::Simplex, 2) if !cell.is_linear() => {
            six_in_triangle().into_iter().map(point).collect()
        }
        (Family::Simplex, 3) if !cell.is_linear() => four_in_tetrahedron().map(point).into(),
        (Family::Simplex, 2) => vec![point((cell.centre(), 0.5))],
        (Family::Simplex, _) => vec![point((cell.centre(), 1.0 / 6.0))],
        _ if cell.is_linear() => {
            let scale = 1.0 / 3.0_f64.sqrt();
            let corners = cell.nodes.iter();
            corners
                .map(|corner| point((corner.map(|x| x * scale), 1.0)))
                .collect()
        }
        (_, axes) => three_per_axis(axes).into_iter().map(point).collect(),
    }
}

fn three_per_axis(axes: usize) -> Vec<([f64; 3], f64)> {
    let outer = 0.6_f64.sqrt();
    let line = [(-outer, 5.0 / 9.0), (0.0, 8.0 / 9.0), (outer, 5.0 / 9.0)];
    let mut points = vec![([0.0; 3], 1.0)];
    for axis in 0..axes {
        let along = |(at, weight): ([f64; 3], f64)| {
            line.map(|(x, share)| {
                let mut at = at;
                at[axis] = x;
                (at, weight * share)
            })
        };
        points = points.into_iter().flat_map(along).collect();
    }
    points
}

/// Two orbits of three points, exact to degree 4.
fn six_in_triangle() -> Vec<([f64; 3], f64)> {
    let root = 10.0_f64.sqrt();
    let spread = (38.0 - 44.0 * 0.4_f64.sqrt()).sqrt();
    let uneven = (213_125.0 - 53_320.0 * root).sqrt();
    let orbits = [(spread, uneven), (-spread, -uneven)];
    let orbit = |(spread, uneven): (f64, f64)| {
        let near = (8.0 - root + spread) / 18.0;
        let weight = (620.0 + uneven) / 3720.0 / 2.0;
        let far = 1.0 - 2.0 * near;
        [[near, near, 0.0], [far, near, 0.0], [near, far, 0.0]].map(|at| (at, weight))
    };
    orbits.into_iter().flat_map(orbit).collect()
}

/// Exact to degree 2.
fn four_in_tetrahedron() -> [([f64; 3], f64); 4] {
    let near = (5.0 - 5.0_f64.sqrt()) / 20.0;
    let far = 1.0 - 3.0 * near;
    let corner = |axis: usize| std::array::from_fn(|j| if j + 1 == axis { far } else { near });
    [0, 1, 2, 3].map(|axis| (corner(axis), 1.0 / 24.0))
}
