//! Materials with directions in scenes: closed forms, and what is refused.

use dpana::Scene;
use serde_json::{Value, json};

use crate::gaps::{off, read};
use crate::stacks::certified;

#[test]
fn the_shipped_sleeve_of_fibres_presses_as_lekhnitskii_says() {
    // Plane strain: R_ij = S_ij − S_iz S_jz/S_zz, k² = R_rr/R_θθ; under p inside σ_θ = k p (1 + c^2k)/(1 − c^2k),
    // c = 20/28, u = a (R_θθ σ_θ − R_rθ p) (Lekhnitskii, Anisotropic Plates (1968), art. 26); the shaft as Lamé.
    let (along, across, nu_along, nu_across) = (140e3, 10e3, 0.3, 0.4);
    let s_zz = 1.0 / across;
    let (s_tz, s_rz) = (-nu_along / along, -nu_across / across);
    let rr = 1.0 / across - s_rz * s_rz / s_zz;
    let tt = 1.0 / along - s_tz * s_tz / s_zz;
    let rt = -nu_along / along - s_rz * s_tz / s_zz;
    let k = f64::sqrt(rr / tt);
    let c = f64::powf(20.0 / 28.0, 2.0 * k);
    let sleeve = 20.0 * (tt * k * (1.0 + c) / (1.0 - c) - rt);
    let (young, poisson) = (210e3 / (1.0 - 0.09), 0.3 / 0.7);
    let shaft = 20.0 / young * ((400.0 + 64.0) / (400.0 - 64.0) - poisson);
    let pressure = 0.05 / (sleeve + shaft);
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/examples/scenes/wound_sleeve.json"
    );
    let (_, report) = certified(&Scene::from_file(file).unwrap());
    // Quadratic cells, 12 across the wall, k = 3.4.
    assert!(
        off(&report, pressure) < 1e-4,
        "{} {pressure}",
        off(&report, pressure)
    );
}

/// A block of a material under a plate.
fn block(material: Value, model: Option<&str>) -> Value {
    let mesh = match model {
        Some(_) => json!({"rectangle": {"x": [1, 2], "y": [0, 1], "cells": [4, 4]}}),
        None => json!({"box": {"x": [1, 2], "y": [0, 1], "z": [0, 1], "cells": [2, 2, 2]}}),
    };
    let axes = if model.is_some() { 2 } else { 3 };
    let mut normal = vec![0.0; axes];
    normal[axes - 1] = -1.0;
    let mut point = vec![0.0; axes];
    point[axes - 1] = 0.99;
    let mut body = json!({"mesh": mesh, "materials": [material],
        "supports": [{"group": "bottom", "displacement": vec![0.0; axes]}]});
    if let Some(model) = model {
        body["model"] = json!(model);
    }
    json!({"bodies": [body], "contacts": [{"group": "top", "friction": 0.2,
        "obstacle": {"plane": {"point": point, "normal": normal}}}]})
}

fn wood(axes: Value) -> Value {
    let mut constants =
        json!({"young": [11000, 500, 800], "poisson": [0.4, 0.35, 0.25], "shear": [600, 700, 40]});
    if !axes.is_null() {
        constants["axes"] = axes;
    }
    json!({"orthotropic": constants})
}

fn fibres(along: Value, more: Value) -> Value {
    let mut constants = json!({"young_along": 140e3, "young_across": 10e3, "poisson_along": 0.3,
        "poisson_across": 0.4, "shear_along": 5e3, "along": along});
    for (key, value) in more.as_object().unwrap() {
        constants[key] = value.clone();
    }
    json!({"transversely_isotropic": constants})
}

#[test]
fn every_way_to_say_a_direction_is_solved() {
    let line = json!({"point": [0, 0], "direction": null});
    let upright = json!({"point": [0, 0, 0], "direction": [0, 0, 1]});
    for (material, model) in [
        (wood(Value::Null), Some("plane_strain")),
        (
            wood(json!({"directions": [[1, 1], [0, 1]]})),
            Some("axisymmetric"),
        ),
        (
            wood(json!({"directions": [[0, 0, 2], [0, 1, 0]]})),
            Some("plane_strain"),
        ),
        (wood(json!({"cylinder": line})), Some("plane_strain")),
        (wood(json!({"cylinder": upright})), None),
        (wood(json!({"directions": [[1, 1, 1], [0, 1, 0]]})), None),
        (fibres(json!([1, 1]), json!({})), Some("plane_strain")),
        (fibres(json!([0, 0, 1]), json!({})), Some("plane_strain")),
        (fibres(json!("radial"), json!({})), Some("axisymmetric")),
        (
            fibres(json!("around"), json!({"cylinder": line})),
            Some("plane_strain"),
        ),
        (fibres(json!("axial"), json!({"cylinder": upright})), None),
    ] {
        certified(&read(&block(material, model)));
    }
}

