//! The rectangle in a polygon, in fractions.
//!
//! *Decided.* Whether no edge enters the rectangle, it is inside by the even-odd rule, and the area and the gap are what they are said to be:
//! exact. Whether no rectangle is larger than the upper bound: refuted by a larger one, of which it is decided that it is inside.
//! Those tried lie between coordinates of vertices and some levels, shrunk a little.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use taut::certify::{InscribedRectangle, RectangleVerdict, Solution};

use super::Truth;
use super::circle::{Point, crosses_above, edges, exact};
use crate::random::Random;

/// Rectangles of the random search, and changes of each.
const TRIED: (usize, usize) = (30, 150);

/// Knows the truth about the rectangles in one polygon.
pub struct RectangleOracle {
    edges: Vec<[Point; 2]>,
    /// The area of the best rectangle found, which is inside.
    best: BigRational,
}

/// Whether an edge enters the open rectangle, exactly.
fn enters(low: &Point, high: &Point, [a, b]: &[Point; 2]) -> bool {
    let (mut from, mut to) = (BigRational::zero(), BigRational::one());
    for k in 0..2 {
        for (here, there) in
            [(&a[k] - &low[k], &b[k] - &low[k]), (&high[k] - &a[k], &high[k] - &b[k])]
        {
            if !here.is_positive() && !there.is_positive() {
                return false;
            }
            if here.is_positive() && there.is_positive() {
                continue;
            }
            let share = &here / (&here - &there);
            if here.is_positive() {
                to = to.min(share);
            } else {
                from = from.max(share);
            }
        }
    }
    from < to
}

fn area(low: &Point, high: &Point) -> BigRational {
    (&high[0] - &low[0]) * (&high[1] - &low[1])
}

impl RectangleOracle {
    /// Prepares to judge rectangles in the rings of these rows.
    pub fn new(values: &[f64], columns: usize) -> Self {
        let plain = edges(values, columns);
        let of_edge = |edge: &[[f64; 2]; 2]| edge.map(|p| p.map(exact));
        let edges: Vec<[Point; 2]> = plain.iter().map(of_edge).collect();
        let mut oracle = RectangleOracle { edges, best: BigRational::zero() };
        let mut tried = candidates(&plain);
        let size = |r: &[[f64; 2]; 2]| (r[1][0] - r[0][0]) * (r[1][1] - r[0][1]);
        tried.sort_by(|one, other| size(other).total_cmp(&size(one)));
        for [low, high] in tried {
            let (low, high) = (low.map(exact), high.map(exact));
            if (0..2).all(|k| low[k] < high[k]) && oracle.holds(&low, &high) {
                oracle.best = area(&low, &high);
                break;
            }
        }
        oracle
    }

    fn holds(&self, low: &Point, high: &Point) -> bool {
        let middle = [0, 1].map(|k| (&low[k] + &high[k]) / exact(2.0));
        let crossed = self.edges.iter().filter(|edge| crosses_above(edge, &middle)).count();
        crossed % 2 == 1 && !self.edges.iter().any(|edge| enters(low, high, edge))
    }

    /// Judges every claim of an answer that the checker let pass.
    pub fn judge(&self, found: &Solution<InscribedRectangle>, verdict: &RectangleVerdict) -> Truth {
        let (answer, numbers) = (&found.answer, [verdict.lower, verdict.upper, verdict.gap]);
        let fields = answer.low.iter().chain(&answer.high).chain(&numbers);
        let are_numbers = fields.chain([&answer.area]).all(|x| x.is_finite());
        let is_empty = (0..2).any(|k| answer.low[k] >= answer.high[k]);
        if !(are_numbers && verdict.lower > 0.0 && verdict.gap >= 0.0) || is_empty {
            return Truth::False(format!("{answer:?} and {verdict:?} are no rectangle"));
        }
        let (low, high) = (answer.low.map(exact), answer.high.map(exact));
        let found = area(&low, &high);
        let [lower, upper, gap] = numbers.map(exact);
        Truth::claim(self.holds(&low, &high), || "the rectangle is not inside".into())
            .and(|| Truth::claim(lower <= found, || "the area is less than the lower bound".into()))
            .and(|| {
                let holds = (exact(answer.area) - &found).abs() <= exact(1e-13) * &found;
                Truth::claim(holds, || "the area is not that of the sides".into())
            })
            .and(|| {
                Truth::claim(self.best <= upper, || {
                    format!("there is a rectangle larger than {:?}", verdict.upper)
                })
            })
            .and(|| {
                let most = (BigRational::one() + &gap) * &lower;
                Truth::claim(upper <= most, || format!("the gap is more than {:?}", verdict.gap))
            })
    }
}

/// Rectangles that may be large, each the best of a random search in plain arithmetic; proved by nobody.
fn candidates(edges: &[[[f64; 2]; 2]]) -> Vec<[[f64; 2]; 2]> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for [p, _] in edges {
        for k in 0..2 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    let mut random = Random::new("rectangles", edges.len() as u64);
    let clear = |r: &[[f64; 2]; 2]| {
        let middle = [0, 1].map(|k| 0.5 * r[0][k] + 0.5 * r[1][k]);
        let is_apart = |[a, b]: &[[f64; 2]; 2]| {
            let (mut from, mut to) = (0.0f64, 1.0f64);
            for k in 0..2 {
                for (here, there) in
                    [(a[k] - r[0][k], b[k] - r[0][k]), (r[1][k] - a[k], r[1][k] - b[k])]
                {
                    if here <= 0.0 && there <= 0.0 {
                        return true;
                    }
                    let share = here / (here - there);
                    if here > 0.0 && there <= 0.0 {
                        to = to.min(share);
                    } else if here <= 0.0 {
                        from = from.max(share);
                    }
                }
            }
            from >= to
        };
        super::circle::is_inside(edges, middle) && edges.iter().all(is_apart)
    };
    let size = |r: &[[f64; 2]; 2]| {
        ((r[1][0] - r[0][0]) / (high[0] - low[0])) * ((r[1][1] - r[0][1]) / (high[1] - low[1]))
    };
    let mut found = vec![];
    for _ in 0..TRIED.0 {
        let at = [0, 1].map(|k| low[k] + (high[k] - low[k]) * random.unit());
        let mut here = [at, at.map(f64::next_up)];
        let mut step = 0.5;
        for _ in 0..TRIED.1 {
            let mut next = here;
            for corner in &mut next {
                for k in 0..2 {
                    corner[k] += step * random.signed() * (high[k] - low[k]);
                }
            }
            let is_larger = (0..2).all(|k| next[0][k] < next[1][k]) && size(&next) > size(&here);
            if is_larger && clear(&next) {
                here = next;
            } else {
                step *= 0.97;
            }
        }
        found.push(here);
    }
    found.retain(|r| r.as_flattened().iter().all(|x| x.is_finite()));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn most_of_a_square_is_found() {
        let oracle = RectangleOracle::new(&[0.0, 0.0, 2.0, 0.0, 2.0, 2.0, 0.0, 2.0], 2);
        assert!(oracle.best <= exact(4.0) && oracle.best >= exact(3.0));
    }
}
