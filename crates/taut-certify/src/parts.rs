//! Answers judged over points that lie in several places: each place judges its rows, and the verdict is that over all.
//!
//! *Idea.* A checker makes one pass in blocks, hashes them, keeps the rows that the certificate names and ends with these. So
//! whole blocks can be judged anywhere ([`AnySolution::check_part`]), and what was found in them merged in any order.
//! *Guarantee.* [`AnySolution::check_parts`] returns the verdict or the violation of [`AnySolution::check`] over all points.

mod findings;

use std::collections::BTreeMap;

use taut_points::{
    BlockRuns, Blocks, ByteReader, ByteWriter, Monitor, PartsError, PointSource, PointsHash, Rows,
    check_part, hash_block, map_blocks,
};

pub(crate) use self::findings::Findings;
use crate::ball::check::parts as ball;
use crate::centers::check::parts as centers;
use crate::ellipsoid::check::parts as ellipsoid;
use crate::hashed_pass::WantedRows;
use crate::{AnySolution, AnyVerdict, CheckError, Violation};

/// The findings of the checker in some blocks of rows.
#[derive(Clone, Debug, PartialEq)]
pub struct PartialVerdict {
    n: u64,
    columns: usize,
    /// The fingerprint of the answer with its certificate.
    answer: u64,
    blocks: BlockRuns,
    /// Rows that the certificate names.
    rows: BTreeMap<u64, Vec<f64>>,
    findings: Findings,
}

/// The word that bytes of a partial verdict begin with.
const VERDICT: &str = "verdict";

impl PartialVerdict {
    /// Merges these findings with those in other blocks, in either order.
    ///
    /// # Errors
    /// [`PartsError::Question`] where they are about two answers, [`PartsError::Twice`] for a block that both have.
    pub fn merge(self, other: Self) -> Result<Self, PartsError> {
        let about = |part: &Self| (part.n, part.columns, part.answer);
        if about(&self) != about(&other) {
            return Err(PartsError::Question);
        }
        let rows_of_block = Blocks::new(self.n, self.columns).range(0).end;
        let mut rows = self.rows;
        rows.extend(other.rows);
        Ok(PartialVerdict {
            blocks: self.blocks.merge(other.blocks, rows_of_block)?,
            rows,
            findings: self.findings.merge(other.findings),
            ..self
        })
    }

    /// The partial verdict as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = ByteWriter::new(VERDICT);
        for number in [self.n, self.columns as u64, self.answer] {
            bytes.whole(number);
        }
        self.blocks.write(&mut bytes);
        bytes.count(self.rows.len());
        for (&id, row) in &self.rows {
            bytes.whole(id);
            bytes.floats(row);
        }
        self.findings.write(&mut bytes);
        bytes.into_bytes()
    }

    /// Reads what [`to_bytes`](Self::to_bytes) wrote.
    ///
    /// # Errors
    /// [`PartsError::Bytes`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PartsError> {
        let mut bytes = ByteReader::new(VERDICT, bytes)?;
        let (n, columns, answer) = (bytes.whole()?, bytes.size()?, bytes.whole()?);
        let blocks = BlockRuns::read(&mut bytes)?;
        let mut rows = BTreeMap::new();
        for _ in 0..bytes.count(16)? {
            let (id, row) = (bytes.whole()?, bytes.floats()?);
            if row.len() != columns {
                return Err(bytes.wrong());
            }
            rows.insert(id, row);
        }
        let findings = Findings::read(&mut bytes)?;
        bytes.end(PartialVerdict { n, columns, answer, blocks, rows, findings })
    }
}

impl AnySolution {
    /// Refuses what is wrong without a look at the rows, and kinds that are judged over all of them at once.
    fn check_structure(&self, n: u64, columns: usize) -> Result<(), CheckError> {
        match self {
            AnySolution::Ball(found) => {
                ball::check_structure(&found.answer, &found.certificate, n, columns)
            }
            AnySolution::Ellipsoid(found) => {
                ellipsoid::check_structure(&found.answer, &found.certificate, n, columns)
            }
            AnySolution::Centers(found) => {
                centers::check_structure(&found.answer, &found.certificate, n, columns)
            }
            other => Err(CheckError::NoParts { kind: other.kind() }),
        }
    }

