//! Bounding dops, in exact arithmetic.
//!
//! *Decided, all of it exactly.* The offset of a facet is the least double that is at least u·p for all rows. The vertices are the
//! points of three facets that all half-spaces hold. The volume is the sum of tetrahedra over the facets. Both are found once for
//! each set of half-spaces.
//! *Integers.* Rows and offsets are scaled by their common denominators, and half-spaces are tested in homogeneous coordinates: reducing
//! fractions would take most of the time.

use std::collections::BTreeMap;
use std::ops::{Add, Mul, Sub};

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use taut::Solution;
use taut::certify::{BoundingDop, DopVerdict};

use super::Truth;

type Point = [BigRational; 3];

/// The vertices, each with the facets that hold it, and the volume.
type Shape = (Vec<(Vec<bool>, Point)>, BigRational);

/// Knows the truth about the bounding dops of one input.
pub struct DopOracle {
    rows: Vec<[BigInt; 3]>,
    /// The common denominator of the rows.
    denominator: BigInt,
    shapes: BTreeMap<String, Shape>,
}

fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).unwrap_or_else(BigRational::zero)
}

fn whole(x: i64) -> BigRational {
    BigRational::from_integer(BigInt::from(x))
}

/// Scales the values by their common denominator, a power of two, to integers; returns it, too.
fn scaled(values: &[f64]) -> (Vec<BigInt>, BigInt) {
    let exact: Vec<BigRational> = values.iter().copied().map(exact).collect();
    let denominator = exact.iter().map(BigRational::denom).max().cloned();
    let denominator = denominator.unwrap_or_else(BigInt::one);
    (exact.iter().map(|x| x.numer() * (&denominator / x.denom())).collect(), denominator)
}

