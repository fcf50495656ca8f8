//! Options for the use of the machine and for messages, the same for every subcommand.

use anyhow::{anyhow, bail};
use taut::points::{THREADS_MAX, check_threads};

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
    /// Threads to use, 1 to 1024; no result depends on it [default: TAUT_THREADS, or one for each processor]
    #[arg(long, value_name = "N", value_parser = threads)]
    threads: Option<usize>,
    /// Say nothing but errors and the JSON that --json asks for; the exit code tells how it went
    #[arg(short, long)]
    pub(crate) quiet: bool,
    /// When to show progress on standard error
    #[arg(long, value_name = "WHEN", default_value = "auto")]
    progress: Progress,
}

impl Effort {
    /// Starts the threads; to be called once, before any work.
    pub(crate) fn start(&self) -> anyhow::Result<Watch> {
        // For the pool 0 is one for each processor.
        let threads = match self.threads {
            Some(threads) => Some(threads),
            None => threads_of_environment()?,
        };
        rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build_global().map_err(
            |source| {
                anyhow!("the threads could not be started: {source}; try fewer with --threads")
            },
        )?;
        Ok(Watch::new(if self.quiet { Progress::Never } else { self.progress }))
    }
}

fn threads(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|&threads| check_threads(threads).is_ok())
        .ok_or_else(|| format!("expected a whole number from 1 to {THREADS_MAX}"))
}

/// Returns what the variable `TAUT_THREADS` asks for, if it is set and not empty.
fn threads_of_environment() -> anyhow::Result<Option<usize>> {
    let Some(text) = std::env::var_os("TAUT_THREADS").filter(|text| !text.is_empty()) else {
        return Ok(None);
    };
    let text = text.to_string_lossy();
    match threads(&text) {
        Ok(threads) => Ok(Some(threads)),
        Err(expected) => bail!("the environment variable TAUT_THREADS is `{text}`: {expected}"),
    }
}
