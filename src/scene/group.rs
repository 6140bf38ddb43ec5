//! A group of a mesh by its name, or several taken together.

use std::ops::Deref;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Name of a group, or a list of names of groups of one kind: all members of all of them.
///
/// ```
/// use dpana::scene::{SceneGroup, SceneLoad};
///
/// let load: SceneLoad = serde_json::from_str(r#"{"pressure": 2, "group": ["left", "right"]}"#).unwrap();
/// let group = SceneGroup::from(["left", "right"]);
/// assert_eq!(load, SceneLoad::Pressure { pressure: 2.0, group });
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneGroup(Vec<String>);

/// What stands in JSON.
#[derive(Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(untagged, expecting = "the name of a group, or a list of names")]
enum Names {
    /// One group.
    One(String),
    /// Several, of one kind.
    Several(#[cfg_attr(feature = "cli", schemars(length(min = 1)))] Vec<String>),
}

impl Deref for SceneGroup {
    type Target = [String];

    fn deref(&self) -> &[String] {
        &self.0
    }
}

impl From<String> for SceneGroup {
    fn from(name: String) -> Self {
        Self(vec![name])
    }
}

impl From<&str> for SceneGroup {
    fn from(name: &str) -> Self {
        name.to_owned().into()
    }
}

impl From<Vec<String>> for SceneGroup {
    fn from(names: Vec<String>) -> Self {
        Self(names)
    }
}

impl<const COUNT: usize> From<[&str; COUNT]> for SceneGroup {
    fn from(names: [&str; COUNT]) -> Self {
        Self(names.map(str::to_owned).to_vec())
    }
}

impl Serialize for SceneGroup {
    fn serialize<S: Serializer>(&self, sink: S) -> Result<S::Ok, S::Error> {
        match self.0.as_slice() {
            [one] => one.serialize(sink),
            several => several.serialize(sink),
        }
    }
}

impl<'de> Deserialize<'de> for SceneGroup {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        Ok(match Names::deserialize(source)? {
            Names::One(name) => name.into(),
            Names::Several(names) => Self(names),
        })
    }
}

#[cfg(feature = "cli")]
impl schemars::JsonSchema for SceneGroup {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "SceneGroup".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Names::json_schema(generator)
    }
}
