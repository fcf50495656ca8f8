//! Numbers as messages show them.

/// Writes a number as messages do: the shortest digits that give it back, with an exponent where it is very large or small.
///
/// ```
/// use taut_points::shown_number;
/// assert_eq!([1e308, 0.25, -1.0, 1e-9].map(shown_number), ["1e308", "0.25", "-1", "1e-9"]);
/// assert_eq!(shown_number(f64::NAN), "NaN");
/// ```
pub fn shown_number(value: f64) -> String {
    let digits = format!("{value:?}");
    match digits.strip_suffix(".0") {
        Some(whole) => whole.to_owned(),
        None => digits,
    }
}
