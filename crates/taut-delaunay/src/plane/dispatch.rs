//! One choice per batch: whether the processor fuses multiplication and addition.
//!
//! The signs that a filter is sure of are true in either case, so the meshes are the same. Fused operations, and the
//! three-operand instructions that come with them, take a twentieth off the time of a build.
#![allow(unsafe_code)]

use taut_predicates::Separate;

use super::Mesh;

pub(super) fn insert(mesh: &mut Mesh, sites: &[u32]) {
    #[cfg(target_arch = "x86_64")]
    if mesh.settings.vectors && is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
    {
        // SAFETY: the processor has both features the function is compiled for.
        return unsafe { insert_avx2(mesh, sites) };
    }
    #[cfg(target_arch = "aarch64")]
    if mesh.settings.vectors {
        // Every such processor has the fused instruction.
        return mesh.insert_all::<taut_predicates::Fused>(sites);
    }
    mesh.insert_all::<Separate>(sites);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn insert_avx2(mesh: &mut Mesh, sites: &[u32]) {
    mesh.insert_all::<taut_predicates::Fused>(sites);
}
