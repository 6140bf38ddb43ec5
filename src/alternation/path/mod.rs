//! PATHS: states followed step by step where sweeps do not settle (continuation).
//!
//! | path | file |
//! |---|---|
//! | in the plane, surfaces that approach from afar, exactly (D10) | `plane`, `plane_piece` |
//! | in space, contacts that are joined (D13) | `joined` |
//! | where bodies float, contacts that open as they slide, and less and less so (D19) | `dilation` |
//! | one of them, where all else fails | `last_resort` |

mod dilation;
mod joined;
mod last_resort;
pub(super) mod plane;
mod plane_piece;
