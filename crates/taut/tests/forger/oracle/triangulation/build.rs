//! The perturbed Delaunay triangulation of a point set, with whole numbers of any size.

use std::collections::{HashMap, HashSet};

use num_bigint::{BigInt, Sign};
use num_traits::Zero;

use super::super::lattice::{Lattice, determinant, difference, dot};
use super::canonical;

/// The triangulation and what it has of what.
pub(super) struct Delaunay {
    /// Dimension of the affine hull; `None` without points.
    pub(super) dimension: Option<u8>,
    /// Distinct points.
    pub(super) sites: usize,
    /// The simplices in canonical form, ascending; the chain of points on a line in its order.
    pub(super) simplices: Vec<Vec<u32>>,
    /// The facets of the hull likewise, seen from outside; the ends of a chain, the smaller first.
    pub(super) hull: Vec<Vec<u32>>,
    /// Each row that equals an earlier one, with the first of these.
    pub(super) duplicates: Vec<[u32; 2]>,
    /// Facets between two simplices.
    pub(super) inner_facets: u64,
    /// Those of them whose simplices have one circumsphere.
    pub(super) ties: u64,
}

impl Delaunay {
    pub(super) fn of(values: &[f64], columns: usize) -> Self {
        let points = Lattice::of(values, columns).points;
        let mut first: HashMap<&[BigInt], u32> = HashMap::new();
        let (mut sites, mut duplicates) = (vec![], vec![]);
        for (row, point) in (0u32..).zip(&points) {
            match first.get(&point[..]) {
                Some(&first) => duplicates.push([row, first]),
                None => {
                    first.insert(point, row);
                    sites.push(row);
                }
            }
        }
        let frame = Frame::of(&points, &sites);
        let count = sites.len();
        let (simplices, hull) = match &frame {
            Frame::Empty => (vec![], vec![]),
            Frame::Point => (vec![vec![sites[0]]], vec![]),
            Frame::Line => {
                sites.sort_by(|&a, &b| points[a as usize].cmp(&points[b as usize]));
                let edges = sites.windows(2).map(<[u32]>::to_vec).collect();
                (edges, vec![vec![sites[0]], vec![sites[count - 1]]])
            }
            Frame::Full(axes) => return Self::wrapped(&points, sites, axes, duplicates),
        };
        let dimension = frame.dimension();
        Delaunay { dimension, sites: count, simplices, hull, duplicates, inner_facets: 0, ties: 0 }
    }

    /// Gift wrapping of points that span all coordinates in `axes`.
    fn wrapped(
        points: &[Vec<BigInt>],
        sites: Vec<u32>,
        axes: &[usize],
        duplicates: Vec<[u32; 2]>,
    ) -> Self {
        let wrapping = Wrapping { points, sites: &sites, axes };
        let mut open = vec![wrapping.first_simplex()];
        let mut known: HashSet<Vec<u32>> = open.iter().map(|simplex| canonical(simplex)).collect();
        let (mut hull, mut twice_inner, mut twice_ties) = (vec![], 0, 0);
        while let Some(simplex) = open.pop() {
            for opposite in 0..simplex.len() {
                let facet = seen_from_outside(&simplex, opposite);
                match wrapping.beyond(&facet) {
                    None => hull.push(canonical(&facet)),
                    Some(apex) => {
                        twice_inner += 1;
                        let heights = wrapping.heights(&simplex, apex);
                        twice_ties += u64::from(heights[0].is_zero());
                        let next = wrapping.turned([&facet[..], &[apex]].concat());
                        if known.insert(canonical(&next)) {
                            open.push(next);
                        }
                    }
                }
            }
        }
        let mut simplices: Vec<Vec<u32>> = known.into_iter().collect();
        simplices.sort_unstable();
        hull.sort_unstable();
        Delaunay {
            dimension: Some(axes.len() as u8),
            sites: sites.len(),
            simplices,
            hull,
            duplicates,
            inner_facets: twice_inner / 2,
            ties: twice_ties / 2,
        }
    }
}

/// The affine hull of the points.
enum Frame {
    Empty,
    Point,
    Line,
    /// A plane or space, and coordinates in which no part of it is upright.
    Full(Vec<usize>),
}

impl Frame {
    fn of(points: &[Vec<BigInt>], sites: &[u32]) -> Self {
        let at = |site: u32| &points[site as usize];
        let [a, rest @ ..] = sites else { return Frame::Empty };
        let from_a = |site: u32| difference(at(site), at(*a));
        let [b, rest @ ..] = rest else { return Frame::Point };
        let u = from_a(*b);
        let pairs: &[[usize; 2]] = if u.len() == 2 { &[[0, 1]] } else { &[[0, 1], [0, 2], [1, 2]] };
        let area = |v: &[BigInt], [i, j]: [usize; 2]| &u[i] * &v[j] - &u[j] * &v[i];
        let third = rest.iter().map(|&site| from_a(site)).find_map(|v| {
            let axes = pairs.iter().find(|&&axes| !area(&v, axes).is_zero())?;
            Some((v, axes.to_vec()))
        });
        let Some((v, axes)) = third else { return Frame::Line };
        let is_beside = |&site: &u32| !determinant(&[u.clone(), v.clone(), from_a(site)]).is_zero();
        match u.len() == 3 && rest.iter().any(is_beside) {
            true => Frame::Full(vec![0, 1, 2]),
            false => Frame::Full(axes),
        }
    }

