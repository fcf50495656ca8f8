//! A checker is worth what it rejects: every number and every list of a robust ellipsoid, doctored one at a time.

use robust::{by, classical, contaminated, normal, solve};
use taut_certify::{
    CheckError, RobustEllipsoid, RobustMethod, RobustScale, Solution, Unweighted, Violation,
};
use taut_enclose::RobustOptions;
use taut_points::Points;

use crate::robust;

type Solved = Solution<RobustEllipsoid>;

/// A change of one thing.
struct Mutation {
    name: String,
    apply: Box<dyn Fn(&mut Solved)>,
}

fn mutation(name: impl Into<String>, apply: impl Fn(&mut Solved) + 'static) -> Mutation {
    Mutation { name: name.into(), apply: Box::new(apply) }
}

/// A number made a little larger or smaller: by `part` of `size`.
type Number = fn(&mut Solved, usize) -> &mut f64;

fn numbers(found: &Solved) -> Vec<Mutation> {
    let (dim, rank) = (found.answer.center.len(), found.answer.factor.len());
    let tables: [(&str, Number, usize); 3] = [
        ("matrix", |f, at| entry(&mut f.answer.matrix, at), dim * dim),
        ("factor", |f, at| entry(&mut f.answer.factor, at), rank * dim),
        ("scatter", |f, at| entry(&mut f.answer.scatter, at), dim * dim),
    ];
    let mut all = vec![];
    for (name, number, count) in tables {
        let mut copy = found.clone();
        let largest = (0..count).map(|at| number(&mut copy, at).abs()).fold(0.0, f64::max);
        for at in 0..count {
            for part in [1e-5, -1e-5, 1.0, f64::NAN, f64::INFINITY] {
                all.push(mutation(format!("{name} {at} by {part}"), move |found| {
                    *number(found, at) += part * largest;
                }));
            }
        }
    }
    let deviation = |a: usize| found.answer.scatter[a][a].sqrt();
    for at in 0..dim {
        let size = deviation(at).max(1e-3);
        for part in [1e-5, -1e-5, 1.0, -3.0, f64::NAN] {
            all.push(mutation(format!("center {at} by {part}"), move |found| {
                found.answer.center[at] += part * size;
            }));
        }
    }
    let single: [(&str, Number); 8] = [
        ("log-volume", |f, _| &mut f.answer.log_volume),
        ("log-determinant", |f, _| &mut f.answer.log_det),
        ("objective", |f, _| &mut f.certificate.objective),
        ("level", |f, _| &mut f.certificate.level),
        ("cutoff", |f, _| &mut f.certificate.cutoff),
        ("raw scale", |f, _| &mut f.certificate.raw_scale),
        ("scale", |f, _| &mut f.certificate.scale),
        ("distance of the hull", |f, _| {
            f.answer.hull.as_mut().map_or(&mut f.answer.log_det, |hull| &mut hull.distance)
        }),
    ];
    for (name, number) in single {
        for part in [1e-5, -1e-5, 0.3, -2.0, f64::NAN, f64::NEG_INFINITY] {
            all.push(mutation(format!("{name} by {part}"), move |found| {
                let number = number(found, 0);
                *number += part * number.abs().max(1.0);
            }));
        }
    }
    all
}

fn entry(table: &mut [Vec<f64>], at: usize) -> &mut f64 {
    let columns = table[0].len();
    &mut table[at / columns][at % columns]
}

/// Rows taken from and added to lists, one by one.
fn lists(found: &Solved, n: u64) -> Vec<Mutation> {
    type List = fn(&mut Solved) -> &mut Vec<u64>;
    let mut all = vec![];
    let lists: [(&str, List); 3] = [
        ("outliers", |f| &mut f.answer.outliers),
        ("left out", |f| &mut f.certificate.left_out),
        ("weighed out", |f| &mut f.certificate.weighed_out),
    ];
    for (name, list) in lists {
        let rows = list(&mut found.clone()).clone();
        for row in 0..n {
            let at = rows.partition_point(|&other| other < row);
            let is_in = rows.get(at) == Some(&row);
            all.push(mutation(format!("{name}: {row}"), move |found| {
                let rows = list(found);
                if is_in {
                    rows.remove(at);
                } else {
                    rows.insert(at, row);
                }
            }));
        }
        if rows.len() > 1 {
            all.push(mutation(format!("{name}: reversed"), move |found| list(found).reverse()));
        }
        all.push(mutation(format!("{name}: beyond"), move |found| list(found).push(n)));
        // One row for another.
        for (i, row) in (0..n).filter(|row| !rows.contains(row)).enumerate().take(20) {
            if rows.is_empty() {
                break;
            }
            let at = i % rows.len();
            all.push(mutation(format!("{name}: {row} for {}", rows[at]), move |found| {
                let rows = list(found);
                rows[at] = row;
                rows.sort_unstable();
            }));
        }
    }
    all
}

