//! What is corrupted between two stages is found by the judge of the scene: no such state is certified.
//!
//! Every scene is solved once as it is and certified. Then one thing is changed at a time: in the contact surface
//! before bodies are condensed on it, in the condensed problem before it is solved, in the reaction that was
//! found, in the displacements that were recovered. Each of these states must end with another status.

use dpana::alternation::{self, Outcome, Settings};
use dpana::body::Body;
use dpana::condensation::Condensed;
use dpana::contact::{ContactNode, ContactPair, ContactSurface};
use dpana::kkt::SceneGeometry;
use dpana::problem::{ContactProblem, Operator};
use dpana::{Acting, Error, Measured, Scene, Status};
use faer::Scale;

/// Bodies with everything that their stages made of them.
struct Stages {
    bodies: Vec<Body>,
    pairs: Vec<ContactPair>,
    surface: ContactSurface,
    settings: Settings,
}

/// What is done, where.
enum Sabotage {
    /// To one contact and, beside it, the size of a facet there, in metre.
    Contact(fn(&mut ContactNode, f64)),
    Gaps(fn(&mut [f64], usize, f64)),
    Problem(fn(&ContactProblem) -> ContactProblem),
    Outcome(fn(&mut Outcome)),
    /// To the displacement of the contact's body, with an unknown of its node.
    Displacement(fn(&mut [f64], usize)),
    SupportReaction,
}

const SABOTAGES: [(&str, Sabotage); 18] = [
    (
        "a mortar weight is half as large again",
        Sabotage::Contact(|contact, _| heaviest(contact).1 *= 1.5),
    ),
    (
        "a tenth of a mortar weight goes to another node",
        Sabotage::Contact(|contact, _| {
            let nodes = &mut contact.opposite.as_mut().unwrap().nodes;
            assert!(nodes.len() > 1);
            nodes[0].1 += 0.1;
            nodes[1].1 -= 0.1;
        }),
    ),
    (
        "two opposite nodes change places",
        Sabotage::Contact(|contact, _| {
            let nodes = &mut contact.opposite.as_mut().unwrap().nodes;
            nodes.sort_by(|a, b| a.1.total_cmp(&b.1));
            let last = nodes.len() - 1;
            let swapped = (nodes[last].0, nodes[0].0);
            (nodes[0].0, nodes[last].0) = swapped;
        }),
    ),
    (
        "an opposite node is dropped",
        Sabotage::Contact(|contact, _| {
            let heaviest = heaviest(contact).0;
            let nodes = &mut contact.opposite.as_mut().unwrap().nodes;
            nodes.retain(|(node, _)| *node != heaviest);
        }),
    ),
    (
        "an own weight is dropped",
        Sabotage::Contact(|contact, _| {
            contact.own.remove(0);
        }),
    ),
    (
        "own weights are nine tenths",
        Sabotage::Contact(|contact, _| contact.own.iter_mut().for_each(|own| own.1 *= 0.9)),
    ),
    (
        "an own weight goes to another node",
        Sabotage::Contact(|contact, _| contact.own[0].0 ^= 1),
    ),
    (
        "a normal is flipped",
        Sabotage::Contact(|contact, _| {
            contact.frame[0] = contact.frame[0].map(|component| -component);
        }),
    ),
    (
        "a normal leans by six degrees",
        Sabotage::Contact(|contact, _| {
            let [n, t, _] = contact.frame;
            let (sin, cos) = 0.1_f64.sin_cos();
            contact.frame[0] = [0, 1, 2].map(|k| cos * n[k] + sin * t[k]);
            contact.frame[1] = [0, 1, 2].map(|k| cos * t[k] - sin * n[k]);
        }),
    ),
    (
        "a gap is larger by a hundredth of a facet",
        Sabotage::Contact(|contact, size| contact.initial_gap += 0.01 * size),
    ),
    (
        "a gap is smaller by a hundredth of a facet",
        Sabotage::Contact(|contact, size| contact.initial_gap -= 0.01 * size),
    ),
    (
        "one gap is shifted in the problem",
        Sabotage::Gaps(|gaps, contact, size| gaps[contact] += 0.01 * size),
    ),
    (
        "all gaps are shifted in the problem",
        Sabotage::Gaps(|gaps, _, size| gaps.iter_mut().for_each(|gap| *gap -= 0.01 * size)),
    ),
    (
        "bodies are softer by a thousandth",
        Sabotage::Problem(|problem| {
            let compliance = problem.compliance() * Scale(1.001);
            with(problem, Operator::from_compliance(compliance).unwrap())
        }),
    ),
    (
        "bodies move together less",
        Sabotage::Problem(|problem| {
            let mut compliance = problem.compliance().to_owned();
            let last = compliance.nrows() - 1;
            compliance[(0, last)] *= 0.9;
            compliance[(last, 0)] *= 0.9;
            with(problem, Operator::from_compliance(compliance).unwrap())
        }),
    ),
    (
        "the reaction is a thousandth larger",
        Sabotage::Outcome(|outcome| outcome.reaction.iter_mut().for_each(|t| *t *= 1.001)),
    ),
    (
        "a recovered displacement is a thousandth larger",
        Sabotage::Displacement(|displacement, unknown| displacement[unknown] *= 1.001),
    ),
    ("a support reaction is zero", Sabotage::SupportReaction),
];

