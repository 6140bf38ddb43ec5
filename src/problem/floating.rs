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

/// Largest entries of a mode that others can be compared with.
const SIZES: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// Free rigid modes of all bodies together (C3).
#[derive(Clone, Debug, PartialEq)]
pub struct Floating {
    modes: Mat<f64>,
    load: Vec<f64>,
    /// How far an amplitude of one moves the bodies, per mode.
    sizes: Vec<f64>,
}

impl Floating {
    /// Checks and joins the parts.
    ///
    /// - `modes`: R, unknowns × modes, displacement per amplitude (best, one metre of amplitude
    ///   moves a body by about one metre);
    /// - `load`: e per mode, in newton.
    ///
    /// # Errors
    ///
    /// A length that does not fit, a NaN or infinity, a mode that moves contacts, but by less than
    /// 1e-3 or by more than 1e3 metre per metre of amplitude.
    pub fn new(modes: Mat<f64>, load: Vec<f64>) -> Result<Self, Error> {
        let mut sizes = Vec::with_capacity(modes.ncols());
        for (k, mode) in modes.col_iter().enumerate() {
            let size = mode.norm_max();
            if size != 0.0 && !SIZES.contains(&size) {
                return Err(Error::OutOfRange {
                    place: format!("largest entry of floating.modes column {k}"),
                    value: size,
                    accepted: "0, or 1e-3 to 1e3: a metre of amplitude moves a body by about a metre",
                });
            }
            sizes.push(if size > 0.0 { size } else { 1.0 });
        }
        Self::of_sizes(modes, load, sizes)
    }

    /// Modes whose amplitude is that of the whole bodies; at the contacts they may be nothing.
    pub(crate) fn of_bodies(modes: Mat<f64>, load: Vec<f64>) -> Result<Self, Error> {
        let sizes = vec![1.0; modes.ncols()];
        Self::of_sizes(modes, load, sizes)
    }

    /// The same modes under another load.
    pub(crate) fn under(&self, load: Vec<f64>) -> Result<Self, Error> {
        Self::of_sizes(self.modes.clone(), load, self.sizes.clone())
    }

    fn of_sizes(modes: Mat<f64>, load: Vec<f64>, sizes: Vec<f64>) -> Result<Self, Error> {
        check_length("floating.load", modes.ncols(), load.len())?;
        check_finite("floating.load", &load)?;
        for k in 0..modes.ncols() {
            check_finite(&format!("floating.modes column {k}"), modes.col_as_slice(k))?;
        }
        Ok(Self { modes, load, sizes })
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

    /// How far one metre of amplitude moves the bodies, in metre per mode.
    #[must_use]
    pub fn sizes(&self) -> &[f64] {
        &self.sizes
    }
}
