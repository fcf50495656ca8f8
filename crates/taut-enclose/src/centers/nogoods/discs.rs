//! The largest sets of points of the plane that discs of one radius hold, as points come one by one.
//!
//! *Idea.* A disc that holds some points can be moved until two of them are on its border and none has left it; of a point without neighbors
//! the disc about it is enough. A new point is added to the discs that hold it, and discs with it on their border come in: as a disc goes around it, the others come in and
//! go out, and the set is largest between one that comes in and the next that goes out. A set that another one has in it is dropped.
//! *Guarantee.* Each set of points in one disc is in one of the sets. Of a set with the new point, either each
//! disc that holds the old points holds the new one, or some disc has the new one on its border.

use super::disc_table::DiscTable;
use super::item_set::ItemSet;

pub(super) type Place = [f64; 2];

/// In parts of the square of the radius, how far from the center points are taken to be in a disc. Its border points are in it, whatever
/// rounding does: two points nearly at one place come in at once, and so do more points on one circle of this radius. Where two points are nearly
/// as far apart as a disc is wide, its center is off by 1e-8 of the radius. What a disc holds too much only refutes larger discs, less than the margin of a search.
const INSIDE: f64 = 1.0 + 1e-7;

/// A largest set and the center of a disc that holds it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disc<const WORDS: usize> {
    pub(super) held: ItemSet<WORDS>,
    pub(super) center: Place,
}

/// Points, and the discs that hold the largest sets of them.
#[derive(Clone, Debug)]
pub(super) struct Discs<const WORDS: usize> {
    radius: f64,
    places: Vec<Place>,
    /// For each point those that are in no disc with it.
    apart: Vec<ItemSet<WORDS>>,
    /// All discs there ever were.
    discs: Vec<Disc<WORDS>>,
    /// How many points each of them holds.
    sizes: Vec<u32>,
    /// The numbers of those in use, growing.
    in_use: Vec<u32>,
    /// For each point the discs in use that hold it.
    of: Vec<Vec<u32>>,
    /// For each point the table of these discs, as it was when it was last brought up to date; empty if it never was.
    tables: Vec<DiscTable<WORDS>>,
    /// For each point, whether its table is up to date: no point near by has come since.
    is_current: Vec<bool>,
}

impl<const WORDS: usize> Discs<WORDS> {
    pub(super) fn new(radius: f64, places: impl Iterator<Item = Place>) -> Self {
        let mut discs = Discs {
            radius,
            places: vec![],
            apart: vec![],
            discs: vec![],
            sizes: vec![],
            in_use: vec![],
            of: vec![],
            tables: vec![],
            is_current: vec![],
        };
        places.for_each(|place| discs.add(place));
        discs
    }

    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    pub(super) fn place(&self, item: u32) -> Place {
        self.places[item as usize]
    }

    /// The points that are in no disc with this one.
    pub(super) fn apart(&self, item: u32) -> &ItemSet<WORDS> {
        &self.apart[item as usize]
    }

    pub(super) fn disc(&self, disc: u32) -> &Disc<WORDS> {
        &self.discs[disc as usize]
    }

    /// The numbers of the discs that hold a point.
    pub(super) fn of(&self, item: u32) -> &[u32] {
        &self.of[item as usize]
    }

    /// Brings the table of the discs with a point up to date.
    pub(super) fn update_table(&mut self, item: u32) {
        let Discs { discs, of, tables, is_current, places, .. } = self;
        let item = item as usize;
        if !std::mem::replace(&mut is_current[item], true) {
            tables[item].update(&of[item], places.len(), |at| &discs[at as usize].held);
        }
    }

    /// The table of the discs with a point.
    ///
    /// It has to be up to date.
    pub(super) fn table(&self, item: u32) -> &DiscTable<WORDS> {
        &self.tables[item as usize]
    }

