//! Sets of points that are hard, each in its own way.

use std::f64::consts::TAU;

use crate::numbers::numbers;
use crate::test_length::long_or;

/// All sets in the long tests; else the small ones, and of the others those with every fifth number, from `first` on.
pub(in super::super) fn some<const D: usize>(
    sets: Vec<(&'static str, Vec<[f64; D]>)>,
    first: usize,
) -> impl Iterator<Item = (&'static str, Vec<[f64; D]>)> {
    let is_taken = move |place: usize, points: usize| {
        points <= SMALL_SET_POINTS_MAX || place % long_or(1, 5) == first % long_or(1, 5)
    };
    let sets = sets.into_iter().enumerate();
    sets.filter(move |(place, set)| is_taken(*place, set.1.len())).map(|(_, set)| set)
}

/// Sets of up to so many points take no time.
const SMALL_SET_POINTS_MAX: usize = 500;

/// Independent numbers in the unit square or cube.
pub(super) fn uniform<const D: usize>(count: usize, seed: u64) -> Vec<[f64; D]> {
    let values = numbers(count * D, seed);
    values.chunks_exact(D).map(|c| std::array::from_fn(|i| c[i])).collect()
}

fn shuffled<const D: usize>(points: Vec<[f64; D]>, seed: u64) -> Vec<[f64; D]> {
    let mut keyed: Vec<(u64, [f64; D])> =
        numbers(points.len(), seed).into_iter().map(f64::to_bits).zip(points).collect();
    keyed.sort_by_key(|&(key, _)| key);
    keyed.into_iter().map(|(_, p)| p).collect()
}

pub(in super::super) fn plane() -> Vec<(&'static str, Vec<[f64; 2]>)> {
    let circle = |i: usize, n: usize| (TAU * i as f64 / n as f64).sin_cos();
    let u = uniform::<2>(3000, 7);
    let clusters = u.iter().enumerate().map(|(i, p)| {
        let center = u[i % 12];
        [center[0] + p[0].powi(3) * 0.01, center[1] + p[1].powi(3) * 0.01]
    });
    let kuzmin = u.iter().map(|&[a, b]| {
        let r = (1.0 / ((1.0 - a) * (1.0 - a)) - 1.0).sqrt();
        [r * (TAU * b).cos(), r * (TAU * b).sin()]
    });
    let roads = (0..3000).map(|i| {
        let (road, s) = (i % 30, u[i][0]);
        let ([x, y], [v, w]) = (u[road], u[road + 30]);
        [((x + s * (v - x)) * 1e4).round(), ((y + s * (w - y)) * 1e4).round()]
    });
    let lines = (0..2000).map(|i| {
        let (line, s) = (i % 20, u[i][0]);
        let ([x, y], [v, w]) = (u[line], u[line + 20]);
        [x + s * v, y + s * w + 1e-9 * u[i][1]]
    });
    let circles = (0..1200).map(|i| {
        let ((s, c), r) = (circle(i / 2, 600), [1.0, 2.0][i % 2]);
        [r * c, r * s]
    });
    let lattice = (-25i32..=25).flat_map(|x| (-25i32..=25).map(move |y| (x, y)));
    let on_circles = lattice.filter(|(x, y)| [625, 325, 425, 125].contains(&(x * x + y * y)));
    let spiral = (0..2000).map(|i| {
        let t = f64::from(i) * 0.05;
        [t * t.cos(), t * t.sin()]
    });
    let doubled: Vec<[f64; 2]> = (0..3000).map(|i| u[(i * 7) % 1000]).collect();
    let heap = (0..1500).map(|i| if i % 3 == 0 { u[i] } else { u[0] });
    vec![
        ("uniform", u.clone()),
        ("clusters", clusters.collect()),
        ("kuzmin", kuzmin.collect()),
        ("roads", roads.collect()),
        ("20 lines", lines.collect()),
        ("two circles", shuffled(circles.collect(), 3)),
        ("lattice on circles", on_circles.map(|(x, y)| [x.into(), y.into()]).collect()),
        ("grid", shuffled((0..3600).map(|i| [f64::from(i % 60), f64::from(i / 60)]).collect(), 11)),
        ("sorted grid", (0..2500).map(|i| [f64::from(i / 50), f64::from(i % 50)]).collect()),
        (
            "grid of tenths",
            (0..2500).map(|i| [f64::from(i / 50) * 0.1, f64::from(i % 50) * 0.1]).collect(),
        ),
        ("spiral", spiral.collect()),
        ("line and apex", (0..1000).map(|i| [f64::from(i), 0.0]).chain([[400.5, 700.0]]).collect()),
        ("two lines", (0..1000).map(|i| [f64::from(i / 2) * 0.37, f64::from(i % 2)]).collect()),
        ("duplicates", doubled),
        ("a heap of equal points", heap.collect()),
        ("all equal", vec![[-0.0, 3.5]; 500]),
        ("collinear", shuffled((0..500).map(|i| [f64::from(i) * 0.1; 2]).collect(), 13)),
        ("huge", u[..500].iter().map(|p| p.map(|x| (x - 0.5) * 1e150)).collect()),
        ("tiny", u[..500].iter().map(|p| p.map(|x| (x - 0.5) * 1e-150)).collect()),
        (
            "all scales",
            (0..300).map(|i| 2f64.powi(i * 6 - 900)).zip(&u).map(|(s, p)| [s, p[0] * s]).collect(),
        ),
        (
            "cluster in a void",
            (0..2000)
                .map(|i| {
                    if i < 200 {
                        u[i].map(|x| x * 1e6)
                    } else {
                        [4e5 + u[i][0] * 1e-3, 6e5 + u[i][1] * 1e-3]
                    }
                })
                .collect(),
        ),
        ("a triangle", vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
        ("one point", vec![[3.0, -4.0]]),
        ("nothing", vec![]),
    ]
}

pub(in super::super) fn space() -> Vec<(&'static str, Vec<[f64; 3]>)> {
    let u = uniform::<3>(2500, 17);
    let clusters = u.iter().enumerate().map(|(i, p)| {
        let center = u[i % 9];
        std::array::from_fn(|k| center[k] + p[k].powi(3) * 0.01)
    });
    let grid = (0..1728).map(|i| [i % 12, i / 12 % 12, i / 144].map(f64::from));
    let sphere = u[..900].iter().map(|&[a, b, _]| {
        let z = 2.0 * a - 1.0;
        let r = (1.0 - z * z).sqrt();
        [r * (TAU * b).cos(), r * (TAU * b).sin(), z]
    });
    let torus = u[..900].iter().map(|&[a, b, _]| {
        let r = 2.0 + 0.7 * (TAU * b).cos();
        [r * (TAU * a).cos(), r * (TAU * a).sin(), 0.7 * (TAU * b).sin()]
    });
    let lines = (0..160).map(|i| {
        let s = f64::from(i);
        if i % 2 == 0 { [s, 0.0, 0.0] } else { [3.0, s, 7.0] }
    });
    vec![
        ("uniform", u.clone()),
        ("clusters", clusters.collect()),
        ("grid", shuffled(grid.clone().collect(), 19)),
        ("sorted grid", grid.clone().collect()),
        ("grid of tenths", grid.map(|p| p.map(|x| x * 0.1)).collect()),
        ("sphere", sphere.collect()),
        ("torus", torus.collect()),
        ("skew lines", lines.collect()),
        ("plane and apex", {
            let plane = (0..900).map(|i| [f64::from(i % 30), f64::from(i / 30), 0.0]);
            plane.chain([[3.5, 4.5, 9.0]]).collect()
        }),
        ("coplanar", (0..900).map(|i| [i % 30, i / 30, i % 30 + i / 30].map(f64::from)).collect()),
        ("coplanar, upright", u[..500].iter().map(|&[x, _, z]| [x, 7.0, z]).collect()),
        ("collinear", (0..200).map(|i| [f64::from(i * 37 % 200) * 0.1; 3]).collect()),
        ("all equal", vec![[1.0, 2.0, 3.0]; 300]),
        ("duplicates", (0..2000).map(|i| u[(i * 7) % 700]).collect()),
        (
            "cluster in a void",
            (0..1200)
                .map(|i| if i < 150 { u[i].map(|x| x * 1e5) } else { u[i].map(|x| 5e4 + x * 1e-4) })
                .collect(),
        ),
        ("a tetrahedron", vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        ("one point", vec![[3.0, -4.0, 0.5]]),
        ("nothing", vec![]),
    ]
}
