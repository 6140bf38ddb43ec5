//! The numbers of a record of a .msh file: words of a line, or bytes.

use std::str::{FromStr, SplitAsciiWhitespace};

use crate::error::Error;

/// Byte order of a binary file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// The lowest byte first.
    Little,
    /// The highest byte first.
    Big,
}

/// Where the numbers stand.
pub(super) enum Source<'a> {
    /// On a line.
    Words {
        words: SplitAsciiWhitespace<'a>,
        line: usize,
    },
    /// In a binary file, from a byte on.
    Bytes {
        bytes: &'a [u8],
        at: usize,
        order: Order,
    },
}

/// The numbers of a record, one after the other.
pub(super) struct Fields<'a> {
    file: &'a str,
    source: Source<'a>,
}

impl<'a> Fields<'a> {
    /// Numbers of a source in a file of this name.
    pub(super) fn new(file: &'a str, source: Source<'a>) -> Self {
        Self { file, source }
    }

    fn error(&self, reason: String) -> Error {
        match self.source {
            Source::Words { line, .. } => Error::Mesh {
                file: self.file.to_owned(),
                line,
                reason,
            },
            Source::Bytes { bytes, at, .. } => error_at_byte(bytes, self.file, at, &reason),
        }
    }

    /// Next word of a line.
    pub(super) fn word(&mut self, meaning: &str) -> Result<&'a str, Error> {
        let next = match &mut self.source {
            Source::Words { words, .. } => words.next(),
            Source::Bytes { .. } => None,
        };
        next.ok_or_else(|| self.error(format!("the line ends; expected a {meaning}")))
    }

    /// Next number of a binary file by its byte order; none in an ASCII file.
    fn number<const BYTES: usize, T>(
        &mut self,
        meaning: &str,
        little: fn([u8; BYTES]) -> T,
        big: fn([u8; BYTES]) -> T,
    ) -> Option<Result<T, Error>> {
        let Source::Bytes { bytes, at, order } = &mut self.source else {
            return None;
        };
        let Some(&found) = bytes[*at..].first_chunk::<BYTES>() else {
            let reason = format!("the file ends; expected a {meaning} in {BYTES} bytes");
            return Some(Err(self.error(reason)));
        };
        *at += BYTES;
        Some(Ok(match order {
            Order::Little => little(found),
            Order::Big => big(found),
        }))
    }

    fn parsed<T: FromStr>(&mut self, meaning: &str) -> Result<T, Error> {
        let word = self.word(meaning)?;
        word.parse()
            .map_err(|_| self.error(format!("{} is not a {meaning}", quote(word))))
    }

    /// Next number, of the format's type `int`.
    pub(super) fn int<T: FromStr + TryFrom<i32>>(&mut self, meaning: &str) -> Result<T, Error> {
        let Some(number) = self.number(meaning, i32::from_le_bytes, i32::from_be_bytes) else {
            return self.parsed(meaning);
        };
        let number = number?;
        T::try_from(number).map_err(|_| self.error(format!("{number} is not a {meaning}")))
    }

    /// Next number, of the format's type `size_t`.
    pub(super) fn size<T: FromStr + TryFrom<u64>>(&mut self, meaning: &str) -> Result<T, Error> {
        let Some(number) = self.number(meaning, u64::from_le_bytes, u64::from_be_bytes) else {
            return self.parsed(meaning);
        };
        let number = number?;
        T::try_from(number).map_err(|_| self.error(format!("{number} is not a {meaning}")))
    }

    /// Next number, of the format's type `double`; it must be finite.
    pub(super) fn coordinate(&mut self) -> Result<f64, Error> {
        let value = match self.number("coordinate", f64::from_le_bytes, f64::from_be_bytes) {
            Some(value) => value?,
            None => {
                let word = self.word("coordinate")?;
                let value = word.parse().ok().filter(|value: &f64| value.is_finite());
                let refusal = || self.error(format!("{} is not a finite coordinate", quote(word)));
                return value.ok_or_else(refusal);
            }
        };
        if value.is_finite() {
            return Ok(value);
        }
        Err(self.error(format!("{value} is not a finite coordinate")))
    }

    /// Three coordinates.
    pub(super) fn position(&mut self) -> Result<[f64; 3], Error> {
        Ok([self.coordinate()?, self.coordinate()?, self.coordinate()?])
    }

    /// Where a binary file goes on; further words of a line are refused.
    pub(super) fn end(mut self) -> Result<Option<usize>, Error> {
        match &mut self.source {
            Source::Bytes { at, .. } => Ok(Some(*at)),
            Source::Words { words, .. } => match words.next() {
                None => Ok(None),
                Some(word) => Err(self.error(format!("{} is one word too many", quote(word)))),
            },
        }
    }
}

/// An error at a byte, and at the line that it lies on as editors count them.
pub(super) fn error_at_byte(bytes: &[u8], file: &str, at: usize, reason: &str) -> Error {
    let before = &bytes[..at.min(bytes.len())];
    Error::Mesh {
        file: file.to_owned(),
        line: 1 + before.iter().filter(|&&byte| byte == b'\n').count(),
        reason: format!("byte {at}: {reason}"),
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
