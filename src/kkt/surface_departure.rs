//! Whether the recovered bodies move at their contacts as the condensed problem says.

use super::certificate::Worst;
use super::resultant::nodal_lengths;
use super::sides::{block, check_sides, check_surface, relative_displacement};
use crate::body::Body;
use crate::condensation::{ContactProblem, ContactSurface};
use crate::error::{Error, check_length};

/// Largest difference between the relative displacement of a contact in the recovered
/// bodies (K5) and in the condensed problem, in metre; scaled by the largest displacement.
///
/// `displacements` are per body and unknown (`node · dimension + axis`),
/// `contact_displacement` per contact unknown as the judge computed it, both in metre. The
/// certificate of (L1)–(L3) speaks of the condensed problem; this says whether it speaks
/// of the bodies as well.
///
/// # Errors
///
/// [`Error::Length`] if arrays do not belong together, [`Error::UnknownIndex`] if a
/// contact stands at a body or node that does not exist.
pub fn surface_departure(
    bodies: &[Body],
    displacements: &[Vec<f64>],
    surface: &ContactSurface,
    problem: &ContactProblem,
    contact_displacement: &[f64],
) -> Result<Worst, Error> {
    let place = "contact displacement";
    check_surface(surface, problem, place, contact_displacement)?;
    check_sides(surface, bodies)?;
    check_length("displacements", bodies.len(), displacements.len())?;
    let mut motion = 0.0_f64;
    for (index, (body, displacement)) in bodies.iter().zip(displacements).enumerate() {
        let (dimension, nodes) = (body.mesh.dimension, body.mesh.nodes.len());
        let place = format!("displacements[{index}]");
        check_length(&place, nodes * dimension, displacement.len())?;
        motion = nodal_lengths(displacement, dimension).fold(motion, f64::max);
    }

    let mut worst = Worst::default();
    for (i, contact) in surface.nodes.iter().enumerate() {
        let dimension = bodies[contact.body].mesh.dimension;
        let relative = relative_displacement(contact, displacements, dimension);
        let condensed = block(problem, i, contact_displacement);
        for (direction, condensed) in contact.frame.iter().zip(condensed) {
            let along: f64 = direction.iter().zip(relative).map(|(d, u)| d * u).sum();
            worst.raise((along - condensed).abs(), i);
        }
    }
    Ok(worst.over(motion))
}
