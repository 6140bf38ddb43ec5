//! Stacks of bodies, cracks in one, pairs that share nodes or stand twice, gaps and fits: what is
//! exact stays exact, and what is unique is found.

use std::f64::consts::PI;

use dpana::body::{CellKind, Facet, Group, Mesh, graded, rectangle};
use dpana::report::{Contact, Report};
use dpana::scene::{MeshSource, SceneBody, SceneContact, SceneLoad};
use dpana::{Scene, Solution, Status, solve};

use crate::stacks::{block, body, certified, contact, hold, hold_at, scene};

/// A block of base 1 between two heights, on the symmetry planes of its left and its front.
fn layer(
    name: &str,
    kind: CellKind,
    heights: [f64; 2],
    cells: usize,
    (young, poisson): (f64, f64),
) -> SceneBody {
    let up = kind.dimension() - 1;
    let (mut low, mut high) = ([0.0; 3], [1.0; 3]);
    (low[up], high[up]) = (heights[0], heights[1]);
    let mut body = body(name, block(kind, low, high, [cells; 3]), young, poisson);
    for (axis, side) in ["left", "front"].into_iter().enumerate().take(up) {
        body = hold(body, side, axis, 0.0);
    }
    body
}

/// Shortening per pressure: (1 − ν²)/E in plane strain, 1/E in a solid.
fn shortening(kind: CellKind, (young, poisson): (f64, f64)) -> f64 {
    match kind.dimension() {
        2 => (1.0 - poisson * poisson) / young,
        _ => 1.0 / young,
    }
}

/// `digit` is 1e-10 below: certified to 1e-12, and two digits for the condition of G.
fn check_pressure<'a>(contacts: impl IntoIterator<Item = &'a Contact>, expected: f64, digit: f64) {
    for contact in contacts {
        let off = (contact.pressure.unwrap() / expected - 1.0).abs();
        assert!(off < digit, "{off:e} {contact:?}");
        for q in contact.friction_traction.as_ref().unwrap() {
            assert!(q.abs() < digit * expected, "{contact:?}");
        }
    }
}

/// Elastic constants that differ, but widen alike only where they are the same.
const SAME: [(f64, f64); 3] = [(1000.0, 0.3); 3];
const UNLIKE: [(f64, f64); 3] = [(1000.0, 0.3), (200.0, 0.45), (4000.0, 0.1)];

/// Three layers, pressed by 2: the top goes down, the middle one is held at one node where it
/// would be anyway.
fn three_layers(kind: CellKind, materials: [(f64, f64); 3], pairs: Vec<SceneContact>) -> Scene {
    let up = kind.dimension() - 1;
    let heights = [0.0, 1.0, 1.5, 2.2];
    let cells = if up == 1 { [5, 7, 4] } else { [3, 4, 2] };
    let mut bodies = Vec::new();
    let mut sunk = 0.0;
    for (at, name) in ["low", "middle", "high"].into_iter().enumerate() {
        let [from, to] = [heights[at], heights[at + 1]];
        let mut body = layer(name, kind, [from, to], cells[at], materials[at]);
        let strain = 2.0 * shortening(kind, materials[at]);
        body = match at {
            0 => hold(body, "bottom", up, 0.0),
            1 => {
                let MeshSource::Given(mesh) = &body.mesh else {
                    unreachable!();
                };
                let inside = |x: &&[f64; 3]| x[up] > from && x[up] < to;
                let pin = *mesh.nodes.iter().find(inside).unwrap();
                hold_at(body, pin, up, -sunk - strain * (pin[up] - from))
            }
            _ => hold(body, "top", up, -sunk - strain * (to - from)),
        };
        sunk += strain * (to - from);
        bodies.push(body);
    }
    scene(bodies, pairs)
}

