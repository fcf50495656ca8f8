//! NumPy arrays, and the same values without a header.

use taut_points::{Rows, ScalarKind};

use super::{OutputFile, Points};
use crate::{Error, NpyArray};

pub(super) fn write(points: &Points<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let dtype = match points.source.scalar() {
        ScalarKind::F32 => "<f4".to_owned(),
        ScalarKind::F64 => "<f8".to_owned(),
    };
    let width = points.source.scalar().size();
    let shape = vec![points.source.len(), points.source.dim() as u64];
    // It is a multiple of 64 bytes, so that the values can be mapped.
    out.put(&NpyArray { dtype, width, fortran: false, shape, offset: 0 }.header())?;
    write_values(points, out)
}

pub(super) fn write_values(points: &Points<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    points.blocks(|rows| match rows {
        Rows::F32(rows) => out.put(bytemuck::cast_slice(rows.values())),
        Rows::F64(rows) => out.put(bytemuck::cast_slice(rows.values())),
    })
}
