//! CONE PROGRAMS: what contact forces may do, held against what they have to.
//!
//! ```text
//! K = { t_N ≤ 0, ‖t_T‖ ≤ −μ t_N }   admissible reactions        K* = { v_N + μ ‖v_T‖ ≤ 0 }   what none of them works against
//!
//! the half-steps of the outer loop, with the other half of the reactions held
//! (H1)  normal         min ½ s_N·G_NN s_N + s_N·(û_N + G_NT t_T − g₀)   s.t.  s_N ≤ 0                       normal.rs
//! (H2)  friction       min ½ s_T·G_TT s_T + s_T·(û_T + G_TN t_N)        s.t.  ‖s_T,i‖ ≤ −μ_i t_N,i          friction.rs
//!
//! all reactions at once, and bodies that contact alone holds (rigid motions R, load e on them)
//! (H3)  cones          K = T (cones of a program)                                                           generators.rs
//! (H4)  equilibrium    Rᵀ t + e = 0,  t ∈ K                                                                 rigid_contacts.rs
//! (H5)  distance       min ½ ‖Qᵀ t + e‖²   s.t.  t ∈ K                   is zero, or proves that (H4) fails  separation.rs
//! (H6)  limit          max λ   s.t.  (H4) for e + λ g                                                       limit.rs
//! (H7)  least friction min k   s.t.  (H4) for k μ                                                           least_friction.rs
//! (H8)  Coulomb        min ½ t·G t + t_N·(û_N − g₀ − μ s) + t_T·û_T      s.t.  (H4)                         coulomb.rs
//! (H9)  failure        min ‖R (α' − α)‖   s.t.  sliding contacts stay closed                                failure.rs
//! ```
//!
//! (H1) finds the normal reactions while friction is held, (H2) friction while the normal reactions are held
//! (Bisegna, Lebon, Maceri, C. R. Acad. Sci. Paris I 333 (2001) 1053–1058), on working sets (reduced.rs,
//! elimination.rs). (H8) with the slip `s` of its own minimiser is Coulomb's law. Clarabel solves (H1), (H2) and (H8)
//! (clarabel.rs); (H5) is solved by proximal Newton steps on the projection onto K (cone_projection.rs), in
//! unit-free velocities Q of the rigid motions (velocity_basis.rs), and (H6), (H7) by asking (H5) again. equilibrium.rs
//! says what counts as zero.

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
