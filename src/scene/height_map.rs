//! Height maps from files: what a profilometer, or another program, measured on a grid.
//!
//! ```text
//! .npy   NumPy array of rows along x, `float64` or `float32`, little endian, in C order
//! .csv   a row of heights per line, apart by commas, semicolons, tabs or blanks
//! .txt   the same behind lines that start with #, as Gwyddion exports them: of these `Width`, `Height`
//!        and `Value units` are read, with their units
//! ```
//!
//! Row `j` of the file is row `j` of the grid: y grows downwards.

use std::path::Path;

use crate::error::Error;

/// Heights, and how large the map says it is.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct HeightMap {
    /// Columns and rows.
    pub(super) cells: [usize; 2],
    /// Row by row; in the unit of the file.
    pub(super) heights: Vec<f64>,
    /// Sides, in metre, where the file names them.
    pub(super) size: Option<[f64; 2]>,
    /// Metres per unit of the heights, where the file names it.
    pub(super) unit: Option<f64>,
}

impl HeightMap {
    /// Reads a file's bytes; `place` stands for it in messages.
    pub(super) fn read(place: &str, path: &Path, bytes: &[u8]) -> Result<Self, Error> {
        let map = match path.extension().and_then(|ending| ending.to_str()) {
            Some("npy") => Self::of_npy(bytes),
            Some("csv" | "txt" | "asc" | "dat") => Self::of_text(bytes),
            _ => Err("ends on none of .npy, .csv, .txt, .asc, .dat".to_owned()),
        };
        let refuse = |reason: String| Error::Unreadable {
            place: place.to_owned(),
            file: path.display().to_string(),
            reason,
        };
        let map = map.map_err(refuse)?;
        match map.heights.iter().position(|height| !height.is_finite()) {
            None => Ok(map),
            Some(at) => {
                let (column, row) = (at % map.cells[0], at / map.cells[0]);
                let height = map.heights[at];
                Err(refuse(format!(
                    "the height in row {row}, column {column} is {height}; expected a number \
                     everywhere: fill what was not measured"
                )))
            }
        }
    }

    fn of_npy(bytes: &[u8]) -> Result<Self, String> {
        let short = || "ends before its header does".to_owned();
        let magic = bytes
            .strip_prefix(b"\x93NUMPY")
            .ok_or("is no NumPy array")?;
        let (&version, rest) = magic.split_first().ok_or_else(short)?;
        let width = if version == 1 { 2 } else { 4 };
        let length = rest.get(1..1 + width).ok_or_else(short)?;
        let length = length
            .iter()
            .rev()
            .fold(0, |sum, byte| sum << 8 | usize::from(*byte));
        let rest = &rest[1 + width..];
        let header = rest.get(..length).ok_or_else(short)?;
        let header = String::from_utf8_lossy(header);
        let numbers = &rest[length..];
        let double = match (header.contains("'<f8'"), header.contains("'<f4'")) {
            (true, _) => true,
            (false, true) => false,
            (false, false) => return Err("holds no float64 or float32, little endian".to_owned()),
        };
        if header.contains("'fortran_order': True") {
            return Err("is in Fortran order; expected C order (np.ascontiguousarray)".to_owned());
        }
        let shape = header
            .split_once('(')
            .and_then(|(_, rest)| rest.split_once(')'));
        let shape = shape
            .map(|(shape, _)| shape.split(','))
            .ok_or("names no shape")?;
        let shape: Vec<usize> = shape.filter_map(|side| side.trim().parse().ok()).collect();
        let [rows, columns] = shape[..] else {
            return Err(format!("has {} dimensions; expected 2", shape.len()));
        };
        let expected = rows
            .saturating_mul(columns)
            .saturating_mul(if double { 8 } else { 4 });
        if numbers.len() != expected || expected == 0 {
            let found = numbers.len();
            return Err(format!(
                "holds {found} bytes of numbers; expected {expected}, not none"
            ));
        }
        let heights = match double {
            true => numbers
                .as_chunks()
                .0
                .iter()
                .map(|b| f64::from_le_bytes(*b))
                .collect(),
            false => {
                let singles = numbers.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b));
                singles.map(f64::from).collect()
            }
        };
        Ok(Self {
            cells: [columns, rows],
            heights,
            size: None,
            unit: None,
        })
    }

    fn of_text(bytes: &[u8]) -> Result<Self, String> {
        let text = std::str::from_utf8(bytes).map_err(|error| error.to_string())?;
        let mut map = Self {
            cells: [0, 0],
            heights: Vec::new(),
            size: None,
            unit: None,
        };
        let (mut width, mut height) = (None, None);
        for (number, line) in (1..).zip(text.lines()) {
            let line = line.trim();
            if let Some(comment) = line.strip_prefix('#') {
                match comment
                    .split_once(':')
                    .map(|(key, value)| (key.trim(), value.trim()))
                {
                    Some(("Width", value)) => width = Some(length(number, value)?),
                    Some(("Height", value)) => height = Some(length(number, value)?),
                    Some(("Value units", value)) => map.unit = Some(metres(number, value)?),
                    Some(_) | None => {}
                }
            } else if !line.is_empty() {
                map.row(number, line)?;
            }
        }
        map.size = width.zip(height).map(|(width, height)| [width, height]);
        match map.heights.is_empty() {
            true => Err("holds no heights".to_owned()),
            false => Ok(map),
        }
    }

    fn row(&mut self, number: usize, line: &str) -> Result<(), String> {
        let before = self.heights.len();
        let apart = |c: char| c == ',' || c == ';' || c.is_whitespace();
        for word in line.split(apart).filter(|word| !word.is_empty()) {
            let height = word.parse::<f64>();
            let height = height.map_err(|_| format!("line {number}: `{word}` is no number"))?;
            self.heights.push(height);
        }
        let found = self.heights.len() - before;
        if self.cells[1] > 0 && found != self.cells[0] {
            let expected = self.cells[0];
            return Err(format!(
                "line {number}: {found} heights; expected {expected} as before"
            ));
        }
        self.cells = [found, self.cells[1] + 1];
        Ok(())
    }
}

