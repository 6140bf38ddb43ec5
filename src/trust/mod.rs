//! TRUST: what a solved state is worth, asked of the loop and of the state itself.
//!
//! ```text
//! (T1)  how a small disturbance grows per sweep, and from which friction on                    contraction.rs
//! (T2)  whether a path of states leads back to where its load step began, without a jump       continuity.rs
//! (T3)  by what factor a load can grow before nothing holds elastic bodies                     elastic_limit.rs
//!       whether solves from elsewhere end in other states                                      other_starts.rs
//! ```
//!
//! (T2) and (T3) follow loads in proportion (proportion.rs).

mod continuity;
mod contraction;
mod elastic_limit;
mod other_starts;
mod proportion;

pub use continuity::{Earlier, WayBack, way_back};
pub use contraction::{Contraction, contraction};
pub use elastic_limit::{ElasticLimit, LimitStart, elastic_limit};
pub use other_starts::{OtherStarts, other_starts};
