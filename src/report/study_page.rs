//! A study as one page of HTML that needs nothing else: what is seen, figures, tables.

use std::fmt::Write;

use super::svg::escaped;
use super::{Part, ReportedStatus, StudiedRun, Study};

pub(super) const STYLE: &str = "body{font:16px/1.5 sans-serif;color:#222;background:#fff;max-width:960px;\
margin:2em auto;padding:0 1em}h1{font-size:1.5em}h2{font-size:1.2em;margin-top:2em}\
svg{max-width:100%;height:auto}figure{margin:1.5em 0}figcaption{color:#555;font-size:.9em}\
div.wide{overflow-x:auto}table{border-collapse:collapse;font-size:13px;white-space:nowrap}\
th,td{padding:.25em .6em;border-bottom:1px solid #ddd;text-align:right}\
th:first-child,td:first-child{text-align:left}tr.bad td{color:#a33}";

impl Study {
    /// The page; `command` is what made it.
    #[must_use]
    pub fn page(&self, command: &str) -> String {
        let title = match self.title.as_str() {
            "" => "A contact study",
            title => title,
        };
        let title = escaped(title);
        let mut page = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n\
             <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n\
             <p>Made by <code>{}</code>; units: {}.</p>\n<h2>What is seen</h2>\n<ul>\n",
            escaped(command),
            if self.units.is_empty() {
                "those of the scene".to_owned()
            } else {
                escaped(&self.units)
            }
        );
        for sentence in self.sentences() {
            let _ = writeln!(page, "<li>{}</li>", escaped(&sentence));
        }
        page += "</ul>\n";
        for (name, figure) in self.figures() {
            let caption = escaped(caption(name));
            let svg = figure.to_svg();
            let _ = writeln!(
                page,
                "<figure>\n{svg}<figcaption>{caption}</figcaption>\n</figure>"
            );
        }
        self.mesh_rows(&mut page);
        self.run_rows(&mut page);
        self.penalty_rows(&mut page);
        needs(&mut page);
        page + "</body>\n</html>\n"
    }

    fn mesh_rows(&self, page: &mut String) {
        let known = self.meshes.first().map_or(&[][..], |mesh| &mesh.known);
        let mut heads: Vec<String> = [
            "mesh",
            "unknowns",
            "contacts",
            "status",
            "sweeps",
            "Newton",
            "residual",
            "ordering s",
            "factorisation s",
            "condensation s",
            "sweeps s",
            "finish s",
            "total s",
            "oscillation",
            "estimated error",
            "error to finest",
            "effectivity",
        ]
        .map(str::to_owned)
        .to_vec();
        heads.extend(known.iter().map(|known| format!("{} off by", known.name)));
        let rows = self.meshes.iter().map(|mesh| {
            let spent = &mesh.seconds;
            let mut row = vec![
                mesh.name.clone(),
                mesh.unknowns.to_string(),
                mesh.size.contacts.to_string(),
                words(mesh.status).to_owned(),
                mesh.sweeps.to_string(),
                mesh.newton_steps.to_string(),
                size(mesh.certificate.natural_map),
            ];
            row.extend([spent.ordering, spent.factorisation, spent.condensation].map(seconds));
            row.extend([spent.sweeps, spent.finish, spent.total].map(seconds));
            let quality = &mesh.quality;
            row.extend(
                [
                    quality.oscillation,
                    quality.stress_error_estimate,
                    mesh.error,
                ]
                .map(|part| part.map_or_else(|| "–".to_owned(), size)),
            );
            row.push(
                mesh.effectivity
                    .map_or_else(|| "–".to_owned(), |e| format!("{e:.2}")),
            );
            row.extend(mesh.known.iter().map(|known| size(known.error)));
            (mesh.status != ReportedStatus::Certified, row)
        });
        table(page, "The default loop, mesh by mesh", &heads, rows);
    }

    fn penalty_rows(&self, page: &mut String) {
        let heads = [
            "friction force within",
            "springs over the contacts' stiffness",
            "steps, whole bodies",
            "seconds",
            "springs, condensed",
            "seconds with the condensation",
        ];
        let rows: Vec<_> = self
            .penalties()
            .into_iter()
            .map(|(within, found)| {
                let mut row = vec![format!("{} %", 100.0 * within)];
                for (at, run) in found.into_iter().enumerate() {
                    let of = |words: &dyn Fn(&StudiedRun) -> String| {
                        run.map_or_else(|| "–".to_owned(), words)
                    };
                    row.push(of(&|run| run.parameter.map_or_else(String::new, size)));
                    if at == 0 {
                        row.push(of(&|run| run.newton_steps.to_string()));
                    }
                    row.push(of(&|run| seconds(self.whole_seconds(run))));
                }
                (found_none(&row), row)
            })
            .collect();
        if !rows.is_empty() {
            let title = "What a penalty takes";
            table(page, title, &heads.map(str::to_owned), rows.into_iter());
        }
    }

    fn run_rows(&self, page: &mut String) {
        let heads = [
            "loop",
            "contacts",
            "friction",
            "tolerance",
            "status",
            "sweeps",
            "passes",
            "Newton",
            "residual",
            "energy gap",
            "distance",
            "seconds",
        ]
        .map(str::to_owned);
        let rows = self.runs.iter().map(|run| {
            let friction = run
                .friction
                .map_or_else(|| "scene's".to_owned(), |mu| mu.to_string());
            let row = vec![
                run.name.to_owned(),
                run.contacts.to_string(),
                friction,
                format!("{:.0e}", run.tolerance),
                words(run.status).to_owned(),
                run.sweeps.to_string(),
                run.passes.to_string(),
                run.newton_steps.to_string(),
                size(run.natural_map),
                size(run.energy_gap),
                size(run.distance),
                seconds(run.seconds),
            ];
            (run.status != ReportedStatus::Certified, row)
        });
        table(page, "Loops on the condensed problem", &heads, rows);
    }

    /// What a person would say after a look at the figures.
    #[must_use]
    pub fn sentences(&self) -> Vec<String> {
        let mut said = Vec::new();
        let certified = self
            .meshes
            .iter()
            .filter(|mesh| mesh.status == ReportedStatus::Certified)
            .count();
        let most = |count: fn(&super::StudiedMesh) -> usize| self.meshes.iter().map(count).max();
        if let (Some(sweeps), Some(steps)) = (most(|m| m.sweeps), most(|m| m.newton_steps)) {
            said.push(format!(
                "The default loop is certified on {certified} of {} meshes, with at most {} and {}.",
                self.meshes.len(),
                counted(sweeps, "sweep"),
                counted(steps, "Newton step")
            ));
        }
        if !self.exponents.is_empty() {
            let fitted = self.exponents.iter();
            let fitted: Vec<String> = fitted
                .map(|fitted| format!("{} {:.2}", fitted.stage, fitted.power))
                .collect();
            said.push(format!(
                "Time grows with the unknowns to the power: {}.",
                fitted.join(", ")
            ));
        }
        let mut effectivities: Vec<f64> = self
            .meshes
            .iter()
            .filter_map(|mesh| mesh.effectivity)
            .collect();
        // One halving away the finest mesh is itself too wrong to be held against.
        effectivities.pop();
        if let (Some(least), Some(largest)) = (
            effectivities.iter().copied().reduce(f64::min),
            effectivities.iter().copied().reduce(f64::max),
        ) {
            said.push(format!(
                "The estimated error of the stress is {least:.2} to {largest:.2} times the \
                 difference to the finest mesh."
            ));
        }
        said.extend(self.duels());
        said.extend(self.prices());
        for name in Self::loops(self.runs.iter()) {
            for status in [
                ReportedStatus::NotConverged,
                ReportedStatus::NoEquilibrium,
                ReportedStatus::CouplingFault,
            ] {
                let lost = self
                    .of_part(Part::Friction)
                    .filter(|run| run.name == name && run.status == status);
                let lost = lost.filter_map(|run| run.friction);
                let lost: Vec<String> = lost.map(|mu| mu.to_string()).collect();
                if !lost.is_empty() {
                    said.push(format!(
                        "{name}: {} at μ = {}.",
                        words(status),
                        lost.join(", ")
                    ));
                }
            }
        }
        said
    }

    /// What a penalty costs, error by error, beside the default.
    fn prices(&self) -> Vec<String> {
        let defaults = self
            .of_part(Part::Loops)
            .filter(|run| run.name == "default");
        let ours = defaults.last().map(|run| self.whole_seconds(run));
        let priced = self.penalties().into_iter().map(|(within, [whole, condensed])| {
            let price = |run: Option<&StudiedRun>, how: &str| match run {
                None => format!("none of them {how}"),
                Some(run) => format!(
                    "springs of {} times the contacts' stiffness, {} and {} s {how}",
                    run.parameter.map_or_else(String::new, size),
                    counted(run.newton_steps, "step"),
                    seconds(self.whole_seconds(run)),
                ),
            };
            format!(
                "A penalty has {} % of the friction force with {}, and with {}; the default has all its digits in {} s.",
                100.0 * within,
                price(whole, "on whole bodies"),
                price(condensed, "on the condensed problem"),
                ours.map_or_else(|| "–".to_owned(), seconds),
            )
        });
        priced.collect()
    }

    /// The default against Gauss–Seidel, tolerance by tolerance.
    fn duels(&self) -> Vec<String> {
        let mut said = Vec::new();
        let runs = |name: &'static str| {
            self.of_part(Part::Meshes)
                .filter(move |run| run.name == name)
        };
        for baseline in runs("NSGS") {
            let like = |run: &&StudiedRun| {
                (run.mesh, run.tolerance) == (baseline.mesh, baseline.tolerance)
            };
            let Some(default) = runs("default").find(like) else {
                continue;
            };
            let (contacts, passes) = (baseline.contacts, baseline.passes);
            let to = format!("{contacts} contacts to {:.0e}", baseline.tolerance);
            let (slow, fast) = (baseline.seconds, default.seconds);
            said.push(match (baseline.status == ReportedStatus::Certified, slow < fast) {
                (false, _) => format!(
                    "{to}: Gauss–Seidel gave up after {passes} passes and {} s with a residual of \
                     {}; the default loop took {} s.",
                    seconds(slow),
                    size(baseline.natural_map),
                    seconds(fast)
                ),
                (true, true) => format!(
                    "{to}: Gauss–Seidel wins, {} s in {passes} passes against {} s.",
                    seconds(slow),
                    seconds(fast)
                ),
                (true, false) => format!(
                    "{to}: the default loop wins, {} s against {} s in {passes} passes.",
                    seconds(fast),
                    seconds(slow)
                ),
            });
        }
        said
    }
}

