//! Items in the coordinates y = P(x − c), with twice the digits on the way there.
//!
//! *Why.* Where P brings axes of very different lengths to one, PSP′ is a small difference of large numbers. Formed in
//! doubled precision and rounded once, it is right to the last digits beside 1.

use taut_points::parallel::IntoParallel;
#[cfg(target_arch = "x86_64")]
use taut_points::{InstructionSet, instruction_set};

use super::Shapes;
use taut_kernels::vector::dot;
use taut_kernels::{Center, DoubleDouble};

/// Relative rounding of one operation in doubled precision, as the checker takes it: a few times what it is.
const DOUBLED_ROUNDING: f64 = 16.0 * f64::EPSILON * f64::EPSILON;

/// Where a′Sa is not this much larger than its error, no point is known to touch, to the checker either.
const KNOWN_RATIO: f64 = 1e6;

/// A linear map by rows, r × d, and the center it is taken from.
#[derive(Clone, Copy)]
pub(crate) struct Map<'a> {
    pub(crate) matrix: &'a [f64],
    pub(crate) center: &'a Center,
}

impl Map<'_> {
    pub(crate) fn rank(&self) -> usize {
        self.matrix.len() / self.center.dim()
    }

    fn row(&self, a: usize) -> &[f64] {
        let dim = self.center.dim();
        &self.matrix[a * dim..(a + 1) * dim]
    }

    /// Px for a vector x.
    fn image(&self, x: &[DoubleDouble]) -> Vec<f64> {
        let coordinate = |a: usize| {
            let terms = self.row(a).iter().zip(x).filter(|(p, _)| **p != 0.0);
            terms.fold(DoubleDouble::ZERO, |sum, (&p, &x)| sum + x * p.into()).high
        };
        (0..self.rank()).map(coordinate).collect()
    }

    /// x − c.
    fn offset(&self, x: &[f64]) -> Vec<DoubleDouble> {
        let tail = |j: usize| self.center.low.get(j).copied().unwrap_or(0.0);
        let parts = x.iter().zip(&self.center.high).enumerate();
        parts.map(|(j, (x, c))| DoubleDouble::sum(*x, -c) + (-tail(j)).into()).collect()
    }

    /// P(x − c).
    pub(crate) fn point(&self, x: &[f64]) -> Vec<f64> {
        self.image(&self.offset(x))
    }

    /// P(m − c) of an item.
    pub(crate) fn center_of(&self, shapes: &Shapes, i: usize) -> Vec<f64> {
        self.point(shapes.center(i))
    }

    /// PSP′ of an item, r × r.
    pub(crate) fn shape_of(&self, shapes: &Shapes, i: usize) -> Vec<f64> {
        #[cfg(target_arch = "x86_64")]
        if instruction_set() >= InstructionSet::Avx2 {
            // SAFETY: the processor has both features.
            #[allow(unsafe_code)]
            return unsafe { congruence_with_fma(*self, shapes, i) };
        }
        congruence(*self, shapes, i)
    }

    /// P(p − c) for the point of an item that lies farthest in the direction a; the center where no such point is known.
    pub(crate) fn touching(&self, shapes: &Shapes, i: usize, a: &[f64]) -> Vec<f64> {
        let mut offset = self.offset(shapes.center(i));
        for (x, v) in offset.iter_mut().zip(Step::new(shapes, i, a).value) {
            *x = *x + v;
        }
        self.image(&offset)
    }

    /// The length by which a checker may find that point elsewhere: of thin items much more than the rounding of the point.
    pub(crate) fn touching_error(&self, shapes: &Shapes, i: usize, a: &[f64]) -> f64 {
        let step = Step::new(shapes, i, a);
        let of_row =
            |a: usize| self.row(a).iter().zip(&step.errors).map(|(p, e)| (p * e).abs()).sum();
        let errors: Vec<f64> = (0..self.rank()).map(of_row).collect();
        let image = self.image(&step.value);
        dot(&errors, &errors).sqrt() + step.relative * dot(&image, &image).sqrt()
    }
}

/// The way from the center of an item to the point of it that lies farthest in a direction.
struct Step {
    /// Sa/√(a′Sa), or 0 where rounding hides a′Sa.
    value: Vec<DoubleDouble>,
    /// Bound on the error of each coordinate beside that.
    errors: Vec<f64>,
    /// Bound on the part by which all of it is longer or shorter: the error of a′Sa.
    relative: f64,
}