#[test]
fn three_blocks_in_a_stack_carry_one_pressure() {
    // The middle one touches both others, at either face with a friction of its own.
    for kind in CellKind::LINEAR {
        for (materials, friction) in [(SAME, [0.2, 0.6]), (UNLIKE, [0.0, 0.0])] {
            let pairs = vec![
                contact(["low", "top"], ["middle", "bottom"], friction[0]),
                contact(["high", "bottom"], ["middle", "top"], friction[1]),
            ];
            let (_, report) = certified(&three_layers(kind, materials, pairs));
            check_pressure(&report.contacts, 2.0, 1e-10);
            assert_eq!(report.totals.pairs.len(), 2);
            for body in &report.certificate.bodies {
                assert!(body.moment_defect.scaled < 1e-12, "{kind:?} {body:?}");
            }
        }
    }
}

/// A beam on two columns side by side that fill its length, all of one material; lowered by a
/// strain of 1e-3.
fn beam_on_columns(kind: CellKind, friction: [f64; 2]) -> Scene {
    let up = kind.dimension() - 1;
    let at = |x: [f64; 2], z: [f64; 2], cells: [usize; 3]| {
        let (mut low, mut high) = ([0.0; 3], [1.0; 3]);
        (low[0], high[0], low[up], high[up]) = (x[0], x[1], z[0], z[1]);
        block(kind, low, high, cells)
    };
    let meshes = [
        ("left", at([0.0, 0.7], [0.0, 1.0], [3, 3, 3])),
        ("right", at([0.7, 2.0], [0.0, 1.0], [4, 2, 3])),
        ("beam", at([0.0, 2.0], [1.0, 2.0], [5, 4, 3])),
    ];
    let bodies = meshes.map(|(name, mesh)| {
        let (side, lowered) = if name == "beam" {
            ("top", -2e-3)
        } else {
            ("bottom", 0.0)
        };
        // ν = 0: nothing widens, so the columns need no more than a plane each.
        let mut body = hold(body(name, mesh, 1000.0, 0.0), side, up, lowered);
        for (axis, side) in ["left", "front"].into_iter().enumerate().take(up) {
            body = hold(body, side, axis, 0.0);
        }
        body
    });
    let pair = |at: usize, name| contact(["beam", "bottom"], [name, "top"], friction[at]);
    scene(bodies.to_vec(), vec![pair(0, "left"), pair(1, "right")])
}

#[test]
fn one_node_may_stand_in_two_pairs() {
    // The end of the columns lies inside a cell of the beam, whose nodes meet both.
    for kind in CellKind::LINEAR {
        let (_, report) = certified(&beam_on_columns(kind, [0.3, 0.7]));
        check_pressure(&report.contacts, 1.0, 1e-10);
        let of_pair = |pair| {
            let contacts = report.contacts.iter().filter(move |c| c.pair == pair);
            contacts.map(|c| c.node).collect::<Vec<_>>()
        };
        let shared = of_pair(0).iter().filter(|n| of_pair(1).contains(n)).count();
        assert!(shared >= 2, "{kind:?} {shared}");
        for (pair, width) in report.totals.pairs.iter().zip([0.7, 1.3]) {
            assert!((pair.totals.normal - width).abs() < 1e-10, "{kind:?}");
        }
    }
}

