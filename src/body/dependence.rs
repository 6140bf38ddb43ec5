//! What the equations of supports and ties leave independent.
//!
//! ```text
//! (B17)  u = T q + E b        q: the unknowns that are left,  b: right hand sides of (B16)
//! ```
//!
//! Gauss–Jordan elimination, equation by equation; each makes the unknown that it is about depend on the
//! others, or one of these where that is better. The motion of a rigid group never stays independent: the
//! displacements on which it shows best stand for it, found by pivoting over all nodes of the group.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix3, Vector3};
use sprs::CsMat;

use super::tie::{OF_TIE, equations};
use super::{Body, Equation, Source};
use crate::error::Error;

/// Part of the largest coefficient of an equation below which nothing is left of it.
const NOTHING: f64 = 1e-8;

/// Part of the largest coefficient with which the unknown that an equation is about is still taken.
const SERVES: f64 = 0.1;

/// Part of the largest given displacement by which equations that say the same may differ.
const AGREES: f64 = 1e-9;

/// Part of the largest square of a motion below which a direction is held.
const HELD: f64 = 1e-13;

/// Coefficients per column.
type Row = BTreeMap<usize, f64>;

/// `u = T q + E b` (B17) of a body.
#[derive(Clone, Debug)]
pub(crate) struct Dependence {
    equations: Vec<Equation>,
    /// Per column of (B16): what it is; none where it is independent.
    of: Vec<Option<Dependent>>,
    spare: Vec<Spare>,
    unknowns: usize,
    dimension: usize,
}

/// An equation that says nothing new.
#[derive(Clone, Debug)]
struct Spare {
    /// Combination of right hand sides that has to vanish.
    row: Row,
    /// Where it is stated.
    place: String,
    /// What it is about, and what says the same.
    words: String,
}

/// A displacement in terms of others and of the right hand sides.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Dependent {
    /// Independent displacements and their coefficients.
    pub(crate) terms: Vec<(usize, f64)>,
    /// Equations and how their right hand sides count.
    values: Vec<(usize, f64)>,
}

/// The dependence that supports and ties of a body make; none where each supports single displacements only.
///
/// # Errors
///
/// Equations that contradict each other, with the places that state them.
pub(crate) fn dependence(body: &Body) -> Result<Option<Dependence>, Error> {
    if !body.is_tied() {
        return Ok(None);
    }
    let equations = equations(body);
    let mut elimination = Elimination::new(&equations);
    let single = equations.partition_point(|equation| equation.terms.len() == 1);
    (0..single).for_each(|index| elimination.take(index));
    for tie in 0..body.ties.len() {
        elimination.settle(tie, body.unknowns() + OF_TIE * tie);
    }
    (single..equations.len()).for_each(|index| elimination.take(index));
    let found = elimination.close(body);
    found.check(&found.values(|_| 1.0))?;
    Ok(Some(found))
}

/// An elimination under way.
struct Elimination<'a> {
    equations: &'a [Equation],
    /// What a column is: coefficients of others, and of right hand sides.
    of: BTreeMap<usize, [Row; 2]>,
    /// Dependent columns in which a column stands.
    users: BTreeMap<usize, BTreeSet<usize>>,
    taken: BTreeSet<usize>,
    spare: Vec<(usize, Row)>,
}

impl<'a> Elimination<'a> {
    fn new(equations: &'a [Equation]) -> Self {
        Self {
            equations,
            of: BTreeMap::new(),
            users: BTreeMap::new(),
            taken: BTreeSet::new(),
            spare: Vec::new(),
        }
    }

    /// What is left of an equation, `Σ row = Σ values`.
    fn reduced(&self, index: usize) -> [Row; 2] {
        let mut row = Row::new();
        let mut values = Row::from([(index, 1.0)]);
        for &(column, a) in &self.equations[index].terms {
            match self.of.get(&column) {
                None => *row.entry(column).or_insert(0.0) += a,
                Some([terms, given]) => {
                    add(&mut row, a, terms);
                    add(&mut values, -a, given);
                }
            }
        }
        let size = self.equations[index].terms.iter();
        let size = size.fold(0.0_f64, |most, (_, a)| most.max(a.abs()));
        row.retain(|_, a| a.abs() > NOTHING * size);
        [row, values]
    }

    /// Makes one unknown of an equation dependent.
    fn take(&mut self, index: usize) {
        if !self.taken.insert(index) {
            return;
        }
        let [row, values] = self.reduced(index);
        let largest = row.values().fold(0.0_f64, |most, a| most.max(a.abs()));
        let named = self.equations[index].terms.iter().map(|(column, _)| column);
        let serves = |column: &&usize| row.get(column).is_some_and(|a| a.abs() >= SERVES * largest);
        let best = row.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let best = best.map(|(column, _)| column);
        match named.clone().find(serves).or(best).copied() {
            Some(column) => self.solve([row, values], column),
            None => self.spare.push((index, values)),
        }
    }

