//! Random blocks, one upon the other.

use std::fmt;

use crate::body::{CellKind, Mesh, box_mesh, rectangle};
use crate::closed_forms::Elastic;
use crate::error::Error;
use crate::random::Random;
use crate::scene::{
    Scene, SceneBody, SceneContact, SceneLoad, SceneModel, SceneSupport, SceneSurface,
};
use crate::verify::scenes::body;

/// Two or three blocks: the lowest is clamped, the uppermost is pushed down and aside, and all have weight.
#[derive(Clone)]
pub(super) struct Stack {
    model: SceneModel,
    blocks: Vec<Block>,
    /// Coefficient of friction below each block but the lowest.
    frictions: Vec<f64>,
    /// Displacement of the top: aside, down.
    push: [f64; 2],
    /// Blocks touch before loading, on flat faces: the answer grows in proportion to the load.
    pub(super) proportional: bool,
}

#[derive(Clone)]
struct Block {
    /// Lines of the grid along each axis.
    lines: Vec<Vec<f64>>,
    kind: CellKind,
    /// Radius of its lower side; flat without.
    round: Option<f64>,
    material: Elastic,
    weight: f64,
}

const PLANE_CELLS: [CellKind; 4] = [
    CellKind::Tri3,
    CellKind::Quad4,
    CellKind::Tri6,
    CellKind::Quad8,
];
const SOLID_CELLS: [CellKind; 3] = [CellKind::Hex8, CellKind::Tet4, CellKind::Hex20];

impl Stack {
    pub(super) fn random(random: &mut Random) -> Self {
        let model = match random.below(5) {
            0 => SceneModel::PlaneStress { thickness: 0.3 },
            1 => SceneModel::Axisymmetric,
            2 => SceneModel::Solid,
            _ => SceneModel::PlaneStrain,
        };
        let count = 2 + random.below(2);
        let flat = random.part() < 0.7;
        let proportional = flat && random.part() < 0.5;
        let (mut blocks, mut low) = (Vec::new(), 0.0);
        for level in 0..count {
            let high = low + random.between(0.3, 0.8);
            let mut block = Block::random(random, model, [low, high]);
            // The lower side of the uppermost block is round.
            if !flat && level + 1 == count {
                block.round = Some(random.between(4.0, 40.0));
            }
            blocks.push(block);
            let apart = if proportional {
                0.0
            } else {
                random.between(-1e-3, 1e-3)
            };
            low = high + apart;
        }
        // What lies on a smooth body, and is not held, may lie anywhere along it.
        let smooth = random.part() < 0.3;
        let friction = |level| match smooth && level + 1 == count {
            true => 0.0,
            false => random.between(0.05, 1.0),
        };
        let frictions = (1..count).map(friction).collect();
        let aside = match model {
            SceneModel::Axisymmetric => 0.0,
            _ => random.between(-3e-3, 3e-3),
        };
        Self {
            model,
            blocks,
            frictions,
            push: [aside, -random.between(2e-3, 8e-3)],
            proportional,
        }
    }

    /// The same blocks in other cells, each of the order it has; none with a round side, whose approach is more than
    /// a mesh of a few cells resolves.
    pub(super) fn of_other_cells(&self) -> Option<Self> {
        let mut other = self.clone();
        if self.is_round() {
            return None;
        }
        for block in &mut other.blocks {
            block.kind = match block.kind {
                CellKind::Tri3 => CellKind::Quad4,
                CellKind::Quad4 => CellKind::Tri3,
                CellKind::Tri6 => CellKind::Quad9,
                CellKind::Quad8 => CellKind::Tri6,
                CellKind::Hex8 => CellKind::Tet4,
                CellKind::Tet4 => CellKind::Hex8,
                CellKind::Hex20 => CellKind::Tet10,
                kind => kind,
            };
        }
        Some(other)
    }

    /// Whether a side is round.
    pub(super) fn is_round(&self) -> bool {
        self.blocks.iter().any(|block| block.round.is_some())
    }

