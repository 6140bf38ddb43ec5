//! Two curved bodies of one material, pressed and sheared: the fields of Cattaneo and Mindlin
//! (Johnson, Contact Mechanics, Cambridge 1985, ch. 7), which depend on the order of the loads.

use std::f64::consts::PI;

use dpana::body::{CellKind, Mesh, rectangle};
use dpana::mesh_file::gmsh;
use dpana::report::{Report, ReportedLedger};
use dpana::scene::SceneSteps;
use dpana::{Scene, Status, solve_steps};

use crate::stacks::{body, contact, hold, part, scene};

const RADIUS: f64 = 100.0;
const FRICTION: f64 = 0.3;
const PRESSED: f64 = 0.019;
const SHEARED: f64 = 0.006;

/// Rows of a table of factors.
type Rows<'a> = &'a [[f64; 2]];

/// The shipped parabola and its flat, 16 cells a side.
fn shipped() -> [Mesh; 2] {
    let text = include_str!("../data/meshes/B2_mindlin_n16.msh");
    let mesh = gmsh::parse(text, "B2_mindlin_n16.msh").unwrap();
    [
        ("body0", [["contact", "bottom"], ["top", "back"]]),
        ("body1", [["master", "top"], ["base", "back"]]),
    ]
    .map(|(group, names)| {
        let mut mesh = part(&mesh, group);
        for [shipped, name] in names {
            let facets = mesh.groups.remove(shipped).unwrap();
            mesh.groups.insert(name.to_owned(), facets);
        }
        mesh
    })
}

/// A parabola and a flat of 40 mm × 20 mm each, `cells` per mm at their faces.
fn meshed(cells: f64) -> [Mesh; 2] {
    let mut lines = vec![0.0];
    let mut size = 1.0 / cells;
    while lines[lines.len() - 1] < 20.0 - size {
        lines.push(lines[lines.len() - 1] + size);
        if lines[lines.len() - 1] > 1.4 {
            size *= 1.15;
        }
    }
    lines.push(20.0);
    let mut depths = vec![0.0];
    let mut size = 1.0 / cells;
    while depths[depths.len() - 1] < 20.0 - size {
        depths.push(depths[depths.len() - 1] + size);
        size *= 1.12;
    }
    depths.push(20.0);
    let left = lines[1..].iter().rev().map(|x| -x);
    let xs: Vec<f64> = left.chain(lines.iter().copied()).collect();
    let mut upper = rectangle(&xs, &depths, CellKind::Quad4).unwrap();
    for [x, y, _] in &mut upper.nodes {
        *y += *x * *x / (4.0 * RADIUS) * (1.0 - *y / 20.0);
    }
    let ys: Vec<f64> = depths.iter().rev().map(|depth| -depth).collect();
    let mut lower = rectangle(&xs, &ys, CellKind::Quad4).unwrap();
    for [x, y, _] in &mut lower.nodes {
        *y -= *x * *x / (4.0 * RADIUS) * (1.0 + *y / 20.0);
    }
    for (mesh, back) in [(&mut upper, "top"), (&mut lower, "bottom")] {
        let facets = mesh.groups[back].clone();
        mesh.groups.insert("back".to_owned(), facets);
    }
    [upper, lower]
}

/// The parabola pushed down on its flat by `down` times 0.019 mm and sideways by `along` times
/// 0.006 mm.
fn mindlin([upper, lower]: [Mesh; 2], at: &[f64], down: Rows<'_>, along: Rows<'_>) -> Scene {
    let [upper, lower] =
        [("upper", upper), ("lower", lower)].map(|(name, mesh)| body(name, mesh, 210e3, 0.3));
    let upper = hold(hold(upper, "back", 0, SHEARED), "back", 1, -PRESSED);
    let lower = hold(hold(lower, "back", 0, 0.0), "back", 1, 0.0);
    let pair = contact(["upper", "bottom"], ["lower", "top"], FRICTION);
    let mut scene = scene(vec![upper, lower], vec![pair]);
    let rows = |rows: Rows<'_>| rows.iter().map(|row| row.to_vec()).collect();
    scene.steps = Some(SceneSteps {
        at: at.to_vec(),
        factors: [
            ("bodies[0].supports[0]".to_owned(), rows(along)),
            ("bodies[0].supports[1]".to_owned(), rows(down)),
        ]
        .into(),
        ..SceneSteps::default()
    });
    scene
}

