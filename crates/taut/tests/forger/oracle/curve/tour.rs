//! Tours: that they pass all points, how long they are, and how short one can be.
//!
//! Lengths are whole numbers of 2⁻¹⁰⁰ of the extent, each rounded down: a sum of n is short of the truth by less than n units,
//! which is the resolution of what is said here.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use taut::Solution;
use taut::certify::Curve;
use taut::certify::CurveVerdict;

use super::super::lattice::{Lattice, difference, dot, parts};
use super::lists::key;
use super::planar::Point;
use super::{Judged, Stop, ensure};

/// Units in the largest distance, as a power of two.
const BITS: u64 = 100;

/// The shortest tour is found of at most this many points.
const TOUR_POINTS_MAX: usize = 11;

/// The amount by which the lower bound of a certificate may exceed the proved one, relatively, as documented. What is told as the gap
/// may not be less than the truth at all.
const BOUND_SLACK: f64 = 1e-9;

/// Potentials beyond this many extents say nothing that an oracle could compare: any are valid.
const POTENTIAL_MAX: f64 = 4.0;

/// Distances of the distinct points, and the shortest closed and open tour.
pub(super) struct Tours {
    keys: Vec<[u64; 2]>,
    distances: Vec<Vec<i128>>,
    /// A unit is 2^`exponent`.
    exponent: i64,
    /// Closed and open: of few points the shortest, else one that was found.
    short: [i128; 2],
    is_shortest: bool,
}

impl Tours {
    pub(super) fn of(rows: &[Point]) -> Self {
        let mut points: Vec<Point> = rows.to_vec();
        points.sort_by_key(|&p| key(p));
        points.dedup_by_key(|p| key(*p));
        let lattice = Lattice::of(points.as_flattened(), 2);
        let squared = |i: usize, j: usize| {
            let r = difference(&lattice.points[j], &lattice.points[i]);
            dot(&r, &r)
        };
        let n = points.len();
        let squares: Vec<Vec<BigInt>> =
            (0..n).map(|i| (0..n).map(|j| squared(i, j)).collect()).collect();
        let longest = squares.iter().flatten().map(BigInt::bits).max().unwrap_or(0).div_ceil(2);
        // √(s·4^up / 4^down) is in units of 2^(down − up).
        let (up, down) = (BITS.saturating_sub(longest), longest.saturating_sub(BITS));
        let length = |s: &BigInt| ((s << (2 * up)) >> (2 * down)).sqrt().to_i128();
        let distances: Vec<Vec<i128>> = squares
            .iter()
            .map(|row| row.iter().map(|s| length(s).expect("at most 101 bits")).collect())
            .collect();
        let exponent = i64::from(lattice.exponent) + down as i64 - up as i64;
        let is_shortest = n <= TOUR_POINTS_MAX;
        let short = [false, true].map(|is_open| match is_shortest {
            true => shortest(&distances, is_open),
            false => found(&distances, is_open),
        });
        let keys = points.into_iter().map(key).collect();
        Tours { keys, distances, exponent, short, is_shortest }
    }

    /// Tests whether what is said of a tour is true.
    pub(super) fn judge(&self, solution: &Solution<Curve>, verdict: &CurveVerdict) -> Judged {
        let Some(bound) = &solution.certificate.tour else {
            return ensure(verdict.tour_gap.is_none(), || "a gap of no tour".into());
        };
        let [tour] = &solution.answer.curves[..] else {
            return Err(Stop::Lie("a tour is one curve".into()));
        };
        ensure(solution.answer.outliers.is_empty() && !tour.rows.is_empty(), || {
            "a tour passes all rows".into()
        })?;
        ensure(bound.potentials.len() == tour.vertices.len(), || "not as many potentials".into())?;
        let place = |p: &Point| self.keys.binary_search(&key(*p)).ok();
        let order: Option<Vec<usize>> = tour.vertices.iter().map(place).collect();
        let order = order.ok_or(Stop::Lie("the tour has a vertex that is no point".into()))?;
        let mut visits = order.clone();
        visits.sort_unstable();
        visits.dedup();
        let n = self.keys.len();
        ensure(visits.len() == n && order.len() == n, || "not each point once".into())?;
        let length = self.length(&order, tour.closed);
        let short = self.short[usize::from(!tour.closed)].min(length);
        let rounding = n as i128;
        let Some(gap) = verdict.tour_gap else {
            return Err(Stop::Lie("a tour with a bound has a gap".into()));
        };
        ensure(gap >= 0.0, || format!("the gap is {gap}"))?;
        if gap.is_finite() {
            // The shortest tour is one that is known, at most.
            let factor = whole(gap) + BigRational::from_integer(1.into());
            let most = factor.clone() * BigRational::from_integer((short + rounding).into());
            let is_true = BigRational::from_integer(length.into()) <= most;
            ensure(is_true || !self.is_shortest, || {
                let excess = length as f64 / short as f64 - 1.0;
                format!("the gap is told to be {gap:e}, and is {excess:e}")
            })?;
            if !is_true && short < length {
                return Err(Stop::Lie(format!("a tour shorter by more than the gap {gap:e}")));
            }
            self.weigh(&order, tour.closed, &bound.potentials, bound.lower, &factor, length)?;
        }
        let most = (short + rounding) as f64 * (1.0 + 2.0 * BOUND_SLACK);
        let lower = self.in_units(bound.lower);
        ensure(lower.to_f64().is_some_and(|lower| lower <= most), || {
            format!("no tour is said to be shorter than {:e}, but one is", bound.lower)
        })
    }

