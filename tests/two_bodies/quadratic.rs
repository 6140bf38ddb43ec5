//! Curved quadratic facets between two bodies whose meshes do not match: Lamé's tubes and balls,
//! torsion through a joint, one stress across a bent cut.

use std::f64::consts::{FRAC_PI_2, TAU};

use dpana::body::{CellKind, rectangle};
use dpana::report::{Contact, Report};
use dpana::scene::{MeshSource, SceneBody, SceneContact, SceneLoad, SceneObstacle, SceneSupport};

use crate::rounds::{Wall, bent, octant, quarter, quarter_disc, quarter_square, tube};
use crate::stacks::{body, certified, contact, hold, scene};

/// The inner body reaches out to 2.01, the outer one in to 1.99; their other sides are at 1 and 3.
const RADII: [f64; 2] = [2.01, 1.99];

fn walls(dimension: i32) -> [Wall; 2] {
    [(2000.0, 0.3), (1000.0, 0.2)].map(|(young, poisson)| Wall {
        dimension,
        young,
        poisson,
    })
}

/// Force per angle (tubes) or solid angle (balls) between the two: what it gives closes the fit.
fn force_per_angle(dimension: i32, held: bool) -> f64 {
    let [inner, outer] = walls(dimension);
    let [r_1, r_2] = RADII;
    let across = |r: f64| r.powi(dimension - 1);
    let given =
        inner.given(r_1, 1.0, held) / across(r_1) + outer.given(r_2, 3.0, held) / across(r_2);
    (r_1 - r_2) / given
}

/// The two surfaces that meet, the one named first being that of the inner body or not.
fn pair(inner_first: bool, friction: f64) -> SceneContact {
    let (inner, outer) = (["inner", "top"], ["outer", "bottom"]);
    match inner_first {
        true => contact(inner, outer, friction),
        false => contact(outer, inner, friction),
    }
}

/// What is balanced to round-off, whatever the mesh: forces across the joint, the laws, the bodies.
fn check_balance(report: &Report) {
    let exchange = report.totals.pairs[0].exchange.as_ref().unwrap();
    assert!(exchange.force_defect.scaled < 1e-14, "{exchange:?}");
    assert!(report.certificate.natural_map < 1e-12);
    for body in &report.certificate.bodies {
        assert!(body.force_defect.scaled < 1e-12, "{body:?}");
        assert!(body.moment_defect.scaled < 1e-12, "{body:?}");
    }
}

/// Errors of the pressure relative to `expected`: the largest, and the mean square over the area.
fn pressure_errors(report: &Report, expected: impl Fn(&Contact) -> f64) -> [f64; 2] {
    let (mut worst, mut squares, mut area) = (0.0_f64, 0.0, 0.0);
    for contact in &report.contacts {
        let off = contact.pressure.unwrap() / expected(contact) - 1.0;
        worst = worst.max(off.abs());
        squares += contact.area * off * off;
        area += contact.area;
    }
    [worst, (squares / area).sqrt()]
}

/// Orders at which two errors fall from one number of cells to the next: per step, per error. They are asked
/// for less a twentieth, as meshes this coarse are not yet in the limit.
fn orders(errors: [[f64; 2]; 3], cells: [usize; 3]) -> [[f64; 2]; 2] {
    [0, 1].map(|step| {
        let refined = cells[step + 1] as f64 / cells[step] as f64;
        [0, 1].map(|k| (errors[step][k] / errors[step + 1][k]).ln() / refined.ln())
    })
}

/// Kinds of the inner and the outer body.
const PLANE: [[CellKind; 2]; 4] = [
    [CellKind::Quad8; 2],
    [CellKind::Quad9; 2],
    [CellKind::Tri6; 2],
    [CellKind::Tri6, CellKind::Quad8],
];
const SOLID: [[CellKind; 2]; 4] = [
    [CellKind::Hex20; 2],
    [CellKind::Hex27; 2],
    [CellKind::Tet10; 2],
    [CellKind::Tet10, CellKind::Hex20],
];

