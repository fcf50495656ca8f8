//! Defines how the memory is used, and which runs are merged when.

use super::chunk::{self, stage_bytes};
use super::layout::RecordLayout;
use crate::error::Error;
use crate::sort::records::room_bytes;
use crate::store::PAGE;

/// Blocks of this size keep a disk busy.
const BLOCK_MAX: usize = 1 << 20;
/// Blocks that are written. There are two: one is filled while the other is written.
const WRITE_BLOCK: usize = 512 << 10;
/// Smaller blocks are better collected by the system.
const PAST_CACHE_MIN: usize = 64 << 10;
/// From this limit on, there is room for what sorting records in their own place takes, ...
const IN_PLACE_MIN: usize = 16 << 20;
/// ... which is this or that share of the memory, for the places where records wait to be written and for as many threads as
/// it holds rooms for, and a fortieth of the records.
const IN_PLACE_ROOM: (usize, usize) = (7 << 20, 16);
/// Bytes that are collected from runs at once: half of a second-level cache.
const BATCH_BYTES: usize = 512 << 10;
/// Fewest records that are looked at in each run, where there is room.
const WINDOW_MIN: usize = 32;
/// Rather than with smaller blocks, runs are merged in several steps.
const BLOCK_MIN: usize = 256 << 10;

/// The way in which the memory is used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Plan {
    pub(super) layout: RecordLayout,
    pub(super) records: u64,
    /// Most records of a run: what fits, or less where more gains nothing.
    pub(super) chunk: usize,
    /// Bytes that are written at once.
    pub(super) write_block: usize,
    /// True if runs and blocks are whole pages but for the last one, and large.
    pub(super) past_cache: bool,
    /// On how many threads records are sorted in their own place; 0 if they are sorted by words.
    pub(super) in_place: usize,
    /// The unit of which blocks are multiples.
    pub(super) unit: usize,
    memory: usize,
}

impl Plan {
    pub(super) fn new(layout: &RecordLayout, records: u64, memory: usize) -> Result<Self, Error> {
        layout.check()?;
        let width = layout.width;
        let mut write_block = whole((memory / 32).min(WRITE_BLOCK), width);
        let (in_place, mut chunk) = if memory >= IN_PLACE_MIN && chunk::sorts(layout) {
            let room = IN_PLACE_ROOM.0.max(memory / IN_PLACE_ROOM.1);
            let threads = (room - 2 * stage_bytes(pages_of(width))) / room_bytes(width);
            (threads, (memory - room) / 41 * 40 / width)
        } else {
            (0, memory.saturating_sub(2 * write_block) / (width + size_of::<u64>()))
        };
        if memory < 64 << 10 || chunk < 64 {
            return Err(Error::Option {
                name: "memory",
                value: format!("{memory} bytes"),
                expected: "at least 65536 bytes, and room for 64 records",
            });
        }
        let pages = pages_of(width);
        let past_cache = write_block >= PAST_CACHE_MIN.max(pages);
        let mut unit = width;
        if past_cache {
            write_block = whole(write_block, pages);
            unit = pages;
        }
        chunk -= chunk % (unit / width);
        let layout = layout.clone();
        let mut plan =
            Self { layout, records, chunk, write_block, past_cache, in_place, unit, memory };
        if !plan.fits() {
            plan.chunk = plan.chunk.min(plan.balanced());
        }
        Ok(plan)
    }

    /// Returns true if the records fit into memory.
    pub(super) fn fits(&self) -> bool {
        self.records <= self.chunk as u64
    }

    pub(super) fn runs(&self) -> u64 {
        self.records.div_ceil(self.chunk as u64)
    }

    pub(super) fn bytes(&self) -> u64 {
        self.records * self.layout.width as u64
    }

    /// The runs as they are made, the first one from `start`.
    pub(super) fn made(&self, start: u64) -> Vec<Run> {
        let chunk = self.chunk as u64;
        let run = |i| Run {
            offset: start + i * chunk * self.layout.width as u64,
            records: chunk.min(self.records - i * chunk),
        };
        (0..self.runs()).map(run).collect()
    }

    /// Records of a run for which making runs takes as much memory as merging them with the largest blocks; more only if so
    /// many runs could not be merged at once.
    ///
    /// To use more than that gains nothing and has its price, the first access of each page: 240 MiB instead of 56 cost a tenth
    /// of the processor's time of sorting 3.2 GB.
    fn balanced(&self) -> usize {
        let (width, bytes) = (self.layout.width, self.bytes());
        let balanced = (bytes as f64 * BLOCK_MAX.max(self.least_share()) as f64).sqrt() as usize;
        let least = self.records.div_ceil(self.fan_in() as u64) as usize * width;
        balanced.max(least).div_ceil(self.unit) * self.unit / width
    }

