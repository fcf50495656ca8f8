//! Orientation and in-sphere determinants, of triangles and of tetrahedra, over any numbers.
//!
//! *Formula.* Let a₀…a_d be a positively oriented simplex, q a point, eᵢ = aᵢ − a₀, r = q − a₀ and lᵢ = |eᵢ|². The
//! paraboloid over a₀ is met in the lifted vertices by the plane with slopes N/O, where O = det(e₁…e_d) > 0 and N is the
//! combination of the lᵢ with the cofactors of O. So
//!
//! > D = N·r − |r|²·O
//!
//! is positive when q lies inside the circumsphere, negative outside. N and O belong to the simplex and serve for all its
//! neighbors. The cofactor of lᵢ is the orientation of the simplex with q in place of aᵢ, that of |r|² is −O.
//! *Triangles in space.* In a plane that does not stand upright on the first two coordinates, minors of those two serve
//! for the orientation, as projecting the plane to them is affine; only the squares l and |r|² need all three.

use super::signs::UNDERFLOW;
use crate::arithmetic::{Ring, U};
use crate::unrolled::unrolled;

/// N and O.
pub(crate) struct Lifted<T, const D: usize> {
    pub(crate) normal: [T; D],
    pub(crate) orientation: T,
}

/// Bounds that hold for a determinant over `f64`, in units of the largest |monomial| there can be, and the sizes of
/// coordinate differences, in units that divide them all, up to which it is known exactly.
pub(crate) struct Bounds {
    /// Monomials times roundings on the way of one, times u, with one more rounding for the bound itself.
    pub(crate) rounding: f64,
    /// The same in units of the sum of all |monomials|.
    pub(crate) rounding_of_sum: f64,
    /// The same over [`DoubleDouble`](crate::arithmetic::DoubleDouble), from 8u² for each operation.
    pub(crate) rounding_twice: f64,
    /// monomials·m^degree ≤ 2⁵³.
    pub(crate) exact_max: f64,
    /// Factors in a monomial.
    pub(crate) degree: i32,
}

impl Bounds {
    /// Returns what a determinant over [`DoubleDouble`](crate::arithmetic::DoubleDouble) is off by at most, if no monomial is
    /// larger than `size`.
    pub(crate) fn of_double_double(&self, size: f64) -> f64 {
        self.rounding_twice * (1.0 + 64.0 * U) * size + UNDERFLOW
    }
}

/// A kind of simplices: `V` vertices with `D` coordinates.
pub(crate) trait Geometry<const D: usize, const V: usize>: Sync {
    const ORIENTATION: Bounds;
    const IN_SPHERE: Bounds;
    /// Every monomial of O and D has a factor from each of so many first coordinates.
    const FACTORS: usize;

    /// N and O of the edges e₁…e_{V−1}.
    fn lifted<T: Ring>(edges: &[[T; D]]) -> Lifted<T, D>;

    /// O alone.
    fn orientation<T: Ring>(edges: &[[T; D]]) -> T;

    /// N·r.
    fn slope<T: Ring>(normal: &[T; D], r: &[T; D]) -> T;

    /// The largest monomial of O where `max` are the largest sizes of the differences in each coordinate.
    fn volume(max: &[f64; D]) -> f64;

    /// D.
    #[inline(always)]
    fn in_sphere<T: Ring>(lifted: &Lifted<T, D>, r: &[T; D]) -> T {
        Self::slope(&lifted.normal, r).minus(&square(r).times(&lifted.orientation))
    }

    /// The largest monomial of D.
    #[inline(always)]
    fn lifted_volume(max: &[f64; D]) -> f64 {
        let largest = largest(max);
        Self::volume(max) * largest * largest
    }
}

/// The largest of sizes.
#[inline(always)]
pub(crate) fn largest<const D: usize>(sizes: &[f64; D]) -> f64 {
    let mut largest = 0.0f64;
    unrolled!(k < D, { largest = largest.max(sizes[k]) });
    largest
}

/// |v|².
#[inline(always)]
fn square<T: Ring, const D: usize>(v: &[T; D]) -> T {
    // A loop: a closure would not be compiled for the vectors that its caller is compiled for.
    let mut sum = v[0].times(&v[0]);
    unrolled!(k < D - 1, { sum = sum.plus(&v[k + 1].times(&v[k + 1])) });
    sum
}

