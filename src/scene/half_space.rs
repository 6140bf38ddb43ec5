//! A scene of half-spaces: materials, grid, shape of the gap, and what presses and drags.
//!
//! ```text
//! half_space  material, other, grid, surroundings
//! surface     shapes whose gaps add up: rigid bodies, random surfaces, height maps
//! friction, load or approach, shift or force, or steps of these
//! ```
//!
//! The gap counts from where the surfaces first touch. A step keeps what it does not name, and slip
//! counts from the step before.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Deserialize;

use super::height_map::{HeightMap, unit_in_metres};
use super::{json, read};
use crate::error::{Error, check_finite};
use crate::half_space::{
    Creepage, Drag, ElasticHalf, Grid, HalfSpace, HalfSpaceProblem, Press, SelfAffine, Surroundings,
};

/// Most lengths of the grid that a gap outside of a punch is: nothing touches there.
const FAR: f64 = 10.0;

/// A scene of one half-space on a rigid body, or of two.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a scene of half-spaces")]
pub struct HalfSpaceScene {
    /// Where editors find the schema of scenes; not read.
    #[serde(default, rename = "$schema")]
    pub schema: Option<String>,
    /// Anything the author wants to say; not read.
    #[serde(default)]
    pub comment: Option<String>,
    /// Shown in reports.
    #[serde(default)]
    pub title: String,
    /// Label of the units: shown in reports, never used to convert.
    #[serde(default)]
    pub units: String,
    /// The elastic bodies and the grid.
    pub half_space: SceneHalfSpace,
    /// Shapes between the bodies; their gaps add up. None: two planes.
    #[serde(default)]
    pub surface: Vec<SceneSurfaceShape>,
    /// Coefficient of friction, `μ ≥ 0`.
    #[serde(default)]
    pub friction: f64,
    /// Force that presses, in N; what stands here holds before the first of the steps.
    pub load: Option<f64>,
    /// Approach, in metre.
    pub approach: Option<f64>,
    /// Shift of the other side along x and y, in metre.
    pub shift: Option<[f64; 2]>,
    /// Force on the half-space along x and y, in N.
    pub force: Option<[f64; 2]>,
    /// A history.
    #[serde(default)]
    pub steps: Vec<SceneDrive>,
    /// Steady rolling along x under the last step, instead of a shift.
    pub rolling: Option<SceneRolling>,
    /// Residual that counts as solved, from 1e-15 to 1e-2; 1e-10 if left out.
    pub tolerance: Option<f64>,
    /// File that the scene came from.
    #[serde(skip)]
    pub source: PathBuf,
}

/// Materials, grid and surroundings.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a half-space")]
pub struct SceneHalfSpace {
    /// Material of the half-space.
    pub material: SceneHalf,
    /// That of the other one; a rigid body if left out.
    pub other: Option<SceneHalf>,
    /// Cells along x and y.
    pub cells: [usize; 2],
    /// Sides of the grid, in metre; along y 1 for a plane, whose forces are per metre.
    pub size: [f64; 2],
    /// `free` if left out, `periodic` or `plane`.
    #[serde(default)]
    pub surroundings: SceneSurroundings,
}

/// Young's modulus, in Pa, and Poisson's ratio.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a material")]
pub struct SceneHalf {
    /// Young's modulus `> 0`, in Pa.
    pub young: f64,
    /// Poisson's ratio, from 0 to 0.5.
    pub poisson: f64,
}

/// What lies around the grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum SceneSurroundings {
    /// A free surface.
    #[default]
    Free,
    /// The same again and again.
    Periodic,
    /// A half-plane: strips without end along y.
    Plane,
}

