//! Folds by class, drawn with a seed.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

/// Assigns each point to one of `folds` folds, so that every class is spread over them as evenly as can be.
///
/// A point that is the only one of its class is in no fold: it has to be trained on always. The result depends on the labels and the
/// seed alone. Returns all `None` for fewer than two folds.
pub fn stratified_folds(labels: &[u32], folds: usize, seed: u64) -> Vec<Option<usize>> {
    let mut fold_of = vec![None; labels.len()];
    if folds < 2 {
        return fold_of;
    }
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let classes = labels.iter().copied().max().map_or(0, |most| most as usize + 1);
    let mut members = vec![vec![]; classes];
    labels.iter().enumerate().for_each(|(i, &label)| members[label as usize].push(i));
    // Going on where the last class stopped keeps the folds of equal size.
    let mut next = 0;
    for members in &mut members {
        members.shuffle(&mut rng);
        if members.len() < 2 {
            continue;
        }
        for &i in members.iter() {
            fold_of[i] = Some(next % folds);
            next += 1;
        }
    }
    fold_of
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_spread_and_single_points_stay_in_training() {
        let labels: Vec<u32> =
            (0..53).map(|i| if i == 17 { 2 } else { u32::from(i % 3 == 0) }).collect();
        let folds = stratified_folds(&labels, 5, 9);
        assert_eq!(folds[17], None);
        assert_eq!(folds.iter().filter(|fold| fold.is_none()).count(), 1);
        for class in 0..2 {
            let counts: Vec<usize> = (0..5)
                .map(|fold| {
                    (0..53).filter(|&i| labels[i] == class && folds[i] == Some(fold)).count()
                })
                .collect();
            let (low, high) = (counts.iter().min().unwrap(), counts.iter().max().unwrap());
            assert!(high - low <= 1, "{counts:?}");
        }
        assert_eq!(folds, stratified_folds(&labels, 5, 9));
        assert_ne!(folds, stratified_folds(&labels, 5, 10));
        assert!(stratified_folds(&labels, 1, 0).iter().all(Option::is_none));
    }
}
