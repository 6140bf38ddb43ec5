//! Convex polygons in a plane: cut, intersection, difference, area.
//!
//! Corners run counter-clockwise. An intersection is cut out edge by edge (Sutherland &
//! Hodgman, Comm. ACM 17 (1974) 32–42); what each cut throws away is the difference.

use nalgebra::{SVector, Vector2};

/// A point of the plane.
pub(super) type Point = Vector2<f64>;

/// Corners of a convex polygon, counter-clockwise; fewer than three enclose nothing.
pub(super) type Polygon = Vec<Point>;

/// `a_1 b_2 − a_2 b_1`: twice the area between two vectors, positive when `b` is to the left.
pub(super) fn cross(a: Point, b: Point) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Area, negative when the corners run clockwise.
pub(super) fn area(polygon: &[Point]) -> f64 {
    fan(polygon)
        .map(|[a, b, c]| cross(b - a, c - a))
        .sum::<f64>()
        / 2.0
}

/// The triangles between the first corner and the edges.
pub(super) fn fan(polygon: &[Point]) -> impl Iterator<Item = [Point; 3]> {
    let edges = polygon.get(1..).unwrap_or_default().windows(2);
    edges.map(|edge| [polygon[0], edge[0], edge[1]])
}

/// Turn at a corner, as a part of the square of a facet's size, that is none.
const STRAIGHT: f64 = 1e-9;

/// The corners at which a polygon turns.
pub(super) fn turning(polygon: &[Point]) -> Polygon {
    let mut kept = Polygon::new();
    for (index, &corner) in polygon.iter().enumerate() {
        let before = kept.last().or(polygon.last()).copied().unwrap_or(corner);
        let after = match polygon.get(index + 1) {
            Some(next) => *next,
            None => kept.first().copied().unwrap_or(corner),
        };
        if cross(corner - before, after - corner).abs() > STRAIGHT {
            kept.push(corner);
        }
    }
    if kept.len() < 3 {
        polygon.to_vec()
    } else {
        kept
    }
}

/// Centre of area; the polygon encloses some.
pub(super) fn centroid(polygon: &[Point]) -> Point {
    let (mut area, mut moment) = (0.0, Point::zeros());
    for [a, b, c] in fan(polygon) {
        let twice = cross(b - a, c - a);
        area += twice;
        moment += (a + b + c) * (twice / 3.0);
    }
    moment / area
}

/// The parts to the left and to the right of the line from `from` to `to`.
fn cut(polygon: &[Point], from: Point, to: Point) -> [Polygon; 2] {
    let [mut left, mut right] = [Polygon::new(), Polygon::new()];
    let side = |point: Point| cross(to - from, point - from);
    for (index, &corner) in polygon.iter().enumerate() {
        let next = polygon[(index + 1) % polygon.len()];
        let (here, there) = (side(corner), side(next));
        if here >= 0.0 {
            left.push(corner);
        }
        if here <= 0.0 {
            right.push(corner);
        }
        if here * there < 0.0 {
            let crossing = corner + (next - corner) * (here / (here - there));
            left.push(crossing);
            right.push(crossing);
        }
    }
    [left, right]
}

/// Start and end of each edge.
fn edges(polygon: &[Point]) -> impl Iterator<Item = (Point, Point)> {
    let ends = polygon.iter().skip(1).chain(polygon.first());
    polygon.iter().copied().zip(ends.copied())
}

/// What two polygons have in common.
pub(super) fn intersection(polygon: &[Point], other: &[Point]) -> Polygon {
    let mut common = polygon.to_vec();
    for (from, to) in edges(other) {
        if common.len() < 3 {
            break;
        }
        let [left, _] = cut(&common, from, to);
        common = left;
    }
    common
}

