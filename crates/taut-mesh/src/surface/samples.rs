//! Points laid over triangles evenly by area.
//!
//! *Problem.* Draw N points of a mesh such that each part of it gets its share by area, any of them without the others.
//! *Idea.* The triangles in their order are cut into N parts of equal area, and each part gets one point: the place within the
//! sum of areas names the triangle, two more numbers the point in it, folded back where the square is beyond the triangle.
//! The k-th number is the k-th of SplitMix64, which can be had without those before it.
//! *Guarantee.* Of a share of the area that covers m whole parts, m points; all of them the same for the same seed.
//! *Reference.* Steele, Lea, Flood, Fast splittable pseudorandom number generators, OOPSLA 2014.

use super::SurfaceOptions;
use crate::bvh::normal;

/// Points over triangles.
pub(super) struct Sampler<'a> {
    triangles: &'a [(u32, [[f64; 3]; 3])],
    /// The area of all triangles up to and with each.
    areas: Vec<f64>,
    /// The last with an area.
    last: usize,
    options: SurfaceOptions,
}

impl<'a> Sampler<'a> {
    /// `None` if there is no area.
    pub(super) fn new(
        triangles: &'a [(u32, [[f64; 3]; 3])],
        options: &SurfaceOptions,
    ) -> Option<Self> {
        let (mut sum, mut last) = (0.0, None);
        let mut areas = Vec::with_capacity(triangles.len());
        for (place, (_, corners)) in triangles.iter().enumerate() {
            let n = normal(corners);
            let area = n[0].hypot(n[1]).hypot(n[2]);
            if sum + area > sum {
                last = Some(place);
            }
            sum += area;
            areas.push(sum);
        }
        last.map(|last| Self { triangles, areas, last, options: *options })
    }

    /// Sample i: its triangle, and where it is.
    pub(super) fn sample(&self, i: usize) -> (usize, [f64; 3]) {
        let number =
            |k: u64| uniform(self.options.seed, (i as u64).wrapping_mul(3).wrapping_add(k));
        let part = (i as f64 + number(0)) / self.options.samples as f64;
        let place = part * self.areas[self.last];
        let triangle = self.areas.partition_point(|&area| area <= place).min(self.last);
        let [a, b, c] = self.triangles[triangle].1;
        let (mut u, mut v) = (number(1), number(2));
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        (triangle, std::array::from_fn(|k| a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k])))
    }
}

/// The k-th number of the seed, evenly from [0, 1).
fn uniform(seed: u64, k: u64) -> f64 {
    const STEP: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut z = seed.wrapping_add(k.wrapping_add(1).wrapping_mul(STEP));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 * (0.5 / (1u64 << 52) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first numbers of the seed 1234567, as its authors give them.
    #[test]
    fn numbers_are_those_of_the_generator() {
        let first = [6457827717110365317u64, 3203168211198807973, 9817491932198370423];
        for (k, bits) in (0..).zip(first) {
            assert_eq!(uniform(1_234_567, k), (bits >> 11) as f64 / (1u64 << 53) as f64);
        }
    }

    #[test]
    fn each_triangle_gets_its_share() {
        // Areas of 1, none, 3, 5 and none, in halves.
        let shapes = [([1.0, 0.0], [0.0, 1.0]), ([1.0, 1.0], [2.0, 2.0]), ([3.0, 0.0], [7.0, 1.0])];
        let more = [([0.0, 5.0], [1.0, 9.0]), ([0.0, 0.0], [0.0, 0.0])];
        let triangles: Vec<_> = (0..)
            .zip(shapes.iter().chain(&more))
            .map(|(k, (b, c))| (k, [[0.0; 3], [b[0], b[1], 0.0], [c[0], c[1], 0.0]]))
            .collect();
        let options = SurfaceOptions { samples: 9000, seed: 7 };
        let sampler = Sampler::new(&triangles, &options).unwrap();
        let (mut counts, mut sums) = ([0; 5], [[0.0; 2]; 5]);
        for i in 0..options.samples {
            let (triangle, p) = sampler.sample(i);
            counts[triangle] += 1;
            sums[triangle][0] += p[0];
            sums[triangle][1] += p[1];
        }
        assert_eq!(counts, [1000, 0, 3000, 5000, 0]);
        // Centers of mass: of 1000 independent points within 10 they are off by 10/√12/√1000 = 0.09; four times that.
        for k in [0, 2, 3] {
            let [_, b, c] = triangles[k].1;
            for x in 0..2 {
                assert!((sums[k][x] / f64::from(counts[k]) - (b[x] + c[x]) / 3.0).abs() < 0.36);
            }
        }
        assert!(Sampler::new(&triangles[1..2], &options).is_none());
        assert!(Sampler::new(&[], &options).is_none());
    }
}