#[test]
fn a_cube_with_directions_that_cannot_expand_presses_by_its_modulus_along_the_way() {
    // Free aside: N = E_z α_z T A, whatever the constants across.
    let ortho = json!({"orthotropic": {"young": [100, 200, 1000], "poisson": [0.2, 0.1, 0.15],
        "shear": [60, 70, 80], "expansion": [4e-3, 5e-3, 1e-3]}});
    let along = fibres(
        json!([0, 0, 1]),
        json!({"expansion_along": 1e-3, "expansion_across": 5e-3}),
    );
    for (material, young) in [(ortho, 1000.0), (along, 140e3)] {
        let hot = json!({"bodies": [{
            "mesh": {"box": {"x": [0, 1], "y": [0, 1], "z": [0, 1], "cells": [2, 2, 2]}},
            "materials": [material],
            "supports": [{"group": "top", "displacement": [null, null, 0]},
                {"at": [0, 0, 1], "displacement": [0, 0, null]}, {"at": [1, 0, 1], "displacement": [null, 0, null]}],
            "loads": [{"temperature": 2}]}],
            "contacts": [{"group": "bottom", "friction": 0,
                "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}]});
        let totals = certified(&read(&hot)).1.totals;
        assert!(
            (totals.normal / (young * 2e-3) - 1.0).abs() < 1e-9,
            "{}",
            totals.normal
        );
        let mut cold = hot;
        cold["bodies"][0]["materials"] = json!([wood(Value::Null)]);
        let said = read(&cold).mechanics().map(|_| ()).unwrap_err().to_string();
        assert!(said.contains("materials without `expansion`"), "{said}");
    }
}

/// What is said of a material.
fn refusal(material: Value, model: Option<&str>) -> String {
    let scene = block(material, model).to_string();
    match Scene::from_json(&scene, "").and_then(|scene| scene.mechanics().map(|_| ())) {
        Ok(()) => String::new(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn materials_that_are_none_are_refused_with_place_value_and_cure() {
    let place = "bodies[0].materials[0]";
    let plane = Some("plane_strain");
    let line = json!({"cylinder": {"point": [0, 0]}});
    let mut both = wood(Value::Null);
    both["young"] = json!(1);
    let mut warm = wood(Value::Null);
    warm["expansion"] = json!(1e-5);
    let mut brittle = wood(Value::Null);
    brittle["orthotropic"]["poisson"] = json!([0.4, 0.35, 0.8]);
    for (material, model, said) in [
        (
            json!({}),
            plane,
            vec![place, "no constants", "transversely_isotropic"],
        ),
        (
            json!({"young": 1}),
            plane,
            vec![place, "`young` without `poisson`"],
        ),
        (both, plane, vec![place, "more than one"]),
        (
            warm,
            plane,
            vec!["materials[0].expansion", "within orthotropic"],
        ),
        (brittle, plane, vec!["orthotropic.poisson[2]: 0.8", "±0.79"]),
        (
            wood(json!({"directions": [[1, 1], [2, 2]]})),
            plane,
            vec!["axes.directions", "parallel"],
        ),
        (
            wood(json!({"directions": [[1, 0, 1], [0, 1, 0]]})),
            plane,
            vec!["orthotropic", "out of the plane"],
        ),
        (
            wood(line.clone()),
            Some("axisymmetric"),
            vec!["orthotropic", "z around already"],
        ),
        (
            wood(json!({"cylinder": {"point": [0, 0, 0]}})),
            None,
            vec!["cylinder.direction", "nothing"],
        ),
        (
            fibres(json!("sideways"), json!({})),
            plane,
            vec!["along", "radial"],
        ),
        (
            fibres(json!([0, 0]), json!({})),
            plane,
            vec!["along", "any length but zero"],
        ),
        (
            fibres(json!("radial"), json!({})),
            plane,
            vec!["cylinder", "the line of the cylinder"],
        ),
        (
            fibres(json!([1, 0]), line),
            plane,
            vec!["cylinder", "nothing beside"],
        ),
        (
            fibres(json!([1, 0]), json!({"poisson_along": 3})),
            plane,
            vec!["poisson_along: 3", "±2.0494"],
        ),
        (
            fibres(json!([1, 0]), json!({"shear_along": 0})),
            plane,
            vec!["shear_along: 0", "> 0"],
        ),
    ] {
        let found = refusal(material, model);
        assert!(
            said.iter().all(|part| found.contains(part)),
            "{said:?}: {found}"
        );
    }
}
