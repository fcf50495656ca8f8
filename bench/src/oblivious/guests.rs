//! Peers that are processes of their own: each gets the input as a file and takes its turn in every round.

use super::*;

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
        let (mut guests, input) = (vec![], context.file("words"));
        if !names.is_empty() {
            write_rows(&input, bytemuck::cast_slice(words), columns)?;
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
