//! The changes of points before a surface was sought, in terms of all rows.
//!
//! *Trap.* A checker sees places alone: of rows in one place the first stands for all, whatever became of the others. So where an outlier
//! is in the place of a row that was kept, both are left out.

use taut_certify::TopologyDoubt;

use super::denoise::firsts;
use super::spheres::Point;
use super::{Denoise, Positions};

/// Where vertices are, if points were changed before a surface was sought.
#[derive(Clone, Debug, Default)]
pub(super) struct Changes {
    /// Rows that were left out, but for copies of others.
    pub(super) outliers: Vec<u32>,
    /// Each row that is in the place of an earlier one, with the first there; none if that is for the triangulation to say.
    pub(super) copies: Option<Vec<[u32; 2]>>,
    /// The place of each row, if it is another one than the row's own.
    pub(super) moved: Vec<Point>,
    /// The largest distance of such a place from the row.
    pub(super) displacement: f64,
    /// Reasons to doubt the topology that were found before the surface was.
    pub(super) doubts: Vec<TopologyDoubt>,
    /// The places of all rows, if the triangles are those of other places.
    pub(super) elsewhere: Option<Vec<Point>>,
}

impl Changes {
    /// Of rows that were given some are outliers, and the others, `rows` and `points`, are elsewhere now. Gives those that are left to be
    /// triangulated.
    pub(super) fn of(
        given: Vec<Point>,
        how: &Denoise,
        outliers: Vec<u32>,
        (rows, points): (Vec<u32>, Vec<Point>),
    ) -> (Self, Vec<u32>, Vec<Point>) {
        let is_moved = how.iterations > 0 && how.positions == Positions::Projected;
        let mut places = given.clone();
        if is_moved {
            rows.iter().zip(&points).for_each(|(&row, &point)| places[row as usize] = point);
        }
        let first = firsts(&places);
        let mut is_out = vec![false; given.len()];
        outliers.iter().for_each(|&row| is_out[first[row as usize] as usize] = true);
        let left = rows.into_iter().zip(points);
        let left = left.filter(|(row, _)| !is_out[first[*row as usize] as usize]);
        let (rows, points) = left.unzip();
        let all = 0..given.len() as u32;
        let is_first = |row: &u32| first[*row as usize] == *row;
        let copies = all.clone().filter(|row| !is_first(row)).map(|row| [row, first[row as usize]]);
        let changes = Self {
            outliers: all.filter(|row| is_out[*row as usize] && is_first(row)).collect(),
            copies: Some(copies.collect()),
            displacement: given.iter().zip(&places).map(apart).fold(0.0, f64::max),
            moved: if is_moved { places } else { Vec::new() },
            doubts: Vec::new(),
            elsewhere: (how.iterations > 0 && !is_moved).then_some(given),
        };
        (changes, rows, points)
    }
}

fn apart((from, to): (&Point, &Point)) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|k| to[k] - from[k]);
    x.hypot(y).hypot(z)
}
