//! Bare condensed problems: G, û, gaps and friction as arrays.

use std::time::Duration;

use dpana::alternation::{self, Outcome, Settings, Shortfall};
use dpana::condensation::Condensed;
use dpana::contact::ContactNode;
use dpana::kkt::{ContactStatus, Worst};
use dpana::problem::{Floating, Operator};
use dpana::scene::BareProblem;
use dpana::{ContactProblem, Status};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arrays::{Numbers, Rows, column, indices, matrix, numbers, of_matrix, rows};
use super::error::{Error, refused};
use super::watched::{Flag, watched};

/// The Python file that knows problems in files.
const FILES: &str = "dpana._problem";

/// Find reactions t and displacements u = u_free + G t that satisfy the laws of Signorini and Coulomb.
///
/// Problem(G, u_free, gap, mu, tangents=None, modes=None, mode_load=None): contact i owns a block of
/// 1 + tangents[i] unknowns, normal first; blocks stand one after the other.
///
/// G: compliance, (unknowns, unknowns), symmetric positive semi-definite, in m/N.
/// u_free: displacement without contact forces, (unknowns,), in m, positive towards the other side.
/// gap: distance before loading, (contacts,), in m. mu: coefficients of friction, (contacts,).
/// tangents: 0, 1 or 2 per contact; left out, all contacts have the same.
/// modes, mode_load: R (unknowns, modes) and e (modes,) of bodies that float: u gains R a, and
/// R' t + e = 0 holds.
#[pyclass(module = "dpana", frozen)]
pub(super) struct Problem {
    problem: ContactProblem,
    /// Where it comes from, if from a scene, and the dimension of that.
    scene: Option<(Condensed, usize)>,
}

