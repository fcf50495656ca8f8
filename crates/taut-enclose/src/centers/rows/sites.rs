//! All rows in memory, in an order in which near rows stand near one another.
//!
//! *Idea.* Rows are halved along their widest coordinate down to 64, which then share one word of a set of rows. A ball
//! of rows is so few words, and so is what two balls have in common.
//! *Guarantee.* Distances are those of [`squared_distances`], symmetric and to [`relative_error`]; where squares would
//! overflow or vanish they are taken again in other units, so that only a distance that is no `f64` itself is lost.

use taut_kernels::{Center, Difference, relative_error, squared_distances};
use taut_points::parallel::{IntoParallel, ParallelSlice};
use taut_points::{PointsHash, exponent_of, times_two_to};

use crate::centers::item_rows::ItemRows;
use crate::centers::items::Shape;
use crate::centers::{EXACT_DISTANCES, reach_of};

/// Rows that share a word.
pub(super) const WORD: usize = 64;
/// Rows that one thread takes at a time; a multiple of [`WORD`].
const CHUNK: usize = 1 << 12;
/// The distances of this many rows are taken before they are compared: 4 KiB.
const DISTANCES_PER_BATCH: usize = 512;
/// Squares between these are as exact as any.
const EXACT_SQUARES: std::ops::RangeInclusive<f64> = 1e-280..=1e300;

/// The rows, by site: the place in the order that this module gives them.
pub(super) struct Sites {
    dim: usize,
    /// Coordinates by site.
    positions: Vec<f64>,
    /// By site; empty where all are 1.
    weights: Vec<f64>,
    /// By site; empty for points.
    radii: Vec<f64>,
    groups: Option<SiteGroups>,
    rows: Vec<u64>,
    hash: PointsHash,
}

/// The groups of rows that one ball is to hold whole.
struct SiteGroups {
    /// The group of each site.
    of: Vec<u32>,
    /// The sites of each group.
    members: Vec<Vec<usize>>,
}

