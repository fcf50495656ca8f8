//! The subcommands of `taut hand` about people: keys, matchers, and the store.

mod enroll;
mod find;
mod key;
mod manage;
mod open;
mod scans;
mod train;

use crate::exit::Outcome;

#[derive(Debug, clap::Subcommand)]
pub(super) enum Subcommands {
    Key(key::Args),
    Train(train::Args),
    #[command(alias = "enrol")]
    Enroll(enroll::Args),
    Verify(find::VerifyArgs),
    Identify(find::IdentifyArgs),
    List(manage::ListArgs),
    Unlock(manage::UnlockArgs),
    Delete(manage::DeleteArgs),
}

impl Subcommands {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        match self {
            Self::Key(args) => args.run(),
            Self::Train(args) => args.run(),
            Self::Enroll(args) => args.run(),
            Self::Verify(args) => args.run(),
            Self::Identify(args) => args.run(),
            Self::List(args) => args.run(),
            Self::Unlock(args) => args.run(),
            Self::Delete(args) => args.run(),
        }
    }
}
