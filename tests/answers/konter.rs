//! NAFEMS' contact benchmark no. 2 (Konter, Advanced Finite Element Contact Benchmarks, 2006): a
//! punch with a rounded edge on a cylinder, both elastic and axisymmetric, without friction.

use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

use dpana::body::{CellKind, Facet, Group, Mesh};
use dpana::scene::MeshSource;
use dpana::{Scene, Status, solve};
use serde_json::json;

/// Cells along each side of the fillet's square.
const FILLET: usize = 6;

/// A side by its name, and whether a position is on it.
type Side<'a> = (&'a str, &'a dyn Fn([f64; 3]) -> bool);

/// A mesh under construction: nodes at the same place are one.
#[derive(Default)]
struct Blocks {
    nodes: Vec<[f64; 3]>,
    at: HashMap<[i64; 2], usize>,
    cells: Vec<Vec<usize>>,
}

impl Blocks {
    fn node(&mut self, [x, y]: [f64; 2]) -> usize {
        let key = [x, y].map(|c| (c * 1e6).round() as i64);
        *self.at.entry(key).or_insert_with(|| {
            self.nodes.push([x, y, 0.0]);
            self.nodes.len() - 1
        })
    }

    /// Cells between lines of the unit square, mapped into the plane; those without a first side
    /// become triangles.
    fn block(&mut self, us: &[f64], vs: &[f64], map: impl Fn(f64, f64) -> [f64; 2]) {
        for u in us.windows(2) {
            for v in vs.windows(2) {
                let corners = [(u[0], v[0]), (u[1], v[0]), (u[1], v[1]), (u[0], v[1])];
                let mut nodes = Vec::new();
                for (u, v) in corners {
                    let node = self.node(map(u, v));
                    if !nodes.contains(&node) {
                        nodes.push(node);
                    }
                }
                self.cells.push(nodes);
            }
        }
    }

    /// The mesh with its sides as groups: facets whose nodes all satisfy a condition.
    fn mesh(self, sides: &[Side<'_>]) -> Mesh {
        let mut mesh = Mesh::new(2, self.nodes);
        for nodes in self.cells {
            let kind = match nodes.len() {
                3 => CellKind::Tri3,
                _ => CellKind::Quad4,
            };
            mesh.push_cell(kind, &nodes);
        }
        let outer = mesh.boundary_facets();
        for (name, on) in sides {
            let within = |facet: &&Facet| facet.nodes.iter().all(|node| on(mesh.nodes[*node]));
            let facets: Vec<Facet> = outer.iter().filter(within).cloned().collect();
            assert!(!facets.is_empty(), "{name}");
            mesh.groups
                .insert((*name).to_owned(), Group::Facets(facets));
        }
        mesh
    }
}

fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..=count)
        .map(|k| from + (to - from) * k as f64 / count as f64)
        .collect()
}

/// ⌀ 100 and 100 high, its lower edge rounded with a radius of 10, in mm.
fn punch() -> Mesh {
    let mut blocks = Blocks::default();
    let (inner, outer) = (even(0.0, 40.0, 24), even(40.0, 50.0, FILLET));
    let (low, high) = (even(0.0, 10.0, FILLET), even(10.0, 100.0, 36));
    let straight = |x: f64, y: f64| [x, y];
    blocks.block(&inner, &low, straight);
    blocks.block(&inner, &high, straight);
    blocks.block(&outer, &high, straight);
    // Rings around (40, 10), from straight down to the right.
    let arc = even(0.0, FRAC_PI_2, 2 * FILLET);
    blocks.block(&even(0.0, 10.0, FILLET), &arc, |r, angle| {
        [40.0 + r * angle.sin(), 10.0 - r * angle.cos()]
    });
    let bottom = |[x, y, _]: [f64; 3]| {
        y < 1e-9 || (x > 40.0 - 1e-9 && ((x - 40.0).hypot(y - 10.0) - 10.0).abs() < 1e-6)
    };
    blocks.mesh(&[("bottom", &bottom), ("top", &|[_, y, _]| y > 100.0 - 1e-9)])
}

/// ⌀ 200 and 200 high, finer under the punch's edge.
fn foundation() -> Mesh {
    let mut blocks = Blocks::default();
    let mut xs = even(0.0, 36.0, 20);
    xs.extend(&even(36.0, 50.0, 24)[1..]);
    xs.extend(&even(50.0, 100.0, 20)[1..]);
    let mut depths = vec![0.0];
    let mut size = 0.8;
    while depths.last().unwrap() + 2.0 * size < 200.0 {
        depths.push(depths.last().unwrap() + size);
        size *= 1.08;
    }
    depths.push(200.0);
    let ys: Vec<f64> = depths.iter().rev().map(|y| 0.0 - y).collect();
    blocks.block(&xs, &ys, |x, y| [x, y]);
    blocks.mesh(&[
        ("top", &|[_, y, _]| y == 0.0),
        ("bottom", &|[_, y, _]| y == -200.0),
    ])
}

#[test]
fn the_foundation_gives_way_as_published() {
    let body = |name: &str, young: f64| {
        json!({
            "name": name, "mesh": {"file": "given in code"}, "model": "axisymmetric",
            "materials": [{"young": young, "poisson": 0.3}]
        })
    };
    let mut scene = json!({
        "bodies": [body("punch", 210e3), body("foundation", 70e3)],
        "contacts": [{
            "body": "foundation", "group": "top", "friction": 0,
            "against": {"body": "punch", "group": "bottom"}
        }]
    });
    scene["bodies"][0]["loads"] = json!([{"group": "top", "pressure": 100}]);
    scene["bodies"][1]["supports"] = json!([{"group": "bottom", "displacement": [0, 0]}]);
    let mut scene = Scene::from_json(&scene.to_string(), "").unwrap();
    scene.bodies[0].mesh = MeshSource::Given(punch());
    scene.bodies[1].mesh = MeshSource::Given(foundation());
    let solution = solve(&scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    let report = solution.report().unwrap();
    // 100 MPa on π 50² mm²: statics, certified to 1e-12, and two digits for K u, which sums larger forces.
    let load = 100.0 * std::f64::consts::PI * 2500.0;
    let carried = report.totals.contact_force[1].abs();
    assert!((carried / load - 1.0).abs() < 1e-10, "{carried}");
    let top = &report.certificate.bodies[1].supports.force;
    assert!((top[1] / load - 1.0).abs() < 1e-10, "{top:?}");
    let centre = solution.displacement_near(1, [0.0, 0.0, 0.0]).unwrap()[1];
    // Eight digits are published, of a mesh that is not: 1 % is a guard of the distance to it.
    assert!((centre / -0.132_897_45 - 1.0).abs() < 0.01, "{centre}");
    for body in &report.certificate.bodies {
        assert!(body.force_defect.scaled < 1e-10 && body.moment_defect.scaled < 1e-10);
    }
}
