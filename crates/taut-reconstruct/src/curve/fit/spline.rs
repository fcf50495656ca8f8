//! A curve as it is known so far, and the points in the order in which they lie along it.
//!
//! *Idea.* Between two nodes the curve is the cubic that leaves and arrives along their tangents. Each point goes to the nearest
//! place on a fine polyline of it, and from then on all neighborhoods are ranges of a sorted list.
//! *Guarantee.* O(n log n); a function of the nodes and the points that turns and scales with them.

use rayon::prelude::*;
use taut_oblivious::hilbert_order;

use super::link::Chain;
use super::parameters::{DEVIATION_MIN, NOISE_SEEDS, PIECES_PER_NODE, POINTS_PER_RUN};
use super::seeds::Seed;
use crate::curve::index::{Index, Nearest};

type Point = [f64; 2];

/// A place on the curve with its tangent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// The place.
    pub(super) at: Point,
    /// The unit tangent, along the curve; at a corner, that with which the curve arrives.
    pub(super) tangent: Point,
    /// The unit tangent with which the curve leaves: the same but at a corner.
    pub(super) leaving: Point,
    /// How far around it points are to be looked at first.
    pub(super) reach: f64,
    /// Standard deviation of the noise there.
    pub(super) deviation: f64,
    /// Standard error of the place.
    pub(super) error: f64,
}

/// One connected curve.
#[derive(Clone, Debug, Default)]
pub(super) struct Spline {
    /// Its nodes in order.
    pub(super) nodes: Vec<Node>,
    /// Whether the first follows the last.
    pub(super) closed: bool,
    /// The length along the curve at each node, and for a closed one, at the end, its whole length.
    pub(super) arc: Vec<f64>,
    /// The points by their place along the curve, ascending.
    pub(super) members: Vec<Member>,
}

/// A point and its place along a spline.
#[derive(Clone, Copy, Debug)]
pub(super) struct Member {
    /// Length along the curve from its first node.
    pub(super) arc: f64,
    /// The point.
    pub(super) at: Point,
    /// Its number.
    pub(super) site: u32,
    /// Its distance from the curve, in standard deviations of the noise there.
    pub(super) share: f64,
}

/// The cubic from a to b at t ∈ [0, 1], and its derivative, for tangents as long as the chord.
pub(super) fn hermite(a: &Node, b: &Node, t: f64) -> (Point, Point) {
    let chord = (b.at[0] - a.at[0]).hypot(b.at[1] - a.at[1]);
    let (t2, t3) = (t * t, t * t * t);
    let (p, q) = (2.0 * t3 - 3.0 * t2 + 1.0, -2.0 * t3 + 3.0 * t2);
    let (r, s) = (t3 - 2.0 * t2 + t, t3 - t2);
    let (dp, dr, ds) = (6.0 * t2 - 6.0 * t, 3.0 * t2 - 4.0 * t + 1.0, 3.0 * t2 - 2.0 * t);
    let place =
        |i: usize| p * a.at[i] + q * b.at[i] + chord * (r * a.leaving[i] + s * b.tangent[i]);
    let slope =
        |i: usize| dp * (a.at[i] - b.at[i]) + chord * (dr * a.leaving[i] + ds * b.tangent[i]);
    ([place(0), place(1)], [slope(0), slope(1)])
}

impl Spline {
    /// A spline through the seeds of a chain, without points.
    pub(super) fn through(chain: Chain) -> Self {
        let node = |s: &Seed| Node {
            at: s.at,
            tangent: s.tangent,
            leaving: s.tangent,
            reach: s.reach,
            deviation: s.deviation,
            error: s.deviation,
        };
        Self::new(chain.seeds.iter().map(node).collect(), chain.closed, NOISE_SEEDS)
    }