    /// Bytes that merging a run takes with the least block: the block, a word for a record, and the last record collected.
    fn least_share(&self) -> usize {
        self.unit + self.layout.width + size_of::<u64>()
    }

    /// The most runs that are merged at once.
    fn fan_in(&self) -> usize {
        let least = (self.memory / 64).clamp(4096, BLOCK_MIN).max(self.least_share());
        ((self.memory - 2 * self.write_block) / least).max(2)
    }

    /// Bytes of the block and records of the window of each run when so many are merged.
    pub(super) fn merge_sizes(&self, runs: usize) -> (usize, usize) {
        let width = self.layout.width;
        let share = (self.memory - 2 * self.write_block) / runs;
        // Each record of a window takes a word besides.
        let word = size_of::<u64>();
        let window = (BATCH_BYTES / width / runs).max(WINDOW_MIN);
        let window = window.min(share / 4 / (width + word)).max(1);
        // The last record that was collected is kept.
        let block = share.saturating_sub(window * word + width).min(BLOCK_MAX);
        let block = whole(block, if block < self.unit { width } else { self.unit });
        (block, window.min(block / width))
    }
}

/// The least bytes that are both whole records of a width and whole pages.
fn pages_of(width: usize) -> usize {
    let twos = width.trailing_zeros().min(PAGE.trailing_zeros());
    width * (PAGE >> twos)
}

/// The largest multiple of `width` that is at most `bytes`, but one `width` at least.
pub(super) fn whole(bytes: usize, width: usize) -> usize {
    (bytes / width).max(1) * width
}

/// Sorted records in the file of runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Run {
    pub(super) offset: u64,
    pub(super) records: u64,
}

impl Run {
    pub(super) fn end(&self, plan: &Plan) -> u64 {
        self.offset + self.records * plan.layout.width as u64
    }
}

/// Neighboring runs, and the longer one that they are merged to.
pub(super) type Step = (Vec<Run>, Run);

/// The merges after which few enough runs are left to be merged at once, and those runs.
///
/// From the front, as many neighbors as can be merged at once, until that is enough; if it is not, what came of it is
/// gone through again. Longer runs are written behind the shorter ones, which stay.
pub(super) fn steps(mut left: Vec<Run>, plan: &Plan) -> (Vec<Step>, Vec<Run>) {
    let (fan_in, mut steps) = (plan.fan_in(), vec![]);
    let mut end = left.last().map_or(0, |run| run.end(plan));
    while left.len() > fan_in {
        let (mut excess, mut next, mut rest) = (left.len() - fan_in, vec![], &left[..]);
        while !rest.is_empty() {
            let group;
            (group, rest) = rest.split_at(fan_in.min(excess + 1).min(rest.len()));
            excess -= group.len() - 1;
            let offset = end.next_multiple_of(PAGE as u64);
            let longer = Run { offset, records: group.iter().map(|run| run.records).sum() };
            if group.len() > 1 {
                end = longer.end(plan);
                steps.push((group.to_vec(), longer));
            }
            next.push(if group.len() > 1 { longer } else { group[0] });
        }
        left = next;
    }
    (steps, left)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sort::external::KeyKind;

    /// Shorter runs are never so many that they cannot be merged at once where those as long as memory allows can.
    #[test]
    fn shorter_runs_need_no_step_more() {
        let mut compared = 0;
        for width in [1, 8, 17, 32, 100, 4097, 645_723, 1 << 20, (1 << 22) + 1, 1 << 24] {
            let layout = RecordLayout { width, key: 0..1, kind: KeyKind::Bytes };
            for memory in (16..34).flat_map(|bits| [1 << bits, (1 << bits) + 12_345_678]) {
                for times in [1.01, 1.5, 2.0, 7.0, 19.0, 60.0, 250.0, 900.0] {
                    let records = (memory as f64 * times / width as f64) as u64;
                    let Ok(plan) = Plan::new(&layout, records, memory) else { continue };
                    if plan.fits() {
                        continue;
                    }
                    let fan_in = plan.fan_in() as u64;
                    let chunk = Plan::new(&layout, 1, memory).expect("the same limit").chunk;
                    let longest = records.div_ceil(chunk as u64);
                    assert!(plan.chunk <= chunk && plan.runs() >= longest);
                    assert!(plan.runs() <= fan_in.max(longest), "{plan:?}");
                    let (block, window) = plan.merge_sizes(plan.runs().min(fan_in) as usize);
                    assert!(block >= width && (1..=block / width).contains(&window), "{plan:?}");
                    compared += 1;
                }
            }
        }
        assert!(compared > 1000);
    }
}
