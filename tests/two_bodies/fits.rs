//! A fit of two circles presses as Lamé says although its facets are straight, for gaps are measured
//! between the circles that the facets stand for. (Timoshenko & Goodier, Theory of Elasticity, § 28.)

use std::f64::consts::PI;

use dpana::body::{CellKind, Facet, Group, Mesh};
use dpana::report::Report;
use dpana::scene::{SceneBody, SceneSupport};
use dpana::{Scene, Solution};

use crate::stacks::{body, certified, contact, hold_at, scene};

/// Radii of the bore of the shaft, of the joint and of the hub in mm, by how much the shaft is too thick.
const RADII: [f64; 3] = [8.0, 20.0, 40.0];
const TOO_THICK: f64 = 0.02;

const YOUNG: f64 = 210e3;
const POISSON: f64 = 0.3;

/// A ring of `around` straight facets and as many cells across as make them square, its groups `inner` and
/// `outer`.
fn ring(around: usize, radii: [f64; 2]) -> Mesh {
    let across = (around / 12).max(4);
    let mut nodes = Vec::new();
    for layer in 0..=across {
        let r = radii[0] + (radii[1] - radii[0]) * layer as f64 / across as f64;
        for spoke in 0..around {
            let (sin, cos) = (2.0 * PI * spoke as f64 / around as f64).sin_cos();
            nodes.push([r * cos, r * sin, 0.0]);
        }
    }
    let mut mesh = Mesh::new(2, nodes);
    let at = |layer: usize, spoke: usize| layer * around + spoke % around;
    for layer in 0..across {
        for spoke in 0..around {
            let quad = [
                at(layer, spoke),
                at(layer + 1, spoke),
                at(layer + 1, spoke + 1),
                at(layer, spoke + 1),
            ];
            mesh.push_cell(CellKind::Quad4, &quad);
        }
    }
    for (name, layer) in [("inner", 0), ("outer", across)] {
        let facet = |spoke| Facet {
            nodes: vec![at(layer, spoke), at(layer, spoke + 1)],
        };
        mesh.groups.insert(
            name.to_owned(),
            Group::Facets((0..around).map(facet).collect()),
        );
    }
    mesh
}

/// A ring that can only breathe: four of its nodes at a radius stay on the axes.
fn breathing(name: &str, mesh: Mesh, radius: f64) -> SceneBody {
    let nodes = mesh.nodes.clone();
    let body = body(name, mesh, YOUNG, POISSON);
    [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]
        .into_iter()
        .fold(body, |body, [x, y]| {
            let away = |at: &&[f64; 3]| (at[0] - radius * x).hypot(at[1] - radius * y);
            let nearest = nodes
                .iter()
                .min_by(|a, b| away(a).total_cmp(&away(b)))
                .unwrap();
            hold_at(body, *nearest, usize::from(y == 0.0), 0.0)
        })
}

fn fit(facets: [usize; 2], shaft_first: bool, rounded: bool) -> Scene {
    let shaft = ring(facets[0], [RADII[0], RADII[1] + TOO_THICK]);
    let hub = ring(facets[1], [RADII[1], RADII[2]]);
    let bodies = vec![
        breathing("shaft", shaft, RADII[0]),
        breathing("hub", hub, RADII[2]),
    ];
    let (shaft, hub) = (["shaft", "outer"], ["hub", "inner"]);
    let mut pair = if shaft_first {
        contact(shaft, hub, 0.0)
    } else {
        contact(hub, shaft, 0.0)
    };
    pair.rounded = Some(rounded);
    scene(bodies, vec![pair])
}

/// p, in MPa, in plane strain.
fn lame() -> f64 {
    let (young, poisson) = (YOUNG / (1.0 - POISSON * POISSON), POISSON / (1.0 - POISSON));
    let [a, b, c] = RADII.map(|r| r * r);
    let give = (c + b) / (c - b) + poisson + (b + a) / (b - a) - poisson;
    TOO_THICK * young / (RADII[1] * give)
}

/// Errors of the force and of the peak over the mean pressure.
fn errors(report: &Report) -> [f64; 2] {
    let normal = report.totals.normal / (2.0 * PI * RADII[1] * lame()) - 1.0;
    let mean = report.totals.normal / report.totals.contact_area;
    [normal.abs(), report.totals.peak_pressure / mean - 1.0]
}

