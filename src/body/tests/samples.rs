//! Bodies that the tests of this folder share.

#![allow(clippy::unwrap_used)]

use nalgebra::Vector3;

use crate::body::{
    Body, CellKind, Facet, Group, Material, Mesh, Model, Support, box_mesh, graded, mixed_box,
    rectangle,
};

/// Cells of plane bodies.
pub(crate) const PLANE: [CellKind; 5] = [
    CellKind::Tri3,
    CellKind::Quad4,
    CellKind::Tri6,
    CellKind::Quad8,
    CellKind::Quad9,
];

/// A block of 2 × 1 (× 1) m with 4 × 2 (× 2) uneven cells, `E = 10 Pa`, `ν = 0.3`.
pub(crate) fn block(kind: CellKind) -> Body {
    let (xs, ys) = (
        graded(0.0, 2.0, 4, 2.0).unwrap(),
        graded(0.0, 1.0, 2, 1.5).unwrap(),
    );
    let (mesh, model) = if kind.dimension() == 2 {
        (rectangle(&xs, &ys, kind).unwrap(), Model::PlaneStrain)
    } else {
        (box_mesh(&xs, &ys, &ys, kind).unwrap(), Model::Solid)
    };
    body(mesh, model, 0.3)
}

/// A body of one material, `E = 10 Pa`, with neither supports nor loads.
pub(crate) fn body(mesh: Mesh, model: Model, poisson: f64) -> Body {
    Body::new("block", mesh, model, vec![Material::new(10.0, poisson)])
}

/// A support that holds nodes along some axes.
pub(crate) fn support(nodes: &[usize], axes: &[usize]) -> Support {
    let mut displacement = [None; 3];
    for axis in axes {
        displacement[*axis] = Some(0.0);
    }
    Support::new("support", nodes.to_vec(), displacement)
}

/// The same block with every inner corner moved by a fifth of a cell or less, its sides straight.
pub(crate) fn distorted(kind: CellKind) -> Body {
    let mut body = block(kind);
    distort(&mut body);
    body
}

fn distort(body: &mut Body) {
    let axes = body.mesh.dimension;
    let sides = [2.0, 1.0, 1.0];
    for position in &mut body.mesh.nodes {
        let inside = (0..axes).all(|j| position[j] > 0.0 && position[j] < sides[j]);
        let [x, y, z] = *position;
        for (axis, entry) in position.iter_mut().enumerate().take(axes) {
            if inside {
                *entry += 0.08 * (7.0 * x + 11.0 * y + 5.0 * z + axis as f64).sin();
            }
        }
    }
    straighten(&mut body.mesh);
}

/// Moves the nodes between corners to where straight sides have them.
pub(crate) fn straighten(mesh: &mut Mesh) {
    for index in 0..mesh.cell_count() {
        let kind = mesh.cell(index).kind;
        let linear = kind.linear();
        let nodes = mesh.cell(index).nodes.to_vec();
        for local in linear.node_count()..nodes.len() {
            let shape = linear.reference().shape(kind.position(local));
            let corners = nodes.iter().zip(shape);
            let at = corners.map(|(node, n)| Vector3::from(mesh.nodes[*node]) * n);
            let at: Vector3<f64> = at.sum();
            mesh.nodes[nodes[local]] = at.into();
        }
    }
}

/// Facets of a named group.
pub(crate) fn facets(mesh: &Mesh, name: &str) -> Vec<Facet> {
    match &mesh.groups[name] {
        Group::Facets(facets) => facets.clone(),
        other => unreachable!("{other:?}"),
    }
}

/// Holds one component of a named group's nodes at zero.
pub(crate) fn hold(body: &mut Body, name: &str, axis: usize) {
    let nodes = facets(&body.mesh, name)
        .into_iter()
        .flat_map(|facet| facet.nodes);
    let mut displacement = [None; 3];
    displacement[axis] = Some(0.0);
    body.supports
        .push(Support::new(name, nodes.collect(), displacement));
}

/// Solves `K u = f` for the components that are not prescribed, by a dense factorisation.
pub(crate) fn solve(body: &Body) -> Vec<f64> {
    let stiffness = crate::body::stiffness(body);
    let force = crate::body::load_vector(body);
    let prescribed = crate::body::prescribed(body).unwrap();
    let free: Vec<usize> = (0..force.len())
        .filter(|i| prescribed[*i].is_none())
        .collect();
    let mut place = vec![usize::MAX; force.len()];
    for (at, unknown) in free.iter().enumerate() {
        place[*unknown] = at;
    }
    let mut matrix = faer::Mat::<f64>::zeros(free.len(), free.len());
    let mut right = faer::Mat::<f64>::zeros(free.len(), 1);
    for (at, unknown) in free.iter().enumerate() {
        right[(at, 0)] = force[*unknown];
        for (column, value) in stiffness.outer_view(*unknown).unwrap().iter() {
            match prescribed[column] {
                Some(given) => right[(at, 0)] -= value * given,
                None => matrix[(at, place[column])] = *value,
            }
        }
    }
    let factor = faer::linalg::solvers::Llt::new(matrix.as_ref(), faer::Side::Lower).unwrap();
    let solution = faer::linalg::solvers::Solve::solve(&factor, right);
    let mut displacement: Vec<f64> = prescribed.iter().map(|u| u.unwrap_or(0.0)).collect();
    for (at, unknown) in free.iter().enumerate() {
        displacement[*unknown] = solution[(at, 0)];
    }
    displacement
}

/// What `check` says about a block after a change.
pub(crate) fn complaint(kind: CellKind, change: impl Fn(&mut Body)) -> String {
    let mut body = block(kind);
    change(&mut body);
    match crate::body::check(&body) {
        Ok(()) => String::new(),
        Err(error) => error.to_string(),
    }
}

pub(crate) fn assert_says(kind: CellKind, change: impl Fn(&mut Body), parts: &[&str]) {
    let found = complaint(kind, change);
    assert!(parts.iter().all(|part| found.contains(part)), "{found}");
}

/// A distorted block whose upright columns are hexahedra, pyramids and prisms in turn, linear or quadratic.
pub(crate) fn mixed(quadratic: bool) -> Body {
    let kinds = match quadratic {
        false => [CellKind::Hex8, CellKind::Pyramid5, CellKind::Prism6],
        true => [CellKind::Hex20, CellKind::Pyramid13, CellKind::Prism15],
    };
    let xs = graded(0.0, 2.0, 4, 2.0).unwrap();
    let ys = graded(0.0, 1.0, 3, 1.5).unwrap();
    let kind = |[i, j, _]: [usize; 3]| kinds[(i + j) % 3];
    let mut body = body(mixed_box(&xs, &ys, &ys, kind).unwrap(), Model::Solid, 0.3);
    distort(&mut body);
    body
}
