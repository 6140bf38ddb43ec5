//! CONDENSATION: the elastic body, seen from its contact surface.
//!
//! ```text
//! (C1)  u = û + G t          û: displacement of the contact surface with no contact forces
//! (C2)  S = L_cc L_ccᵀ       trailing block of the Cholesky factor of K, contact unknowns last
//!       G = S⁻¹ = L_cc⁻ᵀ L_cc⁻¹
//! ```
//!
//! G does not depend on loads, gap or friction: one factorisation serves every load case.

pub mod obstacle;
pub mod operator;
pub mod problem;
pub mod surface;

pub use obstacle::Obstacle;
pub use operator::Operator;
pub use problem::ContactProblem;
pub use surface::{ContactNode, ContactPair, ContactSurface};
