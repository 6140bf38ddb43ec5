//! Sectors that repeat around an axis: `*TIE, CYCLIC SYMMETRY` and `*CYCLIC SYMMETRY MODEL`.
//!
//! ```text
//! x_i = R(±2π / N) x_d      every node of the dependent surface on one of the independent surface
//! ```

use super::parts::Parts;
use super::statement::Statement;
use super::transform::{cross, dot, minus, points, unit};
use crate::error::Error;
use crate::mesh_file::abaqus::{Card, Contents};
use crate::scene::{SceneAxis, ScenePeriodic};

/// Distance over the size of the deck within which nodes match, as in scenes.
const MATCHING: f64 = 1e-6;

/// Nodes of one connected part that repeat.
#[derive(Debug)]
pub(super) struct Repeat {
    pub(super) part: usize,
    /// Dependent and independent.
    pub(super) nodes: [Vec<usize>; 2],
    /// In radian, from the former to the latter.
    angle: f64,
    axis: [[f64; 3]; 2],
}

impl Repeat {
    /// The faces in a scene; their groups have these names.
    pub(super) fn periodic(&self, [from, onto]: &[String; 2], dimension: usize) -> ScenePeriodic {
        let [a, b] = self.axis;
        let direction = minus(b, a).to_vec();
        let turned = if dimension == 2 && direction[2] < 0.0 {
            -self.angle
        } else {
            self.angle
        };
        let axis = SceneAxis {
            point: a[..dimension].to_vec(),
            direction: (dimension == 3).then_some(direction),
        };
        ScenePeriodic::turned(from, onto, axis, turned)
    }
}

/// All that repeats in a deck.
pub(super) fn repeats(
    statement: &Statement<'_, '_>,
    contents: &Contents,
    parts: &Parts,
) -> Result<Vec<Repeat>, Error> {
    let model = || statement.model.iter();
    let mut found = Vec::new();
    for &(scope, tie) in model().filter(|(_, card)| card.get("CYCLICSYMMETRY").is_some()) {
        tie.only(&["NAME", "CYCLICSYMMETRY", "POSITIONTOLERANCE"])?;
        let name = tie.need("NAME")?;
        let mut models = model().filter(|(_, card)| card.name == "CYCLICSYMMETRYMODEL");
        let of_tie = models.find(|(_, card)| card.get("TIE").is_none_or(|tie| tie == name));
        let &(_, cyclic) =
            of_tie.ok_or_else(|| tie.error("expected a *CYCLIC SYMMETRY MODEL of this tie"))?;
        let (angle, axis) = sector(cyclic, parts)?;
        let row = tie.row("dependent and independent surface")?;
        let surface = |at: usize| {
            let (_, sides) = contents.surface(tie.head(scope), row.word(at))?;
            let mut nodes: Vec<usize> = sides
                .iter()
                .flat_map(|&side| contents.facet(side))
                .collect();
            nodes.sort_unstable();
            nodes.dedup();
            Ok(nodes)
        };
        let nodes = [surface(0)?, surface(1)?];
        for part in 0..parts.parts.len() {
            let of_part = |nodes: &Vec<usize>| -> Vec<usize> {
                let of = nodes
                    .iter()
                    .filter(|&&node| parts.of_node[node] == Some(part));
                of.copied().collect()
            };
            let nodes = nodes.each_ref().map(of_part);
            if nodes.iter().any(|nodes| !nodes.is_empty()) {
                let angles = [angle, -angle].into_iter();
                let fits = |angle: &f64| matches(contents, &nodes, *angle, axis);
                let angle = angles.clone().find(fits).ok_or_else(|| {
                    tie.error(format!(
                        "surfaces of `{}` that {:.6}° do not turn onto each other node by node; expected \
                         faces that are meshed alike",
                        parts.parts[part].name,
                        angle.to_degrees()
                    ))
                })?;
                found.push(Repeat {
                    part,
                    nodes,
                    angle,
                    axis,
                });
            }
        }
    }
    Ok(found)
}

/// Angle of a sector in radian, and two points of the axis.
fn sector(card: &Card<'_>, parts: &Parts) -> Result<(f64, [[f64; 3]; 2]), Error> {
    card.only(&["N", "TIE", "NGRAPH", "ELSET"])?;
    let count = card.head(0).label(card.need("N")?, "number of sectors")?;
    let row = card.row("two points of the axis")?;
    let axis = points(row)?;
    let [x, y, _] = minus(axis[1], axis[0]);
    match parts.plane() && (x != 0.0 || y != 0.0) {
        true => Err(row.error("an axis in the plane of the elements; expected one along z")),
        false => Ok((std::f64::consts::TAU / count as f64, axis)),
    }
}

/// Whether an angle turns every node of the first list onto one of the second, and there is none besides.
fn matches(
    contents: &Contents,
    [from, onto]: &[Vec<usize>; 2],
    angle: f64,
    [a, b]: [[f64; 3]; 2],
) -> bool {
    let Some(along) = unit(minus(b, a)) else {
        return false;
    };
    let at = |node: &usize| contents.positions[*node];
    let size = from.iter().flat_map(|node| minus(at(node), a));
    let tolerance = MATCHING * size.fold(0.0, |most: f64, x| most.max(x.abs()));
    let (sine, cosine) = angle.sin_cos();
    let turned = |node: &usize| {
        let arm = minus(at(node), a);
        let (part, across) = (dot(arm, along), cross(along, arm));
        [0, 1, 2]
            .map(|k| a[k] + cosine * arm[k] + sine * across[k] + (1.0 - cosine) * part * along[k])
    };
    let near = |image: [f64; 3]| {
        let apart = |node: &usize| {
            minus(at(node), image)
                .iter()
                .fold(0.0_f64, |sum, x| sum.hypot(*x))
        };
        onto.iter().any(|node| apart(node) <= tolerance)
    };
    from.len() == onto.len() && from.iter().map(turned).all(near)
}
