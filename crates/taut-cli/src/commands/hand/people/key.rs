//! `taut hand key`.

use std::path::PathBuf;

use anyhow::bail;
use taut::recognize::store::Key;

use crate::exit::Outcome;
use crate::output::writing;

/// Make a secret key for a store of people.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The key has 32 random bytes, written as hexadecimal digits to a new file that you alone may read. Without the key \
nobody reads the store, you included: keep a copy of it elsewhere, and no copy beside the store.
Exit: 0 done · 2 bad input or usage, nothing written
Example: taut hand key -o key")]
pub(crate) struct Args {
    /// The file to make; an earlier one is not replaced
    #[arg(short, long, visible_alias = "output", value_name = "FILE")]
    out: PathBuf,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        if writing::is_stream(&self.out) {
            bail!("a key is written to a file that you alone may read: name it after --out");
        }
        Key::generate()?.write_new(&self.out)?;
        Ok(Outcome::Done)
    }
}