fn others(found: &Solved) -> Vec<Mutation> {
    let mut all = vec![
        mutation("one more kept", |f| f.certificate.kept += 1),
        mutation("one less kept", |f| f.certificate.kept -= 1),
        mutation("nothing kept", |f| f.certificate.kept = 0),
        mutation("hash", |f| f.certificate.points_hash.0 ^= 1),
        mutation("no center", |f| f.answer.center.clear()),
        mutation("a row of the matrix", |f| _ = f.answer.matrix.pop()),
        mutation("a row of the factor", |f| _ = f.answer.factor.pop()),
        mutation("a number of the factor", |f| _ = f.answer.factor[0].pop()),
        mutation("a row of the scatter", |f| _ = f.answer.scatter.pop()),
        mutation("an asymmetric scatter", |f| f.answer.scatter[0][1] *= 1.0 + 1e-14),
        mutation("tail", |f| f.answer.center_tail = vec![1.0]),
        mutation("another enclosure", |f| match &mut f.certificate.enclosure {
            Some(enclosure) => enclosure.ellipsoid.center[0] += 1e-3,
            none => {
                let ellipsoid = f.answer.ellipsoid();
                let certificate = taut_certify::EllipsoidCertificate {
                    items: taut_certify::Items::Points,
                    support: vec![],
                    multipliers: vec![],
                    directions: vec![],
                    left_out: f.certificate.left_out.clone(),
                    gap: 0.0,
                    points_hash: f.certificate.points_hash,
                };
                *none = Some(taut_certify::Enclosure { ellipsoid, certificate });
            }
        }),
    ];
    for scale in RobustScale::ALL {
        all.push(mutation(format!("scaled by {scale}"), move |f| f.certificate.scaled_by = scale));
    }
    for method in RobustMethod::ALL {
        if method != found.certificate.method {
            all.push(mutation(format!("by {method}"), move |f| f.certificate.method = method));
        }
    }
    if found.certificate.enclosure.is_some() {
        all.push(mutation("no enclosure", |f| f.certificate.enclosure = None));
        all.push(mutation("a tighter gap", |f| {
            f.certificate.enclosure.as_mut().unwrap().certificate.gap = 0.0;
            f.certificate.enclosure.as_mut().unwrap().certificate.multipliers[0] *= 1.0 + 1e-3;
        }));
    }
    if found.answer.hull.is_some() {
        all.push(mutation("no hull", |f| f.answer.hull = None));
        all.push(mutation("a turned hull", |f| {
            let hull = f.answer.hull.as_mut().unwrap();
            hull.basis[0][0] += 1e-4;
        }));
    }
    all
}

#[test]
fn every_doctored_answer_is_rejected() {
    let n = 60;
    let mut flat = normal(n, 3, 4);
    for row in flat.chunks_mut(3).take(45) {
        row[2] = row[0] - row[1];
    }
    let plain = contaminated(n, 3, 18, 8.0, 4);
    let mut tried = 0;
    for (name, values, method, coverage, scale) in [
        ("mcd", &plain, RobustMethod::Mcd, None, RobustScale::Share),
        ("mve", &plain, RobustMethod::Mve, None, RobustScale::Share),
        ("trim", &plain, RobustMethod::Trim, Some(0.8), RobustScale::Share),
        ("mcd of all", &plain, RobustMethod::Mcd, Some(1.0), RobustScale::Share),
        ("flat mcd", &flat, RobustMethod::Mcd, None, RobustScale::Share),
        ("flat mve", &flat, RobustMethod::Mve, None, RobustScale::Share),
        ("mcd by level", &plain, RobustMethod::Mcd, None, RobustScale::Level),
        ("mve by level", &plain, RobustMethod::Mve, None, RobustScale::Level),
    ] {
        let options = RobustOptions { coverage, scale, ..by(method) };
        let found = solve(name, values, 3, &options);
        let points = Points::new(values, 3).unwrap();
        let mutations =
            numbers(&found).into_iter().chain(lists(&found, n as u64)).chain(others(&found));
        for Mutation { name: change, apply } in mutations {
            let mut doctored = found.clone();
            apply(&mut doctored);
            if doctored == found {
                continue; // an infinite number of infinite size, or nothing to change
            }
            assert!(doctored.check(&points).is_err(), "{name}: {change} is accepted");
            tried += 1;
        }
    }
    assert!(tried > 1000, "{tried}");
}

