//! A half-step's program on its working set.
//!
//! A contact that is predicted open has no variable, one predicted firmly pressed or
//! stuck has no cone and is eliminated, the others keep their cones. A wrong
//! prediction costs time, never the answer: each half-step checks all contacts and
//! gives whoever breaks its prediction the cone back.

use std::ops::Range;

use faer::MatRef;

use super::clarabel::ConeProgram;
use super::elimination::{Elimination, gather};
use crate::problem::ContactProblem;

/// A contact's place in the program of a half-step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// No variable: its reaction is zero.
    Absent,
    /// A variable without a cone: firmly pressed, or firmly stuck.
    Free,
    /// A variable in its cone.
    Cone,
}

/// What a half-step took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HalfStepWork {
    /// Programs handed to the cone solver.
    pub programs: usize,
    /// Interior-point iterations over these.
    pub iterations: usize,
    /// Largest number of contacts that had a cone.
    pub cones: usize,
}

/// The half of each contact's unknowns that a half-step moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Half {
    /// `x ≤ 0`, where not bilateral.
    Normal,
    /// `‖x‖ ≤` bound, where that is finite.
    Tangential,
}

/// The program of a half-step; a working set that stays the same is set up once.
pub(super) struct WorkingSet<'a> {
    problem: &'a ContactProblem,
    half: Half,
    held: Option<(Vec<Role>, ReducedProgram)>,
}

impl<'a> WorkingSet<'a> {
    /// Nothing is set up before the first minimisation.
    pub(super) fn new(problem: &'a ContactProblem, half: Half) -> Self {
        Self {
            problem,
            half,
            held: None,
        }
    }

    /// The next minimisation sets up its own program.
    pub(super) fn forget(&mut self) {
        self.held = None;
    }

    /// The unknowns of a contact that the half-step moves.
    pub(super) fn unknowns(&self, contact: usize) -> Range<usize> {
        let Range { start, end } = self.problem.block(contact);
        match self.half {
            Half::Normal => start..start + 1,
            Half::Tangential => start + 1..end,
        }
    }

    /// The minimiser of `½ x·G x + q·x` over the contacts as their roles have it; all other unknowns are zero.
    ///
    /// `linear` is q for every unknown, `bounds` the radius of every contact's disc (not read for the normal half).
    /// Where G is singular on the free contacts they get their cones.
    pub(super) fn minimise(
        &mut self,
        linear: &[f64],
        bounds: &[f64],
        roles: &mut [Role],
        tolerance: f64,
        work: &mut HalfStepWork,
    ) -> Option<Vec<f64>> {
        if self.held.as_ref().is_none_or(|(held, _)| held != roles) {
            let program = self.set_up(roles)?;
            self.held = Some((roles.to_vec(), program));
        }
        let (_, program) = self.held.as_mut()?;
        let cone = with_role(roles, Role::Cone);
        let radii: Vec<f64> = match self.half {
            Half::Normal => Vec::new(),
            Half::Tangential => cone.iter().map(|&contact| bounds[contact]).collect(),
        };
        let mut x = vec![0.0; linear.len()];
        work.iterations += program.minimise(linear, &radii, tolerance, &mut x)?;
        work.programs += usize::from(program.program.is_some());
        work.cones = work.cones.max(cone.len());
        Some(x)
    }

    fn set_up(&self, roles: &mut [Role]) -> Option<ReducedProgram> {
        self.program(roles).or_else(|| {
            for role in roles.iter_mut().filter(|role| **role == Role::Free) {
                *role = Role::Cone;
            }
            self.program(roles)
        })
    }

    /// Whether anything bounds a contact's half of the reactions.
    fn is_bounded(&self, contact: usize) -> bool {
        match self.half {
            Half::Normal => !self.problem.is_bilateral(contact),
            Half::Tangential => !self.problem.sticks(contact),
        }
    }