/// The report of every step; all must be certified on two factorisations.
fn reports(scene: &Scene) -> Vec<Report> {
    let mut reports = Vec::new();
    let last = solve_steps(scene, None, |solution| {
        assert_eq!(solution.status(), Status::Certified);
        reports.push(solution.report()?);
        Ok(())
    });
    assert_eq!(last.unwrap().condensed().work().factorisations, 2);
    reports
}

/// Hertz's pressure at a load per length.
#[derive(Clone, Copy)]
struct Hertz {
    half_width: f64,
    peak: f64,
}

impl Hertz {
    fn new(load: f64) -> Self {
        let modulus = 210e3 / (2.0 * (1.0 - 0.09));
        let half_width = (4.0 * load * RADIUS / (PI * modulus)).sqrt();
        let peak = 2.0 * load / (PI * half_width);
        Self { half_width, peak }
    }

    fn at(self, x: f64) -> f64 {
        self.peak * (1.0 - (x / self.half_width).powi(2)).max(0.0).sqrt()
    }

    /// c/a = √(1 − Q/(μP)).
    fn stick(self, load: f64, shear: f64) -> f64 {
        self.half_width * (1.0 - shear / (FRICTION * load)).sqrt()
    }

    /// q = μ (p₀/a) [√(a²−x²) − √(c²−x²)].
    fn cattaneo(self, stick: f64, x: f64) -> f64 {
        let inner = (stick * stick - x * x).max(0.0).sqrt();
        FRICTION * (self.at(x) - self.peak / self.half_width * inner)
    }
}

/// P and Q on the lower body, per depth: Q positive the way the upper body is pushed.
fn resultants(report: &Report) -> (f64, f64) {
    (report.totals.normal, -report.totals.friction[0])
}

/// L2 difference of the shear from a field, relative to that of another field.
fn departure(report: &Report, field: impl Fn(f64) -> f64, size: impl Fn(f64) -> f64) -> f64 {
    let (mut error, mut sum) = (0.0, 0.0);
    for contact in &report.contacts {
        let shear = -contact.friction_traction.as_ref().unwrap()[0];
        let x = contact.position[0];
        error += contact.area * (shear - field(x)).powi(2);
        sum += contact.area * size(x).powi(2);
    }
    (error / sum).sqrt()
}

/// L2 differences from a field, over the length of contact: of the shear, linear between its nodes,
/// and of what is linear between the field's own values at the nodes.
fn between_nodes(report: &Report, field: impl Fn(f64) -> f64) -> [f64; 2] {
    const POINTS: u32 = 200;
    let nodes = report.contacts.iter().map(|contact| {
        let shear = -contact.friction_traction.as_ref().unwrap()[0];
        (contact.position[0], shear)
    });
    let mut nodes: Vec<(f64, f64)> = nodes.collect();
    nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut squares = [0.0; 2];
    for ends in nodes.windows(2) {
        let [(left, q), (right, r)] = [ends[0], ends[1]];
        let exact = [field(left), field(right)];
        for k in 0..POINTS {
            let part = (f64::from(k) + 0.5) / f64::from(POINTS);
            let weight = (right - left) / f64::from(POINTS);
            let at = field(left + part * (right - left));
            for (square, [a, b]) in squares.iter_mut().zip([[q, r], exact]) {
                *square += weight * (a + part * (b - a) - at).powi(2);
            }
        }
    }
    squares.map(f64::sqrt)
}

/// Half the length that sticks, in mm.
fn stick(report: &Report) -> f64 {
    0.5 * (report.totals.contact_area - report.totals.slip_area)
}

/// `count` instants up to `end`, the first after `start`.
fn instants(start: f64, end: f64, count: u32) -> impl Iterator<Item = f64> {
    (1..=count).map(move |k| start + (end - start) * f64::from(k) / f64::from(count))
}

/// Presses in `count` steps, then shears to Q/(μP) ≈ 0.25, 0.5, 0.75, 0.9; the last four reports.
///
/// The surfaces are inclined: a node that approaches moves along its tangent a little. In many
/// steps it begins its slip where it closes and not where it stood before loading.
fn pressed_then_sheared(meshes: [Mesh; 2], count: u32) -> Vec<Report> {
    let sheared = [1.36, 1.72, 2.09, 2.34];
    let at: Vec<f64> = instants(0.0, 1.0, count).chain(sheared).collect();
    let along = [[1.0, 0.0], [3.0, 2.0]];
    let reports = reports(&mindlin(meshes, &at, &[[0.0, 0.0], [1.0, 1.0]], &along));
    reports[count as usize..].to_vec()
}

