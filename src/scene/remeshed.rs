//! The same scene on other meshes.

use std::path::Path;

use super::mesh_source::MOST_NODES;
use super::{MeshSource, Scene};
use crate::error::Error;

impl Scene {
    /// The scene with so many times the cells along every edge, at least one; none where a mesh is
    /// not generated.
    #[must_use]
    pub fn refined(&self, factor: f64) -> Option<Self> {
        let more = |cells: &mut usize| *cells = ((*cells as f64 * factor).round() as usize).max(1);
        let mut scene = self.clone();
        for body in &mut scene.bodies {
            match &mut body.mesh {
                MeshSource::Rectangle { rectangle } => rectangle.cells.iter_mut().for_each(more),
                MeshSource::Box { solid } => solid.cells.iter_mut().for_each(more),
                MeshSource::File { .. } | MeshSource::Given(_) => return None,
            }
        }
        Some(scene)
    }

    /// The scene with every cell of every mesh split into halves along each axis, on the same nodes and
    /// those between them: curved cells stay curved, and flat ones stay flat.
    ///
    /// # Errors
    ///
    /// Those of reading or generating its meshes.
    pub fn with_halved_cells(&self) -> Result<Self, Error> {
        let folder = self.source.parent().unwrap_or(Path::new(""));
        let mut scene = self.clone();
        let bodies = scene.bodies.iter_mut().enumerate();
        bodies.into_iter().try_for_each(|(at, body)| {
            let place = format!("bodies[{at}].mesh");
            let mesh = body.mesh.mesh(&place, folder, MOST_NODES);
            let mesh = mesh.map_err(|error| self.locate(error))?;
            body.mesh = MeshSource::Given(mesh.refined());
            Ok(())
        })?;
        Ok(scene)
    }

    /// The scene with this mesh file, relative to the working folder, in place of its one.
    ///
    /// # Errors
    ///
    /// [`Error::NotAccepted`] unless exactly one body has its mesh from a file.
    pub fn with_mesh_file(&self, path: &Path) -> Result<Self, Error> {
        let mut scene = self.clone();
        let mut files = Vec::new();
        for body in &mut scene.bodies {
            if let MeshSource::File { file, .. } = &mut body.mesh {
                files.push(file);
            }
        }
        let count = files.len();
        let [file] = &mut files[..] else {
            return Err(Error::NotAccepted {
                place: "meshes".to_owned(),
                found: format!("a scene with {count} meshes from files"),
                accepted: "one with exactly one, that the list replaces".to_owned(),
            });
        };
        **file = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        Ok(scene)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn scene(meshes: &[&str]) -> Scene {
        let body = |(at, mesh): (usize, &&str)| {
            format!(r#"{{"name": "{at}", "mesh": {mesh}, "materials": []}}"#)
        };
        let bodies: Vec<String> = meshes.iter().enumerate().map(body).collect();
        let text = format!(r#"{{"bodies": [{}], "contacts": []}}"#, bodies.join(","));
        Scene::from_json(&text, "").unwrap()
    }

    const GRID: &str = r#"{"rectangle": {"x": [0, 1], "y": [0, 1], "cells": [3, 1]}}"#;
    const FILE: &str = r#"{"file": "a.msh", "scale": 2}"#;

    #[test]
    fn every_generated_mesh_is_refined_and_none_is_left_without_cells() {
        let cells = |factor: f64| {
            let refined = scene(&[GRID, GRID]).refined(factor).unwrap();
            let bodies = refined.bodies.into_iter();
            bodies
                .map(|body| match body.mesh {
                    MeshSource::Rectangle { rectangle } => rectangle.cells,
                    _ => [0, 0],
                })
                .collect::<Vec<_>>()
        };
        assert_eq!(cells(2.0), [[6, 2], [6, 2]]);
        assert_eq!(cells(0.1), [[1, 1], [1, 1]]);
        assert_eq!(scene(&[GRID, FILE]).refined(2.0), None);
    }

    #[test]
    fn one_mesh_file_is_replaced_and_keeps_its_scale() {
        let path = std::path::absolute("b.msh").unwrap();
        let replaced = scene(&[GRID, FILE])
            .with_mesh_file(Path::new("b.msh"))
            .unwrap();
        let mesh = &replaced.bodies[1].mesh;
        assert_eq!(
            *mesh,
            MeshSource::File {
                file: path,
                scale: 2.0,
                split: None,
                groups: Vec::new(),
            }
        );
        for meshes in [&[GRID][..], &[FILE, FILE]] {
            assert!(scene(meshes).with_mesh_file(Path::new("b.msh")).is_err());
        }
    }
}