/// An answer by hand, in the plane, for any rows kept: right in all but, perhaps, the choice of the rows.
fn by_hand(found: &Solved, values: &[f64], kept: &[u64]) -> Solved {
    let rows: Vec<f64> =
        kept.iter().flat_map(|&row| values[2 * row as usize..][..2].to_vec()).collect();
    let (center, covariance) = classical(&rows, 2);
    let mut made = found.clone();
    let (scale, cutoff) = (found.certificate.raw_scale, found.certificate.cutoff);
    let scatter: Vec<Vec<f64>> =
        covariance.iter().map(|row| row.iter().map(|v| v * scale).collect()).collect();
    // F = L⁻¹/√cutoff for S = LL′.
    let a = scatter[0][0].sqrt();
    let b = scatter[1][0] / a;
    let c = (scatter[1][1] - b * b).sqrt();
    let border = cutoff.sqrt();
    let factor = vec![vec![1.0 / a / border, 0.0], vec![-b / (a * c) / border, 1.0 / c / border]];
    let entry = |i: usize, j: usize| factor.iter().map(|row| row[i] * row[j]).sum::<f64>();
    let off = entry(1, 0);
    made.answer.matrix = vec![vec![entry(0, 0), off], vec![off, entry(1, 1)]];
    made.answer.log_volume = std::f64::consts::PI.ln() - (factor[0][0] * factor[1][1]).ln();
    made.answer.log_det = 2.0 * (a * c).ln();
    (made.answer.scatter, made.answer.factor, made.answer.center) = (scatter, factor, center);
    let n = values.len() as u64 / 2;
    let ellipsoid = made.answer.ellipsoid();
    made.answer.outliers =
        (0..n).filter(|&row| ellipsoid.norm(&values[2 * row as usize..][..2]) > 1.0).collect();
    made.certificate.left_out = (0..n).filter(|row| !kept.contains(row)).collect();
    made.certificate.weighed_out = made.certificate.left_out.clone();
    made.certificate.scale = scale;
    made.certificate.unweighted = Some(Unweighted::Flat);
    made.certificate.objective =
        (covariance[0][0] * covariance[1][1] - covariance[1][0] * covariance[0][1]).ln();
    made
}

/// The one thing that only distances tell: of rows exchanged, all numbers are right.
#[test]
fn rows_that_a_c_step_improves_are_rejected() {
    let values = contaminated(80, 2, 20, 6.0, 12);
    let points = Points::new(&values, 2).unwrap();
    let found = solve("mcd", &values, 2, &by(RobustMethod::Mcd));
    let out = &found.certificate.left_out;
    let kept: Vec<u64> = (0..80).filter(|row| !out.contains(row)).collect();
    // Right in all but that points could be weighed again: the distances are judged before that.
    let right = by_hand(&found, &values, &kept).check(&points).unwrap_err();
    assert!(matches!(right, CheckError::Rejected(Violation::Reweighting { .. })), "{right}");
    for at in 0..kept.len() {
        let mut worse = kept.clone();
        worse[at] = out[at % out.len()];
        worse.sort_unstable();
        let refused = by_hand(&found, &values, &worse).check(&points).unwrap_err();
        assert!(
            matches!(refused, CheckError::Rejected(Violation::NotNearest { .. })),
            "{at}: {refused}"
        );
    }
}

