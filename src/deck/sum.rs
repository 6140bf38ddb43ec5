//! What loads add up to, in global axes.
//!
//! ```text
//! F = Σ F_i n_i                      force on a node with axes n_i of its own
//! p = p of *DLOAD + p of *DSLOAD     b = (BX, BY, BZ) + ρ g
//! ```
//!
//! Until here each has the value that was stated of it: to state one once more changes no other.

use std::collections::BTreeMap;

use super::load::{Reader, Slot};

/// Values at the instants.
type Values = BTreeMap<Slot, Vec<f64>>;

impl Reader<'_> {
    /// The sums of what is stated.
    pub(super) fn sums(&self, stated: Values) -> Values {
        let mut sums = Values::new();
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
                _ => add(&mut sums, slot, 1.0, &values),
            }
        }
        sums
    }

    /// Components, in global axes, of a unit along an axis of a node's own.
    fn components(&self, node: usize, axis: usize) -> Vec<(usize, f64)> {
        let position = self.contents.positions[node];
        let direction = self.transforms.direction(node, position, axis);
        let components = direction.into_iter().flatten().enumerate();
        let components = components.take(self.dimension());
        components.filter(|(_, n)| *n != 0.0).collect()
    }
}

fn add(sums: &mut Values, slot: Slot, factor: f64, values: &[f64]) {
    let sum = sums.entry(slot).or_insert_with(|| vec![0.0; values.len()]);
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += factor * value;
    }
}
