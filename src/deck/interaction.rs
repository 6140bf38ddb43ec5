//! Laws of contact.
//!
//! ```text
//! HARD, LINEAR K, EXPONENTIAL (c₀, p₀)    unilateral
//! TIED K and λ, *TIE                      one with what it stands on
//! NO SEPARATION, ROUGH                    apart never; no slip while pressed; with both, one
//! K, stick slope λ                        left out from 100 E / h of the cells there on, as penalties;
//!                                         below it layers of compliance 1 / K and 1 / λ
//! ```

use std::collections::BTreeMap;

use super::statement::Notes;
use crate::error::Error;
use crate::mesh_file::abaqus::Card;
use crate::scene::{SceneCompliance, SceneContact, SceneLaw};

/// What a law does along the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Normal {
    /// Unilateral.
    Apart,
    /// Unilateral, with a pressure that grows exponentially where the gap closes.
    Exponential,
    /// Neither parts nor overlaps; slips.
    NoSeparation,
    /// One with what it stands on.
    Tied,
}

/// A law of contact.
#[derive(Clone, Debug)]
pub(super) struct Interaction<'a, 'c> {
    /// Name in the deck.
    pub(super) name: String,
    normal: Normal,
    /// Coefficient of friction.
    friction: f64,
    /// Pressure per overlap, and where it is stated; none for hard contact.
    stiffness: Option<(f64, &'c Card<'a>)>,
    /// Shear stress per displacement before slip, and where it is stated.
    stick: Option<(f64, &'c Card<'a>)>,
    /// Shear stress that friction does not exceed, and where it is stated.
    cap: Option<(f64, &'c Card<'a>)>,
    /// Whether nothing slips while it is pressed.
    rough: bool,
}

/// Reads what a card says of a law: a new one, or more of the last.
pub(super) fn read_law<'a, 'c>(
    laws: &mut Vec<Interaction<'a, 'c>>,
    card: &'c Card<'a>,
    notes: &mut Notes,
) -> Result<(), Error> {
    let orphan = || card.error("expected *SURFACE INTERACTION before");
    match card.name.as_str() {
        "SURFACEINTERACTION" => {
            card.only(&["NAME"])?;
            let name = card.need("NAME")?;
            if laws.iter().any(|law| law.name == name) {
                return Err(card.error(format!("surface interaction `{name}` once more")));
            }
            laws.push(Interaction {
                name: name.to_owned(),
                normal: Normal::Apart,
                ..Interaction::glue()
            });
        }
        "SURFACEBEHAVIOR" => {
            let law = laws.last_mut().ok_or_else(orphan)?;
            let (normal, stiffness) = normal(card, notes)?;
            (law.normal, law.stiffness) = (normal, stiffness.map(|of| (of, card)));
        }
        "FRICTION" => {
            let law = laws.last_mut().ok_or_else(orphan)?;
            card.only(&[
                "SLIPTOLERANCE",
                "ELASTICSLIP",
                "LAGRANGE",
                "ROUGH",
                "TAUMAX",
            ])?;
            law.rough = card.get("ROUGH").is_some();
            law.cap = cap(card)?.map(|cap| (cap, card));
            if law.rough && law.cap.is_some() {
                return Err(card.error("`TAUMAX` beside `ROUGH` is not read"));
            }
            if !law.rough {
                let (friction, stick) = friction(card)?;
                (law.friction, law.stick) = (friction, stick.map(|of| (of, card)));
            }
        }
        _ => {}
    }
    Ok(())
}

/// What a law does along the normal, and its pressure per overlap; none where contact is hard.
fn normal(card: &Card<'_>, notes: &mut Notes) -> Result<(Normal, Option<f64>), Error> {
    card.only(&[
        "PRESSURE-OVERCLOSURE",
        "PENALTY",
        "AUGMENTEDLAGRANGE",
        "DIRECT",
        "NOSEPARATION",
    ])?;
    let kind = card.get("PRESSURE-OVERCLOSURE").unwrap_or("HARD");
    let kinds = ["HARD", "LINEAR", "EXPONENTIAL", "TIED"];
    card.one_of("PRESSURE-OVERCLOSURE", &kinds)?;
    let held = card.get("NOSEPARATION").is_some();
    match (kind, held) {
        ("HARD", false) => return Ok((Normal::Apart, None)),
        ("HARD", true) => return Ok((Normal::NoSeparation, None)),
        (_, true) => return Err(card.error("`NO SEPARATION` is read with HARD only")),
        _ => {}
    }
    let row = card.row("the stiffness")?;
    let stated = row.number(0, "a stiffness or a distance", None)?;
    let (normal, stiffness) = match kind {
        "LINEAR" => (Normal::Apart, stated),
        "TIED" => (Normal::Tied, stated),
        // p = p₀ exp(−g ln 100 / c₀) has the slope p₀ ln 100 / c₀ where the gap closes.
        _ => {
            let slope = row.number(1, "a pressure", None)? * 100.0_f64.ln() / stated;
            (Normal::Exponential, slope)
        }
    };
    if kind == "LINEAR" && row.number(1, "a tension", 0.0)? != 0.0 {
        notes.add(
            card,
            "the tension of surfaces that are apart is not needed here",
        );
    }
    match stiffness > 0.0 {
        true => Ok((normal, Some(stiffness))),
        false => Err(row.error("expected a stiffness above 0")),
    }
}

