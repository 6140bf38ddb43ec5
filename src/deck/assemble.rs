//! From what the deck says to a scene: a body per connected part, groups for all that refers to it.

use std::collections::{BTreeMap, BTreeSet};

use super::history::History;
use super::interaction::{Contacts, Pair, check_hard};
use super::load::Slot;
use super::material::Materials;
use super::parts::{Part, Parts};
use super::statement::Notes;
use crate::body::{Facet, Group, Mesh};
use crate::error::Error;
use crate::mesh_file::abaqus::{Contents, Shape, Side, Space};
use crate::scene::{
    MeshSource, Scene, SceneBody, SceneContact, SceneLoad, SceneMaterial, SceneModel, SceneSteps,
    SceneSupport, SceneSurface,
};

/// All that a deck says.
pub(super) struct Stock<'a, 'c> {
    pub(super) contents: Contents,
    pub(super) materials: Materials,
    pub(super) parts: Parts,
    pub(super) contacts: Contacts<'a, 'c>,
    pub(super) history: History,
}

/// A body on the way: its mesh, and the numbers that the deck's nodes and elements have in it.
struct Building {
    body: SceneBody,
    mesh: Mesh,
    /// Of nodes.
    node: BTreeMap<usize, usize>,
    /// Of elements.
    cell: BTreeMap<usize, usize>,
}

impl Stock<'_, '_> {
    /// The scene.
    pub(super) fn scene(&self, notes: &mut Notes) -> Result<Scene, Error> {
        let mut bodies: Vec<Building> = (0..self.parts.parts.len())
            .map(|part| self.building(part))
            .collect();
        let mut factors = BTreeMap::new();
        self.add_loads(&mut bodies, &mut factors);
        let mut contacts = Vec::new();
        for pair in &self.contacts.pairs {
            contacts.extend(self.contacts_of(pair, &mut bodies, notes)?);
        }
        let steps = (self.history.instants.len() > 1).then(|| SceneSteps {
            at: self.history.instants.clone(),
            factors,
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
        let mut of_material: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for at in &cells {
            let material = self.materials.sections[self.materials.of_cell[*at]].material;
            of_material.entry(material).or_default().push(cell[at]);
        }
        for (material, cells) in of_material {
            let material = &self.materials.materials[material];
            let [young, poisson] = material.elastic.unwrap_or_default();
            let group = format!("cells of {}", material.name);
            mesh.groups.insert(group.clone(), Group::Cells(cells));
            body.materials
                .push(SceneMaterial::new(young, poisson).of(&group));
        }
        Building {
            body,
            mesh,
            node,
            cell,
        }
    }

    /// Supports and loads: one for all nodes, faces or elements that share a history.
    fn add_loads(&self, bodies: &mut [Building], factors: &mut BTreeMap<String, Vec<Vec<f64>>>) {
        let mut alike: BTreeMap<(usize, [usize; 2], Vec<u64>), Vec<Slot>> = BTreeMap::new();
        for (&slot, values) in &self.history.values {
            let (part, kind) = match slot {
                Slot::Held(node, axis) => (self.parts.of_node[node], [0, axis]),
                Slot::Force(node, axis) => (self.parts.of_node[node], [1, 3 * node + axis]),
                Slot::Pressure((cell, _)) => (Some(self.parts.of_cell[cell]), [2, 0]),
                Slot::Weight(cell, axis) => (Some(self.parts.of_cell[cell]), [3, axis]),
            };
            let bits = values.iter().map(|value| (value + 0.0).to_bits()).collect();
            if let Some(part) = part {
                alike.entry((part, kind, bits)).or_default().push(slot);
            }
        }
        for ((part, kind, bits), slots) in alike {
            let values: Vec<f64> = bits.into_iter().map(f64::from_bits).collect();
            let size = |value: &&f64| value.abs();
            let largest = values.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
            let stated = largest.copied().unwrap_or_default();
            if kind[0] > 0 && stated == 0.0 {
                continue;
            }
            let place = bodies[part].add(&self.contents, &slots, stated);
            if values.iter().any(|value| *value != stated) {
                let rows = self.history.instants.iter().zip(values);
                let rows = rows.map(|(at, value)| vec![*at, value / stated]).collect();
                factors.insert(format!("bodies[{part}].{place}"), rows);
            }
        }
    }

    /// A contact for each slave and each master body of a pair that can meet.
    fn contacts_of(
        &self,
        pair: &Pair<'_, '_>,
        bodies: &mut [Building],
        notes: &mut Notes,
    ) -> Result<Vec<SceneContact>, Error> {
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
                check_hard(law, young / size, notes)?;
                let [group, against] = &pair.surfaces;
                bodies[slave].add_surface(&self.contents, group, own);
                bodies[master].add_surface(&self.contents, against, other);
                contacts.push(SceneContact {
                    group: group.clone().into(),
                    body: Some(self.parts.parts[slave].name.clone()),
                    against: Some(SceneSurface {
                        body: Some(self.parts.parts[master].name.clone()),
                        group: against.clone().into(),
                    }),
                    friction: Some(law.friction),
                    ..SceneContact::default()
                });
            }
        }
        match contacts.is_empty() {
            true => Err(pair.card.error("no slave face stands near a master face")),
            false => Ok(contacts),
        }
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
        let corners = self.contents.corners(side);
        let place = |at: usize| self.contents.positions[corners[at % corners.len()]];
        let edges = (0..corners.len()).map(|at| (place(at), place(at + 1)));
        let edges = edges.map(|(a, b)| (0..3).fold(0.0_f64, |sum, k| sum.hypot(a[k] - b[k])));
        let [young, _] = self.materials.of(side.0).elastic.unwrap_or_default();
        [young, edges.fold(0.0, f64::max)]
    }
}

