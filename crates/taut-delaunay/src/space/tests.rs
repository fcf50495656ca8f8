//! The kernel of space against brute force.

mod canonical;
mod inputs;
mod lanes;

use taut_predicates::Sign;
use taut_predicates::space::{self, conflict_exact};

use super::lanes::Level;
use super::signs::Unfiltered;
use super::*;

const PLAIN: Settings = Settings { integral: false, filtered: true, vectors: true };

/// Seeded numbers (SplitMix64; Steele, Lea and Flood, OOPSLA 2014).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    /// In [0, 1).
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn points(&mut self, count: usize) -> Vec<[f64; 3]> {
        (0..count).map(|_| [self.unit(), self.unit(), self.unit()]).collect()
    }

    fn shuffled(&mut self, count: usize) -> Vec<u32> {
        let mut order: Vec<u32> = (0..count as u32).collect();
        for i in (1..count).rev() {
            order.swap(i, self.below(i + 1));
        }
        order
    }
}

/// All of {0, …, k − 1}³.
fn grid(k: u32) -> Vec<[f64; 3]> {
    let axis = || (0..k).map(f64::from);
    axis().flat_map(|x| axis().flat_map(move |y| axis().map(move |z| [x, y, z]))).collect()
}

/// The mesh after inserting the sites in this order, all but the first four that span space.
fn built(points: &[[f64; 3]], settings: Settings, level: Option<Level>, order: &[u32]) -> Mesh {
    let mut mesh = Mesh::new(points.to_vec(), settings);
    mesh.level = level.unwrap_or(mesh.level);
    let first = independent(points, order).expect("the points span space");
    mesh.start(first);
    let rest: Vec<u32> = order.iter().copied().filter(|i| !first.contains(i)).collect();
    mesh.insert(&rest).expect("few points make few simplices");
    mesh
}

/// Finite simplices and ghosts as sorted quadruples, sorted.
fn quadruples(mesh: &Mesh) -> Vec<[u32; 4]> {
    let live = mesh.simplices().iter().filter(|s| s.is_live());
    let mut all: Vec<[u32; 4]> = live
        .map(|s| {
            let mut vertices = s.vertices;
            vertices.sort_unstable();
            vertices
        })
        .collect();
    all.sort_unstable();
    all
}

fn finite(mesh: &Mesh) -> usize {
    mesh.simplices().iter().filter(|s| s.is_live() && !s.is_ghost()).count()
}

/// Neighbors, orientation, the Euler relation, and that no simplex is in conflict with the vertex across any facet.
fn check(mesh: &mut Mesh) {
    let Mesh { sites, records, marks, owners, workers, .. } = mesh;
    let (simplices, judge) = (records.as_slice(), &mut workers[0].judge);
    assert!(marks.iter_mut().all(|mark| *mark.get_mut() == 0), "marks are clear");
    assert!(owners.are_free(), "nobody holds a vertex");
    let (mut vertices, mut edges, mut count) =
        (std::collections::HashSet::new(), std::collections::HashSet::new(), 0);
    for (t, simplex) in simplices.iter().enumerate().filter(|(_, s)| s.is_live()) {
        count += 1;
        if !simplex.is_ghost() {
            let sign = judge.orient(simplex.vertices.map(|v| &sites[row(v)]));
            assert!(sign.is_positive(), "simplex {t} is {sign:?}");
        }
        for i in 0..4 {
            vertices.insert(simplex.vertices[i]);
            for j in 0..i {
                let (a, b) = (simplex.vertices[i], simplex.vertices[j]);
                edges.insert((a.min(b), a.max(b)));
            }
            let (other, side) = crate::simplex::decode(simplex.neighbors[i]);
            let neighbor = &simplices[other as usize];
            assert!(neighbor.is_live());
            assert_eq!(neighbor.neighbors[side], code(t as u32, i as u32), "{t} and {other} agree");
            let [a, b, c] = FACETS[i].map(|k| simplex.vertices[k]);
            let [d, e, f] = FACETS[side].map(|k| neighbor.vertices[k]);
            assert!(
                [[a, c, b], [c, b, a], [b, a, c]].contains(&[d, e, f]),
                "one facet from two sides"
            );
            let apex = neighbor.vertices[side];
            if apex != GHOST {
                let conflict = judge.conflicts(
                    Unfiltered,
                    sites,
                    records.all(),
                    &[t as u32],
                    1,
                    &sites[row(apex)],
                ) != 0;
                assert!(!conflict, "{t} is in conflict with vertex {apex}");
            }
        }
    }
    // Facets are twice as many as simplices: V − E + 2T − T = 0.
    assert_eq!(vertices.len() + count, edges.len(), "Euler");
}

