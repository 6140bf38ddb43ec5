//! THE PROBLEM: plain numbers between mechanics and solver.
//!
//! ```text
//! (C1)   u = û + G t + R α         G: compliance, α: motion of what contact alone holds
//! (C3)   Rᵀ t + e = 0              rigid body modes R, load e on them
//! (C13)  u = û − u_ref + G t       a load step, seen from where the last one ended
//! ```
//!
//! Contact `i` has a block of unknowns, the normal first, then its tangents. A
//! [`ContactProblem`] is a [`Compliance`], mostly an [`Operator`], a free displacement, an initial gap and a coefficient of
//! friction per contact, maybe a [`Law`] that says more, and the free modes of bodies that [float](Floating).
//!
//! | part | file |
//! |---|---|
//! | the problem of a load step (C13) | `contact_problem` |
//! | what every compliance offers, with a matrix or without | `compliance` |
//! | compliance with entries, and stiffness where it exists | `operator` |
//! | laws beyond Coulomb's (L4), (L5) | `law`: `under_laws` |
//! | bodies that contact alone holds (C3) | `floating` |
//! | their motions, free of units | `velocity_basis` |

mod compliance;
mod contact_problem;
mod floating;
mod law;
mod operator;
mod under_laws;
pub(crate) mod velocity_basis;

pub use compliance::Compliance;
pub use contact_problem::ContactProblem;
pub use floating::Floating;
pub(crate) use law::Limits;
pub use law::{Ellipse, Law};
pub use operator::Operator;
pub(crate) use operator::{RoundedStiffness, inverse_of_product};
