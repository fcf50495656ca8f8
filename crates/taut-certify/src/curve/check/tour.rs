//! How short a tour can be, from nothing but points and potentials.
//!
//! *Problem.* For points of the plane and any numbers πᵢ, a number that no tour through all points is shorter than.
//! *Idea.* Under weights |ij| + πᵢ + πⱼ every tour is heavier than its points are far apart by 2Σπ, and no lighter than the least
//! 1-tree: the least spanning tree of all points but one, and the two least edges of that one. A path is no lighter than the
//! least spanning tree; its two ends count their πᵢ once.
//! The tree is one of the complete graph: Borůvka's, each component finding its least edge out in a tree of boxes, each with the
//! least potential in it and the component that all its points are of, if there is one.
//! *Guarantee.* Weights are whole numbers in units of 2⁻⁴⁸ of the extent, lengths rounded down, and their sums exact: the bound is
//! right whatever rounding did, and the same for any number of threads. Any potentials make a valid bound.
//! *Cost.* For potentials like those of an ascent, O(n log² n) in practice. Absurd ones make boxes useless, and n² log n steps at
//! worst; the monitor is asked every thousand points.
//! *Trap.* Ties in Borůvka may close cycles; they are of equal weights, and an edge that closes one is left out.
//! *Reference.* Held and Karp, Operations Research 18, 1970; March, Ram and Gray, Fast Euclidean minimum spanning tree, KDD 2010.

mod boxes;
#[cfg(test)]
mod tests;

use std::sync::atomic::{AtomicI64, Ordering};

use taut_points::parallel::ParallelSlice;
use taut_points::{Cancelled, Monitor};

use boxes::Boxes;

/// Points a task has, between two questions to the monitor.
const TASK: usize = 1 << 10;
/// Units in the extent of the points, which is scaled to between 1 and 2.
const UNITS: f64 = (1u64 << 48) as f64;
/// Potentials beyond this count as this: any are valid, and sums stay exact.
const POTENTIAL_MAX: f64 = (1u64 << 50) as f64;
/// Roundings in a length: two differences, two squares, a sum and a root, less than 4 in all, and as many again.
const LENGTH_ROUNDING: f64 = 4.0 * f64::EPSILON;
/// No point.
const NONE: u32 = u32::MAX;

/// A lower bound, rounded down, on the length of every closed tour through all points, or of every path if `open`.
///
/// `potentials[i]` is of `points[i]`; those that are missing or not finite count as 0. The first point is the special one of the
/// 1-tree. Points are finite; equal ones do no harm.
///
/// # Errors
/// [`Cancelled`] when the monitor says so.
pub fn tour_bound(
    points: &[[f64; 2]],
    potentials: &[f64],
    open: bool,
    monitor: &Monitor<'_>,
) -> Result<f64, Cancelled> {
    let n = points.len();
    if n < 2 {
        return Ok(0.0);
    }
    let scale = Scale::of(points);
    let at: Vec<[f64; 2]> = points.iter().map(|&p| scale.point(p)).collect();
    let potentials: Vec<f64> =
        (0..n).map(|i| scale.potential(potentials.get(i).copied().unwrap_or(0.0))).collect();
    let from = usize::from(!open);
    let mut weight = spanning_tree(&at[from..], &potentials[from..], monitor)?;
    let mut least = [f64::INFINITY; 2];
    let mut offer = |weight: f64| {
        least = [least[0].min(weight), least[1].min(weight.max(least[0]))];
    };
    if open {
        potentials.iter().for_each(|&pi| offer(pi));
    } else {
        for i in 1..n {
            offer(length(at[0], at[i]) + (potentials[0] + potentials[i]));
        }
        if n == 2 {
            least[1] = least[0];
        }
    }
    weight += least.iter().map(|&w| w as i128).sum::<i128>();
    weight -= 2 * potentials.iter().map(|&pi| pi as i128).sum::<i128>();
    Ok(scale.back_down(weight))
}

/// The length of the tour through points in this order, back to the first unless `open`, rounded up.
pub fn tour_length(points: &[[f64; 2]], open: bool) -> f64 {
    let scale = Scale::of(points);
    let at = |i: usize| scale.point(points[i % points.len()]);
    let steps = points.len() - usize::from(open && !points.is_empty());
    let sum: f64 = (0..steps).map(|i| distance(at(i), at(i + 1))).sum();
    // Rounding of each length and of their sum, and coordinates below the least double after scaling.
    let slack = (points.len() as f64 + 16.0) * f64::EPSILON;
    if sum == 0.0 { 0.0 } else { scale.back_up(sum * (1.0 + slack)) }
}

#[inline(always)]
fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    let (dx, dy) = (p[0] - q[0], p[1] - q[1]);
    (dx * dx + dy * dy).sqrt()
}

/// A distance in whole units, rounded down.
#[inline(always)]
fn length(p: [f64; 2], q: [f64; 2]) -> f64 {
    (distance(p, q) * (1.0 - LENGTH_ROUNDING) * UNITS).floor()
}

/// The power of two that scales points to an extent between 1 and 2, in steps that are doubles.
struct Scale {
    to: [f64; 2],
    back: [f64; 2],
}

