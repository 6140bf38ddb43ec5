//! Skins and parts of faces as contact surfaces: they touch where the bodies do, and nowhere else.

use dpana::Scene;
use dpana::body::{CellKind, Group, Mesh, graded, rectangle};
use dpana::scene::{SceneBody, SceneContact, SceneGeneralContact, SceneLoad};

use crate::stacks::{body, certified, contact, hold, scene};

/// Of even cells between two corners.
fn rectangle_of(kind: CellKind, low: [f64; 2], high: [f64; 2], cells: [usize; 2]) -> Mesh {
    let lines = |axis: usize| graded(low[axis], high[axis], cells[axis], 1.0).unwrap();
    rectangle(&lines(0), &lines(1), kind).unwrap()
}

/// With contact wherever skins face each other.
fn anywhere(bodies: Vec<SceneBody>, distance: f64) -> Scene {
    let mut scene = scene(bodies, Vec::<SceneContact>::new());
    let friction = 0.0;
    scene.general_contact = Some(SceneGeneralContact { distance, friction });
    scene
}

#[test]
fn skins_of_thin_plates_touch_where_the_plates_do() {
    // Their far faces are 0.14 behind each other, less than a twentieth of the plates' length.
    for overlap in [0.0, 0.002] {
        let plate = |name: &str, low: f64| {
            let mut mesh = rectangle_of(CellKind::Quad4, [0.0, low], [3.0, low + 0.07], [12, 2]);
            let skin = Group::Facets(mesh.boundary_facets());
            mesh.groups.insert("skin".to_owned(), skin);
            body(name, mesh, 1000.0, 0.3)
        };
        let lower = hold(hold(plate("lower", 0.0), "bottom", 1, 0.0), "left", 0, 0.0);
        let upper = hold(plate("upper", 0.07 - overlap), "left", 0, 0.0)
            .with_load(SceneLoad::pressure("top", 0.5));
        let normal = |scene: Scene| certified(&scene).1.totals.normal;
        let skins = contact(["lower", "skin"], ["upper", "skin"], 0.0);
        let bodies = vec![lower, upper];
        let named = normal(scene(bodies.clone(), vec![skins]));
        assert!((named - 1.5).abs() < 1e-9, "{named}");
        let found = normal(anywhere(bodies, 0.2));
        assert!((found - 1.5).abs() < 1e-9, "{found}");
    }
}

#[test]
fn a_box_in_a_corner_presses_on_both_walls() {
    // An L of 3 × 3 without its upper right 2 × 2, and in its corner a box that is pressed from above and from the right.
    for kind in [CellKind::Quad4, CellKind::Quad8] {
        let lines = [0.0, 1.0, 2.0, 3.0];
        let whole = rectangle(&lines, &lines, kind).unwrap();
        let solid: Vec<usize> = (0..9)
            .filter(|cell| cell % 3 == 0 || cell / 3 == 0)
            .collect();
        let corner = hold(
            hold(
                body("corner", whole.part(&solid), 1000.0, 0.3),
                "bottom",
                1,
                0.0,
            ),
            "left",
            0,
            0.0,
        );
        for gap in [0.0, 0.003] {
            let mesh = rectangle_of(kind, [1.0 + gap; 2], [1.7, 1.5], [3, 2]);
            let pushed = body("box", mesh, 1000.0, 0.3)
                .with_load(SceneLoad::pressure("top", 5.0))
                .with_load(SceneLoad::pressure("right", 1.0));
            for bodies in [[&corner, &pushed], [&pushed, &corner]] {
                let bodies = bodies.map(SceneBody::clone).to_vec();
                let (_, report) = certified(&anywhere(bodies, 0.01));
                let normals = report.totals.pairs.iter().map(|pair| pair.totals.normal);
                let mut normals: Vec<f64> = normals.collect();
                normals.sort_by(f64::total_cmp);
                let (right, top) = (0.5 - gap, 5.0 * (0.7 - gap));
                assert_eq!(normals.len(), 2);
                assert!(
                    (normals[0] - right).abs() < 1e-9 && (normals[1] - top).abs() < 1e-9,
                    "{normals:?}"
                );
            }
        }
    }
}

