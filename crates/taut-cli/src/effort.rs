//! How much of the machine is used and how much is said on the way, the same for every subcommand.

use std::num::NonZeroUsize;

use anyhow::Context;

use crate::watch::Watch;

/// When progress is shown on standard error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Progress {
    /// if it is a terminal
    Auto,
    /// as a bar, or as lines where it is no terminal
    Always,
    /// not at all
    Never,
}

#[derive(Clone, Copy, Debug, clap::Args)]
#[command(next_help_heading = "Running")]
pub(crate) struct Effort {
    /// Threads to use; no result depends on it [default: one for each processor]
    #[arg(long, value_name = "N", env = "TAUT_THREADS", hide_env_values = true)]
    threads: Option<NonZeroUsize>,
    /// Say nothing but errors; the exit code tells how it went
    #[arg(short, long)]
    pub(crate) quiet: bool,
    /// When to show progress on standard error
    #[arg(long, value_name = "WHEN", default_value = "auto")]
    progress: Progress,
}

impl Effort {
    /// Starts the threads; to be called once, before any work.
    pub(crate) fn start(&self) -> anyhow::Result<Watch> {
        let threads = self.threads.map_or(0, NonZeroUsize::get);
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().with_context(|| {
            format!("could not start {threads} threads; try fewer with --threads")
        })?;
        Ok(Watch::new(if self.quiet { Progress::Never } else { self.progress }))
    }
}
