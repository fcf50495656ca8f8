//! Rings to test with, and what every answer has to satisfy.

pub(crate) mod bytes;

use taut_certify::{CircleVerdict, InscribedCircle, Solution, Stop};
use taut_inscribe::{CircleOptions, Error, inscribed_circle};
use taut_points::Points;

pub(crate) type Ring = Vec<[f64; 2]>;

/// The largest circle with the default options.
pub(crate) fn solve(ring: &[[f64; 2]]) -> Result<Solution<InscribedCircle>, Error> {
    solve_with(ring, &CircleOptions::default())
}

pub(crate) fn solve_with(
    ring: &[[f64; 2]],
    options: &CircleOptions<'_>,
) -> Result<Solution<InscribedCircle>, Error> {
    inscribed_circle(&Points::new(ring.as_flattened(), 2).unwrap(), options)
}

/// The largest circle, verified with the gap asked for.
pub(crate) fn proved(ring: &[[f64; 2]]) -> (Solution<InscribedCircle>, CircleVerdict) {
    let found = solve(ring).unwrap();
    let verdict = verify(&found, ring);
    assert_eq!(found.trace.stop, Stop::Converged, "{ring:?}");
    // The gap claimed may be off by rounding from the one asked for.
    assert!(verdict.gap <= 1e-9 * (1.0 + 1e-9) + 4e-15, "{verdict:?}");
    (found, verdict)
}

pub(crate) fn verify(found: &Solution<InscribedCircle>, ring: &[[f64; 2]]) -> CircleVerdict {
    let verdict = found.check(&Points::new(ring.as_flattened(), 2).unwrap());
    verdict.unwrap_or_else(|error| panic!("{error}: {:?}, {ring:?}", found.answer))
}

/// Numbers in [0, 1), a function of the seed: the generator of Steele, Lea and Flood (SplitMix64).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A polygon that is seen from the origin: simple, as no two neighbors in angle are half a turn apart.
pub(crate) fn star_shaped(seed: u64, size: usize) -> Ring {
    let mut random = Random(seed);
    (0..size)
        .map(|i| {
            let turn = (i as f64 + 0.9 * random.unit()) / size as f64;
            let angle = std::f64::consts::TAU * turn;
            let radius = 0.15 + random.unit();
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect()
}

/// A random tour whose crossings are undone by reversals, each of which shortens it.
pub(crate) fn tour(seed: u64, size: usize) -> Ring {
    let mut random = Random(seed);
    let mut ring: Ring = (0..size).map(|_| [random.unit(), random.unit()]).collect();
    let length = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    loop {
        let mut shorter = false;
        for i in 0..size - 1 {
            for j in i + 2..size {
                let (a, b, c, d) = (ring[i], ring[i + 1], ring[j], ring[(j + 1) % size]);
                if length(a, c) + length(b, d) < length(a, b) + length(c, d) - 1e-12 {
                    ring[i + 1..=j].reverse();
                    shorter = true;
                }
            }
        }
        if !shorter {
            return ring;
        }
    }
}

/// A ring of `teeth` spikes up from a bar of height 1; each as wide as the gap beside it.
pub(crate) fn comb(teeth: usize, tooth: f64) -> Ring {
    let mut ring = vec![[0.0, 0.0], [2.0 * teeth as f64 - 1.0, 0.0]];
    for i in (0..teeth).rev() {
        let x = 2.0 * i as f64;
        ring.extend([[x + 1.0, 1.0], [x + 1.0, 1.0 + tooth], [x, 1.0 + tooth], [x, 1.0]]);
    }
    // The first corner of the last tooth is on the right side of the bar, the last on its left side.
    ring.remove(2);
    ring.pop();
    ring
}

/// A regular polygon around the origin with the circumradius 1.
pub(crate) fn regular(size: usize) -> Ring {
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / size as f64;
    (0..size).map(|i| [angle(i).cos(), angle(i).sin()]).collect()
}

/// The distance from p to the segment ab, in plain arithmetic.
pub(crate) fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (e, d) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = e[0] * e[0] + e[1] * e[1];
    let share =
        if square > 0.0 { ((d[0] * e[0] + d[1] * e[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (d[0] - share * e[0]).hypot(d[1] - share * e[1])
}

/// The distance from p to the nearest edge.
pub(crate) fn clearance(p: [f64; 2], ring: &[[f64; 2]]) -> f64 {
    let after = ring[1..].iter().chain(&ring[..1]);
    ring.iter().zip(after).map(|(&a, &b)| distance(p, a, b)).fold(f64::INFINITY, f64::min)
}

/// Tests whether p, which is on no edge, is inside: by the parity of the edges above it.
pub(crate) fn is_inside(p: [f64; 2], ring: &[[f64; 2]]) -> bool {
    let after = ring[1..].iter().chain(&ring[..1]);
    let is_above = |(a, b): (&[f64; 2], &[f64; 2])| {
        (a[0] <= p[0]) != (b[0] <= p[0])
            && a[1] + (p[0] - a[0]) / (b[0] - a[0]) * (b[1] - a[1]) > p[1]
    };
    ring.iter().zip(after).filter(|&edge| is_above(edge)).count() % 2 == 1
}
