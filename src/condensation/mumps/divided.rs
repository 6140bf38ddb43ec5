//! The factor of a body divided among ranks, from rank 0.
//!
//! ```text
//!        ordinary  seen
//!       [  K'       Bᵀ  ]      Schur complement of the last rows: −G
//!       [  B        0   ]      f reduced onto them: −v̂;  expanded from −t: u = K'⁻¹ (f + Bᵀ t)
//! ```
//!
//! The border of (C17), whatever the contacts see; K' is the sum of what the ranks assemble. MUMPS says nothing of
//! a matrix that is singular but for round-off, and counts negative pivots of an indefinite one: a probe tells.
//! Solved for a load without equilibrium, a body that can move without force leaves much of the load, a sound one
//! ε times its condition of it.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use faer::Mat;
use sprs::CsMat;

use super::entries::Entries;
use super::factorisation::{RankMemory, factorise, words};
use super::ranks::{Request, with};
use super::{World, mark};
use crate::body::Body;
use crate::condensation::columns::BorderRow;
use crate::condensation::ordering::Ordering;

/// Part of the probe's load that is left at most where the body cannot move without force.
const SINGULAR: f64 = 1e-2;

/// Why nothing is done outside of an MPI run.
const ALONE: &str = "an engine without ranks: none are joined, or they have left,";

/// Ways to solve, as ICNTL(26) numbers them.
#[derive(Clone, Copy)]
enum Way {
    Plainly,
    Reduce,
    Expand,
}

/// Why there is no factor.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Refusal {
    /// A motion without force, most at a degree of freedom.
    Moves {
        /// Degree of freedom that moves most.
        dof: usize,
        /// What resists it there, and the diagonal entry of K', in N/m.
        resistance: f64,
        diagonal: f64,
    },
    /// More unknowns than MUMPS counts.
    TooLarge,
    /// What MUMPS or a rank says.
    Says(String),
}

/// A body to be factorised.
pub(crate) struct Whole<'a> {
    /// As every rank has it.
    pub(crate) body: &'a Body,
    /// Its number in the scene.
    pub(crate) index: usize,
    /// K', grounded.
    pub(crate) stiffness: &'a CsMat<f64>,
    /// Degrees of freedom whose diagonal has a spring in it, as stiff as the rest (C12).
    pub(crate) springs: &'a [usize],
    pub(crate) ordering: &'a Ordering,
    pub(crate) border: &'a [BorderRow],
}

/// A factor whose parts the ranks hold.
#[derive(Debug)]
pub(crate) struct Divided {
    /// The instance; none where no displacement is unknown.
    number: Option<usize>,
    border: usize,
    entries: usize,
    seconds: f64,
    memory: Vec<RankMemory>,
    compliance: Mat<f64>,
    /// Why a solve failed.
    failure: Mutex<Option<String>>,
}

impl Divided {
    /// Factorises, and forms G of (C17) in m/N.
    pub(crate) fn new(whole: &Whole<'_>) -> Result<Self, Refusal> {
        let start = Instant::now();
        let border = whole.border.len();
        let size = whole.ordering.unknowns() + border;
        let fits = i32::try_from(size).is_ok() && i32::try_from(whole.stiffness.rows()).is_ok();
        if !fits {
            return Err(Refusal::TooLarge);
        }
        if size == 0 {
            return Ok(Self::default());
        }
        let mut complement = vec![0.0; border * border];
        let done = with(|world| {
            let [high, low] = mark(whole.body);
            let unknowns = whole.ordering.unknowns() as i32;
            let of = [whole.index as i32, unknowns, border as i32, high, low];
            Request::Factorise(of).ask(world);
            let mut dof: Vec<i32> = whole.ordering.dof.iter().map(|&dof| dof as i32).collect();
            world.tell(&mut dof);
            let part = whole.part(world.count());
            let factorised = factorise(world, part, (size, border), &mut complement)?;
            let number = factorised.number;
            let positive = world.said(number, 12) == 0 && !factorised.singular;
            let entries = counted(world.said(number, 29));
            Ok((factorised, positive, entries))
        });
        let (factorised, positive, entries) = done
            .unwrap_or_else(|| Err(ALONE.to_owned()))
            .map_err(Refusal::Says)?;
        let factor = Self {
            number: Some(factorised.number),
            border,
            entries,
            seconds: start.elapsed().as_secs_f64(),
            memory: factorised.memory,
            compliance: compliance(&complement, border),
            failure: Mutex::new(None),
        };
        factor.probe(whole, positive)?;
        Ok(factor)
    }

