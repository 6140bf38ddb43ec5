//! A profile in the plane: a polyline, or a smooth curve through points; the body lies to the left of the way
//! along it.
//!
//! ```text
//! polyline   straight from point to point
//! smooth     Hermite cubics over the chords, with the tangents of the parabolas through three points
//! ```
//!
//! Beyond an open end there is nothing, nor beyond an edge that turns away by more than 60°: before the edge
//! of a punch.

use nalgebra::Vector2;

use super::{Closest, SHARP};
use crate::error::{Error, check_finite};

/// Part of a piece's length that is round-off at its ends.
const ROUNDED: f64 = 1e-9;

/// Places that are looked at on a curved piece, and halvings from there.
const LOOKS: usize = 16;
const HALVINGS: usize = 60;

/// A curve that bounds an obstacle in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    pieces: Vec<Piece>,
    closed: bool,
}

/// From `from` to `to`, with the tangents there per unit of the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    from: Vector2<f64>,
    to: Vector2<f64>,
    tangents: Option<[Vector2<f64>; 2]>,
}

/// The point of a piece that is nearest.
#[derive(Clone, Copy)]
struct Foot {
    piece: usize,
    parameter: f64,
    position: Vector2<f64>,
    square: f64,
}

impl Profile {
    /// Through points in order, in metre; closed if the last one is the first.
    ///
    /// # Errors
    ///
    /// Fewer than two points, a NaN or infinity, a point twice in a row.
    pub fn new(place: &str, points: &[[f64; 2]], smooth: bool) -> Result<Self, Error> {
        for (at, point) in points.iter().enumerate() {
            check_finite(&format!("{place}[{at}]"), point)?;
        }
        if points.len() < 2 {
            return Err(Error::NotAccepted {
                place: place.to_owned(),
                found: format!("{} points", points.len()),
                accepted: "at least two points".to_owned(),
            });
        }
        if let Some(at) = (1..points.len()).find(|&at| points[at] == points[at - 1]) {
            return Err(Error::NotAccepted {
                place: format!("{place}[{at}]"),
                found: "the point before again".to_owned(),
                accepted: "points that differ from their neighbours".to_owned(),
            });
        }
        let x: Vec<Vector2<f64>> = points.iter().map(|&point| point.into()).collect();
        let closed = x.len() > 3 && points.first() == points.last();
        let pieces = (1..x.len()).map(|k| Piece {
            from: x[k - 1],
            to: x[k],
            tangents: smooth.then(|| {
                let chord = (x[k] - x[k - 1]).norm();
                [k - 1, k].map(|at| tangent(&x, at, closed) * chord)
            }),
        });
        Ok(Self {
            pieces: pieces.collect(),
            closed,
        })
    }

    /// The profile from a position.
    pub(super) fn closest(&self, [x, y, _]: [f64; 3]) -> Closest {
        let x = Vector2::new(x, y);
        let mut feet = (0..self.pieces.len()).map(|piece| self.pieces[piece].foot(piece, x));
        let Some(first) = feet.next() else {
            return Closest::new(f64::INFINITY, nalgebra::Vector3::zeros());
        };
        let foot = feet.fold(first, |best, foot| {
            if foot.square < best.square {
                foot
            } else {
                best
            }
        });
        let normals = self.normals(&foot);
        let apart = x - foot.position;
        let length = apart.norm();
        let piece = &self.pieces[foot.piece];
        let size = (piece.to - piece.from).norm();
        let sum: Vector2<f64> = normals.iter().sum();
        let outside = apart.dot(&sum) >= 0.0;
        let upright = normals
            .iter()
            .map(|normal| normal.perp(&apart).abs())
            .fold(f64::INFINITY, f64::min);
        if upright <= ROUNDED * size {
            // Perpendicular to a piece, or on it: its own normal has all digits.
            let perpendicular =
                |normal: &&Vector2<f64>| normal.perp(&apart).abs() <= ROUNDED * size;
            let normal = normals.iter().find(perpendicular).unwrap_or(&normals[0]);
            return plane_closest(apart.dot(normal), -normal, false);
        }
        let sign = if outside { 1.0 } else { -1.0 };
        let sharp = normals.len() == 2 && normals[0].dot(&normals[1]) < SHARP;
        let beyond = normals.len() == 1 || (outside && sharp);
        plane_closest(sign * length, -apart * (sign / length), beyond)
    }

