//! Delaunay insertions in the plane: each point replaces the triangles whose circumcircles hold it.
//!
//! *Idea.* A triangulation of taut is a function of the set of points alone. So the triangulation after an insertion is that of the
//! points inserted so far, however it comes about, and what an insertion does is the difference of two of them.

use std::collections::BTreeSet;

use serde_json::Value;
use taut_draw::{Figure, LineStyle, Shape2, Tone};
use taut_report::numbers::{count, counted};

use super::frame::{Frame, circles, layer, marked};
use super::{Table, Trace, said};
use crate::input::Opened;

/// Most points inserted; of more the first are taken.
const INSERTED_MAX: u64 = 400;

/// How far circles may reach beyond the points and still be drawn, as a part of the sides of the box around them.
const CIRCLE_MARGIN: f64 = 0.15;

/// The points in the order of their insertion.
#[derive(Debug)]
pub(super) struct Insertions {
    /// In that order.
    table: Table,
    /// The row of each in the input.
    rows: Vec<u64>,
    /// How many points there are in all.
    all: u64,
    frame: Frame,
}

/// A simplex by its vertices, ascending; edges while all points are on a line.
type Simplex = Vec<usize>;

impl Insertions {
    pub(super) fn new(points: &Opened) -> Result<Self, String> {
        let source = points.source();
        if source.dim() != 2 || source.is_empty() {
            return Err("the steps are shown for points of the plane".to_owned());
        }
        let read = Table::of(points, INSERTED_MAX)?;
        let view = taut::Points::new(&read.values, 2).map_err(|error| error.to_string())?;
        let order = taut::spatial_order(&view, &Default::default()).map_err(|e| e.to_string())?;
        let rows = order.answer.rows;
        let order: Vec<usize> = rows.iter().map(|&row| row as usize).collect();
        let table = Table { values: read.gathered(&order), dim: 2, names: read.names };
        let frame = Frame::of(&table).padded(CIRCLE_MARGIN);
        Ok(Insertions { table, rows, all: source.len(), frame })
    }

    /// The triangulation of the first `count` points.
    fn first(&self, count: usize) -> Result<BTreeSet<Simplex>, String> {
        let points = taut::Points::new(&self.table.values[..2 * count], 2);
        let points = points.map_err(|error| error.to_string())?;
        let found = taut::delaunay(&points, &Default::default()).map_err(|e| e.to_string())?;
        let sorted = |simplex: &[u32]| {
            let mut simplex: Simplex = simplex.iter().map(|&id| id as usize).collect();
            simplex.sort_unstable();
            simplex
        };
        Ok(found.answer.rows().map(sorted).collect())
    }

    /// The simplices that stay, those that go and those that come when point `step` is inserted.
    fn change(&self, step: usize) -> Result<[Vec<Simplex>; 3], String> {
        if step >= self.count() {
            return Err("there is no such step".to_owned());
        }
        let (before, after) = (self.first(step)?, self.first(step + 1)?);
        Ok([
            before.intersection(&after).cloned().collect(),
            before.difference(&after).cloned().collect(),
            after.difference(&before).cloned().collect(),
        ])
    }

    fn outlines(&self, simplices: &[Simplex]) -> Shape2 {
        let outline = |simplex: &Simplex| simplex.iter().map(|&id| self.table.place(id)).collect();
        Shape2::Polygons(simplices.iter().filter(|s| s.len() > 1).map(outline).collect())
    }
}

impl Trace for Insertions {
    fn count(&self) -> usize {
        self.table.len()
    }