/// A square of edge 2 with a crack along y = 1 from x = ½ to 5/4: groups `upper` and `lower`
/// for its lips, `outside` for the rest of the boundary.
fn cracked(kind: CellKind) -> Mesh {
    let lines = graded(0.0, 2.0, 8, 1.0).unwrap();
    let whole = rectangle(&lines, &lines, kind).unwrap();
    let mut mesh = Mesh::new(2, whole.nodes.clone());
    let mut double = vec![None; whole.nodes.len()];
    for (node, at) in whole.nodes.iter().enumerate() {
        if at[1] == 1.0 && at[0] > 0.5 && at[0] < 1.25 {
            double[node] = Some(mesh.nodes.len());
            mesh.nodes.push(*at);
        }
    }
    for cell in whole.cells() {
        let heights = cell.nodes.iter().map(|node| whole.nodes[*node][1] - 1.0);
        let above = heights.sum::<f64>() > 0.0;
        let lip = |&node: &usize| double[node].filter(|_| above).unwrap_or(node);
        mesh.push_cell(cell.kind, &cell.nodes.iter().map(lip).collect::<Vec<_>>());
    }
    let on = |facet: &Facet, axis: usize, at: f64| {
        facet.nodes.iter().all(|node| mesh.nodes[*node][axis] == at)
    };
    let is_upper = |facet: &Facet| facet.nodes.iter().any(|node| *node >= whole.nodes.len());
    let (lips, outside): (Vec<_>, Vec<_>) = mesh
        .boundary_facets()
        .into_iter()
        .partition(|facet| on(facet, 1, 1.0));
    let (upper, lower): (Vec<_>, Vec<_>) = lips.into_iter().partition(is_upper);
    let groups = [("upper", upper), ("lower", lower), ("outside", outside)];
    let groups = groups.map(|(name, facets)| (name.to_owned(), Group::Facets(facets)));
    mesh.groups.extend(groups);
    mesh
}

#[test]
fn a_closed_crack_that_sticks_is_as_if_it_were_not_there() {
    // The outside moves as under a pressure of 1 along y and a shear of 0.2, in plane strain: with
    // μ = 0.3 the lips carry both. With μ = 0.1 they slip and the shear on them is 0.1.
    let (young, poisson) = (1000.0, 0.3);
    let [down, across, sheared] = [
        (1.0 - poisson * poisson) / young,
        poisson * (1.0 + poisson) / young,
        0.2 * 2.0 * (1.0 + poisson) / young,
    ];
    let exact = |[x, y, _]: [f64; 3]| [across * x + sheared * y, -down * y];
    for kind in [CellKind::Quad4, CellKind::Tri3] {
        for [own, other] in [["upper", "lower"], ["lower", "upper"]] {
            let mesh = cracked(kind);
            let mut plate = body("plate", mesh.clone(), young, poisson);
            for at in mesh
                .nodes
                .iter()
                .filter(|at| at[..2].iter().any(|x| [0.0, 2.0].contains(x)))
            {
                for axis in 0..2 {
                    plate = hold_at(plate, *at, axis, exact(*at)[axis]);
                }
            }
            let solve = |friction: f64| {
                let pair = contact(["plate", own], ["plate", other], friction);
                certified(&scene(vec![plate.clone()], vec![pair]))
            };
            let (solution, report) = solve(0.3);
            assert_eq!((report.size.contacts, report.totals.stick), (2, 2));
            for contact in &report.contacts {
                assert!(
                    (contact.pressure.unwrap() - 1.0).abs() < 1e-11,
                    "{contact:?}"
                );
                let shear = contact.friction_traction.as_ref().unwrap()[0].abs();
                assert!((shear - 0.2).abs() < 1e-11, "{contact:?}");
            }
            let nodal = solution.displacements()[0].chunks(2);
            for (at, u) in mesh.nodes.iter().zip(nodal) {
                let [x, y] = exact(*at);
                assert!((u[0] - x).hypot(u[1] - y) < 1e-14, "{at:?} {u:?}");
            }
            let (_, report) = solve(0.1);
            assert_eq!(report.totals.slip, 2);
            for contact in &report.contacts {
                let shear = contact.friction_traction.as_ref().unwrap()[0].abs();
                assert!((shear - 0.1 * contact.pressure.unwrap()).abs() < 1e-11);
            }
        }
    }
}

