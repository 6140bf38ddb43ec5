//! PATHS: states followed step by step where sweeps do not settle, and back to where a step began
//! (continuation).
//!
//! | path | file |
//! |---|---|
//! | in the plane, surfaces that approach from afar, exactly (D10) | `approach`: `plane`, `plane_piece` |
//! | a load step, followed back to its start (D11) | `continuity` |

mod approach;
pub(super) mod continuity;
mod plane;
mod plane_piece;