/// aᵢbⱼ − aⱼbᵢ.
#[inline(always)]
pub(crate) fn minor<T: Ring, const D: usize>(a: &[T; D], b: &[T; D], i: usize, j: usize) -> T {
    a[i].times(&b[j]).minus(&a[j].times(&b[i]))
}

/// Triangles, in the plane (`D = 2`) or in a plane of space that is not upright (`D = 3`).
pub(crate) struct Triangles;

impl<const D: usize> Geometry<D, 3> for Triangles {
    /// 2 monomials; two differences, a product, a difference.
    const ORIENTATION: Bounds = Bounds {
        rounding: 2.0 * 5.0 * U,
        rounding_of_sum: 5.0 * U,
        rounding_twice: 2.0 * 3.0 * 8.0 * U * U,
        exact_max: 67_108_864.0,
        degree: 2,
    };
    /// 18 monomials for D = 3. For eᵢ: four differences, 3 roundings in a square, its product with a coordinate, a
    /// difference, the product with r, and two sums: 12.
    const IN_SPHERE: Bounds = Bounds {
        rounding: 18.0 * 13.0 * U,
        rounding_of_sum: 13.0 * U,
        rounding_twice: 18.0 * 9.0 * 8.0 * U * U,
        exact_max: 4096.0,
        degree: 4,
    };
    const FACTORS: usize = 2;

    #[inline(always)]
    fn lifted<T: Ring>(edges: &[[T; D]]) -> Lifted<T, D> {
        let (b, c) = (&edges[0], &edges[1]);
        let (lb, lc) = (square(b), square(c));
        // The slope in the third coordinate is not used.
        let mut normal = b.clone();
        normal[0] = lb.times(&c[1]).minus(&lc.times(&b[1]));
        normal[1] = lc.times(&b[0]).minus(&lb.times(&c[0]));
        Lifted { normal, orientation: minor(b, c, 0, 1) }
    }

    #[inline(always)]
    fn orientation<T: Ring>(edges: &[[T; D]]) -> T {
        minor(&edges[0], &edges[1], 0, 1)
    }

    #[inline(always)]
    fn slope<T: Ring>(normal: &[T; D], r: &[T; D]) -> T {
        normal[0].times(&r[0]).plus(&normal[1].times(&r[1]))
    }

    #[inline(always)]
    fn volume(max: &[f64; D]) -> f64 {
        max[0] * max[1]
    }
}

pub(crate) struct Tetrahedra;

/// The plane of a triangle in space, in plain arithmetic, for many points.
pub(crate) struct Plane {
    origin: [f64; 3],
    normal: [f64; 3],
    max: [f64; 3],
}

impl Plane {
    #[inline(always)]
    pub(crate) fn of([a, b, c]: &[[f64; 3]; 3]) -> Self {
        let [b, c] = [b, c].map(|p| std::array::from_fn(|k| p[k] - a[k]));
        let max = std::array::from_fn(|k| b[k].abs().max(c[k].abs()));
        Plane { origin: *a, normal: cross(&b, &c), max }
    }

    /// Tests whether the tetrahedron of the triangle and `q` is surely negative: the triangle faces away from `q`. All sizes are below 1.
    #[inline(always)]
    pub(crate) fn is_beneath(&self, q: &[f64; 3]) -> bool {
        let r: [f64; 3] = std::array::from_fn(|k| q[k] - self.origin[k]);
        let max = std::array::from_fn(|k| self.max[k].max(r[k].abs()));
        let bound = Tetrahedra::ORIENTATION.rounding * Tetrahedra::volume(&max) + UNDERFLOW;
        dot(&self.normal, &r) < -bound
    }
}

/// a × b.
#[inline(always)]
pub(crate) fn cross<T: Ring>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [minor(a, b, 1, 2), minor(a, b, 2, 0), minor(a, b, 0, 1)]
}

#[inline(always)]
fn dot<T: Ring>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
}

