//! How wrong the stress of a solution is: an estimate, and a bound.

use super::Solution;
use crate::body::{self, Facet};
use crate::contact::Opposite;
use crate::error::Error;

impl Solution {
    /// Estimated error of the stress of all bodies relative to the stress, both in the energy
    /// norm (B9); 0 where there is no stress.
    #[must_use]
    pub fn stress_error_estimate(&self) -> f64 {
        let [error, energy] = self.recovery();
        relative(error, energy)
    }

    /// A bound of the same error (B18), of bodies under the tractions on their contact that this state has
    /// there; plane and axisymmetric bodies with straight cells.
    ///
    /// What finer meshes change in those tractions, and in where contact begins and ends, is not in it. With friction no such
    /// bound is known to us: the solution minimises no energy. Without it the complementary energy of an admissible
    /// stress would do, once the displacement is admissible as well, which contacts in the mean are not between curved sides.
    ///
    /// ```
    /// use dpana::{Scene, solve};
    ///
    /// # fn main() -> Result<(), dpana::Error> {
    /// // A block is pressed on a rough floor, and its sides bulge.
    /// let scene = r#"{
    ///     "bodies": [{ "mesh": { "rectangle": { "x": [0, 2], "y": [0, 1], "cells": [8, 4] } },
    ///                  "model": "plane_strain",
    ///                  "materials": [{ "young": 1000, "poisson": 0.3 }],
    ///                  "supports": [{ "group": "top", "displacement": [0, -0.01] }] }],
    ///     "contacts": [{ "group": "bottom", "friction": 0.9,
    ///                    "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }] }"#;
    /// let solution = solve(&Scene::from_json(scene, "")?)?;
    /// let (estimate, bound) = (solution.stress_error_estimate(), solution.stress_error_bound()?);
    /// assert!(bound > 0.5 * estimate && bound < 3.0 * estimate && bound < 0.2);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::NotAccepted`] for what the bound does not know: bodies in 3D, curved cells, springs, ties, forces and
    /// supports of single nodes, incompatible modes and averaged dilatations.
    pub fn stress_error_bound(&self) -> Result<f64, Error> {
        let mut bound = 0.0;
        for (index, body) in self.setup.bodies.iter().enumerate() {
            let touching = self.touching(index);
            bound += body::stress_error_bound(body, &self.displacements[index], &touching)?;
        }
        Ok(relative(bound, self.recovery()[1]))
    }

    /// Squares of the estimated error and of the stress.
    fn recovery(&self) -> [f64; 2] {
        let solved = self.setup.bodies.iter().zip(&self.displacements);
        solved.fold([0.0; 2], |[error, energy], (body, displacement)| {
            let found = body::stress_recovery(body, displacement);
            [error + found.error, energy + found.energy]
        })
    }

    /// Facets on which a body may touch.
    fn touching(&self, index: usize) -> Vec<Facet> {
        let pairs = self.setup.pairs.iter();
        let facets = pairs.flat_map(|pair| {
            let own = (pair.body == index).then_some(&pair.facets);
            let other = match &pair.opposite {
                Opposite::Surface { body, facets } if *body == index => Some(facets),
                _ => None,
            };
            own.into_iter().chain(other).flatten().cloned()
        });
        facets.collect()
    }
}

fn relative(error: f64, energy: f64) -> f64 {
    if energy > 0.0 {
        (error / energy).sqrt()
    } else {
        0.0
    }
}
