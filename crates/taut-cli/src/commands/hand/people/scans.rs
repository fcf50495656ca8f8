//! Scans from images, as `taut hand measure` reads them.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use taut::recognize::hand::{Hand, HandError, HandOptions, Threshold};
use taut::recognize::store::Scan;

use super::super::measure::explain;

/// How images are read.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Reading")]
pub(super) struct Images {
    /// Dots per inch, 20 to 2400 [default: that of the file]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    dpi: Option<f64>,
    /// The b* of CIELAB above which a pixel is skin [default: from the image]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    threshold: Option<f64>,
}

impl Images {
    fn measure(&self, path: &Path) -> Result<Hand, HandError> {
        let options = HandOptions {
            dots_per_inch: self.dpi,
            threshold: self.threshold.map_or(Threshold::Adaptive, Threshold::Fixed),
            ..HandOptions::default()
        };
        Hand::from_file(path, &options)
    }

    /// Measures the hand in an image.
    pub(super) fn scan(&self, path: &Path) -> anyhow::Result<Scan> {
        let hand = self.measure(path).map_err(|error| explain(path, error))?;
        Ok(Scan::from(&hand))
    }

    /// Measures all images; the first one that cannot be measured is the error.
    pub(super) fn scans(&self, paths: &[PathBuf]) -> anyhow::Result<Vec<Scan>> {
        let scans: Vec<_> = paths.par_iter().map(|path| self.scan(path)).collect();
        scans.into_iter().collect()
    }

    /// Measures all images; none for those that show no hand that can be measured.
    pub(super) fn measurable(&self, paths: &[PathBuf]) -> anyhow::Result<Vec<Option<Scan>>> {
        let measure = |path: &PathBuf| match self.measure(path) {
            Ok(hand) => Ok(Some(Scan::from(&hand))),
            Err(HandError::Hand(_)) => Ok(None),
            Err(error) => Err(explain(path, error)),
        };
        let scans: Vec<_> = paths.par_iter().map(measure).collect();
        scans.into_iter().collect()
    }
}
