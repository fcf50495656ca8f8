//! Axes of error rates: a rate stands where the standard normal distribution has it as its tail.
//!
//! *Idea.* Scores of two normal distributions with equal variances give a straight line on such axes, and rates of 0.1 % and of 40 %
//! are both readable: the axes of the detection error trade-off.
//! *Reference.* Martin et al., The DET curve in assessment of detection task performance, Eurospeech 1997. The quantile is Acklam's
//! rational approximation, with a relative error below 1.2e-9: far less than a pixel.

use crate::axes::{Span, Tick, Ticks};

/// The rates that an axis can name, in percent.
const TICK_PERCENTS: [f64; 19] = [
    0.001, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 60.0, 80.0, 90.0,
    99.0, 99.9, 99.99,
];

/// Returns true for a rate that has a place: above 0 and below 1.
pub(crate) fn has_place(rate: f64) -> bool {
    rate > 0.0 && rate < 1.0
}

/// The standard normal quantile of a rate in (0, 1).
pub(crate) fn quantile(rate: f64) -> f64 {
    /// Below this rate, and above one less it, the tails have their own approximation.
    const TAIL_RATE_MAX: f64 = 0.02425;
    const A: [f64; 6] = [
        -39.696_830_286_653_76,
        220.946_098_424_520_5,
        -275.928_510_446_968_7,
        138.357_751_867_269,
        -30.664_798_066_147_16,
        2.506_628_277_459_239,
    ];
    const B: [f64; 6] = [
        -54.476_098_798_224_06,
        161.585_836_858_040_9,
        -155.698_979_859_886_6,
        66.801_311_887_719_72,
        -13.280_681_552_885_72,
        1.0,
    ];
    const C: [f64; 6] = [
        -0.007_784_894_002_430_293,
        -0.322_396_458_041_136_5,
        -2.400_758_277_161_838,
        -2.549_732_539_343_734,
        4.374_664_141_464_968,
        2.938_163_982_698_783,
    ];
    const D: [f64; 5] = [
        0.007_784_695_709_041_462,
        0.322_467_129_070_039_8,
        2.445_134_137_142_996,
        3.754_408_661_907_416,
        1.0,
    ];
    let polynomial =
        |coefficients: &[f64], x: f64| coefficients.iter().fold(0.0, |sum, c| sum * x + c);
    let tail = |rate: f64| {
        let q = (-2.0 * rate.ln()).sqrt();
        polynomial(&C, q) / polynomial(&D, q)
    };
    if rate < TAIL_RATE_MAX {
        tail(rate)
    } else if rate > 1.0 - TAIL_RATE_MAX {
        -tail(1.0 - rate)
    } else {
        let q = rate - 0.5;
        let r = q * q;
        polynomial(&A, r) * q / polynomial(&B, r)
    }
}

/// Ticks of an axis whose interval is given in quantiles (`unit` is 1), in percent; less than twice `most`.
pub(crate) fn ticks(span: &Span, most: usize) -> Ticks {
    let width = span.high - span.low;
    let inside: Vec<(f64, f64)> = TICK_PERCENTS
        .iter()
        .map(|&percent| (percent, quantile(percent / 100.0)))
        .filter(|&(_, at)| (span.low..=span.high).contains(&at))
        .collect();
    // From the last one backward, each far enough from the one before.
    let apart = width / most.max(1) as f64;
    let mut kept: Vec<(f64, f64)> = vec![];
    for mark in inside.into_iter().rev() {
        if kept.last().is_none_or(|last| last.1 - mark.1 >= 0.55 * apart) {
            kept.push(mark);
        }
    }
    let tick = |(percent, at): (f64, f64)| Tick {
        fraction: (at - span.low) / width,
        label: percent.to_string(),
    };
    Ticks {
        ticks: kept.into_iter().rev().map(tick).collect(),
        scale: " (%)".to_owned(),
        ..Ticks::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        for (rate, expected) in [
            (0.5, 0.0),
            (0.025, -1.959_963_984_540_054),
            (0.01, -2.326_347_874_040_841),
            (0.001, -3.090_232_306_167_813),
            (1e-6, -4.753_424_308_822_899),
            (0.158_655_253_931_457_05, -1.0),
        ] {
            assert!((quantile(rate) - expected).abs() < 1e-8, "{rate}: {}", quantile(rate));
            assert!((quantile(1.0 - rate) + expected).abs() < 1e-8, "{rate}");
        }
        assert!(has_place(1e-300) && !has_place(0.0) && !has_place(1.0) && !has_place(f64::NAN));
    }

    #[test]
    fn ticks_are_within_the_interval_and_not_too_many() {
        let span =
            Span { unit: 1.0, low: quantile(0.0005), high: quantile(0.5), pixels: [0.0, 500.0] };
        let found = ticks(&span, 8);
        assert!((6..=12).contains(&found.ticks.len()), "{found:?}");
        assert!(found.ticks.iter().all(|tick| (0.0..=1.0).contains(&tick.fraction)));
        assert!(found.ticks.iter().any(|tick| tick.label == "1"), "{found:?}");
    }
}
