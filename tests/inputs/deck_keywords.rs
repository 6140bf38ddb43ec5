//! What decks say beyond plain contact, each against an answer by hand: layers, surfaces held together,
//! pairs taken out and in, heat, directions of nodes, sectors, rigid groups, materials with directions.

use dpana::scene::{MeshSource, SceneFormulation, SceneLaw, SceneLoad};
use dpana::{Scene, solve, solve_steps};

use crate::decks::{SQUARES, assert_close, assert_squares, certified, instances, read, refused};
use crate::program::{dpana, folder};

/// The squares with their upper side moved down by 0.01, in place of the pressure: p = E / (1 − ν²) · 0.005.
fn moved() -> String {
    SQUARES
        .replace("14, 1\n", "14, 1\n13, 2, 2, -0.01\n14, 2, 2, -0.01\n")
        .replace("*DLOAD\n2, P3, 2.\n", "")
}

const PRESSED: f64 = 1000.0 / (1.0 - 0.0625) * 0.005;

/// What the first pair carries; the cut of a bolt would be the next one.
fn normal(text: &str) -> f64 {
    let totals = certified(&read(text)).report().unwrap().totals;
    totals.pairs[0].totals.normal.abs()
}

fn normals(text: &str) -> Vec<f64> {
    let mut found = Vec::new();
    let last = solve_steps(&read(text).scene, None, |solution| {
        found.push(solution.report()?.totals.pairs[0].totals.normal.abs());
        Ok(())
    });
    assert_eq!(last.unwrap().status(), dpana::Status::Certified);
    found
}

#[test]
fn a_soft_penalty_is_a_layer_in_series_with_the_bodies() {
    let law = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n2000.\n*FRICTION\n0.5, 500.";
    let deck = read(&SQUARES.replace("*FRICTION\n0.5", law));
    let compliance = deck.scene.contacts[0].compliance.unwrap();
    assert_eq!(
        [compliance.normal, compliance.tangential],
        [1.0 / 2000.0, 1.0 / 500.0]
    );
    for said in [
        "stiffness 2.000e3 is kept as that of a layer: 2.00 E / h",
        "stick slope 5.000e2 is kept",
    ] {
        assert!(
            deck.notes.iter().any(|note| note.contains(said)),
            "{:?}",
            deck.notes
        );
    }
    // p / K = 1e-3 on top of 3.75e-3 of the squares.
    let corner = certified(&deck)
        .displacement_near(1, [1.0, 2.0, 0.0])
        .unwrap();
    assert_close(corner[1], -4.75e-3, 1e-9);
}

#[test]
fn tied_surfaces_pull_and_a_tie_holds_what_is_near() {
    let pulled = SQUARES.replace("2, P3, 2.", "2, P3, -2.");
    let tied = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1.e6\n*FRICTION\n1., 1.e6";
    let by_law = pulled.replace("*FRICTION\n0.5", tied);
    let by_pair = pulled.replace("INTERACTION=I\nB", "INTERACTION=I, TIED\nB");
    let (start, rest) = pulled.split_once("*SURFACE INTERACTION").unwrap();
    let rest = rest.split_once("BOTTOM, TOP").unwrap().1;
    let by_tie = format!("{start}*TIE, NAME=T, POSITION TOLERANCE=0.03\nBOTTOM, TOP{rest}");
    let apart = by_tie
        .replace("11, 0, 1\n", "11, 0, 1.02\n")
        .replace("12, 1, 1\n", "12, 1, 1.02\n");
    for text in [by_law, by_pair, by_tie, apart.clone()] {
        let deck = read(&text);
        assert_eq!(deck.scene.contacts[0].law, Some(SceneLaw::Bonded));
        let corner = certified(&deck)
            .displacement_near(1, [1.0, 2.0, 0.0])
            .unwrap();
        assert_close(corner[1], 3.75e-3, 1e-9);
    }
    let said = refused(&apart.replace("=0.03", "=0.01"));
    assert!(
        said.contains("deck.inp:23: *TIE: no face of `BOTTOM` stands within 1.000e-2"),
        "{said}"
    );
    let loose = pulled.replace(
        "*FRICTION\n0.5",
        tied.split_once("*FRICTION").unwrap().0.trim(),
    );
    assert!(
        refused(&loose)
            .contains("*SURFACE BEHAVIOR: `TIED`: expected *FRICTION with a stick slope")
    );
    let no_separation = "*SURFACE BEHAVIOR, NO SEPARATION\n*FRICTION\n0.5";
    let deck = read(&pulled.replace("*FRICTION\n0.5", no_separation));
    assert_eq!(
        deck.scene.contacts[0].law,
        Some(SceneLaw::NoSeparation { friction: 0.5 })
    );
    let rough = read(&SQUARES.replace("*FRICTION\n0.5", "*FRICTION, ROUGH"));
    assert_eq!(rough.scene.contacts[0].law, Some(SceneLaw::Rough));
    assert_eq!(certified(&rough).report().unwrap().totals.slip, 0);
}

