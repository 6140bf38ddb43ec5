//! What supports and loads must satisfy: they lie on the body, once, and are numbers.

use std::collections::HashSet;

use super::boundary::Owners;
use super::entries::{check_indices, check_vector};
use super::{Body, Facet, Ground, Line, Load, Material, Model, Tie, Wrench};
use crate::error::{Error, check_finite, check_length};

/// Checks nodes and values of every support, and of every spring.
pub(super) fn check_supports(body: &Body) -> Result<(), Error> {
    for support in &body.supports {
        let place = || support.place.clone();
        check_not_empty(place, support.nodes.len())?;
        check_indices(place, "node", &support.nodes, body.mesh.nodes.len())?;
        let values = support.displacement.map(|value| value.unwrap_or(0.0));
        check_vector(body, || format!("{}.displacement", support.place), &values)?;
        if !support.offsets.is_empty() {
            let place = format!("{}.offsets", support.place);
            check_length(&place, support.nodes.len(), support.offsets.len())?;
        }
        for offset in &support.offsets {
            check_vector(body, || format!("{}.offsets", support.place), offset)?;
        }
        if !support.axes.is_empty() {
            let place = format!("{}.axes", support.place);
            check_length(&place, support.nodes.len(), support.axes.len())?;
            check_finite(&place, support.axes.as_flattened().as_flattened())?;
        }
    }
    body.ties.iter().try_for_each(|tie| check_tie(body, tie))?;
    for spring in &body.foundation {
        spring.check(body)?;
        let place = || spring.place.clone();
        if let Ground::Area(facets) = &spring.on {
            let owners = Owners::new(&body.mesh, facets.iter());
            check_facets(body, place, facets, &owners)?;
        }
    }
    Ok(())
}

/// Nodes and numbers of a tie; the motion of a rigid group shows on its nodes.
fn check_tie(body: &Body, tie: &Tie) -> Result<(), Error> {
    let (count, place) = (body.mesh.nodes.len(), || tie.place().to_owned());
    match tie {
        Tie::Pairs(tied) => {
            check_indices(place, "node", tied.pairs.as_flattened(), count)?;
            check_finite(&place(), tied.rotation.as_flattened())
        }
        Tie::Rigid(group) => {
            check_not_empty(place, group.nodes.len())?;
            check_indices(place, "node", &group.nodes, count)?;
            check_finite(&place(), &group.reference_point)?;
            let given = group.displacement.iter().chain(&group.rotation).flatten();
            check_finite(&place(), &given.copied().collect::<Vec<_>>())?;
            match body.model == Model::Axisymmetric || group.turns(body) {
                true => Ok(()),
                false => Err(Error::NotAccepted {
                    place: place(),
                    found: "a single node, or nodes on a line".to_owned(),
                    accepted: "nodes whose displacements tell every rotation of the group"
                        .to_owned(),
                }),
            }
        }
    }
}

/// Checks facets, cells, nodes and values of every load.
pub(super) fn check_loads(body: &Body) -> Result<(), Error> {
    let listed = body.loads.iter().flat_map(facets_of);
    let owners = Owners::new(&body.mesh, listed);
    for (index, load) in body.loads.iter().enumerate() {
        let place = || format!("{}: loads[{index}]", body.name);
        check_values(body, place, load)?;
        match load {
            Load::PointForce { node, .. } => {
                check_indices(place, "node", &[*node], body.mesh.nodes.len())?;
            }
            Load::AtReference { nodes, .. } => {
                check_not_empty(place, nodes.len())?;
                check_indices(place, "node", nodes, body.mesh.nodes.len())?;
            }
            Load::BodyForce { cells, .. }
            | Load::Gravity { cells, .. }
            | Load::Centrifugal { cells, .. }
            | Load::Temperature { cells, .. }
            | Load::InitialStress { cells, .. } => {
                check_not_empty(place, cells.len())?;
                check_indices(place, "cell", cells, body.mesh.cell_count())?;
                check_once(place, "cell", cells.iter().map(|cell| vec![*cell]))?;
                check_material(body, place, load, cells)?;
            }
            Load::Pressure { .. }
            | Load::Traction { .. }
            | Load::VaryingPressure { .. }
            | Load::VaryingTraction { .. }
            | Load::Spread { .. } => check_facets(body, place, facets_of(load), &owners)?,
        }
    }
    Ok(())
}

/// The facets of a load on the surface.
fn facets_of(load: &Load) -> &[Facet] {
    match load {
        Load::Pressure { facets, .. }
        | Load::Traction { facets, .. }
        | Load::VaryingPressure { facets, .. }
        | Load::VaryingTraction { facets, .. }
        | Load::Spread { facets, .. } => facets,
        _ => &[],
    }
}

