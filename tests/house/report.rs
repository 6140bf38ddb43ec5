//! What the reports say about a state that can be checked in the head, and that an
//! independent reader finds the same numbers in the VTU files.

use std::path::PathBuf;

use dpana::alternation::{Outcome, Settings, Status, SweepRecord, Work, solve};
use dpana::body::{Body, CellKind, Extremes, Facet, Mesh, Model};
use dpana::contact::{ContactNode, ContactPair, ContactSurface, Obstacle, Opposite, OppositeNodes};
use dpana::kkt::{Balance, ContactStatus, Judge, Worst, WorstNode};
use dpana::problem::{ContactProblem, Operator};
use dpana::report::vtu::{BodyFields, body_vtu, contact_path, contact_vtu};
use dpana::report::{Report, ReportParts, RigidParts, StageWork, replace_file};
use faer::Mat;
use serde_json::{Value, json};
use vtkio::Vtk;
use vtkio::model::{Attribute, CellType, DataSet, Piece, UnstructuredGridPiece, VertexNumbers};

const FLOOR: Obstacle = Obstacle::Plane {
    point: [0.0; 3],
    normal: [0.0, 1.0, 0.0],
};

const STAGES: StageWork = StageWork {
    factorisations: 1,
    single_factors: 0,
    corrections: 0,
    fallback: None,
    assembly: 0.5,
    ordering: 0.0,
    factorisation: 0.0,
    condensation: 0.0,
    recovery: 0.0,
};

fn body(name: &str, mesh: Mesh) -> Body {
    Body::new(name, mesh, Model::PlaneStrain, vec![])
}

fn pair(place: &str, opposite: Opposite) -> ContactPair {
    ContactPair::new(place, 0, vec![], opposite, 0.5)
}

/// Three squares in a row on a plane. Node 0 slips along +x under 4 N with a friction of
/// −2 N, node 1 sticks under 6 N with a friction of +1 N, node 2 is 0.25 m open, and a
/// support holds node 3.
struct Row {
    bodies: Vec<Body>,
    pairs: Vec<ContactPair>,
    surface: ContactSurface,
    problem: ContactProblem,
    outcome: Outcome,
    displacements: Vec<Vec<f64>>,
    balances: Vec<Balance>,
    extremes: Vec<Extremes>,
    support_forces: Vec<Vec<[f64; 3]>>,
}

