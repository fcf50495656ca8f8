//! The verdict does not depend on the number of threads.

use common::{Case, certify, normalized};
use taut_certify::{CheckError, Items};
use taut_points::{Monitor, Points, hash_points};

use crate::common;

fn said(case: &Case, threads: usize) -> String {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    match pool.install(|| case.check()) {
        Ok(verdict) => {
            format!(
                "{:?} {:?}",
                verdict,
                [verdict.lower, verdict.upper, verdict.gap].map(f64::to_bits)
            )
        }
        Err(CheckError::Rejected(violation)) => format!("{violation:?}"),
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn the_verdict_is_the_same_for_every_number_of_threads() {
    // 30,000 rows of 7 make 4 blocks; many rows of every block lie outside the second ball.
    let mut values = common::numbers(210_000, 11);
    let support = [5, 77, 2000, 2999];
    let lambda = normalized(&[1.0, 2.0, 2.0, 3.0]);
    // Multipliers stand on the first rows, so few rows are enough to make the certificate by fractions.
    let mut case =
        certify("threads", &values[..21_000], 7, Items::Points, &support, &lambda, false);
    case.solution.answer.radius *= 1.2;
    case.solution.certificate.gap = case.solution.certificate.gap * 1.2 + 0.3;
    let adopt = |case: &mut Case, values: &[f64]| {
        let points = Points::new(values, 7).unwrap();
        case.solution.certificate.points_hash = hash_points(&points, &Monitor::silent()).unwrap();
        case.values = values.to_vec();
    };
    adopt(&mut case, &values);
    let mut cases = vec![case.clone()];
    case.solution.answer.radius *= 0.6;
    cases.push(case.clone());
    values[100_003] = f64::NAN;
    values[200_000] = f64::INFINITY;
    adopt(&mut case, &values);
    cases.push(case);
    let words = ["Verdict", "Outside", "NonFinite { row: 14286, column: 1"];
    for (case, word) in cases.iter().zip(words) {
        let one = said(case, 1);
        assert!(one.contains(word), "{one}");
        for threads in [2, 3, 8] {
            assert_eq!(one, said(case, threads));
        }
    }
}
