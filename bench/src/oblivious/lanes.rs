//! Programs that take turns on one thread; of each the least processor time counts.
//!
//! *Trap.* A virtual machine may hand free memory back to its host after a moment. Whoever accesses it first then pays for
//! the host, in processor time of the thread: up to 4 ms for a page of 2 MiB, where clearing it takes 0.2 ms.

use super::*;
#[cfg(target_os = "linux")]
use memmap2::Advice;

/// Times so far, by name, in the order in which the names came up.
#[derive(Default)]
pub(super) struct Lanes {
    times: Vec<(&'static str, Vec<f64>)>,
}

impl Lanes {
    /// Does `work` and keeps its processor time on this thread.
    pub(super) fn time<T>(&mut self, name: &'static str, work: impl FnOnce() -> T) -> T {
        let start = thread_cpu();
        let done = black_box(work());
        self.keep(name, thread_cpu() - start);
        done
    }

    /// Keeps a time that was taken elsewhere.
    pub(super) fn keep(&mut self, name: &'static str, seconds: f64) {
        match self.times.iter_mut().find(|lane| lane.0 == name) {
            Some(lane) => lane.1.push(seconds),
            None => self.times.push((name, vec![seconds])),
        }
    }

    /// The least seconds of that name; NaN, which meets no goal, if it never ran.
    pub(super) fn of(&self, name: &str) -> f64 {
        least(self.rounds(name).iter().copied()).unwrap_or(f64::NAN)
    }

    /// How many times as long `other` took as `name`.
    pub(super) fn faster(&self, name: &str, other: &str) -> f64 {
        self.of(other) / self.of(name)
    }

    /// How many times as long as the fastest round of that name its slowest took: what is noise.
    pub(super) fn spread(&self, name: &str) -> f64 {
        self.rounds(name).iter().copied().fold(0.0, f64::max) / self.of(name)
    }

    /// Nanoseconds for each of `n` and how many times as long as taut, program by program.
    pub(super) fn table(&self, n: usize) -> Table {
        let mut table = Table::new("program | each:ns | ÷ taut:x | slowest ÷ fastest round:x");
        for (name, seconds) in self.iter() {
            table.push(json!({
                "program": name, "each": seconds / n as f64, "÷ taut": self.faster("taut", name),
                "slowest ÷ fastest round": self.spread(name), "rounds": self.rounds(name),
            }));
        }
        table
    }

    /// Seconds of that name in all rounds.
    fn rounds(&self, name: &str) -> &[f64] {
        self.times.iter().find(|lane| lane.0 == name).map_or(&[], |lane| &lane.1)
    }

    /// Nanoseconds for each of `n` in all rounds, for the report.
    pub(super) fn json(&self, n: usize) -> Value {
        let lane = |(name, seconds): &(&str, Vec<f64>)| {
            let each: Vec<f64> = seconds.iter().map(|seconds| seconds / n as f64 * 1e9).collect();
            json!({ "name": name, "ns": each })
        };
        self.times.iter().map(lane).collect::<Vec<_>>().into()
    }

    /// Names and least seconds.
    fn iter(&self) -> impl Iterator<Item = (&'static str, f64)> {
        self.times.iter().map(|(name, _)| (*name, self.of(name)))
    }
}

/// Peers that are processes of their own, as far as they are there: each gets the input as a file and takes its turn.
pub(super) struct Peers(Vec<(&'static str, Peer)>);

impl Peers {
    /// Starts peers on rows of so many words; one that is not installed is named and left out.
    pub(super) fn start(
        context: &Context,
        words: &[u64],
        columns: usize,
        names: &[&'static str],
    ) -> Result<Self> {
        let (mut peers, input) = (vec![], context.file("words"));
        if !names.is_empty() {
            write_rows(&input, bytemuck::cast_slice(words), columns)?;
        }
        for &name in names {
            match Peer::start(name, &input, context.temp.path())? {
                Ok(peer) => peers.push((name, peer)),
                Err(silence @ Silence::NotInstalled) => println!("{name}: {silence}\n"),
                Err(silence) => bail!("{name}: {silence}"),
            }
        }
        Ok(Self(peers))
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

/// Takes so many bytes, writes to each page and gives them back: the system has memory for what is timed next.
pub(super) fn have_memory(bytes: usize) -> Result<()> {
    let mut pages = MmapMut::map_anon(bytes.max(1))?;
    #[cfg(target_os = "linux")]
    pages.advise(Advice::HugePage)?;
    for byte in pages.iter_mut().step_by(4096) {
        *byte = 1;
    }
    black_box(&pages);
    Ok(())
}

/// Processor seconds of this thread so far.
pub(super) fn thread_cpu() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_time_of_a_name_counts() {
        let mut lanes = Lanes::default();
        for (name, seconds) in [("a", 3.0), ("b", 8.0), ("a", 2.0), ("a", 4.0)] {
            lanes.keep(name, seconds);
        }
        assert_eq!(lanes.iter().collect::<Vec<_>>(), [("a", 2.0), ("b", 8.0)]);
        assert_eq!((lanes.faster("a", "b"), lanes.spread("a")), (4.0, 2.0));
        assert_eq!(lanes.json(1)[0]["ns"], json!([3e9, 2e9, 4e9]));
        assert!(lanes.faster("a", "c").is_nan());
        assert_eq!(lanes.time("d", || 7), 7);
        assert!(lanes.of("d") >= 0.0);
    }
}
