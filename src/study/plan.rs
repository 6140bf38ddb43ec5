//! What a study runs.

use std::path::PathBuf;

use crate::error::Error;
use crate::scene::Scene;

/// What a study runs; the default is three meshes, three tolerances and seven coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Cells along every edge of the generated meshes, relative to the scene's, from coarse to fine.
    pub refine: Vec<f64>,
    /// Mesh files in place of the scene's one, from coarse to fine; with these `refine` is not used.
    pub meshes: Vec<PathBuf>,
    /// Tolerances of the outer loop, from loose to tight.
    pub tolerances: Vec<f64>,
    /// Coefficients of friction, each for all contacts; empty for none but the scene's.
    pub friction: Vec<f64>,
    /// Penalties that are tried: springs over the contacts' own stiffness, from soft to stiff.
    pub penalties: Vec<f64>,
    /// Totals that are known, by their column of a [`Table`](crate::report::Table), none of them 0.
    pub known: Vec<(String, f64)>,
    /// Loops are compared on the finest mesh with at most so many contact unknowns.
    pub loop_unknowns: usize,
    /// Sweeps after which a loop gives up.
    pub sweeps: usize,
    /// Gauss–Seidel passes after which it gives up; fewer where one takes long.
    pub passes: usize,
    /// Times that short runs are repeated.
    pub repetitions: usize,
}

/// What a study is about to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress<'a> {
    /// Parts that are done.
    pub done: usize,
    /// Parts in all; known for certain when the meshes are done.
    pub of: usize,
    /// The next part, in words.
    pub doing: &'a str,
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            refine: vec![1.0, 2.0, 4.0],
            meshes: Vec::new(),
            tolerances: vec![1e-4, 1e-8, 1e-12],
            friction: vec![0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0],
            penalties: (0..=14)
                .map(|half| 10_f64.powf(0.5 * f64::from(half)))
                .collect(),
            known: Vec::new(),
            loop_unknowns: 600,
            sweeps: 100,
            passes: 20_000,
            repetitions: 5,
        }
    }
}

impl Plan {
    /// A plan of seconds: two meshes, two tolerances, two coefficients, nothing repeated.
    #[must_use]
    pub fn quick() -> Self {
        Self {
            refine: vec![1.0, 2.0],
            tolerances: vec![1e-4, 1e-10],
            friction: vec![0.2, 1.0],
            penalties: vec![1e1, 1e3],
            loop_unknowns: 150,
            sweeps: 40,
            passes: 2_000,
            repetitions: 1,
            ..Self::default()
        }
    }

    /// Checks the ranges.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] naming the field and its range.
    pub fn validate(&self) -> Result<(), Error> {
        let refuse = |place: &str, value: f64, accepted| Error::OutOfRange {
            place: format!("plan.{place}"),
            value,
            accepted,
        };
        let all = |place, values: &[f64], accepted, sound: fn(f64) -> bool| match values
            .iter()
            .find(|value| !sound(**value))
        {
            Some(value) => Err(refuse(place, *value, accepted)),
            None => Ok(()),
        };
        all("refine", &self.refine, "0 < factor <= 1000", |x| {
            x > 0.0 && x <= 1000.0
        })?;
        all("tolerances", &self.tolerances, "1e-15 to 1e-2", |x| {
            (1e-15..=1e-2).contains(&x)
        })?;
        all("friction", &self.friction, "0 < friction < infinity", |x| {
            x > 0.0 && x.is_finite()
        })?;
        all("penalties", &self.penalties, "0 < factor < infinity", |x| {
            x > 0.0 && x.is_finite()
        })?;
        let known: Vec<f64> = self.known.iter().map(|known| known.1).collect();
        all("known", &known, "a finite number other than 0", |x| {
            x != 0.0 && x.is_finite()
        })?;
        for (place, count) in [
            ("sweeps", self.sweeps),
            ("passes", self.passes),
            ("repetitions", self.repetitions),
            ("tolerances: count", self.tolerances.len()),
            ("refine: count", self.refine.len().max(self.meshes.len())),
        ] {
            if count == 0 {
                return Err(refuse(place, 0.0, "at least 1"));
            }
        }
        Ok(())
    }

    /// The scene on every mesh, with the mesh's name.
    pub(super) fn scenes(&self, scene: &Scene) -> Result<Vec<(String, Scene)>, Error> {
        if scene.steps.is_some() {
            return Err(Error::NotAccepted {
                place: "steps".to_owned(),
                found: "a load history".to_owned(),
                accepted: "a scene of one state".to_owned(),
            });
        }
        if self.meshes.is_empty() {
            let refined = self.refine.iter().map(|factor| {
                let scene = scene.refined(*factor)?;
                Some((format!("× {factor}"), scene))
            });
            // A mesh that cannot be refined is studied as it is.
            let as_given = || vec![("as given".to_owned(), scene.clone())];
            return Ok(refined.collect::<Option<_>>().unwrap_or_else(as_given));
        }
        let with = |path: &PathBuf| {
            let name = path.file_stem().unwrap_or(path.as_os_str());
            let scene = scene.with_mesh_file(path);
            Ok((
                name.to_string_lossy().into_owned(),
                scene.map_err(|error| error.within("plan"))?,
            ))
        };
        self.meshes.iter().map(with).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_plan_outside_its_ranges_is_refused_by_name() {
        let plan = |change: fn(&mut Plan)| {
            let mut plan = Plan::default();
            change(&mut plan);
            plan.validate().map_err(|error| error.to_string())
        };
        assert_eq!(plan(|_| ()), Ok(()));
        assert_eq!(Plan::quick().validate(), Ok(()));
        for (change, words) in [
            (
                (|p| p.refine = vec![1.0, f64::NAN]) as fn(&mut Plan),
                "plan.refine",
            ),
            (|p| p.refine = vec![], "plan.refine: count"),
            (|p| p.tolerances = vec![1e-16], "plan.tolerances"),
            (|p| p.friction = vec![-0.1], "plan.friction"),
            (|p| p.known = vec![("normal".into(), 0.0)], "plan.known"),
            (|p| p.penalties = vec![0.0], "plan.penalties"),
            (|p| p.passes = 0, "plan.passes"),
        ] {
            let refused = plan(change).unwrap_err();
            assert!(refused.starts_with(words), "{refused}");
        }
    }
}
