//! Signs of determinants of coordinates, exact whatever the coordinates are.
//!
//! *Stages*, each asked only about what the one before left open.
//! 1. Plain `f64`, with the bound (monomials × roundings)·u·(product of the largest differences).
//! 2. The same value again, now as the exact one: when every coordinate is a multiple of one power of two, 2^q, and the
//!    differences are so few times 2^q that no operation rounds. Gridded points end here, ties included.
//! 3. Plain `f64` once more, with roundings·u·(sum of the |monomials|) as the bound, which is far below that of stage 1.
//! 4. Double-double, with its bound: points near circles and spheres end here.
//! 5. Whole numbers modulo 2¹²⁸. The value in units of 2^q is a whole number. Stage 4 tells how large it can be at most;
//!    where that is less than 2¹²⁷ the residue is the number, however large the products are that cancel. Ties of points
//!    on turned grids end here.
//! 6. Whole numbers of any size.
//!
//! *Range.* [`Input`](super::input::Input) scales all coordinates by a power of two so that they are below 1 in size:
//! nothing overflows, and what underflows in a determinant is off by less than 2⁻¹⁰⁷⁰ times a few hundred operations and
//! factors, for which 2⁻¹⁰⁰⁰ is added to each bound. Where scaling would lose bits, only stage 6 is left.
//! *Ties.* When q lies on the sphere of a simplex, the lift of each of the d + 2 points is raised by an infinitesimal
//! amount, infinitely more for a lexicographically larger point. D is linear in the lifts, so the largest point whose
//! cofactor is not 0 decides: q itself is then outside, and a vertex gives the orientation of the simplex with q in its
//! place.

use std::cmp::Ordering;

use super::geometry::{Bounds, Geometry};
use crate::arithmetic::{DoubleDouble, Integer, Residue, Ring, parts};

/// A value and the sum of the |monomials| it is made of.
#[derive(Clone, Copy)]
struct Sized {
    value: f64,
    sum: f64,
}

impl Ring for Sized {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        Sized { value: self.value + other.value, sum: self.sum + other.sum }
    }

    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        Sized { value: self.value - other.value, sum: self.sum + other.sum }
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        Sized { value: self.value * other.value, sum: self.sum * other.sum }
    }
}

/// Added to every bound for what underflows.
pub(crate) const UNDERFLOW: f64 = f64::from_bits((1023 - 1000) << 52);

/// A determinant has at most this many differences.
const DIFFERENCES_MAX: usize = 4;

/// The known facts about all coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Signs {
    /// All sizes are below 1.
    pub(crate) is_filtered: bool,
    /// 2^q, of which every coordinate is a multiple; 0 where q is unknown or below −200.
    pub(crate) quantum: f64,
}

/// Where a point is with respect to a sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Conflict {
    pub(crate) is_inside: bool,
    /// The point is on the sphere, and the perturbation decided.
    pub(crate) is_tie: bool,
}

impl Signs {
    /// The sign of O.
    pub(crate) fn orientation<G: Geometry<D, V>, const D: usize, const V: usize>(
        &self,
        simplex: &[[f64; D]; V],
    ) -> Ordering {
        let [origin, vertices @ ..] = simplex.as_slice() else { return Ordering::Equal };
        self.sign::<D>(
            origin,
            vertices,
            G::FACTORS,
            &G::ORIENTATION,
            G::volume,
            G::orientation::<f64>,
            G::orientation::<Sized>,
            G::orientation::<DoubleDouble>,
            G::orientation::<Residue>,
            G::orientation::<Integer>,
        )
    }

    /// The sign of D for a positively oriented simplex: `Greater` is inside.
    pub(crate) fn in_sphere<G: Geometry<D, V>, const D: usize, const V: usize>(
        &self,
        simplex: &[[f64; D]; V],
        q: &[f64; D],
    ) -> Ordering {
        self.sign::<D>(
            &simplex[0],
            &others(simplex, q),
            G::FACTORS,
            &G::IN_SPHERE,
            G::lifted_volume,
            determinant::<G, f64, D, V>,
            determinant::<G, Sized, D, V>,
            determinant::<G, DoubleDouble, D, V>,
            determinant::<G, Residue, D, V>,
            determinant::<G, Integer, D, V>,
        )
    }

