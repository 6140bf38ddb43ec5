//! CONE PROGRAMS: the two half-steps.
//!
//! ```text
//! (H1)  normal:    min ½ s_N·G_NN s_N + s_N·(û_N + G_NT t_T − g₀)    s.t.  s_N ≤ 0
//! (H2)  friction:  min ½ s_T·G_TT s_T + s_T·(û_T + G_TN t_N)         s.t.  ‖s_T,i‖ ≤ −μ_i t_N,i
//! ```
//!
//! (H1) finds the normal reactions while friction is held, (H2) friction while the
//! normal reactions are held (Bisegna, Lebon, Maceri, C. R. Acad. Sci. Paris I 333
//! (2001) 1053–1058). Clarabel solves both on working sets.

#[cfg(test)]
mod blocks;
mod clarabel;
mod cone_projection;
mod coulomb;
mod elimination;
mod equilibrium;
mod failure;
mod friction;
mod generators;
mod least_friction;
mod limit;
mod normal;
mod reduced;
mod rigid_contacts;
mod separation;
mod velocity_basis;

pub use coulomb::{CoulombProgram, CoulombSolution};
pub use equilibrium::Equilibrium;
pub use failure::Failure;
pub use friction::FrictionHalfStep;
pub use least_friction::LeastFriction;
pub use limit::Limit;
pub use normal::NormalHalfStep;
pub use reduced::{HalfStepWork, Role};
pub use rigid_contacts::RigidContacts;
