//! Input made to break readers and solver: refused before it costs anything, never a panic.
//!
//! Most of it was found by the targets of `tests/fuzz`.

use std::fmt::Write;
use std::time::{Duration, Instant};

use dpana::body::{CellKind, box_mesh, graded};
use dpana::mesh_file::gmsh;
use dpana::problem::{ContactProblem, Floating, Operator};
use dpana::scene::{BareProblem, MeshSource, Scene};
use dpana::{Status, solve};
use faer::{Mat, mat};
use serde_json::{Value, json};

/// Longer than any refusal needs, shorter than anything that grows faster than its input.
const AT_ONCE: Duration = Duration::from_secs(10);

fn refusal<T>(result: Result<T, dpana::Error>) -> String {
    match result {
        Ok(_) => "accepted".to_owned(),
        Err(error) => error.to_string(),
    }
}

fn assert_says(said: &str, words: &[&str]) {
    for word in words {
        assert!(said.contains(word), "`{word}` is not in: {said}");
    }
}

/// Rectangles of these cells, side by side, each on the same line.
fn rectangles(cells: &[[usize; 2]]) -> Value {
    let body = |(at, cells): (usize, &[usize; 2])| {
        json!({
            "name": format!("b{at}"),
            "mesh": {"rectangle": {"x": [at, at + 1], "y": [0, 1], "cells": cells}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": [0, -0.01]}]
        })
    };
    let bodies: Vec<Value> = cells.iter().enumerate().map(body).collect();
    let plane = json!({"plane": {"point": [0, 0], "normal": [0, 1]}});
    let contact = json!({"body": "b0", "group": "bottom", "friction": 0.3, "obstacle": plane});
    json!({"bodies": bodies, "contacts": [contact]})
}

fn mechanics(scene: &Value) -> String {
    let scene = Scene::from_json(&scene.to_string(), "").unwrap();
    refusal(scene.mechanics())
}

#[test]
fn meshes_that_would_fill_the_memory_are_refused_before_they_are_made() {
    let start = Instant::now();
    let most = "at most 20000000 nodes in all bodies together";
    for cells in [[1_000_000_000; 2], [usize::MAX; 2], [1, usize::MAX - 1]] {
        let said = mechanics(&rectangles(&[cells]));
        assert_says(&said, &["bodies[0].mesh.rectangle.cells", most]);
    }
    // 4 nodes, then 20 million less one: too many together.
    let said = mechanics(&rectangles(&[[1, 1], [1, 9_999_999]]));
    assert_says(&said, &["bodies[1].mesh.rectangle.cells", most]);
    assert!(start.elapsed() < AT_ONCE);
}

#[test]
fn deep_nesting_is_refused_where_it_starts_to_matter() {
    let deep = format!("{{\"bodies\": {}", "[".repeat(1_000_000));
    assert_says(
        &refusal(Scene::from_json(&deep, "scene.json")),
        &["scene.json:1:"],
    );
    // An unknown key's value is passed over, however deep.
    let unknown = format!("{{\"bodies\": [{{\"name\": {}", "{\"a\":".repeat(1_000_000));
    assert!(Scene::from_json(&unknown, "scene.json").is_err());
}

#[test]
fn long_names_are_refused_as_fast_as_short_ones() {
    let start = Instant::now();
    let name = "x".repeat(1_000_000);
    let text = SQUARE.replace("1 1 \"bottom\"", &format!("1 1 \"{name}\""));
    let mesh = gmsh::parse(&text, "part.msh").unwrap();
    assert!(mesh.groups.contains_key(&name));
    let mut scene = rectangles(&[[1, 1]]);
    scene["contacts"][0]["group"] = json!(name);
    let said = mechanics(&scene);
    assert_says(&said, &["contacts[0].group: there is no group `xxx"]);
    assert!(!said.contains("did you mean"));
    assert!(start.elapsed() < AT_ONCE);
}

/// One quadrilateral in MSH 2.2, with a group for its lower side and one for itself.
const SQUARE: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
    $PhysicalNames\n2\n1 1 \"bottom\"\n2 9 \"body\"\n$EndPhysicalNames\n\
    $Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n\
    $Elements\n2\n1 1 2 1 1 1 2\n2 3 2 9 1 1 2 3 4\n$EndElements\n";

#[test]
fn counts_in_a_mesh_file_are_believed_only_as_far_as_the_file_goes() {
    let start = Instant::now();
    let most = usize::MAX.to_string();
    for (count, place) in [
        ("$PhysicalNames\n2", "physical name 3 of"),
        ("$Nodes\n4", "node 5 of"),
        ("$Elements\n2", "element 3 of"),
    ] {
        let (section, _) = count.split_once('\n').unwrap();
        let text = SQUARE.replace(count, &format!("{section}\n{most}"));
        assert_says(
            &refusal(gmsh::parse(&text, "part.msh")),
            &["part.msh:", place],
        );
    }
    let tags = SQUARE.replace("2 3 2 9", &format!("2 3 {most} 9"));
    assert_says(
        &refusal(gmsh::parse(&tags, "part.msh")),
        &["part.msh:19", "the line ends"],
    );
    let entities =
        format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n{most} {most} {most} {most}\n");
    assert_says(
        &refusal(gmsh::parse(&entities, "part.msh")),
        &["entity 1 of"],
    );
    let blocks = format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n2 1 0 {most}\n");
    assert_says(
        &refusal(gmsh::parse(&blocks, "part.msh")),
        &["tag of node 1 of"],
    );
    assert!(start.elapsed() < AT_ONCE);
}

/// A fan of triangles round one node: every side but the outer ones starts there.
#[test]
fn a_node_in_every_cell_costs_no_more_than_others() {
    let cells = 30_000;
    let mut text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n1 0 0 0\n",
        cells + 2
    );
    for at in 0..=cells {
        let angle = std::f64::consts::PI * f64::from(at) / f64::from(cells);
        writeln!(text, "{} {} {} 0", at + 2, angle.cos(), angle.sin()).unwrap();
    }
    writeln!(text, "$EndNodes\n$Elements\n{cells}").unwrap();
    for at in 1..=cells {
        writeln!(text, "{at} 2 0 1 {} {}", at + 1, at + 2).unwrap();
    }
    text += "$EndElements\n";
    let mesh = gmsh::parse(&text, "fan.msh").unwrap();
    let start = Instant::now();
    assert_eq!(
        mesh.boundary_facets().len(),
        usize::try_from(cells).unwrap() + 2
    );
    assert!(start.elapsed() < AT_ONCE);
}

