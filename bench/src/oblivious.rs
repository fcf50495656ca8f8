//! The memory hierarchy: `taut-oblivious` and the reference code of `taut-reference` beside their peers.

mod draw;
mod files;
mod guests;
mod in_place;
mod lanes;
pub(crate) mod one;
mod order;
mod packed;
mod queue;
mod sample;
mod search;
mod simulate;
mod sort;
mod transpose;
mod tree;

use crate::prelude::*;

/// All sections.
const AREA: Area<Run> = Area {
    name: "oblivious",
    sections: &[
        runs("search", search::run).about(
            "Lower bounds among 2²⁴ sorted u64, in batches and each depending on the one \
                 before, beside std's binary search.",
        ),
        runs("sort", sort::run).about(
            "10⁷ u64 and 10⁷ records of 32 bytes beside std, rdst, voracious_radix_sort \
                 and numpy; twelve patterns of 10⁶.",
        ),
        runs("transpose", transpose::run).about(
            "Four shapes of doubles beside the crate transpose and a copy; sides off by one.",
        ),
        runs("in-place", in_place::run).about(
            "The same shapes in their own place, beside the crate transpose and a second array.",
        ),
        runs("files", files::run).about(
            "Files larger than the memory allowed: sorted beside extsort, put through a \
                 queue, and transposed.",
        ),
        runs("files-large", files::run_large)
            .about(
                "The same with 10⁸ records under 256 MiB and a matrix of 4 GiB; only where it \
                 is named, with --scratch and 10 GB of disk.",
            )
            .extra(),
        runs("packed", packed::run)
            .about("Ordered sets of 10⁷ u64 beside std's BTreeSet and indexset."),
        runs("sample", sample::run).about("2²⁰ of 2⁴⁰ without replacement, in order; shuffles."),
        runs("tree", tree::run).about("The nearest of 16 million points in space, beside kiddo."),
        runs("order", order::run)
            .about("A million points along a Hilbert curve, beside CGAL and fast_hilbert."),
        runs("simulate", simulate::run).about(
            "Accesses per second of the simulator; misses of algorithms beside their bounds.",
        ),
        runs("queue", queue::run)
            .about("10⁷ keys with values through a queue, beside std's BinaryHeap and quickheap."),
    ],
    runs: 3,
    threads: &[1],
    limit: 300,
    peer_budget: 300,
};

/// Runs the sections that were asked for.
pub(crate) fn run(options: &Options) -> Result<()> {
    // All work on this thread, whose processor time is what counts.
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()?;
    AREA.run_all(options)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        let areas = [&AREA, &crate::curve::AREA, &crate::surface::AREA];
        assert!(areas.iter().all(|area| area.has_unique_names()));
    }
}
