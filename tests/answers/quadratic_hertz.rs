//! Hertz' line contact with quadratic cells: exact for the size of the cells, and smooth.

use dpana::body::{CellKind, rectangle};
use dpana::closed_forms::HertzLine;
use dpana::scene::MeshSource;
use dpana::{Scene, Status, solve};
use serde_json::json;

/// What is measured of a half of the contact.
struct Measured {
    /// Contacts per half-width.
    strips: f64,
    /// L2 error of the pressure and error of its peak, relative.
    pressure: f64,
    peak: f64,
    /// Pressures from the middle outward, relative to the peak.
    profile: Vec<f64>,
}

/// A rigid cylinder of radius 10 in a block with `per_unit` cells per 0.01 of width.
fn measure(kind: CellKind, per_unit: usize) -> Measured {
    let scene = json!({
        "bodies": [{
            "mesh": {"file": "given in code"}, "model": "plane_strain",
            "materials": [{"young": 1.0, "poisson": 0.3}],
            "supports": [
                {"group": "left", "displacement": [0, null]},
                {"group": "bottom", "displacement": [null, 1.5e-4]}
            ]
        }],
        "contacts": [{
            "group": "top", "friction": 0,
            "obstacle": {"circle": {"center": [0, 10], "radius": 10}}
        }]
    });
    let mut scene = Scene::from_json(&scene.to_string(), "").unwrap();
    let fine = 0.01 / per_unit as f64;
    let mut lines: Vec<f64> = (0..=3 * per_unit).map(|k| k as f64 * fine).collect();
    let (mut size, mut last) = (fine, 0.03);
    while last < 2.0 {
        size *= 1.15;
        last += size;
        lines.push(last);
    }
    let depths: Vec<f64> = lines.iter().rev().map(|y| 0.0 - y).collect();
    let mesh = rectangle(&lines, &depths, kind).unwrap();
    scene.bodies[0].mesh = MeshSource::Given(mesh);
    let solution = solve(&scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    let report = solution.report().unwrap();
    let hertz = HertzLine::new(2.0 * report.totals.normal, 10.0, 1.0 / 0.91).unwrap();
    let mut contacts = report.contacts;
    contacts.sort_by(|a, b| a.position[0].total_cmp(&b.position[0]));
    let (mut error, mut total) = (0.0, 0.0);
    for contact in &contacts {
        let exact = hertz.pressure(contact.position[0]);
        error += contact.area * (contact.pressure.unwrap() - exact).powi(2);
        total += contact.area * exact * exact;
    }
    Measured {
        strips: hertz.half_width / fine,
        pressure: (error / total).sqrt(),
        peak: (contacts[0].pressure.unwrap() / hertz.peak - 1.0).abs(),
        profile: contacts
            .iter()
            .map(|c| c.pressure.unwrap() / hertz.peak)
            .collect(),
    }
}

#[test]
fn the_pressure_of_quadratic_cells_is_hertz_own() {
    // Piecewise constant pressures of n strips per half-width have an error of 0.11/n; contacts of
    // quadratic cells stand two such strips apart. The peak misses by 0.13/(n/2)², 2.7e-3 and 0.7e-3 with n = 14
    // and 28 contacts, and by (a/L)² = 1.4e-4: the bound lies between.
    for kind in [CellKind::Quad9, CellKind::Quad8, CellKind::Tri6] {
        for per_unit in [6, 12] {
            let found = measure(kind, per_unit);
            assert!(
                found.pressure * found.strips < 0.22,
                "{kind:?} {per_unit}: {:e}",
                found.pressure
            );
            assert!(found.peak < 1e-3, "{kind:?} {per_unit}: {:e}", found.peak);
        }
    }
}

#[test]
fn the_pressure_falls_from_the_middle_to_the_rim_without_a_ripple() {
    for kind in [CellKind::Quad9, CellKind::Quad8, CellKind::Tri6] {
        let found = measure(kind, 12);
        let falls = found.profile.windows(2).all(|pair| pair[1] <= pair[0]);
        assert!(falls, "{kind:?}: {:?}", found.profile);
    }
}
