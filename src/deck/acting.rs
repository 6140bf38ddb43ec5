//! Supports, loads and ties of a scene's bodies: one for all nodes, faces or elements that share a history.

use std::collections::BTreeMap;

use super::assemble::{Building, Stock, Tables};
use super::load::Slot;
use super::rigid::RigidGroup;
use super::transform::{Axes, minus};
use crate::body::Group;
use crate::error::Error;
use crate::mesh_file::abaqus::{Contents, Space};
use crate::scene::{
    SceneAxis, SceneLoad, SceneRigidGroup, SceneSpin, SceneSupport, SceneTemperature,
};

/// What slots may stand in one support or load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Held(usize),
    Force(usize, usize),
    Pressure,
    Weight(usize),
    Spin([u64; 6]),
    Heat,
}

/// Components that are stated, and the history that they share, over its largest value.
type Together = ([Option<f64>; 6], Vec<f64>);

/// Part of a history that is round-off.
const ROUND_OFF: f64 = 1e-12;

/// The value of largest amount.
pub(super) fn largest(values: &[f64]) -> f64 {
    let size = |value: &&f64| value.abs();
    let largest = values.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
    largest.copied().unwrap_or_default()
}

/// Values over the largest, without round-off.
fn relative(values: &[f64]) -> Vec<f64> {
    let stated = largest(values);
    let factor = |value: &f64| (value / stated / ROUND_OFF).round() * ROUND_OFF;
    values.iter().map(factor).collect()
}

impl Stock<'_, '_> {
    /// Supports and loads.
    pub(super) fn add_loads(&self, bodies: &mut [Building], factors: &mut Tables) {
        let mut alike: BTreeMap<(usize, Kind, Vec<u64>), Vec<Slot>> = BTreeMap::new();
        for (&slot, values) in &self.history.values {
            let Some((part, kind)) = self.part_and_kind(slot) else {
                continue;
            };
            if kind != Kind::Heat {
                let bits = values.iter().map(|value| (value + 0.0).to_bits()).collect();
                alike.entry((part, kind, bits)).or_default().push(slot);
            } else if largest(values) != 0.0 {
                let bits = relative(values).into_iter();
                let bits = bits.map(|value| (value + 0.0).to_bits()).collect();
                alike.entry((part, kind, bits)).or_default().push(slot);
            }
        }
        for ((part, kind, bits), slots) in alike {
            let values: Vec<f64> = bits.into_iter().map(f64::from_bits).collect();
            let stated = match kind {
                // A square: its sign is that of the factor.
                Kind::Spin(_) => largest(&values).abs(),
                _ => largest(&values),
            };
            if !matches!(kind, Kind::Held(_)) && stated == 0.0 {
                continue;
            }
            let building = &mut bodies[part];
            let place = match kind {
                Kind::Held(axis) => building.hold(self, &slots, axis, stated),
                Kind::Heat => building.warm(self, &slots),
                _ => building.load(&self.contents, &slots, stated),
            };
            self.tabulate(
                format!("bodies[{part}].{place}"),
                (&values, stated),
                factors,
            );
        }
    }

    fn part_and_kind(&self, slot: Slot) -> Option<(usize, Kind)> {
        let (of_node, of_cell) = (&self.parts.of_node, &self.parts.of_cell);
        Some(match slot {
            Slot::Held(node, axis) => (of_node[node]?, Kind::Held(axis)),
            Slot::Force(node, axis) => (of_node[node]?, Kind::Force(node, axis)),
            Slot::Heat(node) => (of_node[node]?, Kind::Heat),
            Slot::Pressure((cell, _)) => (of_cell[cell], Kind::Pressure),
            Slot::Weight(cell, axis) => (of_cell[cell], Kind::Weight(axis)),
            Slot::Spin(cell, line) => (of_cell[cell], Kind::Spin(line)),
            // Of rigid groups and bolts, and what the sums hold no more.
            _ => return None,
        })
    }

    /// Adds a table of factors, where a value changes.
    pub(super) fn tabulate(
        &self,
        place: String,
        (values, stated): (&[f64], f64),
        factors: &mut Tables,
    ) {
        if values.iter().any(|value| *value != stated) {
            let rows = self.history.instants.iter().zip(values);
            let rows = rows.map(|(at, value)| vec![*at, value / stated]);
            factors.insert(place, rows.collect());
        }
    }

