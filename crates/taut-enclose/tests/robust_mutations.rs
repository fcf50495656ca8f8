//! A checker is worth what it rejects: every number and every list of a robust ellipsoid, doctored one at a time.

mod robust;

use robust::{by, classical, contaminated, normal, solve};
use taut_certify::{CheckError, RobustEllipsoid, RobustMethod, Solution, Violation};
use taut_enclose::RobustOptions;
use taut_points::Points;

type Found = Solution<RobustEllipsoid>;

/// A change of one thing.
struct Mutation {
    name: String,
    apply: Box<dyn Fn(&mut Found)>,
}

fn mutation(name: impl Into<String>, apply: impl Fn(&mut Found) + 'static) -> Mutation {
    Mutation { name: name.into(), apply: Box::new(apply) }
}

/// A number made a little larger or smaller: by `part` of `size`.
type Number = fn(&mut Found, usize) -> &mut f64;

fn numbers(found: &Found) -> Vec<Mutation> {
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
            all.push(mutation(format!("centre {at} by {part}"), move |found| {
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
            if name == "distance of the hull" && part > 0.0 && part < 1.0 {
                continue; // a hull that is stated wider holds the same rows
            }
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
fn lists(found: &Found, n: u64) -> Vec<Mutation> {
    type List = fn(&mut Found) -> &mut Vec<u64>;
    let mut all = vec![];
    let lists: [(&str, List); 3] = [
        ("flagged", |f| &mut f.answer.flagged),
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

fn others(found: &Found) -> Vec<Mutation> {
    let mut all = vec![
        mutation("one more kept", |f| f.certificate.kept += 1),
        mutation("one less kept", |f| f.certificate.kept -= 1),
        mutation("nothing kept", |f| f.certificate.kept = 0),
        mutation("hash", |f| f.certificate.points_hash.0 ^= 1),
        mutation("no centre", |f| f.answer.center.clear()),
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
    for (name, values, method, coverage) in [
        ("mcd", &plain, RobustMethod::Mcd, None),
        ("mve", &plain, RobustMethod::Mve, None),
        ("trim", &plain, RobustMethod::Trim, Some(0.8)),
        ("mcd of all", &plain, RobustMethod::Mcd, Some(1.0)),
        ("flat mcd", &flat, RobustMethod::Mcd, None),
        ("flat mve", &flat, RobustMethod::Mve, None),
    ] {
        let options = RobustOptions { coverage, ..by(method) };
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
fn by_hand(found: &Found, values: &[f64], kept: &[u64]) -> Found {
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
    made.answer.flagged =
        (0..n).filter(|&row| ellipsoid.norm(&values[2 * row as usize..][..2]) > 1.0).collect();
    made.certificate.left_out = (0..n).filter(|row| !kept.contains(row)).collect();
    made.certificate.weighed_out = made.certificate.left_out.clone();
    made.certificate.scale = scale;
    made.certificate.objective =
        (covariance[0][0] * covariance[1][1] - covariance[1][0] * covariance[0][1]).ln();
    made
}

/// The one thing that only distances tell.
#[test]
fn rows_that_a_c_step_improves_are_rejected() {
    let values = contaminated(80, 2, 20, 6.0, 12);
    let points = Points::new(&values, 2).unwrap();
    let found = solve("mcd", &values, 2, &by(RobustMethod::Mcd));
    let out = &found.certificate.left_out;
    let kept: Vec<u64> = (0..80).filter(|row| !out.contains(row)).collect();
    let verdict = by_hand(&found, &values, &kept).check(&points).unwrap();
    assert!(!verdict.reweighted && (verdict.objective - found.certificate.objective).abs() < 1e-9);
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