#[test]
fn a_pair_is_taken_out_and_in_and_may_stand_apart() {
    let text = moved();
    assert_close(normal(&text), PRESSED, 1e-9);
    let change = |what: &str| format!("*MODEL CHANGE, TYPE=CONTACT PAIR, {what}\nBOTTOM, TOP\n");
    let out = text.replace("0.1, 1.\n", &format!("0.1, 1.\n{}", change("REMOVE")));
    let steps = format!(
        "{out}*STEP\n*STATIC\n*END STEP\n*STEP\n*STATIC\n{}*END STEP\n",
        change("ADD")
    );
    let found = normals(&steps);
    assert_eq!(found[..2], [0.0, 0.0]);
    assert_close(found[2], PRESSED, 1e-9);
    assert!(refused(&out).contains("takes all pairs out"));
    assert!(
        refused(&out.replace("BOTTOM, TOP\n*END", "TOP, BOTTOM\n*END"))
            .contains("is no *CONTACT PAIR")
    );
    // 0.004 of the 0.01 closes the gap.
    let clear = text.replace(
        "*BOUNDARY",
        "*CLEARANCE, MASTER=TOP, SLAVE=BOTTOM, VALUE=0.004\n*BOUNDARY",
    );
    assert_close(normal(&clear), 0.6 * PRESSED, 1e-9);
    let apart = clear.replace("11, 0, 1\n", "11, 0, 1.01\n");
    assert!(refused(&apart).contains("*CLEARANCE: the surfaces are drawn up to 1.000e-2 apart"));
}

#[test]
fn heat_presses_what_cannot_expand() {
    // σ = E α ΔT / (1 − ν) in plane strain between fixed plates: 1000 · 1e-4 · 10 / 0.75.
    let heated = moved()
        .replace("-0.01", "0.")
        .replace("1000., 0.25", "1000., 0.25\n*EXPANSION, ZERO=20.\n1.e-4")
        .replace(
            "*ELEMENT, TYPE=CPE4, ELSET=UP",
            "*NSET, NSET=ALL, GENERATE\n1, 14\n*ELEMENT, TYPE=CPE4, ELSET=UP",
        )
        .replace(
            "*STEP",
            "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 293.\n*STEP",
        )
        .replace("*END STEP", "*TEMPERATURE\nALL, 300.\nALL, 303.\n*END STEP");
    assert_close(normal(&heated), 4.0 / 3.0, 1e-9);
    // Half of it on the way, nothing once it is cold again.
    let more = "*STEP\n*STATIC\n*TEMPERATURE\nALL, 298.\n*END STEP\n*STEP\n*STATIC\n*TEMPERATURE, OP=NEW\n*END STEP\n";
    let found = normals(&format!("{heated}{more}"));
    assert_close(found[1], 2.0 / 3.0, 1e-9);
    assert!(found[2].abs() < 1e-12, "{found:?}");
    let cold = heated.replace("*EXPANSION, ZERO=20.\n1.e-4\n", "");
    assert!(
        read(&cold)
            .notes
            .iter()
            .any(|note| note.contains("*TEMPERATURE is not needed here"))
    );
    let amplitude = "*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n*STEP";
    let scaled = heated
        .replace("*STEP", amplitude)
        .replace("*TEMPERATURE\n", "*TEMPERATURE, AMPLITUDE=A\n");
    assert!(refused(&scaled).contains("an amplitude of temperatures that do not begin at 0"));
}