impl Row {
    fn new() -> Self {
        let positions = (0..8)
            .map(|k| [f64::from(k % 4), f64::from(k / 4), 0.0])
            .collect();
        let mut mesh = Mesh::new(2, positions);
        for k in 0..3 {
            mesh.push_cell(CellKind::Quad4, &[k, k + 1, k + 5, k + 4]);
        }
        let contact = |node: usize, initial_gap: f64, area: f64| ContactNode {
            body: 0,
            node,
            own: vec![(node, 1.0)],
            opposite: None,
            pair: 0,
            position: [node as f64, 0.0, 0.0],
            frame: [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
            tangents: 1,
            initial_gap,
            area,
            bulge: 0.0,
            second: false,
            rim: node == 0,
        };
        let surface = ContactSurface {
            nodes: vec![
                contact(0, 0.0, 0.5),
                contact(1, 0.0, 1.0),
                contact(2, 0.1, 1.0),
            ],
            facets: (0..3)
                .map(|k| {
                    let nodes = vec![k, k + 1];
                    (0, Facet { nodes })
                })
                .collect(),
            left_out: vec![(0, 3)],
            couplings: Vec::new(),
        };
        // G = I, so û = u − t with u = (0, 0.1), (0, 0), (−0.15, 0.3).
        let free = vec![4.0, 2.1, 6.0, -1.0, -0.15, 0.3];
        let operator = Operator::from_compliance(Mat::identity(6, 6)).unwrap();
        let gaps = vec![0.0, 0.0, 0.1];
        let problem = ContactProblem::new(&[1; 3], vec![0.5; 3], gaps, free, operator).unwrap();
        let reaction = vec![-4.0, -2.0, -6.0, 1.0, 0.0, 0.0];
        let sweep = SweepRecord {
            residual: 1e-4,
            open_stick_slip: [1, 1, 1],
            ..Default::default()
        };
        // What a solve gives, with numbers chosen for what is reported of it.
        let mut outcome = solve(&problem, &Settings::default()).unwrap();
        outcome.verdict = Judge::new(&problem).measure(&reaction);
        outcome.reaction = reaction;
        outcome.history = vec![sweep];
        outcome.work = Work::default();
        outcome.work.sweeps = 1;
        outcome.work.cone_iterations = 12;
        outcome.work.newton_steps = 2;
        outcome.work.seconds.predict = 0.25;
        let mut displacement = vec![0.0; 16];
        displacement[..6].copy_from_slice(&[0.1, 0.0, 0.0, 0.0, 0.3, 0.15]);
        Self {
            bodies: vec![body("row", mesh)],
            pairs: vec![pair("contacts[0]", Opposite::Obstacle(FLOOR))],
            surface,
            problem,
            outcome,
            displacements: vec![displacement],
            balances: vec![Balance::default()],
            extremes: vec![Extremes::default()],
            support_forces: vec![Vec::new()],
        }
    }

    /// The row without floor: nodes 1 and 2 stand on a beam with the nodes (1, 0) and (3, 0)
    /// instead. Node 1 on the first, node 2 in the middle.
    fn on_beam() -> Self {
        let mut row = Self::new();
        let ends = vec![[1.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
        row.bodies.push(body("beam", Mesh::new(2, ends)));
        let opposite = Opposite::Surface {
            body: 1,
            facets: vec![],
        };
        row.pairs.push(pair("contacts[1]", opposite));
        for (contact, nodes) in [(1, vec![(0, 1.0)]), (2, vec![(0, 0.5), (1, 0.5)])] {
            row.surface.nodes[contact].pair = 1;
            row.surface.nodes[contact].opposite = Some(OppositeNodes { body: 1, nodes });
        }
        row.surface.left_out.push((1, 0));
        // The middle of the beam moves by 0.1 m along x.
        row.displacements.push(vec![0.0, 0.0, 0.2, 0.0]);
        let unsteady = WorstNode {
            value: 3.0,
            scaled: 0.5,
            node: 1,
        };
        row.extremes.push(Extremes::default());
        row.support_forces.push(Vec::new());
        row.balances.push(Balance {
            equilibrium: unsteady,
            ..Balance::default()
        });
        row
    }

    fn report(&self) -> Report {
        Report::new(&self.parts()).unwrap()
    }

    fn parts(&self) -> ReportParts<'_> {
        ReportParts {
            title: "Row of squares",
            units: "m, N, Pa",
            bodies: &self.bodies,
            pairs: &self.pairs,
            surface: &self.surface,
            problem: &self.problem,
            outcome: &self.outcome,
            displacements: &self.displacements,
            motions: &[],
            balances: &self.balances,
            rigid: RigidParts::default(),
            extremes: &self.extremes,
            support_forces: &self.support_forces,
            group_states: &[],
            departure: Worst::default(),
            fits: &[],
            stages: &STAGES,
            ranks: &[],
            origins: &[],
            step: None,
            notes: &[],
        }
    }

    fn json(&self) -> Value {
        serde_json::from_str(&self.report().to_json()).unwrap()
    }
}

fn keys(value: &Value) -> Vec<&str> {
    value
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect()
}

#[test]
fn totals_add_up_the_contacts() {
    let totals = Row::new().json()["totals"].take();
    // Normal 4 + 6 N; friction −2 + 1 N along x; moment 1 m · 6 N; pressure 4 N / 0.5 m².
    let mut expected = json!({
        "open": 1, "stick": 1, "slip": 1,
        "normal": 10.0, "friction": [-1.0, 0.0], "contact_force": [-1.0, 10.0], "moment": [6.0],
        "contact_area": 1.5, "slip_area": 0.5, "peak_pressure": 8.0,
    });
    let mut only = expected.clone();
    only["place"] = json!("contacts[0]");
    only["exchange"] = Value::Null;
    expected["pairs"] = json!([only]);
    assert_eq!(totals, expected);
}

#[test]
fn each_pair_has_its_totals_and_what_the_other_side_receives() {
    let pairs = &Row::on_beam().json()["totals"]["pairs"];
    let on_floor = json!({
        "place": "contacts[0]", "open": 0, "stick": 0, "slip": 1,
        "normal": 4.0, "friction": [-2.0, 0.0], "contact_force": [-2.0, 4.0], "moment": [0.0],
        "contact_area": 0.5, "slip_area": 0.5, "peak_pressure": 8.0, "exchange": null,
    });
    // 6 N up and 1 N along x on the row at x = 1 m, the opposite on the beam.
    let nothing = json!({"value": 0.0, "scaled": 0.0});
    let on_beam = json!({
        "place": "contacts[1]", "open": 1, "stick": 1, "slip": 0,
        "normal": 6.0, "friction": [1.0, 0.0], "contact_force": [1.0, 6.0], "moment": [6.0],
        "contact_area": 1.0, "slip_area": 0.0, "peak_pressure": 6.0,
        "exchange": {
            "opposite": {"force": [-1.0, -6.0], "moment": [-6.0]},
            "force_defect": nothing, "moment_defect": nothing,
        },
    });
    assert_eq!(pairs, &json!([on_floor, on_beam]));
}

#[test]
fn slip_is_relative_to_the_other_side() {
    let mut row = Row::on_beam();
    row.outcome.verdict.status[2] = ContactStatus::Slip;
    let contacts = &row.json()["contacts"];
    // 0.3 m of the row's node minus 0.1 m of the beam's middle; node 1's end does not move.
    let slip = contacts[2]["slip"][0].as_f64().unwrap();
    assert!((slip - 0.2).abs() < 1e-15);
    assert_eq!(contacts[1]["slip"], json!([0.0, 0.0]));
    assert_eq!(contacts[0]["slip"], json!([0.1, 0.0]));
}

#[test]
fn sizes_are_given_for_all_bodies_and_for_each() {
    let expected = json!({
        "dimension": 2, "nodes": 10, "cells": 3, "contacts": 3, "contact_unknowns": 6,
        "bodies": [
            {"name": "row", "nodes": 8, "cells": 3},
            {"name": "beam", "nodes": 2, "cells": 0},
        ],
    });
    assert_eq!(Row::on_beam().json()["size"], expected);
}

#[test]
fn contacts_are_told_in_global_axes_and_with_the_dimension_of_the_body() {
    let contacts = &Row::new().json()["contacts"];
    let slipping = json!({
        "body": 0, "node": 0, "pair": 0, "position": [0.0, 0.0], "normal": [0.0, -1.0], "state": "slip",
        "gap": 0.0, "slip": [0.1, 0.0], "area": 0.5, "force": [-2.0, 4.0],
        "pressure": 8.0, "friction_traction": [-4.0, 0.0],
    });
    assert_eq!(contacts[0], slipping);
    assert_eq!(
        (&contacts[1]["state"], &contacts[2]["state"]),
        (&json!("stick"), &json!("open"))
    );
    assert_eq!(
        (&contacts[2]["gap"], &contacts[2]["slip"]),
        (&json!(0.25), &json!([0.0, 0.0]))
    );
}

#[test]
fn names_of_the_report_are_stable() {
    let json = Row::new().json();
    let names = [
        "certificate",
        "contacts",
        "extremes",
        "history",
        "notes",
        "quality",
        "size",
        "status",
        "supports",
        "title",
        "totals",
        "units",
        "work",
    ];
    assert_eq!(keys(&json), names);
    let laws = [
        "bipotential_gap",
        "bodies",
        "complementarity",
        "disc_excess",
        "dissipation_defect",
        "natural_map",
        "penetration",
        "reaction_energy",
        "recovered",
        "tension",
    ];
    assert_eq!(keys(&json["certificate"]), laws);
    assert_eq!(
        keys(&json["certificate"]["tension"]),
        ["contact", "scaled", "value"]
    );
    let balance = [
        "contact",
        "equilibrium",
        "force_defect",
        "loads",
        "moment_defect",
        "name",
        "support",
        "supports",
    ];
    assert_eq!(keys(&json["certificate"]["bodies"][0]), balance);
    assert_eq!(json["certificate"]["bodies"][0]["name"], "row");
    let work = [
        "cone_iterations",
        "corrections",
        "coulomb_programs",
        "factorisations",
        "friction_program_contacts",
        "friction_programs",
        "newton_steps",
        "normal_programs",
        "passes",
        "seconds",
        "single_factors",
        "sweeps",
    ];
    assert_eq!(keys(&json["work"]), work);
    let stages = [
        "assembly",
        "condensation",
        "coulomb",
        "factorisation",
        "finish",
        "friction",
        "judge",
        "normal",
        "ordering",
        "predict",
        "recovery",
        "total",
    ];
    assert_eq!(keys(&json["work"]["seconds"]), stages);
    assert_eq!(json["work"]["seconds"]["total"], 0.75);
    let sweep = [
        "coulomb_iterations",
        "friction_iterations",
        "newton_steps",
        "normal_iterations",
        "open",
        "residual",
        "seconds",
        "slip",
        "stick",
    ];
    assert_eq!(keys(&json["history"][0]), sweep);
}

#[test]
fn every_status_has_its_name() {
    let mut row = Row::new();
    for (status, name) in [
        (Status::Certified, "certified"),
        (Status::NotConverged, "not_converged"),
        (Status::NoEquilibrium, "no_equilibrium"),
    ] {
        row.outcome.status = status;
        assert_eq!(row.json()["status"], name);
    }
}

#[test]
fn a_contact_without_area_has_a_force_and_no_pressure() {
    let mut row = Row::new();
    row.surface.nodes[0].area = 0.0;
    let json = row.json();
    let contact = &json["contacts"][0];
    assert_eq!(contact["force"], json!([-2.0, 4.0]));
    assert!(contact["pressure"].is_null() && contact["friction_traction"].is_null());
    assert_eq!(json["totals"]["peak_pressure"], 6.0);
}

#[test]
fn a_pressed_contact_at_the_rim_and_a_node_left_out_are_noted() {
    let row = Row::new();
    let parts = ReportParts {
        origins: &[],
        step: None,
        notes: &["the body is alone".to_owned()],
        ..row.parts()
    };
    let notes = Report::new(&parts).unwrap().notes;
    assert_eq!(notes[0], "the body is alone");
    assert!(notes[1].starts_with("node 3: no contact here"));
    assert!(notes[2].starts_with("node 0: contact reaches the rim"));
    let mut open = Row::new();
    open.surface.nodes[0].rim = false;
    open.surface.nodes[2].rim = true;
    assert_eq!(open.report().notes.len(), 1);
}

#[test]
fn notes_name_the_body_where_there_are_several() {
    let notes = Row::on_beam().report().notes;
    assert!(notes[0].starts_with("body `row`, node 3: no contact here"));
    assert!(notes[1].starts_with("body `beam`, node 0: no contact here"));
    assert!(notes[2].starts_with("body `row`, node 0: contact reaches the rim"));
}

#[test]
fn the_summary_fits_on_a_screen_and_shouts_when_nothing_is_certified() {
    let mut row = Row::new();
    let text = row.report().summary();
    assert!(text.lines().count() <= 30, "{text}");
    for line in [
        "status          certified",
        "units           m, N, Pa",
        "contacts        3: 1 open, 1 stick, 1 slip",
        "normal force    10.0000",
        "friction        (-1.00000, 0)",
        "work            1 factorisation, 1 sweep, 12 cone iterations, 2 Newton steps",
    ] {
        assert!(text.lines().any(|found| found == line), "{line}\n{text}");
    }
    row.outcome.status = Status::NotConverged;
    assert!(row.report().summary().contains("NOT CONVERGED"));
}

#[test]
fn the_summary_of_several_bodies_lists_pairs_and_names_the_worst_body() {
    let text = Row::on_beam().report().summary();
    assert!(text.lines().count() <= 34, "{text}");
    for line in [
        "size            2D, 10 nodes, 3 cells in 2 bodies",
        "contacts        3: 1 open, 1 stick, 1 slip",
        "pairs               open  stick   slip  normal force  peak pressure",
        "  contacts[0]          0      0      1       4.00000        8.00000",
        "  contacts[1]          1      1      0       6.00000        6.00000",
        "  equilibrium          3.0e0    5.0e-1  body `beam`, node 1",
        "  force exchange           0         0",
    ] {
        assert!(text.lines().any(|found| found == line), "{line}\n{text}");
    }
}

#[test]
fn parts_of_different_problems_are_refused() {
    let refused = |spoil: fn(&mut Row)| {
        let mut row = Row::on_beam();
        spoil(&mut row);
        Report::new(&row.parts()).unwrap_err().to_string()
    };
    assert_eq!(
        refused(|row| row.displacements[0].truncate(15)),
        "displacements[0]: expected 16 entries, found 15"
    );
    assert_eq!(
        refused(|row| row.balances.truncate(1)),
        "balances: expected 2 entries, found 1"
    );
    assert_eq!(
        refused(|row| row.bodies[1].mesh.dimension = 3),
        "bodies[1]: dimension 3 does not fit; expected 2"
    );
    assert_eq!(
        refused(|row| row.pairs.truncate(1)),
        "contact nodes[1]: pair 1 does not exist; expected less than 1"
    );
    assert_eq!(
        refused(|row| row.surface.nodes[2].node = 99),
        "contact nodes[2]: node 99 does not exist; expected less than 8"
    );
    assert_eq!(
        refused(|row| row.bodies.clear()),
        "bodies: empty; expected at least one entry"
    );
}

/// Writes a document, reads it back with an independent reader.
fn read_back(name: &str, text: &str) -> UnstructuredGridPiece {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    replace_file(&path, text).unwrap();
    let DataSet::UnstructuredGrid { mut pieces, .. } = Vtk::import(&path).unwrap().data else {
        panic!("not an unstructured grid");
    };
    let Piece::Inline(piece) = pieces.remove(0) else {
        panic!("no inline piece");
    };
    *piece
}

fn array(arrays: &[Attribute], wanted: &str) -> Vec<f64> {
    let found = arrays.iter().find_map(|attribute| match attribute {
        Attribute::DataArray(array) if array.name == wanted => Some(&array.data),
        _ => None,
    });
    found.unwrap().cast_into().unwrap()
}

fn connectivity(piece: &UnstructuredGridPiece) -> (Vec<u64>, Vec<u64>) {
    match &piece.cells.cell_verts {
        VertexNumbers::XML {
            connectivity,
            offsets,
        } => (connectivity.clone(), offsets.clone()),
        VertexNumbers::Legacy { .. } => panic!("legacy cells in an XML file"),
    }
}

#[test]
fn the_body_is_read_back_with_its_cells_and_fields() {
    let row = Row::new();
    let stress: Vec<[f64; 6]> = (0..8)
        .map(|k| [f64::from(k), 2.0, 3.0, 4.0, 5.0, 6.0])
        .collect();
    // Von Mises of pure tension is that tension, of shear √3 times that shear.
    let mut cell_stress = [[0.0; 6]; 3];
    (cell_stress[0][0], cell_stress[1][1]) = (0.1, -1e-150);
    cell_stress[2][5] = -2e100;
    let text = body_vtu(&[BodyFields {
        mesh: &row.bodies[0].mesh,
        displacement: &row.displacements[0],
        nodal_stress: &stress,
        cell_stress: &cell_stress,
        cell_strain: &[],
        contact_force: &[],
        support_force: &[],
    }])
    .unwrap();
    let piece = read_back("row.vtu", &text);
    assert_eq!(piece.cells.types, [CellType::Quad; 3]);
    let (nodes, ends) = connectivity(&piece);
    assert_eq!((&nodes[4..8], ends), (&[1, 2, 6, 5][..], vec![4, 8, 12]));
    let points: Vec<f64> = piece.points.cast_into().unwrap();
    assert_eq!((points.len(), &points[15..18]), (24, &[1.0, 1.0, 0.0][..]));
    let moved = array(&piece.data.point, "displacement");
    assert_eq!((moved.len(), &moved[6..9]), (24, &[0.3, 0.15, 0.0][..]));
    // Voigt's yz, xz, xy = 4, 5, 6 become VTK's xy, yz, xz.
    assert_eq!(
        array(&piece.data.point, "stress")[6..12],
        [1.0, 2.0, 3.0, 6.0, 4.0, 5.0]
    );
    let expected = [0.1, 1e-150, 2e100 * 3.0_f64.sqrt()];
    let found = array(&piece.data.cell, "von_mises");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 1e-14, "{found:e}");
    }
    // Uniaxial pull and push, and pure shear: τ, 0, −τ.
    let principal = array(&piece.data.cell, "principal_stress");
    assert_eq!(principal[..6], [0.1, 0.0, 0.0, 0.0, 0.0, -1e-150]);
    for (found, expected) in principal[6..].iter().zip([2e100, 0.0, -2e100]) {
        assert!((found - expected).abs() < 1e86, "{found:e}");
    }
    assert_eq!(array(&piece.data.cell, "body"), [0.0; 3]);
    assert_eq!(array(&piece.data.point, "body"), [0.0; 8]);
}

