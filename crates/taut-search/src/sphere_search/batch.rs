//! Many queries at once: in the order of the tree, on all threads, each answer back in the place of its query.
//!
//! *Idea.* Queries are put in the order of their home blocks, so that one finds in the caches what the one before it read; a task
//! is a fixed number of them.
//! *Guarantee.* Each answer depends on its query alone, so neither tasks nor threads change any.

use pulp::{Simd, WithSimd};
use taut_certify::Items;
use taut_points::parallel::ParallelSlice;
use taut_points::{ReadError, with_narrow_vectors};

use super::dim::{AnyDim, Dim, Fixed, unrolled};
use super::measure::{Measure, Squares, Surfaces, WideSquares, is_plain};
use super::{QueryOptions, SphereSearch};
use crate::Error;

/// Queries of one task.
const TASK_SIZE: usize = 1 << 10;
/// Bits of the home blocks by which queries are put in order: what is below a node of so few rows is in the caches anyway.
const ORDER_BITS: u32 = 12;

/// Numbers that begin with a place, and the home block of that.
#[derive(Clone, Copy)]
pub(super) struct Query<'a> {
    pub(super) values: &'a [f64],
    pub(super) home: usize,
}

/// What is done with each query of a task.
pub(super) trait Work: Sync {
    type Found: Send;
    /// Memory that is kept from one query to the next.
    type Kept<M: Measure>: Default;

    /// The answer to a query.
    fn answer<D: Dim, M: Measure>(
        &self,
        search: &SphereSearch,
        dim: D,
        query: Query<'_>,
        kept: &mut Self::Kept<M>,
    ) -> Self::Found;
}

/// The answer to each query; `width` numbers are a query, and its first ones a place.
pub(super) fn run<W: Work>(
    search: &SphereSearch,
    values: &[f64],
    width: usize,
    options: &QueryOptions<'_>,
    work: &W,
) -> Result<Vec<W::Found>, Error> {
    let homes: Vec<u32> = values
        .par_chunks(width)
        .with_min_len(TASK_SIZE)
        .map(|query| search.nodes.home(&query[..search.dim()]) as u32)
        .collect();
    let order = tree_order(&homes, search.nodes.blocks());
    let mut found: Vec<Option<W::Found>> = order.iter().map(|_| None).collect();
    order.par_chunks(TASK_SIZE).zip(found.par_chunks_mut(TASK_SIZE)).try_for_each(
        |(task, found)| {
            options.monitor.check().map_err(ReadError::from)?;
            let query = |&query: &u32| {
                let (query, home) = (query as usize, homes[query as usize] as usize);
                Query { values: &values[query * width..][..width], home }
            };
            let queries: Vec<Query<'_>> = task.iter().map(query).collect();
            run_task(search, &queries, work, found);
            options.monitor.points(task.len() as u64);
            Ok::<(), Error>(())
        },
    )?;
    let mut placed: Vec<Option<W::Found>> = order.iter().map(|_| None).collect();
    for (query, found) in order.into_iter().zip(found) {
        placed[query as usize] = found;
    }
    Ok(placed.into_iter().flatten().collect())
}

/// The answer to one query, on this thread.
pub(super) fn run_one<W: Work>(
    search: &SphereSearch,
    values: &[f64],
    work: &W,
) -> Option<W::Found> {
    let home = search.nodes.home(&values[..search.dim()]);
    let mut found = [None];
    run_task(search, &[Query { values, home }], work, &mut found);
    let [found] = found;
    found
}

/// The queries by the first bits of their home blocks.
fn tree_order(homes: &[u32], blocks: usize) -> Vec<u32> {
    let shift = (blocks.ilog2() + 1).saturating_sub(ORDER_BITS);
    let mut ends = vec![0u32; (1 << ORDER_BITS) + 1];
    for home in homes {
        ends[(home >> shift) as usize + 1] += 1;
    }
    for bucket in 1..ends.len() {
        ends[bucket] += ends[bucket - 1];
    }
    let mut order = vec![0; homes.len()];
    for (query, home) in (0..).zip(homes) {
        let end = &mut ends[(home >> shift) as usize];
        order[*end as usize] = query;
        *end += 1;
    }
    order
}

/// Does the work in the measure and the dimension of the tree and the queries.
fn run_task<W: Work>(
    search: &SphereSearch,
    queries: &[Query<'_>],
    work: &W,
    found: &mut [Option<W::Found>],
) {
    let task = Task { search, queries, work, found };
    let dim = AnyDim(search.dim());
    if search.is_plain && queries.iter().all(|query| is_plain(query.values)) {
        return with_narrow_vectors(task);
    }
    match search.items {
        Items::Points => task.answer::<_, WideSquares>(dim),
        _ => task.answer::<_, Surfaces<WideSquares>>(dim),
    }
}

/// Queries, and where their answers go.
struct Task<'a, W: Work> {
    search: &'a SphereSearch,
    queries: &'a [Query<'a>],
    work: &'a W,
    found: &'a mut [Option<W::Found>],
}

impl<W: Work> Task<'_, W> {
    /// A loop, not an iterator: a closure is compiled without the vectors of the processor unless it is inlined.
    #[inline(always)]
    fn answer<D: Dim, M: Measure>(self, dim: D) {
        let mut kept = W::Kept::<M>::default();
        for (query, found) in self.queries.iter().zip(self.found) {
            *found = Some(self.work.answer::<D, M>(self.search, dim, *query, &mut kept));
        }
    }

    #[inline(always)]
    fn in_dim<D: Dim>(self, dim: D) {
        match self.search.items {
            Items::Points => self.answer::<D, Squares>(dim),
            _ => self.answer::<D, Surfaces<Squares>>(dim),
        }
    }
}

impl<W: Work> WithSimd for Task<'_, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let dim = AnyDim(self.search.dim());
        match unrolled::<S>(dim.0) {
            Some(2) => self.in_dim(Fixed::<2>),
            Some(3) => self.in_dim(Fixed::<3>),
            _ => self.in_dim(dim),
        }
    }
}
