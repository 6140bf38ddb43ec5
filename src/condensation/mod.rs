//! CONDENSATION: the elastic body, seen from its contact surface.
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
//! | where the bodies may touch what | `surface`, `frame` |
//! | corners and the nodes around them (C16) | `footing` |
//! | a rigid obstacle | `obstacle_contacts`: `obstacle`, `facing` |
//! | another surface | `paired` |
//! | what a deformable other side is to the contact nodes (C7)–(C10) | `mortar` |
//! | the stiffness in the contact's axes (C4) | `frames` |
//! | order of elimination, contact last | `ordering`, `elimination_tree` |
//! | factor, trailing block (C2), substitutions | `columns`, `factor`, `substitution` |
//! | where contacts see less than their nodes: a border (C17) | `border` |
//! | free displacement (C5), of driven loads and supports (C15) | `supported`, `action`, `superposition` |
//! | several bodies, and what supports leave free (C11), (C3), (C12) | `interface`, `floating`, `rigid_bodies`, `grounding` |
//! | recovered body (C6) | `condensed_body` |
//! | the problem of a load step (C13) | `problem`, `step` |

mod action;
#[cfg(test)]
mod bed;
mod border;
mod columns;
mod condensed;
mod condensed_body;
mod elimination_tree;
mod facing;
mod factor;
mod floating;
mod footing;
mod frame;
mod frames;
mod grounding;
mod interface;
#[cfg(test)]
mod lattice;
pub mod mortar;
pub mod obstacle;
mod obstacle_contacts;
pub mod operator;
mod ordering;
mod paired;
pub mod problem;
mod rigid_bodies;
mod step;
mod substitution;
mod superposition;
mod supported;
pub mod surface;

pub use condensed::{CondensationWork, Condensed};
pub use condensed_body::CondensedBody;
pub use floating::Floating;
pub use mortar::{Mortar, MortarNode};
pub use obstacle::{Closest, Obstacle};
pub use operator::Operator;
pub use problem::ContactProblem;
pub use rigid_bodies::{PartMotion, RigidBodies};
pub use superposition::{Driven, Superposition};
pub use surface::{ContactNode, ContactPair, ContactSurface, Opposite, OppositeNodes};
