//! Numbers as people read them.

use std::time::Duration;

/// All digits that matter: the shortest that reads back to the same number.
pub fn exact(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or_else(|| text.clone(), str::to_owned)
}

/// Nine digits at most, for numbers that are looked at.
pub fn short(value: f64) -> String {
    digits(value, 9)
}

/// So many digits at most, at least one; with 17 all that matter.
fn digits(value: f64, most: usize) -> String {
    format!("{value:.*e}", most - 1).parse().map_or_else(|_| value.to_string(), exact)
}

/// Nine digits, or as many as place the number within a thousandth of `size`.
fn beside(value: f64, size: f64) -> String {
    // Rounding to k digits moves v by at most 5·10^(log|v| − k), which is size/2000 for k = log(|v|/size) + 4.
    let needed = (value / size).abs().log10() + 4.0;
    // All digits where nothing less will do, and where there is no size.
    if needed <= 16.0 { digits(value, needed.max(9.0).ceil() as usize) } else { exact(value) }
}

/// A relative gap: two digits are enough.
pub fn gap(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") }
}

/// A whole number, in groups of three.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut grouped = String::with_capacity(digits.len() * 4 / 3 + 1);
    for (i, digit) in digits.chars().enumerate() {
        // Four digits read well as they are.
        if i > 0 && digits.len() > 4 && (digits.len() - i).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

/// A whole number of things: "1 point", "5,000 points".
pub fn counted(value: u64, noun: &str) -> String {
    format!("{} {noun}{}", count(value), if value == 1 { "" } else { "s" })
}

/// A span of time in seconds, or below one in milliseconds.
pub fn seconds(time: Duration) -> String {
    let time = time.as_secs_f64();
    match time {
        ..0.01 => format!("{:.1} ms", time * 1e3),
        ..1.0 => format!("{:.0} ms", time * 1e3),
        _ => format!("{time:.2} s"),
    }
}

/// Coordinates of a point beside a length `size`, with the digits that matter there; of many, the first few. What is
/// nothing beside the size is 0.
pub fn coordinates(point: &[f64], size: f64) -> String {
    const SHOWN_COORDINATES_MAX: usize = 6;
    let shown =
        if point.len() <= SHOWN_COORDINATES_MAX + 2 { point.len() } else { SHOWN_COORDINATES_MAX };
    let list: Vec<String> = point[..shown]
        .iter()
        .map(|&value| if value.abs() < 1e-12 * size { "0".to_owned() } else { beside(value, size) })
        .collect();
    match point.len() - shown {
        0 => format!("({})", list.join(", ")),
        _ => format!("({}, …)", list.join(", ")),
    }
}

/// Returns true if [`coordinates`] leaves some out.
pub fn abridged(point: &[f64]) -> bool {
    coordinates(point, 0.0).ends_with("…)")
}

/// An amount of memory or disk in words.
pub fn bytes(amount: u64) -> String {
    let units = [("TiB", 40), ("GiB", 30), ("MiB", 20), ("KiB", 10)];
    match units.into_iter().find(|(_, power)| amount >> power > 0) {
        Some((unit, power)) => format!("{:.1} {unit}", amount as f64 / (1u64 << power) as f64),
        None => format!("{amount} bytes"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(exact(1.0), "1");
        assert_eq!(exact(0.1 + 0.2), "0.30000000000000004");
        assert_eq!(exact(1e-300), "1e-300");
        assert_eq!(short(0.1 + 0.2), "0.3");
        assert_eq!(short(f64::NAN), "NaN");
        assert_eq!(short(-123_456_789_012.0), "-123456789000");
        assert_eq!(gap(0.0), "0");
        assert_eq!(gap(2.22e-16), "2.2e-16");
        assert_eq!(count(7291), "7291");
        assert_eq!(count(10_000), "10,000");
        assert_eq!(count(1_234_567), "1,234,567");
        assert_eq!(counted(1, "point"), "1 point");
        assert_eq!(coordinates(&[1.0, -0.5, -1e-13], 1.0), "(1, -0.5, 0)");
        assert_eq!(coordinates(&[0.0; 9], 1.0), "(0, 0, 0, 0, 0, 0, …)");
        assert_eq!(coordinates(&[1_000_000_000_001.0, 7.0], 0.5), "(1000000000001, 7)");
        assert_eq!(coordinates(&[1_000_000_000_001.25], 9000.0), "(1000000000001)");
        assert_eq!(coordinates(&[0.1 + 0.2, 1e300 / 3.0], 1.0), "(0.3, 3.3333333333333335e299)");
        assert_eq!(coordinates(&[0.1 + 0.2, 0.0], 0.0), "(0.30000000000000004, 0)");
        assert!(!abridged(&[0.0; 8]) && abridged(&[0.0; 9]));
    }
}
