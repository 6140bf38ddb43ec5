//! A table of values at nodes, from a file.
//!
//! One row per node: its position, one number per axis, then the value, separated by commas or blanks.
//! Empty rows, and what follows a `#`, are not read. Every node that needs a value has a row; rows elsewhere
//! are left alone.

use std::collections::HashMap;
use std::path::Path;

use super::selection::{AT_NODE, norm, size};
use crate::body::Mesh;
use crate::error::Error;

/// The value of every node of a mesh; NaN where `needed` is false and the file has none.
pub(super) fn read(
    place: &str,
    file: &Path,
    mesh: &Mesh,
    needed: &[bool],
) -> Result<Vec<f64>, Error> {
    let bytes = super::read(place, file)?;
    let unreadable = |reason: String| Error::Unreadable {
        place: place.to_owned(),
        file: file.display().to_string(),
        reason,
    };
    let text = String::from_utf8(bytes)
        .map_err(|_| unreadable("not UTF-8 text; expected rows of numbers".to_owned()))?;
    let nodes = Positions::new(mesh);
    let mut values = vec![f64::NAN; mesh.nodes.len()];
    for (number, line) in text.lines().enumerate() {
        let wrong = |what: String| unreadable(format!("line {}: {what}", number + 1));
        let Some(row) = row(line, mesh.dimension).map_err(wrong)? else {
            continue;
        };
        let (value, position) = (row[3], [row[0], row[1], row[2]]);
        for node in nodes.at(position) {
            if values[node].is_finite() && values[node] != value {
                return Err(wrong(format!(
                    "{value} at node {node}, which has {} already; expected one value per node",
                    values[node]
                )));
            }
            values[node] = value;
        }
    }
    let without = (0..values.len()).find(|node| needed[*node] && values[*node].is_nan());
    match without {
        None => Ok(values),
        Some(node) => Err(unreadable(format!(
            "no row for node {node} at {:?}; expected one for every node, within {:.1e} of it",
            &mesh.nodes[node][..mesh.dimension],
            nodes.tolerance
        ))),
    }
}

/// Position in space and value of a row; none if it holds nothing.
fn row(line: &str, dimension: usize) -> Result<Option<[f64; 4]>, String> {
    let line = line.split('#').next().unwrap_or_default();
    let words = line.split(|c: char| c == ',' || c.is_whitespace());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    if words.is_empty() {
        return Ok(None);
    }
    if words.len() != dimension + 1 {
        let found = words.len();
        return Err(format!(
            "{found} entries; expected {}: a position and a value",
            dimension + 1
        ));
    }
    let mut row = [0.0; 4];
    for (at, word) in words.iter().enumerate() {
        let value = word.parse().ok().filter(|value: &f64| value.is_finite());
        let entry = if at == dimension { 3 } else { at };
        row[entry] = value.ok_or_else(|| format!("`{word}`; expected a finite number"))?;
    }
    Ok(Some(row))
}

/// Nodes by their positions.
struct Positions<'a> {
    mesh: &'a Mesh,
    tolerance: f64,
    /// Nodes in each box of a grid, whose boxes are wider than the tolerance.
    boxes: HashMap<[i64; 3], Vec<usize>>,
}

impl<'a> Positions<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        let tolerance = (AT_NODE * size(mesh)).max(f64::MIN_POSITIVE);
        let mut positions = Self {
            mesh,
            tolerance,
            boxes: HashMap::new(),
        };
        for (node, position) in mesh.nodes.iter().enumerate() {
            let key = positions.box_of(*position);
            positions.boxes.entry(key).or_default().push(node);
        }
        positions
    }

    // Far positions share the outermost box, and no node is there.
    fn box_of(&self, position: [f64; 3]) -> [i64; 3] {
        position.map(|x| (x / (2.0 * self.tolerance)).floor() as i64)
    }

    /// All nodes at a position.
    fn at(&self, position: [f64; 3]) -> Vec<usize> {
        let centre = self.box_of(position);
        let mut found = Vec::new();
        for box_number in 0..27 {
            let step = [box_number % 3, box_number / 3 % 3, box_number / 9].map(|k: i64| k - 1);
            let key = [0, 1, 2].map(|axis: usize| centre[axis].saturating_add(step[axis]));
            let near = |node: &&usize| {
                let x = self.mesh.nodes[**node];
                norm([0, 1, 2].map(|axis| x[axis] - position[axis])) <= self.tolerance
            };
            let nodes = self.boxes.get(&key).into_iter().flatten();
            found.extend(nodes.filter(near));
        }
        found
    }
}
