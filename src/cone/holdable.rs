//! The loads that admissible contact forces can hold: how far one is from them, and how far one grows in them.
//!
//! ```text
//! (H5)  min ‖Qᵀ t + e‖   s.t.  t ∈ K                    =   max e·β    s.t.  Q β ∈ K*,  ‖β‖ ≤ 1
//! (H6)  max λ            s.t.  Qᵀ t + e + λ g = 0, …    =   min −e·β   s.t.  Q β ∈ K*,  g·β ≥ 1
//! ```
//!
//! `K* = { v : v_N + μ ‖v_T‖ ≤ 0 }` holds the velocities that no admissible reaction works against. If the distance
//! (H5) is zero, `t` holds the load; if not, β proves that nothing does:
//! `0 = β·(Qᵀ t + e) = (Q β)·t + e·β ≥ e·β > 0` for whatever admissible `t`. (H5) has no special cases: it is always
//! solvable and never unbounded. Motions β, loads and norms are those of
//! [`VelocityBasis`](super::velocity_basis::VelocityBasis), so units do not matter.
//!
//! A load that may grow is one more contact without friction: its reaction `−λ ≤ 0` works on the
//! velocity `−g·β`.

use faer::Mat;

use super::clarabel::{Columns, ConeSizes, ConicProgram};
use super::generators::Generators;
use super::nearest::Projection;
use super::rigid_contacts::{RigidContacts, slip};
use super::velocity_basis::{norm, product};

/// Contacts, and a growing load as the last of them, in the velocities Q.
pub(super) struct Holdable {
    velocities: Mat<f64>,
    offsets: Vec<usize>,
    friction: Vec<f64>,
    generators: Generators,
    grows: bool,
}

impl Holdable {
    /// For coefficients of friction that may differ from the contacts' own.
    pub(super) fn new(contacts: &RigidContacts, friction: &[f64], growing: Option<&[f64]>) -> Self {
        let (mut offsets, mut friction) = (contacts.offsets().to_vec(), friction.to_vec());
        let q = &contacts.basis.velocities;
        let (unknowns, rank) = (q.nrows(), q.ncols());
        let velocities = match growing {
            None => q.clone(),
            Some(growing) => {
                offsets.push(unknowns + 1);
                friction.push(0.0);
                let last = |j: usize| -growing[j];
                Mat::from_fn(unknowns + 1, rank, |i, j| {
                    if i < unknowns { q[(i, j)] } else { last(j) }
                })
            }
        };
        // Columns of Q have unit norm: this brings the program's entries to order one.
        let size = (friction.len() as f64).sqrt();
        let mut scale: Vec<f64> = friction.iter().map(|mu| size / mu.max(1.0)).collect();
        if let (Some(_), Some(last)) = (growing, scale.last_mut()) {
            *last = 1.0;
        }
        let generators = Generators::new(&offsets, &friction, &scale);
        Self {
            velocities,
            offsets,
            friction,
            generators,
            grows: growing.is_some(),
        }
    }

    /// (H5): reactions `t` (with `−λ` at the end) and the motion β, for a load of unit size.
    pub(super) fn distance(&self, load: &[f64], tolerance: f64) -> Option<(Vec<f64>, Vec<f64>)> {
        let (rank, ball) = (load.len(), self.generators.size());
        let mut columns = Columns::new();
        for j in 0..rank {
            self.push_velocity(&mut columns, j, 0);
            columns.push(ball + 1 + j, -1.0);
            columns.end_column();
        }
        let mut cones = self.generators.cones().clone();
        cones.second_order.push(1 + rank);
        let mut right = vec![0.0; ball + 1 + rank];
        right[ball] = 1.0;
        self.solve(columns, &cones, load, &right, 0, tolerance)
    }

    /// (H6): reactions, `−λ` at the end, and the motion β that begins there, for unit loads.
    pub(super) fn limit(
        &self,
        load: &[f64],
        growing: &[f64],
        tolerance: f64,
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        // g·β ≥ 0 of the cones is implied by g·β ≥ 1, which takes its place: λ is the sum of both multipliers.
        let mut columns = Columns::new();
        for (j, g) in growing.iter().enumerate() {
            columns.push(0, -g);
            self.push_velocity(&mut columns, j, 1);
            columns.end_column();
        }
        let mut cones = self.generators.cones().clone();
        cones.nonnegative += 1;
        let mut right = vec![0.0; 1 + self.generators.size()];
        right[0] = -1.0;
        self.solve(columns, &cones, load, &right, 1, tolerance)
    }