/// One contact of two unknowns, G = 1.
fn bare() -> Value {
    json!({
        "name": "one", "source": "by hand", "convention": "as documented",
        "dimension": 2, "contacts": 1,
        "w_rows": [0, 1], "w_cols": [0, 1], "w_values": [1, 1],
        "q": [-1, 0.5], "mu": [0.5]
    })
}

fn bare_with(changes: &[(&str, Value)]) -> String {
    let mut problem = bare();
    for (key, value) in changes {
        problem[*key] = value.clone();
    }
    let problem = BareProblem::from_json(&problem.to_string(), "bare.json").unwrap();
    refusal(problem.to_problem())
}

#[test]
fn counts_of_a_bare_problem_are_checked_before_anything_is_made_of_them() {
    assert_eq!(bare_with(&[]), "accepted");
    let most = "contacts × dimension <= 20000";
    // 2 · 2⁶³ is 0 in 64 bits.
    for contacts in [1_u64 << 63, u64::MAX, 10_001] {
        let empty = json!([]);
        let said = bare_with(&[
            ("contacts", json!(contacts)),
            ("q", empty.clone()),
            ("mu", empty),
        ]);
        assert_says(&said, &["contacts: ", most]);
    }
    assert_says(
        &bare_with(&[("w_rows", json!([0, usize::MAX]))]),
        &["w_rows, w_cols", "not accepted"],
    );
    assert_says(
        &bare_with(&[("dimension", json!(usize::MAX))]),
        &["dimension", "2 or 3"],
    );
}

#[test]
fn operators_that_no_elastic_body_has_are_refused_with_the_size_of_the_violation() {
    let refused = |compliance: Mat<f64>| refusal(Operator::from_compliance(compliance));
    assert_says(
        &refused(mat![[1.0, 0.5], [0.25, 1.0]]),
        &[
            "operator[1][0] differs from operator[0][1] by 2.5e-1",
            "symmetric",
        ],
    );
    // Eigenvalues −1 and 3.
    assert_says(
        &refused(mat![[1.0, 2.0], [2.0, 1.0]]),
        &[
            "operator: smallest eigenvalue -",
            "largest entry 2e0",
            "semi-definite",
        ],
    );
    assert_says(
        &refused(mat![[0.0, 1.0], [1.0, 0.0]]),
        &["smallest eigenvalue -"],
    );
    assert_says(
        &refused(mat![[-0.5]]),
        &["operator[0][0]: -0.5 is not accepted", ">= 0"],
    );
    assert_says(
        &refused(mat![[1.0, f64::NAN], [f64::NAN, 1.0]]),
        &["NaN is not a finite"],
    );
    assert_says(&refused(mat![[f64::INFINITY]]), &["inf is not a finite"]);
    assert_says(
        &refused(Mat::zeros(2, 3)),
        &["operator columns: expected 2"],
    );
    // The same through the reader of files: W of negative energy.
    let (rows, columns) = (json!([0, 0, 1, 1]), json!([0, 1, 0, 1]));
    let values = json!([1, 2, 2, 1]);
    let said = bare_with(&[("w_rows", rows), ("w_cols", columns), ("w_values", values)]);
    assert_says(&said, &["smallest eigenvalue -"]);
}

