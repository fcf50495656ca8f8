//! The boxes of the grid in which the corners of the triangles lie.

use super::BodiesViolation;

/// Coordinates of the grid are at most this, so that all sums and products fit.
pub(super) const COORDINATE_MAX: i64 = 1 << 30;

/// Exponents of the unit for which neither the unit nor its cube leaves the range of normal numbers.
const EXPONENTS: std::ops::RangeInclusive<i32> = -300..=310;

/// Coordinates in units are below this, so that whole numbers hold them.
const UNITS_MAX: f64 = (1u64 << 61) as f64;

/// Triangles of a block. Those that follow each other in a list are mostly near each other, and what is known of the box of a block holds
/// for all of them: most blocks are looked at once for a body.
const BLOCK_ROWS: usize = 16;

/// Blocks of a group, which are looked at once where all of them are far from a body.
const GROUP_BLOCKS: usize = 8;

/// For each corner of each triangle and then of each cap the floors and the ceilings of its coordinates, in units from the origin:
/// in 32 bits, as much of the time of a check goes into reading them for each body.
pub(super) struct Boxes {
    /// How many triangles are those of the mesh.
    pub(super) rows: usize,
    pub(super) floors: Vec<[[i32; 3]; 3]>,
    pub(super) ceilings: Vec<[[i32; 3]; 3]>,
    /// The least floors and the largest ceilings of each block of triangles.
    blocks: Vec<[[i32; 3]; 2]>,
    /// The same of each group of blocks.
    groups: Vec<[[i32; 3]; 2]>,
}

/// Triangles by their numbers, the least of their floors, and the largest of their ceilings.
pub(super) type Rows<'a> = (std::ops::Range<usize>, &'a [i32; 3], &'a [i32; 3]);

/// 2^exponent, for an exponent of normal numbers.
pub(super) fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((exponent + 1023) as u64) << 52)
}

impl Boxes {
    /// The boxes of the triangles of a mesh, of which the first `rows` are not caps.
    pub(super) fn of(
        triangles: &[[[f64; 3]; 3]],
        rows: usize,
        grid: &Grid,
    ) -> Result<Self, BodiesViolation> {
        let mut floors = vec![[[0; 3]; 3]; triangles.len()];
        let mut ceilings = floors.clone();
        let all = floors.as_flattened_mut().iter_mut().zip(ceilings.as_flattened_mut());
        for (point, (low, high)) in triangles.as_flattened().iter().zip(all) {
            let [floor, ceiling] = grid.around(*point)?;
            for c in 0..3 {
                // At most 2^30.
                (low[c], high[c]) = (floor[c] as i32, ceiling[c] as i32);
            }
        }
        Ok(Boxes::around(rows, floors, ceilings))
    }

    pub(super) fn around(
        rows: usize,
        floors: Vec<[[i32; 3]; 3]>,
        ceilings: Vec<[[i32; 3]; 3]>,
    ) -> Self {
        let extreme = |corners: &[[i32; 3]], pick: fn(i32, i32) -> i32| {
            let corners = corners.iter().copied();
            corners.reduce(|p, q| [0, 1, 2].map(|c| pick(p[c], q[c]))).unwrap_or_default()
        };
        let pairs = floors.chunks(BLOCK_ROWS).zip(ceilings.chunks(BLOCK_ROWS));
        let blocks: Vec<[[i32; 3]; 2]> = pairs
            .map(|(low, high)| {
                [extreme(low.as_flattened(), i32::min), extreme(high.as_flattened(), i32::max)]
            })
            .collect();
        let of_group = |group: &[[[i32; 3]; 2]]| {
            let ends = group.as_flattened();
            [extreme(ends, i32::min), extreme(ends, i32::max)]
        };
        let groups = blocks.chunks(GROUP_BLOCKS).map(of_group).collect();
        Boxes { rows, floors, ceilings, blocks, groups }
    }

    /// The groups of blocks.
    pub(super) fn groups(&self) -> impl Iterator<Item = Rows<'_>> {
        let rows = BLOCK_ROWS * GROUP_BLOCKS;
        self.groups.iter().enumerate().map(move |(group, [low, high])| {
            let first = group * rows;
            (first..self.floors.len().min(first + rows), low, high)
        })
    }

    /// The blocks of all triangles, or of the triangles of one group.
    pub(super) fn blocks(&self, of: std::ops::Range<usize>) -> impl Iterator<Item = Rows<'_>> {
        let blocks = of.start / BLOCK_ROWS..of.end.div_ceil(BLOCK_ROWS);
        self.blocks[blocks.clone()].iter().zip(blocks).map(|([low, high], block)| {
            let first = block * BLOCK_ROWS;
            (first..self.floors.len().min(first + BLOCK_ROWS), low, high)
        })
    }
}

/// A grid: y stands for (`origin` + y)/`per_unit`.
pub(super) struct Grid {
    per_unit: f64,
    origin: [i64; 3],
}

impl Grid {
    pub(super) fn of(exponent: i32, origin: [i64; 3]) -> Result<Self, BodiesViolation> {
        if !EXPONENTS.contains(&exponent) {
            return Err(BodiesViolation::Grid { problem: "the exponent is not from -300 to 310" });
        }
        Ok(Grid { per_unit: power_of_two(-exponent), origin })
    }

    /// The floors and the ceilings of the coordinates of a point.
    pub(super) fn around(&self, point: [f64; 3]) -> Result<[[i64; 3]; 2], BodiesViolation> {
        let (mut low, mut high) = ([0; 3], [0; 3]);
        for c in 0..3 {
            let [floor, ceiling] = match whole(point[c], self.per_unit) {
                Some(ends) => ends.map(|y| y.saturating_sub(self.origin[c])),
                None => [i64::MIN, i64::MAX],
            };
            if floor < -COORDINATE_MAX || ceiling > COORDINATE_MAX {
                let problem = "a coordinate is more than 2^30 units from the origin";
                return Err(BodiesViolation::Grid { problem });
            }
            (low[c], high[c]) = (floor, ceiling);
        }
        Ok([low, high])
    }
}

/// The floor and the ceiling of a number of units, exactly.
///
/// The product is exact unless it is subnormal, and then it is less than 1, as the exact number is.
fn whole(x: f64, per_unit: f64) -> Option<[i64; 2]> {
    let units = x * per_unit;
    if units.abs() < 1.0 {
        return Some([-i64::from(x < 0.0), i64::from(x > 0.0)]);
    }
    let fits = units.abs() < UNITS_MAX;
    if !fits {
        return None;
    }
    // The cast rounds towards 0, and back it is exact.
    let whole = units as i64;
    let rounded = whole as f64;
    Some([whole - i64::from(rounded > units), whole + i64::from(rounded < units)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floors_and_ceilings_are_exact() {
        for (x, exponent, expected) in [
            (0.0, 0, Some([0, 0])),
            (-0.0, 0, Some([0, 0])),
            (5e-324, 310, Some([0, 1])),
            (-1e-300, 0, Some([-1, 0])),
            (0.75, -2, Some([3, 3])),
            (0.75, -1, Some([1, 2])),
            (-0.75, -1, Some([-2, -1])),
            (1.0, 0, Some([1, 1])),
            (-1.0, 0, Some([-1, -1])),
            (f64::MAX, 310, None),
            (f64::MAX, -300, None),
        ] {
            assert_eq!(whole(x, power_of_two(-exponent)), expected, "{x} in 2^{exponent}");
        }
    }
}
