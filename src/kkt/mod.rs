//! JUDGE: how far a contact state is from satisfying the laws of the original problem.
//!
//! ```text
//! (L1)  t_N ≤ 0,   u_N − g₀ ≤ 0,   t_N (u_N − g₀) = 0            Signorini
//! (L2)  ‖t_T‖ ≤ −μ t_N                                          Coulomb's disc
//! (L3)  −μ t_N ‖u_T‖ + t_T · u_T = 0                            slip opposes friction
//! (L4), (L5)                                                   laws beyond Coulomb's, in `law`
//!
//! (K1)  r_N = t_N − min(0, t_N − ρ_N (u_N − g₀))                natural map, and
//!       r_T = t_T − P_disc(t_T − ρ_T u_T)                       ‖r‖ / max(‖t‖, floor)
//! (K2)  f = (w·w / w·G w) w,   w = û + interference             load force, 1000 × floor
//! (K3)  η = Σ [t_N (u_N − g₀) + t_T · u_T − μ t_N ‖u_T‖]        bipotential gap
//! (K4)  K u = f + contact and support reactions                 equilibrium of each body
//! (K5)  u = R (u_own − Σ w_j u_j),   f_j = −w_j f_own           the two sides of a contact
//! (K6)  Σ_own f + Σ_opposite f = 0                              what the sides exchange
//! (K7)  e·α > 0,  v_N + μ ‖v_T‖ ≤ 0,  v = R α                    a motion that nothing stops
//!       e·α > Σ max over the set of −v·t              the same under laws that bound more or less
//! (K8)  Rᵀ t + e = 0                                            equilibrium of floating bodies
//! (K21) contact forces + given force = 0                        equilibrium of rigid bodies
//! (K22) s = Cᵀ λ                                            forces where displacements depend on each other
//! (K9)  external work = elastic + dissipation + closure          where the work of a load step went
//! (K15) Π(u) + Π*(t) ≥ 0                                         energies of a displacement and a reaction
//! ```
//!
//! It shares no code with the solver: it never sees a cone program or a sweep, only
//! the problem and a reaction, and computes `u = û + G t` itself. Its [`Certificate`]
//! decides when a solve may stop; [`balance`](balance()) looks at each whole body,
//! [`surface_departure`](surface_departure()) at whether the bodies follow the condensed
//! problem, [`exchange`](exchange()) at what they give each other.

mod balance;
mod bipotential;
mod body_state;
mod certificate;
mod coulomb;
mod depth;
mod energies;
mod exchange;
mod floating;
mod held;
mod impossibility;
mod judge;
mod law;
mod ledger;
mod natural_map;
mod resultant;
mod rigid_balance;
mod scales;
mod scene;
mod sides;
mod signorini;
mod state;
mod support_forces;
mod surface_departure;
#[cfg(test)]
pub(crate) mod tests;
mod tied;

pub use balance::{Balance, WorstNode, balance};
pub use body_state::BodyState;
pub(crate) use certificate::Defect;
pub use certificate::{Certificate, ContactStatus, Verdict, Worst};
pub use energies::{Energies, Motion, energies};
pub(crate) use exchange::Exchange;
pub use exchange::exchange;
pub(crate) use held::held;
pub(crate) use impossibility::Impossibility;
pub use impossibility::{impossibility, impossibility_under_laws};
pub use judge::Judge;
pub(crate) use ledger::{Account, ContactStep, Ledger};
pub(crate) use resultant::Resultant;
pub use rigid_balance::{RigidBalance, rigid_balance};
pub use scene::{Measure, PairFit, SceneGeometry, Surroundings};
pub(crate) use sides::{global_force, relative_displacement};
pub(crate) use support_forces::{nodal_forces, support_forces};
pub use surface_departure::surface_departure;
pub use tied::GroupState;
pub(crate) use tied::group_states;