    pub(super) fn scene(&self) -> Result<Scene, Error> {
        let bodies: Result<Vec<SceneBody>, Error> = (0..self.blocks.len())
            .map(|level| self.body(level))
            .collect();
        let contacts = (self.frictions.iter().enumerate()).map(|(below, &friction)| SceneContact {
            body: Some(name(below + 1)),
            group: "bottom".into(),
            against: Some(SceneSurface {
                body: Some(name(below)),
                group: "top".into(),
            }),
            friction: Some(friction),
            ..SceneContact::default()
        });
        Ok(Scene {
            contacts: contacts.collect(),
            bodies: bodies?,
            ..Scene::default()
        })
    }

    fn body(&self, level: usize) -> Result<SceneBody, Error> {
        let block = &self.blocks[level];
        let mesh = block.mesh()?;
        let (axes, up) = (mesh.dimension, mesh.dimension - 1);
        let mut body = body(&name(level), mesh, block.material);
        if axes == 2 {
            body.model = Some(self.model);
        }
        let mut clamp = |group: &str, [aside, down]: [f64; 2]| {
            let mut displacement = vec![Some(0.0); axes];
            (displacement[0], displacement[up]) = (Some(aside), Some(down));
            body.supports.push(SceneSupport::Group {
                group: group.into(),
                displacement,
            });
        };
        if level == 0 {
            clamp("bottom", [0.0, 0.0]);
        }
        if level + 1 == self.blocks.len() {
            clamp("top", self.push);
        }
        let mut body_force = vec![0.0; axes];
        body_force[up] = -block.weight;
        body.loads.push(SceneLoad::BodyForce {
            body_force,
            group: None,
        });
        Ok(body)
    }
}

fn name(level: usize) -> String {
    format!("block {level}")
}

impl Block {
    fn random(random: &mut Random, model: SceneModel, height: [f64; 2]) -> Self {
        let at = if model == SceneModel::Axisymmetric {
            1.0
        } else {
            0.0
        };
        let width = [
            at + random.between(-0.15, 0.15),
            at + 1.0 + random.between(-0.15, 0.15),
        ];
        let young = 10_f64.powf(random.between(0.0, 6.0));
        let (extents, kind): (Vec<([f64; 2], usize)>, _) = match model {
            SceneModel::Solid => (
                vec![(width, 3), ([0.0, 0.7], 2), (height, 2)],
                SOLID_CELLS[random.below(3)],
            ),
            _ => (vec![(width, 8), (height, 3)], PLANE_CELLS[random.below(4)]),
        };
        let lines = extents.into_iter().map(|([from, to], most)| {
            let count = 2 + random.below(most - 1);
            let line = |k| from + (to - from) * k as f64 / count as f64;
            (0..=count).map(line).collect()
        });
        Self {
            lines: lines.collect(),
            kind,
            round: None,
            material: Elastic {
                young,
                poisson: random.between(0.0, 0.4),
            },
            weight: 1e-4 * young * random.part(),
        }
    }

    fn mesh(&self) -> Result<Mesh, Error> {
        let mut mesh = match &self.lines[..] {
            [xs, ys, zs] => box_mesh(xs, ys, zs, self.kind)?,
            lines => rectangle(&lines[0], &lines[1], self.kind)?,
        };
        if let Some(radius) = self.round {
            bend(&mut mesh, radius);
        }
        Ok(mesh)
    }
}

/// Makes the lower side round, about its middle, and leaves the upper one flat.
fn bend(mesh: &mut Mesh, radius: f64) {
    let up = mesh.dimension - 1;
    let extent = |axis: usize| {
        let xs = mesh.nodes.iter().map(|x| x[axis]);
        xs.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        })
    };
    let ([from, to], [low, high]) = (extent(0), extent(up));
    for x in &mut mesh.nodes {
        let share = (high - x[up]) / (high - low);
        x[up] += share * (x[0] - 0.5 * (from + to)).powi(2) / (2.0 * radius);
    }
}

impl fmt::Display for Stack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.model)?;
        for block in &self.blocks {
            let round = if block.round.is_some() { " round" } else { "" };
            write!(f, ", {:?}{round} E {:.0}", block.kind, block.material.young)?;
        }
        write!(f, ", mu {:.2?}", self.frictions)
    }
}
