//! What supports and loads must satisfy: they lie on the body, once, and are numbers.

use std::collections::HashSet;

use super::boundary::Owners;
use super::entries::{check_indices, check_vector};
use super::{Body, Facet, Load};
use crate::error::{Error, check_finite};

/// Checks nodes and values of every support.
pub(super) fn check_supports(body: &Body) -> Result<(), Error> {
    for support in &body.supports {
        let place = || support.place.clone();
        check_not_empty(place, support.nodes.len())?;
        check_indices(place, "node", &support.nodes, body.mesh.nodes.len())?;
        let values = support.displacement.map(|value| value.unwrap_or(0.0));
        check_vector(body, || format!("{}.displacement", support.place), &values)?;
    }
    Ok(())
}

/// Checks facets, cells, nodes and values of every load.
pub(super) fn check_loads(body: &Body) -> Result<(), Error> {
    let listed = body.loads.iter().flat_map(|load| match load {
        Load::Pressure { facets, .. } | Load::Traction { facets, .. } => facets.as_slice(),
        Load::BodyForce { .. } | Load::PointForce { .. } => &[],
    });
    let owners = Owners::new(&body.mesh, listed);
    for (index, load) in body.loads.iter().enumerate() {
        let place = || format!("{}: loads[{index}]", body.name);
        match load {
            Load::Pressure { facets, pressure } => {
                check_finite(&format!("{}.pressure", place()), &[*pressure])?;
                check_facets(body, place, facets, &owners)?;
            }
            Load::Traction { facets, traction } => {
                check_vector(body, || format!("{}.traction", place()), traction)?;
                check_facets(body, place, facets, &owners)?;
            }
            Load::BodyForce { cells, density } => {
                check_vector(body, || format!("{}.density", place()), density)?;
                check_not_empty(place, cells.len())?;
                check_indices(place, "cell", cells, body.mesh.cell_count())?;
                check_once(place, "cell", cells.iter().map(|cell| vec![*cell]))?;
            }
            Load::PointForce { node, force } => {
                check_vector(body, || format!("{}.force", place()), force)?;
                check_indices(place, "node", &[*node], body.mesh.nodes.len())?;
            }
        }
    }
    Ok(())
}

fn check_facets(
    body: &Body,
    place: impl Fn() -> String,
    facets: &[Facet],
    owners: &Owners<'_>,
) -> Result<(), Error> {
    check_not_empty(&place, facets.len())?;
    for (index, facet) in facets.iter().enumerate() {
        let place = || format!("{}.facets[{index}]", place());
        let outward = owners.outward(facet, place)?;
        let dimension = body.mesh.dimension;
        if !same_cycle(facet.corners(dimension), outward.corners(dimension)) {
            return Err(Error::FacetInward {
                place: place(),
                nodes: facet.nodes.clone(),
            });
        }
    }
    let sorted = facets.iter().map(|facet| {
        let mut nodes = facet.nodes.clone();
        nodes.sort_unstable();
        nodes
    });
    check_once(place, "facet", sorted)
}

/// Whether two walks around a facet differ only in where they start; two ends of a line do not.
fn same_cycle(one: &[usize], other: &[usize]) -> bool {
    if one.len() == 2 {
        return one == other;
    }
    (0..other.len()).any(|start| {
        let turned = other[start..].iter().chain(&other[..start]);
        one.iter().eq(turned)
    })
}

fn check_not_empty(place: impl Fn() -> String, length: usize) -> Result<(), Error> {
    if length > 0 {
        return Ok(());
    }
    Err(Error::Empty { place: place() })
}

fn check_once(
    place: impl Fn() -> String,
    what: &'static str,
    mut entries: impl Iterator<Item = Vec<usize>>,
) -> Result<(), Error> {
    let mut seen = HashSet::new();
    match entries.find(|entry| !seen.insert(entry.clone())) {
        None => Ok(()),
        Some(index) => Err(Error::Repeated {
            place: place(),
            what,
            index,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::CellKind;
    use crate::body::tests::samples::{assert_says, complaint, facets};

    #[test]
    fn loads_on_nothing_inside_backwards_or_twice_are_refused() {
        let press = |change: fn(&mut Vec<Facet>)| {
            move |body: &mut Body| {
                let mut facets = facets(&body.mesh, "top");
                change(&mut facets);
                body.loads = vec![Load::Pressure {
                    facets,
                    pressure: 1.0,
                }];
            }
        };
        for kind in CellKind::all() {
            assert_says(kind, press(|f| f.clear()), &["block: loads[0]", "empty"]);
            assert_says(
                kind,
                press(|f| f[1].nodes.reverse()),
                &["loads[0].facets[1]", "outward order"],
            );
            assert_says(
                kind,
                press(|f| f.push(f[0].clone())),
                &["loads[0]", "twice"],
            );
            assert_says(
                kind,
                press(|f| f[0].nodes[0] = 999),
                &["loads[0].facets[0]", "belongs to 0 cells"],
            );
        }
        let inside = press(|facets| facets[0].nodes = vec![6, 7]);
        assert_says(CellKind::Quad4, inside, &["[6, 7]", "belongs to 2 cells"]);
        let weight = Load::BodyForce {
            cells: vec![3, 3],
            density: [1.0, 0.0, 0.0],
        };
        assert_says(
            CellKind::Quad4,
            |b| b.loads = vec![weight.clone()],
            &["cell [3]", "twice"],
        );
    }

    #[test]
    fn a_facet_may_start_at_any_of_its_nodes() {
        let turn = |body: &mut Body| {
            let mut facets = facets(&body.mesh, "top");
            facets[0].nodes.rotate_left(2);
            body.loads = vec![Load::Pressure {
                facets,
                pressure: 1.0,
            }];
        };
        assert_eq!(complaint(CellKind::Hex8, turn), "");
        assert_eq!(complaint(CellKind::Tet4, turn), "");
    }
}
