//! The few numbers by which repeated runs are summed up.

use serde::Serialize;

/// Smallest, middle and largest of a few measurements.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Summary {
    /// The smallest.
    pub(crate) min: f64,
    /// The middle one, or the mean of the two in the middle.
    pub(crate) median: f64,
    /// The largest.
    pub(crate) max: f64,
    /// How many there were.
    pub(crate) count: usize,
}

impl Summary {
    /// Sums up `values`; `None` when there is none.
    pub(crate) fn of(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        let (&min, &max) = (sorted.first()?, sorted.last()?);
        let median = 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]);
        Some(Summary { min, median, max, count })
    }

    /// Sums up `above[i] / below[i]`, run by run: what both saw of the machine at that moment cancels.
    pub(crate) fn of_ratios(above: &[f64], below: &[f64]) -> Option<Self> {
        let ratios: Vec<f64> = above.iter().zip(below).map(|(a, b)| a / b).collect();
        Self::of(&ratios)
    }
}

/// The least of several values; `None` of none.
pub(crate) fn least(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    values.into_iter().min_by(f64::total_cmp)
}

/// Median and range of several runs.
pub(crate) fn range(summary: Summary, show: fn(f64) -> String) -> String {
    let Summary { median, min, max, count } = summary;
    format!("{} (range {}–{}, {count} runs)", show(median), show(min), show(max))
}

/// Seconds with a unit that suits them.
pub(crate) fn seconds(value: f64) -> String {
    match value {
        v if v >= 10.0 => format!("{v:.1} s"),
        v if v >= 1.0 => format!("{v:.2} s"),
        v if v >= 0.1 => format!("{:.0} ms", v * 1e3),
        v if v >= 1e-2 => format!("{:.1} ms", v * 1e3),
        v if v >= 1e-3 => format!("{:.2} ms", v * 1e3),
        v => format!("{:.1} µs", v * 1e6),
    }
}

/// A ratio with about three digits.
pub(crate) fn times(value: f64) -> String {
    match value {
        v if v >= 100.0 => format!("{v:.0}"),
        v if v >= 10.0 => format!("{v:.1}"),
        v if v >= 0.1 => format!("{v:.2}"),
        v => format!("{v:.4}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle_whatever_the_order() {
        let odd = Summary::of(&[3.0, 1.0, 2.0]).unwrap();
        assert_eq!((odd.min, odd.median, odd.max, odd.count), (1.0, 2.0, 3.0, 3));
        assert_eq!(Summary::of(&[4.0, 1.0, 3.0, 2.0]).unwrap().median, 2.5);
        assert_eq!(Summary::of(&[]), None);
    }

    #[test]
    fn ratios_are_taken_run_by_run() {
        // A machine that is three times slower in the second run does not blur the ratio of 2.
        let ratio = Summary::of_ratios(&[2.0, 6.0], &[1.0, 3.0]).unwrap();
        assert_eq!((ratio.min, ratio.max), (2.0, 2.0));
        assert_eq!(Summary::of_ratios(&[2.0, 6.0], &[1.0]).unwrap().count, 1);
    }

    #[test]
    fn units_suit_the_value() {
        assert_eq!(seconds(12.34), "12.3 s");
        assert_eq!(seconds(0.1234), "123 ms");
        assert_eq!(seconds(0.0012345), "1.23 ms");
        assert_eq!(seconds(1.2e-5), "12.0 µs");
        assert_eq!(times(203.4), "203");
        assert_eq!(times(0.0123), "0.0123");
    }
}