    /// A length told, in whole units, rounded down.
    fn in_units(&self, length: f64) -> BigInt {
        let (mantissa, exponent) = parts(length);
        match i64::from(exponent) - self.exponent {
            left @ 0.. => mantissa << left as u64,
            right => mantissa >> right.unsigned_abs(),
        }
    }

    fn length(&self, order: &[usize], is_closed: bool) -> i128 {
        let steps = order.windows(2).map(|pair| self.distances[pair[0]][pair[1]]);
        let back = match order {
            [first, .., last] if is_closed => self.distances[*last][*first],
            _ => 0,
        };
        steps.sum::<i128>() + back
    }

    /// The gap is not less than length over the bound of Held and Karp from the potentials, less 1.
    fn weigh(
        &self,
        order: &[usize],
        is_closed: bool,
        potentials: &[f64],
        claimed: f64,
        factor: &BigRational,
        length: i128,
    ) -> Judged {
        let n = order.len();
        let extent = (1i128 << BITS) as f64;
        let pi: Vec<i128> =
            potentials.iter().filter_map(|&pi| self.in_units(pi).to_i128()).collect();
        if n < 3 || pi.len() < n || pi.iter().any(|&pi| pi.abs() as f64 > POTENTIAL_MAX * extent) {
            return Ok(());
        }
        let weight = |i: usize, j: usize| self.distances[order[i]][order[j]] + pi[i] + pi[j];
        let from = usize::from(is_closed);
        let mut near: Vec<i128> = (0..n).map(|j| weight(from, j)).collect();
        let (mut is_in, mut bound) = (vec![false; n], 0);
        is_in[from] = true;
        for _ in from + 1..n {
            let next = (from..n).filter(|&j| !is_in[j]).min_by_key(|&j| near[j]);
            let next = next.expect("one is left");
            (is_in[next], bound) = (true, bound + near[next]);
            (from..n).for_each(|j| near[j] = near[j].min(weight(next, j)));
        }
        let mut ends: Vec<i128> = match is_closed {
            true => (1..n).map(|j| weight(0, j)).collect(),
            false => pi.clone(),
        };
        ends.sort_unstable();
        bound += ends[0] + ends[1] - 2 * pi.iter().sum::<i128>();
        // Potentials were rounded, too, each by one unit in up to 2n places.
        let rounding = (4 * n * n) as i128;
        let claimed = self.in_units(claimed).to_i128().unwrap_or(i128::MAX);
        let most = (bound + rounding).min(claimed.saturating_add(1)).max(0);
        let covered = factor.clone() * BigRational::from_integer(most.into());
        ensure(BigRational::from_integer(length.into()) <= covered, || {
            format!("the gap is less than the potentials prove: {length} over {most}")
        })
    }
}

fn whole(x: f64) -> BigRational {
    BigRational::from_float(x).expect("a finite number")
}

/// By the dynamic program of Bellman, Held and Karp.
fn shortest(distances: &[Vec<i128>], is_open: bool) -> i128 {
    let n = distances.len();
    let mut best = vec![vec![i128::MAX; n]; 1 << n];
    for v in (0..n).filter(|&v| is_open || v == 0) {
        best[1 << v][v] = 0;
    }
    for set in 1..1usize << n {
        for v in (0..n).filter(|&v| set >> v & 1 == 1) {
            let here = best[set][v];
            if here == i128::MAX {
                continue;
            }
            for u in (0..n).filter(|&u| set >> u & 1 == 0) {
                let of = &mut best[set | 1 << u][u];
                *of = (*of).min(here + distances[v][u]);
            }
        }
    }
    let ends = best[(1 << n) - 1].iter().enumerate().filter(|(_, way)| **way < i128::MAX);
    let back = |v: usize| if is_open { 0 } else { distances[v][0] };
    ends.map(|(v, way)| way + back(v)).min().unwrap_or(0)
}

/// Some tour, by the nearest neighbor and moves of two edges.
fn found(distances: &[Vec<i128>], is_open: bool) -> i128 {
    let n = distances.len();
    let mut tour = vec![0];
    while tour.len() < n {
        let last = tour[tour.len() - 1];
        let next = (0..n).filter(|v| !tour.contains(v)).min_by_key(|&v| distances[last][v]);
        tour.extend(next);
    }
    let between = |a: Option<&usize>, b: Option<&usize>| match (a, b) {
        (Some(&a), Some(&b)) => distances[a][b],
        _ => 0,
    };
    let mut is_better = true;
    while is_better {
        is_better = false;
        for i in 0..n {
            for j in i + 1..n {
                let before = match is_open {
                    true => i.checked_sub(1).and_then(|i| tour.get(i)),
                    false => tour.get((i + n - 1) % n),
                };
                let after = if is_open { tour.get(j + 1) } else { tour.get((j + 1) % n) };
                let old = between(before, tour.get(i)) + between(tour.get(j), after);
                let new = between(before, tour.get(j)) + between(tour.get(i), after);
                // The whole tour turned around is the same tour.
                if new < old && (is_open || j - i < n - 1) {
                    tour[i..=j].reverse();
                    is_better = true;
                }
            }
        }
    }
    let steps: i128 = tour.windows(2).map(|pair| distances[pair[0]][pair[1]]).sum();
    steps + if is_open { 0 } else { between(tour.last(), tour.first()) }
}
