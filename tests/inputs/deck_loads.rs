//! What loads of decks act with, step by step: what is restated, and nothing else, takes another value.

use dpana::solve_steps;

use crate::decks::{SQUARES, assert_close, assert_squares, certified, read, refused};

/// The squares with a density of 3 and these loads.
fn squares(model: &str, steps: &str) -> String {
    let (start, _) = SQUARES.split_once("*STEP").unwrap();
    let start = start.replace("1000., 0.25", "1000., 0.25\n*DENSITY\n3.");
    let start = start.replace("*BOUNDARY", &format!("{model}*BOUNDARY"));
    let step = |loads: &str| format!("*STEP\n*STATIC\n{loads}*END STEP\n");
    start + &steps.split("--\n").map(step).collect::<String>()
}

/// What the loads on a body add up to at every instant.
fn loads(text: &str, body: usize) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    let last = solve_steps(&read(text).scene, None, |solution| {
        let force = &solution.report()?.certificate.bodies[body].loads.force;
        found.push([force[0], force[1]]);
        Ok(())
    });
    assert_eq!(last.unwrap().status(), dpana::Status::Certified);
    found
}

fn assert_loads(text: &str, body: usize, expected: &[[f64; 2]]) {
    let found = loads(text, body);
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        let apart = f64::hypot(found[0] - expected[0], found[1] - expected[1]);
        assert!(apart < 1e-9, "{found:?} for {expected:?}");
    }
}

const PRESSED: &str = "*DLOAD\n2, P3, 2.\n";

#[test]
fn each_type_of_load_is_restated_by_itself() {
    // BX of 0.4, ρ g = 0.3, which turns from x to −y as one vector.
    let step = "*DLOAD\n1, GRAV, 0.1, 1., 0.\n1, BX, 0.4\n";
    let text = format!(
        "{PRESSED}{step}--\n*DLOAD\n1, BX, 0.4\n--\n*DLOAD\n1, GRAV, 0.1, 0., -1.\n--\n*DLOAD\n1, BY, 0.1\n"
    );
    let expected = [[0.7, 0.0], [0.7, 0.0], [0.4, -0.3], [0.4, -0.2]];
    assert_loads(&squares("", &text), 0, &expected);
    // Two of one type in one step add up, whatever their histories where they do not meet.
    let both = format!(
        "{PRESSED}*DLOAD\n1, GRAV, 0.1, 1., 0.\n*DLOAD, AMPLITUDE=A\n1, GRAV, 0.1, 0., -1.\n"
    );
    let amplitude = "*AMPLITUDE, NAME=A\n0., 0., 1., 2.\n";
    assert_loads(&squares(amplitude, &both), 0, &[[0.3, -0.6]]);
    // By faces of elements 2, by a surface 1.
    let lid = "*SURFACE, NAME=LID\nUP, S3\n";
    let text = format!("{PRESSED}*DSLOAD\nLID, P, 1.\n--\n*DSLOAD\nLID, P, 1.\n--\n{PRESSED}");
    assert_loads(&squares(lid, &text), 1, &[[0.0, -3.0]; 3]);
    // m ω² r: another axis takes the place of the one before.
    let text = format!(
        "{PRESSED}*DLOAD\n1, CENTRIF, 1., 0.5, 2., 0., 0., 0., 1.\n--\n*DLOAD\n1, CENTRIF, 1., 0.5, 1., 0., 0., 0., 1.\n"
    );
    assert_loads(&squares("", &text), 0, &[[0.0, -4.5], [0.0, -1.5]]);
}

#[test]
fn loads_of_one_step_add_up_each_with_its_own_amplitude() {
    let model = "*AMPLITUDE, NAME=A\n0., 0., 1., 2.\n*AMPLITUDE, NAME=N\n0., 0., 1., -1.\n";
    let text = format!(
        "{PRESSED}*CLOAD, AMPLITUDE=A\n13, 1, 0.1\n*CLOAD, AMPLITUDE=N\n13, 1, 0.3\n*CLOAD\n13, 1, 0.2\n--\n\
         *CLOAD\n13, 1, 0.4\n--\n*CLOAD, OP=NEW\n14, 2, -0.1\n"
    );
    assert_loads(
        &squares(model, &text),
        1,
        &[[0.1, -2.0], [0.4, -2.0], [0.0, -2.1]],
    );
    // Restated with and without an amplitude, whichever card comes first: at once, also within the step.
    let model_of_two =
        "*AMPLITUDE, NAME=A\n0., 0., 1., 2.\n*AMPLITUDE, NAME=T\n0., 0., 0.5, 0.5, 1., 1.\n";
    let cards = ["*CLOAD, AMPLITUDE=T\n13, 1, 0.1\n", "*CLOAD\n13, 1, 0.2\n"];
    for [first, second] in [[0, 1], [1, 0]].map(|order| order.map(|card| cards[card])) {
        let text = format!("{PRESSED}*CLOAD, AMPLITUDE=A\n13, 1, 0.4\n--\n{first}{second}");
        let expected = [[0.8, -2.0], [0.15, -2.0], [0.3, -2.0]];
        assert_loads(&squares(model_of_two, &text), 1, &expected);
    }
    // m ω² r of 4.5 down and, from another axis, of 4.5 to the right; both at once and again, then the other way.
    let both = |amplitude: &str| {
        format!(
            "*DLOAD{amplitude}\n1, CENTRIF, 1., 0.5, 2., 0., 0., 0., 1.\n1, CENTRIF, 1., -1., 0.5, 0., 0., 0., 1.\n"
        )
    };
    let text = format!(
        "{PRESSED}{}--\n{}",
        both(", AMPLITUDE=N"),
        both(", AMPLITUDE=A")
    );
    let text = squares(model, &text).replace("1., 2.\n", "1., 1.\n");
    assert_loads(&text, 0, &[[-4.5, 4.5], [4.5, -4.5]]);
    let only = format!("{PRESSED}{}", both(", AMPLITUDE=N"));
    assert_loads(&squares(model, &only), 0, &[[-4.5, 4.5]]);
}

