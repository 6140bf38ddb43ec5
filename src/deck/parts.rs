//! The bodies of a deck: its connected parts, however its sets cut or join them.

use super::material::Materials;
use crate::error::Error;
use crate::mesh_file::abaqus::{Contents, Space};

/// Connected parts, in the order of their first elements.
#[derive(Debug)]
pub(super) struct Parts {
    /// Part of every element.
    pub(super) of_cell: Vec<usize>,
    /// Part of every node; none for a node of no element.
    pub(super) of_node: Vec<Option<usize>>,
    /// What is common to the elements of each.
    pub(super) parts: Vec<Part>,
}

/// A connected part.
#[derive(Debug)]
pub(super) struct Part {
    /// Where its first section is stated.
    pub(super) place: String,
    /// Name of the body.
    pub(super) name: String,
    /// Where its elements live.
    pub(super) space: Space,
    /// Thickness of plane elements.
    pub(super) thickness: f64,
}

impl Part {
    /// What forces of the deck are divided by: results of plane strain are per unit depth.
    pub(super) fn depth(&self) -> f64 {
        match self.space {
            Space::PlaneStrain => self.thickness,
            _ => 1.0,
        }
    }
}

impl Parts {
    /// Finds the parts; elements that share a node are connected.
    pub(super) fn new(contents: &Contents, materials: &Materials) -> Result<Self, Error> {
        let mut root: Vec<usize> = (0..contents.positions.len()).collect();
        for element in &contents.elements {
            for pair in element.nodes.windows(2) {
                let (a, b) = (find(&mut root, pair[0]), find(&mut root, pair[1]));
                root[a.max(b)] = a.min(b);
            }
        }
        let mut found = Self {
            of_cell: Vec::with_capacity(contents.elements.len()),
            of_node: vec![None; contents.positions.len()],
            parts: Vec::new(),
        };
        let mut of_root = vec![None; root.len()];
        for (cell, element) in contents.elements.iter().enumerate() {
            let section = &materials.sections[materials.of_cell[cell]];
            let of_root = &mut of_root[find(&mut root, element.nodes[0])];
            let part = *of_root.get_or_insert_with(|| {
                found.parts.push(Part {
                    place: section.place.clone(),
                    name: section.set.clone(),
                    space: element.kind.space,
                    thickness: section.thickness,
                });
                found.parts.len() - 1
            });
            let of_part = &found.parts[part];
            let plane = element.kind.shape.dimension() == 2;
            if of_part.space != element.kind.space
                || (plane && of_part.thickness != section.thickness)
            {
                return Err(mixed(element.label, &section.place));
            }
            found.of_cell.push(part);
            for &node in &element.nodes {
                found.of_node[node] = Some(part);
            }
        }
        found.check_together()?;
        found.tell_apart();
        Ok(found)
    }

    /// Whether the deck lives in 2D.
    pub(super) fn plane(&self) -> bool {
        let first = self.parts.first();
        first.is_some_and(|part| part.space != Space::Solid)
    }

    /// Forces are per unit depth of plane strain: bodies that press each other share one depth.
    fn check_together(&self) -> Result<(), Error> {
        let Some(first) = self.parts.first() else {
            return Err(Error::Empty {
                place: "elements".to_owned(),
            });
        };
        let (space, thickness) = (first.space, first.depth());
        let solid = |part: &Part| part.space == Space::Solid;
        let ring = |part: &Part| part.space == Space::Axisymmetric;
        let same = |part: &&Part| {
            solid(part) == (space == Space::Solid)
                && ring(part) == (space == Space::Axisymmetric)
                && part.depth() == thickness
        };
        match self.parts.iter().find(|part| !same(part)) {
            None => Ok(()),
            Some(part) => Err(Error::NotAccepted {
                place: part.place.clone(),
                found: format!("{:?} of thickness {}", part.space, part.thickness),
                accepted: format!("{space:?} of thickness {thickness}, as `{}`", first.name),
            }),
        }
    }

    /// Numbers the names of parts that share one.
    fn tell_apart(&mut self) {
        let names: Vec<String> = self.parts.iter().map(|part| part.name.clone()).collect();
        for (at, part) in self.parts.iter_mut().enumerate() {
            if names.iter().filter(|name| **name == part.name).count() > 1 {
                let before = names[..=at].iter().filter(|name| **name == part.name);
                part.name = format!("{}#{}", part.name, before.count());
            }
        }
    }
}

fn mixed(label: u64, place: &str) -> Error {
    Error::NotAccepted {
        place: place.to_owned(),
        found: format!("element {label}, at a node of elements of another model or thickness"),
        accepted: "one model and one thickness in all that hangs together".to_owned(),
    }
}

/// The smallest node that a node hangs together with, as far as is known.
fn find(root: &mut [usize], mut node: usize) -> usize {
    while root[node] != node {
        root[node] = root[root[node]];
        node = root[node];
    }
    node
}
