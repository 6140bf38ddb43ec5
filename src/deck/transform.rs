//! Directions of nodes' own, in which supports and forces are stated.
//!
//! ```text
//! R   x' along a, y' in the plane of a and b         C   radial, around and along the line from a to b
//! ```

use std::collections::BTreeMap;

use super::statement::Statement;
use crate::error::Error;
use crate::mesh_file::abaqus::{Contents, Row};

/// Numbers of a row, 0 where they are left out.
pub(super) fn numbers<const COUNT: usize>(row: Row<'_, '_>) -> Result<[f64; COUNT], Error> {
    let mut numbers = [0.0; COUNT];
    for (at, number) in numbers.iter_mut().enumerate() {
        *number = row.number(at, "a coordinate", 0.0)?;
    }
    Ok(numbers)
}

/// The two points of a row, which are apart.
pub(super) fn points(row: Row<'_, '_>) -> Result<[[f64; 3]; 2], Error> {
    let [a, b, c, d, e, f] = numbers(row)?;
    match [a, b, c] == [d, e, f] {
        true => Err(row.error("the two points coincide")),
        false => Ok([[a, b, c], [d, e, f]]),
    }
}

/// Axes, the same at all nodes or turning with them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Axes {
    /// Orthonormal rows.
    Straight([[f64; 3]; 3]),
    /// Around the line from the first point to the second.
    Around([[f64; 3]; 2]),
}

/// The axes of a deck, and the nodes that have some.
#[derive(Debug, Default)]
pub(super) struct Transforms {
    pub(super) axes: Vec<Axes>,
    of_node: BTreeMap<usize, usize>,
}

impl Transforms {
    pub(super) fn new(statement: &Statement<'_, '_>, contents: &Contents) -> Result<Self, Error> {
        let mut found = Self::default();
        let model = statement.model.iter();
        for &(scope, card) in model.filter(|(_, card)| card.name == "TRANSFORM") {
            card.only(&["NSET", "TYPE"])?;
            card.one_of("TYPE", &["R", "C"])?;
            let row = card.row("two points")?;
            let (points, stated) = (points(row)?, contents.nodes.scope(scope));
            let axes = match card.get("TYPE") {
                Some("C") => Some(Axes::Around(points.map(|point| stated.place(point)))),
                _ => straight(points.map(|way| stated.turn(way))).map(Axes::Straight),
            };
            let axes = axes.ok_or_else(|| row.error("two points on one line with the origin"))?;
            for node in contents
                .nodes
                .members(card.head(scope), card.need("NSET")?)?
            {
                found.of_node.insert(node, found.axes.len());
            }
            found.axes.push(axes);
        }
        Ok(found)
    }

    /// Number of the axes that a node has of its own.
    pub(super) fn of(&self, node: usize) -> Option<usize> {
        self.of_node.get(&node).copied()
    }

    /// Direction of an axis of a node, at its position; none on the line that axes turn around.
    pub(super) fn direction(
        &self,
        node: usize,
        position: [f64; 3],
        axis: usize,
    ) -> Option<[f64; 3]> {
        match self.of(node).map(|at| self.axes[at]) {
            None => {
                let mut direction = [0.0; 3];
                direction[axis] = 1.0;
                Some(direction)
            }
            Some(Axes::Straight(rows)) => Some(rows[axis]),
            Some(Axes::Around([a, b])) => {
                let along = unit(minus(b, a))?;
                let arm = minus(position, a);
                let part = dot(arm, along);
                let radial = unit([0, 1, 2].map(|k| arm[k] - part * along[k]))?;
                Some([radial, cross(along, radial), along][axis])
            }
        }
    }
}

fn straight([a, b]: [[f64; 3]; 2]) -> Option<[[f64; 3]; 3]> {
    let first = unit(a)?;
    let third = unit(cross(first, b))?;
    Some([first, cross(third, first), third])
}

pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// None for a vector of length zero.
pub(super) fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = a.iter().fold(0.0_f64, |sum, x| sum.hypot(*x));
    (length > 0.0 && length.is_finite()).then(|| a.map(|x| x / length))
}
