//! Answers about ellipsoids, damaged: numbers, lists and directions of the answer, and rows of the input that are moved, swollen or
//! no ellipsoids at all.
//!
//! Every damaged answer is either refused, or what it claims is so: the same problem is solved again, as it is then told.

use taut_certify::{Items, Placement};
use taut_enclose::CentersOptions;
use taut_points::{Distribution, generate};

use crate::centers_sound::*;

/// Two coordinates, then the triangle of a shape.
const COLUMNS: usize = 5;

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
        Sound::of(name, values, COLUMNS, k, &options)
    };
    let sound: Vec<Sound> = tasks.into_iter().map(found).collect();
    have_both_proofs(&sound);
    sound
}

#[test]
fn numbers_of_the_answer_are_judged() {
    sound().iter().for_each(numbers_are_judged);
}

#[test]
fn the_question_is_part_of_the_proof() {
    for sound in sound() {
        for items in [Items::Points, Items::Balls] {
            sound.each([items], |s, items| s.found.certificate.items = items)[0]
                .is_refused("other items");
        }
        sound.each([true], |s, weights| s.found.certificate.weights = weights)[0]
            .is_refused("weights");
        sound
            .each([Some(0), Some(4), Some(u64::MAX)], |s, group| {
                s.found.certificate.group = group;
            })
            .iter()
            .for_each(|damaged| damaged.is_refused("groups"));
        let mut damaged = sound.clone();
        damaged.found.certificate.placement = Placement::Rows;
        damaged.is_refused("centers among the rows");
        damaged.found.answer.rows = vec![0; damaged.found.answer.centers.len()];
        damaged.is_refused("centers among the rows, with their rows");
        counts_are_judged(&sound);
    }
}

/// What is done to the rows and the directions of a core-set.
type Change<'a> = &'a dyn Fn(&mut Vec<u64>, &mut Vec<Vec<f64>>);

#[test]
fn points_of_the_core_set_are_judged() {
    for sound in sound() {
        let n = sound.rows();
        let core = sound.found.certificate.core_set.len();
        let with = |change: Change<'_>| {
            let mut damaged = sound.clone();
            let certificate = &mut damaged.found.certificate;
            change(&mut certificate.core_set, &mut certificate.directions);
            damaged
        };
        for at in (0..core).step_by(crate::test_length::long_or(1, 3)) {
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
            for row in (0..n as u64).step_by(crate::test_length::long_or(1, 4)) {
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
        let n = sound.rows();
        branches_are_judged(&sound);
        assignments_are_judged(&sound);
        for row in 0..n {
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
    }
}

#[test]
fn rows_of_the_input_are_part_of_the_proof() {
    for sound in sound() {
        let n = sound.rows();
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
