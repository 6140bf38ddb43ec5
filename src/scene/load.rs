//! Loads: forces on surfaces, volumes and nodes, weight and spin, heat and initial stress.

use std::path::Path;

use serde::Serialize;

use super::SceneGroup;
use super::field::{SceneAffine, SceneAffineVector, SceneSpin, finite};
use super::heat::SceneTemperature;
use super::selection;
use super::selection::vector;
use crate::body::{Load, Mesh, Model, Wrench};
use crate::error::{Error, check_finite, check_length};

/// What acts on a body. Every kind may have a table of factors in `steps`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", schemars(untagged, deny_unknown_fields))]
#[serde(untagged)]
pub enum SceneLoad {
    /// Force per area along the inward normal.
    Pressure {
        /// Positive presses, in force per area.
        pressure: f64,
        /// Group of surface facets.
        group: SceneGroup,
    },
    /// Force per area.
    Traction {
        /// In global axes, one entry per axis, in force per area.
        traction: Vec<f64>,
        /// Group of surface facets.
        group: SceneGroup,
    },
    /// Force per volume.
    BodyForce {
        /// In global axes, one entry per axis, in force per volume.
        body_force: Vec<f64>,
        /// Group of cells; all cells when left out.
        #[serde(skip_serializing_if = "Option::is_none")]
        group: Option<SceneGroup>,
    },
    /// Force at a node.
    PointForce {
        /// In global axes, one entry per axis, in the unit of force (plane strain: per unit of depth).
        point_force: Vec<f64>,
        /// Position of the node, in the unit of length.
        at: Vec<f64>,
    },
    /// Force per area along the inward normal that varies with position, as under water.
    VaryingPressure {
        /// Positive presses, in force per area.
        pressure: SceneAffine,
        /// Group of surface facets.
        group: SceneGroup,
    },
    /// Force per area that varies with position.
    VaryingTraction {
        /// In global axes, in force per area.
        traction: SceneAffineVector,
        /// Group of surface facets.
        group: SceneGroup,
    },
    /// A force, a moment or both, spread as tractions over a group, which is free to deform.
    Spread {
        /// Total force in global axes, one entry per axis, in the unit of force (plane strain: per unit of
        /// depth; axisymmetric: along the axis, on the whole circumference).
        #[serde(skip_serializing_if = "Option::is_none")]
        force: Option<Vec<f64>>,
        /// Total moment: one entry about z in 2D, three in 3D. A torque about an axis is a moment along it,
        /// wherever the axis is.
        #[serde(skip_serializing_if = "Option::is_none")]
        moment: Option<Vec<f64>>,
        /// Where the force acts, in the unit of length; at the centre of the group's area when left out.
        #[serde(skip_serializing_if = "Option::is_none")]
        at: Option<Vec<f64>>,
        /// Group of surface facets.
        group: SceneGroup,
    },
    /// Weight, by the density of the materials.
    Gravity {
        /// Acceleration in global axes, one entry per axis, in length per time².
        gravity: Vec<f64>,
        /// Group of cells; all cells when left out.
        #[serde(skip_serializing_if = "Option::is_none")]
        group: Option<SceneGroup>,
    },
    /// Force away from the axis of a steady spin, by the density of the materials; a factor multiplies the
    /// force, not the speed.
    Centrifugal {
        /// The spin.
        centrifugal: SceneSpin,
        /// Group of cells; all cells when left out.
        #[serde(skip_serializing_if = "Option::is_none")]
        group: Option<SceneGroup>,
    },
    /// Heat, by the expansion of the materials.
    Temperature {
        /// Temperature above that at which the body is free of stress.
        temperature: SceneTemperature,
        /// Group of cells; all cells when left out.
        #[serde(skip_serializing_if = "Option::is_none")]
        group: Option<SceneGroup>,
    },
    /// Stress that is there before anything is displaced.
    InitialStress {
        /// In force per area and global axes: xx, yy, zz, yz, xz, xy in 3D; xx, yy, zz, xy in plane strain and
        /// of axisymmetric bodies, where zz is around the axis; xx, yy, xy in plane stress.
        initial_stress: Vec<f64>,
        /// Group of cells; all cells when left out.
        #[serde(skip_serializing_if = "Option::is_none")]
        group: Option<SceneGroup>,
    },
}

impl SceneLoad {
    /// Pressure on a group of facets, in force per area; positive into the body.
    #[must_use]
    pub fn pressure(group: &str, pressure: f64) -> Self {
        Self::Pressure {
            pressure,
            group: group.into(),
        }
    }

    /// Force per area on a group of facets, one entry per axis.
    #[must_use]
    pub fn traction(group: &str, traction: &[f64]) -> Self {
        Self::Traction {
            traction: traction.to_vec(),
            group: group.into(),
        }
    }

    /// Force per volume on all cells, one entry per axis.
    #[must_use]
    pub fn body_force(body_force: &[f64]) -> Self {
        Self::BodyForce {
            body_force: body_force.to_vec(),
            group: None,
        }
    }

    /// Weight of all cells under an acceleration, in length per time², one entry per axis.
    #[must_use]
    pub fn gravity(acceleration: &[f64]) -> Self {
        Self::Gravity {
            gravity: acceleration.to_vec(),
            group: None,
        }
    }

    /// One temperature of all cells, above that without stress.
    #[must_use]
    pub fn temperature(rise: f64) -> Self {
        Self::Temperature {
            temperature: SceneTemperature::Uniform(rise),
            group: None,
        }
    }

