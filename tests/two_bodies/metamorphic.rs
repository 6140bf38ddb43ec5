//! What must not change an answer: random bodies are solved as they are, then with the sides of their pairs
//! exchanged, far from the origin, turned, in other units, with bodies, nodes and cells in another order,
//! with loads in parts, with whole skins as contact surfaces, and under more load.
//!
//! Bounds: what only reorders or rescales sums keeps eight digits; far away, coordinates keep thirteen digits
//! of which the approach is a thousandth.

use std::fmt;

use dpana::alternation::{self, Settings};
use dpana::body::{
    Body, CellKind, Facet, Group, Load, Material, Mesh, Model, Support, box_mesh, rectangle,
};
use dpana::condensation::Condensed;
use dpana::contact::{ContactPair, Opposite};
use dpana::kkt::{SceneGeometry, exchange};
use dpana::{Acting, Measured, Status};

/// Bodies and the pairs between them.
#[derive(Clone, Debug)]
struct Assembly {
    bodies: Vec<Body>,
    pairs: Vec<ContactPair>,
    /// Sides touch before loading, on flat faces: the answer grows in proportion to the load.
    proportional: bool,
}

struct Answer {
    status: Status,
    /// What the judge of the scene objects to.
    fault: String,
    /// Per body and node.
    displacements: Vec<Vec<[f64; 3]>>,
    /// On the first side of each pair.
    forces: Vec<[f64; 3]>,
    /// The body that carries the contacts of each pair.
    carriers: Vec<usize>,
}

/// Numbers that look random: xorshift64* (Marsaglia, J. Stat. Softw. 8 (2003) no. 14).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    fn one_of<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }

    fn shuffled(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            order.swap(last, self.below(last + 1));
        }
        order
    }
}

impl Assembly {
    /// Two or three bodies, one upon the other; the lowest is clamped, the uppermost is pushed down and aside.
    fn random(random: &mut Random) -> Self {
        let model = random.one_of(&[
            Model::PlaneStrain,
            Model::PlaneStrain,
            Model::PlaneStress { thickness: 0.3 },
            Model::Axisymmetric,
            Model::Solid,
        ]);
        let count = 2 + random.below(2);
        let flat = random.next() < 0.7;
        let touching = flat && random.next() < 0.5;
        let radius = random.between(4.0, 40.0);
        let (mut bodies, mut low) = (Vec::new(), 0.0);
        for level in 0..count {
            let high = low + random.between(0.3, 0.8);
            let mut mesh = block(random, model, [low, high]);
            // The lower side of the uppermost body is round.
            if !flat && level + 1 == count {
                bend(&mut mesh, [low, high], radius);
            }
            bodies.push(Body {
                name: format!("body {level}"),
                material_of_cell: vec![0; mesh.cell_count()],
                mesh,
                model,
                materials: vec![Material::new(
                    10_f64.powf(random.between(0.0, 6.0)),
                    random.between(0.0, 0.4),
                )],
                supports: Vec::new(),
                loads: Vec::new(),
                foundation: Vec::new(),
                ties: Vec::new(),
            });
            let apart = match touching {
                true => 0.0,
                false => random.between(-1e-3, 1e-3),
            };
            low = high + apart;
        }
        let mut assembly = Self {
            pairs: (1..count)
                .map(|level| pair(&bodies, level, random))
                .collect(),
            bodies,
            proportional: touching,
        };
        assembly.hold(random);
        assembly
    }

    /// Clamps the lowest body, pushes the uppermost, and pulls at the top of all but that.
    fn hold(&mut self, random: &mut Random) {
        let up = self.up();
        let last = self.bodies.len() - 1;
        let aside = match self.bodies[0].model {
            Model::Axisymmetric => 0.0,
            _ => random.between(-3e-3, 3e-3),
        };
        for (level, group, push) in [
            (0, "bottom", 0.0),
            (last, "top", -random.between(2e-3, 8e-3)),
        ] {
            let mut displacement = [None; 3];
            displacement[..=up].fill(Some(0.0));
            displacement[up] = Some(push);
            if level == last {
                displacement[0] = Some(aside);
            }
            let body = &mut self.bodies[level];
            body.supports.push(Support {
                place: "support".to_owned(),
                nodes: nodes(&body.mesh, group),
                displacement,
                offsets: Vec::new(),
                axes: Vec::new(),
            });
        }
        for body in &mut self.bodies {
            let mut density = [0.0; 3];
            density[up] = -1e-4 * body.materials[0].young * random.next();
            let cells = (0..body.mesh.cell_count()).collect();
            body.loads.push(Load::BodyForce { cells, density });
        }
    }

