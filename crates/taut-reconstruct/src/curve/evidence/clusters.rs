//! Whether the sites set aside are too few, and too far from each other, to be a curve that was missed.

use std::collections::HashMap;

use super::nearest::{Segments, Spot};

/// The share of the sites that may be outliers.
const MOST: f64 = 0.2;
/// Outliers that may be linked with each other.
const LINKED_MOST: usize = 9;
/// The length of a link, over the gap that 95 of 100 samples have at most, with some room.
const LINK: f64 = 1.55;
/// Outliers this near, over the band, belong to the noise of the curve; a little less than twice.
const OWN: f64 = 1.99;

pub(super) fn are_harmless(
    segments: &Segments,
    sites: &[[f64; 2]],
    spots: &[Option<Spot>],
    mut gaps: Vec<f64>,
    band: f64,
) -> bool {
    let outliers = spots.iter().filter(|spot| spot.is_none()).count();
    if outliers as f64 > MOST * sites.len() as f64 {
        return false;
    }
    let at = gaps.len() * 19 / 20;
    let usual = match at < gaps.len() {
        true => *gaps.select_nth_unstable_by(at, f64::total_cmp).1,
        false => 0.0,
    };
    let link = (band * 1.01).max(LINK * usual);
    let scaled = |site: usize| sites[site].map(|x| x * segments.scale);
    let none = (0..sites.len()).filter(|&site| spots[site].is_none()).map(scaled);
    let far: Vec<[f64; 2]> =
        none.filter(|p| segments.next_to(*p, usize::MAX, OWN * band).is_none()).collect();
    are_apart(&far, link)
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
