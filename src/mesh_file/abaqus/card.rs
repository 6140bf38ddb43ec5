//! Cards: a keyword with its parameters, and the data lines below it.
//!
//! ```text
//! *ELEMENT, TYPE = C3D8,      keyword, parameters; a comma at the end goes on in the next line
//!   ELSET = Eall
//! 1, 1, 2, 3, 4, 5, 6, 7, 8   data: fields between commas
//! ```
//!
//! Case and blanks count nowhere but inside a field, where a blank is a comma forgotten.

use super::lines::{Line, Source};
use crate::error::Error;

/// A keyword with its data lines.
#[derive(Clone, Debug)]
pub(crate) struct Card<'a> {
    /// In capitals, without `*` and blanks, such as `SOLIDSECTION`.
    pub(crate) name: String,
    /// As a reader knows it, such as `*SOLID SECTION`.
    pub(crate) shown: String,
    /// In capitals; the value is empty where none is given.
    pub(crate) parameters: Vec<(String, String)>,
    lines: Vec<Line<'a>>,
    /// The keyword's own line.
    pub(crate) line: Line<'a>,
}

/// The cards of a deck in reading order.
pub(crate) fn cards(source: &Source) -> Result<Vec<Card<'_>>, Error> {
    let mut cards: Vec<Card<'_>> = Vec::new();
    let mut lines = source.lines();
    while let Some(line) = lines.next() {
        if !line.is_keyword() {
            let Some(card) = cards.last_mut() else {
                return Err(line.error("data before the first keyword; expected `*` and a keyword"));
            };
            card.lines.push(line);
            continue;
        }
        let mut keyword = line.text.to_owned();
        while keyword.ends_with(',') {
            let Some(next) = lines.next() else { break };
            if next.is_keyword() {
                return Err(line.error(format!(
                    "{}: ends in a comma, and no parameter follows",
                    shown(&keyword)
                )));
            }
            keyword.push_str(next.text);
        }
        cards.push(card(line, &keyword));
    }
    Ok(cards)
}

fn card<'a>(line: Line<'a>, keyword: &str) -> Card<'a> {
    let mut words = keyword[1..].split(',');
    let parameters = |word: &str| {
        let (key, value) = word.split_once('=').unwrap_or((word, ""));
        (bare(key), bare(value))
    };
    Card {
        name: bare(words.next().unwrap_or_default()),
        shown: shown(keyword),
        parameters: words
            .map(parameters)
            .filter(|(key, _)| !key.is_empty())
            .collect(),
        lines: Vec::new(),
        line,
    }
}

/// A keyword as it is shown: in capitals, with single blanks.
fn shown(keyword: &str) -> String {
    let name = keyword[1..].split(',').next().unwrap_or_default();
    let words: Vec<String> = name.split_whitespace().map(str::to_uppercase).collect();
    format!("*{}", quote(&words.join(" ")))
}

/// A name in capitals, without blanks and quotation marks.
pub(crate) fn bare(text: &str) -> String {
    let kept = text.chars().filter(|c| !c.is_whitespace() && *c != '"');
    kept.flat_map(char::to_uppercase).collect()
}