    /// Axis along which the bodies stand one upon the other.
    fn up(&self) -> usize {
        self.bodies[0].mesh.dimension - 1
    }

    fn solve(&self) -> Answer {
        let condensed = Condensed::new(&self.bodies, &self.pairs).unwrap();
        let problem = condensed.problem();
        let outcome = alternation::solve(problem, &Settings::default()).unwrap();
        let displacements = condensed
            .recover(&outcome.reaction, &outcome.motion)
            .unwrap();
        let surface = condensed.surface();
        let geometry = SceneGeometry::new(&self.bodies, &self.pairs, surface).unwrap();
        let found = (&outcome, &displacements[..]);
        let measured = Measured::new(
            &self.bodies,
            &condensed,
            &geometry,
            &Acting::default(),
            found,
        );
        let given = exchange(
            &self.bodies,
            &self.pairs,
            surface,
            problem,
            &outcome.reaction,
        );
        let axes = self.up() + 1;
        let of_nodes = |u: &Vec<f64>| {
            let nodes = u.chunks_exact(axes);
            let node = |part: &[f64]| [0, 1, 2].map(|k| part.get(k).copied().unwrap_or(0.0));
            nodes.map(node).collect()
        };
        let measured = measured.unwrap();
        let faults = measured.fits.iter().filter_map(|fit| fit.fault());
        Answer {
            status: measured.status(&outcome).0,
            fault: format!("{:?} {:?}", faults.collect::<Vec<_>>(), outcome.shortfall),
            displacements: displacements.iter().map(of_nodes).collect(),
            carriers: surface.couplings.iter().map(|pair| pair.body).collect(),
            forces: given.unwrap().iter().map(|pair| pair.own.force).collect(),
        }
    }

    /// Moves every node, and turns what has a direction.
    fn moved(
        &self,
        place: impl Fn([f64; 3]) -> [f64; 3],
        turn: impl Fn([f64; 3]) -> [f64; 3],
    ) -> Self {
        let mut moved = self.clone();
        for body in &mut moved.bodies {
            body.mesh.nodes.iter_mut().for_each(|x| *x = place(*x));
            for support in &mut body.supports {
                let given = support.displacement.map(|u| u.unwrap_or(0.0));
                let turned = turn(given);
                for (u, turned) in support.displacement.iter_mut().zip(turned) {
                    *u = u.map(|_| turned);
                }
            }
            for load in &mut body.loads {
                if let Load::BodyForce { density, .. } = load {
                    *density = turn(*density);
                }
            }
        }
        moved
    }
}

impl fmt::Display for Assembly {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kinds = self.bodies.iter().map(|body| body.mesh.cell(0).kind);
        let stiff = self
            .bodies
            .iter()
            .map(|body| body.materials[0].young as usize);
        let frictions = self
            .pairs
            .iter()
            .map(|pair| (100.0 * pair.friction).round() / 100.0);
        write!(
            f,
            "{:?} {:?} E {:?} μ {:?} touching {}",
            self.bodies[0].model,
            kinds.collect::<Vec<_>>(),
            stiff.collect::<Vec<_>>(),
            frictions.collect::<Vec<_>>(),
            self.proportional
        )
    }
}

/// A block between two heights with cells and sides by chance.
fn block(random: &mut Random, model: Model, height: [f64; 2]) -> Mesh {
    let at = if model == Model::Axisymmetric {
        1.0
    } else {
        0.0
    };
    let from = at + random.between(-0.15, 0.15);
    let to = at + 1.0 + random.between(-0.15, 0.15);
    let lines = |random: &mut Random, [from, to]: [f64; 2], most: usize| -> Vec<f64> {
        let count = 2 + random.below(most - 1);
        (0..=count)
            .map(|k| from + (to - from) * k as f64 / count as f64)
            .collect()
    };
    if model == Model::Solid {
        let kinds = [
            CellKind::Tet4,
            CellKind::Hex8,
            CellKind::Hex8,
            CellKind::Hex20,
        ];
        let kind = random.one_of(&kinds);
        let xs = lines(random, [from, to], 3);
        let ys = lines(random, [0.0, 0.7], 2);
        let zs = lines(random, height, 2);
        return box_mesh(&xs, &ys, &zs, kind).unwrap();
    }
    let kinds = [
        CellKind::Tri3,
        CellKind::Quad4,
        CellKind::Tri6,
        CellKind::Quad8,
    ];
    let kind = random.one_of(&kinds);
    let xs = lines(random, [from, to], 8);
    let ys = lines(random, height, 3);
    rectangle(&xs, &ys, kind).unwrap()
}

