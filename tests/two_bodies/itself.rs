//! One skin that may meet itself: as two groups of it that are named.

use dpana::body::{CellKind, Group, Mesh, rectangle};
use dpana::scene::{SceneBody, SceneContact, SceneLaw, SceneLoad, SceneSupport};
use dpana::{Solution, solve};

use crate::stacks::{body, certified, scene};

/// Heights of a clip's grid lines: two arms 1 thick, open to the right over 10, 0.02 apart.
const HEIGHTS: [f64; 8] = [-1.01, -0.7, -0.4, -0.01, 0.01, 0.4, 0.7, 1.01];
const COLUMNS: usize = 24;

/// A clip: 12 long, its arms joined over the last 2 on the left, with all of its skin as a group.
fn clip() -> Mesh {
    let xs: Vec<f64> = (0..=COLUMNS).map(|k| 0.5 * k as f64).collect();
    let whole = rectangle(&xs, &HEIGHTS, CellKind::Quad4).unwrap();
    let open = |cell: &usize| cell / COLUMNS == 3 && cell % COLUMNS >= 4;
    let solid: Vec<usize> = (0..7 * COLUMNS).filter(|cell| !open(cell)).collect();
    let mut mesh = whole.part(&solid);
    let skin = mesh.boundary_facets();
    let walls = [-0.01, 0.01].map(|y: f64| {
        let on =
            |node: &usize| (mesh.nodes[*node][1] - y).abs() < 1e-9 && mesh.nodes[*node][0] > 1.9;
        let of = skin.iter().filter(|facet| facet.nodes.iter().all(on));
        of.cloned().collect::<Vec<_>>()
    });
    let [lower, upper] = walls;
    mesh.groups.insert("lower".to_owned(), Group::Facets(lower));
    mesh.groups.insert("upper".to_owned(), Group::Facets(upper));
    mesh.groups.insert("skin".to_owned(), Group::Facets(skin));
    mesh
}

/// The upper arm is pressed down at its end; the lower one is held.
fn pressed(contact: SceneContact) -> (Solution, dpana::report::Report) {
    certified(&scene(vec![held()], vec![contact]))
}

fn held() -> SceneBody {
    body("clip", clip(), 1000.0, 0.3)
        .with_support(SceneSupport::of("bottom", &[Some(0.0); 2]))
        .with_load(SceneLoad::force("top", &[0.0, -1.5]))
}

fn itself(group: &str, distance: f64) -> SceneContact {
    SceneContact::with_itself(group, distance, 0.2)
}

#[test]
fn a_clip_that_closes_is_found_as_if_its_two_walls_were_named() {
    let (named, report) = pressed(SceneContact::between(
        ["clip", "lower"],
        ["clip", "upper"],
        0.2,
    ));
    let (found, alike) = pressed(itself("skin", 0.05));
    assert!(
        report.totals.stick + report.totals.slip > 1,
        "it stays open"
    );
    assert!(report.totals.open > 1, "it is shut all along");
    // Facets at the root, which share no node across the gap, face each other in both.
    assert_eq!(
        alike.totals.open + alike.totals.stick + alike.totals.slip,
        report.size.contacts
    );
    let pairs = named.displacements()[0]
        .iter()
        .zip(&found.displacements()[0]);
    let largest = named.displacements()[0]
        .iter()
        .fold(0.0_f64, |most, u| most.max(u.abs()));
    let apart = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(apart < 1e-10 * largest, "{apart}");
    assert!((alike.totals.normal - report.totals.normal).abs() < 1e-9);
}

#[test]
fn a_region_counts_on_whichever_wall_its_facets_are() {
    let moved = |contact: SceneContact| {
        let (solution, _) = pressed(contact);
        solution.displacements()[0].clone()
    };
    let law = |region: &str| SceneLaw::Coulomb {
        friction: Some(0.1),
        regions: [(region.to_owned(), 0.4)].into(),
        table: None,
        shear_cap: None,
        static_friction: None,
    };
    let between = |friction| SceneContact::between(["clip", "lower"], ["clip", "upper"], friction);
    let expected = moved(between(0.4));
    let largest = expected.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    let apart = |found: Vec<f64>| {
        let pairs = found.iter().zip(&expected);
        pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
    };
    assert!(apart(moved(between(0.1))) > 1e-3 * largest);
    for region in ["lower", "upper"] {
        for contact in [between(0.1), itself("skin", 0.05)] {
            let apart = apart(moved(contact.with_law(law(region))));
            assert!(apart < 1e-10 * largest, "{region}: {apart}");
        }
    }
}

