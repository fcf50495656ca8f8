//! Delaunay triangulations of a handful of points by their definition, in whole numbers: the judge of the checker.
//!
//! The perturbation is carried out, not simulated: the lift of the k-th largest point is raised by δᵏ, for a fraction δ so
//! small that no smaller one gives other signs.

#![allow(dead_code)] // Each test program uses another part.

use std::collections::{BTreeMap, BTreeSet};

use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};
use taut_certify::{
    NO_NEIGHBOR, Solution, Trace, Triangulation, TriangulationCertificate, TriangulationCounts,
    fingerprint,
};
use taut_points::{Monitor, Points, hash_points};

use crate::common::whole;

/// A triangulation with its points.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) values: Vec<f64>,
    pub(crate) solution: Solution<Triangulation>,
}

impl Case {
    pub(crate) fn dimension(&self) -> usize {
        usize::from(self.solution.answer.dimension)
    }

    pub(crate) fn points(&self) -> Points<'_, f64> {
        Points::new(&self.values, self.dimension()).unwrap()
    }

    /// The same lists with a certificate that says nothing untrue of them.
    pub(crate) fn consistent(&self) -> Self {
        let answer = self.solution.answer.clone();
        Case {
            name: self.name.clone(),
            values: self.values.clone(),
            solution: certify(&self.values, answer),
        }
    }
}

type Point = Vec<BigInt>;

fn determinant(rows: &[Point]) -> BigInt {
    match rows.len() {
        0 => BigInt::one(),
        n => (0..n)
            .map(|k| {
                let rest: Vec<Point> = rows[1..]
                    .iter()
                    .map(|row| (0..n).filter(|&j| j != k).map(|j| row[j].clone()).collect())
                    .collect();
                let term = &rows[0][k] * determinant(&rest);
                if k % 2 == 0 { term } else { -term }
            })
            .sum(),
    }
}

fn edges(points: &[&Point]) -> Vec<Point> {
    points[1..].iter().map(|p| p.iter().zip(points[0]).map(|(a, b)| a - b).collect()).collect()
}

/// The brute force over one set of distinct points that span their space.
struct Sites {
    points: Vec<Point>,
    lifted: Vec<Point>,
}

impl Sites {
    fn of(points: Vec<Point>) -> Self {
        // Determinants of whole numbers other than 0 are at least 1, and at most what δ makes up for.
        let largest = points.iter().flatten().map(BigInt::bits).max();
        let one_by_delta = BigInt::one() << (largest.unwrap_or(0) * 5 + 20);
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by(|&i, &j| points[i].cmp(&points[j]));
        let mut lifted = points.clone();
        // All lifts times δ⁻ⁿ, so that they are whole too.
        let all = num_traits::pow(one_by_delta.clone(), order.len());
        let mut raise = BigInt::one();
        for i in order {
            let square: BigInt = points[i].iter().map(|x| x * x).sum();
            lifted[i].push(square * &all + &raise);
            raise *= &one_by_delta;
        }
        Sites { points, lifted }
    }

    fn orientation(&self, simplex: &[usize]) -> BigInt {
        determinant(&edges(&simplex.iter().map(|&i| &self.points[i]).collect::<Vec<_>>()))
    }

    /// Returns true if the lift of `q` is above the plane through those of a positively oriented simplex.
    fn is_outside(&self, simplex: &[usize], q: usize) -> bool {
        let all: Vec<&Point> = simplex.iter().chain([&q]).map(|&i| &self.lifted[i]).collect();
        let d = determinant(&edges(&all));
        assert!(!d.is_zero(), "the perturbation leaves no tie");
        d.is_positive()
    }

    /// The positively oriented simplices that no point is inside of, from those of `candidates`.
    fn empty(&self, candidates: impl Iterator<Item = Vec<usize>>) -> Vec<Vec<usize>> {
        candidates
            .filter_map(|mut simplex| {
                let sign = self.orientation(&simplex);
                if sign.is_zero() {
                    return None;
                }
                if sign.is_negative() {
                    let last = simplex.len() - 1;
                    simplex.swap(last - 1, last);
                }
                let mut others = (0..self.points.len()).filter(|i| !simplex.contains(i));
                others.all(|q| self.is_outside(&simplex, q)).then_some(simplex)
            })
            .collect()
    }
}