#[test]
fn what_ends_loads_of_another_keyword_is_noted() {
    let lid = "*SURFACE, NAME=LID\nUP, S3\n";
    let text = format!("{PRESSED}*DSLOAD\nLID, P, 1.\n--\n*DLOAD, OP=NEW\n2, P3, 2.\n");
    let text = squares(lid, &text);
    assert_loads(&text, 1, &[[0.0, -3.0], [0.0, -2.0]]);
    let noted = |text: &str| {
        read(text)
            .notes
            .iter()
            .any(|note| note.contains("which CalculiX keeps in one list"))
    };
    assert!(noted(&text));
    assert!(!noted(&text.replace("*DSLOAD\nLID, P, 1.\n", "")));
}

#[test]
fn a_force_along_an_axis_of_its_node_is_restated_by_itself() {
    // 0.1 (0.6, 0.8) + 0.2 (−0.8, 0.6) = (−0.1, 0.2).
    let axes =
        "*TRANSFORM, NSET=13\n0.6, 0.8, 0., -0.8, 0.6, 0.\n*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n";
    let text = format!("{PRESSED}*CLOAD\n13, 1, 0.1\n13, 2, 0.2\n--\n*CLOAD\n13, 1, 0.1\n");
    assert_loads(&squares(axes, &text), 1, &[[-0.1, -1.8]; 2]);
    let text = format!("{PRESSED}*CLOAD, AMPLITUDE=A\n13, 1, 0.1\n*CLOAD\n13, 2, 0.2\n");
    assert_loads(&squares(axes, &text), 1, &[[-0.1, -1.8]]);
}

#[test]
fn a_reference_node_has_directions_of_its_own() {
    // Without lateral strain (ν = 0): u_y = −2 · 2 / 1000.
    let (start, _) = SQUARES.split_once("*STEP").unwrap();
    let start = start
        .replace("0.25", "0.")
        .replace("14, 0, 2\n", "14, 0, 2\n98, 7, 7\n99, 0.5, 3\n*NSET, NSET=UPPER\n13, 14\n")
        .replace(
            "*BOUNDARY",
            "*RIGID BODY, NSET=UPPER, REF NODE=99, ROT NODE=98\n*TRANSFORM, NSET=99\nAXES\n*BOUNDARY",
        );
    let stated = |axes: &str, what: &str| {
        let start = start.replace("AXES", axes);
        format!("{start}*STEP\n*STATIC\n{what}*END STEP\n")
    };
    let upright = "0., 1., 0., -1., 0., 0.";
    let aslant = "0.6, 0.8, 0., -0.8, 0.6, 0.";
    for (axes, what) in [
        (upright, "*CLOAD\n99, 1, -2.\n"),
        (upright, "*BOUNDARY\n99, 1, 1, -0.004\n98, 3\n"),
        (aslant, "*CLOAD\n99, 1, -1.6\n99, 2, -1.2\n"),
        (
            aslant,
            "*BOUNDARY\n99, 1, 1, -0.0032\n99, 2, 2, -0.0024\n98, 3\n",
        ),
    ] {
        let solution = certified(&read(&stated(axes, what)));
        let corner = solution.displacement_near(1, [1.0, 2.0, 0.0]).unwrap();
        assert_close(corner[1], -4e-3, 1e-9);
        assert_close(solution.report().unwrap().totals.normal.abs(), 2.0, 1e-9);
    }
    let said = refused(&stated(aslant, "*BOUNDARY\n99, 1, 1, -0.004\n"));
    assert!(
        said.contains("*RIGID BODY: its reference node is held along axes of a *TRANSFORM"),
        "{said}"
    );
}

