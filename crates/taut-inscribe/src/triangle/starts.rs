//! Triangles from which ascents start.

use taut_points::OrderBy;

use super::ascent::Candidate;
use super::frame::Frame;
use super::gauge::{Gauge, Triangle, doubled_area, scaled};
use super::groups::Groups;
use crate::inner_points::inner_points;

/// Starts of ascents before the search, the largest first.
const STARTS_MAX: usize = 12;

/// Positions of an equilateral triangle, evenly over a third of a turn.
const TURNS_TRIED: usize = 4;

/// The largest equilateral triangles around inner points.
pub(super) fn starts(frame: &Frame, edges: &Groups) -> Vec<Candidate> {
    let mut best: Vec<(f64, Triangle)> = vec![];
    for center in inner_points(&frame.edges, frame.extent) {
        let mut largest: Option<(f64, Triangle)> = None;
        for turn in 0..TURNS_TRIED {
            let triangle = [0, 1, 2].map(|corner| {
                let share = corner as f64 + turn as f64 / TURNS_TRIED as f64;
                let (sine, cosine) = (std::f64::consts::TAU * share / 3.0).sin_cos();
                [center[0] + cosine, center[1] + sine]
            });
            let least = largest.as_ref().map_or(0.0, |found| found.0);
            let gauge = Gauge::of(&triangle);
            let scale = edges.least_scale(&gauge, f64::INFINITY);
            if scale > least && scale.is_finite() {
                largest = Some((scale, triangle));
            }
        }
        if let Some(found) = largest {
            best.push(found);
            best.order_by(&|one, other| other.0.total_cmp(&one.0));
            best.truncate(STARTS_MAX);
        }
    }
    let of = |(scale, triangle): (f64, Triangle)| {
        let corners = scaled(&triangle, scale);
        Candidate { corners, doubled: doubled_area(&corners) }
    };
    best.into_iter().map(of).collect()
}