    fn dimension(&self) -> Option<u8> {
        match self {
            Frame::Empty => None,
            Frame::Point => Some(0),
            Frame::Line => Some(1),
            Frame::Full(axes) => Some(axes.len() as u8),
        }
    }
}

/// The sites, and the coordinates in which simplices have a volume.
struct Wrapping<'a> {
    points: &'a [Vec<BigInt>],
    sites: &'a [u32],
    axes: &'a [usize],
}

impl Wrapping<'_> {
    fn at(&self, site: u32) -> &Vec<BigInt> {
        &self.points[site as usize]
    }

    /// From `a` to `b` in the axes.
    fn edge(&self, a: u32, b: u32) -> Vec<BigInt> {
        self.axes.iter().map(|&k| &self.at(b)[k] - &self.at(a)[k]).collect()
    }

    /// det(b − a, c − a, …).
    fn orientation(&self, simplex: &[u32]) -> Sign {
        let edges: Vec<_> = simplex[1..].iter().map(|&v| self.edge(simplex[0], v)).collect();
        determinant(&edges).sign()
    }

    /// A simplex that is not flat, in positive order.
    fn turned(&self, mut simplex: Vec<u32>) -> Vec<u32> {
        if self.orientation(&simplex) == Sign::Minus {
            simplex.swap(0, 1);
        }
        simplex
    }

    /// The coefficients of 1, ε(largest), ε(second), … in the determinant that is positive if `q` is inside the sphere of
    /// a positively oriented simplex.
    fn heights(&self, simplex: &[u32], q: u32) -> Vec<BigInt> {
        let d = self.axes.len();
        let edges: Vec<_> = simplex.iter().map(|&v| self.edge(q, v)).collect();
        let cofactor = |i: usize| {
            let mut others = edges.clone();
            others.remove(i);
            let minor = determinant(&others);
            // (−1)^(i + d) is the sign of the place in the last column, (−1)^d that of the whole determinant.
            if i.is_multiple_of(2) { minor } else { -minor }
        };
        let cofactors: Vec<BigInt> = (0..=d).map(cofactor).collect();
        let square = |&v: &u32| {
            let r = difference(self.at(v), self.at(q));
            dot(&r, &r)
        };
        let mut terms: Vec<(u32, BigInt)> =
            simplex.iter().copied().zip(cofactors.iter().cloned()).collect();
        terms.push((q, -cofactors.iter().sum::<BigInt>()));
        terms.sort_by(|(a, _), (b, _)| self.at(*b).cmp(self.at(*a)));
        let plain = simplex.iter().zip(&cofactors).map(|(v, c)| c * square(v)).sum();
        std::iter::once(plain).chain(terms.into_iter().map(|(_, c)| c)).collect()
    }

    /// Returns true if `q` is in the perturbed open circumsphere.
    fn is_inside(&self, simplex: &[u32], q: u32) -> bool {
        let decides = self.heights(simplex, q).into_iter().find(|c| !c.is_zero());
        decides.is_some_and(|c| c.sign() == Sign::Plus)
    }

    /// Some simplex at the first site, tried from the nearest sites on.
    fn first_simplex(&self) -> Vec<u32> {
        let [origin, others @ ..] = self.sites else { unreachable!("points span a plane") };
        let far = |&v: &u32| {
            let r = difference(self.at(v), self.at(*origin));
            dot(&r, &r)
        };
        let mut others = others.to_vec();
        others.sort_by_cached_key(far);
        let d = self.axes.len();
        // Subsets with their largest place ascending, so that near sites are tried first.
        let mut places: Vec<usize> = (0..d).collect();
        loop {
            let ids: Vec<u32> =
                std::iter::once(*origin).chain(places.iter().map(|&p| others[p])).collect();
            if self.orientation(&ids) != Sign::NoSign {
                let simplex = self.turned(ids);
                let mut rest = self.sites.iter().filter(|site| !simplex.contains(site));
                if !rest.any(|&q| self.is_inside(&simplex, q)) {
                    return simplex;
                }
            }
            let movable = (0..d).find(|&k| k + 1 == d || places[k] + 1 < places[k + 1]);
            let k = movable.expect("the last place can always move");
            places[k] += 1;
            (0..k).for_each(|j| places[j] = j);
        }
    }

    /// The apex of the simplex beyond a facet seen from there, in positive order; `None` on the hull.
    fn beyond(&self, facet: &[u32]) -> Option<u32> {
        let mut best: Option<(u32, Vec<u32>)> = None;
        for &q in self.sites.iter().filter(|q| !facet.contains(q)) {
            let with_q = [facet, &[q]].concat();
            // From outside the facet is counter-clockwise: what lies there makes the sign that the inside does not.
            let outside = if facet.len() == 2 { Sign::Minus } else { Sign::Plus };
            if self.orientation(&with_q) != outside {
                continue;
            }
            if best.as_ref().is_none_or(|(_, simplex)| self.is_inside(simplex, q)) {
                best = Some((q, self.turned(with_q)));
            }
        }
        best.map(|(apex, _)| apex)
    }
}

/// The facet opposite a vertex of a positive simplex: counter-clockwise seen from outside, or with the points to its left.
fn seen_from_outside(simplex: &[u32], opposite: usize) -> Vec<u32> {
    let mut facet = simplex.to_vec();
    facet.remove(opposite);
    if opposite % 2 == 1 {
        facet.swap(0, 1);
    }
    facet
}