#[test]
fn temperatures_of_nodes_are_written_beside_the_mesh_and_read_again() {
    let heated = moved()
        .replace("1000., 0.25", "1000., 0.25\n*EXPANSION\n1.e-4")
        .replace(
            "*END STEP",
            "*TEMPERATURE\n1, 10.\n2, 30.\n3, 20.\n11, 5.\n*END STEP",
        );
    let folder = folder("heated_deck");
    std::fs::write(folder.join("deck.inp"), &heated).unwrap();
    let run = dpana(&folder, &["import", "deck.inp", "--out", "scene.json"]);
    assert!(run.status.success(), "{run:?}");
    let scene = Scene::from_file(folder.join("scene.json")).unwrap();
    let [a, b] = [&scene, &read(&heated).scene].map(|scene| solve(scene).unwrap());
    let [x, y] = [&a, &b].map(|solution| solution.displacement_near(0, [1.0, 1.0, 0.0]).unwrap());
    assert!((x[0] - y[0]).abs() < 1e-14 && x[0] > 1e-4, "{x:?} {y:?}");
}

#[test]
fn supports_and_forces_stand_in_directions_of_their_nodes() {
    // y' = −x, then radial about a point beside each node.
    let held = SQUARES.replace("11, 1\n14, 1\n", "11, 2\n14, 2\n");
    let straight = "*TRANSFORM, NSET=S\n0., 1., 0., -1., 0., 0.\n*BOUNDARY";
    let sets = "*NSET, NSET=S\n11, 13, 14\n*NSET, NSET=A\n11\n*NSET, NSET=B\n14\n*MATERIAL";
    assert_squares(&read(
        &held
            .replace("*BOUNDARY", straight)
            .replace("*MATERIAL", sets),
    ));
    let around = "*TRANSFORM, NSET=A, TYPE=C\n-5., 1., 0., -5., 1., 1.\n\
        *TRANSFORM, NSET=B, TYPE=C\n-5., 2., 0., -5., 2., 1.\n*BOUNDARY";
    let text = SQUARES
        .replace("*BOUNDARY", around)
        .replace("*MATERIAL", sets);
    assert_squares(&read(&text));
    // x' = y of nodes 13 and 14: a pressure of 2 is a force of −1 at each.
    let forces = held
        .replace("*BOUNDARY", straight)
        .replace("*MATERIAL", sets)
        .replace("*DLOAD\n2, P3, 2.", "*CLOAD\n13, 1, -1.\n14, 1, -1.");
    assert_squares(&read(&forces));
    assert!(
        refused(&text.replace("-5., 1., 1.", "-5., 1., 0."))
            .contains("*TRANSFORM: the two points coincide")
    );
}

/// Two rings of a twelfth each, held together, under pressure from outside.
fn sector(sides: &str) -> String {
    let mut text = String::from("*NODE, NSET=N\n");
    let (radii, angles) = ([1.0, 1.5, 1.5, 2.0], [0.0, 10.0, 20.0, 30.0_f64]);
    for (ring, radius) in radii.into_iter().enumerate() {
        for (at, angle) in angles.into_iter().enumerate() {
            let (sine, cosine) = angle.to_radians().sin_cos();
            let label = 10 * (ring + 1) + at;
            text += &format!("{label}, {:.15}, {:.15}\n", radius * cosine, radius * sine);
        }
    }
    for (label, inner) in [(1, 10), (2, 30)] {
        text += &format!("*ELEMENT, TYPE=CPE4, ELSET=R{label}\n");
        for at in 0..3 {
            let [a, b] = [inner + at, inner + 10 + at];
            text += &format!("{label}{at}, {a}, {b}, {}, {}\n", b + 1, a + 1);
        }
    }
    text + "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.25\n*SOLID SECTION, ELSET=R1, MATERIAL=M\n\
        *SOLID SECTION, ELSET=R2, MATERIAL=M\n*SURFACE, NAME=OUT\nR1, S2\n*SURFACE, NAME=IN\nR2, S4\n\
        *SURFACE, NAME=FIRST\n10, S1\n20, S1\n*SURFACE, NAME=LAST\n12, S3\n22, S3\n\
        *TIE, NAME=RINGS\nIN, OUT\n"
        + sides
        + "*STEP\n*STATIC\n*DLOAD\nR2, P2, 0.1\n*END STEP\n"
}

