//! Solutions from parts: the bytes of those in memory however rows are divided, and what is refused.

use taut_certify::{AnySolution, CheckError, Items, PartialVerdict, Placement, RobustMethod};
use taut_enclose::passes::{Partial, Query, RobustSolver, Solver};
use taut_enclose::{
    BallMethod, BallOptions, CentersMethod, CentersOptions, EllipsoidMethod, EllipsoidOptions,
    Error, RobustInParts, RobustOptions, StreamingCenters, StreamingOptions, ball, centers,
    ellipsoid, robust_ellipsoid,
};
use taut_points::{
    Blocks, Distribution, Monitor, PartsError, PointSource, Points, Scalar, generate,
};

use crate::test_length::long_or;

/// In how many parts a set is dealt.
fn counts() -> &'static [u64] {
    long_or(&[1, 4, 7, 16], &[1, 16])
}

/// The whole blocks of a set, dealt to `count` parts of about as many each; some are empty where there are fewer.
fn parts<'a, T: Scalar>(points: &Points<'a, T>, count: u64) -> Vec<(u64, Points<'a, T>)> {
    let blocks = Blocks::of(points);
    let cut = |part: u64| match part * blocks.count() / count {
        at if at == blocks.count() => PointSource::len(points),
        at => blocks.range(at).start,
    };
    let part = |i| (cut(i), points.slice(cut(i) as usize..cut(i + 1) as usize));
    (0..count).map(part).collect()
}

