//! Linear elasticity: `σ = λ tr ε I + 2 μ ε`, or what `orthotropic.rs` has in place of λ and 2 μ; what heat and
//! initial stress add is in `prestress.rs`.
//!
//! ```text
//! μ = E / (2 (1 + ν)),   λ = E ν / ((1 + ν)(1 − 2 ν))     plane strain, 3D
//!                        λ = E ν / (1 − ν²)               plane stress: σ_zz = 0 eliminates ε_zz
//! ```
//!
//! With the λ of its model, one formula in the body's own axes serves all models.
//! Timoshenko & Goodier, Theory of Elasticity (1970), art. 11 and 84.

use nalgebra::{Matrix6, Vector3};

use super::orthotropic::{components, mandel};
use super::{Material, Model, Orthotropic};
use crate::error::Error;

/// Poisson's ratio from which volume change is averaged: 0.45, however that is stated and rounded.
const NEARLY_INCOMPRESSIBLE: f64 = 0.45 - 1e-9;

/// The stress of a strain at a point, within a model.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "one at a time, on the stack of who asks for a stress"
)]
pub(crate) enum Elasticity {
    /// `λ θ I + 2 μ ε`.
    Isotropic(Lame),
    /// `λ̂ θ I + R ε` (B14).
    Oriented {
        /// λ̂, in pascal.
        lambda: f64,
        /// R, in pascal and Mandel's form.
        rest: Matrix6<f64>,
    },
}

/// Lamé's constants of a material within a model, in pascal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lame {
    /// λ.
    pub lambda: f64,
    /// μ, the shear modulus.
    pub shear: f64,
}

impl Model {
    /// Depth of the body, in metre; 1 in plane strain and 3D, and of axisymmetric bodies, whose
    /// integrals go around the axis.
    #[must_use]
    pub const fn depth(self) -> f64 {
        match self {
            Self::PlaneStress { thickness } => thickness,
            Self::PlaneStrain | Self::Axisymmetric | Self::Solid => 1.0,
        }
    }

    /// 2 or 3.
    #[must_use]
    pub const fn dimension(self) -> usize {
        match self {
            Self::PlaneStrain | Self::PlaneStress { .. } | Self::Axisymmetric => 2,
            Self::Solid => 3,
        }
    }

    /// Checks the thickness.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] unless it is positive and finite.
    pub fn validate(self, place: &str) -> Result<(), Error> {
        check_positive(place, "thickness", self.depth(), "0 < thickness < infinity")
    }
}

impl Material {
    /// A material that neither expands nor weighs anything: Young's modulus in pascal, Poisson's ratio.
    #[must_use]
    pub const fn new(young: f64, poisson: f64) -> Self {
        Self {
            young,
            poisson,
            expansion: 0.0,
            density: 0.0,
            orthotropic: None,
        }
    }

    /// A material with directions that neither weighs anything nor has a Young's modulus or Poisson's ratio of its own.
    #[must_use]
    pub const fn oriented(constants: Orthotropic) -> Self {
        Self {
            orthotropic: Some(constants),
            ..Self::new(1.0, 0.0)
        }
    }

    /// The stress of a strain at a position, in metre.
    pub(crate) fn elasticity(&self, model: Model, position: Vector3<f64>) -> Elasticity {
        match &self.orthotropic {
            None => Elasticity::Isotropic(self.lame(model)),
            Some(constants) => {
                let (lambda, rest) = constants.split(model, position);
                Elasticity::Oriented { lambda, rest }
            }
        }
    }

    /// λ of the term that nearly incompressible cells average, in pascal.
    pub(crate) fn lambda(&self, model: Model) -> f64 {
        match &self.orthotropic {
            None => self.lame(model).lambda,
            Some(constants) => constants.moduli()[0],
        }
    }

    /// Whether a change of volume takes much more than one of shape.
    pub(crate) fn is_nearly_incompressible(&self) -> bool {
        const RATIO: f64 = 2.0 * NEARLY_INCOMPRESSIBLE / (1.0 - 2.0 * NEARLY_INCOMPRESSIBLE);
        match &self.orthotropic {
            None => self.poisson >= NEARLY_INCOMPRESSIBLE,
            Some(constants) => {
                let [lambda, shear] = constants.moduli();
                lambda >= RATIO * shear
            }
        }
    }

    /// Least Young's modulus, in pascal.
    pub(crate) fn softest(&self) -> f64 {
        match &self.orthotropic {
            None => self.young,
            Some(constants) => constants.young.into_iter().fold(f64::INFINITY, f64::min),
        }
    }

    /// Whether heat strains it.
    pub(crate) fn expands(&self) -> bool {
        match &self.orthotropic {
            None => self.expansion != 0.0,
            Some(constants) => constants.expansion != [0.0; 3],
        }
    }

    /// Strain of one kelvin in the order xx, yy, zz, yz, xz, xy.
    pub(crate) fn free_strain(&self, position: Vector3<f64>) -> [f64; 6] {
        match &self.orthotropic {
            None => {
                let alpha = self.expansion;
                [alpha, alpha, alpha, 0.0, 0.0, 0.0]
            }
            Some(constants) => constants.expansion(position),
        }
    }

    /// `σ : C⁻¹ : σ`, in J/m³; with the stress out of the plane it is the same in every model. Isotropic:
    /// `((1 + ν) s : s + (1 − 2ν) (tr σ)²/3)/E` with the deviator s.
    pub(crate) fn energy(&self, position: Vector3<f64>, stress: &[f64; 6]) -> f64 {
        if let Some(constants) = &self.orthotropic {
            return constants.energy(position, *stress);
        }
        let [xx, yy, zz, yz, xz, xy] = stress;
        let trace = xx + yy + zz;
        let normal = [xx, yy, zz].map(|s| (s - trace / 3.0).powi(2));
        let deviator = normal.iter().sum::<f64>() + 2.0 * (yz * yz + xz * xz + xy * xy);
        let Self { young, poisson, .. } = self;
        ((1.0 + poisson) * deviator + (1.0 - 2.0 * poisson) * trace * trace / 3.0) / young
    }

