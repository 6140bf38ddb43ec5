//! What a mesh file says, before it becomes a mesh: nodes, elements and the groups they belong to.

use std::collections::{BTreeMap, HashMap};

use crate::body::CellKind;
use crate::error::Error;

/// Where things stand in a file, for messages.
pub(super) trait Places {
    /// An error at a place, or at what was read last.
    fn fault(&self, place: Option<usize>, reason: String) -> Error;

    /// A place as words in a sentence.
    fn name_of(&self, place: usize) -> String;
}

/// Most nodes of an element.
pub(super) const MOST_NODES: usize = 27;

/// Shape of an element that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
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
    pub(crate) fn dimension(self) -> u8 {
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
    pub(super) fn new(
        mut listed: Vec<(u64, [f64; 3])>,
        places: &impl Places,
    ) -> Result<Self, Error> {
        if listed.len() >= u32::MAX as usize {
            return Err(places.fault(None, "more nodes than can be numbered".to_owned()));
        }
        if !listed.is_sorted_by_key(|&(tag, _)| tag) {
            listed.sort_unstable_by_key(|&(tag, _)| tag);
        }
        if let Some(twice) = listed.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(places.fault(None, format!("node {} is listed twice", twice[0].0)));
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
    /// Keeps the nodes; a second section is an error.
    pub(super) fn keep_nodes(
        &mut self,
        listed: Vec<(u64, [f64; 3])>,
        places: &impl Places,
    ) -> Result<(), Error> {
        if self.nodes.is_some() {
            return Err(places.fault(None, "a second section `$Nodes`".to_owned()));
        }
        self.nodes = Some(Nodes::new(listed, places)?);
        Ok(())
    }

    /// Keeps the elements; a second section is an error.
    pub(super) fn keep_elements(
        &mut self,
        elements: Vec<Element>,
        places: &impl Places,
    ) -> Result<(), Error> {
        if self.elements.is_some() {
            return Err(places.fault(None, "a second section `$Elements`".to_owned()));
        }
        self.elements = Some(elements);
        Ok(())
    }

    /// Index of the node with this tag, which an element on the current line names.
    pub(super) fn node(&self, tag: u64, places: &impl Places) -> Result<u32, Error> {
        match &self.nodes {
            None => Err(places.fault(None, "`$Elements` comes before `$Nodes`".to_owned())),
            Some(nodes) => nodes
                .index(tag)
                .ok_or_else(|| places.fault(None, format!("node {tag} is not listed in `$Nodes`"))),
        }
    }
}

/// Elements and the sets they belong to, as formats list them that have neither entities nor numbers of
/// groups.
#[derive(Default)]
pub(super) struct Gathered {
    contents: Contents,
    elements: Vec<Element>,
    set_names: Vec<String>,
    entities: HashMap<(u8, Vec<u32>), i32>,
}

impl Gathered {
    /// The number of a set.
    pub(super) fn set(&mut self, name: &str) -> u32 {
        let known = self.set_names.iter().position(|known| known == name);
        let number = known.unwrap_or_else(|| {
            self.set_names.push(name.to_owned());
            self.set_names.len() - 1
        });
        number as u32
    }

    /// Adds an element of these nodes, in Gmsh's order, to sets.
    pub(super) fn push(&mut self, place: usize, shape: Shape, nodes: &[usize], sets: Vec<u32>) {
        let dimension = shape.dimension();
        let next = self.entities.len() as i32 + 1;
        let key = (dimension, sets);
        let entity = match self.entities.get(&key) {
            Some(known) => *known,
            None => {
                for &set in &key.1 {
                    let name = self.set_names[set as usize].clone();
                    self.contents.names.insert((dimension, set), name);
                }
                let groups = key.1.clone();
                let of_entity = &mut self.contents.groups_of_entity;
                of_entity.insert((dimension, next), groups);
                self.entities.insert(key, next);
                next
            }
        };
        let mut slots = [u32::MAX; MOST_NODES];
        for (slot, &node) in slots.iter_mut().zip(nodes) {
            *slot = node as u32;
        }
        self.elements.push(Element {
            place,
            shape,
            entity,
            count: nodes.len(),
            slots,
        });
    }

    /// All that a file says; single nodes that are on no cell are no part of a body.
    pub(super) fn contents(
        mut self,
        positions: &[[f64; 3]],
        places: &impl Places,
    ) -> Result<Contents, Error> {
        let mut on_cell = vec![false; positions.len()];
        let all = self.elements.iter();
        let dimension = all.map(|element| element.shape.dimension()).max();
        let is_cell = |element: &&Element| Some(element.shape.dimension()) == dimension;
        let cells = self.elements.iter().filter(is_cell);
        cells.for_each(|cell| cell.nodes().for_each(|node| on_cell[node] = true));
        let kept = |element: &Element| {
            element.shape != Shape::Point || element.nodes().all(|node| on_cell[node])
        };
        self.elements.retain(kept);
        let listed = (0..).zip(positions.iter().copied()).collect();
        self.contents.nodes = Some(Nodes::new(listed, places)?);
        self.contents.elements = Some(self.elements);
        Ok(self.contents)
    }
}

/// Places of a file whose elements have no lines of their own.
pub(super) struct Listed<'a> {
    /// Name of the file.
    pub(super) file: &'a str,
    /// Where the elements stand.
    pub(super) line: usize,
    /// What an element is called.
    pub(super) what: &'static str,
}

impl Places for Listed<'_> {
    fn fault(&self, place: Option<usize>, reason: String) -> Error {
        let reason = match place {
            Some(place) => format!("{}: {reason}", self.name_of(place)),
            None => reason,
        };
        Error::Mesh {
            file: self.file.to_owned(),
            line: self.line,
            reason,
        }
    }

    fn name_of(&self, place: usize) -> String {
        format!("{} {place}", self.what)
    }
}
