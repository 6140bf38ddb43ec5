//! An elastic body: mesh, model, materials, supports and loads.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::bolt;
use super::{
    MeshSource, SceneBolt, SceneFoundation, SceneLoad, SceneMaterial, ScenePeriodic,
    SceneRigidGroup, SceneSupport, selection,
};
use crate::body;
use crate::body::{Body, Material, Mesh, Model};
use crate::error::Error;

/// An elastic body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a body")]
#[non_exhaustive]
pub struct SceneBody {
    /// Name for messages and reports.
    #[serde(default = "unnamed")]
    pub name: String,
    /// Where its mesh comes from.
    pub mesh: MeshSource,
    /// Plane strain, plane stress or axisymmetric, required in 2D; solid when left out in 3D.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub model: Option<SceneModel>,
    /// Its materials; together they cover every cell once.
    #[cfg_attr(feature = "cli", schemars(length(min = 1)))]
    pub materials: Vec<SceneMaterial>,
    /// Where its displacement is given.
    #[serde(default)]
    pub supports: Vec<SceneSupport>,
    /// Given forces, heat and initial stress.
    #[serde(default)]
    pub loads: Vec<SceneLoad>,
    /// More groups: each of all members of some groups of the mesh, to stand wherever a group stands.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub groups: BTreeMap<String, Vec<String>>,
    /// What the displacement of its cells is made of; `standard` when left out.
    #[serde(default, skip_serializing_if = "is_standard")]
    pub formulation: SceneFormulation,
    /// Springs that hold it to the ground.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub foundation: Vec<SceneFoundation>,
    /// Groups that move as rigid bodies, coupled to reference points.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rigid_groups: Vec<SceneRigidGroup>,
    /// Pairs of faces, where the body repeats.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub periodic: Vec<ScenePeriodic>,
    /// Bolts under preload.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bolts: Vec<SceneBolt>,
}

fn unnamed() -> String {
    "body".to_owned()
}

fn is_standard(formulation: &SceneFormulation) -> bool {
    *formulation == SceneFormulation::Standard
}

/// What the displacement of a cell is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum SceneFormulation {
    /// Of shape functions alone.
    #[default]
    Standard,
    /// For bending: quadrilaterals of four nodes and hexahedra of eight also have incompatible modes, with which a few
    /// through the depth bend as a beam does; other cells are as in `standard`.
    IncompatibleModes,
}

/// How strain and stress live in the body's dimension.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SceneModel {
    /// 2D, no strain out of the plane, one unit of length deep.
    PlaneStrain,
    /// 2D, no stress out of the plane.
    PlaneStress {
        /// Depth of the plate, `> 0`, in the unit of length.
        #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
        thickness: f64,
    },
    /// 2D, the section x = r, y = z of a body of revolution about the y axis; all forces are those
    /// of the whole circumference.
    Axisymmetric,
    /// 3D.
    Solid,
}

/// Models of a mesh in 2D.
const PLANE: &str = "plane_strain, plane_stress or axisymmetric for a mesh in 2D, or else a \
    mesh with cells of a solid (from Gmsh: `gmsh -3`, with the volume in a physical group)";

impl SceneBody {
    /// A body on a mesh from memory, from a file or from a generator, with nothing on it yet.
    #[must_use]
    pub fn new(name: &str, mesh: impl Into<MeshSource>) -> Self {
        Self {
            name: name.to_owned(),
            mesh: mesh.into(),
            model: None,
            materials: Vec::new(),
            supports: Vec::new(),
            loads: Vec::new(),
            groups: BTreeMap::new(),
            formulation: SceneFormulation::default(),
            foundation: Vec::new(),
            rigid_groups: Vec::new(),
            periodic: Vec::new(),
            bolts: Vec::new(),
        }
    }

    /// The body with a model, which one in 2D needs.
    #[must_use]
    pub fn with_model(mut self, model: SceneModel) -> Self {
        self.model = Some(model);
        self
    }

    /// The body with one more material.
    #[must_use]
    pub fn with_material(mut self, material: SceneMaterial) -> Self {
        self.materials.push(material);
        self
    }

