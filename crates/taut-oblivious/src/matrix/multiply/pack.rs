//! Operands in the order in which the kernel reads them.
//!
//! *Idea.* A panel is `width` rows of the operand side by side: element k of each of them, then element k + 1. Rows of
//! adjacent elements are turned by the tiles of the transposition; adjacent rows are copied.
//! *Guarantee.* The last panel is filled up with zeros.

use crate::Probe;
use crate::level::Level;
use crate::matrix::transpose::tiles;
use crate::matrix::view::MatrixView;

/// Panels of rows of an operand.
pub(super) struct Panels {
    room: Vec<f64>,
    /// Elements before the first one that begins a line of the cache.
    skip: usize,
    /// Rows of a panel.
    width: usize,
    /// Rows that are packed now.
    rows: usize,
    /// Elements of each row that are packed now.
    depth: usize,
}

impl Panels {
    /// Room for `rows` rows of `depth` elements.
    pub(super) fn new(width: usize, rows: usize, depth: usize) -> Self {
        let room = vec![0.0; rows.next_multiple_of(width) * depth + 7];
        let skip = room.as_ptr().align_offset(64).min(7);
        Self { room, skip, width, rows: 0, depth: 0 }
    }

    /// Replaces the content by all rows of `from`.
    pub(super) fn pack<P: Probe>(&mut self, level: Level, from: MatrixView<'_>, probe: &mut P) {
        (self.rows, self.depth) = from.shape();
        let (width, depth) = (self.width, self.depth);
        for (k, panel) in self.room[self.skip..]
            .chunks_exact_mut(width * depth)
            .enumerate()
            .take_while(|(k, _)| k * width < from.rows)
        {
            let rows = k * width..from.rows.min((k + 1) * width);
            let here = from.part(rows.clone(), 0..depth);
            if P::LISTENS {
                tell(here, probe);
                probe.write(panel);
            }
            if rows.len() < width {
                panel.fill(0.0);
            }
            if here.column_stride == 1 {
                tiles::turn(
                    level,
                    (rows.len(), depth),
                    (here.data, here.row_stride),
                    (panel, width),
                );
            } else if here.row_stride == 1 {
                for (j, column) in panel.chunks_exact_mut(width).enumerate() {
                    column[..rows.len()]
                        .copy_from_slice(&here.data[j * here.column_stride..][..rows.len()]);
                }
            } else {
                for (j, column) in panel.chunks_exact_mut(width).enumerate() {
                    for (i, x) in column[..rows.len()].iter_mut().enumerate() {
                        *x = here.data[i * here.row_stride + j * here.column_stride];
                    }
                }
            }
        }
    }

    /// The first row of each panel, and the panel.
    pub(super) fn panels(&self) -> impl Iterator<Item = (usize, &[f64])> {
        let used = self.rows.next_multiple_of(self.width) * self.depth;
        self.room[self.skip..self.skip + used]
            .chunks_exact(self.width * self.depth)
            .enumerate()
            .map(|(k, panel)| (k * self.width, panel))
    }

    /// The memory of the panels.
    pub(super) fn all(&self) -> &[f64] {
        &self.room
    }
}

/// Tells of what is read, by runs of adjacent elements.
fn tell<P: Probe>(from: MatrixView<'_>, probe: &mut P) {
    let along_rows = from.column_stride == 1;
    let from = if along_rows { from } else { from.transposed() };
    for i in 0..from.rows {
        if from.column_stride == 1 {
            probe.read(&from.data[i * from.row_stride..][..from.columns]);
        } else {
            for j in 0..from.columns {
                probe.read(&from.data[i * from.row_stride + j * from.column_stride..][..1]);
            }
        }
    }
}
