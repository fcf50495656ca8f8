//! Measures many quadrangles at a time.
//!
//! *Problem.* Each asks for four areas and four circumcircles, and there are nearly as many quadrangles as triangles.
//! *Idea.* They lie in the lanes of a vector, the ends of the diagonal first. All four normals look to the same side of the cell,
//! whichever that is, as only angles between them count.
//! *Guarantee.* The same bits whatever the width of the vector, and however many are looked at.

use pulp::{Scalar, Simd, WithSimd};
use taut_points::vectors;

use super::cells::Cells;
use super::diagonals::Quadrangle;
use super::lanes::{MOST_LANES, Vectors, cross, dot, minus};
use super::spheres::Point;

/// Sums of radii that differ by no more than this share are alike. It was chosen from 0.003 to 0.04 with the seven reference sets in
/// view; on all but two of these any of them does.
const RADII_TOLERANCE: f64 = 0.006;
/// A share above this is no rounding.
const ROUNDING_SHARE: f64 = 1e-9;
/// (cos 1/5)², rounded up: angles of no more than a fifth of what takes a swap are small.
const SMALL_COS_SQUARE: f64 = 0.960531;

/// The quality of a quadrangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct QuadQuality {
    /// The other two triangles have smaller circumcircles: in sum, or the larger one if that is much the same.
    pub(super) is_rounder: bool,
    /// Some of its four triangles turn so much against each other that a swap could make the surface flatter.
    pub(super) is_bent: bool,
}

/// Looks at quadrangles.
pub(super) fn quad_qualities(
    quadrangles: &[Quadrangle],
    cells: &Cells,
    points: &[Point],
) -> Vec<QuadQuality> {
    vectors().dispatch(QuadQualityKernel { quadrangles, cells, points })
}

pub(super) fn quad_quality(
    quadrangle: &Quadrangle,
    cells: &Cells,
    points: &[Point],
) -> QuadQuality {
    let mut block = Block::default();
    block.set(0, quadrangle, cells, points);
    block.margins(Scalar::new(), 1);
    block.quad_quality(0)
}

struct QuadQualityKernel<'a> {
    quadrangles: &'a [Quadrangle],
    cells: &'a Cells,
    points: &'a [Point],
}

impl WithSimd for QuadQualityKernel<'_> {
    type Output = Vec<QuadQuality>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<QuadQuality> {
        let Self { quadrangles, cells, points } = self;
        let mut quad_qualities = Vec::with_capacity(quadrangles.len());
        let mut block = Block::default();
        for some in quadrangles.chunks(MOST_LANES) {
            for (lane, quadrangle) in some.iter().enumerate() {
                block.set(lane, quadrangle, cells, points);
            }
            block.margins(simd, some.len());
            for lane in 0..some.len() {
                quad_qualities.push(block.quad_quality(lane));
            }
        }
        quad_qualities
    }
}

/// Quadrangles by lane.
#[derive(Default)]
struct Block {
    /// By corner, axis and lane, the ends of the diagonal first.
    corners: [[[f64; MOST_LANES]; 3]; 4],
    /// By how much circles become smaller, beyond what could be rounding.
    rounder: [f64; MOST_LANES],
    /// By how much the largest angle is small.
    straighter: [f64; MOST_LANES],
}

impl Block {
    #[inline(always)]
    fn set(&mut self, lane: usize, quadrangle: &Quadrangle, cells: &Cells, points: &[Point]) {
        let sites = cells.sites(quadrangle.cell);
        let ([a, b], [c, d]) = (quadrangle.ends, quadrangle.others);
        for (corner, place) in self.corners.iter_mut().zip([a, b, c, d]) {
            let point = points[sites[place] as usize];
            corner[0][lane] = point[0];
            corner[1][lane] = point[1];
            corner[2][lane] = point[2];
        }
    }

    #[inline(always)]
    fn quad_quality(&self, lane: usize) -> QuadQuality {
        QuadQuality { is_rounder: self.rounder[lane] > 0.0, is_bent: self.straighter[lane] <= 0.0 }
    }

    /// Finds the margins of the first few lanes.
    #[inline(always)]
    fn margins<S: Simd>(&mut self, simd: S, count: usize) {
        for begin in (0..count).step_by(S::F64_LANES) {
            let lanes = begin..begin + S::F64_LANES;
            let load = |k: usize| -> Vectors<S> {
                let axis = |i: usize| simd.partial_load_f64s(&self.corners[k][i][lanes.clone()]);
                [axis(0), axis(1), axis(2)]
            };
            let (rounder, straighter) = margins(simd, load(0), load(1), load(2), load(3));
            simd.partial_store_f64s(&mut self.rounder[lanes.clone()], rounder);
            simd.partial_store_f64s(&mut self.straighter[lanes], straighter);
        }
    }
}

