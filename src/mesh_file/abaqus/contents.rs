//! Nodes, elements, sets and surfaces of a deck.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;

use super::card::{Card, Row, bare, quote};
use super::directory::Directory;
use super::element::ElementKind;
use super::instance::Flat;
use super::stated::Element;
use crate::error::Error;

/// An element and the number of its face, from 1.
pub(crate) type Side = (usize, usize);

/// What a deck says of its meshes.
#[derive(Debug)]
pub(crate) struct Contents {
    /// Positions of the nodes.
    pub(crate) positions: Vec<[f64; 3]>,
    /// Numbers and sets of nodes.
    pub(crate) nodes: Directory,
    /// The elements.
    pub(crate) elements: Vec<Element>,
    /// Numbers and sets of elements.
    pub(crate) cells: Directory,
    /// Outer faces of the surfaces, by full name.
    pub(crate) surfaces: BTreeMap<String, BTreeSet<Side>>,
    /// Faces of the sections of bolts, by full name: of one side, inside or outside.
    sections: BTreeMap<String, BTreeSet<Side>>,
}

/// What knows the kind of an element by the name of its type.
pub(crate) type Kinds = fn(&str) -> Result<ElementKind, String>;

/// Keywords that are read here.
pub(crate) const KEYWORDS: [&str; 5] = ["NODE", "ELEMENT", "NSET", "ELSET", "SURFACE"];

