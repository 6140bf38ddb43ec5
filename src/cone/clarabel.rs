//! Convex quadratic programs over cones, in Clarabel.
//!
//! ```text
//! half-steps   min ½ x·P x + q·x    s.t.  x ≤ 0            or    ‖x_i‖ ≤ b_i  for every disc i
//! whole cones  min ½ x·P x + q·x    s.t.  A x + s = b,  s ∈ {0} × R₊ × second-order cones
//! ```
//!
//! Numbers are scaled to order one before Clarabel sees them. [`ConeProgram`] does it itself:
//! each variable (each disc as a whole, so that it stays a disc) by the root of its diagonal
//! of P, and the whole by the largest entry of q. Who poses a [`ConicProgram`] has scaled it.
//! Tolerances then mean the same in all units.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT,
    SecondOrderConeT, SupportedConeT, ZeroConeT,
};
use faer::MatRef;

/// A program whose matrix and cones are set up, to be solved for many `q` and `b`.
pub(crate) struct ConeProgram {
    solver: DefaultSolver<f64>,
    /// Variable `x` in units of the caller is `scale · σ` times Clarabel's.
    scale: Vec<f64>,
    /// First variable of each disc, and their number at the end; empty without discs.
    discs: Vec<usize>,
}

/// What a solve of a cone program left.
pub(crate) struct ConeSolution {
    pub(crate) x: Vec<f64>,
    pub(crate) iterations: usize,
}

impl ConeProgram {
    /// `x ≤ 0` where `bounded`, one number per row of `quadratic` (dense symmetric; the upper triangle is read).
    pub(crate) fn nonpositive(quadratic: MatRef<'_, f64>, bounded: &[bool]) -> Option<Self> {
        let size = quadratic.nrows();
        let scale = (0..size).map(|i| inverse_root(quadratic[(i, i)])).collect();
        let mut columns = Columns::new();
        let mut height = 0;
        for &bounded in bounded {
            if bounded {
                columns.push(height, 1.0);
                height += 1;
            }
            columns.end_column();
        }
        let cones = [NonnegativeConeT(height)];
        Self::set_up(quadratic, scale, columns.matrix(height), &cones, Vec::new())
    }

    /// Discs of the given dimensions (1 or 2), variables one disc after the other; those that are not `bounded`
    /// have no edge.
    pub(crate) fn discs(
        quadratic: MatRef<'_, f64>,
        dimensions: &[usize],
        bounded: &[bool],
    ) -> Option<Self> {
        let mut starts = vec![0];
        let mut scale = Vec::new();
        for &dimension in dimensions {
            let start = starts[starts.len() - 1];
            let trace: f64 = (start..start + dimension).map(|i| quadratic[(i, i)]).sum();
            scale.extend(std::iter::repeat_n(
                inverse_root(trace / dimension as f64),
                dimension,
            ));
            starts.push(start + dimension);
        }
        let edges = dimensions
            .iter()
            .zip(bounded)
            .filter(|(_, bounded)| **bounded);
        let cones: Vec<_> = edges.map(|(d, _)| SecondOrderConeT(d + 1)).collect();
        let rows = disc_rows(dimensions, bounded);
        Self::set_up(quadratic, scale, rows, &cones, starts)
    }

    fn set_up(
        quadratic: MatRef<'_, f64>,
        scale: Vec<f64>,
        rows: CscMatrix<f64>,
        cones: &[SupportedConeT<f64>],
        discs: Vec<usize>,
    ) -> Option<Self> {
        let hessian = scaled_upper_triangle(quadratic, &scale);
        let (q, b) = (vec![0.0; scale.len()], vec![0.0; rows.m]);
        let settings = settings(INITIAL_TOLERANCE)?;
        let solver = DefaultSolver::new(&hessian, &q, &rows, &b, cones, settings).ok()?;
        Some(Self {
            solver,
            scale,
            discs,
        })
    }

