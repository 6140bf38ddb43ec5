//! Tractions on all edges with which every cell is in equilibrium.
//!
//! ```text
//! Σ_e ± ∫_e t · λ_a ds = ∫_K σ(u) : ε(λ_a) − b λ_a dA       for every corner a of every cell K, e: its edges at a
//! ```
//!
//! The right side is what the cell asks of its corner a, and the sum of these around a vanishes because u is in
//! equilibrium; so the equations around every node have a solution, at first the one closest to the
//! recovered σ* n (B9). What they leave free, a circulation around each node, is then taken so that the energy of
//! all cells together is least. A linear function and the hats λ_a are what rigid motions are made of: the
//! tractions hold every cell (Ladevèze, Leguillon, SIAM J. Numer. Anal. 20 (1983) 485–509).

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

use super::bernstein::{LINE, on_edge, raised, times};
use super::edges::{Edge, Edges};
use super::field::Field;
use super::given::{Given, key};
use crate::body::Model;
use crate::body::quadrature::rule;
use crate::body::recovery::recovered_stress;
use crate::body::reference::Point;

/// Forces that do not balance around a node by more than this part of the largest are no rounding.
const BALANCED: f64 = 1e-8;

/// Eigenvalues of what changes of moments do to cells, whole numbers mostly, below which they do nothing.
const NO_FORCE: f64 = 1e-9;

/// Sweeps over what equilibrium leaves free; any number gives a bound.
const SWEEPS: usize = 20;

/// `∫_e t λ_a ds` for both corners of an edge, with the weight of a ring.
pub(super) type Moments = [Vector2<f64>; 2];

/// Tractions of all edges, on the side of their first cell.
pub(super) struct Tractions<'a> {
    field: &'a Field<'a>,
    given: &'a Given<'a>,
    pub(super) edges: &'a Edges,
    /// Degree of t.
    degree: usize,
    /// Coefficients of t per edge and component, before its moments are set right.
    base: Vec<[Vec<f64>; 2]>,
    pub(super) moments: Vec<Moments>,
    /// What equilibrium leaves free: changes of moments around a node, together.
    free: Vec<Vec<Change>>,
}

/// Part of a change of the moments: edge, end, component, how much.
type Change = (usize, usize, usize, f64);

/// A node whose cells no tractions hold.
pub(super) struct Unbalanced(pub(super) usize);

impl<'a> Tractions<'a> {
    pub(super) fn new(
        field: &'a Field<'a>,
        given: &'a Given<'a>,
        edges: &'a Edges,
        degree: usize,
    ) -> Result<Self, Unbalanced> {
        let mut tractions = Self {
            field,
            given,
            edges,
            degree,
            base: Vec::new(),
            moments: Vec::new(),
            free: Vec::new(),
        };
        let (_, smooth) = recovered_stress(field.body, field.displacement);
        for edge in &edges.all {
            let base = tractions.base(edge, &smooth);
            tractions.moments.push(tractions.moments_of(edge, &base));
            tractions.base.push(base);
        }
        tractions.balance()?;
        Ok(tractions)
    }

    /// The given traction, or the mean of σ* n from both sides.
    fn base(&self, edge: &Edge, smooth: &[Vec<[f64; 6]>]) -> [Vec<f64>; 2] {
        let ends = edge
            .ends
            .map(|place| self.given.traction(key(&edge.nodes), place, edge.normal));
        let at_nodes = self.at_nodes(edge, smooth);
        [0, 1].map(|k| match edge.given[k] {
            true => raised(vec![ends[0][k], ends[1][k]], self.degree),
            false => through(&at_nodes.iter().map(|t| t[k]).collect::<Vec<_>>()),
        })
    }

    /// Mean of σ* n at both ends and, of quadratic tractions, in the middle.
    fn at_nodes(&self, edge: &Edge, smooth: &[Vec<[f64; 6]>]) -> Vec<Vector2<f64>> {
        let mut pulls = vec![Vector2::zeros(); self.degree + 1];
        for &(index, local) in &edge.cells {
            let cell = self.field.body.mesh.cell(index);
            let facet = cell.kind.facets()[local];
            let turned = cell.nodes[facet[0]] != edge.nodes[0];
            for (at, pull) in pulls.iter_mut().enumerate() {
                let node = match (at, turned) {
                    (2, _) => facet.get(2),
                    (_, true) => facet.get(1 - at),
                    (_, false) => facet.get(at),
                };
                // Linear cells beside quadratic ones have no node between.
                let stress = |at: usize| smooth[index][at];
                let [xx, yy, _, _, _, xy] = match node {
                    Some(&node) => stress(node),
                    None => half(stress(facet[0]), stress(facet[1])),
                };
                let pulled = Matrix2::new(xx, xy, xy, yy) * edge.normal;
                *pull += pulled / edge.cells.len() as f64;
            }
        }
        pulls
    }

