//! The SSNV128 square reaches its converged answer, in a few steps and certified.
//!
//! Reference values: displacement u_x under the square and states of the contact nodes, computed
//! independently for the same bilinear meshes; the benchmark's own values (code_aster V6.04.128:
//! 28.6, 27.2, 22.8, 19.8, 15.0 in 1e-6 m) are stated to 5 %.

use crate::square;
use dpana::scene::{MeshSource, PlaneCell};
use dpana::{Scene, Solution, Status, solve};

/// Distance from the pushed side, in metre: A, B, C, D, E.
const POINTS: [f64; 5] = [0.0, 0.00125, 0.005, 0.0075, 0.01125];

/// u_x at A to E, in 1e-6 m.
fn displacements(solution: &Solution) -> [f64; 5] {
    POINTS.map(|x| 1e6 * solution.displacement_near(0, [x, 0.0, 0.0]).unwrap()[0])
}

/// The reference row to its last printed digit, counts of open, slipping and sticking nodes, balance.
fn check_row(solution: &Solution, expected: [f64; 5], open_slip_stick: [usize; 3]) {
    assert_eq!(solution.status(), Status::Certified);
    let report = solution.report().unwrap();
    assert!(report.certificate.natural_map <= 1e-12);
    // Half of the last printed digit, and what its own rounding adds.
    for (found, expected) in displacements(solution).iter().zip(expected) {
        assert!((found - expected).abs() < 6e-6, "{found} {expected}");
    }
    let (totals, balance) = (&report.totals, &report.certificate.bodies[0]);
    assert_eq!([totals.open, totals.slip, totals.stick], open_slip_stick);
    // The total in the limit to its five digits, which meshes of 32 cells and finer reach to as much.
    assert!((totals.friction[0] / -1.4054e6 - 1.0).abs() < 1e-4);
    // The top carries 5e7 Pa · 0.04 m; the corner's support takes what the contact does not.
    let carried = totals.normal + balance.supports.force[1];
    assert!((carried / 2e6 - 1.0).abs() < 1e-12, "{carried}");
    assert!(balance.equilibrium.scaled < 1e-12 && balance.force_defect.scaled < 1e-12);
}

#[test]
fn the_mesh_from_the_file_gives_the_row_of_32_cells_in_one_sweep() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/ssnv128.json");
    let solution = solve(&Scene::from_file(file).unwrap()).unwrap();
    let row = [28.59438, 27.21685, 22.84998, 19.79627, 15.40564];
    check_row(&solution, row, [3, 21, 8]);
    let work = solution.report().unwrap().work;
    assert_eq!((work.factorisations, work.sweeps), (1, 1));
    assert!(work.cone_iterations <= 30 && work.newton_steps <= 6);
}

#[test]
fn finer_grids_give_their_rows_in_at_most_two_sweeps() {
    for (cells, row, open_slip_stick) in [
        (
            64,
            [28.60421, 27.22727, 22.86527, 19.80566, 15.41248],
            [6, 42, 16],
        ),
        (
            128,
            [28.60218, 27.22501, 22.86695, 19.80672, 15.41338],
            [11, 85, 32],
        ),
    ] {
        let solution = solve(&square::scene(cells, 0.2, 1.0)).unwrap();
        check_row(&solution, row, open_slip_stick);
        let work = solution.report().unwrap().work;
        assert_eq!(work.factorisations, 1);
        assert!(work.sweeps <= 2 && work.newton_steps <= 10, "{work:?}");
        assert!(work.cone_iterations <= 150, "{work:?}");
    }
}

#[test]
fn without_friction_the_stress_is_uniform_on_any_mesh() {
    // σ_y = −50 MPa, σ_x = −150 MPa: u_x(0) = a [(1−ν²) 150 MPa − ν (1+ν) 50 MPa] / E, and ε is constant.
    let expected = 0.04 * ((1.0 - 0.04) * 15e7 - 0.2 * 1.2 * 5e7) / 1.3e11;
    assert!((expected - 4.061_538_461_538_5e-5_f64).abs() < 1e-18);
    for (cells, cell) in [
        (3, PlaneCell::Quad4),
        (32, PlaneCell::Quad4),
        (32, PlaneCell::Tri3),
    ] {
        let mut scene = square::scene(cells, 0.2, 0.0);
        if let MeshSource::Rectangle { rectangle } = &mut scene.bodies[0].mesh {
            (rectangle.cell, rectangle.grading) = (cell, [3.0, 0.5]);
        }
        let solution = solve(&scene).unwrap();
        assert_eq!(solution.status(), Status::Certified);
        let nodes = &solution.bodies()[0].mesh.nodes;
        for (node, u) in nodes.iter().zip(solution.displacements()[0].chunks(2)) {
            let linear = expected * (1.0 - node[0] / 0.04);
            assert!(
                (u[0] - linear).abs() < 1e-12 * expected,
                "{u:?} at {node:?}"
            );
        }
        let contacts = solution.report().unwrap().contacts;
        let uneven = |pressure: f64| (pressure / 5e7 - 1.0).abs();
        assert!(contacts.iter().all(|c| uneven(c.pressure.unwrap()) < 1e-11));
    }
}

#[test]
fn a_nearly_incompressible_square_does_not_lock() {
    // Locking would show as displacements that grow with refinement and differ between cells. The
    // quadrilateral may miss by 2 h² of a side of 32 h, the triangle by h, as with averaged dilatation.
    let reference = displacements(&solve(&square::scene(128, 0.4999, 1.0)).unwrap());
    for (cell, tolerance) in [(PlaneCell::Quad4, 2e-3), (PlaneCell::Tri3, 3e-2)] {
        let mut scene = square::scene(32, 0.4999, 1.0);
        if let MeshSource::Rectangle { rectangle } = &mut scene.bodies[0].mesh {
            rectangle.cell = cell;
        }
        let solution = solve(&scene).unwrap();
        assert_eq!(solution.status(), Status::Certified);
        let work = solution.report().unwrap().work;
        assert!(work.sweeps <= 3, "{work:?}");
        for (found, fine) in displacements(&solution).iter().zip(reference) {
            let difference = (found - fine).abs();
            assert!(difference < tolerance * reference[0], "{cell:?} {found}");
        }
    }
}

#[test]
fn high_friction_is_certified_where_plain_sweeps_diverge() {
    for friction in [5.0, 10.0] {
        for cells in [32, 64, 96] {
            let solution = solve(&square::scene(cells, 0.2, friction)).unwrap();
            assert_eq!(solution.status(), Status::Certified, "{friction} {cells}");
            let report = solution.report().unwrap();
            assert!(report.certificate.natural_map <= 1e-12);
            assert!(report.certificate.disc_excess.scaled <= 1e-12);
            assert!(
                report.work.sweeps <= 30,
                "{friction} {cells}: {:?}",
                report.work
            );
        }
    }
}
