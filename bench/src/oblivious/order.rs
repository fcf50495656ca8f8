//! Points in the order of a curve that fills space, beside CGAL's and beside keys of the crate fast_hilbert.

use super::*;

/// Keys of the crate and numbers, sorted by std.
const CRATE: &str = "fast_hilbert and std's sort";
/// By the curve that has no short steps.
const MORTON: &str = "taut, Z-order";

/// Random points of the square and the cube, and of clouds in the square; no bound is set for them.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.size(1_000_000, 10_000);
    let plane: Vec<[f64; 2]> = points(n, Draw::unit);
    // Dense along two sides, most of all in the corner.
    let dense: Vec<[f64; 2]> = points(n, |draw| draw.unit().powi(8));
    let space: Vec<[f64; 3]> = points(n, Draw::unit);
    let cgal = [
        ["cgal-hilbert-2-median", "cgal-hilbert-2-middle"],
        ["cgal-hilbert-3-median", "cgal-hilbert-3-middle"],
    ];
    case(context, out, "square", &plane, cgal[0], Some(quantized))?;
    case(context, out, "square, x⁸ and y⁸", &dense, cgal[0], Some(quantized))?;
    case(context, out, "cube", &space, cgal[1], None)
}

fn points<const D: usize>(n: usize, number: fn(&mut Draw) -> f64) -> Vec<[f64; D]> {
    let mut draw = Draw(1);
    (0..n).map(|_| std::array::from_fn(|_| number(&mut draw))).collect()
}

/// An order, by an order of points.
type By<const D: usize> = fn(&[[f64; D]]) -> Vec<u32>;

/// All by turns; each order must have every point once. Curves differ, so the length of the way is shown beside.
fn case<const D: usize>(
    context: &Context,
    out: &mut Outcome,
    name: &str,
    points: &[[f64; D]],
    cgal: [&'static str; 2],
    other: Option<By<D>>,
) -> Result<()> {
    // Times, and of each program the mean step from a point to the next.
    let (mut lanes, mut steps) = (Lanes::default(), vec![]);
    let words: Vec<u64> = points.iter().flatten().map(|number| number.to_bits()).collect();
    let mut peers = Peers::start(context, &words, D, &cgal)?;
    let ours: By<D> = |points| hilbert_order(points.len(), |i| points[i]);
    let morton: By<D> = |points| morton_order(points.len(), |i| points[i]);
    let programs = [("taut", Some(ours)), (MORTON, Some(morton)), (CRATE, other)];
    for round in 0..context.runs {
        let mut judge = |name, order: &[u32]| -> Result<()> {
            let mean = walk(points, order);
            ensure!(mean.is_some(), "{name}: a point is lost");
            if round == 0 {
                steps.extend(mean.map(|mean| (name, mean)));
            }
            Ok(())
        };
        for (name, by) in programs {
            let Some(by) = by else { continue };
            have_memory(64 * points.len())?;
            let order = lanes.time(name, || by(points));
            judge(name, &order)?;
        }
        have_memory(64 * points.len())?;
        peers.turn(context, &mut lanes, |name, order| {
            let order: Vec<u32> = order.iter().map(|&word| f64::from_bits(word) as u32).collect();
            judge(name, &order)
        })?;
    }
    let mut table = Table::new("program | a point:ns | ÷ taut:x | mean step ÷ taut's:x");
    let first = steps.first().map_or(f64::NAN, |first| first.1);
    for (program, mean) in &steps {
        table.push(json!({
            "program": program, "a point": lanes.of(program) / points.len() as f64,
            "÷ taut": lanes.faster("taut", program), "mean step ÷ taut's": mean / first, "step": mean,
        }));
    }
    out.table(&format!("{} points: {name}", points.len()), table);
    out.keep(name, lanes.json(points.len()));
    Ok(())
}

/// Cells of a grid of 2³² by 2³² and numbers of points, as one would write it; the numbers are from 0 to 1.
fn quantized(points: &[[f64; 2]]) -> Vec<u32> {
    let key = |(i, point): (usize, &[f64; 2])| {
        let [x, y] = point.map(|number| (number * 4_294_967_296.0) as u32);
        (fast_hilbert::xy2h(x, y, 32), i as u32)
    };
    let mut keys: Vec<(u64, u32)> = points.iter().enumerate().map(key).collect();
    keys.sort_unstable();
    keys.into_iter().map(|(_, i)| i).collect()
}

/// The mean distance between neighbors of the order; `None` unless it has every point once.
fn walk<const D: usize>(points: &[[f64; D]], order: &[u32]) -> Option<f64> {
    if !is_permutation(order.iter().map(|&row| row as usize), points.len()) {
        return None;
    }
    let step = |pair: &[u32]| {
        let [a, b] = [pair[0], pair[1]].map(|i| points[i as usize]);
        (0..D).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
    };
    Some(order.windows(2).map(step).sum::<f64>() / (points.len() - 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lost_point_is_seen() {
        let square = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
        assert_eq!(walk(&square, &[0, 1, 2, 3]), Some(1.0));
        for wrong in [&[0, 1, 2][..], &[0, 1, 2, 2], &[0, 1, 2, 4]] {
            assert_eq!(walk(&square, wrong), None);
        }
        assert!(walk(&square, &quantized(&square.map(|p| p.map(|x| x / 2.0)))).is_some());
    }
}
