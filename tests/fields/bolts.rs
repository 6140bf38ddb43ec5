//! Bolts under preload, beside the joint of two springs: bolt and clamped members in parallel, in series with
//! the shortening. (VDI 2230-1, Systematic calculation of highly stressed bolted joints (2015), § 3.2.)
//!
//! ```text
//! F = F₀ + Φ P,   F_K = F₀ − (1 − Φ) P,   Φ = k_S / (k_S + k_P)        until F_K = 0, then F = P
//! ```

use dpana::body::{CellKind, Facet, Group, Mesh, box_mesh, graded};
use dpana::report::Report;
use dpana::scene::{
    SceneBody, SceneBolt, SceneContact, SceneObstacle, ScenePeriodic, SceneRigidGroup, SceneSteps,
    SceneSupport,
};
use dpana::{Scene, Status, solve_steps};
use nalgebra::{Rotation3, Vector3};

use crate::local_supports::shipped;
use crate::stacks::{block, body, certified, scene};

/// Stiffness of the bolt and of the members, in N/m, and the preload, in newton.
const BOLT: f64 = 1000.0;
const MEMBERS: f64 = 1500.0;
const PRELOAD: f64 = 6.0;

/// A bolt of width 2 and length 4 (E = 2000) whose head, 6 wide, is rigid: k = E A / L.
fn bolt_mesh() -> Mesh {
    let mut mesh = Mesh::new(2, Vec::new());
    let row = |y: usize| -> usize { if y < 4 { 3 } else { 7 } };
    let first = |y: usize| if y < 4 { 3 * y } else { 12 + 7 * (y - 4) };
    for y in 0..6 {
        let half = (row(y) - 1) as f64 / 2.0;
        (0..row(y)).for_each(|x| mesh.nodes.push([x as f64 - half, y as f64, 0.0]));
    }
    let at = |x: usize, y: usize| first(y) + if row(y) == 3 { x - 2 } else { x };
    let (mut shank, mut head) = (Vec::new(), Vec::new());
    for (x, y) in (0..4)
        .flat_map(|y| [(2, y), (3, y)])
        .chain((0..6).map(|x| (x, 4)))
    {
        let cells = if y < 4 { &mut shank } else { &mut head };
        cells.push(mesh.cell_count());
        let nodes = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
        mesh.push_cell(CellKind::Quad4, &nodes);
    }
    let facet = |a: usize, b: usize| Facet { nodes: vec![a, b] };
    let under = [0, 1, 4, 5].map(|x| facet(at(x, 4), at(x + 1, 4)));
    let end = [2, 3].map(|x| facet(at(x, 0), at(x + 1, 0)));
    mesh.groups.extend([
        ("shank".to_owned(), Group::Cells(shank)),
        ("head".to_owned(), Group::Cells(head)),
        ("under".to_owned(), Group::Facets(under.to_vec())),
        ("end".to_owned(), Group::Facets(end.to_vec())),
    ]);
    mesh
}

/// Two members 2 wide on either side of the bolt, clamped by its head, which is pulled by `load`.
fn joint(bolt: SceneBolt, load: f64) -> Scene {
    let clamped = [Some(0.0); 2];
    let head = SceneRigidGroup {
        force: Some(vec![0.0, load]),
        ..SceneRigidGroup::new("head", &[0.0, 4.0])
    };
    let shaft = body("shaft", bolt_mesh(), 2.0 * BOLT, 0.0)
        .with_support(SceneSupport::of("end", &clamped))
        .with_rigid_group(head)
        .with_bolt(bolt);
    let member = |name: &str, x: f64| {
        let mesh = block(
            CellKind::Quad4,
            [x, 0.0, 0.0],
            [x + 2.0, 4.0, 0.0],
            [3, 5, 1],
        );
        body(name, mesh, MEMBERS, 0.0).with_support(SceneSupport::of("bottom", &clamped))
    };
    let contacts =
        ["left", "right"].map(|name| SceneContact::between(["shaft", "under"], [name, "top"], 0.0));
    scene(
        vec![shaft, member("left", -3.0), member("right", 1.0)],
        contacts.to_vec(),
    )
}

fn tightened() -> SceneBolt {
    SceneBolt::preloaded("M2", "shank", &[0.0, 2.0], &[0.0, 1.0], PRELOAD)
}

