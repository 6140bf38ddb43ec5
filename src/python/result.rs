//! A solved scene: its report, contacts as arrays, fields of the bodies.

use std::path::PathBuf;
use std::sync::Arc;

use dpana::report::{Contact, Report, ReportedContactState};
use dpana::{Solution, Status};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;

use super::arrays::{column, rows};
use super::error::{Error, refused};
use super::mesh::Mesh;
use super::problem::Problem;
use super::watched::{Flag, watched};

/// A solved scene.
#[pyclass(module = "dpana", name = "Result", frozen)]
pub(super) struct Solved {
    solution: Solution,
    report: Arc<Report>,
    /// The report without its longest parts, as Python reads it.
    short: PyOnceLock<Py<PyAny>>,
    /// That of the solve.
    flag: Arc<Flag>,
}

/// A body by its place in the scene or by its name.
#[derive(FromPyObject)]
enum Which {
    Index(usize),
    Name(String),
}

impl Solved {
    pub(super) fn new(solution: Solution, flag: Arc<Flag>) -> PyResult<Self> {
        Ok(Self {
            flag,
            report: Arc::new(solution.report().map_err(refused)?),
            solution,
            short: PyOnceLock::new(),
        })
    }

    fn body(&self, which: Option<Which>) -> PyResult<usize> {
        let bodies = self.solution.bodies();
        let found = match &which {
            None => Some(0),
            Some(Which::Index(at)) => Some(*at),
            Some(Which::Name(name)) => bodies.iter().position(|body| body.name == *name),
        };
        found.filter(|&at| at < bodies.len()).ok_or_else(|| {
            let names: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
            let asked = match which {
                Some(Which::Name(name)) => format!("`{name}`"),
                Some(Which::Index(at)) => at.to_string(),
                None => "the first".to_owned(),
            };
            Error::new_err(format!(
                "body: {asked} is not in the scene; expected one of {}, or a number from 0",
                names.join(", ")
            ))
        })
    }

    fn short<'py>(&self, py: Python<'py>) -> PyResult<&Bound<'py, PyAny>> {
        let short = self.short.get_or_try_init(py, || {
            let mut report = Report::clone(&self.report);
            report.contacts.clear();
            report.history.clear();
            parsed(py, &report.to_json()).map(Bound::unbind)
        })?;
        Ok(short.bind(py))
    }
}

/// JSON as Python objects; numbers keep every bit.
pub(super) fn parsed<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (json,))
}

