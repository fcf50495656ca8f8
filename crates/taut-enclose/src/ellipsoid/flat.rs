//! Points in an affine subspace: which one, and the ellipsoid in it.
//!
//! *Idea.* Coordinates are brought to size 1, so that the rank does not depend on their units. An affine basis is
//! grown by the point farthest from the span, of a sample first, then of all points, until none lies farther out than
//! rounding of the given coordinates explains. Projected on an orthonormal basis of it the points are a source of
//! their own, of full rank, and solved as any other.
//! *Guarantee.* The distance of every point from the subspace is part of the answer.
//! *Trap.* The zero that rank is measured against: a coordinate of size |x| and extent e is known to 2⁻⁵³·|x|/e of
//! that extent, so points far from the origin are flat at a larger thickness; but no other coordinate is known less well for
//! it. So coordinates are brought to size 1 rather than to extent 1, and one zero serves them all.
//! *Trap.* Points thicker than that, by less than what their leverages are found to, have no ellipsoid of full rank in `f64`:
//! then the zero is raised until they count as flat, up to where the checker would no longer agree.

use std::ops::Range;

use taut_certify::{Ellipsoid, Hull, Solution, Stop};
use taut_kernels::compensated::Map;
use taut_kernels::vector::{add_scaled, dot};
use taut_kernels::{Center, DoubleDouble};
use taut_points::{PointSource, Points, ReadError, Rows, Scalar, ScalarKind, Scratch};

use super::counters::Counters;
use super::outcome::{Candidate, Outcome, log_unit_ball};
use super::point_reader::{PassResult, PointReader};
use super::proof::{Flat, answer, settle, solution, spread};
use super::question::{Kind, Question};
use super::sample::Sample;
use super::whitener::{Rebased, Whitener};
use super::{EllipsoidOptions, method};
use crate::Error;
use crate::top::Far;

/// The excess of residuals over the rounding of the coordinates, for √d of them, and still count as none.
const ROUNDINGS: f64 = 16.0;
/// The zero is raised by this factor, up to the largest, for points that are neither flat nor have leverages.
const ZERO_GROWTH: f64 = 8.0;
const RAISED_MOST: f64 = 4096.0;
/// Part of the radius that no sum shows, whatever is added to it.
const ZERO_RATIO: f64 = 1e-100;

/// An affine subspace through an origin, in coordinates of size 1.
pub(super) struct Span {
    origin: Vec<f64>,
    /// By what each coordinate is divided: its extent, or what it is at the origin if that is more; 0 for one that never
    /// changes.
    sizes: Vec<f64>,
    /// Orthonormal rows.
    basis: Vec<Vec<f64>>,
    /// Residuals up to this are rounding.
    zero: f64,
}

impl Span {
    fn new(origin: &[f64], extents: &[f64], raised: f64) -> Self {
        let size = |(o, e): (&f64, &f64)| if *e > 0.0 { e.max(o.abs()) } else { 0.0 };
        Span {
            origin: origin.to_vec(),
            sizes: origin.iter().zip(extents).map(size).collect(),
            basis: vec![],
            zero: raised * ROUNDINGS * (origin.len() as f64).sqrt() * f64::EPSILON,
        }
    }

    /// The part of a row, relative to the origin, that lies outside the span, in coordinates of size 1.
    fn residual(&self, row: &mut [f64]) {
        for (x, &size) in row.iter_mut().zip(&self.sizes) {
            *x = if size > 0.0 { *x / size } else { 0.0 };
        }
        // Twice, as once leaves what rounding of a long row makes of a short residual.
        for direction in self.basis.iter().chain(&self.basis) {
            let product = dot(row, direction);
            add_scaled(row, -product, direction);
        }
    }