#[test]
fn a_tube_shrunk_onto_another_presses_as_lame_says() {
    // A contact has one normal, while its facets turn by the angle h each: order two, about h²/4, and up to half
    // as much again where the facets of both sides meet badly.
    let force = force_per_angle(2, true);
    let [one, two] = walls(2);
    for kinds in PLANE {
        for inner_first in [true, false] {
            let errors = [2, 4, 8].map(|n| {
                let inner = tube(kinds[0], [1.0, RADII[0]], [8 * n, n], 0.0);
                let outer = tube(kinds[1], [RADII[1], 3.0], [12 * n, n], 0.1);
                let mut inner = body("inner", inner, one.young, one.poisson);
                let mut outer = body("outer", outer, two.young, two.poisson);
                for axis in [0, 1] {
                    inner = hold(inner, "bottom", axis, 0.0);
                    outer = hold(outer, "top", axis, 0.0);
                }
                let (_, report) =
                    certified(&scene(vec![inner, outer], vec![pair(inner_first, 0.0)]));
                check_balance(&report);
                let radius = RADII[usize::from(!inner_first)];
                let [worst, _] = pressure_errors(&report, |_| force / radius);
                let total = report.totals.normal / (force * TAU) - 1.0;
                let facet = TAU / report.contacts.len() as f64;
                assert!(worst < 0.35 * facet * facet, "{kinds:?} {n} {worst:e}");
                assert!(total.abs() < 0.3 * facet * facet, "{kinds:?} {n} {total:e}");
                [worst, total.abs()]
            });
            let orders = orders(errors, [2, 4, 8]);
            assert!(
                orders.iter().all(|step| step[1] > 1.9),
                "{kinds:?} {orders:?}"
            );
        }
    }
}

#[test]
fn a_symmetry_plane_cuts_a_tube_without_a_trace() {
    // The contacts on the planes of a quarter are those of the whole tube, with the same h²/4.
    let force = force_per_angle(2, false);
    let [one, two] = walls(2);
    for kinds in PLANE {
        for inner_first in [true, false] {
            let errors = [2, 4, 8].map(|n| {
                let inner = quarter(kinds[0], [1.0, RADII[0]], [2 * n, n]);
                let outer = quarter(kinds[1], [RADII[1], 3.0], [3 * n, n]);
                let inner = body("inner", inner, one.young, one.poisson);
                let outer = body("outer", outer, two.young, two.poisson);
                let on_planes = |ring| hold(hold(ring, "left", 0, 0.0), "right", 1, 0.0);
                let bodies = [inner, outer].map(on_planes).to_vec();
                let (_, report) = certified(&scene(bodies, vec![pair(inner_first, 0.0)]));
                check_balance(&report);
                let radius = RADII[usize::from(!inner_first)];
                let [worst, _] = pressure_errors(&report, |_| force / radius);
                let total = report.totals.normal / (force * FRAC_PI_2) - 1.0;
                let facet = FRAC_PI_2 / (report.contacts.len() - 1) as f64;
                assert!(worst < 0.4 * facet * facet, "{kinds:?} {n} {worst:e}");
                [worst, total.abs()]
            });
            let orders = orders(errors, [2, 4, 8]);
            assert!(
                orders.iter().all(|step| step[1] > 1.9),
                "{kinds:?} {orders:?}"
            );
        }
    }
}

#[test]
fn a_ball_shrunk_onto_another_presses_as_lame_says() {
    let force = force_per_angle(3, false);
    let [one, two] = walls(3);
    for kinds in SOLID {
        for inner_first in [true, false] {
            let errors = [1, 2, 3].map(|n| {
                let inner = octant(kinds[0], [1.0, RADII[0]], [2 * n, n]);
                let outer = octant(kinds[1], [RADII[1], 3.0], [3 * n, n]);
                let inner = body("inner", inner, one.young, one.poisson);
                let outer = body("outer", outer, two.young, two.poisson);
                let held = [inner, outer].map(|ball| on_planes(ball, &["x", "y", "z"]));
                let bodies = held.to_vec();
                let (_, report) = certified(&scene(bodies, vec![pair(inner_first, 0.0)]));
                check_balance(&report);
                let radius = RADII[usize::from(!inner_first)];
                let [_, mean] = pressure_errors(&report, |_| force / (radius * radius));
                let total = report.totals.normal / (force * FRAC_PI_2) - 1.0;
                [mean, total.abs()]
            });
            // The coarsest has two or three facets along an edge: its total may be good by chance, and the next
            // step is held to a tenth less than two.
            let orders = orders(errors, [1, 2, 3]);
            assert!(
                orders.iter().all(|step| step[0] > 1.9),
                "{kinds:?} {orders:?}"
            );
            assert!(orders[1][1] > 1.8, "{kinds:?} {orders:?}");
        }
    }
}