#[test]
fn a_sector_that_repeats_is_a_sector_between_planes_of_symmetry() {
    let planes = sector(
        "*NSET, NSET=SIDES\n10, 20, 30, 40, 13, 23, 33, 43\n*TRANSFORM, NSET=N, TYPE=C\n0., 0., 0., 0., 0., 1.\n\
         *BOUNDARY\nSIDES, 2\n",
    );
    let repeated = sector(
        "*TRANSFORM, NSET=N, TYPE=C\n0., 0., 0., 0., 0., 1.\n*BOUNDARY\n11, 2\n31, 2\n\
         *TIE, NAME=T, CYCLIC SYMMETRY\nLAST, FIRST\n\
         *CYCLIC SYMMETRY MODEL, N=12, TIE=T, NGRAPH=1\n0., 0., 0., 0., 0., 1.\n",
    );
    let [a, b] = [&planes, &repeated].map(|text| certified(&read(text)));
    let [x, y] = [&a, &b].map(|s| s.displacement_near(1, [2.0, 0.0, 0.0]).unwrap());
    assert_close(y[0], x[0], 1e-9);
    assert!(y[0] < -1e-4 && y[1].abs() < 1e-12, "{y:?}");
    let eleven = repeated.replace("N=12", "N=11");
    assert!(
        refused(&eleven)
            .contains("*TIE: surfaces of `R1` that 32.727273° do not turn onto each other")
    );
    assert!(
        refused(&repeated.replace("N=12, TIE=T", "N=12, TIE=U"))
            .contains("expected a *CYCLIC SYMMETRY MODEL")
    );
}

#[test]
fn nodes_that_move_as_one_are_driven_at_their_reference_node() {
    // Without lateral strain (ν = 0): u_y = −2 · 2 / 1000.
    let text = SQUARES
        .replace("0.25", "0.")
        .replace(
            "14, 0, 2\n",
            "14, 0, 2\n98, 7, 7\n99, 0.5, 3\n*NSET, NSET=UPPER\n13, 14\n",
        )
        .replace("*DLOAD\n2, P3, 2.", "*CLOAD\n99, 2, -2.");
    let body = text.replace(
        "*BOUNDARY",
        "*RIGID BODY, NSET=UPPER, REF NODE=99, ROT NODE=98\n*BOUNDARY",
    );
    let surface = text
        .replace(
            "*SURFACE INTERACTION",
            "*SURFACE, NAME=LID\nUP, S3\n*SURFACE INTERACTION",
        )
        .replace(
            "*BOUNDARY",
            "*COUPLING, CONSTRAINT NAME=C, REF NODE=99, SURFACE=LID\n*KINEMATIC\n1, 2\n*BOUNDARY",
        );
    let driven = body.replace("*CLOAD\n99, 2, -2.", "*BOUNDARY\n99, 2, 2, -0.004\n98, 3");
    for text in [&body, &surface, &driven] {
        let solution = certified(&read(text));
        let corner = solution.displacement_near(1, [1.0, 2.0, 0.0]).unwrap();
        assert_close(corner[1], -4e-3, 1e-9);
        assert_close(solution.report().unwrap().totals.normal.abs(), 2.0, 1e-9);
    }
    for (from, to, said) in [
        (
            "\n1, 2\n",
            "\n1, 1\n",
            "*KINEMATIC: couples some directions only; expected 1 to 2",
        ),
        (
            "*KINEMATIC",
            "*DISTRIBUTING",
            "*DISTRIBUTING: is not read: a node that moves as the mean",
        ),
        (
            "*KINEMATIC\n1, 2\n",
            "",
            "*COUPLING: expected *KINEMATIC right after",
        ),
    ] {
        let said_is = refused(&surface.replace(from, to));
        assert!(said_is.contains(said), "{said_is}");
    }
    let apart = body.replace("UPPER\n13, 14", "UPPER\n1, 14");
    assert!(refused(&apart).contains("*RIGID BODY: expected nodes of one connected part"));
}

