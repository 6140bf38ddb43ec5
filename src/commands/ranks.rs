//! A command on all processes of an MPI run: rank 0 does what one process would, the others serve it.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use dpana::{Engine, Ranks};

use super::outputs::is_standard;
use super::scene_file::read_scene;

/// What factorises the bodies, by name.
#[derive(Clone, Copy, clap::ValueEnum)]
pub(crate) enum EngineName {
    /// This process, on all of its threads.
    Faer,
    /// All processes that `mpirun` started.
    Mumps,
}

impl From<EngineName> for Engine {
    fn from(name: EngineName) -> Self {
        match name {
            EngineName::Faer => Self::Faer,
            EngineName::Mumps => Self::Mumps,
        }
    }
}

/// Runs a command on a scene's file with an engine.
pub(super) fn run(
    engine: EngineName,
    scene: &Path,
    command: impl FnOnce() -> Result<ExitCode, Box<dyn Error>>,
) -> Result<ExitCode, Box<dyn Error>> {
    if matches!(engine, EngineName::Faer) {
        return command();
    }
    if is_standard(scene) {
        let refused = "--engine mumps: a scene from standard input, which one rank alone can read; \
                       expected a file";
        return Err(refused.into());
    }
    let ranks = Ranks::join()?;
    if ranks.rank() == 0 {
        return command();
    }
    let bodies = read_scene(scene).and_then(|scene| Ok(scene.mechanics()?.bodies));
    ranks.serve(bodies);
    Ok(ExitCode::SUCCESS)
}
