//! Local feature size by maximal empty tangent balls.
//!
//! *Problem.* For points of smooth curves: how far each is from the medial axis, the closure of the centers of all disks that are
//! empty of the curves and touch them twice.
//! *Idea.* On each side of a point p with unit normal n the largest empty disk that touches in p has radius
//! r = min |p − q|² / 2n·(q − p) over the points q before it, and its center is on the medial axis. Disks of neighboring points
//! are much alike: the q of the last gives an r to begin with, and runs of points outside the disk of radius r are passed over
//! whole. At the end of an arc, disks of all directions that lie beyond it are taken.
//! *Guarantee.* Radii are exact for the sample; f is too large by at most the gap to the next center.
//! *Trap.* Normals must be exact: the radius of a disk that touches in p and next to it is as sensitive to the normal as to the
//! curvature.

use crate::parallel::ParallelSlice;

use super::fourier::Piece;

/// A run has this many points.
const RUN_POINTS: usize = 32;
/// Disks in a row that one thread takes.
const CHUNK: usize = 512;
/// Disks at an end have this many directions, over a half turn.
const DISK_DIRECTIONS: usize = 512;

/// Points, in runs of neighbors with a disk around each.
struct Runs {
    points: Vec<[f64; 2]>,
    disks: Vec<([f64; 2], f64)>,
}

impl Runs {
    fn new(points: Vec<[f64; 2]>) -> Self {
        let disks = points.chunks(RUN_POINTS).map(|run| {
            let [mut low, mut high] = [run[0]; 2];
            for p in run {
                low = [low[0].min(p[0]), low[1].min(p[1])];
                high = [high[0].max(p[0]), high[1].max(p[1])];
            }
            let center = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
            (center, run.iter().map(|&p| distance(p, center)).fold(0.0, f64::max))
        });
        Self { disks: disks.collect(), points }
    }

    /// The points that a disk around `center` of the radius that `radius` tells may hold; it may shrink on the way.
    fn scan<S>(
        &self,
        state: &mut S,
        disk: impl Fn(&S) -> ([f64; 2], f64),
        mut see: impl FnMut(&mut S, u32),
    ) {
        for (run, &(middle, around)) in self.disks.iter().enumerate() {
            let (center, radius) = disk(state);
            let reach = radius + around;
            let (x, y) = (middle[0] - center[0], middle[1] - center[1]);
            if x * x + y * y < reach * reach {
                let first = run * RUN_POINTS;
                for q in first..(first + RUN_POINTS).min(self.points.len()) {
                    see(state, q as u32);
                }
            }
        }
    }

    /// The center of the largest disk that touches p, lies on the side of n and holds no point, unless it has no bound; `touched` is
    /// a first guess of the point that stops it, and becomes that point.
    fn largest_disk(&self, p: [f64; 2], n: [f64; 2], touched: &mut u32) -> Option<[f64; 2]> {
        let radius = |q: u32| {
            let q = self.points[q as usize];
            let d = [q[0] - p[0], q[1] - p[1]];
            let ahead = 2.0 * (d[0] * n[0] + d[1] * n[1]);
            if ahead > 0.0 { (d[0] * d[0] + d[1] * d[1]) / ahead } else { f64::INFINITY }
        };
        let mut state = (radius(*touched), *touched);
        // A disk without bound is a half plane; one of a great radius is scanned as such.
        self.scan(
            &mut state,
            |&(r, _)| {
                let r = r.min(1e9);
                ([p[0] + r * n[0], p[1] + r * n[1]], r * (1.0 + 1e-12))
            },
            |state, q| {
                let r = radius(q);
                if r < state.0 {
                    *state = (r, q);
                }
            },
        );
        let (r, q) = state;
        *touched = q;
        (r < 1e9).then(|| [p[0] + r * n[0], p[1] + r * n[1]])
    }

    /// Distance to the nearest of the points; `near` as above.
    fn nearest(&self, x: [f64; 2], near: &mut u32) -> f64 {
        let mut state = (distance(x, self.points[*near as usize]), *near);
        self.scan(
            &mut state,
            |&(r, _)| (x, r),
            |state, q| {
                let r = distance(x, self.points[q as usize]);
                if r < state.0 {
                    *state = (r, q);
                }
            },
        );
        *near = state.1;
        state.0
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let (x, y) = (a[0] - b[0], a[1] - b[1]);
    (x * x + y * y).sqrt()
}

/// The local feature size at each point of the curves.
pub(super) fn features_of(
    pieces: &[Piece],
    curves: &[Vec<[f64; 2]>],
    parameters: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let samples = Runs::new(curves.concat());
    let mut disks: Vec<([f64; 2], [f64; 2])> = Vec::new();
    for ((piece, points), parameters) in pieces.iter().zip(curves).zip(parameters) {
        for side in [1.0, -1.0] {
            disks.extend(
                points
                    .iter()
                    .zip(parameters)
                    .map(|(&p, &t)| (p, piece.normal(t).map(|v| side * v))),
            );
        }
        if !piece.closed {
            let last = points.len() - 1;
            // Outward along the curve at each end.
            for (end, turn) in [(0, 1.0), (last, -1.0)] {
                let n = piece.normal(parameters[end]);
                disks.extend((0..=DISK_DIRECTIONS).map(|k| {
                    let (sin, cos) =
                        (std::f64::consts::PI * (k as f64 / DISK_DIRECTIONS as f64)).sin_cos();
                    let out = [-turn * n[1] * sin, turn * n[0] * sin];
                    (points[end], [n[0] * cos + out[0], n[1] * cos + out[1]])
                }));
            }
        }
    }
    let centers: Vec<[f64; 2]> = disks
        .par_chunks(CHUNK)
        .flat_map_iter(|chunk| {
            let mut touched = 0;
            chunk
                .iter()
                .filter_map(|&(p, n)| samples.largest_disk(p, n, &mut touched))
                .collect::<Vec<_>>()
        })
        .collect();
    let axis = Runs::new(centers);
    let features = curves.iter().map(|points| {
        let chunks = points.par_chunks(CHUNK).flat_map_iter(|chunk| {
            let mut near = 0;
            chunk.iter().map(|&x| axis.nearest(x, &mut near)).collect::<Vec<_>>()
        });
        chunks.collect()
    });
    features.collect()
}