impl Building {
    /// Adds a support or a load on all slots, which are of one kind, and returns its place in the body.
    fn add(&mut self, contents: &Contents, slots: &[Slot], stated: f64) -> String {
        let dimension = self.mesh.dimension;
        let along = |axis: usize| {
            let mut vector = vec![0.0; dimension];
            vector[axis] = stated;
            vector
        };
        let (supports, loads) = (self.body.supports.len(), self.body.loads.len());
        let (mut nodes, mut facets, mut cells) = (Vec::new(), Vec::new(), Vec::new());
        for slot in slots {
            match *slot {
                Slot::Held(node, _) | Slot::Force(node, _) => nodes.push(self.node[&node]),
                Slot::Pressure(side) => facets.push(self.facet(contents, side)),
                Slot::Weight(cell, _) => cells.push(self.cell[&cell]),
            }
        }
        let load = match slots.first() {
            Some(&Slot::Held(_, axis)) => {
                let group = format!("support {supports}");
                self.mesh.groups.insert(group.clone(), Group::Points(nodes));
                let mut displacement = vec![None; dimension];
                displacement[axis] = Some(stated);
                self.body.supports.push(SceneSupport::Group {
                    group: group.into(),
                    displacement,
                });
                return format!("supports[{supports}]");
            }
            Some(&Slot::Force(_, axis)) => SceneLoad::PointForce {
                point_force: along(axis),
                at: self.mesh.nodes[nodes[0]][..dimension].to_vec(),
            },
            Some(&Slot::Weight(_, axis)) => {
                let group = format!("weight {loads}");
                self.mesh.groups.insert(group.clone(), Group::Cells(cells));
                SceneLoad::BodyForce {
                    body_force: along(axis),
                    group: Some(group.into()),
                }
            }
            _ => {
                let group = format!("pressure {loads}");
                self.mesh
                    .groups
                    .insert(group.clone(), Group::Facets(facets));
                SceneLoad::Pressure {
                    pressure: stated,
                    group: group.into(),
                }
            }
        };
        self.body.loads.push(load);
        format!("loads[{loads}]")
    }

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

    fn facet(&self, contents: &Contents, side: Side) -> Facet {
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
