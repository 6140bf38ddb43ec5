//! Bytes to the readers of mesh files (Gmsh, VTU, Abaqus), and a scene around every mesh that they accept.
#![no_main]

use dpana::body::{Group, Mesh};
use dpana::mesh_file;
use dpana::scene::{
    Scene, SceneBody, SceneContact, SceneLoad, SceneMaterial, SceneModel, SceneObstacle,
    SceneSupport,
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
    let any = |group: Option<&String>| group.cloned().unwrap_or_default();
    let axes = |values: [f64; 3]| values[..dimension].to_vec();
    let up = if dimension == 2 {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let against = choice % 3 == 0;
    let hold = SceneSupport::Group {
        group: any(mesh.groups.keys().last()).into(),
        displacement: axes([0.0, -0.01, -0.01]).into_iter().map(Some).collect(),
    };
    let load = SceneLoad::Pressure {
        pressure: 1.0,
        group: any(facets.last()).into(),
    };
    let obstacle = SceneObstacle::Plane {
        point: axes([0.0; 3]),
        normal: axes(up),
    };
    let mut part = SceneBody::new("part", mesh).with_material(SceneMaterial::new(1000.0, 0.3));
    part.model = (dimension == 2).then_some(SceneModel::PlaneStrain);
    part.supports.extend((choice % 2 == 0).then_some(hold));
    part.loads.push(load);
    let [first, second] = [0, 1].map(|at| any(facets.get(at)));
    let contact = match against {
        true => SceneContact::between(["part", &first], ["part", &second], 0.3),
        false => SceneContact::on(obstacle, &first, 0.3),
    };
    Scene::new(vec![part], vec![contact])
}