#[test]
fn materials_have_directions_of_their_own() {
    // Axis 1, of 1000, points along y; axis 2 is half as stiff: u_y = −2 · 2 / 1000.
    let constants = "1000., 500., 700., 0., 0., 0., 400., 400.\n300.";
    let text = SQUARES
        .replace(
            "*ELASTIC\n1000., 0.25",
            &format!("*ELASTIC, TYPE=ENGINEERING CONSTANTS\n{constants}"),
        )
        .replace("MATERIAL=M\n", "MATERIAL=M, ORIENTATION=O\n")
        .replace(
            "*SURFACE INTERACTION",
            "*ORIENTATION, NAME=O\n0., 1., 0., -1., 0., 0.\n*SURFACE INTERACTION",
        );
    // D of a diagonal compliance is diagonal.
    let stiffness = "1000., 0., 500., 0., 0., 700., 400., 400.\n300.";
    let by_stiffness = text
        .replace("ENGINEERING CONSTANTS", "ORTHO")
        .replace(constants, stiffness);
    let along_line = text.replace(
        "O\n0., 1., 0., -1., 0., 0.",
        "O, SYSTEM=CYLINDRICAL\n0.5, -1.e6, 0., 0.5, -1.e6, 1.",
    );
    for (text, precision) in [(&text, 1e-9), (&by_stiffness, 1e-9), (&along_line, 1e-6)] {
        let corner = certified(&read(text))
            .displacement_near(1, [1.0, 2.0, 0.0])
            .unwrap();
        assert_close(corner[1], -4e-3, precision);
    }
    let unknown = text.replace("ORIENTATION=O\n", "ORIENTATION=Q\n");
    assert!(refused(&unknown).contains("*SOLID SECTION: orientation `Q` is not known"));
    let short = text.replace(", 400.\n300.", "\n300.");
    assert!(
        refused(&short).contains("*ELASTIC: `` is no finite number; expected an elastic constant")
    );
}

#[test]
fn directions_of_a_part_turn_with_each_of_its_instances() {
    // The upper square lies on its side: its axis 2, half as stiff, is along x, that of the lower one along y.
    let oriented = instances()
        .replace(
            "*ELASTIC\n1000., 0.25",
            "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1000., 500., 700., 0., 0., 0., 400., 400.\n300.",
        )
        .replace(
            "*SOLID SECTION, ELSET=CELL",
            "*ORIENTATION, NAME=O\n1., 0., 0., 0., 1., 0.\n*SOLID SECTION, ORIENTATION=O, ELSET=CELL",
        );
    let corner = certified(&read(&oriented))
        .displacement_near(1, [1.0, 2.0, 0.0])
        .unwrap();
    assert_close(corner[1], -2.0 / 500.0 - 2.0 / 1000.0, 1e-9);
    // Axis 1 of the nodes is y of the part, and x of the model where the part lies on its side.
    let transformed = instances()
        .replace(
            "*SOLID",
            "*TRANSFORM, NSET=SIDE\n0., 1., 0., -1., 0., 0.\n*SOLID",
        )
        .replace("LOW.SIDE, 1\nLOW.1, 2\n", "LOW.SIDE, 2\nLOW.1, 1\n");
    assert_squares(&read(&transformed));
}

#[test]
fn spin_delays_and_letters_of_elements_reach_the_scene() {
    let text = SQUARES
        .replace("1000., 0.25", "1000., 0.25\n*DENSITY\n3.")
        .replace("CPE4, ELSET=UP", "CPE4I, ELSET=UP")
        .replace("2, P3, 2.", "UP, CENTRIF, 25., 0.5, 2., 0., 0., 0., 1.");
    let deck = read(&text);
    let up = &deck.scene.bodies[1];
    assert_eq!(up.formulation, SceneFormulation::IncompatibleModes);
    assert_eq!(deck.scene.bodies[0].formulation, SceneFormulation::Standard);
    assert_eq!(up.materials[0].density, 3.0);
    let SceneLoad::Centrifugal { centrifugal, .. } = &up.loads[0] else {
        unreachable!("{:?}", up.loads)
    };
    assert_eq!(
        (centrifugal.speed, centrifugal.point.as_deref()),
        (5.0, Some(&[0.5, 2.0][..]))
    );
    // ρ ω² times the distance 0.5 of the centre from the axis.
    assert_close(normal(&text), 3.0 * 25.0 * 0.5, 1e-9);
    let delayed = SQUARES
        .replace(
            "*STEP",
            "*AMPLITUDE, NAME=A\n0., 0., 0.25, 2.,\n0.5, 0.5\n*STEP",
        )
        .replace("*DLOAD", "*DLOAD, AMPLITUDE=A, TIME DELAY=0.25");
    assert_eq!(
        read(&delayed).scene.steps.unwrap().at,
        [0.25, 0.5, 0.75, 1.0]
    );
    let MeshSource::Given(mesh) = &up.mesh else {
        unreachable!("meshes of decks are in memory")
    };
    assert_eq!(mesh.nodes.len(), 4);
}

