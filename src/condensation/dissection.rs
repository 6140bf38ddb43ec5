//! Nested dissection by coordinates, of bodies whose nodes are all crossings of a lattice: generated boxes and
//! rectangles.
//!
//! ```text
//! nodes of a part  =  this side of the middle plane across its longest side,  the other side,  the plane
//! ```
//!
//! A. George, Nested dissection of a regular finite element mesh, SIAM J. Numer. Anal. 10 (1973) 345–363.

use super::elimination_tree::Graph;

/// A part of so few planes has a middle that separates it.
const THIN: u32 = 3;

/// A vertex and where it is on the lattice.
type Place = ([u32; 3], usize);

/// The vertex eliminated at each step; none where the nodes are no lattice, or neighbours not next to each other.
///
/// - `positions`: of all nodes of the body, in metre;
/// - `nodes`: that of each vertex of the graph.
pub(super) fn dissect(
    positions: &[[f64; 3]],
    nodes: &[usize],
    graph: &Graph,
) -> Option<Vec<usize>> {
    let lines: Vec<Vec<u64>> = (0..3).map(|axis| lines(positions, axis)).collect();
    let crossings = lines.iter().map(Vec::len).product::<usize>();
    if positions.is_empty() || crossings != positions.len() {
        return None;
    }
    let place = |node: usize| -> Option<[u32; 3]> {
        let mut found = [0; 3];
        for (axis, lines) in lines.iter().enumerate() {
            let at = lines.binary_search(&key(positions[node][axis])).ok()?;
            found[axis] = u32::try_from(at).ok()?;
        }
        Some(found)
    };
    let places: Vec<[u32; 3]> = nodes
        .iter()
        .map(|&node| place(node))
        .collect::<Option<_>>()?;
    let next = |a: &[u32; 3], b: &[u32; 3]| (0..3).all(|axis| a[axis].abs_diff(b[axis]) <= 1);
    let joined = |v: usize| graph.neighbours(v).all(|w| next(&places[v], &places[w]));
    if !(0..places.len()).all(joined) {
        return None;
    }
    let mut parts: Vec<Place> = places.into_iter().zip(0..).collect();
    let mut order = Vec::with_capacity(nodes.len());
    separate(&mut parts, &mut order);
    Some(order)
}

/// A number whose order is that of coordinates, with one zero.
fn key(coordinate: f64) -> u64 {
    let bits = (coordinate + 0.0).to_bits();
    if bits >> 63 == 1 {
        !bits
    } else {
        bits | 1 << 63
    }
}

/// The coordinates along an axis, each once.
fn lines(positions: &[[f64; 3]], axis: usize) -> Vec<u64> {
    let mut keys: Vec<u64> = positions.iter().map(|x| key(x[axis])).collect();
    keys.sort_unstable();
    keys.dedup();
    keys
}

/// Adds the vertices of a part in their order.
fn separate(part: &mut [Place], order: &mut Vec<usize>) {
    let Some((first, rest)) = part.split_first() else {
        return;
    };
    let (mut low, mut high) = (first.0, first.0);
    for (place, _) in rest {
        for axis in 0..3 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    }
    let planes = |axis: &usize| high[*axis] - low[*axis] + 1;
    let longest = (0..3).max_by_key(planes).unwrap_or(0);
    if planes(&longest) < THIN {
        order.extend(part.iter().map(|(_, vertex)| vertex));
        return;
    }
    let middle = low[longest].midpoint(high[longest]);
    part.sort_by_key(|(place, _)| (place[longest] == middle, place[longest] > middle));
    let sides = part.partition_point(|(place, _)| place[longest] != middle);
    let (sides, plane) = part.split_at_mut(sides);
    let this = sides.partition_point(|(place, _)| place[longest] < middle);
    let (this, other) = sides.split_at_mut(this);
    separate(this, order);
    separate(other, order);
    order.extend(plane.iter().map(|(_, vertex)| vertex));
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A row of nodes along an axis, each joined with the next.
    fn row(coordinates: &[f64], axis: usize) -> (Vec<[f64; 3]>, Graph) {
        let mut graph = Graph {
            starts: vec![0],
            ..Graph::default()
        };
        let count = i32::try_from(coordinates.len()).unwrap();
        for v in 0..count {
            let ends = [v - 1, v + 1].into_iter();
            let ends = ends.filter(|&w| w >= 0 && w < count);
            graph.neighbours.extend(ends);
            let end = i32::try_from(graph.neighbours.len()).unwrap();
            graph.starts.push(end);
        }
        let position = |&x: &f64| {
            let mut position = [0.0; 3];
            position[axis] = x;
            position
        };
        (coordinates.iter().map(position).collect(), graph)
    }

    #[test]
    fn the_middle_of_each_part_comes_after_both_sides() {
        // Below and above zero, and −0 is 0.
        for axis in 0..3 {
            let (nodes, graph) = row(&[-3.0, -1.0, -0.5, -0.0, 1.0, 2.0, 7.0], axis);
            let found = dissect(&nodes, &[0, 1, 2, 3, 4, 5, 6], &graph).unwrap();
            assert_eq!(found, [0, 2, 1, 4, 6, 5, 3]);
        }
    }

    #[test]
    fn what_is_no_lattice_or_joined_across_it_is_not_dissected() {
        let (mut nodes, mut graph) = row(&[0.0, 1.0, 2.0], 0);
        assert!(dissect(&nodes, &[0, 1, 2], &graph).is_some());
        // 0 and 2 are joined over 1.
        graph.neighbours = vec![2, 0, 2, 0];
        assert!(dissect(&nodes, &[0, 1, 2], &graph).is_none());
        // A node beside the row: four places for three nodes.
        nodes[1][1] = 0.5;
        assert!(dissect(&nodes, &[0, 1, 2], &graph).is_none());
    }
}
