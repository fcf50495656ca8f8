//! Whether outliers could be the samples of a curve that was missed.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use taut_points::OrderBy;

use super::super::CurveDoubt;
use super::arcs;
use super::band::{Placed, nearest};
use super::edges::Edges;

/// At most this part of the rows may be outliers.
const OUTLIER_RATIO_MAX: f64 = 0.2;

/// Outliers that may lie as near to each other as samples do.
const CLUSTER_MOST: usize = 9;

/// How near outliers must be to each other to be linked, over the gap that 95 of 100 samples have at most to the next.
const LINK_RATIO: f64 = 1.5;

/// Fewest outliers of which it is asked whether they are spread as chance would, and how near they may be to each other on average, over
/// what chance makes it.
const OUTLIERS_MIN: usize = 8;
const NEAR_LEAST: f64 = 0.75;

/// Parts of the outliers that chance puts as near to their next.
const NEXT_SHARES: [f64; 3] = [0.1, 0.2, 0.4];
/// −ln of how seldom chance may put as many more there: neighbors that name each other count twice, so it is half of this. Of a thousand
/// simulated sets one is doubted.
const NEXT_RARITY: f64 = 10.0;

/// In circles around outliers, in which chance puts so many others, those that there are are counted.
const EXPECTED: [f64; 7] = [0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0];

/// −ln of how seldom chance may fill any of these circles so; chosen on the draws of the example
/// `curve_rates` of `taut-reconstruct`.
const FILL_RARITY: f64 = 6.5;

/// Fewest and most outliers far from all curves that are too few to tell from the samples of a small curve: more show how they are spread.
const HANDFUL: std::ops::Range<usize> = 4..24;

/// Outliers nearer to the curve than this times what nine of ten rows are off it are counted along it.
const NEAR_BAND_RATIO: f64 = 6.0;
/// −ln of how seldom chance may gather as many in one stretch: of 400 simulated curves at most one is doubted.
const NEAR_RARITY: f64 = 6.0;
/// Each number of outliers in a stretch that is tried is greater than the one before by one of so many parts; the first is half of
/// [`OUTLIERS_MIN`].
const COUNT_STEPS: usize = 4;

/// Half the width of the band along an arc of outliers, over what nine of ten rows are off their curve: the noise of uniform bands has its
/// edge at 10/9 of that.
const ARC_WIDTH_RATIO: f64 = 1.15;

/// Chance links outliers, too: not where each has this many others within reach on average.
const CHANCE_NEIGHBORS_MAX: f64 = 0.15;

/// One of this many rows may be said to be an outlier though it is no farther from the curve than others are.
const ROWS_PER_NEAR_OUTLIER: usize = 50;

/// Outliers nearer to the curve than this times the band are its own: noise has tails.
const OWN_BAND_RATIO: f64 = 2.0;
/// One of this many rows may be such an outlier of the curve's own.
const ROWS_PER_TAIL_OUTLIER: usize = 1000;

