//! Bad input is refused with file, place, value and what is accepted.

use dpana::body::{CellKind, Facet, Group, Mesh};
use dpana::scene::{MeshSource, Scene};
use serde_json::{Value, json};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data");

/// The SSNV128 square on its mesh: a scene without a mistake.
fn block() -> Value {
    json!({
        "title": "SSNV128", "units": "m, N, Pa",
        "bodies": [{
            "name": "block",
            "mesh": {"file": "meshes/A_block_n32.msh", "scale": 0.001},
            "model": "plane_strain",
            "materials": [{"group": "body0", "young": 1.3e11, "poisson": 0.2}],
            "supports": [
                {"group": "sym", "displacement": [0, null]},
                {"at": [0.04, 0], "displacement": [null, 0]}
            ],
            "loads": [
                {"pressure": 5e7, "group": "top"},
                {"pressure": 15e7, "group": "left"}
            ]
        }],
        "contacts": [{
            "group": "contact", "friction": 1.0,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
        }]
    })
}

/// A unit cube of 2 × 2 × 2 hexahedra above the plane z = 0.
fn cube() -> Value {
    json!({
        "bodies": [{
            "name": "cube",
            "mesh": {"box": {"x": [0, 1], "y": [0, 1], "z": [0, 1], "cells": [2, 2, 2]}},
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": [0, 0, -0.01]}]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.3,
            "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}
        }]
    })
}

/// What is said about a scene's text.
fn said(text: &str) -> String {
    let file = format!("{FOLDER}/scene.json");
    let scene = Scene::from_json(text, file);
    match scene.and_then(|scene| scene.mechanics()) {
        Ok(_) => "accepted".to_owned(),
        Err(error) => error.to_string(),
    }
}

/// What is said when the value at `pointer` is replaced, or added.
fn said_with(mut scene: Value, pointer: &str, value: Value) -> String {
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    match scene.pointer_mut(parent).unwrap() {
        Value::Object(object) => {
            object.insert(key.to_owned(), value);
        }
        other => other[key.parse::<usize>().unwrap()] = value,
    }
    said(&scene.to_string())
}

/// Each mistake and the words that its message must hold, beside the file's name.
fn check_all(scene: fn() -> Value, mistakes: &[(&str, Value, &[&str])]) {
    for (pointer, value, words) in mistakes {
        let message = said_with(scene(), pointer, value.clone());
        assert!(message.contains("scene.json"), "{pointer}: {message}");
        for word in *words {
            assert!(
                message.contains(word),
                "{pointer}: no `{word}` in {message}"
            );
        }
    }
}

#[test]
fn the_scenes_without_a_mistake_are_accepted() {
    assert_eq!(said(&block().to_string()), "accepted");
    assert_eq!(said(&cube().to_string()), "accepted");
}

#[test]
fn numbers_outside_their_range_are_refused() {
    let material = "/bodies/0/materials/0";
    let at = |field: &str| format!("{material}/{field}");
    let (young, poisson) = (at("young"), at("poisson"));
    check_all(
        block,
        &[
            (
                &young,
                json!(0),
                &["bodies[0].materials[0].young: 0 ", "0 < young"],
            ),
            (
                &young,
                json!(-1e9),
                &["materials[0].young: -1000000000", "0 < young"],
            ),
            (
                &poisson,
                json!(0.5),
                &["materials[0].poisson: 0.5 ", "-1 < poisson < 0.5"],
            ),
            (
                &poisson,
                json!(-1),
                &["materials[0].poisson: -1 ", "-1 < poisson < 0.5"],
            ),
            (
                "/contacts/0/friction",
                json!(-0.1),
                &["contacts[0].friction: -0.1 ", "0 <= friction"],
            ),
            (
                "/bodies/0/model",
                json!({"plane_stress": {"thickness": 0}}),
                &[
                    "bodies[0].model.plane_stress.thickness: 0 ",
                    "0 < thickness",
                ],
            ),
            (
                "/bodies/0/mesh/scale",
                json!(-1),
                &["bodies[0].mesh.scale: -1 ", "0 < scale"],
            ),
            (
                "/settings",
                json!({"tolerance": 0}),
                &["settings.tolerance: 0 ", "1e-15 <= tolerance <= 1e-2"],
            ),
            (
                "/settings",
                json!({"max_sweeps": 0}),
                &["settings.max_sweeps: 0 ", "max_sweeps >= 1"],
            ),
        ],
    );
}

