//! DECKS: Abaqus and CalculiX input as a scene.
//!
//! ```text
//! mesh_file/abaqus   lines → cards → instances written out → nodes, elements, sets, surfaces
//! statement          which cards state the model, which the steps, which are left or refused
//! material, parts    sections, constants, orientations; connected parts become bodies
//! interaction, pair  laws, and the surfaces that obey them; adjust   slave nodes moved onto the master
//! transform, rigid, cyclic          directions of nodes, nodes that move as one, sectors that repeat
//! pre_tension, bolt                 bolts under preload
//! load, distributed, amplitude      what a card gives
//! history, sum       what holds at every instant;  what loads add up to, in global axes
//! acting, assemble   the scene
//! ```
//!
//! | read | how |
//! |---|---|
//! | `*NODE`, `*ELEMENT`, `*NSET`, `*ELSET`, `*INCLUDE`, parts and instances | C3D4, C3D5, C3D6, C3D8, C3D10, C3D15, C3D20, and CPE, CPS, CAX of 3, 4, 6, 8 nodes; linear ones folded up to a triangle, wedge, pyramid or tetrahedron are one; every connected part is a body, with incompatible modes if an element of it has them (C3D8I, CPE4I) |
//! | `*SURFACE` | by faces, by elements (all outer faces), by nodes (outer faces whose corners are all in the set) |
//! | `*MATERIAL`, `*ELASTIC`, `*DENSITY`, `*EXPANSION`, `*ORIENTATION`, `*SOLID SECTION` | isotropic, by engineering constants, or orthotropic; a thickness is that of plane stress, and what forces of plane strain are divided by |
//! | `*CONTACT PAIR`, `*SURFACE INTERACTION`, `*SURFACE BEHAVIOR`, `*FRICTION` | contact with friction, slave first; a penalty or a stick slope from 100 E / h of the cells there on is left out, a softer one kept as a layer (exponential ones are left out with a note, and refused below 10 E / h); `TAUMAX`, TIED (with a stick slope), NO SEPARATION, ROUGH |
//! | `*TIE` | slave faces that are near enough are moved onto the master and one with it |
//! | `ADJUST=`, `*CLEARANCE` | slave nodes that overlap, or are near, or of a set, are moved onto the master surface; a distance in place of none that is drawn |
//! | `*MODEL CHANGE` of pairs | in the steps in which they are taken out their gap is ten times the size of the deck |
//! | `*BOUNDARY`, `*CLOAD`, `*DLOAD` (P1 to P6, GRAV, CENTRIF, BX, BY, BZ), `*DSLOAD` (P), `*AMPLITUDE` | persist from step to step, each type of load by itself, ramp, end with `OP=NEW`; supports stay; without a set on the whole model |
//! | `*INITIAL CONDITIONS, TYPE=TEMPERATURE`, `*TEMPERATURE` | the rise strains by the expansion |
//! | `*TRANSFORM` | of supports and forces, straight or around a line; a reference node is held along global axes, or along all three of its own |
//! | `*RIGID BODY`, `*COUPLING` with `*KINEMATIC` of all directions | nodes of one part move as a rigid body, by what is stated at the reference node in one history |
//! | `*TIE, CYCLIC SYMMETRY`, `*CYCLIC SYMMETRY MODEL` | faces that turn onto each other node by node move as one |
//! | `*PRE-TENSION SECTION` of solid elements | a bolt, cut along a plane: at its reference node `*CLOAD` is the force, `*BOUNDARY` the shortening, `*BOUNDARY, FIXED` in a later step the lock |
//! | `*STEP`, `*STATIC` | an instant per step and per time of an amplitude; `NLGEOM` is noted, displacements are small |
//!
//! What changes the mechanics and is not read is refused by file, line and keyword: shells, beams, gap
//! elements, equations, bolts of one beam, springs, plasticity, dynamics, laws that change, elements that come
//! and go, supports that do. What steers a numerical method, and steps of `*FREQUENCY`, are noted and left.
//! Numbers keep the deck's units.
//!
//! # Beside CalculiX
//!
//! Largest difference of a node's displacement over the largest displacement, for eight of CalculiX' own tests as its
//! version 2.20 solves them (all pairs `TYPE=LINMORTAR`, without `NLGEOM`; its results have six digits):
//!
//! | test | with its own penalty | penalty and stick slope times 10⁴ |
//! |---|---:|---:|
//! | testmortar | 1.1e-6 | 1.1e-6 |
//! | cubespring | 7.8e-7 | 1.7e-5 |
//! | friction1 | 1.2e-6 | 4.3e-6 |
//! | contact5 | 1.1e-6 | 1.5e-5 |
//! | cubesmortar | 1.2e-6 | 1.0e-5 |
//! | cubesmortar2, with a stick slope of 10⁵ | 1.1e-6 | 3.8e-6 |
//! | contact4_mortar | 7.5e-6 | 7.7e-6 |
//! | contact14 (`*CLEARANCE`, `*MODEL CHANGE`), LINEAR in place of HARD | | 2.5e-6 |
//!
//! Its axisymmetric elements are solids of 2°, whose chords are shorter than their arcs by 1.5e-4: so far apart are ring1
//! and ring2 (heat). Of 100 decks of static elastic contact in public repositories, 92 with their meshes, 52 were
//! read when bolts were not, which stood in six more; the rest is refused by keyword and line: shells 8, gap elements
//! and equations 4 each.
//!
//! Sources: Abaqus keywords reference, CalculiX CrunchiX user's manual.

