//! CONDENSATION: the elastic body, seen from its contact surface (static condensation).
//!
//! ```text
//! (C1)  u = û + G t          û: displacement of the contact surface with no contact forces
//! (C2)  S = L_cc L_ccᵀ       trailing block of the Cholesky factor of K, contact unknowns last
//!       G = S⁻¹ = L_cc⁻ᵀ L_cc⁻¹
//! ```
//!
//! G does not depend on loads, gap or friction: one factorisation serves every load case.
//!
//! | step | file |
//! |---|---|
//! | the stiffness in the contact's axes (C4) | `local_axes` |
//! | order of elimination, contact last | `ordering`, `dissection`, `elimination_tree` |
//! | factor (C32), trailing block (C2), substitutions | `columns`, `factor`, `supernodes`, `substitution` |
//! | where contacts see less than their nodes: a border (C17) | `border` |
//! | free displacement (C5), of driven loads and supports (C15) | `supported`, `load_case`, `superposition` |
//! | what is given before, and which precision that allows | `given` |
//! | several bodies, and what supports leave free (C11), (C3), (C12) | `interface`, `rigid_bodies`, `grounding` |
//! | bodies without compliance (C31) | `carried` |
//! | recovered body (C6), set right where the factor has few digits (C24) | `condensed_body`, `correction` |
//! | room for what is dense, and what all will take | `room`, `estimate` |
//! | laws of the contacts, per area and place (C25) | `laws` |
//! | the problem of a load step (C13) | `load_step` |
//! | an engine of choice; factors divided among the processes of an MPI run | `engine`, `mumps` |
//! | what loads, supports, obstacles and moduli change per unit (C26) | `rates` |

mod border;
mod carried;
mod columns;
mod condensed;
mod condensed_body;
mod correction;
mod dissection;
mod elimination_tree;
mod engine;
mod estimate;
mod factor;
mod given;
mod grounding;
mod interface;
mod laws;
mod load_case;
mod load_step;
mod local_axes;
mod mumps;
mod ordering;
mod rates;
mod rigid_bodies;
mod room;
mod substitution;
mod supernodes;
mod superposition;
mod supported;
#[cfg(test)]
pub(crate) mod tests;
mod work;

pub use condensed::Condensed;
pub(crate) use condensed_body::CondensedBody;
pub use correction::Correction;
pub use engine::Engine;
pub use estimate::Estimate;
pub(crate) use estimate::estimate;
pub(crate) use factor::Precision;
pub(crate) use laws::friction;
pub use mumps::{RankMemory, Ranks};
pub(crate) use rates::BodyRate;
pub(crate) use rigid_bodies::{PartMotion, RigidBodies};
pub(crate) use room::dense_bytes;
pub(crate) use superposition::{Driven, Superposition};
pub use work::{CondensationWork, Fallback};
