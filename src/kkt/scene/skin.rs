//! One side of a contact pair: its facets as the mesh has them, and the nearest point on them.
//!
//! Facets are cut into straight tiles, of which a tree finds the nearest; on a facet that is curved or
//! no parallelogram the foot is then moved by Gauss–Newton steps on `‖x(ξ) − p‖²`.

use std::collections::HashMap;

use nalgebra::{Matrix2, Vector2, Vector3};

use super::tile::nearest_shares;
use super::tree::{Bounds, Tree};
use crate::body::{Body, Facet, FacetReference, Mesh};

/// Turn between facets, in radian, from which the edge between them is one of the body's own, 34°.
const CORNER: f64 = 0.6;

/// Steps towards the foot on a curved facet: the error squares with each.
const STEPS: usize = 4;

/// Share of a reference facet that is round-off.
const ROUNDED: f64 = 1e-9;

/// Least cosine between one side's normal and the other's reversed for them to face.
const FACING: f64 = 0.1;

/// One side of a pair.
#[derive(Clone, Debug)]
pub(super) struct Skin {
    /// Index of the body.
    pub(super) body: usize,
    pub(super) dimension: usize,
    pub(super) faces: Vec<Face>,
    /// Faces around each node.
    pub(super) of_node: HashMap<usize, Vec<usize>>,
    tiles: Vec<Tile>,
    tree: Tree,
}

/// A facet of a side.
#[derive(Clone, Debug)]
pub(super) struct Face {
    pub(super) nodes: Vec<usize>,
    x: Vec<Vector3<f64>>,
    reference: FacetReference,
    /// Outward in the order of its nodes, or inward.
    sign: f64,
    /// Largest distance between nodes, in metre.
    pub(super) size: f64,
    /// How far the smooth surface may stand off it, in metre.
    pub(super) sagitta: f64,
    /// Its tiles are the facet.
    straight: bool,
    /// Whether the edge from each corner on is one where the side ends.
    pub(super) rim: Vec<bool>,
}

impl Face {
    /// Positions of the corners, in metre.
    pub(super) fn corners(&self) -> impl Iterator<Item = Vector3<f64>> + '_ {
        let corners = self.reference.hats(self.reference.centre()).len();
        self.x[..corners].iter().copied()
    }

    /// Position of the middle, in metre.
    pub(super) fn middle(&self) -> Vector3<f64> {
        self.position(self.reference.centre())
    }
}

/// A straight part of a facet.
#[derive(Clone, Debug)]
struct Tile {
    face: usize,
    /// Corners on the reference facet.
    at: Vec<[f64; 3]>,
    x: Vec<Vector3<f64>>,
    normal: Vector3<f64>,
}

/// A point of a side.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub(super) face: usize,
    /// Values of the shape functions, in the order of the facet's nodes.
    pub(super) shape: Vec<f64>,
    pub(super) position: Vector3<f64>,
    /// Outward unit normal.
    pub(super) normal: Vector3<f64>,
    /// It is on an edge where the side ends.
    pub(super) on_rim: bool,
}