/// The definition: all simplices that no other point is in conflict with.
fn brute_force(points: &[[f64; 3]]) -> Vec<[u32; 4]> {
    let exact = &mut taut_predicates::Exact::default();
    let n = points.len();
    let mut found = Vec::new();
    for a in 0..n {
        for b in a + 1..n {
            for c in b + 1..n {
                for d in c + 1..n {
                    let mut p = [a, b, c, d].map(|i| points[i]);
                    match space::orient_exact(p[0], p[1], p[2], p[3], exact) {
                        Sign::Zero => continue,
                        Sign::Negative => p.swap(2, 3),
                        Sign::Positive => {}
                    }
                    let [pa, pb, pc, pd] = p;
                    let mut others = (0..n).filter(|i| ![a, b, c, d].contains(i));
                    if !others.any(|q| conflict_exact(pa, pb, pc, pd, points[q], exact)) {
                        found.push([a as u32, b as u32, c as u32, d as u32]);
                    }
                }
            }
        }
    }
    found
}

/// Points in the order of a Hilbert curve (Skilling's transform), deduplicated.
fn hilbert(points: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    let min = points.iter().fold([f64::MAX; 3], |m, p| [0, 1, 2].map(|i| m[i].min(p[i])));
    let max = points.iter().fold([f64::MIN; 3], |m, p| [0, 1, 2].map(|i| m[i].max(p[i])));
    let extent = [0, 1, 2].map(|i| max[i] - min[i]).into_iter().fold(f64::MIN_POSITIVE, f64::max);
    const BITS: u32 = 20;
    let key = |p: &[f64; 3]| {
        let mut x =
            [0, 1, 2].map(|i| ((p[i] - min[i]) / extent * f64::from((1 << BITS) - 1)) as u32);
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
        (0..BITS)
            .rev()
            .fold(0u64, |key, bit| x.iter().fold(key, |key, x| key << 1 | u64::from(x >> bit & 1)))
    };
    let mut keyed: Vec<(u64, [f64; 3])> = points.iter().map(|p| (key(p), *p)).collect();
    keyed.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.partial_cmp(&b.1).unwrap()));
    keyed.dedup_by_key(|k| k.1);
    keyed.into_iter().map(|k| k.1).collect()
}

/// Four sites that span space, and the others in strided rounds.
fn rounds(points: &[[f64; 3]]) -> ([u32; 4], Vec<u32>) {
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let first = independent(points, &order).expect("the points span space");
    order.retain(|i| !first.contains(i));
    order.sort_by_key(|&i| std::cmp::Reverse((i + 1).trailing_zeros() / 3));
    (first, order)
}

/// The first four sites in this order that span space.
fn independent(points: &[[f64; 3]], order: &[u32]) -> Option<[u32; 4]> {
    let exact = &mut taut_predicates::Exact::default();
    let point = |i: u32| points[i as usize];
    let (a, b) = (order[0], order[1]);
    let flat = |p: [f64; 3]| [[p[0], p[1]], [p[1], p[2]], [p[2], p[0]]];
    let bent = |c: u32| {
        let (o, p, q) = (flat(point(a)), flat(point(b)), flat(point(c)));
        (0..3).any(|i| !taut_predicates::plane::orient(o[i], p[i], q[i]).is_zero())
    };
    let c = *order[2..].iter().find(|&&c| bent(c))?;
    let spans =
        |d: u32| !space::orient_exact(point(a), point(b), point(c), point(d), exact).is_zero();
    let mut spans = spans;
    let d = *order[2..].iter().find(|&&d| spans(d))?;
    Some([a, b, c, d])
}
