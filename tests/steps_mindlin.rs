//! Two curved bodies of one material, pressed and sheared: the fields of Cattaneo and Mindlin
//! (Johnson, Contact Mechanics, Cambridge 1985, ch. 7), which depend on the order of the loads.
#![allow(clippy::unwrap_used, missing_docs)]

mod stacks;

use std::f64::consts::PI;

use dpana::body::gmsh;
use dpana::report::Report;
use dpana::scene::SceneSteps;
use dpana::{Scene, Status, solve_steps};

use stacks::{body, contact, hold, part, scene};

const RADIUS: f64 = 100.0;
const FRICTION: f64 = 0.3;
const PRESSED: f64 = 0.019;
const SHEARED: f64 = 0.006;

/// Rows of a table of factors.
type Rows<'a> = &'a [[f64; 2]];

/// The parabola on its flat: pushed down by `down` times 0.019 mm and sideways by `along` times 0.006 mm.
fn mindlin(at: &[f64], down: Rows<'_>, along: Rows<'_>) -> Scene {
    let text = include_str!("data/meshes/B2_mindlin_n16.msh");
    let mesh = gmsh::parse(text, "B2_mindlin_n16.msh").unwrap();
    let [upper, lower] = [("upper", "body0"), ("lower", "body1")]
        .map(|(name, group)| body(name, part(&mesh, group), 210e3, 0.3));
    let upper = hold(hold(upper, "top", 0, SHEARED), "top", 1, -PRESSED);
    let lower = hold(hold(lower, "base", 0, 0.0), "base", 1, 0.0);
    let pair = contact(["upper", "contact"], ["lower", "master"], FRICTION);
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

/// L2 difference of the shear from a field, relative to the field.
fn departure(report: &Report, field: impl Fn(f64) -> f64) -> f64 {
    let (mut error, mut size) = (0.0, 0.0);
    for contact in &report.contacts {
        let shear = -contact.friction_traction.as_ref().unwrap()[0];
        let exact = field(contact.position[0]);
        error += contact.area * (shear - exact).powi(2);
        size += contact.area * exact * exact;
    }
    (error / size).sqrt()
}

/// Half the length that sticks, in mm.
fn stick(report: &Report) -> f64 {
    0.5 * (report.totals.contact_area - report.totals.slip_area)
}

/// Largest cell of the contact, in mm.
fn cell(report: &Report) -> f64 {
    let pressed = report.contacts.iter().filter(|c| c.pressure.unwrap() > 0.0);
    pressed.map(|contact| contact.area).fold(0.0, f64::max)
}

#[test]
fn pressed_and_then_sheared_the_edge_slips_as_cattaneo_and_mindlin_say() {
    let at: Vec<f64> = (0..=20).map(|k| 1.0 + f64::from(k) / 20.0).collect();
    let scene = mindlin(&at, &[[0.0, 0.0], [1.0, 1.0]], &[[1.0, 0.0], [2.0, 1.0]]);
    let reports = reports(&scene);
    for report in &reports[1..] {
        let (load, shear) = resultants(report);
        let ratio = shear / (FRICTION * load);
        let hertz = Hertz::new(load);
        let c = hertz.stick(load, shear);
        eprintln!(
            "{:.3} ratio {ratio:.4} stick {:.5} exact {c:.5} cell {:.5} L2 {:.4} sweeps {} newton {}",
            report.step.as_ref().unwrap().at,
            stick(report),
            cell(report),
            departure(report, |x| hertz.cattaneo(c, x)),
            report.work.sweeps,
            report.work.newton_steps
        );
    }
}

#[test]
fn sheared_and_pressed_in_proportion_nothing_slips() {
    let at: Vec<f64> = (1..=40).map(|k| f64::from(k) / 40.0).collect();
    let scene = mindlin(&at, &[[0.0, 0.0], [1.0, 1.0]], &[[0.0, 0.0], [1.0, 0.3]]);
    let reports = reports(&scene);
    let states: Vec<(f64, f64)> = reports.iter().map(resultants).collect();
    // dp = dP/(π√(a² − x²)) and dq = dQ/(π√(a² − x²)): q = Σ (ΔQ/ΔP) Δp.
    let field = |x: f64| {
        let mut before = (0.0, 0.0, 0.0);
        let mut q = 0.0;
        for &(load, shear) in &states {
            let p = Hertz::new(load).at(x);
            q += (shear - before.1) / (load - before.0) * (p - before.2);
            before = (load, shear, p);
        }
        q
    };
    let last = reports.last().unwrap();
    let (load, shear) = resultants(last);
    let hertz = Hertz::new(load);
    let c = hertz.stick(load, shear);
    eprintln!(
        "proportional Q/μP {:.4}, slip {} of {}, L2 own {:.4}, L2 of P then Q {:.4}",
        shear / (FRICTION * load),
        last.totals.slip,
        last.totals.stick,
        departure(last, field),
        departure(last, |x| hertz.cattaneo(c, x))
    );
}

#[test]
fn pressed_a_little_sheared_and_then_pressed_the_first_shear_stays() {
    let at = [0.3, 0.5, 1.0, 2.0, 2.5, 3.0];
    let scene = mindlin(
        &at,
        &[[0.0, 0.0], [0.3, 0.3], [1.0, 0.3], [3.0, 1.0]],
        &[[0.3, 0.0], [1.0, 0.25]],
    );
    let reports = reports(&scene);
    let (load, shear) = resultants(&reports[2]);
    let hertz = Hertz::new(load);
    let c = hertz.stick(load, shear);
    for report in &reports {
        let (p, q) = resultants(report);
        eprintln!(
            "P {p:.3} Q {q:.4} slip {} L2 {:.4} of own P {:.4}",
            report.totals.slip,
            departure(report, |x| hertz.cattaneo(c, x)),
            departure(report, |x| Hertz::new(p)
                .cattaneo(Hertz::new(p).stick(p, q), x))
        );
    }
}

#[test]
fn a_cycle_of_shear_closes_and_its_area_is_what_friction_dissipates() {
    for parts in [10, 40] {
        let at: Vec<f64> = (0..=5 * parts)
            .map(|k| 1.0 + f64::from(k) / f64::from(parts))
            .collect();
        let along = [[1.0, 0.0], [2.0, 0.6], [4.0, -0.6], [6.0, 0.6]];
        let scene = mindlin(&at, &[[0.0, 0.0], [1.0, 1.0]], &along);
        let reports = reports(&scene);
        let of = |instant: f64| {
            reports
                .iter()
                .find(|r| r.step.as_ref().unwrap().at == instant)
                .unwrap()
        };
        let (first, again) = (of(2.0), of(6.0));
        let departure = first
            .contacts
            .iter()
            .zip(&again.contacts)
            .map(|(a, b)| {
                let f = (a.force[0] - b.force[0]).hypot(a.force[1] - b.force[1]);
                f
            })
            .fold(0.0, f64::max);
        let t = |r: &Report| r.step.as_ref().unwrap().total;
        let (a, b) = (t(first), t(again));
        eprintln!(
            "{parts}: closes to {:e} of {:e}; work {:e} elastic {:e} dissipation {:e} closure {:e}",
            departure,
            again.totals.normal,
            b.supports - a.supports,
            b.elastic - a.elastic,
            b.dissipation - a.dissipation,
            b.closure - a.closure
        );
        eprintln!("Q {:e} {:e}", resultants(first).1, resultants(again).1);
    }
}
