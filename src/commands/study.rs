//! `dpana study`: a scene over meshes, tolerances, friction and loops.

use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use dpana::report::replace_file;
use dpana::study::{self, Plan};

use dpana::scene::Scene;

use super::outputs::command_line;
use super::progress::Progress;
use super::scene_file::read_scene;

#[derive(Args)]
pub(crate) struct Study {
    /// Scene in JSON (`-`: from standard input), or an Abaqus or CalculiX deck (`.inp`), without load
    /// steps.
    scene: PathBuf,
    /// Write page, tables and figures into this folder, which is made if it is not there:
    /// `index.html`, `study.json`, `meshes.csv`, `loops.csv` and the figures in SVG.
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    /// Number of meshes, each with twice the cells per edge of the one before.
    #[arg(long, value_name = "N", conflicts_with_all = ["refine", "meshes"])]
    levels: Option<u32>,
    /// Meshes by their cells per edge, relative to the scene's: `1,1.5,2,3`.
    #[arg(long, value_name = "FACTORS", conflicts_with = "meshes")]
    refine: Option<String>,
    /// Mesh files in place of the scene's one, from coarse to fine: `a.msh,b.msh`.
    #[arg(long, value_name = "FILES", value_delimiter = ',')]
    meshes: Vec<PathBuf>,
    /// Coefficients of friction, for all contacts: `0.1:5:8` (from, to, how many; evenly in the
    /// logarithm) or `0.1,0.5`. `none` for the scene's own only.
    #[arg(long, value_name = "VALUES")]
    friction: Option<String>,
    /// Tolerances of the outer loop, from loose to tight: `1e-4,1e-8,1e-12`.
    #[arg(long, value_name = "VALUES")]
    tolerances: Option<String>,
    /// A total that is known, by its column in the table of `dpana solve --table`:
    /// `friction_x=-1.40536e6`. May be given again.
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    known: Vec<String>,
    /// Compare loops on the finest mesh with at most so many contact unknowns.
    #[arg(long, value_name = "N")]
    loop_unknowns: Option<usize>,
    /// Compare with half-spaces in place of the bodies, and do nothing else: a row per contact in
    /// `half_space.csv` of the folder.
    #[arg(long)]
    half_space: bool,
    /// Two meshes, two tolerances, two coefficients, nothing repeated.
    #[arg(long)]
    quick: bool,
}

pub(crate) fn study(arguments: &Study) -> Result<ExitCode, Box<dyn Error>> {
    let plan = plan(arguments)?;
    let scene = read_scene(&arguments.scene)?;
    check_refinable(arguments, &scene)?;
    fs::create_dir_all(&arguments.out)
        .map_err(|error| format!("--out {}: {error}", arguments.out.display()))?;
    if arguments.half_space {
        return beside_half_spaces(&scene, &arguments.out);
    }
    let progress = Progress::new(false);
    let study = dpana::study(&scene, &plan, |part| progress.show(&words(part)))?;
    drop(progress);
    let write = |name: &str, text: &str| replace_file(&arguments.out.join(name), text);
    write("study.json", &study.to_json())?;
    write("meshes.csv", &study.mesh_table().to_csv())?;
    write("loops.csv", &study.run_table().to_csv())?;
    for (name, figure) in study.figures() {
        write(&format!("{name}.svg"), &figure.to_svg())?;
    }
    write("index.html", &study.page(&command_line()))?;
    let mut out = io::stdout().lock();
    for sentence in study.sentences() {
        writeln!(out, "{sentence}")?;
    }
    writeln!(out, "{}", arguments.out.join("index.html").display())?;
    let certified =
        |mesh: &dpana::report::StudiedMesh| mesh.status == dpana::report::ReportedStatus::Certified;
    Ok(match study.meshes.iter().all(certified) {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(1),
    })
}

fn beside_half_spaces(scene: &Scene, folder: &Path) -> Result<ExitCode, Box<dyn Error>> {
    let fit = study::half_space_fit(scene)?;
    replace_file(&folder.join("half_space.csv"), &fit.contacts.to_csv())?;
    writeln!(io::stdout(), "{}", fit.sentence())?;
    Ok(match fit.certified() {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(1),
    })
}

