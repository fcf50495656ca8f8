//! Answers about ellipsoids, damaged: numbers, lists and directions of the answer, and rows of the input that are moved, swollen or
//! no ellipsoids at all.
//!
//! Every damaged answer is either refused, or what it claims is so: the same problem is solved again, as it is then told.

use taut_certify::{Centers, CheckError, Items, LowerBound, Placement, Solution};
use taut_enclose::{CentersOptions, centers};
use taut_points::{Distribution, Monitor, Points, generate, hash_points};

/// An answer and its rows: two coordinates, then the triangle of a shape.
#[derive(Clone)]
struct Sound {
    name: &'static str,
    values: Vec<f64>,
    found: Solution<Centers>,
}

const COLUMNS: usize = 5;

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
            inputs: Items::Ellipsoids,
            outliers: certificate.outliers,
            ..Default::default()
        };
        let points = Points::new(&self.values, COLUMNS).unwrap();
        let found = centers(&points, certificate.k as usize, &options).ok()?;
        found.check(&points).unwrap_or_else(|why| panic!("{why}\n{:?}\n{found:?}", self.values));
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
    let plain = CentersOptions {
        epsilon: 1e-9,
        assignment: true,
        inputs: Items::Ellipsoids,
        ..Default::default()
    };
    let tasks = [
        ("few", 5, 2, 0.3, plain),
        ("many", 16, 4, 0.2, plain),
        ("large", 6, 2, 2.0, plain),
        ("coarse", 12, 3, 0.2, CentersOptions { epsilon: 0.2, ..plain }),
        ("apart", 4, 3, 0.05, CentersOptions { epsilon: 0.3, ..plain }),
        ("one center", 4, 1, 0.4, plain),
        ("some left out", 9, 2, 0.2, CentersOptions { outliers: 2, ..plain }),
    ];
    let found = |(name, count, k, size, options): (_, usize, usize, f64, _)| {
        let noise: Vec<f64> = generate(Distribution::Uniform, 3 * count, 2, 7).unwrap();
        let row = |at: usize| {
            let [x, y, a, b, c, d] = std::array::from_fn(|j| noise[6 * at + j]);
            let [a, b, c, d] = [a, b, c, d].map(|v| size * (v - 0.5));
            // The first is a segment.
            let [c, d] = if at == 0 { [0.0; 2] } else { [c, d] };
            [x, y, a * a + c * c, a * b + c * d, b * b + d * d]
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
        for value in no_numbers.into_iter().chain([
            0.0,
            5e-324,
            f64::MIN_POSITIVE,
            radius * (1.0 - 1e-9),
            radius / 2.0,
        ]) {
            each(&sound, [value], |s, value| s.found.answer.radius = value)[0]
                .is_refused("the radius");
        }
        for value in [5e-324, f64::MIN_POSITIVE, 0.0] {
            let both = |s: &mut Sound, value: f64| {
                s.found.answer.lower_bound = value;
                s.found.answer.radius = value;
            };
            each(&sound, [value], both)[0].is_refused("bound and radius of nothing");
        }
        for factor in [1.0 + 1e-7, 1.5, 1e6, 1e300] {
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
                let numbers = [f64::NAN, f64::INFINITY, 1e308, 1e300, 5e-324, 0.0];
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
        for items in [Items::Points, Items::Balls] {
            each(&sound, [items], |s, items| s.found.certificate.items = items)[0]
                .is_refused("other items");
        }
        each(&sound, [true], |s, weights| s.found.certificate.weights = weights)[0]
            .is_refused("weights");
        each(&sound, [Some(0), Some(4), Some(u64::MAX)], |s, group| {
            s.found.certificate.group = group;
        })
        .iter()
        .for_each(|damaged| damaged.is_refused("groups"));
        let mut damaged = sound.clone();
        damaged.found.certificate.placement = Placement::Rows;
        damaged.is_refused("centers among the rows");
        damaged.found.answer.rows = vec![0; damaged.found.answer.centers.len()];
        damaged.is_refused("centers among the rows, with their rows");
        for damaged in each(&sound, 1..8, |s, k| s.found.certificate.k = k) {
            damaged.is_judged("another k");
        }
        for damaged in each(&sound, 0..4, |s, z| s.found.certificate.outliers = z) {
            damaged.is_judged("other outliers");
        }
    }
}

/// What is done to the rows and the directions of a core-set.
type Change<'a> = &'a dyn Fn(&mut Vec<u64>, &mut Vec<Vec<f64>>);

#[test]
fn points_of_the_core_set_are_judged() {
    for sound in sound() {
        let n = sound.values.len() / COLUMNS;
        let core = sound.found.certificate.core_set.len();
        let with = |change: Change<'_>| {
            let mut damaged = sound.clone();
            let certificate = &mut damaged.found.certificate;
            change(&mut certificate.core_set, &mut certificate.directions);
            damaged
        };
        for at in 0..core {
            let row = |rows: &mut Vec<u64>, _: &mut Vec<Vec<f64>>| {
                rows.remove(at);
            };
            with(&row).is_refused("a row dropped");
            with(&|_, directions| drop(directions.remove(at))).is_refused("a direction dropped");
            let both = |rows: &mut Vec<u64>, directions: &mut Vec<Vec<f64>>| {
                rows.remove(at);
                directions.remove(at);
            };
            with(&both).is_judged("a point dropped");
            let twice = |rows: &mut Vec<u64>, directions: &mut Vec<Vec<f64>>| {
                rows.push(rows[at]);
                directions.push(directions[at].clone());
            };
            with(&twice).is_judged("a point repeated");
            with(&|_, directions| directions[at].truncate(1)).is_refused("a direction cut off");
            with(&|_, directions| directions[at].push(1.0)).is_refused("a direction too long");
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                with(&|_, directions| directions[at][1] = value).is_refused("no direction");
            }
            for value in [0.0, -0.0, 5e-324, -1e-310, 1e-160, 1.0, -1e160, 1e308, f64::MAX] {
                with(&|_, directions| directions[at][0] = value).is_judged("another direction");
                with(&|_, directions| directions[at] = vec![value; 2]).is_judged("of one number");
            }
            for row in 0..n as u64 {
                with(&|rows, _| rows[at] = row).is_judged("a point of another ellipsoid");
            }
            with(&|rows, _| rows[at] = n as u64).is_refused("no such row");
        }
        with(&|_, directions| directions.clear()).is_refused("no directions");
        with(&|rows, directions| (*rows, *directions) = (vec![], vec![])).is_judged("no core-set");
    }
}