    /// The same in whole numbers, where |D| ≤ `most`.
    pub(crate) fn in_sphere_exactly<G: Geometry<D, V>, const D: usize, const V: usize>(
        &self,
        simplex: &[[f64; D]; V],
        q: &[f64; D],
        most: f64,
    ) -> Ordering {
        self.exact_sign(
            &simplex[0],
            &others(simplex, q),
            &G::IN_SPHERE,
            most,
            determinant::<G, Residue, D, V>,
            determinant::<G, Integer, D, V>,
        )
    }

    /// The sign of a determinant of the differences of `points` and `origin`, given over five kinds of numbers.
    #[inline(always)]
    fn sign<const D: usize>(
        &self,
        origin: &[f64; D],
        points: &[[f64; D]],
        factors: usize,
        bounds: &Bounds,
        volume: impl Fn(&[f64; D]) -> f64,
        plain: impl Fn(&[[f64; D]]) -> f64,
        sized: impl Fn(&[[Sized; D]]) -> Sized,
        double: impl Fn(&[[DoubleDouble; D]]) -> DoubleDouble,
        residue: impl Fn(&[[Residue; D]]) -> Residue,
        exact: impl Fn(&[[Integer; D]]) -> Integer,
    ) -> Ordering {
        let (count, mut size) = (points.len(), 0.0);
        if self.is_filtered {
            let mut differences = [[0.0; D]; DIFFERENCES_MAX];
            let mut max = [0.0f64; D];
            for (difference, point) in differences.iter_mut().zip(points) {
                for k in 0..D {
                    difference[k] = point[k] - origin[k];
                    max[k] = max[k].max(difference[k].abs());
                }
            }
            let value = plain(&differences[..count]);
            size = volume(&max);
            if value.abs() > bounds.rounding * size + UNDERFLOW {
                return sign_of(value);
            }
            let largest = max.iter().fold(0.0f64, |largest, &m| largest.max(m));
            if largest <= bounds.exact_max * self.quantum {
                return sign_of(value);
            }
            // Every monomial has a factor from each of these coordinates.
            if max[..factors].contains(&0.0) {
                return Ordering::Equal;
            }
        }
        self.fine_sign(origin, points, bounds, size, sized, double, residue, exact)
    }

    /// Stages 3 to 6. Apart from the others, which would be slower for the room that these take.
    #[inline(never)]
    fn fine_sign<const D: usize>(
        &self,
        origin: &[f64; D],
        points: &[[f64; D]],
        bounds: &Bounds,
        size: f64,
        sized: impl Fn(&[[Sized; D]]) -> Sized,
        double: impl Fn(&[[DoubleDouble; D]]) -> DoubleDouble,
        residue: impl Fn(&[[Residue; D]]) -> Residue,
        exact: impl Fn(&[[Integer; D]]) -> Integer,
    ) -> Ordering {
        let (count, mut most) = (points.len(), f64::INFINITY);
        if self.is_filtered {
            let mut with_sums = [[Sized { value: 0.0, sum: 0.0 }; D]; DIFFERENCES_MAX];
            for (difference, point) in with_sums.iter_mut().zip(points) {
                for k in 0..D {
                    let value = point[k] - origin[k];
                    difference[k] = Sized { value, sum: value.abs() };
                }
            }
            let Sized { value, sum } = sized(&with_sums[..count]);
            if value.abs() > bounds.rounding_of_sum * sum + UNDERFLOW {
                return sign_of(value);
            }
            let mut twice = [[DoubleDouble { high: 0.0, low: 0.0 }; D]; DIFFERENCES_MAX];
            for (difference, point) in twice.iter_mut().zip(points) {
                for k in 0..D {
                    difference[k] = DoubleDouble::difference(point[k], origin[k]);
                }
            }
            let value = double(&twice[..count]).high;
            let bound = bounds.of_double_double(size);
            if value.abs() > bound {
                return sign_of(value);
            }
            most = value.abs() + bound;
        }
        self.exact_sign(origin, points, bounds, most, residue, exact)
    }

