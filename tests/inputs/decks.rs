//! Abaqus and CalculiX decks: answers known in closed form, the ways in which decks are written, and
//! what is refused.

use std::fs;
use std::path::Path;

use dpana::deck::Deck;
use dpana::scene::{MeshSource, SceneLoad};
use dpana::{Error, Scene, Solution, Status, solve, solve_steps};

use proptest::prelude::*;

use crate::program::{dpana, folder};

/// Two unit squares in plane strain, E = 1000, ν = 0.25, the upper one pressed by 2.
pub(crate) const SQUARES: &str = "*NODE
1, 0, 0
2, 1, 0
3, 1, 1
4, 0, 1
11, 0, 1
12, 1, 1
13, 1, 2
14, 0, 2
*ELEMENT, TYPE=CPE4, ELSET=LOW
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPE4, ELSET=UP
2, 11, 12, 13, 14
*MATERIAL, NAME=M
*ELASTIC
1000., 0.25
*SOLID SECTION, ELSET=LOW, MATERIAL=M
*SOLID SECTION, ELSET=UP, MATERIAL=M
*SURFACE, NAME=TOP
LOW, S3
*SURFACE, NAME=BOTTOM
UP, S1
*SURFACE INTERACTION, NAME=I
*FRICTION
0.5
*CONTACT PAIR, INTERACTION=I
BOTTOM, TOP
*BOUNDARY
1, 1, 2
2, 2
11, 1
14, 1
*STEP
*STATIC
0.1, 1.
*DLOAD
2, P3, 2.
*END STEP
";

fn no_file(name: &str) -> Result<Vec<u8>, Error> {
    unreachable!("{name} is not included")
}

pub(crate) fn read(text: &str) -> Deck {
    Deck::parse(text.as_bytes(), "deck.inp", &no_file).unwrap()
}

pub(crate) fn refused(text: &str) -> String {
    let error = Deck::parse(text.as_bytes(), "deck.inp", &no_file);
    error.unwrap_err().to_string()
}

/// A deck of `tests/data/decks`, solved and certified.
fn solved(name: &str) -> Solution {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data/decks")
        .join(name);
    certified(&Deck::from_file(file).unwrap())
}

