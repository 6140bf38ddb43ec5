//! An element as it is stated, and the cell that it is.

use nalgebra::Vector3;

use super::card::quote;
use super::collapsed::Collapsed;
use super::element::{ElementKind, Space};
use crate::mesh_file::elements::Shape;

/// An element: its nodes in the order of its cell.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    /// Kind.
    pub(crate) kind: ElementKind,
    /// Indices of nodes.
    pub(crate) nodes: Vec<usize>,
    /// Its number in the deck.
    pub(crate) label: u64,
    /// Where nodes of it are one: the cell's face, from 1, that each of its faces is.
    faces: Option<Vec<Option<usize>>>,
}

impl Element {
    /// The element of its own number and those of its nodes, which have these indices.
    pub(super) fn new(
        kind: ElementKind,
        numbers: &[u64],
        nodes: &[usize],
        positions: &[[f64; 3]],
    ) -> Result<Self, String> {
        let (label, plane) = (numbers[0], kind.space != Space::Solid);
        let raised = nodes.iter().map(|&node| positions[node][2]);
        if let Some(z) = raised.into_iter().find(|z| plane && *z != 0.0) {
            return Err(format!(
                "plane element {label} has a node at z = {z}; expected 0"
            ));
        }
        let mut element = Self {
            kind,
            nodes: kind.cell_nodes(nodes),
            label,
            faces: None,
        };
        let repeated = (1..nodes.len()).find(|&at| nodes[..at].contains(&nodes[at]));
        if let Some(at) = repeated {
            let refusal = || {
                format!(
                    "element {label} has node {} twice; expected different nodes, or those of a linear element folded \
                     up to a triangle, wedge, pyramid or tetrahedron",
                    numbers[1 + at]
                )
            };
            let cell = Collapsed::new(kind, nodes).ok_or_else(refusal)?;
            (element.kind, element.nodes) = (cell.kind, cell.nodes);
            element.faces = Some(cell.faces);
        }
        match (element.volume(positions) < 0.0, plane) {
            (false, _) => Ok(element),
            (true, true) => Err(format!(
                "element {label} runs clockwise; expected its corners counterclockwise"
            )),
            (true, false) => Err(format!(
                "element {label} is inside out; expected the corners of its first face counterclockwise as seen from \
                 the others"
            )),
        }
    }

    /// Signed volume of a solid, area of a plane element; 0 of all that only describes geometry.
    fn volume(&self, positions: &[[f64; 3]]) -> f64 {
        let Shape::Cell(cell) = self.kind.shape else {
            return 0.0;
        };
        let solid = self.kind.space == Space::Solid;
        if solid != (cell.dimension() == 3) {
            return 0.0;
        }
        let nodes = self.nodes.iter().map(|&node| positions[node].into());
        let nodes: Vec<Vector3<f64>> = nodes.collect();
        let points = cell.reference().rule.iter().map(|point| {
            let [a, b, c] = point.tangents(cell.dimension(), &nodes);
            point.weight * a.dot(&b.cross(&c))
        });
        points.sum()
    }

    /// The cell's face behind a label such as `S2`.
    pub(super) fn stated_face(&self, label: &str, letter: char) -> Result<usize, String> {
        let number: Option<usize> = label.strip_prefix(letter).and_then(|n| n.parse().ok());
        let count = self.faces.as_ref().map_or(self.kind.faces(), Vec::len);
        let Some(number) = number.filter(|number| (1..=count).contains(number)) else {
            return Err(format!(
                "`{}` is no face of element {}; expected {letter}1 to {letter}{count}",
                quote(label),
                self.label,
            ));
        };
        let face = match &self.faces {
            None => Some(number),
            Some(faces) => faces[number - 1],
        };
        face.ok_or_else(|| {
            format!(
                "face {letter}{number} of element {} is folded up, for nodes of it are one; expected a face with an area",
                self.label
            )
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn collapsed_elements_keep_their_side_and_their_volume() {
        // Of the unit cube, corners as in Abaqus: half of it, a third, a sixth.
        let corner = |at: usize| [[0, 0], [1, 0], [1, 1], [0, 1]][at % 4].map(f64::from);
        let cube = (0..8).map(|at| [corner(at)[0], corner(at)[1], (at / 4) as f64]);
        let positions: Vec<[f64; 3]> = cube.collect();
        let element = |name: &str, numbers: &[u64]| {
            let nodes: Vec<usize> = numbers.iter().map(|n| *n as usize - 1).collect();
            let kind = ElementKind::new(name).unwrap();
            Element::new(kind, &[&[77], numbers].concat(), &nodes, &positions)
        };
        for (name, nodes, volume) in [
            ("C3D8", &[1, 2, 3, 4, 5, 6, 7, 8][..], 1.0),
            ("C3D8", &[1, 2, 3, 3, 5, 6, 7, 7], 0.5),
            ("C3D8", &[1, 5, 6, 2, 4, 4, 3, 3], 0.5),
            ("C3D8I", &[1, 2, 3, 4, 5, 5, 5, 5], 1.0 / 3.0),
            ("C3D8R", &[1, 2, 3, 3, 5, 5, 5, 5], 1.0 / 6.0),
            ("C3D6", &[1, 2, 3, 5, 5, 5], 1.0 / 6.0),
        ] {
            let found = element(name, nodes).unwrap().volume(&positions);
            assert!((found - volume).abs() < 1e-12, "{nodes:?}: {found}");
        }
        let said = element("C3D8", &[5, 6, 7, 8, 1, 2, 3, 4]).unwrap_err();
        assert!(said.contains("element 77 is inside out"), "{said}");
        let said = element("C3D8", &[1, 2, 3, 3, 5, 6, 7, 8]).unwrap_err();
        assert!(said.contains("element 77 has node 3 twice"), "{said}");
    }
}