/// The beginning of a word that may be very long.
pub(super) fn quote(text: &str) -> String {
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

impl<'a> Card<'a> {
    /// What is wrong with the keyword.
    pub(crate) fn error(&self, reason: impl std::fmt::Display) -> Error {
        self.head(0).error(reason)
    }

    /// Where the card stands, for notes.
    pub(crate) fn place(&self) -> String {
        format!("{}:{}: {}", self.line.file, self.line.number, self.shown)
    }

    /// The value of a parameter, empty where it has none.
    pub(crate) fn get(&self, key: &str) -> Option<&str> {
        let found = self.parameters.iter().find(|(name, _)| name == key);
        found.map(|(_, value)| value.as_str())
    }

    /// The value of a parameter that must be there.
    pub(crate) fn need(&self, key: &str) -> Result<&str, Error> {
        match self.get(key) {
            Some(value) if !value.is_empty() => Ok(value),
            _ => Err(self.error(format!("expected `{key}=` and a name"))),
        }
    }

    /// Refuses every parameter but these.
    pub(crate) fn only(&self, known: &[&str]) -> Result<(), Error> {
        let unknown = |(key, _): &&(String, String)| !known.contains(&key.as_str());
        match self.parameters.iter().find(unknown) {
            None => Ok(()),
            Some((key, _)) => Err(self.error(format!(
                "parameter `{}` is not read; accepted: {}",
                quote(key),
                known.join(", ")
            ))),
        }
    }

    /// Refuses a parameter's value that is none of these; left out it is accepted.
    pub(crate) fn one_of(&self, key: &str, accepted: &[&str]) -> Result<(), Error> {
        match self.get(key) {
            Some(value) if !accepted.contains(&value) => Err(self.error(format!(
                "`{key}={}` is not read; accepted: {}",
                quote(value),
                accepted.join(", ")
            ))),
            _ => Ok(()),
        }
    }

    /// Its data lines, whose words are known in a scope.
    pub(crate) fn rows(&self, scope: usize) -> impl Iterator<Item = Row<'_, 'a>> {
        let row = move |&line: &Line<'a>| Row {
            scope,
            card: self,
            line,
        };
        self.lines.iter().map(row)
    }

    /// Its own line as one whose words are known in a scope.
    pub(crate) fn head(&self, scope: usize) -> Row<'_, 'a> {
        Row {
            scope,
            card: self,
            line: self.line,
        }
    }

    /// Its only data line.
    pub(crate) fn row(&self, what: &str) -> Result<Row<'_, 'a>, Error> {
        let mut rows = self.rows(0);
        match (rows.next(), rows.next()) {
            (Some(row), None) => Ok(row),
            (None, _) => Err(self.error(format!("expected a line with {what}"))),
            (_, Some(second)) => Err(second.error(format!("one line too many; expected {what}"))),
        }
    }
}

/// A data line of a card.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<'c, 'a> {
    /// The scope that its words are known in.
    pub(crate) scope: usize,
    /// Its card.
    pub(crate) card: &'c Card<'a>,
    line: Line<'a>,
}

impl<'a> Row<'_, 'a> {
    /// What is wrong in it.
    pub(crate) fn error(&self, reason: impl std::fmt::Display) -> Error {
        self.line.error(format!("{}: {reason}", self.card.shown))
    }

    /// The words between commas; a comma at the end ends the last one.
    pub(crate) fn words(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        let text = self.line.text;
        let text = text.strip_suffix(',').unwrap_or(text);
        text.split(',').map(str::trim)
    }

    /// Word number `at`, empty where there is none.
    pub(crate) fn word(&self, at: usize) -> &'a str {
        self.words().nth(at).unwrap_or_default()
    }

    /// Word number `at` as a number; `default` where it is left out.
    pub(crate) fn number(
        &self,
        at: usize,
        what: &str,
        default: impl Into<Option<f64>>,
    ) -> Result<f64, Error> {
        match (self.word(at), default.into()) {
            ("", Some(default)) => Ok(default),
            (word, _) => self.number_of(word, what),
        }
    }

    /// A word as a number; Fortran's `1.d5` is one.
    pub(crate) fn number_of(&self, word: &str, what: &str) -> Result<f64, Error> {
        let number = word.replace(['d', 'D'], "e").parse::<f64>();
        let number = number.ok().filter(|number| number.is_finite());
        number.ok_or_else(|| self.no(word, &format!("finite number; expected {what}")))
    }

    /// A word as the number of a node or an element.
    pub(crate) fn label(&self, word: &str, what: &str) -> Result<u64, Error> {
        let number = word.parse().ok().filter(|number| *number > 0);
        number.ok_or_else(|| self.no(word, &format!("{what}; expected a whole number above 0")))
    }

    fn no(&self, word: &str, what: &str) -> Error {
        let hint = match word.contains(char::is_whitespace) {
            true => " (a comma is missing between two words)",
            false => "",
        };
        self.error(format!("`{}` is no {what}{hint}", quote(word)))
    }
}