    /// Grows the span by the rows, relative to the origin, that lie outside it.
    fn grow(&mut self, mut rows: Vec<f64>) {
        let dim = self.origin.len();
        rows.chunks_exact_mut(dim).for_each(|row| self.residual(row));
        while self.basis.len() < dim {
            let squares = rows.chunks_exact(dim).map(|row| dot(row, row));
            let Some((farthest, square)) =
                squares.enumerate().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))
            else {
                return;
            };
            if square.sqrt() <= self.zero {
                return;
            }
            let mut direction = rows[farthest * dim..(farthest + 1) * dim].to_vec();
            for other in self.basis.iter().chain(&self.basis) {
                let product = dot(&direction, other);
                add_scaled(&mut direction, -product, other);
            }
            let norm = dot(&direction, &direction).sqrt();
            direction.iter_mut().for_each(|v| *v /= norm);
            for row in rows.chunks_exact_mut(dim) {
                let product = dot(row, &direction);
                add_scaled(row, -product, &direction);
            }
            self.basis.push(direction);
        }
    }

    /// One pass for the point farthest outside the span, if any is outside by more than rounding.
    fn farthest(&self, reader: &mut PointReader<'_>) -> Result<Option<u64>, Error> {
        let question = || Question {
            matrix: self.basis.concat(),
            center: Center { high: self.origin.clone(), low: self.sizes.clone() },
            kind: Kind::Span,
        };
        let far = match reader.ask(question)? {
            Some(answer) => answer.span()?,
            None => {
                let each = reader.visit(|first, rows| self.farthest_of_block(first, rows))?;
                let start = Far { id: 0, reach2: 0.0 };
                each.into_iter().fold(start, |a, b| if b.reach2 > a.reach2 { b } else { a })
            }
        };
        Ok((far.reach2 > self.zero).then_some(far.id))
    }

    /// The span that a question is about; its zero is for those who ask.
    pub(super) fn of_question(matrix: &[f64], center: &Center) -> Self {
        Span {
            origin: center.high.clone(),
            sizes: center.low.clone(),
            basis: matrix.chunks_exact(center.dim()).map(<[f64]>::to_vec).collect(),
            zero: 0.0,
        }
    }

    /// The point of a block that is farthest outside, with its distance in the place of a square.
    pub(super) fn farthest_of_block(&self, first: u64, rows: &[f64]) -> Far {
        let dim = self.origin.len();
        let mut best = Far { id: first, reach2: 0.0 };
        let mut row = vec![0.0; dim];
        for (id, values) in (first..).zip(rows.chunks_exact(dim)) {
            // A coordinate that never changed in the sample may change elsewhere.
            let mut moved = 0.0;
            for (j, (row, x)) in row.iter_mut().zip(values).enumerate() {
                *row = x - self.origin[j];
                if self.sizes[j] == 0.0 && *row != 0.0 {
                    moved = f64::INFINITY;
                }
            }
            self.residual(&mut row);
            let distance = dot(&row, &row).sqrt().max(moved);
            if distance > best.reach2 {
                best = Far { id, reach2: distance };
            }
        }
        best
    }

    /// Orthonormal rows in the given coordinates, r × d.
    fn directions(&self) -> Vec<f64> {
        let dim = self.origin.len();
        let mut rows: Vec<Vec<f64>> = self.basis.clone();
        for row in &mut rows {
            row.iter_mut().zip(&self.sizes).for_each(|(v, e)| *v *= e);
            // Entries of any size: no square may overflow or vanish.
            let largest = row.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            row.iter_mut().for_each(|v| *v /= largest);
        }
        let mut done: Vec<Vec<f64>> = vec![];
        for mut row in rows {
            for other in done.iter().chain(&done) {
                let product = dot(&row, other);
                add_scaled(&mut row, -product, other);
            }
            let norm = dot(&row, &row).sqrt();
            row.iter_mut().for_each(|v| *v /= norm);
            done.push(row);
        }
        debug_assert!(done.iter().all(|row| row.len() == dim));
        done.concat()
    }
}

pub(super) enum RankResult {
    /// That of the space: a sample that shows it, and its whitener.
    Full(Sample, Whitener),
    /// Less; solved.
    Flat(Box<Solution<Ellipsoid>>),
}

/// Takes a sample and decides the rank of the set; solves it if it is flat.
pub(super) fn decide_rank(
    reader: &mut PointReader<'_>,
    options: &EllipsoidOptions<'_>,
) -> Result<RankResult, Error> {
    let mut sample = Sample::new(reader)?;
    if !sample.is_finite() {
        // The first row that is not finite is to be named; if there is none, differences overflow.
        let question = || Question {
            matrix: vec![],
            center: Center { high: vec![], low: vec![] },
            kind: Kind::Finite,
        };
        if reader.ask(question)?.is_none() {
            reader.visit(|_, _| ())?;
        }
        return Err(Error::Overflow);
    }
    let extents = sample.extents();
    if reader.len() > reader.dim() as u64 && extents.iter().all(|&e| e > 0.0) {
        let (whitener, how) = sample.whitener(&extents);
        if how == Rebased::Plainly {
            return Ok(RankResult::Full(sample, whitener));
        }
    }
    let mut raised = 1.0;
    loop {
        let span = span(reader, &mut sample, raised)?;
        if span.basis.len() < reader.dim() {
            return flat(reader, &span, options).map(|found| RankResult::Flat(Box::new(found)));
        }
        let (whitener, how) = sample.whitener(&sample.extents());
        if how != Rebased::Never {
            return Ok(RankResult::Full(sample, whitener));
        }
        if raised >= RAISED_MOST {
            return Err(Error::Overflow);
        }
        raised *= ZERO_GROWTH;
    }
}