/// Numbers of a load.
fn check_values(body: &Body, place: impl Fn() -> String, load: &Load) -> Result<(), Error> {
    let at = |field: &'static str| move |place: String| format!("{place}.{field}");
    let vector = |field, value: [f64; 3]| check_vector(body, || at(field)(place()), &value);
    match load {
        Load::Pressure { pressure, .. } => check_finite(&at("pressure")(place()), &[*pressure]),
        Load::Traction { traction, .. } => vector("traction", *traction),
        Load::BodyForce { density, .. } => vector("density", *density),
        Load::PointForce { force, .. } => vector("force", *force),
        Load::VaryingPressure { pressure, .. } => {
            check_finite(&at("pressure")(place()), &[pressure.value])?;
            vector("pressure.gradient", pressure.gradient)
        }
        Load::VaryingTraction { traction, .. } => {
            vector("traction", traction.map(|component| component.value))?;
            let mut gradients = traction.iter().map(|component| component.gradient);
            gradients.try_for_each(|g| vector("traction.gradient", g))
        }
        Load::Spread { wrench, .. } | Load::AtReference { wrench, .. } => {
            check_wrench(body, place, wrench)
        }
        Load::Gravity { acceleration, .. } => vector("acceleration", *acceleration),
        Load::Centrifugal {
            axis,
            speed_squared,
            ..
        } => {
            check_finite(&at("speed_squared")(place()), &[*speed_squared])?;
            check_finite(&at("axis.point")(place()), &axis.point)?;
            check_finite(&at("axis.direction")(place()), &axis.direction)?;
            check_spin(body, place, axis)
        }
        Load::Temperature { rise, .. } => {
            check_length(&at("rise")(place()), body.mesh.nodes.len(), rise.len())?;
            check_finite(&at("rise")(place()), rise)
        }
        Load::InitialStress { stress, .. } => {
            check_finite(&at("stress")(place()), stress)?;
            check_in_plane(body, place, stress)
        }
    }
}

/// A wrench moves a body in its own space, a ring along its axis only.
fn check_wrench(body: &Body, place: impl Fn() -> String, wrench: &Wrench) -> Result<(), Error> {
    check_vector(body, || format!("{}.force", place()), &wrench.force)?;
    check_finite(&format!("{}.moment", place()), &wrench.moment)?;
    if let Some(at) = &wrench.at {
        check_vector(body, || format!("{}.at", place()), at)?;
    }
    let (force, moment) = (wrench.force, wrench.moment);
    let refused = match body.model {
        Model::Axisymmetric if force[0] != 0.0 => Some((
            "force[0]",
            force[0],
            "0, for across the axis a ring's forces are no resultant",
        )),
        Model::Axisymmetric => {
            (moment != [0.0; 3]).then_some(("moment", moment[2], "0, for the body is axisymmetric"))
        }
        Model::Solid => None,
        _ => moment[..2].iter().find(|m| **m != 0.0).map(|m| {
            (
                "moment",
                *m,
                "a moment about z alone, for the body is plane",
            )
        }),
    };
    match refused {
        None => Ok(()),
        Some((field, value, accepted)) => Err(Error::OutOfRange {
            place: format!("{}.{field}", place()),
            value,
            accepted,
        }),
    }
}

/// A body spins about an axis that leaves it in its space.
fn check_spin(body: &Body, place: impl Fn() -> String, axis: &Line) -> Result<(), Error> {
    let [x, y, z] = axis.direction;
    let (fits, accepted) = match body.model {
        Model::Solid => (
            axis.direction != [0.0; 3],
            "a direction of any length but zero",
        ),
        Model::Axisymmetric => (
            [x, z] == [0.0; 2] && y != 0.0 && axis.point[0] == 0.0,
            "the body's own axis x = 0, for it is axisymmetric",
        ),
        _ => (
            [x, y] == [0.0; 2] && z != 0.0,
            "the direction of z, for the body is plane",
        ),
    };
    match fits {
        true => Ok(()),
        false => Err(Error::NotAccepted {
            place: format!("{}.axis", place()),
            found: format!("{:?} through {:?}", axis.direction, axis.point),
            accepted: accepted.to_owned(),
        }),
    }
}

/// The stress out of the plane is zero in plane stress, shear there in all plane bodies.
fn check_in_plane(body: &Body, place: impl Fn() -> String, stress: &[f64; 6]) -> Result<(), Error> {
    let zero: &[usize] = match body.model {
        Model::Solid => &[],
        Model::PlaneStress { .. } => &[2, 3, 4],
        Model::PlaneStrain | Model::Axisymmetric => &[3, 4],
    };
    match zero.iter().find(|k| stress[**k] != 0.0) {
        None => Ok(()),
        Some(k) => Err(Error::OutOfRange {
            place: format!("{}.stress[{k}]", place()),
            value: stress[*k],
            accepted: "0 out of the plane (order xx, yy, zz, yz, xz, xy)",
        }),
    }
}

/// A load on mass or by heat acts on some material.
fn check_material(
    body: &Body,
    place: impl Fn() -> String,
    load: &Load,
    cells: &[usize],
) -> Result<(), Error> {
    let acts = |on: fn(&Material) -> bool| {
        let mut materials = cells.iter().map(|cell| body.material_of_cell[*cell]);
        materials.any(|material| on(&body.materials[material]))
    };
    let (fits, field) = match load {
        Load::Gravity { .. } | Load::Centrifugal { .. } => (acts(|m| m.density != 0.0), "density"),
        Load::Temperature { .. } => (acts(Material::expands), "expansion"),
        _ => (true, ""),
    };
    match fits {
        true => Ok(()),
        false => Err(Error::NotAccepted {
            place: place(),
            found: format!("materials without `{field}`"),
            accepted: format!("a `{field}` of a material that the load acts on"),
        }),
    }
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