/// Two arms of length 2 and height 1 on each other, joined by a spine at their right end: groups
/// `upper` and `lower` for the faces of the slit, whose cells do not match, and the rest `outside`.
fn clip(kind: CellKind, cells: [usize; 2]) -> Mesh {
    let heights = [[0.0, 0.5, 1.0], [1.0, 1.4, 2.0]];
    let spine = [2.0, 2.4, 2.5];
    let mut mesh = Mesh::new(2, Vec::new());
    let mut number_of = std::collections::HashMap::new();
    for (arm, (ys, count)) in heights.iter().zip(cells).enumerate() {
        let mut xs = graded(0.0, 2.0, count, 1.0).unwrap();
        xs.extend(&spine[1..]);
        let part = rectangle(&xs, ys, kind).unwrap();
        let mut number = |at: [f64; 3]| {
            // The faces of the slit have nodes of their own up to its end.
            let side = if at[0] < 2.0 { arm } else { 0 };
            let bits = [at[0].to_bits(), at[1].to_bits()];
            *number_of.entry((bits, side)).or_insert_with(|| {
                mesh.nodes.push(at);
                mesh.nodes.len() - 1
            })
        };
        let numbers: Vec<usize> = part.nodes.iter().map(|at| number(*at)).collect();
        for cell in part.cells() {
            let nodes = cell.nodes.iter().map(|node| numbers[*node]);
            mesh.push_cell(cell.kind, &nodes.collect::<Vec<_>>());
        }
    }
    let in_slit = |facet: &Facet| facet.nodes.iter().all(|node| mesh.nodes[*node][1] == 1.0);
    let (slit, outside): (Vec<_>, Vec<_>) = mesh.boundary_facets().into_iter().partition(in_slit);
    let up = |facet: &Facet| mesh.facet_geometry(facet).normal[1] > 0.0;
    let (lower, upper): (Vec<_>, Vec<_>) = slit.into_iter().partition(up);
    let groups = [("upper", upper), ("lower", lower), ("outside", outside)];
    let groups = groups.map(|(name, facets)| (name.to_owned(), Group::Facets(facets)));
    mesh.groups.extend(groups);
    mesh
}

#[test]
fn a_slit_whose_faces_do_not_match_carries_a_uniform_pressure() {
    // The outside moves as under a pressure of 1 along y, in plane strain; the faces of the slit
    // have a node in common where it ends.
    let (young, poisson) = (1000.0, 0.3);
    let [down, across] = [
        (1.0 - poisson * poisson) / young,
        poisson * (1.0 + poisson) / young,
    ];
    for kind in [CellKind::Quad4, CellKind::Tri3] {
        for cells in [[5, 8], [8, 5], [3, 4], [6, 6]] {
            for [own, other] in [["upper", "lower"], ["lower", "upper"]] {
                let mesh = clip(kind, cells);
                let Group::Facets(outside) = &mesh.groups["outside"] else {
                    unreachable!();
                };
                let mut held: Vec<usize> = outside.iter().flat_map(|f| f.nodes.clone()).collect();
                held.sort_unstable();
                held.dedup();
                // The left ends of the two faces stand at one place: they stay free.
                held.retain(|node| mesh.nodes[*node][..2] != [0.0, 1.0]);
                let mut clip = body("clip", mesh.clone(), young, poisson);
                for at in held.into_iter().map(|node| mesh.nodes[node]) {
                    clip = hold_at(clip, at, 0, across * at[0]);
                    clip = hold_at(clip, at, 1, -down * at[1]);
                }
                for friction in [0.0, 0.3] {
                    let pair = contact(["clip", own], ["clip", other], friction);
                    let (solution, report) = certified(&scene(vec![clip.clone()], vec![pair]));
                    check_pressure(&report.contacts, 1.0, 1e-10);
                    let nodal = solution.displacements()[0].chunks(2);
                    for (at, u) in mesh.nodes.iter().zip(nodal) {
                        let off = (u[0] - across * at[0]).hypot(u[1] + down * at[1]);
                        assert!(off < 1e-13, "{at:?} {u:?}");
                    }
                }
            }
        }
    }
}

