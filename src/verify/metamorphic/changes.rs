//! Changes of a scene, and what each makes of the answer.

use super::stack::Stack;
use crate::body::{Facet, Group, Mesh};
use crate::error::Error;
use crate::random::Random;
use crate::scene::{MeshSource, Scene, SceneContact, SceneLoad, SceneModel, SceneSupport};

/// A vector as it was, and as it has to be.
type Map = Box<dyn Fn([f64; 3]) -> [f64; 3]>;

/// A changed scene, and how its answer follows from the first.
pub(super) struct Changed {
    pub(super) scene: Scene,
    /// Largest difference, relative to the largest displacement or force.
    pub(super) within: f64,
    /// What a displacement becomes; none where meshes differ, and only forces are compared.
    pub(super) displacement: Option<Map>,
    /// What the force on the first side of a pair becomes.
    pub(super) force: Map,
    /// New number of each body.
    pub(super) bodies: Vec<usize>,
    /// New numbers of the nodes of each old body; as they were if there are none.
    pub(super) nodes: Vec<Vec<usize>>,
    /// Pairs that stand for one old pair.
    pub(super) parts: usize,
    /// A few cells may not resolve it, if the judge of the scene says so.
    pub(super) may_be_refused: bool,
}

/// What a mesh of two cells on a side resolves: where the other of two equal sides carries the contacts, where cells
/// are of another kind, and where a surface ends in its middle.
pub(super) const OF_MESH: f64 = 0.3;

/// What sums in another order, or numbers in other units, keep.
const OF_ROUNDING: f64 = 1e-8;

/// Far away, coordinates keep thirteen digits, of which the approach is a thousandth.
const OF_PLACE: f64 = 1e-6;

/// Other units: of length, of force.
const UNITS: [f64; 2] = [1000.0, 7e-4];

/// A part of the load.
const LESS: f64 = 0.25;

/// A change by name; none where it does not apply.
pub(super) type Change = fn(&Stack, Scene, &mut Random) -> Result<Option<Changed>, Error>;

pub(super) const CHANGES: [(&str, Change); 11] = [
    ("sides exchanged", |_, scene, _| Ok(Some(exchanged(scene)))),
    ("far away", |_, scene, random| {
        Ok(Some(far_away(scene, random)))
    }),
    ("turned", |_, scene, random| Ok(turned(scene, random))),
    ("in other units", |_, scene, _| {
        Ok(Some(in_other_units(scene)))
    }),
    ("bodies in another order", |_, scene, _| {
        Ok(Some(reordered(scene)))
    }),
    ("nodes and cells in another order", |_, scene, random| {
        Ok(Some(renumbered(scene, random)))
    }),
    ("loads in two parts", |_, scene, _| {
        Ok(Some(loads_in_parts(scene)))
    }),
    ("whole skins", |_, scene, _| Ok(Some(whole_skins(scene)))),
    ("less load", |stack, scene, _| {
        Ok(stack.proportional.then(|| less_load(scene)))
    }),
    ("surface in two parts", |stack, scene, _| {
        Ok((!stack.is_round()).then(|| surface_in_parts(scene)))
    }),
    ("other cells", |stack, _, _| {
        let other = stack.of_other_cells().map(|stack| stack.scene());
        let other = other.transpose()?;
        Ok(other.map(|scene| Changed::none(scene).of_other_mesh()))
    }),
];

impl Changed {
    /// Nothing has to change.
    fn none(scene: Scene) -> Self {
        Self {
            within: OF_ROUNDING,
            displacement: Some(Box::new(|u| u)),
            force: Box::new(|t| t),
            bodies: (0..scene.bodies.len()).collect(),
            nodes: Vec::new(),
            parts: 1,
            may_be_refused: false,
            scene,
        }
    }

    /// Displacements are those of other nodes.
    fn of_other_mesh(self) -> Self {
        Self {
            within: OF_MESH,
            displacement: None,
            ..self
        }
    }
}

fn meshes(scene: &mut Scene) -> impl Iterator<Item = &mut Mesh> {
    let sources = scene.bodies.iter_mut().map(|body| &mut body.mesh);
    sources.filter_map(|source| match source {
        MeshSource::Given(mesh) => Some(mesh),
        _ => None,
    })
}

