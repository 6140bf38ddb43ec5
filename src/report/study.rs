//! A study as it is reported: meshes, loops, exponents.

use serde::Serialize;

use super::{Cell, Quality, ReportedCertificate, ReportedSeconds, ReportedStatus, Size, Table};

/// A scene over meshes, tolerances, friction and loops.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Study {
    /// Title of the scene.
    pub title: String,
    /// The scene's label of units; empty where it names none.
    pub units: String,
    /// The default loop, mesh by mesh from coarse to fine.
    pub meshes: Vec<StudiedMesh>,
    /// How the time of a stage grows with the unknowns.
    pub exponents: Vec<Exponent>,
    /// Loops on one mesh each.
    pub runs: Vec<StudiedRun>,
}

/// The scene on one mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StudiedMesh {
    /// Which mesh.
    pub name: String,
    /// Unknowns of the bodies, contact unknowns included, without those that supports hold.
    pub unknowns: usize,
    /// Stored entries of the factors.
    pub factor_entries: usize,
    /// Nodes, cells, contacts.
    pub size: Size,
    /// How the default loop ended.
    pub status: ReportedStatus,
    /// Every law, measured.
    pub certificate: ReportedCertificate,
    /// Sweeps of the default loop.
    pub sweeps: usize,
    /// Its Newton steps.
    pub newton_steps: usize,
    /// Its interior-point iterations.
    pub cone_iterations: usize,
    /// Wall time, the median of several solves where one is short.
    pub seconds: StageSeconds,
    /// Oscillation of the pressure, estimated error of the stress.
    pub quality: Quality,
    /// Difference to the displacement on the finest mesh, relative in the energy norm; `null` on
    /// the finest, where the nodes of a mesh are no product of lines, and where a body is nearly
    /// incompressible.
    pub error: Option<f64>,
    /// The estimated error over that difference.
    pub effectivity: Option<f64>,
    /// Totals that are known.
    pub known: Vec<KnownTotal>,
}

/// A total whose value is known.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KnownTotal {
    /// Column of a [`Table`].
    pub name: String,
    /// Value found.
    pub computed: f64,
    /// Known value.
    pub exact: f64,
    /// `|computed/exact − 1|`.
    pub error: f64,
}

/// Wall time of a whole solve by stage, in second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct StageSeconds {
    /// Stiffness and loads.
    pub assembly: f64,
    /// Fill-reducing ordering.
    pub ordering: f64,
    /// Factorisation.
    pub factorisation: f64,
    /// Condensed operator and free displacement.
    pub condensation: f64,
    /// Prediction, cone programs and judge.
    pub sweeps: f64,
    /// Newton finish, the contact stiffness included.
    pub finish: f64,
    /// Recovery of the whole displacement.
    pub recovery: f64,
    /// Sum of the stages above.
    pub total: f64,
    /// The error estimate of the stress, which is in no total.
    pub estimate: f64,
}

/// What a run is held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// The default and the baseline, mesh by mesh.
    Meshes,
    /// All loops on one mesh, tolerance by tolerance.
    Loops,
    /// Rivals on that mesh, tolerance by tolerance.
    Rivals,
    /// Penalties on that mesh, spring by spring.
    Penalties,
    /// All loops on that mesh, friction by friction.
    Friction,
}

/// One loop on one mesh to one tolerance.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct StudiedRun {
    /// What it is held against.
    pub part: Part,
    /// Mesh, as an index into the study's meshes.
    pub mesh: usize,
    /// Name of the loop.
    pub name: &'static str,
    /// Coefficient of friction of all contacts; `null` for that of the scene.
    pub friction: Option<f64>,
    /// Natural-map residual at which it may stop.
    pub tolerance: f64,
    /// Springs over the contacts' own stiffness 1/G_kk; `null` where they follow the tolerance, or are none.
    pub parameter: Option<f64>,
    /// It factorises whole bodies in every step: its seconds are all there are, while those of others follow a condensation.
    pub whole: bool,
    /// How it ended.
    pub status: ReportedStatus,
    /// The judge's natural-map residual.
    pub natural_map: f64,
    /// √(η / ½ t·G t) of the judge's bipotential gap.
    pub energy_gap: f64,
    /// `‖t − t*‖_G / ‖t*‖_G` to the solution of the same problem.
    pub distance: f64,
    /// How far the resultant of friction is off that solution's, relative to it; not a number without friction, and
    /// mesh by mesh.
    pub friction_error: f64,
    /// Contacts.
    pub contacts: usize,
    /// Sweeps; 0 for Gauss–Seidel.
    pub sweeps: usize,
    /// Gauss–Seidel passes.
    pub passes: usize,
    /// Newton steps.
    pub newton_steps: usize,
    /// Interior-point iterations.
    pub cone_iterations: usize,
    /// Wall time of the loop on the condensed problem, or on whole bodies, in second; the median where it is short.
    pub seconds: f64,
    /// Seconds since the start and natural-map residual, where the judge was asked.
    pub course: Vec<[f64; 2]>,
}

