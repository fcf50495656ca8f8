//! Places of rows in whole numbers, and what is known of triangles and of pairs of them.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use num_traits::Signed;

use super::super::lattice::{Lattice, dot};
use super::Point;
use super::balls::{Ball, Inside};
use super::convex::{Place, cross, is_zero, meet, normal};

/// The places, and what was found out about them.
pub(super) struct Scene {
    pub(super) places: Vec<Point>,
    pub(super) exact: Vec<Place>,
    flat: Mutex<HashMap<[u32; 3], bool>>,
    meeting: Mutex<HashMap<[[u32; 3]; 2], bool>>,
    pub(super) balls: Mutex<HashMap<Ball, Inside>>,
}

/// Returns what is kept under a key, found now if it is not there.
pub(super) fn kept<K: Eq + std::hash::Hash, V: Clone>(
    all: &Mutex<HashMap<K, V>>,
    key: K,
    find: impl FnOnce() -> V,
) -> V {
    // Not locked while it is found, as that may ask for other things that are kept.
    if let Some(found) = locked(all).get(&key) {
        return found.clone();
    }
    let found = find();
    locked(all).insert(key, found.clone());
    found
}

fn locked<T>(all: &Mutex<T>) -> MutexGuard<'_, T> {
    all.lock().unwrap_or_else(PoisonError::into_inner)
}

pub(super) fn sorted(mut triangle: [u32; 3]) -> [u32; 3] {
    triangle.sort_unstable();
    triangle
}

impl Scene {
    pub(super) fn of(places: Vec<Point>) -> Self {
        let exact = Lattice::of(places.as_flattened(), 3).points;
        let (flat, meeting, balls) = Default::default();
        Scene { places, exact, flat, meeting, balls }
    }

    /// The same with other places, and what is known of rows that stayed.
    pub(super) fn moved_to(&self, places: Vec<Point>) -> Self {
        let moved = Scene::of(places);
        let is_changed: Vec<bool> =
            moved.places.iter().zip(&self.places).map(|(to, from)| to != from).collect();
        if self.places.len() != moved.places.len() {
            return moved;
        }
        let have_stayed = |rows: &[u32]| !rows.iter().any(|&row| is_changed[row as usize]);
        let changed: Vec<u32> =
            (0u32..).zip(&is_changed).filter(|one| *one.1).map(|one| one.0).collect();
        locked(&moved.flat).extend(
            locked(&self.flat)
                .iter()
                .filter(|(rows, _)| have_stayed(&rows[..]))
                .map(|(k, v)| (*k, *v)),
        );
        locked(&moved.meeting).extend(
            locked(&self.meeting)
                .iter()
                .filter(|(pair, _)| have_stayed(pair.as_flattened()))
                .map(|(k, v)| (*k, *v)),
        );
        locked(&moved.balls).extend(
            locked(&self.balls)
                .iter()
                .filter(|(ball, _)| !changed.iter().any(|&row| ball.names(row)))
                .map(|(ball, inside)| (*ball, ball.renewed(inside, &changed, &moved))),
        );
        moved
    }

    pub(super) fn at(&self, row: u32) -> &Place {
        &self.exact[row as usize]
    }

    pub(super) fn corners(&self, triangle: [u32; 3]) -> [&Place; 3] {
        triangle.map(|row| self.at(row))
    }

    /// Tests whether the corners are on a line.
    pub(super) fn is_flat(&self, triangle: [u32; 3]) -> bool {
        let triangle = sorted(triangle);
        kept(&self.flat, triangle, || is_zero(&normal(self.corners(triangle))))
    }

    /// Tests whether the boxes around two triangles are apart.
    fn boxes_are_apart(&self, one: [u32; 3], other: [u32; 3]) -> bool {
        let ends = |triangle: [u32; 3], k: usize| {
            let of = triangle.map(|row| self.places[row as usize][k]);
            (of[0].min(of[1]).min(of[2]), of[0].max(of[1]).max(of[2]))
        };
        (0..3).any(|k| {
            let ((low, high), (other_low, other_high)) = (ends(one, k), ends(other, k));
            high < other_low || other_high < low
        })
    }

    /// Tests whether two triangles that are not flat and have not the same corners share more than common corners and edges.
    pub(super) fn do_meet(&self, one: [u32; 3], other: [u32; 3]) -> bool {
        if self.boxes_are_apart(one, other) {
            return false;
        }
        let mut pair = [sorted(one), sorted(other)];
        pair.sort_unstable();
        kept(&self.meeting, pair, || self.find_meeting(pair))
    }

    fn find_meeting(&self, [one, other]: [[u32; 3]; 2]) -> bool {
        let (common, mine): (Vec<u32>, Vec<u32>) =
            one.into_iter().partition(|row| other.contains(row));
        let theirs: Vec<u32> = other.into_iter().filter(|row| !common.contains(row)).collect();
        let (first, second) = (self.corners(one), self.corners(other));
        match (&common[..], &mine[..], &theirs[..]) {
            ([], ..) => meet(first, &second),
            // From the common corner any other common point leads on to the side opposite, of one or the other.
            ([_], [a, b], [c, d]) => {
                meet(second, &[self.at(*a), self.at(*b)])
                    || meet(first, &[self.at(*c), self.at(*d)])
            }
            // In one plane on the same side of the common edge.
            ([u, v], [a], [b]) => {
                let [m, n] = [a, b].map(|&p| normal([self.at(*u), self.at(*v), self.at(p)]));
                is_zero(&cross(&m, &n)) && dot(&m, &n).is_positive()
            }
            _ => true,
        }
    }
}
