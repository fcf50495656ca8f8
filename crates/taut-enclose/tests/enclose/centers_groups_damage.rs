//! Answers about groups, damaged: numbers, lists and columns of the answer, and groups of the input that are split, merged or moved.
//!
//! Every damaged answer is either refused, or what it claims is so: the same problem is solved again, as it is then told.

use taut_certify::{Centers, CheckError, LowerBound, Placement, Solution};
use taut_enclose::{CentersMethod, CentersOptions, centers};
use taut_points::{Distribution, Monitor, Points, generate, hash_points};

/// An answer and its rows: two coordinates, then the group.
#[derive(Clone)]
struct Sound {
    name: &'static str,
    values: Vec<f64>,
    found: Solution<Centers>,
}

const COLUMNS: usize = 3;

impl Sound {
    fn check(&self) -> Result<(), CheckError> {
        let points = Points::new(&self.values, COLUMNS).unwrap();
        self.found.check(&points).map(|_| ())
    }

    /// Makes the hash that of the rows, so that it hides nothing.
    fn rehash(&mut self) {
        let points = Points::new(&self.values, COLUMNS).unwrap();
        self.found.certificate.points_hash = hash_points(&points, &Monitor::silent()).unwrap();
    }

    /// The least radius of what the certificate says was asked.
    fn optimum(&self) -> Option<(f64, f64)> {
        let certificate = &self.found.certificate;
        let options = CentersOptions {
            epsilon: 1e-9,
            placement: certificate.placement,
            outliers: certificate.outliers,
            group: certificate.group.map(|column| column as usize),
            ..Default::default()
        };
        let points = Points::new(&self.values, COLUMNS).unwrap();
        let found = centers(&points, certificate.k as usize, &options).ok()?;
        Some((found.answer.lower_bound, found.answer.radius))
    }

    /// Fails where the checker accepts what is not so.
    fn is_judged(&self, damage: &str) {
        if self.check().is_err() {
            return;
        }
        let Some((least, reached)) = self.optimum() else {
            panic!("{}: accepted, though nothing can be so: {damage}", self.name);
        };
        let Centers { radius, lower_bound, .. } = self.found.answer;
        assert!(
            radius >= least && lower_bound <= reached && radius.is_finite(),
            "{}: accepted: {damage}: {lower_bound} to {radius}, found {least} to {reached}",
            self.name
        );
    }

    fn is_refused(&self, damage: &str) {
        assert!(self.check().is_err(), "{}: accepted: {damage}", self.name);
    }
}

fn sound() -> Vec<Sound> {
    let plain =
        CentersOptions { epsilon: 1e-9, assignment: true, group: Some(2), ..Default::default() };
    let rows = CentersOptions { placement: Placement::Rows, ..plain };
    let method = CentersMethod::FarthestFirst;
    let tasks = [
        ("few groups", 5, 4, 2, 0.3, plain),
        ("many groups", 16, 3, 4, 0.2, plain),
        ("large groups", 6, 5, 2, 2.0, plain),
        ("coarse", 12, 3, 3, 0.2, CentersOptions { epsilon: 0.2, ..plain }),
        ("apart", 4, 3, 3, 0.1, plain),
        ("one center", 4, 3, 1, 0.4, plain),
        ("some left out", 9, 3, 2, 0.2, CentersOptions { outliers: 2, ..plain }),
        ("farthest first", 9, 3, 3, 0.2, CentersOptions { method, ..plain }),
        ("rows", 10, 3, 3, 0.2, rows),
        ("rows, one left out", 8, 3, 2, 0.2, CentersOptions { outliers: 1, ..rows }),
        ("rows, farthest first", 8, 3, 3, 0.2, CentersOptions { method, ..rows }),
    ];
    let found = |(name, groups, size, k, spread, options): (_, usize, usize, usize, f64, _)| {
        let count = groups * size;
        let noise: Vec<f64> = generate(Distribution::Uniform, count + groups, 2, 7).unwrap();
        let (places, noise) = noise.split_at(2 * groups);
        let row = |at: usize| {
            let group = at % groups;
            let place = |axis: usize| places[2 * group + axis] + spread * noise[2 * at + axis];
            [place(0), place(1), 10.0 + group as f64]
        };
        let values: Vec<f64> = (0..count).flat_map(row).collect();
        let found = centers(&Points::new(&values, COLUMNS).unwrap(), k, &options).unwrap();
        Sound { name, values, found }
    };
    let sound: Vec<Sound> = tasks.into_iter().map(found).collect();
    for answer in &sound {
        answer.check().unwrap_or_else(|why| panic!("{}: {why}", answer.name));
    }
    let is_apart = |s: &&Sound| s.found.certificate.proof == LowerBound::Separated;
    assert!(sound.iter().any(|s| is_apart(&s)) && !sound.iter().all(|s| is_apart(&s)));
    sound
}