/// The first reason to think that outliers are more than that, `gaps` being those between samples and `band` that of the noise.
pub(super) fn doubt(
    edges: &Edges,
    placed: &Placed,
    mut gaps: Vec<f64>,
    band: f64,
) -> Option<CurveDoubt> {
    let outliers = placed.outliers.len();
    let rows = outliers + placed.inliers.len();
    if outliers as f64 > OUTLIER_RATIO_MAX * rows as f64 {
        return Some(CurveDoubt::Outliers { outliers: outliers as u64, rows: rows as u64 });
    }
    gaps.sort_by(f64::total_cmp);
    let usual = gaps.get(gaps.len() * 19 / 20).copied().unwrap_or(0.0);
    let link = band.max(LINK_RATIO * usual);
    let (mut far, mut inside, mut beside) = (vec![], 0u32, 0u32);
    for &(row, place) in &placed.outliers {
        if nearest(edges, place, OWN_BAND_RATIO * band).is_none() {
            far.push((row, place));
        } else if nearest(edges, place, band).is_some() {
            inside += 1;
        } else {
            beside += 1;
        }
    }
    let room = Room::of(edges, placed, band);
    let within: Vec<(usize, [f64; 2])> =
        far.iter().copied().filter(|far| room.holds(far.1)).collect();
    // Outliers fall into the band as they do elsewhere, and stay outliers where it is narrower than where it is widest.
    let chance = within.len() as f64 * room.inside / room.far;
    let most = chance + 4.0 * chance.sqrt() + OUTLIERS_MIN.max(rows / ROWS_PER_NEAR_OUTLIER) as f64;
    if f64::from(inside) > most {
        return Some(CurveDoubt::Inside { outliers: u64::from(inside) });
    }
    // Those that chance puts there, as dense as farther off, four deviations more, and tails.
    let expected = within.len() as f64 * room.beside / room.far;
    let most =
        expected + 4.0 * expected.sqrt() + OUTLIERS_MIN.max(rows / ROWS_PER_TAIL_OUTLIER) as f64;
    if f64::from(beside) > most {
        return Some(CurveDoubt::Beside { outliers: u64::from(beside) });
    }
    if !placed.is_exact && HANDFUL.contains(&far.len()) {
        return Some(CurveDoubt::Handful { outliers: far.len() as u64 });
    }
    let by_chance = (CHANCE_NEIGHBORS_MAX * room.far / (PI * within.len().max(1) as f64)).sqrt();
    cluster(&far, link.min(by_chance)).or_else(|| gathered(&room, &within)).or_else(|| {
        let usual = usual_offset(placed)?;
        near_one_stretch(edges, placed, usual)
            .or_else(|| arcs::arc(&within, room.free, ARC_WIDTH_RATIO * usual))
    })
}

/// The distance from the curves that nine of ten rows do not exceed, under noise.
fn usual_offset(placed: &Placed) -> Option<f64> {
    let mut offsets: Vec<f64> = placed.inliers.iter().map(|foot| foot.offset.abs()).collect();
    let at = offsets.len() * 9 / 10;
    (!placed.is_exact && at < offsets.len())
        .then(|| *offsets.select_nth_unstable_by(at, f64::total_cmp).1)
}

