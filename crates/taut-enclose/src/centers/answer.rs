//! From centers in the units of the search to an answer in those of the rows: every reach once more, from the centers as they are
//! returned.

use taut_kernels::{Center, Difference, relative_error};
use taut_points::{OrderBy, exponent_of, two_to};

use super::cloud::{Cloud, Far};
use super::grouping::{Grouping, Served};
use super::items::{ItemSet, Position, Shape, distance};
use super::nearest::{EXACT_DISTANCES, length};
use super::read::Table;
use crate::Error;
use crate::ball::reach_up;

/// At most this many items that may reach as far as the farthest are measured exactly: mostly two or three for each of
/// some centers.
const MEASURED_ITEMS_MAX: usize = 64;
/// Squares of distances below this have lost digits.
const SQUARE_MIN: f64 = 1e-140;

/// The statements about the items.
pub(super) struct ItemReport {
    pub(super) centers: Vec<Vec<f64>>,
    /// The upper bound, not below any reach, exactly or in plain `f64`.
    pub(super) radius: f64,
    pub(super) outliers: Vec<u64>,
    pub(super) assignment: Vec<u32>,
}

/// Measures everything from these centers, of which those that are nearest to nothing are left away.
pub(super) fn answer<P: Position>(
    table: &Table,
    cloud: &Cloud<P>,
    centers: &[P],
    z: usize,
    assignment: bool,
) -> Result<ItemReport, Error> {
    let mut is_used = vec![false; centers.len()];
    cloud.assign(centers, |_, center, _| is_used[center] = true);
    let used =
        centers.iter().zip(is_used).filter(|(_, is_used)| *is_used).map(|(center, _)| center);
    let outside: Vec<Vec<f64>> = used.map(|center| table.bring_out(center.as_ref())).collect();
    if outside.iter().flatten().any(|c| !c.is_finite()) {
        return Err(Error::Overflow);
    }
    let inside: Vec<P> = outside
        .iter()
        .map(|center| {
            let mut inside = P::zeros(table.rows.dim);
            table.bring_in(center, inside.as_mut());
            inside
        })
        .collect();
    if let Some(grouping) = &cloud.grouping {
        return of_groups(table, cloud, grouping, &inside, outside, z, assignment);
    }
    let exact = |item: u32| reach(table, cloud, &inside, &outside, item);

    let far = cloud.farthest(&inside, z.saturating_add(MEASURED_ITEMS_MAX));
    let (left_out, kept) = far.split_at(z.min(far.len()));
    let farthest = kept.first().map_or(0.0, |far| far.reach);
    let doubt = 4.0 * relative_error(table.rows.dim);
    let mut radius = 0.0f64;
    if farthest < SQUARE_MIN {
        // Distances of different sizes than all others: each is measured, by whatever is left of it.
        let left_out: Vec<u32> = left_out.iter().map(|far| far.item).collect();
        let items = (0..cloud.len() as u32).filter(|item| !left_out.contains(item));
        radius = items.map(exact).fold(radius, f64::max);
    } else {
        let near: Vec<&Far> =
            kept.iter().take_while(|far| far.reach >= farthest * (1.0 - doubt)).collect();
        radius = near.iter().map(|far| exact(far.item)).fold(radius, f64::max);
        if near.len() == MEASURED_ITEMS_MAX {
            radius *= 1.0 + doubt;
        }
    }
    if !radius.is_finite() {
        return Err(Error::Overflow);
    }
    let mut outliers: Vec<u64> = left_out
        .iter()
        .filter(|far| exact(far.item) > radius)
        .map(|far| cloud.rows[far.item as usize])
        .collect();
    outliers.sort_unstable();
    let mut numbers = vec![];
    if assignment {
        numbers.resize(cloud.len(), 0);
        cloud.assign(&inside, |item, center, _| numbers[cloud.rows[item] as usize] = center as u32);
    }
    Ok(ItemReport { centers: outside, radius, outliers, assignment: numbers })
}