/// The answer of all parts. The query and partials go through their bytes; partials are merged from both ends by turns.
fn answered<T: Scalar>(query: &Query, parts: &[(u64, Points<'_, T>)]) -> Result<Partial, Error> {
    let query = Query::from_bytes(&query.to_bytes()).unwrap();
    let mut merged = Partial::none(&query);
    for (turn, (first_row, part)) in parts.iter().rev().enumerate() {
        let partial = query.run(part, *first_row, &Monitor::silent())?;
        let partial = Partial::from_bytes(&partial.to_bytes()).unwrap();
        merged = if turn % 2 == 0 { merged.merge(partial)? } else { partial.merge(merged)? };
    }
    Ok(merged)
}

fn solve<T: Scalar>(
    mut solver: Solver,
    parts: &[(u64, Points<'_, T>)],
) -> Result<AnySolution, Error> {
    let monitor = Monitor::silent();
    while let Some(query) = solver.query(&monitor).unwrap() {
        let answer = answered(query, parts)?;
        solver.feed(answer)?;
    }
    solver.solution(&monitor)
}

fn solve_robust<T: Scalar>(
    options: RobustOptions<'static>,
    parts: &[(u64, Points<'_, T>)],
) -> Result<RobustInParts, Error> {
    let n = parts.iter().map(|(_, part)| PointSource::len(part)).sum();
    let (mut solver, monitor) =
        (RobustSolver::new(n, parts[0].1.dim(), options)?, Monitor::silent());
    while let Some(query) = solver.query(&monitor).unwrap() {
        let answer = answered(query, parts)?;
        solver.feed(answer)?;
    }
    solver.solution(&monitor)
}

/// Point sets of several blocks, most with ties or copies.
fn sets() -> Vec<(String, usize, Vec<f64>)> {
    let mut sets = vec![];
    let mut add = |name: &str, dim: usize, values: Vec<f64>| {
        sets.push((format!("{name} in dimension {dim}"), dim, values));
    };
    for (dim, many, few) in [(1, 3, 2), (2, 5, 2), (3, 9, 2), (10, 17, 3), (100, 7, 2)] {
        let blocks = long_or(many, few);
        let n = blocks * (Blocks::VALUES / dim) - 5;
        for (name, distribution) in [
            ("normal", Distribution::Normal),
            ("cube", Distribution::CubeVertices),
            ("sphere", Distribution::Sphere),
            ("lattice", Distribution::Poisson),
            ("grid", Distribution::Grid { side: 9, angle: 0.0 }),
        ]
        .into_iter()
        .step_by(long_or(1, 2))
        {
            let n = if dim == 100 && name != "lattice" { 1500 } else { n };
            add(name, dim, generate(distribution, n, dim, 5).unwrap());
        }
    }
    let normal = || generate::<f64>(Distribution::Normal, 100_000, 2, 6).unwrap();
    add("huge", 2, normal().into_iter().map(|x| x * 1e200).collect());
    add("tiny", 2, normal().into_iter().map(|x| x * 1e-200).collect());
    add("far off", 2, normal().into_iter().map(|x| x + 1e9).collect());
    add("huge and far off", 2, normal().into_iter().map(|x| 1e300 + x * 1e290).collect());
    add("one point often", 3, vec![0.25; 90_000]);
    add("one point", 3, vec![1.0, 2.0, 3.0]);
    add("copies of two", 2, (0..200_000).map(|i| f64::from(i / 2 % 2)).collect());
    sets
}

#[test]
fn balls_have_the_bytes_of_those_in_memory() {
    let sets = sets();
    assert!(sets.len() >= long_or(30, 22));
    for (name, dim, values) in &sets {
        let points = Points::new(values, *dim).unwrap();
        let n = PointSource::len(&points);
        let wanted = ball(&points, &BallOptions::default()).unwrap().to_json();
        for &count in counts() {
            let solver = Solver::ball(n, *dim, BallOptions::default()).unwrap();
            let found = solve(solver, &parts(&points, count)).unwrap();
            assert_eq!(found.to_json(), wanted, "{name}, {count} parts");
        }
    }
}

#[test]
fn ellipsoids_have_the_bytes_of_those_in_memory() {
    let options = EllipsoidOptions::default();
    let (mut solved, mut flat) = (0, 0);
    for (name, dim, values) in sets().iter().filter(|set| set.1 <= 10) {
        let points = Points::new(values, *dim).unwrap();
        let n = PointSource::len(&points);
        let wanted = ellipsoid(&points, &options).map(|found| found.to_json());
        for &count in counts() {
            let solver = Solver::ellipsoid(n, *dim, options.clone()).unwrap();
            match (solve(solver, &parts(&points, count)), &wanted) {
                (Ok(found), Ok(wanted)) => {
                    solved += 1;
                    assert_eq!(&found.to_json(), wanted, "{name}, {count} parts");
                }
                (Err(Error::FlatInParts { .. }), Ok(_)) => flat += 1,
                (Err(found), Err(wanted)) => {
                    assert_eq!(found.to_string(), wanted.to_string(), "{name}");
                }
                (found, wanted) => panic!("{name}: {found:?}, in memory {wanted:?}"),
            }
        }
    }
    // One point, often or once, and two.
    let ways = counts().len();
    assert!(solved >= ways * long_or(20, 12) && flat == ways * 3, "{solved} solved, {flat} flat");
    let thesis = EllipsoidOptions { method: EllipsoidMethod::ThesisInitial, ..options };
    let refused = Solver::ellipsoid(10, 2, thesis).unwrap_err().to_string();
    assert!(refused.contains("expected newton"), "{refused}");
}

/// What the checker says of a solution, from parts that are merged last first.
fn verdict<T: Scalar>(
    solution: &AnySolution,
    parts: &[(u64, Points<'_, T>)],
) -> Result<String, CheckError> {
    let (monitor, mut merged) = (Monitor::silent(), None::<PartialVerdict>);
    let n = parts.iter().map(|(_, part)| PointSource::len(part)).sum();
    for (first_row, part) in parts.iter().rev() {
        let found = solution.check_part(part, *first_row, n, &monitor)?;
        let found = PartialVerdict::from_bytes(&found.to_bytes()).unwrap();
        merged = Some(match merged {
            Some(merged) => merged.merge(found)?,
            None => found,
        });
    }
    Ok(format!("{:?}", solution.check_parts(&merged.unwrap(), &monitor)?))
}

#[test]
fn centers_of_streams_have_the_bytes_and_verdicts_of_those_in_memory() {
    let method = CentersMethod::Stream(StreamingOptions::DEFAULT);
    let monitor = Monitor::silent();
    let sets = sets();
    let few = sets.iter().filter(|set| set.2.len() < 500_000);
    for (number, (name, dim, values)) in few.enumerate() {
        let points = Points::new(values, *dim).unwrap();
        let ways = [(7, Placement::Rows), (1, Placement::Free)];
        let first = long_or(0, number % 2);
        for (k, placement) in ways.into_iter().skip(first).step_by(long_or(1, 2)) {
            let options = CentersOptions { method, placement, ..Default::default() };
            let wanted = centers(&points, k, &options).map(AnySolution::from);
            for &count in long_or(&[1, 7][..], &[7]) {
                let parts = parts(&points, count);
                let mut cover = StreamingCenters::new(*dim, k, &StreamingOptions::DEFAULT).unwrap();
                let added = parts.iter().try_for_each(|(_, part)| {
                    cover.add_source(part, &monitor)?;
                    cover = StreamingCenters::from_bytes(&cover.to_bytes())?;
                    Ok::<_, Error>(())
                });
                let found = added.and_then(|()| solve(Solver::centers(cover, placement), &parts));
                match (found, &wanted) {
                    (Ok(found), Ok(wanted)) => {
                        assert_eq!(found.to_json(), wanted.to_json(), "{name}, {count} parts");
                        let said = format!("{:?}", wanted.check(&points, &monitor).unwrap());
                        assert_eq!(verdict(&found, &parts).unwrap(), said, "{name}");
                    }
                    (Err(found), Err(wanted)) => {
                        assert_eq!(found.to_string(), wanted.to_string(), "{name}");
                    }
                    (found, wanted) => panic!("{name}: {found:?}, in memory {wanted:?}"),
                }
            }
        }
    }
}

#[test]
fn traversals_have_the_answers_and_certificates_of_those_in_memory() {
    let (monitor, mut compared) = (Monitor::silent(), 0);
    for (name, dim, values) in &sets() {
        let points = Points::new(values, *dim).unwrap();
        let n = PointSource::len(&points);
        for (k, placement) in [(1, Placement::Free), (9, Placement::Rows)] {
            let method = CentersMethod::FarthestFirst;
            let options = CentersOptions { method, placement, ..Default::default() };
            let wanted = centers(&points, k, &options);
            for &count in long_or(&[1, 7][..], &[7]) {
                let parts = parts(&points, count);
                let solver = Solver::k_centers(n, *dim, k, options).unwrap();
                match (solve(solver, &parts), &wanted) {
                    (Ok(AnySolution::Centers(found)), Ok(wanted)) => {
                        compared += 1;
                        assert_eq!(found.answer, wanted.answer, "{name}, {count} parts");
                        assert_eq!(found.certificate, wanted.certificate, "{name}, {count} parts");
                        // The extent, then at most one for each center.
                        assert!(found.trace.passes <= 2 + k as u64, "{name}: {:?}", found.trace);
                        let said = format!("{:?}", wanted.check(&points).unwrap());
                        let solution = AnySolution::from(found);
                        assert!(verdict(&solution, &parts).unwrap().contains(&said), "{name}");
                        solution.check(&points, &monitor).unwrap();
                    }
                    (Err(found), Err(wanted)) => {
                        assert_eq!(found.to_string(), wanted.to_string(), "{name}");
                    }
                    (found, wanted) => panic!("{name}: {found:?}, in memory {wanted:?}"),
                }
            }
        }
    }
    assert!(compared >= long_or(100, 30), "{compared} compared");
}

#[test]
fn centers_to_a_gap_are_found_over_a_core_set_and_proved_in_parts() {
    let monitor = Monitor::silent();
    let mut solved = 0;
    // Three balls around a circle or a sphere may turn: a core-set takes hundreds of rounds.
    let is_quick = |set: &&(String, usize, Vec<f64>)| set.1 <= 3 && !set.0.starts_with("sphere");
    for (number, (name, dim, values)) in sets().iter().filter(is_quick).enumerate() {
        let points = Points::new(values, *dim).unwrap();
        let n = PointSource::len(&points);
        let ways = [(3, 0.01), (1, 1e-6)];
        let first = long_or(0, number % 2);
        for (k, epsilon) in ways.into_iter().skip(first).step_by(long_or(1, 2)) {
            let options = CentersOptions { epsilon, ..Default::default() };
            let mut bytes: Option<String> = None;
            for count in [1, 7] {
                let parts = parts(&points, count);
                let solver = Solver::k_centers(n, *dim, k, options).unwrap();
                let found = match solve(solver, &parts) {
                    Ok(found) => found,
                    Err(Error::Overflow) if name.contains("huge") => continue,
                    Err(error) => panic!("{name}, {k} centers: {error}"),
                };
                let json = found.to_json();
                assert_eq!(bytes.get_or_insert(json.clone()), &json, "{name}, {count} parts");
                let AnySolution::Centers(centers) = &found else { panic!("{name}: {found:?}") };
                assert!(centers.certificate.gap <= epsilon, "{name}: {:?}", centers.certificate);
                let said = format!("{:?}", found.check(&points, &monitor).unwrap());
                assert_eq!(verdict(&found, &parts).unwrap(), said, "{name}");
                // Most rows were looked at by passes alone.
                assert!(centers.certificate.core_set.len() < 1000, "{name}");
                solved += 1;
            }
        }
    }
    assert!(solved >= long_or(50, 20), "{solved} solved");
    let refused = |options| Solver::k_centers(10, 2, 2, options).unwrap_err().to_string();
    let plain = CentersOptions::default;
    let stream = CentersMethod::Stream(StreamingOptions::DEFAULT);
    for (options, words) in [
        (CentersOptions { method: stream, ..plain() }, "tree or farthest-first"),
        (CentersOptions { outliers: 1, ..plain() }, "neither groups, outliers"),
        (CentersOptions { assignment: true, ..plain() }, "neither groups, outliers"),
        (CentersOptions { weights: true, ..plain() }, "without weights"),
        (CentersOptions { inputs: Items::Balls, ..plain() }, "without weights"),
        (CentersOptions { placement: Placement::Rows, ..plain() }, "free for a search"),
        (CentersOptions { epsilon: 2.0, ..plain() }, "epsilon"),
    ] {
        assert!(refused(options).contains(words), "{}", refused(options));
    }
}

/// Normal points, of which three in ten are moved far off, not all to one place.
fn contaminated(n: usize, dim: usize) -> Vec<f64> {
    let mut values = generate::<f64>(Distribution::Normal, n, dim, 8).unwrap();
    for (row, values) in values.chunks_exact_mut(dim).enumerate() {
        if row % 10 < 3 {
            values.iter_mut().for_each(|x| *x = 0.3 * *x + 20.0 + (row % 3) as f64);
        }
    }
    values
}

#[test]
fn robust_ellipsoids_of_parts_bear_outliers_whatever_the_parts() {
    let first = (long_or(9000, 4000), 2, Some(0.6));
    let sizes = [first, (60_000, 3, None), (40_000, 10, None)];
    for (n, dim, coverage) in sizes.into_iter().take(long_or(usize::MAX, 1)) {
        let values = contaminated(n, dim);
        let points = Points::new(&values, dim).unwrap();
        let options = RobustOptions { coverage, ..Default::default() };
        let found = solve_robust(options.clone(), &parts(&points, 1)).unwrap();
        for &count in counts() {
            assert_eq!(solve_robust(options.clone(), &parts(&points, count)).unwrap(), found);
        }
        let wanted = robust_ellipsoid(&points, &options).unwrap();
        // Both are local optima of the same; the search in memory also exchanges points at the border.
        let (here, there) = (found.objective, wanted.certificate.objective);
        assert!((here - there).abs() < 1e-3, "{here}, in memory {there}");
        assert_eq!(found.kept, wanted.certificate.kept);
        assert_eq!(found.points_hash, wanted.certificate.points_hash);
        for (a, b) in found.answer.center.iter().zip(&wanted.answer.center) {
            assert!((a - b).abs() < 1e-2, "{a}, in memory {b}");
        }
        assert!((found.answer.log_volume - wanted.answer.log_volume).abs() < 1e-2);
        // The rows kept are the nearest in the metric that they say: the determinant is that of what is weighed, not of all.
        assert!(
            found.weighed < (0.71 * n as f64) as u64 && found.weighed > (0.6 * n as f64) as u64
        );
    }
}

#[test]
fn robust_ellipsoids_of_ties_and_flats_in_parts() {
    // Each place has a thousand rows and more: no shell has few of them.
    let normal = generate::<f64>(Distribution::Normal, 100_000, 2, 9).unwrap();
    let values: Vec<f64> = normal.into_iter().map(f64::round).collect();
    let points = Points::new(&values, 2).unwrap();
    let found = solve_robust(RobustOptions::default(), &parts(&points, 1)).unwrap();
    assert!(found.kept > 50_001, "{} kept: ties are kept as a whole", found.kept);
    assert_eq!(solve_robust(RobustOptions::default(), &parts(&points, 4)).unwrap(), found);
    // All rows: the mean and covariance.
    let all = RobustOptions { coverage: Some(1.0), ..Default::default() };
    let found = solve_robust(all.clone(), &parts(&points, 2)).unwrap();
    let wanted = robust_ellipsoid(&points, &all).unwrap();
    assert_eq!((found.kept, found.weighed), (100_000, 100_000));
    assert!((found.objective - wanted.certificate.objective).abs() < 1e-9);
    let flat: Vec<f64> = (0..100_000).flat_map(|i| [f64::from(i % 997), 5.0]).collect();
    let points = Points::new(&flat, 2).unwrap();
    let refused = solve_robust(RobustOptions::default(), &parts(&points, 2)).unwrap_err();
    assert!(matches!(refused, Error::MostFlatInParts), "{refused}");
    let mut odd = contaminated(40_000, 2);
    odd[2 * 39_990 + 1] = f64::NAN;
    let points = Points::new(&odd, 2).unwrap();
    let refused =
        solve_robust(RobustOptions::default(), &parts(&points, 2)).unwrap_err().to_string();
    assert!(refused.contains("39990"), "{refused}");
    let mve = RobustOptions { method: RobustMethod::Mve, ..Default::default() };
    assert!(RobustSolver::new(10, 2, mve).unwrap_err().to_string().contains("expected mcd"));
}

#[test]
fn forged_answers_are_refused_in_parts_with_the_row() {
    let monitor = Monitor::silent();
    let values: Vec<f64> = generate(Distribution::Normal, 100_000, 2, 3).unwrap();
    let points = Points::new(&values, 2).unwrap();
    let parts = parts(&points, 4);
    let mut forged = vec![];
    let mut found = ball(&points, &BallOptions::default()).unwrap();
    found.answer.radius *= 0.999;
    forged.push(AnySolution::from(found));
    let mut found = ellipsoid(&points, &EllipsoidOptions::default()).unwrap();
    found.answer.center[0] += 0.01;
    forged.push(AnySolution::from(found));
    let method = CentersMethod::Stream(StreamingOptions::DEFAULT);
    let options = CentersOptions { method, ..Default::default() };
    let mut found = centers(&points, 3, &options).unwrap();
    found.answer.radius *= 0.999;
    found.answer.lower_bound = 0.0;
    found.certificate.gap = f64::MAX;
    forged.push(AnySolution::from(found));
    for solution in forged {
        let wanted = solution.check(&points, &monitor).unwrap_err().to_string();
        assert_eq!(verdict(&solution, &parts).unwrap_err().to_string(), wanted);
        assert!(wanted.starts_with("point "), "{wanted}");
    }
    let options = CentersOptions { assignment: true, ..Default::default() };
    let found = AnySolution::from(centers(&points, 2, &options).unwrap());
    let refused = verdict(&found, &parts).unwrap_err().to_string();
    assert!(refused.contains("centers with an assignment"), "{refused}");
}

#[test]
fn balls_of_balls_single_precision_and_other_methods_too() {
    let values: Vec<f64> = generate(Distribution::Uniform, 70_000, 4, 8).unwrap();
    let points = Points::new(&values, 4).unwrap();
    let narrow: Vec<f32> = values.iter().map(|&x| x as f32).collect();
    let narrow = Points::new(&narrow, 4).unwrap();
    for (inputs, method, epsilon) in [
        (Items::Points, BallMethod::CoreSet, 0.0),
        (Items::Balls, BallMethod::CoreSet, 1e-9),
        (Items::Points, BallMethod::BadoiuClarkson, 0.05),
    ] {
        let options = BallOptions { inputs, method, epsilon, ..Default::default() };
        let solver = || Solver::ball(70_000, 4, options.clone()).unwrap();
        let found = solve(solver(), &parts(&points, 3)).unwrap();
        assert_eq!(found.to_json(), ball(&points, &options).unwrap().to_json());
        let found = solve(solver(), &parts(&narrow, 3)).unwrap();
        assert_eq!(found.to_json(), ball(&narrow, &options).unwrap().to_json());
    }
}

#[test]
fn parts_that_do_not_belong_together_are_refused() {
    let monitor = Monitor::silent();
    let values: Vec<f64> = generate(Distribution::Normal, 100_000, 2, 1).unwrap();
    let points = Points::new(&values, 2).unwrap();
    let parts = parts(&points, 4);
    let mut solver = Solver::ball(100_000, 2, BallOptions::default()).unwrap();
    let rows = solver.query(&monitor).unwrap().unwrap().clone();
    assert!(!rows.is_pass());
    let run = |query: &Query, part: usize| query.run(&parts[part].1, parts[part].0, &monitor);
    let all = |query: &Query| {
        (0..4).fold(Partial::none(query), |all, part| all.merge(run(query, part).unwrap()).unwrap())
    };
    assert_eq!(solver.feed(Partial::none(&rows)), Err(PartsError::Missing { row: 0 }));
    solver.feed(all(&rows)).unwrap();
    assert_eq!(solver.feed(all(&rows)), Err(PartsError::Question));
    let first = solver.query(&monitor).unwrap().unwrap().clone();
    assert!(first.is_pass());
    assert_eq!(solver.feed(all(&rows)), Err(PartsError::Question));
    let (a, b) = (run(&first, 0).unwrap(), run(&first, 2).unwrap());
    assert_eq!(a.clone().merge(a.clone()), Err(PartsError::Twice { row: 0 }));
    assert_eq!(a.clone().merge(run(&rows, 1).unwrap()), Err(PartsError::Question));
    let missing = PartsError::Missing { row: parts[1].0 };
    assert_eq!(solver.feed(a.merge(b).unwrap()), Err(missing));

    let is_boundary =
        |ran: Result<Partial, Error>| matches!(ran, Err(Error::Parts(PartsError::Boundary { .. })));
    assert!(is_boundary(first.run(&points.slice(0..7), 0, &monitor)));
    assert!(is_boundary(first.run(&parts[0].1, 1, &monitor)));
    assert!(is_boundary(first.run(&points, parts[1].0, &monitor)));
    let line = Points::new(&values, 1).unwrap();
    let columns = PartsError::Columns { found: 1, expected: 2 };
    assert!(matches!(first.run(&line, 0, &monitor), Err(Error::Parts(e)) if e == columns));

    // Bytes of other kernels: the number of the set is the second behind the head.
    let bytes = run(&first, 1).unwrap().to_bytes();
    let at = bytes.iter().position(|&b| b == b'\n').unwrap() + 9;
    let mut other = bytes.clone();
    other[at] = if bytes[at] == 0 { 2 } else { 0 };
    let other = Partial::from_bytes(&other).unwrap();
    assert!(matches!(all(&rows).merge(other.clone()), Err(PartsError::Question)));
    let merged = run(&first, 0).unwrap().merge(other);
    assert!(matches!(merged, Err(PartsError::Kernels { .. })));
    for end in [0, at, bytes.len() - 1] {
        assert!(Partial::from_bytes(&bytes[..end]).is_err());
    }

    solver.feed(all(&first)).unwrap();
    let mut values = values.clone();
    values[70_001] = f64::NAN;
    let damaged = Points::new(&values, 2).unwrap();
    let ran = first.run(&damaged.slice(32768..65536), 32768, &monitor);
    let message = ran.unwrap_err().to_string();
    assert!(message.contains("coordinate 1 of point 35000"), "{message}");
}

/// A solver that nobody feeds any more ends, and so do those in all states.
#[test]
fn a_solver_can_be_dropped_at_any_time() {
    let monitor = Monitor::silent();
    let values: Vec<f64> = generate(Distribution::Sphere, 3000, 3, 1).unwrap();
    let points = Points::new(&values, 3).unwrap();
    for steps in 0..4 {
        let mut solver = Solver::ball(3000, 3, BallOptions::default()).unwrap();
        for _ in 0..steps {
            let query = solver.query(&monitor).unwrap().unwrap();
            let partial = query.run(&points, 0, &monitor).unwrap();
            solver.feed(partial).unwrap();
        }
        if steps == 2 {
            let open = solver.solution(&monitor).unwrap_err();
            assert!(matches!(open, Error::Parts(PartsError::Open)));
        }
    }
    let empty = Solver::ball(0, 3, BallOptions::default()).unwrap();
    assert!(matches!(empty.solution(&monitor), Err(Error::Empty)));
}