    /// Groups that move as rigid bodies.
    pub(super) fn add_rigid_groups(
        &self,
        bodies: &mut [Building],
        factors: &mut Tables,
    ) -> Result<(), Error> {
        for (number, group) in self.rigid.groups.iter().enumerate() {
            let building = &mut bodies[group.part];
            let (name, at) = (format!("rigid {number}"), building.body.rigid_groups.len());
            building.points(&name, &group.nodes);
            let dimension = building.mesh.dimension;
            let mut stated = SceneRigidGroup::new(
                &name,
                &self.contents.positions[group.reference][..dimension],
            );
            let place = format!("bodies[{}].rigid_groups[{at}]", group.part);
            let turns = if dimension == 2 { 5..6 } else { 3..6 };
            let motion = self.together(number, group, Slot::Motion)?;
            if let Some((components, values)) = motion {
                stated.displacement = Some(components[..dimension].to_vec());
                stated.rotation = Some(components[turns.clone()].to_vec());
                let place = format!("{place}.motion");
                self.tabulate(place, (&values, largest(&values)), factors);
            }
            if let Some((components, values)) = self.together(number, group, Slot::Wrench)? {
                let all = components.map(Option::unwrap_or_default);
                stated.force = Some(all[..dimension].to_vec());
                stated.moment = Some(all[turns].to_vec());
                self.tabulate(
                    format!("{place}.load"),
                    (&values, largest(&values)),
                    factors,
                );
            }
            building.body.rigid_groups.push(stated);
        }
        Ok(())
    }

    /// Components of a motion or a wrench that are stated, and their common history.
    fn together(
        &self,
        number: usize,
        group: &RigidGroup<'_, '_>,
        slot: fn(usize, usize) -> Slot,
    ) -> Result<Option<Together>, Error> {
        let mut components = [None; 6];
        let mut common: Option<Vec<f64>> = None;
        for (axis, component) in components.iter_mut().enumerate() {
            let Some(values) = self.history.values.get(&slot(number, axis)) else {
                continue;
            };
            let stated = largest(values);
            *component = Some(stated);
            if stated == 0.0 {
                continue;
            }
            let of_axis = relative(values);
            match &common {
                Some(common) if *common != of_axis => {
                    return Err(group.card.error(
                        "motions, or forces, of its reference node that do not grow in proportion are not read",
                    ));
                }
                _ => common = Some(of_axis),
            }
        }
        let still = vec![1.0; self.history.instants.len()];
        let any = components.iter().any(Option::is_some);
        Ok(any.then(|| (components, common.unwrap_or(still))))
    }

    /// Faces on which bodies repeat.
    pub(super) fn add_repeats(&self, bodies: &mut [Building]) {
        for (number, repeat) in self.repeats.iter().enumerate() {
            let building = &mut bodies[repeat.part];
            let names = ["dependent", "independent"].map(|side| format!("{side} {number}"));
            for (name, nodes) in names.iter().zip(&repeat.nodes) {
                building.points(name, nodes);
            }
            let periodic = repeat.periodic(&names, building.mesh.dimension);
            building.body.periodic.push(periodic);
        }
    }
}

impl Building {
    /// Adds a group of nodes.
    fn points(&mut self, name: &str, nodes: &[usize]) {
        let points = nodes.iter().map(|node| self.node[node]).collect();
        self.mesh
            .groups
            .insert(name.to_owned(), Group::Points(points));
    }

