//! Whether the sites set aside are too few, and too far from each other, to be a curve that was missed.

use std::collections::HashMap;

use taut_oblivious::hilbert_order;

use super::nearest::{Segments, Spot};
use crate::curve::index::Index;

/// At most this share of the sites may be outliers.
const OUTLIER_RATIO_MAX: f64 = 0.2;
/// Outliers that may be linked with each other.
const LINKED_MOST: usize = 9;
/// A link has this length, over the gap that 95 of 100 samples have at most, with some room.
const LINK_RATIO: f64 = 1.55;
/// Outliers this near, over the band, belong to the noise of the curve. Nothing is claimed where roundings decide of one.
const OWN_BAND_RATIO: f64 = 2.0;
const ROUNDING: f64 = 1e-9;
/// One in this many sites may be that near, and some more by chance.
const SITES_PER_TAIL_OUTLIER: usize = 1010;
/// This many deviations more may be that near by chance.
const CHANCE_DEVIATIONS: f64 = 3.9;

/// Outliers of the band itself: so many, or one in so many sites.
const INSIDE_LEAST: usize = 7;
const SITES_PER_NEAR_OUTLIER: usize = 51;
/// From so many outliers on it is asked how they are scattered: their mean distance from the next over that of chance, a little more than
/// what the checker asks for.
const SCATTERED_FROM: usize = 8;
const NEAR_LEAST: f64 = 0.76;
/// How many others chance puts into the circles around outliers in which they are counted, and ln of how seldom it may put more than there
/// are, with some room.
const BY_CHANCE: [f64; 7] = [0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
const FILL_RARITY: f64 = 5.5;

pub(super) fn are_harmless(
    segments: &Segments,
    sites: &[[f64; 2]],
    spots: &[Option<Spot>],
    mut gaps: Vec<f64>,
    band: f64,
) -> bool {
    let outliers = spots.iter().filter(|spot| spot.is_none()).count();
    if outliers as f64 > OUTLIER_RATIO_MAX * sites.len() as f64 {
        return false;
    }
    let at = gaps.len() * 19 / 20;
    let usual = match at < gaps.len() {
        true => *gaps.select_nth_unstable_by(at, f64::total_cmp).1,
        false => 0.0,
    };
    let link = (band * 1.01).max(LINK_RATIO * usual);
    let scaled = |site: usize| sites[site].map(|x| x * segments.scale);
    let none = || (0..sites.len()).filter(|&site| spots[site].is_none()).map(scaled);
    let (mut far, mut inside, mut beside) = (Vec::new(), 0, 0);
    for p in none() {
        match segments.next_to(p, usize::MAX, (OWN_BAND_RATIO + ROUNDING) * band) {
            None => far.push(p),
            Some(spot) if spot.distance >= (OWN_BAND_RATIO - ROUNDING) * band => return false,
            Some(spot) if spot.distance <= 1.001 * band => inside += 1,
            Some(_) => beside += 1,
        }
    }
    let lengths = segments.ends.iter().map(|[a, b]| (b[0] - a[0]).hypot(b[1] - a[1]));
    let around = 2.0 * band * lengths.sum::<f64>();
    let mut frame = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    for [x, y] in segments.ends.iter().flatten().copied().chain(none()) {
        frame = [frame[0].min(x), frame[1].min(y), frame[2].max(x), frame[3].max(y)];
    }
    let whole = (frame[2] - frame[0]) * (frame[3] - frame[1]);
    let area = (whole - OWN_BAND_RATIO * around).max(0.25 * whole);
    let by_chance = far.len() as f64 * (OWN_BAND_RATIO - 1.0) * around / area;
    let beside_most = by_chance
        + CHANCE_DEVIATIONS * by_chance.sqrt()
        + INSIDE_LEAST.max(sites.len() / SITES_PER_TAIL_OUTLIER) as f64;
    inside <= INSIDE_LEAST.max(sites.len() / SITES_PER_NEAR_OUTLIER)
        && f64::from(beside) <= beside_most
        && are_apart(&far, link)
        && are_scattered(&far, area)
}

/// Whether points are as far from each other as chance would put them in an area: on average, and in no circle more than chance puts
/// there.
fn are_scattered(far: &[[f64; 2]], area: f64) -> bool {
    if far.len() < SCATTERED_FROM {
        return true;
    }
    let each = area / far.len() as f64;
    let usual = 0.5 * each.sqrt();
    let mut places = far.to_vec();
    places.sort_unstable_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    places.dedup();
    let order = hilbert_order(places.len(), |i| places[i]);
    let places: Vec<[f64; 2]> = order.iter().map(|&i| places[i as usize]).collect();
    let index = Index::new(&places);
    let many = places.len() as f64;
    let most = (far.len() as f64 * BY_CHANCE.len() as f64).ln() + FILL_RARITY;
    let mut sum = 0.0;
    for &p in &places {
        let mut least = 4.0 * usual;
        // Smaller circles first: one that is full already is the end.
        for (k, by_chance) in BY_CHANCE.into_iter().enumerate() {
            let square = 1.001 * by_chance * each / std::f64::consts::PI;
            let mut count = -1.0;
            index.within(p, square, &mut |place| {
                count += 1.0;
                let [x, y] = places[place as usize];
                let apart = (x - p[0]).hypot(y - p[1]);
                // The widest circle holds all that are as near as that.
                if k + 1 == BY_CHANCE.len() && apart > 0.0 {
                    least = least.min(apart);
                }
            });
            if count > by_chance && count * (count / by_chance).ln() - (count - by_chance) > most {
                return false;
            }
        }
        sum += least;
    }
    let needed = NEAR_LEAST.min(1.01 - 4.0 * 0.52 / many.sqrt());
    sum / many >= needed * usual
}

/// Whether no more than a few points are linked one by one.
fn are_apart(points: &[[f64; 2]], link: f64) -> bool {
    let cell = |p: [f64; 2]| p.map(|x| (x / link).floor() as i64);
    let mut cells: HashMap<[i64; 2], Vec<u32>> = HashMap::new();
    for (k, &p) in points.iter().enumerate() {
        let members = cells.entry(cell(p)).or_default();
        members.push(k as u32);
        // Four cells of half the width have more than 9 in one of them.
        if members.len() > 4 * LINKED_MOST {
            return false;
        }
    }
    // From every point, all that it is linked with.
    let mut seen = vec![false; points.len()];
    let mut open = Vec::new();
    for start in 0..points.len() {
        if std::mem::replace(&mut seen[start], true) {
            continue;
        }
        open.push(start);
        let mut linked = 0;
        while let Some(k) = open.pop() {
            linked += 1;
            if linked > LINKED_MOST {
                return false;
            }
            let p = points[k];
            let [x, y] = cell(p);
            for near in (-1..=1).flat_map(|i| (-1..=1).map(move |j| [i, j])) {
                let key = [x.saturating_add(near[0]), y.saturating_add(near[1])];
                for &other in cells.get(&key).into_iter().flatten() {
                    let q = points[other as usize];
                    let is_near = (p[0] - q[0]).hypot(p[1] - q[1]) <= link;
                    if is_near && !std::mem::replace(&mut seen[other as usize], true) {
                        open.push(other as usize);
                    }
                }
            }
        }
    }
    true
}