#[test]
fn a_load_without_a_set_acts_on_the_whole_model() {
    let text = format!("{PRESSED}*DLOAD\n, GRAV, 0.1, 0., -1.\n, BY, -0.2\n");
    assert_loads(&squares("", &text), 0, &[[0.0, -0.5]]);
    assert_loads(&squares("", &text), 1, &[[0.0, -2.5]]);
    // What has no density has no weight.
    let light = squares("*MATERIAL, NAME=L\n*ELASTIC\n1000., 0.25\n", &text)
        .replace("ELSET=UP, MATERIAL=M", "ELSET=UP, MATERIAL=L");
    assert_loads(&light, 1, &[[0.0, -2.2]]);
    let note = "*DLOAD elements without *DENSITY are left out";
    assert!(read(&light).notes.iter().any(|said| said.contains(note)));
    let said = refused(&SQUARES.replace("2, P3, 2.", ", P3, 2."));
    assert!(
        said.contains("*DLOAD: `` is no element and no set of them"),
        "{said}"
    );
}

#[test]
fn parameters_that_steer_a_method_are_noted_and_left() {
    let more = ", TRACKING=STATE, NO THICKNESS, EXTENSION ZONE=0.1, SMOOTH=0.2, GEOMETRIC CORRECTION=G, \
        MECHANICAL CONSTRAINT=PENALTY, CPSET=X";
    let text = SQUARES
        .replace("INTERACTION=I\nB", &format!("INTERACTION=I{more}\nB"))
        .replace("*STEP", "*STEP, CONVERT SDI=NO, SOLVER=DIRECT");
    let deck = read(&text);
    for said in [
        "deck.inp:26: *CONTACT PAIR `TRACKING` is not needed here",
        "*CONTACT PAIR `SMOOTH`",
        "*STEP `CONVERTSDI`",
    ] {
        assert!(
            deck.notes.iter().any(|note| note.contains(said)),
            "{said}: {:?}",
            deck.notes
        );
    }
    assert_squares(&deck);
    let (start, rest) = SQUARES.split_once("*SURFACE INTERACTION").unwrap();
    let rest = rest.split_once("BOTTOM, TOP").unwrap().1;
    assert_squares(&read(&format!(
        "{start}*TIE, NAME=T, NO ROTATION, NO THICKNESS\nBOTTOM, TOP{rest}"
    )));
    let said = refused(&SQUARES.replace("BOTTOM, TOP", "TOP, TOP"));
    assert!(
        said.contains(
            "deck.inp:27: *CONTACT PAIR: expected slave and master surface; one that touches itself"
        ),
        "{said}"
    );
}

#[test]
fn friction_that_is_capped_gives_no_more_than_its_cap() {
    // Pressed by 2 and dragged: μ p = 1, the cap is 0.3.
    let text = SQUARES.replace("11, 1\n14, 1\n", "11, 1, 1, 0.1\n14, 1, 1, 0.1\n");
    let dragged = |text: &str| certified(&read(text)).report().unwrap().totals.friction[0].abs();
    assert_close(dragged(&text), 1.0, 1e-9);
    let capped = text.replace("*FRICTION\n", "*FRICTION, TAUMAX=0.3\n");
    assert_close(dragged(&capped), 0.3, 1e-9);
    for (found, expected) in [
        ("TAUMAX=0.", "`TAUMAX=0`; expected one above 0"),
        ("ROUGH, TAUMAX=0.3", "`TAUMAX` beside `ROUGH` is not read"),
    ] {
        let said = refused(&capped.replace("TAUMAX=0.3", found));
        assert!(said.contains(&format!("*FRICTION: {expected}")), "{said}");
    }
}

#[test]
fn what_neither_parts_nor_slips_is_one() {
    let text = SQUARES.replace("11, 1\n14, 1\n", "11, 1, 1, 0.1\n14, 1, 1, 0.1\n");
    let shear = |law: &str| {
        let text = text.replace("*FRICTION\n0.5\n", law);
        certified(&read(&text)).report().unwrap().totals.friction[0]
    };
    let held = shear("*SURFACE BEHAVIOR, NO SEPARATION\n*FRICTION, ROUGH\n");
    assert_close(
        held,
        shear("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1.E9\n*FRICTION\n0.5, 1.E9\n"),
        1e-9,
    );
    assert!(held.abs() > 10.0);
}

#[test]
fn elements_with_a_node_twice_are_the_simpler_cells_that_they_are() {
    let text = SQUARES
        .replace(
            "2, 11, 12, 13, 14\n",
            "2, 11, 12, 13, 13\n3, 11, 13, 14, 14\n",
        )
        .replace("UP, S1", "2, S1")
        .replace("2, P3, 2.", "3, P2, 2.");
    assert_squares(&read(&text));
    for (from, to, said) in [
        (
            "3, P2",
            "3, P3",
            ":38: *DLOAD: face P3 of element 3 is folded up",
        ),
        (
            "3, P2",
            "3, P5",
            ":38: *DLOAD: `P5` is no face of element 3; expected P1 to P4",
        ),
        (
            "12, 13, 13\n",
            "12, 11, 13\n",
            ":13: *ELEMENT: element 2 has node 11 twice; expected",
        ),
        (
            "12, 13, 13\n",
            "13, 12, 12\n",
            ":13: *ELEMENT: element 2 runs clockwise; expected",
        ),
    ] {
        let error = refused(&text.replace(from, to));
        assert!(error.contains(&format!("deck.inp{said}")), "{error}");
    }
}
