//! The compliance of half-spaces on a grid, applied by convolution.

use std::sync::{Arc, OnceLock};

use super::compliance::{ElasticHalf, SurfaceCompliance};
use super::grid::Grid;
use super::points::Points;
use super::range::check_range;
use super::rectangle::{KERNELS, arranged, rectangle, strip};
use super::symbol::Symbols;
use super::transform::{Convolution, Mix, Transforms};
use super::vectors::{Pair, zero_pair};
use crate::error::{Error, check_length};

/// Cells of a grid that needs no coarser one for a start.
const COARSEST: usize = 1024;

/// What comes out of a convolution.
const NORMAL: [bool; 3] = [true, false, false];
const TANGENTIAL: [bool; 3] = [false, true, true];

/// What lies around the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surroundings {
    /// A free surface: the half-space goes on without contact.
    Free,
    /// The same grid again and again along both axes.
    Periodic,
    /// A half-plane: one row of strips without end along y, forces per metre; displacements are those
    /// relative to a point one length of the grid away.
    Plane,
}

/// `u = G f` (S2) for forces on the cells of a grid: what a compliance matrix would do, without one.
///
/// Two half-spaces that press each other are one operator of relative displacement. Nothing of it
/// changes after it is made; many problems may share it.
pub struct HalfSpace {
    grid: Grid,
    surroundings: Surroundings,
    materials: (ElasticHalf, Option<ElasticHalf>),
    compliance: SurfaceCompliance,
    symbols: Symbols,
    transforms: Transforms,
    diagonal: [f64; 3],
    whole: Points,
    coarser: OnceLock<Option<Arc<HalfSpace>>>,
}

impl std::fmt::Debug for HalfSpace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (grid, around) = (&self.grid, &self.surroundings);
        write!(f, "HalfSpace({grid:?}, {around:?}, {:?})", self.materials)
    }
}

