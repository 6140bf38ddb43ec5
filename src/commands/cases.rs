//! `dpana cases`: one scene under many values.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use dpana::Variation;

use super::outputs::{check_output, say, write_table};
use super::progress::Progress;
use super::scene_file::{half_space_scene, read_scene};

#[derive(Args)]
pub(crate) struct Cases {
    /// Scene in JSON, of bodies or of half-spaces; `-` reads it from standard input, without load steps.
    scene: PathBuf,
    /// Quantity and its values: `friction=0.1:0.9:17` (from, to, how many) or `gap=0,1e-3`.
    /// Given again, all combinations are solved. Quantities: friction, gap,
    /// contacts[0].friction, contacts[0].gap, contacts[0].x (motion of the obstacle),
    /// bodies[0].loads[0] and bodies[0].supports[0] (factors); of half-spaces load, approach, friction,
    /// shift_x, shift_y, force_x, force_y.
    #[arg(long, value_name = "NAME=VALUES", required = true)]
    vary: Vec<String>,
    /// Write the table to this file: JSON if it ends so, else CSV; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

pub(crate) fn cases(arguments: &Cases) -> Result<ExitCode, Box<dyn Error>> {
    check_output("--out", &arguments.out, &arguments.scene)?;
    let variations = arguments.vary.iter().map(|text| variation(text));
    let variations: Vec<Variation> = variations.collect::<Result<_, _>>()?;
    let progress = Progress::new(false);
    let show = |done: usize, all: usize| progress.show(&format!("{done} of {all} cases"));
    let table = match half_space_scene(&arguments.scene)? {
        Some(scene) => dpana::half_space_cases(&scene, &variations, show)?,
        None => dpana::cases_watched(&read_scene(&arguments.scene)?, &variations, show)?,
    };
    drop(progress);
    write_table(&arguments.out, &table)?;
    let certified = dpana::report::Cell::Word("certified".into());
    let sound = table
        .rows
        .iter()
        .filter(|row| row.contains(&certified))
        .count();
    let line = format!("{} cases, {sound} certified", table.rows.len());
    say([&arguments.out], &line)?;
    Ok(match sound == table.rows.len() {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(1),
    })
}

/// Reads `name=from:to:count` or `name=value,value,...`.
fn variation(text: &str) -> Result<Variation, String> {
    let refuse = || {
        format!(
            "--vary {text}: not understood; expected NAME=FROM:TO:COUNT with a COUNT of 2 to \
             1000000, or NAME=VALUE,VALUE"
        )
    };
    let (name, values) = text.split_once('=').ok_or_else(refuse)?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| refuse());
    let parts: Vec<&str> = values.split(':').collect();
    let values = match parts[..] {
        [from, to, count] => {
            let (from, to) = (number(from)?, number(to)?);
            let count: usize = count.trim().parse().map_err(|_| refuse())?;
            if !(2..=1_000_000).contains(&count) {
                return Err(refuse());
            }
            let last = (count - 1) as f64;
            let part = |k: usize| k as f64 / last;
            (0..count)
                .map(|k| from * (1.0 - part(k)) + to * part(k))
                .collect()
        }
        [list] => list.split(',').map(number).collect::<Result<_, _>>()?,
        _ => return Err(refuse()),
    };
    Ok(Variation {
        name: name.trim().to_owned(),
        values,
    })
}