mod acting;
mod adjust;
mod amplitude;
mod assemble;
mod bolt;
mod cyclic;
mod distributed;
mod elastic;
mod history;
mod interaction;
mod load;
mod material;
mod orientation;
mod pair;
mod parts;
mod pre_tension;
mod rigid;

mod statement;
mod sum;
mod transform;

use std::path::Path;

use crate::error::Error;
use crate::mesh_file::abaqus::{Contents, ElementKind, Source, cards, flatten};
use crate::scene::{Scene, read};

use amplitude::amplitudes;
use assemble::Stock;
use cyclic::repeats;
use history::History;
use load::Reader;
use material::Materials;
use pair::Contacts;
use parts::Parts;
use pre_tension::Sections;
use rigid::RigidGroups;
use statement::{Notes, Statement};
use transform::Transforms;

/// A deck that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Deck {
    /// What it says; its meshes are held in memory.
    pub scene: Scene,
    /// What was read and left, by file, line and keyword.
    pub notes: Vec<String>,
}

impl Deck {
    /// Reads a deck from a file, and what it includes relative to its folder.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], and those of [`Deck::parse`].
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let bytes = read("deck", path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut deck = Self::parse(&bytes, &path.display().to_string(), &|included| {
            read("*INCLUDE", &folder.join(included))
        })?;
        deck.scene.source = path.to_owned();
        Ok(deck)
    }

    /// Reads a deck from bytes; `name` stands for it in messages, and `read` gives the bytes of a file
    /// that it includes.
    ///
    /// # Errors
    ///
    /// [`Error::Mesh`] with file, line and keyword: data that is no data, an unknown keyword, one that
    /// is not read, a parameter or value that changes the mechanics and is not read, names that refer
    /// to nothing, files that include themselves.
    pub fn parse(
        bytes: &[u8],
        name: &str,
        read: &dyn Fn(&str) -> Result<Vec<u8>, Error>,
    ) -> Result<Self, Error> {
        let mut notes = Notes::default();
        let source = Source::new(bytes, name, read)?;
        let cards = cards(&source)?;
        let Some(last) = cards.last() else {
            return Err(Error::Mesh {
                file: name.to_owned(),
                line: 1,
                reason: "no keyword; expected a deck with *NODE, *ELEMENT, *STEP".to_owned(),
            });
        };
        let flat = flatten(&cards)?;
        let statement = Statement::new(&flat, &mut notes)?;
        let contents = Contents::new(&flat, ElementKind::new)?;
        if contents.elements.is_empty() {
            return Err(last.error("the deck ends; expected *NODE and *ELEMENT with data"));
        }
        let mut scene = stock(&statement, contents, &mut notes)?.scene(&mut notes)?;
        scene.title = name.to_owned();
        Ok(Self {
            scene,
            notes: notes.lines,
        })
    }
}

/// Takes up all that a deck states.
fn stock<'a, 'c>(
    statement: &Statement<'a, 'c>,
    mut contents: Contents,
    notes: &mut Notes,
) -> Result<Stock<'a, 'c>, Error> {
    let materials = Materials::new(statement, &contents)?;
    let parts = Parts::new(&contents, &materials)?;
    let mut contacts = Contacts::new(statement, &contents, notes)?;
    let transforms = Transforms::new(statement, &contents)?;
    let rigid = RigidGroups::new(statement, &contents, &parts)?;
    let sections = Sections::new(statement, &contents, &parts)?;
    let repeats = repeats(statement, &contents, &parts)?;
    let reader = Reader {
        contents: &contents,
        materials: &materials,
        parts: &parts,
        rigid: &rigid,
        sections: &sections,
        transforms: &transforms,
        initial: initial_temperatures(statement, &contents)?,
        outer: contents.outer_sides(),
    };
    let history = History::new(statement, &amplitudes(&statement.model)?, reader, notes)?;
    for pair in &mut contacts.pairs {
        adjust::settle(&mut contents, pair, notes)?;
    }
    Ok(Stock {
        contents,
        materials,
        parts,
        contacts,
        transforms,
        rigid,
        sections,
        repeats,
        history,
    })
}

/// Temperature of every node before the first step, 0 where none is stated.
fn initial_temperatures(
    statement: &Statement<'_, '_>,
    contents: &Contents,
) -> Result<Vec<f64>, Error> {
    let mut initial = vec![0.0; contents.positions.len()];
    let model = statement.model.iter();
    for &(scope, card) in model.filter(|(_, card)| card.name == "INITIALCONDITIONS") {
        card.only(&["TYPE"])?;
        card.need("TYPE")?;
        card.one_of("TYPE", &["TEMPERATURE"])?;
        for row in card.rows(scope) {
            let value = row.number(1, "a temperature", None)?;
            for node in contents.nodes.members(row, row.word(0))? {
                initial[node] = value;
            }
        }
    }
    Ok(initial)
}