    /// Returns the FNV-1a hash of the JSON, which tells an answer from others about the same points.
    fn fingerprint(&self) -> u64 {
        self.to_json().bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        })
    }

    /// The hash and the rows that the certificate names.
    fn named(&self) -> Result<(PointsHash, Vec<u64>), CheckError> {
        match self {
            AnySolution::Ball(found) => {
                Ok((found.certificate.points_hash, found.certificate.support.clone()))
            }
            AnySolution::Ellipsoid(found) => {
                Ok((found.certificate.points_hash, found.certificate.support.clone()))
            }
            AnySolution::Centers(found) => {
                let rows = [&found.certificate.core_set[..], &found.answer.rows];
                Ok((found.certificate.points_hash, rows.concat()))
            }
            other => Err(CheckError::NoParts { kind: other.kind() }),
        }
    }

    fn check_block(
        &self,
        columns: usize,
        first: u64,
        rows: &Rows<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<Findings, CheckError> {
        match self {
            AnySolution::Ball(found) => {
                Ok(ball::check_block(&found.answer, &found.certificate, first, rows))
            }
            AnySolution::Ellipsoid(found) => {
                Ok(ellipsoid::check_block(&found.answer, &found.certificate, first, rows))
            }
            AnySolution::Centers(found) => {
                let (answer, certificate) = (&found.answer, &found.certificate);
                centers::check_block(answer, certificate, columns, first, rows, monitor)
            }
            other => Err(CheckError::NoParts { kind: other.kind() }),
        }
    }

    /// Judges the answer over the rows of `part`, whole blocks of a set of `n` rows that are numbered from `first_row` on.
    ///
    /// Balls around points and balls, ellipsoids around points of full rank, and centers of points and balls without weights, groups and
    /// assignment are judged in parts. The rows that are wrong are part of the
    /// result, so that the first of all of them is named in the end.
    ///
    /// # Errors
    /// [`CheckError::Rejected`] for what is wrong without a look at the rows, [`CheckError::Read`], [`CheckError::Parts`] where the part
    /// is not whole blocks, [`CheckError::NoParts`].
    pub fn check_part(
        &self,
        part: &dyn PointSource,
        first_row: u64,
        n: u64,
        monitor: &Monitor<'_>,
    ) -> Result<PartialVerdict, CheckError> {
        let columns = part.dim();
        self.check_structure(n, columns)?;
        check_part(part, first_row, n)?;
        let (_, support) = self.named()?;
        let wanted = WantedRows::of(&support);
        let found = map_blocks(part, monitor, |row, rows| {
            let first = first_row + row;
            let kept = wanted.of_block(first, &rows, columns);
            let found = self.check_block(columns, first, &rows, monitor)?;
            Ok::<_, CheckError>((hash_block(&rows), kept, found))
        })?;
        let first_block = first_row / Blocks::new(n, columns).range(0).end.max(1);
        let blocks = BlockRuns::of(first_block, found.iter().map(|block| block.0));
        let values = found.iter().flat_map(|block| block.1.chunks_exact(columns));
        let ids = wanted.among(first_row, first_row + part.len());
        let rows = ids.iter().copied().zip(values.map(<[f64]>::to_vec)).collect();
        let findings = found.into_iter().map(|block| block.2);
        let findings = findings.reduce(Findings::merge).unwrap_or_default();
        let answer = self.fingerprint();
        Ok(PartialVerdict { n, columns, answer, blocks, rows, findings })
    }

    /// The verdict over all rows, from what was found in all parts.
    ///
    /// # Errors
    /// The violation that [`check`](Self::check) finds over all points; [`CheckError::Parts`] where blocks are missing.
    pub fn check_parts(
        &self,
        merged: &PartialVerdict,
        monitor: &Monitor<'_>,
    ) -> Result<AnyVerdict, CheckError> {
        let PartialVerdict { n, columns, blocks, rows, findings, .. } = merged;
        self.check_structure(*n, *columns)?;
        let (claimed, support) = self.named()?;
        let found = blocks.hash(*n, *columns)?;
        if merged.answer != self.fingerprint() {
            return Err(PartsError::Question.into());
        }
        findings.refuse_invalid()?;
        if found != claimed {
            let (claimed, found) = (claimed.to_string(), found.to_string());
            return Err(Violation::Hash { claimed, found }.into());
        }
        findings.refuse_outside()?;
        if support.iter().any(|id| !rows.contains_key(id)) {
            return Err(PartsError::Bytes { what: VERDICT }.into());
        }
        match self {
            AnySolution::Ball(found) => {
                ball::prove(&found.answer, &found.certificate, rows, *columns, monitor)
                    .map(AnyVerdict::Ball)
            }
            AnySolution::Ellipsoid(found) => {
                let (answer, certificate) = (&found.answer, &found.certificate);
                ellipsoid::prove(answer, certificate, findings, rows, *columns, monitor)
                    .map(AnyVerdict::Ellipsoid)
            }
            AnySolution::Centers(found) => {
                centers::prove(&found.answer, &found.certificate, rows, *n, *columns, monitor)
                    .map(AnyVerdict::Centers)
            }
            other => Err(CheckError::NoParts { kind: other.kind() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Ball, BallCertificate, Ellipsoid, EllipsoidCertificate, Items, Solution, Trace};
    use taut_points::{Points, hash_points};

    /// Two points at distance 2 among many between them, and the ball around them.
    fn ball(values: &[f64]) -> AnySolution {
        let points = Points::new(values, 2).unwrap();
        let answer = Ball { center: vec![0.0, 0.0], center_tail: vec![], radius: 1.0 };
        let certificate = BallCertificate {
            items: Items::Points,
            support: vec![3, 99_999],
            multipliers: vec![0.5, 0.5],
            directions: vec![],
            gap: 1e-15,
            points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
        };
        Solution { answer, certificate, trace: Trace::default() }.into()
    }

    /// The unit circle as an ellipsoid that claims to be about the points of this ball.
    fn ellipsoid(ball: &AnySolution) -> AnySolution {
        let AnySolution::Ball(ball) = ball else { unreachable!() };
        let unit = vec![vec![1.0, 0.0], vec![0.0, 1.0]];
        let answer = Ellipsoid {
            center: vec![0.0, 0.0],
            center_tail: vec![],
            matrix: unit.clone(),
            factor: unit,
            hull: None,
            log_volume: std::f64::consts::PI.ln(),
        };
        let certificate = EllipsoidCertificate {
            items: Items::Points,
            support: ball.certificate.support.clone(),
            multipliers: vec![0.5, 0.5],
            directions: vec![],
            left_out: vec![],
            gap: 1e-9,
            points_hash: ball.certificate.points_hash,
        };
        Solution { answer, certificate, trace: Trace::default() }.into()
    }

    fn values() -> Vec<f64> {
        let mut values: Vec<f64> = (0..200_000).map(|i| (f64::from(i) * 0.3).sin() / 2.0).collect();
        values[6..8].copy_from_slice(&[-1.0, 0.0]);
        values[199_998..].copy_from_slice(&[1.0, 0.0]);
        values
    }

    fn in_parts(solution: &AnySolution, values: &[f64]) -> Result<AnyVerdict, CheckError> {
        let monitor = Monitor::silent();
        let points = Points::new(values, 2).unwrap();
        let n = PointSource::len(&points);
        let blocks = Blocks::new(n, 2);
        let mut merged: Option<PartialVerdict> = None;
        for block in (0..blocks.count()).rev() {
            let range = blocks.range(block);
            let part = points.slice(range.start as usize..range.end as usize);
            let found = solution.check_part(&part, range.start, n, &monitor)?;
            let found = PartialVerdict::from_bytes(&found.to_bytes()).unwrap();
            merged = Some(match merged {
                Some(merged) => merged.merge(found)?,
                None => found,
            });
        }
        solution.check_parts(&merged.unwrap(), &monitor)
    }

    #[test]
    fn verdicts_and_violations_are_those_over_all_points() {
        let values = values();
        let right = ball(&values);
        let mut outside = values.clone();
        outside[70_000] = 1.5;
        outside[150_001] = -7.0;
        let mut odd = outside.clone();
        odd[150_001] = f64::NAN;
        let sets = [values.clone(), outside.clone(), odd];
        let solutions = [right.clone(), ball(&outside)];
        for solution in &solutions {
            for set in &sets {
                let wanted = solution.check(&Points::new(set, 2).unwrap(), &Monitor::silent());
                let found = in_parts(solution, set);
                assert_eq!(format!("{found:?}"), format!("{wanted:?}"));
            }
        }
        assert!(in_parts(&right, &values).is_ok());
        let first = in_parts(&right, &outside).unwrap_err().to_string();
        assert!(first.contains("the data changed"), "{first}");
        let first = in_parts(&solutions[1], &outside).unwrap_err().to_string();
        assert!(first.starts_with("point 35000 lies 1.5"), "{first}");
    }

    #[test]
    fn parts_that_do_not_belong_together_are_refused() {
        let monitor = Monitor::silent();
        let (values, first) = (values(), 32768);
        let solution = ball(&values);
        let points = Points::new(&values, 2).unwrap();
        let part = |from: usize, end: usize| {
            solution.check_part(&points.slice(from..end), from as u64, 100_000, &monitor).unwrap()
        };
        let (a, b) = (part(0, first), part(first, 100_000));
        let twice = a.clone().merge(a.clone());
        assert_eq!(twice, Err(PartsError::Twice { row: 0 }));
        let missing = solution.check_parts(&b, &monitor);
        assert!(matches!(missing, Err(CheckError::Parts(PartsError::Missing { row: 0 }))));
        let other = ball(&values[..199_998].iter().copied().chain([1.0, 0.5]).collect::<Vec<_>>());
        let all = b.merge(a).unwrap();
        let question = other.check_parts(&all, &monitor);
        assert!(matches!(question, Err(CheckError::Parts(PartsError::Question))));
        // Parts of the right ball prove neither another ball nor an ellipsoid, of the same points.
        let AnySolution::Ball(mut moved) = solution.clone() else { unreachable!() };
        moved.answer.center[0] = 1e-13;
        let question = AnySolution::from(moved).check_parts(&all, &monitor);
        assert!(matches!(question, Err(CheckError::Parts(PartsError::Question))));
        let question = ellipsoid(&solution).check_parts(&all, &monitor);
        assert!(matches!(question, Err(CheckError::Parts(PartsError::Question))));
        let odd = solution.check_part(&points.slice(0..7), 0, 100_000, &monitor);
        assert!(matches!(odd, Err(CheckError::Parts(PartsError::Boundary { .. }))));
    }
}