    /// A spline through nodes, without points. The noise at each is the median of what so many nodes on either side say: an outlier
    /// in a window makes it look wide, and points in a row by chance narrow, and either would decide what the next window holds.
    pub(super) fn new(mut nodes: Vec<Node>, closed: bool, span: usize) -> Self {
        let deviations = medians(&nodes, closed, span);
        for (node, deviation) in nodes.iter_mut().zip(deviations) {
            node.deviation = deviation.max(DEVIATION_MIN * node.reach);
        }
        let mut spline = Self { nodes, closed, arc: vec![0.0], members: Vec::new() };
        let mut sum = 0.0;
        for edge in 0..spline.edges() {
            let places: Vec<Point> = (0..=PIECES_PER_NODE).map(|k| spline.piece(edge, k)).collect();
            sum += places
                .windows(2)
                .map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]))
                .sum::<f64>();
            spline.arc.push(sum);
        }
        spline
    }

    /// Edges between nodes.
    pub(super) fn edges(&self) -> usize {
        self.nodes.len() - usize::from(!self.closed)
    }

    /// Nodes that are corners.
    pub(super) fn corners(&self) -> usize {
        self.nodes.iter().filter(|node| node.tangent != node.leaving).count()
    }

    /// The whole length.
    pub(super) fn length(&self) -> f64 {
        self.arc[self.arc.len() - 1]
    }

    /// The nodes at both ends of an edge.
    pub(super) fn edge(&self, edge: usize) -> (&Node, &Node) {
        (&self.nodes[edge], &self.nodes[(edge + 1) % self.nodes.len()])
    }

    /// The place at some length along the curve, within it, and the direction there.
    pub(super) fn place(&self, arc: f64) -> (Point, Point) {
        let edge = self.arc.partition_point(|&a| a <= arc).clamp(1, self.edges()) - 1;
        let (a, b) = self.edge(edge);
        let span = self.arc[edge + 1] - self.arc[edge];
        hermite(a, b, if span > 0.0 { (arc - self.arc[edge]) / span } else { 0.0 })
    }

    fn piece(&self, edge: usize, k: usize) -> Point {
        let (a, b) = self.edge(edge);
        hermite(a, b, k as f64 / PIECES_PER_NODE as f64).0
    }
}

/// The medians of deviations over each node and so many on either side.
fn medians(nodes: &[Node], closed: bool, span: usize) -> Vec<f64> {
    let count = nodes.len();
    let median = |i: usize| {
        let at = |k: usize| match closed {
            true => (i + count + k - span.min(count)) % count,
            false => (i + k).saturating_sub(span).min(count - 1),
        };
        let mut values: Vec<f64> = (0..=2 * span).map(|k| nodes[at(k)].deviation).collect();
        values.sort_unstable_by(f64::total_cmp);
        values[span]
    };
    (0..count).map(median).collect()
}

/// A vertex of the fine polylines of all splines.
struct Vertex {
    spline: u32,
    /// Number of the vertex in its polyline.
    number: u32,
}