impl Step {
    fn new(shapes: &Shapes, i: usize, a: &[f64]) -> Self {
        let dim = shapes.dim();
        let rounding = (dim + 8) as f64 * DOUBLED_ROUNDING;
        let mut v = vec![DoubleDouble::ZERO; dim];
        let mut sizes = vec![0.0; dim];
        for (j, (v, size)) in v.iter_mut().zip(&mut sizes).enumerate() {
            for (k, &ak) in a.iter().enumerate() {
                let term = shapes.entry(i, j, k) * ak.into();
                *v = *v + term;
                *size += term.high.abs();
            }
        }
        let q = v.iter().zip(a).fold(DoubleDouble::ZERO, |sum, (v, &a)| sum + *v * a.into());
        let q_error: f64 = sizes.iter().zip(a).map(|(s, a)| 3.0 * rounding * (s * a).abs()).sum();
        let is_known = q.high > KNOWN_RATIO * q_error && q.high.is_finite();
        if !is_known {
            let value = vec![DoubleDouble::ZERO; dim];
            return Step { value, errors: vec![0.0; dim], relative: 0.0 };
        }
        let root = q.sqrt();
        let value: Vec<DoubleDouble> = v.iter().map(|&v| v / root).collect();
        let error = |(s, v): (&f64, &DoubleDouble)| {
            rounding * s / root.high + 8.0 * DOUBLED_ROUNDING * v.high.abs()
        };
        let errors = sizes.iter().zip(&value).map(error).collect();
        Step { value, errors, relative: q_error / q.high }
    }
}

/// The same with the multiply-add as an instruction rather than a function call.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn congruence_with_fma(map: Map<'_>, shapes: &Shapes, i: usize) -> Vec<f64> {
    congruence(map, shapes, i)
}

#[inline(always)]
fn congruence(map: Map<'_>, shapes: &Shapes, i: usize) -> Vec<f64> {
    let (dim, rank) = (shapes.dim(), map.rank());
    let mut shape = vec![0.0; rank * rank];
    if shapes.is_point(i) {
        return shape;
    }
    let mut product = vec![DoubleDouble::ZERO; dim];
    for a in 0..rank {
        product.fill(DoubleDouble::ZERO);
        for (j, &p) in map.row(a).iter().enumerate().filter(|(_, p)| **p != 0.0) {
            for (k, sum) in product.iter_mut().enumerate() {
                *sum = *sum + shapes.entry(i, j, k) * p.into();
            }
        }
        for b in 0..=a {
            let mut sum = DoubleDouble::ZERO;
            for (&p, &v) in map.row(b).iter().zip(&product).filter(|(p, _)| **p != 0.0) {
                sum = sum + v * p.into();
            }
            shape[a * rank + b] = sum.high;
            shape[b * rank + a] = sum.high;
        }
    }
    shape
}

/// All items in the coordinates of a map.
pub(crate) struct Framed {
    pub(crate) rank: usize,
    /// P(m − c), n × r.
    pub(crate) centers: Vec<f64>,
    /// PSP′, n × r × r.
    pub(crate) shapes: Vec<f64>,
}

impl Framed {
    pub(crate) fn of(shapes: &Shapes, map: Map<'_>) -> Self {
        let each: Vec<(Vec<f64>, Vec<f64>)> = (0..shapes.len())
            .into_par_iter()
            .with_min_len(64)
            .map(|i| (map.center_of(shapes, i), map.shape_of(shapes, i)))
            .collect();
        let (centers, matrices): (Vec<_>, Vec<_>) = each.into_iter().unzip();
        Framed { rank: map.rank(), centers: centers.concat(), shapes: matrices.concat() }
    }

    pub(crate) fn len(&self) -> usize {
        self.centers.len() / self.rank
    }

    pub(crate) fn center(&self, i: usize) -> &[f64] {
        &self.centers[i * self.rank..(i + 1) * self.rank]
    }

    pub(crate) fn shape(&self, i: usize) -> &[f64] {
        let size = self.rank * self.rank;
        &self.shapes[i * size..(i + 1) * size]
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.centers.iter().chain(&self.shapes).all(|v| v.is_finite())
    }

    /// The point of item i that lies farthest in the direction a, both in these coordinates.
    pub(crate) fn touching(&self, i: usize, a: &[f64]) -> Vec<f64> {
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let v: Vec<f64> = self.shape(i).chunks_exact(self.rank).map(|row| dot(row, a)).collect();
        let q = dot(&v, a);
        let scale = if q > 0.0 { 1.0 / q.sqrt() } else { 0.0 };
        self.center(i).iter().zip(&v).map(|(m, v)| m + scale * v).collect()
    }
}
