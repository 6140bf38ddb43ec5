//! The commands, one per file: its arguments, then what is done with them.

mod accuracy;
mod cases;
mod check;
mod completions;
mod find;
mod half_space;
mod import;
mod interrupt;
mod limit;
mod man;
mod new;
mod outputs;
mod progress;
mod ranks;
mod scene_file;
mod schema;
mod solve;
mod starter;
mod study;
mod verify;

pub(crate) use cases::{Cases, cases};
pub(crate) use check::{Check, check};
pub(crate) use completions::{Completions, completions};
pub(crate) use find::{Find, find};
pub(crate) use half_space::{HalfSpace, half_space};
pub(crate) use import::{Import, import};
pub(crate) use limit::{Limit, limit};
pub(crate) use man::{Man, man};
pub(crate) use new::{New, new};
pub(crate) use schema::{Schema, schema};
pub(crate) use solve::{Solve, solve};
pub(crate) use study::{Study, study};
pub(crate) use verify::{Verify, verify};
