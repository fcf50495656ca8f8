//! Streams against the triangulation in memory.

use std::collections::BTreeSet;

use proptest::collection::vec;
use proptest::prelude::*;
use taut_points::{Monitor, Points};

use super::super::tests::sets;
use super::*;
use crate::geometry::Bounds;
use crate::{DelaunayOptions, delaunay};

/// A stream of points in the order of `rows`, each number of points followed by the cells that are closed then.
fn options<const D: usize>(points: &[[f64; D]], coherence: Coherence) -> StreamOptions<'static, D> {
    let mut within = [[0.0; D]; 2];
    if !points.is_empty() {
        let bounds = Bounds::of(points.iter().copied());
        within = [bounds.low, bounds.high];
    }
    StreamOptions { within, coherence, memory: 64 << 20, vectors: true, monitor: Monitor::silent() }
}

/// The points in a coherent order, as places among them, and the cells to close after so many points.
fn order<const D: usize>(
    points: &[[f64; D]],
    options: &StreamOptions<'_, D>,
) -> (Vec<usize>, Vec<(usize, u64)>) {
    let mut order: Vec<usize> = (0..points.len()).collect();
    match options.coherence {
        Coherence::Sorted { axis } => {
            order.sort_by(|&i, &j| points[i][axis].total_cmp(&points[j][axis]));
            (order, vec![])
        }
        Coherence::Cells { .. } => {
            let region = Region::new(options.within, options.coherence).unwrap();
            let cell = |i: usize| region.place(points[i].map(|x| x + 0.0), 0).unwrap();
            // A spiral of sorts: the cells in an order that leaves open ones within closed ones.
            let key = |cell: usize| (cell as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 61;
            order.sort_by_key(|&i| (key(cell(i)), cell(i)));
            let mut closed: Vec<(usize, u64)> = Vec::new();
            let mut cells: Vec<usize> = (0..region.lists()).collect();
            cells.sort_by_key(|&c| (key(c), c));
            let last = |c: usize| order.iter().rposition(|&i| cell(i) == c).map_or(0, |at| at + 1);
            let mut after = 0;
            for c in cells {
                after = after.max(last(c));
                // One in seven is never closed.
                if c % 7 != 6 {
                    closed.push((after, c as u64));
                }
            }
            (order, closed)
        }
    }
}

fn check<const D: usize>(name: &str, points: &[[f64; D]], coherence: Coherence, first_chunk: usize)
where
    Dim<D>: Dimension<D>,
{
    let options = options(points, coherence);
    let (order, closed) = order(points, &options);
    let mut simplices: Vec<Vec<u64>> = Vec::new();
    let mut take = |rows: &[u64]| {
        simplices.push(rows.to_vec());
        Ok(())
    };
    let mut stream = Stream::new(options).unwrap();
    stream.chunk = first_chunk;
    let mut next = closed.into_iter().peekable();
    for (at, &i) in order.iter().enumerate() {
        while let Some((_, cell)) = next.next_if(|&(after, _)| after <= at) {
            stream.close(cell, &mut take).unwrap();
        }
        stream.push(points[i], &mut take).unwrap();
        stream.look(&mut take).unwrap();
    }
    let totals = stream.end(&mut take).unwrap();
    let streamed: Vec<[f64; D]> = order.iter().map(|&i| points[i]).collect();
    let view = Points::new(streamed.as_flattened(), D).unwrap();
    let found = delaunay(&view, &DelaunayOptions::default()).unwrap();
    let name = format!("{name} {coherence:?} {first_chunk}");
    let counts = found.certificate.counts;
    assert_eq!(totals.fingerprint, found.certificate.fingerprint, "{name}");
    assert_eq!((totals.sites, totals.simplices), (counts.sites, counts.simplices), "{name}");
    assert_eq!(totals.duplicates as usize, found.answer.duplicates.len(), "{name}");
    let k = found.answer.vertices_per_simplex();
    if k == D + 1 {
        assert_eq!(totals.hull, counts.hull, "{name}");
    }
    let expected: BTreeSet<Vec<u64>> = found
        .answer
        .simplices
        .chunks(k.max(1))
        .map(|rows| rows.iter().map(|&row| u64::from(row)).collect())
        .collect();
    assert_eq!(simplices.len(), expected.len(), "{name}");
    if k == D + 1 {
        // Rows and orientation, the smallest vertex first: vertices ascend as far as the orientation allows in either.
        let turned = |mut rows: Vec<u64>| {
            let least = (0..k).min_by_key(|&i| rows[i]).unwrap();
            if D == 2 {
                rows.rotate_left(least);
            } else {
                // Even permutations of four: bring the two smallest to the front, then the sign tells the last two apart.
                let sign = parity(&rows);
                rows.sort_unstable();
                if sign {
                    rows.swap(2, 3);
                }
            }
            rows
        };
        let a: BTreeSet<Vec<u64>> = simplices.into_iter().map(turned).collect();
        let b: BTreeSet<Vec<u64>> = expected.into_iter().map(turned).collect();
        assert_eq!(a, b, "{name}");
    }
}

/// True for an odd permutation.
fn parity(rows: &[u64]) -> bool {
    let pairs = (0..rows.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    pairs.filter(|&(i, j)| rows[i] < rows[j]).count() % 2 == 1
}

#[test]
fn streams_of_the_plane_are_the_triangulation_in_memory() {
    for (name, points) in sets::some(sets::plane(), 2) {
        for axis in 0..2 {
            check(name, &points, Coherence::Sorted { axis }, 60);
        }
        for (levels, first_chunk) in [(1, 1), (3, 100), (4, 30)] {
            check(name, &points, Coherence::Cells { levels }, first_chunk);
        }
    }
}

#[test]
fn streams_of_space_are_the_triangulation_in_memory() {
    for (name, points) in sets::some(sets::space(), 2) {
        for axis in 0..3 {
            check(name, &points, Coherence::Sorted { axis }, 200);
        }
        for (levels, first_chunk) in [(1, 1), (2, 100), (3, 300)] {
            check(name, &points, Coherence::Cells { levels }, first_chunk);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn streams_of_small_integers(
        points in vec([-6i8..6, -6i8..6], 0..120),
        step in prop_oneof![Just(1.0), Just(0.1)],
        chunk in 1usize..40,
        kind in 0u32..5,
    ) {
        let points: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| f64::from(x) * step)).collect();
        let coherence = match kind {
            0 | 1 => Coherence::Sorted { axis: kind as usize },
            levels => Coherence::Cells { levels: levels - 1 },
        };
        check("small integers", &points, coherence, chunk);
    }

    #[test]
    fn streams_of_small_integers_in_space(
        points in vec([-3i8..3, -3i8..3, -3i8..3], 0..90),
        chunk in 1usize..40,
        kind in 0u32..5,
    ) {
        let points: Vec<[f64; 3]> = points.iter().map(|p| p.map(f64::from)).collect();
        let coherence = match kind {
            0..3 => Coherence::Sorted { axis: kind as usize },
            levels => Coherence::Cells { levels: levels - 2 },
        };
        check("small integers", &points, coherence, chunk);
    }
}

fn plain(coherence: Coherence) -> StreamOptions<'static, 2> {
    StreamOptions {
        within: [[0.0; 2], [1.0; 2]],
        coherence,
        memory: 32 << 20,
        vectors: true,
        monitor: Monitor::silent(),
    }
}

#[test]
fn points_that_break_the_promise_are_named() {
    let mut take = |_: &[u64]| Ok(());
    let mut stream = Stream::new(plain(Coherence::Sorted { axis: 1 })).unwrap();
    stream.push([0.5, 0.25], &mut take).unwrap();
    stream.push([0.1, 0.25], &mut take).unwrap();
    let shown = |error: Error| error.to_string();
    let behind = shown(stream.push([0.5, 0.24], &mut take).unwrap_err());
    assert!(behind.starts_with("point 2 comes after a point with a larger"), "{behind}");
    let outside = shown(stream.push([1.5, 0.3], &mut take).unwrap_err());
    assert!(outside.starts_with("point 2 lies outside the box"), "{outside}");
    let not_finite = shown(stream.push([f64::NAN, 0.3], &mut take).unwrap_err());
    assert!(not_finite.contains("coordinate 0 of point 2"), "{not_finite}");
    let mut stream = Stream::new(plain(Coherence::Cells { levels: 1 })).unwrap();
    stream.close(3, &mut take).unwrap();
    let closed = shown(stream.push([0.5, 0.5], &mut take).unwrap_err());
    assert!(closed.starts_with("point 0 lies in a cell that was closed"), "{closed}");
    stream.push([0.5, 0.5f64.next_down()], &mut take).unwrap();
}

#[test]
fn options_that_make_no_sense_are_refused() {
    let refused = |options: StreamOptions<'static, 2>| Stream::new(options).is_err();
    assert!(refused(plain(Coherence::Sorted { axis: 2 })));
    assert!(refused(plain(Coherence::Cells { levels: 0 })));
    assert!(refused(plain(Coherence::Cells { levels: 11 })));
    assert!(refused(StreamOptions { memory: 1 << 20, ..plain(Coherence::Sorted { axis: 0 }) }));
    for within in
        [[[0.0, 1.0], [1.0, 0.0]], [[f64::NAN, 0.0], [1.0; 2]], [[0.0; 2], [f64::INFINITY; 2]]]
    {
        assert!(refused(StreamOptions { within, ..plain(Coherence::Sorted { axis: 0 }) }));
    }
}

/// Points in any order that no cell is ever closed for: there is a row at which the memory is exceeded.
#[test]
fn an_incoherent_stream_is_refused_with_its_row() {
    let mut take = |_: &[u64]| Ok(());
    let mut stream = Stream::new(plain(Coherence::Cells { levels: 4 })).unwrap();
    let refused = (0..10_000_000u64).find_map(|i| {
        let x = [i.wrapping_mul(0x9E37_79B9_7F4A_7C15), i.wrapping_mul(0xD6E8_FEB8_6659_FD93)];
        stream.push(x.map(|x| (x >> 11) as f64 / (1u64 << 53) as f64), &mut take).err()
    });
    match refused {
        Some(Error::Incoherent { row, waiting, .. }) => {
            assert_eq!(waiting, row + 1);
            // 32 MiB are less than 700,000 points of 48 bytes.
            assert!((100_000..700_000).contains(&row), "{row}");
        }
        other => panic!("{other:?}"),
    }
}