impl Skin {
    /// Faces at a plane of symmetry stand off the smooth surface as if their images were there; `held` are the directions
    /// along which supports hold a node.
    pub(super) fn see_images<'a>(&mut self, held: impl Fn(usize) -> &'a [Vector3<f64>]) {
        for tile in &self.tiles {
            let face = &mut self.faces[tile.face];
            let planes = face.nodes.iter().flat_map(|&node| held(node));
            let leans = planes.map(|plane| plane.dot(&tile.normal).abs().min(1.0).asin());
            let turns = leans.map(|lean| 2.0 * lean).filter(|turn| *turn < CORNER);
            let turn = turns.fold(0.0, f64::max);
            face.sagitta = face.sagitta.max(face.size * turn / 8.0);
        }
    }

    /// The given facets of a body; what is no facet of a cell is left out.
    pub(super) fn new(index: usize, body: &Body, facets: &[Facet]) -> Self {
        let mesh = &body.mesh;
        let mut faces = faces(mesh, facets);
        let mut of_node: HashMap<usize, Vec<usize>> = HashMap::new();
        for (number, face) in faces.iter().enumerate() {
            for &node in &face.nodes {
                of_node.entry(node).or_default().push(number);
            }
        }
        mark_rims(&mut faces, mesh.dimension);
        let tiles: Vec<Tile> = faces.iter().enumerate().flat_map(tiles).collect();
        measure_turns(&mut faces, &of_node, &tiles);
        let bounds: Vec<Bounds> = tiles.iter().map(Tile::bounds).collect();
        Self {
            body: index,
            dimension: mesh.dimension,
            faces,
            of_node,
            tree: Tree::new(&bounds),
            tiles,
        }
    }

    /// The nodes and the centre of every facet.
    pub(super) fn samples(&self) -> impl Iterator<Item = Place> + '_ {
        self.faces
            .iter()
            .enumerate()
            .flat_map(move |(number, face)| {
                let nodes = face.reference.nodes().iter().copied();
                let places = nodes.chain([face.reference.centre()]);
                places.filter_map(move |at| self.place(number, at))
            })
    }

    /// The nearest point of the side, of facets that face a normal if one is given.
    pub(super) fn foot(&self, point: Vector3<f64>, facing: Option<Vector3<f64>>) -> Option<Place> {
        let mut best = (f64::INFINITY, None);
        self.tree.nearest(point.into(), |number| {
            let tile = &self.tiles[number];
            if facing.is_some_and(|normal| -normal.dot(&tile.normal) < FACING) {
                return None;
            }
            let shares = nearest_shares(&tile.x, point);
            let foot: Vector3<f64> = tile.x.iter().zip(shares).map(|(x, s)| x * s).sum();
            let square = (foot - point).norm_squared();
            if square < best.0 {
                best = (square, Some((tile, shares)));
            }
            Some(square)
        });
        let (tile, shares) = best.1?;
        let at = std::array::from_fn(|axis| {
            let terms = tile.at.iter().zip(shares);
            terms.map(|(corner, share)| corner[axis] * share).sum()
        });
        let face = &self.faces[tile.face];
        let at = match face.straight {
            true => at,
            false => face.towards(at, point, self.dimension),
        };
        self.place(tile.face, at)
    }

    /// Numbers of the faces that share a node with any of the given ones, these among them.
    pub(super) fn around(&self, faces: &[usize]) -> Vec<usize> {
        let nodes = faces.iter().flat_map(|&face| &self.faces[face].nodes);
        let mut around: Vec<usize> = nodes.flat_map(|node| self.at(*node)).copied().collect();
        around.sort_unstable();
        around.dedup();
        around
    }

    /// The faces at a node.
    pub(super) fn at(&self, node: usize) -> &[usize] {
        self.of_node.get(&node).map_or(&[], Vec::as_slice)
    }

    /// Whether the side ends at a corner, be it with an edge of a neighbouring facet.
    fn ends_at(&self, node: usize) -> bool {
        self.at(node).iter().any(|&number| {
            let (nodes, rim) = (&self.faces[number].nodes, &self.faces[number].rim);
            let found = nodes[..rim.len()].iter().position(|&corner| corner == node);
            found.is_some_and(|k| match rim.len() {
                2 => rim[k],
                corners => rim[k] || rim[(k + corners - 1) % corners],
            })
        })
    }

    fn place(&self, number: usize, at: [f64; 3]) -> Option<Place> {
        let face = &self.faces[number];
        let hats = face.reference.hats(at);
        let corners = hats.len();
        let on_edge = |corner: usize| match corners {
            2 => hats[corner] >= 1.0 - ROUNDED,
            _ => hats[corner] + hats[(corner + 1) % corners] >= 1.0 - ROUNDED,
        };
        Some(Place {
            face: number,
            shape: face.reference.shape(at),
            position: face.position(at),
            normal: face.normal(at, self.dimension)?,
            on_rim: (0..corners).any(|corner| {
                let here = hats[corner] >= 1.0 - ROUNDED;
                (face.rim[corner] && on_edge(corner)) || (here && self.ends_at(face.nodes[corner]))
            }),
        })
    }
}

impl Face {
    fn position(&self, at: [f64; 3]) -> Vector3<f64> {
        let terms = self.x.iter().zip(self.reference.shape(at));
        terms.map(|(x, shape)| x * shape).sum()
    }

    /// `∂x/∂ξ_j`.
    fn tangents(&self, at: [f64; 3]) -> [Vector3<f64>; 2] {
        let mut tangents = [Vector3::zeros(); 2];
        for (x, slope) in self.x.iter().zip(self.reference.slopes(at)) {
            tangents[0] += x * slope[0];
            tangents[1] += x * slope[1];
        }
        tangents
    }

    fn normal(&self, at: [f64; 3], dimension: usize) -> Option<Vector3<f64>> {
        let [first, second] = self.tangents(at);
        let normal = match dimension {
            2 => first.cross(&Vector3::z()),
            _ => first.cross(&second),
        };
        Some(normal.try_normalize(0.0)? * self.sign)
    }

