//! The condensed contact problem: plain numbers between mechanics and solver.
//!
//! A load step starts from where the last state left the contacts. Its laws see
//!
//! ```text
//! (C13)  u = û − u_ref + G t      u_ref: slip of the last state in the tangents,
//!                                 motion of a rigid other side along the normal
//! ```
//!
//! and so does everything that solves or judges: to them a step is a problem like any other,
//! whose free displacement is `û − u_ref`. What does not change from step to step is shared.

use std::ops::Range;
use std::sync::Arc;

use faer::Mat;

use super::{Compliance, Floating, Law, Operator};
use crate::error::{Error, check_finite, check_length};

/// Find reactions `t` and displacements `u = û + G t` (C1) that satisfy (L1)–(L3);
/// between bodies that float, `u = û + G t + R α` and `Rᵀ t + e = 0` (C3).
///
/// Contact `i` owns a block of `1 + tangents[i]` unknowns, normal first; blocks stand
/// one after the other. A contact without friction has no tangent. The free
/// displacement is positive towards the other side, reactions are `≤ 0` pressed.
///
/// ```
/// use dpana::alternation::{Settings, solve};
/// use dpana::faer::mat;
/// use dpana::problem::Operator;
/// use dpana::{ContactProblem, Status};
///
/// # fn main() -> Result<(), dpana::Error> {
/// // One contact with one tangent, μ = 1/2: it slips by 0.5 m under −0.25 N of friction.
/// let operator = Operator::from_compliance(mat![[1.0, -1.0], [-1.0, 2.0]])?;
/// let problem = ContactProblem::new(&[1], vec![0.5], vec![0.0], vec![0.25, 0.5], operator)?;
/// let outcome = solve(&problem, &Settings::default())?;
/// assert_eq!(outcome.status, Status::Certified);
/// assert!((outcome.reaction[0] + 0.5).abs() < 1e-12); // t_N
/// assert!((outcome.reaction[1] + 0.25).abs() < 1e-12); // t_T
/// assert!((outcome.verdict.displacement[1] - 0.5).abs() < 1e-12); // u_T
/// # Ok(())
/// # }
/// ```
///
/// [`step`](Self::step) is the same problem under another load, for friction on the slip since a state;
/// it shares the operator, and [`solve_from`](crate::alternation::solve_from) starts it from there.
///
/// The operator may be any [`Compliance`]. What needs entries of a matrix takes a `ContactProblem` as it
/// stands, whose operator is an [`Operator`]; [`dense`](Self::dense) makes one of every other.
#[derive(Debug)]
pub struct ContactProblem<O = Operator> {
    friction: Vec<f64>,
    initial_gap: Vec<f64>,
    /// `û − u_ref` of (C13).
    free_displacement: Vec<f64>,
    reference: Vec<f64>,
    operator: Arc<O>,
    offsets: Vec<usize>,
    /// Contacts that were stated without friction and hold no tangent.
    smooth: Arc<[bool]>,
    floating: Option<Floating>,
    /// Per contact; none where all obey Coulomb's law alone.
    laws: Option<Arc<[Law]>>,
}

impl<O> Clone for ContactProblem<O> {
    fn clone(&self) -> Self {
        self.on_other(self.operator.clone())
    }
}

impl<O> ContactProblem<O> {
    /// The same problem with another operator of its size.
    fn on_other<P>(&self, operator: Arc<P>) -> ContactProblem<P> {
        ContactProblem {
            operator,
            friction: self.friction.clone(),
            initial_gap: self.initial_gap.clone(),
            free_displacement: self.free_displacement.clone(),
            reference: self.reference.clone(),
            offsets: self.offsets.clone(),
            smooth: self.smooth.clone(),
            floating: self.floating.clone(),
            laws: self.laws.clone(),
        }
    }
}

impl ContactProblem {
    /// The same problem with another operator of its size.
    pub(crate) fn with_operator(&self, operator: Operator) -> Self {
        self.on_other(Arc::new(operator))
    }

    /// First unknown of each block of `1 + tangents[i]`, and the number of unknowns at the end.
    pub(crate) fn block_offsets(tangents: &[usize]) -> Result<Vec<usize>, Error> {
        let mut offsets = vec![0];
        for (contact, &count) in tangents.iter().enumerate() {
            if count > 2 {
                return Err(Error::OutOfRange {
                    place: format!("tangents[{contact}]"),
                    value: count as f64,
                    accepted: "0, 1 or 2",
                });
            }
            offsets.push(offsets[contact] + 1 + count);
        }
        Ok(offsets)
    }

    /// Finite and not negative.
    pub(crate) fn check_friction(friction: &[f64]) -> Result<(), Error> {
        check_finite("friction", friction)?;
        match friction.iter().position(|&mu| mu < 0.0) {
            None => Ok(()),
            Some(contact) => Err(Error::OutOfRange {
                place: format!("friction[{contact}]"),
                value: friction[contact],
                accepted: "friction >= 0",
            }),
        }
    }