    /// Stages 5 and 6, where the determinant is at most `most` in size.
    fn exact_sign<const D: usize>(
        &self,
        origin: &[f64; D],
        points: &[[f64; D]],
        bounds: &Bounds,
        most: f64,
        residue: impl Fn(&[[Residue; D]]) -> Residue,
        exact: impl Fn(&[[Integer; D]]) -> Integer,
    ) -> Ordering {
        // All powers are exact. One bit less than there is makes up for the rounding of `most`.
        let scale = (0..bounds.degree).fold(1.0, |power, _| power * self.quantum);
        if most < scale * 2f64.powi(126) {
            let mut differences = [[Residue::ZERO; D]; DIFFERENCES_MAX];
            let (per_quantum, mut are_near) = (1.0 / self.quantum, true);
            // Points close together have differences that `f64` holds, and that are small whole numbers of quanta: to turn
            // these into residues takes a small part of the time that it takes to turn every coordinate into one.
            for (difference, point) in differences.iter_mut().zip(points) {
                for k in 0..D {
                    let DoubleDouble { high, low } = DoubleDouble::difference(point[k], origin[k]);
                    let in_quanta = high * per_quantum;
                    are_near &= (low == 0.0) & (in_quanta.abs() < i64::MAX as f64);
                    difference[k] = Residue::of(in_quanta as i64);
                }
            }
            if !are_near {
                let least = parts(self.quantum).1;
                let residues = |point: &[f64; D]| point.map(|x| Residue::scaled(x, least));
                let base = residues(origin);
                for (difference, point) in differences.iter_mut().zip(points) {
                    let point = residues(point);
                    *difference = std::array::from_fn(|k| point[k].minus(&base[k]));
                }
            }
            return residue(&differences[..points.len()]).sign();
        }
        let all = || points.iter().chain([origin]).flatten().filter(|&&x| x != 0.0);
        let least = all().map(|&x| parts(x).1).min().unwrap_or(0);
        let integer = |point: &[f64; D]| point.map(|x| Integer::scaled(x, least));
        let base = integer(origin);
        let differences: Vec<[Integer; D]> = points
            .iter()
            .map(|point| {
                let point = integer(point);
                std::array::from_fn(|k| point[k].minus(&base[k]))
            })
            .collect();
        exact(&differences).sign()
    }

    /// Tests whether q is inside the sphere of a positively oriented simplex under the perturbation. q is no vertex.
    #[inline(never)]
    pub(crate) fn conflict<G: Geometry<D, V>, const D: usize, const V: usize>(
        &self,
        simplex: &[[f64; D]; V],
        q: &[f64; D],
    ) -> Conflict {
        self.conflict_of::<G, D, V>(simplex, q, self.in_sphere::<G, D, V>(simplex, q))
    }

    /// The same where the sign of D is known.
    #[inline(always)]
    pub(crate) fn conflict_of<G: Geometry<D, V>, const D: usize, const V: usize>(
        &self,
        simplex: &[[f64; D]; V],
        q: &[f64; D],
        in_sphere: Ordering,
    ) -> Conflict {
        match in_sphere {
            Ordering::Less => Conflict { is_inside: false, is_tie: false },
            Ordering::Greater => Conflict { is_inside: true, is_tie: false },
            Ordering::Equal => {
                Conflict { is_inside: self.wins_tie::<G, D, V>(simplex, q), is_tie: true }
            }
        }
    }

    /// Tests whether q, on the sphere of a positively oriented simplex, is inside under the perturbation.
    fn wins_tie<G: Geometry<D, V>, const D: usize, const V: usize>(
        &self,
        simplex: &[[f64; D]; V],
        q: &[f64; D],
    ) -> bool {
        // Vertices that are not larger than q come too late. Nearly always the largest decides.
        let mut above = [false; V];
        for i in 0..V {
            above[i] = is_less(q, &simplex[i]);
        }
        loop {
            let mut largest = V;
            for i in 0..V {
                if above[i] && (largest == V || is_less(&simplex[largest], &simplex[i])) {
                    largest = i;
                }
            }
            // Either q is the largest that is left: it is raised more than all of them. Or q is the smallest of all and
            // all cofactors of the vertices vanish, which cannot be, as their sum does not.
            if largest == V {
                return false;
            }
            above[largest] = false;
            let mut replaced = *simplex;
            replaced[largest] = *q;
            match self.orientation::<G, D, V>(&replaced) {
                Ordering::Equal => {}
                sign => return sign == Ordering::Greater,
            }
        }
    }
}

/// D from the differences to the first vertex: of the other vertices, then of q.
#[inline(always)]
fn determinant<G: Geometry<D, V>, T: Ring, const D: usize, const V: usize>(
    differences: &[[T; D]],
) -> T {
    let (edges, r) = differences.split_at(V - 1);
    G::in_sphere(&G::lifted(edges), &r[0])
}

