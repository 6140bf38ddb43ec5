//! Random stacks of blocks that nothing but contact holds: each is certified and carries what statics
//! demands at every interface, or the judge has found the motion that nothing stops, or the loads come
//! within a twentieth of what rigid blocks could hold.

use dpana::report::Beyond;
use dpana::{Scene, Solution, Status, rigid_limit, solve};
use proptest::prelude::*;
use serde_json::{Value, json};

/// One block: offset, extent along x (and y), height, cells, cell kind, stiffness, weight per volume, friction below.
#[derive(Clone, Debug)]
struct Block {
    offset: f64,
    extent: [f64; 2],
    height: f64,
    cells: [usize; 3],
    simplex: bool,
    young: f64,
    poisson: f64,
    density: f64,
    friction: f64,
}

#[derive(Clone, Debug)]
struct Stack {
    dimension: usize,
    blocks: Vec<Block>,
    /// Pull on the top block, relative to what friction holds below it.
    pull: f64,
}

fn block() -> impl Strategy<Value = Block> {
    let shape = (
        -0.1..0.1,
        [0.6..1.2, 0.6..1.2],
        0.3..1.5,
        [2..6_usize, 2..5, 2..5],
    );
    let material = (any::<bool>(), 3.0..6.0, 0.0..0.45, 0.5..2.0, 0.05..1.5);
    (shape, material).prop_map(|(shape, material)| {
        let (offset, extent, height, cells) = shape;
        let (simplex, exponent, poisson, density, friction) = material;
        Block {
            offset,
            extent,
            height,
            cells,
            simplex,
            young: f64::powf(10.0, exponent),
            poisson,
            density,
            friction,
        }
    })
}

fn stack() -> impl Strategy<Value = Stack> {
    (2..4_usize, prop::collection::vec(block(), 1..5), 0.0..1.3).prop_map(
        |(dimension, blocks, pull)| Stack {
            dimension,
            blocks,
            pull,
        },
    )
}

impl Stack {
    fn weight(&self, block: &Block) -> f64 {
        let depth = if self.dimension == 2 {
            1.0
        } else {
            block.extent[1]
        };
        block.density * block.extent[0] * depth * block.height
    }

    fn force(&self) -> f64 {
        let top = &self.blocks[self.blocks.len() - 1];
        self.pull * top.friction * self.weight(top)
    }

    fn scene(&self) -> Scene {
        let (mut bodies, mut contacts, mut low) = (Vec::new(), Vec::new(), 0.0);
        for (k, block) in self.blocks.iter().enumerate() {
            let high = low + block.height;
            bodies.push(self.body(k, block, [low, high]));
            contacts.push(self.contact(k, block));
            low = high;
        }
        let scene = json!({ "bodies": bodies, "contacts": contacts });
        Scene::from_json(&scene.to_string(), "stack.json").unwrap()
    }

    fn body(&self, k: usize, block: &Block, height: [f64; 2]) -> Value {
        let x = [block.offset, block.offset + block.extent[0]];
        let [a, b, c] = block.cells;
        let (mesh, model, down, area) = if self.dimension == 2 {
            let cell = if block.simplex { "tri3" } else { "quad4" };
            let mesh =
                json!({ "rectangle": { "x": x, "y": height, "cells": [a, c], "cell": cell } });
            (
                mesh,
                "plane_strain",
                json!([0, -block.density]),
                block.extent[0],
            )
        } else {
            let cell = if block.simplex { "tet4" } else { "hex8" };
            let y = [0.0, block.extent[1]];
            let mesh =
                json!({ "box": { "x": x, "y": y, "z": height, "cells": [a, b, c], "cell": cell } });
            let area = block.extent[0] * block.extent[1];
            (mesh, "solid", json!([0, 0, -block.density]), area)
        };
        let mut loads = vec![json!({ "body_force": down })];
        if k + 1 == self.blocks.len() {
            let mut traction = vec![0.0; self.dimension];
            traction[0] = self.force() / area;
            // At the foot: it shall slide before it tips.
            loads.push(json!({ "group": "bottom", "traction": traction }));
        }
        json!({ "name": format!("block {k}"), "mesh": mesh, "model": model, "loads": loads,
                "materials": [{ "young": block.young, "poisson": block.poisson }] })
    }

    fn contact(&self, k: usize, block: &Block) -> Value {
        let mut contact =
            json!({ "body": format!("block {k}"), "group": "bottom", "friction": block.friction });
        if k == 0 {
            let mut normal = vec![0.0; self.dimension];
            normal[self.dimension - 1] = 1.0;
            contact["obstacle"] =
                json!({ "plane": { "point": vec![0.0; self.dimension], "normal": normal } });
        } else {
            contact["against"] = json!({ "body": format!("block {}", k - 1), "group": "top" });
        }
        contact
    }

    /// Normal and friction resultants of every interface.
    fn check_statics(&self, solution: &Solution) {
        let report = solution.report().unwrap();
        let mut above = self
            .blocks
            .iter()
            .map(|block| self.weight(block))
            .sum::<f64>();
        // Equilibrium is certified to 1e-12 of the load; the topmost block may weigh a 300th of the stack.
        for (block, pair) in self.blocks.iter().zip(&report.totals.pairs) {
            assert!((pair.totals.normal - above).abs() <= 1e-9 * above);
            assert!((pair.totals.friction[0] + self.force()).abs() <= 1e-9 * above);
            above -= self.weight(block);
        }
    }
}

/// Multiple of the pull that rigid blocks hold.
fn pull_limit(scene: &Scene) -> f64 {
    let limits = rigid_limit(scene).unwrap();
    match limits.loads.last().map(|load| &load.beyond) {
        Some(Beyond::Grows { factor, .. }) => *factor,
        other => unreachable!("{other:?}"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn a_stack_is_certified_or_provably_moves(stack in stack()) {
        let solution = solve(&stack.scene()).unwrap();
        let certificate = &solution.outcome().verdict.certificate;
        match solution.status() {
            Status::Certified => {
                prop_assert!(certificate.residual() <= 1e-12);
                // A stiff block that sinks with soft ones: K u is a difference of numbers 1e3 times as large and more.
                for balance in solution.balances() {
                    prop_assert!(balance.equilibrium.scaled < 1e-9, "{balance:?}");
                }
                stack.check_statics(&solution);
            }
            // Elastic bodies press unevenly: they slide a little before rigid ones, which press as it suits them.
            Status::NoEquilibrium if solution.outcome().failure.as_ref().unwrap().elastic => {
                prop_assert!(pull_limit(&stack.scene()) < 1.05);
            }
            Status::NoEquilibrium => {
                let failure = solution.outcome().failure.as_ref().unwrap();
                prop_assert!(failure.proof.work > 0.0);
                // To stop this motion the contacts would have to press hundreds of times the weight.
                let weight: f64 = stack.blocks.iter().map(|block| stack.weight(block)).sum();
                prop_assert!(failure.proof.least_reaction >= 100.0 * weight, "{failure:?}");
                prop_assert!(failure.missing > 0.0);
            }
            Status::NotConverged => prop_assert!(pull_limit(&stack.scene()) < 1.05),
            Status::CouplingFault => prop_assert!(false, "{:?}", solution.fits()),
        }
    }
}
