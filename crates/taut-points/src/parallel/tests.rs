use super::*;
use crate::thread_pool;

fn on_pools(test: impl Fn() + Sync) {
    for threads in [1, 2, 7] {
        thread_pool(threads).unwrap().install(&test);
    }
}

#[test]
fn results_are_in_the_order_of_the_items() {
    on_pools(|| {
        for count in [0, 1, 2, 63, 64, 65, 1024, 1025, 5000] {
            for least in [1, 7, 64, 10_000] {
                let wanted: Vec<usize> = (0..count).map(|i| 3 * i + 1).collect();
                let found: Vec<usize> =
                    (0..count).into_par_iter().with_min_len(least).map(|i| 3 * i + 1).collect();
                assert_eq!(found, wanted);
                let found: Vec<usize> = wanted.par_iter().with_min_len(least).map(|i| *i).collect();
                assert_eq!(found, wanted);
                let found: Vec<usize> = wanted.clone().into_par_iter().map(|i| i).collect();
                assert_eq!(found, wanted);
                let parts: Vec<(usize, Vec<usize>)> =
                    wanted.par_chunks(least).map(<[usize]>::to_vec).enumerate().collect();
                assert_eq!(
                    parts,
                    wanted.chunks(least).map(<[usize]>::to_vec).enumerate().collect::<Vec<_>>()
                );
                let mut written = vec![0; count];
                let others = wanted.par_chunks(least);
                written.par_chunks_mut(least).zip(others).enumerate().for_each(
                    |(part, (to, from))| {
                        assert_eq!(from[0], 3 * part * least + 1);
                        to.copy_from_slice(from);
                    },
                );
                assert_eq!(written, wanted);
                written.par_iter_mut().with_min_len(least).for_each(|number| *number += 1);
                assert!(written.iter().zip(&wanted).all(|(a, b)| *a == b + 1));
            }
        }
    });
}

#[test]
fn the_first_error_is_returned_whoever_fails_first() {
    let fails = |i: usize| match i % 100 == 40 {
        true => Err(i),
        false => Ok(i),
    };
    on_pools(|| {
        for _ in 0..50 {
            for least in [1, 3, 100, 2000] {
                let items = || (0..1000usize).into_par_iter().with_min_len(least);
                assert_eq!(items().map(fails).collect::<Result<Vec<_>, _>>(), Err(40));
                assert_eq!(items().try_for_each(|i| fails(i).map(drop)), Err(40));
                assert_eq!(items().try_for_each(|_| Ok::<_, ()>(())), Ok(()));
                let all = items().map(Ok::<usize, ()>).collect::<Result<Vec<_>, _>>();
                assert!(all.is_ok_and(|all| all.iter().copied().eq(0..1000)));
            }
        }
    });
}

#[test]
fn items_are_left_out_made_more_and_put_together() {
    on_pools(|| {
        for count in [0, 1, 100, 3000u32] {
            let items = || (0..count).into_par_iter();
            let odd: Vec<u32> = items().filter(|i| i % 2 == 1).collect();
            assert_eq!(odd, (0..count).filter(|i| i % 2 == 1).collect::<Vec<_>>());
            let thirds: Vec<u32> = items().filter_map(|i| (i % 3 == 0).then_some(i / 3)).collect();
            assert_eq!(thirds, (0..count.div_ceil(3)).collect::<Vec<_>>());
            let twice: Vec<u32> = items().flat_map_iter(|i| [i, i]).collect();
            assert_eq!(twice, (0..count).flat_map(|i| [i, i]).collect::<Vec<_>>());
            let kept: Vec<u32> =
                items().map_init(|| 7, |kept, i| std::mem::replace(kept, 7) * i).collect();
            assert_eq!(kept, (0..count).map(|i| 7 * i).collect::<Vec<_>>());
            assert_eq!(items().reduce(|| 0, |a, b| a + b), (0..count).sum::<u32>());
            assert!(items().all(|i| i < count));
            assert_eq!(items().all(|i| i < 99), count <= 99);
        }
        let ends: Vec<u32> = (u32::MAX - 3..u32::MAX).into_par_iter().collect();
        assert_eq!(ends, [u32::MAX - 3, u32::MAX - 2, u32::MAX - 1]);
        #[allow(clippy::reversed_empty_ranges)]
        let none: Vec<u64> = (5..2u64).into_par_iter().collect();
        assert!(none.is_empty());
        let pairs: Vec<(&u8, usize)> =
            [1, 2, 3].par_iter().zip((0..2usize).into_par_iter()).collect();
        assert_eq!(pairs, [(&1, 0), (&2, 1)]);
    });
}

#[test]
fn a_panic_of_a_task_is_one_of_the_loop() {
    on_pools(|| {
        let outcome = std::panic::catch_unwind(|| {
            (0..100usize).into_par_iter().for_each(|i| assert!(i != 50, "fifty"));
        });
        assert!(outcome.is_err());
    });
}

#[test]
fn two_works_return_what_each_returns() {
    on_pools(|| assert_eq!(join(|| 1, || "two"), (1, "two")));
}
