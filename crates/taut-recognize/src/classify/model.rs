//! A trained classifier as data: predictions, and saving as JSON with a format and a version.

use serde::{Deserialize, Serialize};
use taut_points::parallel::IntoParallel;
use taut_points::{OrderBy, Points};

use super::calibrate::Calibration;
use super::data::check_finite;
use super::method::Method;
use super::plda::Plda;
use super::rule::{Fitted, Learned};
use super::select::Trial;
use super::{Classifier, Score, best_of};
use crate::Error;

/// What the JSON of a model calls its format.
const FORMAT: &str = "taut-classifier";
/// The version that is written, and the only one that is read.
const VERSION: u64 = 1;
/// Median kernel values between nearest neighbors outside this range mean a width by which all points are alone, or all the same.
const NEAREST_KERNEL_RANGE: [f64; 2] = [0.05, 0.95];

/// A trained classifier.
///
/// Models of balls and machines hold rows of the training points as they are after scaling: whoever has the model has these.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// Names of the classes.
    pub(super) classes: Vec<String>,
    /// Names of the coordinates; empty where they have none.
    pub(super) columns: Vec<String>,
    pub(super) learned: Learned,
    /// Points whose best score is below are rejected.
    pub(super) threshold: Option<f64>,
    pub(super) calibration: Option<Calibration>,
    /// The candidates, where there were several.
    pub(super) trials: Vec<Trial>,
}

/// What a model says of a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// The number of the class; none where the point was rejected.
    pub class: Option<u32>,
    /// The score of each class; the larger, the better. Their meaning depends on the method: for PLDA a log-likelihood ratio, for
    /// balls a squared distance in the feature space with its sign changed, for support vector machines multiples of the margin.
    pub scores: Vec<f64>,
    /// The probability of each class if the point belongs to one of them: of PLDA the posterior for equally frequent classes, of
    /// other methods by sigmoids fitted to held-out scores. None where neither is there.
    pub probabilities: Option<Vec<f64>>,
}

/// The JSON of a model.
#[derive(Serialize)]
struct SavedModel<'a> {
    format: &'a str,
    version: u64,
    model: &'a Model,
}

/// What a JSON begins with, before it is known to be a model.
#[derive(Deserialize)]
struct Head {
    format: Option<String>,
    version: Option<u64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LoadedModel {
    #[serde(rename = "format")]
    _format: String,
    #[serde(rename = "version")]
    _version: u64,
    model: Model,
}

impl Model {
    /// Names of the classes, by number.
    pub fn classes(&self) -> &[String] {
        &self.classes
    }

    /// Names of the coordinates; empty where none were given.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The same model with names of the coordinates.
    ///
    /// # Errors
    /// [`Error::Dimension`] where there are names, and not one for each coordinate.
    pub fn with_columns(mut self, columns: Vec<String>) -> Result<Self, Error> {
        if !columns.is_empty() && columns.len() != self.dim() {
            return Err(Error::Dimension { found: columns.len(), expected: self.dim() });
        }
        self.columns = columns;
        Ok(self)
    }

    /// The methods that vote: one, or those of a committee.
    pub fn methods(&self) -> Vec<Method> {
        self.parts().into_iter().filter_map(|learned| learned.method).collect()
    }

    /// The candidates and what inner folds said of them, in their order; empty where there was one.
    pub fn trials(&self) -> &[Trial] {
        &self.trials
    }

    /// The score below which a point is rejected.
    pub fn threshold(&self) -> Option<f64> {
        self.threshold
    }

    /// The same model with another threshold: points whose best score is below are rejected.
    ///
    /// # Errors
    /// [`taut_points::InputError::Option`] for NaN and infinities.
    pub fn with_threshold(mut self, threshold: Option<f64>) -> Result<Self, Error> {
        if let Some(value) = threshold.filter(|value| !value.is_finite()) {
            return Err(Error::option("threshold", value.to_string(), "a finite number"));
        }
        self.threshold = threshold;
        Ok(self)
    }