/// The span of all points, beginning with that of the sample, which takes up the points that are outside of it.
fn span(reader: &mut PointReader<'_>, sample: &mut Sample, raised: f64) -> Result<Span, Error> {
    let dim = reader.dim();
    loop {
        let mut rows = vec![0.0; sample.set.len() * dim];
        for (i, row) in rows.chunks_exact_mut(dim).enumerate() {
            sample.set.copy_row(i, row);
        }
        let mut span = Span::new(&sample.origin, &sample.extents(), raised);
        span.grow(rows);
        if span.basis.len() == dim {
            return Ok(span);
        }
        let Some(far) = span.farthest(reader)? else { return Ok(span) };
        // What is farthest outside, and is in the sample already, is rounding after all.
        if sample.set.contains(far) {
            return Ok(span);
        }
        let row = reader.rows_from(&sample.origin, &[far])?;
        sample.add(&[far], &row);
    }
}

/// The points as coordinates along the rows of a basis.
struct Projected<'a> {
    source: &'a dyn PointSource,
    origin: &'a [f64],
    /// r × d.
    directions: &'a [f64],
}

impl PointSource for Projected<'_> {
    fn len(&self) -> u64 {
        self.source.len()
    }

    fn dim(&self) -> usize {
        self.directions.len() / self.origin.len()
    }

    fn scalar(&self) -> ScalarKind {
        ScalarKind::F64
    }

    fn read<'a>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let (dim, rank) = (self.origin.len(), self.dim());
        let mut inner = Scratch::new();
        let rows = self.source.read(range, &mut inner)?;
        let values = scratch.values::<f64>(rows.len() as u64, rank)?;
        let mut row = vec![0.0; dim];
        for (i, image) in values.chunks_exact_mut(rank).enumerate() {
            rows.copy_row(i, &mut row);
            row.iter_mut().zip(self.origin).for_each(|(x, o)| *x -= o);
            for (y, direction) in image.iter_mut().zip(self.directions.chunks_exact(dim)) {
                *y = dot(direction, &row);
            }
        }
        let points = Points::new(values, rank).expect("the values are whole rows");
        Ok(f64::rows(points))
    }
}

/// The ellipsoid in a subspace that all points lie in.
fn flat(
    reader: &mut PointReader<'_>,
    span: &Span,
    options: &EllipsoidOptions<'_>,
) -> Result<Solution<Ellipsoid>, Error> {
    let dim = reader.dim();
    let directions = span.directions();
    let rank = directions.len() / dim;
    if reader.source().elsewhere().is_some() {
        return Err(Error::FlatInParts { rank, dim });
    }
    if rank == 0 {
        return point(reader, options);
    }
    let source =
        Projected { source: reader.source(), origin: &span.origin, directions: &directions };
    let mut projected = PointReader::new(&source, reader.monitor())?;
    let sample = Sample::new(&projected)?;
    let (whitener, how) = sample.whitener(&sample.extents());
    if how == Rebased::Never {
        return Err(Error::Overflow);
    }
    let outcome = method(&mut projected, &sample, whitener, options)?;
    reader.count(projected.passes());
    let inner = &outcome.best;
    // M(y − c) = MB(x − o) − Mc for y = B(x − o).
    let mut matrix = vec![0.0; rank * dim];
    for (row, m) in matrix.chunks_exact_mut(dim).zip(inner.matrix.chunks_exact(rank)) {
        for (&m, direction) in m.iter().zip(directions.chunks_exact(dim)) {
            add_scaled(row, m, direction);
        }
    }
    let center = lifted(&span.origin, &directions, &inner.center);
    let (extents, distance) = extents(reader, &center, &directions)?;
    // What no point makes anything of only has squares that vanish.
    for row in matrix.chunks_exact_mut(dim) {
        row.iter_mut()
            .zip(&extents)
            .filter(|(m, e)| (**m * **e).abs() < ZERO_RATIO)
            .for_each(|(m, _)| *m = 0.0);
    }
    let map = Map { matrix: &matrix, center: &center, triangular: false };
    let basis = directions.chunks_exact(dim).map(<[f64]>::to_vec).collect();
    let hull = Hull { basis, distance };
    let flat = Flat { hull: &hull, reach: extents.iter().sum() };
    let settled = settle(reader, inner, map, spread(&matrix, &extents), Some(flat))?;
    let logs: f64 = (0..rank).map(|a| inner.matrix[a * rank + a].ln()).sum();
    let log_volume = log_unit_ball(rank) - logs - rank as f64 * settled.scale.ln();
    let answer = answer(&settled.factor, center, log_volume, Some(hull))?;
    Ok(solution(reader, answer, outcome, settled.gap, options))
}

