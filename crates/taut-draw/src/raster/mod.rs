//! Opaque triangles by a depth buffer: for each sample of a grid the nearest triangle, its shade and its side.
//!
//! *Idea.* Corners are snapped to 1/256 of a sample; whether a sample is in a triangle is then a question of whole numbers. A
//! sample on an edge belongs to the triangle below or to the right of it, so that triangles with a common edge leave no crack and
//! no sample is counted twice. Nearness is a quantity that is affine on the sheet, so it is interpolated as it is.
//! *Guarantee.* The same samples on every machine: whole numbers, and sums, products and quotients of `f64` in a fixed order.
//! Of two triangles equally near the first one given stays.

use std::ops::Range;

use taut_points::parallel::ParallelSlice;

mod image;
mod normals;
mod order;
mod png;

pub(crate) use image::{Image, Ramp, ramp};
pub(crate) use normals::normals;
pub(crate) use order::order;
pub(crate) use png::png;

/// Rows are filled in this many bands, more than most machines have processors. The samples do not depend on it.
const BANDS: usize = 16;

/// Corners are snapped to this many parts of a sample.
pub(crate) const SNAP_PARTS: i64 = 256;

/// A corner on the grid, in parts of a sample.
pub(crate) type Snapped = [i64; 2];

/// The grid of samples, rows from the top.
pub(crate) struct Raster {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// The nearness of the nearest triangle, above 0; 0 where there is none.
    near: Vec<f32>,
    /// The lightness there, 0 to 255.
    light: Vec<u8>,
    /// The number of its colors.
    ink: Vec<u8>,
    owner: Vec<u32>,
}

/// A triangle on the grid.
pub(crate) struct Facet {
    pub(crate) corners: [Snapped; 3],
    /// The nearness of each corner, above 0.
    pub(crate) near: [f64; 3],
    /// The lightness of each corner, 0 to 1.
    pub(crate) light: [f64; 3],
    pub(crate) ink: u8,
    pub(crate) owner: u32,
}

/// The corner nearest to a place in samples.
pub(crate) fn snap(at: [f64; 2]) -> Snapped {
    at.map(|x| (x.clamp(-1e6, 1e6) * SNAP_PARTS as f64).round() as i64)
}

/// Twice the area, positive where the corners run counter-clockwise to the eye. (Rows run downwards.)
pub(crate) fn area(corners: &[Snapped; 3]) -> i64 {
    -edge(corners[0], corners[1], corners[2])
}

/// Twice the area of a, b, p; positive where they run clockwise to the eye.
fn edge(a: Snapped, b: Snapped, p: Snapped) -> i64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

impl Raster {
    pub(crate) fn new(width: usize, height: usize) -> Self {
        let samples = width * height;
        Raster {
            width,
            height,
            near: vec![0.0; samples],
            light: vec![0; samples],
            ink: vec![0; samples],
            owner: vec![0; samples],
        }
    }

