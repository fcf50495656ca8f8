//! Numbers of all sizes: whatever is answered is confirmed by the checker, and answers to one question agree.

use taut_certify::{Centers, Items, Placement, Solution, Stop};
use taut_enclose::{CentersMethod, CentersOptions, Error, StreamingOptions, centers};
use taut_points::{Distribution, Points, generate};

use crate::test_length::long_or;

/// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    fn below(&mut self, count: u64) -> u64 {
        self.next() % count
    }

    fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len() as u64) as usize]
    }

    /// In [0, 1).
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / 2f64.powi(53)
    }
}

const FAMILIES: [&str; 8] =
    ["offset", "far integers", "thin", "huge", "tiny", "subnormal", "near copies", "mixed"];

/// Coordinates that are hard on arithmetic.
fn places(random: &mut Random, family: &str, n: usize, dim: usize) -> Vec<f64> {
    let offset = 10f64.powi(8 + random.below(8) as i32);
    let small = random.of(&[1e-300, 1e-200, 1e-160, 1e-100, 1e-20]);
    let big = random.of(&[1e150, 1e200, 1e300]);
    let is_grid = random.below(2) == 0;
    (0..n * dim)
        .map(|i| {
            let plain = match is_grid {
                true => random.below(7) as f64 - 3.0,
                false => 4.0 * random.unit() - 2.0,
            };
            match family {
                "offset" => plain + offset,
                "far integers" => plain.round() + offset,
                "thin" if i % dim > 0 || dim == 1 && random.below(2) == 0 => plain * small,
                "huge" => plain * big,
                "tiny" => plain * small,
                "subnormal" => plain.round() * 5e-324,
                "near copies" => random.of(&[0.0, 1.0, 5.0]) + plain.round() * small,
                "mixed" => random.of(&[0.0, 1.0, offset, -offset]) + plain,
                _ => plain,
            }
        })
        .collect()
}

#[derive(Debug, Clone)]
struct Case {
    family: &'static str,
    values: Vec<f64>,
    columns: usize,
    items: Items,
    k: usize,
    options: CentersOptions<'static>,
}

fn case(seed: u64) -> Case {
    let random = &mut Random(seed);
    let family = random.of(&FAMILIES);
    let (dim, k) = (random.of(&[1, 2, 2, 3, 10]), 1 + random.below(6) as usize);
    let most = random.of(&[4, 12, 60]);
    let n = 1 + random.below(most) as usize;
    let places = places(random, family, n, dim);
    let (items, weights) = random.of(&[
        (Items::Points, false),
        (Items::Points, false),
        (Items::Points, true),
        (Items::Balls, false),
    ]);
    let is_wild = random.below(2) == 0;
    let largest = places.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let values = if weights || items == Items::Balls {
        let extra = |random: &mut Random| match (weights, is_wild) {
            (true, true) => 10f64.powf(300.0 * random.unit() - 150.0),
            (true, false) => 0.5 + random.below(4) as f64,
            (false, true) => random.of(&[0.0, 1e100, 1e-100, 1.0, 5e-324]),
            (false, false) => largest * 0.25 * random.below(3) as f64,
        };
        let rows = places.chunks_exact(dim).map(<[f64]>::to_vec);
        rows.flat_map(|mut row| {
            row.push(extra(random));
            row
        })
        .collect()
    } else {
        places
    };
    let columns = values.len() / n;
    let outliers = random.of(&[0, 0, 1, 2]).min(n as u64 - 1);
    let options = CentersOptions {
        epsilon: random.of(&[0.0, 1e-9, 1e-6, 0.01]),
        outliers,
        weights,
        placement: random.of(&[Placement::Free, Placement::Free, Placement::Rows]),
        max_nodes: 1000,
        assignment: random.below(4) == 0,
        ..Default::default()
    };
    Case { family, values, columns, items, k, options }
}

impl Case {
    fn solve(&self, method: CentersMethod) -> Result<Solution<Centers>, Error> {
        let options = CentersOptions { method, ..self.options };
        let points = Points::new(&self.values, self.columns).unwrap();
        centers(&points, self.k, &CentersOptions { inputs: self.items, ..options })
    }

    fn methods(&self) -> Vec<CentersMethod> {
        let is_plain = self.options.outliers == 0 && !self.options.weights;
        let mut methods = vec![CentersMethod::Tree, CentersMethod::FarthestFirst];
        if is_plain && self.options.placement == Placement::Free {
            methods.push(CentersMethod::Thesis);
        }
        if is_plain && self.items == Items::Points && !self.options.assignment {
            methods.push(CentersMethod::Stream(StreamingOptions::DEFAULT));
        }
        methods
    }

