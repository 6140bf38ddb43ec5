//! A lattice of springs: the smallest elastic body with a known stiffness, for tests.

use sprs::{CsMat, TriMat};

/// Nodes on a grid of unit spacing, each joined to its 8 (3D: 26) neighbours by a bar.
pub(crate) struct Lattice {
    counts: [usize; 3],
    dimension: usize,
}

impl Lattice {
    /// `cells` per axis; none along z makes it a 2D body.
    pub(crate) fn new(cells: [usize; 3]) -> Self {
        Self {
            counts: cells.map(|count| count + 1),
            dimension: if cells[2] == 0 { 2 } else { 3 },
        }
    }

    pub(crate) fn nodes(&self) -> usize {
        self.counts.iter().product()
    }

    /// Node at grid position `at`, numbered with x fastest.
    pub(crate) fn node(&self, at: [usize; 3]) -> usize {
        at[0] + self.counts[0] * (at[1] + self.counts[1] * at[2])
    }

    pub(crate) fn position(&self, node: usize) -> [f64; 3] {
        let [nx, ny, _] = self.counts;
        [node % nx, node / nx % ny, node / (nx * ny)].map(|i| i as f64)
    }

    /// `K = Σ k d dᵀ / ‖d‖²` over all bars `d`, with a stiffness `k` that varies from bar to bar.
    pub(crate) fn stiffness(&self) -> CsMat<f64> {
        let size = self.nodes() * self.dimension;
        let mut entries = TriMat::new((size, size));
        for a in 0..self.nodes() {
            for b in a + 1..self.nodes() {
                let (p, q) = (self.position(a), self.position(b));
                let d: [f64; 3] = std::array::from_fn(|i| q[i] - p[i]);
                if d.iter().any(|x| x.abs() > 1.0) {
                    continue;
                }
                let square: f64 = d.iter().map(|x| x * x).sum();
                let k = (1.0 + ((7 * a + 3 * b) % 5) as f64) / square;
                for i in 0..self.dimension {
                    for j in 0..self.dimension {
                        for (row, column, sign) in [(a, a, k), (b, b, k), (a, b, -k), (b, a, -k)] {
                            let (row, column) =
                                (row * self.dimension + i, column * self.dimension + j);
                            entries.add_triplet(row, column, sign * d[i] * d[j]);
                        }
                    }
                }
            }
        }
        entries.to_csr()
    }
}
