//! `dpana schema`: the JSON Schema of scenes.

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::Args;
use dpana::scene;

#[derive(Args)]
pub(crate) struct Schema {
    /// That of scenes of half-spaces.
    #[arg(long)]
    half_space: bool,
}

pub(crate) fn schema(arguments: &Schema) -> Result<ExitCode, Box<dyn Error>> {
    let schema = match arguments.half_space {
        true => scene::half_space_schema(),
        false => scene::schema(),
    };
    writeln!(io::stdout(), "{schema:#}")?;
    Ok(ExitCode::SUCCESS)
}