#[test]
fn what_stands_on_a_part_of_a_face_does_not_touch_beyond_it() {
    // A tower over x from 1 to 2, on a base whose facets are 3/7 long; the part is the three of them under it.
    let kind = CellKind::Quad4;
    let mut base = rectangle_of(kind, [0.0, -1.0], [3.0, 0.0], [7, 2]);
    let top = base.boundary_facets().into_iter().filter(|facet| {
        let nodes = facet.nodes.iter().map(|node| base.nodes[*node]);
        nodes
            .into_iter()
            .all(|x| x[1] == 0.0 && x[0] > 0.8 && x[0] < 2.2)
    });
    let part = Group::Facets(top.collect());
    base.groups.insert("under".to_owned(), part);
    let base = hold(
        hold(body("base", base, 1000.0, 0.3), "bottom", 1, 0.0),
        "bottom",
        0,
        0.0,
    );
    let tower = rectangle_of(kind, [1.0, 0.0], [2.0, 2.0], [2, 4]);
    let tower = body("tower", tower, 1000.0, 0.3).with_load(SceneLoad::pressure("top", 5.0));
    let bodies = vec![base, tower];
    let [under, bottom] = [["base", "under"], ["tower", "bottom"]];
    for scene in [
        scene(bodies.clone(), vec![contact(under, bottom, 0.3)]),
        scene(bodies.clone(), vec![contact(bottom, under, 0.3)]),
        anywhere(bodies, 0.01),
    ] {
        let (_, report) = certified(&scene);
        assert!(
            (report.totals.contact_area - 1.0).abs() < 1e-9,
            "{}",
            report.totals.contact_area
        );
        assert!((report.totals.normal - 5.0).abs() < 1e-9);
    }
}

#[test]
fn what_is_in_each_other_by_a_corner_is_no_contact() {
    // Four unit squares in a cross, each 0.002 in its neighbours, ν = 0: p = E · 0.002 / 2 everywhere; those that meet at
    // the middle alone do not press. A strip beside a block is in it at its end, not above and below.
    let square = |name: &str, [x, y]: [f64; 2], sides: [&str; 2]| {
        let mesh = rectangle_of(CellKind::Quad4, [x, y], [x + 1.0, y + 1.0], [5, 5]);
        hold(
            hold(body(name, mesh, 1000.0, 0.0), sides[0], 0, 0.0),
            sides[1],
            1,
            0.0,
        )
    };
    let near = 1.0 - 0.002;
    let cross = vec![
        square("a", [0.0, 0.0], ["left", "bottom"]),
        square("b", [near, 0.0], ["right", "bottom"]),
        square("c", [0.0, near], ["left", "top"]),
        square("d", [near, near], ["right", "top"]),
    ];
    let (_, report) = certified(&anywhere(cross, 0.02));
    assert_eq!(report.totals.pairs.len(), 4);
    assert!(
        (report.totals.peak_pressure - 1.0).abs() < 0.01,
        "{}",
        report.totals.peak_pressure
    );
    let of = |name: &str, low: [f64; 2], high: [f64; 2], held: &str| {
        let mesh = rectangle_of(CellKind::Quad4, low, high, [2, 2]);
        hold(
            hold(body(name, mesh, 1000.0, 0.0), held, 0, 0.0),
            held,
            1,
            0.0,
        )
    };
    let strip = vec![
        of("block", [0.0, 0.0], [1.5, 2.0], "left"),
        of("strip", [1.498, 0.05], [3.0, 0.15], "right"),
    ];
    for distance in [0.02, 0.2] {
        let (_, report) = certified(&anywhere(strip.clone(), distance));
        assert_eq!(report.totals.pairs.len(), 1);
        assert!(report.totals.normal > 0.05);
    }
}