    fn words(&self, step: usize) -> Result<Value, String> {
        let [_, gone, new] = self.change(step)?;
        let title = format!(
            "Point {} of {}: row {}",
            count(step as u64 + 1),
            count(self.count() as u64),
            count(self.rows[step] + 1)
        );
        let triangles = |of: &[Simplex]| {
            let noun =
                if of.iter().any(|simplex| simplex.len() == 3) { "triangle" } else { "edge" };
            counted(of.len() as u64, noun)
        };
        let mut text = match (gone.len(), new.len()) {
            (0, 0) if step > 0 => "It equals an earlier point, so nothing changes.".to_owned(),
            _ if step == 0 => "The first point.".to_owned(),
            (0, _) => format!(
                "It lies outside of all circumcircles: {} join it to the hull.",
                triangles(&new)
            ),
            _ => format!(
                "{} have it in their circumcircles, or see it beyond the hull, and are replaced by {}.",
                triangles(&gone),
                triangles(&new)
            ),
        };
        if step == 0 && self.all > self.count() as u64 {
            text += &format!(
                " The first {} of {} points are inserted here.",
                count(self.count() as u64),
                count(self.all)
            );
        }
        Ok(said(title, text + " The order is along a Hilbert curve."))
    }

    fn figure(&self, step: usize) -> Result<Figure, String> {
        let [kept, gone, new] = self.change(step)?;
        let around = |simplex: &Simplex| circumcircle(simplex, &self.table);
        let around = gone.iter().filter_map(around).filter(|&(at, r)| self.frame.holds(at, r));
        let inserted: Vec<usize> = (0..step).collect();
        let later: Vec<usize> = (step + 1..self.count()).collect();
        let layers = vec![
            marked(&self.table, &later, "still to come", Tone::Muted, 1.4),
            layer("triangles", Tone::Point, LineStyle::Thin, self.outlines(&kept)),
            layer("new", Tone::Answer, LineStyle::Filled, self.outlines(&new)),
            layer("replaced", Tone::Support, LineStyle::Dashed, self.outlines(&gone)),
            circles("their circumcircles", Tone::Second, LineStyle::Dashed, around),
            marked(&self.table, &inserted, "inserted", Tone::Ink, 2.4),
            marked(&self.table, &[step], "this point", Tone::Support, 5.0),
        ];
        Ok(self.frame.figure(&self.table, String::new(), String::new(), layers))
    }
}

/// Center and radius of the circle through the corners of a triangle; none of a flat one.
fn circumcircle(simplex: &Simplex, table: &Table) -> Option<([f64; 2], f64)> {
    let [a, b, c] = simplex[..] else { return None };
    let [a, b, c] = [a, b, c].map(|id| table.place(id));
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    let twice = 2.0 * (u[0] * v[1] - u[1] * v[0]);
    let (uu, vv) = (u[0] * u[0] + u[1] * u[1], v[0] * v[0] + v[1] * v[1]);
    let at = [(v[1] * uu - u[1] * vv) / twice, (u[0] * vv - v[0] * uu) / twice];
    let radius = at[0].hypot(at[1]);
    radius.is_finite().then_some(([a[0] + at[0], a[1] + at[1]], radius))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

    #[test]
    fn each_insertion_adds_two_triangles_inside() {
        let points = samples::generate("few").unwrap();
        let insertions = Insertions::new(&points).unwrap();
        assert_eq!(insertions.count(), 60);
        for step in 3..60 {
            let [kept, gone, new] = insertions.change(step).unwrap();
            // Each new triangle has the new point, no replaced one has, and the circles of those hold it.
            assert!(new.iter().all(|simplex| simplex.contains(&step)));
            assert!(kept.iter().chain(&gone).all(|simplex| !simplex.contains(&step)));
            for simplex in &gone {
                let (center, radius) = circumcircle(simplex, &insertions.table).unwrap();
                let [x, y] = insertions.table.place(step);
                assert!((x - center[0]).hypot(y - center[1]) < radius * (1.0 + 1e-9));
            }
        }
        assert_eq!(
            insertions.first(60).unwrap().len(),
            taut::delaunay(points.source(), &Default::default()).unwrap().answer.len()
        );
        assert!(insertions.figure(59).is_ok() && insertions.figure(60).is_err());
    }

    #[test]
    fn copies_and_lines_are_steps_too() {
        let points = Opened::read(b"0,0\n1,1\n2,2\n1,1\n0,2\n".to_vec(), "line.csv").unwrap();
        let insertions = Insertions::new(&points).unwrap();
        for step in 0..5 {
            insertions.words(step).unwrap();
            insertions.figure(step).unwrap();
        }
    }
}
