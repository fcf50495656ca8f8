//! Ways to recognize hands, for the protocol.

use super::protocol::Contender;
use crate::classify::{Cells, Covariance, Method, Rule, Scaling, Width};
use crate::hand::{FEATURE_NAMES, FEATURES, Hand, PROFILE, profile_names};

/// The features of a hand in a row: the thirty of the thesis, then the width profile.
pub const HAND_COLUMNS: usize = FEATURES + PROFILE;

/// θ of the thesis.
const THESIS_THETA: f64 = 125.0;
/// Steps of Algorithm 11 in the thesis.
const THESIS_STEPS: u64 = 100;

/// The names of the features in a row.
pub fn hand_columns() -> Vec<String> {
    FEATURE_NAMES.map(str::to_owned).into_iter().chain(profile_names()).collect()
}

/// The features of a hand in a row.
pub fn hand_row(hand: &Hand) -> [f64; HAND_COLUMNS] {
    let mut row = [0.0; HAND_COLUMNS];
    row[..FEATURES].copy_from_slice(&hand.features);
    row[FEATURES..].copy_from_slice(&hand.profile);
    row
}

/// The ways to recognize hands that are compared, for rows of [`hand_row`]: first those of the thesis, on its features.
///
/// | name | features | identifies | verifies |
/// |---|---|---|---|
/// | `thesis-box` | 30 | the nearest box | the same |
/// | `thesis-ball` | 30 | Voronoi cells of balls with exp(−d²/125²), 100 steps | ½(Σ of the person + Σ pooled) |
/// | `features-mahalanobis` | 30 | the pooled covariance | the same |
/// | `features-plda` | 30 | PLDA | the same |
/// | `profile-plda` | profile | PLDA | the same |
/// | `all-mahalanobis` | both | the pooled covariance | the same |
/// | `all-plda` | both | PLDA | the same |
///
/// The profile is here without the widths at a tenth of the fingers: in many scans the higher valley is above them, and they are measured
/// there. They were chosen on the synthetic scans of the seeds 501 to 503.
pub fn hand_contenders() -> Vec<Contender> {
    let names = hand_columns();
    let all: Vec<usize> =
        (0..HAND_COLUMNS).filter(|&column| !names[column].ends_with("width at 10 %")).collect();
    let (thirty, profile) = all.split_at(FEATURES);
    let contender = |name: &str, columns: &[usize], scaling, rule| Contender {
        name: name.to_owned(),
        columns: columns.to_vec(),
        method: Method { scaling, whitening: false, rule },
        verifier: None,
    };
    let z_score = |name, columns, rule| contender(name, columns, Scaling::ZScore, rule);
    let mahalanobis = |covariance| Rule::Mahalanobis { covariance };
    let verifier = Method {
        scaling: Scaling::ZScore,
        whitening: false,
        rule: mahalanobis(Covariance::Thesis),
    };
    let ball = Rule::Ball {
        width: Width::ThetaSquared { theta: THESIS_THETA },
        cells: Cells::Voronoi,
        nu: None,
        steps: Some(THESIS_STEPS),
    };
    vec![
        contender("thesis-box", thirty, Scaling::None, Rule::NearestBox),
        Contender {
            verifier: Some(verifier),
            ..contender("thesis-ball", thirty, Scaling::Percent, ball)
        },
        z_score("features-mahalanobis", thirty, mahalanobis(Covariance::Pooled)),
        z_score("features-plda", thirty, Rule::Plda),
        z_score("profile-plda", profile, Rule::Plda),
        z_score("all-mahalanobis", &all, mahalanobis(Covariance::Pooled)),
        z_score("all-plda", &all, Rule::Plda),
    ]
}
