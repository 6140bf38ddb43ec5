//! One program over all Coulomb cones, with the equilibrium of floating bodies as rows.
//!
//! ```text
//! (H8)  min ½ t·G t + t_N·(û_N − g₀ − μ s) + t_T·û_T    s.t.  t ∈ K,  Rᵀ t + e = 0
//!
//!       u = û + G t + R α,   g₀ − u_N + μ s ≥ μ ‖u_T‖
//! ```
//!
//! Where the shift `s` is the slip `‖u_T‖` of the minimiser itself, (L1)–(L3) hold: the fixed point
//! of Acary, Cadoux, Lemaréchal and Malick (Z. Angew. Math. Mech. 91 (2011) 155–175). With `s = 0` a sliding
//! contact opens as it slides; its reaction is a start that is admissible and in equilibrium.
//! The multipliers of the equilibrium rows are the rigid motion α. Laws beyond Coulomb's have their own sets (H10).

use faer::MatRef;

use super::clarabel::{Columns, ConeSizes, ConicProgram};
use super::generators::Generators;
use crate::problem::ContactProblem;
use crate::problem::velocity_basis::{VelocityBasis, norm, product};

/// (H8) for one problem, set up once for many shifts and loads.
pub(crate) struct CoulombProgram<'a> {
    problem: &'a ContactProblem,
    basis: VelocityBasis,
    generators: Generators,
    program: ConicProgram,
    /// Size of `T`, so that the equilibrium rows are of order one.
    unit: f64,
}

/// What (H8) left.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CoulombSolution {
    /// Reaction, admissible, in newton per contact unknown.
    pub reaction: Vec<f64>,
    /// Rigid motion α: `u = û + G t + R α`.
    pub motion: Vec<f64>,
    /// The multipliers of the equilibrium rows alone: if these cannot hold, a motion on which the load does more work
    /// than any reaction takes (Farkas).
    pub multipliers: Vec<f64>,
    /// Size of `Rᵀ t + e` relative to that of `e`, as the contacts measure it.
    pub remainder: f64,
    /// Interior-point iterations.
    pub iterations: usize,
}

impl<'a> CoulombProgram<'a> {
    /// Sets up (H8) for the modes R (unknowns × modes, possibly none) of the floating bodies.
    ///
    /// `None` if the modes do not fit the problem or the cone solver refuses the numbers.
    #[must_use]
    pub(crate) fn new(problem: &'a ContactProblem, modes: MatRef<'_, f64>) -> Option<Self> {
        if modes.nrows() != problem.unknowns() {
            return None;
        }
        let basis = VelocityBasis::new(modes)?;
        let scale = scales(problem);
        let unit = norm(scale.iter().copied()) / (scale.len().max(1) as f64).sqrt();
        let generators = Generators::new(problem, &scale);
        let form = generators.form(problem.compliance().as_ref());
        let rank = basis.rank();
        let mut rows = vec![Vec::new(); rank];
        for (row, velocity) in rows.iter_mut().zip(basis.velocities.col_iter()) {
            let velocity: Vec<f64> = velocity.iter().copied().collect();
            *row = generators.transpose(&velocity);
        }
        let mut columns = Columns::new();
        for z in 0..generators.size() {
            for (row, images) in rows.iter().enumerate() {
                columns.push(row, images[z] / unit);
            }
            for (row, entry) in generators.rows(z) {
                columns.push(rank + row, *entry);
            }
            columns.end_column();
        }
        let cones = ConeSizes {
            zero: rank,
            ..generators.cones().clone()
        };
        let program = ConicProgram::new(form.as_ref(), columns, &cones)?;
        Some(Self {
            problem,
            basis,
            generators,
            program,
            unit,
        })
    }

