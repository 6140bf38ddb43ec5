//! From what the deck says to a scene: a body per connected part, groups for all that refers to it.

use std::collections::{BTreeMap, BTreeSet};

use super::cyclic::Repeat;
use super::history::History;
use super::material::Materials;
use super::pair::{Contacts, Pair};
use super::parts::{Part, Parts};
use super::pre_tension::Sections;
use super::rigid::RigidGroups;
use super::statement::Notes;
use super::transform::Transforms;
use crate::body::{Facet, Group, Mesh};
use crate::error::Error;
use crate::mesh_file::abaqus::{Contents, Shape, Side, Space};
use crate::scene::{
    MeshSource, Scene, SceneBody, SceneContact, SceneFormulation, SceneModel, SceneSteps,
    SceneSurface,
};

/// All that a deck says.
pub(super) struct Stock<'a, 'c> {
    pub(super) contents: Contents,
    pub(super) materials: Materials,
    pub(super) parts: Parts,
    pub(super) contacts: Contacts<'a, 'c>,
    pub(super) transforms: Transforms,
    pub(super) rigid: RigidGroups<'a, 'c>,
    pub(super) sections: Sections<'a, 'c>,
    pub(super) repeats: Vec<Repeat>,
    pub(super) history: History,
}

/// A body on the way: its mesh, and the numbers that the deck's nodes and elements have in it.
pub(super) struct Building {
    pub(super) body: SceneBody,
    pub(super) mesh: Mesh,
    /// Of nodes.
    pub(super) node: BTreeMap<usize, usize>,
    /// Of elements.
    pub(super) cell: BTreeMap<usize, usize>,
}

/// Tables of a history, by the place of what they drive.
pub(super) type Tables = BTreeMap<String, Vec<Vec<f64>>>;

/// Gap of a pair that is taken out, over the size of all that the deck holds.
const AWAY: f64 = 10.0;

impl Stock<'_, '_> {
    /// The scene.
    pub(super) fn scene(&self, notes: &mut Notes) -> Result<Scene, Error> {
        let mut bodies: Vec<Building> = (0..self.parts.parts.len())
            .map(|part| self.building(part))
            .collect();
        let mut factors = Tables::new();
        self.add_loads(&mut bodies, &mut factors);
        self.add_rigid_groups(&mut bodies, &mut factors)?;
        self.add_bolts(&mut bodies, &mut factors)?;
        self.add_repeats(&mut bodies);
        let (mut contacts, mut gaps) = (Vec::new(), Tables::new());
        for pair in &self.contacts.pairs {
            let found = self.contacts_of(pair, &mut bodies, notes)?;
            if let Some(rows) = self.gaps(pair) {
                let places = contacts.len()..contacts.len() + found.len();
                gaps.extend(places.map(|at| (format!("contacts[{at}]"), rows.clone())));
            }
            contacts.extend(found);
        }
        if contacts.is_empty() {
            let last = self.contacts.pairs.last();
            let nothing = || Error::Empty {
                place: "contacts".to_owned(),
            };
            return Err(last.map_or_else(nothing, |pair| {
                pair.card
                    .error("*MODEL CHANGE takes all pairs out, in all steps")
            }));
        }
        let steps = self.history.instants.len() > 1 || !factors.is_empty();
        let steps = steps.then(|| SceneSteps {
            at: self.history.instants.clone(),
            factors,
            gaps,
            ..SceneSteps::default()
        });
        let finish = |building: Building| SceneBody {
            mesh: MeshSource::Given(building.mesh),
            ..building.body
        };
        Ok(Scene {
            bodies: bodies.into_iter().map(finish).collect(),
            contacts,
            steps,
            ..Scene::default()
        })
    }

    /// The mesh and the materials of a part.
    fn building(&self, part: usize) -> Building {
        let (contents, of_part) = (&self.contents, &self.parts.parts[part]);
        let (mut node, mut cell) = (BTreeMap::new(), BTreeMap::new());
        let cells = (0..contents.elements.len()).filter(|&at| self.parts.of_cell[at] == part);
        let cells: Vec<usize> = cells.collect();
        let dimension = if of_part.space == Space::Solid { 3 } else { 2 };
        let mut mesh = Mesh::new(dimension, Vec::new());
        for &at in &cells {
            let element = &contents.elements[at];
            let mut local = Vec::with_capacity(element.nodes.len());
            for &of_deck in &element.nodes {
                let next = mesh.nodes.len();
                local.push(*node.entry(of_deck).or_insert(next));
                if node.len() > next {
                    mesh.nodes.push(contents.positions[of_deck]);
                }
            }
            cell.insert(at, mesh.cell_count());
            if let Shape::Cell(kind) = element.kind.shape {
                mesh.push_cell(kind, &local);
            }
        }
        let mut body = SceneBody {
            model: Some(model(of_part)),
            ..SceneBody::new(&of_part.name, Mesh::default())
        };
        if cells.iter().any(|&at| contents.elements[at].kind.bends) {
            body.formulation = SceneFormulation::IncompatibleModes;
        }
        let mut of_section: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for at in &cells {
            let section = self.materials.filling(self.materials.of_cell[*at]);
            of_section.entry(section).or_default().push(cell[at]);
        }
        for (section, cells) in of_section {
            let group = format!("cells of {}", self.materials.name(section));
            mesh.groups.insert(group.clone(), Group::Cells(cells));
            let material = self.materials.in_scene(section, of_part.space);
            body.materials.push(material.of(&group));
        }
        Building {
            body,
            mesh,
            node,
            cell,
        }
    }

