//! Answers about groups, damaged: numbers, lists and columns of the answer, and groups of the input that are split, merged or moved.
//!
//! Every damaged answer is either refused, or what it claims is so: the same problem is solved again, as it is then told.

use taut_certify::Placement;
use taut_enclose::{CentersMethod, CentersOptions};
use taut_points::{Distribution, generate};

use crate::centers_sound::*;

/// Two coordinates, then the group.
const COLUMNS: usize = 3;

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
        for group in [Some(0), Some(1), Some(3), Some(u64::MAX)] {
            let damaged = &sound.each([group], |s, group| s.found.certificate.group = group)[0];
            damaged.is_refused("another column of groups");
        }
        // Without groups the rows have one coordinate more.
        sound.each([None], |s, group| s.found.certificate.group = group)[0].is_refused("no groups");
        counts_are_judged(&sound);
    }
}

#[test]
fn lists_are_judged() {
    for sound in sound() {
        let n = sound.rows();
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
        branches_are_judged(&sound);
        assignments_are_judged(&sound);
        for row in 0..n {
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
        let n = sound.rows();
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
