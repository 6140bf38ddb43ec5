//! The units that a scene's label names, for legends.

use serde::Serialize;

/// What a label names, each empty where it does not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub(super) struct Symbols {
    pub(super) length: &'static str,
    pub(super) force: &'static str,
    pub(super) stress: &'static str,
}

const LENGTHS: [&str; 9] = ["m", "mm", "cm", "dm", "km", "µm", "nm", "in", "ft"];
const FORCES: [&str; 8] = ["N", "kN", "MN", "mN", "µN", "lbf", "kip", "kgf"];
const STRESSES: [&str; 8] = ["Pa", "kPa", "MPa", "GPa", "psi", "ksi", "bar", "N/mm²"];

impl Symbols {
    /// Those among the words of a label such as `mm, N, MPa`.
    pub(super) fn of(label: &str) -> Self {
        let words: Vec<&str> = label.split([',', ';', ' ', '(', ')']).collect();
        let first = |known: &[&'static str]| {
            let found = words
                .iter()
                .find_map(|word| known.iter().find(|unit| *unit == word));
            found.copied().unwrap_or_default()
        };
        Self {
            length: first(&LENGTHS),
            force: first(&FORCES),
            stress: first(&STRESSES),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_found_by_name_and_not_guessed() {
        let found = Symbols::of("mm, N, MPa (per millimetre of depth)");
        assert_eq!(
            (found.length, found.force, found.stress),
            ("mm", "N", "MPa")
        );
        assert_eq!(Symbols::of("any consistent system"), Symbols::default());
        assert_eq!(Symbols::of("m, N").stress, "");
    }
}
