//! Solves a scene of several bodies and prints its summary.
//!
//! `cargo run --release --example two_body [SCENE]`; without a scene a steel punch that nothing
//! holds but an aluminium block of another mesh: it is pressed down and pushed, and slips in part.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use dpana::report::Report;
use dpana::{Scene, Status};

const PUNCH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/punch.json");

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let path = std::env::args_os().nth(1);
    let (status, report) = solve(path.as_deref().unwrap_or(PUNCH.as_ref()).as_ref())?;
    println!("{}", report.summary().trim_end());
    Ok(match status {
        Status::Certified => ExitCode::SUCCESS,
        Status::NotConverged | Status::NoEquilibrium | Status::CouplingFault => ExitCode::FAILURE,
    })
}

fn solve(path: &Path) -> Result<(Status, Report), Box<dyn Error>> {
    let solution = dpana::solve(&Scene::from_file(path)?)?;
    let report = solution.report()?;
    Ok((solution.status(), report))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_punch_slips_in_part_and_hands_its_loads_to_the_foundation() {
        let (status, report) = solve(PUNCH.as_ref()).unwrap();
        assert_eq!(status, Status::Certified);
        let totals = &report.totals;
        assert!(totals.stick > 0 && totals.slip > 0, "{totals:?}");
        // 20 mm under (20, −100) MPa. Statics, certified to 1e-12 of the load, and a digit for its smaller part.
        assert!((totals.normal / 2000.0 - 1.0).abs() < 1e-11);
        assert!((totals.friction[0] / -400.0 - 1.0).abs() < 1e-11);
        let below = &report.certificate.bodies[1].supports.force;
        assert!((below[0] / -400.0 - 1.0).abs() < 1e-11 && (below[1] / 2000.0 - 1.0).abs() < 1e-11);
    }
}