/// What each kind of loop asks of its user, and what it costs where bodies are not condensed.
const NEEDS: [[&str; 3]; 8] = [
    [
        "default, sweeps, full cone",
        "nothing",
        "one factorisation per body",
    ],
    [
        "relaxed sweeps",
        "a part of the way",
        "one factorisation per body",
    ],
    [
        "penalty",
        "the stiffness of its springs, which is the error",
        "a factorisation of the bodies in every Newton step",
    ],
    [
        "augmented Lagrangian",
        "the stiffness of its springs, which is the rate; when to stop each of two loops",
        "a factorisation of the bodies in every Newton step",
    ],
    [
        "Newton from rest",
        "a start that is near enough; load steps where it is not",
        "a factorisation of the bodies in every Newton step",
    ],
    [
        "active set, whole bodies",
        "the same; and a solver of unsymmetric systems",
        "that is what it is: a factorisation in every step",
    ],
    [
        "primal alternation",
        "friction that is low enough, as the plain sweeps",
        "a factorisation per active set of a half-step",
    ],
    [
        "NSGS",
        "patience, and friction that is low enough",
        "one factorisation per body",
    ],
];

fn needs(page: &mut String) {
    let heads = [
        "loop",
        "what it needs from the user",
        "without condensation",
    ];
    let rows = NEEDS
        .iter()
        .map(|row| (false, row.map(str::to_owned).to_vec()));
    table(page, "What each needs", &heads.map(str::to_owned), rows);
}

