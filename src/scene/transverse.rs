//! Materials that are the same in all directions across one, as fibres in a resin.

use serde::{Deserialize, Serialize};

use super::field::{SceneLine, is_zero, material_direction};
use crate::body::{MaterialAxes, Model, Orthotropic};
use crate::error::Error;

/// Engineering constants of a material that is the same in all directions across one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with young_along, young_across, poisson_along, poisson_across, shear_along and along"
)]
pub struct SceneTransverse {
    /// Young's modulus along the direction, in force per area.
    #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
    pub young_along: f64,
    /// Young's modulus across it, in force per area.
    #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
    pub young_across: f64,
    /// Contraction across under a pull along the direction.
    pub poisson_along: f64,
    /// Contraction across under a pull across.
    pub poisson_across: f64,
    /// Shear modulus of planes that hold the direction, in force per area; across it is `E/(2 (1 + ν))`.
    #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
    pub shear_along: f64,
    /// Thermal expansion along the direction, per unit of temperature; 0 when left out.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub expansion_along: f64,
    /// Thermal expansion across it; 0 when left out.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub expansion_across: f64,
    /// The direction: a vector, or `radial`, `around` or `axial` with respect to `cylinder` (of an axisymmetric
    /// body: to its own axis).
    pub along: SceneAlong,
    /// The line that `radial`, `around` and `axial` refer to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cylinder: Option<SceneLine>,
}

/// A direction of a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    untagged,
    expecting = "a direction in brackets, \"radial\", \"around\" or \"axial\""
)]
pub enum SceneAlong {
    /// With respect to a line.
    Around(CylindricalAxis),
    /// In global axes, of any length but zero; in 2D of two or three entries.
    Direction(Vec<f64>),
}

/// An axis of cylindrical coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum CylindricalAxis {
    /// Away from the line.
    Radial,
    /// Around the line.
    Around,
    /// Along the line.
    Axial,
}

impl SceneTransverse {
    fn check(&self, place: &str) -> Result<(), Error> {
        for (field, value) in [
            ("young_along", self.young_along),
            ("young_across", self.young_across),
            ("shear_along", self.shear_along),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::OutOfRange {
                    place: format!("{place}.{field}"),
                    value,
                    accepted: "a modulus > 0 and finite",
                });
            }
        }
        let most = (self.young_along / self.young_across).sqrt();
        let ratios = [
            ("poisson_across", self.poisson_across, 1.0),
            (
                "poisson_along",
                self.poisson_along,
                most * ((1.0 - self.poisson_across) / 2.0).sqrt(),
            ),
        ];
        for (field, value, most) in ratios {
            if value.is_nan() || value.abs() >= most {
                return Err(Error::NotAccepted {
                    place: format!("{place}.{field}"),
                    found: value.to_string(),
                    accepted: format!(
                        "a ratio between ±{most:.4}: |poisson_across| < 1 and |poisson_along| < √(young_along \
                         (1 − poisson_across)/(2 young_across))"
                    ),
                });
            }
        }
        Ok(())
    }

    pub(super) fn resolve(&self, place: &str, model: Model) -> Result<Orthotropic, Error> {
        let place = format!("{place}.transversely_isotropic");
        self.check(&place)?;
        let across = self.young_across;
        // The direction is axis `at`; the other two are alike.
        let (at, axes) = self.axes(&place, model)?;
        let pick = |along: f64, across: f64| {
            std::array::from_fn(|axis| if axis == at { along } else { across })
        };
        let backward = self.poisson_along * across / self.young_along;
        let pairs = [(0, 1), (0, 2), (1, 2)];
        let constants = Orthotropic {
            young: pick(self.young_along, across),
            poisson: pairs.map(|(i, j)| match (i == at, j == at) {
                (true, _) => self.poisson_along,
                (_, true) => backward,
                _ => self.poisson_across,
            }),
            shear: pairs.map(|(i, j)| match i == at || j == at {
                true => self.shear_along,
                false => across / (2.0 * (1.0 + self.poisson_across)),
            }),
            expansion: pick(self.expansion_along, self.expansion_across),
            axes,
        };
        constants.validate(&place)?;
        Ok(constants)
    }

    /// The axes of the material, and which of them is the direction.
    fn axes(&self, place: &str, model: Model) -> Result<(usize, MaterialAxes), Error> {
        let ring = model == Model::Axisymmetric;
        let wrong = |found: &str, accepted: &str| {
            Err(Error::NotAccepted {
                place: format!("{place}.cylinder"),
                found: found.to_owned(),
                accepted: accepted.to_owned(),
            })
        };
        match (&self.along, &self.cylinder) {
            (SceneAlong::Direction(along), None) => {
                let along = material_direction(&format!("{place}.along"), along, model)?;
                // Any direction will do for axis 2 but its own.
                let least = (0..3).min_by(|a, b| along[*a].abs().total_cmp(&along[*b].abs()));
                let mut beside = [0.0; 3];
                // In 2D the axis out of the plane is one of the material's.
                let plane = model.dimension() == 2 && along[2] == 0.0;
                beside[if plane { 2 } else { least.unwrap_or_default() }] = 1.0;
                let axes = MaterialAxes::spanned(along, beside).unwrap_or(MaterialAxes::GLOBAL);
                Ok((0, axes))
            }
            (SceneAlong::Direction(_), Some(_)) => {
                wrong("a line", "nothing beside a direction in brackets")
            }
            (SceneAlong::Around(_), Some(_)) if ring => wrong(
                "a line",
                "nothing, for an axisymmetric body has its own axis",
            ),
            (SceneAlong::Around(axis), None) if ring => {
                let at = [
                    CylindricalAxis::Radial,
                    CylindricalAxis::Axial,
                    CylindricalAxis::Around,
                ];
                Ok((
                    at.iter().position(|one| one == axis).unwrap_or_default(),
                    MaterialAxes::GLOBAL,
                ))
            }
            (SceneAlong::Around(_), None) => wrong(
                "nothing",
                "the line of the cylinder: point, and in 3D direction",
            ),
            (SceneAlong::Around(axis), Some(stated)) => {
                let line = stated.resolve(&format!("{place}.cylinder"), model)?;
                Ok((*axis as usize, MaterialAxes::Around(line)))
            }
        }
    }
}
