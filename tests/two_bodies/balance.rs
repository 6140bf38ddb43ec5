//! Whatever the two sides of a contact look like, what one receives the other gives: forces and
//! moments balance to round-off, also where the faces are curved and their meshes do not match.

use dpana::body::{CellKind, Mesh};
use dpana::contact::ContactNode;
use dpana::report::{Contact, Report};
use dpana::{Scene, Solution};
use nalgebra::Vector3;

use crate::stacks::{block, body, certified, contact, hold, scene};

/// How a block is bent: its last coordinate, from 0 where the blocks meet, becomes the radius
/// less 2.
type Bend = fn([f64; 3]) -> [f64; 3];

/// A plane arc of one radian.
fn arc([x, y, _]: [f64; 3]) -> [f64; 3] {
    let (angle, r) = (x - 0.5, 2.0 + y);
    [r * angle.sin(), r * angle.cos(), 0.0]
}

/// A wave across the blocks, the same in both.
fn wave([x, y, _]: [f64; 3]) -> [f64; 3] {
    [x, y + 0.04 * (6.0 * x).sin(), 0.0]
}

/// Part of a sphere: quadrilaterals are warped and no parallelograms.
fn dome([x, y, z]: [f64; 3]) -> [f64; 3] {
    let ray = Vector3::new(x - 0.5, y - 0.5, 1.0).normalize();
    (ray * (2.0 + z)).into()
}

/// A saddle.
fn saddle([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x, y, z + 0.3 * (x - 0.4) * (y - 0.6)]
}

const CASES: [([CellKind; 2], [usize; 2], Bend); 6] = [
    ([CellKind::Quad4; 2], [11, 8], arc),
    ([CellKind::Quad4, CellKind::Tri3], [11, 8], wave),
    ([CellKind::Tri3, CellKind::Quad4], [5, 9], arc),
    ([CellKind::Hex8; 2], [5, 4], dome),
    ([CellKind::Tet4, CellKind::Hex8], [4, 5], dome),
    ([CellKind::Hex8, CellKind::Tet4], [5, 4], saddle),
];

/// Two bent blocks, `gap` apart, their backs held; the upper one is pushed by a vector.
fn bent(
    (kinds, cells, bend): ([CellKind; 2], [usize; 2], Bend),
    gap: f64,
    push: [f64; 3],
    friction: f64,
) -> Scene {
    let dimension = kinds[0].dimension();
    let mesh = |at: usize| -> Mesh {
        let (mut low, mut high) = ([0.0; 3], [1.0; 3]);
        (low[dimension - 1], high[dimension - 1]) = [(-1.0, 0.0), (gap, 1.0)][at];
        let mut mesh = block(kinds[at], low, high, [cells[at]; 3]);
        for node in &mut mesh.nodes {
            *node = bend(*node);
        }
        mesh
    };
    let mut lower = body("lower", mesh(0), 1000.0, 0.3);
    let mut upper = body("upper", mesh(1), 3000.0, 0.2);
    for (axis, push) in push.into_iter().enumerate().take(dimension) {
        lower = hold(lower, "bottom", axis, 0.0);
        upper = hold(upper, "top", axis, push);
    }
    let pair = contact(["upper", "bottom"], ["lower", "top"], friction);
    scene(vec![lower, upper], vec![pair])
}

fn push(dimension: usize, sideways: f64) -> [f64; 3] {
    match dimension {
        2 => [sideways, -0.02, 0.0],
        _ => [sideways, 0.5 * sideways, -0.02],
    }
}

/// Forces and moments of each body with its loads and supports, and forces of the sides.
fn check_balance(report: &Report, place: &str) {
    for body in &report.certificate.bodies {
        assert!(body.force_defect.scaled < 1e-13, "{place} {body:?}");
        assert!(body.moment_defect.scaled < 1e-13, "{place} {body:?}");
        assert!(body.equilibrium.scaled < 1e-12, "{place} {body:?}");
    }
    let exchange = report.totals.pairs[0].exchange.as_ref().unwrap();
    assert!(exchange.force_defect.scaled < 1e-14, "{place} {exchange:?}");
    let (given, received) = (&exchange.opposite, &report.certificate.bodies[0].contact);
    for (a, b) in [
        (&given.force, &received.force),
        (&given.moment, &received.moment),
    ] {
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-13 * report.totals.normal);
    }
}

fn length(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Distance of where both sides are pushed, times friction force, summed over the contacts, in newton metre.
fn gap_times_friction(solution: &Solution, report: &Report) -> f64 {
    let friction = |c: &Contact| length(c.friction_traction.as_ref().unwrap()) * c.area;
    let moments = report
        .contacts
        .iter()
        .zip(&solution.condensed().surface().nodes);
    let apart = |node: &ContactNode| {
        let opposite = node.opposite.as_ref().unwrap();
        let nodes = [node.body, opposite.body].map(|body| &solution.bodies()[body].mesh.nodes);
        let of = |side: usize, weights: &[(usize, f64)]| -> Vector3<f64> {
            let terms = weights.iter();
            terms
                .map(|(k, w)| Vector3::from(nodes[side][*k]) * *w)
                .sum()
        };
        (of(0, &node.own) - of(1, &opposite.nodes)).norm()
    };
    moments.map(|(c, node)| apart(node) * friction(c)).sum()
}

#[test]
fn pressures_on_curved_faces_balance_in_force_and_moment() {
    for case in CASES {
        for gap in [0.0, 0.005] {
            let push = push(case.0[0].dimension(), 0.003);
            let (_, report) = certified(&bent(case, gap, push, 0.0));
            let place = format!("{:?} {gap}", case.0);
            check_balance(&report, &place);
            assert!(report.totals.normal > 1.0, "{place}");
            let exchange = report.totals.pairs[0].exchange.as_ref().unwrap();
            assert!(
                exchange.moment_defect.scaled < 1e-14,
                "{place} {exchange:?}"
            );
        }
    }
}

#[test]
fn friction_on_curved_faces_balances_up_to_gap_times_friction() {
    for case in CASES {
        let push = push(case.0[0].dimension(), 0.003);
        let (solution, report) = certified(&bent(case, 0.0, push, 0.3));
        let place = format!("{:?}", case.0);
        check_balance(&report, &place);
        assert!(length(&report.totals.friction) > 0.1, "{place}");
        let exchange = report.totals.pairs[0].exchange.as_ref().unwrap();
        let allowed = gap_times_friction(&solution, &report);
        assert!(exchange.moment_defect.value <= allowed + 1e-12, "{place}");
        // Facets of length h stand off each other by h²/(8R), some 2e-3 here, times μ.
        assert!(exchange.moment_defect.scaled < 1e-3, "{place} {exchange:?}");
    }
}