/// A rigid motion of the whole clip moves both faces of its slit alike: what the mortar's weights leave of it, 1e-16 of
/// the motion, is neither resistance nor a way to hold the load.
#[test]
fn a_clip_that_nothing_holds_is_not_held_by_touching_itself() {
    for cells in [[5, 8], [3, 4]] {
        let mut clip = body("clip", clip(CellKind::Quad4, cells), 1000.0, 0.3);
        let push = vec![2.0, -3.0];
        clip.loads.push(SceneLoad::BodyForce {
            group: None,
            body_force: push,
        });
        let pair = contact(["clip", "upper"], ["clip", "lower"], 0.3);
        let solution = solve(&scene(vec![clip], vec![pair])).unwrap();
        assert_eq!(solution.status(), Status::NoEquilibrium);
        let floating = solution.condensed().problem().floating().unwrap();
        assert_eq!(floating.modes().norm_max(), 0.0);
        let proof = &solution.outcome().failure.as_ref().unwrap().proof;
        assert!(proof.work > 0.0 && proof.resistance == 0.0, "{proof:?}");
    }
}

/// Two blocks pressed askew with friction: some contacts open, some stick, some slip.
fn askew(kind: CellKind, pairs: &[SceneContact]) -> Scene {
    let up = kind.dimension() - 1;
    let cells = if up == 1 { [6, 9] } else { [3, 4] };
    let side = |from: f64, cells: usize| {
        let (mut low, mut high) = ([0.0; 3], [1.0; 3]);
        (low[up], high[up]) = (from, from + 1.0);
        block(kind, low, high, [cells; 3])
    };
    let mut upper = side(1.0, cells[1]);
    for at in &mut upper.nodes {
        // A face that rises to the right.
        at[up] += 0.02 * at[0] * (2.0 - at[up]);
    }
    let mut lower = body("lower", side(0.0, cells[0]), 1000.0, 0.3);
    let mut upper = body("upper", upper, 3000.0, 0.2);
    for axis in 0..=up {
        let pushed = if axis == up {
            -0.01
        } else {
            [0.002, 0.001][axis]
        };
        lower = hold(lower, "bottom", axis, 0.0);
        upper = hold(upper, "top", axis, pushed);
    }
    scene(vec![lower, upper], pairs.to_vec())
}

/// Largest difference between displacements, of the largest displacement.
///
/// Of pairs that stand twice G has no inverse: what is certified to 1e-12 of t is known to √1e-12 in
/// displacements at worst, and to the order of 1e-12 where no contact is on the brink. 1e-8 lies between.
fn difference(one: &Solution, other: &Solution) -> f64 {
    let values = |s: &Solution| s.displacements().concat();
    let (one, other) = (values(one), values(other));
    let size = one.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    let pairs = one.iter().zip(&other);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
}

fn force_difference(one: &Report, other: &Report) -> f64 {
    let (one, other) = (&one.certificate.bodies[0], &other.certificate.bodies[0]);
    let forces = one.contact.force.iter().zip(&other.contact.force);
    let size = one
        .contact
        .force
        .iter()
        .fold(0.0_f64, |m, f| m.max(f.abs()));
    forces.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
}

#[test]
fn a_pair_that_stands_twice_changes_no_displacement_and_no_resultant() {
    let (lower, upper) = (["lower", "top"], ["upper", "bottom"]);
    for kind in CellKind::LINEAR {
        for friction in [0.0, 0.15] {
            let pair = contact(upper, lower, friction);
            let (once, report) = certified(&askew(kind, std::slice::from_ref(&pair)));
            assert!(
                report.totals.open > 0 && report.totals.normal > 0.0,
                "{kind:?}"
            );
            if friction > 0.0 {
                assert!(report.totals.slip > 0, "{kind:?}");
            }
            let (twice, of_both) = certified(&askew(kind, &[pair.clone(), pair]));
            let (u, f) = (
                difference(&once, &twice),
                force_difference(&report, &of_both),
            );
            assert!(u < 1e-8 && f < 1e-8, "{kind:?} {friction} {u:e} {f:e}");
        }
    }
}

