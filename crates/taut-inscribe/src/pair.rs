//! Numbers of twice the precision, for cross products of differences.

/// A number as the sum of two: the second at most half a unit of the last place of the first.
pub(crate) type Pair = (f64, f64);

/// a − b, exactly.
pub(crate) fn minus(a: f64, b: f64) -> Pair {
    let difference = a - b;
    let of_b = a - difference;
    (difference, (a - (difference + of_b)) + (of_b - b))
}

/// a·b, exactly unless something underflows.
fn product(a: f64, b: f64) -> Pair {
    let split = |x: f64| {
        let wide = ((1u32 << 27) + 1) as f64 * x;
        let high = wide - (wide - x);
        (high, x - high)
    };
    let (product, (ah, al), (bh, bl)) = (a * b, split(a), split(b));
    (product, ((ah * bh - product) + ah * bl + al * bh) + al * bl)
}

/// The cross product of two vectors, with an error of about u² times their lengths.
pub(crate) fn cross(d: [Pair; 2], e: [Pair; 2]) -> f64 {
    let ((left, left_rest), (right, right_rest)) =
        (product(d[0].0, e[1].0), product(d[1].0, e[0].0));
    let (high, low) = minus(left, right);
    let rest = (d[0].0 * e[1].1 + d[0].1 * e[1].0) - (d[1].0 * e[0].1 + d[1].1 * e[0].0);
    high + (low + (left_rest - right_rest) + rest)
}
