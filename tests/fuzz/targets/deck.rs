//! Text to the reader of decks, and small scenes that come out of it to the solver. The text stands
//! for every file that it includes, too.
#![no_main]

use dpana::deck::Deck;
use dpana::scene::MeshSource;
use dpana_fuzz::attempt;
use libfuzzer_sys::fuzz_target;

/// Most nodes of a scene that is solved.
const NODES: usize = 400;

/// Most bytes of a text that includes itself.
const INCLUDED: usize = 2000;

fuzz_target!(|bytes: &[u8]| {
    let included = |_: &str| Ok(bytes[..bytes.len().min(INCLUDED)].to_vec());
    let Ok(deck) = Deck::parse(bytes, "deck.inp", &included) else {
        return;
    };
    let nodes = deck.scene.bodies.iter().map(|body| match &body.mesh {
        MeshSource::Given(mesh) => mesh.nodes.len(),
        _ => unreachable!("meshes of decks are in memory"),
    });
    if nodes.sum::<usize>() <= NODES {
        let _ = attempt(deck.scene);
    }
});
