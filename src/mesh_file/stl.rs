//! STL, ASCII and binary: triangles, each with corners of its own.
//!
//! ```text
//! binary   80 bytes, number n of triangles, n × (normal, three corners as f32, 2 bytes): 84 + 50 n bytes
//! ASCII    solid … facet normal … vertex x y z … endsolid
//! ```
//!
//! Normals of the file are not read: triangles run counterclockwise, seen from outside.

use crate::error::Error;

/// Bytes before the triangles, and of each.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;

/// The corners of all triangles, three of each; `place` stands for the file in messages.
///
/// # Errors
///
/// A file that is neither, or that ends within a triangle.
pub(crate) fn corners(place: &str, bytes: &[u8]) -> Result<Vec<[f64; 3]>, Error> {
    let refused = |found: String| Error::NotAccepted {
        place: place.to_owned(),
        found,
        accepted: "an STL file, ASCII or binary, of at least one triangle".to_owned(),
    };
    let corners = match binary(bytes) {
        Some(corners) => corners,
        None => ascii(bytes).map_err(refused)?,
    };
    match corners.is_empty() {
        true => Err(refused("no triangle".to_owned())),
        false => Ok(corners),
    }
}

/// None unless the length is that of the triangles that it counts.
fn binary(bytes: &[u8]) -> Option<Vec<[f64; 3]>> {
    let count: [u8; 4] = bytes.get(80..HEAD)?.try_into().ok()?;
    let count = usize::try_from(u32::from_le_bytes(count)).ok()?;
    let triangles = &bytes[HEAD..];
    if Some(triangles.len()) != count.checked_mul(TRIANGLE) {
        return None;
    }
    let number = |four: &[u8]| {
        four.try_into()
            .map_or(f64::NAN, |four| f64::from(f32::from_le_bytes(four)))
    };
    let corners = triangles
        .chunks_exact(TRIANGLE)
        .flat_map(|triangle| triangle[12..48].chunks_exact(12));
    Some(
        corners
            .map(|corner| [0, 4, 8].map(|at| number(&corner[at..at + 4])))
            .collect(),
    )
}

fn ascii(bytes: &[u8]) -> Result<Vec<[f64; 3]>, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| {
        format!(
            "{} bytes that are no text, and no number of triangles that fits",
            bytes.len()
        )
    })?;
    let mut lines = text.lines().enumerate();
    match lines.next() {
        Some((_, first)) if first.trim_start().starts_with("solid") => {}
        _ => return Err("text that does not begin with `solid`".to_owned()),
    }
    let mut corners = Vec::new();
    for (at, line) in lines {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("vertex") => {
                let numbers: Result<Vec<f64>, _> = words.map(str::parse).collect();
                let numbers = numbers
                    .ok()
                    .and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
                let corner =
                    numbers.ok_or_else(|| format!("line {}: `{}`", at + 1, line.trim()))?;
                corners.push(corner);
            }
            Some("endfacet") if corners.len() % 3 != 0 => {
                return Err(format!("line {}: a facet that is no triangle", at + 1));
            }
            _ => {}
        }
    }
    match corners.len() % 3 {
        0 => Ok(corners),
        _ => Err("a file that ends within a triangle".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const TEXT: &str = "solid plate\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1.5 0 0\n   \
                        vertex 0 2e0 -1\n  endloop\n endfacet\nendsolid plate\n";
    const CORNERS: [[f64; 3]; 3] = [[0.0; 3], [1.5, 0.0, 0.0], [0.0, 2.0, -1.0]];

    fn as_binary() -> Vec<u8> {
        // Headers of binary files may begin like those of text.
        let mut bytes = b"solid, but binary".to_vec();
        bytes.resize(80, 0);
        bytes.extend(1_u32.to_le_bytes());
        bytes.extend([0; 12]);
        for x in CORNERS.into_iter().flatten() {
            bytes.extend((x as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
        bytes
    }

    #[test]
    fn text_and_binary_give_the_same_triangle() {
        assert_eq!(corners("file", TEXT.as_bytes()).unwrap(), CORNERS);
        assert_eq!(corners("file", &as_binary()).unwrap(), CORNERS);
    }

    #[test]
    fn damaged_files_are_refused_with_the_place() {
        let mut cut = as_binary();
        cut.pop();
        let short = TEXT.replace("vertex 1.5 0 0", "");
        let word = TEXT.replace("1.5", "far");
        for bytes in [
            &cut[..],
            short.as_bytes(),
            word.as_bytes(),
            b"",
            b"solid\n",
            b"ply",
        ] {
            let refused = corners("surfaces[0].triangles.file", bytes)
                .unwrap_err()
                .to_string();
            assert!(
                refused.starts_with("surfaces[0].triangles.file"),
                "{refused}"
            );
        }
    }
}