/// Measures groups: each of its items from the center from which the group reaches least far.
fn of_groups<P: Position>(
    table: &Table,
    cloud: &Cloud<P>,
    grouping: &Grouping<P>,
    inside: &[P],
    outside: Vec<Vec<f64>>,
    z: usize,
    assignment: bool,
) -> Result<ItemReport, Error> {
    let served: Vec<Served> = (0..grouping.len())
        .map(|group| serve(&cloud.items, &grouping.members[group], inside))
        .collect();
    let mut order: Vec<usize> = (0..served.len()).collect();
    order.order_by(&|&a, &b| served[b].reach.total_cmp(&served[a].reach).then(a.cmp(&b)));
    let (left_out, kept) = order.split_at(z.min(order.len()));
    let farthest = kept.first().map_or(0.0, |&group| served[group].reach);
    let doubt = 4.0 * relative_error(table.rows.dim);
    let exact =
        |group: usize, item: u32| reach_from(table, cloud, &outside[served[group].center], item);
    let mut radius = 0.0f64;
    for &group in kept {
        let center = &inside[served[group].center];
        for &item in &grouping.members[group] {
            let distance = length(cloud.items.at(item as usize), center.as_ref());
            let reach = cloud.items.reach_at(item as usize, distance);
            // Short distances have digits of other sizes than all others: each of these is measured.
            if reach >= farthest * (1.0 - doubt) || farthest < SQUARE_MIN {
                radius = radius.max(exact(group, item));
            }
        }
    }
    if !radius.is_finite() {
        return Err(Error::Overflow);
    }
    let is_out = |group: &&usize| {
        grouping.members[**group].iter().any(|&item| exact(**group, item) > radius)
    };
    let items = left_out.iter().filter(is_out).flat_map(|&group| &grouping.members[group]);
    let mut outliers: Vec<u64> = items.map(|&item| cloud.rows[item as usize]).collect();
    outliers.sort_unstable();
    let mut numbers = vec![];
    if assignment {
        numbers.resize(cloud.len(), 0);
        for (served, members) in served.iter().zip(&grouping.members) {
            for &item in members {
                numbers[cloud.rows[item as usize] as usize] = served.center as u32;
            }
        }
    }
    Ok(ItemReport { centers: outside, radius, outliers, assignment: numbers })
}

/// How items are served together, by distances that have their digits whatever their size.
fn serve<P: Position>(items: &ItemSet<P>, members: &[u32], centers: &[P]) -> Served {
    let mut served = Served { center: 0, item: members[0], reach: f64::INFINITY };
    for (number, center) in centers.iter().enumerate() {
        let mut farthest = (members[0], f64::NEG_INFINITY);
        for &item in members {
            let distance = length(items.at(item as usize), center.as_ref());
            let reach = items.reach_at(item as usize, distance);
            if reach > farthest.1 {
                farthest = (item, reach);
            }
            if reach >= served.reach {
                break;
            }
        }
        if farthest.1 < served.reach {
            served = Served { center: number, item: farthest.0, reach: farthest.1 };
        }
    }
    served
}

/// Returns how far an item reaches from the nearest center, in the units of the rows: the larger of what is exact, rounded up, and what
/// plain `f64` says.
fn reach<P: Position>(
    table: &Table,
    cloud: &Cloud<P>,
    inside: &[P],
    outside: &[Vec<f64>],
    item: u32,
) -> f64 {
    let position = cloud.items.at(item as usize);
    let nearest = (0..inside.len())
        .min_by(|&a, &b| {
            let reach = |j: usize| length(position, inside[j].as_ref());
            reach(a).total_cmp(&reach(b))
        })
        .expect("there is a center");
    reach_from(table, cloud, &outside[nearest], item)
}

/// The same from one center.
fn reach_from<P: Position>(table: &Table, cloud: &Cloud<P>, center: &[f64], item: u32) -> f64 {
    let row = table.rows.row(cloud.rows[item as usize] as usize);
    let (place, extra) = row.split_at(table.rows.dim);
    let (weight, radius) = match table.rows.shape {
        Shape::Points => (1.0, 0.0),
        Shape::Weighted => (extra[0], 0.0),
        Shape::Balls => (1.0, extra[0]),
    };
    reach_of(place, center, weight, radius)
}

/// w·|p − c| + r, one of w = 1 and r = 0 being so: the larger of what is exact, rounded up, and what plain `f64` says.
pub(crate) fn reach_of(place: &[f64], center: &[f64], weight: f64, radius: f64) -> f64 {
    if place == center {
        return radius;
    }
    let halves = place.iter().zip(center).map(|(x, c)| (x / 2.0 - c / 2.0).abs());
    // Units of its own, in which the square is near 1.
    let size = halves.fold(radius / 2.0, f64::max).max(f64::MIN_POSITIVE);
    let scale = two_to((-exponent_of(size)).clamp(-1000, 1000));
    let difference = Difference::new(place, &Center { high: center.to_vec(), low: vec![] }, scale);
    let up = reach_up(&difference, difference.squared(), radius * scale);
    // What vanishes is less than an ulp, but not nothing.
    let is_lost = difference.vanishes || radius * scale / scale != radius;
    let up = unscale_up(if is_lost { up.next_up() } else { up }, scale);
    let up = if weight == 1.0 { up } else { (weight * up).next_up() };
    match distance(place, center) {
        plain if EXACT_DISTANCES.contains(&plain) => up.max(weight * plain + radius),
        _ => up,
    }
}

/// value / scale for a power of two; where that cannot be exact, because it is subnormal, rounded up.
fn unscale_up(value: f64, scale: f64) -> f64 {
    let unscaled = value / scale;
    if unscaled * scale < value { unscaled.next_up() } else { unscaled }
}