/// Every keyword gone wrong, in place of the line `*BOUNDARY` before the first step or `*END STEP`.
/// The squares between a floor and a ceiling; the lower one of two elements, with a section between them.
fn clamped(vector: &str, section: &str, steps: &str) -> String {
    let cut = format!(
        "*NODE\n99, 7, 7\n*SURFACE, NAME=CUT\n1, S3\n*PRE-TENSION SECTION, SURFACE=CUT, NODE=99\n{vector}"
    );
    let (model, _) = SQUARES.split_once("*STEP").unwrap();
    let model = model
        .replace("1, 1, 2, 3, 4\n", "1, 1, 2, 6, 5\n3, 5, 6, 3, 4\n")
        .replace("3, 1, 1\n4", "3, 1, 1\n5, 0, 0.5\n6, 1, 0.5\n4")
        .replace("LOW, S3", "3, S3")
        .replace("MATERIAL=M\n", &format!("MATERIAL=M\n{section}"))
        .replace("14, 1\n", "14, 1, 2\n13, 2\n")
        .replace("*BOUNDARY", &format!("{cut}*BOUNDARY"));
    format!("{model}{steps}")
}

#[test]
fn a_section_of_a_bolt_carries_its_force_or_is_shortened_and_stays_locked() {
    // Between floor and ceiling the column is pressed by what the section pushes: F, or E' s / 2 for a lengthening s.
    let step = |what: &str| format!("*STEP\n*STATIC\n{what}*END STEP\n");
    let modulus = 1000.0 / (1.0 - 0.0625);
    for (vector, section, load, expected) in [
        ("", "", "*CLOAD\n99, 1, -3.\n", 3.0),
        ("0., 2., 0.\n", "", "*CLOAD\n99, 1, -3.\n", 3.0),
        ("0., -1., 0.\n", "", "*CLOAD\n99, 1, 3.\n", 3.0),
        ("", "2.\n", "*CLOAD\n99, 1, -3.\n", 1.5),
        ("", "", "*BOUNDARY\n99, 1, 1, -0.01\n", 0.005 * modulus),
        ("", "", "*BOUNDARY\n99, 1, 6, -0.01\n", 0.005 * modulus),
        (
            "0., -1., 0.\n",
            "",
            "*BOUNDARY\n99, 1, 1, 0.01\n",
            0.005 * modulus,
        ),
    ] {
        let found = normal(&clamped(vector, section, &step(load)));
        assert_close(found, expected, 1e-9);
    }
    // Locked at 3, then the ceiling comes down.
    let down =
        "*BOUNDARY, FIXED\n99, 1, 1\n*CLOAD, OP=NEW\n*BOUNDARY\n13, 2, 2, -0.01\n14, 2, 2, -0.01\n";
    let text = clamped("", "", &(step("*CLOAD\n99, 1, -3.\n") + &step(down)));
    let found = normals(&text);
    assert_close(found[0], 3.0, 1e-9);
    assert_close(found[1], 3.0 + 0.005 * modulus, 1e-9);
    // Not locked, the section gives way.
    let found = normals(&text.replace("*BOUNDARY, FIXED\n99, 1, 1\n*CLOAD, OP=NEW\n", ""));
    assert_close(found[1], 3.0, 1e-9);

    let said = refused(&clamped("1., 1., 0.\n", "", &step("")));
    assert!(
        said.contains("*PRE-TENSION SECTION: the vector [1.0, 1.0, 0.0] aside"),
        "{said}"
    );
    let said = refused(&clamped("", "", &step("*BOUNDARY, FIXED\n99, 1, 1\n")));
    assert!(
        said.contains("*PRE-TENSION SECTION: `FIXED` in the first step"),
        "{said}"
    );
}

