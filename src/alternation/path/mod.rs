//! PATHS: states followed step by step where sweeps do not settle, and back to where a step began
//! (continuation).
//!
//! | path | file |
//! |---|---|
//! | in the plane, surfaces that approach from afar, exactly (D10) | `plane`, `plane_piece` |
//! | in space, contacts that are joined (D13) | `joined` |
//! | either of them, where all else fails | `last_resort` |
//! | a load step, followed back to its start (D11) | `continuity` |

pub(super) mod continuity;
mod joined;
mod last_resort;
mod plane;
mod plane_piece;
