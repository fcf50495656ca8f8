//! Identification: who of the enrolled people is it, if any?

use crate::Error;

/// Scores of probes against all enrolled people.
#[derive(Clone, Debug, PartialEq)]
pub struct Identification {
    /// For each probe of an enrolled person its rank, the own score, and whether a higher or equal one comes before.
    enrolled: Vec<Probe>,
    /// For each probe of an unknown person the best score.
    unknown: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Probe {
    rank: usize,
    best: f64,
    own: f64,
}

/// Rates of identification in an open set, at one threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenSetRates {
    /// The false positive identification rate: the share of unknown probes that are named; none without such probes.
    pub fpir: Option<f64>,
    /// The false negative identification rate: the share of enrolled probes that are not named rightly; none without such probes.
    pub fnir: Option<f64>,
    /// The share of enrolled probes that get a wrong name, which the thesis counts among false acceptances.
    pub misnamed: Option<f64>,
}

impl Identification {
    /// Takes the scores of each probe, against all `people`, and who it is, `None` being an unknown person.
    ///
    /// Of equal scores the own one comes last, so that a system that says the same of everybody finds nobody.
    ///
    /// # Errors
    /// [`Error::LabelCount`], [`Error::Label`], and [`Error::ScoreNan`].
    pub fn new(people: usize, scores: &[f64], truth: &[Option<u32>]) -> Result<Self, Error> {
        if people == 0 || scores.len() != truth.len() * people {
            let points = scores.len() / people.max(1);
            return Err(Error::LabelCount { labels: truth.len(), points });
        }
        if let Some(index) = scores.iter().position(|score| score.is_nan()) {
            return Err(Error::ScoreNan { what: "identification", index });
        }
        let mut found = Identification { enrolled: vec![], unknown: vec![] };
        for (row, (scores, &truth)) in scores.chunks_exact(people).zip(truth).enumerate() {
            let largest =
                |scores: &mut dyn Iterator<Item = f64>| scores.fold(f64::NEG_INFINITY, f64::max);
            let Some(label) = truth else {
                found.unknown.push(largest(&mut scores.iter().copied()));
                continue;
            };
            let Some(&own) = scores.get(label as usize) else {
                return Err(Error::Label { row, label, classes: people });
            };
            let others = || scores.iter().enumerate().filter(|other| other.0 != label as usize);
            found.enrolled.push(Probe {
                rank: 1 + others().filter(|other| *other.1 >= own).count(),
                best: largest(&mut others().map(|other| *other.1)),
                own,
            });
        }
        Ok(found)
    }

    /// The share of enrolled probes whose person is among the `rank` best; none without such probes.
    pub fn identified_within(&self, rank: usize) -> Option<f64> {
        share(self.enrolled.iter().filter(|probe| probe.rank <= rank).count(), self.enrolled.len())
    }

    /// The rates where the best person is named if the score is at least `threshold`.
    pub fn open_set(&self, threshold: f64) -> OpenSetRates {
        let named = self.unknown.iter().filter(|&&best| best >= threshold).count();
        let right = |probe: &&Probe| probe.rank == 1 && probe.own >= threshold;
        let wrong = |probe: &&Probe| probe.rank > 1 && probe.best >= threshold;
        let count = self.enrolled.len();
        OpenSetRates {
            fpir: share(named, self.unknown.len()),
            fnir: share(count - self.enrolled.iter().filter(right).count(), count),
            misnamed: share(self.enrolled.iter().filter(wrong).count(), count),
        }
    }
}

fn share(part: usize, whole: usize) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}