    /// Draws triangles, each where it is nearer than what is there. The rows are filled in bands, on all threads of the pool.
    pub(crate) fn fill(&mut self, facets: &[Facet]) {
        let width = self.width;
        // One thread reads the triangles once.
        let bands = if rayon::current_num_threads() == 1 { 1 } else { BANDS };
        let rows = self.height.div_ceil(bands).max(1);
        let size = (rows * width).max(1);
        let bands = self.near.par_chunks_mut(size).zip(self.light.par_chunks_mut(size));
        let marks = self.ink.par_chunks_mut(size).zip(self.owner.par_chunks_mut(size));
        bands.zip(marks).enumerate().for_each(|(band, ((nears, lights), (inks, owners)))| {
            let top = band * rows;
            for facet in facets {
                scan(facet, width, top..top + nears.len() / width, |x, y, near, light| {
                    let sample = (y - top) * width + x;
                    if near > nears[sample] {
                        nears[sample] = near;
                        // Rounded; a call of `round` for each sample took 6 % of drawing a sphere.
                        lights[sample] = (light().clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
                        inks[sample] = facet.ink;
                        owners[sample] = facet.owner;
                    }
                });
            }
        });
    }

    /// Which of the owners below `count` are seen in some sample.
    pub(crate) fn seen(&self, count: usize) -> Vec<bool> {
        let mut seen = vec![false; count];
        for (&owner, _) in self.owner.iter().zip(&self.near).filter(|&(_, &near)| near > 0.0) {
            seen[owner as usize] = true;
        }
        seen
    }

    /// The owners whose triangles are not the nearest at some sample that they cover, each with the owner of the one that is. Those
    /// that are less than `difference` behind do not count.
    pub(crate) fn behind(&self, facets: &[Facet], difference: f32) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        for facet in facets {
            let mut last = facet.owner;
            scan(facet, self.width, 0..self.height, |x, y, near, _| {
                let sample = y * self.width + x;
                let nearest = self.owner[sample];
                // Neighboring samples mostly say the same.
                if nearest != last && self.near[sample] > near + difference {
                    last = nearest;
                    pairs.push([facet.owner, nearest]);
                }
            });
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Tests whether all samples within `reach` of a place, in samples, are nearer than it is, by more than `difference`.
    pub(crate) fn hides(&self, at: [f64; 2], near: f64, reach: i64, difference: f64) -> bool {
        let [x, y] = at.map(|v| v.clamp(-1e6, 1e6).floor() as i64);
        let hidden = |x: i64, y: i64| {
            (0..self.width as i64).contains(&x)
                && (0..self.height as i64).contains(&y)
                && f64::from(self.near[y as usize * self.width + x as usize]) > near + difference
        };
        (y - reach..=y + reach).all(|y| (x - reach..=x + reach).all(|x| hidden(x, y)))
    }
}

/// Calls `each` for all samples of a triangle in some rows of a grid: with column, row, nearness there, and what calculates its light,
/// which samples behind others do not need.
fn scan(
    facet: &Facet,
    width: usize,
    rows: Range<usize>,
    mut each: impl FnMut(usize, usize, f32, &dyn Fn() -> f64),
) {
    let Facet { corners, near, light, .. } = facet;
    let bounds = |k: usize, size: Range<usize>| {
        let low = corners[0][k].min(corners[1][k]).min(corners[2][k]);
        let high = corners[0][k].max(corners[1][k]).max(corners[2][k]);
        // Samples are at the middles: x·SNAP_PARTS + SNAP_PARTS/2.
        let first = (low - SNAP_PARTS / 2).div_euclid(SNAP_PARTS).max(size.start as i64);
        let last = (high - SNAP_PARTS / 2).div_euclid(SNAP_PARTS).min(size.end as i64 - 1);
        first..last + 1
    };
    let rows = bounds(1, rows);
    if rows.is_empty() {
        return;
    }
    let columns = bounds(0, 0..width);
    // The order in which all three edges have the inside at their positive side.
    let order = if area(corners) < 0 { [0, 1, 2] } else { [0, 2, 1] };
    let [a, b, c] = order.map(|k| corners[k]);
    let whole = edge(a, b, c);
    if whole == 0 {
        return;
    }
    let sides = [(b, c), (c, a), (a, b)];
    // Edges at the top and at the left belong to the triangle, the others do not.
    let owned = sides.map(|(p, q)| i64::from(!(q[1] < p[1] || (q[1] == p[1] && q[0] > p[0]))));
    let steps = sides.map(|(p, q)| -(q[1] - p[1]) * SNAP_PARTS);
    let scale = 1.0 / whole as f64;
    for y in rows {
        let start = [columns.start * SNAP_PARTS + SNAP_PARTS / 2, y * SNAP_PARTS + SNAP_PARTS / 2];
        let mut inside = sides.map(|(p, q)| edge(p, q, start));
        let mut is_entered = false;
        for x in columns.clone() {
            if inside[0] >= owned[0] && inside[1] >= owned[1] && inside[2] >= owned[2] {
                is_entered = true;
                let weights = inside.map(|e| e as f64 * scale);
                let mix = |values: &[f64; 3]| {
                    weights[0] * values[order[0]]
                        + weights[1] * values[order[1]]
                        + weights[2] * values[order[2]]
                };
                each(x as usize, y as usize, mix(near) as f32, &|| mix(light));
            } else if is_entered {
                // A row is in a triangle from one sample to another.
                break;
            }
            for k in 0..3 {
                inside[k] += steps[k];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facet(corners: [[f64; 2]; 3], near: [f64; 3], owner: u32) -> Facet {
        Facet { corners: corners.map(snap), near, light: [1.0; 3], ink: 0, owner }
    }

    fn owners(raster: &Raster) -> Vec<i64> {
        let of = |i: usize| if raster.near[i] > 0.0 { i64::from(raster.owner[i]) } else { -1 };
        (0..raster.near.len()).map(of).collect()
    }

    #[test]
    fn triangles_around_a_vertex_share_out_all_samples() {
        // A fan around a sample's middle: each sample of the square once, none on a seam left out or counted twice.
        let rim = [[0.0, 0.0], [4.5, 0.0], [9.0, 0.0], [9.0, 9.0], [4.5, 9.0], [0.0, 9.0]];
        for turned in [false, true] {
            let mut raster = Raster::new(9, 9);
            let mut count = 0;
            for i in 0..rim.len() {
                let mut corners = [[4.5, 4.5], rim[i], rim[(i + 1) % rim.len()]];
                if turned {
                    corners.swap(1, 2);
                }
                scan(&facet(corners, [1.0; 3], 0), 9, 0..9, |x, y, near, _| {
                    raster.near[9 * y + x] = near;
                    count += 1;
                });
            }
            assert!(raster.near.iter().all(|&near| near > 0.0));
            assert_eq!(count, 81);
        }
    }

    #[test]
    fn the_nearer_one_is_seen_whatever_comes_first() {
        let low = facet([[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]], [1.0; 3], 1);
        let high = facet([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]], [2.0; 3], 2);
        let [mut one, mut other] = [0, 1].map(|_| Raster::new(8, 8));
        let both = [low, high];
        one.fill(&both);
        other.fill(&both[1..]);
        other.fill(&both[..1]);
        assert_eq!(owners(&one), owners(&other));
        let seen = |who: i64| owners(&one).into_iter().filter(|&o| o == who).count();
        assert_eq!([seen(2), seen(1) + seen(2)], [6, 28]);
        assert_eq!(one.behind(&both, 1e-6), [[1, 2]]);
        assert_eq!(one.seen(4), [false, true, true, false]);
    }

    #[test]
    fn triangles_that_pierce_each_other_meet_in_a_line() {
        let level = facet([[0.0, 0.0], [16.0, 0.0], [0.0, 16.0]], [1.5; 3], 1);
        let slope = facet([[0.0, 0.0], [16.0, 0.0], [0.0, 16.0]], [2.0, 1.0, 2.0], 2);
        let mut raster = Raster::new(16, 16);
        let both = [level, slope];
        raster.fill(&both);
        assert_eq!(raster.behind(&both, 1e-6), [[1, 2], [2, 1]]);
        for (i, owner) in owners(&raster).into_iter().enumerate() {
            let (x, y) = (i % 16, i / 16);
            let nearest = if x >= 8 { 1 } else { 2 };
            let wanted = if x + y >= 15 { -1 } else { nearest };
            assert_eq!(owner, wanted, "{x} {y}");
        }
    }

    #[test]
    fn bands_are_filled_as_one_whole_is() {
        // Heights below and above the number of bands, and not multiples of it.
        for (width, height) in [(7, 5), (33, 50), (20, 160)] {
            let mut place = 1_u32;
            let mut next = |size: usize| {
                place = place.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(place >> 8) / f64::from(1 << 24) * size as f64 * 1.4 - size as f64 * 0.2
            };
            let facets: Vec<Facet> = (0..60)
                .map(|owner| {
                    let corners = [(); 3].map(|()| [next(width), next(height)]);
                    facet(corners, [(); 3].map(|()| 1.5 + next(1)), owner)
                })
                .collect();
            let mut raster = Raster::new(width, height);
            raster.fill(&facets);
            let mut whole = Raster::new(width, height);
            for facet in &facets {
                scan(facet, width, 0..height, |x, y, near, _| {
                    let sample = y * width + x;
                    if near > whole.near[sample] {
                        (whole.near[sample], whole.owner[sample]) = (near, facet.owner);
                    }
                });
            }
            assert_eq!((&raster.near, owners(&raster)), (&whole.near, owners(&whole)));
            assert!(raster.near.iter().filter(|&&near| near > 0.0).count() > width * height / 2);
        }
    }

    #[test]
    fn triangles_without_area_or_out_of_sight_show_nothing() {
        let mut raster = Raster::new(4, 4);
        for corners in [
            [[1.0, 1.0], [1.0, 1.0], [1.0, 1.0]],
            [[0.0, 0.0], [2.0, 2.0], [4.0, 4.0]],
            [[10.0, 0.0], [20.0, 0.0], [10.0, 9.0]],
            [[-1e300, 0.0], [-9.0, f64::NAN], [-5.0, 1e300]],
        ] {
            raster.fill(&[facet(corners, [1.0; 3], 0)]);
        }
        assert!(owners(&raster).into_iter().all(|owner| owner == -1));
    }

    #[test]
    fn a_place_is_hidden_behind_and_seen_before_and_beside() {
        let mut raster = Raster::new(8, 8);
        raster.fill(&[facet([[0.0, 0.0], [16.0, 0.0], [0.0, 16.0]], [1.0; 3], 0)]);
        assert!(raster.hides([3.0, 3.0], 0.5, 1, 1e-3));
        assert!(!raster.hides([3.0, 3.0], 1.0, 1, 1e-3));
        assert!(!raster.hides([9.0, 3.0], 0.5, 1, 1e-3));
    }
}
