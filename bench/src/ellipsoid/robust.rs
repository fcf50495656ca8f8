//! MCD: the objective and the time beside scikit-learn, and the outliers of classical sets.

use anyhow::{Context as _, Result};
use serde_json::json;
use taut_certify::{RobustEllipsoid, Solution};
use taut_enclose::{RobustOptions, robust_ellipsoid};
use taut_points::{Distribution, Points, generate};

use super::case::Case;
use super::goals::{self, Measured};
use super::{Context, data, read, rounds};
use crate::input::{SEED, write_rows};
use crate::stats::seconds;
use crate::table::Table;

/// scikit-learn's `MinCovDet`.
const PEER: &str = "sklearn-mcd";
const N: usize = 100_000;
const D: usize = 10;
/// Of ten points so many are in a second cloud of the same spread, moved by 10 along each axis. A cloud much denser than
/// the others would not do: with it a subset can have the smaller determinant.
const OUTLIERS: usize = 3;

/// Normal points, of ten the last three moved to one cloud.
fn draw(n: usize, d: usize) -> Result<Vec<f64>> {
    let mut values: Vec<f64> = generate(Distribution::Normal, n, d, SEED)?;
    for (i, row) in values.chunks_exact_mut(d).enumerate() {
        if i % 10 >= 10 - OUTLIERS {
            row.iter_mut().for_each(|x| *x += 10.0);
        }
    }
    Ok(values)
}

/// ln det of the covariance (divisor h − 1) of the rows in `kept`, ascending, each once; `None` where it has none.
fn log_det(values: &[f64], d: usize, kept: &[u64]) -> Option<f64> {
    let is_subset = kept.windows(2).all(|pair| pair[0] < pair[1])
        && kept.last().is_some_and(|&last| (last as usize) < values.len() / d);
    if !is_subset {
        return None;
    }
    let h = kept.len() as f64;
    let row = |i: u64| &values[i as usize * d..][..d];
    let mut mean = vec![0.0; d];
    kept.iter().for_each(|&i| mean.iter_mut().zip(row(i)).for_each(|(m, x)| *m += x / h));
    let mut covariance = vec![0.0; d * d];
    let mut offset = vec![0.0; d];
    for &i in kept {
        offset.iter_mut().zip(row(i)).zip(&mean).for_each(|((o, x), m)| *o = x - m);
        for j in 0..d {
            for k in 0..=j {
                covariance[j * d + k] += offset[j] * offset[k] / (h - 1.0);
            }
        }
    }
    // Cholesky's factor in place: the determinant is the product of the squares of its diagonal.
    let mut sum = 0.0;
    for j in 0..d {
        for k in 0..=j {
            let product: f64 = (0..k).map(|l| covariance[j * d + l] * covariance[k * d + l]).sum();
            let rest = covariance[j * d + k] - product;
            covariance[j * d + k] = if j == k { rest.sqrt() } else { rest / covariance[k * d + k] };
        }
        sum += 2.0 * covariance[j * d + j].ln();
    }
    sum.is_finite().then_some(sum)
}

