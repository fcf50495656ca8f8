//! NumPy arrays, and the same values without a header.

use taut_points::{Rows, ScalarKind};

use super::{Out, Points};
use crate::Error;

pub(super) fn write(points: &Points<'_>, out: &mut Out<'_>) -> Result<(), Error> {
    let descr = match points.source.scalar() {
        ScalarKind::F32 => "<f4",
        ScalarKind::F64 => "<f8",
    };
    let (n, dim) = (points.source.len(), points.source.dim());
    let mut header =
        format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({n}, {dim}), }}");
    // Spaces and a line feed bring the values to a multiple of 64 bytes, so that they can be mapped.
    let before = 10;
    while (before + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    out.put(b"\x93NUMPY\x01\x00")?;
    out.put(&(header.len() as u16).to_le_bytes())?;
    out.put(header.as_bytes())?;
    write_values(points, out)
}

pub(super) fn write_values(points: &Points<'_>, out: &mut Out<'_>) -> Result<(), Error> {
    points.blocks(|rows| match rows {
        Rows::F32(rows) => out.put(bytemuck::cast_slice(rows.values())),
        Rows::F64(rows) => out.put(bytemuck::cast_slice(rows.values())),
    })
}
