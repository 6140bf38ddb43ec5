//! Prescribed displacements, component by component.

use super::{Body, Support, dependence, held_by_axis};
use crate::error::Error;

/// Prescribed displacement per unknown `dimension · node + axis`, in metre; `None` where free.
///
/// Nodes on the axis of an axisymmetric body cannot leave it, whether a support says so or not.
///
/// # Errors
///
/// [`Error::ContradictorySupports`] if two supports give one component different values
/// (equal ones are fine), [`Error::UnknownIndex`] for a node that does not exist,
/// [`Error::OutOfRange`] for a support that moves a node off the axis.
pub(crate) fn prescribed(body: &Body) -> Result<Vec<Option<f64>>, Error> {
    if let Some(dependence) = dependence(body)? {
        return Ok(dependence.given(&dependence.values(|_| 1.0)));
    }
    let mesh = &body.mesh;
    let mut prescribed = prescribed_by(&body.supports, mesh.dimension, mesh.nodes.len())?;
    for unknown in held_by_axis(body) {
        if let Some(value) = prescribed[unknown].filter(|value| *value != 0.0) {
            return Err(Error::OutOfRange {
                place: format!("{}: radial displacement on the axis", body.name),
                value,
                accepted: "0 at nodes on the axis",
            });
        }
        prescribed[unknown] = Some(0.0);
    }
    Ok(prescribed)
}

/// The same by some supports of a body of `nodes` nodes that may move along `axes` axes.
///
/// # Errors
///
/// Those of [`prescribed`].
pub(crate) fn prescribed_by(
    supports: &[Support],
    axes: usize,
    nodes: usize,
) -> Result<Vec<Option<f64>>, Error> {
    // Per unknown the number of the first support that holds it, to name it if another disagrees.
    let mut holder: Vec<Option<usize>> = vec![None; axes * nodes];
    let mut prescribed = vec![None; axes * nodes];
    for (index, support) in supports.iter().enumerate() {
        for (at, &node) in support.nodes.iter().enumerate() {
            if node >= nodes {
                return Err(Error::UnknownIndex {
                    place: support.place.clone(),
                    what: "node",
                    index: node,
                    count: nodes,
                });
            }
            for (axis, value) in support.given(at).into_iter().enumerate().take(axes) {
                let Some(value) = value else { continue };
                let unknown = axes * node + axis;
                match (prescribed[unknown], holder[unknown]) {
                    (Some(before), Some(first)) if before != value => {
                        let places = [&supports[first], support];
                        return Err(contradiction(places, node, axis, [before, value]));
                    }
                    (Some(_), _) => {}
                    (None, _) => {
                        prescribed[unknown] = Some(value);
                        holder[unknown] = Some(index);
                    }
                }
            }
        }
    }
    Ok(prescribed)
}

impl Support {
    /// The support with its displacement times a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            displacement: self.displacement.map(|u| u.map(|u| factor * u)),
            offsets: self.offsets.iter().map(|u| u.map(|u| factor * u)).collect(),
            ..self.clone()
        }
    }

    /// What is prescribed at the node of this number in the list, per axis, in metre.
    #[must_use]
    pub fn given(&self, at: usize) -> [Option<f64>; 3] {
        let Some(offset) = self.offsets.get(at) else {
            return self.displacement;
        };
        [0, 1, 2].map(|axis| self.displacement[axis].map(|u| u + offset[axis]))
    }

    /// Direction of a component at the node of this number in the list.
    #[must_use]
    pub fn direction(&self, at: usize, component: usize) -> [f64; 3] {
        let mut axis = [0.0; 3];
        axis[component] = 1.0;
        self.axes.get(at).map_or(axis, |axes| axes[component])
    }
}

fn contradiction(supports: [&Support; 2], node: usize, axis: usize, values: [f64; 2]) -> Error {
    Error::ContradictorySupports {
        places: supports.map(|support| support.place.clone()),
        node,
        component: ['x', 'y', 'z'][axis],
        values,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::CellKind;
    use crate::body::tests::samples::block;

    fn support(place: &str, nodes: &[usize], displacement: [Option<f64>; 3]) -> Support {
        Support::new(place, nodes.to_vec(), displacement)
    }

    #[test]
    fn components_that_no_support_names_stay_free() {
        let mut body = block(CellKind::Quad4);
        body.supports = vec![
            support("a", &[0, 1], [Some(0.5), None, None]),
            support("b", &[1], [Some(0.5), Some(0.0), None]),
        ];
        let found = prescribed(&body);
        let first = found.map(|all| all[..6].to_vec());
        assert_eq!(
            first,
            Ok(vec![Some(0.5), None, Some(0.5), Some(0.0), None, None])
        );
    }

    #[test]
    fn two_values_for_one_component_are_refused_with_both_places() {
        let mut body = block(CellKind::Hex8);
        body.supports = vec![
            support("a", &[0, 1], [None, Some(0.5), None]),
            support("b", &[1], [None, Some(0.25), None]),
        ];
        let expected = Error::ContradictorySupports {
            places: ["a".to_owned(), "b".to_owned()],
            node: 1,
            component: 'y',
            values: [0.5, 0.25],
        };
        assert_eq!(prescribed(&body), Err(expected));
    }

    #[test]
    fn a_node_that_does_not_exist_is_refused() {
        let mut body = block(CellKind::Tri3);
        body.supports = vec![support("a", &[1000], [Some(0.0), None, None])];
        assert!(matches!(
            prescribed(&body),
            Err(Error::UnknownIndex { index: 1000, .. })
        ));
    }
}
