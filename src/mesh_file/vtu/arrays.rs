//! Arrays of numbers as VTU files encode them.
//!
//! ```text
//! ascii                   numbers between blanks
//! plain                   [bytes] numbers
//! compressed              [blocks, size of a block, size of the last, compressed size of each] blocks
//! ```
//!
//! Both binary forms stand in the tree in base64, or behind it as they are or in base64. Base64 may end
//! in `=` and begin anew at any place, as headers are often encoded apart.

use std::io::Read;

use flate2::read::ZlibDecoder;
use roxmltree::Node;

use super::Grid;
use crate::error::Error;

/// What is appended behind the tree.
pub(super) struct Appended<'a> {
    bytes: &'a [u8],
    base64: bool,
}

/// The XML tree, closed where numbers are appended behind it, and these.
pub(super) fn split<'a>(
    bytes: &'a [u8],
    name: &str,
) -> Result<(String, Option<Appended<'a>>), Error> {
    const TAG: &[u8] = b"<AppendedData";
    let found = bytes.windows(TAG.len()).position(|window| window == TAG);
    let tree = &bytes[..found.unwrap_or(bytes.len())];
    let fault = |at: usize, reason: &str| Error::Mesh {
        file: name.to_owned(),
        line: 1 + bytes[..at].iter().filter(|&&byte| byte == b'\n').count(),
        reason: reason.to_owned(),
    };
    let text = std::str::from_utf8(tree).map_err(|broken| {
        fault(
            broken.valid_up_to(),
            "no text; expected the XML of a VTU file",
        )
    })?;
    let text = text.trim_start_matches('\u{feff}');
    let Some(start) = found else {
        return Ok((text.to_owned(), None));
    };
    let rest = &bytes[start..];
    let tag = rest.iter().position(|&byte| byte == b'>');
    let tag = &rest[..tag.unwrap_or(rest.len())];
    let base64 = match String::from_utf8_lossy(tag) {
        tag if tag.contains("\"base64\"") => true,
        tag if tag.contains("\"raw\"") => false,
        _ => {
            return Err(fault(
                start,
                "`<AppendedData>`: expected the encoding raw or base64",
            ));
        }
    };
    let data = &rest[tag.len()..];
    let Some(first) = data.iter().position(|&byte| byte == b'_') else {
        return Err(fault(
            start,
            "`<AppendedData>`: expected `_` before the first byte",
        ));
    };
    let appended = Appended {
        bytes: &data[first + 1..],
        base64,
    };
    Ok((format!("{text}</VTKFile>"), Some(appended)))
}

/// The beginning of a word that may be very long.
pub(super) fn quote(word: &str) -> String {
    word.chars().take(40).collect()
}

/// Whether an array holds one whole number per entry.
pub(super) fn is_whole(array: Node<'_, '_>) -> bool {
    let kind = array.attribute("type").unwrap_or_default();
    let components = array.attribute("NumberOfComponents").unwrap_or("1");
    array.has_tag_name("DataArray") && kind.contains("Int") && components == "1"
}

/// The numbers of an array.
pub(super) enum Values {
    Real(Vec<f64>),
    Whole(Vec<i64>),
}

impl Values {
    /// As real numbers.
    pub(super) fn reals(self) -> Vec<f64> {
        match self {
            Self::Real(values) => values,
            Self::Whole(values) => values.into_iter().map(|value| value as f64).collect(),
        }
    }
}

/// How all arrays of a file are encoded.
pub(super) struct Arrays<'a> {
    big_endian: bool,
    /// Bytes of a number in a header.
    header: usize,
    compressed: bool,
    appended: Option<&'a Appended<'a>>,
}

impl<'a> Arrays<'a> {
    pub(super) fn new(grid: &'a Grid<'a>) -> Result<Self, Error> {
        let refuse = |key: &str, found: &str, expected: &str| {
            let found = quote(found);
            grid.error(
                grid.root,
                format!("`{key}` is `{found}`; expected {expected}"),
            )
        };
        let stated = |key: &str, default: &'static str| grid.root.attribute(key).unwrap_or(default);
        Ok(Self {
            big_endian: match stated("byte_order", "LittleEndian") {
                "LittleEndian" => false,
                "BigEndian" => true,
                other => return Err(refuse("byte_order", other, "LittleEndian or BigEndian")),
            },
            header: match stated("header_type", "UInt32") {
                "UInt32" => 4,
                "UInt64" => 8,
                other => return Err(refuse("header_type", other, "UInt32 or UInt64")),
            },
            compressed: match stated("compressor", "") {
                "" => false,
                "vtkZLibDataCompressor" => true,
                other => {
                    let expected = "vtkZLibDataCompressor, or none";
                    return Err(refuse("compressor", other, expected));
                }
            },
            appended: grid.appended.as_ref(),
        })
    }

