//! Gauss rules of reference cells and facets.
//!
//! Two points per axis integrate the volume, `∫ N_a dV` and `∫ ∇N_a dV` of every linear
//! cell exactly, warped hexahedra included; quadratic cells have three, and simplices six
//! (degree 4: Dunavant, Int. J. Numer. Meth. Engng 21 (1985) 1129–1148) and four (degree 2).
//! Prisms take the points of a triangle times those of a line, pyramids those of a line in u and v times a rule for
//! `t² dt` (see `pyramid.rs`). Straight-sided cells are integrated exactly with these, but for the rings' `1/r`.

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
        (Family::Prism, _) => in_prism(cell.is_linear()).map(point).collect(),
        (Family::Pyramid, _) => in_pyramid(cell.is_linear()).map(point).collect(),
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

/// Two points of a line, or three.
fn on_line(two: bool) -> &'static [(f64, f64)] {
    const TWO: f64 = 0.577_350_269_189_625_8;
    const THREE: f64 = 0.774_596_669_241_483_4;
    match two {
        true => &[(-TWO, 1.0), (TWO, 1.0)],
        false => &[(-THREE, 5.0 / 9.0), (0.0, 8.0 / 9.0), (THREE, 5.0 / 9.0)],
    }
}

fn in_prism(linear: bool) -> impl Iterator<Item = ([f64; 3], f64)> {
    let triangle = match linear {
        true => three_in_triangle().to_vec(),
        false => six_in_triangle(),
    };
    triangle.into_iter().flat_map(move |([x, y, _], area)| {
        let heights = on_line(linear).iter();
        heights.map(move |(z, share)| ([x, y, *z], area * share))
    })
}

fn in_pyramid(linear: bool) -> impl Iterator<Item = ([f64; 3], f64)> {
    let heights = if linear {
        two_of_squares()
    } else {
        three_of_squares()
    };
    heights.into_iter().flat_map(move |(t, share)| {
        let line = on_line(linear).iter();
        line.clone().flat_map(move |(u, first)| {
            line.clone()
                .map(move |(v, second)| ([t * u, t * v, 1.0 - t], share * first * second))
        })
    })
}

/// Points and weights for `∫ f(t) t² dt` from 0 to 1, exact to degree 3: roots of `t² − 4/3 t + 2/5`.
fn two_of_squares() -> Vec<(f64, f64)> {
    let spread = (2.0_f64 / 45.0).sqrt();
    let point = |side: f64| {
        (
            2.0 / 3.0 + side * spread,
            1.0 / 6.0 + side / (72.0 * spread),
        )
    };
    vec![point(-1.0), point(1.0)]
}

/// The same to degree 5: roots of `t³ − 15/8 t² + 15/14 t − 5/28`, by Newton's method.
fn three_of_squares() -> Vec<(f64, f64)> {
    let roots = [0.3_f64, 0.65, 0.93].map(|start| {
        (0..8).fold(start, |t, _| {
            let value = ((t - 15.0 / 8.0) * t + 15.0 / 14.0) * t - 5.0 / 28.0;
            t - value / ((3.0 * t - 15.0 / 4.0) * t + 15.0 / 14.0)
        })
    });
    let weight = |at: usize| {
        let [t, a, b] = [0, 1, 2].map(|k| roots[(at + k) % 3]);
        (
            t,
            (1.0 / 5.0 - (a + b) / 4.0 + a * b / 3.0) / ((t - a) * (t - b)),
        )
    };
    (0..3).map(weight).collect()
}

fn three_per_axis(axes: usize) -> Vec<([f64; 3], f64)> {
    let mut points = vec![([0.0; 3], 1.0)];
    for axis in 0..axes {
        let along = |(at, weight): ([f64; 3], f64)| {
            on_line(false).iter().map(move |(x, share)| {
                let mut at = at;
                at[axis] = *x;
                (at, weight * share)
            })
        };
        points = points.into_iter().flat_map(along).collect();
    }
    points
}

/// Exact to degree 2.
pub(super) fn three_in_triangle() -> [([f64; 3], f64); 3] {
    let [near, far] = [1.0 / 6.0, 2.0 / 3.0];
    [[near, near, 0.0], [far, near, 0.0], [near, far, 0.0]].map(|at| (at, 1.0 / 6.0))
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
