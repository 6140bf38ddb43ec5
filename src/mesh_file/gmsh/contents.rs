//! What a .msh file says, before it becomes a mesh.

use std::collections::{BTreeMap, HashMap};

use super::fields::quote;
use super::lines::Lines;
use crate::body::CellKind;
use crate::error::Error;

/// Most nodes of an element.
pub(super) const MOST_NODES: usize = 27;

/// Shape of an element that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    /// One node.
    Point,
    /// Two nodes, or three.
    Line,
    /// A cell of a plane mesh, a facet of a solid one, or a solid cell.
    Cell(CellKind),
}

impl Shape {
    /// Shape and its number of nodes, from Gmsh's number of the element type.
    pub(super) fn from_type(number: u32) -> Result<(Self, usize), String> {
        let kind = match number {
            15 => return Ok((Self::Point, 1)),
            1 => return Ok((Self::Line, 2)),
            8 => return Ok((Self::Line, 3)),
            2 => CellKind::Tri3,
            3 => CellKind::Quad4,
            4 => CellKind::Tet4,
            5 => CellKind::Hex8,
            9 => CellKind::Tri6,
            10 => CellKind::Quad9,
            11 => CellKind::Tet10,
            12 => CellKind::Hex27,
            16 => CellKind::Quad8,
            17 => CellKind::Hex20,
            6 => CellKind::Prism6,
            7 => CellKind::Pyramid5,
            18 => CellKind::Prism15,
            19 => CellKind::Pyramid13,
            _ => {
                let name = match number {
                    13 => "prism of 18 nodes; `Mesh.SecondOrderIncomplete = 1;` makes 15 of them",
                    14 => "pyramid of 14 nodes; `Mesh.SecondOrderIncomplete = 1;` makes 13 of them",
                    _ => "of another shape or order",
                };
                return Err(format!(
                    "element type {number} ({name}) is not read; expected points (15), lines \
                     (1, 8), triangles (2, 9), quadrilaterals (3, 10, 16), tetrahedra (4, 11), \
                     hexahedra (5, 12, 17), prisms (6, 18) or pyramids (7, 19)"
                ));
            }
        };
        Ok((Self::Cell(kind), kind.node_count()))
    }

    /// Dimension of the shape, 0 to 3.
    pub(super) fn dimension(self) -> u8 {
        match self {
            Self::Point => 0,
            Self::Line => 1,
            Self::Cell(kind) if kind.dimension() == 2 => 2,
            Self::Cell(_) => 3,
        }
    }
}

/// One element with its nodes as indices into [`Nodes`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    /// Place in the file, for messages.
    pub(super) place: usize,
    /// Shape.
    pub(super) shape: Shape,
    /// Geometric entity (4.1) or physical group (2.2); with the shape's dimension it is a
    /// key of [`Contents::groups_of_entity`].
    pub(super) entity: i32,
    /// Number of nodes in use below.
    pub(super) count: usize,
    /// Nodes, unused ones `u32::MAX`.
    pub(super) slots: [u32; MOST_NODES],
}

impl Element {
    /// Indices of the nodes.
    pub(super) fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.slots[..self.count].iter().map(|&node| node as usize)
    }
}

/// The nodes in increasing order of their tags.
#[derive(Debug, Default)]
pub(super) struct Nodes {
    tags: Vec<u64>,
    positions: Vec<[f64; 3]>,
}

