//! In-sphere determinants of many facets at a time, in double-double: what plain arithmetic leaves open.
//!
//! *Idea.* On a turned grid, a sphere or a circle nearly every facet is a near tie, and each takes a few hundred dependent
//! operations. Those of several facets fill the lanes of a vector, and a fused multiply-add gives the error of a product in
//! one operation. The few that are still open are told one by one in whole numbers.
//! *Bound.* As for [`DoubleDouble`](crate::arithmetic::DoubleDouble): the same operations, lane by lane.

use pulp::{Arch, Simd, WithSimd};

use super::super::MeshViolation;
use super::facets::Facet;
use super::geometry::Geometry;
use super::signs::{Conflict, Signs, sign_of};
use crate::arithmetic::Ring;

/// Lanes of the widest vectors there are.
const MOST_LANES: usize = 8;

/// Numbers as [`DoubleDouble`](crate::arithmetic::DoubleDouble), one in each lane.
#[derive(Clone, Copy)]
struct Lanes<S: Simd> {
    simd: S,
    high: S::f64s,
    low: S::f64s,
}

impl<S: Simd> Lanes<S> {
    /// a − b, exactly.
    #[inline(always)]
    fn difference(simd: S, a: S::f64s, b: S::f64s) -> Self {
        Self::two_sum(simd, a, simd.neg_f64s(b))
    }

    #[inline(always)]
    fn two_sum(simd: S, a: S::f64s, b: S::f64s) -> Self {
        let high = simd.add_f64s(a, b);
        let of_b = simd.sub_f64s(high, a);
        let of_a = simd.sub_f64s(high, of_b);
        let low = simd.add_f64s(simd.sub_f64s(a, of_a), simd.sub_f64s(b, of_b));
        Lanes { simd, high, low }
    }

    /// a + b, where |a| ≥ |b| or a = 0.
    #[inline(always)]
    fn fast_two_sum(simd: S, a: S::f64s, b: S::f64s) -> Self {
        let high = simd.add_f64s(a, b);
        Lanes { simd, high, low: simd.sub_f64s(b, simd.sub_f64s(high, a)) }
    }
}

impl<S: Simd> Ring for Lanes<S> {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        let simd = self.simd;
        let sum = Self::two_sum(simd, self.high, other.high);
        let rest = Self::two_sum(simd, self.low, other.low);
        let sum = Self::fast_two_sum(simd, sum.high, simd.add_f64s(sum.low, rest.high));
        Self::fast_two_sum(simd, sum.high, simd.add_f64s(sum.low, rest.low))
    }

    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        let simd = self.simd;
        let (high, low) = (simd.neg_f64s(other.high), simd.neg_f64s(other.low));
        self.plus(&Lanes { simd, high, low })
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let simd = self.simd;
        let product = simd.mul_f64s(self.high, other.high);
        let error = simd.mul_add_f64s(self.high, other.high, simd.neg_f64s(product));
        let cross =
            simd.add_f64s(simd.mul_f64s(self.high, other.low), simd.mul_f64s(self.low, other.high));
        Self::fast_two_sum(simd, product, simd.add_f64s(error, cross))
    }
}

/// A facet with the points of its determinant.
struct NearTie<const D: usize, const V: usize> {
    facet: Facet,
    simplex: [[f64; D]; V],
    apex: [f64; D],
    /// The largest monomial there can be.
    size: f64,
}

/// Facets on their way.
pub(super) struct NearTies<const D: usize, const V: usize> {
    ties: Vec<NearTie<D, V>>,
    values: Vec<f64>,
}

impl<const D: usize, const V: usize> NearTies<D, V> {
    pub(super) fn new() -> Self {
        NearTies { ties: Vec::new(), values: Vec::new() }
    }

    /// Adds a facet of `simplex` with `apex` beyond it; no monomial of the determinant is larger than `size`.
    pub(super) fn push(&mut self, facet: Facet, simplex: [[f64; D]; V], apex: [f64; D], size: f64) {
        self.ties.push(NearTie { facet, simplex, apex, size });
    }

    /// Drops what a block that failed has left.
    pub(super) fn forget(&mut self) {
        self.ties.clear();
    }

