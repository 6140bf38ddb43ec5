//! Two blocks on each other carry a uniform pressure exactly, whatever their meshes, cells and
//! stiffness, and whichever side the contact names first.

use std::collections::HashSet;

use dpana::body::{CellKind, Group, Mesh, graded, mixed_box};
use dpana::report::Report;
use dpana::{Scene, Solution};
use serde_json::json;

use crate::stacks::{block, body, certified, contact, hold, scene};

/// Pressure between the blocks, in pascal.
const PRESSURE: f64 = 1.0;

/// Elastic constants of a block, and how it gives way to the pressure.
#[derive(Clone, Copy, Debug)]
struct Material {
    young: f64,
    poisson: f64,
}

impl Material {
    /// Shortening and widening per pressure: plane strain (1 − ν²)/E and ν(1 + ν)/E, else 1/E
    /// and ν/E.
    fn strains(self, dimension: usize) -> [f64; 2] {
        let Self { young, poisson } = self;
        match dimension {
            2 => [
                (1.0 - poisson * poisson) / young,
                poisson * (1.0 + poisson) / young,
            ],
            _ => [1.0 / young, poisson / young],
        }
    }

    /// A material `softer` times as soft that widens alike.
    fn softer(self, softer: f64, dimension: usize) -> Self {
        let young = self.young / softer;
        let widening = self.strains(dimension)[1] * young;
        let poisson = match dimension {
            // ν (1 + ν) = w, in the form without cancellation.
            2 => 2.0 * widening / (1.0 + (1.0 + 4.0 * widening).sqrt()),
            _ => widening,
        };
        Self { young, poisson }
    }
}

/// Lower and upper block, of unit size.
#[derive(Clone, Copy, Debug)]
struct Stack {
    kinds: [CellKind; 2],
    cells: [usize; 2],
    materials: [Material; 2],
    friction: f64,
    /// The upper block carries the contacts.
    upper_first: bool,
}

const LATERAL: [&str; 2] = ["left", "front"];

impl Stack {
    fn dimension(&self) -> usize {
        self.kinds[0].dimension()
    }

    /// Shortening and widening of lower and upper block, and by how much both shorten.
    fn give(&self) -> ([[f64; 2]; 2], f64) {
        let strains = self.materials.map(|m| m.strains(self.dimension()));
        (strains, PRESSURE * (strains[0][0] + strains[1][0]))
    }

    fn scene(&self) -> Scene {
        let up = self.dimension() - 1;
        let (_, closing) = self.give();
        // The stiffer block rests: moved along by the other's shortening, its own would be lost in
        // the last digits of that.
        let lifted = self.materials[1].young > self.materials[0].young;
        let ends = if lifted {
            [closing, 0.0]
        } else {
            [0.0, -closing]
        };
        let mut bodies = Vec::new();
        for (at, name) in ["lower", "upper"].into_iter().enumerate() {
            let (mut low, mut high) = ([0.0; 3], [1.0; 3]);
            (low[up], high[up]) = (at as f64, at as f64 + 1.0);
            let mesh = block(self.kinds[at], low, high, [self.cells[at]; 3]);
            let Material { young, poisson } = self.materials[at];
            let mut body = body(name, mesh, young, poisson);
            for (axis, side) in LATERAL.into_iter().enumerate().take(up) {
                body = hold(body, side, axis, 0.0);
            }
            bodies.push(hold(body, ["bottom", "top"][at], up, ends[at]));
        }
        let (lower, upper) = (["lower", "top"], ["upper", "bottom"]);
        let pair = if self.upper_first {
            contact(upper, lower, self.friction)
        } else {
            contact(lower, upper, self.friction)
        };
        scene(bodies, vec![pair])
    }

    /// The patch is exact to `digit`, relative to the pressure and to the largest displacement: ε times
    /// the condition of K, up to 1e5 on these meshes, or the ratio of the stiffnesses if that is more.
    fn check(&self, digit: f64) {
        self.check_on(&self.scene(), digit);
    }

    fn check_on(&self, scene: &Scene, digit: f64) {
        let (solution, report) = certified(scene);
        check_pressure(&report, digit);
        let (strains, closing) = self.give();
        let lifted = self.materials[1].young > self.materials[0].young;
        let lift = if lifted { closing } else { 0.0 };
        for at in 0..2 {
            let patch = |position: [f64; 3]| {
                let mut u = patch(position, self.dimension(), strains, at);
                u[self.dimension() - 1] += lift;
                u
            };
            let off = worst_displacement(&solution, at, |_, position| patch(position));
            assert!(off < digit * closing, "{off:e} of {closing:e} {self:?}");
        }
    }
}

