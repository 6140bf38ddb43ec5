//! How far a surface of triangles is from a point, and where it lies.
//!
//! ```text
//! (x − q) · m        q: nearest point, m: normal of the triangle there that x is most in front of
//! ```

use nalgebra::Vector3;

use super::tree::Tree;
use crate::contact::Triangulated;

/// Part of a distance by which another triangle is as near, and of a normal's distance and a triangle's size by which a
/// point may be aside of it.
const ASIDE: [f64; 2] = [1e-6, 1e-9];

/// Cosine of the largest turn of an edge that something may touch.
const SHARP: f64 = 0.5;

/// Corners of triangles, by place.
#[derive(Debug)]
pub(super) struct Triangles {
    corners: Vec<[Vector3<f64>; 3]>,
    tree: Tree,
}

impl Triangles {
    pub(super) fn new(surface: &Triangulated) -> Self {
        let points: Vec<Vector3<f64>> = surface.points().map(Vector3::from).collect();
        let corners = surface
            .triangles()
            .iter()
            .map(|triangle| triangle.map(|corner| points[corner]));
        let corners: Vec<[Vector3<f64>; 3]> = corners.collect();
        let bounds: Vec<_> = corners
            .iter()
            .map(|[a, b, c]| [a.inf(b).inf(c).into(), a.sup(b).sup(c).into()])
            .collect();
        Self {
            tree: Tree::new(&bounds),
            corners,
        }
    }

    /// Signed distance in metre, negative inside, and the unit vector towards the surface; none beyond its rim or a
    /// sharp edge.
    pub(super) fn see(&self, x: Vector3<f64>) -> Option<(f64, Vector3<f64>)> {
        let mut nearest: Vec<(f64, Vector3<f64>, usize)> = Vec::new();
        self.tree.nearest(x.into(), |triangle| {
            let foot = foot(&self.corners[triangle], x);
            let square = (x - foot).norm_squared();
            nearest.push((square, foot, triangle));
            // What is as near has to be found as well.
            Some(square * (1.0 + ASIDE[0]))
        });
        let least = nearest
            .iter()
            .map(|found| found.0)
            .fold(f64::INFINITY, f64::min);
        nearest.retain(|found| found.0 <= least * (1.0 + ASIDE[0]) + f64::MIN_POSITIVE);
        let normals: Vec<Vector3<f64>> = nearest
            .iter()
            .map(|&(_, _, triangle)| {
                let [a, b, c] = self.corners[triangle];
                (b - a).cross(&(c - a)).normalize()
            })
            .collect();
        let apart = x - nearest.first()?.1;
        let front = |normal: &Vector3<f64>| normal.dot(&apart).abs();
        let normal = normals
            .iter()
            .max_by(|a, b| front(a).total_cmp(&front(b)))?;
        let [a, b, _] = self.corners[nearest.first()?.2];
        let (length, along) = (apart.norm(), apart.dot(normal));
        if apart.cross(normal).norm() <= ASIDE[0] * length + ASIDE[1] * (b - a).norm() {
            return Some((along, -normal));
        }
        let sharp = normals
            .iter()
            .any(|a| normals.iter().any(|b| a.dot(b) < SHARP));
        if normals.len() == 1 || (along >= 0.0 && sharp) {
            return None;
        }
        Some((length * along.signum(), -apart * (along.signum() / length)))
    }
}

/// The point of a triangle that is nearest: the foot on its plane if that is inside, else on one of its sides.
fn foot(corners: &[Vector3<f64>; 3], x: Vector3<f64>) -> Vector3<f64> {
    let [a, b, c] = corners;
    let normal = (b - a).cross(&(c - a)).normalize();
    let foot = x - normal * normal.dot(&(x - a));
    let sides = [[a, b], [b, c], [c, a]];
    let inside =
        |[from, to]: &[&Vector3<f64>; 2]| (*to - *from).cross(&(foot - *from)).dot(&normal) >= 0.0;
    if sides.iter().all(inside) {
        return foot;
    }
    let on_side = |[from, to]: [&Vector3<f64>; 2]| {
        let way = to - from;
        from + way * ((x - from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0)
    };
    let feet = sides.map(on_side);
    let square = |foot: &Vector3<f64>| (x - foot).norm_squared();
    feet.into_iter().fold(feet[0], |best, foot| {
        if square(&foot) < square(&best) {
            foot
        } else {
            best
        }
    })
}
