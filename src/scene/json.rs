//! JSON with errors that name line, column, path, value and what is accepted.

use serde::de::DeserializeOwned;

use super::spelling;
use crate::error::Error;

/// Reads `text`; `file` stands for it in messages.
pub(super) fn parse<T: DeserializeOwned>(text: &str, file: &str) -> Result<T, Error> {
    let mut source = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut source).map_err(|error| {
        let place = error.path().to_string();
        locate(file, &place, error.inner())
    })?;
    source.end().map_err(|error| locate(file, ".", &error))?;
    Ok(value)
}

fn locate(file: &str, place: &str, error: &serde_json::Error) -> Error {
    // The root's path is a single dot.
    let place = if place == "." { "scene" } else { place };
    let text = error.to_string();
    let position = format!(" at line {} column {}", error.line(), error.column());
    Error::Json {
        file: file.to_owned(),
        line: error.line(),
        column: error.column(),
        place: place.to_owned(),
        reason: reword(text.strip_suffix(&position).unwrap_or(&text)),
    }
}

/// Says in the user's words what serde says in the programmer's.
fn reword(reason: &str) -> String {
    if let Some(better) = suggest(reason) {
        return better;
    }
    let reason = reason.replace("unit variant, expected struct variant", {
        "a word alone, expected an object with its fields"
    });
    let (found, expected) = match reason.rsplit_once("expected ") {
        Some(parts) => parts,
        None => return reason,
    };
    let expected = match expected {
        "f64" => "a number",
        "usize" => "a whole number >= 0",
        "a string" => "text in quotes",
        "a sequence" => "a list in brackets",
        other => other,
    };
    format!("{found}expected {expected}")
}

/// For an unknown key or choice, names the known one that is spelt most alike.
fn suggest(reason: &str) -> Option<String> {
    let (what, rest) = [("unknown field ", "key"), ("unknown variant ", "choice")]
        .into_iter()
        .find_map(|(start, what)| Some((what, reason.strip_prefix(start)?)))?;
    let (unknown, expected) = rest.strip_prefix('`')?.split_once("`, ")?;
    let known: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
    let hint = match spelling::nearest(unknown, known.iter().copied()) {
        Some(near) => format!(" (did you mean `{near}`?)"),
        None => String::new(),
    };
    Some(format!("unknown {what} `{unknown}`{hint}; {expected}"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    #[allow(dead_code)]
    struct Disc {
        radius: f64,
        cells: Option<[usize; 2]>,
    }

    fn message(text: &str) -> String {
        parse::<Vec<Disc>>(text, "disc.json")
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn an_unknown_key_is_named_with_the_nearest_known_one() {
        assert_eq!(
            message("[{\"radius\": 1},\n {\"raduis\": 2}]"),
            "disc.json:2:10: [1].raduis: unknown key `raduis` (did you mean `radius`?); \
             expected `radius` or `cells`"
        );
    }

    #[test]
    fn a_wrong_value_is_shown_with_what_is_accepted() {
        assert_eq!(
            message("[{\"radius\": \"wide\"}]"),
            "disc.json:1:18: [0].radius: invalid type: string \"wide\", expected a number"
        );
        assert!(
            message("[{\"radius\": 1, \"cells\": [3, -1]}]").contains(
                "[0].cells[1]: invalid value: integer `-1`, expected a whole number >= 0"
            )
        );
    }

    #[test]
    fn numbers_that_overflow_and_text_behind_the_end_are_refused() {
        assert!(message("[{\"radius\": 1e999}]").contains("[0].radius: number out of range"));
        assert!(message("[] []").contains("scene: trailing characters"));
        assert!(message("[{\"radius\": NaN}]").contains("[0].radius: expected value"));
        assert!(message("[{\"radius\"").contains("disc.json:1:"));
    }
}