#[test]
fn a_face_may_be_the_first_of_one_pair_and_the_second_of_another() {
    let (lower, upper) = (["lower", "top"], ["upper", "bottom"]);
    for kind in CellKind::LINEAR {
        for friction in [0.0, 0.4] {
            let pairs = [
                contact(upper, lower, friction),
                contact(lower, upper, friction),
            ];
            let (one, report) = certified(&askew(kind, &pairs));
            let [a, b] = pairs;
            let (other, turned) = certified(&askew(kind, &[b, a]));
            let (u, f) = (difference(&one, &other), force_difference(&report, &turned));
            assert!(u < 1e-8 && f < 1e-8, "{kind:?} {friction} {u:e} {f:e}");
        }
    }
}

/// Two layers of which the upper one stands `gap` above the lower one and comes down by `lowered`.
fn falling(kind: CellKind, gap: f64, lowered: f64, friction: f64) -> Scene {
    let up = kind.dimension() - 1;
    let cells = if up == 1 { [5, 7] } else { [3, 4] };
    let lower = layer("lower", kind, [0.0, 1.0], cells[0], SAME[0]);
    let upper = layer("upper", kind, [1.0 + gap, 2.0 + gap], cells[1], SAME[1]);
    let bodies = vec![
        hold(lower, "bottom", up, 0.0),
        hold(upper, "top", up, -lowered),
    ];
    let pair = contact(["upper", "bottom"], ["lower", "top"], friction);
    scene(bodies, vec![pair])
}

#[test]
fn a_block_falls_by_three_cells_and_presses_evenly() {
    for kind in CellKind::LINEAR {
        for friction in [0.0, 0.3] {
            let gap = if kind.dimension() == 2 {
                3.0 / 7.0
            } else {
                0.75
            };
            let pressed = 2.0 * 2.0 * shortening(kind, SAME[0]);
            let (_, report) = certified(&falling(kind, gap, gap + pressed, friction));
            check_pressure(&report.contacts, 2.0, 1e-10);
            // Not far enough: it hangs above the other one, and nothing is carried.
            let (solution, report) = certified(&falling(kind, gap, gap - 1e-3, friction));
            assert_eq!(report.totals.open, report.size.contacts);
            assert!(report.contacts.iter().all(|c| (c.gap - 1e-3).abs() < 1e-14));
            assert!(solution.displacements()[0].iter().all(|u| *u == 0.0));
        }
    }
}

#[test]
fn blocks_that_overlap_between_walls_press_by_their_interference() {
    // Two blocks that are 0.004 too long: p (s₁ h₁ + s₂ h₂) = 0.004, s the shortening per pressure.
    let fit = 0.004;
    for kind in CellKind::LINEAR {
        for (materials, friction) in [(SAME, 0.3), (UNLIKE, 0.0)] {
            let up = kind.dimension() - 1;
            let lower = layer("lower", kind, [0.0, 1.0], 3, materials[0]);
            let upper = layer("upper", kind, [1.0 - fit, 1.5], 4, materials[1]);
            let given =
                shortening(kind, materials[0]) + (0.5 + fit) * shortening(kind, materials[1]);
            let bodies = vec![hold(lower, "bottom", up, 0.0), hold(upper, "top", up, 0.0)];
            let pair = contact(["upper", "bottom"], ["lower", "top"], friction);
            let (_, report) = certified(&scene(bodies, vec![pair]));
            check_pressure(&report.contacts, fit / given, 1e-10);
        }
    }
}

/// A quarter of a ring between two radii, `cells` around and half as many across; groups `bottom`
/// (inside), `top` (outside), `left` (on the y axis) and `right` (on the x axis).
fn quarter_ring([inner, outer]: [f64; 2], cells: usize) -> Mesh {
    let angles = graded(0.0, PI / 2.0, cells, 1.0).unwrap();
    let radii = graded(inner, outer, cells / 2, 1.0).unwrap();
    let mut mesh = rectangle(&angles, &radii, CellKind::Quad4).unwrap();
    for [x, y, _] in &mut mesh.nodes {
        let (angle, r) = (*x, *y);
        let (sin, cos) = angle.sin_cos();
        (*x, *y) = (r * sin, if angle == angles[cells] { 0.0 } else { r * cos });
    }
    mesh
}