impl HalfSpace {
    /// The operator of one half-space on a rigid body, or with `other` of two on each other.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a material that is none, and for a half-plane whose grid has more
    /// than one row, for a periodic surface of one cell; [`Error::NotFinite`].
    pub fn new(
        grid: Grid,
        surroundings: Surroundings,
        material: ElasticHalf,
        other: Option<ElasticHalf>,
    ) -> Result<Self, Error> {
        let grid = Grid::new(grid.cells, grid.spacing)?;
        let compliance = SurfaceCompliance::new(material, other)?;
        let [columns, rows] = grid.cells;
        let one = surroundings != Surroundings::Plane || rows == 1;
        check_range("grid.cells[1]", rows as f64, one, "1 row for a half-plane")?;
        let accepted = "two cells or more on a periodic surface, whose mean nothing moves";
        let several = surroundings != Surroundings::Periodic || grid.len() > 1;
        check_range("grid.cells[0]", columns as f64, several, accepted)?;
        let of = |offset| influence(&grid, surroundings, &compliance, offset);
        let (padded, symbols, diagonal) = match surroundings {
            Surroundings::Periodic => {
                let symbols = Symbols::periodic(&grid, &compliance);
                let diagonal = symbols.means();
                (grid.cells, symbols, diagonal)
            }
            Surroundings::Free | Surroundings::Plane => {
                let padded = grid.cells.map(padded_length);
                let symbols = Symbols::bounded(padded, &|cells| of(cells.map(|at| at as f64)));
                let [nn, xx, yy, ..] = of([0.0; 2]);
                (padded, symbols, [nn, xx, yy])
            }
        };
        Ok(Self {
            surroundings,
            materials: (material, other),
            compliance,
            symbols,
            transforms: Transforms::new(grid.cells, padded),
            diagonal,
            whole: Points::whole(&grid),
            coarser: OnceLock::new(),
            grid,
        })
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// What lies around the grid.
    #[must_use]
    pub fn surroundings(&self) -> Surroundings {
        self.surroundings
    }

    /// The half-space, and the one opposite where there is one.
    #[must_use]
    pub fn materials(&self) -> (ElasticHalf, Option<ElasticHalf>) {
        self.materials
    }

    /// Compliance of a cell under a force on itself along the normal, x and y, in m/N.
    #[must_use]
    pub fn diagonal(&self) -> [f64; 3] {
        self.diagonal
    }

    /// Whether normal forces displace along the tangents.
    #[must_use]
    pub fn coupled(&self) -> bool {
        self.compliance.coupling != 0.0
    }

    /// |β| of the materials.
    pub(super) fn dundurs(&self) -> f64 {
        self.compliance.dundurs()
    }

    /// Two-dimensional transforms done so far; six are one application.
    #[must_use]
    pub fn transforms(&self) -> usize {
        self.transforms.done()
    }

    /// `G f`: displacements along the normal, x and y at every cell, in metre, of such forces, in N.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] unless there is one force per cell and direction.
    pub fn apply(&self, forces: [&[f64]; 3]) -> Result<[Vec<f64>; 3], Error> {
        self.check_forces(forces)?;
        Ok(self.full(forces, &self.whole, &self.whole))
    }

    /// The transforms of [`HalfSpace::apply`] alone, there and back, with nothing done to the waves: forces times
    /// the number of cells with their padding. What benches set an application beside.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] as `apply`.
    pub fn transform(&self, forces: [&[f64]; 3]) -> Result<[Vec<f64>; 3], Error> {
        self.check_forces(forces)?;
        let forces = forces.map(Some);
        Ok(self.convolve(forces, &self.whole, [true; 3], &self.whole, &|_, _| {}))
    }

    fn check_forces(&self, forces: [&[f64]; 3]) -> Result<(), Error> {
        for (force, place) in forces.iter().zip(["forces[0]", "forces[1]", "forces[2]"]) {
            check_length(place, self.grid.len(), force.len())?;
        }
        Ok(())
    }

    /// A column of `G` by the formulas: displacement at a cell by a unit force at another, rows and
    /// columns normal, x, y, in m/N. Nothing if the grid is periodic, which has no such formula.
    #[must_use]
    pub fn influence(&self, at: usize, of: usize) -> Option<[[f64; 3]; 3]> {
        if self.surroundings == Surroundings::Periodic {
            return None;
        }
        let (at, of) = (self.grid.position(at), self.grid.position(of));
        let offset = [0, 1].map(|axis| (at[axis] - of[axis]) / self.grid.spacing[axis]);
        let offset = offset.map(f64::round);
        let kernels = influence(&self.grid, self.surroundings, &self.compliance, offset);
        Some(arranged(kernels))
    }

    /// Symbol of a periodic operator at a wave, as [`HalfSpace::influence`]; NN, xx, yy, xy and the
    /// imaginary parts of xN, yN.
    pub(super) fn symbol(&self, wave: [usize; 2]) -> [f64; KERNELS] {
        let rows = self.grid.cells[1] / 2 + 1;
        let size = self.grid.len() as f64;
        let at = wave[0] * rows + wave[1];
        std::array::from_fn(|kernel| size * self.symbols.kernels[kernel][at])
    }

    /// The same half-space on cells twice as long along every axis that has more than one; nothing
    /// where a number of cells is odd, or the grid coarse enough. Made once.
    pub(super) fn coarser(&self) -> Option<&Arc<HalfSpace>> {
        let cells = self.grid.cells;
        if cells.iter().any(|&cells| cells > 1 && cells % 2 == 1) || self.grid.len() <= COARSEST {
            return None;
        }
        let coarser = self.coarser.get_or_init(|| {
            let axis = |axis: usize| if cells[axis] > 1 { 2 } else { 1 };
            let grid = Grid {
                cells: [0, 1].map(|a| cells[a] / axis(a)),
                spacing: [0, 1].map(|a| self.grid.spacing[a] * axis(a) as f64),
            };
            let (material, other) = self.materials;
            Self::new(grid, self.surroundings, material, other)
                .ok()
                .map(Arc::new)
        });
        coarser.as_ref()
    }

    pub(super) fn whole(&self) -> &Points {
        &self.whole
    }

    /// Upper bounds of the eigenvalues of the normal and the tangential part.
    pub(super) fn largest(&self) -> [f64; 2] {
        self.symbols.largest()
    }

    pub(super) fn full(&self, forces: [&[f64]; 3], from: &Points, to: &Points) -> [Vec<f64>; 3] {
        let mix: Mix = &|column, waves| self.symbols.full(column, waves);
        self.convolve(forces.map(Some), from, [true; 3], to, mix)
    }

    /// Normal displacement of normal forces.
    pub(super) fn normal(&self, force: &[f64], from: &Points, to: &Points) -> Vec<f64> {
        let mix: Mix = &|column, waves| self.symbols.normal(column, waves);
        let [normal, ..] = self.convolve([Some(force), None, None], from, NORMAL, to, mix);
        normal
    }

    /// Preconditioner for [`HalfSpace::normal`]: the inverse symbol, on the same points.
    pub(super) fn inverse_normal(&self, force: &[f64], on: &Points) -> Vec<f64> {
        let mix: Mix = &|column, waves| self.symbols.inverse_normal(column, waves);
        let [normal, ..] = self.convolve([Some(force), None, None], on, NORMAL, on, mix);
        normal
    }

    /// Tangential displacement of tangential forces.
    pub(super) fn tangential(&self, [x, y]: &Pair, from: &Points, to: &Points) -> Pair {
        let mix: Mix = &|column, waves| self.symbols.tangential(column, waves);
        let [_, x, y] = self.convolve([None, Some(x), Some(y)], from, TANGENTIAL, to, mix);
        [x, y]
    }

    /// Preconditioner for [`HalfSpace::tangential`]: the inverse symbol, on the same points.
    pub(super) fn inverse_tangential(&self, [x, y]: &Pair, on: &Points) -> Pair {
        let mix: Mix = &|column, waves| self.symbols.inverse_tangential(column, waves);
        let [_, x, y] = self.convolve([None, Some(x), Some(y)], on, TANGENTIAL, on, mix);
        [x, y]
    }

    /// Normal displacement of tangential forces.
    pub(super) fn normal_of_tangential(
        &self,
        [x, y]: &Pair,
        from: &Points,
        to: &Points,
    ) -> Vec<f64> {
        if !self.coupled() {
            return vec![0.0; to.len()];
        }
        let mix: Mix = &|column, waves| self.symbols.normal_of_tangential(column, waves);
        let [normal, ..] = self.convolve([None, Some(x), Some(y)], from, NORMAL, to, mix);
        normal
    }

    /// Tangential displacement of normal forces.
    pub(super) fn tangential_of_normal(&self, force: &[f64], from: &Points, to: &Points) -> Pair {
        if !self.coupled() {
            return zero_pair(to.len());
        }
        let mix: Mix = &|column, waves| self.symbols.tangential_of_normal(column, waves);
        let [_, x, y] = self.convolve([Some(force), None, None], from, TANGENTIAL, to, mix);
        [x, y]
    }

    fn convolve(
        &self,
        inputs: [Option<&[f64]>; 3],
        from: &Points,
        outputs: [bool; 3],
        to: &Points,
        mix: Mix,
    ) -> [Vec<f64>; 3] {
        let asked = Convolution {
            inputs,
            from,
            outputs,
            to,
        };
        self.transforms.convolve(&asked, mix)
    }
}

/// Kernels at an offset in cells.
fn influence(
    grid: &Grid,
    surroundings: Surroundings,
    compliance: &SurfaceCompliance,
    offset: [f64; 2],
) -> [f64; KERNELS] {
    let [x, y] = [0, 1].map(|axis| offset[axis] * grid.spacing[axis]);
    match surroundings {
        Surroundings::Plane => {
            let datum = grid.cells[0] as f64 * grid.spacing[0];
            strip(compliance, grid.spacing[0], datum, x)
        }
        Surroundings::Free | Surroundings::Periodic => rectangle(compliance, grid.spacing, [x, y]),
    }
}

/// The least even number from `2n − 1` on whose prime factors are 2, 3 and 5; 1 for a single cell.
fn padded_length(cells: usize) -> usize {
    if cells == 1 {
        return 1;
    }
    let smooth = |mut number: usize| {
        for factor in [2, 3, 5] {
            while number.is_multiple_of(factor) {
                number /= factor;
            }
        }
        number == 1
    };
    let mut length = (2 * cells - 1).next_multiple_of(2);
    while !smooth(length) {
        length += 2;
    }
    length
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const RUBBER: ElasticHalf = ElasticHalf {
        young: 2.0,
        poisson: 0.3,
    };

    /// Numbers between -1 and 1 without a pattern.
    fn scattered(length: usize, seed: u64) -> Vec<f64> {
        let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        (0..length)
            .map(|_| {
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
            })
            .collect()
    }

    #[test]
    fn the_convolution_is_the_sum_over_all_cells() {
        for (cells, around) in [
            ([5, 7], Surroundings::Free),
            ([8, 6], Surroundings::Free),
            ([1, 9], Surroundings::Free),
            ([9, 1], Surroundings::Free),
            ([1, 1], Surroundings::Free),
            ([16, 3], Surroundings::Free),
            ([12, 1], Surroundings::Plane),
            ([7, 1], Surroundings::Plane),
            ([1, 1], Surroundings::Plane),
        ] {
            let grid = Grid::new(cells, [0.3, 0.2]).unwrap();
            let space = HalfSpace::new(grid, around, RUBBER, None).unwrap();
            let count = grid.len();
            let force = [1, 2, 3].map(|seed| scattered(count, seed));
            let found = space.apply([&force[0], &force[1], &force[2]]).unwrap();
            for (at, row) in (0..count).flat_map(|at| (0..3).map(move |row| (at, row))) {
                let term = |of: usize, column: usize| {
                    space.influence(at, of).unwrap()[row][column] * force[column][of]
                };
                let sum: f64 = (0..count)
                    .map(|of| (0..3).map(|c| term(of, c)).sum::<f64>())
                    .sum();
                let off = (sum - found[row][at]).abs();
                assert!(off < 1e-13 * count as f64, "{cells:?} {around:?}");
            }
        }
    }

    #[test]
    fn far_from_a_cell_its_displacement_is_that_of_a_point_force() {
        // references.md, item 6, with P = −1 (into the body: +1): u_z = (1 − ν)/(2πGr), towards the load
        // u_x = −(1 − 2ν) x/(4πGr²); Q = 1: u_x = (1/2πG)((1 − ν)/r + ν x²/r³), u_y = ν xy/(2πGr³).
        let grid = Grid::new([64, 64], [0.01, 0.01]).unwrap();
        let space = HalfSpace::new(grid, Surroundings::Free, RUBBER, None).unwrap();
        let (at, of) = (50 + 64 * 40, 3 + 64 * 7);
        let (x, y, shear, nu) = (0.47, 0.33, 2.0 / 2.6, 0.3);
        let r = f64::hypot(x, y);
        let found = space.influence(at, of).unwrap();
        let point = 1.0 / (2.0 * std::f64::consts::PI * shear);
        let expected = [
            (found[0][0], point * (1.0 - nu) / r),
            (found[1][0], 0.5 * point * (1.0 - 2.0 * nu) * x / (r * r)),
            (found[0][1], -0.5 * point * (1.0 - 2.0 * nu) * x / (r * r)),
            (
                found[1][1],
                point * ((1.0 - nu) / r + nu * x * x / r.powi(3)),
            ),
            (found[2][1], point * nu * x * y / r.powi(3)),
        ];
        for (found, expected) in expected {
            assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
        }
    }

    #[test]
    fn work_done_by_one_load_on_another_is_mutual() {
        for (cells, around) in [
            ([5, 7], Surroundings::Free),
            ([8, 6], Surroundings::Periodic),
            ([9, 5], Surroundings::Periodic),
            ([1, 9], Surroundings::Periodic),
            ([11, 1], Surroundings::Plane),
        ] {
            let grid = Grid::new(cells, [0.3, 0.2]).unwrap();
            let space = HalfSpace::new(grid, around, RUBBER, None).unwrap();
            let loads = [1, 11].map(|seed| [0, 1, 2].map(|c| scattered(grid.len(), seed + c)));
            let moved = loads
                .clone()
                .map(|load| space.apply([&load[0], &load[1], &load[2]]).unwrap());
            let work = |load: &[Vec<f64>; 3], moved: &[Vec<f64>; 3]| -> f64 {
                let pairs = load.iter().flatten().zip(moved.iter().flatten());
                pairs.map(|(force, u)| force * u).sum()
            };
            assert!((work(&loads[0], &moved[1]) - work(&loads[1], &moved[0])).abs() < 1e-12);
            assert!(work(&loads[0], &moved[0]) > 0.0, "{cells:?} {around:?}");
        }
    }
}
