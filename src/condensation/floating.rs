//! Rigid motions that the supports leave free, as the contacts see them.
//!
//! ```text
//! (C3)  u = û + G t + R α,      Rᵀ t + e = 0
//! ```
//!
//! R: displacement of every contact unknown under a unit of each free mode; e: work of
//! the loads on the modes; α: the rigid motion that the solution needs.

use faer::{Mat, MatRef};

use super::condensed_body::CondensedBody;
use super::{ContactNode, ContactSurface};
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

    /// R and e of condensed bodies; none if every body is held.
    pub(super) fn of(
        surface: &ContactSurface,
        bodies: &[CondensedBody],
        dimension: usize,
    ) -> Result<Option<Self>, Error> {
        let count: usize = bodies.iter().map(|body| body.free_modes.ncols()).sum();
        if count == 0 {
            return Ok(None);
        }
        let unknowns = surface.nodes.iter().map(|node| 1 + node.tangents).sum();
        let mut modes = Mat::zeros(unknowns, count);
        let (mut load, mut first) = (Vec::with_capacity(count), 0);
        for (index, body) in bodies.iter().enumerate() {
            for k in 0..body.free_modes.ncols() {
                let of_body = body.free_modes.col_as_slice(k);
                let column = modes.col_as_slice_mut(first + k);
                let mut entries = column.iter_mut();
                for contact in &surface.nodes {
                    let moved = moved(contact, index, of_body, dimension);
                    for (row, entry) in contact.frame[..=contact.tangents].iter().zip(&mut entries)
                    {
                        *entry = row.iter().zip(moved).map(|(d, u)| d * u).sum();
                    }
                }
                load.push(of_body.iter().zip(&body.load).map(|(r, f)| r * f).sum());
            }
            first += body.free_modes.ncols();
        }
        Self::new(modes, load).map(Some)
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

/// Relative displacement of a contact, in global axes, under one mode of body `index`.
fn moved(contact: &ContactNode, index: usize, mode: &[f64], axes: usize) -> [f64; 3] {
    let own = (contact.body == index).then_some((contact.node, 1.0));
    let opposite = contact.opposite.iter().filter(|side| side.body == index);
    let opposite = opposite.flat_map(|side| side.nodes.iter().map(|&(node, w)| (node, -w)));
    let mut moved = [0.0; 3];
    for (node, weight) in own.into_iter().chain(opposite) {
        for (axis, sum) in moved[..axes].iter_mut().enumerate() {
            *sum += weight * mode[node * axes + axis];
        }
    }
    moved
}