    /// `None` if G is singular on the free unknowns.
    fn program(&self, roles: &[Role]) -> Option<ReducedProgram> {
        let (free, cone) = (with_role(roles, Role::Free), with_role(roles, Role::Cone));
        let unknowns = |contacts: &[usize]| -> Vec<usize> {
            let each = contacts.iter().flat_map(|&contact| self.unknowns(contact));
            each.collect()
        };
        let form = self.problem.compliance().as_ref();
        ReducedProgram::new(form, unknowns(&free), unknowns(&cone), |quadratic| {
            let bounded = cone.iter().map(|&contact| self.is_bounded(contact));
            let bounded: Vec<bool> = bounded.collect();
            match self.half {
                Half::Normal => ConeProgram::nonpositive(quadratic, &bounded),
                Half::Tangential => {
                    let sizes = cone.iter().map(|&contact| self.unknowns(contact).len());
                    ConeProgram::discs(quadratic, &sizes.collect::<Vec<_>>(), &bounded)
                }
            }
        })
    }
}

/// Contacts with a role.
fn with_role(roles: &[Role], role: Role) -> Vec<usize> {
    (0..roles.len())
        .filter(|&contact| roles[contact] == role)
        .collect()
}

/// `min ½ x·P x + q·x` over the unknowns of a working set; all other unknowns are zero.
struct ReducedProgram {
    free: Vec<usize>,
    cone: Vec<usize>,
    elimination: Option<Elimination>,
    program: Option<ConeProgram>,
}

impl ReducedProgram {
    /// Splits off the free unknowns and hands the form of the others to `cones`; `None` if the form is
    /// singular on the free unknowns.
    fn new(
        form: MatRef<'_, f64>,
        free: Vec<usize>,
        cone: Vec<usize>,
        cones: impl Fn(MatRef<'_, f64>) -> Option<ConeProgram>,
    ) -> Option<Self> {
        let elimination = if free.is_empty() {
            None
        } else {
            Some(Elimination::new(form, &free, &cone)?)
        };
        let program = match &elimination {
            _ if cone.is_empty() => None,
            Some(elimination) => Some(cones(elimination.reduced.as_ref())?),
            None => Some(cones(gather(form, &cone, &cone).as_ref())?),
        };
        Some(Self {
            free,
            cone,
            elimination,
            program,
        })
    }

    /// Writes the minimiser into `x` at the working set's unknowns and returns the iterations.
    ///
    /// `linear` is q for every unknown of the form, `bounds` one number per disc.
    fn minimise(
        &mut self,
        linear: &[f64],
        bounds: &[f64],
        tolerance: f64,
        x: &mut [f64],
    ) -> Option<usize> {
        let mut cone_linear: Vec<f64> = self.cone.iter().map(|&i| linear[i]).collect();
        let mut free_part = None;
        if let Some(elimination) = &self.elimination {
            let free_linear: Vec<f64> = self.free.iter().map(|&i| linear[i]).collect();
            let (y, reduced) = elimination.reduce(&free_linear, &cone_linear);
            cone_linear = reduced;
            free_part = Some((elimination, y));
        }
        let (mut cone_x, mut iterations) = (Vec::new(), 0);
        if let Some(program) = &mut self.program {
            let solution = program.solve(&cone_linear, bounds, tolerance)?;
            (cone_x, iterations) = (solution.x, solution.iterations);
        }
        for (&unknown, &value) in self.cone.iter().zip(&cone_x) {
            x[unknown] = value;
        }
        if let Some((elimination, y)) = free_part {
            for (&unknown, value) in self.free.iter().zip(elimination.recover(&y, &cone_x)) {
                x[unknown] = value;
            }
        }
        Some(iterations)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::problem::Operator;
    use faer::mat;

    #[test]
    fn free_contacts_get_their_cones_where_they_cannot_be_told_apart() {
        // Two contacts on one spot, G = [[1, 1], [1, 1]]: only the sum of their reactions is determined, −2.
        let operator = Operator::from_compliance(mat![[1.0, 1.0], [1.0, 1.0]]).unwrap();
        let (zero, free) = (vec![0.0; 2], vec![2.0; 2]);
        let problem =
            ContactProblem::new(&[0, 0], zero.clone(), zero, free.clone(), operator).unwrap();
        let mut set = WorkingSet::new(&problem, Half::Normal);
        let (mut roles, mut work) = ([Role::Free; 2], HalfStepWork::default());
        let x = set
            .minimise(&free, &[], &mut roles, 1e-10, &mut work)
            .unwrap();
        // The sum is strictly pressed: its error is of the order of the gap, 1e-10.
        assert!((x[0] + x[1] + 2.0).abs() < 1e-8, "{x:?}");
        assert_eq!((roles, work.programs, work.cones), ([Role::Cone; 2], 1, 2));
    }
}