impl Scale {
    fn of(points: &[[f64; 2]]) -> Self {
        let span = |factor: f64| {
            let ends = (0..2).map(|k| {
                let of = points.iter().map(|p| p[k] * factor);
                let low = of.clone().fold(f64::INFINITY, f64::min);
                of.fold(f64::NEG_INFINITY, f64::max) - low
            });
            ends.fold(0.0, f64::max)
        };
        let whole = span(1.0);
        let exponent = if whole.is_finite() { exponent(whole) } else { exponent(span(0.5)) + 1 };
        let power = |e: i32| [2f64.powi(e / 2), 2f64.powi(e - e / 2)];
        Self { to: power(-exponent), back: power(exponent) }
    }

    /// A coordinate that is beyond all numbers in this scale is the same for all points: it may as well be 0.
    fn point(&self, p: [f64; 2]) -> [f64; 2] {
        p.map(|x| x * self.to[0] * self.to[1]).map(|x| if x.is_finite() { x } else { 0.0 })
    }

    /// A potential in whole units.
    fn potential(&self, pi: f64) -> f64 {
        let scaled = pi * self.to[0] * self.to[1] * UNITS;
        if pi.is_finite() { scaled.clamp(-POTENTIAL_MAX, POTENTIAL_MAX).round() } else { 0.0 }
    }

    /// So many units as a length, rounded down, and at least 0.
    fn back_down(&self, units: i128) -> f64 {
        let mut value = units.max(0) as f64;
        if value as i128 > units.max(0) {
            value = value.next_down();
        }
        let value = value / UNITS;
        let scaled = value * self.back[0] * self.back[1];
        // Exact unless it underflows.
        if scaled * self.to[0] * self.to[1] > value {
            scaled.next_down()
        } else {
            scaled.min(f64::MAX)
        }
    }

    /// A scaled length as one of the points, rounded up.
    fn back_up(&self, value: f64) -> f64 {
        let scaled = value * self.back[0] * self.back[1];
        if scaled * self.to[0] * self.to[1] < value { scaled.next_up() } else { scaled }
    }
}

/// The exponent of the highest bit of a number of at least 0; of 0 that of 1.
fn exponent(x: f64) -> i32 {
    let biased = (x.to_bits() >> 52) as i32;
    match x {
        0.0 => 0,
        _ if biased > 0 => biased - 1023,
        _ => -1011 - x.to_bits().leading_zeros() as i32,
    }
}

/// The least weight of a spanning tree of the complete graph, in units.
fn spanning_tree(
    at: &[[f64; 2]],
    potentials: &[f64],
    monitor: &Monitor<'_>,
) -> Result<i128, Cancelled> {
    let mut boxes = Boxes::of(at, potentials);
    let n = at.len();
    let mut parents: Vec<u32> = (0..n as u32).collect();
    // For each point a bound on its edges out of its component, and the other end of the least if it is known.
    let mut known = vec![(i64::MIN, NONE); n];
    let least: Vec<AtomicI64> = (0..n).map(|_| AtomicI64::new(i64::MAX)).collect();
    let mut components: Vec<u32> = (0..n as u32).collect();
    let (mut total, mut joined) = (0i128, 0);
    while joined + 1 < n {
        monitor.check()?;
        least.par_iter().for_each(|least| least.store(i64::MAX, Ordering::Relaxed));
        for (p, known) in known.iter_mut().enumerate() {
            let of = components[p];
            if known.1 != NONE && components[known.1 as usize] == of {
                known.1 = NONE;
            } else if known.1 != NONE {
                least[of as usize].fetch_min(known.0, Ordering::Relaxed);
            }
        }
        let search = |(task, known): (usize, &mut [(i64, u32)])| {
            monitor.check()?;
            for (i, known) in known.iter_mut().enumerate() {
                let p = task * TASK + i;
                let least = &least[components[p] as usize];
                let most = least.load(Ordering::Relaxed);
                if known.1 == NONE && known.0 < most {
                    *known = boxes.nearest_outside(p, &components, most);
                    least.fetch_min(known.0, Ordering::Relaxed);
                }
            }
            Ok(())
        };
        known.par_chunks_mut(TASK).enumerate().try_for_each(search)?;
        // Which of equal edges is taken does not change the weight of the tree.
        for (p, &(weight, other)) in known.iter().enumerate() {
            let of = components[p];
            if other != NONE && least[of as usize].load(Ordering::Relaxed) == weight {
                least[of as usize].store(i64::MIN, Ordering::Relaxed);
                let (a, b) =
                    (root(&mut parents, of), root(&mut parents, components[other as usize]));
                if a != b {
                    parents[a.max(b) as usize] = a.min(b);
                    total += i128::from(weight);
                    joined += 1;
                }
            }
        }
        for component in &mut components {
            *component = root(&mut parents, *component);
        }
        boxes.mark(&components);
    }
    Ok(total)
}

fn root(parents: &mut [u32], mut v: u32) -> u32 {
    while parents[v as usize] != v {
        let above = parents[parents[v as usize] as usize];
        parents[v as usize] = above;
        v = above;
    }
    v
}
