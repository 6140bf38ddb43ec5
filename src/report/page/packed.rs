//! Arrays as they stand in the page: base64 of little-endian numbers of 32 bits.

use serde::Serialize;

use crate::report::base64;

/// An array of numbers of 32 bits as text.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub(super) struct Packed(String);

impl Packed {
    /// Real numbers, rounded to seven digits; what does not exist is NaN.
    pub(super) fn reals(values: impl IntoIterator<Item = f64>) -> Self {
        Self::of(values.into_iter().map(|value| (value as f32).to_le_bytes()))
    }

    /// Counts and indices.
    pub(super) fn integers(values: impl IntoIterator<Item = u32>) -> Self {
        Self::of(values.into_iter().map(u32::to_le_bytes))
    }

    fn of(words: impl Iterator<Item = [u8; 4]>) -> Self {
        let bytes: Vec<u8> = words.flatten().collect();
        let mut text = String::new();
        base64::encode(&bytes, &mut text);
        Self(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_little_endian() {
        // 1 = 01 00 00 00; 1.0 = 3f800000 from the back.
        assert_eq!(Packed::integers([1]), Packed("AQAAAA==".to_owned()));
        assert_eq!(Packed::reals([1.0]), Packed("AACAPw==".to_owned()));
    }
}