    /// Takes one point more, which is at none of the others.
    pub(super) fn add(&mut self, place: Place) {
        let (item, square_of_radius) = (self.len() as u32, self.radius * self.radius);
        let mut near = vec![];
        self.apart.push(ItemSet::default());
        for other in 0..item {
            if square(self.place(other), place) < 4.0 * INSIDE * square_of_radius {
                near.push(other);
            } else {
                self.apart[other as usize].insert(item);
                self.apart[item as usize].insert(other);
            }
        }
        self.places.push(place);
        self.of.push(vec![]);
        // Only points near the new one share a disc with it.
        near.iter().for_each(|&other| self.is_current[other as usize] = false);
        let mut without_it = vec![];
        for &at in &self.in_use {
            let disc = &mut self.discs[at as usize];
            let away = square(disc.center, place);
            if away <= square_of_radius * INSIDE {
                disc.held.insert(item);
                self.sizes[at as usize] += 1;
                self.of[item as usize].push(at);
            } else if away < 9.0 * square_of_radius {
                without_it.push((self.sizes[at as usize], at));
            }
        }
        self.take(item, self.on_border(item, &near), &without_it);
    }

    /// Takes those discs that hold the last point whose sets lie in no other set. An old disc without that point is dropped if its set now lies
    /// in a new one: its set was a largest one, so it is the new set without the last point, and it is found as such. Rounding can only leave a set
    /// that is not needed. Given are the sizes and numbers of the old discs near by.
    fn take(&mut self, last: u32, mut new: Vec<Disc<WORDS>>, without_it: &[(u32, u32)]) {
        // A set comes after those that may have it in them.
        new.sort_by_key(|disc| std::cmp::Reverse(disc.held.len()));
        let room = self.of(last).len() + new.len();
        let mut table = DiscTable::with_room(room, self.len());
        table.add_all(self.of(last), |at| &self.disc(at).held);
        let only_last = ItemSet::of_one(last);
        let (first_new, mut needless) = (self.discs.len() as u32, vec![]);
        for disc in new {
            if table.has_one_with(&disc.held) {
                continue;
            }
            let size = disc.held.len();
            let rest = disc.held.without(&only_last);
            let as_large = without_it.iter().filter(|&&(other, _)| other + 1 == size);
            needless.extend(as_large.map(|&(_, at)| at).find(|&at| self.disc(at).held == rest));
            let number = self.discs.len() as u32;
            table.add(number, &disc.held);
            disc.held.items().for_each(|item| self.of[item as usize].push(number));
            self.discs.push(disc);
            self.sizes.push(size);
        }
        needless.sort_unstable();
        for &at in &needless {
            for item in self.discs[at as usize].held.items() {
                self.of[item as usize].retain(|&other| other != at);
            }
        }
        self.in_use.retain(|at| needless.binary_search(at).is_err());
        self.in_use.extend(first_new..self.discs.len() as u32);
        self.tables.push(DiscTable::with_room(0, 0));
        self.is_current.push(false);
    }

    /// Discs with this point and another one on their border. As a disc goes around this point, only those that hold more than the ones beside it are kept.
    fn on_border(&self, item: u32, near: &[u32]) -> Vec<Disc<WORDS>> {
        let (place, square_of_radius) = (self.place(item), self.radius * self.radius);
        if near.is_empty() {
            return vec![Disc { held: ItemSet::of_one(item), center: place }];
        }
        // By angle of the center; of equals, those that come in first.
        let mut changes: Vec<(f64, bool, u32)> = vec![];
        for &other in near {
            let [x, y] = self.place(other);
            let (dx, dy) = (x - place[0], y - place[1]);
            let direction = dy.atan2(dx);
            let half = (0.5 * dx.hypot(dy) / self.radius).min(1.0).acos();
            changes.push((into_turn(direction - half), false, other));
            changes.push((into_turn(direction + half), true, other));
        }
        changes
            .sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        let nexts = changes.iter().cycle().skip(1);
        let largest = changes.iter().zip(nexts).filter(|(now, next)| !now.1 && next.1);
        largest
            .map(|(&(_, _, other), _)| {
                let [x, y] = self.place(other);
                let across = square_of_radius / square(place, [x, y]) - 0.25;
                let across = across.max(0.0).sqrt();
                let center = [
                    0.5 * (place[0] + x) + across * (y - place[1]),
                    0.5 * (place[1] + y) - across * (x - place[0]),
                ];
                let mut held = ItemSet::of_one(item);
                held.insert(other);
                for &third in near {
                    if square(self.place(third), center) <= square_of_radius * INSIDE {
                        held.insert(third);
                    }
                }
                Disc { held, center }
            })
            .collect()
    }
}

