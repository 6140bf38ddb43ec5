//! Sparse symmetric matrices with a block per pair of nodes that share a cell or patch.
//!
//! ```text
//! node i with the ascending neighbours j_0 … j_(k−1), d unknowns per node, o_i = Σ_(h<i) k_h:
//! row d i + r starts at d² o_i + r d k, and its block j_p stands d p further
//! ```
//!
//! Blocks are added where they belong, with no list of triplets in between.

use nalgebra::Matrix3;

use super::incidence::Incidence;

/// A symmetric matrix under assembly, in compressed rows.
pub(crate) struct BlockMatrix {
    axes: usize,
    /// `o_i` per node, and their end.
    offsets: Vec<usize>,
    neighbours: Vec<usize>,
    values: Vec<f64>,
}

impl BlockMatrix {
    /// A zero matrix that couples all nodes of each of the `lists` with each other.
    pub(crate) fn new<'a>(
        axes: usize,
        node_count: usize,
        lists: impl Iterator<Item = &'a [usize]> + Clone,
    ) -> Self {
        let around = Incidence::new(node_count, lists.clone());
        let lists: Vec<&[usize]> = lists.collect();
        let mut offsets = vec![0];
        let mut neighbours = Vec::new();
        // Last row that met each node: tells new neighbours from old ones.
        let mut met = vec![usize::MAX; node_count];
        for node in 0..node_count {
            let start = neighbours.len();
            for list in around.of(node) {
                for &other in lists[*list] {
                    if met[other] != node {
                        met[other] = node;
                        neighbours.push(other);
                    }
                }
            }
            neighbours[start..].sort_unstable();
            offsets.push(neighbours.len());
        }
        let values = vec![0.0; axes * axes * neighbours.len()];
        Self {
            axes,
            offsets,
            neighbours,
            values,
        }
    }

    /// Adds a block and, off the diagonal, its transpose: the matrix stays symmetric to
    /// the last bit.
    #[inline]
    pub(crate) fn add(&mut self, row: usize, column: usize, block: &Matrix3<f64>) {
        self.add_one(row, column, block);
        if row != column {
            self.add_one(column, row, &block.transpose());
        }
    }

    #[inline]
    fn add_one(&mut self, row: usize, column: usize, block: &Matrix3<f64>) {
        let axes = self.axes;
        let range = self.offsets[row]..self.offsets[row + 1];
        let count = range.len();
        let place = self.neighbours[range.clone()].partition_point(|node| *node < column);
        let start = axes * axes * range.start + axes * place;
        for r in 0..axes {
            let from = start + r * axes * count;
            for (c, value) in self.values[from..from + axes].iter_mut().enumerate() {
                *value += block[(r, c)];
            }
        }
    }

    /// The matrix with `d` rows per node, `dof = d · node + axis`.
    pub(crate) fn into_rows(self) -> sprs::CsMat<f64> {
        let axes = self.axes;
        let nodes = self.offsets.len() - 1;
        let mut starts = Vec::with_capacity(axes * nodes + 1);
        let mut columns = Vec::with_capacity(self.values.len());
        starts.push(0);
        for node in 0..nodes {
            let neighbours = &self.neighbours[self.offsets[node]..self.offsets[node + 1]];
            for _ in 0..axes {
                let of_node = |node: &usize| axes * node..axes * (node + 1);
                columns.extend(neighbours.iter().flat_map(of_node));
                starts.push(columns.len());
            }
        }
        let size = axes * nodes;
        sprs::CsMat::new((size, size), starts, columns, self.values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_stand_at_their_nodes_in_both_triangles() {
        let lists: [&[usize]; 2] = [&[0, 2], &[2, 1]];
        let mut matrix = BlockMatrix::new(2, 3, lists.into_iter());
        let block = Matrix3::new(1.0, 2.0, 9.0, 3.0, 4.0, 9.0, 9.0, 9.0, 9.0);
        matrix.add(2, 0, &block);
        matrix.add(2, 0, &block);
        let rows = matrix.into_rows();
        assert_eq!(rows.shape(), (6, 6));
        // Nodes 0 and 1 share no list: 3² + … = 2·2·(2 + 2 + 3) stored numbers.
        assert_eq!(rows.nnz(), 28);
        let at = |i, j| rows.get(i, j).copied();
        assert_eq!(
            [at(4, 0), at(4, 1), at(5, 0), at(5, 1)],
            [2.0, 4.0, 6.0, 8.0].map(Some)
        );
        assert_eq!(
            [at(0, 4), at(1, 4), at(0, 5), at(1, 5)],
            [2.0, 4.0, 6.0, 8.0].map(Some)
        );
        assert_eq!(at(0, 2), None);
    }
}