#[test]
fn a_shrunk_joint_carries_torsion_until_it_slips_all_round() {
    // u_θ = M/(4πG) (r/r_k² − 1/r) in wall k and no other stress: M₁ = 2π r₁ Q from within, Q the
    // friction per radian, M₂ = 2π r₂ Q from outside, a gap apart. Stuck, M₁ y₁ r₁ + M₂ y₂ r₂ = r₂ turn
    // with y₁ = (1 − 1/r₁²)/(4πG₁), y₂ = (1/r₂² − 1/9)/(4πG₂); else Q = μ · the normal force.
    let force = force_per_angle(2, true);
    let [one, two] = walls(2);
    let [r_1, r_2] = RADII;
    let friction = 0.2;
    let limit = TAU * r_1 * friction * force;
    let y_1 = (1.0 - 1.0 / (r_1 * r_1)) / (2.0 * TAU * one.shear());
    let y_2 = (1.0 / (r_2 * r_2) - 1.0 / 9.0) / (2.0 * TAU * two.shear());
    let yielding = (y_1 * r_1 * r_1 + y_2 * r_2 * r_2) / (r_1 * r_2);
    for kinds in PLANE {
        for (turn, expected) in [(0.5, 0.5 * limit), (2.0, limit)] {
            for n in [2, 4, 8] {
                let inner = tube(kinds[0], [1.0, r_1], [8 * n, n], 0.0);
                let outer = tube(kinds[1], [r_2, 3.0], [12 * n, n], 0.1);
                let mut inner = body("inner", inner, one.young, one.poisson);
                for axis in [0, 1] {
                    inner = hold(inner, "bottom", axis, 0.0);
                }
                let outer = body("outer", outer, two.young, two.poisson);
                let outer = turned(outer, turn * limit * yielding);
                let (_, report) = certified(&scene(vec![inner, outer], vec![pair(true, friction)]));
                check_balance(&report);
                let total = &report.totals;
                let all = report.contacts.len();
                assert_eq!(
                    [total.stick, total.slip],
                    if turn < 1.0 { [all, 0] } else { [0, all] }
                );
                // Stuck, only the cells are wrong; slipping, so is the pressure, by h²/4: 0.005 is a guard that it
                // has no part before.
                let off = (total.moment[0].abs() / expected - 1.0).abs();
                let facet = TAU / all as f64;
                let share = if turn < 1.0 { 0.005 } else { 0.25 };
                assert!(off < share * facet * facet, "{kinds:?} {turn} {n} {off:e}");
            }
        }
    }
}

/// The body with its outer side, of radius 3, turned by an angle; displacements are small.
fn turned(mut outer: SceneBody, turn: f64) -> SceneBody {
    let MeshSource::Given(mesh) = &outer.mesh else {
        unreachable!();
    };
    let rim = mesh.nodes.iter().filter(|x| x[0].hypot(x[1]) > 3.0 - 1e-9);
    let supports = rim.map(|[x, y, _]| SceneSupport::At {
        at: vec![*x, *y],
        displacement: vec![Some(-turn * y), Some(turn * x)],
    });
    outer.supports = supports.collect();
    outer
}

/// Holds a body on planes through the origin, each named by the coordinate that vanishes there.
fn on_planes(body: SceneBody, planes: &[&str]) -> SceneBody {
    let planes = planes.iter().enumerate();
    planes.fold(body, |body, (axis, plane)| hold(body, plane, axis, 0.0))
}

fn press(group: &str, pressure: f64) -> SceneLoad {
    SceneLoad::Pressure {
        pressure,
        group: group.into(),
    }
}

#[test]
fn one_stress_passes_a_disc_in_a_hole_of_its_size() {
    // σ_x = −1, σ_y = −σ in both: p = n_x² + σ n_y², friction (1 − σ) n_x n_y ≤ 0.36 p holds for σ = ½.
    for kinds in PLANE {
        for (across, friction) in [(1.0, 0.0), (0.5, 0.5)] {
            for cells in [[2, 3], [3, 2]] {
                let errors = [1, 2, 4].map(|n| {
                    let inner = quarter_disc(kinds[0], cells[0] * n);
                    let outer = quarter_square(kinds[1], cells[1] * n);
                    let inner = on_planes(body("inner", inner, 1000.0, 0.3), &["x", "y"]);
                    let mut outer = on_planes(body("outer", outer, 1000.0, 0.3), &["x", "y"]);
                    outer.loads = vec![press("right", 1.0), press("above", across)];
                    let (_, report) =
                        certified(&scene(vec![inner, outer], vec![pair(true, friction)]));
                    check_balance(&report);
                    assert!(friction == 0.0 || report.totals.stick == report.contacts.len());
                    pressure_errors(&report, |contact| {
                        let x = &contact.position;
                        x[0] * x[0] + across * x[1] * x[1]
                    })
                });
                // Symmetry planes undo the error of the ends: orders come out above two, of which 2.2 is a guard.
                let orders = orders(errors, [1, 2, 4]);
                assert!(
                    orders.as_flattened().iter().all(|order| *order > 2.2),
                    "{orders:?}"
                );
            }
        }
    }
}

