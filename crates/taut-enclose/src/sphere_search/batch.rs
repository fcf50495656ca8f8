//! Many queries at once: in spatial order, on all threads, each answer back in the place of its query.
//!
//! *Idea.* Queries are sorted along a Hilbert curve through their first three coordinates, so that one finds in the caches what the
//! one before it read; a task is a fixed number of them.
//! *Guarantee.* Each answer depends on its query alone, so neither tasks nor threads change any.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use taut_certify::Items;
use taut_oblivious::hilbert_order;
use taut_points::ReadError;

use super::dim::{AnyDim, Dim, Fixed};
use super::measure::{Measure, Squares, Surfaces, WideSquares, is_plain};
use super::{QueryOptions, SphereSearch};
use crate::Error;

/// Queries of one task.
const TASK_SIZE: usize = 1 << 10;

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
        query: &[f64],
        kept: &mut Self::Kept<M>,
    ) -> Self::Found;
}

/// The answers to some queries, in their order. A loop, not `map` and `collect`: what these call is compiled without the vectors of
/// the processor.
#[inline(always)]
fn answers<D: Dim, M: Measure, W: Work>(
    work: &W,
    search: &SphereSearch,
    dim: D,
    queries: &[&[f64]],
) -> Vec<W::Found> {
    let mut kept = W::Kept::<M>::default();
    let mut all = Vec::with_capacity(queries.len());
    for query in queries {
        all.push(work.answer::<D, M>(search, dim, query, &mut kept));
    }
    all
}

/// The answer to each query; `width` numbers are a query, and its first ones a place.
pub(super) fn run<W: Work>(
    search: &SphereSearch,
    values: &[f64],
    width: usize,
    options: &QueryOptions<'_>,
    work: &W,
) -> Result<Vec<W::Found>, Error> {
    let order = spatial_order(values, width, search.dim().min(width));
    let tasks: Vec<Vec<W::Found>> = order
        .par_chunks(TASK_SIZE)
        .map(|task| {
            options.monitor.check().map_err(ReadError::from)?;
            let queries: Vec<&[f64]> =
                task.iter().map(|&query| &values[query as usize * width..][..width]).collect();
            let found = run_task(search, &queries, work);
            options.monitor.points(task.len() as u64);
            Ok(found)
        })
        .collect::<Result<_, Error>>()?;
    let mut placed: Vec<(u32, W::Found)> =
        order.into_iter().zip(tasks.into_iter().flatten()).collect();
    placed.par_sort_unstable_by_key(|&(query, _)| query);
    Ok(placed.into_iter().map(|(_, found)| found).collect())
}

fn spatial_order(values: &[f64], width: usize, dim: usize) -> Vec<u32> {
    let at = |i: usize, axis: usize| {
        if axis < dim { values[i * width + axis] } else { 0.0 }
    };
    let len = values.len() / width;
    if dim < 3 {
        hilbert_order(len, |i| [at(i, 0), at(i, 1)])
    } else {
        hilbert_order(len, |i| [at(i, 0), at(i, 1), at(i, 2)])
    }
}

/// Does the work in the measure and the dimension of the tree and the queries.
pub(super) fn run_task<W: Work>(
    search: &SphereSearch,
    queries: &[&[f64]],
    work: &W,
) -> Vec<W::Found> {
    let dim = search.dim();
    if search.is_plain && queries.iter().all(|query| is_plain(query)) {
        return Arch::new().dispatch(Task { search, queries, work });
    }
    match search.items {
        Items::Points => answers::<_, WideSquares, W>(work, search, AnyDim(dim), queries),
        _ => answers::<_, Surfaces<WideSquares>, W>(work, search, AnyDim(dim), queries),
    }
}

/// A task compiled for the vectors of the processor.
struct Task<'a, W> {
    search: &'a SphereSearch,
    queries: &'a [&'a [f64]],
    work: &'a W,
}

impl<W: Work> Task<'_, W> {
    #[inline(always)]
    fn in_dim<D: Dim>(self, dim: D) -> Vec<W::Found> {
        let Task { search, queries, work } = self;
        match search.items {
            Items::Points => answers::<D, Squares, W>(work, search, dim, queries),
            _ => answers::<D, Surfaces<Squares>, W>(work, search, dim, queries),
        }
    }
}

impl<W: Work> WithSimd for Task<'_, W> {
    type Output = Vec<W::Found>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        match self.search.dim() {
            2 => self.in_dim(Fixed::<2>),
            3 => self.in_dim(Fixed::<3>),
            dim => self.in_dim(AnyDim(dim)),
        }
    }
}