    /// Tells of each what it is, and forgets them.
    pub(super) fn settle<G: Geometry<D, V>>(
        &mut self,
        signs: &Signs,
        mut conclude: impl FnMut(&Facet, Conflict) -> Result<(), MeshViolation>,
    ) -> Result<(), MeshViolation> {
        if self.ties.is_empty() {
            return Ok(());
        }
        self.values.clear();
        let (ties, values) = (&self.ties, &mut self.values);
        Arch::new().dispatch(Determinants {
            ties,
            values,
            geometry: std::marker::PhantomData::<G>,
        });
        for (tie, &value) in self.ties.iter().zip(&self.values) {
            let NearTie { facet, simplex, apex, size } = tie;
            let bound = G::IN_SPHERE.of_double_double(*size);
            let sign = if value.abs() > bound {
                sign_of(value)
            } else {
                signs.in_sphere_exactly::<G, D, V>(simplex, apex, value.abs() + bound)
            };
            conclude(facet, signs.conflict_of::<G, D, V>(simplex, apex, sign))?;
        }
        self.ties.clear();
        Ok(())
    }
}

/// The determinants of `ties`, in turn.
struct Determinants<'a, G, const D: usize, const V: usize> {
    ties: &'a [NearTie<D, V>],
    values: &'a mut Vec<f64>,
    geometry: std::marker::PhantomData<G>,
}

impl<G: Geometry<D, V>, const D: usize, const V: usize> WithSimd for Determinants<'_, G, D, V> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let width = S::F64_LANES.min(MOST_LANES);
        let zero = simd.splat_f64s(0.0);
        let mut differences = [[Lanes { simd, high: zero, low: zero }; D]; V];
        let mut lanes = [0.0; MOST_LANES];
        for ties in self.ties.chunks(width) {
            for k in 0..D {
                for (lane, tie) in lanes.iter_mut().zip(ties) {
                    *lane = tie.simplex[0][k];
                }
                let origin = simd.partial_load_f64s(&lanes[..width]);
                // The edges from the first vertex to the others, then to the apex.
                for i in 1..=V {
                    for (lane, tie) in lanes.iter_mut().zip(ties) {
                        *lane = tie.simplex.get(i).unwrap_or(&tie.apex)[k];
                    }
                    let to = simd.partial_load_f64s(&lanes[..width]);
                    differences[i - 1][k] = Lanes::difference(simd, to, origin);
                }
            }
            let (edges, r) = differences.split_at(V - 1);
            let value = G::in_sphere(&G::lifted(edges), &r[0]).high;
            simd.partial_store_f64s(&mut lanes[..width], value);
            self.values.extend_from_slice(&lanes[..ties.len()]);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::super::geometry::{Tetrahedra, Triangles};
    use super::*;
    use crate::arithmetic::DoubleDouble;

    /// The determinants of some facets by lanes, and each by [`DoubleDouble`].
    fn agree<G: Geometry<D, V>, const D: usize, const V: usize>(
        values: &[f64],
    ) -> Result<(), TestCaseError> {
        let points: &[[f64; D]] = values.as_chunks().0;
        let mut ties = NearTies::<D, V>::new();
        let mut expected = vec![];
        for points in points.chunks_exact(V + 1) {
            let simplex: [[f64; D]; V] = std::array::from_fn(|i| points[i]);
            ties.push(Facet::default(), simplex, points[V], 0.0);
            let differences: Vec<[DoubleDouble; D]> = points[1..]
                .iter()
                .map(|p| std::array::from_fn(|k| DoubleDouble::difference(p[k], points[0][k])))
                .collect();
            let (edges, r) = differences.split_at(V - 1);
            expected.push(G::in_sphere(&G::lifted(edges), &r[0]).high);
        }
        let NearTies { ties, values } = &mut ties;
        let geometry = std::marker::PhantomData::<G>;
        Arch::new().dispatch(Determinants { ties, values, geometry });
        prop_assert_eq!(values.as_slice(), expected.as_slice());
        Arch::Scalar.dispatch(Determinants { ties, values, geometry });
        let twice = [expected.as_slice(), expected.as_slice()].concat();
        prop_assert_eq!(values.as_slice(), twice.as_slice());
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// Any number of facets, so that vectors are full or not.
        #[test]
        fn lanes_give_the_bits_of_single_numbers(values in vec(-1.0f64..1.0, 0..400)) {
            agree::<Triangles, 2, 3>(&values)?;
            agree::<Triangles, 3, 3>(&values)?;
            agree::<Tetrahedra, 3, 4>(&values)?;
        }
    }
}