    /// Stored entries of L.
    pub(crate) fn entries(&self) -> usize {
        self.entries
    }

    /// Number of rows of the border.
    pub(crate) fn contact_unknowns(&self) -> usize {
        self.border
    }

    /// Wall time of assembly, analysis and factorisation, in second.
    pub(crate) fn numeric_seconds(&self) -> f64 {
        self.seconds
    }

    /// G of (C17) in m/N, given away.
    pub(crate) fn take_compliance(&mut self) -> Mat<f64> {
        std::mem::replace(&mut self.compliance, Mat::new())
    }

    /// Per rank.
    pub(crate) fn memory(&self) -> &[RankMemory] {
        &self.memory
    }

    /// Why a solve failed, if one did: what it gave is not a number.
    pub(crate) fn failure(&self) -> Option<String> {
        let failure = self.failure.lock();
        failure.unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// v̂ of (C17) in metre, of a force in newton.
    pub(crate) fn free_displacement(&self, force: &[f64]) -> Vec<f64> {
        let mut reduced = vec![0.0; self.border];
        if self.border > 0 {
            let mut x = self.bordered(force);
            let ask = |ranks: &mut Asked<'_>| ranks.solve(Way::Reduce, &mut x, &mut reduced);
            if !self.done(ask) {
                reduced.fill(f64::NAN);
            }
        }
        reduced.iter().map(|u| -u).collect()
    }

    /// Displacement under a force per unknown and one per row of the border, in metre.
    pub(crate) fn displacement_under(&self, force: &[f64], forces: &[f64]) -> Vec<f64> {
        let mut x = self.bordered(force);
        // What reduces is what expands: nobody comes in between.
        let done = self.done(|ranks| {
            if self.border == 0 {
                return ranks.solve(Way::Plainly, &mut x, &mut []);
            }
            let mut reduced = vec![0.0; self.border];
            ranks.solve(Way::Reduce, &mut x.clone(), &mut reduced)?;
            for (reduced, force) in reduced.iter_mut().zip(forces) {
                *reduced = -force;
            }
            ranks.solve(Way::Expand, &mut x, &mut reduced)
        });
        if !done {
            x.fill(f64::NAN);
        }
        x.truncate(force.len());
        x
    }

    fn bordered(&self, force: &[f64]) -> Vec<f64> {
        let mut bordered = force.to_vec();
        bordered.resize(force.len() + self.border, 0.0);
        bordered
    }

    /// Whether the ranks did some work; if not, why is kept.
    fn done(&self, work: impl FnOnce(&mut Asked<'_>) -> Result<(), String>) -> bool {
        let Some(number) = self.number else {
            return true;
        };
        let done = with(|world| work(&mut Asked { world, number }));
        let Err(reason) = done.unwrap_or_else(|| Err(ALONE.to_owned())) else {
            return true;
        };
        *self.failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(reason);
        false
    }

    /// Refuses a body that moves without force, or against it: solved for some load, and for the motion that this
    /// made as the next, which is the softest that there is.
    fn probe(&self, whole: &Whole<'_>, positive: bool) -> Result<(), Refusal> {
        let ordering = whole.ordering;
        let some = |at: usize| ((at * 104_729 + 7) % 1009) as f64 / 504.5 - 1.0;
        let some: Vec<f64> = (0..ordering.unknowns()).map(some).collect();
        let none = vec![0.0; self.border];
        let mut load = self.displacement_under(&some, &none);
        let largest = load.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        load.iter_mut().for_each(|u| *u /= largest);
        let moved = self.displacement_under(&load, &none);
        if let Some(reason) = self.failure() {
            return Err(Refusal::Says(reason));
        }
        let forces = whole.forces(&moved);
        let rest = load.iter().zip(&forces).map(|(f, k)| (f - k).powi(2));
        let all: f64 = load.iter().map(|f| f.powi(2)).sum();
        let left = f64::sqrt(rest.sum::<f64>() / all);
        // A NaN is no sound body.
        if positive && left <= SINGULAR {
            return Ok(());
        }
        let further = |a: &usize, b: &usize| moved[*a].abs().total_cmp(&moved[*b].abs());
        let most = (0..moved.len()).max_by(further).unwrap_or_default();
        let work: f64 = forces.iter().zip(&moved).map(|(f, u)| f * u).sum();
        Err(Refusal::Moves {
            dof: ordering.dof[most],
            resistance: work / moved[most].powi(2),
            diagonal: whole.diagonal(ordering.dof[most]),
        })
    }
}

impl Default for Divided {
    fn default() -> Self {
        Self {
            number: None,
            border: 0,
            entries: 0,
            seconds: 0.0,
            memory: Vec::new(),
            compliance: Mat::new(),
            failure: Mutex::new(None),
        }
    }
}

impl Drop for Divided {
    fn drop(&mut self) {
        let Some(number) = self.number else {
            return;
        };
        with(|world| {
            Request::Free(number as i32).ask(world);
            world.free(number);
        });
    }
}

/// The ranks, asked about one instance.
struct Asked<'a> {
    world: &'a mut World,
    number: usize,
}

impl Asked<'_> {
    fn solve(&mut self, way: Way, force: &mut [f64], reduced: &mut [f64]) -> Result<(), String> {
        let (number, way) = (self.number, way as i32);
        Request::Solve([number as i32, way]).ask(self.world);
        match self.world.solve(number, way, force, reduced) {
            0.. => Ok(()),
            code => Err(words(self.world, number, code)),
        }
    }
}

