//! HALF-SPACE: a contact per cell of a grid, without a matrix.
//!
//! Where bodies are large beside their contact, each is a half-space, and its compliance a convolution.
//! The laws, the signs and the words are those of the condensed problem; normal first:
//!
//! ```text
//! (S1)  u = û + G t,   û = (δ, −U) − u_ref       δ: approach, U: shift of the other side
//!       (L1)–(L3) at every cell                  g = g₀ − u_N ≥ 0, t_N ≤ 0, ‖t_T‖ ≤ −μ t_N
//! (S2)  (G t)_i = Σ_j K(x_i − x_j) t_j           one force per cell, spread evenly over it
//! (S3)–(S6)  kernels K and their symbols         `rectangle`, `symbol`
//! (S7)  normal half-step                         `normal`: conjugate gradients on the pressed set
//! (S8), (S9)  friction half-step                 `friction`: projected Newton steps on the discs
//! (S10), (S11)  resultants, operator             `judge`: by products and direct sums alone
//! (S12) random surfaces                          `rough`
//! (S13) all laws at once                         `finish`: Newton's method with GMRES
//! (S17) strong friction                          `growing`: the coefficient grows to what it is
//! (S18) given force                              `forced`: the shift with the friction half-step
//! (S14) rolling                                  `rolling`
//! (S15) power spectrum                           `spectrum`
//! (S16) stiffness                                `stiffness`
//! ```
//!
//! The half-space fills `z < 0`; n = z points to the other side, a rigid body or a second half-space
//! upside down, and the relative displacement is body 1 minus body 2. What is unknown of the rigid
//! motion, δ under a given load or U under a given force, is found with the reactions. Displacements
//! of a periodic grid have mean zero: nothing else fixes them.
//!
//! A Hertz contact that is pressed and then dragged by half of what friction can carry:
//!
//! ```
//! use std::sync::Arc;
//!
//! use dpana::half_space::{
//!     Drag, ElasticHalf, Grid, HalfSpace, HalfSpaceProblem, HalfSpaceStatus, Press, Surroundings,
//! };
//!
//! # fn main() -> Result<(), dpana::Error> {
//! let steel = ElasticHalf { young: 210e3, poisson: 0.3 }; // MPa, mm, N
//! let grid = Grid::new([48, 48], [0.02, 0.02])?;
//! let operator = Arc::new(HalfSpace::new(grid, Surroundings::Free, steel, None)?);
//! let gap = grid.sample(|[x, y]| (x * x + y * y) / (2.0 * 10.0)); // a sphere of radius 10
//!
//! let problem = HalfSpaceProblem::new(operator, gap, &[0.2], Press::Load(1000.0))?;
//! let outcome = problem.dragged(Drag::Force([100.0, 0.0]))?.solve()?;
//!
//! assert_eq!(outcome.status, HalfSpaceStatus::Certified);
//! assert!((outcome.state.approach / 0.0101841 - 1.0).abs() < 0.01); // Hertz: a²/R
//! # Ok(())
//! # }
//! ```
//!
//! Work does not grow with the grid in outer iterations (some 10), and like its square root in
//! products on rough surfaces. Bits do not depend on the number of threads.

mod clusters;
mod compliance;
mod coupled;
mod finish;
mod forced;
mod friction;
mod gmres;
mod grid;
mod growing;
mod judge;
mod normal;
mod operator;
mod outcome;
mod points;
mod problem;
mod range;
mod rectangle;
mod rolling;
mod rough;
mod run;
mod spectrum;
mod stiffness;
mod sweep;
mod symbol;
mod transform;
mod unknowns;
mod vectors;

pub use clusters::clusters;
pub use compliance::ElasticHalf;
pub use grid::Grid;
pub use operator::{HalfSpace, Surroundings};
pub use outcome::{
    HalfSpaceCertificate, HalfSpaceOutcome, HalfSpaceState, HalfSpaceStatus, HalfSpaceWork,
};
pub use problem::{Drag, HalfSpaceProblem, Press};
#[cfg(feature = "cli")]
pub(crate) use rectangle::Influence;
pub use rolling::Creepage;
pub use rough::SelfAffine;
pub use spectrum::{SpectrumRing, power_spectrum};