#[pymethods]
impl Problem {
    #[new]
    #[pyo3(signature = (G, u_free, gap, mu, tangents=None, modes=None, mode_load=None))]
    #[allow(
        non_snake_case,
        reason = "the paper's letter, which Python calls by name"
    )]
    fn new(
        G: Rows<'_>,
        u_free: Numbers<'_>,
        gap: Numbers<'_>,
        mu: Numbers<'_>,
        tangents: Option<Numbers<'_>>,
        modes: Option<Rows<'_>>,
        mode_load: Option<Numbers<'_>>,
    ) -> PyResult<Self> {
        let (u_free, mu) = (numbers(&u_free), numbers(&mu));
        let tangents = match tangents {
            Some(tangents) => indices("tangents", numbers(&tangents).iter())?,
            None => vec![same_tangents(u_free.len(), mu.len())?; mu.len()],
        };
        let operator = Operator::from_compliance(matrix(&G)).map_err(refused)?;
        let problem = ContactProblem::new(&tangents, mu, numbers(&gap), u_free, operator);
        let mut problem = problem.map_err(refused)?;
        if let Some(modes) = modes {
            let load = mode_load.as_ref().map(numbers).unwrap_or_default();
            let floating = Floating::new(matrix(&modes), load);
            problem = floating.and_then(|f| problem.float(f)).map_err(refused)?;
        }
        Ok(problem.into())
    }

    /// Reads the text of a problem in JSON, in the convention of rigid-body codes (Siconos, FCLIB).
    #[staticmethod]
    fn from_json(text: &str, name: &str) -> PyResult<Self> {
        let bare = BareProblem::from_json(text, name).map_err(refused)?;
        bare.to_problem().map(Self::from).map_err(refused)
    }

    /// Reads a problem: `.npz` with G, u_free, gap, mu (and tangents, modes, mode_load), or with W, q, mu
    /// in the signs of Siconos; `.json` in the format of the shipped FCLIB problems.
    #[staticmethod]
    fn load<'py>(py: Python<'py>, path: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        py.import(FILES)?.call_method1("load", (path,))
    }

    /// Writes the problem: `.npz` keeps every bit, `.json` is in the signs of Siconos with gaps in q.
    fn save(slf: &Bound<'_, Self>, path: &Bound<'_, PyAny>) -> PyResult<()> {
        let files = slf.py().import(FILES)?;
        files.call_method1("save", (slf, path)).map(drop)
    }

    /// The problem `v = W r + q` of rigid-body codes, r_N >= 0 pressed: W (d n, d n), q (d n,), mu (n,) for
    /// n contacts in d dimensions, normal first.
    #[staticmethod]
    #[pyo3(signature = (W, q, mu, dimension=None))]
    #[allow(
        non_snake_case,
        reason = "the letter of those codes, which Python calls by name"
    )]
    fn from_siconos<'py>(
        py: Python<'py>,
        W: &Bound<'py, PyAny>,
        q: &Bound<'py, PyAny>,
        mu: &Bound<'py, PyAny>,
        dimension: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        py.import(FILES)?
            .call_method1("from_siconos", (W, q, mu, dimension))
    }

    /// W, q, mu of rigid-body codes, q_N = gap - u_free_N.
    fn to_siconos<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import(FILES)?.call_method1("to_siconos", (slf,))
    }

    /// Solves the problem, without the interpreter's lock; Ctrl-C ends it.
    ///
    /// tolerance: largest natural-map residual that counts as solved, 1e-12 if left out;
    /// max_sweeps: 100 if left out; time_limit: in s; near: the result of a neighbouring problem of
    /// the same contacts to start from.
    #[pyo3(signature = (tolerance=None, max_sweeps=None, time_limit=None, near=None))]
    fn solve(
        &self,
        py: Python<'_>,
        tolerance: Option<f64>,
        max_sweeps: Option<usize>,
        time_limit: Option<f64>,
        near: Option<PyRef<'_, SolvedProblem>>,
    ) -> PyResult<SolvedProblem> {
        let default = Settings::default();
        let seconds = time_limit.map(Duration::try_from_secs_f64).transpose();
        let time_limit = seconds
            .map_err(|_| Error::new_err("time_limit is not accepted; expected seconds >= 0"))?;
        let mut settings = default
            .with_tolerance(tolerance.unwrap_or(default.tolerance))
            .with_max_sweeps(max_sweeps.unwrap_or(default.max_sweeps));
        settings.time_limit = time_limit;
        let near = near.map(|near| near.outcome.clone());
        let outcome = watched(py, &Flag::take(), |interrupt| {
            settings.interrupt = Some(interrupt);
            match &near {
                None => alternation::solve(&self.problem, &settings),
                Some(near) => alternation::solve_near(&self.problem, &settings, near),
            }
        })?;
        Ok(SolvedProblem {
            problem: self.problem.clone(),
            outcome: outcome.map_err(refused)?,
        })
    }

    /// The same problem with other coefficients of friction, (contacts,); the operator is shared.
    fn with_friction(&self, mu: Numbers<'_>) -> PyResult<Self> {
        self.with(self.problem.with_friction(numbers(&mu)))
    }

    /// The same problem with other gaps before loading, (contacts,), in m; the operator is shared.
    fn with_gap(&self, gap: Numbers<'_>) -> PyResult<Self> {
        self.with(self.problem.with_initial_gap(numbers(&gap)))
    }

    /// Number of contacts.
    #[getter]
    fn contacts(&self) -> usize {
        self.problem.contacts()
    }

    /// Number of unknowns.
    #[getter]
    fn unknowns(&self) -> usize {
        self.problem.unknowns()
    }

    /// Compliance, (unknowns, unknowns), in m/N; a copy.
    #[getter]
    #[pyo3(name = "G")]
    fn compliance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        of_matrix(py, self.problem.compliance().as_ref())
    }

    /// Displacement without contact forces, (unknowns,), in m.
    #[getter]
    fn u_free<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.problem.free_displacement())
    }

    /// Gap before loading, (contacts,), in m.
    #[getter]
    fn gap<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.problem.initial_gap())
    }

    /// Coefficients of friction, (contacts,).
    #[getter]
    fn mu<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.problem.friction())
    }

    /// Tangential unknowns per contact, (contacts,).
    #[getter]
    fn tangents<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        column(
            py,
            self.problem.blocks().map(|block| block.len() as i64 - 1),
        )
    }

    /// Displacement per free mode, (unknowns, modes); None where supports hold every body.
    #[getter]
    fn modes<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let floating = self.problem.floating();
        floating
            .map(|floating| of_matrix(py, floating.modes()))
            .transpose()
    }

    /// Work of the loads on each free mode, (modes,), in N; None where supports hold every body.
    #[getter]
    fn mode_load<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        let floating = self.problem.floating()?;
        Some(PyArray1::from_slice(py, floating.load()))
    }

    /// Where the contacts of a scene are before loading, (contacts, d), in m; None without a scene.
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let Some((nodes, axes)) = self.nodes() else {
            return Ok(None);
        };
        let positions = nodes.iter().flat_map(|node| node.position[..axes].to_vec());
        rows(py, positions, axes).map(Some)
    }

    /// Orthonormal rows per contact of a scene, (contacts, d, d): the normal towards the other side,
    /// then the tangents, of which the first `tangents[i]` are unknowns; None without a scene.
    #[getter]
    fn frames<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray3<f64>>>> {
        let Some((nodes, axes)) = self.nodes() else {
            return Ok(None);
        };
        let entries = nodes.iter().flat_map(|node| {
            let rows = node.frame[..axes].iter();
            rows.flat_map(|row| row[..axes].to_vec())
                .collect::<Vec<_>>()
        });
        let entries = column(py, entries);
        entries.reshape([nodes.len(), axes, axes]).map(Some)
    }

    /// Tributary area per contact of a scene, (contacts,), in m²; None without a scene.
    #[getter]
    fn areas<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        let (nodes, _) = self.nodes()?;
        Some(column(py, nodes.iter().map(|node| node.area)))
    }

    fn __repr__(&self) -> String {
        let (contacts, unknowns) = (self.problem.contacts(), self.problem.unknowns());
        format!("dpana.Problem({contacts} contacts, {unknowns} unknowns)")
    }
}