pub(crate) fn certified(deck: &Deck) -> Solution {
    let solution = solve(&deck.scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    solution
}

pub(crate) fn assert_close(found: f64, expected: f64, relative: f64) {
    let apart = (found - expected).abs();
    assert!(apart <= relative * expected.abs(), "{found} for {expected}");
}

/// The two squares under p = 2: u_y = −2 p (1 − ν²) / E on top, u_x = p ν (1 + ν) / E at the side.
pub(crate) fn assert_squares(deck: &Deck) {
    let solution = certified(deck);
    let corner = solution.displacement_near(1, [1.0, 2.0, 0.0]).unwrap();
    assert_close(corner[1], -3.75e-3, 1e-9);
    assert_close(corner[0], 6.25e-4, 1e-9);
    assert_close(solution.report().unwrap().totals.normal.abs(), 2.0, 1e-9);
}

#[test]
fn blocks_of_hexahedra_press_evenly_whatever_way_the_deck_is_written() {
    // u_z = −p / E₁ − p / 2 E₂ on top, ν p / E₂ sideways in the softer block.
    for name in [
        "own_blocks_c3d8.inp",
        "own_blocks_c3d20.inp",
        "own_wedges_c3d15.inp",
    ] {
        let solution = solved(name);
        let report = solution.report().unwrap();
        assert_close(report.totals.normal.abs(), 100.0, 1e-9);
        assert_close(report.totals.peak_pressure, 100.0, 1e-9);
        let top = solution.displacement_near(1, [1.0, 1.0, 1.5]).unwrap();
        assert_close(top[2], -100.0 / 210_000.0 - 50.0 / 70_000.0, 1e-9);
        let lateral = solution.displacements().iter().flatten().enumerate();
        let lateral = lateral.filter(|(at, _)| at % 3 < 2).map(|(_, u)| u.abs());
        assert_close(lateral.fold(0.0, f64::max), 0.3 * 100.0 / 70_000.0, 1e-9);
    }
}

#[test]
fn plane_strain_of_a_thickness_is_told_per_unit_depth() {
    let solution = solved("own_cpe4_thickness.inp");
    let corner = solution.displacement_near(1, [2.0, 2.0, 0.0]).unwrap();
    assert_close(corner[1], -3.75e-3, 1e-9);
    assert_close(corner[0], 1.25e-3, 1e-9);
    assert_close(solution.report().unwrap().totals.normal.abs(), 4.0, 1e-9);
}

#[test]
fn an_axisymmetric_press_fit_has_lames_pressure() {
    let solution = solved("own_cax8_fit.inp");
    let totals = solution.report().unwrap().totals;
    assert_close(totals.normal.abs(), 0.809_130, 1e-3);
    assert_close(totals.normal.abs() / totals.contact_area, 0.128_777, 1e-3);
}

#[test]
fn a_deck_is_read_whatever_its_case_blanks_and_line_ends() {
    assert_squares(&read(SQUARES));
    assert_squares(&read(&SQUARES.to_lowercase().replace('\n', "\r\n")));
    assert_squares(&read(
        &SQUARES
            .replace(", ", " ,\t")
            .replace('=', " = ")
            .replace('*', "  *"),
    ));
    assert_squares(&read(
        &SQUARES
            .replace("0\n", "0,\n")
            .replace("*NODE", "\u{feff}*NODE"),
    ));
    assert_squares(&read(
        &SQUARES.replace("1, 1, 2, 3, 4\n", "1, 1, 2,\n** Größe\n3,\n4\n"),
    ));
    assert_squares(&read(
        &SQUARES.replace("TYPE=CPE4, ELSET=LOW", "TYPE=CPE4R,\n ELSET=LOW"),
    ));
    assert_squares(&read(&SQUARES.replace("1000.,", "1.D+3,")));
}

#[test]
fn sets_are_generated_nested_and_appended_and_surfaces_made_of_nodes() {
    let sets = "*NSET, NSET=FEW, GENERATE\n11, 12\n*NSET, NSET=ALL\nFEW\n*NSET, NSET=ALL\n99\n";
    let text = SQUARES
        .replace("*MATERIAL", &format!("{sets}*MATERIAL"))
        .replace("14, 0, 2\n", "14, 0, 2\n99, 5, 5\n")
        .replace("NAME=BOTTOM\nUP, S1", "NAME=BOTTOM, TYPE=NODE\nALL")
        .replace("2, P3, 2.", "UP, P3, 2.");
    assert_squares(&read(&text));
    // All outer faces of an element where no face is named.
    let text = SQUARES.replace("UP, S1", "UP,");
    assert_squares(&read(&text.replace("0.5\n*CONTACT", "0.\n*CONTACT")));
}

/// The squares as two instances of one part.
pub(crate) fn instances() -> String {
    let part = "*PART, NAME=SQUARE\n*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n*ELEMENT, TYPE=CPE4\n\
        1, 1, 2, 3, 4\n*ELSET, ELSET=CELL\n1\n*NSET, NSET=SIDE\n1, 4\n\
        *SOLID SECTION, ELSET=CELL, MATERIAL=M\n,\n*END PART\n\
        *ASSEMBLY, NAME=A\n*INSTANCE, NAME=LOW, PART=SQUARE\n*END INSTANCE\n\
        *INSTANCE, NAME=UP, PART=SQUARE\n0., 2., 0.\n0., 2., 0., 0., 2., 1., -90.\n*END INSTANCE\n\
        *ELSET, ELSET=_S, INTERNAL, INSTANCE=UP\n1\n\
        *SURFACE, NAME=BOTTOM\n_S, S2\n*SURFACE, NAME=TOP\nLOW.CELL, S3\n*END ASSEMBLY\n";
    // A quarter turn clockwise about (0, 2): node 1 at (0, 2), 2 at (0, 1), 3 at (1, 1), 4 at (1, 2).
    let rest = SQUARES
        .split_once("*MATERIAL")
        .unwrap()
        .1
        .split_once("*SOLID")
        .unwrap()
        .0;
    let tail = SQUARES.split_once("*SURFACE INTERACTION").unwrap().1;
    let tail = tail
        .replace(
            "1, 1, 2\n2, 2\n11, 1\n14, 1\n",
            "LOW.SIDE, 1\nLOW.1, 2\nLOW.2, 2\nUP.1, 1\nUP.2, 1\n",
        )
        .replace("2, P3", "UP.1, P4");
    format!("{part}*MATERIAL{rest}*SURFACE INTERACTION{tail}").replace(
        "*ELSET, ELSET=_S",
        "*SURFACE, NAME=X\nUP.CELL, S2\n*ELSET, ELSET=_S",
    )
}

#[test]
fn instances_of_one_part_are_moved_and_named_apart() {
    let deck = read(&instances());
    let names: Vec<_> = deck
        .scene
        .bodies
        .iter()
        .map(|body| body.name.as_str())
        .collect();
    assert_eq!(names, ["LOW.CELL", "UP.CELL"]);
    assert_squares(&deck);
}

#[test]
fn connected_parts_of_one_set_are_bodies_of_their_own() {
    let text = SQUARES
        .replace("ELSET=UP", "ELSET=LOW")
        .replace("UP, S1", "2, S1");
    let text = text.replace("LOW, S3", "1, S3");
    let deck = read(&text);
    let names: Vec<_> = deck
        .scene
        .bodies
        .iter()
        .map(|body| body.name.as_str())
        .collect();
    assert_eq!(names, ["LOW#1", "LOW#2"]);
    assert_squares(&deck);
}

#[test]
fn included_files_stand_in_place_and_may_not_include_themselves() {
    let (start, rest) = SQUARES.split_once("*MATERIAL").unwrap();
    let rest = format!("*MATERIAL{rest}");
    let text = format!("{start}*Include,\n input = Rest.inc\n");
    let included = |name: &str| match name {
        "Rest.inc" => Ok(rest.clone().into_bytes()),
        _ => no_file(name),
    };
    assert_squares(&Deck::parse(text.as_bytes(), "deck.inp", &included).unwrap());
    let endless = |_: &str| Ok(b"*INCLUDE, INPUT=a\n*INCLUDE, INPUT=b\n".to_vec());
    let refused = Deck::parse(b"*NODE\n*INCLUDE, INPUT=a", "deck.inp", &endless);
    let said = refused.unwrap_err().to_string();
    assert!(
        said.contains("a:1: *INCLUDE: `a` includes itself"),
        "{said}"
    );
    // Each file includes the next one twice; then once, without end.
    let next = |name: &str| format!("*INCLUDE, INPUT={name}x\n");
    let doubling = |name: &str| match name.len() {
        ..=12 => Ok(next(name).repeat(2).into_bytes()),
        _ => Ok(Vec::new()),
    };
    let deep = Deck::parse(b"*INCLUDE, INPUT=x", "deck.inp", &|name| {
        Ok(next(name).into())
    });
    assert!(
        deep.unwrap_err()
            .to_string()
            .contains("or 50 inside each other")
    );
    let refused = Deck::parse(b"*INCLUDE, INPUT=x", "deck.inp", &doubling);
    assert!(
        refused
            .unwrap_err()
            .to_string()
            .contains("more than 1000 files")
    );
    let lost = |name: &str| Err(Error::Empty { place: name.into() });
    let refused = Deck::parse(b"*NODE\n*INCLUDE, INPUT=lost", "deck.inp", &lost);
    assert!(
        refused
            .unwrap_err()
            .to_string()
            .contains("deck.inp:2: *INCLUDE")
    );
}

#[test]
fn loads_persist_over_steps_ramp_and_end_with_op_new() {
    let steps = "*STEP\n*STATIC\n0.1, 2.\n*CLOAD\n13, 2, -3.\n14, 2, -3.\n*END STEP\n\
        *STEP\n*STATIC\n*DLOAD, OP=NEW\n*END STEP\n";
    let text = format!("{SQUARES}{steps}");
    let deck = read(&text);
    assert_eq!(deck.scene.steps.as_ref().unwrap().at, [1.0, 3.0, 4.0]);
    let mut normal = Vec::new();
    let last = solve_steps(&deck.scene, None, |solution| {
        normal.push(solution.report()?.totals.normal.abs());
        Ok(())
    });
    assert_eq!(last.unwrap().status(), Status::Certified);
    for (found, expected) in normal.iter().zip([2.0, 8.0, 6.0]) {
        assert_close(*found, expected, 1e-9);
    }
    assert_eq!(normal.len(), 3);
}

#[test]
fn an_amplitude_is_followed_inside_a_step() {
    let text = SQUARES
        .replace(
            "*STEP",
            "*AMPLITUDE, NAME=A\n0., 0., 0.25, 2.,\n0.5, 0.5, 1., 1.\n*STEP",
        )
        .replace("*DLOAD", "*DLOAD, AMPLITUDE=A");
    let steps = read(&text).scene.steps.unwrap();
    assert_eq!(steps.at, [0.25, 0.5, 1.0]);
    let factors = &steps.factors["bodies[1].loads[0]"];
    assert_eq!(factors, &[vec![0.25, 1.0], vec![0.5, 0.25], vec![1.0, 0.5]]);
}

#[test]
fn adjust_moves_slave_nodes_onto_the_master_and_no_others() {
    // The upper square stands 0.01 too low on the left and 0.02 too high on the right.
    let text = SQUARES
        .replace("11, 0, 1\n", "11, 0, 0.99\n")
        .replace("12, 1, 1\n", "12, 1, 1.02\n");
    let height = |adjust: &str| {
        let deck = read(&text.replace("INTERACTION=I\nB", &format!("INTERACTION=I{adjust}\nB")));
        let MeshSource::Given(mesh) = &deck.scene.bodies[1].mesh else {
            unreachable!("meshes of decks are in memory")
        };
        [mesh.nodes[0][1], mesh.nodes[1][1]]
    };
    assert_eq!(height(""), [0.99, 1.02]);
    assert_eq!(height(", ADJUST=0."), [1.0, 1.02]);
    assert_eq!(height(", ADJUST=0.03"), [1.0, 1.0]);
    let named = text.replace("*MATERIAL", "*NSET, NSET=RIGHT\n12\n*MATERIAL");
    let deck = read(&named.replace("INTERACTION=I\nB", "INTERACTION=I, ADJUST=RIGHT\nB"));
    let MeshSource::Given(mesh) = &deck.scene.bodies[1].mesh else {
        unreachable!("meshes of decks are in memory")
    };
    assert_eq!([mesh.nodes[0][1], mesh.nodes[1][1]], [0.99, 1.0]);
}

#[test]
fn weight_is_density_times_gravity_and_point_forces_are_per_depth() {
    let text = SQUARES
        .replace("1000., 0.25", "1000., 0.25\n*DENSITY\n3.")
        .replace("ELSET=LOW, MATERIAL=M", "ELSET=LOW, MATERIAL=M\n4.")
        .replace("ELSET=UP, MATERIAL=M", "ELSET=UP, MATERIAL=M\n4.")
        .replace("2, P3, 2.", "UP, GRAV, 5., 0., -1.\n*CLOAD\n13, 2, -8.");
    let deck = read(&text);
    let loads = &deck.scene.bodies[1].loads;
    assert!(loads.iter().any(|load| matches!(load,
        SceneLoad::BodyForce { body_force, .. } if *body_force == [0.0, -15.0])));
    assert!(loads.iter().any(|load| matches!(load,
        SceneLoad::PointForce { point_force, .. } if *point_force == [0.0, -2.0])));
}

#[test]
fn what_is_left_out_is_noted_by_place() {
    let text = SQUARES
        .replace(
            "*STEP\n*STATIC",
            "*STEP, NLGEOM, INC=100\n*STATIC, DIRECT\n",
        )
        .replace("*DLOAD", "*CONTROLS, RESET\n*NODE FILE\nU\n*DLOAD")
        .replace(
            "*FRICTION\n0.5",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.e6\n*FRICTION\n0.5, 1.e6",
        );
    let deck = read(&text);
    for said in [
        "deck.inp:35: *STEP `NLGEOM`",
        "*CONTROLS is not needed here",
        "*NODE FILE is not needed here",
        "deck.inp:24: *SURFACE BEHAVIOR the stiffness",
        "*FRICTION the stick slope of the penalty",
        "*STATIC increments",
    ] {
        assert!(
            deck.notes.iter().any(|note| note.contains(said)),
            "{said}: {:?}",
            deck.notes
        );
    }
    assert_squares(&deck);
    let soft = text
        .replace("LINEAR", "EXPONENTIAL")
        .replace("1.e6", "1., 2.e3");
    assert!(
        refused(&soft).contains("deck.inp:24: *SURFACE BEHAVIOR: stiffness 9.210e3 where the gap")
    );
    let medium = soft.replace("2.e3", "4.342945e3");
    assert!(
        read(&medium)
            .notes
            .iter()
            .any(|note| note.contains("it gives 5 % of what a cell gives"))
    );
}

#[test]
fn a_bad_deck_is_refused_by_file_line_and_keyword() {
    let mut missed = Vec::new();
    for (from, to, said) in [
        ("*NODE", "1, 2\n*NODE", ":1: data before the first keyword"),
        ("*NODE", "*NODES", ":1: *NODES: an unknown keyword"),
        (
            "*NODE\n",
            "*NODE, SYSTEM=C\n",
            ":1: *NODE: `SYSTEM=C` is not read",
        ),
        ("1, 0, 0", "1, 0 0", ":2: *NODE: `0 0` is no finite number"),
        (
            "1, 0, 0",
            "1, 1e999, 0",
            ":2: *NODE: `1e999` is no finite number",
        ),
        ("1, 0, 0", "1, nan, 0", ":2: *NODE: `nan`"),
        (
            "1, 0, 0",
            "-1, 0, 0",
            ":2: *NODE: `-1` is no number of a node",
        ),
        (
            "1, 0, 0",
            "99999999999999999999, 0, 0",
            ":2: *NODE: `99999999999999999999`",
        ),
        ("1, 0, 0", "1, 0, 0, 0, 7", ":2: *NODE: one word too many"),
        ("2, 1, 0", "1, 1, 0", ":3: *NODE: node 1 is listed twice"),
        (
            "TYPE=CPE4, ELSET=LOW",
            "TYPE=S4, ELSET=LOW",
            ":10: *ELEMENT: `TYPE=S4`, a shell",
        ),
        (
            "TYPE=CPE4, ELSET=LOW",
            "ELSET=LOW",
            ":10: *ELEMENT: expected `TYPE=`",
        ),
        (
            "1, 1, 2, 3, 4",
            "1, 1, 2, 3",
            ":11: *ELEMENT: element 1 has 3 nodes",
        ),
        (
            "1, 1, 2, 3, 4",
            "1, 1, 2, 3, 4, 4",
            ":11: *ELEMENT: element 1 has 5 nodes",
        ),
        (
            "1, 1, 2, 3, 4",
            "1, 1, 2, 3, 5",
            ":11: *ELEMENT: element 1: node 5 is not in the deck",
        ),
        (
            "2, 11, 12",
            "1, 11, 12",
            ":13: *ELEMENT: element 1 is listed twice",
        ),
        (
            "3, 1, 1",
            "3, 1, 1, 0.5",
            ":11: *ELEMENT: plane element 1 has a node at z = 0.5",
        ),
        (
            "*ELASTIC\n",
            "*ELASTIC, TYPE=ORTHO\n",
            ":15: *ELASTIC: expected two lines with nine constants",
        ),
        (
            "1000., 0.25",
            "1000.",
            ":16: *ELASTIC: `` is no finite number; expected Poisson",
        ),
        (
            "1000., 0.25",
            "1000., 0.5",
            ":16: *ELASTIC: moduli 1000, 0.5",
        ),
        (
            "1000., 0.25",
            "1000., 0.25\n900., 0.25, 100.",
            ":17: *ELASTIC: one line too many",
        ),
        (
            "*ELASTIC\n",
            "*PLASTIC\n",
            ":15: *PLASTIC: is not read: plasticity",
        ),
        (
            "ELSET=UP, MATERIAL=M",
            "ELSET=UP, MATERIAL=N",
            ":18: *SOLID SECTION: material `N`",
        ),
        (
            "ELSET=UP, MATERIAL=M",
            "ELSET=UPP, MATERIAL=M",
            ":18: *SOLID SECTION: `UPP` is no element",
        ),
        (
            "*SOLID SECTION, ELSET=UP, MATERIAL=M\n",
            "",
            ":32: *STEP: begins; expected a *SOLID SECTION",
        ),
        (
            "LOW, S3",
            "LOW, S5",
            ":20: *SURFACE: `S5` is no face of element 1",
        ),
        ("LOW, S3", "LOW, SPOS", ":20: *SURFACE: `SPOS` is no face"),
        (
            "14, 1\n",
            "14, 1, 9\n",
            ":32: *BOUNDARY: degree of freedom 9; expected 1 to 3",
        ),
        (
            "NAME=I\n",
            "NAME=I\n*GAP\n",
            ":24: *GAP: is not read: gap elements",
        ),
        ("0.5\n*", "-0.5\n*", ":25: *FRICTION: coefficient -0.5"),
        (
            "*FRICTION",
            "*FRICTION, EXPONENTIAL DECAY",
            ":24: *FRICTION: parameter `EXPONENTIALDECAY` is not read",
        ),
        (
            "INTERACTION=I\n",
            "INTERACTION=J\n",
            ":26: *CONTACT PAIR: surface interaction `J`",
        ),
        (
            "BOTTOM, TOP",
            "BOTTOM, TIP",
            ":27: *CONTACT PAIR: surface `TIP` is not known",
        ),
        (
            "BOTTOM, TOP",
            "BOTTOM",
            ":27: *CONTACT PAIR: expected slave and master",
        ),
        (
            "2, 2\n11",
            "2, 2,\n7\n11",
            ":31: *BOUNDARY: node 7 is not in the deck",
        ),
        (
            "*STATIC",
            "*DYNAMIC",
            ":34: *DYNAMIC: is not read: motion with inertia",
        ),
        (
            "*STATIC\n0.1, 1.\n",
            "",
            ":33: *STEP: a step without *STATIC",
        ),
        ("0.1, 1.", "0.1, -1.", ":34: *STATIC: period -1"),
        (
            "2, P3, 2.",
            "2, P3",
            ":37: *DLOAD: `` is no finite number; expected a load",
        ),
        (
            "2, P3, 2.",
            "2, CENTRIF, 2.",
            ":37: *DLOAD: expected the square of an angular velocity",
        ),
        (
            "*DLOAD",
            "*DLOAD, AMPLITUDE=A",
            ":36: *DLOAD: amplitude `A` is not known",
        ),
        ("*END STEP\n", "", ":33: *STEP: a step that is not ended"),
        ("*STEP\n", "*STEP,\n", ":33: *STEP: ends in a comma"),
        (
            "*MATERIAL",
            "*PART, NAME=P\n*MATERIAL",
            ":34: *STEP: inside *PART, which is not ended",
        ),
        (
            "*MATERIAL",
            "*PART, NAME=P\n*END PART\n*PART, NAME=P\n*END PART\n*MATERIAL",
            ":16: *PART: part `P` once more",
        ),
        (
            "*MATERIAL",
            "*NSET, NSET=A, GENERATE\n5, 9\n*MATERIAL",
            ":15: *NSET: no node from 5 to 9",
        ),
        (
            "*MATERIAL",
            "*NSET, NSET=A, GENERATE\n5, 1\n*MATERIAL",
            ":15: *NSET: expected a first",
        ),
        (
            "*MATERIAL",
            "*EQUATION\n2\n*MATERIAL",
            ":14: *EQUATION: is not read: equations",
        ),
        (
            "*MATERIAL",
            "*INCLUDE\n*MATERIAL",
            ":14: *INCLUDE: expected `INPUT=`",
        ),
    ] {
        let text = SQUARES.replacen(from, to, 1);
        assert_ne!(text, SQUARES, "{from}");
        let (error, at_line) = (refused(&text), format!("deck.inp{said}"));
        if !error.contains(&at_line) {
            missed.push(format!("{at_line}\n  but {error}"));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn a_deck_that_stops_anywhere_is_an_error_with_file_and_line() {
    for end in 0..SQUARES.len() - "*END STEP\n".len() {
        let error = refused(&SQUARES[..end]);
        assert!(error.starts_with("deck.inp:"), "{end}: {error}");
    }
}

proptest! {
    /// Words of a deck are lost, doubled or replaced; what is still a deck has mechanics or an error.
    #[test]
    fn words_gone_wrong_never_break_the_reader(
        changes in prop::collection::vec((0.0..1.0, 0..WORDS.len()), 1..4),
    ) {
        let mut text = SQUARES.to_owned();
        for (fraction, word) in changes {
            let sign = |c: char| c == ',' || c == '\n' || c == '=';
            let at = (fraction * text.len() as f64) as usize;
            let start = text[..at].rfind(sign).map_or(0, |before| before + 1);
            let end = text[at..].find(sign).map_or(text.len(), |length| at + length);
            text.replace_range(start..end, WORDS[word]);
        }
        match Deck::parse(text.as_bytes(), "deck.inp", &|_| Ok(SQUARES.into())) {
            Ok(deck) => drop(deck.scene.mechanics()),
            Err(error) => {
                let said = error.to_string();
                let line = said.split(':').any(|part| part.parse::<usize>().is_ok());
                prop_assert!(line, "{said}");
            }
        }
    }
}

/// Words that stand in place of others.
const WORDS: [&str; 16] = [
    "",
    "0",
    "-1",
    "2",
    "1e308",
    "18446744073709551615",
    "nan",
    "LOW",
    "S3",
    "*STEP",
    "*END STEP",
    "1, 2",
    "GENERATE",
    "*INCLUDE, INPUT=x.inp",
    "**",
    "\n",
];

#[test]
fn numbers_of_any_size_make_no_work() {
    let text = SQUARES.replace(
        "*MATERIAL",
        "*NSET, NSET=A, GENERATE\n1, 18446744073709551615, 1\n*MATERIAL",
    );
    assert_squares(&read(&text));
}

#[test]
fn an_imported_deck_is_a_scene_with_the_same_answer() {
    let deck =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/decks/own_cpe4_thickness.inp");
    let folder = folder("imported_deck");
    let out = folder.join("scene.json");
    let run = dpana(
        &folder,
        &[
            "import",
            deck.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
        ],
    );
    assert!(run.status.success(), "{run:?}");
    let [scene, from_deck] = [
        Scene::from_file(&out).unwrap(),
        Deck::from_file(&deck).unwrap().scene,
    ];
    assert_eq!(scene.contacts, from_deck.contacts);
    let [scene, from_deck] = [scene, from_deck].map(|scene| solve(&scene).unwrap());
    assert_eq!(scene.displacements().len(), 2);
    for body in 0..2 {
        // Cells and nodes come in another order, which round-off may feel.
        for node in &from_deck.bodies()[body].mesh.nodes {
            let [a, b] = [&scene, &from_deck].map(|s| s.displacement_near(body, *node).unwrap());
            assert!(
                (0..2).all(|axis| (a[axis] - b[axis]).abs() < 1e-14),
                "{a:?} {b:?}"
            );
        }
    }
    let refused = dpana(
        &folder,
        &[
            "import",
            deck.to_str().unwrap(),
            "--out",
            deck.to_str().unwrap(),
        ],
    );
    assert!(String::from_utf8_lossy(&refused.stderr).contains("would overwrite"));
    let nowhere = dpana(&folder, &["import", deck.to_str().unwrap(), "--out", "-"]);
    assert!(String::from_utf8_lossy(&nowhere.stderr).contains("`-` is no name for the meshes"));
    assert!(!folder.join("-").exists());
    let solved = dpana(&folder, &["solve", deck.to_str().unwrap()]);
    assert!(solved.status.success());
    assert!(
        String::from_utf8_lossy(&solved.stderr).contains("note: "),
        "{solved:?}"
    );
}

#[test]
fn every_deck_of_the_folder_is_tested_here() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/decks");
    assert_eq!(fs::read_dir(folder).unwrap().count(), 5);
}
