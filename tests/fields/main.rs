//! What loads, fields, gaps and supports of a scene do, beside closed forms.

mod gaps;
#[path = "../stacks/mod.rs"]
mod stacks;
