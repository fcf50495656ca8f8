//! `taut man`: the manual, one page per subcommand, from the same words as `--help`.

use std::path::PathBuf;

use anyhow::anyhow;
use clap::CommandFactory;

use crate::cli::Cli;
use crate::exit::Outcome;
use crate::writing::Outputs;

/// Write the manual pages to a folder.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: taut man ~/.local/share/man/man1 && man taut-ball")]
pub(crate) struct Args {
    /// Folder for the pages; made if it is not there
    dir: PathBuf,
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        let mut top = Cli::command().disable_help_subcommand(true);
        top.build();
        let pages: Vec<clap::Command> =
            std::iter::once(top.clone()).chain(top.get_subcommands().cloned()).collect();
        std::fs::create_dir_all(&self.dir)
            .map_err(|source| anyhow!("{}: could not be made: {source}", self.dir.display()))?;
        let mut outputs = Outputs::default();
        for page in pages {
            let page = clap_mangen::Man::new(page);
            let mut text = Vec::new();
            page.render(&mut text)?;
            outputs.add(&self.dir.join(page.get_filename()), &text)?;
        }
        outputs.finish()?;
        Ok(Outcome::Done)
    }
}
