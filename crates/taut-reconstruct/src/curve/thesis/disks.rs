//! The samples in disks that grow around a sample.
//!
//! *Problem.* A disk is grown until its samples are flat, and nobody knows how far that is.
//! *Idea.* Samples are fetched from the tree of boxes with twice the radius whenever those at hand do not suffice, and sorted by
//! distance: k samples cost O(k log k) however often the disk is grown.
//! *Guarantee.* Coordinates are relative to the sample; the order is by distance, then by coordinates.

use crate::curve::boxes::{Bounds, Boxes};

/// A sample near another one: its squared distance and its place relative to it.
pub(super) type Sample = (f64, [f64; 2]);

/// The samples with the tree over them.
pub(super) struct Disks<'a> {
    pub(super) samples: &'a [[f64; 2]],
    boxes: Boxes,
}

impl<'a> Disks<'a> {
    /// Over samples in Hilbert order, or nearly.
    pub(super) fn over(samples: &'a [[f64; 2]]) -> Self {
        Self { samples, boxes: Boxes::over(samples.len(), |i| Bounds::of(samples[i])) }
    }

    /// The radius of the smallest disk around a sample that contains `count` samples, itself included, or all there are.
    pub(super) fn radius(&self, sample: usize, count: usize) -> f64 {
        let center = self.samples[sample];
        let mut nearest: Vec<f64> = Vec::with_capacity(count + 1);
        self.boxes.nearest(
            f64::INFINITY,
            |b| b.distance2(center),
            |leaf, _| {
                for i in self.boxes.leaf(leaf) {
                    let (distance2, _) = relative(center, self.samples[i]);
                    if nearest.len() < count || nearest.last().is_some_and(|&d| distance2 < d) {
                        nearest.truncate(count - 1);
                        let place = nearest.partition_point(|&d| d <= distance2);
                        nearest.insert(place, distance2);
                    }
                }
                if nearest.len() < count { f64::INFINITY } else { nearest[count - 1] }
            },
        );
        nearest.last().map_or(0.0, |d| d.sqrt())
    }

    /// Visits the numbers of the samples within a distance of a point.
    pub(super) fn within(&self, center: [f64; 2], radius: f64, mut visit: impl FnMut(usize)) {
        let most = radius * radius;
        self.boxes.nearest(
            most,
            |b| b.distance2(center),
            |leaf, bound| {
                for i in self.boxes.leaf(leaf) {
                    if relative(center, self.samples[i]).0 <= most {
                        visit(i);
                    }
                }
                bound
            },
        );
    }
}

fn relative(center: [f64; 2], [x, y]: [f64; 2]) -> Sample {
    let (dx, dy) = (x - center[0], y - center[1]);
    (dx * dx + dy * dy, [dx, dy])
}

/// A disk that grows around one sample.
pub(super) struct Growing<'a> {
    disks: &'a Disks<'a>,
    center: [f64; 2],
    /// All samples within this distance are at hand.
    fetched: f64,
    near: Vec<Sample>,
}

impl<'a> Growing<'a> {
    pub(super) fn around(disks: &'a Disks<'a>, sample: usize) -> Self {
        Self { disks, center: disks.samples[sample], fetched: -1.0, near: Vec::new() }
    }

    /// The samples within a distance; what a smaller distance gave, or would give, comes first.
    pub(super) fn within(&mut self, radius: f64) -> &[Sample] {
        if radius > self.fetched {
            self.fetched = if self.fetched < 0.0 { radius } else { radius.max(2.0 * self.fetched) };
            let Self { disks, center, near, .. } = self;
            near.clear();
            disks.within(*center, self.fetched, |i| near.push(relative(*center, disks.samples[i])));
            if self.fetched > radius {
                near.sort_unstable_by(|a, b| {
                    let places = a.1[0].total_cmp(&b.1[0]).then(a.1[1].total_cmp(&b.1[1]));
                    a.0.total_cmp(&b.0).then(places)
                });
            }
        }
        if radius == self.fetched {
            return &self.near;
        }
        &self.near[..self.near.partition_point(|sample| sample.0 <= radius * radius)]
    }
}
