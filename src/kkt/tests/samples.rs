//! Two bodies with one contact between them, for tests.

use faer::Mat;

use crate::body::{Body, Mesh, Model};
use crate::contact::{ContactNode, ContactPair, ContactSurface, Obstacle, Opposite, OppositeNodes};
use crate::problem::{ContactProblem, Operator};

/// Node (1, 0) of a lid above a box with the nodes (0, −gap) and (4, −gap): three quarters of
/// the contact force go to the near one.
pub(crate) fn lid_on_box(gap: f64) -> (Vec<Body>, ContactSurface, ContactProblem) {
    let lid = body("lid", vec![[1.0, 0.0, 0.0]]);
    let under = body("box", vec![[4.0, -gap, 0.0], [0.0, -gap, 0.0]]);
    let contact = ContactNode {
        body: 0,
        node: 0,
        own: vec![(0, 1.0)],
        opposite: Some(OppositeNodes {
            body: 1,
            nodes: vec![(1, 0.75), (0, 0.25)],
        }),
        pair: 0,
        position: [1.0, 0.0, 0.0],
        frame: [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        tangents: 1,
        initial_gap: gap,
        area: 1.0,
        bulge: 0.0,
        second: false,
        rim: false,
    };
    let surface = ContactSurface {
        nodes: vec![contact],
        ..ContactSurface::default()
    };
    let operator = Operator::from_compliance(Mat::identity(2, 2));
    let problem = operator.and_then(|operator| {
        ContactProblem::new(&[1], vec![0.5], vec![gap], vec![0.0; 2], operator)
    });
    #[allow(clippy::unwrap_used)]
    (vec![lid, under], surface, problem.unwrap())
}

/// The lid against the box, and a pair with an obstacle that has no contact.
pub(crate) fn pairs() -> Vec<ContactPair> {
    let pair = |opposite| ContactPair::new("contacts[0]", 0, Vec::new(), opposite, 0.5);
    let plane = Obstacle::Plane {
        point: [0.0; 3],
        normal: [0.0, 1.0, 0.0],
    };
    vec![
        pair(Opposite::Surface {
            body: 1,
            facets: Vec::new(),
        }),
        pair(Opposite::Obstacle(plane)),
    ]
}

fn body(name: &str, nodes: Vec<[f64; 3]>) -> Body {
    Body::new(name, Mesh::new(2, nodes), Model::PlaneStrain, Vec::new())
}
