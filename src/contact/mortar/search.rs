//! Which facets lie over a facet, however far away.
//!
//! A binary tree of boxes, split at the median along the longest side. It is asked for
//! all that the prism over a facet meets, from a given depth behind the facet to any
//! distance before it: about log n boxes are visited per facet that is found.

use super::polygon::Point;
use super::view::View;
use crate::body::{Facet, Mesh};

/// Facets in a leaf.
const LEAF: usize = 4;

/// Boxes around facets.
pub(super) struct Tree {
    boxes: Vec<Branch>,
    /// Facet numbers, those of a leaf side by side.
    facets: Vec<usize>,
}

/// A box and what is in it.
struct Branch {
    bounds: Bounds,
    contents: Contents,
}

enum Contents {
    /// The first half is the next box, the second half is this one.
    Halves(usize),
    /// Positions in the list of facets.
    Leaf(std::ops::Range<usize>),
}

/// Lowest and highest corner of a box, in metre.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
}

impl Bounds {
    const NOTHING: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// The box around the nodes of facets.
    pub(super) fn around<'a>(mesh: &Mesh, facets: impl Iterator<Item = &'a Facet>) -> Self {
        let mut bounds = Self::NOTHING;
        for node in facets.flat_map(|facet| &facet.nodes) {
            let position = mesh.nodes[*node];
            bounds = bounds.with(&Self {
                low: position,
                high: position,
            });
        }
        bounds
    }

    /// The box around points.
    pub(super) fn of(points: &[[f64; 3]]) -> Self {
        let one = |at: &[f64; 3]| Self {
            low: *at,
            high: *at,
        };
        points
            .iter()
            .fold(Self::NOTHING, |bounds, at| bounds.with(&one(at)))
    }

    pub(super) fn contains(&self, point: [f64; 3]) -> bool {
        (0..3).all(|axis| self.low[axis] <= point[axis] && point[axis] <= self.high[axis])
    }

    fn with(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            self.low[axis] = self.low[axis].min(other.low[axis]);
            self.high[axis] = self.high[axis].max(other.high[axis]);
        }
        self
    }

    fn side(&self, axis: usize) -> f64 {
        self.high[axis] - self.low[axis]
    }

    /// Length of the diagonal, in metre.
    pub(super) fn diagonal(&self) -> f64 {
        (0..3).map(|axis| self.side(axis)).fold(0.0, f64::hypot)
    }
}

/// The space over a facet: a rectangle in its plane, from a depth behind it to infinity.
pub(super) struct Prism<'a> {
    view: &'a View,
    /// Least and greatest coordinate along the two axes of the plane.
    sides: [[f64; 2]; 2],
    /// Depth behind the facet, in the plane's unit.
    depth: f64,
}

impl<'a> Prism<'a> {
    /// The prism over a polygon of the plane; `depth` is in metre.
    pub(super) fn new(view: &'a View, polygon: &[Point], depth: f64) -> Self {
        let side = |axis: usize| {
            let along = polygon.iter().map(|corner| corner[axis]);
            let low = along.clone().fold(f64::INFINITY, f64::min);
            [low, along.fold(f64::NEG_INFINITY, f64::max)]
        };
        Self {
            view,
            sides: [side(0), side(1)],
            depth: depth / view.size,
        }
    }

    fn meets(&self, bounds: &Bounds) -> bool {
        let extent = |axis| self.view.extent(bounds.low, bounds.high, axis);
        let beside = |axis: usize| {
            let ([low, high], [left, right]) = (extent(axis), self.sides[axis]);
            low > right || high < left
        };
        !beside(0) && !beside(1) && extent(2)[1] >= -self.depth
    }
}

impl Tree {
    /// A tree of the given facets.
    pub(super) fn new(mesh: &Mesh, facets: &[Facet]) -> Self {
        let bounds = facets
            .iter()
            .map(|facet| Bounds::around(mesh, [facet].into_iter()));
        let bounds: Vec<_> = bounds.collect();
        let mut tree = Self {
            boxes: Vec::with_capacity(facets.len()),
            facets: (0..facets.len()).collect(),
        };
        tree.split(&bounds, 0..facets.len());
        tree
    }