impl Geometry<3, 4> for Tetrahedra {
    /// 6 monomials; three differences, a product, a difference, a product, two sums: 8.
    const ORIENTATION: Bounds = Bounds {
        rounding: 6.0 * 9.0 * U,
        rounding_of_sum: 9.0 * U,
        rounding_twice: 6.0 * 6.0 * 8.0 * U * U,
        exact_max: 65_536.0,
        degree: 3,
    };
    /// 72 monomials. For eᵢ: five differences, 3 roundings in a square, 2 in a minor, their product, two sums, the
    /// product with r, and three sums: 17.
    const IN_SPHERE: Bounds = Bounds {
        rounding: 72.0 * 18.0 * U,
        rounding_of_sum: 18.0 * U,
        rounding_twice: 72.0 * 13.0 * 8.0 * U * U,
        exact_max: 512.0,
        degree: 5,
    };
    const FACTORS: usize = 3;

    #[inline(always)]
    fn lifted<T: Ring>(edges: &[[T; 3]]) -> Lifted<T, 3> {
        let (b, c, d) = (&edges[0], &edges[1], &edges[2]);
        let (lb, lc, ld) = (square(b), square(c), square(d));
        let (cd, db, bc) = (cross(c, d), cross(d, b), cross(b, c));
        let mut normal = b.clone();
        for k in 0..3 {
            normal[k] = lb.times(&cd[k]).plus(&lc.times(&db[k])).plus(&ld.times(&bc[k]));
        }
        Lifted { normal, orientation: dot(&bc, d) }
    }

    #[inline(always)]
    fn orientation<T: Ring>(edges: &[[T; 3]]) -> T {
        dot(&cross(&edges[0], &edges[1]), &edges[2])
    }

    #[inline(always)]
    fn slope<T: Ring>(normal: &[T; 3], r: &[T; 3]) -> T {
        dot(normal, r)
    }

    #[inline(always)]
    fn volume(max: &[f64; 3]) -> f64 {
        max[0] * max[1] * max[2]
    }
}

/// Triangles in space with their smallest ball instead of a sphere through a fourth point: for edges u, v and n = u × v, O is |n|² and
/// N is (n × u)|v|² + (v × n)|u|², so that D = N·r − |r|²·O is positive when q lies inside the smallest ball whose sphere passes the
/// three vertices. Nothing of this tells on which side of the triangle q is.
pub(crate) struct Gabriel;

impl Geometry<3, 3> for Gabriel {
    /// 12 monomials, as 4 for the square of each of three minors; four differences, 2 roundings in each of two minors, a product, two
    /// sums: 11.
    const ORIENTATION: Bounds = Bounds {
        rounding: 12.0 * 12.0 * U,
        rounding_of_sum: 12.0 * U,
        rounding_twice: 12.0 * 8.0 * 8.0 * U * U,
        exact_max: 4096.0,
        degree: 4,
    };
    /// 36 monomials of |r|²·O and 72 of N·r. For those of N: six differences, 2 roundings in n, 2 in n × u, 3 in a square, their
    /// product, a sum, the product with r, and three sums: 19.
    const IN_SPHERE: Bounds = Bounds {
        rounding: 108.0 * 20.0 * U,
        rounding_of_sum: 20.0 * U,
        rounding_twice: 108.0 * 14.0 * 8.0 * U * U,
        exact_max: 200.0,
        degree: 6,
    };
    const FACTORS: usize = 0;

    #[inline(always)]
    fn lifted<T: Ring>(edges: &[[T; 3]]) -> Lifted<T, 3> {
        let (u, v) = (&edges[0], &edges[1]);
        let (lu, lv, n) = (square(u), square(v), cross(u, v));
        let (nu, vn) = (cross(&n, u), cross(v, &n));
        let mut normal = u.clone();
        for k in 0..3 {
            normal[k] = nu[k].times(&lv).plus(&vn[k].times(&lu));
        }
        Lifted { normal, orientation: square(&n) }
    }

    #[inline(always)]
    fn orientation<T: Ring>(edges: &[[T; 3]]) -> T {
        square(&cross(&edges[0], &edges[1]))
    }

    #[inline(always)]
    fn slope<T: Ring>(normal: &[T; 3], r: &[T; 3]) -> T {
        dot(normal, r)
    }

    #[inline(always)]
    fn volume(max: &[f64; 3]) -> f64 {
        let largest = max.iter().fold(0.0f64, |largest, &m| largest.max(m));
        largest * largest * largest * largest
    }
}