fn supports(scene: &mut Scene) -> impl Iterator<Item = &mut Vec<Option<f64>>> {
    let supports = scene.bodies.iter_mut().flat_map(|body| &mut body.supports);
    supports.filter_map(|support| match support {
        SceneSupport::Group { displacement, .. } => Some(displacement),
        _ => None,
    })
}

fn weights(scene: &mut Scene) -> impl Iterator<Item = &mut Vec<f64>> {
    let loads = scene.bodies.iter_mut().flat_map(|body| &mut body.loads);
    loads.filter_map(|load| match load {
        SceneLoad::BodyForce { body_force, .. } => Some(body_force),
        _ => None,
    })
}

fn dimension(scene: &mut Scene) -> usize {
    meshes(scene).next().map_or(2, |mesh| mesh.dimension)
}

fn is_axisymmetric(scene: &Scene) -> bool {
    scene.bodies[0].model == Some(SceneModel::Axisymmetric)
}

/// Moves every node, and maps what has a direction.
fn moved(
    scene: &mut Scene,
    place: impl Fn([f64; 3]) -> [f64; 3],
    turn: impl Fn([f64; 3]) -> [f64; 3],
) {
    let padded = |given: &[f64]| [0, 1, 2].map(|k| given.get(k).copied().unwrap_or(0.0));
    for mesh in meshes(scene) {
        mesh.nodes.iter_mut().for_each(|x| *x = place(*x));
    }
    for displacement in supports(scene) {
        let given: Vec<f64> = displacement.iter().map(|u| u.unwrap_or(0.0)).collect();
        let turned = turn(padded(&given)).map(Some);
        displacement.copy_from_slice(&turned[..given.len()]);
    }
    for weight in weights(scene) {
        let (turned, axes) = (turn(padded(weight)), weight.len());
        weight.copy_from_slice(&turned[..axes]);
    }
}

fn exchanged(mut scene: Scene) -> Changed {
    for contact in &mut scene.contacts {
        if let Some(other) = &mut contact.against {
            std::mem::swap(&mut contact.body, &mut other.body);
            std::mem::swap(&mut contact.group, &mut other.group);
        }
    }
    Changed {
        force: Box::new(|t| t.map(|t| -t)),
        ..Changed::none(scene)
    }
}

fn far_away(mut scene: Scene, random: &mut Random) -> Changed {
    let axes = dimension(&mut scene);
    let mut by = [0.0; 3];
    for by in &mut by[..axes] {
        *by = random.between(-1000.0, 1000.0);
    }
    // What revolves keeps its axis.
    if is_axisymmetric(&scene) {
        by[0] = 0.0;
    }
    moved(&mut scene, |x| [0, 1, 2].map(|k| x[k] + by[k]), |u| u);
    Changed {
        within: OF_PLACE,
        ..Changed::none(scene)
    }
}

fn turned(mut scene: Scene, random: &mut Random) -> Option<Changed> {
    if is_axisymmetric(&scene) {
        return None;
    }
    let (angle, tilt) = (random.between(0.0, 6.0), random.between(0.0, 3.0));
    let solid = dimension(&mut scene) == 3;
    let turn = move |x: [f64; 3]| {
        let x = about(x, [0, 1], angle);
        if solid { about(x, [1, 2], tilt) } else { x }
    };
    moved(&mut scene, turn, turn);
    Some(Changed {
        displacement: Some(Box::new(turn)),
        force: Box::new(turn),
        ..Changed::none(scene)
    })
}

fn about(x: [f64; 3], [first, second]: [usize; 2], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    let mut turned = x;
    turned[first] = cos * x[first] - sin * x[second];
    turned[second] = sin * x[first] + cos * x[second];
    turned
}

fn in_other_units(mut scene: Scene) -> Changed {
    let [length, force] = UNITS;
    let long = move |x: [f64; 3]| x.map(|x| x * length);
    moved(&mut scene, long, long);
    // A force per volume was moved as a length.
    weights(&mut scene)
        .flatten()
        .for_each(|weight| *weight *= force / length.powi(4));
    for body in &mut scene.bodies {
        if let Some(young) = &mut body.materials[0].young {
            *young *= force / (length * length);
        }
        if let Some(SceneModel::PlaneStress { thickness }) = &mut body.model {
            *thickness *= length;
        }
    }
    // In plane strain, forces are those of one unit of depth.
    let depth = match scene.bodies[0].model {
        Some(SceneModel::PlaneStrain) => length,
        _ => 1.0,
    };
    Changed {
        displacement: Some(Box::new(long)),
        force: Box::new(move |t| t.map(|t| t * force / depth)),
        ..Changed::none(scene)
    }
}