fn subsets(n: usize, k: usize) -> impl Iterator<Item = Vec<usize>> {
    (0u32..1 << n)
        .filter(move |mask| mask.count_ones() as usize == k)
        .map(move |mask| (0..n).filter(|i| mask >> i & 1 == 1).collect())
}

/// The answer, by trying every simplex.
pub(crate) fn brute_force(values: &[f64], dimension: usize) -> Triangulation {
    let values = whole(values);
    let rows: Vec<Point> = values.chunks(dimension).map(<[BigInt]>::to_vec).collect();
    let mut first: BTreeMap<&Point, usize> = BTreeMap::new();
    let mut duplicates = vec![];
    for (i, row) in rows.iter().enumerate() {
        let vertex = *first.entry(row).or_insert(i);
        if vertex != i {
            duplicates.push([i as u32, vertex as u32]);
        }
    }
    let ids: Vec<usize> = (0..rows.len()).filter(|&i| first[&rows[i]] == i).collect();
    let points: Vec<Point> = ids.iter().map(|&i| rows[i].clone()).collect();
    let hull_dimension = rank(&points);
    let (simplices, hull): (Vec<Vec<usize>>, Vec<Vec<usize>>) = match hull_dimension {
        None => (vec![], vec![]),
        Some(0) => (vec![vec![0]], vec![]),
        Some(1) => {
            let mut order: Vec<usize> = (0..points.len()).collect();
            order.sort_by(|&i, &j| points[i].cmp(&points[j]));
            let ends = vec![vec![order[0]], vec![order[order.len() - 1]]];
            (order.windows(2).map(<[usize]>::to_vec).collect(), ends)
        }
        Some(2) if dimension == 3 => {
            let simplices = in_a_plane(&points);
            let hull = boundary(&simplices);
            (simplices, hull)
        }
        Some(_) => {
            let simplices = Sites::of(points.clone()).empty(subsets(points.len(), dimension + 1));
            let hull = boundary(&simplices);
            (simplices, hull)
        }
    };
    let flat = |rows: Vec<Vec<usize>>| rows.into_iter().flatten().map(|i| ids[i] as u32).collect();
    Triangulation {
        dimension: dimension as u8,
        hull_dimension,
        simplices: flat(simplices),
        hull: flat(hull),
        duplicates,
    }
}

fn rank(points: &[Point]) -> Option<u8> {
    let first = points.first()?;
    let d = first.len();
    let is_independent = |chosen: &[&Point]| {
        let edges = edges(chosen);
        // Some minor of full size is not 0.
        subsets(d, edges.len()).any(|columns| {
            let minor: Vec<Point> =
                edges.iter().map(|e| columns.iter().map(|&c| e[c].clone()).collect()).collect();
            !determinant(&minor).is_zero()
        })
    };
    let mut chosen = vec![first];
    for point in points {
        chosen.push(point);
        if chosen.len() > d + 1 || !is_independent(&chosen) {
            chosen.pop();
        }
    }
    Some(chosen.len() as u8 - 1)
}

/// Triangles of points on a plane of space: the bases of the tetrahedra over them with an apex beside the plane.
fn in_a_plane(points: &[Point]) -> Vec<Vec<usize>> {
    let n = points.len();
    let mut with_apex = points.to_vec();
    for axis in 0..3 {
        let mut apex = points[0].clone();
        apex[axis] += 1;
        with_apex.push(apex);
        if rank(&with_apex) == Some(3) {
            break;
        }
        with_apex.pop();
    }
    let projected = |axes: [usize; 2]| {
        points.iter().map(|p| vec![p[axes[0]].clone(), p[axes[1]].clone()]).collect::<Vec<_>>()
    };
    let shadow = [[0, 1], [0, 2], [1, 2]].map(projected).into_iter().find(|s| rank(s) == Some(2));
    let shadow = shadow.expect("a plane is upright on two coordinates at most");
    let bases = subsets(n, 3).map(|mut base| {
        base.push(n);
        base
    });
    let tetrahedra = Sites::of(with_apex).empty(bases);
    tetrahedra
        .into_iter()
        .map(|tetrahedron| {
            let mut base: Vec<usize> = tetrahedron.into_iter().filter(|&i| i != n).collect();
            let corners: Vec<&Point> = base.iter().map(|&i| &shadow[i]).collect();
            if determinant(&edges(&corners)).is_negative() {
                base.swap(1, 2);
            }
            base
        })
        .collect()
}

