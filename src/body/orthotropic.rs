//! Orthotropic elasticity: three planes of symmetry, each direction with constants of its own.
//!
//! ```text
//! ε = S σ     S_ii = 1/E_i,  S_ij = −ν_ij/E_i = −ν_ji/E_j,  2 ε_ij = σ_ij/G_ij      along the material's axes
//! (B14)  C = S⁻¹ = λ̂ I⊗I + R,    λ̂ = K − ⅔ G,    1/K = Σ S_ij,
//!        1/G = (4 Σ S_ii − 4 Σ_(i<j) S_ij + 3 Σ 1/G_ij)/15
//! ```
//!
//! ν_ij is the contraction along j under a pull along i. K and G are the bulk and shear modulus of Reuss, the same
//! in all axes; λ̂ is λ and R is 2 μ of an isotropic material, and R is positive definite for every other. So all
//! that is done to λ of a nearly incompressible material ((B4), (B5)) is done to λ̂, and nothing else changes.
//! Matrices are in Mandel's order xx, yy, zz, √2 yz, √2 xz, √2 xy, in which turning is orthogonal.
//!
//! Jones, Mechanics of Composite Materials (1999), ch. 2; Hill, Proc. Phys. Soc. A 65 (1952) 349–354.

use std::f64::consts::SQRT_2;

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::{Line, Model};
use crate::error::{Error, check_finite};

/// Cosine that a material's axis may be short of 1 along the normal of a plane body.
const ASIDE: f64 = 1e-9;

/// Orthotropic constants along the axes 1, 2, 3 of the material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthotropic {
    /// Young's moduli `E_1, E_2, E_3`, in pascal.
    pub young: [f64; 3],
    /// Poisson's ratios `ν_12, ν_13, ν_23`: contraction along the second axis under a pull along the first.
    pub poisson: [f64; 3],
    /// Shear moduli `G_12, G_13, G_23`, in pascal.
    pub shear: [f64; 3],
    /// Thermal expansion along each axis, in 1/kelvin.
    pub expansion: [f64; 3],
    /// Where the axes point.
    pub axes: MaterialAxes,
}

/// Where the axes of a material point; in axisymmetric bodies x is radial, y axial, z around.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MaterialAxes {
    /// The same everywhere: three orthogonal unit vectors.
    Fixed([[f64; 3]; 3]),
    /// Radial, around and along a line; on the line itself any radial direction.
    Around(Line),
}

impl MaterialAxes {
    /// Along the global axes.
    pub const GLOBAL: Self = Self::Fixed([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);

    /// Axis 1 along `first`, axis 2 in the plane of both; none if they are parallel.
    #[must_use]
    pub fn spanned(first: [f64; 3], second: [f64; 3]) -> Option<Self> {
        let first = Vector3::from(first).try_normalize(0.0)?;
        let second = Vector3::from(second).try_normalize(0.0)?;
        let third = first.cross(&second).try_normalize(ASIDE)?;
        Some(Self::Fixed(
            [first, third.cross(&first), third].map(Into::into),
        ))
    }

    /// The axes at a position, in metre, as rows.
    pub(super) fn at(&self, position: Vector3<f64>) -> Matrix3<f64> {
        match self {
            Self::Fixed(rows) => Matrix3::from_fn(|i, j| rows[i][j]),
            Self::Around(line) => {
                let along = Vector3::from(line.direction).normalize();
                let arm = Vector3::from(line.arm(position.into()));
                let beside = along.cross(&Vector3::ith(along.iamin(), 1.0)).normalize();
                let radial = arm.try_normalize(0.0).unwrap_or(beside);
                let rows = [radial, along.cross(&radial), along].map(|axis| axis.transpose());
                Matrix3::from_rows(&rows)
            }
        }
    }
}

impl Orthotropic {
    /// S along the material's axes.
    fn compliance(&self) -> Matrix6<f64> {
        let mut compliance = Matrix6::zeros();
        for (i, young) in self.young.into_iter().enumerate() {
            compliance[(i, i)] = 1.0 / young;
        }
        for ((i, j), poisson) in PAIRS.into_iter().zip(self.poisson) {
            compliance[(i, j)] = -poisson / self.young[i];
            compliance[(j, i)] = compliance[(i, j)];
        }
        for ((i, j), shear) in PAIRS.into_iter().zip(self.shear) {
            compliance[(6 - i - j, 6 - i - j)] = 0.5 / shear;
        }
        compliance
    }