    /// Adds a support and returns its place in the body.
    fn hold(&mut self, stock: &Stock<'_, '_>, slots: &[Slot], axis: usize, stated: f64) -> String {
        let (number, dimension) = (self.body.supports.len(), self.mesh.dimension);
        let group = format!("support {number}");
        let nodes = slots.iter().filter_map(|slot| match slot {
            Slot::Held(node, _) => Some(*node),
            _ => None,
        });
        self.points(&group, &nodes.collect::<Vec<_>>());
        let mut displacement = vec![None; dimension];
        displacement[axis % 3] = Some(stated);
        let own = (axis / 3).checked_sub(1);
        self.body
            .supports
            .push(match own.map(|at| stock.transforms.axes[at]) {
                None => SceneSupport::Group {
                    group: group.into(),
                    displacement,
                },
                Some(Axes::Straight(rows)) => {
                    SceneSupport::along(&group, &rows[axis % 3][..dimension], stated)
                }
                Some(Axes::Around([a, b])) => {
                    let axis = SceneAxis {
                        point: a[..dimension].to_vec(),
                        direction: (dimension == 3).then(|| minus(b, a).to_vec()),
                    };
                    SceneSupport::around(&group, axis, &displacement)
                }
            });
        format!("supports[{number}]")
    }

    /// Adds the temperatures of nodes, as a load, and returns its place in the body.
    fn warm(&mut self, stock: &Stock<'_, '_>, slots: &[Slot]) -> String {
        let mut rise = vec![0.0; self.mesh.nodes.len()];
        for slot in slots {
            if let Slot::Heat(node) = slot {
                rise[self.node[node]] = largest(&stock.history.values[slot]);
            }
        }
        let first = rise.first().copied().unwrap_or_default();
        let temperature = match rise.iter().all(|rise| *rise == first) {
            true => SceneTemperature::Uniform(first),
            false => SceneTemperature::Given(rise),
        };
        self.body.loads.push(SceneLoad::Temperature {
            temperature,
            group: None,
        });
        format!("loads[{}]", self.body.loads.len() - 1)
    }

    /// Adds a load on all slots, which are of one kind, and returns its place in the body.
    fn load(&mut self, contents: &Contents, slots: &[Slot], stated: f64) -> String {
        let number = self.body.loads.len();
        let dimension = self.mesh.dimension;
        let along = |axis: usize| {
            let mut vector = vec![0.0; dimension];
            vector[axis] = stated;
            vector
        };
        let (mut facets, mut cells) = (Vec::new(), Vec::new());
        for slot in slots {
            match *slot {
                Slot::Pressure(side) => facets.push(self.facet(contents, side)),
                Slot::Weight(cell, _) | Slot::Spin(cell, _) => cells.push(self.cell[&cell]),
                _ => {}
            }
        }
        let group = format!("load {number}");
        let (of, load) = match slots.first() {
            Some(&Slot::Force(node, axis)) => {
                let at = self.mesh.nodes[self.node[&node]][..dimension].to_vec();
                let point_force = along(axis);
                (None, SceneLoad::PointForce { point_force, at })
            }
            Some(&Slot::Weight(_, axis)) => {
                let (body_force, group) = (along(axis), Some(group.clone().into()));
                (
                    Some(Group::Cells(cells)),
                    SceneLoad::BodyForce { body_force, group },
                )
            }
            Some(&Slot::Spin(_, line)) => {
                let (centrifugal, group) = (
                    spin(line, stated, contents, slots),
                    Some(group.clone().into()),
                );
                (
                    Some(Group::Cells(cells)),
                    SceneLoad::Centrifugal { centrifugal, group },
                )
            }
            _ => {
                let (pressure, group) = (stated, group.clone().into());
                (
                    Some(Group::Facets(facets)),
                    SceneLoad::Pressure { pressure, group },
                )
            }
        };
        self.mesh.groups.extend(of.map(|of| (group, of)));
        self.body.loads.push(load);
        format!("loads[{number}]")
    }
}

/// A spin about a line of these bits.
fn spin(line: [u64; 6], squared: f64, contents: &Contents, slots: &[Slot]) -> SceneSpin {
    let line = line.map(f64::from_bits);
    let space = slots.iter().find_map(|slot| match slot {
        Slot::Spin(cell, _) => Some(contents.elements[*cell].kind.space),
        _ => None,
    });
    let (point, direction) = match space {
        Some(Space::Solid) => (Some(&line[..3]), Some(&line[3..])),
        Some(Space::Axisymmetric) => (None, None),
        _ => (Some(&line[..2]), None),
    };
    SceneSpin {
        speed: squared.sqrt(),
        point: point.map(<[f64]>::to_vec),
        direction: direction.map(<[f64]>::to_vec),
    }
}
