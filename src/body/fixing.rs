//! Degrees of freedom that hold a free body without straining it.
//!
//! Pinning as many components as there are rigid modes is isostatic if the modes, restricted to these
//! components, form a regular matrix: loads in equilibrium then leave no reaction at the pins.

use super::Body;
use super::rigid_modes::FreeModes;

/// A component that moves at least this part of what the best one moves serves as well.
const SERVES: f64 = 0.1;

/// Unknowns (`dimension · node + axis`), one per mode, on which the modes are far from dependent.
///
/// The component that moves most is taken first; each next one is that on which most of the remaining
/// motions is left (QR with pivoting on the components), which finds nodes far apart. Components that
/// are not free are never chosen, and components of the nodes to `avoid` (such as those on the contact surface, any
/// order) only where the others of their part hardly move.
#[must_use]
pub(crate) fn fixing_dofs(
    body: &Body,
    is_free: impl Fn(usize) -> bool,
    free: &FreeModes,
    avoid: &[usize],
) -> Vec<usize> {
    let mut avoided = vec![false; body.mesh.nodes.len()];
    for &node in avoid {
        if let Some(avoided) = avoided.get_mut(node) {
            *avoided = true;
        }
    }
    let mut chosen = Vec::with_capacity(free.modes.len());
    for (part, nodes) in free.parts.iter().enumerate() {
        let modes: Vec<_> = free.modes.iter().filter(|mode| mode.part == part).collect();
        let mut rows = rows(body, &is_free, nodes, &modes);
        for _ in 0..modes.len() {
            let Some(pivot) = pivot(&rows, &avoided, body.mesh.dimension).cloned() else {
                break;
            };
            chosen.push(pivot.unknown);
            for row in &mut rows {
                row.orthogonalise(&pivot);
            }
        }
    }
    chosen
}

/// The row that moves most, one of the nodes not to avoid if it serves.
fn pivot<'a>(rows: &'a [Row], avoided: &[bool], axes: usize) -> Option<&'a Row> {
    let largest = |rows: &mut dyn Iterator<Item = &'a Row>| {
        rows.max_by(|a, b| a.square().total_cmp(&b.square()))
    };
    let best = largest(&mut rows.iter()).filter(|row| row.square() > 0.0)?;
    let preferred = largest(&mut rows.iter().filter(|row| !avoided[row.unknown / axes]));
    let serves = |row: &&Row| row.square() >= SERVES * SERVES * best.square();
    preferred.filter(serves).or(Some(best))
}

/// What the modes do to one unknown.
#[derive(Clone)]
struct Row {
    unknown: usize,
    motion: [f64; 6],
}

impl Row {
    fn square(&self) -> f64 {
        self.motion.iter().map(|x| x * x).sum()
    }

    fn orthogonalise(&mut self, held: &Row) {
        let products = self.motion.iter().zip(&held.motion).map(|(a, b)| a * b);
        let share = products.sum::<f64>() / held.square();
        for (entry, held) in self.motion.iter_mut().zip(&held.motion) {
            *entry -= share * held;
        }
    }
}