/// Gives each point that is near enough to its spline; the others are named, ascending.
///
/// Near is within `width` standard deviations of the noise at the node next to it.
pub(super) fn assign(splines: &mut [Spline], points: &[Point], width: f64) -> Vec<u32> {
    // The polylines, with the length along the curve at each vertex.
    let lines: Vec<Vec<(Point, f64)>> = splines.par_iter().map(polyline).collect();
    let vertices: Vec<Vertex> = lines
        .iter()
        .enumerate()
        .flat_map(|(s, line)| {
            (0..line.len()).map(move |k| Vertex { spline: s as u32, number: k as u32 })
        })
        .collect();
    let at = |v: &Vertex| lines[v.spline as usize][v.number as usize].0;
    let order = hilbert_order(vertices.len(), |i| at(&vertices[i]));
    let places: Vec<Point> = order.iter().map(|&i| at(&vertices[i as usize])).collect();
    let index = Index::new(&places);
    let shared: &[Spline] = splines;
    let place_of = |p: Point, nearest: u32| {
        let vertex = &vertices[order[nearest as usize] as usize];
        let spline = &shared[vertex.spline as usize];
        let (distance, arc) =
            project(spline, &lines[vertex.spline as usize], vertex.number as usize, p);
        let node =
            &spline.nodes[(vertex.number as usize).div_ceil(PIECES_PER_NODE) % spline.nodes.len()];
        (distance <= width * node.deviation)
            .then(|| (vertex.spline, arc, distance / node.deviation.max(f64::MIN_POSITIVE)))
    };
    // Points come in the order of a Hilbert curve: a run of them is in one place, as a rule.
    let mut found: Vec<Option<(u32, f64, f64)>> = vec![None; points.len()];
    points
        .par_chunks(POINTS_PER_RUN)
        .zip(found.par_chunks_mut(POINTS_PER_RUN))
        .with_min_len(1 << 6)
        .for_each_init(Nearest::default, |nearest, (points, found)| {
            index.nearest_to_each(points, nearest, |k, at| found[k] = place_of(points[k], at));
        });
    let mut members: Vec<Vec<Member>> = vec![Vec::new(); splines.len()];
    let mut left = Vec::new();
    for (site, (&at, found)) in points.iter().zip(&found).enumerate() {
        match found {
            &Some((spline, arc, share)) => {
                members[spline as usize].push(Member { arc, at, site: site as u32, share });
            }
            None => left.push(site as u32),
        }
    }
    for (spline, mut members) in splines.iter_mut().zip(members) {
        members.par_sort_unstable_by(|a, b| a.arc.total_cmp(&b.arc).then(a.site.cmp(&b.site)));
        spline.members = members;
    }
    left
}

fn polyline(spline: &Spline) -> Vec<(Point, f64)> {
    let mut line: Vec<(Point, f64)> = Vec::with_capacity(spline.edges() * PIECES_PER_NODE + 1);
    for edge in 0..spline.edges() {
        let mut arc = spline.arc[edge];
        for k in 0..PIECES_PER_NODE {
            let at = spline.piece(edge, k);
            if let Some(&(last, before)) = line.last().filter(|_| k > 0) {
                arc = before + (at[0] - last[0]).hypot(at[1] - last[1]);
            }
            line.push((at, arc));
        }
    }
    if !spline.closed {
        line.push((spline.nodes[spline.nodes.len() - 1].at, spline.length()));
    }
    line
}

/// The distance of a point from the two pieces at a vertex, and its place along the curve. Beyond the ends of an open
/// spline the last pieces go on.
fn project(spline: &Spline, line: &[(Point, f64)], vertex: usize, p: Point) -> (f64, f64) {
    let mut best = (f64::INFINITY, [f64::INFINITY; 2], 0.0);
    let count = line.len();
    for first in [vertex.wrapping_sub(1), vertex] {
        let first = match first {
            usize::MAX if spline.closed => count - 1,
            usize::MAX => continue,
            last if last + 1 == count && !spline.closed => continue,
            first => first,
        };
        let ((a, start), (b, end)) = (line[first], line[(first + 1) % count]);
        let end = if first + 1 == count { spline.length() } else { end };
        let (ex, ey) = (b[0] - a[0], b[1] - a[1]);
        let share =
            ((p[0] - a[0]) * ex + (p[1] - a[1]) * ey) / (ex * ex + ey * ey).max(f64::MIN_POSITIVE);
        let least = if !spline.closed && first == 0 { -4.0 } else { 0.0 };
        let most = if !spline.closed && first + 2 == count { 5.0 } else { 1.0 };
        let t = share.clamp(least, most);
        let [x, y] = [p[0] - a[0] - t * ex, p[1] - a[1] - t * ey];
        if x * x + y * y < best.0 {
            best = (x * x + y * y, [x, y], start + t * (end - start));
        }
    }
    let (_, [x, y], arc) = best;
    (x.hypot(y), arc)
}
