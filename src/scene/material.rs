//! Materials: isotropic, orthotropic, and where their axes point; `transverse.rs` has the transversely isotropic ones.

use serde::{Deserialize, Serialize};

use super::field::{SceneLine, is_zero, material_direction};
use super::{SceneGroup, SceneTransverse};
use crate::body::{Material, MaterialAxes, Model, Orthotropic};
use crate::error::Error;

/// A linear elastic material: isotropic by `young` and `poisson`, or else orthotropic or transversely isotropic.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", schemars(extend("oneOf" = [
    {"required": ["young", "poisson"]}, {"required": ["orthotropic"]}, {"required": ["transversely_isotropic"]}
])))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with young and poisson, orthotropic or transversely_isotropic"
)]
pub struct SceneMaterial {
    /// Group of cells; all cells when left out, which only a single material may do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub group: Option<SceneGroup>,
    /// Young's modulus `E > 0`, in force per area.
    #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub young: Option<f64>,
    /// Poisson's ratio, `-1 < ν < 0.5`.
    #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = -1, "exclusiveMaximum" = 0.5)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub poisson: Option<f64>,
    /// Constants of its own along three axes, as of wood.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orthotropic: Option<SceneOrthotropic>,
    /// Constants of its own along one direction, as of fibres in a resin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transversely_isotropic: Option<SceneTransverse>,
    /// Thermal expansion per unit of temperature, for loads by `temperature`; 0 when left out. With directions
    /// it stands beside their constants.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub expansion: f64,
    /// Mass per volume `ρ ≥ 0`, for loads by `gravity` and `centrifugal`; 0 when left out. Masses are
    /// consistent with the other units: with mm, N and s it is in t/mm³ (steel: 7.85e-9).
    #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
    #[serde(default, skip_serializing_if = "is_zero")]
    pub density: f64,
}

/// Engineering constants along the axes 1, 2, 3 of a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with young, poisson, shear and axes"
)]
pub struct SceneOrthotropic {
    /// Young's moduli `E1, E2, E3 > 0`, in force per area.
    pub young: [f64; 3],
    /// Poisson's ratios `ν12, ν13, ν23`: `ν12` is the contraction along 2 under a pull along 1, `|ν12| < √(E1/E2)`.
    pub poisson: [f64; 3],
    /// Shear moduli `G12, G13, G23 > 0`, in force per area.
    pub shear: [f64; 3],
    /// Thermal expansion along each axis, per unit of temperature.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expansion: Option<[f64; 3]>,
    /// Where the axes point; along x, y and z when left out. In an axisymmetric body x is radial, y along the
    /// axis and z around it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<SceneAxes>,
}

/// Axes of a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SceneAxes {
    /// Axis 1, then a vector that with it spans the plane of axes 1 and 2; any lengths but zero, in 2D of two or
    /// three entries.
    Directions([Vec<f64>; 2]),
    /// 1 radial, 2 around and 3 along a line.
    Cylinder(SceneLine),
}

impl SceneMaterial {
    /// A material of all cells: Young's modulus in force per area, Poisson's ratio.
    #[must_use]
    pub fn new(young: f64, poisson: f64) -> Self {
        Self {
            group: None,
            young: Some(young),
            poisson: Some(poisson),
            orthotropic: None,
            transversely_isotropic: None,
            expansion: 0.0,
            density: 0.0,
        }
    }

    /// An orthotropic material of all cells.
    #[must_use]
    pub fn orthotropic(constants: SceneOrthotropic) -> Self {
        Self {
            young: None,
            poisson: None,
            orthotropic: Some(constants),
            ..Self::new(0.0, 0.0)
        }
    }

    /// The same with a thermal expansion, per unit of temperature.
    #[must_use]
    pub fn with_expansion(mut self, expansion: f64) -> Self {
        self.expansion = expansion;
        self
    }

    /// The same with a mass per volume.
    #[must_use]
    pub fn with_density(mut self, density: f64) -> Self {
        self.density = density;
        self
    }

    /// The same for a group of cells only.
    #[must_use]
    pub fn of(mut self, group: &str) -> Self {
        self.group = Some(group.into());
        self
    }

    /// The material in the terms of mechanics.
    pub(super) fn resolve(&self, place: &str, model: Model) -> Result<Material, Error> {
        let wrong = |found: &str| {
            Err(Error::NotAccepted {
                place: place.to_owned(),
                found: found.to_owned(),
                accepted: "`young` and `poisson`, or `orthotropic`, or `transversely_isotropic`"
                    .to_owned(),
            })
        };
        let (constants, field) = match (
            self.young,
            self.poisson,
            &self.orthotropic,
            &self.transversely_isotropic,
        ) {
            (Some(young), Some(poisson), None, None) => {
                let material = Material {
                    expansion: self.expansion,
                    density: self.density,
                    ..Material::new(young, poisson)
                };
                material.validate(place)?;
                return Ok(material);
            }
            (None, None, Some(stated), None) => (stated.resolve(place, model)?, "orthotropic"),
            (None, None, None, Some(stated)) => {
                (stated.resolve(place, model)?, "transversely_isotropic")
            }
            (Some(_), None, None, None) => return wrong("`young` without `poisson`"),
            (None, Some(_), None, None) => return wrong("`poisson` without `young`"),
            (None, None, None, None) => return wrong("no constants"),
            _ => return wrong("more than one of them"),
        };
        if self.expansion != 0.0 {
            return Err(Error::NotAccepted {
                place: format!("{place}.expansion"),
                found: self.expansion.to_string(),
                accepted: format!("that of each direction, within {field}"),
            });
        }
        constants.check_plane(&format!("{place}.{field}"), model)?;
        let material = Material {
            density: self.density,
            ..Material::oriented(constants)
        };
        material.validate(place)?;
        Ok(material)
    }
}

impl SceneOrthotropic {
    fn resolve(&self, place: &str, model: Model) -> Result<Orthotropic, Error> {
        let place = format!("{place}.orthotropic");
        let axes = match &self.axes {
            None => MaterialAxes::GLOBAL,
            Some(axes) => axes.resolve(&format!("{place}.axes"), model)?,
        };
        let constants = Orthotropic {
            young: self.young,
            poisson: self.poisson,
            shear: self.shear,
            expansion: self.expansion.unwrap_or_default(),
            axes,
        };
        constants.validate(&place)?;
        Ok(constants)
    }
}

impl SceneAxes {
    fn resolve(&self, place: &str, model: Model) -> Result<MaterialAxes, Error> {
        match self {
            Self::Cylinder(line) => Ok(MaterialAxes::Around(
                line.resolve(&format!("{place}.cylinder"), model)?,
            )),
            Self::Directions([first, second]) => {
                let place = format!("{place}.directions");
                let first = material_direction(&format!("{place}[0]"), first, model)?;
                let second = material_direction(&format!("{place}[1]"), second, model)?;
                match MaterialAxes::spanned(first, second) {
                    Some(axes) => Ok(axes),
                    None => Err(Error::NotAccepted {
                        place,
                        found: format!("{first:?} and {second:?}, which are parallel"),
                        accepted: "two directions that span the plane of the axes 1 and 2"
                            .to_owned(),
                    }),
                }
            }
        }
    }
}
