//! A facet or plane cell as small straight ones: a lattice of points between its nodes.
//!
//! ```text
//! x(ξ) = Σ N_a(ξ) x_a      at ξ on a lattice of n parts along each side
//! ```
//!
//! One part is enough where `N` is linear; more of them show curved sides as curved.

use crate::body::FacetReference;

/// Points, small triangles and sides of a lattice on a reference facet.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Lattice {
    /// Reference positions of the points.
    pub(super) points: Vec<[f64; 3]>,
    /// Points of each small triangle, or of each small line on a line.
    pub(super) pieces: Vec<Vec<u32>>,
    /// Points along each side, from a corner to the next.
    pub(super) sides: Vec<Vec<u32>>,
}

impl Lattice {
    /// That of `parts ≥ 1` along each side.
    pub(super) fn new(facet: FacetReference, parts: u32) -> Self {
        match (facet.corners(), facet.is_simplex()) {
            (2, _) => Self::line(parts),
            (_, true) => Self::triangle(parts),
            (_, false) => Self::quadrilateral(parts),
        }
    }

    fn line(parts: u32) -> Self {
        Self {
            points: (0..=parts).map(|i| [centred(i, parts), 0.0, 0.0]).collect(),
            pieces: (0..parts).map(|i| vec![i, i + 1]).collect(),
            sides: Vec::new(),
        }
    }

    fn triangle(parts: u32) -> Self {
        let mut points = Vec::new();
        for row in 0..=parts {
            let places = (0..=parts - row).map(|i| [part(i, parts), part(row, parts), 0.0]);
            points.extend(places);
        }
        // Rows 0, 1, … hold n + 1, n, … points.
        let at = |i: u32, row: u32| row * (parts + 1) - row * row.saturating_sub(1) / 2 + i;
        let mut pieces = Vec::new();
        for row in 0..parts {
            for i in 0..parts - row {
                pieces.push(vec![at(i, row), at(i + 1, row), at(i, row + 1)]);
                if i + row + 1 < parts {
                    pieces.push(vec![at(i + 1, row), at(i + 1, row + 1), at(i, row + 1)]);
                }
            }
        }
        let along = || 0..=parts;
        let sides = vec![
            along().map(|i| at(i, 0)).collect(),
            along().map(|i| at(parts - i, i)).collect(),
            along().map(|i| at(0, parts - i)).collect(),
        ];
        Self {
            points,
            pieces,
            sides,
        }
    }

    fn quadrilateral(parts: u32) -> Self {
        let at = |i: u32, row: u32| row * (parts + 1) + i;
        let cells = (0..parts).flat_map(|row| (0..parts).map(move |i| (i, row)));
        let pieces = cells.flat_map(|(i, row)| {
            let corners = [
                at(i, row),
                at(i + 1, row),
                at(i + 1, row + 1),
                at(i, row + 1),
            ];
            [[0, 1, 2], [0, 2, 3]].map(|half| half.map(|corner| corners[corner]).to_vec())
        });
        let places = (0..=parts).flat_map(|row| (0..=parts).map(move |i| (i, row)));
        let along = || 0..=parts;
        let sides = vec![
            along().map(|i| at(i, 0)).collect(),
            along().map(|i| at(parts, i)).collect(),
            along().map(|i| at(parts - i, parts)).collect(),
            along().map(|i| at(0, parts - i)).collect(),
        ];
        Self {
            points: places
                .map(|(i, row)| [centred(i, parts), centred(row, parts), 0.0])
                .collect(),
            pieces: pieces.collect(),
            sides,
        }
    }
}

/// Place `i` of `parts` between 0 and 1.
fn part(i: u32, parts: u32) -> f64 {
    f64::from(i) / f64::from(parts)
}

/// The same between −1 and 1.
fn centred(i: u32, parts: u32) -> f64 {
    2.0 * part(i, parts) - 1.0
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn area(lattice: &Lattice) -> f64 {
        let of = |piece: &Vec<u32>| {
            let [a, b, c] = [0, 1, 2].map(|k| lattice.points[piece[k] as usize]);
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        };
        let areas: Vec<f64> = lattice.pieces.iter().map(of).collect();
        assert!(areas.iter().all(|area| *area > 0.0), "{areas:?}");
        areas.iter().sum()
    }

    #[test]
    fn small_triangles_cover_the_facet_and_keep_its_sense() {
        for parts in [1, 2, 4] {
            let of = |nodes| Lattice::new(FacetReference::of(3, nodes).unwrap(), parts);
            // Areas of the reference triangle and of the reference square.
            assert!((area(&of(6)) - 0.5).abs() < 1e-15);
            assert!((area(&of(8)) - 4.0).abs() < 1e-15);
            let pieces = (parts * parts) as usize;
            assert_eq!(
                (of(3).pieces.len(), of(4).pieces.len()),
                (pieces, 2 * pieces)
            );
        }
    }

    #[test]
    fn sides_run_from_corner_to_corner() {
        for (nodes, corners) in [(3, 3), (4, 4)] {
            let facet = FacetReference::of(3, nodes).unwrap();
            let lattice = Lattice::new(facet, 3);
            for (corner, side) in lattice.sides.iter().enumerate() {
                let end = |at: usize| lattice.points[side[at] as usize];
                assert_eq!(end(0), facet.nodes()[corner]);
                assert_eq!(end(3), facet.nodes()[(corner + 1) % corners]);
            }
        }
    }
}
