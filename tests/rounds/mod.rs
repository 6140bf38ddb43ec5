//! Tubes and balls: meshes whose nodes all lie on circles or spheres, and what Lamé says of them.
#![allow(dead_code)]

use std::collections::HashMap;
use std::f64::consts::FRAC_PI_4;

use dpana::body::{CellKind, Facet, Group, Mesh, box_mesh, graded, rectangle};

/// A mesh of the unit square (cube in 3D), the last axis across the wall, bent by `to`. Its groups
/// are those of the generator: `bottom` inside, `top` outside.
pub(crate) fn bent(kind: CellKind, cells: [usize; 2], to: impl Fn([f64; 3]) -> [f64; 3]) -> Mesh {
    let lines = |count| graded(0.0, 1.0, count, 1.0).unwrap();
    let (along, across) = (lines(cells[0]), lines(cells[1]));
    let mut mesh = match kind.dimension() {
        2 => rectangle(&along, &across, kind).unwrap(),
        _ => box_mesh(&along, &along, &across, kind).unwrap(),
    };
    mesh.nodes.iter_mut().for_each(|node| *node = to(*node));
    mesh
}

/// A quarter of a tube between two radii; `left` on the plane x = 0, `right` on y = 0.
pub(crate) fn quarter(kind: CellKind, [inner, outer]: [f64; 2], cells: [usize; 2]) -> Mesh {
    bent(kind, cells, |[x, y, _]| {
        let r = inner + (outer - inner) * y;
        let (sin, cos) = (2.0 * FRAC_PI_4 * x).sin_cos();
        [r * sin, if x == 1.0 { 0.0 } else { r * cos }, 0.0]
    })
}

/// A whole tube between two radii, its first cell beginning at an angle of `turned`.
pub(crate) fn tube(
    kind: CellKind,
    [inner, outer]: [f64; 2],
    cells: [usize; 2],
    turned: f64,
) -> Mesh {
    let closed = bent(kind, cells, |[x, y, _]| {
        let r = inner + (outer - inner) * y;
        // Against the clock the square would be turned over.
        let angle = if x == 1.0 { 0.0 } else { x };
        let (sin, cos) = (turned - 8.0 * FRAC_PI_4 * angle).sin_cos();
        [r * cos, r * sin, 0.0]
    });
    glued(&[closed], ["bottom", "top"])
}

/// An octant of a hollow ball between two radii, with 3 × `cells[0]`² cells along its faces; `x`,
/// `y` and `z` are the planes on which these vanish.
pub(crate) fn octant(kind: CellKind, [inner, outer]: [f64; 2], cells: [usize; 2]) -> Mesh {
    let patches = [0, 1, 2].map(|turn| {
        let mut patch = bent(kind, cells, |[s, t, r]| {
            let r = inner + (outer - inner) * r;
            let [s, t] = [s, t].map(|x: f64| match x {
                1.0 => 1.0,
                _ => (FRAC_PI_4 * x).tan(),
            });
            let length = r / (1.0 + s * s + t * t).sqrt();
            let mut ray = [length, length * s, length * t];
            ray.rotate_right(turn);
            ray
        });
        for (side, axis) in [("left", 1), ("front", 2)] {
            let name = ["x", "y", "z"][(axis + turn) % 3].to_owned();
            let facets = patch.groups.remove(side).unwrap();
            patch.groups.insert(name, facets);
        }
        patch
    });
    glued(&patches, ["x", "y", "z", "bottom", "top"])
}

/// A quarter of a disc of radius 1 of 3 × `cells`² cells; `top` on the circle, `x` and `y` are the planes
/// on which these vanish.
pub(crate) fn quarter_disc(kind: CellKind, cells: usize) -> Mesh {
    let between = |core: [f64; 2], angle: f64, share: f64| {
        let (sin, cos) = angle.sin_cos();
        let [x, y] = [[core[0], cos], [core[1], sin]].map(|[a, b]| a + (b - a) * share);
        [x, y, 0.0]
    };
    let mut core = bent(kind, [cells, cells], |[x, y, _]| [x / 2.0, y / 2.0, 0.0]);
    let mut right = bent(kind, [cells, cells], |[x, y, _]| {
        let up = 1.0 - x;
        between([0.5, up / 2.0], FRAC_PI_4 * up, y)
    });
    let mut above = bent(kind, [cells, cells], |[x, y, _]| {
        let off = between([0.5, x / 2.0], FRAC_PI_4 * x, y);
        // The part to the right, mirrored at the diagonal.
        [off[1], off[0], 0.0]
    });
    rename(&mut core, [("left", "x"), ("bottom", "y")]);
    rename(&mut right, [("right", "y"), ("bottom", "inside")]);
    rename(&mut above, [("left", "x"), ("bottom", "inside")]);
    core.groups.remove("top");
    glued(&[core, right, above], ["x", "y", "top"])
}

