//! The question of centers that are known: how far the farthest point is from the nearest of them.

use taut_points::{
    BlockHash, ByteReader, ByteWriter, Elsewhere, Monitor, PartsError, PointSource, PointsHash,
};

use super::partial::Body;
use super::query::{Question, among_all};
use crate::Error;
use crate::streaming::Reach;

/// A pass that measures centers; one for squares also hashes rows and refuses those that are not finite.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CentersQuestion {
    centers: Vec<Vec<f64>>,
    reach: Reach,
}

/// Measures centers over rows that are held elsewhere; the hash is that of the rows where squares are measured.
pub(crate) fn ask_reach(
    elsewhere: &dyn Elsewhere,
    source: &dyn PointSource,
    centers: &[Vec<f64>],
    reach: Reach,
) -> Result<(f64, PointsHash), Error> {
    let question = Question::Centers(CentersQuestion { centers: centers.to_vec(), reach });
    let partial = question.ask(elsewhere, source)?;
    let hash = partial.hash()?;
    match partial.body {
        Body::Centers(reach) => Ok((reach, hash)),
        _ => Err(PartsError::Question.into()),
    }
}

impl CentersQuestion {
    /// The answer of some rows, and in a pass for squares the hashes of their blocks.
    pub(super) fn run(
        &self,
        part: &dyn PointSource,
        first_row: u64,
        monitor: &Monitor<'_>,
    ) -> Result<(Option<Vec<BlockHash>>, Body), Error> {
        let measured = self.reach.of(part, &self.centers, monitor);
        let (reach, hashes) = measured.map_err(|error| among_all(error, first_row))?;
        Ok(((self.reach == Reach::Square).then_some(hashes), Body::Centers(reach)))
    }

    pub(super) fn write(&self, bytes: &mut ByteWriter) {
        bytes.whole(u64::from(self.reach == Reach::Distance));
        bytes.count(self.centers.len());
        self.centers.iter().for_each(|center| bytes.floats(center));
    }

    pub(super) fn read(bytes: &mut ByteReader<'_>, columns: usize) -> Result<Self, PartsError> {
        let reach = match bytes.whole()? {
            0 => Reach::Square,
            1 => Reach::Distance,
            _ => return Err(bytes.wrong()),
        };
        let count = bytes.count(8)?;
        let centers = (0..count).map(|_| bytes.floats()).collect::<Result<Vec<_>, _>>()?;
        if centers.is_empty() || centers.iter().any(|center| center.len() != columns) {
            return Err(bytes.wrong());
        }
        Ok(CentersQuestion { centers, reach })
    }
}