    /// Returns what is wrong with the answers, if anything.
    fn judge(&self) -> Result<(), String> {
        let points = Points::new(&self.values, self.columns).unwrap();
        let mut bounds = vec![];
        for method in self.methods() {
            let found = match self.solve(method) {
                Ok(found) => found,
                // What is no f64 cannot be answered.
                Err(Error::Overflow) => continue,
                Err(error) => return Err(format!("{method}: {error}")),
            };
            found.check(&points).map_err(|why| format!("{method}: {why}"))?;
            let (lower, upper) = (found.answer.lower_bound, found.answer.radius);
            let last =
                found.trace.history.last().map_or((0.0, f64::INFINITY), |b| (b.lower, b.upper));
            if last.0 > lower || last.1 < upper {
                return Err(format!(
                    "{method}: the history ends with {last:?}, not {lower}, {upper}"
                ));
            }
            let (gap, epsilon) = (found.certificate.gap, self.options.epsilon);
            let is_said = found.trace.stop == Stop::Converged;
            // Below 2e-11 it is for rounding to say.
            let is_true = if is_said { gap <= epsilon.max(2e-11) } else { gap > epsilon };
            let promises_gap = matches!(method, CentersMethod::Tree | CentersMethod::Thesis);
            if promises_gap && !is_true {
                return Err(format!(
                    "{method}: {:?} at {}",
                    found.trace.stop, found.certificate.gap
                ));
            }
            bounds.push((method, lower, upper));
        }
        for (method, lower, _) in &bounds {
            for (other, _, upper) in &bounds {
                if lower > upper {
                    return Err(format!("{lower} by {method}, {upper} by {other}"));
                }
            }
        }
        Ok(())
    }
}

