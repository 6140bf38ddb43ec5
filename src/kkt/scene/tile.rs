//! The point of a segment or a triangle that is nearest to a given one.

use nalgebra::Vector3;

/// Shares of the corners in the nearest point; they are positive and add up to one.
pub(super) fn nearest_shares(corners: &[Vector3<f64>], point: Vector3<f64>) -> [f64; 3] {
    match corners {
        [a, b] => {
            let along = on_segment(*a, *b, point);
            [1.0 - along, along, 0.0]
        }
        [a, b, c] => on_triangle([*a, *b, *c], point),
        _ => [1.0, 0.0, 0.0],
    }
}

/// How far along a segment the nearest point is, from 0 to 1.
fn on_segment(a: Vector3<f64>, b: Vector3<f64>, point: Vector3<f64>) -> f64 {
    let span = b - a;
    let length = span.norm_squared();
    match length > 0.0 {
        true => ((point - a).dot(&span) / length).clamp(0.0, 1.0),
        false => 0.0,
    }
}

/// The foot of the perpendicular if it is inside, else the nearest point of the three sides.
fn on_triangle(corners: [Vector3<f64>; 3], point: Vector3<f64>) -> [f64; 3] {
    let [a, b, c] = corners;
    let normal = (b - a).cross(&(c - a));
    let square = normal.norm_squared();
    if square > 0.0 {
        // Share of a corner: signed area of what the point spans with the side across it.
        let share = |from: Vector3<f64>, to: Vector3<f64>| {
            (to - from).cross(&(point - from)).dot(&normal) / square
        };
        let shares = [share(b, c), share(c, a), share(a, b)];
        if shares.iter().all(|share| *share >= 0.0) {
            return shares;
        }
    }
    let mut best = ([1.0, 0.0, 0.0], f64::INFINITY);
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let along = on_segment(corners[i], corners[j], point);
        let away = (corners[i] + (corners[j] - corners[i]) * along - point).norm_squared();
        if away < best.1 {
            let mut shares = [0.0; 3];
            (shares[i], shares[j]) = (1.0 - along, along);
            best = (shares, away);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners() -> [Vector3<f64>; 3] {
        [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(Vector3::from)
    }

    #[test]
    fn over_a_triangle_it_is_the_foot_and_beside_it_a_side_or_a_corner() {
        for (point, shares) in [
            ([1.0, 1.0, 7.0], [0.5, 0.25, 0.25]),
            ([1.0, -3.0, 2.0], [0.75, 0.25, 0.0]),
            ([-1.0, -1.0, 0.0], [1.0, 0.0, 0.0]),
            ([4.0, 4.0, 1.0], [0.0, 0.5, 0.5]),
        ] {
            assert_eq!(nearest_shares(&corners(), point.into()), shares);
        }
    }

    #[test]
    fn on_a_segment_it_is_the_foot_or_an_end() {
        let [a, b, _] = corners();
        for (x, shares) in [(1.0, [0.75, 0.25, 0.0]), (9.0, [0.0, 1.0, 0.0])] {
            assert_eq!(nearest_shares(&[a, b], Vector3::new(x, 5.0, 0.0)), shares);
        }
        assert_eq!(nearest_shares(&[a, a], b), [1.0, 0.0, 0.0]);
    }
}