impl Whole<'_> {
    /// The entries of rank 0: its cells, the springs, the border.
    fn part(&self, ranks: usize) -> Result<Entries, String> {
        let mut part = match ranks {
            // The whole has its springs in it.
            1 => Entries::of(self.stiffness, self.ordering),
            _ => {
                let part = Entries::of_cells(self.body, (0, ranks), self.ordering);
                let mut part = part.map_err(|error| error.to_string())?;
                for &dof in self.springs {
                    part.spring(self.ordering.position[dof], 0.5 * self.diagonal(dof));
                }
                part
            }
        };
        part.border(self.ordering, self.border);
        Ok(part)
    }

    /// `K' u`, both in the order of elimination.
    fn forces(&self, moved: &[f64]) -> Vec<f64> {
        let mut displacement = vec![0.0; self.stiffness.rows()];
        for (&dof, u) in self.ordering.dof.iter().zip(moved) {
            displacement[dof] = *u;
        }
        let force = |&dof: &usize| -> f64 {
            let row = self.stiffness.outer_view(dof);
            let terms = row.iter().flat_map(|row| row.iter());
            terms.map(|(other, k)| k * displacement[other]).sum()
        };
        self.ordering.dof.iter().map(force).collect()
    }

    fn diagonal(&self, dof: usize) -> f64 {
        self.stiffness.get(dof, dof).copied().unwrap_or_default()
    }
}

/// G from −G, given as its lower triangle by rows; both triangles are filled.
fn compliance(complement: &[f64], size: usize) -> Mat<f64> {
    Mat::from_fn(size, size, |i, j| -complement[i.max(j) * size + i.min(j)])
}

/// A number that MUMPS gives in millions where it is large.
fn counted(number: i32) -> usize {
    match number {
        0.. => number as usize,
        millions => 1_000_000 * millions.unsigned_abs() as usize,
    }
}