/// Whether outliers near a curve gather in one stretch of it, as they do beside a strand that was left out. Curves follow one another as
/// one line: chance spreads outliers over all of it alike.
fn near_one_stretch(edges: &Edges, placed: &Placed, usual: f64) -> Option<CurveDoubt> {
    let mut ways = vec![0.0];
    for edge in 0..edges.ends.len() {
        let [a, b] = edges.segment(edge);
        ways.push(ways[edge] + (b[0] - a[0]).hypot(b[1] - a[1]));
    }
    let mut near: Vec<(f64, usize)> = vec![];
    for &(row, place) in &placed.outliers {
        if let Some((edge, t)) = nearest(edges, place, NEAR_BAND_RATIO * usual) {
            near.push((ways[edge] + t * (ways[edge + 1] - ways[edge]), row));
        }
    }
    near.order_by(&|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let (many, length) = (near.len(), ways[edges.ends.len()]);
    let most = (many as f64).ln() + NEAR_RARITY;
    let mut count = OUTLIERS_MIN / 2;
    while count <= many {
        for k in 0..many {
            let (last, wraps) = ((k + count - 1) % many, (k + count - 1) / many);
            let stretch = near[last].0 - near[k].0 + length * wraps as f64;
            // As many as chance puts into the stretch of so many; the two at its ends are there by choice.
            let (found, expected) = ((count - 1) as f64, many as f64 * stretch / length);
            if found > expected && chernoff(found, expected) > most {
                let (row, rows) = (near[k].1 as u64, count);
                return Some(CurveDoubt::Gathered { row, rows, near: expected / found });
            }
        }
        count += count / COUNT_STEPS;
    }
    None
}

/// Chernoff's bound of the tail of a Poisson distribution: −ln of the probability of at least so many.
fn chernoff(count: f64, expected: f64) -> f64 {
    count * (count / expected).ln() - (count - expected)
}

/// The box around curves and outliers, but for a few that are alone far off: with them it would be so large that all others were near each
/// other in it.
struct Room {
    low: [f64; 2],
    high: [f64; 2],
    /// The area that no curve's own outliers take up.
    far: f64,
    /// That over the area of the box.
    free: f64,
    /// That of those beyond the band.
    beside: f64,
    /// That of the band.
    inside: f64,
}

impl Room {
    fn of(edges: &Edges, placed: &Placed, band: f64) -> Self {
        let (mut low, mut high, mut length) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2], 0.0);
        let mut take = |p: [f64; 2]| {
            for k in 0..2 {
                (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
            }
            [low, high]
        };
        let mut curves = [[0.0; 2]; 2];
        for [a, b] in (0..edges.ends.len()).map(|edge| edges.segment(edge)) {
            length += (b[0] - a[0]).hypot(b[1] - a[1]);
            take(a);
            curves = take(b);
        }
        let [from, to] = curves;
        let size = (to[0] - from[0]).max(to[1] - from[1]);
        let beyond = |p: [f64; 2]| {
            [0, 1].map(|k| (from[k] - p[k]).max(p[k] - to[k])).into_iter().fold(0.0, f64::max)
        };
        let mut far: Vec<f64> = placed.outliers.iter().map(|&(_, place)| beyond(place)).collect();
        far.sort_unstable_by(|a, b| b.total_cmp(a));
        // The farthest few are left out, and none as far as the next.
        let reach = far.get(HANDFUL.start - 1).map_or(size, |next| next.max(size));
        for &(_, place) in placed.outliers.iter().filter(|out| beyond(out.1) <= reach) {
            take(place);
        }
        let all = (high[0] - low[0]) * (high[1] - low[1]);
        let far = (all - 2.0 * OWN_BAND_RATIO * band * length).max(all / 4.0);
        let inside = 2.0 * band * length;
        let beside = (OWN_BAND_RATIO - 1.0) * inside;
        Self { low, high, far, free: far / all, beside, inside }
    }

    fn holds(&self, p: [f64; 2]) -> bool {
        (0..2).all(|k| (self.low[k]..=self.high[k]).contains(&p[k]))
    }
}

