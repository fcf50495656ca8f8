//! The memory hierarchy: `taut-oblivious` and the reference code of `taut-reference` beside their peers.

mod draw;
mod files;
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

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};
use std::fs::File;
use std::hint::black_box;
use std::io::{BufReader, BufWriter, Read, Write};
use std::num::NonZero;
use std::os::unix::fs::{FileExt as _, OpenOptionsExt as _};

use extsort::{ExternalSorter, Sortable};
use indexset::BTreeSet as IndexSet;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use memmap2::MmapMut;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand::seq::SliceRandom;
use rdst::RadixSort;
use rustix::fs::OFlags;
use rustix::time::{ClockId, clock_gettime};
use serde::{Deserialize, Serialize};
use taut_certify::{
    ElementOrder, FileAnswer, Files, Hash128, KeyKind, SortCertificate, SortedFile, TransposedFile,
};
use taut_oblivious::external::{FileSortOptions, RecordLayout, sort_file};
use taut_oblivious::kdtree::KdTree;
use taut_oblivious::{
    FileMatrix, Probe, Sequential, TransposeFileOptions, bernoulli, hilbert_order, morton_order,
    shuffle, transpose_file,
};
use taut_reference::algorithms::{
    MatrixSizes, VebTree, distribution_sort_instrumented, funnelsort_instrumented,
    mergesort_instrumented, multiply_instrumented, transpose_instrumented,
};
use taut_reference::packed::PackedSet;
use taut_reference::search::{BlockedVanEmdeBoas, Eytzinger, SPlusTree, Sorted, SortedIndex};
use taut_reference::simulate::{CacheShape, Simulator, StackDistances};
use taut_reference::{PriorityQueue, SpillingQueue};
use tempfile::TempDir;
use voracious_radix_sort::RadixSort as _;

use crate::prelude::*;
use draw::{Draw, PATTERNS, Pattern};
use lanes::{Lanes, Peers, have_memory, thread_cpu};
use one::{FileCost, RECORD_BYTES, Task, Work};

/// All sections.
pub(crate) const AREA: Area<Run> = Area {
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
        runs("in-place", transpose::run_in_place).about(
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
