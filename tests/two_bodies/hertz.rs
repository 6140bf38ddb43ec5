//! Curved bodies on each other carry the pressure of Hertz (Johnson, Contact Mechanics, Cambridge
//! 1985, ch. 4) for the load that their meshes carry.

use std::f64::consts::PI;

use dpana::Scene;
use dpana::body::{CellKind, Mesh, rectangle};
use dpana::mesh_file::gmsh;
use dpana::report::Report;
use dpana::scene::SceneBody;

use crate::stacks;
use crate::stacks::{body, certified, contact, hold, part, scene};

/// Two cylinders, or a cylinder and a flat, in plane strain.
struct Hertz {
    half_width: f64,
    peak: f64,
}

impl Hertz {
    /// a = √(4 P R/(π E*)), p₀ = 2 P/(π a), P per length of the whole contact.
    fn new(load: f64, radius: f64, modulus: f64) -> Self {
        let half_width = (4.0 * load * radius / (PI * modulus)).sqrt();
        let peak = 2.0 * load / (PI * half_width);
        Self { half_width, peak }
    }

    fn pressure(&self, x: f64) -> f64 {
        self.peak * (1.0 - (x / self.half_width).powi(2)).max(0.0).sqrt()
    }

    /// Relative error of the pressure in L2 over the contacts.
    fn error(&self, report: &Report) -> f64 {
        let (mut error, mut size) = (0.0, 0.0);
        for contact in &report.contacts {
            let exact = self.pressure(contact.position[0]);
            error += contact.area * (contact.pressure.unwrap() - exact).powi(2);
            size += contact.area * exact * exact;
        }
        (error / size).sqrt()
    }

    fn peak_error(&self, report: &Report) -> f64 {
        (report.totals.peak_pressure / self.peak - 1.0).abs()
    }

    /// Strips of constant pressure, n per half-width, miss p₀ by 0.13/n² and the pressure in L2 by 0.11/n (references:
    /// computed); twice that in L2, as the edge falls anywhere in a cell.
    fn check(&self, report: &Report, cell: f64) {
        let strips = self.half_width / cell;
        let (peak, l2) = (self.peak_error(report), self.error(report));
        assert!(
            peak < 0.13 / strips.powi(2) && l2 < 0.22 / strips,
            "{peak:e} {l2:e} {strips}"
        );
    }
}

/// 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂.
fn contact_modulus([one, two]: [(f64, f64); 2]) -> f64 {
    let compliance = |(young, poisson): (f64, f64)| (1.0 - poisson * poisson) / young;
    1.0 / (compliance(one) + compliance(two))
}

const STEEL: (f64, f64) = (210e3, 0.3);

/// R of the parabola, in mm.
const RADIUS: f64 = 100.0;

/// Length of a cell at the contact of the shipped mesh, in mm.
const CELL: f64 = 0.1875;

/// The upper body pushed down on the lower one; both clamped at their backs.
fn pressed(meshes: [Mesh; 2], backs: [&str; 2], lowered: f64) -> [SceneBody; 2] {
    let [upper, lower] = meshes;
    let mut bodies = [("upper", upper, -lowered), ("lower", lower, 0.0)]
        .map(|(name, mesh, _)| body(name, mesh, STEEL.0, STEEL.1));
    for (at, value) in [-lowered, 0.0].into_iter().enumerate() {
        for (axis, value) in [0.0, value].into_iter().enumerate() {
            bodies[at] = hold(bodies[at].clone(), backs[at], axis, value);
        }
    }
    bodies
}

/// The shipped parabola on a flat, 16 cells a side, as two bodies, of which the upper one starts
/// `lift` higher and ends where it would without.
fn mindlin(friction: f64, upper_first: bool, lift: f64) -> Scene {
    let text = include_str!("../data/meshes/B2_mindlin_n16.msh");
    let mesh = gmsh::parse(text, "B2_mindlin_n16.msh").unwrap();
    let mut meshes = ["body0", "body1"].map(|group| part(&mesh, group));
    for [_, y, _] in &mut meshes[0].nodes {
        *y += lift;
    }
    let bodies = pressed(meshes, ["top", "base"], 0.019 + lift);
    let (upper, lower) = (["upper", "contact"], ["lower", "master"]);
    let pair = if upper_first {
        contact(upper, lower, friction)
    } else {
        contact(lower, upper, friction)
    };
    scene(bodies.to_vec(), vec![pair])
}