    /// Sentences about what makes the model doubtful; none where nothing does.
    pub fn warnings(&self) -> Vec<String> {
        let [low, high] = NEAREST_KERNEL_RANGE;
        let doubtful = |learned: &Learned| {
            let value = learned.nearest_kernel?;
            // Of machines a wide kernel is the linear limit, which is no worse.
            let is_svm = matches!(learned.fitted, Fitted::Svm(_));
            let why = match value {
                value if value < low => "so narrow that each point is alone; take a wider one",
                value if value > high && !is_svm => {
                    "so wide that all points are nearly the same; take a narrower one"
                }
                _ => return None,
            };
            Some(format!(
                "the kernel is {why}: between nearest neighbors its median is {value:.2e}, expected {low} to {high}"
            ))
        };
        let mut all: Vec<String> = self.parts().into_iter().filter_map(doubtful).collect();
        all.dedup();
        all
    }

    fn parts(&self) -> Vec<&Learned> {
        match &self.learned.fitted {
            Fitted::Committee(committee) => committee.members().collect(),
            _ => vec![&self.learned],
        }
    }

    /// Finds the class of each point.
    ///
    /// # Errors
    /// [`Error::Dimension`], [`taut_points::InputError::NonFinite`], and [`Error::Overflow`] where a score is not a number.
    pub fn predict(&self, points: Points<'_, f64>) -> Result<Vec<Prediction>, Error> {
        if points.dim() != self.dim() {
            return Err(Error::Dimension { found: points.dim(), expected: self.dim() });
        }
        check_finite(&points)?;
        (0..points.len()).into_par_iter().map(|i| self.predict_one(points.row(i))).collect()
    }

    fn predict_one(&self, x: &[f64]) -> Result<Prediction, Error> {
        let mut scores = vec![Score::default(); Classifier::classes(self)];
        self.scores(x, &mut scores);
        if scores.iter().any(|score| score.value.is_nan() || score.tie.is_nan()) {
            return Err(Error::Overflow);
        }
        let (class, best) = best_of(&scores);
        let is_rejected = self.threshold.is_some_and(|threshold| best.value < threshold);
        let scores: Vec<f64> = scores.into_iter().map(|score| score.value).collect();
        let probabilities = match (&self.calibration, &self.learned.fitted) {
            (Some(calibration), _) => Some(calibration.probabilities(&scores)),
            (None, Fitted::Plda(_)) => Some(Plda::probabilities(&scores)),
            _ => None,
        };
        Ok(Prediction { class: (!is_rejected).then_some(class as u32), scores, probabilities })
    }

    /// The model as JSON.
    pub fn to_json(&self) -> String {
        let written = SavedModel { format: FORMAT, version: VERSION, model: self };
        serde_json::to_string(&written).expect("numbers, names and lists can be written")
    }

    /// The model that a JSON holds: predictions have the same bits.
    ///
    /// # Errors
    /// [`Error::NoModel`] and [`Error::Version`].
    pub fn from_json(json: &str) -> Result<Self, Error> {
        let no_model = |problem: String| Error::NoModel { problem };
        let head: Head = serde_json::from_str(json).map_err(|error| no_model(error.to_string()))?;
        if head.format.as_deref() != Some(FORMAT) {
            return Err(no_model(format!("its `format` is not \"{FORMAT}\"")));
        }
        match head.version {
            Some(VERSION) => {}
            Some(found) => return Err(Error::Version { found, known: VERSION }),
            None => return Err(no_model("it has no `version`".to_owned())),
        }
        let LoadedModel { model, .. } =
            serde_json::from_str(json).map_err(|error| no_model(error.to_string()))?;
        model.check().map_err(|problem| no_model(problem.to_owned()))?;
        Ok(model)
    }

    /// Tests that all parts have sizes that fit, so that no prediction fails.
    fn check(&self) -> Result<(), &'static str> {
        let (dim, classes) = (self.learned.preparation.dim(), self.classes.len());
        let mut names = self.classes.clone();
        names.order();
        if names.iter().any(String::is_empty) || names.windows(2).any(|pair| pair[0] == pair[1]) {
            return Err("its classes have an empty name, or one name twice");
        }
        let is_sound = classes > 0
            && self.learned.is_sound(dim, classes)
            && (self.columns.is_empty() || self.columns.len() == dim)
            && self.calibration.as_ref().is_none_or(|c| classes > 1 && c.is_sound(classes));
        if is_sound { Ok(()) } else { Err("its parts have sizes that contradict each other") }
    }
}

impl Classifier for Model {
    fn dim(&self) -> usize {
        self.learned.dim()
    }

    fn classes(&self) -> usize {
        self.classes.len()
    }

    fn scores(&self, x: &[f64], out: &mut [Score]) {
        self.learned.scores(x, out);
    }
}