/// Tightened at 1, locked, then pulled by up to 12 N; the report of every step.
fn in_steps(change: impl Fn(&mut Scene)) -> Scene {
    let mut bolt = tightened();
    bolt.locked_from = Some(1.0);
    let mut scene = joint(bolt, 12.0);
    let rows = [[1.0, 0.0], [2.0, 5.0 / 12.0], [3.0, 0.75], [4.0, 1.0]];
    let rows = rows.map(|row| row.to_vec()).to_vec();
    let mut steps = SceneSteps {
        at: vec![1.0, 2.0, 3.0, 4.0],
        ..SceneSteps::default()
    };
    steps
        .factors
        .insert("bodies[0].rigid_groups[0].load".to_owned(), rows);
    scene.steps = Some(steps);
    change(&mut scene);
    scene
}

fn reports(scene: &Scene) -> Vec<Report> {
    let mut reports = Vec::new();
    solve_steps(scene, None, |solution| {
        // To lock a bolt factorises nothing.
        assert_eq!(solution.status(), Status::Certified);
        assert_eq!(solution.condensed().work().factorisations, 3);
        reports.push(solution.report()?);
        Ok(())
    })
    .unwrap();
    reports
}

fn close(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() < 1e-10 * PRELOAD,
        "{found} {expected}"
    );
}

#[test]
fn a_joint_that_is_tightened_and_then_pulled_follows_its_springs_until_it_parts() {
    let part = BOLT / (BOLT + MEMBERS);
    let shortening = PRELOAD * (1.0 / BOLT + 1.0 / MEMBERS);
    let reports = reports(&in_steps(|_| {}));
    assert_eq!(reports.len(), 4);
    for (report, load) in reports.iter().zip([0.0, 5.0, 9.0, 12.0]) {
        let parted = load > PRELOAD / (1.0 - part);
        let force = if parted { load } else { PRELOAD + part * load };
        let bolt = &report.bolts[0];
        close(bolt.force, force);
        close(bolt.shortening, shortening);
        assert_eq!((bolt.name.as_str(), bolt.held), ("M2", load > 0.0));
        // The head stretches the bolt beyond its shortening, or stands on the members.
        let head = report.rigid_groups[0].displacement[1];
        close(head, force / BOLT - shortening);
        if !parted {
            close(head, -(force - load) / MEMBERS);
        }
        let clamped: f64 = report.totals.pairs[..2]
            .iter()
            .map(|pair| pair.totals.normal)
            .sum();
        close(clamped, force - load);
    }
    // Stiffness of the joint before it parts, and after.
    let head = |step: usize| reports[step].rigid_groups[0].displacement[1];
    close(4.0 / (head(2) - head(1)) / (BOLT + MEMBERS), 1.0);
}

#[test]
fn tightened_then_pulled_is_shortened_and_pulled_at_once() {
    let steps = reports(&in_steps(|_| {}));
    for (step, load) in [(1, 5.0), (3, 12.0)] {
        let bolt = SceneBolt {
            force: None,
            shortening: Some(steps[0].bolts[0].shortening),
            ..tightened()
        };
        let (_, once) = certified(&joint(bolt, load));
        close(once.bolts[0].force, steps[step].bolts[0].force);
        assert!(once.bolts[0].held);
        let heads = [&once, &steps[step]].map(|report| report.rigid_groups[0].displacement[1]);
        close(heads[0], heads[1]);
    }
    // A force that is given, not locked, stays what it is; the members give way.
    let (_, given) = certified(&joint(tightened(), 5.0));
    close(given.bolts[0].force, PRELOAD);
    close(given.bolts[0].shortening, PRELOAD / BOLT + 1.0 / MEMBERS);
}

#[test]
fn steps_in_halves_and_steps_from_a_saved_state_are_the_same_steps() {
    let whole = reports(&in_steps(|_| {}));
    let halved = reports(&in_steps(|scene| {
        if let Some(steps) = &mut scene.steps {
            steps.resolve = Some(1e-3);
        }
    }));
    for (whole, halved) in whole.iter().zip(&halved) {
        close(halved.bolts[0].force, whole.bolts[0].force);
    }
    let scene = in_steps(|_| {});
    let mut saved = Vec::new();
    solve_steps(&scene, None, |solution| {
        saved.extend(solution.saved_state());
        Ok(())
    })
    .unwrap();
    // Just tightened, and after a step with the lock.
    for state in &saved[..3] {
        let mut last = Vec::new();
        solve_steps(&scene, Some(state), |solution| {
            last.push(solution.report()?.bolts[0].force);
            Ok(())
        })
        .unwrap();
        assert_eq!(last.last(), Some(&whole[3].bolts[0].force));
    }
}

