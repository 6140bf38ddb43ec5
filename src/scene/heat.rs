//! Temperatures: one number, an affine function of position, or a table of nodes in a file.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Deserializer, Serialize, de};

use super::field::{Either, SceneAffine, finite};
use super::nodal_table;
use crate::body::{Load, Mesh};
use crate::error::{Error, check_finite, check_length};

/// How much warmer a body is than without stress.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", schemars(untagged))]
#[serde(untagged)]
pub enum SceneTemperature {
    /// The same everywhere.
    Uniform(f64),
    /// An affine function of position.
    Affine(SceneAffine),
    /// A value at every node.
    Table(NodalFile),
    /// Values that the calling code gives, one per node of the body's mesh.
    #[serde(skip_serializing)]
    #[cfg_attr(feature = "cli", schemars(skip))]
    Given(Vec<f64>),
}

/// A table of nodes in a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "an object with file")]
pub struct NodalFile {
    /// Text, relative to the scene's folder: a row per node with its position, in the scene's unit of length,
    /// and the value, separated by commas or blanks; `#` begins a remark.
    pub file: PathBuf,
}

/// The keys of a temperature that is no number.
#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an object with value and gradient, or with file"
)]
struct Keys {
    value: Option<f64>,
    gradient: Option<Vec<f64>>,
    at: Option<Vec<f64>>,
    file: Option<PathBuf>,
}

impl<'de> Deserialize<'de> for SceneTemperature {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        let keys: Keys = match Either::deserialize(source)? {
            Either::Plain(value) => return Ok(Self::Uniform(value)),
            Either::Object(keys) => keys,
        };
        match (keys.value, keys.gradient, keys.at, keys.file) {
            (Some(value), Some(gradient), at, None) => Ok(Self::Affine(SceneAffine {
                value,
                gradient,
                at,
            })),
            (None, None, None, Some(file)) => Ok(Self::Table(NodalFile { file })),
            _ => Err(de::Error::custom(
                "expected a number, `value` and `gradient` with or without `at`, or `file` alone",
            )),
        }
    }
}

impl SceneTemperature {
    /// The load on some cells.
    pub(super) fn resolve(
        &self,
        place: &str,
        folder: &Path,
        mesh: &Mesh,
        cells: Vec<usize>,
    ) -> Result<Load, Error> {
        let rise = match self {
            Self::Uniform(value) => {
                finite(place.to_owned(), *value)?;
                vec![*value; mesh.nodes.len()]
            }
            Self::Affine(affine) => {
                let affine = affine.resolve(place, mesh.dimension)?;
                mesh.nodes.iter().map(|x| affine.at(*x)).collect()
            }
            Self::Table(NodalFile { file }) => {
                let mut needed = vec![false; mesh.nodes.len()];
                for &cell in &cells {
                    super::selection::check_cell(mesh, place, cell)?;
                    for &node in mesh.cell(cell).nodes {
                        needed[node] = true;
                    }
                }
                let place = format!("{place}.file");
                let values = nodal_table::read(&place, &folder.join(file), mesh, &needed)?;
                let values = values.into_iter().zip(needed);
                values
                    .map(|(value, needed)| if needed { value } else { 0.0 })
                    .collect()
            }
            Self::Given(values) => {
                check_length(place, mesh.nodes.len(), values.len())?;
                check_finite(place, values)?;
                values.clone()
            }
        };
        Ok(Load::Temperature { cells, rise })
    }
}