    /// Solves for `linear` (q) and, with discs, `bounds` (b > 0); `None` if Clarabel refuses the numbers or
    /// the minimiser has none.
    ///
    /// An inexact answer is an answer: whoever calls judges it by the laws of contact.
    pub(crate) fn solve(
        &mut self,
        linear: &[f64],
        bounds: &[f64],
        tolerance: f64,
    ) -> Option<ConeSolution> {
        let scaled: Vec<f64> = linear.iter().zip(&self.scale).map(|(q, d)| q * d).collect();
        let largest = scaled
            .iter()
            .fold(0.0_f64, |largest, q| largest.max(q.abs()));
        let sigma = if largest > 0.0 { largest } else { 1.0 };
        let q: Vec<f64> = scaled.iter().map(|q| q / sigma).collect();
        self.solver.update_settings(settings(tolerance)?).ok()?;
        self.solver.update_q(&q).ok()?;
        if !self.discs.is_empty() {
            self.solver
                .update_b(&self.disc_bounds(bounds, sigma))
                .ok()?;
        }
        self.solver.solve();
        let solution = &self.solver.solution;
        let scaled = solution.x.iter().zip(&self.scale);
        let x: Vec<f64> = scaled.map(|(x, d)| x * d * sigma).collect();
        if x.iter().any(|x| !x.is_finite()) {
            return None;
        }
        Some(ConeSolution {
            x,
            iterations: solution.iterations as usize,
        })
    }

    /// Right-hand side: the bound first, then zeros for the disc's variables; nothing for a disc without edge.
    fn disc_bounds(&self, bounds: &[f64], sigma: f64) -> Vec<f64> {
        let mut b = Vec::with_capacity(bounds.len() + self.scale.len());
        let discs = self.discs.windows(2).zip(bounds);
        for (disc, bound) in discs.filter(|(_, bound)| bound.is_finite()) {
            b.push(bound / (self.scale[disc[0]] * sigma));
            b.resize(b.len() + disc[1] - disc[0], 0.0);
        }
        b
    }
}

/// The cones of `s`, in the order of the rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct ConeSizes {
    /// Rows where `s = 0`.
    pub(crate) zero: usize,
    /// Rows where `s ≥ 0`.
    pub(crate) nonnegative: usize,
    /// Dimensions of second-order cones, `s_0 ≥ ‖(s_1, …)‖`.
    pub(crate) second_order: Vec<usize>,
}

/// A sparse matrix that is written column by column, rows in ascending order.
#[derive(Clone, Debug)]
pub(crate) struct Columns {
    ends: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl Columns {
    pub(crate) fn new() -> Self {
        let (rows, values) = (Vec::new(), Vec::new());
        let ends = vec![0];
        Self { ends, rows, values }
    }

    /// An entry of the column at hand; zeros are not stored.
    pub(crate) fn push(&mut self, row: usize, value: f64) {
        if value != 0.0 {
            self.rows.push(row);
            self.values.push(value);
        }
    }

    pub(crate) fn end_column(&mut self) {
        self.ends.push(self.values.len());
    }

    fn matrix(self, height: usize) -> CscMatrix<f64> {
        CscMatrix::new(
            height,
            self.ends.len() - 1,
            self.ends,
            self.rows,
            self.values,
        )
    }
}

/// `min ½ x·P x + q·x  s.t.  A x + s = b` over whole cones, set up for many `q` and `b`.
pub(crate) struct ConicProgram {
    solver: DefaultSolver<f64>,
}

/// What a solve over whole cones left.
pub(crate) struct ConicSolution {
    pub(crate) x: Vec<f64>,
    /// One per row, in the dual cones: `P x + q + Aᵀ z = 0`.
    pub(crate) multipliers: Vec<f64>,
    pub(crate) iterations: usize,
}

impl ConicProgram {
    /// Sets up P (dense symmetric, the upper triangle is read), A and the cones.
    pub(crate) fn new(
        quadratic: MatRef<'_, f64>,
        columns: Columns,
        cones: &ConeSizes,
    ) -> Option<Self> {
        let size = columns.ends.len() - 1;
        let height = cones.zero + cones.nonnegative + cones.second_order.iter().sum::<usize>();
        let hessian = scaled_upper_triangle(quadratic, &vec![1.0; size]);
        let mut kinds = Vec::with_capacity(2 + cones.second_order.len());
        if cones.zero > 0 {
            kinds.push(ZeroConeT(cones.zero));
        }
        if cones.nonnegative > 0 {
            kinds.push(NonnegativeConeT(cones.nonnegative));
        }
        kinds.extend(cones.second_order.iter().map(|&d| SecondOrderConeT(d)));
        let matrix = columns.matrix(height);
        let (q, b) = (vec![0.0; size], vec![0.0; height]);
        let settings = settings(INITIAL_TOLERANCE)?;
        let solver = DefaultSolver::new(&hessian, &q, &matrix, &b, &kinds, settings).ok()?;
        Some(Self { solver })
    }

