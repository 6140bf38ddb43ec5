//! Directions along which supports and ties give the displacement of a node.

use nalgebra::Vector3;

use crate::body::Dependence;

/// Part of a direction that may be free where it counts as held.
const ROUND_OFF: f64 = 1e-6;

/// Orthonormal directions.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Directions(pub(crate) Vec<Vector3<f64>>);

impl From<[bool; 3]> for Directions {
    /// Global axes.
    fn from(held: [bool; 3]) -> Self {
        let axes = (0..3).filter(|&axis| held[axis]);
        Self(axes.map(|axis| Vector3::ith(axis, 1.0)).collect())
    }
}

impl Directions {
    /// Those that hold a node of a body.
    pub(super) fn of(
        prescribed: &[Option<f64>],
        tied: Option<&Dependence>,
        dimension: usize,
        node: usize,
    ) -> Self {
        let unknown = |axis: usize| dimension * node + axis;
        let depends = |tied: &&Dependence| {
            let mut of = (0..dimension).filter_map(|axis| tied.of(unknown(axis)));
            of.any(|of| !of.terms.is_empty())
        };
        match tied.filter(depends) {
            Some(tied) => Self(tied.held_directions(node)),
            None => {
                let held = |axis| axis < dimension && prescribed[unknown(axis)].is_some();
                std::array::from_fn(held).into()
            }
        }
    }

    /// All along global axes.
    pub(super) fn are_axes(&self) -> bool {
        self.0.iter().all(|direction| direction.amax() == 1.0)
    }

    /// The same span, from the part of a vector that is in it on, unless one of them is that.
    pub(super) fn led_by(self, vector: Vector3<f64>) -> Self {
        let along = self.along(vector);
        let (size, mut own) = (along.norm(), self.0.iter());
        if size < ROUND_OFF || own.any(|own| own.dot(&along).abs() == size) {
            return self;
        }
        let mut basis = vec![along.normalize()];
        for direction in self.0.iter().skip(1) {
            let rest = (0..2).fold(*direction, |rest, _| {
                basis.iter().fold(rest, |rest, b| rest - b * b.dot(&rest))
            });
            basis.extend(rest.try_normalize(ROUND_OFF));
        }
        match basis.len() == self.0.len() {
            true => Self(basis),
            false => self,
        }
    }

    /// With those of other unit vectors that are at right angles to them.
    pub(super) fn and_across(mut self, others: Self) -> Self {
        let across = others
            .0
            .into_iter()
            .filter(|other| self.along(*other).norm() < ROUND_OFF);
        let across: Vec<Vector3<f64>> = across.collect();
        self.0.extend(across);
        self
    }

    /// What of a vector is along them.
    pub(crate) fn along(&self, vector: Vector3<f64>) -> Vector3<f64> {
        self.0.iter().map(|d| d * d.dot(&vector)).sum()
    }

    /// What of a vector is across them.
    pub(crate) fn across(&self, vector: Vector3<f64>) -> Vector3<f64> {
        self.0
            .iter()
            .fold(vector, |rest, d| rest - d * d.dot(&vector))
    }

    /// Whether a unit vector is in their span.
    pub(super) fn hold(&self, direction: &Vector3<f64>) -> bool {
        self.across(*direction).norm() < ROUND_OFF
    }
}
