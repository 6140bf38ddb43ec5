//! Rigid motions that the supports leave free, as the contacts see them.
//!
//! ```text
//! (C3)  u = û + G t + R α,      Rᵀ t + e = 0
//! ```
//!
//! R: displacement of every contact unknown under a unit of each free mode; e: work of
//! the loads on the modes; α: the rigid motion that the solution needs.

use faer::{Mat, MatRef};

use crate::error::{Error, check_finite, check_length};

/// Free rigid modes of all bodies together (C3).
#[derive(Clone, Debug, PartialEq)]
pub struct Floating {
    modes: Mat<f64>,
    load: Vec<f64>,
}

impl Floating {
    /// Checks and joins the parts.
    ///
    /// - `modes`: R, unknowns × modes, displacement per amplitude (modes of comparable size:
    ///   best, one metre of amplitude moves a body by about one metre);
    /// - `load`: e per mode, in newton.
    ///
    /// # Errors
    ///
    /// A length that does not fit, a NaN or infinity.
    pub fn new(modes: Mat<f64>, load: Vec<f64>) -> Result<Self, Error> {
        check_length("floating.load", modes.ncols(), load.len())?;
        check_finite("floating.load", &load)?;
        for k in 0..modes.ncols() {
            check_finite(&format!("floating.modes column {k}"), modes.col_as_slice(k))?;
        }
        Ok(Self { modes, load })
    }

    /// R, per contact unknown and mode.
    #[must_use]
    pub fn modes(&self) -> MatRef<'_, f64> {
        self.modes.as_ref()
    }

    /// e, the work of the loads on each mode, in newton.
    #[must_use]
    pub fn load(&self) -> &[f64] {
        &self.load
    }
}