#[test]
fn one_pressure_passes_a_ball_in_another() {
    for kinds in SOLID {
        for cells in [[2, 3], [3, 2]] {
            let errors = [1, 2, 3].map(|n| {
                let ball = |name, kind, radii, cells: usize, side| {
                    let mesh = octant(kind, radii, [cells * n, n]);
                    let mut ball = on_planes(body(name, mesh, 100.0, 0.3), &["x", "y", "z"]);
                    ball.loads.push(press(side, 1.0));
                    ball
                };
                let inner = ball("inner", kinds[0], [1.0, 2.0], cells[0], "bottom");
                let outer = ball("outer", kinds[1], [2.0, 3.0], cells[1], "top");
                let (_, report) = certified(&scene(vec![inner, outer], vec![pair(true, 0.0)]));
                check_balance(&report);
                pressure_errors(&report, |_| 1.0)
            });
            let orders = orders(errors, [1, 2, 3]);
            assert!(
                orders.iter().all(|step| step[1] > 1.9),
                "{kinds:?} {orders:?}"
            );
        }
    }
}

/// Two halves of a block of edge 1 on two symmetry planes, cut along a circle of radius √6 about the
/// one of them, the upper one first.
fn cut(kinds: [CellKind; 2], cells: [usize; 2]) -> [SceneBody; 2] {
    let height = |x: f64| (6.0 - x * x).sqrt() - 1.7;
    [("upper", kinds[0], cells[0]), ("lower", kinds[1], cells[1])].map(|(name, kind, count)| {
        let mesh = bent(kind, [count, count.div_ceil(2)], |[x, y, _]| {
            let at = height(x);
            let up = match name {
                "upper" => at + (1.0 - at) * y,
                _ => at * y,
            };
            [x, up, 0.0]
        });
        hold(body(name, mesh, 1000.0, 0.3), "left", 0, 0.0)
    })
}

#[test]
fn one_stress_passes_a_bent_cut_up_to_its_free_end() {
    // Pressed from above by 1: p = n_y² = 1 − x²/6, and friction holds. The normal of a contact stands
    // for all of what ψ spreads its force over: in every facet of length h along a circle of radius R
    // that adds a friction p h/R (2s − 1), 0 ≤ s ≤ 1, of first moment p h³/(6R), and all facets together a
    // pair of forces p h²/(6R) at the ends of the surface. On a symmetry plane the mirror image undoes
    // it; at a free end the pressure of the last contact is of first order, its mean of order 3/2.
    for kinds in PLANE {
        for cells in [[2, 3], [3, 2]] {
            let errors = [2, 4, 8].map(|n| {
                let [mut upper, lower] = cut(kinds, cells.map(|count| n * count));
                let lower = hold(lower, "bottom", 1, 0.0);
                upper.loads.push(press("top", 1.0));
                let met = contact(["upper", "bottom"], ["lower", "top"], 1.0);
                let (_, report) = certified(&scene(vec![upper, lower], vec![met]));
                assert_eq!(report.totals.stick, report.contacts.len());
                assert!((report.totals.contact_force[1] - 1.0).abs() < 1e-13);
                check_balance(&report);
                pressure_errors(&report, |contact| 1.0 - contact.position[0].powi(2) / 6.0)
            });
            // That pair of forces on the last half facet is a pressure of p h/(3R), 0.0085 with h = 1/16; a third more.
            assert!(errors[2][0] < 0.011, "{kinds:?} {errors:?}");
            let orders = orders(errors, [2, 4, 8]);
            let expected = |step: &[f64; 2]| step[0] > 0.95 && step[1] > 1.45;
            assert!(orders.iter().all(expected), "{kinds:?} {orders:?}");
        }
    }
}

#[test]
fn a_contact_at_a_corner_that_is_held_keeps_its_normal_however_the_scene_is_turned() {
    // Two squares side by side, their tops given, on a plane: what carries what is the same at every angle.
    let forces = |angle: f64| {
        let (sin, cos) = f64::sin_cos(angle);
        let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
        let part = |name: &str, from: f64| {
            let mut mesh = rectangle(&[from, from + 1.0], &[0.0, 1.0], CellKind::Quad8).unwrap();
            for node in &mut mesh.nodes {
                let [x, y] = turn([node[0], node[1]]);
                *node = [x, y, 0.0];
            }
            let [x, y] = turn([0.002, -0.01]);
            hold(
                hold(body(name, mesh, 1000.0, 0.3), "top", 0, x),
                "top",
                1,
                y,
            )
        };
        let on_plane = |name: &str| {
            let plane = SceneObstacle::plane(&[0.0, 0.0], &turn([0.0, 1.0]));
            SceneContact::on(plane, "bottom", 0.3).of(name)
        };
        let side = contact(["one", "right"], ["two", "left"], 0.3);
        let contacts = vec![side, on_plane("one"), on_plane("two")];
        let scene = scene(vec![part("one", 0.0), part("two", 1.0)], contacts);
        certified(&scene).1.totals.normal
    };
    let straight = forces(0.0);
    for angle in [0.3, 1.0, 2.0] {
        let off = forces(angle) / straight - 1.0;
        assert!(off.abs() < 1e-9, "{angle} {off}");
    }
}
