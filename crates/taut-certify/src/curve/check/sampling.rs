//! How far apart samples are along a curve, how far off, and what lies across their band.

use super::super::CurveDoubt;
use super::band::Foot;
use super::features::Features;
use super::valley::valley;

/// A gap is compared with this many gaps on either side.
const NEIGHBOR_GAPS: usize = 32;

/// −ln of how seldom chance may leave a gap as long, where vertices are rows and where they are not: of curves with rows at random seven and
/// twelve in a thousand have such a gap, of those with more even rows fewer.
pub(super) const GAP_RARITY: f64 = 6.0;
pub(super) const NOISY_GAP_RARITY: f64 = 5.25;

/// Rows across whose offsets bands are sought: short windows follow the curve, long ones find thin gaps. The last is all rows.
const WINDOWS: [usize; 5] = [64, 128, 512, 2048, usize::MAX];

/// Neighbors are compared along windows of this many rows.
const WINDOW_ROWS: usize = 128;

/// ln of how seldom chance may leave any of the windows of a curve with this few rows between two bands.
const VALLEY_RARITY: f64 = 4.0;

/// The least that squared differences of neighbors may be on average, over twice the variance. Of 128 numbers that chance orders it is
/// 1 ± 0.09, normal or uniform: less than this once in 10⁸ windows.
const WINDING_LEAST: f64 = 0.5;

/// Where on a curve something is largest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worst {
    pub(super) value: f64,
    /// Vertex or row.
    pub(super) at: usize,
}

impl Worst {
    pub(super) const NONE: Worst = Worst { value: 0.0, at: 0 };

    fn see(&mut self, value: f64, at: usize) {
        if value > self.value {
            *self = Worst { value, at };
        }
    }
}

/// A row on a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// The way along the curve to its place.
    pub(super) along: f64,
    /// The vertex before its place.
    pub(super) vertex: usize,
    pub(super) offset: f64,
    pub(super) row: usize,
}

/// The samples of a curve in the order of their places.
pub(super) fn ordered(feet: &[Foot], first_edge: usize, features: &Features) -> Vec<Sample> {
    let mut samples: Vec<Sample> = feet
        .iter()
        .map(|foot| {
            let vertex = foot.edge - first_edge;
            let (from, to) = (features.along[vertex], features.along[vertex + 1]);
            let along = from + foot.t * (to - from);
            Sample { along, vertex, offset: foot.offset, row: foot.row }
        })
        .collect();
    // Many have one foot, a vertex.
    samples.sort_unstable_by(|a, b| {
        let by_place = a.along.total_cmp(&b.along).then(a.offset.total_cmp(&b.offset));
        by_place.then(a.row.cmp(&b.row))
    });
    samples
}

/// The largest half gap over the least φ in it, and the vertex that it begins after.
pub(super) fn sampling_ratio(samples: &[Sample], features: &Features) -> Worst {
    let (mut worst, count) = (Worst::NONE, features.size.len());
    for (gap, from, to) in gaps(samples, features) {
        let last = to + 1 + if to < from || samples.len() == 1 { count } else { 0 };
        let least = (from..=last).map(|k| features.size[k % count]).fold(f64::INFINITY, f64::min);
        if gap > 0.0 {
            worst.see(gap / (2.0 * least), from);
        }
    }
    worst
}

/// The gaps around the curve, each with the vertices before its two ends.
fn gaps<'a>(
    samples: &'a [Sample],
    features: &'a Features,
) -> impl Iterator<Item = (f64, usize, usize)> + 'a {
    let length = features.along[features.size.len()];
    samples.iter().enumerate().map(move |(k, sample)| match samples.get(k + 1) {
        Some(next) => (next.along - sample.along, sample.vertex, next.vertex),
        None => (samples[0].along + length - sample.along, sample.vertex, samples[0].vertex),
    })
}

/// The lengths of all gaps.
pub(super) fn lengths(samples: &[Sample], features: &Features) -> Vec<f64> {
    gaps(samples, features).map(|gap| gap.0).collect()
}

/// Gaps that are more even are supposed to have this coefficient of variation.
const VARIATION_MIN: f64 = 0.1;