/// Returns what refuses a forgery: something consistent in itself that claims too much.
fn refused(what: &str, forged: &Solved, values: &[f64], dim: usize) -> Violation {
    match forged.check(&Points::new(values, dim).unwrap()) {
        Err(CheckError::Rejected(violation)) => violation,
        other => panic!("{what}: {other:?}"),
    }
}

/// The certificate within a trimmed fit is one of an ellipsoid, but not one around all points.
#[test]
fn the_ellipsoid_of_a_trimmed_fit_does_not_pass_for_one_around_all() {
    let values = contaminated(80, 2, 20, 6.0, 3);
    let found = solve("trim", &values, 2, &by(RobustMethod::Trim));
    let taut_certify::Enclosure { ellipsoid, certificate } = found.certificate.enclosure.unwrap();
    let alone = Solution { answer: ellipsoid, certificate, trace: found.trace };
    let refusal = alone.check(&Points::new(&values, 2).unwrap());
    assert!(matches!(refusal, Err(CheckError::Rejected(Violation::LeftOut { .. }))), "{refusal:?}");
}

/// All lists agree that a row is out that is not, or in that is not.
#[test]
fn rows_moved_in_and_out_of_all_lists_are_found() {
    let values = contaminated(80, 2, 20, 6.0, 3);
    let found = solve("trim", &values, 2, &by(RobustMethod::Trim));
    let support = found.certificate.enclosure.as_ref().unwrap().certificate.support.clone();
    for row in (0..80).filter(|row| !support.contains(row)) {
        let mut forged = found.clone();
        let is_out = found.answer.outliers.contains(&row);
        for list in [
            &mut forged.answer.outliers,
            &mut forged.certificate.left_out,
            &mut forged.certificate.enclosure.as_mut().unwrap().certificate.left_out,
        ] {
            match list.binary_search(&row) {
                Ok(at) => _ = list.remove(at),
                Err(at) => list.insert(at, row),
            }
        }
        // One row more is kept; of one less there are too few.
        let refusal = refused("moved", &forged, &values, 2);
        match refusal {
            Violation::Listed { row: found, .. } if is_out => assert_eq!(found, row),
            Violation::Estimate { .. } if !is_out => {}
            other => panic!("{row}: {other}"),
        }
        forged.certificate.kept -= u64::from(!is_out);
        refused("moved, and one less asked for", &forged, &values, 2);
    }
}

/// Points on a line, and others beside it: the fit on the line, with the line as wide as the plane.
#[test]
fn a_hull_as_wide_as_the_points_is_no_exact_fit() {
    let line = normal(100, 1, 7);
    let plane: Vec<f64> = line
        .iter()
        .enumerate()
        .flat_map(|(i, &x)| [x, if i < 80 { 0.001 * (i % 9) as f64 } else { 50.0 }])
        .collect();
    let on_line = solve("line", &line, 1, &by(RobustMethod::Mcd));
    let in_plane = solve("plane", &plane, 2, &by(RobustMethod::Mcd));
    for distance in [100.0, 1.0] {
        let mut forged = on_line.clone();
        let answer = &mut forged.answer;
        let embedded = |v: f64| vec![vec![v, 0.0], vec![0.0, 0.0]];
        answer.center.push(0.0);
        answer.factor[0].push(0.0);
        answer.matrix = embedded(answer.matrix[0][0]);
        answer.scatter = embedded(answer.scatter[0][0]);
        answer.hull = Some(taut_certify::Hull { basis: vec![vec![1.0, 0.0]], distance });
        forged.certificate.points_hash = in_plane.certificate.points_hash;
        let list = |rows: &mut Vec<u64>| {
            rows.extend(80..100);
            rows.sort_unstable();
            rows.dedup();
        };
        if distance < 50.0 {
            list(&mut answer.outliers);
            list(&mut forged.certificate.left_out);
            list(&mut forged.certificate.weighed_out);
            forged.certificate.kept = 100 - forged.certificate.left_out.len() as u64;
        }
        let refusal = refused("a wide hull", &forged, &plane, 2);
        let is_for_that = matches!(refusal, Violation::NotFlat { .. })
            || distance < 50.0 && matches!(refusal, Violation::Number { .. });
        assert!(is_for_that, "{refusal}");
    }
}

