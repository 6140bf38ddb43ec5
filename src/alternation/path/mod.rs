//! PATHS: states followed step by step where sweeps do not settle, and back to where a step began
//! (continuation).
//!
//! | path | file |
//! |---|---|
//! | friction raised from nothing, or lowered from rough (D9) | `friction` |
//! | in the plane, surfaces that approach from afar, exactly (D10) | `plane`: `plane_piece` |
//! | a load step, followed back to its start (D11) | `continuity` |

pub(super) mod continuity;
pub(super) mod friction;
mod plane;
mod plane_piece;
