//! A second opinion on an answer, from the laws alone and in twice the working precision.
//!
//! ```text
//! u = û + G t + R α
//! certified        r_N = max(t_N, ρ_N (u_N − g₀)),   r_T = t_T − P(t_T − ρ_T u_T),   Rᵀ t + e   all small
//! no equilibrium   e · α > 0 while  v_N + μ ‖v_T‖ ≤ 0,  v = R α,  at every contact: no reaction
//!                  of Coulomb's cone works against the motion, the load works for it
//!
//! A resistance r of at most `e·α / (1000 · load)` still proves that no equilibrium has reactions below a thousand
//! times the load. `load` is the largest `|e_k| / size_k`, and `size_k` how far an amplitude of one moves the *bodies*:
//! at the contacts a mode may be nothing but round-off, as between two faces of one body.
//! ```

use dpana::problem::ContactProblem;
use dpana::alternation::{Outcome, Shortfall, Status};

use crate::accurate::Sum;

/// Part of the largest sum of sizes that rounding in working precision may cost.
const ROUNDING: f64 = 1e-14;

/// A witness that allows less than this would only see its own rounding.
const FINEST: f64 = 1e-11;

/// Smallest reaction that residuals are relative to, as a part of the load force.
const FLOOR: f64 = 1e-3;

/// Panics where an answer is not what its status says.
pub fn witness(problem: &ContactProblem, outcome: &Outcome, tolerance: f64) {
    assert_eq!(outcome.reaction.len(), problem.unknowns());
    assert_eq!(outcome.motion.len(), problem.free_modes());
    assert!(
        outcome.reaction.iter().all(|t| t.is_finite()),
        "{outcome:?}"
    );
    match outcome.status {
        Status::Certified => certified(problem, outcome, tolerance),
        Status::NoEquilibrium => impossible(problem, outcome),
        Status::CouplingFault => panic!("certified as a problem, and the bodies are elsewhere"),
        Status::NotConverged => {
            let unbalanced = matches!(
                outcome.shortfall,
                Some(Shortfall::OutOfBalance { .. } | Shortfall::IllConditioned { .. })
            );
            assert!(
                unbalanced || !(outcome.verdict.certificate.residual() <= tolerance),
                "good enough, but not certified"
            );
        }
    }
}

fn certified(problem: &ContactProblem, outcome: &Outcome, tolerance: f64) {
    let reaction = &outcome.reaction;
    let mut displacement = Vec::new();
    for (i, &free) in problem.free_displacement().iter().enumerate() {
        let mut sum = Sum::default();
        sum.add(free);
        for (j, &t) in reaction.iter().enumerate() {
            sum.add_product(problem.compliance()[(i, j)], t);
        }
        if let Some(floating) = problem.floating() {
            for (k, &amplitude) in outcome.motion.iter().enumerate() {
                sum.add_product(floating.modes()[(i, k)], amplitude);
            }
        }
        displacement.push(sum);
    }
    let (mut residual, mut rounding) = (0.0_f64, 0.0_f64);
    let steps = steps(problem);
    for (contact, ends) in problem.offsets().windows(2).enumerate() {
        let [normal, tangential] = steps[contact];
        let block = ends[0]..ends[1];
        let overlap = displacement[ends[0]].value() - problem.initial_gap()[contact];
        let t = &reaction[block.clone()];
        let r_normal = t[0].max(normal * overlap);
        let radius = -problem.friction()[contact] * t[0].min(0.0);
        let slip = displacement[block].iter().skip(1);
        let trial: Vec<f64> = t[1..]
            .iter()
            .zip(slip.clone())
            .map(|(t, u)| t - tangential * u.value())
            .collect();
        let reach = trial.iter().fold(0.0_f64, |sum, t| sum.hypot(*t));
        let shrink = if reach > radius { radius / reach } else { 1.0 };
        residual = residual.hypot(r_normal);
        for (t, trial) in t[1..].iter().zip(&trial) {
            residual = residual.hypot(t - shrink * trial);
        }
        let size = displacement[ends[0]].size() + problem.initial_gap()[contact].abs();
        rounding = rounding.hypot(normal * size);
        for u in slip {
            rounding = rounding.hypot(tangential * u.size());
        }
    }
    // Sums in twice the precision need products that do not overflow.
    if !rounding.is_finite() {
        return;
    }
    let scale = norm(reaction).max(FLOOR * load_force(problem, &steps));
    let allowed = (10.0 * tolerance).max(FINEST) * scale + ROUNDING * rounding;
    assert!(
        residual <= allowed,
        "certified, but the natural map is {residual:e} of {scale:e}"
    );
    balanced(problem, reaction, tolerance);
}

