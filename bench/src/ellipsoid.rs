//! Ellipsoids: of points, of ellipsoids, and robust ones, each answer proved before its time is believed.

mod approximate;
mod case;
mod conic;
pub(crate) mod file;
mod judgement;
mod laws;
mod linear;
mod plane;
mod points;
mod real;
mod robust;
mod shapes;

use std::collections::BTreeMap;
use std::iter::{once, repeat};

use serde::{Deserialize, Serialize};
use taut_certify::{
    EllipseSupport, Ellipsoid, EllipsoidVerdict, Items, RobustEllipsoid, Solution, ellipse_support,
};
use taut_enclose::{
    BallOptions, EllipsoidOptions, RobustOptions, ball, ellipsoid, robust_ellipsoid,
};
use taut_points::{FileSource, ScalarKind};

use crate::prelude::*;
use crate::raw;
use crate::rounds::{self, Opponents, Rounds, TIME_COLUMNS};
pub(crate) use case::AREA;
use case::{DIFFERS, FASTER, Input, OBJECTIVE, OTHER_FLAGS, OTHER_THAN_PEER, OUTSIDE};
use judgement::Judgement;
use laws::Law;
use linear::product;
use points::{columns, shown_gap, solve};
use robust::Cloud;

/// The numbers of a file with one line of names, the first `columns` of each row, or all.
fn read(path: &Path, columns: Option<usize>) -> Result<(Vec<f64>, usize)> {
    let text = std::fs::read_to_string(path)?;
    let mut values = Vec::new();
    let mut width = None;
    for line in text.lines().skip(1) {
        let row = line.split(',').take(columns.unwrap_or(usize::MAX));
        let row = row.map(|field| field.trim().parse()).collect::<Result<Vec<f64>, _>>()?;
        ensure!(
            *width.get_or_insert(row.len()) == row.len(),
            "{}: rows of several lengths",
            path.display()
        );
        values.extend(row);
    }
    Ok((values, width.unwrap_or(0)))
}
