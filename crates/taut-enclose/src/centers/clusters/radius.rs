//! The radius of a cluster with one item more: what it is, and what it is at least.

use super::Cluster;
use crate::centers::items::{ItemSet, Position, Shape, distance, square};
use crate::centers::small_ball::{REACH_TOLERANCE, Workspace};

/// A radius that is accurate to 1e-13 has a center that is accurate to the root of twice that, 5e-7 of the radius.
const CENTER_ERROR: f64 = 1e-6;
/// Relative error of a distance from a center that is at least 2e-7, [`f64::EPSILON`] over this, of the largest coordinate of the center. In smaller
/// distances the rounding of the coordinates shows.
const DISTANCE_ERROR: f64 = 1e-9;
/// Thresholds from this to its inverse have squares that neither vanish nor overflow, nor lose digits as subnormal numbers do.
const SQUARES_MIN: f64 = 1e-140;

impl<P: Position> Cluster<P> {
    /// Returns what the radius with one point more is at least, whatever rounding has done to the ball: (D² + r²)/2D, less
    /// [`CENTER_ERROR`] of it. Returns −∞ for a point in the ball, or so near that rounding may be more than that.
    pub(super) fn radius_at_least(&self, items: &ItemSet<P>, item: u32) -> f64 {
        let r = self.ball.radius;
        let d = distance(items.at(item as usize), self.ball.center.as_ref());
        let coordinates = self.ball.center.as_ref().iter();
        let largest = coordinates.fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let is_accurate = d * DISTANCE_ERROR >= f64::EPSILON * largest;
        match items.shape() {
            Shape::Points if d > r && is_accurate => 0.5 * (d + r * (r / d)) * (1.0 - CENTER_ERROR),
            _ => f64::NEG_INFINITY,
        }
    }

    /// The radius with one item more, ∞ if it is not below the threshold; `others` are the members to which the item may be too far
    /// for any ball.
    #[inline(always)]
    pub(super) fn radius_with(
        &self,
        items: &ItemSet<P>,
        item: u32,
        others: &[u32],
        threshold: f64,
        work: &mut Workspace<P>,
    ) -> f64 {
        let at = item as usize;
        let r = self.ball.radius;
        let inside = r * (1.0 + REACH_TOLERANCE);
        let squared = square(items.at(at), self.ball.center.as_ref());
        match items.shape() {
            // Squares spare the roots of most items.
            Shape::Points if (SQUARES_MIN..1.0 / SQUARES_MIN).contains(&threshold) => {
                if squared <= inside * inside {
                    return r;
                }
                if squared + r * r >= 2.0 * squared.sqrt() * threshold {
                    return f64::INFINITY;
                }
                let is_far =
                    |&other: &u32| items.square(other as usize, at) >= 4.0 * threshold * threshold;
                if others.iter().any(is_far) {
                    return f64::INFINITY;
                }
            }
            _ => {
                let d = squared.sqrt();
                if items.reach_at(at, d) <= inside {
                    return r;
                }
                if items.shape() == Shape::Points && d * d + r * r >= 2.0 * d * threshold {
                    return f64::INFINITY;
                }
                for &other in others {
                    if items.pair_radius(other as usize, at) >= threshold {
                        return f64::INFINITY;
                    }
                }
            }
        }
        match self.members[..] {
            [only] => items.pair_radius(only as usize, at),
            _ => work.radius_with(items, &self.ball, &self.members, item, threshold),
        }
    }
}
