//! Operands in the order in which the kernel reads them.
//!
//! *Idea.* A panel is `width` rows of the operand side by side: element k of each of them, then element k + 1. Rows of
//! adjacent elements are turned by the tiles of the transposition; adjacent rows are copied.
//! *Guarantee.* The last panel is filled up with zeros.

use crate::Probe;
use crate::level::Level;
use crate::matrix::transpose::tiles;
use crate::matrix::view::MatrixView;

/// This many runs lie between the request for one and its use: they lie in different pages, which the processor does
/// not foresee.
const PREFETCH_RUNS: usize = 4;

/// Panels of rows of an operand.
pub(super) struct Panels<'a> {
    room: &'a mut [f64],
    /// Rows of a panel.
    width: usize,
    /// Rows that are packed now.
    rows: usize,
    /// Elements of each row that are packed now.
    depth: usize,
}

impl<'a> Panels<'a> {
    /// Elements of memory for `rows` rows of `depth` elements.
    pub(super) fn room(width: usize, rows: usize, depth: usize) -> usize {
        rows.next_multiple_of(width) * depth
    }

    /// Panels of so many rows, in memory that begins at a line of the cache.
    pub(super) fn new(width: usize, room: &'a mut [f64]) -> Self {
        Self { room, width, rows: 0, depth: 0 }
    }

    /// Replaces the content by all rows of `from`.
    pub(super) fn pack<P: Probe>(&mut self, level: Level, from: MatrixView<'_>, probe: &mut P) {
        (self.rows, self.depth) = from.shape();
        let (width, depth) = (self.width, self.depth);
        let used = &mut self.room[..Self::room(width, from.rows, depth)];
        if !from.rows.is_multiple_of(width) {
            let last = used.len() - width * depth;
            used[last..].fill(0.0);
        }
        if from.column_stride == 1 {
            for (panel, top) in used.chunks_exact_mut(width * depth).zip((0..).step_by(width)) {
                let here = from.part(top..from.rows.min(top + width), 0..depth);
                if P::LISTENS {
                    (0..here.rows)
                        .for_each(|i| probe.read(&here.data[i * here.row_stride..][..depth]));
                    probe.write(panel);
                }
                let source = (here.data, here.row_stride);
                tiles::turn(level, (here.rows, depth), source, (panel, width));
            }
        } else if from.row_stride == 1 {
            // All panels side by side: a run of the source is read as it lies in memory.
            for j in 0..depth {
                let run = |j: usize| &from.data[j * from.column_stride..][..from.rows];
                tiles::fetch(level, run((j + PREFETCH_RUNS).min(depth - 1)));
                let run = run(j);
                let places = used[j * width..].chunks_mut(width * depth);
                probe.read(run);
                for (piece, place) in run.chunks(width).zip(places) {
                    let place = &mut place[..piece.len()];
                    place.copy_from_slice(piece);
                    probe.write(place);
                }
            }
        } else {
            for (i, at) in (0..from.rows).map(|i| (i, i / width * width * depth + i % width)) {
                for (j, x) in used[at..].iter_mut().step_by(width).take(depth).enumerate() {
                    let source = i * from.row_stride + j * from.column_stride;
                    *x = from.data[source];
                    probe.read(&from.data[source..][..1]);
                    probe.write(std::slice::from_ref(x));
                }
            }
        }
    }

    /// The first row of each panel, and the panel.
    pub(super) fn panels(&self) -> impl Iterator<Item = (usize, &[f64])> {
        self.room[..Self::room(self.width, self.rows, self.depth)]
            .chunks_exact(self.width * self.depth)
            .enumerate()
            .map(|(k, panel)| (k * self.width, panel))
    }

    /// The panel after the one whose first row this is; nothing after the last.
    pub(super) fn after(&self, row: usize) -> &[f64] {
        let used = Self::room(self.width, self.rows, self.depth);
        let panel = self.width * self.depth;
        let begin = (row * self.depth + panel).min(used);
        &self.room[begin..used.min(begin + panel)]
    }

    /// The memory of the panels.
    pub(super) fn all(&self) -> &[f64] {
        self.room
    }
}