    /// A total force on a group of facets, one entry per axis, at the centre of its area.
    #[must_use]
    pub fn force(group: &str, force: &[f64]) -> Self {
        Self::Spread {
            force: Some(force.to_vec()),
            moment: None,
            at: None,
            group: group.into(),
        }
    }

    /// A total moment on a group of facets: one entry about z in 2D, three in 3D.
    #[must_use]
    pub fn moment(group: &str, moment: &[f64]) -> Self {
        Self::Spread {
            force: None,
            moment: Some(moment.to_vec()),
            at: None,
            group: group.into(),
        }
    }

    /// The load in the terms of mechanics; files are relative to `folder`.
    pub(super) fn resolve(
        &self,
        place: &str,
        folder: &Path,
        mesh: &Mesh,
        model: Model,
    ) -> Result<Load, Error> {
        let axes = mesh.dimension;
        let at = |field: &str| format!("{place}.{field}");
        let facets = |group: &SceneGroup| selection::facets(mesh, &at("group"), group);
        let cells = |group: &Option<SceneGroup>| match group {
            None => Ok((0..mesh.cell_count()).collect()),
            Some(group) => selection::cells(mesh, &at("group"), group),
        };
        match self {
            Self::Pressure { pressure, group } => {
                finite(at("pressure"), *pressure)?;
                Ok(Load::Pressure {
                    facets: facets(group)?,
                    pressure: *pressure,
                })
            }
            Self::Traction { traction, group } => Ok(Load::Traction {
                traction: vector(&at("traction"), traction, axes)?,
                facets: facets(group)?,
            }),
            Self::BodyForce { body_force, group } => Ok(Load::BodyForce {
                density: vector(&at("body_force"), body_force, axes)?,
                cells: cells(group)?,
            }),
            Self::PointForce {
                point_force,
                at: node,
            } => Ok(Load::PointForce {
                force: vector(&at("point_force"), point_force, axes)?,
                node: selection::node_at(mesh, &at("at"), node)?,
            }),
            Self::VaryingPressure { pressure, group } => Ok(Load::VaryingPressure {
                pressure: pressure.resolve(&at("pressure"), axes)?,
                facets: facets(group)?,
            }),
            Self::VaryingTraction { traction, group } => Ok(Load::VaryingTraction {
                traction: traction.resolve(&at("traction"), axes)?,
                facets: facets(group)?,
            }),
            Self::Spread {
                force,
                moment,
                at: on,
                group,
            } if model == Model::Axisymmetric && on.is_some() => Err(Error::NotAccepted {
                place: at("at"),
                found: "a point".to_owned(),
                accepted: "no `at`, as a ring carries its force all around".to_owned(),
            }),
            Self::Spread {
                force,
                moment,
                at: on,
                group,
            } => Ok(Load::Spread {
                wrench: wrench(place, [force, moment, on].map(Option::as_deref), model)?,
                facets: facets(group)?,
            }),
            Self::Gravity { gravity, .. }
                if model == Model::Axisymmetric && gravity.first().is_some_and(|g| *g != 0.0) =>
            {
                Err(Error::OutOfRange {
                    place: at("gravity[0]"),
                    value: gravity[0],
                    accepted: "0, for across the axis the weight of a ring is no load of a body of revolution",
                })
            }
            Self::Gravity { gravity, group } => Ok(Load::Gravity {
                acceleration: vector(&at("gravity"), gravity, axes)?,
                cells: cells(group)?,
            }),
            Self::Centrifugal { centrifugal, group } => {
                let ring = model == Model::Axisymmetric;
                let (axis, speed_squared) = centrifugal.resolve(&at("centrifugal"), axes, ring)?;
                Ok(Load::Centrifugal {
                    cells: cells(group)?,
                    axis,
                    speed_squared,
                })
            }
            Self::Temperature { temperature, group } => {
                temperature.resolve(&at("temperature"), folder, mesh, cells(group)?)
            }
            Self::InitialStress {
                initial_stress,
                group,
            } => Ok(Load::InitialStress {
                stress: stress(&at("initial_stress"), initial_stress, model)?,
                cells: cells(group)?,
            }),
        }
    }
}

/// Force, moment and place of a load that is spread.
pub(super) fn wrench(
    place: &str,
    [force, moment, on]: [Option<&[f64]>; 3],
    model: Model,
) -> Result<Wrench, Error> {
    let axes = model.dimension();
    let mut wrench = Wrench::default();
    if let Some(force) = force {
        wrench.force = vector(&format!("{place}.force"), force, axes)?;
    }
    if let Some(moment) = moment {
        let place = format!("{place}.moment");
        let entries = if axes == 2 { 1 } else { 3 };
        check_length(&place, entries, moment.len())?;
        check_finite(&place, moment)?;
        wrench.moment[3 - entries..].copy_from_slice(moment);
    }
    if let Some(on) = on {
        wrench.at = Some(vector(&format!("{place}.at"), on, axes)?);
    }
    Ok(wrench)
}

/// A stress in the order xx, yy, zz, yz, xz, xy from the components that a model has.
fn stress(place: &str, given: &[f64], model: Model) -> Result<[f64; 6], Error> {
    let components: &[usize] = match model {
        Model::Solid => &[0, 1, 2, 3, 4, 5],
        Model::PlaneStrain | Model::Axisymmetric => &[0, 1, 2, 5],
        Model::PlaneStress { .. } => &[0, 1, 5],
    };
    check_length(place, components.len(), given.len())?;
    check_finite(place, given)?;
    let mut stress = [0.0; 6];
    for (component, value) in components.iter().zip(given) {
        stress[*component] = *value;
    }
    Ok(stress)
}
