//! Where the vertices are, and what arithmetic on their coordinates may rely on.

use std::cmp::Ordering;

use taut_points::{Monitor, PointSource, Points, Scratch};

use super::super::{Surface, SurfaceCertificate};
use crate::triangulation::{Input, Signs, Tetrahedra, turn};
use crate::{CheckError, Violation};

/// The place of each row, multiplied by a power of two.
pub(super) struct Places {
    pub(super) all: Vec<[f64; 3]>,
    pub(super) signs: Signs,
    /// That power; 1 where it would lose bits.
    pub(super) scale: f64,
}

/// All places, if the rows are those of the hash, and the largest distance of a place from its row.
pub(super) fn read(
    surface: &Surface,
    certificate: &SurfaceCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<(Places, f64), CheckError> {
    let mut scratch = Scratch::new();
    let rows = Input::<3>::read(source, &mut scratch, monitor)?;
    if rows.hash != certificate.points_hash {
        let (claimed, found) = (certificate.points_hash.to_string(), rows.hash.to_string());
        return Err(Violation::Hash { claimed, found }.into());
    }
    let length = "the list of vertices";
    match Points::new(surface.vertices.as_flattened(), 3) {
        Ok(moved) if !surface.vertices.is_empty() => {
            let apart = (0..).zip(&surface.vertices).map(|(row, to)| distance(&rows.row(row), to));
            let displacement = apart.fold(0.0, f64::max);
            let mut scratch = Scratch::new();
            let input = Input::<3>::read(&moved, &mut scratch, &Monitor::silent())?;
            Ok((Places::of(&input), displacement))
        }
        Ok(_) => Ok((Places::of(&rows), 0.0)),
        // Its length was found to be that of the rows.
        Err(_) => Err(Violation::Length { what: length, found: 0, expected: rows.len() }.into()),
    }
}

/// The distance of two points, rounded up; infinite where it is beyond the largest number.
fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let apart = (b[0] - a[0]).hypot(b[1] - a[1]).hypot(b[2] - a[2]);
    // Each of two roots of subnormal numbers may lose the least of them, which no factor makes up for.
    let raised = (apart * (1.0 + 8.0 * f64::EPSILON)).next_up().next_up();
    if a == b { 0.0 } else { raised }
}

impl Places {
    fn of(input: &Input<'_, 3>) -> Self {
        let all = (0..input.len() as u32).map(|row| input.scaled(&input.row(row))).collect();
        Places { all, signs: input.signs(), scale: input.scale() }
    }

    pub(super) fn corners(&self, triangle: [u32; 3]) -> [[f64; 3]; 3] {
        triangle.map(|row| self.all[row as usize])
    }
}

/// The sign of det(b − a, c − a, d − a).
pub(super) fn side(signs: &Signs, [a, b, c]: &[[f64; 3]; 3], d: &[f64; 3]) -> Ordering {
    signs.orientation::<Tetrahedra, 3, 4>(&[*a, *b, *c, *d])
}

/// The first two coordinates, in the order xy, xz, yz, in which a triangle has an area; `None` if it is flat.
pub(super) fn axes(signs: &Signs, [a, b, c]: &[[f64; 3]; 3]) -> Option<[usize; 2]> {
    [[0, 1], [0, 2], [1, 2]].into_iter().find(|&axes| turn(signs, a, b, c, axes).is_ne())
}