    /// Compliance G, in m/N.
    #[must_use]
    pub fn compliance(&self) -> &Mat<f64> {
        self.operator.compliance()
    }
}

impl<O: Compliance> ContactProblem<O> {
    /// Checks and joins the parts.
    ///
    /// - `tangents`: tangential unknowns per contact, 0 to 2;
    /// - `friction`: coefficient `μ ≥ 0` per contact;
    /// - `initial_gap`: in metre, per contact;
    /// - `free_displacement`: in metre, per unknown;
    /// - `operator`: compliance in m/N.
    ///
    /// # Errors
    ///
    /// A length that does not fit, a NaN or infinity, a negative coefficient, more than two tangents.
    pub fn new(
        tangents: &[usize],
        friction: Vec<f64>,
        initial_gap: Vec<f64>,
        free_displacement: Vec<f64>,
        operator: O,
    ) -> Result<Self, Error> {
        let operator = Arc::new(operator);
        Self::on(operator, tangents, friction, initial_gap, free_displacement)
    }

    /// The same on an operator that others have too.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn on(
        operator: Arc<O>,
        tangents: &[usize],
        friction: Vec<f64>,
        initial_gap: Vec<f64>,
        free_displacement: Vec<f64>,
    ) -> Result<Self, Error> {
        let contacts = tangents.len();
        check_length("friction", contacts, friction.len())?;
        check_length("initial_gap", contacts, initial_gap.len())?;
        let offsets = <ContactProblem>::block_offsets(tangents)?;
        let unknowns = offsets[contacts];
        check_length("free_displacement", unknowns, free_displacement.len())?;
        check_length("operator", unknowns, operator.size())?;
        <ContactProblem>::check_friction(&friction)?;
        check_finite("initial_gap", &initial_gap)?;
        check_finite("free_displacement", &free_displacement)?;
        let stated = tangents.iter().zip(&friction);
        let smooth = stated.map(|(&tangents, &mu)| tangents == 0 && mu == 0.0);
        let smooth = smooth.collect();
        Ok(Self {
            smooth,
            friction,
            initial_gap,
            free_displacement,
            reference: vec![0.0; unknowns],
            operator,
            offsets,
            floating: None,
            laws: None,
        })
    }

    /// The same contacts under another load: `free_displacement` is û in metre per unknown,
    /// `reference` is u_ref of (C13), in metre per unknown. The operator is shared.
    ///
    /// For a problem that starts from a solved one, the reference is
    /// [`total_displacement`](Self::total_displacement) of its state in the tangents, and zero
    /// along the normals: an open contact is then taken on from where it stands, so that one that
    /// closes again begins a new slip.
    ///
    /// # Errors
    ///
    /// A length that does not fit, a NaN or infinity.
    pub fn step(
        &self,
        mut free_displacement: Vec<f64>,
        reference: Vec<f64>,
    ) -> Result<Self, Error> {
        check_length(
            "free_displacement",
            self.unknowns(),
            free_displacement.len(),
        )?;
        check_length("reference", self.unknowns(), reference.len())?;
        check_finite("free_displacement", &free_displacement)?;
        check_finite("reference", &reference)?;
        for (free, reference) in free_displacement.iter_mut().zip(&reference) {
            *free -= reference;
        }
        Ok(Self {
            free_displacement,
            reference,
            ..self.clone()
        })
    }

    /// The same problem with other coefficients of friction, per contact.
    ///
    /// # Errors
    ///
    /// A length that does not fit, a NaN or infinity, a negative coefficient, friction at a contact that
    /// was stated without any and has no tangent for it.
    pub fn with_friction(&self, friction: Vec<f64>) -> Result<Self, Error> {
        check_length("friction", self.contacts(), friction.len())?;
        <ContactProblem>::check_friction(&friction)?;
        let rough = friction.iter().zip(self.smooth.iter());
        if let Some(contact) = rough.clone().position(|(&mu, &smooth)| smooth && mu > 0.0) {
            return Err(Error::OutOfRange {
                place: format!("friction[{contact}]"),
                value: friction[contact],
                accepted: "0, as this contact was condensed without friction and holds no tangent; \
                           condense it with any friction > 0, and set that to 0 where it is not wanted",
            });
        }
        self.check_laws(&friction)?;
        Ok(Self {
            friction,
            ..self.clone()
        })
    }

    /// The same problem under other laws, whose compliance is not looked at.
    pub(crate) fn under(&self, laws: Option<Arc<[Law]>>) -> Self {
        Self {
            laws,
            ..self.clone()
        }
    }

    /// The same problem with other gaps before loading, in metre per contact.
    ///
    /// # Errors
    ///
    /// A length that does not fit, a NaN or infinity.
    pub fn with_initial_gap(&self, initial_gap: Vec<f64>) -> Result<Self, Error> {
        check_length("initial_gap", self.contacts(), initial_gap.len())?;
        check_finite("initial_gap", &initial_gap)?;
        Ok(Self {
            initial_gap,
            ..self.clone()
        })
    }

    /// The same problem between bodies that their supports do not hold (C3): the free
    /// displacement and the operator are those of bodies grounded in any way.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] if the modes are not of the problem's unknowns.
    pub fn float(self, floating: Floating) -> Result<Self, Error> {
        check_length("floating.modes", self.unknowns(), floating.modes().nrows())?;
        Ok(self.floating_as(Some(floating)))
    }

    /// The same problem with these free modes of its unknowns, or with none.
    pub(crate) fn floating_as(self, floating: Option<Floating>) -> Self {
        Self { floating, ..self }
    }

    /// Number of contacts.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.friction.len()
    }

    /// Number of unknowns over all contacts.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.free_displacement.len()
    }

    /// First unknown of each contact, and the number of unknowns at the end.
    #[must_use]
    pub fn offsets(&self) -> &[usize] {
        &self.offsets
    }

    /// The unknowns of a contact: the normal one first, then its tangents.
    ///
    /// # Panics
    ///
    /// If there is no such contact.
    #[must_use]
    pub fn block(&self, contact: usize) -> Range<usize> {
        self.offsets[contact]..self.offsets[contact + 1]
    }

    /// The unknowns of all contacts, contact by contact.
    pub fn blocks(&self) -> impl ExactSizeIterator<Item = Range<usize>> + '_ {
        (0..self.contacts()).map(|contact| self.block(contact))
    }

    /// The normal unknown of each contact.
    #[must_use]
    pub fn normals(&self) -> &[usize] {
        &self.offsets[..self.contacts()]
    }

    /// `g₀ − u_N` of a contact at a displacement per unknown, in metre: what is left of the distance.
    ///
    /// # Panics
    ///
    /// If there is no such contact, or `displacement` is shorter than the unknowns.
    #[must_use]
    pub fn gap(&self, contact: usize, displacement: &[f64]) -> f64 {
        self.initial_gap[contact] - displacement[self.offsets[contact]]
    }

    /// A displacement per unknown beyond the gaps, `u_N − g₀` and `u_T`, in metre.
    pub(crate) fn beyond(&self, mut displacement: Vec<f64>) -> Vec<f64> {
        for (&n, gap) in self.normals().iter().zip(&self.initial_gap) {
            displacement[n] -= gap;
        }
        displacement
    }

    /// Coefficient of friction per contact.
    #[must_use]
    pub fn friction(&self) -> &[f64] {
        &self.friction
    }

    /// What contacts obey beside Coulomb's law, per contact; none where all obey that alone.
    #[must_use]
    pub fn laws(&self) -> Option<&[Law]> {
        self.laws.as_deref()
    }

    /// Initial gap per contact, in metre.
    #[must_use]
    pub fn initial_gap(&self) -> &[f64] {
        &self.initial_gap
    }

    /// Displacement without contact forces per unknown, from the reference on (C13), in metre.
    #[must_use]
    pub fn free_displacement(&self) -> &[f64] {
        &self.free_displacement
    }

    /// u_ref of (C13) per unknown, in metre; zero where no step came before.
    #[must_use]
    pub fn reference(&self) -> &[f64] {
        &self.reference
    }

    /// Displacement from the start of the history on, in metre per unknown, of one that is
    /// measured from the reference (C13), such as the judge's.
    #[must_use]
    pub fn total_displacement(&self, displacement: &[f64]) -> Vec<f64> {
        let pairs = displacement.iter().zip(&self.reference);
        pairs.map(|(u, reference)| u + reference).collect()
    }

    /// What the supports leave free; none if they hold every body.
    #[must_use]
    pub fn floating(&self) -> Option<&Floating> {
        self.floating.as_ref()
    }

    /// Number of free rigid modes over all bodies.
    #[must_use]
    pub fn free_modes(&self) -> usize {
        self.floating.as_ref().map_or(0, |f| f.load().len())
    }

    /// The operator.
    #[must_use]
    pub fn operator(&self) -> &O {
        &self.operator
    }

    /// The same problem with the entries of its operator, for one application per unknown: up to some
    /// thousand contacts the cone programs can solve it.
    ///
    /// # Errors
    ///
    /// Those of [`Operator::from_compliance`].
    pub fn dense(&self) -> Result<ContactProblem, Error> {
        let operator = Operator::from_products(self.operator())?;
        Ok(self.on_other(Arc::new(operator)))
    }

    /// Displacement `u = û + G t` (C1) for a reaction per unknown, in metre; from the reference
    /// on (C13).
    #[must_use]
    pub fn displacement(&self, reaction: &[f64]) -> Vec<f64> {
        let mut displacement = self.free_displacement.clone();
        self.operator.add_product(reaction, &mut displacement);
        displacement
    }
}