/// Whether outliers lie nearer to each other than chance would put as many of them in the room around all rows that no band takes up
/// (Clark and Evans 1954), on average or somewhere.
fn gathered(room: &Room, far: &[(usize, [f64; 2])]) -> Option<CurveDoubt> {
    let (many, area, low) = (far.len() as f64, room.far, room.low);
    if far.len() < OUTLIERS_MIN {
        return None;
    }
    let usual = 0.5 * (area / many).sqrt();
    let reaches = EXPECTED.map(|expected| (expected * area / (PI * many)).sqrt());
    let most = many.ln() + FILL_RARITY;
    let is_crowd = |count: f64, expected: f64| count > expected && chernoff(count, expected) > most;
    let gathered = |row: usize, near: f64| {
        Some(CurveDoubt::Gathered { row: row as u64, rows: far.len(), near })
    };
    // Cells as wide as the largest circles. Four of those around points of a cell hold all that are in it: where there are so many that one
    // of them is a crowd, it would take long to look through.
    let side = reaches[EXPECTED.len() - 1];
    let cell = |p: [f64; 2]| [0, 1].map(|k| ((p[k] - low[k]) / side).floor() as i64);
    let mut cells: BTreeMap<[i64; 2], Vec<[f64; 2]>> = BTreeMap::new();
    far.iter().for_each(|&(_, p)| cells.entry(cell(p)).or_default().push(p));
    let is_full = |p: [f64; 2]| {
        let in_one = (cells[&cell(p)].len() as f64 / 4.0).floor() - 1.0;
        is_crowd(in_one, EXPECTED[EXPECTED.len() - 1])
    };
    if let Some(&(row, _)) = far.iter().find(|(_, p)| is_full(*p)) {
        return gathered(row, 0.0);
    }
    let (mut distances, mut crowded) = (Vec::with_capacity(far.len()), None);
    for &(row, p) in far {
        let [x, y] = cell(p);
        let (mut next, mut counts) = (4.0 * usual, [0.0; EXPECTED.len()]);
        for (i, j) in (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j))) {
            // Beyond the last cell that has a number there is none.
            let beside = x.checked_add(i).zip(y.checked_add(j));
            let near = beside.and_then(|(x, y)| cells.get(&[x, y]));
            for q in near.into_iter().flatten() {
                let apart = (p[0] - q[0]).hypot(p[1] - q[1]);
                if apart > 0.0 {
                    next = next.min(apart);
                    let first = reaches.partition_point(|&reach| reach < apart);
                    counts[first..].iter_mut().for_each(|count| *count += 1.0);
                }
            }
        }
        distances.push(next);
        if crowded.is_none() && (0..EXPECTED.len()).any(|k| is_crowd(counts[k], EXPECTED[k])) {
            crowded = Some(row);
        }
    }
    // Ascending, so that the sum does not depend on the order of the rows.
    distances.sort_unstable_by(f64::total_cmp);
    let near = distances.iter().sum::<f64>() / many / usual;
    // The mean of so many distances is off by 0.52/√n of itself, by four times that hardly ever.
    let is_gathered = near < NEAR_LEAST.min(1.0 - 4.0 * 0.52 / many.sqrt());
    let is_gathered = is_gathered
        || NEXT_SHARES.iter().any(|share| {
            // Of points at random, so many have their next within t: 1 − exp(−πt²·n/area).
            let t = (-(1.0 - share).ln() * area / (PI * many)).sqrt();
            let (found, expected) = (distances.partition_point(|&x| x < t) as f64, share * many);
            let rest = |found: f64, expected: f64| match found > 0.0 {
                true => found * (found / expected).ln(),
                false => 0.0,
            };
            found > expected
                && rest(found, expected) + rest(many - found, many - expected) > NEXT_RARITY
        });
    match crowded.or(is_gathered.then_some(far[0].0)) {
        Some(row) => gathered(row, near),
        None => None,
    }
}

/// The first cluster of too many points that are linked one by one.
fn cluster(points: &[(usize, [f64; 2])], link: f64) -> Option<CurveDoubt> {
    // Two points of a cell are linked, so a cell of many is a cluster; else there are few pairs to look at.
    let side = link / 2f64.sqrt();
    let mut cells: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
    for (at, (row, place)) in points.iter().enumerate() {
        let cell = cells.entry(place.map(|x| (x / side).floor() as i64)).or_default();
        cell.push(at);
        if cell.len() > CLUSTER_MOST {
            let row = points[cell[0]].0.min(*row) as u64;
            return Some(CurveDoubt::Cluster { row, rows: cell.len() });
        }
    }
    let (mut parent, mut size): (Vec<usize>, Vec<usize>) =
        ((0..points.len()).collect(), vec![1; points.len()]);
    for (&[x, y], cell) in &cells {
        for &one in cell {
            for (i, j) in (-2..=2).flat_map(|i| (-2..=2).map(move |j| (i, j))) {
                let near = cells.get(&[x.saturating_add(i), y.saturating_add(j)]);
                for &other in near.into_iter().flatten().filter(|&&other| other < one) {
                    let [p, q] = [points[one].1, points[other].1];
                    if (p[0] - q[0]).hypot(p[1] - q[1]) > link {
                        continue;
                    }
                    let (a, b) = (root(&mut parent, one), root(&mut parent, other));
                    let (first, second) = (a.min(b), a.max(b));
                    if first == second {
                        continue;
                    }
                    parent[second] = first;
                    size[first] += size[second];
                    if size[first] > CLUSTER_MOST {
                        let (row, rows) = (points[first].0 as u64, size[first]);
                        return Some(CurveDoubt::Cluster { row, rows });
                    }
                }
            }
        }
    }
    None
}

fn root(parent: &mut [usize], mut at: usize) -> usize {
    while parent[at] != at {
        parent[at] = parent[parent[at]];
        at = parent[at];
    }
    at
}