/// The answer after one change each.
fn each<T>(
    sound: &Sound,
    values: impl IntoIterator<Item = T>,
    change: impl Fn(&mut Sound, T),
) -> Vec<Sound> {
    let changed = |value| {
        let mut damaged = sound.clone();
        change(&mut damaged, value);
        damaged
    };
    values.into_iter().map(changed).collect()
}

#[test]
fn numbers_of_the_answer_are_judged() {
    let no_numbers = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, -0.0, 1e308];
    for sound in sound() {
        let Centers { radius, lower_bound, .. } = sound.found.answer;
        for value in
            no_numbers.into_iter().chain([0.0, 5e-324, radius * (1.0 - 1e-9), radius / 2.0])
        {
            each(&sound, [value], |s, value| s.found.answer.radius = value)[0]
                .is_refused("the radius");
        }
        for factor in [1.0 + 1e-7, 1.5, 1e6] {
            let raise = |s: &mut Sound, factor: f64| {
                s.found.answer.lower_bound = radius * factor;
                s.found.answer.radius = radius * factor;
            };
            each(&sound, [factor], raise)[0].is_refused("bound and radius raised");
        }
        for value in [f64::NAN, f64::INFINITY, -1.0, -0.0, radius * (1.0 + 1e-9)] {
            each(&sound, [value], |s, value| s.found.answer.lower_bound = value)[0]
                .is_refused("the bound");
        }
        each(&sound, [radius, 5e-324, lower_bound / 2.0, 0.0], |s, value| {
            s.found.answer.lower_bound = value;
            s.found.certificate.gap = f64::MAX;
        })
        .iter()
        .for_each(|damaged| damaged.is_judged("the bound, with any gap"));
        for value in [f64::NAN, -1.0, f64::INFINITY] {
            each(&sound, [value], |s, value| s.found.certificate.gap = value)[0]
                .is_refused("the gap");
        }
        for center in 0..sound.found.answer.centers.len() {
            for column in 0..2 {
                let numbers = [f64::NAN, f64::INFINITY, 1e300, 5e-324, 0.0];
                for damaged in
                    each(&sound, numbers, |s, value| s.found.answer.centers[center][column] = value)
                {
                    damaged.is_judged("a coordinate of a center");
                }
            }
        }
    }
}

#[test]
fn the_question_is_part_of_the_proof() {
    for sound in sound() {
        for group in [Some(0), Some(1), Some(3), Some(u64::MAX)] {
            let damaged = &each(&sound, [group], |s, group| s.found.certificate.group = group)[0];
            damaged.is_refused("another column of groups");
        }
        // Without groups the rows have one coordinate more.
        each(&sound, [None], |s, group| s.found.certificate.group = group)[0]
            .is_refused("no groups");
        for damaged in each(&sound, 0..8, |s, k| s.found.certificate.k = k) {
            if damaged.found.certificate.k > 0 {
                damaged.is_judged("another k");
            }
        }
        for damaged in each(&sound, 0..4, |s, z| s.found.certificate.outliers = z) {
            damaged.is_judged("other outliers");
        }
    }
}