#[test]
fn the_shipped_pair_sticks_where_cattaneo_and_mindlin_say() {
    // Eleven cells across the contact. Between its nodes not even the exact shear, made linear, is
    // nearer than 23, 12, 8 and 6 % of itself, for its slope is infinite at ±c and ±a: the computed
    // one is held against that, with a twentieth more for its own error. In the sum over nodes n constant
    // strips per half-width miss a pressure in L2 by 0.11/n (references: computed); the shear is a difference
    // of two, over a and over c: 0.11/n (1 + √(c/a)) of μ p, 0.039 with n = 5.5, and over the shear itself,
    // a part of 0.26, 0.5, 0.75 and 0.89 of μ p in L2, 0.15, 0.07, 0.046 and 0.035.
    let ratios = [0.25, 0.5, 0.75, 0.9];
    for (report, ratio) in pressed_then_sheared(shipped(), 40).iter().zip(ratios) {
        let (load, shear) = resultants(report);
        // The state that was meant; what is expected follows from the forces found.
        assert!((shear / (FRICTION * load) - ratio).abs() < 0.01);
        let hertz = Hertz::new(load);
        let c = hertz.stick(load, shear);
        // Half a cell.
        assert!(
            (stick(report) - c).abs() < 0.09375,
            "{ratio}: {} {c}",
            stick(report)
        );
        let field = |x| hertz.cattaneo(c, x);
        let [error, of_exact] = between_nodes(report, field);
        assert!(error < 1.05 * of_exact, "{ratio}: {error} {of_exact}");
        let error = departure(report, field, |x| FRICTION * hertz.at(x));
        assert!(error < 0.04, "{ratio}: {error}");
        let error = departure(report, field, field);
        let most = if ratio < 0.7 { 0.1 } else { 0.04 };
        assert!(error < most, "{ratio}: {error}");
    }
}

#[test]
fn on_a_fine_mesh_the_shear_is_that_of_cattaneo_and_mindlin() {
    let cells = 40.0;
    let sheared = pressed_then_sheared(meshed(cells), 80);
    for (report, ratio) in sheared.iter().zip([0.25, 0.5, 0.75, 0.9]) {
        let (load, shear) = resultants(report);
        assert!((shear / (FRICTION * load) - ratio).abs() < 0.01);
        let hertz = Hertz::new(load);
        let c = hertz.stick(load, shear);
        // Half a cell.
        assert!(
            (stick(report) - c).abs() < 0.5 / cells,
            "{ratio}: {} {c}",
            stick(report)
        );
        let field = |x| hertz.cattaneo(c, x);
        let error = departure(report, field, field);
        // Strips as above, forty: 0.02 at the first ratio. Where tangents are inclined by x/R on one side p x/(2R)
        // of a vertical pressure counts as friction, a/(2μR) √(1/5) = 0.8 % of μ p in L2, there 0.03 of the shear.
        assert!(error < 0.04, "{ratio}: {error}");
    }
}

#[test]
fn sheared_and_pressed_in_proportion_nothing_slips() {
    let at: Vec<f64> = instants(0.0, 1.0, 160).collect();
    let down = [[0.0, 0.0], [1.0, 1.0]];
    let reports = reports(&mindlin(
        meshed(20.0),
        &at,
        &down,
        &[[0.0, 0.0], [1.0, 0.8]],
    ));
    let states: Vec<(f64, f64)> = reports.iter().map(resultants).collect();
    // dp = dP/(π√(a² − x²)) and dq = dQ/(π√(a² − x²)): q = Σ (ΔQ/ΔP) Δp.
    let field = |x: f64| {
        let (mut before, mut q) = ((0.0, 0.0, 0.0), 0.0);
        for &(load, shear) in states.iter().filter(|(load, _)| *load > 0.0) {
            let p = Hertz::new(load).at(x);
            q += (shear - before.1) / (load - before.0) * (p - before.2);
            before = (load, shear, p);
        }
        q
    };
    let last = reports.last().unwrap();
    let (load, shear) = resultants(last);
    assert!(shear > 0.5 * FRICTION * load);
    assert_eq!(last.totals.slip, 0);
    // 0.11/n of strips, n = 20, and up to 0.015 of inclined tangents, 0.8 % of μ p (above) with q > μ p/2.
    let error = departure(last, field, field);
    assert!(error < 0.03, "{error}");
    let hertz = Hertz::new(load);
    let other = |x| hertz.cattaneo(hertz.stick(load, shear), x);
    assert!(departure(last, other, other) > 10.0 * error);
}

