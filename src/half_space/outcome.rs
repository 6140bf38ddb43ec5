//! The end of a solve: state, certificate, work.

/// How far a state is from the laws, and what it consists of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HalfSpaceCertificate {
    /// Natural map (K1), relative to the reactions.
    pub residual: f64,
    /// Largest relative departure from a given load or force (S10).
    pub resultant_defect: f64,
    /// Departure of the convolution from direct summation (S11).
    pub operator_defect: f64,
    /// Numbers of cells that are open, stick and slip.
    pub open: usize,
    /// Cells in contact inside their disc.
    pub stick: usize,
    /// Cells in contact on the edge of their disc.
    pub slip: usize,
}

/// Whether the judge certified the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HalfSpaceStatus {
    /// The residual is below the tolerance, resultants and operator are right.
    Certified,
    /// The loop gave up: the state is the last.
    NotConverged,
    /// Friction cannot carry the given tangential force: all contacts slip.
    NoEquilibrium,
}

/// Reactions, and the rigid motion of the other side that goes with them.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfSpaceState {
    /// Along the normal (`t_N ≤ 0`), x and y, in N per cell.
    pub reaction: [Vec<f64>; 3],
    /// By how much the other side came closer, in metre.
    pub approach: f64,
    /// By how much it moved along x and y, in metre.
    pub shift: [f64; 2],
}

/// What a solve took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HalfSpaceWork {
    /// Outer iterations on the finest grid.
    pub outer: usize,
    /// Two-dimensional transforms, those of coarser grids by their share of cells; without the judge's.
    pub transforms: f64,
}

impl HalfSpaceWork {
    /// Full applications of `G` that the transforms amount to, six each.
    #[must_use]
    pub fn applications(&self) -> f64 {
        self.transforms / 6.0
    }
}

/// The end of a solve.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfSpaceOutcome {
    /// Whether the judge certified the state.
    pub status: HalfSpaceStatus,
    /// What the judge measured.
    pub certificate: HalfSpaceCertificate,
    /// The reactions.
    pub state: HalfSpaceState,
    /// Gap that is left, in metre per cell.
    pub gap: Vec<f64>,
    /// Slip along x and y since the start of the step, in metre per cell.
    pub slip: [Vec<f64>; 2],
    /// Cells at the border of a grid that is not periodic that press: where the body goes on there, so does
    /// the contact, and pressures near them are wrong.
    pub at_border: usize,
    /// What it took.
    pub work: HalfSpaceWork,
}