impl Sites {
    /// Puts rows in order.
    pub(super) fn of(rows: ItemRows) -> Self {
        let ItemRows { shape, dim, .. } = rows;
        let mut order: Vec<u32> = (0..rows.len() as u32).collect();
        halve(&mut order, &|row, j| rows.row(row as usize)[j], dim);
        let last = |wanted| match shape == wanted {
            true => order.iter().map(|&id| rows.row(id as usize)[dim]).collect(),
            false => vec![],
        };
        let groups = (!rows.groups.is_empty()).then(|| {
            let of: Vec<u32> = order.iter().map(|&id| rows.groups[id as usize]).collect();
            let mut members = vec![vec![]; rows.group_count()];
            of.iter().enumerate().for_each(|(site, &group)| members[group as usize].push(site));
            SiteGroups { of, members }
        });
        Sites {
            groups,
            dim,
            positions: order.iter().flat_map(|&id| rows.place(id as usize)).copied().collect(),
            weights: last(Shape::Weighted),
            radii: last(Shape::Balls),
            rows: order.iter().map(|&id| id.into()).collect(),
            hash: rows.hash,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(super) fn dim(&self) -> usize {
        self.dim
    }

    pub(super) fn hash(&self) -> PointsHash {
        self.hash
    }

    pub(super) fn row(&self, site: usize) -> u64 {
        self.rows[site]
    }

    pub(super) fn position(&self, site: usize) -> &[f64] {
        &self.positions[site * self.dim..(site + 1) * self.dim]
    }

    /// Returns true if all items count alike.
    pub(super) fn are_plain(&self) -> bool {
        self.weights.is_empty() && self.radii.is_empty()
    }

    /// Returns true if rows are in groups.
    pub(super) fn are_grouped(&self) -> bool {
        self.groups.is_some()
    }

    /// The group of a site, if rows are in groups.
    pub(super) fn group(&self, site: usize) -> Option<u32> {
        self.groups.as_ref().map(|groups| groups.of[site])
    }

    /// The sites that one ball is to hold with a site, itself among them.
    pub(super) fn linked(&self, site: usize) -> Vec<usize> {
        match &self.groups {
            None => vec![site],
            Some(groups) => groups.members[groups.of[site] as usize].clone(),
        }
    }

    /// Of the sites linked to a site, the first that reaches farthest from a center.
    pub(super) fn farthest_linked(&self, site: usize, center: usize) -> usize {
        let reach = |site: usize| self.reach(site, self.distance(site, center));
        let farther = |a: usize, b: usize| if reach(b) > reach(a) { b } else { a };
        self.linked(site).into_iter().reduce(farther).unwrap_or(site)
    }

    /// Returns true if a center has a site within a reach less than `radius`.
    pub(super) fn is_near(&self, site: usize, center: usize, radius: f64) -> bool {
        self.reach(site, self.distance(site, center)) < radius
    }

    /// Returns the reach of an item at a distance: w·distance + r.
    fn reach(&self, site: usize, distance: f64) -> f64 {
        let weight = self.weights.get(site).copied().unwrap_or(1.0);
        weight * distance + self.radii.get(site).copied().unwrap_or(0.0)
    }

    /// The distance of a site from the row of `center`.
    fn distance(&self, site: usize, center: usize) -> f64 {
        let mut distance = [0.0];
        self.distances(site, &self.center(center), &mut distance);
        distance[0]
    }

    /// Returns true if a distance has all its digits.
    pub(super) fn is_even(&self, site: usize, center: usize) -> bool {
        site == center || EXACT_DISTANCES.contains(&self.distance(site, center))
    }

    /// The reach that one of two items has at least, wherever the center: (D + r₁ + r₂)/2 or a radius for balls,
    /// w₁w₂D/(w₁ + w₂) for weights.
    pub(super) fn reach_of_pair(&self, a: usize, b: usize) -> f64 {
        let distance = self.distance(a, b);
        if !self.radii.is_empty() {
            let (a, b) = (self.radii[a], self.radii[b]);
            return a.max(b).max(distance.mul_add(0.5, a.mul_add(0.5, b * 0.5)));
        }
        match (self.weights.get(a), self.weights.get(b)) {
            (Some(&a), Some(&b)) => distance / (1.0 / a + 1.0 / b),
            _ => 0.5 * distance,
        }
    }

    /// The distances of the sites from `first` on to a center.
    fn distances(&self, first: usize, center: &Center, out: &mut [f64]) {
        let values = &self.positions[first * self.dim..(first + out.len()) * self.dim];
        squared_distances(values, self.dim, center, out);
        for (value, row) in out.iter_mut().zip(values.chunks_exact(self.dim)) {
            *value = match EXACT_SQUARES.contains(value) {
                true => value.sqrt(),
                false => careful_distance(row, &center.high),
            };
        }
    }

    /// Few rows are done sooner than other threads wake.
    fn is_small(&self) -> bool {
        self.len() * self.dim < 8 * CHUNK
    }

    /// A row as center.
    fn center(&self, site: usize) -> Center {
        Center { high: self.position(site).to_vec(), low: vec![] }
    }

    /// Calls `work` with the first site of each chunk and the distances of its sites to the row of `center`; results in order.
    fn by_chunks<R: Send>(
        &self,
        center: usize,
        work: impl Fn(usize, &mut [f64]) -> R + Sync,
    ) -> Vec<R> {
        let center = self.center(center);
        let chunk = |first: usize| {
            let mut distances = vec![0.0; CHUNK.min(self.len() - first)];
            self.distances(first, &center, &mut distances);
            work(first, &mut distances)
        };
        let firsts = (0..self.len()).step_by(CHUNK);
        match self.is_small() {
            true => firsts.map(chunk).collect(),
            false => firsts.collect::<Vec<_>>().into_par_iter().map(chunk).collect(),
        }
    }

    /// The set of rows at which a center has item `site` within a reach less than `radius`, 64 rows a word.
    pub(super) fn near(&self, site: usize, radius: f64) -> Vec<u64> {
        let words = self.by_chunks(site, |_, distances| {
            let word = |distances: &[f64]| {
                let bits = distances.iter().enumerate();
                bits.fold(0u64, |word, (bit, &distance)| {
                    word | u64::from(self.reach(site, distance) < radius) << bit
                })
            };
            distances.chunks(WORD).map(word).collect::<Vec<_>>()
        });
        words.concat()
    }

    /// The least reach of item `site` from any row that is not below `radius`; infinite where there is none.
    pub(super) fn next_reach(&self, site: usize, radius: f64) -> f64 {
        let least = self.by_chunks(site, |_, distances| {
            let reaches = distances.iter().map(|&distance| self.reach(site, distance));
            reaches.filter(|&reach| reach >= radius).fold(f64::INFINITY, f64::min)
        });
        least.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Lowers the reaches of all items to those from one more center. Of a group the site that reaches farthest from the best center
    /// has its reach, and the others −∞.
    pub(super) fn lower(&self, reaches: &mut [f64], center: usize) {
        if let Some(groups) = &self.groups {
            return self.lower_groups(groups, reaches, center);
        }
        let center = self.center(center);
        let chunk = |(number, reaches): (usize, &mut [f64])| {
            let mut distances = [0.0; DISTANCES_PER_BATCH];
            let distances = &mut distances[..reaches.len()];
            self.distances(number * DISTANCES_PER_BATCH, &center, distances);
            for (i, (reach, &distance)) in reaches.iter_mut().zip(&*distances).enumerate() {
                *reach = self.reach(number * DISTANCES_PER_BATCH + i, distance).min(*reach);
            }
        };
        match self.is_small() {
            true => reaches.chunks_mut(DISTANCES_PER_BATCH).enumerate().for_each(chunk),
            false => reaches
                .par_chunks_mut(DISTANCES_PER_BATCH)
                .enumerate()
                .with_min_len(8)
                .for_each(chunk),
        }
    }

    fn lower_groups(&self, groups: &SiteGroups, reaches: &mut [f64], center: usize) {
        let distances = self.by_chunks(center, |_, distances| distances.to_vec()).concat();
        for members in &groups.members {
            let reach = |&site: &usize| self.reach(site, distances[site]);
            let mut farthest = (members[0], f64::NEG_INFINITY);
            for site in members {
                if reach(site) > farthest.1 {
                    farthest = (*site, reach(site));
                }
            }
            let known = members.iter().map(|&site| reaches[site]).fold(f64::NEG_INFINITY, f64::max);
            if farthest.1 < known {
                members.iter().for_each(|&site| reaches[site] = f64::NEG_INFINITY);
                reaches[farthest.0] = farthest.1;
            }
        }
    }

    /// The reach of every item from the nearest of these centers, as [`Self::lower`] gives them.
    pub(super) fn reaches(&self, centers: &[usize]) -> Vec<f64> {
        let mut reaches = vec![f64::INFINITY; self.len()];
        centers.iter().for_each(|&center| self.lower(&mut reaches, center));
        reaches
    }

    /// The reach of every item from the nearest of these centers, and which that is, the first of several. The sites of a group
    /// have the center from which the farthest of them reaches least.
    pub(super) fn nearest(&self, centers: &[usize]) -> (Vec<f64>, Vec<u32>) {
        if let Some(groups) = &self.groups {
            return self.nearest_of_groups(groups, centers);
        }
        let mut least = vec![f64::INFINITY; self.len()];
        let mut nearest = vec![0; self.len()];
        for (j, &center) in (0..).zip(centers) {
            // Distances, as reaches may vanish or be equal where these differ.
            let distances = self.by_chunks(center, |_, distances| distances.to_vec()).concat();
            for (site, distance) in distances.into_iter().enumerate() {
                if distance < least[site] {
                    (least[site], nearest[site]) = (distance, j);
                }
            }
        }
        let reaches = (0..).zip(least).map(|(site, distance)| self.reach(site, distance)).collect();
        (reaches, nearest)
    }

    fn nearest_of_groups(&self, groups: &SiteGroups, centers: &[usize]) -> (Vec<f64>, Vec<u32>) {
        let mut reaches = vec![f64::INFINITY; self.len()];
        let mut nearest = vec![0; self.len()];
        let mut least = vec![f64::INFINITY; groups.members.len()];
        for (j, &center) in (0..).zip(centers) {
            let distances = self.by_chunks(center, |_, distances| distances.to_vec()).concat();
            for (members, least) in groups.members.iter().zip(&mut least) {
                let from_here = |&site: &usize| self.reach(site, distances[site]);
                let most = members.iter().map(from_here).fold(f64::NEG_INFINITY, f64::max);
                if most < *least {
                    *least = most;
                    members.iter().for_each(|site| {
                        (reaches[*site], nearest[*site]) = (from_here(site), j);
                    });
                }
            }
        }
        (reaches, nearest)
    }

    /// The reach of an item from its own position: 0, or its radius.
    pub(super) fn own_reach(&self, site: usize) -> f64 {
        self.reach(site, 0.0)
    }

    /// Of these rows, one from which the largest reach of `items` is about least; the first row if nothing has to be reached.
    pub(super) fn middle(&self, words: &[(u32, u64)], items: &[usize]) -> Option<usize> {
        let mut best: Option<(f64, usize)> = None;
        for &(at, mut word) in words {
            while word != 0 {
                let site = at as usize * WORD + word.trailing_zeros() as usize;
                word &= word - 1;
                let position = self.position(site);
                let most = best.map_or(f64::INFINITY, |(most, _)| most);
                let mut largest = 0.0;
                for &item in items {
                    let squares = self.position(item).iter().zip(position);
                    let square: f64 = squares.map(|(a, b)| (a - b) * (a - b)).sum();
                    largest = self.reach(item, square.sqrt()).max(largest);
                    if largest >= most {
                        break;
                    }
                }
                if best.is_none() || largest < most {
                    best = Some((largest, site));
                }
            }
        }
        best.map(|(_, site)| site)
    }

    /// The reach of item `site` from a center as somebody else may evaluate it, or a little more; itself where nothing
    /// is rounded.
    pub(super) fn reach_up(&self, site: usize, center: usize) -> f64 {
        let distance = self.distance(site, center);
        if !EXACT_DISTANCES.contains(&distance) {
            let weight = self.weights.get(site).copied().unwrap_or(1.0);
            let radius = self.radii.get(site).copied().unwrap_or(0.0);
            return reach_of(self.position(site), self.position(center), weight, radius);
        }
        let reach = self.reach(site, distance);
        let center = self.center(center);
        let difference = Difference::new(self.position(site), &center, 1.0);
        let (square, is_whole) = (difference.squared(), !difference.vanishes);
        let root = square.high.sqrt();
        let is_exact = square.low == 0.0 && root.mul_add(root, -square.high) == 0.0;
        if is_exact && is_whole && self.are_plain() {
            return reach;
        }
        (reach * (1.0 + relative_error(self.dim))).next_up()
    }
}

/// Orders ids so that each run of 64 is one leaf of a tree of halves along the widest coordinate.
fn halve(ids: &mut [u32], value: &impl Fn(u32, usize) -> f64, dim: usize) {
    if ids.len() <= WORD {
        ids.sort_unstable();
        return;
    }
    let width = |j: usize| {
        let values = ids.iter().map(|&id| value(id, j));
        let (low, high) = values
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        high - low
    };
    let widest = (0..dim)
        .map(|j| (j, width(j)))
        .fold((0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best });
    let middle = (ids.len() / 2).next_multiple_of(WORD);
    ids.select_nth_unstable_by(middle, |&a, &b| {
        value(a, widest.0).total_cmp(&value(b, widest.0)).then(a.cmp(&b))
    });
    let (low, high) = ids.split_at_mut(middle);
    halve(low, value, dim);
    halve(high, value, dim);
}

/// |x − c| where squares overflow or vanish: in units of the largest difference, rounded to a power of two.
fn careful_distance(x: &[f64], center: &[f64]) -> f64 {
    let differences = || x.iter().zip(center).map(|(x, c)| x - c);
    let largest = differences().fold(0.0f64, |largest, d| largest.max(d.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let exponent = exponent_of(largest);
    let squares: f64 = differences().map(|d| times_two_to(d, -exponent).powi(2)).sum();
    times_two_to(squares.sqrt(), exponent)
}

#[cfg(test)]
mod tests {
    use taut_certify::Items;
    use taut_points::{Distribution, Monitor, Points, generate};

    use super::*;

    fn sites(values: &[f64], dim: usize) -> Sites {
        let points = Points::new(values, dim).unwrap();
        let rows = ItemRows::read(&points, Items::Points, false, None, &Monitor::silent());
        Sites::of(rows.unwrap())
    }

    #[test]
    fn sites_are_the_rows_in_another_order_and_balls_are_few_words() {
        let values: Vec<f64> = generate(Distribution::Uniform, 20_000, 2, 5).unwrap();
        let sites = sites(&values, 2);
        let mut rows: Vec<u64> = (0..sites.len()).map(|site| sites.row(site)).collect();
        for (site, &row) in rows.iter().enumerate() {
            assert_eq!(sites.position(site), &values[2 * row as usize..2 * row as usize + 2]);
        }
        rows.sort_unstable();
        assert!(rows.iter().copied().eq(0..20_000));
        let near = sites.near(777, 0.1);
        let (used, rows) = near
            .iter()
            .fold((0, 0), |(u, r), word| (u + usize::from(*word != 0), r + word.count_ones()));
        assert!(rows > 100 && used < 40, "{rows} rows in {used} words");
        for (other, reach) in sites.reaches(&[777]).into_iter().enumerate() {
            assert_eq!(near[other / WORD] >> (other % WORD) & 1 == 1, reach < 0.1);
            assert_eq!(reach, sites.reach(777, sites.distance(777, other)), "not symmetric");
        }
    }

    #[test]
    fn distances_at_the_ends_of_the_range_are_right() {
        for scale in [1e-318, 1e-300, 1e-160, 1.0, 1e160, 1e300, 1e307] {
            let values = [0.0, 0.0, 3.0 * scale, 4.0 * scale];
            let sites = sites(&values, 2);
            let wanted = 5.0 * scale;
            let found = sites.distance(0, 1);
            assert!((found - wanted).abs() <= 1e-15 * wanted + 5e-322, "{found:e} {wanted:e}");
        }
    }

    #[test]
    fn a_reach_without_rounding_is_kept() {
        let sites = sites(&[0.0, 0.0, 3.0, 4.0, 1.0, 1.0], 2);
        let site = |row| (0..3).find(|&site| sites.row(site) == row).unwrap();
        assert_eq!(sites.reach_up(site(0), site(1)), 5.0);
        let diagonal = sites.reach_up(site(0), site(2));
        assert!(diagonal > 2f64.sqrt() && diagonal < 2f64.sqrt() * (1.0 + 1e-14));
    }
}
