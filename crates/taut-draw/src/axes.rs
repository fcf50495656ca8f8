//! From numbers to places on an axis, and the ticks that name them.
//!
//! *Idea.* Coordinates are divided by a power of two near the largest of them before anything else happens, so that
//! sums and differences neither overflow nor vanish. Ticks are multiples of 1, 2 or 5 times a power of ten; where
//! numbers are very large, very small or very close together, the axis says what they are counted in or from.
//! *Trap.* Points that differ only in their last digits: labels are differences from an offset named in the title.

use taut_points::{OrderBy, exponent_of, two_to};

use crate::number::{superscript, typeset};

/// The power of two near the largest of `values`; 1 if all are 0.
pub(crate) fn unit(values: impl Iterator<Item = f64>) -> f64 {
    let largest = values.filter(|v| v.is_finite()).fold(0.0_f64, |a, v| a.max(v.abs()));
    if largest == 0.0 { 1.0 } else { two_to(exponent_of(largest).clamp(-1022, 1023)) }
}

/// An interval of an axis, in multiples of a unit, and the pixels it covers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub(crate) unit: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// Pixels of `low` and `high`.
    pub(crate) pixels: [f64; 2],
}

impl Span {
    pub(crate) fn place(&self, value: f64) -> f64 {
        self.at_fraction(self.fraction(value))
    }

    fn fraction(&self, value: f64) -> f64 {
        (value / self.unit - self.low) / (self.high - self.low)
    }

    /// The map from numbers to pixels, if it has numbers itself.
    pub(crate) fn map(&self, is_log: bool) -> Option<AxisMap> {
        let scale = (self.pixels[1] - self.pixels[0]) / (self.high - self.low);
        let map = [self.pixels[0] - self.low * scale, scale / self.unit];
        map.iter().all(|x| x.is_finite()).then_some(AxisMap { zero: map[0], one: map[1], is_log })
    }

    /// Pixels of a length, positive.
    pub(crate) fn length(&self, value: f64) -> f64 {
        (value / self.unit / (self.high - self.low) * (self.pixels[1] - self.pixels[0])).abs()
    }

    pub(crate) fn tick(&self, tick: &Tick) -> f64 {
        self.at_fraction(tick.fraction)
    }

    pub(crate) fn at_fraction(&self, fraction: f64) -> f64 {
        self.pixels[0] + fraction * (self.pixels[1] - self.pixels[0])
    }
}

/// A map from numbers of an axis to pixels, for a page.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AxisMap {
    zero: f64,
    one: f64,
    /// True if the logarithm to base 10 is mapped.
    is_log: bool,
}

impl AxisMap {
    pub(crate) fn place(&self, value: f64) -> f64 {
        self.zero + self.one * if self.is_log { value.log10() } else { value }
    }

    /// As a list for a script.
    pub(crate) fn json(&self) -> String {
        format!("[{:?},{:?},{}]", self.zero, self.one, self.is_log)
    }
}

/// An interval with room at both ends; a single value gets an interval around it.
pub(crate) fn padded(low: f64, high: f64, part: f64) -> [f64; 2] {
    let width = high - low;
    if width > 0.0 {
        [low - part * width, high + part * width]
    } else {
        let around = if low == 0.0 { 1.0 } else { low.abs() * 0.5 };
        [low - around, low + around]
    }
}

/// A number on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    /// Where, as a part of the interval.
    pub(crate) fraction: f64,
    pub(crate) label: String,
}

/// The ticks of an axis, places between them without a label, and what its title has to add: " − 1000", ", in 10⁻³".
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Ticks {
    pub(crate) ticks: Vec<Tick>,
    /// As parts of the interval.
    pub(crate) between: Vec<f64>,
    pub(crate) offset: String,
    pub(crate) scale: String,
}

/// The step of 1, 2 or 5 times a power of ten that divides `width` into at most `most` parts: (digit, exponent).
fn step(width: f64, most: usize) -> (f64, i32) {
    let rough = width / most.max(1) as f64;
    let exponent = rough.log10().floor() as i32;
    let digit = rough / 10.0_f64.powi(exponent);
    match digit {
        d if d <= 1.0 => (1.0, exponent),
        d if d <= 2.0 => (2.0, exponent),
        d if d <= 5.0 => (5.0, exponent),
        _ => (1.0, exponent + 1),
    }
}

/// Ticks of a linear axis, at most `most` + 1.
pub(crate) fn linear(span: &Span, most: usize) -> Ticks {
    // Decimal unit: 10^shift near the largest value, so that everything below is of order one.
    let largest = span.low.abs().max(span.high.abs());
    let shift = ((largest.log10() + span.unit.log10()).floor() as i32).clamp(-300, 300);
    let factor = span.unit / 10.0_f64.powi(shift);
    let (low, high) = (span.low * factor, span.high * factor);
    let width = high - low;
    if !(width > 0.0 && width.is_finite()) {
        return Ticks::default();
    }
    let (digit, exponent) = step(width, most);
    // Close together and far from 0: count from a round number in between.
    let far = width < 1e-4 * low.abs().max(high.abs());
    let offset = if far {
        let grain = 10.0_f64.powi(exponent + 1);
        ((low + width / 2.0) / grain).round() * grain
    } else {
        0.0
    };
    let (from, to) = (low - offset, high - offset);
    let stride = digit * 10.0_f64.powi(exponent);
    // The power of ten that labels count in, a multiple of three where the plain form would be long.
    let top = (from.abs().max(to.abs()).log10().floor() as i32) + shift;
    let bottom = exponent + shift;
    let counted = if top >= 5 || bottom < -3 { top.div_euclid(3) * 3 } else { 0 };
    let decimals = (counted - bottom).max(0) as usize;
    let first = (from / stride).ceil() as i64;
    let last = (to / stride).floor() as i64;
    let ticks = (first..=last)
        .map(|i| {
            let value = i as f64 * stride;
            let label =
                format!("{:.*}", decimals, i as f64 * digit * 10.0_f64.powi(bottom - counted));
            Tick { fraction: (value - from) / width, label: sign(&label) }
        })
        .collect();
    let offset = offset * 10.0_f64.powi(shift);
    Ticks {
        ticks,
        between: Vec::new(),
        offset: match offset {
            0.0 => String::new(),
            o if o < 0.0 => format!(" + {}", typeset(-o, 16)),
            o => format!(" − {}", typeset(o, 16)),
        },
        scale: if counted == 0 {
            String::new()
        } else {
            format!(", in 10{}", superscript(counted))
        },
    }
}

