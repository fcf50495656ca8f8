//! Circumspheres of many cells at a time.
//!
//! *Problem.* Spheres are a sixth of all that comes after the triangulation, and one cell at a time waits for its division and its root.
//! *Idea.* Cells lie in the lanes of a vector, corners and axes apart; what is not a sphere of its own is looked at again, one by one.
//! *Guarantee.* The same operations in the same order as for [`circumsphere`], so the same bits whatever the width of the vector.

use pulp::{Simd, WithSimd};
use taut_points::vectors;

use super::cells::Cells;
use super::spheres::{NEARLY_FLAT, Point, Sphere, circumsphere};

/// Lanes of the widest vectors there are.
pub(super) const MOST_LANES: usize = 8;

/// Writes the spheres of cells from one on, of ghosts some of no size, and tells the flat ones among these cells. Flat is a cell whose
/// volume, squared and six times as large as it is, is at most `flat` beside the product of the squares of the edges from its first vertex.
pub(super) fn write_spheres(
    spheres: &mut [Sphere],
    first: u32,
    cells: &Cells,
    points: &[Point],
    flat: f64,
) -> Vec<u32> {
    vectors().dispatch(Spheres { spheres, first, cells, points, flat })
}

struct Spheres<'a> {
    spheres: &'a mut [Sphere],
    first: u32,
    cells: &'a Cells,
    points: &'a [Point],
    flat: f64,
}

pub(super) type Vectors<S> = [<S as Simd>::f64s; 3];

#[inline(always)]
pub(super) fn minus<S: Simd>(simd: S, a: Vectors<S>, b: Vectors<S>) -> Vectors<S> {
    [simd.sub_f64s(a[0], b[0]), simd.sub_f64s(a[1], b[1]), simd.sub_f64s(a[2], b[2])]
}

#[inline(always)]
pub(super) fn dot<S: Simd>(simd: S, a: Vectors<S>, b: Vectors<S>) -> S::f64s {
    let two = simd.add_f64s(simd.mul_f64s(a[0], b[0]), simd.mul_f64s(a[1], b[1]));
    simd.add_f64s(two, simd.mul_f64s(a[2], b[2]))
}

#[inline(always)]
pub(super) fn cross<S: Simd>(simd: S, a: Vectors<S>, b: Vectors<S>) -> Vectors<S> {
    let along =
        |i: usize, k: usize| simd.sub_f64s(simd.mul_f64s(a[i], b[k]), simd.mul_f64s(a[k], b[i]));
    [along(1, 2), along(2, 0), along(0, 1)]
}

/// By corner, axis and lane.
type Corners = [[[f64; MOST_LANES]; 3]; 4];

/// The result of a block of lanes.
#[derive(Clone, Copy, Default)]
struct Block {
    center: [[f64; MOST_LANES]; 3],
    radius: [f64; MOST_LANES],
    flatness: [f64; MOST_LANES],
}

impl Block {
    /// The spheres through corners, by corner and axis.
    #[inline(always)]
    fn of<S: Simd>(simd: S, corners: &Corners) -> Self {
        let mut block = Self::default();
        let lanes = S::F64_LANES;
        for begin in (0..MOST_LANES).step_by(lanes) {
            let load =
                |lane: &[f64; MOST_LANES]| simd.partial_load_f64s(&lane[begin..begin + lanes]);
            let at = |k: usize| [load(&corners[k][0]), load(&corners[k][1]), load(&corners[k][2])];
            let first = at(0);
            let (u, v, w) =
                (minus(simd, at(1), first), minus(simd, at(2), first), minus(simd, at(3), first));
            let (uu, vv, ww) = (dot(simd, u, u), dot(simd, v, v), dot(simd, w, w));
            let (vw, wu, uv) = (cross(simd, v, w), cross(simd, w, u), cross(simd, u, v));
            let volume = dot(simd, u, vw);
            let product = simd.mul_f64s(simd.mul_f64s(uu, vv), ww);
            let flatness = simd.div_f64s(simd.mul_f64s(volume, volume), product);
            let half = simd.div_f64s(simd.splat_f64s(0.5), volume);
            let along = |k: usize| {
                let two = simd.add_f64s(simd.mul_f64s(uu, vw[k]), simd.mul_f64s(vv, wu[k]));
                simd.mul_f64s(half, simd.add_f64s(two, simd.mul_f64s(ww, uv[k])))
            };
            let offset = [along(0), along(1), along(2)];
            for k in 0..3 {
                let center = simd.add_f64s(first[k], offset[k]);
                simd.partial_store_f64s(&mut block.center[k][begin..begin + lanes], center);
            }
            let radius = simd.sqrt_f64s(dot(simd, offset, offset));
            simd.partial_store_f64s(&mut block.radius[begin..begin + lanes], radius);
            simd.partial_store_f64s(&mut block.flatness[begin..begin + lanes], flatness);
        }
        block
    }
}

