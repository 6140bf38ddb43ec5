//! Solves a scene and prints its summary.
//!
//! `cargo run --release --example signorini [SCENE]`; without a scene the square SSNV128 of
//! code_aster (V6.04.128, from the benchmarks of the French group GRECO), beside the
//! published displacements.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use dpana::report::Report;
use dpana::{Scene, Solution, Status};

/// The square on 32 × 32 quadrilaterals.
const SSNV128: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/ssnv128.json");

/// A node of the contact line, with u_x in 1e-6 m on this very mesh, in the limit of fine
/// meshes, and in the handbook ("average of codes", 5 %; its E is 2.7 % off).
struct Published {
    name: char,
    x: f64,
    same_mesh: f64,
    limit: f64,
    handbook: f64,
}

const fn published(name: char, x: f64, [same_mesh, limit, handbook]: [f64; 3]) -> Published {
    Published {
        name,
        x,
        same_mesh,
        limit,
        handbook,
    }
}

const PUBLISHED: [Published; 5] = [
    published('A', 0.0, [28.59438, 28.602, 28.6]),
    published('B', 0.00125, [27.21685, 27.225, 27.2]),
    published('C', 0.005, [22.84998, 22.867, 22.8]),
    published('D', 0.0075, [19.79627, 19.807, 19.8]),
    published('E', 0.01125, [15.40564, 15.413, 15.0]),
];

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let path = std::env::args_os().nth(1);
    let (solution, report) = solve(path.as_deref().unwrap_or(SSNV128.as_ref()).as_ref())?;
    if path.is_none() {
        print_beside_published(&solution, &report)?;
    }
    println!("{}", report.summary().trim_end());
    Ok(match solution.status() {
        Status::Certified => ExitCode::SUCCESS,
        Status::NotConverged | Status::NoEquilibrium | Status::CouplingFault => ExitCode::FAILURE,
    })
}

fn solve(path: &Path) -> Result<(Solution, Report), Box<dyn Error>> {
    let solution = dpana::solve(&Scene::from_file(path)?)?;
    let report = solution.report()?;
    Ok((solution, report))
}

/// u_x of a node of the contact line, in 1e-6 m.
fn slide(solution: &Solution, x: f64) -> Result<f64, dpana::Error> {
    Ok(1e6 * solution.displacement_near(0, [x, 0.0, 0.0])?[0])
}

fn print_beside_published(solution: &Solution, report: &Report) -> Result<(), dpana::Error> {
    println!("u_x on the contact line, in 1e-6 m:\n");
    println!("  node   x [mm]        here   Q4 32×32     limit   handbook");
    for point in &PUBLISHED {
        println!(
            "  {:<4} {:>8.2} {:>11.5} {:>10.5} {:>9.3} {:>10.1}",
            point.name,
            1e3 * point.x,
            slide(solution, point.x)?,
            point.same_mesh,
            point.limit,
            point.handbook,
        );
    }
    let totals = &report.totals;
    let states = (totals.open, totals.slip, totals.stick);
    println!("\n                              here      published");
    println!("  open / slip / stick   {:>10}        3/21/8", join(states));
    println!(
        "  friction [N/m]        {:>10.4e}    -1.4054e6",
        totals.friction[0]
    );
    println!(
        "  natural-map residual  {:>10.1e}\n",
        report.certificate.natural_map
    );
    Ok(())
}

fn join((open, slip, stick): (usize, usize, usize)) -> String {
    format!("{open}/{slip}/{stick}")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_square_slides_sticks_and_opens_as_published() {
        let (solution, report) = solve(SSNV128.as_ref()).unwrap();
        for point in &PUBLISHED {
            let found = slide(&solution, point.x).unwrap();
            // Half of the last printed digit, and what its own rounding adds.
            let error = (found - point.same_mesh).abs();
            assert!(
                error < 6e-6,
                "{}: {found} against {}",
                point.name,
                point.same_mesh
            );
        }
        let totals = &report.totals;
        assert_eq!((totals.open, totals.slip, totals.stick), (3, 21, 8));
        let friction = totals.friction[0];
        // To its five digits, which hold for the limit and, but for the last, on this mesh.
        assert!((friction / -1.4054e6 - 1.0).abs() < 1e-4, "{friction}");
        assert_eq!(solution.status(), Status::Certified);
        assert!(report.certificate.natural_map <= 1e-12);
    }
}
