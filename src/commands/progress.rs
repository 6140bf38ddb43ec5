//! One line on a terminal that says how far a long run is; nothing where nobody watches.

use std::io::{self, IsTerminal, Write};

/// The line; it is wiped when this goes.
pub(crate) struct Progress {
    watched: bool,
}

impl Progress {
    /// A line on standard error, unless that is no terminal or the user wants it `quiet`.
    pub(crate) fn new(quiet: bool) -> Self {
        Self {
            watched: !quiet && io::stderr().is_terminal(),
        }
    }

    /// Replaces what the line said.
    pub(crate) fn show(&self, text: &str) {
        if self.watched {
            // A terminal that went away takes no line, and the run goes on without it.
            let _ = write!(io::stderr(), "\r\x1b[2K{text}");
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.show("");
    }
}
