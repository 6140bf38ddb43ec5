//! The numbers of a page, decoded and held against closed forms.

use std::fs;
use std::path::Path;

use dpana::report::Page;
use dpana::scene::SceneSupport;
use dpana::{Scene, solve};
use serde_json::{Value, json};

use crate::program::{dpana, folder};
use crate::samples::{block, elements, integers, page_of, reals, strip};

fn near(found: &[f32], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        let off = (f64::from(*found) - expected).abs();
        assert!(
            off < 1e-6 * expected.abs().max(1.0),
            "{found} for {expected}"
        );
    }
}

#[test]
fn a_plane_strip_is_in_the_page_as_it_was_solved() {
    let path = page_of(&strip(), &folder("page_strip"));
    let (scene, states) = (elements(&path, "scene"), elements(&path, "state"));
    let (scene, state) = (&scene[0], &states[0]);
    assert_eq!(scene["title"], "a < b </script>");
    assert_eq!(
        (&scene["symbols"]["length"], &scene["symbols"]["stress"]),
        (&"mm".into(), &"MPa".into())
    );
    // Six nodes about the middle at (1, 1/2); two cells of two triangles; seven edges, six of them outside.
    let body = &scene["bodies"][0];
    assert_eq!(scene["origin"], serde_json::json!([1.0, 0.5, 0.0]));
    let node = integers(&body["nodes"]);
    let positions = reals(&body["positions"]);
    for (at, node) in node.iter().enumerate() {
        let (x, y) = (f64::from(node % 3), f64::from(node / 3));
        near(&positions[3 * at..3 * at + 3], &[x - 1.0, y - 0.5, 0.0]);
    }
    let counts = ["triangles", "lines", "outline"].map(|name| integers(&body[name]).len());
    assert_eq!((node.len(), counts), (6, [12, 14, 12]));

    let (moved, stress) = (
        &state["bodies"][0]["displacement"],
        &state["bodies"][0]["stress"],
    );
    let expected = node
        .iter()
        .flat_map(|node| [0.0, -0.005 * f64::from(node / 3)]);
    near(&reals(moved), &expected.collect::<Vec<_>>());
    near(&reals(stress), &[0.0, -5.0, 0.0, 0.0].repeat(6));

    let contacts = &state["contacts"];
    near(&reals(&contacts["pressure"]), &[5.0; 3]);
    near(&reals(&contacts["gap"]), &[0.0; 3]);
    near(&reals(&contacts["friction"]), &[0.0; 6]);
    assert_eq!(integers(&contacts["state"]), [1; 3]);
    // From the left end on, whatever the order of the contacts.
    let at = reals(&scene["contacts"]["positions"]);
    for (arc, at) in reals(&scene["contacts"]["arc"]).iter().zip(at.chunks(3)) {
        assert!((arc - (at[0] + 1.0)).abs() < 1e-6);
    }
    let said = state["words"][0].as_str().unwrap();
    assert!(said.starts_with("Certified: every law"), "{said}");
    let total = |name: &str| {
        let rows = state["totals"].as_array().unwrap().iter();
        rows.clone().find(|row| row["name"] == name).unwrap()["value"].clone()
    };
    assert_eq!(total("normal force"), "10.0000");
    assert_eq!(total("stick / slip / open"), "0 / 3 / 0");
}

#[test]
fn a_page_loads_nothing_and_what_a_title_holds_ends_nothing() {
    let path = page_of(&strip(), &folder("page_alone"));
    let text = fs::read_to_string(path).unwrap();
    for way_out in [
        "http",
        "src=",
        "href",
        "url(",
        "@import",
        "fetch(",
        "XMLHttp",
        "import(",
        "WebSocket",
    ] {
        assert!(!text.contains(way_out), "{way_out}");
    }
    assert!(text.contains("<title>a &lt; b &lt;/script&gt;</title>"));
    // The viewer's own script, the scene and one state.
    assert_eq!(text.matches("<script").count(), 3);
    assert_eq!(text.matches("</script>").count(), 3);
    for mark in ["{{title}}", "{{style}}", "{{script}}"] {
        assert!(!text.contains(mark));
    }
}

