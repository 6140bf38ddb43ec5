//! A scene from a file: JSON, or an Abaqus or CalculiX deck by its ending.

use std::error::Error;
use std::io::{self, Read, Write};
use std::path::Path;

use dpana::deck::Deck;
use dpana::scene::{HalfSpaceScene, Scene};

use super::outputs::is_standard;

/// Whether a file counts as a deck.
pub(super) fn is_deck(path: &Path) -> bool {
    let ending = path.extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("inp"))
}

/// Reads a scene from a file, or from standard input; mesh files are then relative to the working
/// folder. What a deck says and is not needed is told on standard error.
pub(super) fn read_scene(path: &Path) -> Result<Scene, Box<dyn Error>> {
    if is_standard(path) {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes)?;
        return Ok(Scene::from_bytes(bytes, "standard input")?);
    }
    Ok(match is_deck(path) {
        true => tell(Deck::from_file(path)?).scene,
        false => Scene::from_file(path).map_err(|error| elsewhere(path, error))?,
    })
}

/// A scene of half-spaces has a command of its own; other mistakes stay what they are.
fn elsewhere(path: &Path, error: dpana::Error) -> Box<dyn Error> {
    match HalfSpaceScene::is_in(path) {
        true => {
            let name = path.display();
            format!(
                "{name}: `half_space`: a scene of half-spaces, which have no mesh; expected `dpana half-space {name}`"
            )
            .into()
        }
        false => error.into(),
    }
}

/// Reads a scene of half-spaces from a file, if it is one.
pub(super) fn half_space_scene(path: &Path) -> Result<Option<HalfSpaceScene>, Box<dyn Error>> {
    Ok(match !is_deck(path) && HalfSpaceScene::is_in(path) {
        true => Some(HalfSpaceScene::from_file(path)?),
        false => None,
    })
}

/// Tells the notes of a deck.
pub(super) fn tell(deck: Deck) -> Deck {
    for note in &deck.notes {
        // With standard error closed there is nobody left to tell.
        let _ = writeln!(io::stderr(), "note: {note}");
    }
    deck
}
