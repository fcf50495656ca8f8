//! Which path takes the signs: chosen once per batch of sites.
//!
//! *Idea.* Eight simplices of a list are tested at once with AVX-512, four with AVX2 and FMA; the four facets of a step
//! of the walk are always one vector of four. Everything between `insert` and the arithmetic is inlined into a function
//! compiled for that processor, so there is no call per sign. The formulas are those of `signs`, operation by operation:
//! with fused multiply-add on either side even the same signs are left open.
//! *Trap.* Partial groups are the rule (a cavity tests some 43 simplices in 8 groups), so the caller pads the list and
//! masks the answer; nothing here looks at lengths.

use std::marker::PhantomData;

use taut_predicates::Separate;

use crate::kernel::Settings;
use crate::threads::{Hold, Inserted, Progress};

use super::signs::{Scalar, Unfiltered};
use super::{View, Worker, insert_with};

#[cfg(target_arch = "x86_64")]
mod x86;

/// A path of the signs that this machine can run.
#[derive(Clone, Copy, Debug)]
pub(super) enum Level {
    /// No filter.
    Unfiltered,
    /// One number at a time, on any processor.
    Scalar,
    /// Four numbers at a time.
    #[cfg(target_arch = "x86_64")]
    Four(x86::Avx2),
    /// Eight numbers at a time.
    #[cfg(target_arch = "x86_64")]
    Eight(x86::Avx512),
}

impl Level {
    /// The fastest one allowed.
    pub(super) fn best(settings: Settings) -> Self {
        if !settings.filtered {
            return Level::Unfiltered;
        }
        let all = if settings.vectors { Self::filtered() } else { vec![Level::Scalar] };
        *all.last().expect("the scalar level is always there")
    }

    /// All filtered levels of this machine, the fastest last.
    pub(super) fn filtered() -> Vec<Self> {
        #[cfg(target_arch = "x86_64")]
        let vectors =
            [x86::Avx2::detect().map(Level::Four), x86::Avx512::detect().map(Level::Eight)];
        #[cfg(not(target_arch = "x86_64"))]
        let vectors: [Option<Self>; 0] = [];
        std::iter::once(Level::Scalar).chain(vectors.into_iter().flatten()).collect()
    }
}

/// [`insert_with`], compiled for the level of the mesh.
pub(super) fn insert<H: Hold>(
    view: &View<'_, H::Slot<4>, H::Mark>,
    worker: &mut Worker,
    hold: &mut H,
    sites: &[u32],
    progress: &mut Progress,
) -> Inserted {
    let scalar = Scalar::<Separate>(PhantomData);
    match view.level {
        Level::Unfiltered => insert_with(Unfiltered, view, worker, hold, sites, progress),
        Level::Scalar => insert_with(scalar, view, worker, hold, sites, progress),
        #[cfg(target_arch = "x86_64")]
        Level::Four(yes) => yes.insert(view, worker, hold, sites, progress),
        #[cfg(target_arch = "x86_64")]
        Level::Eight(yes) => yes.insert(view, worker, hold, sites, progress),
    }
}
