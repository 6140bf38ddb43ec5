//! The lines of a .msh file, and the numbers of a binary one, with their places for messages.
//!
//! A binary file holds lines too (names of sections, physical names, counts of MSH 2.2). Between them
//! stand bare numbers in the order of an ASCII file: `int` 4 bytes, `size_t` and `double` 8.

use std::fmt::Display;

use super::super::elements::Places;
use super::fields::{Fields, Order, Source, error_at_byte, quote};
use crate::error::Error;

/// Steps through a file; empty lines are passed over.
pub(super) struct Lines<'a> {
    bytes: &'a [u8],
    /// Number of bytes read.
    at: usize,
    /// Where that begins which was read last.
    start: usize,
    /// Number of lines read.
    number: usize,
    /// Byte order of a binary file, none in an ASCII one.
    order: Option<Order>,
    file: &'a str,
}

impl Places for Lines<'_> {
    fn fault(&self, place: Option<usize>, reason: String) -> Error {
        self.error_at(place.unwrap_or_else(|| self.place()), reason)
    }

    fn name_of(&self, place: usize) -> String {
        let unit = if self.binary() { "byte" } else { "line" };
        format!("{unit} {place}")
    }
}

impl<'a> Lines<'a> {
    /// The lines of a file that is ASCII as far as is known; `file` names it in messages.
    pub(super) fn new(bytes: &'a [u8], file: &'a str) -> Self {
        Self {
            bytes,
            at: 0,
            start: 0,
            number: 0,
            order: None,
            file,
        }
    }

    /// Whether bare numbers stand between the lines.
    pub(super) fn binary(&self) -> bool {
        self.order.is_some()
    }

    /// Place of what was read last: its line, from 1, or in a binary file its first byte, from 0.
    pub(super) fn place(&self) -> usize {
        if self.binary() {
            self.start
        } else {
            self.number
        }
    }

    /// An error at what was read last.
    pub(super) fn error(&self, reason: impl Into<String>) -> Error {
        self.error_at(self.place(), reason)
    }

    /// An error at an earlier place.
    pub(super) fn error_at(&self, place: usize, reason: impl Into<String>) -> Error {
        if self.binary() {
            return error_at_byte(self.bytes, self.file, place, &reason.into());
        }
        Error::Mesh {
            file: self.file.to_owned(),
            line: place,
            reason: reason.into(),
        }
    }

    /// Reads the number one behind the format's line, which tells the byte order.
    pub(super) fn read_order(&mut self) -> Result<(), Error> {
        self.start = self.at;
        let one = self.bytes[self.at..].first_chunk::<4>();
        self.order = match one {
            Some([1, 0, 0, 0]) => Some(Order::Little),
            Some([0, 0, 0, 1]) => Some(Order::Big),
            _ => {
                let found = match one {
                    Some(bytes) => format!("found the bytes {bytes:02x?}"),
                    None => "the file ends".to_owned(),
                };
                let expected =
                    "expected the number 1 in four bytes, as the file is binary (file type 1)";
                return Err(error_at_byte(
                    self.bytes,
                    self.file,
                    self.at,
                    &format!("{found}; {expected}"),
                ));
            }
        };
        self.at += 4;
        Ok(())
    }

    fn advance(&mut self) -> Result<Option<&'a str>, Error> {
        loop {
            let bytes = self.bytes;
            let rest = &bytes[self.at..];
            self.start = self.at;
            if rest.is_empty() {
                return Ok(None);
            }
            let end = rest.iter().position(|&byte| byte == b'\n');
            let line = &rest[..end.map_or(rest.len(), |end| end + 1)];
            self.at += line.len();
            self.number += 1;
            let text = std::str::from_utf8(line).map_err(|broken| {
                let byte = line[broken.valid_up_to()];
                self.error(format!(
                    "byte {byte:#04x} is not text; expected a line of text"
                ))
            })?;
            if !text.trim().is_empty() {
                return Ok(Some(text.trim()));
            }
        }
    }

    /// Next line inside a section; the end of file or of the section is an error.
    pub(super) fn line(&mut self, expected: &dyn Display) -> Result<&'a str, Error> {
        match self.advance()? {
            None => Err(self.error(format!("the file ends; expected {expected}"))),
            Some(line) if line.starts_with('$') => {
                Err(self.error(format!("expected {expected}, found {}", quote(line))))
            }
            Some(line) => Ok(line),
        }
    }

    /// Next line inside a section, cut into its words.
    pub(super) fn fields(&mut self, expected: &dyn Display) -> Result<Fields<'a>, Error> {
        let words = self.line(expected)?.split_ascii_whitespace();
        let line = self.number;
        Ok(Fields::new(self.file, Source::Words { words, line }))
    }

    /// What an ASCII file has on one line: that line, or the bare numbers from here on.
    pub(super) fn record(&mut self, expected: &dyn Display) -> Result<Fields<'a>, Error> {
        let Some(order) = self.order else {
            return self.fields(expected);
        };
        self.start = self.at;
        let (bytes, at) = (self.bytes, self.at);
        Ok(Fields::new(self.file, Source::Bytes { bytes, at, order }))
    }

    /// Goes on behind the fields of a record; words left on its line are refused.
    pub(super) fn close(&mut self, fields: Fields<'a>) -> Result<(), Error> {
        if let Some(at) = fields.end()? {
            self.at = at;
        }
        Ok(())
    }

    /// Name of the next section, none at the end of the file.
    pub(super) fn section(&mut self) -> Result<Option<&'a str>, Error> {
        match self.advance()? {
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
        match self.advance()? {
            Some(line) if line.strip_prefix("$End") == Some(section) => Ok(()),
            Some(line) => Err(self.error(format!(
                "expected `$End{section}` after the announced count, found {}",
                quote(line)
            ))),
            None => Err(self.error(format!("the file ends; expected `$End{section}`"))),
        }
    }

    /// Passes over a section up to the line that closes it.
    pub(super) fn skip(&mut self, section: &str) -> Result<(), Error> {
        if self.binary() {
            let end = format!("$End{section}");
            let rest = &self.bytes[self.at..];
            let found = rest
                .windows(end.len())
                .position(|bytes| bytes == end.as_bytes());
            self.at += found.unwrap_or(rest.len());
            return Ok(());
        }
        loop {
            let before = (self.at, self.number);
            match self.advance()? {
                None => return Ok(()),
                Some(line) if line.strip_prefix("$End") == Some(section) => {
                    (self.at, self.number) = before;
                    return Ok(());
                }
                Some(_) => {}
            }
        }
    }
}
