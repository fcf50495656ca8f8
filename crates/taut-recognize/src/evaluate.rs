//! Error rates of classifiers, verification and identification, with intervals and with warnings where data are too few.
//!
//! | figure | is |
//! |---|---|
//! | FMR, false match rate | the share of impostor comparisons that are accepted |
//! | FNMR, false non-match rate | the share of genuine comparisons that are rejected |
//! | FTE, failure to enroll; FTA, failure to acquire | shares of attempts without a template, or without features |
//! | FAR, false accept rate of transactions | FMR·(1 − FTA) |
//! | FRR, false reject rate of transactions | FTA + FNMR·(1 − FTA) |
//! | EER, equal error rate | FMR and FNMR where they are equal |
//! | FPIR, FNIR | of open-set identification: unknown people who are named, enrolled ones who are not named rightly |
//! | C_llr | the cost of scores as log-likelihood ratios, in bits: 0 is perfect, 1 says nothing |
//!
//! Names and definitions are those of ISO/IEC 19795-1. Scores are similarities: a comparison is accepted where its score is at least the
//! threshold. Comparisons of one person depend on each other, so [`bootstrap_over_people`] draws people and not comparisons.
//!
//! ```
//! use taut_recognize::evaluate::ScoreSet;
//!
//! let scores = ScoreSet::new(vec![0.9, 0.8, 0.7, 0.4], vec![0.5, 0.3, 0.2, 0.1])?;
//! assert_eq!((scores.fmr(0.6), scores.fnmr(0.6)), (0.0, 0.25));
//! assert_eq!(scores.equal_error_rate(), 0.25);
//! # Ok::<(), taut_recognize::Error>(())
//! ```

mod bootstrap;
mod confusion;
#[cfg(feature = "hand")]
mod hands;
mod identify;
mod interval;
mod people;
mod protocol;
mod scores;
mod transaction;

pub use bootstrap::{BootstrapOptions, bootstrap_over_people};
pub use confusion::{Binary, Confusion};
#[cfg(feature = "hand")]
pub use hands::{HAND_COLUMNS, hand_columns, hand_contenders, hand_row};
pub use identify::{Identification, OpenSetRates};
pub use interval::{Interval, RateWarning, clopper_pearson, warnings};
pub use people::person_disjoint_folds;
pub use protocol::{
    Attempt, Contender, OpenSetFigures, Protocol, ProtocolOptions, ProtocolRates, ProtocolRow,
    run_protocol,
};
pub use scores::{DetPoint, ScoreSet};
pub use transaction::TransactionRates;