#[test]
fn a_parabola_on_a_flat_of_the_same_material_carries_the_pressure_of_hertz() {
    for friction in [0.0, 0.3] {
        for upper_first in [true, false] {
            let (_, report) = certified(&mindlin(friction, upper_first, 0.0));
            let hertz = Hertz::new(report.totals.normal, RADIUS, contact_modulus([STEEL; 2]));
            hertz.check(&report, CELL);
            // Identical bodies on matching meshes: pressure makes no slip and friction no gap.
            assert!(report.work.sweeps <= 3, "{}", report.work.sweeps);
            let friction = report.totals.friction[0].abs();
            assert!(friction < 1e-9 * report.totals.normal, "{friction:e}");
        }
    }
}

#[test]
fn a_parabola_that_falls_by_three_cells_carries_the_pressure_of_hertz() {
    // Contacts close along the normals of the mean of both sides, inclined by φ = θ/2, θ = x/R. The gap is
    // (y + d)/cos φ for a fall d, of which the motion gives back d cos φ: d θ²/4 more than y = x²/(2R), as if
    // the radius were R/(1 + d/(2R)), 0.3 % less, whichever side is named first.
    let lift = 3.0 * CELL;
    let radius = RADIUS / (1.0 + 0.5 * lift / RADIUS);
    for upper_first in [true, false] {
        let (_, report) = certified(&mindlin(0.0, upper_first, lift));
        let hertz = Hertz::new(report.totals.normal, radius, contact_modulus([STEEL; 2]));
        hertz.check(&report, CELL);
    }
}

/// Coordinates from 0 to `end`: cells of size `fine` to `even`, then each larger by `growth`.
fn growing(fine: f64, even: f64, end: f64, growth: f64) -> Vec<f64> {
    let count = (even / fine).round();
    let mut lines: Vec<f64> = (0..=count as usize)
        .map(|k| k as f64 * even / count)
        .collect();
    let mut size = even / count;
    while lines[lines.len() - 1] < end - 2.0 * size {
        size *= 1.0 + growth;
        lines.push(lines[lines.len() - 1] + size);
    }
    lines.push(end);
    lines
}

/// Right halves of a parabola on a flat, `cells` per mm of the parabola's face, four fifths as
/// many on the flat's, 40 mm wide and high; the parabola pushed down.
fn halves(cells: f64, lowered: f64) -> Scene {
    let size = 40.0;
    // As fine relative to the depth as at the face.
    let growth = 1.0 / cells;
    let mesh = |fine: f64, upper: bool| {
        let (xs, depths) = (
            growing(fine, 1.5, size, growth),
            growing(fine, fine, size, growth),
        );
        let ys: Vec<f64> = if upper {
            depths
        } else {
            depths.iter().rev().map(|depth| -depth).collect()
        };
        let mut mesh = rectangle(&xs, &ys, CellKind::Quad4).unwrap();
        if upper {
            for [x, y, _] in &mut mesh.nodes {
                *y += *x * *x / (2.0 * RADIUS) * (1.0 - *y / size);
            }
        }
        mesh
    };
    let meshes = [mesh(1.0 / cells, true), mesh(1.25 / cells, false)];
    let bodies = pressed(meshes, ["top", "bottom"], lowered);
    let bodies = bodies.map(|body| hold(body, "left", 0, 0.0));
    let pair = contact(["upper", "bottom"], ["lower", "top"], 0.0);
    scene(bodies.to_vec(), vec![pair])
}