    fn split(&mut self, bounds: &[Bounds], range: std::ops::Range<usize>) {
        let part = &mut self.facets[range.clone()];
        let whole = part
            .iter()
            .fold(Bounds::NOTHING, |all, facet| all.with(&bounds[*facet]));
        let at = self.boxes.len();
        self.boxes.push(Branch {
            bounds: whole,
            contents: Contents::Leaf(range.clone()),
        });
        if range.len() <= LEAF {
            return;
        }
        let longest = |a: &usize, b: &usize| whole.side(*a).total_cmp(&whole.side(*b));
        let axis = (0..3).max_by(longest).unwrap_or_default();
        let middle = |facet: &usize| bounds[*facet].low[axis] + bounds[*facet].high[axis];
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
        self.split(bounds, range.start..range.start + half);
        self.boxes[at].contents = Contents::Halves(self.boxes.len());
        self.split(bounds, range.start + half..range.end);
    }

    /// The facets whose leaf meets the prism, in a fixed order.
    pub(super) fn over(&self, prism: &Prism<'_>) -> Vec<usize> {
        let mut found = Vec::new();
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            let Some(branch) = self.boxes.get(at).filter(|b| prism.meets(&b.bounds)) else {
                continue;
            };
            match &branch.contents {
                Contents::Halves(second) => open.extend([*second, at + 1]),
                Contents::Leaf(range) => found.extend(&self.facets[range.clone()]),
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::body::{CellKind, box_mesh, graded};

    /// All boundary facets of a box, bent so that no two of them are parallel.
    fn bent() -> (Mesh, Vec<Facet>) {
        let along = graded(0.0, 1.0, 9, 3.0).unwrap();
        let mut mesh = box_mesh(&along, &along, &[0.0, 0.1], CellKind::Tet4).unwrap();
        for [x, y, z] in &mut mesh.nodes {
            *z += 0.5 * x.hypot(*y);
        }
        let facets = mesh.boundary_facets();
        (mesh, facets)
    }

    #[test]
    fn the_tree_finds_whatever_stands_over_a_facet() {
        let (mesh, facets) = bent();
        let tree = Tree::new(&mesh, &facets);
        for facet in &facets {
            let view = View::new(&mesh, facet);
            let polygon = view.outline(&mesh, facet).polygon();
            let prism = Prism::new(&view, &polygon, 0.05);
            let mut found = tree.over(&prism);
            assert!(found.len() < facets.len() / 2);
            found.sort_unstable();
            // What only touches the prism may be missed by round-off: look at a slimmer one.
            let slim: Vec<Point> = polygon.iter().map(|corner| corner * (1.0 - 1e-9)).collect();
            let slim = Prism::new(&view, &slim, 0.05);
            for (index, other) in facets.iter().enumerate() {
                let bounds = Bounds::around(&mesh, [other].into_iter());
                assert!(!slim.meets(&bounds) || found.binary_search(&index).is_ok());
            }
        }
    }

    #[test]
    fn only_what_is_too_deep_behind_a_facet_is_left_out() {
        // A triangle that looks up, and others at heights −2, −1 and 1000.
        let at = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
        let mesh = Mesh::new(
            3,
            [0.0, -2.0, -1.0, 1000.0].into_iter().flat_map(at).collect(),
        );
        let facet = |first: usize| Facet {
            nodes: (3 * first..3 * first + 3).collect(),
        };
        let facets: Vec<Facet> = (0..4).map(facet).collect();
        let view = View::new(&mesh, &facets[0]);
        let polygon = view.outline(&mesh, &facets[0]).polygon();
        let prism = Prism::new(&view, &polygon, 1.5);
        let bounds = facets
            .iter()
            .map(|f| Bounds::around(&mesh, [f].into_iter()));
        let met: Vec<bool> = bounds.map(|bounds| prism.meets(&bounds)).collect();
        assert_eq!(met, [true, false, true, true]);
    }
}
