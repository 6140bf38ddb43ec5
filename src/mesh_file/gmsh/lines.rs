//! The lines of a .msh file, with their numbers for messages.

use std::fmt::Display;
use std::str::{FromStr, SplitAsciiWhitespace};

use crate::error::Error;

/// Steps through the lines of a file; empty lines are passed over.
pub(super) struct Lines<'a> {
    rest: std::str::Lines<'a>,
    file: &'a str,
    number: usize,
}

impl<'a> Lines<'a> {
    /// The lines of `text`; `file` names it in messages.
    pub(super) fn new(text: &'a str, file: &'a str) -> Self {
        Self {
            rest: text.lines(),
            file,
            number: 0,
        }
    }

    /// Number of the line read last, from 1.
    pub(super) fn number(&self) -> usize {
        self.number
    }

    /// An error at the line read last.
    pub(super) fn error(&self, reason: impl Into<String>) -> Error {
        self.error_at(self.number, reason)
    }

    /// An error at an earlier line.
    pub(super) fn error_at(&self, line: usize, reason: impl Into<String>) -> Error {
        Error::Mesh {
            file: self.file.to_owned(),
            line,
            reason: reason.into(),
        }
    }

    fn advance(&mut self) -> Option<&'a str> {
        loop {
            let line = self.rest.next()?.trim();
            self.number += 1;
            if !line.is_empty() {
                return Some(line);
            }
        }
    }

    /// Next line inside a section; the end of file or of the section is an error.
    pub(super) fn line(&mut self, expected: &dyn Display) -> Result<&'a str, Error> {
        match self.advance() {
            None => Err(self.error(format!("the file ends; expected {expected}"))),
            Some(line) if line.starts_with('$') => {
                Err(self.error(format!("expected {expected}, found {}", quote(line))))
            }
            Some(line) => Ok(line),
        }
    }

    /// Next line inside a section, cut into its words.
    pub(super) fn fields(&mut self, expected: &dyn Display) -> Result<Fields<'a>, Error> {
        let line = self.line(expected)?;
        Ok(Fields {
            words: line.split_ascii_whitespace(),
            file: self.file,
            number: self.number,
        })
    }

    /// Name of the next section, none at the end of the file.
    pub(super) fn section(&mut self) -> Result<Option<&'a str>, Error> {
        match self.advance() {
            None => Ok(None),
            Some(line) => match line.strip_prefix('$') {
                Some(name) if !name.starts_with("End") => Ok(Some(name)),
                _ => Err(self.error(format!(
                    "expected the start of a section, found {}",
                    quote(line)
                ))),
            },
        }
    }

    /// Reads the line that closes a section.
    pub(super) fn end(&mut self, section: &str) -> Result<(), Error> {
        match self.advance() {
            Some(line) if line.strip_prefix("$End") == Some(section) => Ok(()),
            Some(line) => Err(self.error(format!(
                "expected `$End{section}` after the announced count, found {}",
                quote(line)
            ))),
            None => Err(self.error(format!("the file ends; expected `$End{section}`"))),
        }
    }

    /// Passes over a section's lines up to the one that closes it.
    pub(super) fn skip(&mut self, section: &str) -> Result<(), Error> {
        loop {
            let mut ahead = self.rest.clone();
            match ahead.next().map(str::trim) {
                None => return Ok(()),
                Some(line) if line.strip_prefix("$End") == Some(section) => return Ok(()),
                Some(_) => {
                    self.rest = ahead;
                    self.number += 1;
                }
            }
        }
    }
}

/// The words of one line.
pub(super) struct Fields<'a> {
    words: SplitAsciiWhitespace<'a>,
    file: &'a str,
    number: usize,
}

impl<'a> Fields<'a> {
    fn error(&self, reason: String) -> Error {
        Error::Mesh {
            file: self.file.to_owned(),
            line: self.number,
            reason,
        }
    }

    /// Next word.
    pub(super) fn word(&mut self, meaning: &str) -> Result<&'a str, Error> {
        self.words
            .next()
            .ok_or_else(|| self.error(format!("the line ends; expected a {meaning}")))
    }

    /// Next word as an integer.
    pub(super) fn integer<T: FromStr>(&mut self, meaning: &str) -> Result<T, Error> {
        let word = self.word(meaning)?;
        word.parse()
            .map_err(|_| self.error(format!("{} is not a {meaning}", quote(word))))
    }

    /// Next word as a finite number.
    pub(super) fn coordinate(&mut self) -> Result<f64, Error> {
        let word = self.word("coordinate")?;
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(self.error(format!("{} is not a finite coordinate", quote(word)))),
        }
    }

    /// Three coordinates.
    pub(super) fn position(&mut self) -> Result<[f64; 3], Error> {
        Ok([self.coordinate()?, self.coordinate()?, self.coordinate()?])
    }

    /// Refuses further words.
    pub(super) fn end(mut self) -> Result<(), Error> {
        match self.words.next() {
            None => Ok(()),
            Some(word) => Err(self.error(format!("{} is one word too many", quote(word)))),
        }
    }
}

/// Text of the file as it is shown in a message: quoted, and never long.
pub(super) fn quote(text: &str) -> String {
    const SHOWN: usize = 40;
    match text.char_indices().nth(SHOWN) {
        None => format!("`{text}`"),
        Some((cut, _)) => format!("`{}…`", &text[..cut]),
    }
}