    /// The nearest point of the facet, from a position on the reference facet near it.
    fn towards(&self, start: [f64; 3], point: Vector3<f64>, dimension: usize) -> [f64; 3] {
        let away = |at: [f64; 3]| (self.position(at) - point).norm_squared();
        let (mut at, mut best) = (start, start);
        for _ in 0..STEPS {
            let [first, second] = self.tangents(at);
            let apart = point - self.position(at);
            let right = Vector2::new(first.dot(&apart), second.dot(&apart));
            let step = if dimension == 2 {
                Vector2::new(right.x / first.norm_squared(), 0.0)
            } else {
                let cross = first.dot(&second);
                let square =
                    Matrix2::new(first.norm_squared(), cross, cross, second.norm_squared());
                square.try_inverse().unwrap_or_default() * right
            };
            at = self.inside([at[0] + step.x, at[1] + step.y, 0.0]);
            if away(at) < away(best) {
                best = at;
            }
        }
        best
    }

    /// A position on the reference facet, moved onto it where it is beside it.
    fn inside(&self, at: [f64; 3]) -> [f64; 3] {
        if !self.reference.is_simplex() {
            return at.map(|x| x.clamp(-1.0, 1.0));
        }
        let [x, y] = [at[0].max(0.0), at[1].max(0.0)];
        let sum = (x + y).max(1.0);
        [x / sum, y / sum, 0.0]
    }
}

impl Tile {
    fn bounds(&self) -> Bounds {
        let edge = |axis: usize, of: fn(f64, f64) -> f64| {
            let along = self.x.iter().map(|x| x[axis]);
            along.reduce(of).unwrap_or_default()
        };
        [f64::min as fn(f64, f64) -> f64, f64::max]
            .map(|of| std::array::from_fn(|axis| edge(axis, of)))
    }
}

/// Each facet once, with the side of it on which its cell is.
fn faces(mesh: &Mesh, facets: &[Facet]) -> Vec<Face> {
    let mut on_side = vec![false; mesh.nodes.len()];
    let mut numbers: HashMap<Vec<usize>, usize> = HashMap::new();
    let mut of_node: HashMap<usize, Vec<usize>> = HashMap::new();
    for (number, facet) in facets.iter().enumerate() {
        if facet.nodes.iter().any(|node| *node >= mesh.nodes.len()) {
            continue;
        }
        let mut key = facet.nodes.clone();
        key.sort_unstable();
        if *numbers.entry(key).or_insert(number) == number {
            for &node in &facet.nodes {
                on_side[node] = true;
                of_node.entry(node).or_default().push(number);
            }
        }
    }
    let mut signs = vec![0.0; facets.len()];
    for cell in mesh.cells() {
        let touching = cell.nodes.iter().filter(|node| on_side[**node]);
        if touching.clone().count() < mesh.dimension {
            continue;
        }
        for &number in touching.flat_map(|node| &of_node[node]) {
            let nodes = &facets[number].nodes;
            if nodes.iter().all(|node| cell.nodes.contains(node)) {
                signs[number] = outward(mesh, nodes, cell.nodes);
            }
        }
    }
    let sided = facets.iter().zip(signs).filter(|(_, sign)| *sign != 0.0);
    sided
        .filter_map(|(facet, sign)| Face::new(mesh, facet, sign))
        .collect()
}

/// 1 if the order of a facet's nodes has its cell behind it, else −1.
fn outward(mesh: &Mesh, facet: &[usize], cell: &[usize]) -> f64 {
    let mean = |nodes: &[usize]| {
        let sum: Vector3<f64> = nodes.iter().map(|&k| Vector3::from(mesh.nodes[k])).sum();
        sum / nodes.len() as f64
    };
    let facet = Facet {
        nodes: facet.to_vec(),
    };
    let normal = Vector3::from(mesh.facet_geometry(&facet).normal);
    normal.dot(&(mean(&facet.nodes) - mean(cell))).signum()
}

impl Face {
    fn new(mesh: &Mesh, facet: &Facet, sign: f64) -> Option<Self> {
        let reference = FacetReference::of(mesh.dimension, facet.nodes.len())?;
        let nodes = facet.nodes.iter();
        let x: Vec<_> = nodes.map(|&k| Vector3::from(mesh.nodes[k])).collect();
        let size = x.iter().flat_map(|a| x.iter().map(move |b| (a - b).norm()));
        let size = size.fold(0.0, f64::max);
        let quadratic = reference.corners() < x.len();
        let parallel = match x[..] {
            [a, b, c, d] => (a - b + c - d).norm() <= ROUNDED * size,
            _ => true,
        };
        Some(Self {
            nodes: facet.nodes.clone(),
            x,
            reference,
            sign,
            size,
            sagitta: 0.0,
            straight: parallel && !quadratic,
            rim: vec![false; reference.corners()],
        })
    }
}