impl WithSimd for Spheres<'_> {
    type Output = Vec<u32>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<u32> {
        let Self { spheres, first, cells, points, flat } = self;
        let mut flats = Vec::new();
        let count = spheres.len();
        let block = |k: usize| (k * MOST_LANES).min(count)..((k + 1) * MOST_LANES).min(count);
        let gather = |corners: &mut Corners, k: usize| {
            for (lane, cell) in block(k).map(|k| first + k as u32).enumerate() {
                if cells.is_ghost(cell) {
                    continue;
                }
                for (corner, site) in corners.iter_mut().zip(cells.ascending(cell)) {
                    let point = points[site as usize];
                    corner[0][lane] = point[0];
                    corner[1][lane] = point[1];
                    corner[2][lane] = point[2];
                }
            }
        };
        // A block is gathered before the one ahead of it is used: what was just written number by number is slow to read as a whole.
        let mut corners = [[[[0.0; MOST_LANES]; 3]; 4]; 2];
        gather(&mut corners[0], 0);
        for k in 0..count.div_ceil(MOST_LANES) {
            gather(&mut corners[(k + 1) % 2], k + 1);
            let own = block(k).map(|k| first + k as u32);
            let spheres = &mut spheres[block(k)];
            let found = Block::of(simd, &corners[k % 2]);
            let [x, y, z] = &found.center;
            for ((lane, cell), sphere) in own.enumerate().zip(spheres) {
                if cells.is_ghost(cell) {
                    continue;
                }
                let flatness = found.flatness[lane];
                *sphere = if flatness <= NEARLY_FLAT {
                    circumsphere(cells.ascending(cell).map(|site| points[site as usize]))
                } else {
                    Sphere { center: [x[lane], y[lane], z[lane]], radius: found.radius[lane] }
                };
                if flatness <= flat {
                    flats.push(cell);
                }
            }
        }
        flats
    }
}

#[cfg(test)]
mod tests {
    use taut_delaunay::{DelaunayOptions, Space};
    use taut_points::{Distribution, Points, generate};

    use super::*;

    #[test]
    fn lanes_have_the_bits_of_single_spheres() {
        let mut values: Vec<f64> = generate(Distribution::Uniform, 500, 3, 7).expect("valid");
        // A grid as well, which has cells without volume.
        values
            .extend((0..125).flat_map(|k| [k % 5, k / 5 % 5, k / 25].map(|x| 0.2 * f64::from(x))));
        let points = Points::new(&values, 3).expect("whole rows");
        let space = Space::build(&points, &DelaunayOptions::default());
        let space = space.expect("finite");
        let sites: Vec<Point> = (0..space.site_count() as u32).map(|s| space.site(s)).collect();
        let cells = Cells::of(space.into_slots(), sites.len());
        let mut spheres = vec![Sphere { center: [0.0; 3], radius: 0.0 }; cells.len()];
        let flats = write_spheres(&mut spheres, 0, &cells, &sites, 1e-5);
        assert!(!flats.is_empty() && flats.len() < cells.len() / 2);
        for (cell, sphere) in (0u32..).zip(&spheres) {
            if cells.is_ghost(cell) {
                assert_eq!(sphere.radius, 0.0);
            } else {
                let corners = cells.ascending(cell).map(|site| sites[site as usize]);
                assert_eq!(*sphere, circumsphere(corners), "{cell}");
            }
        }
        // From another cell on, lanes hold others, and nothing changes.
        let mut rest = vec![spheres[0]; cells.len() - 3];
        write_spheres(&mut rest, 3, &cells, &sites, 1e-5);
        let is_same = |(k, sphere): (usize, &Sphere)| {
            cells.is_ghost(k as u32 + 3) || *sphere == spheres[k + 3]
        };
        assert!(rest.iter().enumerate().all(is_same));
    }
}