#[test]
fn what_does_not_meet_itself_is_refused() {
    let refused = |contact| {
        let error = solve(&scene(vec![held()], vec![contact])).unwrap_err();
        error.to_string()
    };
    assert!(refused(itself("skin", 0.001)).contains("contacts[0].against_itself"));
    assert!(refused(itself("skin", 0.001)).contains("no facet of the group faces another"));
    for distance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(refused(itself("skin", distance)).contains("0 < distance"));
    }
    let mut both = SceneContact::between(["clip", "lower"], ["clip", "upper"], 0.2);
    both.against_itself = Some(0.1);
    assert!(refused(both).contains("`against` and `against_itself`"));
}

fn shipped(name: &str) -> dpana::report::Report {
    let file = format!("{}/examples/scenes/{name}", env!("CARGO_MANIFEST_DIR"));
    certified(&dpana::Scene::from_file(file).unwrap()).1
}

#[test]
fn the_shipped_clip_closes_and_the_shipped_stack_carries_its_load_from_plate_to_plate() {
    let clip = shipped("clip.json");
    assert!(clip.totals.stick + clip.totals.slip > 0 && clip.totals.open > 0);
    // 5 N/mm² on 45 mm × 10 mm, through both pairs that were found.
    let stack = shipped("stack.json");
    let normals: Vec<f64> = stack
        .totals
        .pairs
        .iter()
        .map(|pair| pair.totals.normal)
        .collect();
    assert_eq!(normals.len(), 2);
    assert!(
        normals
            .iter()
            .all(|normal| (normal - 2250.0).abs() < 1e-8 * 2250.0)
    );
}

#[test]
fn the_two_sides_of_a_wall_are_not_in_each_other() {
    // The arms are 1 thick, and face each other across 0.02 alone, however far a skin is looked for.
    let near = pressed(itself("skin", 0.05)).1;
    for distance in [1.5, 4.0] {
        let far = pressed(itself("skin", distance)).1;
        assert_eq!(far.totals, near.totals);
    }
}

#[test]
fn a_closed_slit_is_none_up_to_its_tips() {
    // 2 × 2 of cells of 0.25, cut along 1 in the middle; pressed from above, it carries what it would uncut.
    let xs: Vec<f64> = (0..=8).map(|k| 0.25 * f64::from(k)).collect();
    let whole = rectangle(&xs, &xs, CellKind::Quad4).unwrap();
    let on_slit = |x: &[f64; 3]| x[1] == 1.0 && x[0] > 0.5 && x[0] < 1.5;
    let mut mesh = Mesh::new(2, whole.nodes.clone());
    let slit: Vec<usize> = (0..whole.nodes.len())
        .filter(|&n| on_slit(&whole.nodes[n]))
        .collect();
    mesh.nodes.extend(slit.iter().map(|&n| whole.nodes[n]));
    for (number, cell) in whole.cells().enumerate() {
        let above = number >= 32;
        let other = |node: &usize| match slit.iter().position(|at| at == node) {
            Some(at) if above => whole.nodes.len() + at,
            _ => *node,
        };
        let nodes: Vec<usize> = cell.nodes.iter().map(other).collect();
        mesh.push_cell(CellKind::Quad4, &nodes);
    }
    for group in ["bottom", "top"] {
        mesh.groups
            .insert(group.to_owned(), whole.groups[group].clone());
    }
    let skin = mesh.boundary_facets();
    mesh.groups.insert("skin".to_owned(), Group::Facets(skin));
    let of = body("plate", mesh, 1000.0, 0.3)
        .with_support(SceneSupport::of("bottom", &[None, Some(0.0)]))
        .with_support(SceneSupport::At {
            at: vec![0.0, 0.0],
            displacement: vec![Some(0.0), None],
        })
        .with_load(SceneLoad::pressure("top", 3.0));
    let (solution, report) = certified(&scene(vec![of], vec![itself("skin", 0.1)]));
    // Where both sides have their tip in common nothing can open: half a facet at each of them is no contact.
    assert!((report.totals.normal - 0.75 * 3.0).abs() < 1e-9);
    assert!((report.totals.peak_pressure - 3.0).abs() < 1e-9);
    let shortened = 3.0 * 2.0 * (1.0 - 0.09) / 1000.0;
    for x in [0.0, 1.0, 2.0] {
        let [_, u, _] = solution.displacement_near(0, [x, 2.0, 0.0]).unwrap();
        assert!((u + shortened).abs() < 1e-12, "{u}");
    }
}