    /// Normals at a foot: two at a corner, one on a piece and at an open end.
    fn normals(&self, foot: &Foot) -> Vec<Vector2<f64>> {
        let (piece, count) = (foot.piece, self.pieces.len());
        let neighbour = match foot.parameter {
            0.0 if piece > 0 => Some((piece - 1, 1.0)),
            0.0 if self.closed => Some((count - 1, 1.0)),
            1.0 if piece + 1 < count => Some((piece + 1, 0.0)),
            1.0 if self.closed => Some((0, 0.0)),
            _ => None,
        };
        let own = self.pieces[piece].normal(foot.parameter);
        let other = neighbour.map(|(piece, at)| self.pieces[piece].normal(at));
        [Some(own), other].into_iter().flatten().collect()
    }

    /// Number of pieces from point to point.
    #[must_use]
    pub fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// The point of a parameter from 0 to the number of pieces, in metre.
    #[must_use]
    pub fn point(&self, parameter: f64) -> [f64; 2] {
        let last = self.pieces.len() - 1;
        // A negative parameter is the first piece.
        let piece = (parameter as usize).min(last);
        self.pieces[piece].at(parameter - piece as f64).into()
    }

    /// Points along it, close enough to draw it.
    #[must_use]
    pub fn outline(&self) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        for piece in &self.pieces {
            let looks = if piece.tangents.is_some() { LOOKS } else { 1 };
            points.extend((0..looks).map(|k| piece.at(k as f64 / looks as f64)));
        }
        points.extend(self.pieces.last().map(|piece| piece.to));
        points.into_iter().map(Into::into).collect()
    }

    /// Least x of its points, in metre.
    pub(super) fn least_x(&self) -> f64 {
        let ends = self
            .pieces
            .iter()
            .flat_map(|piece| [piece.from.x, piece.to.x]);
        ends.fold(f64::INFINITY, f64::min)
    }
}

fn plane_closest(distance: f64, direction: Vector2<f64>, beyond: bool) -> Closest {
    Closest {
        beyond,
        ..Closest::new(
            distance,
            nalgebra::Vector3::new(direction.x, direction.y, 0.0),
        )
    }
}

/// Derivative by the chord length of the parabola through a point and its neighbours; at an open end
/// through the two next ones, straight where there is only one.
fn tangent(x: &[Vector2<f64>], at: usize, closed: bool) -> Vector2<f64> {
    let last = x.len() - 1;
    let [before, here, after] = match at {
        0 if closed => [last - 1, 0, 1],
        0 => [0, 0, 1],
        at if at == last && closed => [last - 1, last, 1],
        at if at == last => [last - 1, last, last],
        at => [at - 1, at, at + 1],
    };
    let slope = |a: usize, b: usize| (x[b] - x[a]) / (x[b] - x[a]).norm();
    match (before == here, here == after) {
        (true, _) if last > 1 => slope(0, 1) * 2.0 - tangent(x, 1, closed),
        (true, _) => slope(0, 1),
        (_, true) if last > 1 => slope(last - 1, last) * 2.0 - tangent(x, last - 1, closed),
        (_, true) => slope(last - 1, last),
        _ => {
            let [h, k] = [(x[here] - x[before]).norm(), (x[after] - x[here]).norm()];
            (slope(before, here) * k + slope(here, after) * h) / (h + k)
        }
    }
}

impl Piece {
    fn at(&self, t: f64) -> Vector2<f64> {
        let Some([first, second]) = self.tangents else {
            return self.from + (self.to - self.from) * t;
        };
        let (u, v) = (t * t * (3.0 - 2.0 * t), t * (1.0 - t));
        self.from * (1.0 - u) + self.to * u + first * (v * (1.0 - t)) - second * (v * t)
    }

    fn derivative(&self, t: f64) -> Vector2<f64> {
        let Some([first, second]) = self.tangents else {
            return self.to - self.from;
        };
        let chord = (self.to - self.from) * (6.0 * t * (1.0 - t));
        chord + first * ((1.0 - t) * (1.0 - 3.0 * t)) + second * (t * (3.0 * t - 2.0))
    }

    /// To the left.
    fn normal(&self, t: f64) -> Vector2<f64> {
        let along = self.derivative(t);
        Vector2::new(-along.y, along.x).normalize()
    }

