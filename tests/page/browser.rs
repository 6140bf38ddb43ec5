//! Pages in a browser without a window. `checks.js` is put behind the page, looks at what was drawn, works the
//! menus and keys, and writes what it found into the page; Chromium prints the page as it is then.
//!
//! Chromium is looked for under its usual names, or where `CHROMIUM` says.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use dpana::Scene;
use dpana::body::{CellKind, Mesh};
use dpana::scene::{SceneBody, SceneContact, SceneMaterial, SceneObstacle, SceneSupport};
use serde_json::{Value, json};

use crate::program::{dpana, folder};
use crate::samples::{block, page_of, strip};

const CHECKS: &str = include_str!("checks.js");

/// What the browser prints of a page after the checks; `expected` is what they know of the scene.
fn looked_at(page: &Path, expected: &Value) -> Value {
    let text = fs::read_to_string(page).unwrap();
    let checked = page.with_extension("checked.html");
    let expected = expected.to_string().replace('<', "\\u003c");
    fs::write(
        &checked,
        format!("{text}<script>const EXPECTED = {expected};\n{CHECKS}</script>"),
    )
    .unwrap();
    let shown = printed(&checked);
    let found = shown.split("<pre id=\"checks\">").nth(1);
    let found = found.and_then(|rest| rest.split("</pre>").next());
    let Some(found) = found else {
        unreachable!("the checks ran: {shown}");
    };
    let found = found
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&amp;", "&");
    serde_json::from_str(&found).unwrap()
}

