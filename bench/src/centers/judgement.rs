//! What the checker proves of an answer, and what that costs.

use super::*;

/// Columns of a judgement.
pub(super) const COLUMNS: &str = "radius:8 | verdict | core-set | by | branches | check:s";

/// A judgement of one answer.
#[derive(Clone, Debug)]
pub(super) struct Judgement {
    /// The radius that the answer claims.
    pub(super) radius: f64,
    /// What was proved, or why nothing was.
    pub(super) verdict: Result<CentersVerdict, String>,
    /// Rows in the core-set.
    core_set: usize,
    /// How the lower bound is proved.
    proof: &'static str,
    /// Seconds of the check.
    seconds: f64,
}

/// Judges an answer on the threads of the pool it is called in.
pub(super) fn judge(found: &Solution<Centers>, source: &dyn PointSource) -> Judgement {
    let start = Instant::now();
    let verdict = found.check(source).map_err(|why| why.to_string());
    Judgement {
        radius: found.answer.radius,
        verdict,
        core_set: found.certificate.core_set.len(),
        proof: match found.certificate.proof {
            LowerBound::Separated => "apart",
            LowerBound::Branches { .. } => "branches",
            LowerBound::Avoiding { .. } => "branches, some refuted by points left out",
            LowerBound::Nogoods { .. } => "nogoods",
        },
        seconds: start.elapsed().as_secs_f64(),
    }
}

impl Judgement {
    /// The gap that was proved.
    pub(super) fn gap(&self) -> Option<f64> {
        self.verdict.as_ref().ok().map(|verdict| verdict.gap)
    }

    /// Cells under [`COLUMNS`].
    pub(super) fn cells(&self) -> Value {
        let verdict = self.verdict.as_ref();
        let said = match verdict {
            Ok(verdict) => format!("proved, gap {:.1e}", verdict.gap),
            Err(why) => format!("REJECTED: {why}"),
        };
        json!({
            "radius": self.radius, "verdict": said, "core-set": self.core_set, "by": self.proof,
            "branches": verdict.ok().map(|verdict| verdict.branches), "check": self.seconds,
            "lower": verdict.ok().map(|verdict| verdict.lower), "gap": self.gap(),
        })
    }
}

/// What goals ask for of several judgements.
pub(super) fn found(all: &[Judgement]) -> Found {
    let mut found = Found::default();
    for of in all {
        found.check(of.verdict.as_ref().map(|verdict| verdict.gap).map_err(String::clone));
        found.add_with_text(RADIUS, Some((of.radius, Unit::Fixed(8).show(of.radius))));
        found.add(CORE_SET, of.core_set as f64);
    }
    let times: Vec<f64> = all.iter().map(|of| of.seconds).collect();
    found.median(CHECK, Summary::of(&times), seconds);
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use taut_enclose::{CentersOptions, centers};
    use taut_points::Points;

    #[test]
    fn a_true_answer_is_proved_and_a_false_one_is_not() {
        let values = [0.0, 0.0, 0.0, 2.0, 9.0, 0.0, 9.0, 1.0];
        let points = Points::new(&values, 2).unwrap();
        let options = CentersOptions { epsilon: 1e-6, ..CentersOptions::default() };
        let mut solution = centers(&points, 2, &options).unwrap();
        let right = judge(&solution, &points);
        assert!(right.gap().is_some_and(|gap| gap <= 1e-6));
        solution.answer.radius *= 0.9;
        let wrong = judge(&solution, &points);
        assert_eq!(wrong.gap(), None);
        let met = |all: &[Judgement], goal: Goal| goal.judge(&found(all)).2;
        assert_eq!(met(&[right.clone(), wrong], GAP.at_most(1.0)), Some(false));
        assert_eq!(met(std::slice::from_ref(&right), GAP.at_most(1e-6)), Some(true));
        assert_eq!(met(&[right], RADIUS.near(1.0, 1e-9)), Some(true));
    }
}