/// `Rᵀ t + e` against the largest sum of sizes of its terms, modes scaled to order one.
fn balanced(problem: &ContactProblem, reaction: &[f64], tolerance: f64) {
    let Some(floating) = problem.floating() else {
        return;
    };
    let (mut left, mut most) = (Vec::new(), 0.0_f64);
    for (k, &load) in floating.load().iter().enumerate() {
        let (mut sum, mut size) = (Sum::default(), 0.0_f64);
        sum.add(load);
        for (i, &t) in reaction.iter().enumerate() {
            sum.add_product(floating.modes()[(i, k)], t);
            size = size.max(floating.modes()[(i, k)].abs());
        }
        let size = if size > 0.0 { size } else { 1.0 };
        left.push(sum.value() / size);
        most = most.max(sum.size() / size);
    }
    for (k, left) in left.iter().enumerate() {
        assert!(
            left.abs() <= (10.0 * tolerance).max(FINEST) * most.max(norm(reaction)),
            "certified, but mode {k} is out of balance by {left:e} of {most:e}"
        );
    }
}

/// Reactions beyond this many times the load are as good as none.
const JAMMED: f64 = 1e3;

/// Most that rounding adds to `v_N + μ ‖v_T‖`, as a part of `|v_N| + μ ‖v_T‖`: v is a sum in twice the precision,
/// rounded once (ε/2); then come two roots (ε each), a product and a sum (ε/2 each).
const OWN: f64 = 4.0 * f64::EPSILON;

fn impossible(problem: &ContactProblem, outcome: &Outcome) {
    let (Some(floating), Some(failure)) = (problem.floating(), &outcome.failure) else {
        panic!("no equilibrium, but nothing floats or no motion is shown");
    };
    let (mut work, mut velocity) = (Sum::default(), vec![Sum::default(); problem.unknowns()]);
    for (k, &amplitude) in failure.motion.iter().enumerate() {
        work.add_product(floating.load()[k], amplitude);
        for (i, v) in velocity.iter_mut().enumerate() {
            v.add_product(floating.modes()[(i, k)], amplitude);
        }
    }
    assert!(work.value() > 0.0, "the load does not drive the motion");
    if failure.elastic {
        // Rigid bodies could be held, by reactions that these do not reach: the motion proves nothing of rigid ones.
        return;
    }
    let load = (floating.load().iter().zip(floating.sizes()))
        .map(|(e, size)| e.abs() / size)
        .fold(0.0, f64::max);
    for (contact, ends) in problem.offsets().windows(2).enumerate() {
        let slide = velocity[ends[0] + 1..ends[1]]
            .iter()
            .fold(0.0_f64, |sum, v| sum.hypot(v.value()));
        let (normal, rubbed) = (
            velocity[ends[0]].value(),
            problem.friction()[contact] * slide,
        );
        let resisted = normal + rubbed - OWN * (normal.abs() + rubbed);
        assert!(
            resisted * JAMMED * load <= work.value(),
            "contact {contact} resists, by {resisted:e}, a motion on which the load works {:e}",
            work.value()
        );
    }
}

/// `1/G_NN` and `2/tr G_TT` per contact; the largest of all where an entry is nothing.
fn steps(problem: &ContactProblem) -> Vec<[f64; 2]> {
    let diagonal = |i: usize| problem.compliance()[(i, i)];
    let most = (0..problem.unknowns()).map(diagonal).fold(0.0, f64::max);
    let mut steps: Vec<[f64; 2]> = problem
        .offsets()
        .windows(2)
        .map(|ends| {
            let tangents = ends[0] + 1..ends[1];
            let mean = tangents.clone().map(diagonal).sum::<f64>() / tangents.len() as f64;
            [diagonal(ends[0]), mean].map(|g| {
                if g > f64::EPSILON * most {
                    1.0 / g
                } else {
                    f64::NAN
                }
            })
        })
        .collect();
    let known = steps.iter().flatten().filter(|step| !step.is_nan());
    let widest = known.copied().fold(0.0, f64::max);
    let widest = if widest > 0.0 { widest } else { 1.0 };
    for step in steps.iter_mut().flatten().filter(|step| step.is_nan()) {
        *step = widest;
    }
    steps
}

