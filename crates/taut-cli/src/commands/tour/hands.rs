//! The stop at the hands: a synthetic scan, measured, beside what it was made with.

use anyhow::anyhow;
use taut::recognize::hand::synthetic::Generator;
use taut::recognize::hand::{FEATURE_NAMES, Hand, HandOptions};
use taut_draw::{Field, Section};

use super::Stop;
use crate::commands::hand::measure::figure;

pub(super) const HEADING: &str = "A hand, measured";

/// The largest relative difference between a feature and the truth.
const DIFFERENCE_MAX: f64 = 0.05;

/// Makes the scan of a person and measures it; verified means that all features are near those of the outline before pixels and noise.
pub(super) fn stop() -> anyhow::Result<Stop> {
    let scan = Generator::default().scan_with(0, 0, None);
    let hand = Hand::from_rgb(&scan.image, &HandOptions::default())?;
    let truth = scan.truth.features.ok_or_else(|| anyhow!("the hand is cut off"))?;
    let difference = |(found, truth): (&f64, &f64)| (found / truth - 1.0).abs();
    let worst = hand.features.iter().zip(&truth).map(difference).fold(0.0, f64::max);
    let verified = worst <= DIFFERENCE_MAX;
    let shown = [1, 2, 3, 29].map(|k| {
        let value = format!("{:.2} mm, made with {:.2} mm", hand.features[k], truth[k]);
        Field::new(FEATURE_NAMES[k], value)
    });
    let within = format!("all thirty features within {:.1} % of the truth", 100.0 * worst);
    let text = "A synthetic scan with shading, noise and dust. Skin is told from the lid of the scanner by b* of CIELAB, the outline is \
                followed between pixels, and tips and valleys are where it turns. From these come the thirty features of the thesis and \
                the width profile by which people are recognized.";
    let section = Section {
        heading: HEADING.to_owned(),
        text: text.to_owned(),
        command: "taut hand evaluate --synthetic 12x6 --splits 10 --draw rates.html".to_owned(),
        fields: shown.into_iter().chain([Field::new("measured", within.clone())]).collect(),
        figures: vec![figure(&hand)],
    };
    Ok(Stop { section, summary: within, verified })
}
