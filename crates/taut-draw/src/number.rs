//! Numbers as people read them, and as SVG needs them.
//!
//! *Guarantee.* Words write a number as the reports beside pictures do; only the ticks of axes are typeset.

use taut_points::shown_number;

/// A pixel coordinate: two decimals, no trailing zeros, always finite.
pub(crate) fn px(value: f64) -> String {
    let rounded =
        if value.is_finite() { (value.clamp(-1e6, 1e6) * 100.0).round() / 100.0 } else { 0.0 };
    // Adding 0 turns −0 into 0.
    format!("{}", rounded + 0.0)
}

/// All digits that matter, as reports write them: the shortest that reads back to the same number.
pub(crate) fn exact(value: f64) -> String {
    shown_number(value)
}

/// At most `most` significant digits, as reports write them.
pub(crate) fn digits(value: f64, most: usize) -> String {
    format!("{value:.*e}", most.max(1) - 1).parse().map_or_else(|_| exact(value), exact)
}

/// A gap, as reports write it: two digits are enough.
pub(crate) fn gap(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") }
}

/// A number of a scale, at most `digits` significant digits: with raised powers of ten where the plain form would be long.
pub(crate) fn typeset(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let scientific = format!("{:.*e}", digits.max(1) - 1, value.abs());
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let body = if (-4..6.max(digits as i32)).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        trim(&format!("{:.*}", decimals, value.abs())).to_owned()
    } else {
        match trim(mantissa) {
            "1" => format!("10{}", superscript(exponent)),
            mantissa => format!("{mantissa}·10{}", superscript(exponent)),
        }
    };
    if value < 0.0 { format!("−{body}") } else { body }
}

fn trim(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

/// A whole number, in groups of three from five digits on.
pub(crate) fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && digits.len() > 4 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

/// `count` of a thing, in singular or plural: "1 point", "20,000 points".
pub(crate) fn counted(value: u64, thing: &str) -> String {
    format!("{} {thing}{}", count(value), if value == 1 { "" } else { "s" })
}

/// An exponent, raised.
pub(crate) fn superscript(value: i32) -> String {
    let raise = |c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
    };
    value.to_string().chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_typeset() {
        let cases = [
            (0.0, "0"),
            (1.0, "1"),
            (-0.5, "−0.5"),
            (1234.5678, "1234.6"),
            (123456.0, "123456"),
            (1e6, "10⁶"),
            (1.5e-9, "1.5·10⁻⁹"),
            (-2.5e300, "−2.5·10³⁰⁰"),
            (0.00012345678, "0.00012346"),
            (99999.99, "100000"),
        ];
        for (value, text) in cases {
            assert_eq!(typeset(value, 5), text);
        }
    }

    #[test]
    fn words_write_numbers_as_reports_do() {
        assert_eq!(exact(0.1 + 0.2), "0.30000000000000004");
        assert_eq!([exact(-2.0), exact(1.5e-9)], ["-2", "1.5e-9"]);
        assert_eq!([digits(1234.5678, 5), digits(99999.99, 5)], ["1234.6", "100000"]);
        assert_eq!([gap(0.0), gap(1.234e-16), gap(0.25)], ["0", "1.2e-16", "2.5e-1"]);
        assert_eq!(px(-0.001), "0");
        assert_eq!(px(12.3456), "12.35");
        assert_eq!(px(f64::NAN), "0");
        assert_eq!([count(7), count(1000), count(20_000_000)], ["7", "1000", "20,000,000"]);
        assert_eq!(superscript(-1024), "⁻¹⁰²⁴");
    }
}