#[test]
fn pressed_on_after_shear_the_first_shear_stays() {
    let at: Vec<f64> = instants(0.0, 0.3, 40)
        .chain([1.0])
        .chain(instants(1.0, 3.0, 80))
        .collect();
    let down = [[0.0, 0.0], [0.3, 0.3], [1.0, 0.3], [3.0, 1.0]];
    let reports = reports(&mindlin(
        meshed(40.0),
        &at,
        &down,
        &[[0.3, 0.0], [1.0, 0.25]],
    ));
    let (load, shear) = resultants(&reports[40]);
    let hertz = Hertz::new(load);
    let field = |x| hertz.cattaneo(hertz.stick(load, shear), x);
    let last = reports.last().unwrap();
    let (more, same) = resultants(last);
    // Pressing bodies of one material shears them by (a/R)² at most.
    assert!(more > 3.9 * load && (same / shear - 1.0).abs() < 1e-4);
    assert_eq!(last.totals.slip, 0);
    // A guard: strips are half as many in the first contact, and tangents are inclined under the last pressure.
    let error = departure(last, field, field);
    assert!(error < 0.04, "{error}");
    let hertz = Hertz::new(more);
    let other = |x| hertz.cattaneo(hertz.stick(more, same), x);
    assert!(departure(last, other, other) > 0.5);
}

/// A cycle of Q between its extremes in steps of 1/`parts` of a quarter; reports from the first
/// extreme on.
fn cycle(parts: u32, resolve: Option<f64>) -> Vec<Report> {
    let at: Vec<f64> = [1.0, 2.0]
        .into_iter()
        .chain(instants(2.0, 6.0, 4 * parts))
        .collect();
    let along = [[1.0, 0.0], [2.0, 0.6], [4.0, -0.6], [6.0, 0.6]];
    let mut scene = mindlin(shipped(), &at, &[[0.0, 0.0], [1.0, 1.0]], &along);
    scene.steps.as_mut().unwrap().resolve = resolve;
    reports(&scene)[1..].to_vec()
}

/// ∮ Q dδ, from the totals that a user reads.
fn area(reports: &[Report]) -> f64 {
    let points = reports.iter().map(|report| {
        let driven = &report.step.as_ref().unwrap().driven;
        (-report.totals.contact_force[0], SHEARED * driven[0].1)
    });
    let points: Vec<(f64, f64)> = points.collect();
    let chords = points.windows(2);
    chords
        .map(|ends| 0.5 * (ends[0].0 + ends[1].0) * (ends[1].1 - ends[0].1))
        .sum()
}

/// What a cycle adds to the ledger; it must close, force by force.
fn round(reports: &[Report]) -> ReportedLedger {
    // Certified to 1e-12, and two digits for the condition of G and for slips that up to 640 steps hand on; the
    // elastic energy is five hundred times what a cycle dissipates.
    let (first, last) = (&reports[0], &reports[reports.len() - 1]);
    for (a, b) in first.contacts.iter().zip(&last.contacts) {
        for axis in 0..2 {
            assert!((a.force[axis] - b.force[axis]).abs() < 1e-10 * last.totals.normal);
        }
    }
    for report in reports {
        assert!(report.step.as_ref().unwrap().ledger.dissipation >= 0.0);
    }
    let [before, after] = [first, last].map(|report| report.step.as_ref().unwrap().total);
    let cycle = ReportedLedger {
        loads: after.loads - before.loads,
        supports: after.supports - before.supports,
        obstacles: after.obstacles - before.obstacles,
        fits: after.fits - before.fits,
        elastic: after.elastic - before.elastic,
        dissipation: after.dissipation - before.dissipation,
        closure: after.closure - before.closure,
    };
    assert!(cycle.elastic.abs() < 1e-8 * cycle.dissipation);
    cycle
}