    /// Solves (H8) for the load `e` on the modes and the shift `s` per contact, in metre.
    ///
    /// `None` if the cone solver gives up. If nothing holds the load, the remainder says so: ask
    /// [`RigidContacts::admissible`](crate::limit::RigidContacts::admissible) first.
    pub(crate) fn solve(
        &mut self,
        load: &[f64],
        shift: &[f64],
        tolerance: f64,
    ) -> Option<CoulombSolution> {
        let mut linear = self.problem.free_displacement().to_vec();
        for (contact, &n) in self.problem.normals().iter().enumerate() {
            linear[n] -= self.problem.friction()[contact] * shift[contact]
                + self.problem.initial_gap()[contact];
        }
        // Rigid motions in û do no work that the equilibrium rows do not fix: α takes them.
        let carried = product(self.basis.velocities.transpose(), &linear);
        for (entry, rigid) in linear
            .iter_mut()
            .zip(product(self.basis.velocities.as_ref(), &carried))
        {
            *entry -= rigid;
        }
        let moved = self.basis.load(load);
        let mut q = self.generators.transpose(&linear);
        let mut b: Vec<f64> = moved.iter().map(|e| -e / self.unit).collect();
        let entries = q.iter().chain(&b);
        let largest = entries.fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let sigma = if largest > 0.0 { largest } else { 1.0 };
        q.iter_mut().chain(&mut b).for_each(|x| *x /= sigma);
        let right = self.generators.right().iter();
        b.extend(right.map(|bound| (bound / sigma).min(UNBOUNDED)));

        let solution = self.program.solve(&q, &b, tolerance)?;
        let z: Vec<f64> = solution.x.iter().map(|z| z * sigma).collect();
        let reaction = self
            .generators
            .reaction(&self.inside(z), self.problem.unknowns());
        let beta: Vec<f64> = solution
            .multipliers
            .iter()
            .zip(&carried)
            .map(|(y, carried)| y * sigma / self.unit - carried)
            .collect();
        let answer = product(self.basis.velocities.transpose(), &reaction);
        let size = norm(moved.iter().copied());
        let left = norm(answer.iter().zip(&moved).map(|(a, e)| a + e));
        Some(CoulombSolution {
            reaction,
            motion: self.basis.amplitudes(&beta),
            multipliers: self
                .basis
                .amplitudes(&solution.multipliers[..carried.len()]),
            remainder: if size > 0.0 { left / size } else { left },
            iterations: solution.iterations,
        })
    }

    /// The nearest generators in their cones: the solver leaves them by its tolerance.
    fn inside(&self, mut z: Vec<f64>) -> Vec<f64> {
        let (rays, solid) = z.split_at_mut(self.generators.cones().nonnegative);
        for ray in rays {
            *ray = ray.max(0.0);
        }
        for disc in solid[..self.generators.solid()].chunks_exact_mut(3) {
            let size = disc[1].hypot(disc[2]);
            disc[0] = disc[0].max(0.0);
            if size > disc[0] {
                let shrink = disc[0] / size;
                disc[1..].iter_mut().for_each(|x| *x *= shrink);
            }
        }
        z
    }
}

/// Per contact the inverse root of its compliance, with friction counted as `T` does.
fn scales(problem: &ContactProblem) -> Vec<f64> {
    let g = problem.compliance();
    let blocks = problem.blocks().zip(problem.friction());
    let own: Vec<f64> = blocks
        .map(|(block, mu)| {
            let n = block.start;
            let tangents = (n + 1..block.end).map(|i| mu * mu * g[(i, i)]);
            (g[(n, n)] + tangents.sum::<f64>()) / block.len() as f64
        })
        .collect();
    let largest = own.iter().copied().fold(0.0, f64::max);
    // A contact between rigid parts has no compliance of its own.
    let floor = if largest > 0.0 {
        SMALLEST * largest
    } else {
        1.0
    };
    own.iter().map(|g| g.max(floor).sqrt().recip()).collect()
}

/// A bound of so many times what acts bounds nothing.
const UNBOUNDED: f64 = 1e4;