#[pymethods]
impl Solved {
    /// `certified`, `not_converged`, `no_equilibrium` or `coupling_fault`.
    #[getter]
    fn status(&self) -> &'static str {
        self.report.status.word()
    }

    /// Whether the judge certified it.
    #[getter]
    fn certified(&self) -> bool {
        self.solution.status() == Status::Certified
    }

    /// The answer as a short text.
    fn summary(&self) -> String {
        self.report.summary()
    }

    /// The whole report as objects, as `dpana solve --report` writes it; made anew at every call.
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        parsed(py, &self.report.to_json())
    }

    /// The whole report as JSON.
    fn to_json(&self) -> String {
        self.report.to_json()
    }

    /// Counts of open, stick and slip, resultants, areas, peak pressure; the same per contact pair.
    #[getter]
    fn totals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.short(py)?.get_item("totals")
    }

    /// Every law's worst violation and the balance of every body, measured by the judge.
    #[getter]
    fn certificate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.short(py)?.get_item("certificate")
    }

    /// What a reader should know besides the numbers.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.report.notes.clone()
    }

    /// The load step that led here: `number`, `at`, `driven`, ledger; None for a scene without steps.
    #[getter]
    fn step<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.short(py)?.call_method1("get", ("step",))
    }

    /// The contacts as arrays.
    #[getter]
    fn contacts(&self) -> Contacts {
        let problem = self.solution.condensed().problem();
        let reaction = &self.solution.outcome().reaction;
        Contacts {
            report: Arc::clone(&self.report),
            normal_reaction: problem.normals().iter().map(|&at| reaction[at]).collect(),
            initial_gap: problem.initial_gap().to_vec(),
        }
    }

    /// G, û, gaps, friction and frames of the contacts.
    #[getter]
    fn problem(&self) -> PyResult<Problem> {
        let condensed = self.solution.precise().map_err(refused)?;
        Ok(Problem::of_scene(condensed, self.report.size.dimension))
    }

    /// Names of the bodies.
    #[getter]
    fn bodies(&self) -> Vec<String> {
        let bodies = self.solution.bodies().iter();
        bodies.map(|body| body.name.clone()).collect()
    }

    /// Mesh of a body before loading. `body`: name or number from 0; the first one if left out.
    #[pyo3(signature = (body=None))]
    fn mesh(&self, body: Option<Which>) -> PyResult<Mesh> {
        let body = self.body(body)?;
        Ok(Mesh(self.solution.bodies()[body].mesh.clone()))
    }

    /// Displacement of a body's nodes, (nodes, d), in the unit of length.
    #[pyo3(signature = (body=None))]
    fn displacement<'py>(
        &self,
        py: Python<'py>,
        body: Option<Which>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let displacement = &self.solution.displacements()[self.body(body)?];
        rows(py, displacement.iter().copied(), self.report.size.dimension)
    }

    /// Stress at a body's nodes, (nodes, 6), in force per area: xx, yy, zz, yz, xz, xy.
    #[pyo3(signature = (body=None))]
    fn stress<'py>(
        &self,
        py: Python<'py>,
        body: Option<Which>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let body = self.body(body)?;
        let stress = py.detach(|| self.solution.stresses().swap_remove(body));
        rows(py, stress.nodes.into_iter().flatten(), 6)
    }

    /// Stress at the centre of a body's cells, (cells, 6), in force per area: xx, yy, zz, yz, xz, xy.
    #[pyo3(signature = (body=None))]
    fn cell_stress<'py>(
        &self,
        py: Python<'py>,
        body: Option<Which>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let body = self.body(body)?;
        let stress = py.detach(|| self.solution.stresses().swap_remove(body));
        rows(py, stress.cells.into_iter().flatten(), 6)
    }

    /// Estimated error of the stress relative to the stress, both in the energy norm.
    fn stress_error_estimate(&self, py: Python<'_>) -> f64 {
        py.detach(|| self.solution.stress_error_estimate())
    }

    /// The same error at most, of bodies under the contact tractions of this state: where contact begins and ends is not in
    /// it. Plane and axisymmetric bodies of straight cells; an Error says what it does not know.
    fn stress_error_bound(&self, py: Python<'_>) -> PyResult<f64> {
        py.detach(|| self.solution.stress_error_bound())
            .map_err(refused)
    }

    /// Solves again from other starts and looks for jumps on the way here; None without a certificate.
    #[pyo3(signature = (starts=4))]
    fn trust<'py>(&self, py: Python<'py>, starts: usize) -> PyResult<Option<Bound<'py, PyAny>>> {
        let trust = watched(py, &self.flag, |_| self.solution.trust(starts))?;
        let mut report = Report::clone(&self.report);
        report.contacts.clear();
        report.trust = trust.map_err(refused)?;
        match report.trust {
            None => Ok(None),
            Some(_) => parsed(py, &report.to_json())?.get_item("trust").map(Some),
        }
    }

    /// The state after a load step as text, for `restart`; None for a scene without steps.
    fn state(&self) -> Option<String> {
        self.solution.saved_state().map(|state| state.to_json())
    }

    /// Writes displacement and stress for ParaView, and the contact surface beside it
    /// (`NAME_contact.vtu`).
    fn write_vtu(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.solution.write_vtu(&path))
            .map_err(refused)
    }

    /// The deformed bodies and the contact pressure as a drawing in SVG; bodies in 2D only.
    fn to_svg(&self) -> PyResult<String> {
        self.solution.to_svg().map_err(refused)
    }

    fn __repr__(&self) -> String {
        let totals = &self.report.totals;
        format!(
            "dpana.Result({}, {} open, {} stick, {} slip)",
            self.status(),
            totals.open,
            totals.stick,
            totals.slip
        )
    }
}