#[test]
fn finer_meshes_bring_the_pressure_closer_to_that_of_hertz() {
    // The edge of the contact falls anywhere between two nodes: the mean over several loads. For
    // n strips of constant pressure per half-width the error is 0.11/n (references: computed).
    let loads = [0.018, 0.019, 0.020, 0.021];
    let mut errors = Vec::new();
    for cells in [5.0, 10.0, 20.0, 40.0] {
        let of_loads = loads.map(|lowered| {
            let (_, report) = certified(&halves(cells, lowered));
            let load = 2.0 * report.totals.normal;
            let hertz = Hertz::new(load, RADIUS, contact_modulus([STEEL; 2]));
            assert!(
                hertz.peak_error(&report) < 0.05 / cells,
                "{cells} {lowered}"
            );
            (hertz.error(&report), hertz.half_width)
        });
        let (error, half_width) = of_loads.iter().fold((0.0, 0.0), |sum, of_load| {
            (sum.0 + of_load.0, sum.1 + of_load.1)
        });
        let mean = error / loads.len() as f64;
        let strips = cells * half_width / loads.len() as f64;
        // Twice that: the flat's cells are larger by a quarter, and pressures linear across a kink.
        assert!(mean < 0.2 / strips, "{mean:e} with {strips} cells");
        errors.push(mean);
    }
    // First order gives 8; the mean over four loads leaves the scatter of where the edge falls.
    assert!(errors[3] < errors[0] / 5.0, "{errors:?}");
}

/// Konter's cylinder: a quarter of a ring of radii 1 and 50 mm about (0, 50), fine at its lowest
/// point; groups `face` (outside), `left` (x = 0), `top` (y = 50).
fn quarter_ring(fine: f64) -> Mesh {
    let (inner, outer) = (1.0, 50.0);
    let depths = growing(fine, fine, outer - inner, 0.2);
    let arcs = growing(fine, 9.0, outer * PI / 2.0, 0.2);
    let mut mesh = rectangle(&arcs, &depths, CellKind::Quad4).unwrap();
    for [x, y, _] in &mut mesh.nodes {
        let (angle, r) = (*x / outer, outer - *y);
        // On the symmetry plane and on the level of the axis exactly.
        let (sin, cos) = if *x == arcs[0] {
            (0.0, 1.0)
        } else {
            angle.sin_cos()
        };
        (*x, *y) = (r * sin, outer - r * cos);
    }
    mesh
}

const ALUMINIUM: (f64, f64) = (70e3, 0.3);

/// Load of the benchmark, in N per mm of depth.
const LOAD: f64 = 35e3;

/// What the benchmark compares.
struct Konter {
    half_width: f64,
    peak: f64,
    sunk: f64,
}

/// Konter no. 1, right half: steel cylinder of 100 mm on an aluminium block of 200 × 200 mm whose
/// base is clamped, `fine` the cells at the contact, the level of the cylinder's axis pushed down
/// until the load is that of the benchmark.
fn konter(fine: f64, friction: f64, cylinder_first: bool) -> Konter {
    let scene = |lowered: f64| {
        let cylinder = body("cylinder", quarter_ring(fine), STEEL.0, STEEL.1);
        let cylinder = hold(hold(cylinder, "left", 0, 0.0), "right", 1, -lowered);
        let depths = growing(1.25 * fine, 1.25 * fine, 200.0, 0.2);
        let ys: Vec<f64> = depths.iter().rev().map(|depth| -depth).collect();
        let xs = growing(1.25 * fine, 10.0, 100.0, 0.2);
        let block = rectangle(&xs, &ys, CellKind::Quad4).unwrap();
        let mut block = body("block", block, ALUMINIUM.0, ALUMINIUM.1);
        for (side, axis) in [("left", 0), ("bottom", 0), ("bottom", 1)] {
            block = hold(block, side, axis, 0.0);
        }
        let (one, two) = (["cylinder", "bottom"], ["block", "top"]);
        let pair = if cylinder_first {
            contact(one, two, friction)
        } else {
            contact(two, one, friction)
        };
        stacks::scene(vec![cylinder, block], vec![pair])
    };
    let mut lowered = 1.55;
    loop {
        let (solution, report) = certified(&scene(lowered));
        let load = 2.0 * report.totals.normal;
        if (load / LOAD - 1.0).abs() < 1e-4 {
            return Konter {
                half_width: half_width(&report),
                peak: report.totals.peak_pressure,
                sunk: -solution.displacement_near(1, [0.0; 3]).unwrap()[1],
            };
        }
        // Nearly linear.
        lowered *= (LOAD / load).powf(0.9);
    }
}