impl Contents {
    /// Reads the cards of meshes, wherever they stand among the others; `kind` knows the elements.
    pub(crate) fn new(flat: &Flat<'_, '_>, kind: Kinds) -> Result<Self, Error> {
        let mut contents = Self {
            positions: Vec::new(),
            nodes: Directory::new("node", &flat.scopes),
            elements: Vec::new(),
            cells: Directory::new("element", &flat.scopes),
            surfaces: BTreeMap::new(),
            sections: BTreeMap::new(),
        };
        let of = |name: &'static str| {
            let cards = flat.cards.iter().enumerate();
            cards.filter(move |(_, (_, card))| card.name == name)
        };
        for (_, &(scope, card)) in of("NODE") {
            contents.read_nodes(scope, card)?;
        }
        let mut added = HashMap::new();
        for (at, &(scope, card)) in of("ELEMENT") {
            added.insert(at, contents.read_elements(scope, card, kind)?);
        }
        // Sets are made of sets before them.
        for (at, &(scope, card)) in flat.cards.iter().enumerate() {
            contents.read_sets(scope, card, added.get(&at).cloned().unwrap_or_default())?;
        }
        let across = |(_, (_, card)): (usize, &(usize, &Card<'_>))| card.get("SURFACE").map(bare);
        let sections: BTreeSet<String> = of("PRE-TENSIONSECTION").filter_map(across).collect();
        let mut outer = None;
        for (_, &(scope, card)) in of("SURFACE") {
            let name = card.need("NAME")?;
            let (full, inside) = (
                contents.cells.full(scope, name),
                sections.contains(&bare(name)),
            );
            let outer = outer.get_or_insert_with(|| contents.outer_sides());
            let sides = contents.read_surface(scope, card, (!inside).then_some(outer))?;
            let surfaces = match inside {
                true => &mut contents.sections,
                false => &mut contents.surfaces,
            };
            if surfaces.insert(full, sides).is_some() {
                return Err(card.error("a surface of this name stands before"));
            }
        }
        Ok(contents)
    }

    fn read_nodes(&mut self, scope: usize, card: &Card<'_>) -> Result<(), Error> {
        card.only(&["NSET", "SYSTEM"])?;
        card.one_of("SYSTEM", &["R"])?;
        for row in card.rows(scope) {
            let label = row.label(row.word(0), "number of a node")?;
            let mut position = [0.0; 3];
            for (axis, coordinate) in position.iter_mut().enumerate() {
                *coordinate = row.number(1 + axis, "a coordinate", 0.0)?;
            }
            if row.words().count() > 4 {
                return Err(row.error("one word too many; expected a number and 3 coordinates"));
            }
            let position = self.nodes.scope(scope).place(position);
            match self.nodes.number(scope, label, self.positions.len()) {
                None => self.positions.push(position),
                Some(before) if self.positions[before] == position => {
                    self.nodes.number(scope, label, before);
                }
                Some(_) => return Err(row.error(format!("node {label} is listed twice"))),
            }
        }
        Ok(())
    }

    /// Reads elements, whose rows may go on over several lines; returns which they are.
    fn read_elements(
        &mut self,
        scope: usize,
        card: &Card<'_>,
        kind: Kinds,
    ) -> Result<Range<usize>, Error> {
        card.only(&["TYPE", "ELSET"])?;
        let kind = kind(card.need("TYPE")?).map_err(|reason| card.error(reason))?;
        let (start, count) = (self.elements.len(), 1 + kind.nodes);
        let mut numbers: Vec<u64> = Vec::with_capacity(count);
        let mut rows = card.rows(scope).peekable();
        while let Some(row) = rows.next() {
            for word in row.words() {
                numbers.push(row.label(word, "number of an element or a node")?);
            }
            let last = rows.peek().is_none();
            if numbers.len() > count || (last && numbers.len() < count) {
                let (label, found) = (numbers[0], numbers.len() - 1);
                return Err(row.error(format!(
                    "element {label} has {found} nodes; expected {} of {}",
                    count - 1,
                    card.need("TYPE")?
                )));
            }
            if numbers.len() == count {
                let unknown = |reason: String| row.error(reason);
                let element = self.element(scope, kind, &numbers).map_err(unknown)?;
                self.elements.push(element);
                numbers.clear();
            }
        }
        Ok(start..self.elements.len())
    }

    /// An element of its own number and those of its nodes.
    fn element(
        &mut self,
        scope: usize,
        kind: ElementKind,
        numbers: &[u64],
    ) -> Result<Element, String> {
        let label = numbers[0];
        let node = |&number: &u64| {
            let found = self.nodes.index(scope, number);
            found.ok_or_else(|| format!("element {label}: node {number} is not in the deck"))
        };
        let nodes = numbers[1..]
            .iter()
            .map(node)
            .collect::<Result<Vec<_>, _>>()?;
        match self.cells.number(scope, label, self.elements.len()) {
            None => Element::new(kind, numbers, &nodes, &self.positions),
            Some(_) => Err(format!("element {label} is listed twice")),
        }
    }

    /// What a card adds to sets; `added` are the elements that it stated.
    fn read_sets(
        &mut self,
        scope: usize,
        card: &Card<'_>,
        added: Range<usize>,
    ) -> Result<(), Error> {
        match card.name.as_str() {
            "NODE" => {
                let Some(set) = card.get("NSET") else {
                    return Ok(());
                };
                let mut nodes = Vec::new();
                for row in card.rows(scope) {
                    nodes.extend(self.nodes.members(row, row.word(0))?);
                }
                self.nodes.add(scope, set, nodes);
                Ok(())
            }
            "ELEMENT" => {
                let set = card.get("ELSET").into_iter();
                set.for_each(|set| self.cells.add(scope, set, added.clone()));
                Ok(())
            }
            "NSET" => {
                card.only(&[
                    "NSET", "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED", "ELSET",
                ])?;
                self.nodes.read(scope, card)?;
                let Some(set) = card.get("ELSET") else {
                    return Ok(());
                };
                let cells = self.cells.members(card.head(scope), set)?;
                let nodes = cells
                    .iter()
                    .flat_map(|&cell| self.elements[cell].nodes.clone());
                self.nodes.add(scope, card.need("NSET")?, nodes);
                Ok(())
            }
            "ELSET" => {
                card.only(&["ELSET", "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED"])?;
                self.cells.read(scope, card)
            }
            _ => Ok(()),
        }
    }

    /// The outer faces of a surface by faces, or by nodes; where no outer faces are given, any faces that are named.
    fn read_surface(
        &self,
        scope: usize,
        card: &Card<'_>,
        outer: Option<&BTreeSet<Side>>,
    ) -> Result<BTreeSet<Side>, Error> {
        card.only(&["NAME", "TYPE", "INTERNAL"])?;
        card.one_of("TYPE", &["ELEMENT", "NODE"])?;
        if card.get("TYPE") == Some("NODE") {
            let within =
                || card.error("a section of a bolt by nodes; expected one by faces of elements");
            return self.around_nodes(scope, card, outer.ok_or_else(within)?);
        }
        let mut sides = BTreeSet::new();
        for row in card.rows(scope) {
            let cells = self.cells.members(row, row.word(0))?;
            let face = bare(row.word(1));
            if face.is_empty() {
                let all = cells.iter().flat_map(|&cell| {
                    (1..=self.elements[cell].kind.faces()).map(move |face| (cell, face))
                });
                let whole = || row.error("a section of a bolt by elements; expected their faces");
                let outer = outer.ok_or_else(whole)?;
                sides.extend(all.filter(|side| outer.contains(side)));
                continue;
            }
            for cell in cells {
                let side = match outer {
                    Some(outer) => self.side(cell, &face, 'S', outer),
                    None => self.face(cell, &face, 'S'),
                };
                sides.insert(side.map_err(|e| row.error(e))?);
            }
        }
        Ok(sides)
    }

    /// The surface of a name, its full name first.
    pub(crate) fn surface(
        &self,
        row: Row<'_, '_>,
        name: &str,
    ) -> Result<(&String, &BTreeSet<Side>), Error> {
        self.among(&self.surfaces, row, name)
    }

    /// The faces of a section of a bolt, by its name.
    pub(crate) fn section(&self, row: Row<'_, '_>, name: &str) -> Result<&BTreeSet<Side>, Error> {
        Ok(self.among(&self.sections, row, name)?.1)
    }

    fn among<'s>(
        &self,
        surfaces: &'s BTreeMap<String, BTreeSet<Side>>,
        row: Row<'_, '_>,
        name: &str,
    ) -> Result<(&'s String, &'s BTreeSet<Side>), Error> {
        let name = bare(name);
        let full = self.cells.full(row.scope, &name);
        let found = surfaces.get_key_value(&full);
        match found.or_else(|| surfaces.get_key_value(&name)) {
            Some((_, sides)) if sides.is_empty() => {
                Err(row.error(format!("surface `{name}` has no outer face")))
            }
            Some(surface) => Ok(surface),
            None => Err(row.error(format!("surface `{}` is not known", quote(&name)))),
        }
    }