/// Displacement at a position of the lower (0) or the upper (1) block of unit height.
fn patch(position: [f64; 3], dimension: usize, strains: [[f64; 2]; 2], block: usize) -> [f64; 3] {
    let up = dimension - 1;
    let mut u = position.map(|x| PRESSURE * strains[block][1] * x);
    let (low, high) = (position[up].min(1.0), (position[up] - 1.0).max(0.0));
    u[up] = -PRESSURE * (strains[0][0] * low + strains[1][0] * high);
    u
}

fn check_pressure(report: &Report, digit: f64) {
    for contact in &report.contacts {
        let off = (contact.pressure.unwrap() / PRESSURE - 1.0).abs();
        assert!(off < digit, "{off:e} {contact:?}");
        for q in contact.friction_traction.as_ref().unwrap() {
            assert!(q.abs() < digit * PRESSURE, "{contact:?}");
        }
    }
    let area: f64 = report.contacts.iter().map(|c| c.area).sum();
    assert!((area - 1.0).abs() < 1e-13, "{area}");
    assert_eq!(report.totals.open, 0);
}

/// Largest error of a component of a body's displacement, in metre.
fn worst_displacement(
    solution: &Solution,
    body: usize,
    expected: impl Fn(usize, [f64; 3]) -> [f64; 3],
) -> f64 {
    let mesh = &solution.bodies()[body].mesh;
    let nodal = solution.displacements()[body].chunks(mesh.dimension);
    let errors = mesh.nodes.iter().zip(nodal).enumerate();
    let errors = errors.flat_map(|(node, (position, found))| {
        let expected = expected(node, *position);
        found
            .iter()
            .zip(expected)
            .map(|(u, expected)| (u - expected).abs())
    });
    errors.fold(0.0, f64::max)
}

const STEEL: Material = Material {
    young: 1000.0,
    poisson: 0.3,
};

const PAIRS: [[CellKind; 2]; 6] = [
    [CellKind::Quad4, CellKind::Quad4],
    [CellKind::Tri3, CellKind::Tri3],
    [CellKind::Tri3, CellKind::Quad4],
    [CellKind::Hex8, CellKind::Hex8],
    [CellKind::Tet4, CellKind::Tet4],
    [CellKind::Hex8, CellKind::Tet4],
];

#[test]
fn quadratic_blocks_carry_the_pressure_evenly_on_each_other_and_on_linear_ones() {
    for kinds in [
        [CellKind::Quad9, CellKind::Quad9],
        [CellKind::Quad8, CellKind::Quad4],
        [CellKind::Tri6, CellKind::Quad9],
        [CellKind::Tri3, CellKind::Tri6],
        [CellKind::Hex27, CellKind::Hex8],
        [CellKind::Hex20, CellKind::Tet10],
        [CellKind::Tet4, CellKind::Tet10],
    ] {
        let solid = kinds[0].dimension() == 3;
        for (friction, upper_first) in [(0.0, true), (0.3, false), (0.3, true)] {
            Stack {
                kinds,
                cells: if solid { [3, 2] } else { [5, 7] },
                materials: [STEEL; 2],
                friction,
                upper_first,
            }
            .check(1e-11);
        }
    }
}

/// Kinds of a block's upright columns, in turn.
const FILLINGS: [&[CellKind]; 11] = [
    &[CellKind::Prism6],
    &[CellKind::Pyramid5],
    &[CellKind::Prism15],
    &[CellKind::Pyramid13],
    &[CellKind::Hex8, CellKind::Pyramid5, CellKind::Prism6],
    &[CellKind::Hex20, CellKind::Pyramid13, CellKind::Prism15],
    &[CellKind::Hex8],
    &[CellKind::Tet4],
    &[CellKind::Hex20],
    &[CellKind::Hex27],
    &[CellKind::Tet10],
];

#[test]
fn prisms_pyramids_and_mixed_blocks_carry_the_pressure_evenly_on_each_other_and_on_all_others() {
    for (at, lower) in FILLINGS.into_iter().enumerate().take(6) {
        for upper in &FILLINGS[at..] {
            let stack = Stack {
                kinds: [CellKind::Hex8; 2],
                cells: [2, 3],
                materials: [STEEL; 2],
                friction: 0.3,
                upper_first: at % 2 == 0,
            };
            let mut scene = stack.scene();
            for (at, filling) in [lower, *upper].into_iter().enumerate() {
                let (low, high) = (at as f64, at as f64 + 1.0);
                let count = stack.cells[at];
                let line = |low, high, grading| graded(low, high, count, grading).unwrap();
                let mesh = mixed_box(
                    &line(0.0, 1.0, 1.7),
                    &line(0.0, 1.0, 0.8),
                    &line(low, high, 0.6),
                    |[i, j, _]| filling[(i + j) % filling.len()],
                );
                scene.bodies[at].mesh = mesh.unwrap().into();
            }
            stack.check_on(&scene, 1e-10);
        }
    }
}

