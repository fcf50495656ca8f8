//! Points inside of a polygon from which ascents start.

use crate::polygon::Segment;

/// Lines along each axis on which middles of the polygon are starts.
const LINES: usize = 16;

/// The middles of the parts of horizontal and vertical lines that are inside.
pub(crate) fn inner_points(edges: &[Segment], extent: [f64; 2]) -> Vec<[f64; 2]> {
    let mut found = vec![];
    for axis in 0..2 {
        let other = 1 - axis;
        for line in 0..LINES {
            let level = extent[axis] * (line as f64 + 0.5) / LINES as f64;
            let crossing = |[a, b]: &Segment| {
                let crosses = (a[axis] <= level) != (b[axis] <= level);
                let share = (level - a[axis]) / (b[axis] - a[axis]);
                crosses.then(|| a[other] + share * (b[other] - a[other]))
            };
            let mut crossings: Vec<f64> = edges.iter().filter_map(crossing).collect();
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let mut center = [level; 2];
                center[other] = 0.5 * (pair[0] + pair[1]);
                found.push(center);
            }
        }
    }
    found
}