/// A bar of 1 × 1 × 3 m (E = 900) along a direction in space, clamped at both ends, and that direction.
fn leaning_bar(ahead: f64) -> (Mesh, [f64; 3]) {
    let mut mesh = block(CellKind::Hex8, [0.0; 3], [1.0, 1.0, 3.0], [2, 2, 3]);
    let height = mesh.nodes.iter().map(|x| x[2]).find(|z| *z > 0.0).unwrap();
    let turn = Rotation3::new(Vector3::new(0.3, -0.7, 0.2));
    let turned = |x: [f64; 3]| -> [f64; 3] { (turn * Vector3::from(x)).into() };
    mesh.nodes.iter_mut().for_each(|x| *x = turned(*x));
    let along = turned([0.0, 0.0, ahead]);
    mesh.cut(
        "bolts[0]",
        "cut",
        &(0..12).collect::<Vec<_>>(),
        [turned([0.0, 0.0, height]), along],
    )
    .unwrap();
    (mesh, along)
}

fn clamped(mesh: Mesh, bolt: SceneBolt) -> Report {
    let bar: SceneBody = body("bar", mesh, 900.0, 0.0)
        .with_support(SceneSupport::of("bottom", &[Some(0.0); 3]))
        .with_support(SceneSupport::of("top", &[Some(0.0); 3]))
        .with_bolt(bolt);
    certified(&scene(vec![bar], Vec::new())).1
}

#[test]
fn a_bar_along_any_direction_is_shortened_against_its_stiffness() {
    // E A s / L = 900 · s / 3, whichever side of the cut is ahead, and the force gives the shortening back.
    for ahead in [2.0, -1.0] {
        let (mesh, _) = leaning_bar(ahead);
        let bolt = SceneBolt {
            name: "bolt".to_owned(),
            faces: Some(["cut.own", "cut.other"].map(Into::into)),
            shortening: Some(0.02),
            ..SceneBolt::default()
        };
        let report = clamped(mesh.clone(), bolt.clone());
        close(report.bolts[0].force, 6.0);
        close(report.bolts[0].shortening, 0.02);
        let pulled = SceneBolt {
            force: Some(6.0),
            shortening: None,
            ..bolt
        };
        let report = clamped(mesh, pulled);
        close(report.bolts[0].shortening, 0.02);
        assert!(report.bolts[0].force_defect.scaled < 1e-12);
    }
}

/// A bolt whose mesh is cut, changed.
fn refused(change: impl Fn(&mut SceneBolt)) -> String {
    let mut bolt = tightened();
    change(&mut bolt);
    dpana::solve(&joint(bolt, 0.0)).unwrap_err().to_string()
}