fn dot<T>(a: &[T; 3], b: &[T; 3]) -> T
where
    for<'a> &'a T: Mul<Output = T>,
    T: Add<Output = T>,
{
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross<T>(a: &[T; 3], b: &[T; 3]) -> [T; 3]
where
    for<'a> &'a T: Mul<Output = T>,
    T: Sub<Output = T>,
{
    let entry = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [entry(1, 2), entry(2, 0), entry(0, 1)]
}

fn minus(a: &Point, b: &Point) -> Point {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

impl DopOracle {
    /// Holds rows of space.
    pub fn new(values: &[f64], columns: usize) -> Self {
        let (values, denominator) = scaled(if columns == 3 { values } else { &[] });
        DopOracle { rows: values.as_chunks::<3>().0.to_vec(), denominator, shapes: BTreeMap::new() }
    }

    /// Judges every claim of an accepted answer.
    pub fn judge(&mut self, found: &Solution<BoundingDop>, verdict: &DopVerdict) -> Truth {
        let answer = &found.answer;
        let (normals, offsets) = (&answer.normals, &answer.offsets);
        if verdict.facets != normals.len() as u64 || normals.len() != offsets.len() {
            return Truth::False("the number of facets is another one".into());
        }
        let normals: Vec<[BigInt; 3]> = normals.iter().map(|u| u.map(BigInt::from)).collect();
        for (u, &h) in normals.iter().zip(offsets) {
            let Some(most) = self.rows.iter().map(|p| dot(u, p)).max() else {
                return Truth::False("there are no points".into());
            };
            let most = BigRational::new(most, self.denominator.clone());
            if most > exact(h) || most <= exact(h.next_down()) {
                return Truth::False(format!("{h:?} is not the largest sum, rounded up"));
            }
        }
        let key = format!("{:?}", (&answer.normals, offsets));
        let (vertices, volume) = self.shapes.entry(key).or_insert_with(|| shape(&normals, offsets));
        let side = |c: usize| {
            let along = vertices.iter().map(|(_, vertex)| &vertex[c]);
            along.clone().max().zip(along.min()).map(|(high, low)| high - low)
        };
        let longest = (0..3).filter_map(side).max().unwrap_or_else(BigRational::zero);
        let largest = vertices.iter().flat_map(|(_, vertex)| vertex.iter().map(Signed::abs)).max();
        let largest = largest.unwrap_or_else(BigRational::zero);
        // Twice what the checker grants, for the grid on which it finds vertices.
        let slack = exact(2e-9) * &longest + exact(4e-15) * (&largest + &longest);
        let is_near = |a: &Point, b: &Point| (0..3).all(|c| (&a[c] - &b[c]).abs() <= slack);
        let listed: Vec<Point> = answer.vertices.iter().map(|at| at.map(exact)).collect();
        let [lower, upper] = [verdict.volume_lower, verdict.volume_upper].map(exact);
        let claimed = exact(answer.volume);
        let grid = exact(1e-11) * &longest * &longest * &longest;
        let claims = [
            (
                listed.iter().all(|a| vertices.iter().any(|(_, b)| is_near(a, b))),
                "a vertex is none",
            ),
            (vertices.iter().all(|(_, b)| listed.iter().any(|a| is_near(a, b))), "a vertex lacks"),
            (lower <= *volume && *volume <= upper, "the bounds of the volume do not hold"),
            (
                (&claimed - &*volume).abs() <= exact(1.1e-9) * &*volume + grid,
                "the volume is another one",
            ),
        ];
        let lie = claims.iter().find(|(holds, _)| !holds);
        Truth::claim(lie.is_none(), || lie.map_or(String::new(), |(_, lie)| (*lie).into()))
    }
}

fn shape(normals: &[[BigInt; 3]], offsets: &[f64]) -> Shape {
    let facets = normals.len();
    let (offsets, denominator) = scaled(offsets);
    let mut vertices: Vec<(Vec<bool>, Point)> = vec![];
    for i in 0..facets {
        for j in i + 1..facets {
            let ij = cross(&normals[i], &normals[j]);
            for k in j + 1..facets {
                let divisor = dot(&ij, &normals[k]);
                if divisor.is_zero() {
                    continue;
                }
                let (jk, ki) = (cross(&normals[j], &normals[k]), cross(&normals[k], &normals[i]));
                // Times |divisor|.
                let sign = divisor.signum();
                let at = [0, 1, 2].map(|c| {
                    (&offsets[i] * &jk[c] + &offsets[j] * &ki[c] + &offsets[k] * &ij[c]) * &sign
                });
                let divisor = divisor * sign;
                let beyond = normals.iter().zip(&offsets).map(|(u, h)| dot(u, &at) - h * &divisor);
                let beyond: Vec<BigInt> = beyond.collect();
                if beyond.iter().all(|b| !b.is_positive()) {
                    let on = beyond.iter().map(BigInt::is_zero).collect();
                    let divisor = divisor * &denominator;
                    let at = at.map(|x| BigRational::new(x, divisor.clone()));
                    if vertices.iter().all(|(_, other)| *other != at) {
                        vertices.push((on, at));
                    }
                }
            }
        }
    }
    let Some((_, apex)) = vertices.first().cloned() else {
        return (vertices, BigRational::zero());
    };
    // Tetrahedra over the edges of each facet, from a corner of the facet and from one corner of all.
    let mut sixfold = BigRational::zero();
    for facet in 0..facets {
        let corners: Vec<_> = vertices.iter().filter(|(on, _)| on[facet]).collect();
        let Some((_, first)) = corners.first() else { continue };
        for (at, (on, a)) in corners.iter().enumerate() {
            for (other_on, b) in &corners[at + 1..] {
                // An edge is in two facets: the facets of both ends have rank 2.
                let common = (0..facets).filter(|&k| k != facet && on[k] && other_on[k]);
                let is_edge = { common }
                    .any(|k| cross(&normals[k], &normals[facet]).iter().any(|x| !x.is_zero()));
                if is_edge {
                    let span = cross(&minus(a, first), &minus(b, first));
                    sixfold += dot(&span, &minus(&apex, first)).abs();
                }
            }
        }
    }
    (vertices, sixfold / whole(6))
}