impl From<ContactProblem> for Problem {
    fn from(problem: ContactProblem) -> Self {
        Self {
            problem,
            scene: None,
        }
    }
}

impl Problem {
    /// That of a scene of this dimension.
    pub(super) fn of_scene(condensed: &Condensed, dimension: usize) -> Self {
        Self {
            problem: condensed.problem().clone(),
            scene: Some((condensed.clone(), dimension)),
        }
    }

    fn with(&self, problem: Result<ContactProblem, dpana::Error>) -> PyResult<Self> {
        Ok(Self {
            problem: problem.map_err(refused)?,
            scene: self.scene.clone(),
        })
    }

    /// The contacts of the scene, and its dimension.
    fn nodes(&self) -> Option<(&[ContactNode], usize)> {
        let (condensed, dimension) = self.scene.as_ref()?;
        Some((&condensed.surface().nodes, *dimension))
    }
}

/// Tangents of a contact if all have the same.
fn same_tangents(unknowns: usize, contacts: usize) -> PyResult<usize> {
    match (1..=3).find(|block| contacts * block == unknowns) {
        Some(block) => Ok(block - 1),
        None => Err(Error::new_err(format!(
            "u_free: {unknowns} entries for {contacts} coefficients of friction are not accepted; \
             expected 1, 2 or 3 per contact, or tangents"
        ))),
    }
}

/// A solved bare problem.
#[pyclass(module = "dpana", name = "ProblemResult", frozen)]
pub(super) struct SolvedProblem {
    problem: ContactProblem,
    outcome: Outcome,
}