/// One shape; lengths in metre.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SceneSurfaceShape {
    /// A rigid sphere on the middle of the grid.
    Sphere {
        /// Radius `> 0`.
        radius: f64,
    },
    /// `x²/2R_x + y²/2R_y`; a radius left out is infinite.
    Paraboloid {
        /// R_x.
        radius_x: Option<f64>,
        /// R_y.
        radius_y: Option<f64>,
    },
    /// A flat punch, round.
    FlatPunch {
        /// Radius `> 0`.
        radius: f64,
    },
    /// A cone.
    Cone {
        /// Slope of its side against the surface, `> 0`.
        slope: f64,
    },
    /// A random self-affine surface.
    SelfAffine {
        /// Hurst exponent, 0 to 1.
        hurst: f64,
        /// Longest wave of the power law.
        roll_off: f64,
        /// Shortest wave, at least two cells.
        cut_off: f64,
        /// Root mean square slope.
        slope: f64,
        /// Number of the sample.
        #[serde(default)]
        seed: u64,
    },
    /// Heights of the half-space's surface from a file beside the scene.
    HeightMap {
        /// `.npy`, `.csv` or text of a profilometer.
        file: String,
        /// Lengths of the scene per unit of the file; 1 if left out.
        scale: Option<f64>,
        /// Unit of length of the scene, such as `mm`: for files that name theirs.
        unit: Option<String>,
    },
}

/// What presses and drags: one of the first two, at most one of the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a step")]
pub struct SceneDrive {
    /// Force that presses, in N.
    pub load: Option<f64>,
    /// Approach, in metre.
    pub approach: Option<f64>,
    /// Shift of the other side along x and y, in metre.
    pub shift: Option<[f64; 2]>,
    /// Force on the half-space along x and y, in N.
    pub force: Option<[f64; 2]>,
}

/// Steady rolling.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "an object of creepages")]
pub struct SceneRolling {
    /// Creepage along x and y.
    #[serde(default)]
    pub creepage: [f64; 2],
    /// Spin, in 1/m.
    #[serde(default)]
    pub spin: f64,
}

/// A scene in the terms of the half-space.
#[derive(Clone, Debug)]
pub struct HalfSpaceHistory {
    /// The problem of the first step.
    pub problem: HalfSpaceProblem,
    /// What presses and drags in every step; at least one.
    pub steps: Vec<(Press, Drag)>,
    /// Rolling under the last of them.
    pub rolling: Option<Creepage>,
    /// Residual that counts as solved.
    pub tolerance: f64,
}

impl HalfSpaceScene {
    /// Reads a scene from JSON text; `file` stands for it in messages, and height maps are relative
    /// to its folder.
    ///
    /// # Errors
    ///
    /// [`Error::Json`] with line, column and path.
    pub fn from_json(text: &str, file: impl AsRef<Path>) -> Result<Self, Error> {
        let file = file.as_ref();
        let mut scene: Self = json::parse(text, &file.display().to_string())?;
        scene.source = file.to_owned();
        Ok(scene)
    }

