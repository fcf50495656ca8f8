//! `taut completions`: a script that lets a shell complete the command line.

use clap::CommandFactory;
use clap_complete::Shell;

use crate::cli::Cli;
use crate::exit::Outcome;
use crate::output::writing;

/// Write a completion script for a shell to standard output.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example: taut completions bash > ~/.local/share/bash-completion/completions/taut")]
pub(crate) struct Args {
    /// The shell that is to complete
    shell: Shell,
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), "taut", &mut script);
        writing::print(&script)?;
        Ok(Outcome::Done)
    }
}