#[test]
fn numbers_that_json_cannot_hold_are_refused_where_they_stand() {
    for (from, to, words) in [
        (
            "130000000000.0",
            "1e999",
            "bodies[0].materials[0].young: number out of range",
        ),
        (
            "130000000000.0",
            "NaN",
            "bodies[0].materials[0].young: expected",
        ),
        (
            "0.001",
            "\"mm\"",
            "bodies[0].mesh.scale: invalid type: string \"mm\", expected a number",
        ),
        (
            "[0,null]",
            "[0,null,1]",
            "supports[0].displacement: expected 2 entries, found 3",
        ),
        (
            "[0,null]",
            "[null,null]",
            "supports[0].displacement: null in every component",
        ),
        (
            "[0,null]",
            "[0,true]",
            "supports[0].displacement[1]: invalid type: boolean `true`",
        ),
    ] {
        let text = block().to_string();
        assert!(text.contains(from), "{text}");
        let message = said(&text.replace(from, to));
        assert!(message.contains("scene.json"), "{message}");
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn a_scene_built_in_code_with_a_nan_is_refused() {
    let scene = Scene::from_json(&cube().to_string(), "").unwrap();
    let mut soft = scene.clone();
    soft.bodies[0].materials[0].young = Some(f64::NAN);
    let message = soft.mechanics().unwrap_err().to_string();
    assert!(
        message.contains("bodies[0].materials[0].young: NaN"),
        "{message}"
    );
    let mut slippery = scene.clone();
    slippery.contacts[0].friction = Some(f64::NAN);
    let message = slippery.mechanics().unwrap_err().to_string();
    assert!(message.contains("contacts[0].friction: NaN"), "{message}");
    let mut loose = scene;
    loose.settings.tolerance = Some(f64::NAN);
    let message = loose.mechanics().unwrap_err().to_string();
    assert!(message.contains("settings.tolerance: NaN"), "{message}");
}

#[test]
fn an_unknown_key_is_refused_with_the_near_one() {
    check_all(
        block,
        &[
            (
                "/bodies/0/materials/0/poison",
                json!(0.2),
                &[
                    "bodies[0].materials[0]",
                    "`poison`",
                    "did you mean `poisson`?",
                    "`young`",
                ],
            ),
            (
                "/contact",
                json!([]),
                &["`contact`", "did you mean `contacts`?"],
            ),
            (
                "/bodies/0/loads/0/presure",
                json!(1),
                &["bodies[0].loads[0]", "did you mean `pressure`?"],
            ),
            (
                "/bodies/0/model",
                json!("plane_strian"),
                &[
                    "bodies[0].model",
                    "unknown choice",
                    "did you mean `plane_strain`?",
                ],
            ),
            (
                "/contacts/0/obstacle",
                json!({"plane": {"point": [0, 0], "normals": [0, 1]}}),
                &["contacts[0].obstacle.plane", "did you mean `normal`?"],
            ),
            (
                "/bodies/0/mesh/path",
                json!("A.msh"),
                &["bodies[0].mesh", "unknown key `path`", "`file`"],
            ),
        ],
    );
}

#[test]
fn keys_that_do_not_go_together_are_refused() {
    check_all(
        block,
        &[
            (
                "/bodies/0/mesh/rectangle",
                json!({"x": [0, 1], "y": [0, 1], "cells": [1, 1]}),
                &["bodies[0].mesh: expected exactly one of `file`"],
            ),
            (
                "/bodies/0/supports/0/at",
                json!([0, 0]),
                &["bodies[0].supports[0]", "exactly one"],
            ),
            (
                "/bodies/0/loads/0",
                json!({"group": "top"}),
                &["bodies[0].loads[0]", "exactly one"],
            ),
            (
                "/bodies/0/loads/0",
                json!({"point_force": [1, 0], "group": "top"}),
                &["bodies[0].loads[0]", "`point_force` with `at`"],
            ),
            (
                "/bodies/0/model",
                json!("plane_stress"),
                &["bodies[0].model", "with its fields"],
            ),
            (
                "/bodies/0/model",
                json!("solid"),
                &[
                    "bodies[0].model: solid",
                    "plane_strain, plane_stress or axisymmetric",
                ],
            ),
            (
                "/bodies/0/model",
                Value::Null,
                &[
                    "bodies[0].model: nothing",
                    "plane_strain, plane_stress or axisymmetric",
                ],
            ),
            (
                "/bodies/0/materials/0",
                json!({"young": 1}),
                &["materials[0]", "`poisson`"],
            ),
        ],
    );
    check_all(
        cube,
        &[(
            "/bodies/0/model",
            json!("plane_strain"),
            &["bodies[0].model", "solid for a mesh"],
        )],
    );
}

#[test]
fn text_that_is_no_json_is_refused_at_its_line() {
    assert!(said("").contains("scene.json:1:0: "));
    assert!(said("{\n\"bodies\": [}").contains("scene.json:2:12: bodies[0]: expected value"));
    assert!(said("{} {}").contains("scene.json:1:2: scene: missing field `bodies`"));
    assert!(said(&format!("{}]", block())).contains("scene: trailing characters"));
    assert!(said(&"[".repeat(100_000)).contains("scene.json:1:"));
}

#[test]
fn a_group_that_is_missing_or_of_the_wrong_dimension_is_refused() {
    check_all(
        block,
        &[
            (
                "/contacts/0/group",
                json!("contcat"),
                &[
                    "contacts[0].group: there is no group `contcat`",
                    "`contact`?",
                    "`sym`",
                ],
            ),
            (
                "/contacts/0/group",
                json!("body0"),
                &["contacts[0].group", "of cells", "facets"],
            ),
            (
                "/bodies/0/materials/0/group",
                json!("top"),
                &[
                    "bodies[0].materials[0].group: group `top`",
                    "a group of cells",
                ],
            ),
            (
                "/bodies/0/loads/1/group",
                json!("body0"),
                &[
                    "bodies[0].loads[1].group: group `body0` of cells",
                    "surface facets",
                ],
            ),
            (
                "/bodies/0/supports/0/group",
                json!("symm"),
                &[
                    "bodies[0].supports[0].group: there is no group `symm`",
                    "`sym`?",
                ],
            ),
            (
                "/contacts/0/body",
                json!("blok"),
                &["contacts[0].body: there is no body", "`block`?"],
            ),
        ],
    );
}

#[test]
fn a_mesh_file_that_is_missing_or_no_mesh_is_refused() {
    let file = "/bodies/0/mesh/file";
    check_all(
        block,
        &[
            (
                file,
                json!("none.msh"),
                &["bodies[0].mesh.file: cannot read", "none.msh"],
            ),
            (
                file,
                json!("meshes"),
                &["bodies[0].mesh.file: cannot read", "not a regular file"],
            ),
            (
                file,
                json!("README.md"),
                &["bodies[0].mesh.file: ", "README.md:1: expected"],
            ),
            (
                file,
                json!("meshes/B2_mindlin_n16.msh"),
                &["bodies[0].materials: no material for cell 512"],
            ),
        ],
    );
}

#[test]
fn a_truncated_mesh_or_text_called_binary_is_refused_at_its_line() {
    let whole = std::fs::read(format!("{FOLDER}/meshes/A_block_n32.msh")).unwrap();
    let read = |bytes: &[u8]| {
        dpana::mesh_file::gmsh::parse(bytes, "A.msh")
            .map(|mesh| mesh.cell_count().to_string())
            .unwrap_or_else(|error| error.to_string())
    };
    assert_eq!(read(&whole), "1024");
    for cut in (0..whole.len() - 1).step_by(97) {
        assert!(read(&whole[..cut]).starts_with("A.msh:"), "{cut}");
    }
    let text = String::from_utf8(whole).unwrap();
    let binary = text.replacen("4.1 0 8", "4.1 1 8", 1);
    let said = "A.msh:3: byte 20: found the bytes [24, 45, 6e, 64]; expected the number 1";
    assert!(read(binary.as_bytes()).starts_with(said));
    let mut odd = binary.into_bytes();
    odd[200] = 0xfe;
    assert!(read(&odd).starts_with(said));
    assert!(read(&[0xfe, 0xff, 0]).starts_with("A.msh:1: byte 0xfe is not text"));
}

#[test]
fn obstacles_without_size_or_direction_are_refused() {
    let obstacle = "/contacts/0/obstacle";
    check_all(
        block,
        &[
            (
                obstacle,
                json!({"plane": {"point": [0, 0], "normal": [0, 0]}}),
                &[
                    "contacts[0].obstacle.plane.normal: [0.0, 0.0]",
                    "any length but zero",
                ],
            ),
            (
                obstacle,
                json!({"plane": {"point": [0, 0, 0], "normal": [0, 1]}}),
                &["contacts[0].obstacle.plane.point: expected 2 entries, found 3"],
            ),
            (
                obstacle,
                json!({"circle": {"center": [0, 0], "radius": 0}}),
                &["contacts[0].obstacle.circle.radius: 0 ", "0 < radius"],
            ),
            (
                obstacle,
                json!({"sphere": {"center": [0, 0], "radius": 1}}),
                &["contacts[0].obstacle: a sphere", "plane, circle, bore"],
            ),
        ],
    );
    check_all(
        cube,
        &[
            (
                obstacle,
                json!({"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 0], "radius": 1}}),
                &[
                    "contacts[0].obstacle.cylinder.axis: [0.0, 0.0, 0.0]",
                    "any length",
                ],
            ),
            (
                obstacle,
                json!({"sphere": {"center": [0, 0, 0], "radius": -2}}),
                &["contacts[0].obstacle.sphere.radius: -2 ", "0 < radius"],
            ),
            (
                obstacle,
                json!({"circle": {"center": [0, 0], "radius": 1}}),
                &["contacts[0].obstacle: a circle", "plane, cylinder, sphere"],
            ),
        ],
    );
}

#[test]
fn a_position_without_a_node_names_the_nearest_one() {
    // The nodes stand every 1.25 mm: the nearest one to (40 mm, 0.25 mm) is the corner.
    check_all(
        block,
        &[(
            "/bodies/0/supports/1/at",
            json!([0.04, 0.00025]),
            &[
                "bodies[0].supports[1].at: no node",
                "[0.04, 0.0, 0.0]",
                "2.5e-4",
                "at most",
            ],
        )],
    );
}

#[test]
fn supports_that_contradict_each_other_are_refused() {
    check_all(
        block,
        &[(
            "/bodies/0/supports/1",
            json!({"at": [0.04, 0], "displacement": [0.001, 0]}),
            &[
                "bodies[0].supports[0]",
                "bodies[0].supports[1]",
                "component x",
            ],
        )],
    );
}

#[test]
fn nothing_to_solve_is_refused() {
    check_all(
        block,
        &[
            (
                "/bodies",
                json!([]),
                &["bodies: empty; expected at least one entry"],
            ),
            ("/contacts", json!([]), &["contacts: empty"]),
            (
                "/bodies/0/materials",
                json!([]),
                &["bodies[0].materials: no material for cell 0"],
            ),
        ],
    );
    let twice = json!([cube()["bodies"][0], cube()["bodies"][0]]);
    let said = said_with(cube(), "/bodies", twice);
    assert!(said.contains("bodies[1].name: `cube` again"), "{said}");
}

#[test]
fn generated_meshes_without_cells_or_beyond_memory_are_refused() {
    let shape = |cells: Value, x: Value, grading: Value| json!({"box": {"x": x, "y": [0, 1], "z": [0, 1], "cells": cells, "grading": grading}});
    let (unit, even) = (json!([0, 1]), json!([1, 1, 1]));
    let mesh = "/bodies/0/mesh";
    let big = json!([u64::MAX, u64::MAX, 2]);
    check_all(
        cube,
        &[
            (
                mesh,
                shape(json!([1000, 1000, 1000]), unit.clone(), even.clone()),
                &[
                    "bodies[0].mesh.box.cells: [1000, 1000, 1000]",
                    "20000000 nodes",
                ],
            ),
            (
                mesh,
                shape(big, unit.clone(), even.clone()),
                &["bodies[0].mesh.box.cells"],
            ),
            (
                mesh,
                shape(json!([0, 1, 1]), unit.clone(), even.clone()),
                &["bodies[0].mesh.box", "axis x", "count: 0 "],
            ),
            (
                mesh,
                shape(json!([1, 1, 1]), json!([1, 0]), even),
                &["bodies[0].mesh.box", "axis x", "end > start"],
            ),
            (
                mesh,
                shape(json!([1, 1, 1]), unit.clone(), json!([1, 1, 0])),
                &["bodies[0].mesh.box", "axis z", "grading: 0 "],
            ),
            (
                mesh,
                shape(json!([1, 1]), unit, json!([1, 1, 1])),
                &["bodies[0].mesh.box.cells", "2"],
            ),
        ],
    );
}

/// One quadrilateral on the unit square, nodes in the given order, as a scene.
fn one_cell(order: [usize; 4]) -> Scene {
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    let mut mesh = Mesh::new(2, corners.to_vec());
    mesh.push_cell(CellKind::Quad4, &order);
    let facet = |nodes: [usize; 2]| Facet {
        nodes: nodes.to_vec(),
    };
    let groups = [
        ("contact", [0, 1]),
        ("top", [2, 3]),
        ("sym", [1, 2]),
        ("left", [3, 0]),
    ];
    for (name, nodes) in groups {
        mesh.groups
            .insert(name.into(), Group::Facets(vec![facet(nodes)]));
    }
    mesh.groups.insert("body0".into(), Group::Cells(vec![0]));
    let mut scene = Scene::from_json(&block().to_string(), "unit.json").unwrap();
    scene.bodies[0].mesh = MeshSource::Given(mesh);
    scene.bodies[0].supports.truncate(1);
    scene
}

fn change_mesh(change: impl FnOnce(&mut Mesh)) -> String {
    let mut scene = one_cell([0, 1, 2, 3]);
    if let MeshSource::Given(mesh) = &mut scene.bodies[0].mesh {
        change(mesh);
    }
    match scene.mechanics() {
        Ok(_) => "accepted".to_owned(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn broken_cells_and_lone_nodes_are_refused() {
    assert!(one_cell([0, 1, 2, 3]).mechanics().is_ok());
    let inverted = one_cell([3, 2, 1, 0]).mechanics().unwrap_err().to_string();
    // The square's area is 1, run backwards −1.
    assert!(inverted.contains("unit.json: block: cell 0"), "{inverted}");
    assert!(inverted.contains("signed volume -1e0"), "{inverted}");
    for (message, words) in [
        (
            change_mesh(|mesh| mesh.nodes[1] = [0.0; 3]),
            "block: cell 0",
        ),
        (
            change_mesh(|mesh| mesh.nodes.push([5.0, 5.0, 0.0])),
            "belongs to no cell",
        ),
        (change_mesh(|mesh| mesh.nodes[2][0] = f64::NAN), "node 2"),
        (
            change_mesh(|mesh| mesh.push_cell(CellKind::Hex8, &[0, 1])),
            "expected 8 entries",
        ),
        (
            change_mesh(|mesh| mesh.push_cell(CellKind::Tri3, &[0, 1, 9])),
            "expected",
        ),
        (change_mesh(|mesh| mesh.dimension = 7), "mesh.dimension: 7 "),
    ] {
        assert!(message.contains(words), "no `{words}` in {message}");
    }
}

#[test]
fn groups_that_do_not_fit_the_mesh_are_refused() {
    let facets = |nodes: &[usize]| {
        let nodes = nodes.to_vec();
        Group::Facets(vec![Facet { nodes }])
    };
    for (name, group, words) in [
        (
            "contact",
            Group::Facets(vec![]),
            "contacts[0].group: group `contact`: empty",
        ),
        (
            "contact",
            facets(&[0, 2]),
            "contacts[0].group: group `contact`",
        ),
        (
            "contact",
            facets(&[0, 77]),
            "contacts[0].group: group `contact`",
        ),
        ("contact", facets(&[]), "contacts[0].group: group `contact`"),
        (
            "contact",
            facets(&[0, 1, 2, 3, 0, 1]),
            "contacts[0].group: group `contact`",
        ),
        ("body0", Group::Cells(vec![4]), "materials[0].group: cell 4"),
        (
            "body0",
            Group::Cells(vec![0, 0]),
            "materials[0].group: cell 0, which has materials[0]",
        ),
        ("sym", Group::Points(vec![9]), "bodies[0].supports[0]"),
    ] {
        let message = change_mesh(|mesh| {
            mesh.groups.insert(name.into(), group);
        });
        assert!(message.contains(words), "{name}: no `{words}` in {message}");
    }
}
