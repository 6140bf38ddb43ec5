//! Isotropic linear elasticity: `σ = λ tr ε I + 2 μ ε`; what heat and initial stress add is in
//! `prestress.rs`.
//!
//! ```text
//! μ = E / (2 (1 + ν)),   λ = E ν / ((1 + ν)(1 − 2 ν))     plane strain, 3D
//!                        λ = E ν / (1 − ν²)               plane stress: σ_zz = 0 eliminates ε_zz
//! ```
//!
//! With the λ of its model, one formula in the body's own axes serves all models.
//! Timoshenko & Goodier, Theory of Elasticity (1970), art. 11 and 84.

use super::{Material, Model};
use crate::error::Error;

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
        }
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