    /// Takes those equations of a rigid group that tell its motion best.
    fn settle(&mut self, tie: usize, first: usize) {
        let stated = self.equations.iter().enumerate();
        let stated = stated.filter(|(_, equation)| equation.by == Source::Tie(tie));
        let stated: Vec<usize> = stated.map(|(index, _)| index).collect();
        for _ in 0..OF_TIE {
            let mut best: Option<(f64, usize, usize)> = None;
            for &index in stated.iter().filter(|index| !self.taken.contains(index)) {
                for (&column, a) in self.reduced(index)[0].range(first..first + OF_TIE) {
                    if best.is_none_or(|(most, ..)| a.abs() > (1.0 + NOTHING) * most) {
                        best = Some((a.abs(), index, column));
                    }
                }
            }
            let Some((_, index, column)) = best else {
                return;
            };
            self.taken.insert(index);
            self.solve(self.reduced(index), column);
        }
    }

    /// `column = …` from an equation, there and wherever it stands.
    fn solve(&mut self, [mut row, mut values]: [Row; 2], column: usize) {
        let pivot = row.remove(&column).unwrap_or(1.0);
        row.values_mut().for_each(|a| *a /= -pivot);
        values.values_mut().for_each(|a| *a /= pivot);
        for user in self.users.remove(&column).unwrap_or_default() {
            if let Some([terms, given]) = self.of.get_mut(&user) {
                let a = terms.remove(&column).unwrap_or_default();
                add(terms, a, &row);
                add(given, a, &values);
            }
            for other in row.keys() {
                self.users.entry(*other).or_default().insert(user);
            }
        }
        for other in row.keys() {
            self.users.entry(*other).or_default().insert(column);
        }
        self.of.insert(column, [row, values]);
    }

    fn close(mut self, body: &Body) -> Dependence {
        let mut moving: Vec<bool> = self.equations.iter().map(|e| e.value != 0.0).collect();
        // Those that say nothing new are checked in full.
        for (_, values) in &self.spare {
            values.keys().for_each(|index| moving[*index] = true);
        }
        let dependent = |[terms, values]: [Row; 2]| Dependent {
            terms: terms.into_iter().filter(|(_, a)| *a != 0.0).collect(),
            values: values
                .into_iter()
                .filter(|(index, _)| moving[*index])
                .collect(),
        };
        let spare = self.spare.into_iter().map(|(index, row)| {
            let equation = &self.equations[index];
            let node = equation.terms[0].0 / body.mesh.dimension;
            let others = row.keys().filter(|k| **k != index);
            let others = others.map(|k| place(body, self.equations[*k].by));
            let others: Vec<String> = others.collect::<BTreeSet<_>>().into_iter().collect();
            let what = match body.mesh.nodes.get(node) {
                Some(x) => format!("node {node} at {x:?}"),
                None => "a motion of the group".to_owned(),
            };
            Spare {
                place: place(body, equation.by),
                words: format!("{what}, which {} moves otherwise", others.join(" with ")),
                row,
            }
        });
        let columns = body.unknowns() + OF_TIE * body.ties.len();
        let of = (0..columns).map(|column| self.of.remove(&column).map(dependent));
        Dependence {
            of: of.collect(),
            equations: self.equations.to_vec(),
            spare: spare.collect(),
            unknowns: body.unknowns(),
            dimension: body.mesh.dimension,
        }
    }
}

fn add(sum: &mut Row, factor: f64, row: &Row) {
    for (column, a) in row {
        *sum.entry(*column).or_insert(0.0) += factor * a;
    }
}

impl Dependence {
    /// The equations that it comes from.
    pub(crate) fn equations(&self) -> &[Equation] {
        &self.equations
    }

    /// Right hand sides b under a factor per source, in metre.
    pub(crate) fn values(&self, factor: impl Fn(Source) -> f64) -> Vec<f64> {
        let equations = self.equations.iter();
        equations
            .map(|equation| factor(equation.by) * equation.value)
            .collect()
    }

    /// Refuses right hand sides that contradict each other.
    pub(crate) fn check(&self, values: &[f64]) -> Result<(), Error> {
        for spare in &self.spare {
            let terms = spare.row.iter().map(|(k, a)| a * values[*k]);
            let (sum, size) = terms.fold((0.0, 0.0), |(sum, size), x| {
                (sum + x, f64::max(size, x.abs()))
            });
            if f64::abs(sum) > AGREES * size {
                return Err(Error::NotAccepted {
                    place: spare.place.clone(),
                    found: format!("{}, by {:e}", spare.words, sum.abs()),
                    accepted: "supports and ties that agree".to_owned(),
                });
            }
        }
        Ok(())
    }