#[cfg(all(test, mumps))]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body;
    use crate::body::CellKind;
    use crate::body::tests::samples::distorted;
    use crate::condensation::mumps::Ranks;
    use crate::condensation::ordering::HELD;
    use faer::linalg::solvers::Solve;

    /// The first dofs held, the others in their order.
    fn ordering(size: usize, held: usize) -> Ordering {
        let position = (0..size).map(|dof| dof.checked_sub(held).unwrap_or(HELD));
        Ordering {
            position: position.collect(),
            dof: (held..size).collect(),
            contact_unknowns: 0,
        }
    }

    fn whole<'a>(
        body: &'a Body,
        stiffness: &'a CsMat<f64>,
        ordering: &'a Ordering,
        border: &'a [BorderRow],
    ) -> Whole<'a> {
        Whole {
            body,
            index: 0,
            stiffness,
            springs: &[],
            ordering,
            border,
        }
    }

    fn close(found: &[f64], expected: impl Fn(usize) -> f64) {
        let largest = (0..found.len()).fold(0.0_f64, |most, i| most.max(expected(i).abs()));
        for (i, found) in found.iter().enumerate() {
            assert!((found - expected(i)).abs() <= 1e-12 * largest, "{i}");
        }
    }

    // All in one, for MPI begins once in a process.
    #[test]
    fn a_sound_body_is_right_and_one_that_is_not_is_refused() {
        let ranks = Ranks::join().unwrap();
        let body = distorted(CellKind::Hex8);
        let stiffness = body::stiffness(&body);
        // A line of nodes and one beside it.
        let (size, held) = (stiffness.rows(), 18);
        let held_body = ordering(size, held);
        let rows: [BorderRow; 3] = [
            vec![(20, 1.0)],
            vec![(25, 0.6), (31, -0.4)],
            vec![(20, 0.5), (40, 2.0)],
        ];
        let sound = whole(&body, &stiffness, &held_body, &rows);
        let mut factor = Divided::new(&sound).unwrap();

        let free = size - held;
        let entry = |i, j| stiffness.get(i, j).copied().unwrap_or_default();
        let dense = Mat::from_fn(free, free, |i, j| entry(i + held, j + held)).partial_piv_lu();
        let mut seen = Mat::<f64>::zeros(free, rows.len());
        for (k, row) in rows.iter().enumerate() {
            row.iter().for_each(|&(dof, b)| seen[(dof - held, k)] += b);
        }
        let expected = seen.transpose() * dense.solve(&seen);
        let found = factor.take_compliance();
        for k in 0..rows.len() {
            close(found.col_as_slice(k), |i| expected[(i, k)]);
        }
        let force: Vec<f64> = (0..free).map(|i| (i as f64).sin()).collect();
        let forces = [3.0, -1.0, 0.5];
        let moved = dense.solve(Mat::from_fn(free, 1, |i, _| force[i]));
        let free_displacement = seen.transpose() * &moved;
        close(&factor.free_displacement(&force), |k| {
            free_displacement[(k, 0)]
        });
        let pushed = &moved + dense.solve(&seen * Mat::from_fn(3, 1, |k, _| forces[k]));
        close(&factor.displacement_under(&force, &forces), |i| {
            pushed[(i, 0)]
        });
        let unseen = Divided::new(&whole(&body, &stiffness, &held_body, &[])).unwrap();
        close(&unseen.displacement_under(&force, &[]), |i| moved[(i, 0)]);

        let nothing_held = ordering(size, 0);
        let floating = Divided::new(&whole(&body, &stiffness, &nothing_held, &rows));
        assert!(
            matches!(floating, Err(Refusal::Moves { .. })),
            "{floating:?}"
        );
        let mut turned = stiffness.clone();
        *turned.get_mut(50, 50).unwrap() *= -1.0;
        let indefinite = Divided::new(&whole(&body, &turned, &held_body, &rows));
        assert!(
            matches!(indefinite, Err(Refusal::Moves { .. })),
            "{indefinite:?}"
        );

        drop(ranks);
        assert!(factor.failure().is_none());
        assert!(factor.free_displacement(&force).iter().all(|u| u.is_nan()));
        assert!(factor.failure().unwrap().contains("they have left"));
        let late = Divided::new(&sound);
        assert!(matches!(late, Err(Refusal::Says(_))), "{late:?}");
    }
}