    /// The body with one more support.
    #[must_use]
    pub fn with_support(mut self, support: SceneSupport) -> Self {
        self.supports.push(support);
        self
    }

    /// The body with one more load.
    #[must_use]
    pub fn with_load(mut self, load: SceneLoad) -> Self {
        self.loads.push(load);
        self
    }

    /// The body with cells that bend as beams do: quadrilaterals of four nodes and hexahedra of eight.
    #[must_use]
    pub fn with_incompatible_modes(mut self) -> Self {
        self.formulation = SceneFormulation::IncompatibleModes;
        self
    }

    /// The body with springs to the ground.
    #[must_use]
    pub fn with_foundation(mut self, foundation: SceneFoundation) -> Self {
        self.foundation.push(foundation);
        self
    }

    /// The body with a group that moves as a rigid body.
    #[must_use]
    pub fn with_rigid_group(mut self, group: SceneRigidGroup) -> Self {
        self.rigid_groups.push(group);
        self
    }

    /// The body with a pair of faces where it repeats.
    #[must_use]
    pub fn with_periodic(mut self, periodic: ScenePeriodic) -> Self {
        self.periodic.push(periodic);
        self
    }

    /// The body with one more bolt under preload.
    #[must_use]
    pub fn with_bolt(mut self, bolt: SceneBolt) -> Self {
        self.bolts.push(bolt);
        self
    }

    /// The body of this number in the terms of mechanics, of at most `room` nodes, and its bolts; mesh files are
    /// relative to `folder`. What was changed is added to `notes`.
    pub(super) fn resolve(
        &self,
        index: usize,
        folder: &Path,
        room: usize,
        notes: &mut Vec<String>,
    ) -> Result<(Body, Vec<bolt::Resolved>), Error> {
        let place = &format!("bodies[{index}]");
        let of_mesh = format!("{place}.mesh");
        let mut mesh = self.mesh.mesh(&of_mesh, folder, room)?;
        if matches!(self.mesh, MeshSource::File { .. }) {
            match mesh.turn_clockwise_cells() {
                0 => {}
                turned => notes.push(format!(
                    "{of_mesh}: {turned} cells ran clockwise, as of a surface drawn so, and were turned"
                )),
            }
        }
        self.join_groups(place, &mut mesh)?;
        let model = self.resolve_model(place, mesh.dimension)?;
        let bolts = self.resolve_bolts(index, &mut mesh, model)?;
        let (materials, material_of_cell) = self.resolve_materials(place, &mesh, model)?;
        let supports = (self.supports.iter().enumerate())
            .map(|(at, support)| support.resolve(format!("{place}.supports[{at}]"), &mesh, model))
            .collect::<Result<_, _>>()?;
        let mut loads = (self.loads.iter().enumerate())
            .map(|(at, load)| load.resolve(&format!("{place}.loads[{at}]"), folder, &mesh, model))
            .collect::<Result<Vec<_>, _>>()?;
        let foundation = (self.foundation.iter().enumerate())
            .map(|(at, springs)| springs.resolve(format!("{place}.foundation[{at}]"), &mesh))
            .collect::<Result<_, _>>()?;
        let mut ties = Vec::new();
        for (at, group) in self.rigid_groups.iter().enumerate() {
            let (tie, load) =
                group.resolve(&format!("{place}.rigid_groups[{at}]"), &mesh, model)?;
            ties.push(tie);
            loads.extend(load);
        }
        let cuts = bolt::cuts(&bolts);
        for (at, faces) in self.periodic.iter().enumerate() {
            ties.push(faces.resolve(&format!("{place}.periodic[{at}]"), &mesh, model, &cuts)?);
        }
        let body = Body {
            name: self.name.clone(),
            mesh,
            model,
            materials,
            material_of_cell,
            supports,
            loads,
            foundation,
            formulation: match self.formulation {
                SceneFormulation::Standard => body::Formulation::Standard,
                SceneFormulation::IncompatibleModes => body::Formulation::IncompatibleModes,
            },
            ties,
        };
        body::check(&body)?;
        body::prescribed(&body)?;
        Ok((body, bolts))
    }

