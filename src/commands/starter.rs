//! A first guess of the scene that a mesh is meant for, to be changed by its reader.
//!
//! Groups are given their parts by name and place: what is called like a support is held, what is called
//! like a load is pressed, facets of different parts that lie beside each other may touch.

use std::collections::BTreeSet;
use std::path::Path;

use dpana::body::{Facet, Group, Mesh};
use dpana::scene::{
    MeshSource, Scene, SceneBody, SceneComment, SceneContact, SceneLoad, SceneMaterial, SceneModel,
    SceneObstacle, SceneSupport, SceneSurface,
};

/// Words in the names of groups that are held, and of those that are loaded.
const HELD: [&str; 10] = [
    "fix", "base", "support", "clamp", "held", "ground", "bottom", "floor", "wall", "enc",
];
const LOADED: [&str; 7] = ["load", "force", "press", "push", "pull", "top", "trac"];

/// Farthest that the centres of two facets lie apart to be taken for a contact, relative to their sizes.
const NEAR: f64 = 1.0;

/// How many facets of a surface are looked at for one that looks at another surface.
const LOOKED_AT: usize = 200;

/// A facet: its centre, outward direction of length 1, and size.
struct Piece {
    centre: [f64; 3],
    normal: [f64; 3],
    size: f64,
}

/// A group of facets on the way: where it is and what it is part of.
struct Surface<'a> {
    name: &'a str,
    facets: Vec<Piece>,
    bounds: [[f64; 3]; 2],
    /// Connected parts of the mesh that it belongs to.
    parts: BTreeSet<usize>,
}

/// The scene of one body with this mesh, which `file` holds.
pub(super) fn scene(mesh: &Mesh, name: &str, file: &Path) -> Result<Scene, String> {
    let parts = parts(mesh);
    let surfaces = surfaces(mesh, &parts);
    if surfaces.is_empty() {
        let named: Vec<&str> = mesh.groups.keys().map(String::as_str).collect();
        return Err(format!(
            "the mesh has no group of surface facets (groups: {}); expected one per surface that is held, \
             loaded or in contact (in Gmsh: `Physical Surface(\"base\") = {{1}};` in 3D, `Physical Curve` in \
             2D)",
            if named.is_empty() {
                "none".to_owned()
            } else {
                named.join(", ")
            }
        ));
    }
    let dimension = mesh.dimension;
    let split = split(mesh, &parts);
    let contacts = match &split {
        Some(group) => vec![touching(&format!("{group}.own"), &format!("{group}.other"))],
        None => contacts(mesh, &surfaces),
    };
    let in_contact: BTreeSet<&str> = contacts
        .iter()
        .flat_map(|contact| {
            [
                Some(&contact.group),
                contact.against.as_ref().map(|a| &a.group),
            ]
        })
        .flatten()
        .flat_map(|group| group.iter().map(String::as_str))
        .collect();
    let free: Vec<&Surface<'_>> = (surfaces.iter())
        .filter(|surface| !in_contact.contains(surface.name))
        .collect();
    let held = called(&free, &HELD, None);
    let loaded = called(&free, &LOADED, held);
    let zero = vec![Some(0.0); dimension];
    let source = MeshSource::File {
        file: file.to_owned(),
        scale: 1.0,
        groups: Vec::new(),
        split,
    };
    let mut body = SceneBody::new(name, source);
    body.model = (dimension == 2).then_some(SceneModel::PlaneStrain);
    body.materials = materials(mesh);
    body.supports
        .extend(held.map(|held| SceneSupport::of(held, &zero)));
    body.loads.extend(loaded.map(|loaded| SceneLoad::Pressure {
        pressure: 1.0,
        group: loaded.into(),
    }));
    let mut scene = Scene::new(vec![body], contacts);
    scene.comment = Some(SceneComment::Lines(comment(mesh, &surfaces, &parts)));
    scene.title = name.to_owned();
    scene.units = "mm, N, MPa".to_owned();
    Ok(scene)
}

