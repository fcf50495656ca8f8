//! The oracle of k centers: brute force over all partitions, or over all choices of rows.

use std::collections::BTreeMap;

use taut::certify::{Centers, CentersVerdict, Placement};
use taut::certify::{CentersCertificate, LowerBound};
use taut::{Items, Solution};

use super::Truth;
use super::ball::is_gap_granted;
use super::dyadic::{Dyadic, exact};
use super::enclosing::{Body, bracket, digits};

/// There may be at most this many rows: all subsets of them are looked at.
const ROWS_MAX: usize = 10;

/// The kind of the rows, and where centers may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Problem {
    items: u8,
    has_weights: bool,
    is_discrete: bool,
}

/// The true facts about one input.
pub struct CentersOracle {
    values: Vec<f64>,
    columns: usize,
    solved: BTreeMap<Problem, Option<Optima>>,
}

/// The least radius of each number of balls around each subset of the rows, from below and from above.
struct Optima {
    bodies: Vec<Body>,
    /// By whether it is a bound from above, by the number of balls less 1, and by the subset.
    least: [Vec<Vec<Dyadic>>; 2],
}

impl CentersOracle {
    /// Prepares to judge answers for few rows.
    pub fn new(values: &[f64], columns: usize) -> Self {
        assert!(values.len() / columns <= ROWS_MAX, "too many rows for all of their subsets");
        CentersOracle { values: values.to_vec(), columns, solved: BTreeMap::new() }
    }

    /// Judges every claim of an accepted answer.
    pub fn judge(&mut self, solution: &Solution<Centers>, verdict: &CentersVerdict) -> Truth {
        let (answer, certificate) = (&solution.answer, &solution.certificate);
        let is_discrete = certificate.placement == Placement::Rows;
        let items = certificate.items as u8;
        let problem = Problem { items, has_weights: certificate.weights, is_discrete };
        let (values, columns) = (&self.values, self.columns);
        let optima = self.solved.entry(problem).or_insert_with(|| {
            bodies(values, columns, certificate).map(|bodies| match is_discrete {
                true => Optima::of_rows(bodies),
                false => Optima::free(bodies),
            })
        });
        let Some(optima) = optima else {
            return Truth::False("the rows are no such items".into());
        };
        form(answer, certificate, verdict, &optima.bodies)
            .and(|| holds(answer, &optima.bodies))
            .and(|| assigned(answer, &optima.bodies))
            .and(|| optima.bounds(certificate, verdict))
    }
}

/// Reads rows as the certificate says; none if they cannot be that.
fn bodies(values: &[f64], columns: usize, certificate: &CentersCertificate) -> Option<Vec<Body>> {
    let body = |row: &[f64]| {
        let (position, radius, weight) = match (certificate.items, certificate.weights, row) {
            (Items::Points, false, _) => (row, 0.0, 1.0),
            (Items::Points, true, [position @ .., weight]) => (position, 0.0, *weight),
            (Items::Balls, false, [position @ .., radius]) => (position, *radius, 1.0),
            _ => return None,
        };
        (radius >= 0.0 && weight > 0.0 && !position.is_empty()).then(|| Body {
            position: exact(position),
            radius: Dyadic::of(radius),
            weight: Dyadic::of(weight),
        })
    };
    values.chunks_exact(columns).map(body).collect()
}