fn caption(figure: &str) -> &'static str {
    match figure {
        "mesh_error" => {
            "Every point is a mesh. The difference to the finest mesh is in the energy norm of all \
             bodies; the estimate knows nothing of that mesh."
        }
        "time_unknowns" => {
            "The stages of a whole solve; n^p by least squares over the finest meshes."
        }
        "time_contacts" => {
            "The default loop and projected block Gauss–Seidel (NSGS) on the same condensed \
             problems; the condensation counts on neither side."
        }
        "rivals" => {
            "Every point is a tolerance; springs of a penalty are as stiff as its inverse root. Loops on the condensed problem \
             stand with the ordering, factorisation and condensation that come before; those of whole bodies factorise in every step."
        }
        "time_error" => {
            "Every point is a tolerance. t* is the solution of the same condensed problem, so that \
             the mesh's own error is not in it."
        }
        "residual_time" => "The judge's residual after every sweep, to the tightest tolerance.",
        "sweeps_friction" => "Every point is a solve; Gauss–Seidel counts passes.",
        _ => "",
    }
}

/// A table below its title, if it has one; rows that are bad stand out.
pub(super) fn table(
    page: &mut String,
    title: &str,
    heads: &[String],
    rows: impl Iterator<Item = (bool, Vec<String>)>,
) {
    let cells = |tag: &str, cells: &[String]| {
        let cells = cells
            .iter()
            .map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell)));
        cells.collect::<String>()
    };
    if !title.is_empty() {
        let _ = writeln!(page, "<h2>{title}</h2>");
    }
    let _ = writeln!(
        page,
        "<div class=\"wide\"><table>\n<tr>{}</tr>",
        cells("th", heads)
    );
    for (bad, row) in rows {
        let class = if bad { " class=\"bad\"" } else { "" };
        let _ = writeln!(page, "<tr{class}>{}</tr>", cells("td", &row));
    }
    *page += "</table></div>\n";
}

fn found_none(row: &[String]) -> bool {
    row.iter().any(|cell| cell == "–")
}

fn words(status: ReportedStatus) -> &'static str {
    match status {
        ReportedStatus::Certified => "certified",
        ReportedStatus::NotConverged => "gave up",
        ReportedStatus::NoEquilibrium => "no equilibrium",
        ReportedStatus::CouplingFault => "coupling fault",
    }
}

fn counted(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        count => format!("{count} {what}s"),
    }
}

fn size(value: f64) -> String {
    if value.is_finite() {
        format!("{value:.1e}")
    } else {
        "–".to_owned()
    }
}

fn seconds(spent: f64) -> String {
    match spent {
        s if s >= 10.0 => format!("{s:.1}"),
        s if s >= 0.1 => format!("{s:.2}"),
        s if s >= 1e-3 => format!("{s:.4}"),
        s => format!("{s:.1e}"),
    }
}
