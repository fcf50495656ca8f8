//! The oracle of k centers: brute force over all partitions, or over all choices of rows.
//!
//! Of rows that are ellipsoids no bracket of the optimum is known here: the largest lower bound that was verified and the least radius
//! must agree.

use std::collections::BTreeMap;

use taut::certify::{Centers, CentersVerdict, Placement};
use taut::certify::{CentersCertificate, LowerBound};
use taut::{Items, Solution};

use super::Truth;
use super::ball::is_gap_granted;
use super::dyadic::{Dyadic, exact};
use super::enclosing::{Body, bracket, digits};
use super::shapes::{Shape, shapes};

/// There may be at most this many rows: all subsets of them are looked at.
const ROWS_MAX: usize = 10;

/// The kind of the rows, and where centers may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Problem {
    items: u8,
    has_weights: bool,
    group: Option<u64>,
    is_discrete: bool,
}

/// The true facts about one input.
pub struct CentersOracle {
    values: Vec<f64>,
    columns: usize,
    solved: BTreeMap<Problem, Option<Optima>>,
    /// The rows as ellipsoids, if they are asked for; none if they cannot be that.
    shapes: Option<Option<Vec<Shape>>>,
}

/// The least radius of each number of balls around each subset of the rows, from below and from above.
struct Optima {
    bodies: Vec<Body>,
    /// The rows of each group, each row one where there are none.
    groups: Vec<Vec<usize>>,
    /// By whether it is a bound from above, by the number of balls less 1, and by the subset of groups.
    least: [Vec<Vec<Dyadic>>; 2],
}

impl CentersOracle {
    /// Prepares to judge answers for few rows.
    pub fn new(values: &[f64], columns: usize) -> Self {
        assert!(values.len() / columns <= ROWS_MAX, "too many rows for all of their subsets");
        let (values, solved) = (values.to_vec(), BTreeMap::new());
        CentersOracle { values, columns, solved, shapes: None }
    }

    /// Judges every claim of an accepted answer.
    pub fn judge(&mut self, solution: &Solution<Centers>, verdict: &CentersVerdict) -> Truth {
        let (answer, certificate) = (&solution.answer, &solution.certificate);
        if certificate.items == Items::Ellipsoids {
            return self.judge_ellipsoids(solution, verdict);
        }
        let is_discrete = certificate.placement == Placement::Rows;
        let items = certificate.items as u8;
        let (has_weights, group) = (certificate.weights, certificate.group);
        let problem = Problem { items, has_weights, group, is_discrete };
        let (values, columns) = (&self.values, self.columns);
        let optima = self.solved.entry(problem).or_insert_with(|| {
            let groups = groups(values, columns, certificate)?;
            bodies(values, columns, certificate).map(|bodies| match is_discrete {
                true => Optima::of_rows(bodies, groups),
                false => Optima::free(bodies, groups),
            })
        });
        let Some(optima) = optima else {
            return Truth::False("the rows are no such items".into());
        };
        let position = |row: usize| optima.bodies[row].position.clone();
        let (n, dim) = (optima.bodies.len(), optima.bodies[0].position.len());
        form(answer, certificate, verdict, [n, dim], &optima.groups, &position)
            .and(|| holds(answer, optima))
            .and(|| match certificate.group {
                None => assigned(answer, &optima.bodies),
                Some(_) => assigned_together(answer, optima),
            })
            .and(|| optima.bounds(certificate, verdict))
    }

    /// The same where rows are ellipsoids, but for the lower bound.
    fn judge_ellipsoids(
        &mut self,
        solution: &Solution<Centers>,
        verdict: &CentersVerdict,
    ) -> Truth {
        let (answer, certificate) = (&solution.answer, &solution.certificate);
        let (values, columns) = (&self.values, self.columns);
        let dim = Items::Ellipsoids.dim(columns);
        let read = || if dim > 0 { shapes(values, columns) } else { None };
        let Some(shapes) = self.shapes.get_or_insert_with(read) else {
            return Truth::False("the rows are no ellipsoids".into());
        };
        if certificate.weights
            || certificate.group.is_some()
            || certificate.placement == Placement::Rows
        {
            return Truth::False("ellipsoids have no weights, groups or centers among them".into());
        }
        let groups: Vec<Vec<usize>> = (0..shapes.len()).map(|row| vec![row]).collect();
        let no_position = |_: usize| vec![];
        form(answer, certificate, verdict, [shapes.len(), dim], &groups, &no_position)
            .and(|| shapes_held(answer, shapes))
            .and(|| shapes_assigned(answer, shapes))
    }
}