/// Force that undoes the free displacement: the best multiple of it, or what local stiffnesses
/// make of it, whichever is less.
fn load_force(problem: &ContactProblem, steps: &[[f64; 2]]) -> f64 {
    let mut undone = problem.free_displacement().to_vec();
    let mut local = undone.clone();
    for (contact, ends) in problem.offsets().windows(2).enumerate() {
        undone[ends[0]] -= problem.initial_gap()[contact].min(0.0);
        local[ends[0]] = undone[ends[0]] * steps[contact][0];
        for i in ends[0] + 1..ends[1] {
            local[i] = undone[i] * steps[contact][1];
        }
    }
    let length = undone.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
    if length == 0.0 {
        return 0.0;
    }
    let (mut square, mut answer) = (Sum::default(), Sum::default());
    for (i, w) in undone.iter().enumerate() {
        square.add_product(w / length, w / length);
        for (j, v) in undone.iter().enumerate() {
            answer.add_product(problem.compliance()[(i, j)] * (w / length), v / length);
        }
    }
    let global = norm(&undone) * (square.value() / answer.value());
    if global > 0.0 {
        global.min(norm(&local))
    } else {
        norm(&local)
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |norm, x| norm.hypot(*x))
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use dpana::body::{CellKind, Facet, Group, Mesh};
    use dpana::scene::MeshSource;
    use dpana::{Scene, Status};

    use crate::witness;

    /// A clip of edge 3 with a slit along y = 1, three cells above it and two below: groups `upper` and `lower` for its
    /// faces, `top` for the loaded side.
    fn clip() -> Mesh {
        let mut mesh = Mesh::new(2, Vec::new());
        let mut number_of = HashMap::new();
        for (above, count, ys) in [(false, 2, [0.0, 1.0]), (true, 3, [1.0, 3.0])] {
            let mut xs: Vec<f64> = (0..=count)
                .map(|k| 2.0 * f64::from(k) / f64::from(count))
                .collect();
            xs.push(3.0);
            let mut number = |x: f64, y: f64| {
                let side = above && y == 1.0 && x < 2.0;
                *number_of
                    .entry((x.to_bits(), y.to_bits(), side))
                    .or_insert_with(|| {
                        mesh.nodes.push([x, y, 0.0]);
                        mesh.nodes.len() - 1
                    })
            };
            let cells: Vec<_> = xs
                .windows(2)
                .map(|x| {
                    [
                        number(x[0], ys[0]),
                        number(x[1], ys[0]),
                        number(x[1], ys[1]),
                        number(x[0], ys[1]),
                    ]
                })
                .collect();
            for cell in cells {
                mesh.push_cell(CellKind::Quad4, &cell);
            }
        }
        let facets = mesh.boundary_facets();
        let group = |y: f64, up: f64| -> Group {
            let on = |f: &&Facet| {
                f.nodes.iter().all(|n| mesh.nodes[*n][1] == y)
                    && mesh.facet_geometry(f).normal[1] * up > 0.0
            };
            Group::Facets(facets.iter().filter(on).cloned().collect())
        };
        let groups = [
            ("lower", group(1.0, 1.0)),
            ("upper", group(1.0, -1.0)),
            ("top", group(3.0, 1.0)),
        ];
        mesh.groups
            .extend(groups.map(|(name, group)| (name.to_owned(), group)));
        mesh
    }

    /// Nothing holds the clip, and it touches itself only: no contact feels its rigid motions, beside those of a block on
    /// a floor. (The mortar's weights left 1e-16 of them, by which the load was divided: "contact 1 resists, by
    /// 5.9e-17, a motion on which the load works 9.9".)
    #[test]
    fn a_body_that_only_touches_itself_is_not_held_whatever_round_off_says() {
        for [x, y] in [
            [1.0, 2.0],
            [-1.0, 2.0],
            [2.0, 0.3],
            [0.3, 3.0],
            [-2.0, -0.7],
        ] {
            let scene = format!(
                r#"{{"bodies": [
                    {{"name": "clip", "mesh": {{"file": "given in code"}}, "model": "plane_strain",
                      "materials": [{{"young": 1000, "poisson": 0.3}}],
                      "loads": [{{"group": "top", "traction": [{x}, {y}]}}]}},
                    {{"name": "block", "mesh": {{"rectangle": {{"x": [10, 11], "y": [0, 1], "cells": [2, 2]}}}},
                      "model": "plane_strain", "materials": [{{"young": 1000, "poisson": 0.3}}],
                      "loads": [{{"body_force": [0, -1]}}]}}],
                  "contacts": [
                    {{"body": "clip", "group": "upper", "against": {{"body": "clip", "group": "lower"}}, "friction": 0.3}},
                    {{"body": "block", "group": "bottom", "friction": 0.3,
                      "obstacle": {{"plane": {{"point": [0, 0], "normal": [0, 1]}}}}}}]}}"#
            );
            let mut scene = Scene::from_json(&scene, "").unwrap();
            scene.bodies[0].mesh = MeshSource::Given(clip());
            let solution = dpana::solve(&scene).unwrap();
            assert_eq!(solution.status(), Status::NoEquilibrium);
            witness(solution.condensed().problem(), solution.outcome(), 1e-12);
        }
    }
}