/// Sizes at which products of entries of the matrix leave the range of numbers.
#[test]
fn an_ellipsoid_grown_or_shrunk_is_refused_at_any_size() {
    for (scale, times) in [(1e-80, 8.0), (1e-80, 0.125), (1e90, 8.0), (1.0, 8.0), (1.0, 1.001)] {
        let values: Vec<f64> = normal(40, 2, 2).iter().map(|v| v * scale).collect();
        let options = RobustOptions { coverage: Some(1.0), ..by(RobustMethod::Mve) };
        let found = solve("all", &values, 2, &options);
        let mut forged = found.clone();
        let answer = &mut forged.answer;
        answer.factor.iter_mut().flatten().for_each(|v| *v *= times);
        answer.matrix.iter_mut().flatten().for_each(|v| *v *= times * times);
        answer.scatter.iter_mut().flatten().for_each(|v| *v /= times * times);
        answer.log_volume -= 2.0 * times.ln();
        answer.log_det -= 4.0 * times.ln();
        let ellipsoid = answer.ellipsoid();
        answer.outliers =
            (0..40).filter(|&row| ellipsoid.norm(&values[2 * row as usize..][..2]) > 1.0).collect();
        refused(&format!("{times} times at {scale}"), &forged, &values, 2);
    }
}

#[test]
fn tails_of_centers_are_small() {
    let values = contaminated(80, 2, 20, 6.0, 12);
    for method in RobustMethod::ALL {
        let found = solve("tail", &values, 2, &by(method));
        let mut forged = found.clone();
        let center = forged.answer.center.clone();
        forged.answer.center = vec![1e6, -1e6];
        forged.answer.center_tail = vec![center[0] - 1e6, center[1] + 1e6];
        let refusal = refused("a center in its tail", &forged, &values, 2);
        assert!(matches!(refusal, Violation::Number { .. }), "{method}: {refusal}");
    }
}

/// A fit of four points that are the nearest in their own metric, with every factor as it is for h = 4.
#[test]
fn a_fit_of_too_few_points_is_refused() {
    let values = contaminated(80, 2, 20, 6.0, 12);
    let found = solve("mcd", &values, 2, &by(RobustMethod::Mcd));
    for kept in [1, 4, 40] {
        let mut forged = found.clone();
        forged.certificate.kept = kept;
        forged.certificate.left_out = (kept..80).collect();
        let refusal = refused("few", &forged, &values, 2);
        assert!(matches!(refusal, Violation::Number { .. }), "{refusal}");
    }
    assert_eq!(found.certificate.kept, 41);
    let verdict = found.check(&Points::new(&values, 2).unwrap()).unwrap();
    assert_eq!((verdict.wanted, verdict.kept), (41, 41));
    assert!(verdict.flag_excess < 1e-14 && verdict.slack < 1.1e-9, "{verdict:?}");
}

/// The ellipsoid around all points does not pass for the smallest around half of them.
#[test]
fn fewer_points_than_are_kept_were_not_asked_for() {
    let values = normal(100, 2, 1);
    let options = RobustOptions { coverage: Some(1.0), ..by(RobustMethod::Trim) };
    let mut forged = solve("all", &values, 2, &options);
    let quantile = |p: f64| -2.0 * (1.0 - p).ln();
    let small = 1.0 + 15.0 / 98.0;
    let scale = small * small / quantile(50.0 / 101.0);
    let times = scale / forged.certificate.raw_scale;
    forged.certificate.kept = 50;
    forged.certificate.raw_scale = scale;
    forged.answer.scatter.iter_mut().flatten().for_each(|v| *v *= times);
    forged.answer.log_det += 2.0 * times.ln();
    let refusal = refused("half", &forged, &values, 2);
    assert!(matches!(refusal, Violation::Spare { kept: 50, .. }), "{refusal}");
}