/// A compliance below this part of the largest does not scale its contact.
const SMALLEST: f64 = 1e-6;

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::limit::RigidContacts;
    use crate::limit::tests::blocks::Blocks;
    use crate::problem::Operator;
    use faer::Mat;

    /// Compliance of every contact unknown, in m/N.
    const C: f64 = 2e-6;

    /// A plane pad on two springy feet, and its rigid motions.
    fn feet(friction: [f64; 2], free: Vec<f64>) -> (ContactProblem, RigidContacts) {
        let mut pad = Blocks::pad(2, 0.0);
        for (touch, mu) in pad.touches.iter_mut().zip(friction) {
            touch.friction = mu;
        }
        let operator =
            Operator::from_compliance(faer::Scale(C) * Mat::<f64>::identity(4, 4)).unwrap();
        let gaps = vec![0.0; 2];
        let problem = ContactProblem::new(&[1, 1], friction.to_vec(), gaps, free, operator);
        (problem.unwrap(), pad.contacts())
    }

    /// A gap of g, relative to forces of 500 N and lengths of 1e-3 m, leaves an error of √g at worst and of the order of g
    /// where no contact is on the brink; the bounds below lie between.
    fn close(found: &[f64], expected: &[f64], tolerance: f64) -> bool {
        found
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < tolerance)
    }

    #[test]
    fn a_pad_on_springy_feet_sinks_and_follows_its_pull() {
        // 1000 N down, 200 N along x: 500 N and 100 N per foot; u = G t + R α = 0 gives
        // α = (C · 100, −C · 500, 0).
        let (problem, contacts) = feet([0.5; 2], vec![0.0; 4]);
        let mut program = CoulombProgram::new(&problem, contacts.modes()).unwrap();
        let load = [200.0, -1000.0, 0.0];
        let found = program.solve(&load, &[0.0; 2], 1e-10).unwrap();
        assert!(
            close(&found.reaction, &[-500.0, -100.0, -500.0, -100.0], 1e-5),
            "{found:?}"
        );
        assert!(
            close(&found.motion, &[C * 100.0, -C * 500.0, 0.0], 1e-11),
            "{found:?}"
        );
        assert!(found.remainder < 1e-9);
    }

    #[test]
    fn a_rigid_motion_in_the_free_displacement_only_moves_the_body_back() {
        let (_, contacts) = feet([0.5; 2], vec![0.0; 4]);
        let moved = contacts.velocity(&[0.3, -0.2, 5.0]);
        let (problem, contacts) = feet([0.5; 2], moved);
        let mut program = CoulombProgram::new(&problem, contacts.modes()).unwrap();
        let found = program
            .solve(&[200.0, -1000.0, 0.0], &[0.0; 2], 1e-10)
            .unwrap();
        assert!(
            close(&found.reaction, &[-500.0, -100.0, -500.0, -100.0], 1e-5),
            "{found:?}"
        );
        let expected = [C * 100.0 - 0.3, 0.2 - C * 500.0, -5.0];
        assert!(close(&found.motion, &expected, 1e-9), "{found:?}");
    }

    #[test]
    fn shifted_by_its_own_slip_the_program_knows_coulomb_s_law() {
        // μ = 0.1 and 0.5, 1000 N down and 200 N along x: the first foot slips with 50 N, the second
        // holds 150 N, so α_x = C · 150 and the slip is C · (150 − 50), along +x.
        let (problem, contacts) = feet([0.1, 0.5], vec![0.0; 4]);
        let mut program = CoulombProgram::new(&problem, contacts.modes()).unwrap();
        let mut shift = [0.0; 2];
        let mut found = program
            .solve(&[200.0, -1000.0, 0.0], &shift, 1e-11)
            .unwrap();
        for _ in 0..10 {
            let mut u = problem.displacement(&found.reaction);
            for (u, rigid) in u.iter_mut().zip(contacts.velocity(&found.motion)) {
                *u += rigid;
            }
            shift = [u[1].abs(), u[3].abs()];
            found = program
                .solve(&[200.0, -1000.0, 0.0], &shift, 1e-11)
                .unwrap();
        }
        assert!(
            close(&found.reaction, &[-500.0, -50.0, -500.0, -150.0], 1e-4),
            "{found:?}"
        );
        assert!(
            (shift[0] - C * 100.0).abs() < 1e-9 && shift[1] < 1e-9,
            "{shift:?}"
        );
    }

    #[test]
    fn a_shift_by_its_slip_keeps_a_sliding_contact_closed() {
        // û = (1, 2) mm: u_N = 0 takes 500 N, friction μ · 500 N = 250 N leaves 2 mm − C · 250 N = 1.5 mm of slip.
        // Without the shift the contact would open by μ times its slip: u_N = −μ ‖u_T‖.
        let (problem, _) = feet([0.5; 2], vec![1e-3, 2e-3, -1e-3, 0.0]);
        let mut program = CoulombProgram::new(&problem, Mat::zeros(4, 0).as_ref()).unwrap();
        let shifted = program.solve(&[], &[1.5e-3, 0.0], 1e-11).unwrap();
        assert!(
            close(&shifted.reaction, &[-500.0, -250.0, 0.0, 0.0], 1e-4),
            "{shifted:?}"
        );
        // C t_N + 1 mm = −μ (2 mm + C μ t_N): t_N = −(1 + 2 μ) mm / (C (1 + μ²)).
        let unshifted = program.solve(&[], &[0.0; 2], 1e-11).unwrap();
        assert!((unshifted.reaction[0] + 2e-3 / (C * 1.25)).abs() < 1e-4);
    }

    #[test]
    fn without_modes_it_is_a_supported_body() {
        // u_N = û_N + C t_N = 0 at û_N = 1 mm: 500 N; μ = 0 leaves no friction.
        let (problem, _) = feet([0.0; 2], vec![1e-3, 7e-3, -1e-3, 0.0]);
        let mut program = CoulombProgram::new(&problem, Mat::zeros(4, 0).as_ref()).unwrap();
        let found = program.solve(&[], &[0.0; 2], 1e-11).unwrap();
        assert!(
            close(&found.reaction, &[-500.0, 0.0, 0.0, 0.0], 1e-4),
            "{found:?}"
        );
        assert!(CoulombProgram::new(&problem, Mat::zeros(3, 0).as_ref()).is_none());
    }
}