fn sign(label: &str) -> String {
    match label.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => label.to_owned(),
    }
}

/// Ticks of a logarithmic axis whose interval is given in powers of ten (`unit` is 1).
pub(crate) fn logarithmic(span: &Span, most: usize) -> Ticks {
    let width = span.high - span.low;
    let (first, last) = (span.low.ceil() as i32, span.high.floor() as i32);
    let stride = ((width / most.max(1) as f64).ceil() as i32).max(1);
    // All plain or all raised, so that neighbors compare at a glance.
    let plain = first >= -3 && last <= 4;
    let mut marks: Vec<(f64, String)> = (first..=last)
        .filter(|e| e.rem_euclid(stride) == 0)
        .map(|e| (f64::from(e), if plain { power(e) } else { raised(e) }))
        .collect();
    if marks.len() < 3 {
        for e in first - 1..=last {
            for digit in [2.0_f64, 5.0] {
                marks.push((f64::from(e) + digit.log10(), multiple(digit, e, plain)));
            }
        }
    }
    marks.order_by(&|a, b| a.0.total_cmp(&b.0));
    let inside = |at: &f64| (span.low..=span.high).contains(at);
    let ticks = marks
        .into_iter()
        .filter(|(at, _)| inside(at))
        .map(|(at, label)| Tick { fraction: (at - span.low) / width, label })
        .collect();
    Ticks { ticks, ..Ticks::default() }
}

fn power(exponent: i32) -> String {
    typeset(10.0_f64.powi(exponent), 6)
}

fn raised(exponent: i32) -> String {
    if exponent == 0 { "1".into() } else { format!("10{}", superscript(exponent)) }
}

fn multiple(digit: f64, exponent: i32, plain: bool) -> String {
    match plain {
        true => typeset(digit * 10.0_f64.powi(exponent), 6),
        false => format!("{digit}·10{}", superscript(exponent)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn span(low: f64, high: f64) -> Span {
        let unit = unit([low, high].into_iter());
        Span { unit, low: low / unit, high: high / unit, pixels: [0.0, 600.0] }
    }

    fn labels(low: f64, high: f64) -> (Vec<String>, String, String) {
        let ticks = linear(&span(low, high), 5);
        (ticks.ticks.into_iter().map(|t| t.label).collect(), ticks.offset, ticks.scale)
    }

    #[test]
    fn labels_are_round() {
        assert_eq!(labels(-1.0, 1.0).0, ["−1.0", "−0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(labels(0.0, 100.0).0, ["0", "20", "40", "60", "80", "100"]);
        assert_eq!(
            labels(0.0, 1e7),
            (vec_of(&["0", "2", "4", "6", "8", "10"]), "".into(), ", in 10⁶".into())
        );
        assert_eq!(labels(0.0, 5e-300).2, ", in 10⁻³⁰⁰");
    }

    #[test]
    fn close_numbers_are_counted_from_an_offset() {
        let (labels, offset, scale) = labels(1e6, 1e6 + 1e-3);
        assert!(labels.len() >= 3 && labels.iter().all(|l| l.len() < 8), "{labels:?}");
        assert!(offset.starts_with(" − 100000"), "{offset}");
        assert_eq!(scale, ", in 10⁻³");
    }

    #[test]
    fn any_interval_has_few_finite_ticks() {
        for (low, high) in [
            (-1e308, 1e308),
            (0.0, 5e-324),
            (-1e-300, 1e-300),
            (1.0, 1.0 + f64::EPSILON),
            (-1e300, 1.0),
            (1e308, 1.7e308),
        ] {
            let span = span(low, high);
            let ticks = linear(&span, 6);
            assert!(ticks.ticks.len() <= 8, "{low} {high}: {}", ticks.ticks.len());
            assert!(ticks.ticks.iter().all(|t| (-1e-6..=1.0 + 1e-6).contains(&t.fraction)));
            assert!(span.place(low).abs() < 1e-6 && (span.place(high) - 600.0).abs() < 1e-6);
        }
    }

    #[test]
    fn logarithms() {
        let at = |low, high| {
            let ticks = logarithmic(&Span { unit: 1.0, low, high, pixels: [0.0, 1.0] }, 6).ticks;
            ticks.into_iter().map(|t| t.label).collect::<Vec<_>>()
        };
        assert_eq!(at(-6.1, 0.2), ["10⁻⁶", "10⁻⁴", "10⁻²", "1"]);
        assert_eq!(at(0.1, 1.2), ["2", "5", "10"]);
        assert_eq!(at(4.1, 5.2), ["2·10⁴", "5·10⁴", "10⁵"]);
    }

    fn vec_of(labels: &[&str]) -> Vec<String> {
        labels.iter().map(|&l| l.to_owned()).collect()
    }
}
