//! Kinds of condensed problems that sweeps alone do not solve: soft blocks of a bad condition, rigid bodies whose
//! forces are not unique, capsules in a box, strong coupling in space; saved loads, and new ones at random.

use std::collections::BTreeMap;
use std::path::Path;

use dpana::alternation::{Outcome, Settings, Status, solve};
use dpana::problem::{ContactProblem, Operator};
use dpana::scene::BareProblem;
use faer::Mat;

/// What others reach on rigid bodies; and on elastic ones, whose operators have all ranks.
const RIGID: f64 = 1e-8;
const ELASTIC: f64 = 1e-10;

fn text(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/discrete");
    std::fs::read_to_string(folder.join(name)).unwrap()
}

fn load(name: &str) -> BareProblem {
    BareProblem::from_json(&text(name), name).unwrap()
}

fn solved(bare: &BareProblem, tolerance: f64) -> Outcome {
    let settings = Settings::default().with_tolerance(tolerance);
    solve(&bare.to_problem().unwrap(), &settings).unwrap()
}

/// Numbers that look random (xorshift), roughly normal: sums of twelve.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn part(&mut self) -> f64 {
        for (left, by) in [(true, 13), (false, 7), (true, 17)] {
            self.0 ^= if left { self.0 << by } else { self.0 >> by };
        }
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.part()).sum::<f64>() - 6.0
    }
}

/// `q + a W x` for a random x, the part a of ‖q‖ from 0.01 to 1: a load that reactions can answer.
fn reloaded(base: &BareProblem, seed: u64) -> BareProblem {
    let mut random = Random(0x9e37_79b9_7f4a_7c15 ^ (seed + 1).wrapping_mul(0x2545_f491_4f6c_dd1d));
    let force: Vec<f64> = base.q.iter().map(|_| random.normal()).collect();
    let mut moved = vec![0.0; base.q.len()];
    for ((&i, &j), w) in base.w_rows.iter().zip(&base.w_cols).zip(&base.w_values) {
        moved[i] += w * force[j];
    }
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let part = [0.01, 0.03, 0.1, 0.3, 1.0][seed as usize % 5] * norm(&base.q) / norm(&moved);
    let mut bare = base.clone();
    for (q, moved) in bare.q.iter_mut().zip(moved) {
        *q += part * moved;
    }
    bare
}

/// Most Newton steps, and the sum over all loads.
#[derive(Debug, Default)]
struct Effort {
    most: usize,
    all: usize,
}

/// Solves sixty new loads of a kind.
fn new_loads(name: &str, tolerance: f64) -> Effort {
    let base = load(name);
    let mut effort = Effort::default();
    for seed in 0..60 {
        let outcome = solved(&reloaded(&base, seed), tolerance);
        assert_eq!(
            outcome.status,
            Status::Certified,
            "{name}, load {seed}: {:e}",
            outcome.verdict.certificate.residual()
        );
        effort.most = effort.most.max(outcome.work.newton_steps);
        effort.all += outcome.work.newton_steps;
    }
    effort
}

#[test]
fn a_soft_block_under_its_saved_loads_is_certified() {
    let base = load("fem_float_N4_mu0.4_dt300_q3.json");
    let others: BTreeMap<String, Vec<f64>> =
        serde_json::from_str(&text("fem_float_N4_mu0.4_dt300_loads.json")).unwrap();
    for q in [base.q.clone()].into_iter().chain(others.into_values()) {
        let bare = BareProblem { q, ..base.clone() };
        let outcome = solved(&bare, ELASTIC);
        assert_eq!(outcome.status, Status::Certified, "{:?}", outcome.work);
        assert!(outcome.work.sweeps <= 2, "{:?}", outcome.work);
    }
}

#[test]
fn rigid_bodies_that_sweeps_do_not_settle_are_certified() {
    for name in [
        "OneObject-i1028-138~sym_q3.json",
        "Capsules-i101-404~sym.json",
    ] {
        let outcome = solved(&load(name), RIGID);
        assert_eq!(
            outcome.status,
            Status::Certified,
            "{name}: {:?}",
            outcome.work
        );
        assert!(outcome.work.sweeps <= 2, "{name}: {:?}", outcome.work);
    }
}

#[test]
fn a_soft_block_is_certified_under_new_loads() {
    let effort = new_loads("fem_float_N4_mu0.4_dt300_q3.json", ELASTIC);
    assert!(effort.most <= 100 && effort.all <= 60 * 20, "{effort:?}");
}

#[test]
fn elastic_bodies_are_certified_under_new_loads() {
    for name in ["fem_float_N4_mu0.4_dt10.json", "fem_static_N4_mu0.8.json"] {
        let effort = new_loads(name, ELASTIC);
        assert!(
            effort.most <= 60 && effort.all <= 60 * 15,
            "{name}: {effort:?}"
        );
    }
}

#[test]
fn rigid_bodies_are_certified_under_new_loads() {
    for name in [
        "OneObject-i1028-138~sym_q3.json",
        "Box_Stacks-i0122-82-5.json",
        "Confeti-ex03-Fc3D-SBM.json",
        "FC3D_Example1.json",
        "FrictionContactProblem00374.json",
        "NESpheres_30_1.json",
    ] {
        let effort = new_loads(name, RIGID);
        assert!(
            effort.most <= 300 && effort.all <= 60 * 40,
            "{name}: {effort:?}"
        );
    }
}

#[test]
#[ignore = "sixty times 225 contacts take a minute"]
fn capsules_are_certified_under_new_loads() {
    let effort = new_loads("Capsules-i101-404~sym.json", RIGID);
    assert!(effort.all <= 60 * 100, "{effort:?}");
}

/// 4 to 30 contacts in space, each coupled with every other, μ from 5 to 100.
pub(crate) fn coupled(random: &mut Random) -> ContactProblem {
    let contacts = 4 + (random.part() * 27.0) as usize;
    let size = 3 * contacts;
    let a = Mat::from_fn(size, size, |_, _| 2.0 * random.part() - 1.0);
    let product = a.transpose() * &a;
    let shift = [0.01, 0.1, 0.3][(random.part() * 3.0) as usize];
    let compliance = Mat::from_fn(size, size, |i, j| {
        product[(i.min(j), i.max(j))] / size as f64 + if i == j { shift } else { 0.0 }
    });
    let friction = (0..contacts).map(|_| 5.0 * 20.0_f64.powf(random.part()));
    ContactProblem::new(
        &vec![2; contacts],
        friction.collect(),
        vec![0.0; contacts],
        (0..size).map(|_| 2.0 * random.part() - 1.0).collect(),
        Operator::from_compliance(compliance).unwrap(),
    )
    .unwrap()
}

/// Sweeps and proximal steps lose one in a hundred (the 37th goes round in circles beside a state that is none, from
/// every start); a path of contacts that are joined leads to all of them where this was written.
#[test]
fn strong_coupling_in_space_is_certified_but_for_two_in_fifteen_hundred() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let outcomes = (0..1500).map(|number| {
        let outcome = solve(&coupled(&mut random), &Settings::default()).unwrap();
        (number, outcome)
    });
    let lost = outcomes.filter(|(_, outcome)| outcome.status != Status::Certified);
    let lost = lost.map(|(number, outcome)| (number, outcome.verdict.certificate.residual()));
    let lost: Vec<(usize, f64)> = lost.collect();
    assert!(lost.len() <= 2, "{lost:?}");
}