impl Nodes {
    /// Sorts nodes by tag and refuses a tag that comes twice.
    pub(super) fn new(mut listed: Vec<(u64, [f64; 3])>, lines: &Lines<'_>) -> Result<Self, Error> {
        if listed.len() >= u32::MAX as usize {
            return Err(lines.error("more nodes than can be numbered"));
        }
        if !listed.is_sorted_by_key(|&(tag, _)| tag) {
            listed.sort_unstable_by_key(|&(tag, _)| tag);
        }
        if let Some(twice) = listed.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(lines.error(format!("node {} is listed twice", twice[0].0)));
        }
        let (tags, positions) = listed.into_iter().unzip();
        Ok(Self { tags, positions })
    }

    /// Tags in increasing order.
    pub(super) fn tags(&self) -> &[u64] {
        &self.tags
    }

    /// Positions in the order of the tags.
    pub(super) fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Index of a tag. Tags mostly run without holes, so the first guess mostly fits.
    fn index(&self, tag: u64) -> Option<u32> {
        let guess = usize::try_from(tag.checked_sub(*self.tags.first()?)?).ok()?;
        let index = if self.tags.get(guess) == Some(&tag) {
            guess
        } else {
            self.tags.binary_search(&tag).ok()?
        };
        u32::try_from(index).ok()
    }
}

/// Everything read from the file.
#[derive(Debug, Default)]
pub(super) struct Contents {
    /// Nodes, once their section was read.
    pub(super) nodes: Option<Nodes>,
    /// Physical names by dimension and number.
    pub(super) names: BTreeMap<(u8, u32), String>,
    /// Physical groups by dimension and entity.
    pub(super) groups_of_entity: HashMap<(u8, i32), Vec<u32>>,
    /// Elements, once their section was read.
    pub(super) elements: Option<Vec<Element>>,
}

impl Contents {
    /// Reads lines such as `2 100 "body"`.
    pub(super) fn read_names(&mut self, lines: &mut Lines<'_>) -> Result<(), Error> {
        let mut head = lines.fields(&"the number of physical names")?;
        let count: usize = head.size("number of physical names")?;
        for at in 0..count {
            let line = lines.line(&format_args!("physical name {} of {count}", at + 1))?;
            let named = line
                .split_once('"')
                .and_then(|(numbers, rest)| Some((numbers, rest.strip_suffix('"')?)));
            let Some((numbers, name)) = named else {
                return Err(lines.error(format!(
                    "expected dimension, number and quoted name, found {}",
                    quote(line)
                )));
            };
            let key: Vec<i32> = numbers
                .split_ascii_whitespace()
                .map_while(|word| word.parse().ok())
                .collect();
            let &[dimension @ 0..=3, number] = &key[..] else {
                return Err(lines.error(format!(
                    "expected a dimension from 0 to 3 and a number, found {}",
                    quote(numbers)
                )));
            };
            let key = (dimension as u8, number.unsigned_abs());
            if self.names.insert(key, name.to_owned()).is_some() {
                return Err(lines.error(format!(
                    "physical group {number} of dimension {dimension} is named twice"
                )));
            }
        }
        Ok(())
    }

    /// Keeps the nodes; a second section is an error.
    pub(super) fn keep_nodes(
        &mut self,
        listed: Vec<(u64, [f64; 3])>,
        lines: &Lines<'_>,
    ) -> Result<(), Error> {
        if self.nodes.is_some() {
            return Err(lines.error("a second section `$Nodes`"));
        }
        self.nodes = Some(Nodes::new(listed, lines)?);
        Ok(())
    }

    /// Keeps the elements; a second section is an error.
    pub(super) fn keep_elements(
        &mut self,
        elements: Vec<Element>,
        lines: &Lines<'_>,
    ) -> Result<(), Error> {
        if self.elements.is_some() {
            return Err(lines.error("a second section `$Elements`"));
        }
        self.elements = Some(elements);
        Ok(())
    }

    /// Index of the node with this tag, which an element on the current line names.
    pub(super) fn node(&self, tag: u64, lines: &Lines<'_>) -> Result<u32, Error> {
        match &self.nodes {
            None => Err(lines.error("`$Elements` comes before `$Nodes`")),
            Some(nodes) => nodes
                .index(tag)
                .ok_or_else(|| lines.error(format!("node {tag} is not listed in `$Nodes`"))),
        }
    }
}
