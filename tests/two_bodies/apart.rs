//! Bodies that do not touch each other are solved together as if each were alone.

use dpana::alternation::{Outcome, Settings, Status, solve};
use dpana::body::{Body, CellKind, Facet, Group, Load, Material, Model, Support, rectangle};
use dpana::condensation::Condensed;
use dpana::contact::{ContactPair, Obstacle, Opposite};
use dpana::kkt::{self, Balance, Worst};

/// A square of side 1 m, pressed on top by `pressure`, its right side on a symmetry plane
/// and the corner at (1, 0) fixed, for friction alone does not count as a support.
fn square(name: &str, cells: usize, pressure: f64) -> Body {
    let side: Vec<f64> = (0..=cells).map(|k| k as f64 / cells as f64).collect();
    let mesh = rectangle(&side, &side, CellKind::Quad4).unwrap();
    let hold = |place: &str, displacement, held: fn(&[f64; 3]) -> bool| {
        let nodes = mesh.nodes.iter().enumerate().filter(|(_, x)| held(x));
        Support::new(place, nodes.map(|(node, _)| node).collect(), displacement)
    };
    let supports = vec![
        hold("supports[0]", [Some(0.0), None, None], |x| x[0] == 1.0),
        hold("supports[1]", [None, Some(0.0), None], |x| {
            *x == [1.0, 0.0, 0.0]
        }),
    ];
    let top = facets(&mesh.groups["top"]);
    let material = Material::new(1e3, 0.3);
    let mut body = Body::new(name, mesh, Model::PlaneStrain, vec![material]);
    body.supports = supports;
    body.loads = vec![Load::Pressure {
        facets: top,
        pressure,
    }];
    body
}

fn facets(group: &Group) -> Vec<Facet> {
    match group {
        Group::Facets(facets) => facets.clone(),
        _ => Vec::new(),
    }
}

/// The bottom of a body on a rough floor.
fn on_floor(index: usize, body: &Body) -> ContactPair {
    ContactPair::new(
        &format!("contacts[{index}]"),
        index,
        facets(&body.mesh.groups["bottom"]),
        Opposite::Obstacle(Obstacle::Plane {
            point: [0.0; 3],
            normal: [0.0, 1.0, 0.0],
        }),
        0.3,
    )
}

struct Solved {
    bodies: Vec<Body>,
    pairs: Vec<ContactPair>,
    condensed: Condensed,
    outcome: Outcome,
    displacements: Vec<Vec<f64>>,
}

impl Solved {
    fn new(bodies: Vec<Body>) -> Self {
        let pairs = bodies.iter().enumerate();
        let pairs: Vec<_> = pairs.map(|(index, body)| on_floor(index, body)).collect();
        let condensed = Condensed::new(&bodies, &pairs).unwrap();
        let outcome = solve(condensed.problem(), &Settings::default()).unwrap();
        let displacements = condensed
            .recover(&outcome.reaction, &outcome.motion)
            .unwrap();
        Self {
            bodies,
            pairs,
            condensed,
            outcome,
            displacements,
        }
    }

    fn balance(&self, index: usize) -> Balance {
        let (bodies, condensed) = (&self.bodies, &self.condensed);
        let (reaction, displacements) = (&self.outcome.reaction, &self.displacements);
        let states = kkt::BodyState::of_bodies(bodies, condensed, reaction, displacements);
        kkt::balance(&states[index]).unwrap()
    }

    fn departure(&self) -> Worst {
        kkt::surface_departure(
            &self.bodies,
            &self.displacements,
            self.condensed.surface(),
            self.condensed.problem(),
            &self.outcome.verdict.displacement,
            &[],
        )
        .unwrap()
    }
}

#[test]
fn two_bodies_on_one_floor_are_each_as_if_alone() {
    let bodies = [square("small", 4, 10.0), square("fine", 7, 20.0)];
    let together = Solved::new(bodies.to_vec());
    assert_eq!(together.outcome.status, Status::Certified);
    for (index, body) in bodies.into_iter().enumerate() {
        let alone = Solved::new(vec![body]);
        let motion = alone.displacements[0]
            .iter()
            .fold(0.0, |m: f64, u| m.max(u.abs()));
        let both = alone.displacements[0]
            .iter()
            .zip(&together.displacements[index]);
        // Certified to 1e-12; two digits for the condition of G, eight contacts across.
        for (a, b) in both {
            assert!((a - b).abs() < 1e-10 * motion, "{a:e} {b:e}");
        }
    }
}

#[test]
fn every_body_is_in_equilibrium_and_follows_the_condensed_problem() {
    let solved = Solved::new(vec![square("small", 4, 10.0), square("fine", 7, 20.0)]);
    assert!(
        solved.departure().scaled < 1e-12,
        "{:?}",
        solved.departure()
    );
    for (index, load) in [10.0, 20.0].into_iter().enumerate() {
        let balance = solved.balance(index);
        // 1 m² under the pressure.
        assert!((balance.loads.force[1] + load).abs() < 1e-12);
        assert!(balance.equilibrium.scaled < 1e-12, "{balance:?}");
        assert!(balance.force_defect.scaled < 1e-12, "{balance:?}");
        assert!(balance.moment_defect.scaled < 1e-12, "{balance:?}");
        let received = kkt::exchange(
            &solved.bodies,
            &solved.pairs,
            solved.condensed.surface(),
            solved.condensed.problem(),
            &solved.outcome.reaction,
        )
        .unwrap();
        let (a, b) = (received[index].own.force, balance.contact.force);
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-12 * load);
    }
}