/// The opposite node with the largest weight.
fn heaviest(contact: &mut ContactNode) -> &mut (usize, f64) {
    let nodes = &mut contact.opposite.as_mut().unwrap().nodes;
    nodes.iter_mut().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
}

/// The same problem with another operator.
fn with(problem: &ContactProblem, operator: Operator) -> ContactProblem {
    let offsets = problem.offsets();
    let tangents: Vec<usize> = offsets
        .windows(2)
        .map(|ends| ends[1] - ends[0] - 1)
        .collect();
    ContactProblem::new(
        &tangents,
        problem.friction().to_vec(),
        problem.initial_gap().to_vec(),
        problem.free_displacement().to_vec(),
        operator,
    )
    .unwrap()
}

impl Stages {
    fn new(scene: &str) -> Self {
        let mechanics = Scene::from_json(scene, "scene")
            .unwrap()
            .mechanics()
            .unwrap();
        let (bodies, pairs) = (mechanics.bodies, mechanics.contacts);
        let condensed = Condensed::new(&bodies, &pairs).unwrap();
        Self {
            surface: condensed.surface().clone(),
            bodies,
            pairs,
            settings: mechanics.settings,
        }
    }

    /// The most pressed contact of the sound scene.
    fn most_pressed(&self) -> usize {
        let condensed = Condensed::on(&self.bodies, &self.pairs, self.surface.clone()).unwrap();
        let problem = condensed.problem();
        let outcome = alternation::solve(problem, &self.settings).unwrap();
        let normal = |contact: &usize| outcome.reaction[problem.offsets()[*contact]];
        let contacts = 0..problem.contacts();
        contacts
            .min_by(|a, b| normal(a).total_cmp(&normal(b)))
            .unwrap()
    }

    /// Solves the scene, with one thing changed between two stages, and judges it.
    fn status(&self, sabotage: Option<(&Sabotage, usize)>) -> Result<Status, Error> {
        let mut surface = self.surface.clone();
        let size = |contact: usize| {
            let area = self.surface.nodes[contact].area;
            match self.bodies[0].mesh.dimension {
                2 => area,
                _ => area.sqrt(),
            }
        };
        if let Some((Sabotage::Contact(change), contact)) = sabotage {
            change(&mut surface.nodes[contact], size(contact));
        }
        let mut condensed = Condensed::on(&self.bodies, &self.pairs, surface)?;
        if let Some((Sabotage::Gaps(change), contact)) = sabotage {
            let mut gaps = condensed.problem().initial_gap().to_vec();
            change(&mut gaps, contact, size(contact));
            condensed.replace(condensed.problem().friction().to_vec(), gaps)?;
        }
        let mut outcome = match sabotage {
            Some((Sabotage::Problem(change), _)) => {
                alternation::solve(&change(condensed.problem()), &self.settings)?
            }
            _ => alternation::solve(condensed.problem(), &self.settings)?,
        };
        if let Some((Sabotage::Outcome(change), _)) = sabotage {
            change(&mut outcome);
        }
        let mut displacements = condensed.recover(&outcome.reaction, &outcome.motion)?;
        match sabotage {
            Some((Sabotage::Displacement(change), contact)) => {
                let ContactNode { body, own, .. } = &self.surface.nodes[contact];
                let axes = self.bodies[*body].mesh.dimension;
                change(&mut displacements[*body], own[0].0 * axes + axes - 1);
            }
            Some((Sabotage::SupportReaction, _)) => release(&condensed, &mut displacements),
            _ => {}
        }
        let geometry = SceneGeometry::new(&self.bodies, &self.pairs, condensed.surface())?;
        let measured = Measured::new(
            &self.bodies,
            &condensed,
            &geometry,
            &Acting::default(),
            (&outcome, &displacements),
        )?;
        Ok(measured.status(&outcome).0)
    }
}

