//! Potential energy of displacements and complementary energy of reactions, for given friction bounds.
//!
//! ```text
//! (K15)  Π(u) = ½ τᵀ G τ − e · α + Σ s ‖u_T‖            u = û + G τ + R α,  u_N ≤ g₀       else +∞
//!        Π*(t) = ½ tᵀ G t + t · (û − g₀)                t_N ≤ 0,  ‖t_T‖ ≤ s,  Rᵀ t + e = 0   else +∞
//!        Π(u) + Π*(t) = ½ ‖t − τ‖²_G + Σ (−t_N (g₀ − u_N) + s ‖u_T‖ + t_T · u_T) ≥ 0
//! ```
//!
//! Energies count from the bodies without contact forces. The sum vanishes for the solution u, t of the problem
//! with bounds s alone, and bounds the distance of any two from it (hypercircle; Prager, Synge, Quart. Appl.
//! Math. 5 (1947) 241–269):
//!
//! ```text
//! ½ ‖τ − t*‖²_G + ½ ‖t − t*‖²_G ≤ Π(u) + Π*(t)
//! ```
//!
//! With the displacement of the reaction itself, τ = t and s = −μ t_N, it is the bipotential gap of the certificate.

use crate::error::{Error, check_finite, check_length};
use crate::problem::ContactProblem;

/// What is beyond a bound by this part of the largest value of its kind is rounding.
const ROUNDED: f64 = 1e-12;

/// Both energies, in joule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energies {
    /// Π; infinite where contacts overlap.
    pub potential: f64,
    /// Π*; infinite for reactions that pull, that are beyond their bounds, or that do not hold the bodies.
    pub complementary: f64,
    /// Their sum, from terms that are not negative.
    pub gap: f64,
}

/// A displacement of the bodies, by the forces on the contacts that make it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<'a> {
    /// τ per unknown, in newton: any forces, laws or not.
    pub forces: &'a [f64],
    /// α per free mode, in metre.
    pub amplitudes: &'a [f64],
}

/// Energies of a displacement and a reaction (per unknown, in newton) for a friction bound per contact, in newton.
///
/// # Errors
///
/// Lengths that do not fit the problem, a NaN or infinity.
pub fn energies(
    problem: &ContactProblem,
    bound: &[f64],
    moved: Motion<'_>,
    reaction: &[f64],
) -> Result<Energies, Error> {
    let (unknowns, modes) = (problem.unknowns(), problem.free_modes());
    for (place, expected, entries) in [
        ("bound", problem.contacts(), bound),
        ("forces", unknowns, moved.forces),
        ("amplitudes", modes, moved.amplitudes),
        ("reaction", unknowns, reaction),
    ] {
        check_length(place, expected, entries.len())?;
        check_finite(place, entries)?;
    }
    let free = problem.free_displacement();
    let strain = |forces: &[f64]| -> Vec<f64> {
        let moved = problem.displacement(forces);
        moved.iter().zip(free).map(|(u, free)| u - free).collect()
    };
    let of_forces = strain(moved.forces);
    let mut u: Vec<f64> = of_forces
        .iter()
        .zip(free)
        .map(|(g, free)| g + free)
        .collect();
    let mut work = 0.0;
    if let Some(floating) = problem.floating() {
        let columns = floating.modes().col_iter().zip(moved.amplitudes);
        for ((column, amplitude), load) in columns.zip(floating.load()) {
            u.iter_mut()
                .zip(column.iter())
                .for_each(|(u, r)| *u += amplitude * r);
            work += load * amplitude;
        }
    }
    let apart: Vec<f64> = reaction
        .iter()
        .zip(moved.forces)
        .map(|(t, f)| t - f)
        .collect();
    let terms = Terms::new(problem, bound, &u, reaction);
    let contact = half(reaction, &strain(reaction)) + dot(reaction, free);
    Ok(Energies {
        potential: match terms.feasible {
            true => half(moved.forces, &of_forces) - work + terms.friction,
            false => f64::INFINITY,
        },
        complementary: match terms.admissible && holds(problem, reaction) {
            true => contact - terms.gaps,
            false => f64::INFINITY,
        },
        gap: match terms.feasible && terms.admissible && holds(problem, reaction) {
            true => half(&apart, &strain(&apart)) + terms.gap,
            false => f64::INFINITY,
        },
    })
}

