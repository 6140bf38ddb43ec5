//! The state after a load step, from which a history is taken on.
//!
//! Numbers are written as text in the shortest form that gives back every bit.

use std::fmt::{self, Write};

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use super::json;
use crate::error::Error;

/// What the next step needs of the last one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a state")]
pub struct SavedState {
    /// Of bodies and contacts.
    pub bodies: Fingerprint,
    /// Of the instants so far, and of what acted at each.
    pub history: Fingerprint,
    /// Steps done.
    pub steps: usize,
    /// Instant of the last.
    pub at: Exact,
    /// Reaction per contact unknown, in newton.
    pub reaction: Vec<Exact>,
    /// Rigid motion per free mode, in metre.
    pub motion: Vec<Exact>,
    /// Shortening per bolt at which it was locked, in metre, in the order of rigid bodies and bolts; empty while none was.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub locked: Vec<Option<Exact>>,
    /// Slip per contact unknown since the start of the history, in metre.
    pub slip: Vec<Exact>,
    /// Displacement per body and unknown, in metre.
    pub displacements: Vec<Vec<Exact>>,
    /// Work and energy since the start of the history, in joule, in the order of the report.
    pub ledger: Vec<Exact>,
}

/// Tells one scene from another: the same only for what is the same to the last digit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint(u64);

impl Fingerprint {
    /// Of everything that a value shows.
    #[must_use]
    pub fn of(value: &impl fmt::Debug) -> Self {
        let mut hash = Hash(0xcbf2_9ce4_8422_2325);
        // The sink takes whatever it is given.
        let _ = write!(hash, "{value:?}");
        Self(hash.0)
    }
}

/// FNV-1a of Fowler, Noll and Vo: the same on every machine.
struct Hash(u64);

impl fmt::Write for Hash {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
        Ok(())
    }
}

/// A number that comes back bit for bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exact(pub f64);

impl Serialize for Exact {
    fn serialize<S: Serializer>(&self, sink: S) -> Result<S::Ok, S::Error> {
        sink.serialize_str(&self.0.to_string())
    }
}

impl<'de> Deserialize<'de> for Exact {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        let text = String::deserialize(source)?;
        let number: f64 = text.parse().map_err(|_| {
            de::Error::custom(format!("`{text}` is no number; expected one in quotes"))
        })?;
        match number.is_finite() {
            true => Ok(Self(number)),
            false => Err(de::Error::custom(format!("{text} is not a finite number"))),
        }
    }
}

impl SavedState {
    /// Reads a state; `file` stands for it in messages.
    ///
    /// # Errors
    ///
    /// Text that is no state, with line and column.
    pub fn from_json(text: &str, file: &str) -> Result<Self, Error> {
        json::parse(text, file)
    }

    /// The state as JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Plain structs with string keys: there is nothing that could fail to serialise.
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// Numbers to be written.
#[must_use]
pub(crate) fn exact(values: &[f64]) -> Vec<Exact> {
    values.iter().map(|&value| Exact(value)).collect()
}

/// Numbers that were read.
#[must_use]
pub(crate) fn plain(values: &[Exact]) -> Vec<f64> {
    values.iter().map(|value| value.0).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_bit_of_a_number_comes_back() {
        let numbers = [0.1 + 0.2, -0.0, 5e-324, f64::MAX, 1.0 / 3.0, -7.0];
        let state = SavedState {
            bodies: Fingerprint::of(&numbers),
            history: Fingerprint::of(&""),
            steps: 3,
            at: Exact(0.3),
            reaction: exact(&numbers),
            motion: vec![],
            locked: vec![],
            slip: vec![],
            displacements: vec![exact(&numbers)],
            ledger: vec![],
        };
        let back = SavedState::from_json(&state.to_json(), "state.json").unwrap();
        assert_eq!(back.bodies, state.bodies);
        assert_ne!(back.bodies, back.history);
        for (back, number) in plain(&back.reaction).iter().zip(numbers) {
            assert_eq!(back.to_bits(), number.to_bits());
        }
    }

    #[test]
    fn text_that_is_no_number_is_refused_with_its_place() {
        let text = r#"{"bodies": 1, "history": 2, "steps": 1, "at": "soon"}"#;
        let refused = SavedState::from_json(text, "state.json").unwrap_err();
        let refused = refused.to_string();
        assert!(
            refused.contains("state.json:1") && refused.contains("at: `soon`"),
            "{refused}"
        );
    }
}
