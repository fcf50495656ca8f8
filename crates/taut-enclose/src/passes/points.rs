//! The questions of the ellipsoid, on their way to parts and back.

use taut_points::{
    BlockHash, ByteReader, ByteWriter, Elsewhere, Monitor, PartsError, PointSource, PointsHash,
};

use super::partial::Body;
use super::query::Question;
use crate::Error;
use crate::ellipsoid::question as asked;
use crate::ellipsoid::question::TakenIds;
use crate::top::Far;

/// A pass over points; a first pass also hashes rows and refuses those that are not finite.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PointQuestion {
    is_first: bool,
    question: asked::Question,
}

/// The answer of all points, and in a first pass their hash.
pub(crate) struct PointsAnswer {
    pub(crate) hash: PointsHash,
    answer: asked::Answer,
}

/// Makes a pass over points that are held elsewhere.
pub(crate) fn ask_points(
    elsewhere: &dyn Elsewhere,
    source: &dyn PointSource,
    question: asked::Question,
    is_first: bool,
) -> Result<PointsAnswer, Error> {
    let question = Question::Points(PointQuestion { is_first, question });
    let partial = question.ask(elsewhere, source)?;
    let hash = partial.hash()?;
    match partial.body {
        Body::Points(answer) => Ok(PointsAnswer { hash, answer }),
        _ => Err(PartsError::Question.into()),
    }
}

impl PointsAnswer {
    /// The largest leverage, and the points listed, the farthest first.
    pub(crate) fn leverage(self) -> Result<(f64, Vec<Far>), PartsError> {
        match self.answer {
            asked::Answer::Leverage { largest, far, .. } => Ok((largest, far)),
            _ => Err(PartsError::Question),
        }
    }

    /// The rows taken; `None` where a square is no `f64`.
    pub(crate) fn taken(self) -> Result<Option<TakenIds>, PartsError> {
        match self.answer {
            asked::Answer::Take(taken) => Ok(taken),
            _ => Err(PartsError::Question),
        }
    }

    /// The point farthest outside a span.
    pub(crate) fn span(self) -> Result<Far, PartsError> {
        match self.answer {
            asked::Answer::Span(far) => Ok(far),
            _ => Err(PartsError::Question),
        }
    }

    /// The points that may lie farthest out, the farthest first.
    pub(crate) fn border(self) -> Result<Vec<Far>, PartsError> {
        match self.answer {
            asked::Answer::Border(far) => Ok(far),
            _ => Err(PartsError::Question),
        }
    }
}

impl PointQuestion {
    /// The answer of some rows, and in a first pass the hashes of their blocks.
    pub(super) fn run(
        &self,
        part: &dyn PointSource,
        first_row: u64,
        monitor: &Monitor<'_>,
    ) -> Result<(Option<Vec<BlockHash>>, Body), Error> {
        let (hashes, answer) = self.question.run(part, first_row, self.is_first, monitor)?;
        Ok((hashes, Body::Points(answer)))
    }

    pub(super) fn write(&self, bytes: &mut ByteWriter) {
        bytes.whole(u64::from(self.is_first));
        self.question.write(bytes);
    }

    pub(super) fn read(bytes: &mut ByteReader<'_>, columns: usize) -> Result<Self, PartsError> {
        let is_first = bytes.whole()? == 1;
        Ok(PointQuestion { is_first, question: asked::Question::read(bytes, columns)? })
    }
}
