//! Whether points are the vertices of their curves or may be noisy, told before any curve is known, region by region.
//!
//! *Problem.* Samples without noise need no fit, and a fit of them loses what they show; noisy ones need it. A scene may hold both.
//! *Idea.* Half neighbors, as HNN-Crust finds them, are neighbors along the curve where there is no noise, and the curve turns little from
//! one to the next, or turns the same way for a while. In a band of noise that is wider than points are apart they zigzag. Regions are what
//! the nearest neighbors of each point link; they are told apart only where stretches of points disagree.
//! *Guarantee.* A function of the point set. At most [`SITES_MAX`] points are looked at, so that it costs next to nothing for many.
//! *Trap.* The residual of a parabola over the spacing cannot tell: it is 0.03 to 0.85 on sparse samples without noise, and 0.1 to 0.4 on
//! noise of 0.15 to 0.7 spacings.
//! *Trap.* Rugged borders zigzag as noise of half a spacing does. What a fit leaves of them tells: residuals that follow each other
//! ([`fit::Fitted`](super::fit::Fitted)).

use taut_points::parallel::IntoParallel;

use super::boxes::Bounds;
use super::clean::near::{NONE, Near, distance2};
use super::index::Index;

type Point = [f64; 2];

/// Most points that are looked at, in stretches of [`STRETCH_SITES`].
const SITES_MAX: usize = 1 << 15;

/// Points of a stretch: neighbors along a Hilbert curve.
const STRETCH_SITES: usize = 64;

/// Points turn less than this on the median where they are vertices. Unit: degrees. Measured: 0.4 to 21 of samples at ε of 0.2 to 0.5, 43 to 55
/// of noise of more than 0.7 spacings.
const TURN_MAX: f64 = 26.0;

/// Or less than this, where they turn the same way for long: the sides of turns change at fewer than [`CHANGES_MAX`] of them.
const ROUND_TURN_MAX: f64 = 30.0;
const CHANGES_MAX: f64 = 0.22;

/// Fewest turns that tell anything.
const TURNS_MIN: usize = 12;

/// Nearest neighbors that belong to one region with a point: with 6, bands of noise fall apart. Chosen.
const LINKED_NEIGHBORS: usize = 12;

/// One stretch of so many may disagree by chance; if more do, regions are told apart. Chosen.
const STRETCHES_PER_ODD_ONE: usize = 50;

/// Most of the points have so many equally near neighbors on a lattice, and two at most on a curve.
const LATTICE_NEIGHBORS: usize = 4;

/// How points lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// As vertices of their curves.
    Vertices,
    /// Perhaps as noise does; a fit can tell.
    Doubtful,
}

/// What some points are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Judged {
    /// How they lie.
    pub(super) kind: Kind,
    /// The share of points of which one half neighbor has them for a half neighbor in turn, looked at from one side: 0.88 to 1 of vertices,
    /// 0.7 in wide noise.
    pub(super) mutual_share: f64,
}

/// Regions by what they are.
pub(super) struct Regions {
    /// What each region is.
    pub(super) kinds: Vec<Judged>,
    /// The region of each point; empty where there is one.
    pub(super) region: Vec<u32>,
}

impl Regions {
    fn one(judged: Judged) -> Self {
        Self { kinds: vec![judged], region: Vec::new() }
    }

    /// What all points are, if there is one region.
    pub(super) fn only(&self) -> Option<Judged> {
        let [only] = self.kinds[..] else { return None };
        Some(only)
    }
}

/// How far the way turns at a point, in degrees, and between which points it does.
#[derive(Clone, Copy, Debug)]
struct Turn {
    degrees: f64,
    is_left: bool,
    from: u32,
    to: u32,
}

/// The regions of points in the order of a Hilbert curve.
pub(super) fn regions(points: &[Point]) -> Regions {
    let near = Near::new(points);
    let stretches = points.len().div_ceil(STRETCH_SITES);
    let step = stretches.div_ceil(SITES_MAX / STRETCH_SITES).max(1);
    let is_seen = |site: u32| (site as usize / STRETCH_SITES).is_multiple_of(step);
    let turns = turns(&near, is_seen);
    let whole = judge(&turns, (0..points.len()).filter(|&site| is_seen(site as u32)));
    let kinds: Vec<Judged> = (0..stretches)
        .step_by(step)
        .filter_map(|stretch| {
            let sites = stretch * STRETCH_SITES..points.len().min((stretch + 1) * STRETCH_SITES);
            judge(&turns, sites)
        })
        .collect();
    let few = Judged { kind: Kind::Vertices, mutual_share: 1.0 };
    let Some(whole) = whole else { return Regions::one(few) };
    let odd = kinds.iter().filter(|judged| judged.kind != whole.kind).count();
    if odd * STRETCHES_PER_ODD_ONE <= kinds.len() {
        return Regions::one(whole);
    }
    let (region, count) = linked(points);
    let mut members: Vec<Vec<usize>> = vec![vec![]; count];
    region.iter().enumerate().for_each(|(site, &region)| members[region as usize].push(site));
    let kinds: Vec<Judged> = members
        .into_iter()
        .map(|sites| judge(&turns, sites.into_iter()).unwrap_or(whole))
        .collect();
    let kind = kinds[0].kind;
    if kinds.iter().all(|judged| judged.kind == kind) {
        return Regions::one(Judged { kind, ..whole });
    }
    Regions { kinds, region }
}