#[test]
fn a_cycle_of_shear_closes_and_its_area_is_what_friction_dissipates() {
    let mut misfits = Vec::new();
    let mut dissipated = Vec::new();
    for parts in [10, 40, 160] {
        let reports = cycle(parts, None);
        let (round, area) = (round(&reports), area(&reports));
        // The work of the supports is that area, and what it is not is said to be open: sums of works that are
        // five hundred times those of the cycle, each to 1e-12.
        assert!((round.supports / area - 1.0).abs() < 1e-9);
        assert!((area - round.dissipation - round.closure).abs() < 1e-9 * round.dissipation);
        misfits.push((area / round.dissipation - 1.0).abs());
        dissipated.push(round.dissipation);
    }
    // Chords cut the corners where contacts begin to slip, by the square of the steps; what
    // friction dissipates is known from the first on. Half a cycle is 2n steps, in the one where a contact begins
    // to slip ½ · 1/2n · 1/2n of twice its friction times its slip is cut off: ¼/n². Normal forces follow the
    // shear by θ² = 1e-4, θ = a/R, of which as much is cut off.
    for (misfit, parts) in misfits.iter().zip([10.0, 40.0, 160.0_f64]) {
        assert!(*misfit < 0.25 / parts.powi(2), "{misfits:?}");
    }
    assert!(
        (dissipated[0] / dissipated[2] - 1.0).abs() < 1e-6,
        "{dissipated:?}"
    );
}

#[test]
fn halved_where_contacts_begin_to_slip_the_work_of_a_cycle_is_its_dissipation() {
    let reports = cycle(5, Some(1e-5));
    let round = round(&reports);
    let misfit = round.supports / round.dissipation - 1.0;
    // Of second order, the last halving leaves less than it shows: a tenth of the 1e-5 asked for is a guard.
    assert!(misfit.abs() < 1e-6, "{misfit}");
    let halvings = reports[1..]
        .iter()
        .map(|report| report.step.as_ref().unwrap().halving.unwrap());
    let halvings: Vec<_> = halvings.collect();
    assert!(halvings.iter().all(|halving| halving.resolved));
    // Equal steps take 6400 for that: a guard of the work, not of the answer.
    let parts: usize = halvings.iter().map(|halving| halving.parts).sum();
    assert!(parts <= 100, "{parts}");
}

/// Sheared to an extreme Q₀, back to the other and to the first again, against the field of Q₀ with
/// twice that of half the change from the last extreme on top (Johnson, sec. 7.4; Jaeger, New
/// Solutions in Contact Mechanics, WIT Press 2005), on contacts that stand `size` mm apart.
///
/// The end of the zone of stick lies between two contacts, and there the field is steepest: the
/// error is that of where it lies, of first order. Strips miss the parts over a, c and twice c' by
/// 0.11/n (1 + √(c/a) + 2 √(c'/a)) of μ p, up to 0.44 size/a with a = 1 mm, and by up to twice that where
/// the ends fall badly.
fn sheared_to_and_fro(meshes: [Mesh; 2], size: f64) {
    let at = instants(0.0, 1.0, 40)
        .chain([2.0])
        .chain(instants(2.0, 6.0, 16));
    let at: Vec<f64> = at.collect();
    let along = [[1.0, 0.0], [2.0, 0.9], [4.0, -0.9], [6.0, 0.9]];
    let scene = mindlin(meshes, &at, &[[0.0, 0.0], [1.0, 1.0]], &along);
    let reports = reports(&scene)[40..].to_vec();
    let (load, extreme) = resultants(&reports[0]);
    assert!((0.6..0.7).contains(&(extreme / (FRICTION * load))));
    for (number, report) in reports.iter().enumerate().skip(1) {
        let way = if number <= 8 { 1.0 } else { -1.0 };
        let (load, shear) = resultants(report);
        let hertz = Hertz::new(load);
        let first = hertz.stick(load, extreme);
        let back = hertz.stick(load, 0.5 * (extreme - way * shear));
        let field = |x| way * (hertz.cattaneo(first, x) - 2.0 * hertz.cattaneo(back, x));
        let error = departure(report, field, |x| FRICTION * hertz.at(x));
        assert!(error < 0.7 * size, "{number}: {error}");
        let stuck = stick(report);
        // Half a cell, and a tenth for that of Q₀.
        assert!(
            (stuck - back).abs() < 0.6 * size,
            "{number}: {stuck} {back}"
        );
    }
}

#[test]
fn on_the_shipped_pair_cyclic_shear_superposes_cattaneo_and_mindlin() {
    sheared_to_and_fro(shipped(), 0.1875);
}

#[test]
fn on_a_fine_mesh_cyclic_shear_superposes_cattaneo_and_mindlin() {
    sheared_to_and_fro(meshed(30.0), 1.0 / 30.0);
}
