//! A folder of tiles, judged within a limit on memory.

use std::path::Path;

use anyhow::anyhow;
use taut::certify::{
    TilesError, TilesOptions, TilesVerdict, TilesViolation, TriangulationVerdict, check_tiles,
};

use crate::input::reading::Opened;
use crate::output::numbers::{count, counted};
use crate::reports::triangulation::claims_of_triangulation;
use crate::reports::{Claims, Field};
use crate::watch::Watch;

/// The memory of a check if none is asked for.
pub(crate) const MEMORY_DEFAULT: u64 = 512 << 20;

/// The verdict on a folder, or why it is refused; an error where points or files cannot be read.
pub(crate) fn judge(
    folder: &Path,
    points: &Opened,
    memory: u64,
    temporary: Option<&Path>,
    watch: &Watch,
) -> anyhow::Result<Result<TilesVerdict, String>> {
    let judged = watch.during("checking", |monitor| {
        check_tiles(folder, points.source(), &TilesOptions { memory, temporary, monitor: *monitor })
    });
    match judged {
        Ok(verdict) => Ok(Ok(verdict)),
        // Points no folder can be judged by are no fault of the folder.
        Err(TilesError::Rejected(TilesViolation::NonFinite { row, column, value })) => {
            Err(points.not_finite(row, column, value))
        }
        Err(TilesError::Rejected(violation)) => {
            Ok(Err(format!("{}: {violation}", folder.display())))
        }
        Err(TilesError::Read(error)) => Err(points.reading_failed(error)),
        Err(error @ TilesError::Memory { .. }) => Err(anyhow!("{}: {error}", folder.display())),
        Err(error) => Err(error.into()),
    }
}

/// Returns what was proved of a folder.
pub(crate) fn claims(verdict: &TilesVerdict) -> Claims {
    let TilesVerdict { counts, fingerprint, ties, points, dimension, .. } = *verdict;
    let simplices = TriangulationVerdict { counts, fingerprint, ties, refined: 0 };
    let mut claims = claims_of_triangulation(&simplices, points, dimension.into());
    claims.fields.retain(|field| field.name != "refined");
    claims.fields.push(
        Field::proved("duplicates", count(verdict.duplicates))
            .remark("rows that equal an earlier one"),
    );
    claims.fields.push(
        Field::proved("tiles", counted(verdict.tiles, "file"))
            .remark("neighbors, sites and counts of each agree with what all tiles together are"),
    );
    claims
}
