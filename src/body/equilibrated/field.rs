//! The stress of a displacement anywhere in a plane cell or ring, and the compliance there.

use nalgebra::{DMatrix, DVector, Matrix3, Vector2, Vector3};

use crate::body::prestress::Prestress;
use crate::body::quadrature::positions;
use crate::body::reference::Point;
use crate::body::stress::{gradient_of, stress_of, sum};
use crate::body::{Body, Model};

/// Steps that find a position in a cell: one for triangles, few for quadrilaterals.
const STEPS: usize = 30;

/// A displacement of a body, to be asked for its stress.
pub(super) struct Field<'a> {
    pub(super) body: &'a Body,
    pub(super) displacement: &'a [f64],
    prestress: Option<Prestress<'a>>,
}

impl<'a> Field<'a> {
    pub(super) fn new(body: &'a Body, displacement: &'a [f64]) -> Self {
        let prestress = Prestress::new(body, &body.loads);
        Self {
            body,
            displacement,
            prestress,
        }
    }

    /// What an area counts: 1, or r of a ring, whose integrals go around the axis per radian.
    pub(super) fn weight(&self, x: Vector2<f64>) -> f64 {
        match self.body.model {
            Model::Axisymmetric => x.x,
            _ => 1.0,
        }
    }

    /// Corners of a cell.
    pub(super) fn corners(&self, index: usize) -> Vec<Vector2<f64>> {
        let cell = self.body.mesh.cell(index);
        let corners = cell.nodes[..cell.kind.corner_count()].iter();
        corners
            .map(|&node| {
                let [x, y, _] = self.body.mesh.nodes[node];
                Vector2::new(x, y)
            })
            .collect()
    }

    /// The reference position of a place in a cell with straight sides.
    pub(super) fn inside(&self, index: usize, place: Vector2<f64>) -> [f64; 3] {
        let linear = self.body.mesh.cell(index).kind.linear().reference();
        let corners: Vec<Vector3<f64>> = self
            .corners(index)
            .iter()
            .map(|x| Vector3::new(x.x, x.y, 0.0))
            .collect();
        let mut at = linear.centre();
        for _ in 0..STEPS {
            let point = Point::at(linear, at, 1.0);
            let [t1, t2, t3] = point.tangents(2, &corners);
            let away = Vector3::new(place.x, place.y, 0.0) - point.in_space(&corners);
            let Some(inverse) = Matrix3::from_columns(&[t1, t2, t3]).try_inverse() else {
                break;
            };
            let step = inverse * away;
            at = [at[0] + step.x, at[1] + step.y, 0.0];
            if step.norm() < 1e-15 {
                break;
            }
        }
        at
    }

    /// Stress at a reference position of a cell, in pascal: xx, yy, xy and of a ring also that around the axis.
    pub(super) fn stress(&self, index: usize, at: [f64; 3]) -> DVector<f64> {
        let (body, cell) = (self.body, self.body.mesh.cell(index));
        let nodes = positions(&body.mesh, cell.nodes);
        let point = Point::at(cell.kind.reference(), at, 1.0);
        let mapped = point.map(body.model, &nodes);
        let gradient = gradient_of(body, self.displacement, cell, &[], &mapped);
        let material = &body.materials[body.material_of_cell[index]];
        let elasticity = material.elasticity(body.model, point.in_space(&nodes));
        let mut stress = stress_of(&elasticity, body.model, &gradient, None);
        if let Some(prestress) = &self.prestress {
            stress = sum(stress, prestress.at(index, &point.shape));
        }
        self.components(stress)
    }

    /// Number of components of a stress.
    pub(super) fn count(&self) -> usize {
        match self.body.model {
            Model::Axisymmetric => 4,
            _ => 3,
        }
    }

    fn components(&self, [xx, yy, zz, _, _, xy]: [f64; 6]) -> DVector<f64> {
        DVector::from_column_slice(&[xx, yy, xy, zz][..self.count()])
    }

    /// C⁻¹ between these components at a place in a cell; shear strains are whole angles.
    pub(super) fn compliance(&self, index: usize, place: Vector2<f64>) -> DMatrix<f64> {
        let model = self.body.model;
        let material = &self.body.materials[self.body.material_of_cell[index]];
        let elasticity = material.elasticity(model, Vector3::new(place.x, place.y, 0.0));
        let columns: Vec<DVector<f64>> = [0, 1, 5, 2][..self.count()]
            .iter()
            .map(|&k| {
                let mut strain = [0.0; 6];
                strain[k] = if k == 5 { 0.5 } else { 1.0 };
                let theta = if k == 5 { 0.0 } else { 1.0 };
                self.components(elasticity.stress(model, strain, theta))
            })
            .collect();
        let stiffness = DMatrix::from_columns(&columns);
        let size = stiffness.nrows();
        // Checked before: moduli are positive.
        stiffness
            .try_inverse()
            .unwrap_or_else(|| DMatrix::zeros(size, size))
    }
}
