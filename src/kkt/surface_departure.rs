//! Whether the recovered bodies move at their contacts as the condensed problem says.

use super::certificate::Worst;
use super::resultant::nodal_lengths;
use super::sides::{block, check_sides, check_surface, relative_displacement};
use crate::body::Body;
use crate::contact::ContactSurface;
use crate::error::{Error, check_length};
use crate::problem::ContactProblem;

/// Largest difference between the relative displacement of a contact in the recovered
/// bodies (K5) and in the condensed problem, in metre; scaled by the largest displacement.
///
/// `displacements` are per body and unknown (`node · dimension + axis`),
/// `contact_displacement` per contact unknown as the judge computed it, `others` per contact what it holds of the
/// motion of a rigid other side (none: nothing), all in metre. The
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
    others: &[[f64; 3]],
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
        let mut relative = relative_displacement(contact, displacements, dimension);
        for (u, other) in relative.iter_mut().zip(others.get(i).into_iter().flatten()) {
            *u -= other;
        }
        let condensed = block(problem, i, contact_displacement);
        for (direction, condensed) in contact.frame.iter().zip(condensed) {
            let along: f64 = direction.iter().zip(relative).map(|(d, u)| d * u).sum();
            worst.raise((along - condensed).abs(), i);
        }
    }
    Ok(worst.over(motion))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::kkt::tests::samples::lid_on_box;

    /// The lid goes down by 0.5 m and the box by 0.25 m along x: u = (0.5, −0.25).
    fn departure(displacements: &[Vec<f64>], condensed: [f64; 2]) -> Result<Worst, Error> {
        let (bodies, surface, problem) = lid_on_box(0.0);
        surface_departure(&bodies, displacements, &surface, &problem, &condensed, &[])
    }

    fn moved() -> [Vec<f64>; 2] {
        [vec![0.0, -0.5], vec![0.25, 0.0, 0.25, 0.0]]
    }

    #[test]
    fn bodies_that_follow_the_condensed_problem_do_not_depart() {
        let found = departure(&moved(), [0.5, -0.25]).unwrap();
        assert_eq!(found, Worst::default());
    }

    #[test]
    fn a_departure_of_the_other_side_is_measured_against_the_largest_displacement() {
        let mut moved = moved();
        // Three quarters of 0.5 m at the near node of the box, along the normal: 0.375 m.
        moved[1][3] = -0.5;
        let found = departure(&moved, [0.5, -0.25]).unwrap();
        let largest = 0.25_f64.hypot(0.5);
        assert_eq!((found.value, found.contact), (0.375, 0));
        assert!((found.scaled - 0.375 / largest).abs() < 1e-15);
    }

    #[test]
    fn a_nan_in_any_body_is_an_infinite_departure() {
        let mut moved = moved();
        moved[1][0] = f64::NAN;
        let found = departure(&moved, [0.5, -0.25]).unwrap();
        assert_eq!(found.scaled, f64::INFINITY);
    }

    #[test]
    fn displacements_of_other_bodies_are_refused() {
        let mut moved = moved();
        moved[1].pop();
        let refused = departure(&moved, [0.5, -0.25]).unwrap_err().to_string();
        assert_eq!(refused, "displacements[1]: expected 4 entries, found 3");
        assert!(departure(&moved[..1], [0.5, -0.25]).is_err());
    }
}