#[test]
fn lists_are_judged() {
    for sound in sound() {
        let n = sound.values.len() / COLUMNS;
        let core = sound.found.certificate.core_set.len();
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
                damaged.is_refused("another center");
            }
            let mut damaged = sound.clone();
            match damaged.found.answer.outliers.binary_search(&(row as u64)) {
                Ok(at) => {
                    damaged.found.answer.outliers.remove(at);
                    damaged.is_refused("left out no more");
                }
                Err(at) => {
                    damaged.found.answer.outliers.insert(at, row as u64);
                    if sound.found.answer.outliers.len() as u64
                        == damaged.found.certificate.outliers
                    {
                        damaged.is_refused("one more left out");
                    }
                }
            }
        }
        let mut damaged = sound.clone();
        damaged.found.answer.assignment.pop();
        damaged.is_refused("an assignment cut off");
    }
}

#[test]
fn rows_of_the_input_are_part_of_the_proof() {
    for sound in sound() {
        let n = sound.values.len() / COLUMNS;
        for row in 0..n {
            for column in 0..COLUMNS {
                for value in [50.0, -1e150, 1e300, 5e-324, 0.0] {
                    let mut damaged = sound.clone();
                    damaged.values[COLUMNS * row + column] = value;
                    damaged.is_refused("another row");
                    damaged.rehash();
                    damaged.is_judged("another row, with its hash");
                }
                for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    let mut damaged = sound.clone();
                    damaged.values[COLUMNS * row + column] = value;
                    damaged.rehash();
                    damaged.is_refused("no number in a row");
                }
            }
            let mut damaged = sound.clone();
            damaged.values[COLUMNS * row + 4] = -1.0;
            damaged.rehash();
            damaged.is_refused("no ellipsoid");
        }
        let mut fewer = sound.clone();
        fewer.values.truncate(COLUMNS * (n - 1));
        fewer.is_refused("a row less");
    }
}