/// Facet i of a simplex, seen from outside.
fn facet<T: Copy>(simplex: &[T], i: usize) -> Vec<T> {
    let mut facet: Vec<T> = (0..simplex.len()).filter(|&j| j != i).map(|j| simplex[j]).collect();
    if i % 2 == 1 {
        facet.swap(0, 1);
    }
    facet
}

fn sorted<T: Copy + Ord>(row: &[T]) -> Vec<T> {
    let mut row = row.to_vec();
    row.sort_unstable();
    row
}

fn boundary<T: Copy + Ord>(simplices: &[Vec<T>]) -> Vec<Vec<T>> {
    let mut count: BTreeMap<Vec<T>, u32> = BTreeMap::new();
    let all = || simplices.iter().flat_map(|s| (0..s.len()).map(|i| facet(s, i)));
    for facet in all() {
        *count.entry(sorted(&facet)).or_default() += 1;
    }
    all().filter(|facet| count[&sorted(facet)] == 1).collect()
}

/// Rows of a list of ids.
pub(crate) fn rows(list: &[u32], width: usize) -> Vec<Vec<u32>> {
    list.chunks(width.max(1)).map(<[u32]>::to_vec).collect()
}

/// The hull that belongs to simplices of full dimension.
pub(crate) fn hull_of(simplices: &[u32], width: usize) -> Vec<u32> {
    boundary(&rows(simplices, width)).into_iter().flatten().collect()
}

/// Neighbors by a map of all facets.
pub(crate) fn neighbors_of(simplices: &[u32], width: usize) -> Vec<u32> {
    let rows = rows(simplices, width);
    let mut sides: BTreeMap<Vec<u32>, Vec<usize>> = BTreeMap::new();
    for (s, row) in rows.iter().enumerate() {
        for i in 0..row.len() {
            sides.entry(sorted(&facet_of(row, i))).or_default().push(s);
        }
    }
    let across = |(s, row): (usize, &Vec<u32>)| -> Vec<u32> {
        let other = |i| {
            let other = sides[&sorted(&facet_of(row, i))].iter().find(|&&t| t != s);
            other.map_or(NO_NEIGHBOR, |&t| t as u32)
        };
        (0..row.len()).map(other).collect()
    };
    rows.iter().enumerate().flat_map(across).collect()
}

fn facet_of(row: &[u32], i: usize) -> Vec<u32> {
    (0..row.len()).filter(|&j| j != i).map(|j| row[j]).collect()
}

/// A certificate for these lists.
pub(crate) fn certify(values: &[f64], answer: Triangulation) -> Solution<Triangulation> {
    let dimension = usize::from(answer.dimension);
    let points = Points::new(values, dimension).unwrap();
    let width = answer.vertices_per_simplex();
    fn print<const V: usize>(
        points: &Points<'_, f64>,
        answer: &Triangulation,
    ) -> taut_certify::Fingerprint {
        fingerprint::<V>(points, answer.simplices.as_chunks().0.iter().copied())
    }
    let fingerprint = match width {
        1 => print::<1>(&points, &answer),
        2 => print::<2>(&points, &answer),
        3 => print::<3>(&points, &answer),
        4 => print::<4>(&points, &answer),
        _ => Default::default(),
    };
    let certificate = TriangulationCertificate {
        neighbors: if width == 0 { vec![] } else { neighbors_of(&answer.simplices, width) },
        fingerprint,
        points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
        counts: TriangulationCounts {
            sites: (points.len() - answer.duplicates.len()) as u64,
            simplices: answer.len() as u64,
            hull: answer.hull.len().checked_div(width.saturating_sub(1)).unwrap_or(0) as u64,
        },
    };
    Solution { answer, certificate, trace: Trace::default() }
}

/// The true answer for these points.
pub(crate) fn solved(name: &str, values: &[f64], dimension: usize) -> Case {
    let solution = certify(values, brute_force(values, dimension));
    Case { name: name.into(), values: values.to_vec(), solution }
}

/// The simplices as a set.
pub(crate) fn set(answer: &Triangulation) -> BTreeSet<Vec<u32>> {
    answer.rows().map(sorted).collect()
}

/// Whole numbers that look random and are the same on every machine.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % limit
    }

    pub(crate) fn grid(&mut self, count: usize, side: usize) -> Vec<f64> {
        (0..count).map(|_| self.below(side) as f64).collect()
    }

    /// In [0, 1).
    pub(crate) fn numbers(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.below(1 << 16) as f64 / 65536.0).collect()
    }
}
