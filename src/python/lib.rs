//! The Python package: scenes, meshes, problems and results of dpana with NumPy arrays.
//!
//! A user of the public API like the command line; nothing is computed here. It is a package of its
//! own in the workspace, so that users of the crate neither build nor link Python.
//!
//! | file | Python sees |
//! |---|---|
//! | `scene` | `StatedScene`, behind `dpana.Scene` and `dpana.solve` |
//! | `mesh` | `dpana.Mesh` from arrays |
//! | `result` | `dpana.Result` and its `Contacts` |
//! | `problem` | `dpana.Problem`, `ProblemResult` |
//! | `watched` | solves without the interpreter's lock that end at Ctrl-C |

mod arrays;
mod error;
mod mesh;
mod problem;
mod result;
mod scene;
mod watched;

use pyo3::prelude::*;

/// Certified frictional contact of elastic bodies; see the package `dpana`.
#[pymodule]
fn _dpana(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("Error", module.py().get_type::<error::Error>())?;
    module.add_function(wrap_pyfunction!(scene::schema, module)?)?;
    module.add_class::<mesh::Mesh>()?;
    module.add_class::<scene::StatedScene>()?;
    module.add_class::<result::Solved>()?;
    module.add_class::<result::Contacts>()?;
    module.add_class::<problem::Problem>()?;
    module.add_class::<problem::SolvedProblem>()
}