    /// Solves for `linear` (q) and `right` (b); `None` if Clarabel refuses the numbers.
    ///
    /// Whatever status Clarabel ends with: whoever calls judges the numbers.
    pub(crate) fn solve(
        &mut self,
        linear: &[f64],
        right: &[f64],
        tolerance: f64,
    ) -> Option<ConicSolution> {
        self.solver.update_settings(settings(tolerance)?).ok()?;
        self.solver.update_q(&linear.to_vec()).ok()?;
        self.solver.update_b(&right.to_vec()).ok()?;
        self.solver.solve();
        let solution = &self.solver.solution;
        let mut numbers = solution.x.iter().chain(&solution.z);
        if numbers.any(|number| !number.is_finite()) {
            return None;
        }
        Some(ConicSolution {
            x: solution.x.clone(),
            multipliers: solution.z.clone(),
            iterations: solution.iterations as usize,
        })
    }
}

/// Tolerance while a program is set up; every solve brings its own.
const INITIAL_TOLERANCE: f64 = 1e-8;

/// Parts into which the work on a program is divided: the same on any number of threads, because
/// every division rounds in its own way.
const PARTS: u32 = 4;

fn settings(tolerance: f64) -> Option<DefaultSettings<f64>> {
    DefaultSettingsBuilder::default()
        .verbose(false)
        .presolve_enable(false)
        .equilibrate_enable(false)
        .max_threads(PARTS)
        .direct_solve_method("faer".to_owned())
        .tol_gap_abs(tolerance)
        .tol_gap_rel(tolerance)
        .tol_feas(tolerance)
        .build()
        .ok()
}

fn inverse_root(diagonal: f64) -> f64 {
    if diagonal > 0.0 {
        diagonal.sqrt().recip()
    } else {
        1.0
    }
}

/// Upper triangle of `D P D`, column by column. Zeros are not stored, but for the diagonal: few rigid bodies touch
/// each other.
fn scaled_upper_triangle(quadratic: MatRef<'_, f64>, scale: &[f64]) -> CscMatrix<f64> {
    let mut columns = Columns::new();
    for (j, by) in scale.iter().enumerate() {
        for i in 0..j {
            columns.push(i, scale[i] * quadratic[(i, j)] * by);
        }
        columns.rows.push(j);
        columns.values.push(by * quadratic[(j, j)] * by);
        columns.end_column();
    }
    columns.matrix(scale.len())
}

/// `A` of `A x + s = b` with `s = (b, x)` per bounded disc: −1 on the rows of x.
fn disc_rows(dimensions: &[usize], bounded: &[bool]) -> CscMatrix<f64> {
    let mut columns = Columns::new();
    let mut next = 0;
    for (&dimension, &bounded) in dimensions.iter().zip(bounded) {
        for k in 1..=dimension {
            if bounded {
                columns.push(next + k, -1.0);
            }
            columns.end_column();
        }
        next += if bounded { dimension + 1 } else { 0 };
    }
    columns.matrix(next)
}
