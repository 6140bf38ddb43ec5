//! Computed answers beside exact ones, as they are reported.

use std::fmt::Write;

use serde::Serialize;

/// A gallery of scenes whose answers are known.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verification {
    /// Without the finest meshes.
    pub quick: bool,
    /// Every scene passed.
    pub passed: bool,
    /// Scene by scene.
    pub scenes: Vec<VerifiedScene>,
}

/// A scene whose answer is known.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VerifiedScene {
    /// What it is.
    pub name: &'static str,
    /// Where the known answer comes from.
    pub source: &'static str,
    /// What keeps the error from vanishing on ever finer meshes.
    pub floor: &'static str,
    /// The scene on a coarse mesh, drawn in SVG, where it is plane and a page is wanted.
    #[serde(skip)]
    pub picture: Option<String>,
    /// All of its quantities passed.
    pub passed: bool,
    /// Time that it took, in second.
    pub seconds: f64,
    /// Quantity by quantity.
    pub quantities: Vec<VerifiedQuantity>,
}

/// A quantity, computed on a ladder of meshes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VerifiedQuantity {
    /// What it is, with its unit.
    pub quantity: &'static str,
    /// When it passes.
    pub criterion: Criterion,
    /// Mesh by mesh, from coarse to fine.
    pub ladder: Vec<Rung>,
    /// Exponent p of a least-squares fit of error ~ size^p; `null` where the error does not
    /// depend on the mesh.
    pub rate: Option<f64>,
    /// Whether the criterion holds and every solve ended as it should.
    pub passed: bool,
}

/// A quantity on one mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rung {
    /// Mesh, in words.
    pub mesh: String,
    /// Size of its cells, in a unit of the scene's own.
    pub size: f64,
    /// The scenes solved on it ended as they should: certified, or proved to be without equilibrium.
    pub settled: bool,
    /// Value found; `null` for a field.
    pub computed: Option<f64>,
    /// Known value; `null` for a field.
    pub exact: Option<f64>,
    /// Relative error, of a field in the norm that the quantity names; `null` where it is no number.
    pub error: f64,
}

/// When a quantity passes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "criterion", rename_all = "snake_case")]
pub enum Criterion {
    /// The error is at most `within` on every mesh.
    EveryMesh {
        /// Largest relative error.
        within: f64,
    },
    /// The error is at most `within` on the finest mesh.
    FinestMesh {
        /// Largest relative error.
        within: f64,
    },
    /// The error is at most `within` on the finest mesh and falls at least at this rate.
    Converges {
        /// Largest relative error.
        within: f64,
        /// Least exponent of the size.
        rate: f64,
    },
    /// Shown beside a value of another theory; not judged.
    Compared,
}

impl Verification {
    /// The gallery as indented JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Plain structs with string keys: there is nothing that could fail to serialise.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// A table: scene by scene, quantity by quantity; numbers are those of the finest mesh, errors
    /// those of all.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = row(
            "quantity",
            "here",
            "exact",
            "errors, coarse to fine",
            "rate",
        );
        text.push_str("criterion\n");
        for scene in &self.scenes {
            let VerifiedScene { name, source, .. } = scene;
            let _ = writeln!(text, "{name} [{source}], {:.1} s", scene.seconds);
            for quantity in &scene.quantities {
                let _ = writeln!(text, "{}", quantity.row());
            }
            if !scene.floor.is_empty() {
                let _ = writeln!(text, "  floor: {}", scene.floor);
            }
        }
        let passed = self.scenes.iter().filter(|scene| scene.passed).count();
        let _ = writeln!(text, "{passed} of {} scenes pass", self.scenes.len());
        text
    }
}

impl VerifiedQuantity {
    fn row(&self) -> String {
        let errors: Vec<_> = self.ladder.iter().map(|rung| size(rung.error)).collect();
        let of_finest = |value: fn(&Rung) -> Option<f64>| {
            let value = self.ladder.last().and_then(value);
            value.map_or_else(String::new, number)
        };
        let rate = self
            .rate
            .map_or_else(String::new, |rate| format!("{rate:.2}"));
        let (here, exact) = (
            of_finest(|rung| rung.computed),
            of_finest(|rung| rung.exact),
        );
        let mut text = row(self.quantity, &here, &exact, &errors.join(" "), &rate);
        text.push_str(&self.verdict());
        text
    }

    /// The criterion in words, and whether it holds.
    pub(super) fn verdict(&self) -> String {
        let verdict = match (self.criterion, self.passed) {
            (_, false) => ": FAIL",
            (Criterion::Compared, true) => "",
            (_, true) => ": pass",
        };
        self.criterion.words() + verdict
    }
}

/// All columns but the last.
fn row(quantity: &str, here: &str, exact: &str, errors: &str, rate: &str) -> String {
    format!("  {quantity:<29}{here:>12}{exact:>12}  {errors:<40}{rate:>5}  ")
}

impl Criterion {
    fn words(self) -> String {
        match self {
            Self::EveryMesh { within } => format!("each <= {}", size(within)),
            Self::FinestMesh { within } => format!("last <= {}", size(within)),
            Self::Converges { within, rate } => {
                format!("last <= {}, rate >= {rate}", size(within))
            }
            Self::Compared => "not judged".to_owned(),
        }
    }
}

pub(super) fn number(value: f64) -> String {
    let digits = value.abs().log10().floor();
    if (-3.0..6.0).contains(&digits) {
        format!("{value:.*}", (6.0 - digits) as usize)
    } else {
        format!("{value:.5e}")
    }
}

pub(super) fn size(error: f64) -> String {
    if error == 0.0 {
        return "0".to_owned();
    }
    format!("{error:.1e}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_that_fails_says_so_in_its_row() {
        let mut quantity = VerifiedQuantity {
            quantity: "load, N",
            criterion: Criterion::FinestMesh { within: 0.01 },
            ladder: vec![Rung {
                mesh: "one cell".to_owned(),
                size: 1.0,
                settled: true,
                computed: Some(99.0),
                exact: Some(100.0),
                error: 0.01,
            }],
            rate: None,
            passed: true,
        };
        let row = quantity.row();
        assert!(
            row.contains("99.00000") && row.contains("100.0000"),
            "{row}"
        );
        assert!(row.ends_with("last <= 1.0e-2: pass"), "{row}");
        quantity.passed = false;
        assert!(quantity.row().ends_with("FAIL"));
        quantity.criterion = Criterion::Compared;
        quantity.passed = true;
        assert!(quantity.row().ends_with("not judged"));
    }

    #[test]
    fn numbers_keep_seven_digits() {
        let found = [28.602, -1.30264, 12_000.0, -1.405_36e6, 0.0, 1e-9].map(number);
        let expected = [
            "28.60200",
            "-1.302640",
            "12000.00",
            "-1.40536e6",
            "0.00000e0",
            "1.00000e-9",
        ];
        assert_eq!(found, expected);
    }
}