    /// Cuts the mesh through all bolts, then finds their faces.
    fn resolve_bolts(
        &self,
        index: usize,
        mesh: &mut Mesh,
        model: Model,
    ) -> Result<Vec<bolt::Resolved>, Error> {
        let bolts = || {
            let places = (0..).map(|at| format!("bodies[{index}].bolts[{at}]"));
            places.zip(&self.bolts)
        };
        let faces = bolts().map(|(place, bolt)| bolt.cut(&place, mesh));
        let faces = faces.collect::<Result<Vec<_>, _>>()?;
        let resolved = bolts()
            .zip(&faces)
            .map(|((place, bolt), faces)| bolt.resolve(&place, (index, mesh, model), faces));
        resolved.collect()
    }

    /// Adds the groups that are made of others.
    fn join_groups(&self, place: &str, mesh: &mut Mesh) -> Result<(), Error> {
        let mut joined = Vec::new();
        for (name, members) in &self.groups {
            let place = format!("{place}.groups.{name}");
            if mesh.groups.contains_key(name) {
                return Err(Error::NotAccepted {
                    place,
                    found: format!("`{name}`, which the mesh has"),
                    accepted: "the name of a new group".to_owned(),
                });
            }
            joined.push((name.clone(), selection::union(mesh, &place, members)?));
        }
        mesh.groups.extend(joined);
        Ok(())
    }

    fn resolve_model(&self, place: &str, dimension: usize) -> Result<Model, Error> {
        let place = format!("{place}.model");
        let (found, accepted) = match (self.model, dimension) {
            (Some(SceneModel::PlaneStrain), 2) => return Ok(Model::PlaneStrain),
            (Some(SceneModel::Axisymmetric), 2) => return Ok(Model::Axisymmetric),
            (Some(SceneModel::PlaneStress { thickness }), 2) => {
                let model = Model::PlaneStress { thickness };
                model.validate(&format!("{place}.plane_stress"))?;
                return Ok(model);
            }
            (None | Some(SceneModel::Solid), 3) => return Ok(Model::Solid),
            (None, _) => ("nothing", PLANE),
            (Some(SceneModel::Solid), _) => ("solid", PLANE),
            (Some(_), _) => ("a plane model", "solid for a mesh in 3D"),
        };
        Err(Error::NotAccepted {
            place,
            found: found.to_owned(),
            accepted: accepted.to_owned(),
        })
    }

    /// The materials and the one of each cell.
    fn resolve_materials(
        &self,
        place: &str,
        mesh: &Mesh,
        model: Model,
    ) -> Result<(Vec<Material>, Vec<usize>), Error> {
        const NONE: usize = usize::MAX;
        let mut of_cell = vec![NONE; mesh.cell_count()];
        let mut materials = Vec::new();
        for (number, stated) in self.materials.iter().enumerate() {
            let place = format!("{place}.materials[{number}]");
            materials.push(stated.resolve(&place, model)?);
            let Some(group) = &stated.group else {
                if self.materials.len() == 1 {
                    of_cell.fill(number);
                    break;
                }
                return Err(Error::NotAccepted {
                    place,
                    found: "no group".to_owned(),
                    accepted: "a group of cells, as there are several materials".to_owned(),
                });
            };
            let place = format!("{place}.group");
            for cell in selection::cells(mesh, &place, group)? {
                selection::check_cell(mesh, &place, cell)?;
                if of_cell[cell] != NONE {
                    return Err(Error::NotAccepted {
                        place,
                        found: format!("cell {cell}, which has materials[{}]", of_cell[cell]),
                        accepted: "one material per cell".to_owned(),
                    });
                }
                of_cell[cell] = number;
            }
        }
        match of_cell.iter().position(|&number| number == NONE) {
            None => Ok((materials, of_cell)),
            Some(cell) => Err(Error::NotAccepted {
                place: format!("{place}.materials"),
                found: format!("no material for cell {cell}"),
                accepted: "one material per cell".to_owned(),
            }),
        }
    }
}