/// Marks the edges that only one face has; in 2D the ends.
fn mark_rims(faces: &mut [Face], dimension: usize) {
    let edge = |face: &Face, corner: usize| {
        let next = match dimension {
            2 => corner,
            _ => (corner + 1) % face.rim.len(),
        };
        let (a, b) = (face.nodes[corner], face.nodes[next]);
        [a.min(b), a.max(b)]
    };
    let mut owners: HashMap<[usize; 2], usize> = HashMap::new();
    for face in faces.iter() {
        for corner in 0..face.rim.len() {
            *owners.entry(edge(face, corner)).or_default() += 1;
        }
    }
    for face in faces {
        for corner in 0..face.rim.len() {
            face.rim[corner] = owners.get(&edge(face, corner)) == Some(&1);
        }
    }
}

/// The straight parts of a face.
fn tiles((number, face): (usize, &Face)) -> Vec<Tile> {
    let cut = |locals: &[[f64; 2]]| -> Option<Tile> {
        let at: Vec<[f64; 3]> = locals.iter().map(|&[a, b]| [a, b, 0.0]).collect();
        let x: Vec<_> = at.iter().map(|&at| face.position(at)).collect();
        let normal = match x[..] {
            [a, b] => (b - a).cross(&Vector3::z()),
            [a, b, c] => (b - a).cross(&(c - a)),
            _ => return None,
        };
        let normal = normal.try_normalize(0.0)? * face.sign;
        Some(Tile {
            face: number,
            at,
            x,
            normal,
        })
    };
    let parts = parts(face.reference, face.reference.corners() < face.nodes.len());
    parts.iter().filter_map(|part| cut(part)).collect()
}

/// Corners of the tiles on the reference facet: one or two of a linear one, else four or eight.
fn parts(reference: FacetReference, quadratic: bool) -> Vec<Vec<[f64; 2]>> {
    let halves: &[f64] = if quadratic { &[0.0, 0.5] } else { &[0.0] };
    let step = 1.0 / halves.len() as f64;
    match (reference.corners(), reference.is_simplex()) {
        (2, _) => {
            let count = if quadratic { 4 } else { 1 };
            let at = |k: usize| [2.0 * k as f64 / count as f64 - 1.0, 0.0];
            (0..count).map(|k| vec![at(k), at(k + 1)]).collect()
        }
        (_, true) if quadratic => {
            let (a, b, c) = ([0.0, 0.0], [1.0, 0.0], [0.0, 1.0]);
            let (ab, bc, ca) = ([0.5, 0.0], [0.5, 0.5], [0.0, 0.5]);
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
                .map(Vec::from)
                .into()
        }
        (_, true) => vec![vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]],
        _ => {
            let corners = halves
                .iter()
                .flat_map(|&x| halves.iter().map(move |&y| [x, y]));
            let on = |[x, y]: [f64; 2]| [2.0 * x - 1.0, 2.0 * y - 1.0];
            corners
                .flat_map(|[x, y]| {
                    let (right, up) = (x + step, y + step);
                    let [a, b, c, d] = [[x, y], [right, y], [right, up], [x, up]].map(on);
                    [vec![a, b, c], vec![a, c, d]]
                })
                .collect()
        }
    }
}

/// How far smooth surfaces may stand off the faces: size · turn / 8, the turn being the largest
/// between tiles of the face and those of faces around it that no edge of the body parts from it.
fn measure_turns(faces: &mut [Face], of_node: &HashMap<usize, Vec<usize>>, tiles: &[Tile]) {
    let mut normals: Vec<Vec<Vector3<f64>>> = vec![Vec::new(); faces.len()];
    for tile in tiles {
        normals[tile.face].push(tile.normal);
    }
    for (number, face) in faces.iter_mut().enumerate() {
        let around = face.nodes.iter().flat_map(|node| &of_node[node]);
        let others = around.flat_map(|&other| &normals[other]);
        let turns = others.flat_map(|other| {
            let own = normals[number].iter();
            own.map(move |own| own.cross(other).norm().atan2(own.dot(other)))
        });
        let turn = turns.filter(|turn| *turn < CORNER).fold(0.0, f64::max);
        face.sagitta = face.size * turn / 8.0;
    }
}
