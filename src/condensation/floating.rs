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

/// How one unconnected part of a body moves: `translation + rotation × (x − centre)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartMotion {
    /// Index of the body.
    pub body: usize,
    /// Mean position of the part's nodes, in metre.
    pub centre: [f64; 3],
    /// Distance of its farthest node from there, in metre.
    pub size: f64,
    /// Displacement of the centre, in metre.
    pub translation: [f64; 3],
    /// Rotation, in radian.
    pub rotation: [f64; 3],
}

/// The motion of every part that may move, under an amplitude per free mode.
pub(super) fn part_motions(bodies: &[CondensedBody], motion: &[f64]) -> Vec<PartMotion> {
    let modes = bodies.iter().enumerate().flat_map(|(index, body)| {
        let modes = body.grounding.rigid.iter();
        modes.map(move |(mode, size)| (index, mode, *size))
    });
    let mut parts: Vec<((usize, usize), PartMotion)> = Vec::new();
    for ((body, mode, size), amplitude) in modes.zip(motion) {
        let key = (body, mode.part);
        if parts.last().is_none_or(|(last, _)| *last != key) {
            let at_rest = PartMotion {
                body,
                centre: mode.centre,
                size,
                translation: [0.0; 3],
                rotation: [0.0; 3],
            };
            parts.push((key, at_rest));
        }
        if let Some((_, part)) = parts.last_mut() {
            for axis in 0..3 {
                part.translation[axis] += amplitude * mode.translation[axis];
                part.rotation[axis] += amplitude * mode.rotation[axis];
            }
        }
    }
    parts.into_iter().map(|(_, part)| part).collect()
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
        let count: usize = bodies.iter().map(|body| body.grounding.modes.ncols()).sum();
        if count == 0 {
            return Ok(None);
        }
        let unknowns = surface.nodes.iter().map(|node| 1 + node.tangents).sum();
        let mut modes = Mat::zeros(unknowns, count);
        let (mut load, mut first) = (Vec::with_capacity(count), 0);
        for (index, body) in bodies.iter().enumerate() {
            for k in 0..body.grounding.modes.ncols() {
                let of_body = body.grounding.modes.col_as_slice(k);
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
            first += body.grounding.modes.ncols();
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