/// Makes the lower side round, about its middle, and leaves the upper one flat.
fn bend(mesh: &mut Mesh, [low, high]: [f64; 2], radius: f64) {
    let up = mesh.dimension - 1;
    let xs = mesh.nodes.iter().map(|x| x[0]);
    let [from, to] = xs.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    });
    let middle = 0.5 * (from + to);
    for x in &mut mesh.nodes {
        let share = (high - x[up]) / (high - low);
        x[up] += share * (x[0] - middle).powi(2) / (2.0 * radius);
    }
}

fn pair(bodies: &[Body], level: usize, random: &mut Random) -> ContactPair {
    // What lies on a smooth body, and is not held, may lie anywhere along it.
    let held = level + 1 == bodies.len();
    let friction = if held && random.next() < 0.3 {
        0.0
    } else {
        random.between(0.05, 1.0)
    };
    ContactPair {
        place: format!("contacts[{}]", level - 1),
        body: level,
        facets: facets(&bodies[level].mesh, "bottom"),
        opposite: Opposite::Surface {
            body: level - 1,
            facets: facets(&bodies[level - 1].mesh, "top"),
        },
        friction,
        rounded: true,
        gap: 0.0,
        dragged: false,
    }
}

fn facets(mesh: &Mesh, group: &str) -> Vec<Facet> {
    match &mesh.groups[group] {
        Group::Facets(facets) => facets.clone(),
        other => unreachable!("{other:?}"),
    }
}

fn skin(mesh: &Mesh) -> Vec<Facet> {
    let groups = mesh.groups.values();
    let facets = groups.filter_map(|group| match group {
        Group::Facets(facets) => Some(facets.clone()),
        _ => None,
    });
    facets.flatten().collect()
}