/// Lengths, ranges and lists, and the gap between the two bounds.
fn form(
    answer: &Centers,
    certificate: &CentersCertificate,
    verdict: &CentersVerdict,
    bodies: &[Body],
) -> Truth {
    let (n, dim) = (bodies.len() as u64, bodies[0].position.len());
    let is_number = |x: f64| x >= 0.0 && x.is_sign_positive() && x.is_finite();
    let is_ascending = |rows: &[u64]| {
        rows.windows(2).all(|pair| pair[0] < pair[1]) && rows.iter().all(|&row| row < n)
    };
    let mut core = certificate.core_set.clone();
    core.sort_unstable();
    let places = &answer.centers;
    let rows_are_centers = || {
        answer.rows.len() == places.len()
            && answer
                .rows
                .iter()
                .zip(places)
                .all(|(&row, place)| row < n && exact(place) == bodies[row as usize].position)
    };
    let nodes = match (&certificate.proof, answer.lower_bound > 0.0) {
        (LowerBound::Branches { items }, true) => verdict.branches == items.len() as u64,
        _ => verdict.branches == 0,
    };
    let form = [
        (is_number(answer.radius), "the radius is no number of at least 0"),
        (is_number(answer.lower_bound), "the lower bound is no number of at least 0"),
        (is_number(certificate.gap), "the claimed gap is no number of at least 0"),
        (
            !places.is_empty() && places.len() as u64 <= certificate.k,
            "there are not 1 to k centers",
        ),
        (places.iter().all(|place| place.len() == dim), "a center has another dimension"),
        (places.iter().flatten().all(|x| x.is_finite()), "a center is not finite"),
        (is_ascending(&answer.outliers), "the outliers are no ascending list of rows"),
        (answer.outliers.len() as u64 <= certificate.outliers, "there are too many outliers"),
        (is_ascending(&core), "the core-set is no list of different rows"),
        (verdict.upper == answer.radius, "the upper bound is not the radius"),
        (verdict.lower == answer.lower_bound, "the lower bound is another one"),
        (verdict.lower <= verdict.upper, "the lower bound exceeds the radius"),
        (nodes, "the number of nodes is another one"),
        (verdict.gap >= 0.0, "the gap is negative"),
    ];
    if let Some((_, reason)) = form.iter().find(|(holds, _)| !holds) {
        return Truth::False((*reason).into());
    }
    if !match certificate.placement {
        Placement::Free => answer.rows.is_empty(),
        Placement::Rows => rows_are_centers(),
    } {
        return Truth::False("the centers are not the rows they are said to be".into());
    }
    if !is_gap_granted(verdict.gap, certificate.gap) && verdict.gap != f64::INFINITY {
        return Truth::False(format!("gap {:e}, {:e} claimed", verdict.gap, certificate.gap));
    }
    let (lower, upper) = (Dyadic::of(verdict.lower), Dyadic::of(verdict.upper));
    let is_covered = verdict.gap == f64::INFINITY
        || &(&Dyadic::integer(1) + &Dyadic::of(verdict.gap)) * &lower >= upper;
    Truth::claim(is_covered, || "the radius exceeds the lower bound by more than the gap".into())
}

/// Every row that is not left out lies in a ball.
fn holds(answer: &Centers, bodies: &[Body]) -> Truth {
    let radius = Dyadic::of(answer.radius);
    let centers: Vec<Vec<Dyadic>> = answer.centers.iter().map(|center| exact(center)).collect();
    for (row, body) in bodies.iter().enumerate() {
        let is_held = answer.outliers.contains(&(row as u64))
            || centers.iter().any(|center| body.is_within(center, &radius));
        if !is_held {
            return Truth::False(format!("row {row} is in no ball"));
        }
    }
    Truth::True
}

/// Every row is assigned to its nearest center, up to what the sum of a distance in `f64` is off by.
fn assigned(answer: &Centers, bodies: &[Body]) -> Truth {
    if answer.assignment.is_empty() {
        return Truth::True;
    }
    if answer.assignment.len() != bodies.len() {
        return Truth::False("the assignment has another length".into());
    }
    for (row, (body, &center)) in bodies.iter().zip(&answer.assignment).enumerate() {
        let distance = |center: &Vec<f64>| {
            let plain = Body { radius: Dyadic::zero(), weight: Dyadic::integer(1), ..body.clone() };
            plain.reach(&exact(center), 200)
        };
        let Some(own) = answer.centers.get(center as usize).map(distance) else {
            return Truth::False(format!("row {row} is assigned to center {center}"));
        };
        let dim = body.position.len() as i64;
        for other in &answer.centers {
            let [_, nearer] = distance(other);
            let granted = &(&nearer * &Dyadic::integer(dim + 33)).scaled(-53);
            let granted = &(granted + &body.radius.scaled(-51)) + &Dyadic::power(-1070);
            if own[0] > &nearer + &granted {
                return Truth::False(format!("row {row} has a center nearer than its own"));
            }
        }
    }
    Truth::True
}