/// `seconds = factor · unknowns^power`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Exponent {
    /// Stage.
    pub stage: &'static str,
    /// Power of the unknowns.
    pub power: f64,
    /// Factor, in second.
    pub factor: f64,
    /// Meshes that the fit looked at.
    pub meshes: usize,
}

/// Errors of the friction force that penalties are asked for.
const WITHIN: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// Shorter stages, in second, say more of the clock than of the stage.
const MEASURABLE: f64 = 1e-4;

/// Meshes with at least this part of the finest one's unknowns are fitted.
const FITTED: f64 = 1.0 / 30.0;

impl Study {
    /// Joins the parts and fits the exponents.
    #[must_use]
    pub fn new(title: &str, units: &str, meshes: Vec<StudiedMesh>, runs: Vec<StudiedRun>) -> Self {
        let stages = StageSeconds::default().by_name().len();
        let fits = (0..stages).filter_map(|stage| exponent(&meshes, stage));
        Self {
            title: title.to_owned(),
            units: units.to_owned(),
            exponents: fits.collect(),
            meshes,
            runs,
        }
    }

    /// The study as indented JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Plain structs with string keys: there is nothing that could fail to serialise.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// A row per mesh.
    #[must_use]
    pub fn mesh_table(&self) -> Table {
        let mut table = Table::default();
        for mesh in &self.meshes {
            let (count, number) = (Cell::Count, Cell::Number);
            let optional = |value: Option<f64>| number(value.unwrap_or(f64::NAN));
            let mut row = vec![
                ("unknowns".to_owned(), count(mesh.unknowns)),
                ("contacts".to_owned(), count(mesh.size.contacts)),
                ("status".to_owned(), Cell::Word(mesh.status.word().into())),
                (
                    "natural_map".to_owned(),
                    number(mesh.certificate.natural_map),
                ),
                ("sweeps".to_owned(), count(mesh.sweeps)),
                ("newton_steps".to_owned(), count(mesh.newton_steps)),
                ("cone_iterations".to_owned(), count(mesh.cone_iterations)),
                ("oscillation".to_owned(), optional(mesh.quality.oscillation)),
                (
                    "stress_error_estimate".to_owned(),
                    optional(mesh.quality.stress_error_estimate),
                ),
                ("error_to_finest".to_owned(), optional(mesh.error)),
                ("effectivity".to_owned(), optional(mesh.effectivity)),
            ];
            let stages = mesh.seconds.by_name().into_iter();
            row.extend(stages.map(|(name, spent)| (format!("{name}_s"), number(spent))));
            row.push(("estimate_s".to_owned(), number(mesh.seconds.estimate)));
            for known in &mesh.known {
                row.push((known.name.clone(), number(known.computed)));
                row.push((format!("{}_error", known.name), number(known.error)));
            }
            table.add(row);
        }
        table
    }

    /// A row per run of a loop.
    #[must_use]
    pub fn run_table(&self) -> Table {
        let mut table = Table::default();
        for run in &self.runs {
            let (count, number) = (Cell::Count, Cell::Number);
            table.add(vec![
                ("part".to_owned(), Cell::Word(run.part.word().into())),
                ("loop".to_owned(), Cell::Word(run.name.into())),
                ("mesh".to_owned(), count(run.mesh)),
                ("contacts".to_owned(), count(run.contacts)),
                (
                    "friction".to_owned(),
                    number(run.friction.unwrap_or(f64::NAN)),
                ),
                ("tolerance".to_owned(), number(run.tolerance)),
                (
                    "parameter".to_owned(),
                    number(run.parameter.unwrap_or(f64::NAN)),
                ),
                ("status".to_owned(), Cell::Word(run.status.word().into())),
                ("natural_map".to_owned(), number(run.natural_map)),
                ("energy_gap".to_owned(), number(run.energy_gap)),
                ("distance".to_owned(), number(run.distance)),
                ("friction_error".to_owned(), number(run.friction_error)),
                ("sweeps".to_owned(), count(run.sweeps)),
                ("passes".to_owned(), count(run.passes)),
                ("newton_steps".to_owned(), count(run.newton_steps)),
                ("cone_iterations".to_owned(), count(run.cone_iterations)),
                ("seconds".to_owned(), number(run.seconds)),
                ("whole_seconds".to_owned(), number(self.whole_seconds(run))),
            ]);
        }
        table
    }