/// The center in the space of the points.
pub(super) fn lifted(origin: &[f64], directions: &[f64], center: &Center) -> Center {
    let dim = origin.len();
    let mut terms: Vec<DoubleDouble> = origin.iter().map(|&o| o.into()).collect();
    for (k, direction) in directions.chunks_exact(dim).enumerate() {
        let coordinate =
            DoubleDouble { high: center.high[k], low: center.low.get(k).copied().unwrap_or(0.0) };
        for (term, &b) in terms.iter_mut().zip(direction) {
            *term = *term + coordinate * b.into();
        }
    }
    Center {
        high: terms.iter().map(|term| term.high).collect(),
        low: terms.iter().map(|term| term.low).collect(),
    }
}

/// One pass for the largest |x_j − c_j| of each coordinate, and the largest distance from the subspace, rounded up.
fn extents(
    reader: &mut PointReader<'_>,
    center: &Center,
    directions: &[f64],
) -> Result<(Vec<f64>, f64), Error> {
    let dim = center.dim();
    let each = reader.visit(|_, rows| {
        let mut extents = vec![0.0f64; dim];
        let mut distance = 0.0f64;
        let mut row = vec![0.0; dim];
        for values in rows.chunks_exact(dim) {
            for (j, (row, x)) in row.iter_mut().zip(values).enumerate() {
                *row = (x - center.high[j]) - center.low.get(j).copied().unwrap_or(0.0);
                extents[j] = extents[j].max(row.abs());
            }
            // Units that no square overflows in.
            let largest = row.iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
            row.iter_mut().for_each(|v| *v /= largest);
            for direction in directions.chunks_exact(dim) {
                let product = dot(&row, direction);
                add_scaled(&mut row, -product, direction);
            }
            distance = distance.max(largest * dot(&row, &row).sqrt());
        }
        (extents, distance)
    })?;
    let mut extents = vec![0.0f64; dim];
    let mut distance = 0.0f64;
    for (block, far) in each {
        extents.iter_mut().zip(block).for_each(|(e, v)| *e = e.max(v));
        distance = distance.max(far);
    }
    let reach = extents.iter().fold(0.0f64, |m, v| m.max(*v));
    // The amount that rounding may have hidden: of r products with rows as long as √d times the reach.
    let rounding = 4.0 * f64::EPSILON * (dim as f64).sqrt() * (dim + directions.len() / dim) as f64;
    Ok((extents, distance * (1.0 + 1e-12) + rounding * reach))
}

fn point(
    reader: &mut PointReader<'_>,
    options: &EllipsoidOptions<'_>,
) -> Result<Solution<Ellipsoid>, Error> {
    let center = Center { high: reader.rows(&[0])?, low: vec![] };
    let best = Candidate {
        support: vec![0],
        multipliers: vec![1.0],
        matrix: vec![],
        center: center.clone(),
        found: PassResult { largest: 0.0, far: vec![], listed_above: 0.0 },
    };
    let outcome = Outcome {
        best,
        stop: Stop::Converged,
        iterations: 0,
        core_set: 1,
        history: vec![],
        counters: Counters::default().into_named(),
    };
    let (_, distance) = extents(reader, &center, &[])?;
    let hull = Hull { basis: vec![], distance };
    let answer = answer(&[], center, 0.0, Some(hull))?;
    Ok(solution(reader, answer, outcome, 0.0, options))
}