/// The points of D but the first vertex.
#[inline(always)]
fn others<const D: usize, const V: usize>(simplex: &[[f64; D]; V], q: &[f64; D]) -> [[f64; D]; V] {
    let mut others = [*q; V];
    others[..V - 1].copy_from_slice(&simplex[1..]);
    others
}

#[inline(always)]
pub(crate) fn sign_of(value: f64) -> Ordering {
    value.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}

/// Tests whether b is raised more.
#[inline(always)]
fn is_less<const D: usize>(a: &[f64; D], b: &[f64; D]) -> bool {
    let mut is_less = false;
    for k in (0..D).rev() {
        is_less = (a[k] < b[k]) | (a[k] == b[k]) & is_less;
    }
    is_less
}

/// The order of points in which the larger ones are raised more.
#[inline(always)]
pub(crate) fn lexicographic<const D: usize>(a: &[f64; D], b: &[f64; D]) -> Ordering {
    a.partial_cmp(b).unwrap_or(Ordering::Equal)
}

#[cfg(test)]
mod tests {
    use num_rational::BigRational;
    use num_traits::Zero;
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::super::geometry::{Gabriel, Lifted, Tetrahedra, Triangles};
    use super::*;

    impl Ring for BigRational {
        fn plus(&self, other: &Self) -> Self {
            self + other
        }

        fn minus(&self, other: &Self) -> Self {
            self - other
        }

        fn times(&self, other: &Self) -> Self {
            self * other
        }
    }

    fn agrees<G: Geometry<D, V>, const D: usize, const V: usize>(
        signs: &[Signs],
        points: &[[f64; D]],
    ) -> Result<(), TestCaseError> {
        let simplex: [[f64; D]; V] = std::array::from_fn(|i| points[i]);
        let exact = |p: &[f64; D]| p.map(|x| BigRational::from_float(x).expect("finite"));
        let base = exact(&points[0]);
        let differences: Vec<[BigRational; D]> = points[1..=V]
            .iter()
            .map(|p| {
                let p = exact(p);
                std::array::from_fn(|k| &p[k] - &base[k])
            })
            .collect();
        let (edges, r) = differences.split_at(V - 1);
        let Lifted { orientation, .. } = G::lifted(edges);
        let inside = G::in_sphere(&G::lifted(edges), &r[0]);
        for signs in signs {
            let found = signs.orientation::<G, D, V>(&simplex);
            prop_assert_eq!(found, orientation.cmp(&BigRational::zero()));
            let found = signs.in_sphere::<G, D, V>(&simplex, &points[V]);
            prop_assert_eq!(found, inside.cmp(&BigRational::zero()));
        }
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: crate::test_length::long_or(2000, 600), ..ProptestConfig::default() })]

        /// Points on a grid of 2^−k, moved by a few ulps or not: ties, near-ties, and all stages on the way to them.
        #[test]
        fn every_stage_agrees_with_fractions(
            cells in vec((-4i32..5, -1i64..2), 15),
            spread in prop_oneof![Just(1), Just(1 << 9), Just(1 << 20)],
            ulps in any::<bool>(),
        ) {
            let quantum = 2f64.powi(-24);
            let coordinate = |&(cell, ulp): &(i32, i64)| {
                let x = f64::from(cell * spread) * quantum + 0.5;
                if ulps { f64::from_bits((x.to_bits() as i64 + ulp) as u64) } else { x }
            };
            let values: Vec<f64> = cells.iter().map(coordinate).collect();
            let mut signs = vec![
                Signs { is_filtered: true, quantum: 0.0 },
                Signs { is_filtered: false, quantum: 0.0 },
            ];
            signs.push(Signs { is_filtered: true, quantum: if ulps { 2f64.powi(-55) } else { quantum } });
            let flat: Vec<[f64; 2]> = values[..8].as_chunks().0.to_vec();
            agrees::<Triangles, 2, 3>(&signs, &flat)?;
            let solid: Vec<[f64; 3]> = values.as_chunks().0.to_vec();
            agrees::<Tetrahedra, 3, 4>(&signs, &solid)?;
            agrees::<Triangles, 3, 3>(&signs, &solid[..4])?;
            agrees::<Gabriel, 3, 3>(&signs, &solid[..4])?;
            let upright: Vec<[f64; 3]> = solid[..4].iter().map(|p| [0.5, p[1], p[2]]).collect();
            agrees::<Gabriel, 3, 3>(&signs, &upright)?;
        }
    }
}