/// A length with its unit, in metre.
fn length(line: usize, text: &str) -> Result<f64, String> {
    let (value, unit) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    let value: f64 = value
        .parse()
        .map_err(|_| format!("line {line}: `{value}` is no number"))?;
    Ok(value * metres(line, unit.trim())?)
}

fn metres(line: usize, unit: &str) -> Result<f64, String> {
    unit_in_metres(unit).ok_or_else(|| {
        format!("line {line}: unit `{unit}`; expected m, cm, mm, um, µm, nm, pm or Å")
    })
}

/// A unit of length, in metre.
pub(super) fn unit_in_metres(unit: &str) -> Option<f64> {
    Some(match unit {
        "m" => 1.0,
        "cm" => 1e-2,
        "mm" => 1e-3,
        "um" | "µm" | "μm" => 1e-6,
        "nm" => 1e-9,
        "pm" => 1e-12,
        "A" | "Å" => 1e-10,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn read(name: &str, bytes: &[u8]) -> Result<HeightMap, String> {
        HeightMap::read("surface", Path::new(name), bytes).map_err(|error| error.to_string())
    }

    /// What `numpy.save` writes for two rows of three.
    fn npy(kind: &str, order: &str, numbers: &[u8]) -> Vec<u8> {
        let header =
            format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': (2, 3), }}\n");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(numbers);
        bytes
    }

    #[test]
    fn arrays_of_both_widths_are_read_row_by_row() {
        let doubles: Vec<u8> = (0..6).flat_map(|n| f64::from(n).to_le_bytes()).collect();
        let singles: Vec<u8> = (0..6_u8).flat_map(|n| f32::from(n).to_le_bytes()).collect();
        for bytes in [npy("<f8", "False", &doubles), npy("<f4", "False", &singles)] {
            let map = read("a.npy", &bytes).unwrap();
            assert_eq!(
                (map.cells, map.heights),
                ([3, 2], vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0])
            );
        }
        assert!(
            read("a.npy", &npy("<f8", "True", &doubles))
                .unwrap_err()
                .contains("C order")
        );
        assert!(
            read("a.npy", &npy("<i8", "False", &doubles))
                .unwrap_err()
                .contains("float64")
        );
        assert!(
            read("a.npy", &npy("<f8", "False", &singles))
                .unwrap_err()
                .contains("expected 48")
        );
        for length in 0..npy("<f8", "False", &doubles).len() {
            assert!(read("a.npy", &npy("<f8", "False", &doubles)[..length]).is_err());
        }
    }

    #[test]
    fn text_of_a_profilometer_has_sides_and_units() {
        let text = "# Channel: Topography\n# Width: 20 µm\n# Height: 0.01 mm\n# Value units: nm\n\
                    1\t2\n3\t4.5\n";
        let map = read("a.txt", text.as_bytes()).unwrap();
        assert_eq!((map.cells, map.heights), ([2, 2], vec![1.0, 2.0, 3.0, 4.5]));
        let [width, height] = map.size.unwrap();
        assert!((width - 2e-5).abs() < 1e-18 && (height - 1e-5).abs() < 1e-18);
        assert_eq!(map.unit, Some(1e-9));
    }

    #[test]
    fn what_is_wrong_in_a_file_is_told_with_its_line() {
        for (text, reason) in [
            ("1,2\n3\n", "line 2: 1 heights; expected 2"),
            ("1,two\n", "line 1: `two` is no number"),
            ("1,2\n3,nan\n", "row 1, column 1 is NaN"),
            ("", "no heights"),
            ("# Width: 3 ft\n1\n", "line 1: unit `ft`"),
        ] {
            let found = read("a.csv", text.as_bytes()).unwrap_err();
            assert!(
                found.contains(reason) && found.starts_with("surface"),
                "{found}"
            );
        }
        assert!(read("a.xyz", b"1").unwrap_err().contains(".npy"));
    }
}
