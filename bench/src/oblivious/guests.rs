//! Peers that are processes of their own: each gets the input as a file and takes its turn in every round.

use std::fs::File;
use std::io::Write;

use anyhow::{Result, anyhow, bail};

use super::lanes::Lanes;
use crate::context::Context;
use crate::peer::{Peer, Silence};

/// Those that are there.
pub(super) struct Guests(Vec<(&'static str, Peer)>);

impl Guests {
    /// Starts peers on rows of so many words; one that is not installed is named and left out.
    pub(super) fn invite(
        context: &Context,
        words: &[u64],
        columns: usize,
        names: &[&'static str],
    ) -> Result<Self> {
        let (mut guests, input) = (vec![], context.temp.path().join("words"));
        if !names.is_empty() {
            let mut file = File::create(&input)?;
            let rows = words.len() / columns;
            file.write_all(bytemuck::cast_slice(&[rows as u64, columns as u64]))?;
            file.write_all(bytemuck::cast_slice(words))?;
        }
        for &name in names {
            match Peer::start(name, &input, context.temp.path())? {
                Ok(peer) => guests.push((name, peer)),
                Err(silence @ Silence::NotInstalled) => println!("{name}: {silence}\n"),
                Err(silence) => bail!("{name}: {silence}"),
            }
        }
        Ok(Self(guests))
    }

    /// A turn of each; its seconds are kept, and `judge` is given its name and the words it answers with.
    pub(super) fn turn(
        &mut self,
        context: &Context,
        lanes: &mut Lanes,
        mut judge: impl FnMut(&'static str, &[u64]) -> Result<()>,
    ) -> Result<()> {
        for (name, peer) in &mut self.0 {
            let answer = peer.solve(context.limit)?;
            let answer = answer.map_err(|silence| anyhow!("{name}: {silence}"))?;
            judge(name, bytemuck::cast_slice(&answer.center))?;
            lanes.keep(name, answer.seconds);
        }
        Ok(())
    }
}
