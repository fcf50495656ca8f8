//! Points at so few places that each has a center of its own.
//!
//! *Trap.* Places are told apart by their coordinates: squares of distances may vanish where coordinates differ.

use std::collections::HashMap;

use taut_certify::{
    Centers, CentersCertificate, Items, LowerBound, Placement, Solution, Stop, Trace,
};
use taut_points::{OrderBy, PointsHash};

use super::CentersOptions;
use super::item_rows::ItemRows;
use super::nearest::nearest;

/// A center for each place, but for places that are left out with all their rows.
pub(super) struct TrivialCenters {
    centers: Vec<Vec<f64>>,
    /// The first row at each.
    rows: Vec<u64>,
    outliers: Vec<u64>,
    assignment: Vec<u32>,
}

impl TrivialCenters {
    /// Of points; none where k centers leave more than z of them out, or z groups, or where a group is at two places.
    pub(super) fn of(points: &ItemRows, k: usize, z: usize) -> Option<Self> {
        if !points.are_points() {
            return None;
        }
        let (n, position) = (points.len(), |row| points.place(row));
        let mut numbers: HashMap<Vec<u64>, usize> = HashMap::new();
        let mut is_seen = vec![false; points.group_count()];
        let mut place_of_group = vec![usize::MAX; points.group_count()];
        // The first row of each place, and how many rows or groups there are.
        let mut places: Vec<(usize, usize)> = vec![];
        let mut place_of = Vec::new();
        for row in 0..n {
            // −0 is 0.
            let bits = position(row).iter().map(|x| (x + 0.0).to_bits()).collect();
            let place = *numbers.entry(bits).or_insert(places.len());
            if place == places.len() {
                places.push((row, 0));
                // Each place beyond k is left out with a row or group at least.
                if places.len() > k.saturating_add(z) {
                    return None;
                }
            }
            let group = points.groups.get(row).map_or(row, |&group| group as usize);
            if !std::mem::replace(&mut is_seen[group], true) {
                places[place].1 += 1;
                place_of_group[group] = place;
            } else if place_of_group[group] != place {
                return None;
            }
            place_of.push(place);
        }
        let mut order: Vec<usize> = (0..places.len()).collect();
        order.order_by_key(|&place| std::cmp::Reverse(places[place].1));
        let kept = &mut order[..k.min(places.len())];
        kept.sort_unstable();
        let mut center_of = vec![None; places.len()];
        (0..).zip(&*kept).for_each(|(center, &place)| center_of[place] = Some(center));
        let is_out = |row: &usize| center_of[place_of[*row]].is_none();
        let outliers: Vec<u64> = (0..n).filter(is_out).map(|row| row as u64).collect();
        let without_center = center_of.iter().zip(&places).filter(|(center, _)| center.is_none());
        if without_center.map(|(_, place)| place.1).sum::<usize>() > z {
            return None;
        }
        let first = |&place: &usize| places[place].0;
        let centers: Vec<Vec<f64>> =
            kept.iter().map(|place| position(first(place)).to_vec()).collect();
        let nearest = |place: usize| {
            center_of[place].unwrap_or_else(|| nearest(position(places[place].0), &centers))
        };
        Some(TrivialCenters {
            assignment: place_of.iter().map(|&place| nearest(place)).collect(),
            rows: kept.iter().map(|place| first(place) as u64).collect(),
            centers,
            outliers,
        })
    }

    /// The answer, in which there is nothing to prove.
    pub(super) fn solution(
        self,
        k: usize,
        placement: Placement,
        options: &CentersOptions<'_>,
        items: Items,
        points_hash: PointsHash,
    ) -> Solution<Centers> {
        Solution {
            answer: Centers {
                centers: self.centers,
                rows: if placement == Placement::Rows { self.rows } else { vec![] },
                radius: 0.0,
                lower_bound: 0.0,
                outliers: self.outliers,
                assignment: if options.assignment { self.assignment } else { vec![] },
            },
            certificate: CentersCertificate {
                items,
                weights: options.weights,
                group: options.group.map(|column| column as u64),
                placement,
                k: k as u64,
                outliers: options.outliers,
                gap: 0.0,
                core_set: vec![],
                directions: vec![],
                proof: LowerBound::Separated,
                points_hash,
            },
            trace: Trace {
                method: options.method.name().to_owned(),
                stop: Stop::Converged,
                passes: 1,
                ..Trace::default()
            },
        }
    }
}
