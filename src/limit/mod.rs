//! LIMIT ANALYSIS: whether admissible reactions can hold the bodies, and how much more.
//!
//! Bodies are rigid here: R are the motions that supports leave free, e the load on them.
//!
//! ```text
//! (H4)  equilibrium    Rᵀ t + e = 0,  t ∈ K = { t_N ≤ 0, ‖t_T‖ ≤ −μ t_N }                                    rigid_contacts.rs
//! (H5)  distance       min ½ ‖Qᵀ t + e‖²   s.t.  t ∈ K                   is zero, or proves that (H4) fails  separation.rs
//! (H6)  limit          max λ   s.t.  (H4) for e + λ g                                                       load_factor.rs
//! (H7)  least friction min k   s.t.  (H4) for k μ                                                           least_friction.rs
//! (H9)  failure        min ‖R (α' − α)‖   s.t.  sliding contacts stay closed                                failure_motion.rs
//! ```
//!
//! (H5) is solved by proximal Newton steps on the projection onto K (cone_projection.rs), in
//! unit-free velocities Q of the rigid motions; its minimiser, where not zero, is Farkas' certificate that nothing
//! holds. (H6), (H7) ask (H5) again. equilibrium.rs says what counts as zero.

mod cone_projection;
mod equilibrium;
mod failure_motion;
mod least_friction;
mod load_factor;
mod rigid_contacts;
mod separation;
#[cfg(test)]
pub(crate) mod tests;

pub use equilibrium::Equilibrium;
pub use least_friction::LeastFriction;
pub use load_factor::Limit;
pub use rigid_contacts::RigidContacts;