#[test]
fn straight_facets_press_as_the_circles_that_they_stand_for() {
    for (facets, most) in [([48, 40], 0.015), ([96, 80], 0.004), ([192, 160], 0.001)] {
        for shaft_first in [true, false] {
            let (solution, report): (Solution, _) = certified(&fit(facets, shaft_first, true));
            let [force, peak] = errors(&report);
            assert!(
                force < most && peak < 0.04,
                "{facets:?} {shaft_first} {force:e} {peak:e}"
            );
            assert_eq!(report.totals.open, 0);
            // All facets, and the sagitta of those of the coarser hub.
            let coupling = solution.condensed().surface().couplings[0];
            let sagitta = RADII[1] * (1.0 - (PI / facets[1] as f64).cos());
            assert_eq!(coupling.rounded, facets[0] + facets[1]);
            assert!((coupling.largest_bulge / sagitta - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn the_reported_press_fit_has_the_force_of_lame() {
    // 61 facets on 48, R = 20, δ = 0.02, c = 40 in plane stress: 2π b p = 9896 N (tests/data/scenes); 16871 N unrounded.
    let file = "/tests/data/scenes/faceted_press_fit/scene.json";
    let (_, report) =
        certified(&Scene::from_file(format!("{}{file}", env!("CARGO_MANIFEST_DIR"))).unwrap());
    let off = report.totals.normal / 9896.0 - 1.0;
    assert!(off.abs() < 0.01, "{off}");
}

#[test]
fn told_not_to_round_a_fit_is_that_of_polygons_and_says_so() {
    let (solution, report) = certified(&fit([48, 40], true, false));
    let [force, _] = errors(&report);
    // Nodes of the hub stand 0.043 mm off the chords of the shaft's circle and the other way round, twice the overlap.
    assert!(
        force > 0.5 && report.totals.open > 4,
        "{force} {}",
        report.totals.open
    );
    assert_eq!(solution.condensed().surface().couplings[0].rounded, 0);
    let told = report.notes.iter().any(|note| note.contains("facets"));
    assert!(told, "{:?}", report.notes);
}

/// A sector of a ring, one straight facet wide, between planes of symmetry.
fn sector(name: &str, radii: [f64; 2]) -> SceneBody {
    let (angle, across) = (PI / 12.0, 8);
    let mut nodes = Vec::new();
    for layer in 0..=across {
        let r = radii[0] + (radii[1] - radii[0]) * f64::from(layer) / f64::from(across);
        nodes.extend([0.0, angle].map(|at: f64| [r * at.cos(), r * at.sin(), 0.0]));
    }
    let mut mesh = Mesh::new(2, nodes);
    for layer in 0..across as usize {
        let first = 2 * layer;
        mesh.push_cell(CellKind::Quad4, &[first, first + 2, first + 3, first + 1]);
    }
    let mut group = |name: &str, facets: Vec<Vec<usize>>| {
        let facets = facets.into_iter().map(|nodes| Facet { nodes }).collect();
        mesh.groups.insert(name.to_owned(), Group::Facets(facets));
    };
    let last = 2 * across as usize;
    group("inner", vec![vec![0, 1]]);
    group("outer", vec![vec![last, last + 1]]);
    for (cut, node) in [("start", 0), ("end", 1)] {
        let lines = (0..last)
            .step_by(2)
            .map(|at| vec![at + node, at + node + 2]);
        group(cut, lines.collect());
    }
    let mut body = body(name, mesh, YOUNG, POISSON);
    body.supports
        .extend(["start", "end"].map(|cut| SceneSupport::normal(cut, 0.0)));
    body
}

#[test]
fn a_sector_between_planes_of_symmetry_turns_as_its_ring() {
    // Whichever side carries: the facets go on behind the planes, normals lie in them, and p is Lamé's to the mesh error of
    // eight linear cells across.
    let joint = RADII[1];
    for pair in [
        [["shaft", "outer"], ["hub", "inner"]],
        [["hub", "inner"], ["shaft", "outer"]],
    ] {
        let shaft = sector("shaft", [RADII[0], joint + TOO_THICK]);
        let hub = sector("hub", [joint, RADII[2]]);
        let scene = scene(vec![shaft, hub], vec![contact(pair[0], pair[1], 0.0)]);
        let (_, report) = certified(&scene);
        let expected = joint * PI / 12.0 * lame();
        let off = report.totals.normal / expected - 1.0;
        assert!(off.abs() < 0.02, "{off}");
    }
}
