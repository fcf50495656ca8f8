//! Balls in the feature space of a kernel, and classifiers, beside scikit-learn; the nearest of many templates.

pub(crate) mod classifiers;
mod hands;
mod identify;
mod kernel;
pub(crate) mod sets;

use crate::prelude::*;

/// All sections. One thread, as scikit-learn's solver has one.
pub(crate) const AREA: Area<Run> = Area {
    name: "recognize",
    sections: &[
        runs("kernel", kernel::balls)
            .about("Hard and soft balls of a Gaussian kernel, beside scikit-learn's OneClassSVM."),
        runs("classifiers", classifiers::classifiers).about(
            "Accuracies on public data, beside scikit-learn's classifiers on the same halves.",
        ),
        runs("hands", hands::hands)
            .about("Scans of a million pixels, and parts of their measurement beside OpenCV and imageproc."),
        runs("identify", identify::nearest)
            .about("The nearest of a million templates, beside comparing with all of them."),
    ],
    runs: 3,
    threads: &[1],
    limit: 300,
    peer_budget: 300,
};
