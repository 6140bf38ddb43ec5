//! Bytes to the readers of mesh files (Gmsh, VTU, Abaqus), and a scene around every mesh that they accept.
#![no_main]

use dpana::body::{Group, Mesh};
use dpana::mesh_file;
use dpana::scene::{
    Scene, SceneBody, SceneContact, SceneLoad, SceneMaterial, SceneModel,
    SceneGroup, SceneObstacle, SceneSupport, SceneSurface,
};
use dpana_fuzz::attempt;
use libfuzzer_sys::fuzz_target;

/// Most nodes of a mesh that a scene is built around.
const NODES: usize = 400;

fuzz_target!(|bytes: &[u8]| {
    let name = match bytes {
        [b'<', ..] => "part.vtu",
        [b'*', ..] => "part.inp",
        _ => "part.msh",
    };
    let include = |file: &str| Err(dpana::Error::Empty { place: file.to_owned() });
    if let Ok(mesh) = mesh_file::parse(bytes, name, &include) {
        if mesh.nodes.len() <= NODES {
            let _ = attempt(scene(mesh, bytes.len()));
        }
    }
});

/// The first group of facets touches a plane or the second, the last group is held.
fn scene(mesh: Mesh, choice: usize) -> Scene {
    let dimension = mesh.dimension;
    let of_facets =
        |(name, group): (&String, &Group)| matches!(group, Group::Facets(_)).then(|| name.clone());
    let facets: Vec<String> = mesh.groups.iter().filter_map(of_facets).collect();
    let any = |group: Option<&String>| SceneGroup::from(group.cloned().unwrap_or_default());
    let axes = |values: [f64; 3]| values[..dimension].to_vec();
    let up = if dimension == 2 {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let against = choice % 3 == 0;
    let hold = SceneSupport::Group {
        group: any(mesh.groups.keys().last()),
        displacement: axes([0.0, -0.01, -0.01]).into_iter().map(Some).collect(),
    };
    let load = SceneLoad::Pressure {
        pressure: 1.0,
        group: any(facets.last()),
    };
    let obstacle = SceneObstacle::Plane {
        point: axes([0.0; 3]),
        normal: axes(up),
    };
    Scene {
        bodies: vec![SceneBody {
            model: (dimension == 2).then_some(SceneModel::PlaneStrain),
            materials: vec![SceneMaterial::new(1000.0, 0.3)],
            supports: if choice % 2 == 0 { vec![hold] } else { vec![] },
            loads: vec![load],
            ..SceneBody::new("part", mesh)
        }],
        contacts: vec![SceneContact {
            group: any(facets.first()),
            body: None,
            obstacle: (!against).then_some(obstacle),
            against: against.then(|| SceneSurface {
                body: None,
                group: any(facets.get(1)),
            }),
            friction: Some(0.3),
            ..SceneContact::default()
        }],
        ..Scene::default()
    }
}