#[pymethods]
impl SolvedProblem {
    /// `certified`, `not_converged` or `no_equilibrium`.
    #[getter]
    fn status(&self) -> &'static str {
        match self.outcome.status {
            Status::Certified => "certified",
            Status::NotConverged => "not_converged",
            Status::NoEquilibrium => "no_equilibrium",
            Status::CouplingFault => "coupling_fault",
        }
    }

    /// Whether the judge certified it.
    #[getter]
    fn certified(&self) -> bool {
        self.outcome.status == Status::Certified
    }

    /// Why the solve ended without a certificate, in a word; None with one.
    #[getter]
    fn reason(&self) -> Option<&'static str> {
        Some(match self.outcome.shortfall? {
            Shortfall::SweepLimit => "sweep_limit",
            Shortfall::Stalled { .. } => "stalled",
            Shortfall::TimeLimit => "time_limit",
            Shortfall::Interrupted => "interrupted",
            Shortfall::ConeSolver => "cone_solver",
            Shortfall::IllConditioned { .. } => "ill_conditioned",
            Shortfall::OutOfBalance { .. } => "out_of_balance",
            Shortfall::RoundOff { .. } => "round_off",
        })
    }

    /// Reaction, (unknowns,), in N; normal ones are <= 0 where pressed.
    #[getter]
    fn reaction<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.outcome.reaction)
    }

    /// Displacement, (unknowns,), in m.
    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.outcome.verdict.displacement)
    }

    /// Rigid motion per free mode, (modes,), in m.
    #[getter]
    fn motion<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.outcome.motion)
    }

    /// What is left of the distance, (contacts,), in m.
    #[getter]
    fn gap<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let displacement = &self.outcome.verdict.displacement;
        let contacts = 0..self.problem.contacts();
        column(py, contacts.map(|i| self.problem.gap(i, displacement)))
    }

    /// What each contact does, (contacts,): 0 open, 1 slip, 2 stick.
    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i8>> {
        let states = self.outcome.verdict.status.iter();
        column(
            py,
            states.map(|status| match status {
                ContactStatus::Open => 0,
                ContactStatus::Slip => 1,
                ContactStatus::Stick => 2,
            }),
        )
    }

    /// Natural-map residual, relative to the reaction: the stopping test.
    #[getter]
    fn residual(&self) -> f64 {
        self.outcome.verdict.certificate.natural_map
    }

    /// Every law's worst violation: `value` in physical units, `scaled` relative to the load, `contact`.
    #[getter]
    fn certificate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (found, measured) = (PyDict::new(py), &self.outcome.verdict.certificate);
        found.set_item("natural_map", measured.natural_map)?;
        let worst = [
            ("penetration", measured.penetration),
            ("tension", measured.tension),
            ("complementarity", measured.complementarity),
            ("disc_excess", measured.disc_excess),
            ("dissipation_defect", measured.dissipation_defect),
        ];
        for (
            name,
            Worst {
                value,
                scaled,
                contact,
            },
        ) in worst
        {
            let entry = PyDict::new(py);
            entry.set_item("value", value)?;
            entry.set_item("scaled", scaled)?;
            entry.set_item("contact", contact)?;
            found.set_item(name, entry)?;
        }
        if self.problem.free_modes() > 0 {
            found.set_item("equilibrium", measured.equilibrium.value)?;
        }
        found.set_item("bipotential_gap", measured.bipotential_gap)?;
        found.set_item("reaction_energy", measured.reaction_energy)?;
        Ok(found)
    }

    /// Counts of the outer loop's work.
    #[getter]
    fn work<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (found, work) = (PyDict::new(py), &self.outcome.work);
        found.set_item("sweeps", work.sweeps)?;
        found.set_item("newton_steps", work.newton_steps)?;
        found.set_item("cone_iterations", work.cone_iterations)?;
        Ok(found)
    }

    fn __repr__(&self) -> String {
        format!(
            "dpana.ProblemResult({}, residual {:.1e})",
            self.status(),
            self.residual()
        )
    }
}
