//! `dpana schema`: the JSON Schema of scenes.

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

use dpana::scene;

pub(crate) fn schema() -> Result<ExitCode, Box<dyn Error>> {
    writeln!(io::stdout(), "{:#}", scene::schema())?;
    Ok(ExitCode::SUCCESS)
}
