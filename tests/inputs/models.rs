//! The engineering models that ship with their meshes (`examples/meshes`): statics and geometry of the answers.

use dpana::{Scene, Solution, Status, check, solve};

fn model(name: &str) -> Scene {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/meshes");
    Scene::from_file(format!("{folder}/{name}.json")).unwrap()
}

fn solved(name: &str) -> Solution {
    let solution = solve(&model(name)).unwrap();
    assert_eq!(solution.status(), Status::Certified, "{name}");
    solution
}

#[test]
fn a_pin_hands_its_load_to_the_lug() {
    // Statics: all of the 10 kN on the pin's bore goes through the contact.
    let report = solved("lug").report().unwrap();
    let force = &report.totals.contact_force;
    assert!(
        (force[0] + 1e4).abs() < 1e-6 && force[1].abs() < 1e-6,
        "{force:?}"
    );
    // Of a pin as wide as the hole the pressure is that on the middle of a half circle at most as large as
    // 4/π of load over width and thickness (a cosine, as for frictionless pins); not less than the mean.
    let mean = 1e4 / (20.0 * 10.0);
    let peak = report.totals.peak_pressure;
    assert!(
        peak > mean && peak < 1.5 * mean * 4.0 / std::f64::consts::PI,
        "{peak}"
    );
}

#[test]
fn normals_of_involute_teeth_touch_the_base_circle() {
    // Every normal of an involute touches the base circle, of radius 50 cos 20° = 46.98 mm: that is the arm
    // of the normal forces about the pinion's centre, whichever of the two sides carries them.
    let report = solved("gears").report().unwrap();
    let contacts = report.contacts.iter();
    let moment: f64 = contacts
        .map(|contact| {
            let (n, f, x) = (&contact.normal, &contact.force, &contact.position);
            ((f[0] * n[0] + f[1] * n[1]) * (x[0] * n[1] - x[1] * n[0])).abs()
        })
        .sum();
    let arm = moment / report.totals.normal;
    // Facets of 0.6 mm on flanks of radius 17 mm turn by 0.02 from the involute's normal, which is 17 mm long.
    assert!((arm - 46.98).abs() < 0.3, "{arm}");
}

#[test]
fn the_bracket_is_fit_to_be_solved() {
    let checked = check(&model("bracket")).unwrap();
    assert_eq!(checked.mechanics.contacts.len(), 2);
    assert!(checked.surface.nodes.len() > 100);
}