/// A gap so much longer than those beside it that chance would make one in few curves sampled as these are.
///
/// Of n independent gaps one is t times as long as the mean s of k others with a probability of about n·(1 + t/k)⁻ᵏ. Gaps with a
/// coefficient of variation c below 1 leave less to chance: 1 + (g/s − 1)/c takes the place of t.
pub(super) fn wide_gap(
    curve: usize,
    samples: &[Sample],
    features: &Features,
    rarity_most: f64,
) -> Option<CurveDoubt> {
    let gaps: Vec<(f64, usize, usize)> = gaps(samples, features).collect();
    let (count, mut worst) = (gaps.len(), (rarity_most, None));
    let beside = NEIGHBOR_GAPS.min((count - 1) / 2);
    for (k, &(gap, vertex, _)) in gaps.iter().enumerate() {
        let near = || {
            let steps = (1..=beside).flat_map(|step| [k + step, k + count - step]);
            steps.map(|k| gaps[k % count].0)
        };
        let many = (2 * beside) as f64;
        let mean = near().sum::<f64>() / many;
        // Most are shorter than twice the mean, and none of those is seldom.
        if gap <= 2.0 * mean || gap == 0.0 {
            continue;
        }
        let variance = near().map(|gap| (gap - mean).powi(2)).sum::<f64>() / many;
        let varied = (variance.sqrt() / mean).clamp(VARIATION_MIN, 1.0);
        let times = 1.0 + (gap / mean - 1.0) / varied;
        let rarity = many * (times / many).ln_1p() - (count as f64).ln();
        if rarity > worst.0 {
            worst = (rarity, Some(CurveDoubt::Lacuna { curve, vertex, times: gap / mean }));
        }
    }
    worst.1
}

/// The largest distance of a row over φ at its place, and the row.
pub(super) fn noise_ratio(samples: &[Sample], features: &Features) -> Worst {
    let (mut worst, count) = (Worst::NONE, features.size.len());
    for sample in samples.iter().filter(|sample| sample.offset != 0.0) {
        let least = features.size[sample.vertex].min(features.size[(sample.vertex + 1) % count]);
        worst.see(sample.offset.abs() / least, sample.row);
    }
    worst
}

/// Two bands with fewer rows between them than either holds, more so than chance would have it.
pub(super) fn split(curve: usize, samples: &[Sample]) -> Option<CurveDoubt> {
    let most = (samples.len() as f64).ln() + VALLEY_RARITY;
    let mut offsets = Vec::new();
    for window in WINDOWS.map(|window| window.min(samples.len())) {
        let (mut worst, mut share) = (Worst::NONE, 0.0);
        for start in (0..samples.len()).step_by(window.div_ceil(2)) {
            offsets.clear();
            let around = start..start + window;
            offsets.extend(around.map(|k| samples[k % samples.len()].offset));
            offsets.sort_unstable_by(f64::total_cmp);
            let valley = valley(&offsets);
            if valley.evidence > worst.value {
                share = valley.density;
            }
            worst.see(valley.evidence, samples[start].vertex);
        }
        if worst.value > most {
            return Some(CurveDoubt::Split { curve, vertex: worst.at, share });
        }
    }
    None
}

/// Rows that lie off the curve together with their neighbors.
pub(super) fn winding(curve: usize, samples: &[Sample]) -> Option<CurveDoubt> {
    let mut places: Vec<(f64, f64, usize)> =
        samples.iter().map(|sample| (sample.along, sample.offset, sample.vertex)).collect();
    // Rows that are the same point are one.
    places.dedup_by(|b, a| (a.0, a.1) == (b.0, b.1));
    let mut worst = (1.0f64, 0);
    for start in (0..places.len()).step_by(WINDOW_ROWS / 2) {
        let at = |k: usize| places[(start + k) % places.len()].1;
        let mean = (0..WINDOW_ROWS).map(at).sum::<f64>() / WINDOW_ROWS as f64;
        let variance: f64 = (0..WINDOW_ROWS).map(|k| (at(k) - mean).powi(2)).sum();
        let steps: f64 = (1..WINDOW_ROWS).map(|k| (at(k) - at(k - 1)).powi(2)).sum();
        let share = steps / (2.0 * variance);
        if share < worst.0 {
            worst = (share, places[start].2);
        }
    }
    let (share, vertex) = worst;
    (share < WINDING_LEAST).then_some(CurveDoubt::Winding { curve, vertex, share })
}