fn rows(
    body: &Body,
    is_free: impl Fn(usize) -> bool,
    nodes: &[usize],
    modes: &[&super::rigid_modes::RigidMode],
) -> Vec<Row> {
    let axes = body.mesh.dimension;
    let mut rows = Vec::new();
    for &node in nodes {
        let moved: Vec<[f64; 3]> = modes
            .iter()
            .map(|mode| mode.displacement(body.mesh.nodes[node]))
            .collect();
        for axis in 0..axes {
            let unknown = axes * node + axis;
            if is_free(unknown) && !modes.is_empty() {
                let mut motion = [0.0; 6];
                for (entry, moved) in motion.iter_mut().zip(&moved) {
                    *entry = moved[axis];
                }
                rows.push(Row { unknown, motion });
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::Mat;

    use super::*;
    use crate::body::tests::samples::{block, solve};
    use crate::body::{CellKind, Load, Support, free_modes, prescribed};

    const KINDS: [CellKind; 4] = [
        CellKind::Tri3,
        CellKind::Quad4,
        CellKind::Tet4,
        CellKind::Hex8,
    ];

    fn pins(body: &Body) -> (FreeModes, Vec<usize>) {
        pins_away_from(body, &[])
    }

    fn pins_away_from(body: &Body, avoid: &[usize]) -> (FreeModes, Vec<usize>) {
        let prescribed = prescribed(body).unwrap();
        let free = free_modes(body, &prescribed);
        let chosen = fixing_dofs(body, |dof| prescribed[dof].is_none(), &free, avoid);
        (free, chosen)
    }

    /// Least singular value of the modes, which are of order one, at the chosen components.
    fn independence(body: &Body, free: &FreeModes, chosen: &[usize]) -> f64 {
        let axes = body.mesh.dimension;
        assert_eq!(chosen.len(), free.modes.len());
        let matrix = Mat::from_fn(chosen.len(), chosen.len(), |row, mode| {
            let x = body.mesh.nodes[chosen[row] / axes];
            free.modes[mode].displacement(x)[chosen[row] % axes]
        });
        *matrix.singular_values().unwrap().last().unwrap()
    }

    #[test]
    fn pinned_components_are_one_per_mode_and_far_from_dependent() {
        for kind in KINDS {
            let body = block(kind);
            let (free, chosen) = pins(&body);
            let found = independence(&body, &free, &chosen);
            assert!(found > 0.3, "{found}");
        }
    }

    #[test]
    fn nodes_to_avoid_are_pinned_only_where_the_others_hardly_move() {
        for kind in KINDS {
            let body = block(kind);
            let axes = body.mesh.dimension;
            let (count, plain) = (body.mesh.nodes.len(), pins(&body).1);
            let avoid: Vec<usize> = plain.iter().map(|dof| dof / axes).collect();
            let (free, chosen) = pins_away_from(&body, &avoid);
            assert!(!chosen.iter().any(|dof| avoid.contains(&(dof / axes))));
            let found = independence(&body, &free, &chosen);
            assert!(found > 0.1, "{found}");
            // All of them: as without. All but one: that node alone cannot hold the turns.
            let all: Vec<usize> = (0..count).collect();
            assert_eq!(pins_away_from(&body, &all).1, plain);
            let (free, chosen) = pins_away_from(&body, &all[1..]);
            let found = independence(&body, &free, &chosen);
            assert!(
                found > 0.1 && chosen.iter().any(|&dof| dof < axes),
                "{found}"
            );
        }
    }

    #[test]
    fn a_body_pinned_there_strains_as_its_balanced_load_alone_wants_it() {
        // Two opposite forces of 3 N stretch the block between two corners: whatever its pins, the
        // distance of the corners changes by the same amount, and no pin carries a force.
        for kind in KINDS {
            let mut body = block(kind);
            let axes = body.mesh.dimension;
            let last = body.mesh.nodes.len() - 1;
            let x = body.mesh.nodes[last];
            let (ends, force) = ([0, last], x.map(|x| 3.0 * x));
            for (node, sign) in ends.into_iter().zip([-1.0, 1.0]) {
                let force = force.map(|f| sign * f);
                body.loads.push(Load::PointForce { node, force });
            }
            let (_, chosen) = pins(&body);
            let stretch = |dofs: &[usize]| {
                let mut body = body.clone();
                for &dof in dofs {
                    let mut displacement = [None; 3];
                    displacement[dof % axes] = Some(0.0);
                    body.supports
                        .push(Support::new("pin", vec![dof / axes], displacement));
                }
                let u = solve(&body);
                (0..axes)
                    .map(|k| x[k] * (u[axes * last + k] - u[k]))
                    .sum::<f64>()
            };
            // Some other isostatic choice: all of node 0, then enough of two neighbours.
            let along = body
                .mesh
                .nodes
                .iter()
                .position(|x| x[0] > 0.0 && x[1] == 0.0 && x[2] == 0.0);
            let across = body
                .mesh
                .nodes
                .iter()
                .position(|x| x[0] == 0.0 && x[1] > 0.0 && x[2] == 0.0);
            let (along, across) = (along.unwrap(), across.unwrap());
            let other = if axes == 2 {
                vec![0, 1, 2 * along + 1]
            } else {
                vec![0, 1, 2, 3 * along + 1, 3 * along + 2, 3 * across + 2]
            };
            let (found, expected) = (stretch(&chosen), stretch(&other));
            // ε times the condition of K, some thousand, and a digit.
            assert!((found / expected - 1.0).abs() < 1e-11, "{found} {expected}");
        }
    }

    #[test]
    fn a_hinged_body_is_pinned_once_more_and_far_from_its_hinge() {
        let mut body = block(CellKind::Quad4);
        body.supports = vec![Support::new("hinge", vec![0], [Some(0.0), Some(0.0), None])];
        let (_, chosen) = pins(&body);
        // The hinge is at (0, 0); the far side is x = 2, which moves most along y.
        let node = chosen[0] / 2;
        assert!(chosen.len() == 1 && chosen[0] % 2 == 1 && body.mesh.nodes[node][0] == 2.0);
        body.supports[0].nodes = vec![0, 1];
        assert!(pins(&body).1.is_empty());
    }
}