/// The page as the browser prints it, within two minutes.
fn printed(page: &Path) -> String {
    let into = page.with_extension("printed");
    let mut browser = Command::new(chromium())
        .args([
            "--headless",
            "--no-sandbox",
            "--no-first-run",
            "--disable-extensions",
        ])
        .args(["--disable-background-networking", "--password-store=basic"])
        .args([
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
        ])
        .args(["--window-size=1280,800", "--dump-dom"])
        .arg(format!(
            "--user-data-dir={}",
            page.with_extension("profile").display()
        ))
        .arg(format!("file://{}", page.display()))
        .stdout(File::create(&into).unwrap())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while browser.try_wait().unwrap().is_none() {
        if start.elapsed() > Duration::from_secs(120) {
            browser.kill().unwrap();
            browser.wait().unwrap();
            unreachable!("{} was printed in time", page.display());
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    fs::read_to_string(into).unwrap()
}

/// The browser to use.
fn chromium() -> String {
    let given = std::env::var("CHROMIUM").into_iter();
    let usual = ["chromium", "chromium-browser", "google-chrome"].map(str::to_owned);
    let mut names = given.chain(usual);
    let found = names.find(|name| Command::new(name).arg("--version").output().is_ok());
    found.unwrap_or_else(|| unreachable!("no Chromium: install it, or say where it is in CHROMIUM"))
}

/// All checks of a page hold.
fn hold(page: &Path, expected: &Value) {
    let found = looked_at(page, expected);
    let failed = found["failed"].as_array().unwrap();
    assert!(failed.is_empty(), "{failed:#?}");
    assert!(found["passed"].as_u64().unwrap() > 20, "{found}");
}

/// Ids in the menu of fields.
fn fields(plane: bool) -> Value {
    let axes = if plane {
        vec!["x", "y"]
    } else {
        vec!["x", "y", "z"]
    };
    let mut ids = vec!["displacement".to_owned()];
    ids.extend(axes.iter().map(|axis| format!("displacement_{axis}")));
    let stresses = [
        "von_mises",
        "principal_1",
        "principal_2",
        "principal_3",
        "tresca",
    ];
    ids.extend(stresses.map(str::to_owned));
    let components = ["xx", "yy", "zz", "xy", "yz", "xz"];
    let components = components.into_iter().take(if plane { 4 } else { 6 });
    ids.extend(components.map(|name| format!("stress_{name}")));
    let contact = [
        "pressure",
        "friction",
        "friction_used",
        "gap",
        "slip",
        "state",
    ];
    ids.extend(contact.map(str::to_owned));
    json!(ids)
}

#[test]
#[ignore = "needs Chromium"]
fn a_browser_shows_a_plane_strip_field_by_field() {
    let page = page_of(&strip(), &folder("page_browser_strip"));
    hold(
        &page,
        &json!({
            "fields": fields(true), "states": 1, "plane": true,
            "values": {"von_mises": 5, "principal_1": 0, "principal_2": 0, "principal_3": -5, "tresca": 5,
                       "stress_yy": -5, "pressure": 5, "friction": 0, "gap": 0},
            // Drawn from u_y = −0.005 at the top to 0 at the bottom.
            "gradient": {"field": "displacement_y", "range": [-0.005, 0]},
        }),
    );
}

#[test]
#[ignore = "needs Chromium"]
fn a_browser_shows_a_block_step_by_step() {
    let folder = folder("page_browser_block");
    for kind in ["hex8", "tet10"] {
        fs::write(folder.join("block.json"), block(kind).to_string()).unwrap();
        let done = dpana(&folder, &["solve", "block.json", "--page", "block.html"]);
        assert_eq!(done.status.code(), Some(0));
        hold(
            &folder.join("block.html"),
            &json!({
                "fields": fields(false), "states": 2, "plane": false,
                "values": {"von_mises": 5, "principal_1": 0, "principal_2": 0, "principal_3": -5, "tresca": 5,
                           "stress_zz": -5, "pressure": 5, "friction": 0, "gap": 0, "state": 2},
                "gradient": {"field": "displacement_z", "range": [-0.01, 0]},
            }),
        );
    }
}

#[test]
#[ignore = "needs Chromium"]
fn a_page_cut_off_within_a_state_shows_those_before() {
    let folder = folder("page_browser_cut");
    fs::write(folder.join("block.json"), block("hex8").to_string()).unwrap();
    dpana(&folder, &["solve", "block.json", "--page", "block.html"]);
    let path = folder.join("block.html");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[..text.len() - 500]).unwrap();
    // The checks' own element would end the one that was cut.
    let found = looked_at_cut(&path);
    assert_eq!(found, "1");
}

/// The number of states that a page shows which nothing was put behind.
fn looked_at_cut(page: &Path) -> String {
    let shown = printed(page);
    let rest = shown.split("data-states=\"").nth(1).unwrap();
    rest.split('"').next().unwrap().to_owned()
}

/// A plate of so many cells along its sides, pressed on a floor in its middle.
fn plate(cells: usize) -> Scene {
    let ticks: Vec<f64> = (0..=cells).map(|i| i as f64).collect();
    let mesh = dpana::body::box_mesh(&ticks, &ticks, &[0.0, 4.0], CellKind::Hex8).unwrap();
    let middle = 0.5 * cells as f64;
    let near = move |x: f64| (x - middle).abs() < 5.5;
    let spot = move |[x, y, z]: [f64; 3]| z == 0.0 && near(x) && near(y);
    let mesh: Mesh = mesh.with_surface("spot", spot).unwrap();
    let plate = SceneBody::new("plate", mesh)
        .with_material(SceneMaterial::new(1000.0, 0.3))
        .with_support(SceneSupport::of("top", &[Some(0.0), Some(0.0), Some(-0.1)]));
    let floor = SceneObstacle::plane(&[0.0, 0.0, 0.0], &[0.0, 0.0, 1.0]);
    Scene::new(vec![plate], vec![SceneContact::on(floor, "spot", 0.3)])
}

/// 2 × 2 × 222² + 8 × 222 = 198,912 triangles.
#[test]
#[ignore = "needs Chromium, and a minute"]
fn two_hundred_thousand_facets_open_in_three_seconds_and_turn_fluently() {
    let folder = folder("page_browser_plate");
    let page = page_of(&plate(222), &folder);
    let found = looked_at(&page, &json!({"speed": true}));
    assert_eq!(found["triangles"], 198_912);
    assert!(found["drawn"].as_f64().unwrap() < 3000.0, "{found}");
    // Without a graphics card: with one it is a small part of it.
    assert!(found["frame"].as_f64().unwrap() < 200.0, "{found}");
    assert!(found["pick"].as_f64().unwrap() < 100.0, "{found}");
}

#[test]
#[ignore = "slow: run in release"]
fn the_verification_manual_opens_and_shows_every_scene() {
    let folder = folder("manual");
    let page = folder.join("manual.html");
    let made = dpana(&folder, &["verify", "--quick", "--page", "manual.html"]);
    assert_eq!(made.status.code(), Some(0), "{made:?}");
    let looks = "<script>const all = what => [...document.querySelectorAll(what)];\
        const wide = part => part.getBoundingClientRect().width > 200;\
        document.title = JSON.stringify([all('section').length, all('section svg').filter(wide).length,\
        all('section table').filter(wide).length, all('ol a').filter(a => document.querySelector(a.hash)).length]);\
        </script>";
    let text = fs::read_to_string(&page).unwrap();
    let drawn = text.matches("<svg").count();
    fs::write(&page, text + looks).unwrap();
    let shown = printed(&page);
    let expected = format!("<title>[14,{drawn},14,14]</title>");
    assert!(shown.contains(&expected), "{expected}: {}", &shown[..400]);
}