    /// C along the material's axes; S has passed [`Orthotropic::validate`].
    fn stiffness(&self) -> Matrix6<f64> {
        let compliance = self.compliance();
        let normal = compliance.fixed_view::<3, 3>(0, 0).into_owned();
        let inverse = normal.cholesky().map(|factor| factor.inverse());
        let mut stiffness = Matrix6::zeros();
        stiffness
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&inverse.unwrap_or_default());
        for k in 3..6 {
            stiffness[(k, k)] = 1.0 / compliance[(k, k)];
        }
        stiffness
    }

    /// λ̂ of (B14), and G.
    pub(super) fn moduli(&self) -> [f64; 2] {
        let s = self.compliance();
        let normal = s.fixed_view::<3, 3>(0, 0);
        let (all, own) = (normal.sum(), normal.trace());
        let shear: f64 = self.shear.iter().map(|g| 1.0 / g).sum();
        let shear = 15.0 / (4.0 * own - 2.0 * (all - own) + 3.0 * shear);
        [1.0 / all - 2.0 / 3.0 * shear, shear]
    }

    /// λ̂ and R of (B14) at a position; in plane stress no λ̂, and R with the stress out of the plane gone.
    pub(super) fn split(&self, model: Model, position: Vector3<f64>) -> (f64, Matrix6<f64>) {
        let turn = turn(&self.axes.at(position));
        let mut rest = turn.transpose() * self.stiffness() * turn;
        if let Model::PlaneStress { .. } = model {
            let across = rest.column(2).into_owned();
            return (0.0, rest - across * across.transpose() / across[2]);
        }
        let [lambda, _] = self.moduli();
        rest.fixed_view_mut::<3, 3>(0, 0).add_scalar_mut(-lambda);
        (lambda, rest)
    }

    /// Strain of one kelvin at a position, in the order xx, yy, zz, yz, xz, xy.
    pub(super) fn expansion(&self, position: Vector3<f64>) -> [f64; 6] {
        let axes = self.axes.at(position);
        let own = Matrix3::from_diagonal(&self.expansion.into());
        let tensor = axes.transpose() * own * axes;
        COMPONENTS.map(|at| tensor[at])
    }

    /// `σ : S : σ` at a position, in J/m³.
    pub(super) fn energy(&self, position: Vector3<f64>, stress: [f64; 6]) -> f64 {
        let stress = turn(&self.axes.at(position)) * mandel(stress);
        stress.dot(&(self.compliance() * stress))
    }

    /// Checks that the elastic energy is positive and the axes are axes.
    ///
    /// # Errors
    ///
    /// A modulus that is not positive, a ratio with `|ν_ij| ≥ √(E_i/E_j)`, three that are too large together,
    /// numbers that are not finite, axes that are not orthogonal.
    pub fn validate(&self, place: &str) -> Result<(), Error> {
        for (field, moduli) in [("young", self.young), ("shear", self.shear)] {
            for (at, value) in moduli.into_iter().enumerate() {
                if !(value > 0.0 && value.is_finite()) {
                    return Err(Error::OutOfRange {
                        place: format!("{place}.{field}[{at}]"),
                        value,
                        accepted: "a modulus > 0 and finite",
                    });
                }
            }
        }
        check_finite(&format!("{place}.expansion"), &self.expansion)?;
        check_finite(&format!("{place}.poisson"), &self.poisson)?;
        self.check_ratios(place)?;
        self.axes.validate(place)
    }

