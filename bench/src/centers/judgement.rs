//! What the checker proves of an answer, and what that costs.

use std::time::Instant;

use serde_json::{Value, json};
use taut_certify::{Centers, CentersVerdict, LowerBound, Solution};
use taut_points::PointSource;

use super::goals::Measured;
use crate::stats::{Summary, seconds};

/// Columns of a judgement.
pub(super) const COLUMNS: [&str; 6] = ["radius", "verdict", "core-set", "by", "branches", "check"];

/// A judgement of one answer.
#[derive(Clone, Debug)]
pub(super) struct Judgement {
    /// The radius that the answer claims.
    pub(super) radius: f64,
    /// What was proved, or why nothing was.
    pub(super) verdict: Result<CentersVerdict, String>,
    /// Rows in the core-set.
    pub(super) core_set: usize,
    /// How the lower bound is proved.
    pub(super) proof: &'static str,
    /// Seconds of the check.
    pub(super) seconds: f64,
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
    pub(super) fn cells(&self) -> Vec<String> {
        let (said, nodes) = match &self.verdict {
            Ok(verdict) => {
                (format!("proved, gap {:.1e}", verdict.gap), verdict.branches.to_string())
            }
            Err(why) => (format!("REJECTED: {why}"), String::new()),
        };
        let radius = format!("{:.8}", self.radius);
        let [size, proof] = [self.core_set.to_string(), self.proof.to_owned()];
        vec![radius, said, size, proof, nodes, seconds(self.seconds)]
    }

    /// Everything, for the report.
    pub(super) fn json(&self) -> Value {
        let verdict = self.verdict.as_ref();
        json!({
            "radius": self.radius,
            "lower": verdict.ok().map(|verdict| verdict.lower),
            "gap": self.gap(),
            "rejected": verdict.err(),
            "core_set": self.core_set,
            "proof": self.proof,
            "nodes": verdict.ok().map(|verdict| verdict.branches),
            "check_seconds": self.seconds,
        })
    }
}

/// What goals ask for of several judgements: the worst.
pub(super) fn measured(all: &[Judgement]) -> Measured {
    let gaps: Option<Vec<f64>> = all.iter().map(Judgement::gap).collect();
    let least = all.iter().map(|of| of.radius).reduce(f64::min);
    let most = all.iter().map(|of| of.radius).reduce(f64::max);
    let times: Vec<f64> = all.iter().map(|of| of.seconds).collect();
    Measured {
        rejected: all.iter().find_map(|of| of.verdict.as_ref().err().cloned()),
        gap: gaps.and_then(|gaps| gaps.into_iter().reduce(f64::max)),
        radii: least.zip(most).map(|(least, most)| [least, most]),
        core_set: all.iter().map(|of| of.core_set).max(),
        check: Summary::of(&times),
        ..Measured::default()
    }
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
        let mut found = centers(&points, 2, &options).unwrap();
        let right = judge(&found, &points);
        assert!(right.gap().is_some_and(|gap| gap <= 1e-6));
        found.answer.radius *= 0.9;
        let wrong = judge(&found, &points);
        assert_eq!(wrong.gap(), None);
        let both = measured(&[right.clone(), wrong]);
        assert!(both.rejected.is_some() && both.gap.is_none());
        assert_eq!(measured(&[right]).radii, Some([1.0, 1.0]));
    }
}