/// Sums over contacts.
#[derive(Default)]
struct Terms {
    feasible: bool,
    admissible: bool,
    /// `Σ s ‖u_T‖`.
    friction: f64,
    /// `Σ t_N g₀`.
    gaps: f64,
    /// The sum of (K15).
    gap: f64,
}

impl Terms {
    fn new(problem: &ContactProblem, bound: &[f64], u: &[f64], t: &[f64]) -> Self {
        let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let length = largest(u).max(largest(problem.initial_gap()));
        let (length, force) = (ROUNDED * length, ROUNDED * largest(t).max(largest(bound)));
        let mut sums = Self {
            feasible: true,
            admissible: true,
            ..Self::default()
        };
        for (contact, block) in problem.blocks().enumerate() {
            let (gap, t, u) = (problem.gap(contact, u), &t[block.clone()], &u[block]);
            let sizes = [t, u].map(|v| v[1..].iter().fold(0.0, |size: f64, x| size.hypot(*x)));
            sums.feasible &= gap >= -length;
            sums.admissible &= t[0] <= force && sizes[0] <= bound[contact] + force;
            sums.friction += bound[contact] * sizes[1];
            sums.gaps += t[0] * problem.initial_gap()[contact];
            let slid = bound[contact] * sizes[1] + dot(&t[1..], &u[1..]);
            sums.gap += f64::max(-t[0] * gap, 0.0) + slid.max(0.0);
        }
        sums
    }
}

/// Rᵀ t + e is rounding.
fn holds(problem: &ContactProblem, reaction: &[f64]) -> bool {
    problem.floating().is_none_or(|floating| {
        let columns = floating.modes().col_iter().zip(floating.load());
        columns.into_iter().all(|(column, load)| {
            let works = column.iter().zip(reaction).map(|(r, t)| r * t);
            let (sum, size) = works.fold((*load, load.abs()), |(sum, size), work| {
                (sum + work, size + work.abs())
            });
            sum.abs() <= 1e3 * ROUNDED * size
        })
    })
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn half(forces: &[f64], strain: &[f64]) -> f64 {
    0.5 * dot(forces, strain)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::problem::Operator;
    use faer::mat;

    #[test]
    fn energies_of_one_contact_are_those_of_springs() {
        // G = 1, û = (2, 1), g₀ = ½, s = 0.3. u = (0.5, 1) by τ = (−1.5, 0): Π = 1.125 + 0.3.
        let operator = Operator::from_compliance(mat![[1.0, 0.0], [0.0, 1.0]]).unwrap();
        let free = vec![2.0, 1.0];
        let problem = ContactProblem::new(&[1], vec![0.2], vec![0.5], free, operator).unwrap();
        let moved = |forces| Motion {
            forces,
            amplitudes: &[],
        };
        let found = energies(&problem, &[0.3], moved(&[-1.5, 0.0]), &[-1.0, -0.1]).unwrap();
        assert!((found.potential - 1.425).abs() < 1e-15);
        // Π* = ½ (1 + 0.01) − 1.5 − 0.1; the sum is ½ (0.25 + 0.01) + 0.3 − 0.1.
        assert!((found.complementary + 1.095).abs() < 1e-15);
        assert!((found.gap - 0.33).abs() < 1e-15);
        // The solution: t = τ = (−1.5, −0.3).
        let exact = [-1.5, -0.3];
        let found = energies(&problem, &[0.3], moved(&exact), &exact).unwrap();
        assert!(found.gap < 1e-15 && (found.potential + found.complementary).abs() < 1e-15);
        // Overlap, and a reaction beyond its bound.
        let found = energies(&problem, &[0.3], moved(&[0.0; 2]), &[-1.0, 0.4]).unwrap();
        assert_eq!(
            (found.potential, found.complementary),
            (f64::INFINITY, f64::INFINITY)
        );
    }
}