#[test]
fn numbers_of_a_bare_problem_are_checked_one_by_one() {
    let problem = |friction: f64, gap: f64, free: f64| {
        let operator = Operator::from_compliance(Mat::identity(2, 2)).unwrap();
        refusal(ContactProblem::new(
            &[1],
            vec![friction],
            vec![gap],
            vec![free, 0.0],
            operator,
        ))
    };
    assert_eq!(problem(0.5, 0.0, 1.0), "accepted");
    assert_says(&problem(f64::NAN, 0.0, 1.0), &["friction[0]: NaN"]);
    assert_says(
        &problem(-0.1, 0.0, 1.0),
        &["friction[0]: -0.1", "friction >= 0"],
    );
    assert_says(&problem(0.5, f64::INFINITY, 1.0), &["initial_gap[0]: inf"]);
    assert_says(&problem(0.5, 0.0, f64::NAN), &["free_displacement[0]: NaN"]);
}

/// Found by the target `bare`: next to a mode of 1e81 no imbalance of the others counted, and next
/// to one of 1e-21 a reaction of 1e19 N counted as none.
#[test]
fn modes_that_cannot_be_compared_are_refused_by_their_size() {
    let floating = |modes| refusal(Floating::new(modes, vec![-1.5, 1.0]));
    assert_eq!(floating(mat![[1.0, 0.25], [-2.0, 500.0]]), "accepted");
    // A body may turn about its contact.
    assert_eq!(floating(mat![[1.0, 0.0], [-2.0, 0.0]]), "accepted");
    for size in [4.9e81, 1.5e-21] {
        let said = floating(mat![[1.0, 0.0], [-2.0, size]]);
        let place = "largest entry of floating.modes column 1: ";
        assert_says(
            &said,
            &[place, "is not accepted; expected 0, or 1e-3 to 1e3"],
        );
    }
    assert_says(
        &floating(mat![[1.0, 0.0], [f64::NAN, 0.0]]),
        &["NaN is not a finite"],
    );
}

/// Found by the target `scene`: cells of 1 by 1 by 2e19 leave the stiffness no digits. The condensed problem was
/// solved, and the body was out of balance by 0.84 of the largest force.
#[test]
fn a_body_whose_cells_leave_no_digits_is_not_certified() {
    let scene = r#"{"bodies": [{"name": "c", "materials": [{"poisson": 0.3, "young": 1000}],
        "mesh": {"box": {"cells": [2, 1, 2], "x": [0, 1], "y": [-2e19, 1], "z": [0, 1]}},
        "supports": [{"displacement": [0.0045, 0, -0.01], "group": "top"}]}],
        "contacts": [{"friction": 1.3, "group": "bottom",
            "obstacle": {"plane": {"normal": [0, 0, 1], "point": [0, 0, 0]}}}]}"#;
    let solution = dpana::solve(&dpana::Scene::from_json(scene, "").unwrap()).unwrap();
    let holds = solution.balances().iter().all(dpana::kkt::Balance::holds);
    assert!(!holds);
    let report = solution.report().unwrap();
    let json: serde_json::Value = serde_json::from_str(&report.to_json()).unwrap();
    assert_eq!(
        (&json["status"], &json["reason"]),
        (&"not_converged".into(), &"out_of_balance".into())
    );
    assert_says(
        &report.summary(),
        &["not in equilibrium", "bodies[0]", "misplaced unit"],
    );
}

#[test]
fn bodies_that_give_way_where_rigid_ones_would_jam_are_told_so() {
    // Two cells, of which one is drawn out to five times its height, held at two nodes: they can turn about these, which
    // contact 0 resists by friction alone. Pressed hard enough it would hold a rigid body; nothing presses this one
    // so, under less than μ ≈ 1.5. A witness that knows rigid bodies alone took that for a wrong answer.
    let solve_with = |friction: f64| {
        let scene = serde_json::json!({
            "bodies": [{
                "mesh": {"box": {"x": [0, 2], "y": [0, 1], "z": [0, 1], "cells": [2, 1, 1]}},
                "materials": [{"young": 1000, "poisson": 0.3}],
                "supports": [{"at": [2, 0, 0], "displacement": [0, -0.01, -0.01]},
                             {"at": [1, 0, 1], "displacement": [0, -0.01, -0.01]}],
                "loads": [{"group": "top", "pressure": 1}]
            }],
            "contacts": [{"group": "bottom", "friction": friction,
                          "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}]
        });
        let mut scene = Scene::from_json(&scene.to_string(), "").unwrap();
        let lines =
            [2.0, 1.0, 1.0].map(|length| graded(0.0, length, length as usize, 1.0).unwrap());
        let mut mesh = box_mesh(&lines[0], &lines[1], &lines[2], CellKind::Hex8).unwrap();
        let corner = mesh.nodes.iter_mut().find(|x| **x == [2.0, 0.0, 1.0]);
        *corner.unwrap() = [2.0, 0.0, 5.0];
        scene.bodies[0].mesh = MeshSource::Given(mesh);
        solve(&scene).unwrap()
    };
    let gives_way = solve_with(0.3);
    assert_eq!(gives_way.status(), Status::NoEquilibrium);
    let failure = gives_way.outcome().failure.as_ref().unwrap();
    assert!(failure.elastic && failure.proof.work > 0.0, "{failure:?}");
    assert_eq!(solve_with(1.5).status(), Status::Certified);
}