fn nodes(mesh: &Mesh, group: &str) -> Vec<usize> {
    let mut nodes: Vec<usize> = facets(mesh, group)
        .into_iter()
        .flat_map(|f| f.nodes)
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// A change, and what it makes of the answer: bodies and nodes keep their numbers unless a map says otherwise.
struct Changed {
    assembly: Assembly,
    /// Largest difference of a displacement, relative to the largest.
    bound: f64,
    expected: Box<dyn Fn([f64; 3]) -> [f64; 3]>,
    /// New body, and new node per old one.
    bodies: Vec<(usize, Vec<usize>)>,
    /// Sides are exchanged: forces point the other way.
    exchanged: bool,
    /// Forces stay as they are.
    same_forces: bool,
}

/// Largest relative difference where equal sides are exchanged, so that the other one carries the contacts: what
/// meshes of two cells on a side resolve.
const OF_MESH: f64 = 0.3;

const NAMES: [&str; 9] = [
    "sides exchanged",
    "far away",
    "turned",
    "in other units",
    "bodies in another order",
    "nodes and cells in another order",
    "loads in two parts",
    "whole skins",
    "more load",
];

fn change(of: &Assembly, number: usize, random: &mut Random) -> Option<Changed> {
    let same: Vec<(usize, Vec<usize>)> = (of.bodies.iter().enumerate())
        .map(|(index, body)| (index, (0..body.mesh.nodes.len()).collect()))
        .collect();
    let plain = |assembly: Assembly| Changed {
        assembly,
        bound: 1e-8,
        expected: Box::new(|u| u),
        bodies: same.clone(),
        exchanged: false,
        same_forces: true,
    };
    let up = of.up();
    Some(match NAMES[number] {
        "sides exchanged" => {
            let mut other = of.clone();
            other.pairs.iter_mut().for_each(exchange_sides);
            Changed {
                exchanged: true,
                ..plain(other)
            }
        }
        "far away" => {
            let axisymmetric = of.bodies[0].model == Model::Axisymmetric;
            let mut by = [0.0; 3];
            for (axis, by) in by.iter_mut().enumerate().take(up + 1) {
                *by = match axisymmetric && axis == 0 {
                    true => 0.0,
                    false => random.between(-1000.0, 1000.0),
                };
            }
            Changed {
                bound: 1e-6,
                ..plain(of.moved(move |x| [0, 1, 2].map(|k| x[k] + by[k]), |u| u))
            }
        }
        "turned" if of.bodies[0].model != Model::Axisymmetric => {
            let (angle, tilt) = (random.between(0.0, 6.0), random.between(0.0, 3.0));
            let turn = move |x: [f64; 3]| {
                let x = about(x, [0, 1], angle);
                if up == 2 { about(x, [1, 2], tilt) } else { x }
            };
            Changed {
                expected: Box::new(turn),
                same_forces: false,
                ..plain(of.moved(turn, turn))
            }
        }
        "in other units" => {
            let (length, force) = (1000.0, 7e-4);
            let long = move |x: [f64; 3]| x.map(|x| x * length);
            let mut other = of.moved(long, long);
            for body in &mut other.bodies {
                body.materials[0].young *= force / (length * length);
                if let Model::PlaneStress { thickness } = &mut body.model {
                    *thickness *= length;
                }
                for load in &mut body.loads {
                    if let Load::BodyForce { density, .. } = load {
                        *density = density.map(|d| d / length * force / length.powi(3));
                    }
                }
            }
            Changed {
                expected: Box::new(long),
                same_forces: false,
                ..plain(other)
            }
        }
        "bodies in another order" => {
            let mut other = of.clone();
            let last = of.bodies.len() - 1;
            other.bodies.reverse();
            for pair in &mut other.pairs {
                pair.body = last - pair.body;
                if let Opposite::Surface { body, .. } = &mut pair.opposite {
                    *body = last - *body;
                }
            }
            let mut changed = plain(other);
            changed
                .bodies
                .iter_mut()
                .for_each(|(body, _)| *body = last - *body);
            changed
        }
        "nodes and cells in another order" => {
            let (mut other, mut maps) = (of.clone(), Vec::new());
            for (index, body) in other.bodies.iter_mut().enumerate() {
                let order = random.shuffled(body.mesh.nodes.len());
                renumber(body, &order, random);
                maps.push((index, order));
            }
            for pair in &mut other.pairs {
                let renumber = |facets: &mut Vec<Facet>, order: &[usize]| {
                    let nodes = facets.iter_mut().flat_map(|facet| &mut facet.nodes);
                    nodes.for_each(|node| *node = order[*node]);
                };
                renumber(&mut pair.facets, &maps[pair.body].1);
                if let Opposite::Surface { body, facets } = &mut pair.opposite {
                    renumber(facets, &maps[*body].1);
                }
            }
            Changed {
                bodies: maps,
                ..plain(other)
            }
        }
        "loads in two parts" => {
            let mut other = of.clone();
            for body in &mut other.bodies {
                let Load::BodyForce { cells, density } = &body.loads[0] else {
                    continue;
                };
                let density = *density;
                let (one, rest) = cells.split_at(cells.len() / 2);
                body.loads = [one, rest]
                    .map(|cells| Load::BodyForce {
                        cells: cells.to_vec(),
                        density,
                    })
                    .into();
            }
            plain(other)
        }
        "whole skins" => {
            let mut other = of.clone();
            for pair in &mut other.pairs {
                pair.facets = skin(&of.bodies[pair.body].mesh);
                if let Opposite::Surface { body, facets } = &mut pair.opposite {
                    *facets = skin(&of.bodies[*body].mesh);
                }
            }
            plain(other)
        }
        "more load" if of.proportional => {
            let mut other = of.clone();
            for body in &mut other.bodies {
                let given = body.supports.iter_mut().flat_map(|s| &mut s.displacement);
                given.flatten().for_each(|u| *u *= 0.25);
                for load in &mut body.loads {
                    if let Load::BodyForce { density, .. } = load {
                        *density = density.map(|d| 0.25 * d);
                    }
                }
            }
            Changed {
                expected: Box::new(|u| u.map(|u| 0.25 * u)),
                same_forces: false,
                ..plain(other)
            }
        }
        _ => return None,
    })
}

fn about(x: [f64; 3], [first, second]: [usize; 2], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    let mut turned = x;
    turned[first] = cos * x[first] - sin * x[second];
    turned[second] = sin * x[first] + cos * x[second];
    turned
}

fn exchange_sides(pair: &mut ContactPair) {
    if let Opposite::Surface { body, facets } = &mut pair.opposite {
        std::mem::swap(body, &mut pair.body);
        std::mem::swap(facets, &mut pair.facets);
    }
}

/// Gives every node a new number, and puts the cells in another order.
fn renumber(body: &mut Body, order: &[usize], random: &mut Random) {
    let old = &body.mesh;
    let mut nodes = old.nodes.clone();
    for (x, &new) in old.nodes.iter().zip(order) {
        nodes[new] = *x;
    }
    let mut mesh = Mesh::new(old.dimension, nodes);
    for cell in random.shuffled(old.cell_count()) {
        let cell = old.cell(cell);
        let nodes: Vec<usize> = cell.nodes.iter().map(|&node| order[node]).collect();
        mesh.push_cell(cell.kind, &nodes);
    }
    body.mesh = mesh;
    for support in &mut body.supports {
        support
            .nodes
            .iter_mut()
            .for_each(|node| *node = order[*node]);
    }
}

fn size(vector: [f64; 3]) -> f64 {
    vector.iter().fold(0.0, |sum: f64, x| sum.hypot(*x))
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    size([0, 1, 2].map(|k| a[k] - b[k]))
}

/// Largest difference from what was expected, relative to the largest displacement.
fn difference(before: &Answer, after: &Answer, changed: &Changed) -> f64 {
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (old, (new, order)) in before.displacements.iter().zip(&changed.bodies) {
        for (u, &node) in old.iter().zip(order) {
            let expected = (changed.expected)(*u);
            largest = largest.max(size(expected));
            worst = worst.max(apart(expected, after.displacements[*new][node]));
        }
    }
    worst / largest
}

/// Largest difference of the force on a pair's first side that has the same nodes, relative to the largest force; of
/// changes that leave forces as they are.
fn force_difference(before: &Answer, after: &Answer, changed: &Changed) -> f64 {
    let sign = if changed.exchanged { -1.0 } else { 1.0 };
    let forces = before.forces.iter().zip(&after.forces);
    let largest = before.forces.iter().map(|f| size(*f)).fold(0.0, f64::max);
    let apart = forces.map(|(f, g)| apart(f.map(|f| sign * f), *g));
    apart.fold(0.0, f64::max) / largest
}

/// Tries changes of random assemblies; what goes wrong, in words.
fn battery(seed: u64, assemblies: usize) -> (usize, Vec<String>) {
    let (mut tried, mut wrong) = (0, Vec::new());
    for number in 0..assemblies {
        let mut random = Random(
            seed.wrapping_add(number as u64)
                .wrapping_mul(0x9E37_79B9_7F4A_7C15)
                | 1,
        );
        let assembly = Assembly::random(&mut random);
        let before = assembly.solve();
        if before.status != Status::Certified {
            let (status, fault) = (before.status, &before.fault);
            wrong.push(format!("{number} {assembly}: {status:?} {fault}"));
            continue;
        }
        for (kind, name) in NAMES.iter().enumerate() {
            let Some(changed) = change(&assembly, kind, &mut random) else {
                continue;
            };
            tried += 1;
            let after = changed.assembly.solve();
            let mut difference = difference(&before, &after, &changed);
            if changed.same_forces {
                difference = difference.max(force_difference(&before, &after, &changed));
            }
            let bound = match changed.exchanged && before.carriers != after.carriers {
                true => OF_MESH,
                false => changed.bound,
            };
            if after.status != Status::Certified || difference > bound {
                let (status, fault) = (after.status, &after.fault);
                wrong.push(format!(
                    "{number} {assembly}, {name}: {status:?} {difference:e} {fault}"
                ));
            }
        }
    }
    (tried, wrong)
}

#[test]
fn what_must_not_change_an_answer_does_not() {
    let (tried, wrong) = battery(1, 260);
    assert!(tried >= 2000, "{tried}");
    assert!(wrong.is_empty(), "{} of {tried}: {wrong:#?}", wrong.len());
}
