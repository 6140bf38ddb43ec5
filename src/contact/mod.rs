//! CONTACT SURFACE: where bodies may touch rigid obstacles and each other.
//!
//! A scene names pairs of sides. Each pair yields contacts: places of a body with a frame (normal
//! first), an initial gap, an area, and the nodes that move with it on either side.
//!
//! | step | file |
//! |---|---|
//! | a pair of sides, a contact | `pair`, `node` |
//! | all contacts of a scene | `surface` |
//! | normal and tangents of a contact | `frame` |
//! | facets that face the other side | `facing` |
//! | corners and the nodes around them (C16) | `corner_weights` |
//! | against a rigid obstacle | `on_obstacle`: `obstacle` |
//! | against another surface, segment to segment (C7)–(C10) | `between_bodies`: `mortar` |

mod between_bodies;
mod corner_weights;
mod facing;
pub(crate) mod frame;
pub(crate) mod mortar;
mod node;
mod obstacle;
mod on_obstacle;
mod pair;
mod surface;

pub use node::{ContactNode, OppositeNodes};
pub(crate) use obstacle::Closest;
pub use obstacle::Obstacle;
pub use pair::{ContactPair, Opposite};
pub use surface::ContactSurface;