    /// Wall time from the assembled stiffness on, in second: of a loop on the condensed problem with the ordering, factorisation
    /// and condensation of its mesh.
    #[must_use]
    pub fn whole_seconds(&self, run: &StudiedRun) -> f64 {
        let spent = self.meshes[run.mesh].seconds;
        match run.whole {
            true => run.seconds,
            false => run.seconds + spent.ordering + spent.factorisation + spent.condensation,
        }
    }

    /// Per error of the friction force: the softest springs from which on a penalty on whole bodies and one on the condensed
    /// problem are within it.
    pub(super) fn penalties(&self) -> Vec<(f64, [Option<&StudiedRun>; 2])> {
        let found = |name: &str, within: f64| {
            let tried: Vec<_> = self
                .of_part(Part::Penalties)
                .filter(|run| run.name == name)
                .collect();
            let enough = tried.iter().rev();
            enough
                .take_while(|run| run.friction_error <= within)
                .last()
                .copied()
        };
        let tried = self.of_part(Part::Penalties).next().is_some();
        let levels = WITHIN.iter().filter(|_| tried);
        let row = |&within: &f64| {
            let names = ["penalty, whole bodies", "penalty"];
            (within, names.map(|name| found(name, within)))
        };
        levels.map(row).collect()
    }
}

impl Part {
    /// As JSON and tables spell it.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Meshes => "meshes",
            Self::Loops => "loops",
            Self::Rivals => "rivals",
            Self::Penalties => "penalties",
            Self::Friction => "friction",
        }
    }
}

impl StageSeconds {
    /// Of a report.
    #[must_use]
    pub fn new(seconds: &ReportedSeconds) -> Self {
        let sweeps =
            seconds.predict + seconds.coulomb + seconds.normal + seconds.friction + seconds.judge;
        Self {
            assembly: seconds.assembly,
            ordering: seconds.ordering,
            factorisation: seconds.factorisation,
            condensation: seconds.condensation,
            sweeps,
            finish: seconds.finish,
            recovery: seconds.recovery,
            total: seconds.total,
            estimate: 0.0,
        }
    }

    /// Stage by stage the median of several solves; zeros of none.
    #[must_use]
    pub fn median(all: &[Self]) -> Self {
        let of = |stage: fn(&Self) -> f64| {
            let mut seconds: Vec<f64> = all.iter().map(stage).collect();
            seconds.sort_by(f64::total_cmp);
            seconds.get(seconds.len() / 2).copied().unwrap_or(0.0)
        };
        Self {
            assembly: of(|s| s.assembly),
            ordering: of(|s| s.ordering),
            factorisation: of(|s| s.factorisation),
            condensation: of(|s| s.condensation),
            sweeps: of(|s| s.sweeps),
            finish: of(|s| s.finish),
            recovery: of(|s| s.recovery),
            total: of(|s| s.total),
            estimate: of(|s| s.estimate),
        }
    }

    /// The stages in the order of the pipeline, and their sum.
    pub(super) fn by_name(&self) -> [(&'static str, f64); 8] {
        [
            ("assembly", self.assembly),
            ("ordering", self.ordering),
            ("factorisation", self.factorisation),
            ("condensation", self.condensation),
            ("sweeps", self.sweeps),
            ("finish", self.finish),
            ("recovery", self.recovery),
            ("total", self.total),
        ]
    }
}

/// Least squares of ln seconds over ln unknowns; none for fewer than two measurable meshes.
fn exponent(meshes: &[StudiedMesh], stage: usize) -> Option<Exponent> {
    let name = StageSeconds::default().by_name()[stage].0;
    let most = meshes.iter().map(|mesh| mesh.unknowns).max()? as f64;
    let points = meshes.iter().filter_map(|mesh| {
        let (unknowns, seconds) = (mesh.unknowns as f64, mesh.seconds.by_name()[stage].1);
        let counts = seconds >= MEASURABLE && unknowns >= FITTED * most;
        counts.then(|| [unknowns.ln(), seconds.ln()])
    });
    let points: Vec<[f64; 2]> = points.collect();
    let mean = |axis: usize| points.iter().map(|p| p[axis]).sum::<f64>() / points.len() as f64;
    let [x, y] = [mean(0), mean(1)];
    let rise: f64 = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    let run: f64 = points.iter().map(|p| (p[0] - x).powi(2)).sum();
    let power = rise / run;
    power.is_finite().then(|| Exponent {
        stage: name,
        power,
        factor: (y - power * x).exp(),
        meshes: points.len(),
    })
}