/// Moves a held node until its support has no reaction left.
fn release(condensed: &Condensed, displacements: &mut [Vec<f64>]) {
    let (body, displacement) = (&condensed.bodies()[0], &mut displacements[0]);
    let stiffness = body.stiffness();
    let reaction = |unknown: usize| -> f64 {
        let row = stiffness.outer_view(unknown).unwrap();
        let force: f64 = row.iter().map(|(k, entry)| entry * displacement[k]).sum();
        force - body.load()[unknown]
    };
    let held = (0..displacement.len()).filter(|k| body.prescribed()[*k].is_some());
    let largest = held
        .max_by(|a, b| reaction(*a).abs().total_cmp(&reaction(*b).abs()))
        .unwrap();
    displacement[largest] -= reaction(largest) / stiffness.get(largest, largest).unwrap();
}

fn two_blocks(cell: &str, model: &str, low: &str, high: &str) -> String {
    let mesh = |block: &str| {
        let kind = if model == "solid" { "box" } else { "rectangle" };
        format!(r#"{{ "{kind}": {{ {block}, "cell": "{cell}" }} }}"#)
    };
    let model = match model {
        "solid" => String::new(),
        named => format!(r#""model": "{named}","#),
    };
    let axes = if model.is_empty() { 3 } else { 2 };
    let vector = |up: &str| format!("[{}{up}]", "0, ".repeat(axes - 1));
    format!(
        r#"{{ "bodies": [
            {{ "name": "low", "mesh": {}, {model} "materials": [{{ "young": 100, "poisson": 0.3 }}],
               "supports": [{{ "group": "bottom", "displacement": {} }}] }},
            {{ "name": "high", "mesh": {}, {model} "materials": [{{ "young": 60, "poisson": 0.25 }}],
               "supports": [{{ "group": "top", "displacement": {} }}] }}],
           "contacts": [{{ "body": "high", "group": "bottom", "friction": 0.3,
                           "against": {{ "body": "low", "group": "top" }} }}] }}"#,
        mesh(low),
        vector("0"),
        mesh(high),
        vector("-0.02"),
    )
}

fn scenes() -> Vec<(String, String)> {
    let plane = [
        r#""x": [0, 1], "y": [0, 0.5], "cells": [7, 3]"#,
        r#""x": [0.1, 0.9], "y": [0.5, 1], "cells": [5, 3]"#,
    ];
    let ring = [
        r#""x": [1, 2], "y": [0, 0.5], "cells": [7, 3]"#,
        r#""x": [1.1, 1.9], "y": [0.5, 1], "cells": [5, 3]"#,
    ];
    let space = [
        r#""x": [0, 1], "y": [0, 1], "z": [0, 0.5], "cells": [4, 4, 2]"#,
        r#""x": [0.1, 0.9], "y": [0.1, 0.9], "z": [0.5, 1], "cells": [3, 3, 2]"#,
    ];
    let mut scenes = Vec::new();
    for (cells, model, [low, high]) in [
        (&["quad4", "tri3", "quad8"][..], "plane_strain", plane),
        (&["quad4", "tri6"], "axisymmetric", ring),
        (&["hex8", "tet4", "hex20", "tet10"], "solid", space),
    ] {
        scenes.extend(cells.iter().map(|cell| {
            let name = format!("{model}, {cell}");
            (name, two_blocks(cell, model, low, high))
        }));
    }
    scenes
}

#[test]
fn no_sabotage_between_the_stages_is_certified() {
    let (mut tried, mut missed) = (0, Vec::new());
    for (name, scene) in scenes() {
        let stages = Stages::new(&scene);
        assert_eq!(stages.status(None), Ok(Status::Certified), "{name}");
        let contact = stages.most_pressed();
        for (what, sabotage) in &SABOTAGES {
            tried += 1;
            if stages.status(Some((sabotage, contact))) == Ok(Status::Certified) {
                missed.push(format!("{name}: {what}"));
            }
        }
    }
    assert_eq!((tried, missed), (9 * SABOTAGES.len(), Vec::new()));
}
