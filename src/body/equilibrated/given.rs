//! Given forces as functions of position: tractions on edges, forces in cells.

use std::collections::HashMap;

use nalgebra::{Vector2, Vector3};

use crate::body::spread::{Spread, spread_on};
use crate::body::{Body, Facet, Load};

/// Given forces of a body, by edge and cell.
pub(super) struct Given<'a> {
    body: &'a Body,
    /// Loads per edge, by its corners in rising order, with where the traction is spread from.
    on_edge: HashMap<[usize; 2], Vec<(&'a Load, Option<usize>)>>,
    spreads: Vec<Spread>,
    /// Loads per cell.
    in_cell: HashMap<usize, Vec<&'a Load>>,
}

/// Corners of an edge in rising order.
pub(super) fn key(nodes: &[usize]) -> [usize; 2] {
    [nodes[0].min(nodes[1]), nodes[0].max(nodes[1])]
}

impl<'a> Given<'a> {
    pub(super) fn new(body: &'a Body) -> Self {
        let mut given = Self {
            body,
            on_edge: HashMap::new(),
            spreads: Vec::new(),
            in_cell: HashMap::new(),
        };
        for load in &body.loads {
            match load {
                Load::Pressure { facets, .. }
                | Load::Traction { facets, .. }
                | Load::VaryingPressure { facets, .. }
                | Load::VaryingTraction { facets, .. } => given.add(facets, load, None),
                Load::Spread { facets, wrench } => {
                    if let Some(spread) = spread_on(body, facets, wrench) {
                        given.spreads.push(spread);
                        given.add(facets, load, Some(given.spreads.len() - 1));
                    }
                }
                Load::BodyForce { cells, .. }
                | Load::Gravity { cells, .. }
                | Load::Centrifugal { cells, .. } => {
                    for &cell in cells {
                        given.in_cell.entry(cell).or_default().push(load);
                    }
                }
                // Heat and stress are in the stress; forces at nodes are refused.
                Load::Temperature { .. }
                | Load::InitialStress { .. }
                | Load::PointForce { .. }
                | Load::AtReference { .. } => {}
            }
        }
        given
    }

    fn add(&mut self, facets: &'a [Facet], load: &'a Load, spread: Option<usize>) {
        for facet in facets {
            let loads = self.on_edge.entry(key(&facet.nodes)).or_default();
            loads.push((load, spread));
        }
    }

    /// Force per area at a place of an edge with this outward normal, in pascal.
    pub(super) fn traction(
        &self,
        edge: [usize; 2],
        place: Vector2<f64>,
        normal: Vector2<f64>,
    ) -> Vector2<f64> {
        let at = [place.x, place.y, 0.0];
        let loads = self.on_edge.get(&edge).into_iter().flatten();
        loads
            .map(|(load, spread)| match load {
                Load::Pressure { pressure, .. } => normal * -*pressure,
                Load::VaryingPressure { pressure, .. } => normal * -pressure.at(at),
                Load::Traction { traction, .. } => Vector2::new(traction[0], traction[1]),
                Load::VaryingTraction { traction, .. } => {
                    Vector2::new(traction[0].at(at), traction[1].at(at))
                }
                // A wrench is that of the whole depth.
                _ => spread.map_or(Vector2::zeros(), |spread| {
                    self.spreads[spread].traction(Vector3::from(at)).xy() / self.body.model.depth()
                }),
            })
            .sum()
    }

    /// Force per volume at a place in a cell, in N/m³.
    pub(super) fn volume_force(&self, cell: usize, place: Vector2<f64>) -> Vector2<f64> {
        let density = self.body.materials[self.body.material_of_cell[cell]].density;
        let loads = self.in_cell.get(&cell).into_iter().flatten();
        loads
            .map(|load| match load {
                Load::BodyForce { density, .. } => Vector2::new(density[0], density[1]),
                Load::Gravity { acceleration, .. } => {
                    Vector2::new(acceleration[0], acceleration[1]) * density
                }
                Load::Centrifugal {
                    axis,
                    speed_squared,
                    ..
                } => {
                    let arm = axis.arm([place.x, place.y, 0.0]);
                    Vector2::new(arm[0], arm[1]) * (density * speed_squared)
                }
                _ => Vector2::zeros(),
            })
            .sum()
    }
}