/// What is left of a polygon without another one, in convex parts larger than `least`.
pub(super) fn difference(polygon: &[Point], other: &[Point], least: f64) -> Vec<Polygon> {
    let mut parts = Vec::new();
    let mut rest = polygon.to_vec();
    for (from, to) in edges(other) {
        let [inside, outside] = cut(&rest, from, to);
        if area(&outside) > least {
            parts.push(outside);
        }
        rest = inside;
    }
    parts
}

/// The point of a segment that is nearest to another one.
pub(super) fn on_segment<const N: usize>(
    [from, to]: [SVector<f64, N>; 2],
    other: SVector<f64, N>,
) -> SVector<f64, N> {
    let along = to - from;
    let share = (other - from).dot(&along) / along.norm_squared();
    // Ends that coincide leave 0/0, which is the start.
    let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
    from + along * share
}

/// The point of a polygon that is nearest to another one.
pub(super) fn nearest(polygon: &[Point], other: Point) -> Point {
    let left = |(from, to): (Point, Point)| cross(to - from, other - from) >= 0.0;
    if edges(polygon).all(left) {
        return other;
    }
    let on_edges = edges(polygon).map(|(from, to)| on_segment([from, to], other));
    let distance = |at: &Point| (at - other).norm_squared();
    on_edges
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, edge: f64) -> Polygon {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(|(a, b)| Point::new(x + a * edge, y + b * edge))
            .to_vec()
    }

    #[test]
    fn only_corners_at_which_a_polygon_turns_are_kept() {
        let plain = square(0.0, 0.0, 1.0);
        let mut more = plain.clone();
        more.insert(1, Point::new(0.5, 0.0));
        more.insert(3, Point::new(1.0, 1e-12));
        more.push(Point::new(0.0, 0.25));
        assert_eq!(turning(&plain), plain);
        let found = turning(&more);
        assert_eq!(found.len(), 4);
        assert!((area(&found) - 1.0).abs() < 1e-11);
        assert_eq!(turning(&plain[..2]), plain[..2]);
    }

    fn diamond() -> Polygon {
        [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]
            .map(|(x, y)| Point::new(x, y))
            .to_vec()
    }

    #[test]
    fn a_square_cuts_a_corner_off_a_diamond() {
        // The quarter of |x| + |y| ≤ 1 in x, y ≥ 0: a triangle of area ½, centroid at a third.
        let common = intersection(&diamond(), &square(0.0, 0.0, 2.0));
        assert!((area(&common) - 0.5).abs() < 1e-15);
        assert!((centroid(&common) - Point::new(1.0, 1.0) / 3.0).norm() < 1e-15);
    }

    #[test]
    fn a_polygon_is_its_intersection_and_its_difference_together() {
        let (whole, other) = (square(-0.3, -0.4, 1.1), diamond());
        let outside = difference(&whole, &other, 0.0);
        let outside: f64 = outside.iter().map(|part| area(part)).sum();
        let inside = area(&intersection(&whole, &other));
        assert!((inside + outside - 1.21).abs() < 1e-15 && outside > 0.1);
    }

    #[test]
    fn polygons_that_only_touch_have_nothing_in_common() {
        for other in [
            square(1.0, 0.0, 1.0),
            square(1.0, 1.0, 1.0),
            square(3.0, 0.5, 1.0),
        ] {
            assert_eq!(area(&intersection(&square(0.0, 0.0, 1.0), &other)), 0.0);
        }
    }

    #[test]
    fn nothing_is_left_of_a_polygon_inside_another() {
        assert!(difference(&diamond(), &square(-1.0, -1.0, 2.0), 0.0).is_empty());
    }

    #[test]
    fn a_point_beside_a_polygon_is_nearest_to_an_edge_or_a_corner() {
        let polygon = square(0.0, 0.0, 1.0);
        for (from, expected) in [
            ([0.3, 0.9], [0.3, 0.9]),
            ([1.5, 0.25], [1.0, 0.25]),
            ([-1.0, 4.0], [0.0, 1.0]),
        ] {
            assert_eq!(nearest(&polygon, Point::from(from)), Point::from(expected));
        }
    }
}