#[test]
fn cells_of_3d_are_read_back_by_their_kind() {
    let corner = |k: usize| [(k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64];
    let mut mesh = Mesh::new(3, (0..8).map(corner).collect());
    mesh.push_cell(CellKind::Hex8, &[0, 1, 3, 2, 4, 5, 7, 6]);
    mesh.push_cell(CellKind::Tet4, &[0, 1, 2, 4]);
    let displacement: Vec<f64> = (0..24).map(f64::from).collect();
    let fields = BodyFields {
        mesh: &mesh,
        displacement: &displacement,
        nodal_stress: &[],
        cell_stress: &[],
        cell_strain: &[],
        contact_force: &[],
        support_force: &[],
    };
    let piece = read_back("cells.vtu", &body_vtu(&[fields]).unwrap());
    assert_eq!(piece.cells.types, [CellType::Hexahedron, CellType::Tetra]);
    assert_eq!(connectivity(&piece).1, [8, 12]);
    assert_eq!(array(&piece.data.point, "displacement"), displacement);
    // Only `body` is left of what cells have.
    assert_eq!(piece.data.cell.len(), 1);
}

#[test]
fn several_bodies_are_read_back_one_after_the_other() {
    let mut triangle = Mesh::new(2, vec![[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [5.0, 1.0, 0.0]]);
    triangle.push_cell(CellKind::Tri3, &[0, 1, 2]);
    let row = Row::new();
    let of_row = BodyFields {
        mesh: &row.bodies[0].mesh,
        displacement: &row.displacements[0],
        nodal_stress: &[],
        cell_stress: &[],
        cell_strain: &[],
        contact_force: &[],
        support_force: &[],
    };
    let of_triangle = BodyFields {
        mesh: &triangle,
        displacement: &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
        ..of_row
    };
    let text = body_vtu(&[of_row, of_triangle]).unwrap();
    let piece = read_back("bodies.vtu", &text);
    assert_eq!(connectivity(&piece).0[12..], [8, 9, 10]);
    assert_eq!(array(&piece.data.cell, "body"), [0.0, 0.0, 0.0, 1.0]);
    let of_points = array(&piece.data.point, "body");
    assert_eq!(of_points, [[0.0; 8].as_slice(), &[1.0; 3]].concat());
    let moved = array(&piece.data.point, "displacement");
    assert_eq!(moved[24..27], [1.0, 2.0, 0.0]);
    let points: Vec<f64> = piece.points.cast_into().unwrap();
    assert_eq!(points[24..27], [5.0, 0.0, 0.0]);

    // A field that only one of the bodies has would leave the others' values open.
    let still = BodyFields {
        displacement: &[],
        ..of_triangle
    };
    let refused = body_vtu(&[of_row, still]).unwrap_err().to_string();
    assert_eq!(
        refused,
        "bodies[1].displacement: expected 6 entries, found 0"
    );
}

#[test]
fn the_contact_surface_is_read_back_and_blank_where_there_is_no_contact() {
    let row = Row::new();
    let facets = &row.surface.facets;
    let text = contact_vtu(&row.report(), &row.bodies, facets, &row.displacements).unwrap();
    let piece = read_back("row_contact.vtu", &text);
    assert_eq!(piece.cells.types, [CellType::Line; 3]);
    assert_eq!(connectivity(&piece).0, [0, 1, 1, 2, 2, 3]);
    assert_eq!(array(&piece.data.point, "state"), [1.0, 2.0, 0.0, -1.0]);
    // Slip and stick, stick and open, open and none.
    assert_eq!(array(&piece.data.cell, "state"), [2.0, 2.0, 0.0]);
    assert!(text.contains("state: 0 open, 1 slip, 2 stick"));
    assert_eq!(array(&piece.data.point, "node"), [0.0, 1.0, 2.0, 3.0]);
    let pressure = array(&piece.data.point, "pressure");
    assert_eq!(pressure[..3], [8.0, 6.0, 0.0]);
    assert!(pressure[3].is_nan());
    assert_eq!(
        array(&piece.data.point, "friction_traction")[..3],
        [-4.0, 0.0, 0.0]
    );
    assert_eq!(array(&piece.data.point, "gap")[..3], [0.0, 0.0, 0.25]);
    assert_eq!(array(&piece.data.point, "slip")[..3], [0.1, 0.0, 0.0]);
    // What is open does not slip, however far it moved along.
    assert_eq!(array(&piece.data.point, "slip")[6..9], [0.0; 3]);
}

#[test]
fn contacts_without_facets_are_shown_as_points() {
    let row = Row::new();
    let text = contact_vtu(&row.report(), &row.bodies, &[], &row.displacements).unwrap();
    let piece = read_back("points_contact.vtu", &text);
    assert_eq!(piece.cells.types, [CellType::Vertex; 3]);
    for stray in [(0, 99), (7, 0)] {
        let (body, node) = stray;
        let facet = (body, Facet { nodes: vec![node] });
        let found = contact_vtu(&row.report(), &row.bodies, &[facet], &row.displacements);
        assert!(found.is_err());
    }
}

#[test]
fn a_facet_of_another_body_shares_no_point_with_a_contact_of_the_same_node_number() {
    let row = Row::on_beam();
    let facet = (1, Facet { nodes: vec![0, 1] });
    let text = contact_vtu(&row.report(), &row.bodies, &[facet], &row.displacements).unwrap();
    let piece = read_back("beam_contact.vtu", &text);
    assert_eq!(connectivity(&piece).0, [3, 4, 0, 1, 2]);
    let of_points = array(&piece.data.point, "body");
    assert_eq!(of_points, [0.0, 0.0, 0.0, 1.0, 1.0]);
    assert_eq!(array(&piece.data.cell, "body"), [1.0, 0.0, 0.0, 0.0]);
    let moved = array(&piece.data.point, "displacement");
    assert_eq!(moved[12..15], [0.2, 0.0, 0.0]);
}

#[test]
fn a_file_that_cannot_be_written_is_named_and_nothing_is_left_behind() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("writes");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("body.vtu");
    replace_file(&path, "old").unwrap();
    replace_file(&path, "new").unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "new");
    // A folder stands where the file should go.
    let refused = replace_file(&folder, "text").unwrap_err().to_string();
    assert!(refused.contains("writes: cannot be written"), "{refused}");
    let missing = folder.join("missing").join("body.vtu");
    assert!(replace_file(&missing, "text").is_err());
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    assert_eq!(contact_path(&path), folder.join("body_contact.vtu"));
}