/// By how much circles become smaller, and by how much all angles are small: positive if they are. The diagonal is from a to b.
#[inline(always)]
fn margins<S: Simd>(
    simd: S,
    a: Vectors<S>,
    b: Vectors<S>,
    c: Vectors<S>,
    d: Vectors<S>,
) -> (S::f64s, S::f64s) {
    let mul = |x: S::f64s, y: S::f64s| simd.mul_f64s(x, y);
    let squared = |e: Vectors<S>| dot(simd, e, e);
    let (u, v, w) = (minus(simd, b, a), minus(simd, c, a), minus(simd, d, a));
    let (x, y, z) = (minus(simd, c, b), minus(simd, d, b), minus(simd, d, c));
    let (ab, ac, ad) = (squared(u), squared(v), squared(w));
    let (bc, bd, cd) = (squared(x), squared(y), squared(z));
    // Normals and areas of the triangles opposite each corner.
    let (m, n) = (cross(simd, x, y), cross(simd, w, v));
    let (i, k) = (cross(simd, u, w), cross(simd, v, u));
    let (mm, nn, ii, kk) = (squared(m), squared(n), squared(i), squared(k));
    // R = |u||v||u − v|/2|n|, but for the two.
    let radius = |one: S::f64s, two: S::f64s, three: S::f64s, area: S::f64s| {
        simd.sqrt_f64s(simd.div_f64s(mul(mul(one, two), three), area))
    };
    let (one, two) = (radius(ab, bd, ad, ii), radius(ab, bc, ac, kk));
    let (three, four) = (radius(bc, cd, bd, mm), radius(ac, cd, ad, nn));
    let (now, then) = (simd.add_f64s(one, two), simd.add_f64s(three, four));
    let (all, less) = (simd.add_f64s(now, then), simd.sub_f64s(now, then));
    let largest = simd.sub_f64s(simd.max_f64s(one, two), simd.max_f64s(three, four));
    let bound = mul(simd.splat_f64s(RADII_TOLERANCE), all);
    let is_alike = simd.less_than_or_equal_f64s(simd.abs_f64s(less), bound);
    let less = simd.select_f64s(is_alike, largest, less);
    let rounder = simd.sub_f64s(less, mul(simd.splat_f64s(ROUNDING_SHARE), all));
    // x|x| for x the cosine, as its sign counts.
    let small = |along: S::f64s, one: S::f64s, other: S::f64s| {
        let bound = mul(mul(simd.splat_f64s(SMALL_COS_SQUARE), one), other);
        simd.sub_f64s(mul(along, simd.abs_f64s(along)), bound)
    };
    // The two pairs are on the two sides of the cell, which look away from each other.
    let alike = simd.min_f64s(small(dot(simd, i, k), ii, kk), small(dot(simd, m, n), mm, nn));
    let against = |one: Vectors<S>, other: Vectors<S>| simd.neg_f64s(dot(simd, one, other));
    let first = simd.min_f64s(small(against(i, m), ii, mm), small(against(i, n), ii, nn));
    let second = simd.min_f64s(small(against(k, m), kk, mm), small(against(k, n), kk, nn));
    (rounder, simd.min_f64s(alike, simd.min_f64s(first, second)))
}

#[cfg(test)]
mod tests {
    use taut_delaunay::{DelaunayOptions, Space};
    use taut_points::{Distribution, Points, generate};

    use super::*;

    fn triangulated(values: &[f64]) -> (Cells, Vec<Point>) {
        let points = Points::new(values, 3).expect("whole rows");
        let space = Space::build(&points, &DelaunayOptions::default());
        let space = space.expect("finite");
        let sites: Vec<Point> = (0..space.site_count() as u32).map(|s| space.site(s)).collect();
        (Cells::of(space.into_slots(), sites.len()), sites)
    }

    #[test]
    fn many_are_seen_as_each_alone() {
        let mut values: Vec<f64> = generate(Distribution::Uniform, 400, 3, 3).expect("valid");
        // A grid as well, where circles are equal and triangles have right angles.
        values.extend((0..64).flat_map(|k| [k % 4, k / 4 % 4, k / 16].map(|x| 0.3 * f64::from(x))));
        let (cells, points) = triangulated(&values);
        let mix = |cell: u32| cell.wrapping_mul(0x9E37_79B1) >> 31 == 1;
        let inside: Vec<bool> = (0..cells.len() as u32).map(mix).collect();
        let all = 0..cells.len() as u32;
        let all: Vec<_> = all.filter_map(|cell| Quadrangle::of(cell, &cells, &inside)).collect();
        let many = quad_qualities(&all, &cells, &points);
        let alone: Vec<QuadQuality> =
            all.iter().map(|one| quad_quality(one, &cells, &points)).collect();
        assert_eq!(many, alone);
        let count = |is: fn(&QuadQuality) -> bool| {
            many.iter().filter(|&quad_quality| is(quad_quality)).count()
        };
        assert!(all.len() > 300 && count(|quad_quality| quad_quality.is_rounder) > 50);
        assert!(count(|quad_quality| quad_quality.is_bent) > 50);
    }

    #[test]
    fn of_two_diagonals_the_one_with_the_smaller_circles_is_rounder() {
        // A flat kite, 4 long and 2 wide: across its width its triangles have smaller circles than along its length.
        let kite = [0.0, 0.0, 0.0, 4.0, 0.0, 1e-3, 2.0, 1.0, 0.0, 2.0, -1.0, 0.0];
        let (cells, points) = triangulated(&kite);
        let cell = cells.finite().next().expect("four points make a cell");
        let sites = cells.sites(cell);
        let place = |x: f64| {
            (0..4)
                .filter(|&i| (points[sites[i] as usize][0] == 2.0) == (x == 2.0))
                .collect::<Vec<_>>()
        };
        let [along, across] = [place(0.0), place(2.0)].map(|ends| [ends[0], ends[1]]);
        let seen = |ends, others| quad_quality(&Quadrangle { cell, ends, others }, &cells, &points);
        assert_eq!(seen(along, across), QuadQuality { is_rounder: true, is_bent: false });
        assert_eq!(seen(across, along), QuadQuality { is_rounder: false, is_bent: false });
    }
}