    /// The numbers of an array, of which there are at most `most`.
    pub(super) fn read(
        &self,
        grid: &Grid<'_>,
        array: Node<'_, '_>,
        most: usize,
    ) -> Result<Values, Error> {
        let kind = array.attribute("type").unwrap_or_default();
        let name = array.attribute("Name").unwrap_or("Points");
        let fault =
            |reason: String| grid.error(array, format!("array `{}`: {reason}", quote(name)));
        let width = width(kind).ok_or_else(|| {
            fault(format!(
                "type `{}`; expected Int8 to UInt64, Float32 or Float64",
                quote(kind)
            ))
        })?;
        let text = || array.text().unwrap_or_default();
        let mut stream = match array.attribute("format").unwrap_or_default() {
            "ascii" => return from_text(text(), kind, most).map_err(fault),
            "binary" => Stream::new(text().as_bytes(), true),
            "appended" => self.behind(array).map_err(fault)?,
            other => {
                let other = quote(other);
                return Err(fault(format!(
                    "format `{other}`; expected ascii, binary or appended"
                )));
            }
        };
        let bytes = self.bytes(&mut stream, most.saturating_mul(width));
        let bytes = bytes.map_err(fault)?;
        if !bytes.len().is_multiple_of(width) {
            return Err(fault(format!(
                "{} bytes; expected {width} per number",
                bytes.len()
            )));
        }
        from_bytes(bytes, kind, width, self.big_endian).map_err(fault)
    }

    /// The bytes of an array behind the tree.
    fn behind(&self, array: Node<'_, '_>) -> Result<Stream<'a>, String> {
        let appended = self.appended.ok_or("no `<AppendedData>` in the file")?;
        let stated = array.attribute("offset").unwrap_or_default();
        let offset = stated.trim().parse::<usize>().ok();
        let bytes = offset.and_then(|offset| appended.bytes.get(offset..));
        let bytes =
            bytes.ok_or_else(|| format!("offset `{}` is not in the file", quote(stated)))?;
        Ok(Stream::new(bytes, appended.base64))
    }

    /// The bytes of the numbers, of which there are at most `most`.
    fn bytes(&self, stream: &mut Stream<'_>, most: usize) -> Result<Vec<u8>, String> {
        let too_many = |found: usize| format!("{found} bytes; expected at most {most}");
        let first = self.number(stream)?;
        if !self.compressed {
            return match first <= most {
                true => stream.take(first),
                false => Err(too_many(first)),
            };
        }
        let (size, last) = (self.number(stream)?, self.number(stream)?);
        let total = first.saturating_mul(size);
        if total > most.saturating_add(size) || size > most.max(1 << 24) || last > size {
            return Err(too_many(total));
        }
        let mut lengths = Vec::new();
        for _ in 0..first {
            lengths.push(self.number(stream)?);
        }
        let mut bytes = Vec::new();
        for (at, length) in lengths.into_iter().enumerate() {
            let expected = if at + 1 == first && last > 0 {
                last
            } else {
                size
            };
            let block = stream.take(length)?;
            let before = bytes.len();
            let mut inflated = ZlibDecoder::new(&block[..]).take(expected as u64 + 1);
            let read = inflated.read_to_end(&mut bytes);
            read.map_err(|error| format!("block {at} of zlib is broken ({error})"))?;
            let found = bytes.len() - before;
            if found != expected {
                return Err(format!(
                    "block {at} of zlib has another length than {expected}"
                ));
            }
        }
        match bytes.len() <= most {
            true => Ok(bytes),
            false => Err(too_many(bytes.len())),
        }
    }

    /// A number of a header.
    fn number(&self, stream: &mut Stream<'_>) -> Result<usize, String> {
        let mut bytes = [0; 8];
        let read = stream.take(self.header)?;
        bytes[..read.len()].copy_from_slice(&read);
        if self.big_endian {
            bytes[..read.len()].reverse();
        }
        usize::try_from(u64::from_le_bytes(bytes)).map_err(|error| error.to_string())
    }
}

/// Bytes of a number.
fn width(kind: &str) -> Option<usize> {
    match kind {
        "Int8" | "UInt8" => Some(1),
        "Int16" | "UInt16" => Some(2),
        "Int32" | "UInt32" | "Float32" => Some(4),
        "Int64" | "UInt64" | "Float64" => Some(8),
        _ => None,
    }
}