#[test]
fn bolts_that_cannot_be_are_refused_with_the_key_and_the_cure() {
    let says = |text: String, parts: &[&str]| {
        for part in parts {
            assert!(text.contains(part), "`{part}` is not in: {text}");
        }
    };
    let place = "bodies[0].bolts[0]";
    let at = |y: f64| Some(vec![0.0, y]);
    says(
        refused(|bolt| bolt.point = at(9.0)),
        &["bolts[0].point", "one side"],
    );
    says(
        refused(|bolt| bolt.point = at(1.5)),
        &["bolts[0].point", "facets of the mesh lie in"],
    );
    says(
        refused(|bolt| bolt.point = Some(vec![0.0])),
        &["bolts[0].point", "expected 2"],
    );
    says(
        refused(|bolt| bolt.axis = Some(vec![0.0; 2])),
        &["bolts[0].axis", "but zero"],
    );
    says(
        refused(|bolt| bolt.axis = Some(vec![1.0, 0.0])),
        &["bolts[0].group", "holds node"],
    );
    says(
        refused(|bolt| bolt.axis = None),
        &[place, "`group`, `point` and `axis`, or `faces`"],
    );
    says(
        refused(|bolt| bolt.group = Some("shnak".into())),
        &["bolts[0].group", "shank"],
    );
    says(
        refused(|bolt| bolt.group = Some("under".into())),
        &["bolts[0].group", "cells"],
    );
    says(
        refused(|bolt| bolt.force = Some(f64::NAN)),
        &["bolts[0].force", "finite"],
    );
    says(refused(|bolt| bolt.force = None), &[place, "no `force`"]);
    says(
        refused(|bolt| bolt.shortening = Some(0.1)),
        &[place, "both"],
    );
    says(
        refused(|bolt| bolt.locked_from = Some(1.0)),
        &["bolts[0].locked_from", "without `steps`"],
    );
    says(
        refused(|bolt| {
            (bolt.force, bolt.shortening, bolt.locked_from) = (None, Some(0.1), Some(1.0));
        }),
        &["bolts[0].locked_from", "needs no lock"],
    );
    says(
        refused(|bolt| bolt.name = "left".to_owned()),
        &["bolts[0].name", "`left` again"],
    );
    let faces = |bolt: &mut SceneBolt| {
        (bolt.group, bolt.point, bolt.axis) = (None, None, None);
        bolt.faces = Some(["under", "end"].map(Into::into));
    };
    says(refused(faces), &["bolts[0].faces", "lie on each other"]);
    let driven = |instant: f64, rows: &[[f64; 2]]| {
        let scene = in_steps(|scene| {
            scene.bodies[0].bolts[0].locked_from = Some(instant);
            let rows = rows.iter().map(|row| row.to_vec()).collect();
            let key = "bodies[0].bolts[0].force".to_owned();
            scene.steps.as_mut().unwrap().factors.insert(key, rows);
        });
        dpana::solve(&scene).unwrap_err().to_string()
    };
    says(
        driven(1.5, &[[1.0, 1.0]]),
        &["locked_from", "1.5", "steps.at"],
    );
    says(
        driven(2.0, &[[1.0, 1.0], [3.0, 2.0]]),
        &["steps.factors.bodies[0].bolts[0].force", "locked at 2"],
    );
}

#[test]
fn a_bolt_may_reach_faces_that_repeat() {
    // Without Poisson's effect the block is a spring E A / L = 2000 between floor and ceiling; the sides of the cut lie
    // on each other where the faces repeat.
    for kind in [CellKind::Hex8, CellKind::Tet10] {
        let line = |end: f64| graded(0.0, end, 2, 1.0).unwrap();
        let mesh = box_mesh(&line(2.0), &line(1.0), &line(1.0), kind).unwrap();
        let (point, axis) = ([0.0, 0.0, 0.5], [0.0, 0.0, 1.0]);
        let low = body("block", mesh, 1000.0, 0.0)
            .with_support(SceneSupport::of("bottom", &[Some(0.0); 3]))
            .with_periodic(ScenePeriodic::translated("left", "right", &[2.0, 0.0, 0.0]))
            .with_bolt(SceneBolt::preloaded("B", "body", &point, &axis, -4.0));
        let ceiling = SceneObstacle::plane(&[0.0, 0.0, 1.0], &[0.0, 0.0, -1.0]);
        let contact = SceneContact::on(ceiling, "top", 0.2);
        let report = certified(&scene(vec![low], vec![contact])).1;
        close(report.totals.pairs[0].totals.normal, 4.0);
        close(report.bolts[0].shortening, -4.0 / 2000.0);
    }
}

#[test]
fn the_shipped_flange_keeps_its_shortening_and_its_members_carry_what_the_bolt_does_less_the_pull()
{
    let reports = reports(&shipped("bolted_flange"));
    let first = &reports[0].bolts[0];
    assert!((first.force - 20_000.0).abs() < 1e-8 && !first.held);
    for (report, pull) in reports.iter().zip([0.0, 4e3, 8e3, 12e3]) {
        let bolt = &report.bolts[0];
        assert!((bolt.shortening / first.shortening - 1.0).abs() < 1e-12);
        let normal = |pair: usize| report.totals.pairs[pair].totals.normal;
        // Head and nut carry the bolt, the flanges each other.
        for pair in [0, 1] {
            assert!((normal(pair) / bolt.force - 1.0).abs() < 1e-9);
        }
        assert!((normal(2) - (bolt.force - pull)).abs() < 1e-8 * bolt.force);
    }
    // The bolt takes a small part of the pull: the flange is much stiffer.
    let part = (reports[3].bolts[0].force - first.force) / 12e3;
    assert!((0.0..0.1).contains(&part), "{part}");
}