    fn on_axis(&self, edge: &Edge) -> bool {
        self.field.body.model == Model::Axisymmetric && edge.ends.iter().all(|x| x.x == 0.0)
    }

    fn moments_of(&self, edge: &Edge, base: &[Vec<f64>; 2]) -> Moments {
        let mut moments = [Vector2::zeros(); 2];
        for (s, share) in LINE {
            let values = on_edge(self.degree, s);
            let t = Vector2::from_fn(|k, _| values.iter().zip(&base[k]).map(|(b, c)| b * c).sum());
            let weight = share * edge.length * self.field.weight(edge.place(s));
            moments[0] += t * (weight * (1.0 - s));
            moments[1] += t * (weight * s);
        }
        moments
    }

    /// Sets the moments right around every node.
    fn balance(&mut self) -> Result<(), Unbalanced> {
        let asked = self.asked();
        let size = |force: &Vector2<f64>| force.amax();
        let largest = asked.iter().flatten().map(|(_, force)| size(force));
        let given = self.moments.iter().flatten().map(size);
        let largest = largest.chain(given).fold(0.0, f64::max);
        let at_nodes = self.edges.at_nodes(asked.len());
        for (node, cells) in asked.iter().enumerate() {
            for k in 0..2 {
                let on_axis = self.field.body.model == Model::Axisymmetric
                    && self.field.body.mesh.nodes[node][0] == 0.0;
                // Hoop stress holds rings across the axis.
                if k == 0 && on_axis {
                    continue;
                }
                let off = self.around(node, k, cells, &at_nodes[node]);
                if off > BALANCED * largest {
                    return Err(Unbalanced(node));
                }
            }
        }
        Ok(())
    }

