//! Numbers of all sizes: whatever is answered is confirmed by the checker, and answers to one question agree.

use taut_certify::{Centers, Items, Placement, Solution, Stop};
use taut_enclose::{CentersMethod, CentersOptions, Error, centers, centers_of_source};
use taut_points::{Distribution, Monitor, Points, generate};

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
    seed: u64,
    family: &'static str,
    values: Vec<f64>,
    columns: usize,
    items: Items,
    k: usize,
    options: CentersOptions,
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
    Case { seed, family, values, columns, items, k, options }
}

impl Case {
    fn solve(&self, method: CentersMethod) -> Result<Solution<Centers>, Error> {
        let options = CentersOptions { method, ..self.options };
        let points = Points::new(&self.values, self.columns).unwrap();
        centers_of_source(&points, self.items, self.k, &options, &Monitor::silent())
    }

    fn methods(&self) -> Vec<CentersMethod> {
        let is_plain = self.options.outliers == 0 && !self.options.weights;
        let has_thesis = is_plain && self.options.placement == Placement::Free;
        CentersMethod::ALL
            .into_iter()
            .filter(|&method| method != CentersMethod::Thesis || has_thesis)
            .collect()
    }

    /// What is wrong with the answers, if anything.
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
            let wanted = self.options.epsilon.max(2e-11) * (1.0 + 1e-9);
            let is_reached = found.certificate.gap <= wanted;
            if method != CentersMethod::FarthestFirst
                && is_reached != (found.trace.stop == Stop::Converged)
            {
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
    let count = std::env::var("CASES").map_or(1500, |c| c.parse().unwrap());
    let mut wrong = vec![];
    let mut overflows = 0;
    for seed in 0..count {
        let case = case(seed);
        if std::env::var_os("TRACE").is_some() { eprintln!("at {seed}"); }
        overflows += u64::from(matches!(case.solve(CentersMethod::Tree), Err(Error::Overflow)));
        if let Err(why) = case.judge() {
            let Case { family, columns, items, k, options, .. } = &case;
            let n = case.values.len() / columns;
            wrong.push(format!("seed {seed}, {family}, {n} × {columns} {items:?}, k = {k}, z = {}, weights {}, {:?}, ε = {}: {why}", options.outliers, options.weights, options.placement, options.epsilon));
        }
    }
    println!("{overflows} of {count} refused");
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

#[test]
#[ignore]
fn debug() {
    for seed in std::env::var("SEEDS").unwrap().split(',') {
        let case = case(seed.parse().unwrap());
        println!("{case:?}");
        for method in case.methods() {
            println!("{:?}\n", case.solve(method));
        }
        println!("{:?}", case.judge());
    }
}
