//! CONTACT SURFACE: where bodies may touch rigid obstacles and each other.
//!
//! A scene names pairs of sides. Each pair yields contacts: places of a body with a frame (normal
//! first), an initial gap, an area, and the nodes that move with it on either side.
//!
//! | step | file |
//! |---|---|
//! | a pair of sides, a contact | `pair`, `node` |
//! | what the contacts of a pair obey, per area | `law` |
//! | all contacts of a scene | `surface` |
//! | normal and tangents of a contact | `frame` |
//! | facets that face the other side | `facing` |
//! | skins that face each other within a distance | `facing_skins` |
//! | corners and the nodes around them (C16) | `corner_weights` |
//! | what straight facets leave of a round surface (C18) | `rounding`: `turning_edges`, `mirror` |
//! | gaps that are nowhere less than the least distance (C20) | `lift` |
//! | against a rigid obstacle | `on_obstacle`: `obstacle` |
//! | how a body moves that carries obstacles, or is between the faces of a cut | `rigid_body` |
//! | against another surface, segment to segment (C7)–(C10) | `between_bodies`: `carrying_side`, `mortar` |

mod between_bodies;
mod carrying_side;
mod corner_weights;
mod facing;
mod facing_skins;
pub(crate) mod frame;
mod held;
mod law;
mod lift;
mod mirror;
pub(crate) mod mortar;
mod node;
mod obstacle;
mod on_obstacle;
mod pair;
mod repeated;
mod rigid_body;
mod rounding;
mod surface;
mod turn;
mod turning_edges;

pub(crate) use facing::key as facet_key;
pub(crate) use facing_skins::{facing_itself, facing_skins};
pub use law::{PairLaw, Places, Region};
pub use node::{ContactNode, OppositeNodes};
pub(crate) use obstacle::Closest;
pub use obstacle::{Obstacle, Outline, Profile, Triangulated};
pub use pair::{ContactPair, Coupling, Opposite};
pub use rigid_body::{Component, Cut, RigidBody, RigidMotion};
pub use surface::ContactSurface;