    fn push_velocity(&self, columns: &mut Columns, column: usize, above: usize) {
        let velocity: Vec<f64> = self.velocities.col(column).iter().copied().collect();
        for (row, image) in self.generators.transpose(&velocity).iter().enumerate() {
            columns.push(above + row, -image);
        }
    }

    /// Reactions from the multipliers after the first `above`, which belong to the growing load.
    fn solve(
        &self,
        columns: Columns,
        cones: &ConeSizes,
        load: &[f64],
        right: &[f64],
        above: usize,
        tolerance: f64,
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let linear: Vec<f64> = load.iter().map(|e| -e).collect();
        let solution = ConicProgram::new(None, columns, cones)?.solve(&linear, right, tolerance)?;
        let (growth, z) = solution.multipliers.split_at(above);
        let mut reaction = self.generators.reaction(z, self.velocities.nrows());
        if let (true, Some(last)) = (self.grows, reaction.last_mut()) {
            *last -= growth.iter().sum::<f64>();
        }
        Some((reaction, solution.x))
    }

    /// Brings reactions into equilibrium and returns what is left of `Qᵀ t + e`.
    pub(super) fn balance(&self, load: &[f64], reaction: &mut Vec<f64>) -> f64 {
        let found = self
            .projection()
            .nearest(reaction, load, 0.0, vec![0.0; load.len()]);
        *reaction = found.reaction;
        found.remainder
    }

    /// One proximal step for (H5) from `reaction`: better reactions, the motion β along which the rest of
    /// the load pulls, and the size of that rest.
    pub(super) fn separate(
        &self,
        load: &[f64],
        reaction: &[f64],
        softness: f64,
    ) -> (Vec<f64>, Vec<f64>, f64) {
        let found = self
            .projection()
            .nearest(reaction, load, softness, vec![0.0; load.len()]);
        let size = norm(found.gamma.iter().copied());
        let motion = found.gamma.iter().map(|g| -g / size.max(f64::MIN_POSITIVE));
        (found.reaction, motion.collect(), found.remainder)
    }

    /// One proximal step of length σ for (H6) from reactions `t` and the motion β:
    /// `min −λ + ‖s − t‖²/2σ  s.t.  Qᵀ s + e + λ g = 0,  s ∈ K`, whose multipliers are the next β.
    ///
    /// Returns reactions, motion, and what is left of the equations.
    pub(super) fn sharpen(
        &self,
        load: &[f64],
        reaction: &[f64],
        motion: &[f64],
        length: f64,
    ) -> (Vec<f64>, Vec<f64>, f64) {
        let mut target = reaction.to_vec();
        if let Some(last) = target.last_mut() {
            *last -= length;
        }
        let gamma = motion.iter().map(|b| -length * b).collect();
        let found = self.projection().nearest(&target, load, 0.0, gamma);
        let motion = found.gamma.iter().map(|g| -g / length).collect();
        (found.reaction, motion, found.remainder)
    }

    fn projection(&self) -> Projection<'_> {
        Projection {
            q: self.velocities.as_ref(),
            offsets: &self.offsets,
            friction: &self.friction,
        }
    }

    /// `e·β`.
    pub(super) fn work(&self, load: &[f64], motion: &[f64]) -> f64 {
        load.iter().zip(motion).map(|(e, b)| e * b).sum()
    }

    /// Largest `v_N + μ ‖v_T‖`, or zero: what keeps a motion from being free of resistance.
    pub(super) fn resistance(&self, motion: &[f64]) -> f64 {
        let velocity = product(self.velocities.as_ref(), motion);
        let blocks = self.offsets.windows(2).zip(&self.friction);
        let each = blocks
            .map(|(block, mu)| velocity[block[0]] + mu * slip(&velocity[block[0] + 1..block[1]]));
        each.fold(0.0, f64::max)
    }

    /// `Σ −t_N` of the contacts.
    pub(super) fn normal_sum(&self, reaction: &[f64]) -> f64 {
        let normals = self.offsets.iter().filter_map(|&n| reaction.get(n));
        normals.map(|t| -t).sum()
    }
}