/// Refuses other numbers of cells for a mesh that is not generated.
fn check_refinable(arguments: &Study, scene: &Scene) -> Result<(), String> {
    let asked = [
        arguments.levels.map(|levels| format!("--levels {levels}")),
        arguments
            .refine
            .as_ref()
            .map(|refine| format!("--refine {refine}")),
    ];
    match asked.into_iter().flatten().next() {
        Some(asked) if scene.refined(1.0).is_none() => Err(format!(
            "{asked}: a mesh of the scene comes from a file, whose cells cannot be counted anew; expected \
             `--meshes coarse.msh,fine.msh`"
        )),
        _ => Ok(()),
    }
}

fn plan(arguments: &Study) -> Result<Plan, String> {
    let mut plan = if arguments.quick {
        Plan::quick()
    } else {
        Plan::default()
    };
    if let Some(levels) = arguments.levels {
        if !(1..=10).contains(&levels) {
            return Err(format!("--levels {levels}: not accepted; expected 1 to 10"));
        }
        plan.refine = (0..levels).map(|level| f64::from(1_u32 << level)).collect();
    }
    if let Some(text) = &arguments.refine {
        plan.refine = numbers("--refine", text)?;
    }
    if let Some(text) = &arguments.tolerances {
        plan.tolerances = numbers("--tolerances", text)?;
    }
    match arguments.friction.as_deref() {
        None => {}
        Some("none") => plan.friction.clear(),
        Some(text) => plan.friction = frictions(text)?,
    }
    for text in &arguments.known {
        let refuse = || format!("--known {text}: not understood; expected NAME=VALUE");
        let (name, value) = text.split_once('=').ok_or_else(refuse)?;
        let value = value.trim().parse().map_err(|_| refuse())?;
        plan.known.push((name.trim().to_owned(), value));
    }
    if let Some(most) = arguments.loop_unknowns {
        plan.loop_unknowns = most;
    }
    plan.meshes.clone_from(&arguments.meshes);
    plan.validate().map_err(|error| error.to_string())?;
    Ok(plan)
}

fn numbers(option: &str, text: &str) -> Result<Vec<f64>, String> {
    let number = |word: &str| {
        word.trim()
            .parse()
            .map_err(|_| format!("{option} {text}: `{word}` is no number; expected 1,2,4"))
    };
    text.split(',').map(number).collect()
}

/// Reads `from:to:count`, evenly in the logarithm, or values.
fn frictions(text: &str) -> Result<Vec<f64>, String> {
    let parts: Vec<&str> = text.split(':').collect();
    let [from, to, count] = parts[..] else {
        return numbers("--friction", text);
    };
    let refuse = || {
        format!(
            "--friction {text}: not understood; expected FROM:TO:COUNT, both positive, COUNT 2 to 100"
        )
    };
    let number = |word: &str| word.trim().parse::<f64>().map_err(|_| refuse());
    let (from, to) = (number(from)?, number(to)?);
    let count: u32 = count.trim().parse().map_err(|_| refuse())?;
    if !(from > 0.0 && to > 0.0 && from.is_finite() && to.is_finite() && (2..=100).contains(&count))
    {
        return Err(refuse());
    }
    let at = |k: u32| from * (to / from).powf(f64::from(k) / f64::from(count - 1));
    // Three digits are as good to study, and better to read.
    let rounded = |value: f64| format!("{value:.2e}").parse().unwrap_or(value);
    Ok((0..count).map(|k| rounded(at(k))).collect())
}

/// A bar, how many parts are done, and the next one.
fn words(part: study::Progress<'_>) -> String {
    let (done, of) = (part.done, part.of);
    let filled = (20 * done).checked_div(of).unwrap_or(0);
    let bar: String = (0..20)
        .map(|k| if k < filled { '█' } else { '·' })
        .collect();
    format!("{bar} {done}/{of} {}", part.doing)
}