/// Runs MCD beside scikit-learn, both with one thread.
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let n = if context.quick { N / 10 } else { N };
    let what = format!("{n} × {D}, of ten points {OUTLIERS} in one cloud far off");
    let values = draw(n, D)?;
    let file = context.temp.path().join("points");
    write_rows(&file, &values, D)?;
    let points = Points::new(&values, D)?;
    let options = RobustOptions::default();
    let rounds = rounds::run(context, &[1], Some((PEER, &file)), || {
        Ok(robust_ellipsoid(&points, &options)?)
    })?;
    let rejected = rounds.found.check(&points).err().map(|why| why.to_string());
    let left_out = &rounds.found.certificate.left_out;
    let kept: Vec<u64> = (0..n as u64).filter(|row| left_out.binary_search(row).is_err()).collect();
    let ours = log_det(&values, D, &kept).context("the points kept have no covariance")?;

    let mut table = Table::new(&["program", "processor time", "h", "ln det", "outliers flagged"]);
    let flagged = &rounds.found.answer.flagged;
    let found = flagged.iter().filter(|&row| row % 10 >= (10 - OUTLIERS) as u64).count();
    table.push(vec![
        "taut".into(),
        rounds.one_thread().map(seconds).unwrap_or_default(),
        kept.len().to_string(),
        format!("{ours:.9}"),
        format!("{found} of {}, and {} others", n / 10 * OUTLIERS, flagged.len() - found),
    ]);
    let mut theirs = None;
    match &rounds.peer {
        Some(Ok((answer, _))) => {
            let rows: Vec<u64> = answer.center.iter().map(|&row| row as u64).collect();
            // Fewer points have a smaller determinant: only subsets of one size can be compared.
            theirs = log_det(&values, D, &rows).filter(|_| rows.len() == kept.len());
            table.push(vec![
                PEER.into(),
                rounds.peer_seconds().map(seconds).unwrap_or_default(),
                rows.len().to_string(),
                theirs.map_or("none for this h".into(), |theirs| format!("{theirs:.9}")),
                String::new(),
            ]);
        }
        Some(Err(silence)) => table.push(
            [PEER.to_owned(), silence.to_string()]
                .into_iter()
                .chain(std::iter::repeat_n(String::new(), 3))
                .collect(),
        ),
        None => {}
    }
    println!("{what}\n\n{table}");
    let faster = rounds.peer_seconds().zip(rounds.one_thread()).map(|(peer, one)| peer / one);
    let measured = Measured {
        rejected,
        faster,
        objective: theirs.map(|theirs| ours - theirs),
        ..Measured::default()
    };
    let goals = goals::print(&[case.must], &[case.aim], &measured);
    context.report.add(json!({
        "name": case.name, "input": what, "times": rounds.json(), "ln_det": ours, "peer_ln_det": theirs,
        "goals": goals,
    }));
    Ok(())
}

/// Classical sets: name, columns, and the rows (from 1) that the R package robustbase publishes as outliers.
const CLASSICAL: [(&str, usize, &[u64]); 3] = [
    ("rb_hbk.csv", 3, &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14]),
    ("rb_stackloss.csv", 3, &[1, 2, 3, 15, 16, 17, 18, 19, 21]),
    ("rb_starsCYG.csv", 2, &[7, 11, 14, 20, 30, 34]),
];

/// Compares the flags of the classical sets.
pub(super) fn run_flags(context: &mut Context, case: &Case) -> Result<()> {
    let Some(folder) = data() else {
        context.report.add(json!({ "name": case.name, "left_out": "no TAUT_DATA" }));
        return Ok(());
    };
    let mut table = Table::new(&["set", "flagged by taut", "published"]);
    let (mut others, mut rejected) = (Vec::new(), None);
    for (name, columns, published) in CLASSICAL {
        let (values, d) = read(&folder.join(name), Some(columns)).with_context(|| name)?;
        let points = Points::new(&values, d)?;
        let found: Solution<RobustEllipsoid> =
            robust_ellipsoid(&points, &RobustOptions::default())?;
        rejected = rejected.or(found.check(&points).err().map(|why| format!("{name}: {why}")));
        let flagged: Vec<u64> = found.answer.flagged.iter().map(|row| row + 1).collect();
        if flagged != published {
            others.push(name.to_owned());
        }
        let list = |rows: &[u64]| rows.iter().map(u64::to_string).collect::<Vec<_>>().join(" ");
        table.push(vec![name.to_owned(), list(&flagged), list(published)]);
    }
    println!("{table}");
    let measured = Measured { rejected, other_flags: Some(others), ..Measured::default() };
    let goals = goals::print(&[case.must], &[case.aim], &measured);
    context.report.add(json!({ "name": case.name, "goals": goals }));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_determinant_of_a_subset_is_that_of_the_book() {
        // Of the first four: variances 4/3 and 16/3, no covariance.
        let values = [1.0, 2.0, -1.0, 2.0, 1.0, -2.0, -1.0, -2.0, 9.0, 9.0];
        let found = log_det(&values, 2, &[0, 1, 2, 3]).unwrap();
        assert!((found - (64.0f64 / 9.0).ln()).abs() < 1e-14);
        assert_eq!(log_det(&values, 2, &[0, 1]), None);
        assert_eq!(log_det(&values, 2, &[0, 0, 1, 2]), None);
        assert_eq!(log_det(&values, 2, &[0, 1, 5]), None);
        assert_eq!(log_det(&values, 2, &[]), None);
    }
}