/// What to look at, and what there is.
fn comment(mesh: &Mesh, surfaces: &[Surface<'_>], parts: &[usize]) -> Vec<String> {
    let count = parts.iter().collect::<BTreeSet<_>>().len();
    let mut lines = vec![
        "A first guess from the names and places of the groups: look at every value below.".to_owned(),
        "materials: young is Young's modulus (210000 MPa is steel); one entry per group of cells.".to_owned(),
        "supports: displacement per axis, null leaves it free. loads: pressure, traction, force, gravity, …"
            .to_owned(),
        "contacts: a group of facets against an obstacle or another group, with friction and maybe a gap."
            .to_owned(),
        "Lengths, forces and stresses are in one system of units; `units` is only shown.".to_owned(),
        format!(
            "The mesh: {}D, {} nodes, {} cells in {count} connected parts.",
            mesh.dimension,
            mesh.nodes.len(),
            mesh.cell_count()
        ),
    ];
    for (name, group) in &mesh.groups {
        lines.push(match group {
            Group::Cells(cells) => format!("group `{name}`: {} cells", cells.len()),
            Group::Edges(edges) => format!("group `{name}`: {} edges", edges.len()),
            Group::Points(points) => format!("group `{name}`: {} points", points.len()),
            Group::Facets(facets) => {
                let found = surfaces.iter().find(|surface| surface.name == name);
                let extent = found.map_or(String::new(), |surface| extent(mesh, surface));
                format!("group `{name}`: {} facets{extent}", facets.len())
            }
        });
    }
    lines
}

fn extent(mesh: &Mesh, surface: &Surface<'_>) -> String {
    let [low, high] = surface.bounds;
    let axes = ["x", "y", "z"].iter().take(mesh.dimension).enumerate();
    let spans = axes.map(|(axis, name)| format!(", {name} {:.4} to {:.4}", low[axis], high[axis]));
    spans.collect()
}

/// The connected part of every node, as the smallest node of the part.
fn parts(mesh: &Mesh) -> Vec<usize> {
    let mut root: Vec<usize> = (0..mesh.nodes.len()).collect();
    let find = |root: &mut Vec<usize>, mut node: usize| {
        while root[node] != node {
            root[node] = root[root[node]];
            node = root[node];
        }
        node
    };
    for cell in mesh_cells(mesh) {
        for pair in cell.windows(2) {
            let (a, b) = (find(&mut root, pair[0]), find(&mut root, pair[1]));
            root[a.max(b)] = a.min(b);
        }
    }
    (0..root.len()).map(|node| find(&mut root, node)).collect()
}

fn mesh_cells(mesh: &Mesh) -> impl Iterator<Item = &[usize]> {
    mesh.cells().map(|cell| cell.nodes)
}

fn surfaces<'a>(mesh: &'a Mesh, parts: &[usize]) -> Vec<Surface<'a>> {
    let surface = |(name, group): (&'a String, &'a Group)| {
        let Group::Facets(facets) = group else {
            return None;
        };
        let nodes = || facets.iter().flat_map(|facet| &facet.nodes);
        nodes().next()?;
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for &node in nodes() {
            for (axis, x) in mesh.nodes[node].into_iter().enumerate() {
                bounds[0][axis] = bounds[0][axis].min(x);
                bounds[1][axis] = bounds[1][axis].max(x);
            }
        }
        // Facets between two cells are no surface, unless the mesh is cut there.
        let facets = mesh.orient(facets).ok()?;
        Some(Surface {
            name,
            facets: facets.iter().map(|facet| piece(mesh, facet)).collect(),
            bounds,
            parts: nodes().map(|&node| parts[node]).collect(),
        })
    };
    mesh.groups.iter().filter_map(surface).collect()
}

/// A group of cells that shares nodes with others in a mesh that hangs together.
fn split(mesh: &Mesh, parts: &[usize]) -> Option<String> {
    let first = parts.first()?;
    if parts.iter().any(|part| part != first) {
        return None;
    }
    let cells = |(name, group): (&String, &Group)| match group {
        Group::Cells(cells) if cells.len() < mesh.cell_count() => Some(name.clone()),
        _ => None,
    };
    let last = mesh.groups.iter().filter_map(cells).next_back();
    last.filter(|group| mesh.clone().split(group).is_ok())
}

