//! In-sphere determinants of many facets at a time, in double-double: what plain arithmetic leaves open.
//!
//! *Idea.* On a turned grid, a sphere or a circle nearly every facet is a near tie, and each takes a few hundred dependent
//! operations. Those of several facets fill the lanes of a vector, and a fused multiply-add gives the error of a product in
//! one operation. The few that are still open are told one by one in whole numbers.
//! *Bound.* As for [`DoubleDouble`](crate::arithmetic::DoubleDouble): the same operations, lane by lane.

use pulp::{Simd, WithSimd};
use taut_points::vectors;

use super::super::MeshViolation;
use super::facets::{Complex, Facet};
use super::geometry::Geometry;
use super::signs::Conflict;
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

/// Facets on their way.
pub(super) struct NearTies {
    facets: Vec<Facet>,
    values: Vec<f64>,
}

impl NearTies {
    pub(super) fn new() -> Self {
        NearTies { facets: Vec::new(), values: Vec::new() }
    }

    /// Adds a facet, of which vertex and test are known.
    #[inline(always)]
    pub(super) fn push(&mut self, facet: Facet) {
        self.facets.push(facet);
    }

    /// Drops what a block that failed has left.
    pub(super) fn forget(&mut self) {
        self.facets.clear();
    }

    /// Tells of each what it is, and forgets them. The batch begins with simplex `first`.
    pub(super) fn settle<G: Geometry<D, V>, const D: usize, const V: usize>(
        &mut self,
        complex: &Complex<'_, D, V>,
        first: usize,
        mut conclude: impl FnMut(&Facet, Conflict) -> Result<(), MeshViolation>,
    ) -> Result<(), MeshViolation> {
        if self.facets.is_empty() {
            return Ok(());
        }
        self.values.clear();
        let (facets, values) = (&self.facets, &mut self.values);
        let geometry = std::marker::PhantomData::<G>;
        vectors().dispatch(Determinants { complex, first, facets, values, geometry });
        for (facet, &value) in self.facets.iter().zip(&self.values) {
            let bound = G::IN_SPHERE.of_double_double(facet.tested.size);
            let conflict = if value.abs() > bound {
                Conflict { is_inside: value > 0.0, is_tie: false }
            } else {
                let (simplex, apex) = complex.points(first, facet);
                let signs = &complex.signs;
                let sign = signs.in_sphere_exactly::<G, D, V>(&simplex, &apex, value.abs() + bound);
                signs.conflict_of::<G, D, V>(&simplex, &apex, sign)
            };
            conclude(facet, conflict)?;
        }
        self.facets.clear();
        Ok(())
    }
}

/// The determinants of `facets`, in turn.
struct Determinants<'a, G, const D: usize, const V: usize> {
    complex: &'a Complex<'a, D, V>,
    first: usize,
    facets: &'a [Facet],
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
        let mut vertices = [[[0.0; MOST_LANES]; D]; V];
        let mut apexes = [[0.0; MOST_LANES]; D];
        for facets in self.facets.chunks(width) {
            for (lane, facet) in facets.iter().enumerate() {
                let (simplex, apex) = self.complex.points(self.first, facet);
                for k in 0..D {
                    for i in 0..V {
                        vertices[i][k][lane] = simplex[i][k];
                    }
                    apexes[k][lane] = apex[k];
                }
            }
            for k in 0..D {
                let origin = simd.partial_load_f64s(&vertices[0][k][..width]);
                // The edges from the first vertex to the others, then to the apex.
                for i in 1..V {
                    let to = simd.partial_load_f64s(&vertices[i][k][..width]);
                    differences[i - 1][k] = Lanes::difference(simd, to, origin);
                }
                let to = simd.partial_load_f64s(&apexes[k][..width]);
                differences[V - 1][k] = Lanes::difference(simd, to, origin);
            }
            let (edges, r) = differences.split_at(V - 1);
            let value = G::in_sphere(&G::lifted(edges), &r[0]).high;
            let mut lanes = [0.0; MOST_LANES];
            simd.partial_store_f64s(&mut lanes[..width], value);
            self.values.extend_from_slice(&lanes[..facets.len()]);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::marker::PhantomData;

    use proptest::collection::vec;
    use proptest::prelude::*;
    use pulp::Arch;
    use taut_points::{Monitor, Points, Scratch};

    use super::super::geometry::{Tetrahedra, Triangles};
    use super::super::input::Input;
    use super::super::sites::Sites;
    use super::*;
    use crate::arithmetic::DoubleDouble;

    /// The determinants of some facets by lanes, and each by [`DoubleDouble`].
    fn agree<G: Geometry<D, V>, const D: usize, const V: usize>(
        values: &[f64],
    ) -> Result<(), TestCaseError> {
        let facets = values.len() / (D * (V + 1));
        let points = Points::new(&values[..facets * D * (V + 1)], D).unwrap();
        let mut scratch = Scratch::new();
        let input = Input::<D>::read(&points, &mut scratch, &Monitor::silent()).unwrap();
        let (sites, signs) = (Sites::of(&input), input.signs());
        // Each simplex has V rows of its own, and the row after them beyond it.
        let first_row = |simplex: usize| (simplex * (V + 1)) as u32;
        let simplices: Vec<[u32; V]> =
            (0..facets).map(|s| std::array::from_fn(|i| first_row(s) + i as u32)).collect();
        let facets: Vec<Facet> =
            (0..facets).map(|s| Facet::beyond(s, first_row(s) + V as u32)).collect();
        let complex = Complex { sites: &sites, signs, simplices: &simplices, neighbors: &[] };
        let mut expected = vec![];
        for facet in &facets {
            let (simplex, apex) = complex.points(0, facet);
            let others = simplex[1..].iter().chain([&apex]);
            let differences: Vec<[DoubleDouble; D]> = others
                .map(|p| std::array::from_fn(|k| DoubleDouble::difference(p[k], simplex[0][k])))
                .collect();
            let (edges, r) = differences.split_at(V - 1);
            expected.push(G::in_sphere(&G::lifted(edges), &r[0]).high);
        }
        for arch in [Arch::new(), Arch::Scalar] {
            let (mut values, geometry) = (vec![], PhantomData::<G>);
            let determinants = Determinants {
                complex: &complex,
                first: 0,
                facets: &facets,
                values: &mut values,
                geometry,
            };
            arch.dispatch(determinants);
            prop_assert_eq!(&values, &expected);
        }
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
