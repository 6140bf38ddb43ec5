//! A contact: where a body may touch another side, its axes, gap and area.

/// One corner of the contact surface, facing the other side.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactNode {
    /// Index of the body.
    pub body: usize,
    /// Node of its mesh where it stands.
    pub node: usize,
    /// Nodes of the body that it moves with and their weights, which add up to one: its own
    /// node alone on linear facets, those around it on quadratic ones; on a facet that the
    /// other side covers in part, those between which the cover ends.
    pub own: Vec<(usize, f64)>,
    /// The other side; none if that is a rigid obstacle.
    pub opposite: Option<OppositeNodes>,
    /// Index of the contact pair.
    pub pair: usize,
    /// Position before loading, in metre.
    pub position: [f64; 3],
    /// Orthonormal rows: normal (towards the other side), then the tangents.
    pub frame: [[f64; 3]; 3],
    /// Number of tangents that the contact problem holds: 0 without friction, at most
    /// 1 in 2D and 2 in 3D, fewer where a support holds one.
    pub tangents: usize,
    /// Distance along the normal to the other side before loading, in metre.
    pub initial_gap: f64,
    /// Tributary area, in m² (plane bodies: for their depth, axisymmetric ones: of the ring).
    pub area: f64,
    /// Mean distance by which the smooth surfaces of both sides stand off their facets towards each
    /// other, in metre: what straight facets add to a gap. Taken off if the pair is rounded.
    pub bulge: f64,
    /// It stands on the second surface of its pair, which carries the contacts.
    pub second: bool,
    /// The body's surface goes on beyond the assumed contact surface here.
    pub rim: bool,
}

/// The nodes of the other side that a contact is coupled to.
#[derive(Clone, Debug, PartialEq)]
pub struct OppositeNodes {
    /// Index of the body.
    pub body: usize,
    /// Nodes and their mortar weights, which add up to one.
    pub nodes: Vec<(usize, f64)>,
}

impl ContactNode {
    /// Where its displacement is measured and its force acts on its own body, whose nodes are at
    /// `nodes`: the mean of those that it moves with, in metre.
    #[must_use]
    pub fn centre(&self, nodes: &[[f64; 3]]) -> [f64; 3] {
        let mut centre = [0.0; 3];
        for &(node, weight) in &self.own {
            for (sum, x) in centre.iter_mut().zip(nodes[node]) {
                *sum += weight * x;
            }
        }
        centre
    }
}