#[test]
fn a_ring_shrunk_onto_another_presses_as_lame_says() {
    // Rings 1 … b₁ and b₂ … 3 with b₁ − b₂ = δ, plane strain: under a force q per radian they give
    //   s₁ q/b₁ + s₂ q/b₂ = δ,   s₁ = b₁/E'₁ ((b₁² + 1)/(b₁² − 1) − ν'₁),
    //                            s₂ = b₂/E'₂ ((9 + b₂²)/(9 − b₂²) + ν'₂),
    // E' = E/(1 − ν²), ν' = ν/(1 − ν) (Lamé; Timoshenko & Goodier, Theory of Elasticity, art. 28).
    let ([young_1, nu_1], [young_2, nu_2]) = ([2000.0, 0.3], [1000.0, 0.2]);
    let (fit, [b_1, b_2]) = (0.02, [2.01, 1.99]);
    let plane = |young: f64, nu: f64| (young / (1.0 - nu * nu), nu / (1.0 - nu));
    let ((e_1, v_1), (e_2, v_2)) = (plane(young_1, nu_1), plane(young_2, nu_2));
    let given_1 = ((b_1 * b_1 + 1.0) / (b_1 * b_1 - 1.0) - v_1) / e_1;
    let given_2 = ((9.0 + b_2 * b_2) / (9.0 - b_2 * b_2) + v_2) / e_2;
    let per_radian = fit / (given_1 + given_2);
    let (one, two) = (["inner", "top"], ["outer", "bottom"]);
    // Gaps are those of the circles that the facets stand for. What is left does not fall with h, and is the same all
    // around, symmetry planes included: seen along the normals of its facets, a side meets at each of its nodes
    // a part δ h/R of the other one twice where they overlap, δ/R = 1 % of what a contact has, of which the other side's
    // nodes, three for two, take unlike shares: a quarter of it is allowed. The total is of order two, 1/64² and four times that.
    for (pair, radius) in [(contact(one, two, 0.0), b_1), (contact(two, one, 0.0), b_2)] {
        let errors = |cells: usize| {
            let inner = body("inner", quarter_ring([1.0, b_1], 2 * cells), young_1, nu_1);
            let outer = body("outer", quarter_ring([b_2, 3.0], 3 * cells), young_2, nu_2);
            let on_axes = |ring| hold(hold(ring, "left", 0, 0.0), "right", 1, 0.0);
            let bodies = [inner, outer].map(on_axes).to_vec();
            let (_, report) = certified(&scene(bodies, vec![pair.clone()]));
            let expected = per_radian / radius;
            let off = |c: &Contact| (c.pressure.unwrap() / expected - 1.0).abs();
            let worst = report.contacts.iter().map(off).fold(0.0, f64::max);
            let total = report.totals.normal / (per_radian * PI / 2.0) - 1.0;
            (worst, total.abs())
        };
        let [coarse, middle, fine] = [16, 32, 64].map(errors);
        assert!(coarse.1 / middle.1 > 3.8 && middle.1 / fine.1 > 3.8);
        assert!(
            coarse.0 < 0.0025 && fine.0 < 0.0025 && fine.1 < 1e-4,
            "{coarse:?} {fine:?}"
        );
    }
}

