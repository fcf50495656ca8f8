//! The least radius at which the alpha shape is one solid with all points on it or in it.
//!
//! *Problem.* Which α? Too small a one leaves points outside, or several solids; a larger one fills what is hollow.
//! *Idea.* Let cells enter in the order of their circumradii, and join each to those beside it that are there. The first radius at which
//! every site is a corner of a cell and there are no more solids than wanted is the answer.
//! *Guarantee.* The answer is the least `f64` α at which the shape is as wanted: the radius of each cell is rounded up to the next one
//! with exact signs, so that radii that differ by less enter together. O(n log n).
//! *Trap.* The number of solids does not fall steadily: a cell that is flat enough enters before those around it and is a solid of its own
//! for a while. So a binary search, as CGAL's `find_optimal_alpha` makes, may miss the least α; here all radii are gone through.
//! *Reference.* CGAL, 3D Alpha Shapes, `find_optimal_alpha`, for the criterion.

use taut_delaunay::Space;
use taut_points::InputError;
use taut_points::parallel::{IntoParallel, ParallelSlice};

use crate::Error;
use crate::surface::filter::cell_at_most;
use crate::surface::sides::Sides;
use crate::surface::vector::{dot, minus, sphere_center};

/// The least α at which every site is on a cell of the alpha shape, and these cells hang together by facets in at most `solids` sets.
/// Infinite if that is beyond all numbers.
///
/// # Errors
/// [`Error::Flat`] if the sites do not span space, [`Error::Input`] if `solids` is 0.
pub fn optimal_alpha(space: &Space, solids: usize) -> Result<f64, Error> {
    if solids == 0 {
        let (value, expected) = ("0".into(), "at least 1");
        return Err(Error::Input(InputError::Option { name: "solids", value, expected }));
    }
    let sides = Sides::of(space, &[])?;
    let radius = |cell| (!sides.is_ghost(cell)).then(|| (radius(&sides, cell).to_bits(), cell));
    let mut entering: Vec<(u64, u32)> = (0..sides.cell_count() as u32)
        .into_par_iter()
        .with_min_len(1 << 9)
        .filter_map(radius)
        .collect();
    entering.par_sort_unstable();
    let mut growing = Growing::over(&sides);
    for together in entering.chunk_by(|a, b| a.0 == b.0) {
        together.iter().for_each(|&(_, cell)| growing.enter(cell));
        if growing.outside == 0 && growing.solids <= solids {
            return Ok(sides.unscaled_up(f64::from_bits(together[0].0)));
        }
    }
    Ok(f64::INFINITY)
}

/// The solid as cells enter.
struct Growing<'a> {
    sides: &'a Sides,
    entered: Vec<bool>,
    /// Union-find over cells.
    parent: Vec<u32>,
    solids: usize,
    covered: Vec<bool>,
    /// Sites that are on no cell.
    outside: usize,
}

impl<'a> Growing<'a> {
    fn over(sides: &'a Sides) -> Self {
        let (cells, sites) = (sides.cell_count(), sides.points.len());
        Self {
            sides,
            entered: vec![false; cells],
            parent: (0..cells as u32).collect(),
            solids: 0,
            covered: vec![false; sites],
            outside: sites,
        }
    }

    fn enter(&mut self, cell: u32) {
        self.entered[cell as usize] = true;
        self.solids += 1;
        for site in self.sides.cell(cell) {
            self.outside -= usize::from(!std::mem::replace(&mut self.covered[site as usize], true));
        }
        for next in (0..4).map(|i| self.sides.mirror(cell << 2 | i) >> 2) {
            if self.entered[next as usize] {
                let (one, other) = (self.root(cell), self.root(next));
                self.solids -= usize::from(one != other);
                self.parent[one.max(other) as usize] = one.min(other);
            }
        }
    }

    fn root(&mut self, mut cell: u32) -> u32 {
        while self.parent[cell as usize] != cell {
            let above = self.parent[self.parent[cell as usize] as usize];
            self.parent[cell as usize] = above;
            cell = above;
        }
        cell
    }
}

/// The circumradius of a cell, rounded up: the least number with which [`cell_at_most`] holds.
fn radius(sides: &Sides, cell: u32) -> f64 {
    let [a, b, c, d] = sides.corners(cell);
    let center = sphere_center(minus(b, a), minus(c, a), minus(d, a));
    let guess = dot(center, center).sqrt();
    let guess = if guess.is_nan() { f64::MAX } else { guess.min(f64::MAX) };
    let enough = |bits: u64| cell_at_most(sides, cell, f64::from_bits(bits));
    least(guess.to_bits(), enough)
}

/// The least of the numbers, by their bits, from 0 to infinity, that are enough, given one next to it: by steps that double, then halve.
pub(in crate::surface) fn least(guess: u64, enough: impl Fn(u64) -> bool) -> f64 {
    let end = f64::INFINITY.to_bits();
    // `low` is not enough, or 0 has not been asked; `high` is.
    let (mut low, mut high, mut step) = (None, end, 1);
    if enough(guess) {
        high = guess;
        while high > 0 {
            let next = high.saturating_sub(step);
            if !enough(next) {
                low = Some(next);
                break;
            }
            (high, step) = (next, 2 * step);
        }
    } else {
        low = Some(guess);
        let mut reached = guess;
        while reached < end {
            reached = (reached + step).min(end);
            if enough(reached) {
                high = reached;
                break;
            }
            (low, step) = (Some(reached), 2 * step);
        }
    }
    while let Some(below) = low.filter(|&below| high - below > 1) {
        let middle = below + (high - below) / 2;
        if enough(middle) { high = middle } else { low = Some(middle) }
    }
    f64::from_bits(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_is_found_from_any_guess() {
        for truth in [0.0, f64::from_bits(1), 0.1, 1.0, 3e200, f64::MAX, f64::INFINITY] {
            for guess in [0.0, 1e-300, 0.1f64.next_up(), 1.0, f64::MAX, f64::INFINITY] {
                assert_eq!(least(guess.to_bits(), |bits| f64::from_bits(bits) >= truth), truth);
            }
        }
    }
}