#[test]
fn lists_are_judged() {
    for sound in sound() {
        let n = sound.values.len() / COLUMNS;
        let core = sound.found.certificate.core_set.len();
        for at in 0..core {
            let mut damaged = sound.clone();
            damaged.found.certificate.core_set.remove(at);
            damaged.is_judged("a row of the core-set dropped");
            let mut damaged = sound.clone();
            let row = damaged.found.certificate.core_set[at];
            damaged.found.certificate.core_set.push(row);
            damaged.is_refused("a row of the core-set repeated");
            for other in 0..n as u64 {
                let mut damaged = sound.clone();
                damaged.found.certificate.core_set[at] = other;
                damaged.is_judged("another row in the core-set");
            }
        }
        if let LowerBound::Branches { items } = &sound.found.certificate.proof {
            for at in 0..items.len() {
                let with = |change: &dyn Fn(&mut Vec<u32>)| {
                    let mut damaged = sound.clone();
                    if let LowerBound::Branches { items } = &mut damaged.found.certificate.proof {
                        change(items);
                    }
                    damaged
                };
                with(&|items| items.truncate(at)).is_refused("a log cut off");
                with(&|items| items.insert(at, items[at])).is_judged("a branch repeated");
                with(&|items| items.push(items[at])).is_refused("a branch added");
                with(&|items| items[at] = u32::MAX).is_refused("no such item");
                with(&|items| items[at] = (items[at] + 1) % core as u32).is_judged("another item");
                with(&|items| {
                    items.remove(at);
                })
                .is_judged("a branch dropped");
            }
            let mut damaged = sound.clone();
            damaged.found.certificate.proof = LowerBound::Separated;
            damaged.is_judged("said to be apart");
        } else {
            let mut damaged = sound.clone();
            damaged.found.certificate.proof = LowerBound::Branches { items: vec![] };
            if damaged.found.answer.lower_bound > 0.0 {
                damaged.is_refused("no log");
            }
        }
        for row in 0..n {
            let centers = sound.found.answer.centers.len() as u32;
            for center in (0..=centers).filter(|&c| c != sound.found.answer.assignment[row]) {
                let mut damaged = sound.clone();
                damaged.found.answer.assignment[row] = center;
                damaged.is_refused("a row has another center than its group");
            }
            let mut damaged = sound.clone();
            match damaged.found.answer.outliers.binary_search(&(row as u64)) {
                Ok(at) => drop(damaged.found.answer.outliers.remove(at)),
                Err(at) => damaged.found.answer.outliers.insert(at, row as u64),
            }
            damaged.found.certificate.outliers += 1;
            damaged.is_refused("a group left out in part");
        }
    }
}

#[test]
fn groups_of_the_input_are_part_of_the_proof() {
    for sound in sound() {
        let n = sound.values.len() / COLUMNS;
        for row in 0..n {
            // Split off, merged with another group, and by a row that is moved, or is no number.
            for group in
                [99.0, sound.values[2], sound.values[COLUMNS * (n - 1) + 2], f64::MAX, 5e-324]
            {
                let mut damaged = sound.clone();
                damaged.values[COLUMNS * row + 2] = group;
                damaged.rehash();
                damaged.is_judged("a row in another group");
            }
            let (from, to) = (sound.values[COLUMNS * row + 2], sound.values[2]);
            let mut damaged = sound.clone();
            let groups = damaged.values.iter_mut().skip(2).step_by(COLUMNS);
            groups.filter(|group| **group == from).for_each(|group| *group = to);
            damaged.rehash();
            damaged.is_judged("two groups merged");
            for value in [50.0, -1e300, 5e-324] {
                let mut damaged = sound.clone();
                damaged.values[COLUMNS * row] = value;
                damaged.rehash();
                damaged.is_judged("a row moved");
            }
            for (column, value) in
                [(0, f64::NAN), (1, f64::INFINITY), (2, f64::NAN), (2, f64::NEG_INFINITY)]
            {
                let mut damaged = sound.clone();
                damaged.values[COLUMNS * row + column] = value;
                damaged.rehash();
                damaged.is_refused("no number in a row");
            }
        }
        let mut fewer = sound.clone();
        fewer.values.truncate(COLUMNS * (n - 1));
        fewer.is_refused("a row less");
    }
}