/// Contacts between parts that lie beside each other, or else of the lowest surface with a plane.
fn contacts(mesh: &Mesh, surfaces: &[Surface<'_>]) -> Vec<SceneContact> {
    let mut found = Vec::new();
    for (at, own) in surfaces.iter().enumerate() {
        for other in &surfaces[..at] {
            if own.parts.is_disjoint(&other.parts) && beside(own, other) {
                // The finer surface carries the contacts.
                let finer = own.facets.len() >= other.facets.len();
                let (own, other) = if finer { (own, other) } else { (other, own) };
                found.push(touching(own.name, other.name));
            }
        }
    }
    if found.is_empty() {
        let axis = mesh.dimension - 1;
        let low = |surface: &&Surface<'_>| surface.bounds[1][axis];
        let lowest = surfaces.iter().min_by(|a, b| low(a).total_cmp(&low(b)));
        found.extend(lowest.map(|surface| {
            let (mut normal, point) = (vec![0.0; mesh.dimension], surface.bounds[0]);
            normal[axis] = 1.0;
            let plane = SceneObstacle::plane(&point[..mesh.dimension], &normal);
            SceneContact::on(plane, surface.name, 0.2)
        }));
    }
    found
}

fn touching(own: &str, other: &str) -> SceneContact {
    let mut contact = SceneContact::default();
    contact.group = own.into();
    contact.against = Some(SceneSurface {
        body: None,
        group: other.into(),
    });
    contact.friction = Some(0.2);
    contact
}

/// Whether two surfaces may meet: a facet looks at one of the other side that is not farther than they are
/// wide.
fn beside(own: &Surface<'_>, other: &Surface<'_>) -> bool {
    let stride = own.facets.len().div_ceil(LOOKED_AT);
    own.facets.iter().step_by(stride.max(1)).any(|own| {
        other.facets.iter().any(|other| {
            let dot: f64 = own
                .normal
                .iter()
                .zip(other.normal)
                .map(|(a, b)| a * b)
                .sum();
            let apart = length([0, 1, 2].map(|axis| own.centre[axis] - other.centre[axis]));
            dot < -0.5 && apart < NEAR * (own.size + other.size)
        })
    })
}

fn piece(mesh: &Mesh, facet: &Facet) -> Piece {
    let corners = facet.corners(mesh.dimension);
    let at = |corner: usize| mesh.nodes[corners[corner]];
    let minus = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|axis| a[axis] - b[axis]);
    let along = minus(at(1), at(0));
    let normal = match mesh.dimension {
        2 => [along[1], -along[0], 0.0],
        _ => {
            let up = minus(at(corners.len() - 1), at(0));
            [0, 1, 2].map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                along[i] * up[j] - along[j] * up[i]
            })
        }
    };
    let long = length(normal).max(f64::MIN_POSITIVE);
    let count = corners.len() as f64;
    let sum = |axis: usize| {
        (0..corners.len())
            .map(|corner| at(corner)[axis])
            .sum::<f64>()
    };
    Piece {
        centre: [0, 1, 2].map(|axis| sum(axis) / count),
        normal: normal.map(|x| x / long),
        size: length(along),
    }
}

fn length(vector: [f64; 3]) -> f64 {
    vector.iter().fold(0.0, |sum, x| sum.hypot(*x))
}

/// The surface that is called by one of these words, or else the first one that is left.
fn called<'a>(free: &[&Surface<'a>], words: &[&str], taken: Option<&str>) -> Option<&'a str> {
    let left = || free.iter().filter(|surface| Some(surface.name) != taken);
    let named = left().find(|surface| {
        let name = surface.name.to_lowercase();
        words.iter().any(|word| name.contains(word))
    });
    named.or_else(|| left().next()).map(|surface| surface.name)
}

/// Steel, per group of cells where the groups hold every cell once.
fn materials(mesh: &Mesh) -> Vec<SceneMaterial> {
    let steel = SceneMaterial::new(210_000.0, 0.3);
    let mut seen = vec![0_usize; mesh.cell_count()];
    let mut groups = Vec::new();
    for (name, group) in &mesh.groups {
        if let Group::Cells(cells) = group {
            cells.iter().for_each(|&cell| seen[cell] += 1);
            groups.push(name);
        }
    }
    match seen.iter().all(|&count| count == 1) {
        true => groups.iter().map(|name| steel.clone().of(name)).collect(),
        false => vec![steel],
    }
}