/// Whether most points have as many neighbors at one distance as those of a lattice do: no curve passes through all of them.
pub(super) fn are_lattice(points: &[Point]) -> bool {
    /// Points looked at.
    const PLACES: usize = 256;
    /// Equal but for rounding.
    const EQUAL_RATIO_MAX: f64 = 1.0 + 1e-9;
    let index = Index::new(points);
    let (mut looked_at, mut full, mut found) = (0, 0, vec![]);
    for &at in points.iter().step_by(points.len().div_ceil(PLACES).max(1)) {
        found.clear();
        index.nearest(at, LATTICE_NEIGHBORS + 1, &mut found);
        looked_at += 1;
        let is_full = found.len() > LATTICE_NEIGHBORS
            && found[LATTICE_NEIGHBORS].0 <= EQUAL_RATIO_MAX * found[1].0;
        full += usize::from(is_full);
    }
    2 * full > looked_at
}

/// For each point seen how the way from one of its half neighbors to the other turns at it.
fn turns(near: &Near<'_>, is_seen: impl Fn(u32) -> bool + Sync) -> Vec<Option<Turn>> {
    let at = |site: u32| near.sites[site as usize];
    let first = near.nearest(&is_seen, |_| |_, d2| d2, |_| |_: &Bounds| true);
    let across = |p: u32| {
        let [p, n] = [p, first[p as usize]].map(at);
        let apart = distance2(p, n);
        move |s: Point, d2: f64| if distance2(n, s) > apart.max(d2) { d2 } else { f64::INFINITY }
    };
    let second = near.nearest(|p| first[p as usize] != NONE, across, |_| |_: &Bounds| true);
    let turn = |p: usize| {
        let (from, to) = (first[p], second[p]);
        if from == NONE || to == NONE {
            return None;
        }
        let [a, p, b] = [from, p as u32, to].map(at);
        let (u, v) = ([p[0] - a[0], p[1] - a[1]], [b[0] - p[0], b[1] - p[1]]);
        let (cross, dot) = (u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
        Some(Turn { degrees: cross.abs().atan2(dot).to_degrees(), is_left: cross > 0.0, from, to })
    };
    (0..first.len()).into_par_iter().map(turn).collect()
}

/// What some points are by their turns; none where there are too few.
fn judge(turns: &[Option<Turn>], sites: impl Iterator<Item = usize>) -> Option<Judged> {
    let (mut degrees, mut changes, mut pairs) = (vec![], 0usize, 0usize);
    for (site, turn) in sites.filter_map(|site| turns[site].map(|turn| (site as u32, turn))) {
        degrees.push(turn.degrees);
        // Each point looks ahead: it is passed from its nearest neighbor to the other, and the next one is passed on from it.
        if let Some(next) = turns[turn.to as usize] {
            let is_forth = next.from == site;
            if is_forth || next.to == site {
                pairs += 1;
                changes += usize::from((next.is_left == is_forth) != turn.is_left);
            }
        }
    }
    if degrees.len() < TURNS_MIN {
        return None;
    }
    let at = degrees.len() / 2;
    let (_, &mut median, _) = degrees.select_nth_unstable_by(at, f64::total_cmp);
    let is_round = (changes as f64) < CHANGES_MAX * pairs as f64;
    let is_smooth = median < TURN_MAX || median < ROUND_TURN_MAX && is_round;
    let kind = if is_smooth { Kind::Vertices } else { Kind::Doubtful };
    Some(Judged { kind, mutual_share: pairs as f64 / degrees.len() as f64 })
}

/// The region of each point by links to nearest neighbors, numbered by first points, and how many there are.
fn linked(points: &[Point]) -> (Vec<u32>, usize) {
    let links = Index::new(points).neighbors_of_all(LINKED_NEIGHBORS + 1, |found| {
        found.iter().map(|near| near.1).collect::<Vec<u32>>()
    });
    let mut parent: Vec<u32> = (0..points.len() as u32).collect();
    fn root(parent: &mut [u32], mut at: u32) -> u32 {
        while parent[at as usize] != at {
            parent[at as usize] = parent[parent[at as usize] as usize];
            at = parent[at as usize];
        }
        at
    }
    for (site, others) in (0u32..).zip(&links) {
        for &other in others {
            let (a, b) = (root(&mut parent, site), root(&mut parent, other));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    let (mut number, mut count) = (vec![NONE; points.len()], 0);
    let region = (0..points.len() as u32)
        .map(|site| {
            let root = root(&mut parent, site) as usize;
            if number[root] == NONE {
                (number[root], count) = (count, count + 1);
            }
            number[root]
        })
        .collect();
    (region, count as usize)
}

#[cfg(test)]
mod tests {
    use taut_oblivious::hilbert_order;
    use taut_points::generate::curves::{CurveNoise, TestCurve, epsilon_sample, sample_curve};

    use super::*;

    fn sorted(values: &[f64]) -> Vec<Point> {
        let points: &[Point] = values.as_chunks().0;
        let order = hilbert_order(points.len(), |i| points[i]);
        order.iter().map(|&i| points[i as usize]).collect()
    }

    fn judged(values: &[f64]) -> Option<Kind> {
        regions(&sorted(values)).only().map(|judged| judged.kind)
    }

    #[test]
    fn samples_are_vertices_and_wide_noise_is_doubtful() {
        for name in ["circle", "flower5", "bumpy", "gear20", "multi4"] {
            let truth = TestCurve::named(name).expect("a known name").build_with(3000);
            // Beyond, a circle turns more than noise does at the least; what a fit leaves of it tells then.
            for epsilon in [0.03, 0.1, 0.2] {
                let values = epsilon_sample(&truth, epsilon, 1).points;
                assert_eq!(judged(&values), Some(Kind::Vertices), "{name} {epsilon}");
            }
            for per in [30.0, 100.0, 1000.0] {
                let n = ((per * truth.length_over_feature) as usize).clamp(200, 50_000);
                for outliers in [0.0, 0.2] {
                    let noise = CurveNoise { delta: 0.05, outliers, ..CurveNoise::default() };
                    let values = sample_curve(&truth, n, &noise, 1).points;
                    assert_eq!(judged(&values), Some(Kind::Doubtful), "{name} {per} {outliers}");
                }
            }
        }
    }

    #[test]
    fn two_scenes_side_by_side_are_two_regions() {
        let truth = TestCurve::named("bumpy").expect("a known name").build_with(3000);
        let mut values = epsilon_sample(&truth, 0.2, 1).points;
        let noise = CurveNoise { delta: 0.05, ..CurveNoise::default() };
        let n = (40.0 * truth.length_over_feature) as usize;
        let noisy = sample_curve(&truth, n, &noise, 1).points;
        values.extend(noisy.chunks_exact(2).flat_map(|p| [p[0] + 100.0, p[1]]));
        let points = sorted(&values);
        let found = regions(&points);
        assert!(found.only().is_none());
        for (p, &region) in points.iter().zip(&found.region) {
            let expected = if p[0] > 50.0 { Kind::Doubtful } else { Kind::Vertices };
            assert_eq!(found.kinds[region as usize].kind, expected, "{p:?}");
        }
    }

    #[test]
    fn grids_are_lattices_and_curves_are_not() {
        let grid: Vec<f64> =
            (0..900).flat_map(|i| [f64::from(i % 30), f64::from(i / 30)]).collect();
        assert!(are_lattice(&sorted(&grid)));
        let truth = TestCurve::named("circle").expect("a known name").build_with(3000);
        assert!(!are_lattice(&sorted(&epsilon_sample(&truth, 0.2, 1).points)));
        assert!(!are_lattice(&[]) && !are_lattice(&[[1.0, 2.0]]));
    }

    #[test]
    fn half_neighbors_are_mutual_of_vertices_and_not_in_wide_noise() {
        let share = |values: &[f64]| {
            regions(&sorted(values)).only().map_or(f64::NAN, |judged| judged.mutual_share)
        };
        for name in ["circle", "flower5", "bumpy", "multi4"] {
            let truth = TestCurve::named(name).expect("a known name").build_with(3000);
            let sample = share(&epsilon_sample(&truth, 0.3, 1).points);
            assert!(sample > 0.95, "{name}: {sample}");
            let noise = CurveNoise { delta: 0.05, ..CurveNoise::default() };
            let n = ((300.0 * truth.length_over_feature) as usize).clamp(200, 50_000);
            let wide = share(&sample_curve(&truth, n, &noise, 1).points);
            assert!(wide < 0.8, "{name}: {wide}");
        }
    }

    #[test]
    fn few_points_are_vertices() {
        for values in [&[][..], &[1.0, 2.0], &[0.0, 0.0, 1.0, 0.0, 1.0, 1.0]] {
            assert_eq!(judged(values), Some(Kind::Vertices));
        }
    }
}