/// The shear stress that friction does not exceed.
fn cap(card: &Card<'_>) -> Result<Option<f64>, Error> {
    let Some(word) = card.get("TAUMAX") else {
        return Ok(None);
    };
    match card.head(0).number_of(word, "a shear stress")? {
        cap if cap > 0.0 => Ok(Some(cap)),
        cap => Err(card.error(format!("`TAUMAX={cap}`; expected one above 0"))),
    }
}

/// Coefficient of friction and stick slope.
fn friction(card: &Card<'_>) -> Result<(f64, Option<f64>), Error> {
    let row = card.row("the coefficient of friction, one for all pressures")?;
    let friction = row.number(0, "a coefficient of friction", None)?;
    if friction < 0.0 {
        return Err(row.error(format!("coefficient {friction}; expected one from 0")));
    }
    if row.word(1).is_empty() {
        return Ok((friction, None));
    }
    match row.number(1, "a stick slope", None)? {
        slope if slope > 0.0 => Ok((friction, Some(slope))),
        slope => Err(row.error(format!("stick slope {slope}; expected one above 0"))),
    }
}

/// Stiffness over E / h from which on a penalty is left out: it gives a hundredth of what a cell gives.
const HARD: f64 = 100.0;

/// Stiffness over E / h below which a law that is not linear is refused: it gives a tenth of what a cell gives.
const SOFT: f64 = 10.0;

impl Interaction<'_, '_> {
    /// The law of surfaces that are one.
    pub(super) fn glue() -> Self {
        Self {
            name: String::new(),
            normal: Normal::Tied,
            friction: 0.0,
            stiffness: None,
            stick: None,
            cap: None,
            rough: false,
        }
    }

    /// Whether surfaces are held together.
    pub(super) fn is_tied(&self) -> bool {
        [Normal::Tied, Normal::NoSeparation].contains(&self.normal)
    }

    /// Puts the law on a contact; `cell` is E / h, of the softest and of the smallest cell at the surfaces.
    pub(super) fn put_on(
        &self,
        contact: &mut SceneContact,
        cell: f64,
        notes: &mut Notes,
    ) -> Result<(), Error> {
        if let (Normal::Tied, Some((_, card)), None) = (self.normal, self.stiffness, self.stick) {
            return Err(card.error("`TIED`: expected *FRICTION with a stick slope beside it"));
        }
        let stick = |stick| soft("stick slope", stick, cell, notes);
        let tangential = self.stick.map_or(0.0, stick);
        let compliance = SceneCompliance {
            normal: self.approach(cell, notes)?,
            tangential,
        };
        contact.compliance = (compliance != SceneCompliance::default()).then_some(compliance);
        let friction = self.friction;
        contact.law = match (self.normal, self.cap) {
            (Normal::Tied, None) => Some(SceneLaw::Bonded),
            (Normal::NoSeparation, None) if self.rough => Some(SceneLaw::Bonded),
            (Normal::NoSeparation, None) => Some(SceneLaw::NoSeparation { friction }),
            (Normal::Tied | Normal::NoSeparation, Some((_, card))) => {
                return Err(card.error("`TAUMAX` of surfaces that do not part is not read"));
            }
            _ if self.rough => Some(SceneLaw::Rough),
            (_, Some((cap, _))) => Some(SceneLaw::Coulomb {
                friction: Some(friction),
                regions: BTreeMap::new(),
                table: None,
                shear_cap: Some(cap),
                static_friction: None,
            }),
            _ => None,
        };
        contact.friction = contact.law.is_none().then_some(friction);
        Ok(())
    }

    /// Approach per pressure of the layer that the law states.
    fn approach(&self, cell: f64, notes: &mut Notes) -> Result<f64, Error> {
        let Some((stiffness, card)) = self.stiffness else {
            return Ok(0.0);
        };
        let ratio = stiffness / cell;
        if self.normal != Normal::Exponential || ratio >= HARD {
            return Ok(soft("stiffness", (stiffness, card), cell, notes));
        }
        if ratio < SOFT {
            return Err(card.error(format!(
                "stiffness {stiffness:.3e} where the gap closes is a soft layer, {ratio:.2} E / h of the cells \
                 there; expected at least {SOFT} E / h = {:.3e}, LINEAR or HARD",
                SOFT * cell
            )));
        }
        let given = 100.0 / ratio;
        let words = format!(
            "the stiffness is left out, contact is hard here: it gives {given:.0} % of what a cell gives"
        );
        notes.add(card, &words);
        Ok(0.0)
    }
}

/// Displacement per stress of a layer that gives at least a hundredth of what a cell gives; 0 for a penalty.
fn soft(what: &str, (stated, card): (f64, &Card<'_>), cell: f64, notes: &mut Notes) -> f64 {
    let ratio = stated / cell;
    let hard = ratio >= HARD;
    notes.add(
        card,
        &match hard {
            true => format!("the {what} of the penalty is not needed here"),
            false => format!(
                "{what} {stated:.3e} is kept as that of a layer: {ratio:.2} E / h of the cells there"
            ),
        },
    );
    if hard { 0.0 } else { 1.0 / stated }
}
