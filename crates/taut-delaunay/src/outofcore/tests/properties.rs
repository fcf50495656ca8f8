//! Random sets of few small integers: ties, duplicates, lines and planes in every node, under random cuts.

use proptest::collection::vec;
use proptest::prelude::*;

use super::buckets::Cut;
use super::canonical::check_same;
use crate::test_length::long_or;

fn cut() -> impl Strategy<Value = Cut> {
    (0u32..6, 0u64..60, 1usize..4, 1usize..9).prop_map(|(levels, merge_above, threads, stride)| {
        Cut { levels, merge_above, threads, stride }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(long_or(300, 80)))]

    /// Most circles through three of these points pass through more.
    #[test]
    fn tiles_of_small_integers_in_the_plane(
        points in vec([-6i8..6, -6i8..6], 0..120),
        step in prop_oneof![Just(1.0), Just(0.1)],
        cut in cut(),
    ) {
        let points: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| f64::from(x) * step)).collect();
        check_same("small integers", &points, &[cut]);
    }

    #[test]
    fn tiles_of_small_integers_in_space(
        points in vec([-3i8..3, -3i8..3, -3i8..3], 0..90),
        step in prop_oneof![Just(1.0), Just(0.1)],
        cut in cut(),
    ) {
        let points: Vec<[f64; 3]> = points.iter().map(|p| p.map(|x| f64::from(x) * step)).collect();
        check_same("small integers", &points, &[cut]);
    }

    /// A few far points and many near ones: spheres of all sizes across all cells.
    #[test]
    fn tiles_of_points_of_many_scales(
        points in vec((0.0f64..1.0, 0.0f64..1.0, 0i32..30), 3..150),
        cut in cut(),
    ) {
        let scaled = points.iter().map(|&(x, y, k)| [x, y].map(|c| c * 0.5f64.powi(k)));
        check_same("many scales", &scaled.collect::<Vec<_>>(), &[cut]);
    }
}