/// Names and places (points, cells) of the arrays of a file.
fn arrays_of(piece: &UnstructuredGridPiece) -> Vec<(String, &'static str)> {
    let names = |attributes: &[Attribute]| -> Vec<String> {
        let arrays = attributes.iter().filter_map(|attribute| match attribute {
            Attribute::DataArray(array) => Some(array.name.clone()),
            Attribute::Field { .. } => None,
        });
        arrays.collect()
    };
    let points = names(&piece.data.point)
        .into_iter()
        .map(|name| (name, "points"));
    let cells = names(&piece.data.cell)
        .into_iter()
        .map(|name| (name, "cells"));
    let mut arrays: Vec<_> = points.chain(cells).collect();
    arrays.sort();
    arrays
}

/// The rows of the table with this heading in the documentation: names and places, ours or of Abaqus.
fn documented(heading: &str, column: usize) -> Vec<(String, &'static str)> {
    let page = include_str!("../../src/report/vtu/mod.rs");
    let (_, table) = page.split_once(&format!("//! | {heading}: array")).unwrap();
    let rows = table
        .lines()
        .skip(2)
        .take_while(|line| line.starts_with("//! |"));
    let mut arrays = Vec::new();
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let own = cells[1].trim_matches('`');
        let name = match cells[column].trim_matches('`') {
            "" => own,
            name => name,
        };
        let places = ["points", "cells"]
            .into_iter()
            .filter(|place| cells[2].contains(place));
        arrays.extend(places.map(|place| (name.to_owned(), place)));
    }
    arrays.sort();
    arrays
}