/// The contacts of a solved scene as arrays, d = 2 or 3; vectors in global axes.
#[pyclass(module = "dpana", frozen)]
pub(super) struct Contacts {
    report: Arc<Report>,
    normal_reaction: Vec<f64>,
    initial_gap: Vec<f64>,
}

impl Contacts {
    fn vectors<'a, 'py>(
        &'a self,
        py: Python<'py>,
        of: impl Fn(&'a Contact) -> &'a [f64],
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let contacts = self.report.contacts.iter();
        let components = contacts.flat_map(|contact| of(contact).iter().copied());
        rows(py, components, self.report.size.dimension)
    }

    fn numbers<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Contact) -> T,
    ) -> Bound<'py, PyArray1<T>> {
        column(py, self.report.contacts.iter().map(of))
    }
}

#[pymethods]
impl Contacts {
    /// Position before loading, (contacts, d), in the unit of length.
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.vectors(py, |contact| &contact.position)
    }

    /// Unit normal out of the body towards the other side, (contacts, d).
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.vectors(py, |contact| &contact.normal)
    }

    /// What each contact does, (contacts,): 0 open, 1 slip, 2 stick.
    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i8>> {
        self.numbers(py, |contact| match contact.state {
            ReportedContactState::Open => 0,
            ReportedContactState::Slip => 1,
            ReportedContactState::Stick => 2,
        })
    }

    /// Distance before loading, (contacts,), in the unit of length.
    #[getter]
    fn initial_gap<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.initial_gap)
    }

    /// Distance left to the other side, (contacts,), in the unit of length.
    #[getter]
    fn gap<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.numbers(py, |contact| contact.gap)
    }

    /// Tangential displacement relative to the other side since the start of the load step,
    /// (contacts, d), in the unit of length; zero where open.
    #[getter]
    fn slip<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.vectors(py, |contact| &contact.slip)
    }

    /// Tributary area, (contacts,).
    #[getter]
    fn area<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.numbers(py, |contact| contact.area)
    }

    /// Normal contact force t_N on the body, (contacts,), <= 0 where pressed.
    #[getter]
    fn normal_reaction<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.normal_reaction)
    }

    /// Contact force on the body, (contacts, d).
    #[getter]
    fn force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.vectors(py, |contact| &contact.force)
    }

    /// Pressure -t_N / area >= 0, (contacts,), in force per area; NaN without an area.
    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.numbers(py, |contact| contact.pressure.unwrap_or(f64::NAN))
    }

    /// Friction force on the body per area, (contacts, d); NaN without an area.
    #[getter]
    fn friction_traction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        const NONE: &[f64] = &[f64::NAN; 3];
        let axes = self.report.size.dimension;
        self.vectors(py, |contact| {
            contact
                .friction_traction
                .as_deref()
                .unwrap_or(&NONE[..axes])
        })
    }

    /// The body each belongs to, (contacts,), from 0.
    #[getter]
    fn body<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.numbers(py, |contact| contact.body as i64)
    }

    /// Node of that body's mesh, (contacts,), from 0.
    #[getter]
    fn node<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.numbers(py, |contact| contact.node as i64)
    }

    /// Contact pair of the scene, (contacts,), from 0.
    #[getter]
    fn pair<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.numbers(py, |contact| contact.pair as i64)
    }

    fn __len__(&self) -> usize {
        self.report.contacts.len()
    }

    /// All of it by name, as for a table.
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        const NAMES: [&str; 14] = [
            "body",
            "node",
            "pair",
            "position",
            "normal",
            "state",
            "initial_gap",
            "gap",
            "slip",
            "area",
            "normal_reaction",
            "force",
            "pressure",
            "friction_traction",
        ];
        let found = PyDict::new(slf.py());
        for name in NAMES {
            found.set_item(name, slf.getattr(name)?)?;
        }
        Ok(found)
    }
}