    fn foot(&self, piece: usize, x: Vector2<f64>) -> Foot {
        let parameter = match self.tangents {
            None => {
                let along = self.to - self.from;
                ((x - self.from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0)
            }
            Some(_) => self.nearest(x),
        };
        let position = self.at(parameter);
        Foot {
            piece,
            parameter,
            position,
            square: (x - position).norm_squared(),
        }
    }

    /// Parameter of the nearest point of a curved piece.
    fn nearest(&self, x: Vector2<f64>) -> f64 {
        let square = |k: &usize| (self.at(*k as f64 / LOOKS as f64) - x).norm_squared();
        let best = (0..=LOOKS).min_by(|a, b| square(a).total_cmp(&square(b)));
        let best = best.unwrap_or(0) as f64;
        let [mut low, mut high] =
            [best - 1.0, best + 1.0].map(|k| (k / LOOKS as f64).clamp(0.0, 1.0));
        let before = |t: f64| (x - self.at(t)).dot(&self.derivative(t)) > 0.0;
        // At an end it may still be the end that is nearest.
        if !before(low) {
            return low;
        }
        if before(high) {
            return high;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match before(middle) {
                true => low = middle,
                false => high = middle,
            }
        }
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn profile(points: &[[f64; 2]], smooth: bool) -> Profile {
        Profile::new("points", points, smooth).unwrap()
    }

    #[test]
    fn the_body_is_to_the_left_and_ends_are_ends() {
        let floor = profile(&[[0.0, 0.0], [2.0, 0.0], [3.0, 1.0]], false);
        let above = floor.closest([1.0, 0.5, 0.0]);
        assert_eq!(
            (above.distance, above.direction, above.beyond),
            (0.5, [0.0, -1.0, 0.0], false)
        );
        assert_eq!(floor.closest([1.0, -0.5, 0.0]).distance, -0.5);
        // The corner of 45° is seen from either side of both pieces.
        let corner = floor.closest([2.0, -0.1, 0.0]);
        assert!(corner.distance < 0.0 && !corner.beyond);
        assert!(floor.closest([-0.1, 0.1, 0.0]).beyond);
        assert!(!floor.closest([0.0, 0.1, 0.0]).beyond);
    }

    #[test]
    fn nothing_touches_a_sharp_edge_from_beyond() {
        // Up, along and down again: the body of the obstacle is below.
        let punch = profile(&[[-1.0, -1.0], [-1.0, 0.0], [1.0, 0.0], [1.0, -1.0]], false);
        assert!(punch.closest([1.1, 0.1, 0.0]).beyond);
        let edge = punch.closest([1.0, 0.1, 0.0]);
        assert_eq!(
            (edge.distance, edge.direction, edge.beyond),
            (0.1, [0.0, -1.0, 0.0], false)
        );
        let wall = punch.closest([1.25, -0.5, 0.0]);
        assert_eq!((wall.distance, wall.direction), (0.25, [-1.0, 0.0, 0.0]));
    }

    #[test]
    fn a_smooth_closed_profile_through_points_of_a_circle_is_nearly_that_circle() {
        // Cubics over chords of 2π/n: the radius is met to the third power of the chord at least.
        let errors = [16_usize, 32].map(|n| {
            let mut points: Vec<[f64; 2]> = (0..n)
                .map(|k| std::f64::consts::TAU * -(k as f64) / n as f64)
                .map(|angle| [2.0 * angle.cos(), 2.0 * angle.sin()])
                .collect();
            points.push(points[0]);
            let circle = profile(&points, true);
            let mut worst = 0.0_f64;
            for k in 0..200 {
                let (sin, cos) = (0.01 + f64::from(k) * 0.031).sin_cos();
                let seen = circle.closest([2.3 * cos, 2.3 * sin, 0.0]);
                assert!(!seen.beyond);
                worst = worst.max((seen.distance - 0.3).abs());
                let turned = (seen.direction[0] + cos).hypot(seen.direction[1] + sin);
                assert!(turned < 0.02, "{turned}");
            }
            worst
        });
        assert!(
            errors[0] < 2e-3 && errors[1] < errors[0] / 7.0,
            "{errors:?}"
        );
    }

    #[test]
    fn points_that_make_no_curve_are_refused() {
        for points in [
            &[[0.0, 0.0]][..],
            &[[0.0, 0.0], [0.0, 0.0]],
            &[[0.0, 0.0], [f64::NAN, 1.0]],
        ] {
            assert!(Profile::new("profile.points", points, false).is_err());
        }
    }
}