/// The rows of each group, by first appearance; none if the column of groups is not there or all there is.
fn groups(
    values: &[f64],
    columns: usize,
    certificate: &CentersCertificate,
) -> Option<Vec<Vec<usize>>> {
    let rows = values.len() / columns;
    let Some(column) = certificate.group else {
        return Some((0..rows).map(|row| vec![row]).collect());
    };
    let column = usize::try_from(column).ok().filter(|&column| column < columns && columns > 1)?;
    let mut found: Vec<(f64, Vec<usize>)> = vec![];
    for (row, values) in values.chunks_exact(columns).enumerate() {
        // By value: zeros of either sign are one group.
        match found.iter_mut().find(|(value, _)| *value == values[column]) {
            Some((_, rows)) => rows.push(row),
            None => found.push((values[column], vec![row])),
        }
    }
    Some(found.into_iter().map(|(_, rows)| rows).collect())
}

/// Reads rows as the certificate says; none if they cannot be that.
fn bodies(values: &[f64], columns: usize, certificate: &CentersCertificate) -> Option<Vec<Body>> {
    let body = |row: &[f64]| {
        let mut row = row.to_vec();
        if let Some(group) = certificate.group {
            row.remove(group as usize);
        }
        let (position, radius, weight) = match (certificate.items, certificate.weights, &row[..]) {
            (Items::Points, false, row) => (row, 0.0, 1.0),
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
    [n, dim]: [usize; 2],
    groups: &[Vec<usize>],
    position: &dyn Fn(usize) -> Vec<Dyadic>,
) -> Truth {
    let is_out = |row: usize| answer.outliers.contains(&(row as u64));
    let left_out = groups.iter().filter(|rows| rows.iter().any(|&row| is_out(row)));
    let n = n as u64;
    let are_ellipsoids = certificate.items == Items::Ellipsoids;
    let directions = if are_ellipsoids { certificate.core_set.len() } else { 0 };
    let is_number = |x: f64| x >= 0.0 && x.is_sign_positive() && x.is_finite();
    let is_ascending = |rows: &[u64]| {
        rows.windows(2).all(|pair| pair[0] < pair[1]) && rows.iter().all(|&row| row < n)
    };
    let mut core = certificate.core_set.clone();
    core.sort_unstable();
    if are_ellipsoids {
        core.dedup();
    }
    let places = &answer.centers;
    let rows_are_centers = || {
        answer.rows.len() == places.len()
            && answer
                .rows
                .iter()
                .zip(places)
                .all(|(&row, place)| row < n && exact(place) == position(row as usize))
    };
    let nodes = match (&certificate.proof, answer.lower_bound > 0.0) {
        (LowerBound::Branches { items } | LowerBound::Avoiding { items, .. }, true) => {
            verdict.branches == items.len() as u64
        }
        (LowerBound::Nogoods { nogoods }, true) => verdict.branches == nogoods.len() as u64,
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
        (left_out.clone().count() as u64 <= certificate.outliers, "there are too many outliers"),
        (
            left_out.clone().all(|rows| rows.iter().all(|&row| is_out(row))),
            "a group is left out in part",
        ),
        (is_ascending(&core), "the core-set is no list of different rows"),
        (certificate.directions.len() == directions, "there is no direction for each point"),
        (
            certificate
                .directions
                .iter()
                .all(|a| a.len() == dim && a.iter().all(|x| x.is_finite())),
            "a direction is not one of so many finite numbers",
        ),
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

/// Every ellipsoid that is not left out lies in a ball.
fn shapes_held(answer: &Centers, shapes: &[Shape]) -> Truth {
    let rows = shapes.iter().enumerate();
    let counts = rows.filter(|(row, _)| !answer.outliers.contains(&(*row as u64)));
    counts.fold(Truth::True, |truth, (row, shape)| {
        truth.and(|| {
            let found: Vec<Option<bool>> = answer
                .centers
                .iter()
                .map(|center| shape.is_within(center, &[], answer.radius))
                .collect();
            match () {
                () if found.contains(&Some(true)) => Truth::True,
                () if found.contains(&None) => {
                    Truth::Undecided(format!("no ball is known to hold ellipsoid {row}"))
                }
                () => Truth::False(format!("no ball holds ellipsoid {row}")),
            }
        })
    })
}

/// The part of how far an ellipsoid reaches that its center may be worse than another, twice what the documentation grants.
const GRANTED: f64 = 2e-9;

/// Every ellipsoid is assigned to the center from which it reaches least far.
fn shapes_assigned(answer: &Centers, shapes: &[Shape]) -> Truth {
    if answer.assignment.is_empty() {
        return Truth::True;
    }
    if answer.assignment.len() != shapes.len() {
        return Truth::False("the assignment has another length".into());
    }
    for (row, (shape, &center)) in shapes.iter().zip(&answer.assignment).enumerate() {
        let Some(own) = answer.centers.get(center as usize) else {
            return Truth::False(format!("ellipsoid {row} is assigned to center {center}"));
        };
        for other in &answer.centers {
            let Some(reach) = reach_of(shape, other, answer.radius) else { continue };
            if shape.is_within(own, &[], reach * (1.0 + GRANTED)) == Some(false) {
                return Truth::False(format!("ellipsoid {row} has a center nearer than its own"));
            }
        }
    }
    Truth::True
}

/// A radius within which an ellipsoid lies, by halving not much more than the least; none where that is beyond the largest number.
fn reach_of(shape: &Shape, center: &[f64], radius: f64) -> Option<f64> {
    let is_within = |radius: f64| shape.is_within(center, &[], radius) == Some(true);
    let (mut low, mut high) = (0.0, radius.max(f64::MIN_POSITIVE));
    while !is_within(high) {
        (low, high) = (high, high * 2.0);
        if high == f64::INFINITY {
            return None;
        }
    }
    for _ in 0..48 {
        let middle = low + (high - low) / 2.0;
        if is_within(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(high)
}

/// Every group that is not left out lies in a ball.
fn holds(answer: &Centers, optima: &Optima) -> Truth {
    let radius = Dyadic::of(answer.radius);
    let centers: Vec<Vec<Dyadic>> = answer.centers.iter().map(|center| exact(center)).collect();
    for rows in &optima.groups {
        let is_within = |center: &Vec<Dyadic>| {
            rows.iter().all(|&row| optima.bodies[row].is_within(center, &radius))
        };
        if !answer.outliers.contains(&(rows[0] as u64)) && !centers.iter().any(is_within) {
            return Truth::False(format!("no ball holds all of the rows {rows:?}"));
        }
    }
    Truth::True
}

/// Every group is assigned to one center, from which it reaches least far, up to what the sum of a distance in `f64` is off by.
fn assigned_together(answer: &Centers, optima: &Optima) -> Truth {
    if answer.assignment.is_empty() {
        return Truth::True;
    }
    if answer.assignment.len() != optima.bodies.len() {
        return Truth::False("the assignment has another length".into());
    }
    for rows in &optima.groups {
        let center = answer.assignment[rows[0]];
        if rows.iter().any(|&row| answer.assignment[row] != center) {
            return Truth::False(format!("the rows {rows:?} have several centers"));
        }
        let reach = |center: &Vec<f64>, end: usize| {
            let place = exact(center);
            let reaches =
                rows.iter().map(|&row| optima.bodies[row].reach(&place, 200)[end].clone());
            reaches.max().unwrap_or_else(Dyadic::zero)
        };
        let Some(own) = answer.centers.get(center as usize) else {
            return Truth::False(format!("the rows {rows:?} are assigned to center {center}"));
        };
        let dim = own.len() as i64;
        for other in &answer.centers {
            let nearer = reach(other, 1);
            let granted =
                &(&nearer * &Dyadic::integer(dim + 60)).scaled(-53) + &Dyadic::power(-1070);
            if reach(own, 0) > &nearer + &granted {
                return Truth::False(format!(
                    "the rows {rows:?} have a center nearer than their own"
                ));
            }
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
    fn free(bodies: Vec<Body>, groups: Vec<Vec<usize>>) -> Self {
        let balls: Vec<[Dyadic; 2]> = (1u32..1 << groups.len())
            .map(|mask| {
                let subset: Vec<Body> = chosen(mask, groups.len())
                    .flat_map(|group| &groups[group])
                    .map(|&row| bodies[row].clone())
                    .collect();
                let found = bracket(&subset);
                [found.lower, found.upper]
            })
            .collect();
        let least = [0, 1].map(|end| {
            let one: Vec<Dyadic> = [Dyadic::zero()]
                .into_iter()
                .chain(balls.iter().map(|ball| ball[end].clone()))
                .collect();
            partitions(one, groups.len())
        });
        Optima { bodies, groups, least }
    }

    /// Centers at rows: the best choice of so many rows for each subset.
    fn of_rows(bodies: Vec<Body>, groups: Vec<Vec<usize>>) -> Self {
        let (n, bits) = (groups.len(), digits(&bodies));
        let of_group = |rows: &Vec<usize>, center: &Body| {
            let reaches: Vec<[Dyadic; 2]> =
                rows.iter().map(|&row| bodies[row].reach(&center.position, bits)).collect();
            [0, 1].map(|end| {
                let reaches = reaches.iter().map(|reach| reach[end].clone());
                reaches.max().unwrap_or_else(Dyadic::zero)
            })
        };
        let reach: Vec<Vec<[Dyadic; 2]>> = bodies
            .iter()
            .map(|center| groups.iter().map(|rows| of_group(rows, center)).collect())
            .collect();
        let least = [0, 1].map(|end| {
            let one = (0u32..1 << n)
                .map(|mask| {
                    let farthest =
                        |from: usize| chosen(mask, n).map(|i| reach[from][i][end].clone()).max();
                    (0..bodies.len()).filter_map(farthest).min().unwrap_or_else(Dyadic::zero)
                })
                .collect();
            partitions(one, n)
        });
        Optima { bodies, groups, least }
    }

    /// The least radius of at most k balls around all groups except z.
    fn optimum(&self, k: u64, outliers: u64, end: usize) -> Dyadic {
        let n = self.groups.len();
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
