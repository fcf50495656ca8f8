//! The oracle of orders: the rows are put in order once more, from the definition in docs/memory/order.md.

use std::cmp::Ordering;

use taut::Solution;
use taut::certify::{Order, OrderCurve, OrderVerdict};

use super::Truth;

/// Up to this many rows in one cell are in order of their coordinates.
const COORDINATE_ORDER_MAX: usize = 6;

/// The true facts about one input.
pub struct OrderOracle {
    rows: Vec<Vec<f64>>,
}

impl OrderOracle {
    /// Holds rows of the plane or of space.
    pub fn new(values: &[f64], columns: usize) -> Self {
        OrderOracle { rows: values.chunks_exact(columns).map(<[f64]>::to_vec).collect() }
    }

    /// Judges every claim of an accepted answer.
    pub fn judge(&self, solution: &Solution<Order>, verdict: &OrderVerdict) -> Truth {
        let mut rows: Vec<u64> = (0..self.rows.len() as u64).collect();
        let mut grids = 0;
        self.sort(&mut rows, solution.answer.curve, true, &mut grids);
        let claims = [
            (solution.answer.rows == rows, "the rows are in another order"),
            (verdict.points == rows.len() as u64, "the number of points is another one"),
            (verdict.grids == grids, "the number of grids is another one"),
        ];
        let lie = claims.iter().find(|(holds, _)| !holds);
        Truth::claim(lie.is_none(), || lie.map_or(String::new(), |(_, lie)| (*lie).into()))
    }

    fn sort(&self, rows: &mut [u64], curve: OrderCurve, is_all: bool, grids: &mut u64) {
        let at = |row: u64| &self.rows[row as usize];
        let cells =
            (is_all || rows.len() > COORDINATE_ORDER_MAX).then(|| self.cells(rows)).flatten();
        let Some((cells, bits)) = cells else {
            rows.sort_by(|&a, &b| {
                let by_coordinates = at(a).partial_cmp(at(b)).unwrap_or(Ordering::Equal);
                by_coordinates.then(a.cmp(&b))
            });
            return;
        };
        *grids += 1;
        let mut keyed: Vec<(u64, u64)> =
            cells.iter().zip(&*rows).map(|(cell, &row)| (place(curve, cell, bits), row)).collect();
        keyed.sort_unstable();
        for (row, (_, sorted)) in rows.iter_mut().zip(&keyed) {
            *row = *sorted;
        }
        let mut start = 0;
        for run in keyed.chunk_by(|a, b| a.0 == b.0) {
            if run.len() > 1 {
                self.sort(&mut rows[start..start + run.len()], curve, false, grids);
            }
            start += run.len();
        }
    }

    /// The cells of rows in a grid over their box, and the bits of a coordinate; none for a single place.
    fn cells(&self, rows: &[u64]) -> Option<(Vec<Vec<u64>>, u32)> {
        let first = &self.rows[*rows.first()? as usize];
        let (mut low, mut high) = (first.clone(), first.clone());
        for &row in rows {
            for (j, &x) in self.rows[row as usize].iter().enumerate() {
                (low[j], high[j]) = (low[j].min(x), high[j].max(x));
            }
        }
        let extent = |half: f64| {
            (0..low.len()).map(|j| high[j] * half - low[j] * half).fold(0.0f64, f64::max)
        };
        let half = if extent(1.0).is_finite() { 1.0 } else { 0.5 };
        let extent = extent(half);
        if extent == 0.0 {
            return None;
        }
        let lift = if extent < 1e-290 { 2f64.powi(600) } else { 1.0 };
        let bits = if low.len() == 2 { 16 } else { 10 };
        let scale = (1u64 << bits) as f64 / (extent * lift);
        let cell = |row: &u64| {
            let coordinates = self.rows[*row as usize].iter().zip(&low);
            let along = |(x, low): (&f64, &f64)| {
                let cell = ((x * half - low * half) * lift * scale).floor() as u64;
                cell.min((1 << bits) - 1)
            };
            coordinates.map(along).collect()
        };
        Some((rows.iter().map(cell).collect(), bits))
    }
}

/// The number of a cell on the curve.
fn place(curve: OrderCurve, cell: &[u64], bits: u32) -> u64 {
    let d = cell.len() as u32;
    if curve == OrderCurve::Morton {
        let bit = |axis: u32, i: u32| (cell[axis as usize] >> i & 1) << (d * i + axis);
        return (0..d).flat_map(|axis| (0..bits).map(move |i| bit(axis, i))).sum();
    }
    let parts = 1u64 << d;
    let turn = |x: u64, by: u32| {
        (0..d).map(|i| (x >> i & 1) << ((i + by) % d)).fold(0, |turned, bit| turned | bit)
    };
    let gray = |w: u64| w ^ (w >> 1);
    let (mut corner, mut axis, mut place) = (0, 0, 0);
    for i in (0..bits).rev() {
        let wanted = (0..d).map(|j| (cell[j as usize] >> i & 1) << j).sum::<u64>();
        // The parts are visited as w grows, part w at this corner.
        let visited = |w: &u64| turn(gray(*w), axis + 1) ^ corner == wanted;
        let w = (0..parts).find(visited).expect("every part is visited");
        place = place * parts + w;
        let enters = if w == 0 { 0 } else { gray(2 * ((w - 1) / 2)) };
        corner ^= turn(enters, axis + 1);
        let ones = match w {
            0 => 0,
            _ if w % 2 == 0 => (w - 1).trailing_ones(),
            _ => w.trailing_ones(),
        };
        axis = (axis + 1 + ones) % d;
    }
    place
}

#[test]
fn the_curve_visits_neighbors() {
    let mut cells: Vec<Vec<u64>> = (0..64).map(|i| vec![i % 4, i / 4 % 4, i / 16]).collect();
    cells.sort_by_key(|cell| place(OrderCurve::Hilbert, cell, 2));
    for pair in cells.windows(2) {
        let steps: u64 = pair[0].iter().zip(&pair[1]).map(|(a, b)| a.abs_diff(*b)).sum();
        assert_eq!(steps, 1, "{pair:?}");
    }
    assert_eq!(place(OrderCurve::Morton, &[1, 2], 2), 0b1001);
}
