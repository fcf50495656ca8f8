//! Methods by name, and the grids from which inner folds choose.

use taut_points::{choice, shown_number};

use super::method::{Cells, Covariance, Method, Rule, Scaling};
use super::width::Width;
use crate::Error;

/// Factors of [`Width::Scale`] in the grid of support vector machines.
const SVM_SCALES: [f64; 4] = [0.03, 0.1, 0.3, 1.0];
/// Costs in that grid.
const SVM_COSTS: [f64; 5] = [1.0, 3.0, 10.0, 30.0, 100.0];
/// ν of soft balls, unless another is asked for.
const NU_DEFAULT: f64 = 0.05;
/// Steps of Algorithm 11 in the thesis.
const THESIS_STEPS: u64 = 100;
/// θ in the thesis.
const THESIS_THETA: f64 = 125.0;
/// A committee takes those within 0.75 points of the best candidate.
const COMMITTEE_SHARE: f64 = 0.0075;

/// A method by name, or several to choose from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Preset {
    /// The best of all others that suit any data, by inner folds.
    #[default]
    Best,
    /// All of these that come near the best, voting.
    Committee,
    /// Support vector machines, of which inner folds choose width and cost.
    Svm,
    /// Smallest balls of a Gaussian kernel.
    Ball,
    /// The classifier of the thesis, with the width that gives its figures.
    Thesis,
    /// Smallest balls after whitening within classes.
    WhitenedBall,
    /// Soft balls that reject what is outside.
    Svdd,
    /// Mahalanobis distances with the pooled covariance.
    Mahalanobis,
    /// Mahalanobis distances with half the covariance of the class and half the pooled one.
    ThesisVerifier,
    /// Two-covariance PLDA.
    Plda,
    /// The nearest box.
    Box,
}

choice! { "method", Preset {
    Best = "best", "the best of svm, ball and mahalanobis, by inner folds";
    Committee = "committee", "all of these that come near the best, voting";
    Svm = "svm", "support vector machines; width and cost by inner folds";
    Ball = "ball", "the smallest ball of a Gaussian kernel around each class";
    Thesis = "thesis", "the same with scaling, width and 100 steps of the thesis";
    WhitenedBall = "whitened-ball", "smallest balls after whitening: many classes of few points";
    Svdd = "svdd", "soft balls that reject what is outside; also for one class";
    Mahalanobis = "mahalanobis", "distances from means by the pooled covariance";
    ThesisVerifier = "thesis-verifier", "half the covariance of the class, half the pooled one";
    Plda = "plda", "log-likelihood ratios and probabilities; many classes of few points";
    Box = "box", "the nearest box of the thesis";
}}

/// What is to differ from a preset. Each option is refused by methods that do not have it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PresetOptions {
    /// The scaling of coordinates.
    pub scaling: Option<Scaling>,
    /// The width of kernels.
    pub width: Option<Width>,
    /// How balls divide the feature space.
    pub cells: Option<Cells>,
    /// ν of soft balls, in (0, 1].
    pub nu: Option<f64>,
    /// C of support vector machines, above 0.
    pub cost: Option<f64>,
    /// Steps of Algorithm 11 of the thesis, at least 2.
    pub steps: Option<u64>,
}

impl Preset {
    /// How near the best candidates of a committee come; none for a single method.
    pub fn committee(self) -> Option<f64> {
        (self == Preset::Committee).then_some(COMMITTEE_SHARE)
    }

    /// The candidates.
    ///
    /// # Errors
    /// [`Error::Input`] for an option that the method does not have.
    pub fn candidates(self, options: &PresetOptions) -> Result<Vec<Method>, Error> {
        self.check(options)?;
        let PresetOptions { scaling, width, cells, nu, cost, steps } = *options;
        let scaled = |default: Scaling, rule: Rule| Method {
            scaling: scaling.unwrap_or(default),
            whitening: false,
            rule,
        };
        let z_score = |rule| vec![scaled(Scaling::ZScore, rule)];
        let auto = width.unwrap_or(Width::Auto);
        Ok(match self {
            Preset::Best | Preset::Committee => {
                let mut all = Preset::Mahalanobis.candidates(options)?;
                all.extend(Preset::Ball.candidates(options)?);
                all.extend(Preset::Svm.candidates(options)?);
                all
            }
            Preset::Svm => {
                let widths = width.map_or_else(
                    || SVM_SCALES.map(|factor| Width::Scale { factor }).to_vec(),
                    |width| vec![width],
                );
                let costs = cost.map_or_else(|| SVM_COSTS.to_vec(), |cost| vec![cost]);
                let pairs = costs.iter().flat_map(|&c| widths.iter().map(move |&w| (w, c)));
                pairs.flat_map(|(width, cost)| z_score(Rule::Svm { width, cost })).collect()
            }
            Preset::Ball => {
                let cells = cells.unwrap_or_default();
                z_score(Rule::Ball { width: auto, cells, nu, steps })
            }
            Preset::Thesis => {
                let width = width.unwrap_or(Width::ThetaSquared { theta: THESIS_THETA });
                let steps = Some(steps.unwrap_or(THESIS_STEPS));
                let cells = cells.unwrap_or_default();
                let rule = Rule::Ball { width, cells, nu: None, steps };
                vec![scaled(Scaling::Percent, rule)]
            }
            Preset::WhitenedBall => {
                let cells = cells.unwrap_or(Cells::Voronoi);
                let rule = Rule::Ball { width: auto, cells, nu, steps };
                // The shrinkage of the covariance takes features of one size for granted.
                vec![Method { whitening: true, ..scaled(Scaling::ZScore, rule) }]
            }
            Preset::Svdd => z_score(Rule::Svdd { width: auto, nu: nu.unwrap_or(NU_DEFAULT) }),
            Preset::Mahalanobis => z_score(Rule::Mahalanobis { covariance: Covariance::Pooled }),
            Preset::ThesisVerifier => z_score(Rule::Mahalanobis { covariance: Covariance::Thesis }),
            Preset::Plda => z_score(Rule::Plda),
            Preset::Box => vec![scaled(Scaling::None, Rule::NearestBox)],
        })
    }

