//! CONE PROGRAMS: what contact forces may do, held against what they have to.
//!
//! ```text
//! K = { t_N ≤ 0, ‖t_T‖ ≤ −μ t_N }   admissible reactions        K* = { v_N + μ ‖v_T‖ ≤ 0 }   what none of them works against
//!
//! the half-steps of the outer loop, with the other half of the reactions held
//! (H1)  normal         min ½ s_N·G_NN s_N + s_N·(û_N + G_NT t_T − g₀)   s.t.  s_N ≤ 0                       normal.rs
//! (H2)  friction       min ½ s_T·G_TT s_T + s_T·(û_T + G_TN t_N)        s.t.  ‖s_T,i‖ ≤ −μ_i t_N,i          friction.rs
//!
//! all reactions at once, with the equilibrium of bodies that contact alone holds (limit::H4)
//! (H3)  cones          K = T (cones of a program)                                                           generators.rs
//! (H8)  Coulomb        min ½ t·G t + t_N·(û_N − g₀ − μ s) + t_T·û_T      s.t.  (H4)                         coulomb.rs
//! ```
//!
//! (H1) finds the normal reactions while friction is held, (H2) friction while the normal reactions are held
//! (Bisegna, Lebon, Maceri, C. R. Acad. Sci. Paris I 333 (2001) 1053–1058), on working sets (active sets: reduced.rs,
//! elimination.rs). (H8) with the slip `s` of its own minimiser is Coulomb's law. Clarabel solves all three
//! (clarabel.rs).

mod clarabel;
mod coulomb;
mod elimination;
mod friction;
mod generators;
mod normal;
mod reduced;

pub(crate) use coulomb::CoulombProgram;
pub use friction::FrictionHalfStep;
pub use normal::NormalHalfStep;
pub(crate) use reduced::HalfStepWork;
pub use reduced::Role;
