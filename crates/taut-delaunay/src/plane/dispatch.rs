//! One choice per batch: whether the processor fuses multiplication and addition.
//!
//! The signs that a filter is sure of are true in either case, so the meshes are the same. Fused operations, and the
//! three-operand instructions that come with them, take a twentieth off the time of a build.
#![allow(unsafe_code)]

use taut_predicates::Separate;

use super::Mesh;

pub(super) fn insert(mesh: &mut Mesh, sites: &[u32]) {
    match taut_points::instruction_set() {
        _ if !mesh.settings.vectors => mesh.insert_all::<Separate>(sites),
        #[cfg(target_arch = "x86_64")]
        taut_points::InstructionSet::Avx2 | taut_points::InstructionSet::Avx512 => {
            // SAFETY: the processor has the features the function is compiled for.
            unsafe { insert_avx2(mesh, sites) }
        }
        #[cfg(target_arch = "aarch64")]
        taut_points::InstructionSet::Neon => mesh.insert_all::<taut_predicates::Fused>(sites),
        _ => mesh.insert_all::<Separate>(sites),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn insert_avx2(mesh: &mut Mesh, sites: &[u32]) {
    mesh.insert_all::<taut_predicates::Fused>(sites);
}