    /// Reads a scene from a JSON file.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], and those of [`HalfSpaceScene::from_json`].
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let bytes = read("scene", path)?;
        Self::from_json(&String::from_utf8_lossy(&bytes), path)
    }

    /// Whether a file holds such a scene, right or wrong: an object with a `half_space`.
    #[must_use]
    pub fn is_in(path: &Path) -> bool {
        let text = read("scene", path).unwrap_or_default();
        let value: serde_json::Value = serde_json::from_slice(&text).unwrap_or_default();
        value.get("half_space").is_some()
    }

    /// Checks every value, reads the height maps and makes the operator.
    ///
    /// # Errors
    ///
    /// Whatever is wrong, with its place.
    pub fn history(&self) -> Result<HalfSpaceHistory, Error> {
        let named = |error: Error| match self.source.as_os_str().is_empty() {
            true => error,
            false => error.within(self.source.display()),
        };
        self.build().map_err(named)
    }

    fn build(&self) -> Result<HalfSpaceHistory, Error> {
        let SceneHalfSpace { cells, size, .. } = self.half_space;
        if self.half_space.surroundings == SceneSurroundings::Plane && size[1] != 1.0 {
            return Err(Error::NotAccepted {
                place: "half_space.size[1]".to_owned(),
                found: size[1].to_string(),
                accepted: "1 for a plane, whose forces are per metre along y".to_owned(),
            });
        }
        let spacing = [0, 1].map(|axis| size[axis] / cells[axis].max(1) as f64);
        let grid = Grid::new(cells, spacing)?;
        let half = |half: SceneHalf| ElasticHalf {
            young: half.young,
            poisson: half.poisson,
        };
        let surroundings = match self.half_space.surroundings {
            SceneSurroundings::Free => Surroundings::Free,
            SceneSurroundings::Periodic => Surroundings::Periodic,
            SceneSurroundings::Plane => Surroundings::Plane,
        };
        let (material, other) = (
            half(self.half_space.material),
            self.half_space.other.map(half),
        );
        let operator = Arc::new(HalfSpace::new(grid, surroundings, material, other)?);
        let steps = self.drives()?;
        if self.rolling.is_some() && steps.iter().any(|step| step.1 != Drag::Shift([0.0; 2])) {
            return Err(Error::NotAccepted {
                place: "rolling".to_owned(),
                found: "a shift or a force beside it".to_owned(),
                accepted: "creepage and spin alone, which take their place".to_owned(),
            });
        }
        let gap = self.gap(&grid)?;
        let problem = HalfSpaceProblem::new(operator, gap, &[self.friction], steps[0].0)?;
        for (press, drag) in &steps {
            problem.clone().pressed(*press)?.dragged(*drag)?;
        }
        Ok(HalfSpaceHistory {
            problem,
            steps,
            rolling: self.rolling.map(|rolling| Creepage {
                along: rolling.creepage,
                spin: rolling.spin,
            }),
            tolerance: self.tolerance.unwrap_or(1e-10),
        })
    }

    /// What presses and drags in every step.
    pub(crate) fn drives(&self) -> Result<Vec<(Press, Drag)>, Error> {
        let mut now = (None, Drag::Shift([0.0; 2]));
        let mut found = Vec::new();
        let drive = SceneDrive {
            load: self.load,
            approach: self.approach,
            shift: self.shift,
            force: self.force,
        };
        let first = [("scene".to_owned(), drive)];
        let later = self.steps.iter().enumerate();
        let later = later.map(|(at, drive)| (format!("steps[{at}]"), *drive));
        let only = self.steps.is_empty();
        for (place, drive) in first.into_iter().chain(later) {
            let whole = only || place != "scene";
            now = drive.after(&place, now)?;
            match now.0 {
                Some(press) if whole => found.push((press, now.1)),
                Some(_) => {}
                None if whole => {
                    return Err(Error::NotAccepted {
                        place,
                        found: "neither `load` nor `approach`".to_owned(),
                        accepted: "one of them".to_owned(),
                    });
                }
                None => {}
            }
        }
        Ok(found)
    }

    /// Gap of every cell from first touch on, in metre.
    fn gap(&self, grid: &Grid) -> Result<Vec<f64>, Error> {
        let mut gap = vec![0.0; grid.len()];
        for (at, shape) in self.surface.iter().enumerate() {
            let place = format!("surface[{at}]");
            let more = self.shape_gap(&place, shape, grid)?;
            gap.iter_mut()
                .zip(&more)
                .for_each(|(gap, more)| *gap += more);
        }
        let least = gap.iter().fold(f64::INFINITY, |least, gap| least.min(*gap));
        gap.iter_mut().for_each(|gap| *gap -= least);
        Ok(gap)
    }

    fn shape_gap(
        &self,
        place: &str,
        shape: &SceneSurfaceShape,
        grid: &Grid,
    ) -> Result<Vec<f64>, Error> {
        let positive = |field: &str, value: f64| match value > 0.0 && value.is_finite() {
            true => Ok(value),
            false => Err(Error::OutOfRange {
                place: format!("{place}.{field}"),
                value,
                accepted: "a number > 0",
            }),
        };
        let far = FAR * self.half_space.size[0].max(self.half_space.size[1]);
        Ok(match shape {
            SceneSurfaceShape::Sphere { radius } => {
                let radius = positive("radius", *radius)?;
                grid.sample(|[x, y]| {
                    let square = x * x + y * y;
                    let height = (radius * radius - square).max(0.0).sqrt();
                    square / (radius + height)
                })
            }
            SceneSurfaceShape::Paraboloid { radius_x, radius_y } => {
                let curvature = |field: &str, radius: &Option<f64>| match radius {
                    Some(radius) => positive(field, *radius).map(|radius| 0.5 / radius),
                    None => Ok(0.0),
                };
                let along = [
                    curvature("radius_x", radius_x)?,
                    curvature("radius_y", radius_y)?,
                ];
                grid.sample(|[x, y]| along[0] * x * x + along[1] * y * y)
            }
            SceneSurfaceShape::FlatPunch { radius } => {
                let radius = positive("radius", *radius)?;
                grid.sample(|[x, y]| if x.hypot(y) < radius { 0.0 } else { far })
            }
            SceneSurfaceShape::Cone { slope } => {
                let slope = positive("slope", *slope)?;
                grid.sample(|[x, y]| slope * x.hypot(y))
            }
            SceneSurfaceShape::SelfAffine {
                hurst,
                roll_off,
                cut_off,
                slope,
                seed,
            } => {
                let surface = SelfAffine {
                    hurst: *hurst,
                    roll_off: *roll_off,
                    cut_off: *cut_off,
                    slope: *slope,
                    seed: *seed,
                };
                let heights = surface.heights(grid).map_err(|error| error.within(place))?;
                heights.iter().map(|height| -height).collect()
            }
            SceneSurfaceShape::HeightMap { file, scale, unit } => {
                self.heights(place, file, (*scale, unit.as_deref()))?
            }
        })
    }

    /// Gap of a height map, in lengths of the scene.
    fn heights(
        &self,
        place: &str,
        file: &str,
        (scale, unit): (Option<f64>, Option<&str>),
    ) -> Result<Vec<f64>, Error> {
        let scale = scale.unwrap_or(1.0);
        check_finite(&format!("{place}.scale"), &[scale])?;
        let path = self.source.parent().unwrap_or(Path::new("")).join(file);
        let place = format!("{place}.file");
        let map = HeightMap::read(&place, &path, &read(&place, &path)?)?;
        let refuse = |found: String, accepted: String| Error::NotAccepted {
            place: place.clone(),
            found,
            accepted,
        };
        if map.cells != self.half_space.cells {
            let [columns, rows] = self.half_space.cells;
            let [found, in_rows] = map.cells;
            let accepted = format!("{rows} rows of {columns}, as `half_space.cells` says");
            return Err(refuse(
                format!("a map of {in_rows} rows of {found} heights"),
                accepted,
            ));
        }
        let metres = match unit {
            None if map.unit.is_some() || map.size.is_some() => {
                let accepted = "`unit`, the unit of length of the scene, such as `mm`".to_owned();
                return Err(refuse("a map with units of its own".to_owned(), accepted));
            }
            None => 1.0,
            Some(unit) if map.unit.is_none() && map.size.is_none() => {
                let accepted = "`scale` alone, as the file names no unit".to_owned();
                return Err(refuse(format!("unit `{unit}`"), accepted));
            }
            Some(unit) => unit_in_metres(unit).ok_or_else(|| {
                refuse(
                    format!("unit `{unit}`"),
                    "m, cm, mm, um, nm, pm or A".to_owned(),
                )
            })?,
        };
        for (axis, size) in map.size.iter().flatten().enumerate() {
            let (found, expected) = (size / metres, self.half_space.size[axis]);
            if (found - expected).abs() > 1e-3 * expected {
                let accepted = format!("{expected}, as `half_space.size[{axis}]` says");
                return Err(refuse(format!("a map with a side of {found}"), accepted));
            }
        }
        let factor = scale * map.unit.map_or(1.0, |of_file| of_file / metres);
        Ok(map.heights.iter().map(|height| -factor * height).collect())
    }
}

impl SceneDrive {
    /// What presses and drags after a step, of what did before it.
    fn after(
        &self,
        place: &str,
        (press, drag): (Option<Press>, Drag),
    ) -> Result<(Option<Press>, Drag), Error> {
        let both = |one: &str, other: &str| Error::NotAccepted {
            place: place.to_owned(),
            found: format!("both `{one}` and `{other}`"),
            accepted: "one of them".to_owned(),
        };
        let press = match (self.load, self.approach) {
            (Some(_), Some(_)) => return Err(both("load", "approach")),
            (Some(load), None) => Some(Press::Load(load)),
            (None, Some(approach)) => Some(Press::Approach(approach)),
            (None, None) => press,
        };
        let drag = match (self.shift, self.force) {
            (Some(_), Some(_)) => return Err(both("shift", "force")),
            (Some(shift), None) => Drag::Shift(shift),
            (None, Some(force)) => Drag::Force(force),
            (None, None) => drag,
        };
        Ok((press, drag))
    }
}
