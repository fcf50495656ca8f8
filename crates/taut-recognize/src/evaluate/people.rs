//! Splits in which nobody is on both sides.

use std::collections::BTreeMap;

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

/// Assigns each item to one of `folds` folds, all items of a person to the same one; `people` has the person of each item.
///
/// People are drawn in an order of the seed, and each goes to the fold with fewest items so far. A single fold, or none, is fold 0.
pub fn person_disjoint_folds(people: &[u32], folds: usize, seed: u64) -> Vec<usize> {
    let mut counts = BTreeMap::new();
    for &person in people {
        *counts.entry(person).or_insert(0usize) += 1;
    }
    let mut order: Vec<u32> = counts.keys().copied().collect();
    order.shuffle(&mut ChaCha8Rng::seed_from_u64(seed));
    let mut sizes = vec![0; folds.max(1)];
    let mut fold_of = BTreeMap::new();
    for person in order {
        let least = sizes.iter().copied().min().unwrap_or(0);
        let fold = sizes.iter().position(|&size| size == least).unwrap_or(0);
        sizes[fold] += counts[&person];
        fold_of.insert(person, fold);
    }
    people.iter().map(|person| fold_of[person]).collect()
}
