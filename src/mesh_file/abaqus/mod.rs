//! Reader of Abaqus and CalculiX decks, as far as they state meshes: one mesh of the whole deck
//! (`parse`), or what [`deck`](crate::deck) makes bodies of.
//!
//! ```text
//! lines (includes in place) → cards → instances of parts written out → nodes, elements, sets, surfaces
//! ```
//!
//! What a deck says of materials, contact and loads is read in [`deck`](crate::deck).
//! Formats: Abaqus keywords reference, CalculiX CrunchiX user's manual.

mod card;
mod collapsed;
mod contents;
mod directory;
mod element;
mod instance;
mod lines;
mod mesh;
mod stated;

pub(crate) use card::{Card, Row, bare, cards};
pub(crate) use contents::{Contents, KEYWORDS, Side};
pub(crate) use element::{ElementKind, Space};
pub(crate) use instance::{Flat, Scope, flatten};
pub(crate) use lines::Source;
pub(crate) use mesh::parse;

pub(crate) use super::elements::Shape;
