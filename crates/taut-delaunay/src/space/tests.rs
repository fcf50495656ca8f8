//! The kernel of space against brute force.

mod speed;

use super::lanes::Level;
use super::*;

/// Points in the order of a Hilbert curve (Skilling's transform), deduplicated.
fn hilbert(points: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    let min = points.iter().fold([f64::MAX; 3], |m, p| [0, 1, 2].map(|i| m[i].min(p[i])));
    let max = points.iter().fold([f64::MIN; 3], |m, p| [0, 1, 2].map(|i| m[i].max(p[i])));
    let extent = [0, 1, 2].map(|i| max[i] - min[i]).into_iter().fold(f64::MIN_POSITIVE, f64::max);
    const BITS: u32 = 20;
    let key = |p: &[f64; 3]| {
        let mut x = [0, 1, 2].map(|i| ((p[i] - min[i]) / extent * f64::from((1 << BITS) - 1)) as u32);
        let mut q = 1 << (BITS - 1);
        while q > 1 {
            let low = q - 1;
            for i in 0..3 {
                if x[i] & q != 0 {
                    x[0] ^= low;
                } else {
                    let t = (x[0] ^ x[i]) & low;
                    x[0] ^= t;
                    x[i] ^= t;
                }
            }
            q >>= 1;
        }
        x[1] ^= x[0];
        x[2] ^= x[1];
        let mut t = 0;
        let mut q = 1 << (BITS - 1);
        while q > 1 {
            if x[2] & q != 0 {
                t ^= q - 1;
            }
            q >>= 1;
        }
        x = x.map(|x| x ^ t);
        (0..BITS).rev().fold(0u64, |key, bit| {
            x.iter().fold(key, |key, x| key << 1 | u64::from(x >> bit & 1))
        })
    };
    let mut keyed: Vec<(u64, [f64; 3])> = points.iter().map(|p| (key(p), *p)).collect();
    keyed.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.partial_cmp(&b.1).unwrap()));
    keyed.dedup_by_key(|k| k.1);
    keyed.into_iter().map(|k| k.1).collect()
}

/// Four sites that span space, and the others in strided rounds.
fn rounds(points: &[[f64; 3]]) -> ([u32; 4], Vec<u32>) {
    let first = independent(points).expect("the points span space");
    let mut order: Vec<u32> = (0..points.len() as u32).filter(|i| !first.contains(i)).collect();
    order.sort_by_key(|&i| std::cmp::Reverse((i + 1).trailing_zeros() / 3));
    (first, order)
}

/// The first four sites that span space.
fn independent(points: &[[f64; 3]]) -> Option<[u32; 4]> {
    let exact = &mut taut_predicates::Exact::default();
    let cross = |a: usize, b: usize| {
        let flat = |p: [f64; 3]| [[p[0], p[1]], [p[1], p[2]], [p[2], p[0]]];
        let (o, p, q) = (flat(points[0]), flat(points[a]), flat(points[b]));
        (0..3).any(|i| !taut_predicates::plane::orient(o[i], p[i], q[i]).is_zero())
    };
    let c = (2..points.len()).find(|&c| cross(1, c))?;
    let d = (c + 1..points.len()).find(|&d| {
        !taut_predicates::space::orient_exact(points[0], points[1], points[c], points[d], exact).is_zero()
    })?;
    Some([0, 1, c as u32, d as u32])
}