    /// The face of an element behind a label such as `S2`, which must be an outer one.
    pub(crate) fn side(
        &self,
        cell: usize,
        label: &str,
        letter: char,
        outer: &BTreeSet<Side>,
    ) -> Result<Side, String> {
        let side = self.face(cell, label, letter)?;
        match outer.contains(&side) {
            true => Ok(side),
            false => Err(format!(
                "face {label} of element {} lies between two elements; expected an outer face",
                self.elements[cell].label
            )),
        }
    }

    /// The face of an element behind a label, which may be an inner one.
    fn face(&self, cell: usize, label: &str, letter: char) -> Result<Side, String> {
        let face = self.elements[cell].stated_face(label, letter)?;
        Ok((cell, face))
    }

    /// The outer faces all of whose corners are in a surface by nodes.
    fn around_nodes(
        &self,
        scope: usize,
        card: &Card<'_>,
        outer: &BTreeSet<Side>,
    ) -> Result<BTreeSet<Side>, Error> {
        let mut nodes = BTreeSet::new();
        for row in card.rows(scope) {
            nodes.extend(self.nodes.members(row, row.word(0))?);
        }
        let inside = |side: &&Side| self.corners(**side).iter().all(|node| nodes.contains(node));
        Ok(outer.iter().filter(inside).copied().collect())
    }

    /// Corners of a face.
    pub(crate) fn corners(&self, (cell, face): Side) -> Vec<usize> {
        let element = &self.elements[cell];
        let corners = element.kind.face(face).unwrap_or_default();
        corners.iter().map(|&at| element.nodes[at]).collect()
    }

    /// The longest edge of a face.
    pub(crate) fn face_size(&self, side: Side) -> f64 {
        let corners = self.corners(side);
        let place = |at: usize| self.positions[corners[at % corners.len()]];
        let edges = (0..corners.len()).map(|at| (place(at), place(at + 1)));
        let lengths = edges.map(|(a, b)| (0..3).fold(0.0_f64, |sum, k| sum.hypot(a[k] - b[k])));
        lengths.fold(0.0, f64::max)
    }

    /// Nodes of the cell's facet on a face.
    pub(crate) fn facet(&self, (cell, face): Side) -> Vec<usize> {
        let element = &self.elements[cell];
        let facet = element.kind.facet(face).unwrap_or_default();
        facet.iter().map(|&at| element.nodes[at]).collect()
    }

    /// The faces that belong to one element only.
    pub(crate) fn outer_sides(&self) -> BTreeSet<Side> {
        let mut keyed: Vec<([usize; 4], Side)> = Vec::new();
        for (cell, element) in self.elements.iter().enumerate() {
            for face in 1..=element.kind.faces() {
                let mut key = [usize::MAX; 4];
                let corners = self.corners((cell, face));
                key[..corners.len()].copy_from_slice(&corners);
                key.sort_unstable();
                keyed.push((key, (cell, face)));
            }
        }
        keyed.sort_unstable();
        let alone = keyed
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|same| same.len() == 1);
        alone.map(|same| same[0].1).collect()
    }
}
