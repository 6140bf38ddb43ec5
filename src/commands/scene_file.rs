//! A scene from a file: JSON, or an Abaqus or CalculiX deck by its ending.

use std::io::{self, Write};
use std::path::Path;

use dpana::deck::Deck;
use dpana::scene::Scene;

/// Whether a file counts as a deck.
pub(super) fn is_deck(path: &Path) -> bool {
    let ending = path.extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("inp"))
}

/// Reads a scene; what a deck says and is not needed is told on standard error.
pub(super) fn read_scene(path: &Path) -> Result<Scene, dpana::Error> {
    match is_deck(path) {
        true => Ok(tell(Deck::from_file(path)?).scene),
        false => Scene::from_file(path),
    }
}

/// Tells the notes of a deck.
pub(super) fn tell(deck: Deck) -> Deck {
    for note in &deck.notes {
        // With standard error closed there is nobody left to tell.
        let _ = writeln!(io::stderr(), "note: {note}");
    }
    deck
}
