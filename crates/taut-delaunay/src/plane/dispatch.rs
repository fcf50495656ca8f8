//! One choice per batch: whether the processor fuses multiplication and addition.
//!
//! The signs that a filter is sure of are true in either case, so the meshes are the same. Fused operations, and the
//! three-operand instructions that come with them, take a twentieth off the time of a build.
#![allow(unsafe_code)]

use taut_predicates::Separate;

use super::{Shared, Worker, insert_with};
use crate::threads::{Hold, Inserted, Progress};

pub(super) fn insert<H: Hold>(
    shared: &Shared<'_, H::Slot<3>>,
    worker: &mut Worker,
    hold: &mut H,
    sites: &[u32],
    progress: &mut Progress,
) -> Inserted {
    match taut_points::instruction_set() {
        _ if !shared.settings.vectors => {
            insert_with::<Separate, H>(shared, worker, hold, sites, progress)
        }
        #[cfg(target_arch = "x86_64")]
        taut_points::InstructionSet::Avx2 | taut_points::InstructionSet::Avx512 => {
            // SAFETY: the processor has the features the function is compiled for.
            unsafe { insert_avx2(shared, worker, hold, sites, progress) }
        }
        #[cfg(target_arch = "aarch64")]
        taut_points::InstructionSet::Neon => {
            insert_with::<taut_predicates::Fused, H>(shared, worker, hold, sites, progress)
        }
        _ => insert_with::<Separate, H>(shared, worker, hold, sites, progress),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn insert_avx2<H: Hold>(
    shared: &Shared<'_, H::Slot<3>>,
    worker: &mut Worker,
    hold: &mut H,
    sites: &[u32],
    progress: &mut Progress,
) -> Inserted {
    insert_with::<taut_predicates::Fused, H>(shared, worker, hold, sites, progress)
}
