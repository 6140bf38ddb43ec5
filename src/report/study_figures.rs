//! The figures of a study.

use super::figure::{Axis, Curve, Figure, Point};
use super::{Part, ReportedStatus, StudiedMesh, StudiedRun, Study};

/// An error of nothing is drawn as round-off, for there is no zero on a logarithmic axis.
const EXACT: f64 = f64::EPSILON;

impl Study {
    /// The figures that the study has points for, each with a short name for its file.
    #[must_use]
    pub fn figures(&self) -> Vec<(&'static str, Figure)> {
        let all = [
            ("mesh_error", self.mesh_error()),
            ("time_unknowns", self.time_unknowns()),
            ("time_contacts", self.time_contacts()),
            ("rivals", self.rivals()),
            ("time_error", self.time_error()),
            ("residual_time", self.residual_time()),
            ("sweeps_friction", self.sweeps_friction()),
        ];
        let drawn = all
            .into_iter()
            .filter(|(_, figure)| !figure.curves.is_empty());
        drawn.collect()
    }

    /// Runs of one part.
    pub(super) fn of_part(&self, part: Part) -> impl Iterator<Item = &StudiedRun> {
        self.runs.iter().filter(move |run| run.part == part)
    }

    /// Names of loops, each once, in the order of their first run.
    pub(super) fn loops<'a>(runs: impl Iterator<Item = &'a StudiedRun>) -> Vec<&'static str> {
        let mut names = Vec::new();
        for run in runs {
            if !names.contains(&run.name) {
                names.push(run.name);
            }
        }
        names
    }

    fn contacts(&self) -> String {
        let run = self.of_part(Part::Loops).next();
        run.map_or_else(String::new, |run| format!(", {} contacts", run.contacts))
    }

    fn mesh_error(&self) -> Figure {
        let curve = |name: &str, value: &dyn Fn(&StudiedMesh) -> Option<f64>| {
            let points = self.meshes.iter().filter_map(|mesh| {
                Some(Point {
                    at: [mesh.seconds.total, value(mesh)?.max(EXACT)],
                    open: mesh.status != ReportedStatus::Certified,
                })
            });
            let points: Vec<Point> = points.collect();
            (points.len() > 1).then(|| Curve {
                name: name.to_owned(),
                points,
            })
        };
        let mut curves = vec![
            curve("to the finest mesh, energy", &|mesh| mesh.error),
            curve("estimated, stress recovery", &|mesh| {
                mesh.quality.stress_error_estimate
            }),
            curve("oscillation of the pressure", &|mesh| {
                mesh.quality.oscillation
            }),
        ];
        let known = self.meshes.first().map_or(0, |mesh| mesh.known.len());
        for at in 0..known {
            let name = format!("{}, known value", self.meshes[0].known[at].name);
            curves.push(curve(&name, &|mesh| mesh.known.get(at).map(|k| k.error)));
        }
        Figure {
            title: "Time against error, mesh by mesh".to_owned(),
            across: decades("seconds of the whole solve"),
            up: decades("relative error"),
            curves: curves.into_iter().flatten().collect(),
            open: "not certified",
        }
    }

    fn time_unknowns(&self) -> Figure {
        let stages = self.meshes.first().map(|mesh| mesh.seconds.by_name());
        let stages = stages.iter().flatten().filter(|_| self.meshes.len() > 1);
        let curve = |(at, (name, _)): (usize, &(&'static str, f64))| {
            let fitted = self.exponents.iter().find(|fitted| fitted.stage == *name);
            let power = fitted.map_or_else(String::new, |f| format!(" ~ n^{:.2}", f.power));
            let points = self.meshes.iter().map(|mesh| Point {
                at: [mesh.unknowns as f64, mesh.seconds.by_name()[at].1],
                open: false,
            });
            Curve {
                name: format!("{name}{power}"),
                points: points.collect(),
            }
        };
        Figure {
            title: "Time against unknowns, stage by stage".to_owned(),
            across: decades("unknowns n"),
            up: decades("seconds"),
            curves: stages.enumerate().map(curve).collect(),
            open: "",
        }
    }

    fn time_contacts(&self) -> Figure {
        let mut curves: Vec<Curve> = Vec::new();
        for run in self.of_part(Part::Meshes) {
            let name = format!("{} to {:.0e}", run.name, run.tolerance);
            let point = Point {
                at: [run.contacts as f64, run.seconds],
                open: run.status != ReportedStatus::Certified,
            };
            match curves.iter_mut().find(|curve| curve.name == name) {
                Some(curve) => curve.points.push(point),
                None => curves.push(Curve {
                    name,
                    points: vec![point],
                }),
            }
        }
        curves.retain(|curve| curve.points.len() > 1);
        Figure {
            title: "The loop alone against Gauss–Seidel".to_owned(),
            across: decades("contacts"),
            up: decades("seconds on the condensed problem"),
            curves,
            open: "given up",
        }
    }

    fn rivals(&self) -> Figure {
        let ours = ["default", "plain sweeps", "NSGS"];
        let runs = || {
            let shown = |run: &&StudiedRun| match run.part {
                Part::Loops => ours.contains(&run.name),
                part => part == Part::Rivals,
            };
            self.runs.iter().filter(shown)
        };
        let curve = |name: &'static str| Curve {
            name: name.to_owned(),
            points: runs()
                .filter(|run| run.name == name)
                .map(|run| Point {
                    at: [self.whole_seconds(run), run.distance.max(EXACT)],
                    open: run.status != ReportedStatus::Certified,
                })
                .collect(),
        };
        Figure {
            title: format!("What a digit costs, rivals and ours{}", self.contacts()),
            across: decades("seconds from the assembled stiffness on"),
            up: decades("‖t − t*‖ / ‖t*‖, energy norm"),
            curves: Self::loops(runs()).into_iter().map(curve).collect(),
            open: "not certified",
        }
    }

    fn time_error(&self) -> Figure {
        self.by_loop(
            &format!("Time against error, loop by loop{}", self.contacts()),
            [
                "seconds on the condensed problem",
                "‖t − t*‖ / ‖t*‖, energy norm",
            ],
            |run| vec![[run.seconds, run.distance.max(EXACT)]],
        )
    }

    fn residual_time(&self) -> Figure {
        let tightest = self
            .of_part(Part::Loops)
            .map(|run| run.tolerance)
            .fold(1.0, f64::min);
        self.by_loop(
            &format!("Residual against time{}", self.contacts()),
            ["seconds on the condensed problem", "natural-map residual"],
            |run| match run.tolerance == tightest {
                true => run.course.iter().map(|[s, r]| [*s, r.max(EXACT)]).collect(),
                false => Vec::new(),
            },
        )
    }

    fn by_loop(
        &self,
        title: &str,
        labels: [&str; 2],
        points: impl Fn(&StudiedRun) -> Vec<[f64; 2]>,
    ) -> Figure {
        let curve = |name: &str| {
            let own = self.of_part(Part::Loops).filter(|run| run.name == name);
            let points = own.flat_map(|run| {
                let open = run.status != ReportedStatus::Certified;
                points(run).into_iter().map(move |at| Point { at, open })
            });
            Curve {
                name: name.to_owned(),
                points: points.collect(),
            }
        };
        let names = Self::loops(self.of_part(Part::Loops)).into_iter();
        Figure {
            title: title.to_owned(),
            across: decades(labels[0]),
            up: decades(labels[1]),
            curves: names.map(curve).collect(),
            open: "gave up",
        }
    }

    fn sweeps_friction(&self) -> Figure {
        let varied = || self.of_part(Part::Friction);
        let curve = |name: &'static str| {
            let own = varied().filter(|run| run.name == name);
            let points = own.map(|run| Point {
                at: [
                    run.friction.unwrap_or(f64::NAN),
                    if run.sweeps > 0 {
                        run.sweeps
                    } else {
                        run.passes
                    } as f64,
                ],
                open: run.status != ReportedStatus::Certified,
            });
            let unit = if name == "NSGS" { ", passes" } else { "" };
            Curve {
                name: format!("{name}{unit}"),
                points: points.collect(),
            }
        };
        Figure {
            title: format!("Sweeps against friction{}", self.contacts()),
            across: decades("coefficient of friction μ"),
            up: decades("sweeps to the tightest tolerance"),
            curves: Self::loops(varied()).into_iter().map(curve).collect(),
            open: "gave up",
        }
    }
}

fn decades(label: &str) -> Axis {
    Axis {
        label: label.to_owned(),
        logarithmic: true,
    }
}