/// The same direction as an angle between −π and π.
fn into_turn(angle: f64) -> f64 {
    use std::f64::consts::PI;
    if angle < -PI {
        angle + 2.0 * PI
    } else if angle > PI {
        angle - 2.0 * PI
    } else {
        angle
    }
}

pub(super) fn square(a: Place, b: Place) -> f64 {
    (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever a disc about any place of a grid holds is in one of the sets, and none of these is in another one.
    #[test]
    fn no_disc_of_a_grid_holds_more() {
        let mut state = 5u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            (state >> 33) as f64 / 2f64.powi(31)
        };
        for count in [1, 2, 7, 20, 40] {
            let places: Vec<Place> = (0..count).map(|_| [4.0 * draw(), 3.0 * draw()]).collect();
            let discs = Discs::<1>::new(1.0, places.iter().copied());
            let steps = || (0..160).map(|step| f64::from(step) / 40.0);
            for center in steps().flat_map(|x| steps().map(move |y| [x, y])) {
                let mut held = ItemSet::default();
                for (item, &place) in places.iter().enumerate() {
                    if square(place, center) <= 1.0 {
                        held.insert(item as u32);
                    }
                }
                let Some(first) = held.items().next() else { continue };
                let holds_all = |&at: &u32| held.without(&discs.disc(at).held).is_empty();
                assert!(discs.of(first).iter().any(holds_all), "{center:?}");
            }
            let mut all: Vec<u32> = (0..count).flat_map(|item| discs.of(item).to_vec()).collect();
            all.sort_unstable();
            all.dedup();
            for &a in &all {
                let Disc { held, center } = discs.disc(a);
                for item in held.items() {
                    assert!(square(discs.place(item), *center) <= INSIDE);
                    assert!(discs.of(item).contains(&a));
                }
                assert!(
                    all.iter().all(|&b| a == b || !held.without(&discs.disc(b).held).is_empty())
                );
            }
        }
    }

    /// Points on one circle of the radius of the discs, points nearly at one place, and a grid some of whose points are on such a circle.
    #[test]
    fn ties_lose_no_set() {
        let mut state = 7u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            (state >> 33) as f64 / 2f64.powi(31)
        };
        let has = |discs: &Discs<1>, items: &[u32]| {
            let items: ItemSet<1> = items.iter().copied().collect();
            let first = items.items().next().unwrap();
            let holds_all = |&at: &u32| items.without(&discs.disc(at).held).is_empty();
            discs.of(first).iter().any(holds_all)
        };
        let on_circle = |degrees: f64| [degrees.to_radians().cos(), degrees.to_radians().sin()];
        let discs = Discs::<1>::new(1.0, [-80.0, -40.0, 0.0].map(on_circle).into_iter());
        assert!(has(&discs, &[0, 1, 2]));
        for _ in 0..300 {
            let turns = [draw(), draw(), draw()].map(|part| on_circle(360.0 * part));
            assert!(has(&Discs::new(1.0, turns.into_iter()), &[0, 1, 2]), "{turns:?}");
            let [x, y] = on_circle(360.0 * draw());
            let far = 1.0 + 0.95 * draw();
            for near in [1e-9, 1e-11, 1e-13, 1e-15] {
                let twins = [[far * x, far * y], [0.0, 0.0], [near * draw(), near * draw()]];
                assert!(has(&Discs::new(1.0, twins.into_iter()), &[0, 1, 2]), "{twins:?}");
            }
        }
        for square_of_radius in [5.0, 8.5, 10.0f64] {
            for _ in 0..20 {
                let mut places: Vec<Place> = vec![];
                while places.len() < 20 {
                    let place = [(7.0 * draw()).floor(), (7.0 * draw()).floor()];
                    if !places.contains(&place) {
                        places.push(place);
                    }
                }
                let radius = square_of_radius.sqrt();
                let discs = Discs::<1>::new(radius, places.iter().copied());
                for _ in 0..50 {
                    let center =
                        [7.0 * draw() - 0.5, 7.0 * draw() - 0.5].map(|at| (2.0 * at).round() / 2.0);
                    let is_held = |&item: &u32| {
                        square(places[item as usize], center).sqrt() <= radius * (1.0 - 1e-6)
                    };
                    let held: Vec<u32> = (0..20).filter(is_held).collect();
                    assert!(held.is_empty() || has(&discs, &held), "{places:?} {center:?}");
                }
            }
        }
    }
}