#[test]
fn files_hold_the_arrays_that_the_documentation_lists() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/square.json");
    let solution = dpana::solve(&dpana::Scene::from_file(scene).unwrap()).unwrap();
    let documents = solution.to_vtu().unwrap();
    for (document, heading) in documents.iter().zip(["bodies", "contact surface"]) {
        let own = read_back("documented.vtu", document);
        assert_eq!(arrays_of(&own), documented(heading, 1));
        let renamed = dpana::report::vtu::abaqus_names(document);
        let renamed = read_back("documented.vtu", &renamed);
        assert_eq!(arrays_of(&renamed), documented(heading, 4));
    }
    // Contacts and supports hold what presses: 5e7 on the top and 15e7 on the left, both 0.04 wide.
    let bodies = read_back("documented.vtu", &documents[0]);
    let sum = |name: &str| {
        let force = array(&bodies.data.point, name);
        [0, 1].map(|axis| force.iter().skip(axis).step_by(3).sum::<f64>())
    };
    let (contact, support) = (sum("contact_force"), sum("support_force"));
    let totals = solution.report().unwrap().totals;
    for (axis, load) in [6e6, -2e6].into_iter().enumerate() {
        assert!(
            (contact[axis] - totals.contact_force[axis]).abs() < 1e-3,
            "{contact:?}"
        );
        assert!(
            (contact[axis] + support[axis] + load).abs() < 1e-3,
            "{support:?}"
        );
    }
}