    fn check_ratios(&self, place: &str) -> Result<(), Error> {
        let not_accepted = |place: String, found: String, accepted: String| {
            Err(Error::NotAccepted {
                place,
                found,
                accepted,
            })
        };
        for (at, (i, j)) in PAIRS.into_iter().enumerate() {
            let (poisson, most) = (self.poisson[at], (self.young[i] / self.young[j]).sqrt());
            if poisson.abs() >= most {
                return not_accepted(
                    format!("{place}.poisson[{at}]"),
                    poisson.to_string(),
                    format!(
                        "a ratio between ±√(E_{0}/E_{1}) = ±{most:.4}, the contraction along axis {1} under a \
                         pull along axis {0} (ν_{0}{1} = ν_{1}{0} E_{0}/E_{1})",
                        i + 1,
                        j + 1
                    ),
                );
            }
        }
        // Of the ratios ν_ij ν_ji: the determinant of S without its scale.
        let [r12, r13, r23] = [0, 1, 2].map(|at| {
            self.poisson[at] * (self.young[PAIRS[at].1] / self.young[PAIRS[at].0]).sqrt()
        });
        let determinant = 1.0 - r12 * r12 - r13 * r13 - r23 * r23 - 2.0 * r12 * r13 * r23;
        if determinant > 0.0 {
            return Ok(());
        }
        not_accepted(
            format!("{place}.poisson"),
            format!(
                "{:?}, with which 1 − ν12 ν21 − ν23 ν32 − ν13 ν31 − 2 ν21 ν32 ν13 = {determinant:.3e}",
                self.poisson
            ),
            "ratios that leave it positive, as the elastic energy is: smaller ones".to_owned(),
        )
    }

    /// Checks that a plane body strains in its plane alone, a ring without twisting.
    ///
    /// # Errors
    ///
    /// [`Error::NotAccepted`] unless one of the axes is out of the plane.
    pub(crate) fn check_plane(&self, place: &str, model: Model) -> Result<(), Error> {
        if model == Model::Solid {
            return Ok(());
        }
        let (found, accepted) = match (&self.axes, model) {
            (MaterialAxes::Around(_), Model::Axisymmetric) => (
                "axes around a line".to_owned(),
                "axes of the section, where x is radial, y axial and z around already",
            ),
            _ => {
                let axes = self.axes.at(Vector3::zeros());
                if axes.column(2).amax() > 1.0 - ASIDE {
                    return Ok(());
                }
                let rows = axes
                    .row_iter()
                    .map(|row| format!("{:?}", [row[0], row[1], row[2]]));
                let rows: Vec<String> = rows.collect();
                (
                    format!("axes along {}", rows.join(", ")),
                    "one axis of the material out of the plane of a 2D body (of a ring: around it)",
                )
            }
        };
        Err(Error::NotAccepted {
            place: place.to_owned(),
            found,
            accepted: accepted.to_owned(),
        })
    }
}

impl MaterialAxes {
    fn validate(&self, place: &str) -> Result<(), Error> {
        let sound = match self {
            Self::Fixed(rows) => {
                let axes = Matrix3::from_fn(|i, j| rows[i][j]);
                (axes * axes.transpose() - Matrix3::identity()).amax() < ASIDE
                    && axes.determinant() > 0.0
            }
            Self::Around(line) => {
                let length = Vector3::from(line.direction).norm();
                line.point.iter().all(|x| x.is_finite()) && length > 0.0 && length.is_finite()
            }
        };
        if sound {
            return Ok(());
        }
        Err(Error::NotAccepted {
            place: format!("{place}.axes"),
            found: format!("{self:?}"),
            accepted: "three orthogonal unit vectors that form a right hand, or a line".to_owned(),
        })
    }
}

/// The pairs of axes of Poisson's ratios and shear moduli.
const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// The components xx, yy, zz, yz, xz, xy.
const COMPONENTS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)];

/// A symmetric tensor in the order xx, yy, zz, yz, xz, xy in Mandel's form.
pub(super) fn mandel([xx, yy, zz, yz, xz, xy]: [f64; 6]) -> Vector6<f64> {
    Vector6::new(xx, yy, zz, SQRT_2 * yz, SQRT_2 * xz, SQRT_2 * xy)
}

/// The other way.
pub(super) fn components(tensor: &Vector6<f64>) -> [f64; 6] {
    std::array::from_fn(|k| if k < 3 { tensor[k] } else { tensor[k] / SQRT_2 })
}

/// What a turn into axes (rows) does to tensors in Mandel's form.
fn turn(axes: &Matrix3<f64>) -> Matrix6<f64> {
    let columns = (0..6).map(|k| {
        let [xx, yy, zz, yz, xz, xy] = components(&Vector6::ith(k, 1.0));
        let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let t = axes * tensor * axes.transpose();
        mandel(COMPONENTS.map(|at| t[at]))
    });
    Matrix6::from_columns(&columns.collect::<Vec<_>>())
}
