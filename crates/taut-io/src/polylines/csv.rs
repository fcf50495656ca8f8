//! A row for each vertex.

use taut_mesh::Polyline;

use super::Text;
use crate::Error;

pub(super) fn write(curves: &[Polyline<'_>], text: &mut Text<'_>) -> Result<(), Error> {
    text.put("curve,closed,x,y\n");
    for (number, curve) in curves.iter().enumerate() {
        let start = format!("{number},{},", u8::from(curve.closed));
        for &[x, y] in curve.vertices {
            text.put(&start);
            text.number(x);
            text.put(",");
            text.number(y);
            text.put("\n");
            text.spill()?;
        }
    }
    Ok(())
}