    /// What a displacement depends on; none where it is independent.
    pub(crate) fn of(&self, unknown: usize) -> Option<&Dependent> {
        self.of[unknown].as_ref()
    }

    /// The given part of a displacement as it is stated, in metre.
    pub(crate) fn stated(&self, unknown: usize) -> f64 {
        let terms = self.of(unknown).into_iter().flat_map(|of| &of.values);
        terms.map(|&(k, a)| a * self.equations[k].value).sum()
    }

    /// Displacements that nothing but the right hand sides gives, per unknown, in metre; `None` elsewhere.
    pub(crate) fn given(&self, values: &[f64]) -> Vec<Option<f64>> {
        let given = |of: &Option<Dependent>| {
            let of = of.as_ref().filter(|of| of.terms.is_empty())?;
            Some(of.constant(values))
        };
        self.of[..self.unknowns].iter().map(given).collect()
    }

    /// `E b` per unknown, in metre.
    pub(crate) fn constant(&self, values: &[f64]) -> Vec<f64> {
        let of = self.of[..self.unknowns].iter();
        of.map(|of| of.as_ref().map_or(0.0, |of| of.constant(values)))
            .collect()
    }

    /// `Tᵀ f`, in place; zero at what depends.
    pub(crate) fn gather(&self, forces: &mut [f64]) {
        for (unknown, of) in self.of[..self.unknowns].iter().enumerate() {
            if let Some(of) = of {
                let force = std::mem::take(&mut forces[unknown]);
                of.terms.iter().for_each(|&(q, a)| forces[q] += a * force);
            }
        }
    }

    /// `T q`, in place.
    pub(crate) fn spread(&self, displacement: &mut [f64]) {
        for (unknown, of) in self.of[..self.unknowns].iter().enumerate() {
            if let Some(of) = of {
                let moved = of.terms.iter().map(|&(q, a)| a * displacement[q]);
                displacement[unknown] = moved.sum();
            }
        }
    }

    /// `Tᵀ K T`: rows and columns of what depends are empty.
    pub(crate) fn reduce(&self, stiffness: &CsMat<f64>) -> CsMat<f64> {
        let mut users: Vec<Vec<(usize, f64)>> = vec![Vec::new(); self.unknowns];
        for (unknown, of) in self.of[..self.unknowns].iter().enumerate() {
            for &(q, a) in of.iter().flat_map(|of| &of.terms) {
                users[q].push((unknown, a));
            }
        }
        let mut starts = vec![0];
        let (mut columns, mut values) = (
            Vec::with_capacity(stiffness.nnz()),
            Vec::with_capacity(stiffness.nnz()),
        );
        for (unknown, users) in users.iter().enumerate() {
            if self.of[unknown].is_none() {
                let mut row = Row::new();
                for &(from, a) in [(unknown, 1.0)].iter().chain(users) {
                    self.add_row(stiffness, from, a, &mut row);
                }
                columns.extend(row.keys());
                values.extend(row.values());
            }
            starts.push(columns.len());
        }
        CsMat::new((self.unknowns, self.unknowns), starts, columns, values)
    }

    /// Adds a row of `K T`, times a factor.
    fn add_row(&self, stiffness: &CsMat<f64>, from: usize, factor: f64, row: &mut Row) {
        for (column, entry) in stiffness
            .outer_view(from)
            .iter()
            .flat_map(|view| view.iter())
        {
            match self.of(column) {
                None => *row.entry(column).or_insert(0.0) += factor * entry,
                Some(of) => {
                    for (q, a) in &of.terms {
                        *row.entry(*q).or_insert(0.0) += factor * entry * a;
                    }
                }
            }
        }
    }

    /// Orthonormal directions along which a node's displacement is given.
    pub(crate) fn held_directions(&self, node: usize) -> Vec<Vector3<f64>> {
        let rows: Vec<Row> = (0..self.dimension)
            .map(|axis| match self.of(self.dimension * node + axis) {
                None => Row::from([(self.dimension * node + axis, 1.0)]),
                Some(of) => of.terms.iter().copied().collect(),
            })
            .collect();
        // The plane itself holds what leaves it, which is no direction of the body.
        let mut gram = Matrix3::identity();
        for (i, a) in rows.iter().enumerate() {
            for (j, b) in rows.iter().enumerate() {
                gram[(i, j)] = a
                    .iter()
                    .map(|(k, x)| x * b.get(k).copied().unwrap_or(0.0))
                    .sum();
            }
        }
        let size = gram.amax();
        let eigen = gram.symmetric_eigen();
        let held = eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter());
        let held = held.filter(|(value, _)| **value <= HELD * size);
        held.map(|(_, direction)| direction.into_owned()).collect()
    }
}