fn reordered(mut scene: Scene) -> Changed {
    scene.bodies.reverse();
    let changed = Changed::none(scene);
    Changed {
        bodies: changed.bodies.iter().rev().copied().collect(),
        ..changed
    }
}

fn renumbered(mut scene: Scene, random: &mut Random) -> Changed {
    let mut nodes = Vec::new();
    for mesh in meshes(&mut scene) {
        let order = random.shuffled(mesh.nodes.len());
        let cells = random.shuffled(mesh.cell_count());
        *mesh = in_order(mesh, &order, &cells);
        nodes.push(order);
    }
    Changed {
        nodes,
        ..Changed::none(scene)
    }
}

/// The mesh with new numbers of its nodes, and its cells in another order; the group of all cells stays.
fn in_order(old: &Mesh, order: &[usize], cells: &[usize]) -> Mesh {
    let new = |nodes: &[usize]| -> Vec<usize> { nodes.iter().map(|&node| order[node]).collect() };
    let mut positions = old.nodes.clone();
    for (x, &node) in old.nodes.iter().zip(order) {
        positions[node] = *x;
    }
    let mut mesh = Mesh::new(old.dimension, positions);
    for &cell in cells {
        let cell = old.cell(cell);
        mesh.push_cell(cell.kind, &new(cell.nodes));
    }
    mesh.groups = old.groups.clone();
    for group in mesh.groups.values_mut() {
        if let Group::Facets(facets) = group {
            facets
                .iter_mut()
                .for_each(|facet| facet.nodes = new(&facet.nodes));
        }
    }
    mesh
}

fn loads_in_parts(mut scene: Scene) -> Changed {
    for mesh in meshes(&mut scene) {
        let (count, half) = (mesh.cell_count(), mesh.cell_count() / 2);
        for (name, cells) in [("one", 0..half), ("rest", half..count)] {
            mesh.groups
                .insert(name.to_owned(), Group::Cells(cells.collect()));
        }
    }
    for body in &mut scene.bodies {
        let Some(SceneLoad::BodyForce { body_force, .. }) = body.loads.pop() else {
            continue;
        };
        body.loads = ["one", "rest"]
            .map(|group| SceneLoad::BodyForce {
                body_force: body_force.clone(),
                group: Some(group.into()),
            })
            .into();
    }
    Changed::none(scene)
}

fn whole_skins(mut scene: Scene) -> Changed {
    for mesh in meshes(&mut scene) {
        let facets = mesh.groups.values().filter_map(facets).flatten();
        let skin = Group::Facets(facets.cloned().collect());
        mesh.groups.insert("skin".to_owned(), skin);
    }
    for contact in &mut scene.contacts {
        contact.group = "skin".into();
        if let Some(other) = &mut contact.against {
            other.group = "skin".into();
        }
    }
    Changed::none(scene)
}

fn facets(group: &Group) -> Option<&[Facet]> {
    match group {
        Group::Facets(facets) => Some(facets),
        _ => None,
    }
}

fn less_load(mut scene: Scene) -> Changed {
    let less = |x: [f64; 3]| x.map(|x| LESS * x);
    moved(&mut scene, |x| x, less);
    Changed {
        displacement: Some(Box::new(less)),
        force: Box::new(less),
        ..Changed::none(scene)
    }
}

/// Cuts the first side of every pair in two that are pairs of their own.
fn surface_in_parts(mut scene: Scene) -> Changed {
    for mesh in meshes(&mut scene) {
        let Some(all) = mesh.groups.get("bottom").and_then(facets) else {
            continue;
        };
        let (one, rest) = all.split_at(all.len() / 2);
        let parts = [("bottom, one", one), ("bottom, rest", rest)]
            .map(|(name, part)| (name.to_owned(), Group::Facets(part.to_vec())));
        mesh.groups.extend(parts);
    }
    let parts = |contact: &SceneContact| {
        ["bottom, one", "bottom, rest"].map(|group| SceneContact {
            group: group.into(),
            ..contact.clone()
        })
    };
    scene.contacts = scene.contacts.iter().flat_map(parts).collect();
    Changed {
        parts: 2,
        may_be_refused: true,
        ..Changed::none(scene).of_other_mesh()
    }
}