    /// Sets one component right around a node; returns what is left.
    fn around(
        &mut self,
        node: usize,
        k: usize,
        cells: &[(usize, Vector2<f64>)],
        edges: &[usize],
    ) -> f64 {
        let end = |edge: usize| usize::from(self.edges.all[edge].nodes[1] == node);
        let row = |cell: usize| cells.iter().position(|(of, _)| *of == cell);
        let free: Vec<usize> = edges
            .iter()
            .copied()
            .filter(|&edge| !self.edges.all[edge].given[k] && !self.on_axis(&self.edges.all[edge]))
            .collect();
        let mut matrix = DMatrix::zeros(cells.len(), free.len());
        let mut left = DVector::from_iterator(cells.len(), cells.iter().map(|(_, f)| f[k]));
        for &edge in edges {
            for ((cell, _), sign) in self.edges.all[edge].cells.iter().zip([1.0, -1.0]) {
                let Some(row) = row(*cell) else { continue };
                left[row] -= sign * self.moments[edge][end(edge)][k];
                if let Some(column) = free.iter().position(|of| *of == edge) {
                    matrix[(row, column)] = sign;
                }
            }
        }
        if free.is_empty() {
            return left.amax();
        }
        // Circulations around the node change nothing: the motion closest to none has none of them.
        let gram = matrix.transpose() * &matrix;
        let eigen = gram.symmetric_eigen();
        for (value, mode) in eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter())
        {
            if *value > NO_FORCE {
                let along = mode.dot(&(matrix.transpose() * &left)) / value;
                for (edge, part) in free.iter().zip(mode.iter()) {
                    self.moments[*edge][end(*edge)][k] += along * part;
                }
                left -= &matrix * mode * along;
            } else {
                let parts = free.iter().zip(mode.iter());
                let change = parts.map(|(&edge, part)| (edge, end(edge), k, *part));
                self.free.push(change.collect());
            }
        }
        left.amax()
    }

    /// What every cell asks of its corners, per node.
    fn asked(&self) -> Vec<Vec<(usize, Vector2<f64>)>> {
        let (field, mesh) = (self.field, &self.field.body.mesh);
        let mut asked = vec![Vec::new(); mesh.nodes.len()];
        for (index, cell) in mesh.cells().enumerate() {
            let linear = cell.kind.linear().reference();
            let corners: Vec<_> = field.corners(index).iter().map(|x| x.push(0.0)).collect();
            let mut forces = vec![Vector2::zeros(); corners.len()];
            for point in rule(cell.kind, field.body.model) {
                let stress = field.stress(index, point.position);
                let point = Point::at(linear, point.position, point.weight);
                let place = point.in_space(&corners).xy();
                let force = self.given.volume_force(index, place);
                let mapped = point.map(Model::PlaneStrain, &corners);
                let volume = mapped.volume * field.weight(place);
                for (a, sum) in forces.iter_mut().enumerate() {
                    let [x, y, _] = mapped.gradients[a].into();
                    let hat = point.shape[a];
                    let mut pull =
                        Vector2::new(stress[0] * x + stress[2] * y, stress[2] * x + stress[1] * y);
                    if let Some(around) = stress.get(3) {
                        pull.x += around * hat / place.x;
                    }
                    *sum += (pull - force * hat) * volume;
                }
            }
            for (node, force) in cell.nodes.iter().zip(forces) {
                asked[*node].push((index, force));
            }
        }
        asked
    }

    /// Takes what equilibrium leaves free so that the energy of all cells is least: each has ½ mᵀ Q m − p · m for
    /// the moments m of its edges, by edge, end and component.
    pub(super) fn relax(&mut self, energies: &[(DMatrix<f64>, DVector<f64>)]) {
        let of_cell = |edges: &[(usize, f64)], changes: &[Change]| {
            let mut along = DVector::zeros(4 * edges.len());
            for &(edge, end, k, part) in changes {
                if let Some(at) = edges.iter().position(|(of, _)| *of == edge) {
                    along[4 * at + 2 * end + k] += part;
                }
            }
            along
        };
        let free = std::mem::take(&mut self.free);
        for _ in 0..SWEEPS {
            for changes in &free {
                let cells = changes
                    .iter()
                    .flat_map(|change| self.edges.all[change.0].cells.iter().map(|side| side.0));
                let cells: std::collections::BTreeSet<usize> = cells.collect();
                let (mut slope, mut bend) = (0.0, 0.0);
                for cell in cells {
                    let edges = &self.edges.of_cell[cell];
                    let along = of_cell(edges, changes);
                    let moments = edges
                        .iter()
                        .flat_map(|(edge, _)| self.moments[*edge].iter().flat_map(|m| [m.x, m.y]));
                    let moments = DVector::from_iterator(4 * edges.len(), moments);
                    let (quadratic, pull) = &energies[cell];
                    slope += along.dot(&(quadratic * moments - pull));
                    bend += along.dot(&(quadratic * &along));
                }
                if bend > 0.0 {
                    for &(edge, end, k, part) in changes {
                        self.moments[edge][end][k] -= slope / bend * part;
                    }
                }
            }
        }
        self.free = free;
    }

    /// Coefficients of the traction on an edge times the weight of a ring, of a degree.
    pub(super) fn weighted(&self, index: usize, degree: usize) -> [Vec<f64>; 2] {
        let of_base = self.moments_of(&self.edges.all[index], &self.base[index]);
        let units = self.units(index, degree);
        [0, 1].map(|k| {
            let mut t = self.raise(index, self.base[index][k].clone(), degree);
            for (end, unit) in units.iter().enumerate() {
                let off = self.moments[index][end][k] - of_base[end][k];
                t.iter_mut()
                    .zip(unit)
                    .for_each(|(t, unit)| *t += off * unit);
            }
            t
        })
    }

    /// The same of a traction with a unit moment at one end and none at the other.
    pub(super) fn units(&self, index: usize, degree: usize) -> [Vec<f64>; 2] {
        let edge = &self.edges.all[index];
        let mut mass = Matrix2::zeros();
        for (s, share) in LINE {
            let hats = Vector2::new(1.0 - s, s);
            let weight = share * edge.length * self.field.weight(edge.place(s));
            mass += hats * hats.transpose() * weight;
        }
        let inverse = mass.try_inverse().unwrap_or_else(Matrix2::zeros);
        [0, 1].map(|end| {
            let linear = inverse.column(end);
            self.raise(index, vec![linear[0], linear[1]], degree)
        })
    }

    /// A traction times the weight of a ring, by the coefficients of a degree.
    fn raise(&self, index: usize, traction: Vec<f64>, degree: usize) -> Vec<f64> {
        let traction = raised(traction, self.degree);
        let weights = self.edges.all[index].ends.map(|end| self.field.weight(end));
        let weighted = match self.field.body.model {
            Model::Axisymmetric => times(&traction, weights),
            _ => traction,
        };
        raised(weighted, degree)
    }
}

fn half(a: [f64; 6], b: [f64; 6]) -> [f64; 6] {
    std::array::from_fn(|k| 0.5 * (a[k] + b[k]))
}

/// Coefficients of the polynomial with these values at both ends, and in the middle.
fn through(values: &[f64]) -> Vec<f64> {
    match *values {
        [a, b, middle] => vec![a, 2.0 * middle - 0.5 * (a + b), b],
        _ => values.to_vec(),
    }
}