/// Near a level of 1 all quantiles have nearly the same probability.
#[test]
fn a_quantile_too_far_out_is_refused() {
    let values = normal(200, 2, 8);
    for level in [0.975, 1.0 - 1e-9, 1.0 - 1e-13] {
        let options = RobustOptions { level, ..by(RobustMethod::Mcd) };
        let found = solve("level", &values, 2, &options);
        for times in [0.9, 1.1, 10.0, 1e3] {
            let mut forged = found.clone();
            let (certificate, answer) = (&mut forged.certificate, &mut forged.answer);
            certificate.cutoff *= times;
            certificate.weighed_out.clear();
            let root = f64::sqrt(times);
            answer.factor.iter_mut().flatten().for_each(|v| *v /= root);
            answer.matrix.iter_mut().flatten().for_each(|v| *v /= times);
            answer.log_volume += times.ln();
            let refusal = refused("a quantile", &forged, &values, 2);
            assert!(
                matches!(
                    refusal,
                    Violation::Matrix { .. }
                        | Violation::Estimate { .. }
                        | Violation::Listed { .. }
                ),
                "{refusal}"
            );
        }
        let mut forged = found.clone();
        forged.certificate.level = 1.0;
        refused("a level of 1", &forged, &values, 2);
    }
}

/// Nothing is left unweighted without a reason, and no reason is given that does not hold.
#[test]
fn why_nothing_is_weighed_again_must_be_true() {
    let values = contaminated(80, 2, 20, 6.0, 12);
    let found = solve("mcd", &values, 2, &by(RobustMethod::Mcd));
    assert_eq!(found.certificate.unweighted, None);
    let out = &found.certificate.left_out;
    let kept: Vec<u64> = (0..80).filter(|row| !out.contains(row)).collect();
    let by_hand = by_hand(&found, &values, &kept);
    for why in [Unweighted::AllKept, Unweighted::Flat, Unweighted::Trimmed] {
        let mut forged = by_hand.clone();
        forged.certificate.unweighted = Some(why);
        let refusal = refused("a reason", &forged, &values, 2);
        assert!(matches!(refusal, Violation::Reweighting { .. }), "{refusal}");
    }
    let mut forged = by_hand;
    forged.certificate.unweighted = None;
    refused("no reason", &forged, &values, 2);
    let all = RobustOptions { coverage: Some(1.0), ..by(RobustMethod::Mcd) };
    let found = solve("all", &values, 2, &all);
    assert_eq!(found.certificate.unweighted, Some(Unweighted::AllKept));
}

/// A circle around the points kept, with the multipliers of the smallest ellipse and the gap that these prove for it: true
/// as a bracket, but no proof that a C-step leads nowhere.
#[test]
fn a_loose_ellipsoid_around_the_points_kept_is_no_local_optimum() {
    let mut values = contaminated(100, 2, 20, 12.0, 5);
    values[1..160].iter_mut().step_by(2).for_each(|y| *y *= 0.1);
    let options = RobustOptions { coverage: Some(0.8), ..by(RobustMethod::Trim) };
    let mut forged = solve("trim", &values, 2, &options);
    let center = forged.answer.center.clone();
    let kept = (0..100).filter(|row| forged.certificate.left_out.binary_search(row).is_err());
    let reach = |row: u64| {
        let point = &values[2 * row as usize..][..2];
        (point[0] - center[0]).hypot(point[1] - center[1])
    };
    let radius = kept.map(reach).fold(0.0, f64::max) * (1.0 + 1e-9);
    let diagonal = |v: f64| vec![vec![v, 0.0], vec![0.0, v]];
    let size = radius * radius;
    let circle = taut_certify::Ellipsoid {
        factor: diagonal(1.0 / radius),
        matrix: diagonal((1.0 / radius) * (1.0 / radius)),
        log_volume: (std::f64::consts::PI * size).ln(),
        ..forged.answer.ellipsoid()
    };
    forged.answer.factor = circle.factor.clone();
    forged.answer.matrix = circle.matrix.clone();
    forged.answer.log_volume = circle.log_volume;
    forged.answer.scatter = diagonal(size * forged.certificate.raw_scale);
    forged.answer.log_det = 2.0 * (size * forged.certificate.raw_scale).ln();
    forged.certificate.objective = circle.log_volume;
    let enclosure = forged.certificate.enclosure.as_mut().unwrap();
    enclosure.ellipsoid = circle;
    enclosure.certificate.gap = 5.0;
    match refused("circle", &forged, &values, 2) {
        Violation::LooseEnclosure { gap, most } => assert!(gap > 1.0 && most == 0.011, "{gap}"),
        other => panic!("{other}"),
    }
}