#[test]
fn every_answer_is_confirmed() {
    let (count, mut wrong, mut overflows) = (long_or(2000, 600), vec![], 0);
    for seed in 0..count {
        let case = case(seed);
        overflows += u64::from(matches!(case.solve(CentersMethod::Tree), Err(Error::Overflow)));
        if let Err(why) = case.judge() {
            let Case { family, columns, items, k, options, .. } = &case;
            let n = case.values.len() / columns;
            wrong.push(format!("seed {seed}, {family}, {n} × {columns} {items:?}, k = {k}, z = {}, weights {}, {:?}, ε = {}: {why}", options.outliers, options.weights, options.placement, options.epsilon));
        }
    }
    assert!(overflows < count / 50, "{overflows} of {count} refused");
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn many_dimensions_end() {
    for (dim, k) in [(30, 2), (30, 3), (100, 2), (100, 3)] {
        let values: Vec<f64> = generate(Distribution::Normal, 200, dim, 5).unwrap();
        let points = Points::new(&values, dim).unwrap();
        let options = CentersOptions { max_nodes: 50, ..Default::default() };
        let found = centers(&points, k, &options).unwrap();
        let verdict = found.check(&points).unwrap();
        println!("{dim} {k} {:?} {}", found.trace, verdict.gap);
        assert!(verdict.gap < 0.5, "{}", verdict.gap);
    }
}

/// Rows far from the origin, and rows in other units, where that is exact: the same question.
#[test]
fn far_and_scaled_rows_have_the_same_radius() {
    for seed in 0..crate::test_length::long_or(60, 20) {
        let random = &mut Random(seed);
        let (dim, k) = (random.of(&[1, 2, 3, 10]), 1 + random.below(4) as usize);
        let z = random.below(2);
        let values: Vec<f64> = (0..24 * dim).map(|_| random.below(1000) as f64).collect();
        let options = CentersOptions { epsilon: 1e-9, outliers: z, ..Default::default() };
        let solve = |values: &[f64]| {
            let points = Points::new(values, dim).unwrap();
            let found = centers(&points, k, &options).unwrap();
            found.check(&points).unwrap();
            found.answer
        };
        let plain = solve(&values);
        let scaled = |factor: f64| values.iter().map(|x| x * factor).collect::<Vec<_>>();
        for factor in [2f64.powi(-800), 2f64.powi(-300), 2f64.powi(300), 2f64.powi(800)] {
            let other = solve(&scaled(factor));
            assert_eq!(other.radius, plain.radius * factor, "seed {seed} in units of {factor}");
        }
        for offset in [2f64.powi(30), -2f64.powi(40), 2f64.powi(50)] {
            let far: Vec<f64> = values.iter().map(|x| x + offset).collect();
            let other = solve(&far);
            assert!(other.lower_bound <= plain.radius && plain.lower_bound <= other.radius);
            // Centers are rounded to units of the offset, the bound is not.
            let unit = offset.abs() * f64::EPSILON * (dim as f64).sqrt();
            assert!(other.radius <= plain.radius * (1.0 + 1e-9) + unit, "seed {seed} at {offset}");
            assert!(
                other.lower_bound >= plain.lower_bound * (1.0 - 2e-9) - unit,
                "seed {seed} at {offset}: {} and {}",
                other.lower_bound,
                plain.lower_bound
            );
        }
    }
}

/// Places count by their coordinates, however near they are to each other.
#[test]
fn as_many_centers_as_places_leave_no_radius() {
    for near in [1e-20f64, 1e-160, 1e-200, 1e-300, 5e-324] {
        let values = [0.0, 0.0, near, 0.0, -0.0, 0.0, 1.0, 0.0, near, 0.0, 1.0, near];
        let points = Points::new(&values, 2).unwrap();
        for placement in [Placement::Free, Placement::Rows] {
            for method in [CentersMethod::Tree, CentersMethod::FarthestFirst] {
                for (k, outliers, wanted) in [
                    (4, 0, Some(0)),
                    (9, 0, Some(0)),
                    (3, 1, Some(1)),
                    (2, 2, Some(2)),
                    (3, 0, None),
                    (2, 1, None),
                ] {
                    let options =
                        CentersOptions { placement, method, outliers, ..Default::default() };
                    let found = centers(&points, k, &options).unwrap();
                    found.check(&points).unwrap();
                    let what = format!("{near}, {placement:?}, {method}, k = {k}, z = {outliers}");
                    assert_eq!(found.answer.radius == 0.0, wanted.is_some(), "{what}");
                    if let Some(count) = wanted {
                        assert_eq!(found.answer.outliers.len(), count, "{what}");
                        assert_eq!(found.trace.stop, Stop::Converged);
                    } else if method == CentersMethod::Tree {
                        let least = if placement == Placement::Free { near / 2.0 } else { near };
                        // A half of the least number there is, is rounded up.
                        assert!(
                            found.answer.radius <= (least * (1.0 + 1e-14)).max(5e-324),
                            "{what}"
                        );
                    }
                }
            }
        }
    }
}

/// Which center each point has, is no reason for other centers.
#[test]
fn an_assignment_leaves_the_centers_as_they_are() {
    for (n, dim, seed) in [(1, 2, 1), (500, 2, 2), (300, 7, 3)] {
        let values: Vec<f64> = generate(Distribution::Normal, n, dim, seed).unwrap();
        let points = Points::new(&values, dim).unwrap();
        for placement in [Placement::Free, Placement::Rows] {
            let method = CentersMethod::FarthestFirst;
            let options = CentersOptions { placement, method, ..Default::default() };
            let plain = centers(&points, 9, &options).unwrap();
            let told =
                centers(&points, 9, &CentersOptions { assignment: true, ..options }).unwrap();
            told.check(&points).unwrap();
            assert_eq!(told.answer.assignment.len(), n);
            assert_eq!(Centers { assignment: vec![], ..told.answer }, plain.answer);
            assert_eq!(told.certificate, plain.certificate);
        }
    }
}

/// What ended the work is said by its name.
#[test]
fn why_it_stopped() {
    let values: Vec<f64> = generate(Distribution::Normal, 200, 2, 1).unwrap();
    let stop = |values: &[f64], max_nodes, placement| {
        let points = Points::new(values, 2).unwrap();
        let options = CentersOptions { epsilon: 1e-9, max_nodes, placement, ..Default::default() };
        let found = centers(&points, 4, &options).unwrap();
        found.check(&points).unwrap();
        found.trace.stop
    };
    let far: Vec<f64> = values.iter().map(|x| x + 1e12).collect();
    for (placement, of_far) in
        [(Placement::Free, Stop::Rounding), (Placement::Rows, Stop::Converged)]
    {
        assert_eq!(stop(&values, 1_000_000, placement), Stop::Converged);
        assert_eq!(stop(&values, 3, placement), Stop::NodeBudget);
        assert_eq!(stop(&far, 1_000_000, placement), of_far);
    }
}
