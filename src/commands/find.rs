//! `dpana find`: the parameter at which a total is what was measured.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use dpana::Search;

use super::outputs::{check_output, say, write_output};
use super::scene_file::read_scene;

#[derive(Args)]
pub(crate) struct Find {
    /// Scene in JSON (`-`: from standard input), or an Abaqus or CalculiX deck (`.inp`), without load
    /// steps.
    scene: PathBuf,
    /// Quantity and the range in which it is looked for: `friction=0:1`. Quantities are those of
    /// `dpana cases`: friction, gap, contacts[0].friction, contacts[0].gap, contacts[0].x, and the
    /// factors bodies[0].loads[0] and bodies[0].supports[0].
    #[arg(long, value_name = "NAME=FROM:TO", allow_hyphen_values = true)]
    vary: String,
    /// Total and the value that it should have: `friction_x=-4`, `least_gap=0`, a column of the table
    /// of `dpana solve --table`, or a displacement such as `u_x@0.5,0=1e-3`.
    #[arg(long, value_name = "TOTAL=VALUE", allow_hyphen_values = true)]
    so_that: String,
    /// Write the whole report of the state found to this file, in JSON; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
}

pub(crate) fn find(arguments: &Find) -> Result<ExitCode, Box<dyn Error>> {
    if let Some(output) = &arguments.report {
        check_output("--report", output, &arguments.scene)?;
    }
    let search = search(arguments)?;
    let (found, solution) = dpana::find(&read_scene(&arguments.scene)?, &search)?;
    let mut report = solution.report()?;
    report.found = Some(found);
    if let Some(path) = &arguments.report {
        write_output(path, &report.to_json())?;
    }
    say(&arguments.report, report.summary().trim_end())?;
    Ok(ExitCode::SUCCESS)
}

fn search(arguments: &Find) -> Result<Search, String> {
    let refuse = || {
        let text = &arguments.vary;
        format!("--vary {text}: not understood; expected NAME=FROM:TO")
    };
    let (parameter, range) = arguments.vary.rsplit_once('=').ok_or_else(refuse)?;
    let (from, to) = range.split_once(':').ok_or_else(refuse)?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| refuse());
    let between = [number(from)?, number(to)?];
    let text = &arguments.so_that;
    let refuse = || format!("--so-that {text}: not understood; expected TOTAL=VALUE");
    let (total, target) = text.rsplit_once('=').ok_or_else(refuse)?;
    Ok(Search {
        parameter: parameter.trim().to_owned(),
        between,
        total: total.trim().to_owned(),
        target: target.trim().parse().map_err(|_| refuse())?,
    })
}