#[test]
fn keywords_gone_wrong_are_refused_by_line_and_name() {
    let mut missed = Vec::new();
    for (stated, said) in [
        (
            "*SOLID SECTION, ELSET=UP, MATERIAL=M\n3.\n",
            ":28: *SOLID SECTION: element 2 is in another section before",
        ),
        ("*ELASTIC\n5., 0.\n", ":28: *ELASTIC: twice in material `M`"),
        (
            "*SURFACE INTERACTION, NAME=I\n",
            ":28: *SURFACE INTERACTION: surface interaction `I` once more",
        ),
        (
            "*TRANSFORM, NSET=S, TYPE=S\n0., 0., 0., 1., 0., 0.\n",
            ":28: *TRANSFORM: `TYPE=S` is not read",
        ),
        (
            "*TRANSFORM, NSET=NONE\n1., 0., 0., 0., 1., 0.\n",
            ":28: *TRANSFORM: `NONE` is no node and no set",
        ),
        (
            "*TRANSFORM, NSET=1\n1., 0., 0., 2., 0., 0.\n",
            ":29: *TRANSFORM: two points on one line",
        ),
        (
            "*TRANSFORM, NSET=1\n1., inf, 0., 2., 0., 0.\n",
            ":29: *TRANSFORM: `inf` is no finite number",
        ),
        (
            "*CLEARANCE, MASTER=TOP, SLAVE=BOTTOM\n",
            ":28: *CLEARANCE: expected `VALUE=`",
        ),
        (
            "*CLEARANCE, MASTER=TOP, SLAVE=BOTTOM, VALUE=1e999\n",
            ":28: *CLEARANCE: `1E999` is no finite",
        ),
        (
            "*CLEARANCE, MASTER=BOTTOM, SLAVE=TOP, VALUE=1\n",
            ":28: *CLEARANCE: `TOP`, `BOTTOM` is no *CONTACT PAIR",
        ),
        (
            "*TIE, NAME=T, POSITION TOLERANCE=-1\nBOTTOM, TOP\n",
            ":28: *TIE: `POSITION TOLERANCE=-1`; expected",
        ),
        (
            "*TIE, NAME=T\nBOTTOM\n",
            ":29: *TIE: expected slave and master surface",
        ),
        (
            "*TIE, NAME=T, MULTISTAGE\nBOTTOM, TOP\n",
            ":28: *TIE: parameter `MULTISTAGE` is not read",
        ),
        (
            "*TIE, NAME=T, CYCLIC SYMMETRY\nBOTTOM, TOP\n",
            ":28: *TIE: expected a *CYCLIC SYMMETRY MODEL",
        ),
        (
            "*TIE, NAME=T, CYCLIC SYMMETRY\nBOTTOM, TOP\n*CYCLIC SYMMETRY MODEL, N=0\n0., 0., 0., 0., 0., 1.\n",
            ":30: *CYCLIC SYMMETRY MODEL: `0` is no number of sectors",
        ),
        (
            "*TIE, NAME=T, CYCLIC SYMMETRY\nBOTTOM, TOP\n*CYCLIC SYMMETRY MODEL, N=4\n0., 0., 0., 0., 1., 0.\n",
            ":31: *CYCLIC SYMMETRY MODEL: an axis in the plane of the elements",
        ),
        (
            "*RIGID BODY, NSET=1\n",
            ":28: *RIGID BODY: expected `REFNODE=`",
        ),
        (
            "*RIGID BODY, REF NODE=1\n",
            ":28: *RIGID BODY: expected one of `NSET=` and `ELSET=`",
        ),
        (
            "*RIGID BODY, ELSET=UP, REF NODE=77\n",
            ":28: *RIGID BODY: node 77 is not in the deck",
        ),
        (
            "*RIGID BODY, ELSET=UP, ANALYTICAL SURFACE=A\n",
            ":28: *RIGID BODY: parameter `ANALYTICALSURFACE`",
        ),
        (
            "*KINEMATIC\n1, 3\n",
            ":28: *KINEMATIC: expected *COUPLING right before",
        ),
        (
            "*COUPLING, SURFACE=NO, REF NODE=1\n*KINEMATIC\n1, 2\n",
            ":28: *COUPLING: surface `NO` is not known",
        ),
        (
            "*INITIAL CONDITIONS, TYPE=STRESS\nUP, 1.\n",
            ":28: *INITIAL CONDITIONS: `TYPE=STRESS` is not read",
        ),
        (
            "*INITIAL CONDITIONS, TYPE=TEMPERATURE\n1\n",
            ":29: *INITIAL CONDITIONS: `` is no finite number",
        ),
        (
            "*ORIENTATION, NAME=O, SYSTEM=SPHERICAL\n1., 2.\n",
            ":28: *ORIENTATION: `SYSTEM=SPHERICAL` is not read",
        ),
        (
            "*ORIENTATION, NAME=O\n1., 0., 0., 0., 1., 0.\n3, 30.\n",
            ":30: *ORIENTATION: a rotation is not read",
        ),
        (
            "*EXPANSION\n1., 20.\n2., 30.\n",
            ":30: *EXPANSION: one line too many",
        ),
        (
            "*ELASTIC, TYPE=ORTHO\n1., 2., 1., 0., 0., 1., 1., 1.\n1.\n",
            ":28: *ELASTIC: a stiffness that is not positive",
        ),
        (
            "*ELASTIC, TYPE=ANISOTROPIC\n1.\n",
            ":28: *ELASTIC: `TYPE=ANISOTROPIC` is not read",
        ),
        (
            "*MODEL CHANGE, TYPE=CONTACT PAIR, ADD\nBOTTOM, TOP\n",
            ":28: *MODEL CHANGE: before the first step",
        ),
        (
            "*PRE-TENSION SECTION, ELEMENT=1, NODE=1\n",
            ":28: *PRE-TENSION SECTION: `ELEMENT=` is not read: beams",
        ),
        (
            "*PRE-TENSION SECTION, NODE=1\n",
            ":28: *PRE-TENSION SECTION: expected `SURFACE=`",
        ),
        (
            "*PRE-TENSION SECTION, SURFACE=CUT, NODE=1\n",
            ":28: *PRE-TENSION SECTION: surface `CUT` is not known",
        ),
        (
            "*SURFACE, NAME=CUT\n2, S3\n*PRE-TENSION SECTION, SURFACE=CUT, NODE=1\n",
            ":30: *PRE-TENSION SECTION: a reference node of elements",
        ),
        (
            "*SURFACE, NAME=CUT\n2, S3\n*NODE\n99, 0, 0\n*PRE-TENSION SECTION, SURFACE=CUT, NODE=99\n",
            ":32: *PRE-TENSION SECTION: is not read: bolt 0.point: a plane that all cells lie on one side of",
        ),
        (
            "*SURFACE, NAME=CUT\n2\n*PRE-TENSION SECTION, SURFACE=CUT, NODE=99\n",
            ":29: *SURFACE: a section of a bolt by elements; expected their faces",
        ),
        (
            "*SURFACE, NAME=CUT, TYPE=NODE\n1\n*PRE-TENSION SECTION, SURFACE=CUT, NODE=99\n",
            ":28: *SURFACE: a section of a bolt by nodes; expected one by faces",
        ),
        (
            "*BOUNDARY, FIXED\n13, 1, 1\n",
            ":29: *BOUNDARY: `FIXED` is read of nodes of *PRE-TENSION SECTION only",
        ),
        (
            "*GAP, ELSET=UP\n1.\n",
            ":28: *GAP: is not read: gap elements",
        ),
    ] {
        let text = SQUARES.replacen("*BOUNDARY", &format!("{stated}*BOUNDARY"), 1);
        let error = refused(&text);
        if !error.contains(&format!("deck.inp{said}")) {
            missed.push(format!("{said}\n  but {error}"));
        }
    }
    for (stated, said) in [
        (
            "*MODEL CHANGE, TYPE=CONTACT PAIR\nBOTTOM, TOP\n",
            ":38: *MODEL CHANGE: expected one of `REMOVE` and `ADD`",
        ),
        (
            "*MODEL CHANGE, TYPE=ELEMENT, REMOVE\nUP\n",
            ":38: *MODEL CHANGE: `TYPE=ELEMENT` is not read",
        ),
        (
            "*MODEL CHANGE, REMOVE\nUP\n",
            ":38: *MODEL CHANGE: expected `TYPE=`",
        ),
        (
            "*CLOAD, TIME DELAY=1\n13, 2, 1.\n",
            ":38: *CLOAD: `TIME DELAY` without an `AMPLITUDE`",
        ),
        (
            "*TEMPERATURE, FILE=a.frd\n",
            ":38: *TEMPERATURE: parameter `FILE` is not read",
        ),
        (
            "*DLOAD\nUP, CENTRIF, 1., 0., 0., 0., 1., 0., 0.\n",
            ":39: *DLOAD: another axis; expected an axis along z",
        ),
        (
            "*DLOAD\nUP, CENTRIF, 1., 0., 0., 0., 0., 0., 1.\n",
            ":39: *DLOAD: material `M` has no *DENSITY",
        ),
        (
            "*TIE, NAME=T\nBOTTOM, TOP\n",
            ":38: *TIE: inside a step; expected it before",
        ),
    ] {
        let text = SQUARES.replace("*END STEP", &format!("{stated}*END STEP"));
        let error = refused(&text);
        if !error.contains(&format!("deck.inp{said}")) {
            missed.push(format!("{said}\n  but {error}"));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}