    /// A contact for each slave and each master body of a pair that can meet.
    fn contacts_of(
        &self,
        pair: &Pair<'_, '_>,
        bodies: &mut [Building],
        notes: &mut Notes,
    ) -> Result<Vec<SceneContact>, Error> {
        if self
            .history
            .steps
            .iter()
            .all(|step| pair.absent.contains(step))
        {
            notes.add(pair.card, "is taken out in all steps");
            return Ok(Vec::new());
        }
        let law = &self.contacts.laws[pair.interaction];
        let [slaves, masters] = pair.surfaces.each_ref().map(|name| {
            let mut sides: BTreeMap<usize, BTreeSet<Side>> = BTreeMap::new();
            for side in &self.contents.surfaces[name] {
                sides
                    .entry(self.parts.of_cell[side.0])
                    .or_default()
                    .insert(*side);
            }
            sides
        });
        let alone = slaves.len() == 1 && masters.len() == 1;
        let mut contacts = Vec::new();
        for (&slave, own) in &slaves {
            for (&master, other) in &masters {
                if !alone && !self.can_meet(own, other) {
                    continue;
                }
                let cells = own.union(other).map(|side| self.stiffness_and_size(*side));
                let least = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].min(b[1])];
                let [young, size] = cells.reduce(least).unwrap_or([1.0; 2]);
                let [group, against] = &pair.surfaces;
                bodies[slave].add_surface(&self.contents, group, own);
                bodies[master].add_surface(&self.contents, against, other);
                let mut contact = SceneContact {
                    group: group.clone().into(),
                    body: Some(self.parts.parts[slave].name.clone()),
                    against: Some(SceneSurface {
                        body: Some(self.parts.parts[master].name.clone()),
                        group: against.clone().into(),
                    }),
                    ..SceneContact::default()
                };
                law.put_on(&mut contact, young / size, notes)?;
                if self.gaps(pair).is_none() {
                    contact.gap = pair.clearance.map_or(0.0, |(clearance, _)| clearance);
                }
                contacts.push(contact);
            }
        }
        match contacts.is_empty() {
            true => Err(pair.card.error("no slave face stands near a master face")),
            false => Ok(contacts),
        }
    }

    /// Gap at every instant, of a pair that is taken out in some steps.
    fn gaps(&self, pair: &Pair<'_, '_>) -> Option<Vec<Vec<f64>>> {
        let history = &self.history;
        let clearance = pair.clearance.map_or(0.0, |(clearance, _)| clearance);
        let away = AWAY * self.size();
        let gap = |step: &usize| {
            if pair.absent.contains(step) {
                away
            } else {
                clearance
            }
        };
        let rows = history.instants.iter().zip(history.steps.iter().map(gap));
        let rows = rows.map(|(at, gap)| vec![*at, gap]);
        let ever = history.steps.iter().any(|step| pair.absent.contains(step));
        ever.then(|| rows.collect())
    }

    /// Largest extent of all nodes along an axis.
    fn size(&self) -> f64 {
        let along = |axis: usize| {
            let at = self
                .contents
                .positions
                .iter()
                .map(|position| position[axis]);
            let ends = at.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                [low.min(x), high.max(x)]
            });
            ends[1] - ends[0]
        };
        [0, 1, 2].map(along).into_iter().fold(0.0, f64::max)
    }

    /// Whether two sets of faces come closer to each other than the size of the smaller.
    fn can_meet(&self, own: &BTreeSet<Side>, other: &BTreeSet<Side>) -> bool {
        let [a, b] = [own, other].map(|sides| {
            let nodes = sides.iter().flat_map(|&side| self.contents.corners(side));
            let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
            for position in nodes.map(|node| self.contents.positions[node]) {
                for (axis, x) in position.into_iter().enumerate() {
                    bounds[0][axis] = bounds[0][axis].min(x);
                    bounds[1][axis] = bounds[1][axis].max(x);
                }
            }
            bounds
        });
        let size =
            |[low, high]: [[f64; 3]; 2]| (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        let near = size(a).min(size(b));
        (0..3).all(|axis| a[0][axis] <= b[1][axis] + near && b[0][axis] <= a[1][axis] + near)
    }

    /// Young's modulus of the cell at a face, and the longest edge of the face.
    fn stiffness_and_size(&self, side: Side) -> [f64; 2] {
        let elastic = self.materials.of(side.0).elastic.unwrap_or_default();
        [elastic.young(), self.contents.face_size(side)]
    }
}

impl Building {
    /// Adds the group of a surface, once.
    fn add_surface(&mut self, contents: &Contents, name: &str, sides: &BTreeSet<Side>) {
        if !self.mesh.groups.contains_key(name) {
            let facets = sides
                .iter()
                .map(|&side| self.facet(contents, side))
                .collect();
            self.mesh
                .groups
                .insert(name.to_owned(), Group::Facets(facets));
        }
    }

    pub(super) fn facet(&self, contents: &Contents, side: Side) -> Facet {
        let nodes = contents.facet(side);
        Facet {
            nodes: nodes.iter().map(|node| self.node[node]).collect(),
        }
    }
}

fn model(part: &Part) -> SceneModel {
    match part.space {
        Space::Solid => SceneModel::Solid,
        Space::PlaneStrain => SceneModel::PlaneStrain,
        Space::PlaneStress => SceneModel::PlaneStress {
            thickness: part.thickness,
        },
        Space::Axisymmetric => SceneModel::Axisymmetric,
    }
}