impl Dependent {
    fn constant(&self, values: &[f64]) -> f64 {
        self.values.iter().map(|&(k, a)| a * values[k]).sum()
    }
}

/// Where an equation is stated.
fn place(body: &Body, by: Source) -> String {
    match by {
        Source::Axis => format!("{}: the axis", body.name),
        Source::Support(index) => body.supports[index].place.clone(),
        Source::Tie(index) => body.ties[index].place().to_owned(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::tests::samples::{block, support};
    use crate::body::{CellKind, RigidGroup, Support, Tie, TiedPairs};

    fn nodes_at(body: &Body, axis: usize, value: f64) -> Vec<usize> {
        let nodes = body.mesh.nodes.iter().enumerate();
        let on = nodes.filter(|(_, x)| x[axis] == value);
        on.map(|(node, _)| node).collect()
    }

    /// A block whose right side is rigid, whose bottom rests on a slope, and whose left side moves as some others.
    fn tied(kind: CellKind) -> Body {
        let mut body = block(kind);
        let bottom = nodes_at(&body, 1, 0.0);
        let slope = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]];
        body.supports = vec![
            support(&nodes_at(&body, 1, 1.0)[..1], &[0]),
            Support {
                displacement: [Some(0.25), None, None],
                axes: vec![slope; bottom.len()],
                ..support(&bottom, &[])
            },
        ];
        let (left, right) = (nodes_at(&body, 0, 0.0), nodes_at(&body, 0, 2.0));
        let inner = left.iter().map(|node| node + 1);
        let pairs = left.iter().zip(inner).map(|(a, b)| [*a, b]);
        body.ties = vec![
            Tie::Rigid(RigidGroup {
                place: "rigid_groups[0]".to_owned(),
                nodes: right,
                reference_point: [3.0, 1.0, 0.0],
                rotation: [None, None, Some(0.125)],
                ..RigidGroup::default()
            }),
            Tie::Pairs(TiedPairs {
                place: "periodic[0]".to_owned(),
                pairs: pairs.collect(),
                rotation: [[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]],
            }),
        ];
        body
    }

    #[test]
    fn every_equation_holds_whatever_is_left_independent() {
        for kind in [CellKind::Quad4, CellKind::Hex8] {
            let body = tied(kind);
            let found = dependence(&body).unwrap().unwrap();
            let values = found.values(|_| 1.0);
            let mut u: Vec<f64> = (0..found.of.len())
                .map(|k| {
                    if found.of[k].is_none() {
                        ((7 * k) % 11) as f64 - 5.0
                    } else {
                        0.0
                    }
                })
                .collect();
            let free = u.clone();
            for (unknown, of) in found.of.iter().enumerate() {
                if let Some(of) = of {
                    let terms = of.terms.iter().map(|&(q, a)| a * free[q]);
                    u[unknown] = terms.sum::<f64>() + of.constant(&values);
                }
            }
            for (equation, value) in found.equations().iter().zip(&values) {
                let sum: f64 = equation.terms.iter().map(|&(k, a)| a * u[k]).sum();
                assert!((sum - value).abs() < 1e-12, "{equation:?}");
            }
            // No motion of the group is among what is left.
            let group = &found.of[body.unknowns()..body.unknowns() + OF_TIE];
            assert!(
                body.group_motions()
                    .iter()
                    .all(|motion| group[*motion].is_some())
            );
            let mut spread = free[..body.unknowns()].to_vec();
            found.spread(&mut spread);
            // (T q) · f = q · (Tᵀ f).
            let forces: Vec<f64> = (0..spread.len())
                .map(|k| ((5 * k) % 7) as f64 - 3.0)
                .collect();
            let mut gathered = forces.clone();
            found.gather(&mut gathered);
            let work = |u: &[f64], f: &[f64]| u.iter().zip(f).map(|(u, f)| u * f).sum::<f64>();
            assert!((work(&spread, &forces) - work(&free, &gathered)).abs() < 1e-10);
        }
    }

    #[test]
    fn a_node_on_a_slope_is_held_across_it() {
        let body = tied(CellKind::Hex8);
        let found = dependence(&body).unwrap().unwrap();
        let middle = nodes_at(&body, 1, 0.0)[2];
        let held = found.held_directions(middle);
        assert_eq!(held.len(), 1);
        assert!((held[0].dot(&Vector3::new(0.6, 0.8, 0.0)).abs() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_body_without_ties_pays_nothing() {
        let mut body = block(CellKind::Quad4);
        body.supports = vec![support(&[0, 1], &[0, 1])];
        assert!(dependence(&body).unwrap().is_none());
    }
}