fn from_text(text: &str, kind: &str, most: usize) -> Result<Values, String> {
    let words = text.split_ascii_whitespace().take(most.saturating_add(1));
    let no = |word: &str, what: &str| format!("`{}` is no {what} number", quote(word));
    let real = |word: &str| word.parse().map_err(|_| no(word, "real"));
    let whole = |word: &str| word.parse().map_err(|_| no(word, "whole"));
    Ok(match kind.starts_with("Float") {
        true => Values::Real(words.map(real).collect::<Result<_, _>>()?),
        false => Values::Whole(words.map(whole).collect::<Result<_, _>>()?),
    })
}

fn from_bytes(
    mut bytes: Vec<u8>,
    kind: &str,
    width: usize,
    big_endian: bool,
) -> Result<Values, String> {
    if big_endian {
        bytes.chunks_exact_mut(width).for_each(<[u8]>::reverse);
    }
    let signed = !kind.starts_with('U');
    let numbers = bytes.chunks_exact(width);
    let whole = |number: &[u8]| {
        let negative = signed && number[width - 1] >= 0x80;
        let mut wide = [if negative { 0xff } else { 0 }; 8];
        wide[..width].copy_from_slice(number);
        i64::from_le_bytes(wide)
    };
    Ok(match kind {
        "Float32" => Values::Real(
            numbers
                .map(|number| f64::from(f32::from_bits(whole(number) as u32)))
                .collect(),
        ),
        "Float64" => Values::Real(
            numbers
                .map(|number| f64::from_bits(whole(number) as u64))
                .collect(),
        ),
        _ => {
            let values: Vec<i64> = numbers.map(whole).collect();
            match values.iter().find(|value| !signed && **value < 0) {
                Some(value) => return Err(format!("{} is too large a number", *value as u64)),
                None => Values::Whole(values),
            }
        }
    })
}

/// Bytes from a place on, maybe in base64.
struct Stream<'a> {
    bytes: &'a [u8],
    base64: bool,
    /// Bytes of the last four characters that were not taken, in reverse.
    held: Vec<u8>,
}

impl<'a> Stream<'a> {
    fn new(bytes: &'a [u8], base64: bool) -> Self {
        Self {
            bytes,
            base64,
            held: Vec::new(),
        }
    }

    /// The next bytes.
    fn take(&mut self, count: usize) -> Result<Vec<u8>, String> {
        let ends = || format!("it ends before {count} bytes");
        if count > self.bytes.len() + self.held.len() {
            return Err(ends());
        }
        if !self.base64 {
            let (taken, rest) = self.bytes.split_at(count);
            self.bytes = rest;
            return Ok(taken.to_vec());
        }
        let mut taken = Vec::with_capacity(count);
        while taken.len() < count {
            match self.held.pop() {
                Some(byte) => taken.push(byte),
                None => self.decode().ok_or_else(ends)?,
            }
        }
        Ok(taken)
    }

    /// Decodes the next four characters; none at the end or at what is no base64.
    fn decode(&mut self) -> Option<()> {
        let (mut bits, mut digits, mut signs) = (0_u32, 0, 0);
        while signs < 4 {
            let (&first, rest) = self.bytes.split_first()?;
            self.bytes = rest;
            let digit = match first {
                b'A'..=b'Z' => first - b'A',
                b'a'..=b'z' => first - b'a' + 26,
                b'0'..=b'9' => first - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                b'=' => {
                    (bits, signs) = (bits << 6, signs + 1);
                    continue;
                }
                _ if first.is_ascii_whitespace() => continue,
                _ => return None,
            };
            (bits, signs, digits) = (bits << 6 | u32::from(digit), signs + 1, digits + 1);
        }
        let decoded = bits.to_be_bytes();
        let count = match digits {
            4 => 3,
            3 => 2,
            2 => 1,
            _ => return None,
        };
        self.held.extend(decoded[1..=count].iter().rev());
        Some(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn base64_may_end_and_begin_anew() {
        // "Ma" + "n" encoded apart (TWE= and bg==), with a line between.
        let mut stream = Stream::new(b"TWE=\n  bg==", true);
        assert_eq!(stream.take(1).unwrap(), b"M");
        assert_eq!(stream.take(2).unwrap(), b"an");
        assert!(stream.take(1).is_err());
        assert!(Stream::new(b"T!E=", true).take(1).is_err());
    }

    #[test]
    fn numbers_keep_sign_and_byte_order() {
        let Values::Whole(found) = from_bytes(vec![0xff, 0xfe], "Int16", 2, true).unwrap() else {
            unreachable!()
        };
        assert_eq!(found, [-2]);
        let three = 1.5_f32.to_be_bytes().to_vec();
        assert_eq!(
            from_bytes(three, "Float32", 4, true).unwrap().reals(),
            [1.5]
        );
        assert!(from_bytes(vec![0xff; 8], "UInt64", 8, false).is_err());
    }
}