#[test]
fn a_body_whose_nodes_are_all_held_drags_another_by_friction() {
    // A die goes down on a block and sideways: far, and every contact slips; not at all, and with
    // ν = 0 nothing slips. Either may be the finer one and the first of the pair.
    let (die, free) = (["die", "bottom"], ["block", "top"]);
    for kind in CellKind::LINEAR {
        let up = kind.dimension() - 1;
        for cells in [[3, 4], [4, 3]] {
            for pair in [contact(die, free, 0.25), contact(free, die, 0.25)] {
                let solve = |sideways: f64| {
                    let ends = |low: f64| {
                        let (mut from, mut to) = ([0.0; 3], [1.0; 3]);
                        (from[up], to[up]) = (low, low + 1.0);
                        (from, to)
                    };
                    let ((from, to), (above, top)) = (ends(0.0), ends(1.0));
                    let mut lower =
                        body("block", block(kind, from, to, [cells[0]; 3]), 1000.0, 0.0);
                    let mut upper =
                        body("die", block(kind, above, top, [cells[1]; 3]), 1000.0, 0.0);
                    for axis in 0..=up {
                        let moved = if axis == up {
                            -1e-3
                        } else {
                            [sideways, 0.0][axis]
                        };
                        lower = hold(lower, "bottom", axis, 0.0);
                        upper = hold(upper, "body", axis, moved);
                    }
                    certified(&scene(vec![lower, upper], vec![pair.clone()])).1
                };
                let report = solve(0.1);
                for contact in &report.contacts {
                    let [bound, q] = [
                        0.25 * contact.pressure.unwrap(),
                        contact.friction_traction.as_ref().unwrap()[0].abs(),
                    ];
                    // The block's own displacement turns the slip by a few 1e-4, which costs half its square.
                    assert!(
                        (q - bound).abs() <= 1e-7 * bound,
                        "{kind:?} {cells:?} {q} {bound}"
                    );
                }
                assert!(report.totals.slip > 0 && report.totals.stick == 0);
                let report = solve(0.0);
                assert!(
                    (report.totals.normal - 1.0).abs() < 1e-9,
                    "{kind:?} {cells:?}"
                );
                assert!(report.totals.friction[0].abs() < 1e-9);
            }
        }
    }
}

/// A quadratic surface cut in two within a facet of the other side: where a cover has only its ends to be looked at, both are
/// in the other body and what lies between is apart, as the mean is neither.
#[test]
fn one_interface_told_as_two_contacts_is_certified() {
    let lines = |[from, to]: [f64; 2], cells| graded(from, to, cells, 1.0).unwrap();
    let split = |mut mesh: Mesh| {
        let Group::Facets(all) = mesh.groups["bottom"].clone() else {
            unreachable!("bottom is a group of facets");
        };
        for (name, part) in [("one", &all[..1]), ("rest", &all[1..])] {
            mesh.groups
                .insert(name.to_owned(), Group::Facets(part.to_vec()));
        }
        mesh
    };
    for (kind, [low, high], young, aside) in [
        (
            CellKind::Tri3,
            [[0.1242, 0.8907], [-0.1007, 1.0593]],
            [56.0, 47e3],
            -1.1e-3,
        ),
        (
            CellKind::Quad4,
            [[0.1273, 0.8913], [-0.0187, 0.9683]],
            [219e3, 8.1],
            -7.8e-5,
        ),
    ] {
        let forces = [&["bottom"][..], &["one", "rest"]].map(|groups| {
            let lower = rectangle(&lines(low, 2), &lines([0.0, 0.4], 3), kind).unwrap();
            let upper = rectangle(&lines(high, 3), &lines([0.4008, 1.0], 3), CellKind::Quad8);
            let (lower, upper) = (
                body("lower", lower, young[0], 0.1),
                body("upper", split(upper.unwrap()), young[1], 0.3),
            );
            let lower = hold(hold(lower, "bottom", 0, 0.0), "bottom", 1, 0.0);
            let upper = hold(hold(upper, "top", 0, aside), "top", 1, -7e-3);
            let joints = groups
                .iter()
                .map(|group| contact(["upper", *group], ["lower", "top"], 0.1));
            certified(&scene(vec![lower, upper], joints.collect()))
                .1
                .totals
                .normal
        });
        assert!((forces[0] / forces[1] - 1.0).abs() < 1e-2, "{forces:?}");
    }
}