    /// Lamé's constants in a model.
    #[must_use]
    pub fn lame(&self, model: Model) -> Lame {
        let (young, poisson) = (self.young, self.poisson);
        let lambda = match model {
            Model::PlaneStress { .. } => young * poisson / (1.0 - poisson * poisson),
            Model::PlaneStrain | Model::Axisymmetric | Model::Solid => {
                young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
            }
        };
        let shear = young / (2.0 * (1.0 + poisson));
        Lame { lambda, shear }
    }

    /// Checks that the elastic energy is positive.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] unless `E > 0`, `-1 < ν < 0.5` and `ρ ≥ 0`, and α with them is finite.
    pub fn validate(&self, place: &str) -> Result<(), Error> {
        if let Some(constants) = &self.orthotropic {
            constants.validate(place)?;
        }
        check_positive(place, "young", self.young, "0 < young < infinity")?;
        if !(self.density >= 0.0 && self.density.is_finite()) {
            return Err(Error::OutOfRange {
                place: format!("{place}.density"),
                value: self.density,
                accepted: "0 <= density < infinity",
            });
        }
        if !self.expansion.is_finite() {
            return Err(Error::NotFinite {
                place: format!("{place}.expansion"),
                value: self.expansion,
            });
        }
        if self.poisson > -1.0 && self.poisson < 0.5 {
            return Ok(());
        }
        Err(Error::OutOfRange {
            place: format!("{place}.poisson"),
            value: self.poisson,
            accepted: "-1 < poisson < 0.5",
        })
    }
}

fn check_positive(
    place: &str,
    field: &str,
    value: f64,
    accepted: &'static str,
) -> Result<(), Error> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    let place = format!("{place}.{field}");
    Err(Error::OutOfRange {
        place,
        value,
        accepted,
    })
}

impl Elasticity {
    /// Stress of a strain with the dilatation given apart; all as in [`Lame::stress`].
    pub(crate) fn stress(&self, model: Model, strain: [f64; 6], theta: f64) -> [f64; 6] {
        match self {
            Self::Isotropic(lame) => lame.stress(model, strain, theta),
            Self::Oriented { lambda, rest } => {
                let mut stress = components(&(rest * mandel(strain)));
                for normal in &mut stress[..3] {
                    *normal += lambda * theta;
                }
                stress
            }
        }
    }
}

impl Lame {
    /// Stress of a strain with the dilatation `theta` given apart: `λ θ I + 2 μ ε`, in pascal;
    /// both in the order xx, yy, zz, yz, xz, xy, shear strains not doubled.
    ///
    /// Out of the plane the stress is `λ θ` in plane strain and zero in plane stress.
    #[must_use]
    pub fn stress(&self, model: Model, strain: [f64; 6], theta: f64) -> [f64; 6] {
        let mut stress = strain.map(|component| 2.0 * self.shear * component);
        for normal in &mut stress[..3] {
            *normal += self.lambda * theta;
        }
        if matches!(model, Model::PlaneStress { .. }) {
            stress[2] = 0.0;
        }
        stress
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATERIAL: Material = Material::new(10.0, 0.25);

    #[test]
    fn constants_of_a_quarter_poisson_material_are_equal() {
        // ν = 1/4: λ = μ = 0.4 E; in plane stress λ = E · 0.25 / 0.9375 = 4/15 E.
        let solid = MATERIAL.lame(Model::Solid);
        assert!((solid.lambda - 4.0).abs() < 1e-15 && (solid.shear - 4.0).abs() < 1e-15);
        let plate = MATERIAL.lame(Model::PlaneStress { thickness: 2.0 });
        assert!((plate.lambda - 8.0 / 3.0).abs() < 1e-15 && (plate.shear - 4.0).abs() < 1e-15);
    }

    #[test]
    fn uniaxial_stress_gives_youngs_modulus() {
        // ε = (1, −ν, −ν): σ = (E, 0, 0).
        let strain = [1.0, -0.25, -0.25, 0.0, 0.0, 0.0];
        let found = MATERIAL
            .lame(Model::Solid)
            .stress(Model::Solid, strain, 0.5);
        let expected = [10.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert!(
            found
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-14)
        );
        // In plane stress ε_zz takes no part: ε = (1, −ν) alone gives the same.
        let plate = Model::PlaneStress { thickness: 1.0 };
        let strain = [1.0, -0.25, 0.0, 0.0, 0.0, 0.0];
        let found = MATERIAL.lame(plate).stress(plate, strain, 0.75);
        assert!(
            found
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-14)
        );
    }

    #[test]
    fn materials_without_positive_energy_are_refused() {
        let refused = |young, poisson| Material::new(young, poisson).validate("m").is_err();
        assert!(!refused(1.0, 0.4999) && !refused(1.0, -0.9) && !refused(1.0, 0.0));
        assert!(refused(0.0, 0.3) && refused(-1.0, 0.3) && refused(f64::NAN, 0.3));
        assert!(refused(1.0, 0.5) && refused(1.0, -1.0) && refused(1.0, f64::NAN));
        assert!(refused(f64::INFINITY, 0.3));
    }

    #[test]
    fn a_plate_needs_a_thickness() {
        for thickness in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Model::PlaneStress { thickness }.validate("m").is_err());
        }
        assert!(Model::PlaneStress { thickness: 0.1 }.validate("m").is_ok());
    }
}