#[test]
fn a_history_appends_its_states_and_a_solid_body_shows_its_skin() {
    let folder = folder("page_block");
    for (kind, points, triangles) in [
        ("hex8", 26, 48),
        ("hex20", 6 * 81 - 12 * 9 + 8, 24 * 32),
        ("tet10", 0, 48 * 16),
    ] {
        fs::write(folder.join("block.json"), block(kind).to_string()).unwrap();
        let done = dpana(&folder, &["solve", "block.json", "--page", "block.html"]);
        assert_eq!(done.status.code(), Some(0));
        let path = folder.join("block.html");
        let (scene, states) = (elements(&path, "scene"), elements(&path, "state"));
        let body = &scene[0]["bodies"][0];
        let positions = reals(&body["positions"]);
        assert_eq!(integers(&body["triangles"]).len(), 3 * triangles, "{kind}");
        // On a closed surface of triangles V = F/2 + 2.
        let points = if points > 0 {
            points
        } else {
            triangles / 2 + 2
        };
        assert_eq!(positions.len(), 3 * points, "{kind}");
        // All on the surface, about the middle (1, 1, 1).
        let far = |at: &[f32]| at.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
        assert!(positions.chunks(3).all(|at| (far(at) - 1.0).abs() < 1e-6));
        assert_eq!(states.len(), 2);
        for (state, part) in states.iter().zip([0.5, 1.0]) {
            // u_z = −p z/E, and σ_zz = −p alone; z is 1 above the middle.
            let heights = positions.chunks(3).map(|at| f64::from(at[2]) + 1.0);
            let expected = heights.flat_map(|z| [0.0, 0.0, -0.005 * part * z]);
            near(
                &reals(&state["bodies"][0]["displacement"]),
                &expected.collect::<Vec<_>>(),
            );
            let expected = [0.0, 0.0, -5.0 * part, 0.0, 0.0, 0.0].repeat(points);
            near(&reals(&state["bodies"][0]["stress"]), &expected);
            let contacts = reals(&state["contacts"]["pressure"]);
            near(&contacts, &[5.0 * part; 9]);
        }
        let steps: Vec<(&Value, &Value)> = states
            .iter()
            .map(|state| (&state["step"], &state["at"]))
            .collect();
        assert_eq!(steps, [(&1.into(), &1.0.into()), (&2.into(), &2.0.into())]);
        // The contact surface lies on the skin: every point of it is a drawn point at z = −1.
        let surface = &scene[0]["surface"];
        for point in integers(&surface["point"]) {
            assert!((positions[3 * point as usize + 2] + 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn a_state_of_other_bodies_is_refused() {
    let path = folder("page_other").join("page.html");
    let mut page = Page::new(&path);
    solve(&strip()).unwrap().add_to_page(&mut page).unwrap();
    let other = Scene::from_json(&block("hex8").to_string(), Path::new(".")).unwrap();
    let refused = solve(&other).unwrap().add_to_page(&mut page);
    assert!(refused.unwrap_err().to_string().contains("block: nodes"));
    assert_eq!(elements(&path, "state").len(), 1);
}

#[test]
fn a_page_that_cannot_be_written_is_refused_before_the_solve() {
    let folder = folder("page_refused");
    fs::write(folder.join("block.json"), block("hex8").to_string()).unwrap();
    for (page, said) in [
        ("-", "--page -: expected a file name"),
        (".", "--page .: is a folder"),
        ("none/page.html", "its folder does not exist"),
        ("block.json", "would overwrite the scene"),
    ] {
        let refused = dpana(&folder, &["solve", "block.json", "--page", page]);
        assert_eq!(refused.status.code(), Some(2));
        let words = String::from_utf8(refused.stderr).unwrap();
        assert!(words.contains(said), "{words}");
    }
    let both = dpana(
        &folder,
        &["solve", "block.json", "--page", "a.html", "--svg", "a.html"],
    );
    assert_eq!(both.status.code(), Some(2));
}

#[test]
fn every_shape_of_an_obstacle_is_drawn() {
    let up = json!([0, 0, 1]);
    let shapes = [
        json!({"cone": {"apex": [1, 1, 0], "axis": up, "half_angle": 85}}),
        json!({"paraboloid": {"apex": [1, 1, 0], "axis": up, "radius": 50}}),
        json!({"punch": {"center": [1, 1, 0], "axis": up, "radius": 5, "edge": 0.5}}),
        json!({"ellipsoid": {"center": [1, 1, -20], "radii": [30, 40, 20]}}),
        json!({"bore": {"center": [1, 1, 60], "axis": [1, 0, 0], "radius": 60}}),
    ];
    for (at, shape) in shapes.into_iter().enumerate() {
        let mut scene = block("hex8");
        // A face that the obstacle is askew to is held nowhere near it.
        scene["bodies"][0]["supports"] = json!([{"group": "top", "displacement": [0, 0, 0]}]);
        scene["bodies"][0]["loads"] = json!([]);
        scene.as_object_mut().unwrap().remove("steps");
        scene["contacts"][0]["obstacle"] = shape.clone();
        let scene = Scene::from_json(&scene.to_string(), "").unwrap();
        let path = page_of(&scene, &folder(&format!("page_shape_{at}")));
        let drawn = &elements(&path, "scene")[0]["pairs"][0]["obstacle"]["rows"];
        assert!(drawn.is_array(), "{shape}");
        let rows = drawn.as_array().unwrap();
        assert!(rows.len() > 1, "{shape}");
        // The apex, or the line it lies on, 1 below the middle of the block.
        let points = rows.iter().flat_map(|row| row.as_array().unwrap());
        let heights = points.map(|point| point[2].as_f64().unwrap());
        let nearest = heights.fold(f64::INFINITY, |least, z| least.min((z + 1.0).abs()));
        assert!(nearest < 1e-5, "{shape} {nearest}");
    }
    let mut flat = strip();
    flat.bodies[0].supports = vec![SceneSupport::of("top", &[Some(0.0); 2])];
    flat.bodies[0].loads.clear();
    flat.contacts[0].obstacle = Some(
        serde_json::from_value(json!({"ellipsoid": {"center": [1, -3], "radii": [9, 3]}})).unwrap(),
    );
    let path = page_of(&flat, &folder("page_shape_flat"));
    let drawn = &elements(&path, "scene")[0]["pairs"][0]["obstacle"]["rows"];
    assert_eq!(drawn.as_array().map(Vec::len), Some(1));
    assert!(drawn[0].as_array().unwrap().len() > 90);
}

#[test]
fn a_rigid_body_turns_about_its_reference_point() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes/tilting_punch.json");
    let scene = Scene::from_file(&file).unwrap();
    let solution = solve(&scene).unwrap();
    let body = &solution.report().unwrap().rigid_bodies[0];
    let turned = body
        .rotation
        .iter()
        .fold(0.0_f64, |most, w| most.max(w.abs()));
    assert!(turned > 0.0);
    let path = page_of(&scene, &folder("page_turned"));
    let (scene, states) = (elements(&path, "scene"), elements(&path, "state"));
    let motion = &states[0]["obstacles"][0];
    let numbers = |value: &serde_json::Value| -> Vec<f64> {
        let numbers = value.as_array().unwrap().iter();
        numbers.map(|number| number.as_f64().unwrap()).collect()
    };
    let dimension = body.displacement.len();
    assert_eq!(
        numbers(&motion["translation"])[..dimension],
        body.displacement[..]
    );
    match dimension {
        2 => assert_eq!(numbers(&motion["rotation"])[2..], body.rotation[..]),
        _ => assert_eq!(numbers(&motion["rotation"]), body.rotation),
    }
    let about = numbers(&motion["about"]).into_iter();
    let about = about.zip(numbers(&scene[0]["origin"])).map(|(x, o)| x + o);
    for (found, stated) in about.zip(&body.reference) {
        assert!((found - stated).abs() < 1e-12, "{found} {stated}");
    }
}
