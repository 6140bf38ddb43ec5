//! What loads and motions add up to, in global axes.
//!
//! ```text
//! F = Σ F_i n_i                      force, moment at a node with axes n_i of its own
//! p = p of *DLOAD + p of *DSLOAD     b = (BX, BY, BZ) + ρ g
//! u = Σ u_i n_i                      motion of a reference node, where the n_i that are held span global axes
//! ```
//!
//! Until here each has the value that was stated of it: to state one once more changes no other.

use std::collections::BTreeMap;

use super::load::{Reader, Slot};
use crate::error::Error;

/// Values at the instants.
type Values = BTreeMap<Slot, Vec<f64>>;

/// What is given along axes of a node, and its values.
type Held = Vec<(usize, Vec<f64>)>;

/// What a product of directions may be off from 0 or 1.
const OFF: f64 = 1e-9;

/// Part of a motion that is round-off.
const ROUND_OFF: f64 = 1e-14;

impl Reader<'_> {
    /// The sums of what is stated.
    pub(super) fn sums(&self, stated: Values) -> Result<Values, Error> {
        let mut sums = Values::new();
        let mut motions: BTreeMap<(usize, bool), Held> = BTreeMap::new();
        for (slot, values) in stated {
            match slot {
                Slot::SurfacePressure(side) => add(&mut sums, Slot::Pressure(side), 1.0, &values),
                Slot::Gravity(cell, axis) => {
                    add(&mut sums, Slot::Weight(cell, axis), 1.0, &values);
                }
                Slot::OwnForce(node, axis) => {
                    for (axis, n) in self.components(node, axis) {
                        add(&mut sums, Slot::Force(node, axis), n, &values);
                    }
                }
                Slot::OwnWrench(node, component) => {
                    let group = self.rigid.of(node).map_or(0, |(group, _)| group);
                    for (at, n) in self.components(node, component) {
                        add(&mut sums, Slot::Wrench(group, at), n, &values);
                    }
                }
                Slot::OwnMotion(node, component) => {
                    let of_node = motions.entry((node, component < 3)).or_default();
                    of_node.push((component, values));
                }
                _ => add(&mut sums, slot, 1.0, &values),
            }
        }
        for ((node, _), held) in motions {
            self.add_motion(node, &held, &mut sums)?;
        }
        Ok(sums)
    }

    /// Components, in global axes, of a unit along an axis of a node's own, or of one about it from 3 on.
    fn components(&self, node: usize, component: usize) -> Vec<(usize, f64)> {
        let (turns, position) = (component / 3 * 3, self.contents.positions[node]);
        let direction = self.transforms.direction(node, position, component % 3);
        let lives = |at: &usize| match self.dimension() {
            3 => true,
            _ => [0, 1, 5].contains(at),
        };
        let components = direction.into_iter().flatten().enumerate();
        let components = components.map(|(axis, n)| (turns + axis, n));
        components
            .filter(|(at, n)| *n != 0.0 && lives(at))
            .collect()
    }

    /// Displacements, or rotations, of a reference node along axes of its own.
    fn add_motion(
        &self,
        node: usize,
        held: &[(usize, Vec<f64>)],
        sums: &mut Values,
    ) -> Result<(), Error> {
        let Some((group, _)) = self.rigid.of(node) else {
            return Ok(());
        };
        // Σ n nᵀ of what is held.
        let mut projection = [[0.0; 6]; 6];
        for (component, _) in held {
            let n = self.components(node, *component);
            for &(i, a) in &n {
                n.iter().for_each(|&(j, b)| projection[i][j] += a * b);
            }
        }
        let stray = |(i, j): (usize, usize)| {
            let least = if i == j {
                projection[i][i].round()
            } else {
                0.0
            };
            (projection[i][j] - least).abs() > OFF
        };
        if (0..36).any(|at| stray((at / 6, at % 6))) {
            return Err(self.rigid.groups[group].card.error(
                "its reference node is held along axes of a *TRANSFORM that are no global ones, and free across; \
                 expected it held along global axes, or along all three",
            ));
        }
        let mut motion = Values::new();
        for (component, values) in held {
            let along = self.components(node, *component).into_iter();
            for (at, n) in along.filter(|(at, _)| projection[*at][*at] > 0.5) {
                add(&mut motion, Slot::Motion(group, at), n, values);
            }
        }
        // What should cancel does, so that supports of the group's nodes agree with it.
        let size = held.iter().flat_map(|(_, values)| values);
        let size = size.fold(0.0_f64, |most, value| most.max(value.abs()));
        for value in motion.values_mut().flatten() {
            *value = if value.abs() > ROUND_OFF * size {
                *value
            } else {
                0.0
            };
        }
        for (slot, values) in motion {
            add(sums, slot, 1.0, &values);
        }
        Ok(())
    }
}

fn add(sums: &mut Values, slot: Slot, factor: f64, values: &[f64]) {
    let sum = sums.entry(slot).or_insert_with(|| vec![0.0; values.len()]);
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += factor * value;
    }
}
