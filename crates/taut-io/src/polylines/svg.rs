//! All curves as one path of SVG.
//!
//! *Idea.* The numbers of the path are the coordinates as they are, so that it can be taken out of the file and used elsewhere. Up is
//! down in SVG, which one transformation sets right. The path is drawn as a thin line; filled, it has its holes by the even-odd rule.

use taut_mesh::Polyline;

use super::Text;
use crate::Error;

/// Room around the curves, as a part of the longer side.
const MARGIN: f64 = 0.02;

pub(super) fn write(curves: &[Polyline<'_>], text: &mut Text<'_>) -> Result<(), Error> {
    let [left, bottom, width, height] = frame(curves);
    text.put("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"");
    for (place, value) in [left, -(bottom + height), width, height].into_iter().enumerate() {
        text.put(if place > 0 { " " } else { "" });
        text.number(value);
    }
    text.put(
        "\">\n<path transform=\"scale(1 -1)\" fill=\"none\" fill-rule=\"evenodd\" stroke=\"black\" \
         vector-effect=\"non-scaling-stroke\" stroke-linejoin=\"round\" d=\"",
    );
    let mut first = true;
    for curve in curves {
        for (place, &[x, y]) in curve.vertices.iter().enumerate() {
            text.put(match (place, first) {
                (0, true) => "M",
                (0, false) => "\nM",
                (1, _) => "L",
                _ => " ",
            });
            first = false;
            text.number(x);
            text.put(" ");
            text.number(y);
            text.spill()?;
        }
        // A point alone shows as a dot where its path is closed.
        if curve.closed || curve.vertices.len() == 1 {
            text.put("Z");
        }
    }
    text.put("\"/>\n</svg>\n");
    Ok(())
}

/// Left, bottom, width and height of a view of all curves.
fn frame(curves: &[Polyline<'_>]) -> [f64; 4] {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for at in curves.iter().flat_map(|curve| curve.vertices) {
        for k in 0..2 {
            low[k] = low[k].min(at[k]);
            high[k] = high[k].max(at[k]);
        }
    }
    if low[0] > high[0] {
        return [0.0, 0.0, 1.0, 1.0];
    }
    // Halves, as the sides of a box can be too long for a number.
    let longer = (high[0] / 2.0 - low[0] / 2.0).max(high[1] / 2.0 - low[1] / 2.0);
    let room = if longer > 0.0 { 2.0 * MARGIN * longer } else { 0.5 };
    let finite = |value: f64| value.clamp(f64::MIN, f64::MAX);
    let [left, bottom] = low.map(|x| finite(x - room));
    let [width, height] = [0, 1].map(|k| finite(high[k] - low[k] + 2.0 * room));
    [left, bottom, width, height]
}