/// A quarter of a square of half side 2 around a disc of radius 1, of 2 × `cells`² cells; `bottom`
/// on the circle, `x` and `y` are the planes on which these vanish, `right` and `above` the sides.
pub(crate) fn quarter_square(kind: CellKind, cells: usize) -> Mesh {
    let between = |along: f64, share: f64| {
        let (sin, cos) = (FRAC_PI_4 * along).sin_cos();
        [cos + (2.0 - cos) * share, sin + (2.0 * along - sin) * share]
    };
    let mut right = bent(kind, [cells, cells], |[x, y, _]| {
        let [x, y] = between(1.0 - x, y);
        [x, y, 0.0]
    });
    let mut above = bent(kind, [cells, cells], |[x, y, _]| {
        let [y, x] = between(x, y);
        [x, y, 0.0]
    });
    rename(&mut right, [("right", "y"), ("top", "right")]);
    rename(&mut above, [("left", "x"), ("top", "above")]);
    right.groups.remove("left");
    above.groups.remove("right");
    glued(&[right, above], ["x", "y", "bottom", "right", "above"])
}

/// Gives groups other names, one after the other.
fn rename<const COUNT: usize>(mesh: &mut Mesh, names: [(&str, &str); COUNT]) {
    for (old, new) in names {
        let group = mesh.groups.remove(old).unwrap();
        mesh.groups.insert(new.to_owned(), group);
    }
}

/// Meshes joined at the nodes that they share, with the surfaces of these names.
fn glued<const NAMES: usize>(parts: &[Mesh], names: [&str; NAMES]) -> Mesh {
    let dimension = parts[0].dimension;
    let mut whole = Mesh::new(dimension, Vec::new());
    let mut known: HashMap<[i64; 3], usize> = HashMap::new();
    let mut facets = vec![Vec::new(); NAMES];
    for part in parts {
        let numbers = part.nodes.iter().map(|node| {
            // Far above round-off, far below the distance of two nodes.
            let key = node.map(|x| (x * 1e8).round() as i64);
            *known.entry(key).or_insert_with(|| {
                whole.nodes.push(*node);
                whole.nodes.len() - 1
            })
        });
        let numbers: Vec<usize> = numbers.collect();
        let renumbered = |nodes: &[usize]| nodes.iter().map(|n| numbers[*n]).collect::<Vec<_>>();
        for cell in part.cells() {
            whole.push_cell(cell.kind, &renumbered(cell.nodes));
        }
        for (facets, name) in facets.iter_mut().zip(names) {
            let Some(Group::Facets(of_part)) = part.groups.get(name) else {
                continue;
            };
            facets.extend(of_part.iter().map(|facet| Facet {
                nodes: renumbered(&facet.nodes),
            }));
        }
    }
    let groups = names.iter().zip(facets);
    whole
        .groups
        .extend(groups.map(|(name, facets)| ((*name).to_owned(), Group::Facets(facets))));
    let cells = (0..whole.cell_count()).collect();
    whole.groups.insert("body".to_owned(), Group::Cells(cells));
    whole
}

/// The wall of a tube in plane strain (`dimension` 2) or of a ball (3) under radial pressures.
///
/// ```text
/// u_r = A r + B r^(1−d),   σ_r = (d λ + 2 G) A − 2 (d − 1) G B r^(−d)
/// ```
///
/// Timoshenko & Goodier, Theory of Elasticity (1970), art. 28 and 136.
pub(crate) struct Wall {
    pub(crate) dimension: i32,
    pub(crate) young: f64,
    pub(crate) poisson: f64,
}

impl Wall {
    pub(crate) fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// A r and B r^(1−d) per unit of A and B, and σ_r per unit of A and B, at a radius.
    fn terms(&self, r: f64) -> ([f64; 2], [f64; 2]) {
        let d = f64::from(self.dimension);
        let lambda = 2.0 * self.shear() * self.poisson / (1.0 - 2.0 * self.poisson);
        (
            [r, r.powi(1 - self.dimension)],
            [
                d * lambda + 2.0 * self.shear(),
                -2.0 * (d - 1.0) * self.shear() * r.powi(-self.dimension),
            ],
        )
    }

    /// Radial displacement towards the wall's middle per unit of pressure at `loaded`, in m/Pa,
    /// its other side at `other` free or, if `held`, in place.
    pub(crate) fn given(&self, loaded: f64, other: f64, held: bool) -> f64 {
        let (u, stress) = self.terms(loaded);
        let (at_other, stress_there) = self.terms(other);
        let [a, b] = if held { at_other } else { stress_there };
        // A = −b, B = a vanishes at `other`, up to a factor.
        let moved = -b * u[0] + a * u[1];
        let pressure = b * stress[0] - a * stress[1];
        (moved / pressure).abs()
    }
}
