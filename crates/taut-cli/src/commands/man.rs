//! `taut man`: the manual, one page per subcommand and theirs, from the same words as `--help`.

use std::path::PathBuf;

use anyhow::anyhow;
use clap::CommandFactory;

use crate::cli::Cli;
use crate::exit::Outcome;
use crate::output::writing::Outputs;

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
        let mut pages = Vec::new();
        collect(&top, &mut pages);
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

/// A command and all below it; of the help that a command offers on those below, there is no page.
fn collect(command: &clap::Command, pages: &mut Vec<clap::Command>) {
    pages.push(command.clone());
    let below = command.get_subcommands().filter(|below| below.get_name() != "help");
    below.for_each(|below| collect(below, pages));
}