#[test]
fn blocks_of_one_material_carry_the_pressure_evenly() {
    for kinds in PAIRS {
        let solid = kinds[0].dimension() == 3;
        let mut counts = vec![if solid { [3, 4] } else { [5, 7] }, [4, 4], [1, 3]];
        if kinds[0] == kinds[1] {
            counts.push(if solid { [9, 12] } else { [25, 35] });
        }
        for cells in counts {
            for friction in [0.0, 0.3] {
                for upper_first in [true, false] {
                    Stack {
                        kinds,
                        cells,
                        materials: [STEEL; 2],
                        friction,
                        upper_first,
                    }
                    .check(1e-10);
                }
            }
        }
    }
}

/// The stacks of two materials, one of them `ratio` times as stiff, either side named first.
fn unequal(ratio: f64) -> impl Iterator<Item = Stack> {
    PAIRS.into_iter().flat_map(move |kinds| {
        let solid = kinds[0].dimension() == 3;
        let choices = [[0, 0], [0, 1], [1, 0], [1, 1]].into_iter();
        choices.map(move |[soft, first]| {
            let mut stack = Stack {
                kinds,
                cells: if solid { [3, 4] } else { [5, 7] },
                materials: [STEEL; 2],
                friction: 0.0,
                upper_first: first == 1,
            };
            stack.materials[soft].young = STEEL.young / ratio;
            stack
        })
    })
}

#[test]
fn a_block_on_one_a_million_times_as_stiff_carries_the_pressure_evenly() {
    for mut stack in unequal(1e6) {
        stack.check(1e-10);
        let soft = usize::from(stack.materials[1].young < STEEL.young);
        stack.materials[soft] = STEEL.softer(1e6, stack.dimension());
        stack.friction = 0.3;
        stack.check(1e-10);
    }
}

#[test]
fn a_block_on_one_a_billion_times_as_stiff_keeps_eight_digits() {
    unequal(1e9).for_each(|stack| stack.check(1e-8));
}

#[test]
fn two_unconnected_parts_of_one_body_carry_the_pressure_evenly() {
    // Both blocks in one mesh: as the two faces of a crack through it.
    for file in ["D_patch2d_7_5.msh", "D_patch3d_4_3.msh"] {
        for (own, other) in [("contact", "master"), ("master", "contact")] {
            for friction in [0.0, 0.3] {
                let (solution, report) = certified(&shipped(file, own, other, friction));
                check_pressure(&report, 1e-10);
                let mesh = &solution.bodies()[0].mesh;
                let upper = nodes(mesh, "body0");
                let strains = [STEEL.strains(mesh.dimension); 2];
                let off = worst_displacement(&solution, 0, |node, mut position| {
                    // The blocks meet at height 0.
                    position[mesh.dimension - 1] += 1.0;
                    let block = usize::from(upper.contains(&node));
                    patch(position, mesh.dimension, strains, block)
                });
                assert!(off < 1e-10 * 2.0 * strains[0][0], "{off:e} {file}");
            }
        }
    }
}

/// The shipped patch, its top moved down as far as the pressure moves it.
fn shipped(file: &str, own: &str, other: &str, friction: f64) -> Scene {
    let solid = file.contains("3d");
    let lowered = -2.0 * PRESSURE * STEEL.strains(if solid { 3 } else { 2 })[0];
    let mut supports = Vec::new();
    let mut give = |group: &str, axis: usize, value: f64| {
        let mut displacement = vec![json!(null); if solid { 3 } else { 2 }];
        displacement[axis] = json!(value);
        supports.push(json!({"group": group, "displacement": displacement}));
    };
    let up = if solid { 2 } else { 1 };
    give("base", up, 0.0);
    give("top", up, lowered);
    give("u_left", 0, 0.0);
    give("l_left", 0, 0.0);
    if solid {
        give("u_front", 1, 0.0);
        give("l_front", 1, 0.0);
    }
    let scene = json!({
        "bodies": [{
            "mesh": {"file": format!("data/meshes/{file}")},
            "model": if solid { "solid" } else { "plane_strain" },
            "materials": [{"young": STEEL.young, "poisson": STEEL.poisson}],
            "supports": supports
        }],
        "contacts": [{"group": own, "against": {"group": other}, "friction": friction}]
    });
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scene.json");
    Scene::from_json(&scene.to_string(), source).unwrap()
}

/// Nodes of a group of cells.
fn nodes(mesh: &Mesh, group: &str) -> HashSet<usize> {
    let Group::Cells(cells) = &mesh.groups[group] else {
        unreachable!("{group}");
    };
    let cells = cells.iter();
    cells
        .flat_map(|cell| mesh.cell(*cell).nodes.to_vec())
        .collect()
}