impl Optima {
    /// Centers anywhere: the smallest ball of each subset, then the best partition of each.
    fn free(bodies: Vec<Body>) -> Self {
        let balls: Vec<[Dyadic; 2]> = (1u32..1 << bodies.len())
            .map(|mask| {
                let subset: Vec<Body> =
                    chosen(mask, bodies.len()).map(|i| bodies[i].clone()).collect();
                let found = bracket(&subset);
                [found.lower, found.upper]
            })
            .collect();
        let least = [0, 1].map(|end| {
            let one: Vec<Dyadic> = [Dyadic::zero()]
                .into_iter()
                .chain(balls.iter().map(|ball| ball[end].clone()))
                .collect();
            partitions(one, bodies.len())
        });
        Optima { bodies, least }
    }

    /// Centers at rows: the best choice of so many rows for each subset.
    fn of_rows(bodies: Vec<Body>) -> Self {
        let (n, bits) = (bodies.len(), digits(&bodies));
        let reach: Vec<Vec<[Dyadic; 2]>> = bodies
            .iter()
            .map(|center| bodies.iter().map(|body| body.reach(&center.position, bits)).collect())
            .collect();
        let least = [0, 1].map(|end| {
            let one = (0u32..1 << n)
                .map(|mask| {
                    let farthest =
                        |from: usize| chosen(mask, n).map(|i| reach[from][i][end].clone()).max();
                    (0..n).filter_map(farthest).min().unwrap_or_else(Dyadic::zero)
                })
                .collect();
            partitions(one, n)
        });
        Optima { bodies, least }
    }

    /// The least radius of at most k balls around all rows except z.
    fn optimum(&self, k: u64, outliers: u64, end: usize) -> Dyadic {
        let n = self.bodies.len();
        let layer = &self.least[end][(k as usize).clamp(1, n) - 1];
        let kept = (n as u64).saturating_sub(outliers) as u32;
        (0u32..1 << n)
            .filter(|mask| mask.count_ones() >= kept)
            .map(|mask| layer[mask as usize].clone())
            .min()
            .unwrap_or_else(Dyadic::zero)
    }

    fn bounds(&self, certificate: &CentersCertificate, verdict: &CentersVerdict) -> Truth {
        let lower = Dyadic::of(verdict.lower);
        let (k, outliers) = (certificate.k, certificate.outliers);
        let [below, above] = [0, 1].map(|end| self.optimum(k, outliers, end));
        // As `Bracket::is_narrow` has it.
        if &above - &below > above.scaled(-100) {
            return Truth::Undecided("the bracket of the optimum is not narrow".into());
        }
        Truth::claim(lower <= above, || {
            format!("the lower bound {} exceeds the least radius {}", lower.text(), above.text())
        })
    }
}

/// From the size of one ball around each subset, the least size of 1 to n balls around each.
fn partitions(one: Vec<Dyadic>, n: usize) -> Vec<Vec<Dyadic>> {
    let mut order: Vec<usize> = (0..one.len()).collect();
    order.sort_by(|&a, &b| one[a].cmp(&one[b]));
    let mut rank = vec![0; one.len()];
    order.iter().enumerate().for_each(|(place, &mask)| rank[mask] = place);
    let mut layers = vec![rank.clone()];
    for k in 1..n {
        let before = &layers[k - 1];
        let layer = (0..one.len())
            .map(|mask| {
                let mut best = before[mask];
                // A part that holds the first row: each partition has one.
                let mut part = mask;
                while part > 0 {
                    if part & mask & mask.wrapping_neg() != 0 {
                        best = best.min(rank[part].max(before[mask & !part]));
                    }
                    part = (part - 1) & mask;
                }
                best
            })
            .collect();
        layers.push(layer);
    }
    let size = |rank: &usize| one[order[*rank]].clone();
    layers.iter().map(|layer| layer.iter().map(size).collect()).collect()
}

fn chosen(mask: u32, n: usize) -> impl Iterator<Item = usize> {
    (0..n).filter(move |i| mask >> i & 1 == 1)
}