/// ∫ x² p dx / ∫ p dx = a²/4 for p = p₀ √(1 − x²/a²).
fn half_width(report: &Report) -> f64 {
    let (mut moment, mut sum) = (0.0, 0.0);
    for contact in &report.contacts {
        moment += contact.force[1].abs() * contact.position[0].powi(2);
        sum += contact.force[1].abs();
    }
    2.0 * (moment / sum).sqrt()
}

fn assert_near(found: f64, expected: f64, tolerance: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error < tolerance, "{found} against {expected}: {error:.1e}");
}

#[test]
fn a_cylinder_on_a_block_without_friction_carries_the_pressure_of_hertz() {
    let hertz = Hertz::new(LOAD, 50.0, contact_modulus([STEEL, ALUMINIUM]));
    // Half of the last published digit.
    assert_near(hertz.half_width, 6.214_63, 1e-6);
    assert_near(hertz.peak, 3585.36, 1e-6);
    // At the edge the circle rises by a²/(4R²) = 0.4 % more than its parabola, and the block is a half-plane but
    // for (a/L)² = 0.4 %, L = 100 mm; 25 strips per half-width add 0.13/25² (references), the load 1e-4.
    for cylinder_first in [true, false] {
        let found = konter(0.25, 0.0, cylinder_first);
        assert_near(found.half_width, hertz.half_width, 0.01);
        assert_near(found.peak, hertz.peak, 0.01);
    }
}

#[test]
fn a_cylinder_on_a_block_with_friction_agrees_with_the_benchmark() {
    // NAFEMS Konter 2006 no. 1, μ = 0.1. Friction holds back the softer block, which would shrink
    // towards the axis by more than the cylinder: Flamant's (1 − 2ν)(1 + ν)(1/E₂ − 1/E₁) μ p, p
    // half the peak, is an extra slope of 0.9e-3 on the x/R = 0.06 at half the contact. So the
    // contact is narrower and the pressure higher than Hertz', by 1 to 2 %, give or take half a percent as above.
    let hertz = Hertz::new(LOAD, 50.0, contact_modulus([STEEL, ALUMINIUM]));
    for cylinder_first in [true, false] {
        let found = konter(0.25, 0.1, cylinder_first);
        let (narrower, higher) = (hertz.half_width / found.half_width, found.peak / hertz.peak);
        assert!((1.005..1.025).contains(&narrower), "{narrower}");
        assert!((1.005..1.025).contains(&higher), "{higher}");
    }
}

#[test]
fn the_top_of_the_block_sinks_as_far_as_in_the_benchmark_but_for_large_displacement() {
    // The published −1.30264 mm comes from runs with large displacement. Small displacement gives
    // 2.5 % less, 1.2706 mm, with cells of a half and of a quarter of a millimetre: the mesh is not
    // the reason. Strains of a twentieth below the contact, of first order only here, may be, and so
    // may the base: free to slide, it adds 0.0175 mm. Where the cylinder carries the contacts they
    // close along its radii, and friction takes a part of the approach for slip: another 1 %.
    // Both loads are reached to 1e-4. The 3 % and the 1.2 % guard what was found; nothing published bounds them.
    let of = |fine| konter(fine, 0.1, false).sunk;
    let (coarse, sunk) = (of(0.5), of(0.25));
    assert_near(coarse, sunk, 2e-4);
    assert_near(sunk, 1.30264, 0.03);
    assert_near(konter(0.25, 0.1, true).sunk, sunk, 0.012);
}