    /// Refuses options that the method does not have.
    fn check(self, options: &PresetOptions) -> Result<(), Error> {
        use Preset::{Ball, Best, Committee, Svdd, Svm, Thesis, WhitenedBall};
        let PresetOptions { width, cells, nu, cost, steps, .. } = *options;
        let is_one_of = |presets: &[Preset]| presets.contains(&self);
        let several = [Best, Committee];
        let refuse = |name, value: String, expected| Err(Error::option(name, value, expected));
        if is_one_of(&several) {
            return match (width, cells, nu.or(cost), steps) {
                (None, None, None, None) => Ok(()),
                _ => refuse("method", self.to_string(), "a single method, as it has parameters"),
            };
        }
        if let Some(width) = width.filter(|_| !is_one_of(&[Ball, Svdd, Svm, Thesis, WhitenedBall]))
        {
            let expected = "left out, as this method has no kernel";
            return refuse("width", width.to_string(), expected);
        }
        if let Some(cells) = cells.filter(|_| !is_one_of(&[Ball, Thesis, WhitenedBall])) {
            let expected = "left out, as this method has no cells of balls";
            return refuse("cells", cells.to_string(), expected);
        }
        if let Some(nu) = nu.filter(|_| !is_one_of(&[Ball, Svdd, WhitenedBall])) {
            let expected = "left out, as this method has no soft balls";
            return refuse("nu", shown_number(nu), expected);
        }
        if let Some(cost) = cost.filter(|_| self != Svm) {
            let expected = "left out, except with the method svm";
            return refuse("cost", shown_number(cost), expected);
        }
        if let Some(steps) = steps.filter(|_| !is_one_of(&[Ball, Thesis, WhitenedBall])) {
            let expected = "left out, as this method has no hard balls";
            return refuse("steps", steps.to_string(), expected);
        }
        if let Some(steps) = steps.filter(|_| nu.is_some()) {
            let expected = "left out for soft balls, for which ν asks";
            return refuse("steps", steps.to_string(), expected);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_name_has_candidates_and_refuses_foreign_options() {
        for preset in Preset::ALL {
            let candidates = preset.candidates(&PresetOptions::default()).unwrap();
            let is_grid = [Preset::Best, Preset::Committee, Preset::Svm].contains(&preset);
            assert_eq!(candidates.len() > 1, is_grid, "{preset}");
            let foreign = PresetOptions { cost: Some(1.0), ..Default::default() };
            assert_eq!(preset.candidates(&foreign).is_ok(), preset == Preset::Svm, "{preset}");
            assert_eq!(preset.name().parse::<Preset>().unwrap(), preset);
        }
        let given = PresetOptions {
            width: Some(Width::Gamma { gamma: 0.5 }),
            cost: Some(2.0),
            ..Default::default()
        };
        assert_eq!(
            Preset::Svm.candidates(&given).unwrap(),
            [Method {
                rule: Rule::Svm { width: Width::Gamma { gamma: 0.5 }, cost: 2.0 },
                ..Method::default()
            }]
        );
        let refused =
            Preset::Box.candidates(&PresetOptions { nu: Some(0.5), ..Default::default() });
        assert!(refused.unwrap_err().to_string().contains("no soft balls"));
        let both = PresetOptions { nu: Some(0.5), steps: Some(9), ..Default::default() };
        let refused = Preset::Ball.candidates(&both).unwrap_err().to_string();
        assert!(refused.contains("`steps` is 9: expected left out for soft balls"), "{refused}");
    }
}
