//! The vertices of a polygon, as they are given for signs and scaled for distances.
//!
//! Rows (x, y, r) are rings: r is 0 in the first row, and in each other row that of the row before or one more. Edge i leads from
//! row i to the next row of its ring, from the last one to the first. Inside is what an odd number of edges separate from infinity.

use super::PolygonViolation;
use super::signs::crosses_left_of;

/// The vertices, ring by ring.
pub(crate) struct Polygon {
    exact: Vec<[f64; 2]>,
    scaled: Vec<[f64; 2]>,
    /// The row at which the edge that begins at a row ends.
    after: Vec<u32>,
    /// The product of both is the power of two that brings the largest coordinate to [1, 2); one alone could overflow.
    factors: [f64; 2],
}

impl Polygon {
    /// Takes rows (x, y, r) for rings.
    pub(super) fn of(rows: &[[f64; 3]]) -> Result<Self, PolygonViolation> {
        let after = ring_ends(rows)?;
        let exact: Vec<[f64; 2]> = rows.iter().map(|row| [row[0], row[1]]).collect();
        let largest = exact.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
        let factors = factors_of(largest);
        let scaled = exact.iter().map(|p| p.map(|x| x * factors[0] * factors[1])).collect();
        Ok(Polygon { exact, scaled, after, factors })
    }

    /// Edges, which are as many as vertices.
    pub(crate) fn len(&self) -> usize {
        self.exact.len()
    }

    /// The edge from a vertex to the next of its ring, as given.
    pub(crate) fn edge(&self, edge: usize) -> [[f64; 2]; 2] {
        [self.exact[edge], self.exact[self.after(edge)]]
    }

    /// The edge from a vertex to the next of its ring, scaled.
    pub(crate) fn scaled_edge(&self, edge: usize) -> [[f64; 2]; 2] {
        [self.scaled[edge], self.scaled[self.after(edge)]]
    }

    /// The row at which an edge ends.
    pub(crate) fn end(&self, edge: usize) -> u32 {
        self.after[edge]
    }

    fn after(&self, vertex: usize) -> usize {
        self.after[vertex] as usize
    }

    /// The smallest rectangle that holds all vertices, as its lower and upper corner; `None` without vertices.
    pub(crate) fn bounding_box(&self) -> Option<[[f64; 2]; 2]> {
        let first = *self.exact.first()?;
        Some(self.exact.iter().fold([first, first], |[low, high], p| {
            [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
        }))
    }

    /// Tests whether an odd number of edges cross the horizontal line through p to the left of it. A p on an edge counts as lying to
    /// the right of it; its distance to that edge is 0.
    pub(crate) fn is_inside(&self, p: [f64; 2]) -> bool {
        (0..self.len()).filter(|&edge| crosses_left_of(self.edge(edge), p)).count() % 2 == 1
    }

    /// A length in scaled units; exact unless it underflows, for which distances have an error bound.
    pub(crate) fn scaled(&self, length: f64) -> f64 {
        length * self.factors[0] * self.factors[1]
    }

    /// A length in scaled units, not rounded down.
    pub(crate) fn scaled_up(&self, length: f64) -> f64 {
        let scaled = self.scaled(length);
        if self.unscaled(scaled) < length { scaled.next_up() } else { scaled }
    }

    /// A point in scaled units. A point far from the polygon may overflow, which proves nothing of it.
    pub(crate) fn scaled_point(&self, p: [f64; 2]) -> [f64; 2] {
        p.map(|x| self.scaled(x))
    }

    /// A scaled length in units of the input, to the nearest number.
    pub(crate) fn unscaled(&self, length: f64) -> f64 {
        length / self.factors[0] / self.factors[1]
    }

    /// A scaled bound of a radius in units of the input, not rounded down. Every circle in a polygon has a radius of at most half
    /// its width, so that the largest number is a bound as well.
    pub(crate) fn unscaled_up(&self, bound: f64) -> f64 {
        let unscaled = self.unscaled(bound);
        let rounded = if self.scaled(unscaled) < bound { unscaled.next_up() } else { unscaled };
        rounded.min(f64::MAX)
    }
}

/// The row at which the edge that begins at each row ends.
fn ring_ends(rows: &[[f64; 3]]) -> Result<Vec<u32>, PolygonViolation> {
    let mut after: Vec<u32> = (1..=rows.len() as u32).collect();
    let mut first = 0;
    for (row, &[_, _, value]) in rows.iter().enumerate() {
        let before = if row == 0 { 0.0 } else { rows[row - 1][2] };
        let begins = row > 0 && value == before + 1.0;
        if !(value == before || begins) {
            return Err(PolygonViolation::RingNumber { row: row as u64, value });
        }
        if begins {
            after[row - 1] = first;
            first = row as u32;
        }
    }
    if let Some(last) = after.last_mut() {
        *last = first;
    }
    Ok(after)
}

/// Two powers of two whose product brings `largest` to [1, 2); both 1 for 0.
fn factors_of(largest: f64) -> [f64; 2] {
    if largest == 0.0 {
        return [1.0, 1.0];
    }
    let power = |exponent: i32| f64::from_bits(((1023 + exponent) as u64) << 52);
    let (bits, subnormal) = (largest.to_bits(), largest < f64::MIN_POSITIVE);
    let exponent = match subnormal {
        true => -1011 - bits.leading_zeros() as i32,
        false => (bits >> 52) as i32 - 1023,
    };
    let half = -exponent / 2;
    [power(half), power(-exponent - half)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_coordinate_is_brought_to_about_one() {
        for largest in [f64::from_bits(1), 1e-310, f64::MIN_POSITIVE, 1e-150, 1.0, 3.0, f64::MAX] {
            let [one, other] = factors_of(largest);
            let scaled = largest * one * other;
            assert!((1.0..2.0).contains(&scaled), "{largest:e}: {scaled}");
            assert_eq!(scaled / one / other, largest);
        }
    }
}
