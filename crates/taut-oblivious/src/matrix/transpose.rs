//! Transposition out of place, of row-major matrices of any shape.
//!
//! *Problem.* Write the transpose of a matrix that is far larger than the caches at the speed of copying it.
//! *Idea.* Strips of columns become strips of rows of the target. A strip is walked from top to bottom in blocks that fit
//! the innermost cache: tiles of a block are turned in registers into a scratch block, whose rows are runs of whole lines
//! of the target and go there in one go. If the target is larger than the last cache they go past all caches, for elements
//! of 8 bytes straight from the registers.
//! *Guarantee.* A permutation of bytes, the same for any number of threads. Every line of the target is written once,
//! and twice where two of its rows share it; every line of the source is read once, and again at the border of strips.
//! *Trap.* Without the scratch, strides of a power of two put all lines of a block into one set of the cache; with it only
//! eight lines at a time meet. Runs begin where a line of the target begins, which is another place in each of its rows,
//! so blocks overlap by less than a line.
//! *Trap.* Rows of the target shorter than a run are many to a line. A strip is then one run, and what is left of its last
//! line waits for the next block.
//! *Reference.* Thesis, section 5.3, for the recursion and its bound, of which this keeps the two levels that count.

use bytemuck::Pod;
use taut_points::parallel::ParallelSlice;

use crate::level::{Level, last_cache_bytes};
use crate::{Error, NoProbe, Probe};

pub(crate) mod in_place;
mod rectangular;
#[cfg(test)]
mod tests;
pub(in crate::matrix) mod tiles;

/// A strip has this many columns: as many streams as the pages of the target that the processor keeps at hand, with
/// those of the source. Measured with 4096², 10000² and 8192 × 16384 numbers, 32 columns take a tenth longer, 128 up to
/// a fifth.
const STRIP_COLUMNS: usize = 48;
/// A band has this many rows: their pages, one for each row of a wide matrix, stay among the two or three thousand
/// whose translation the processor keeps. Walked from top to bottom, a strip of more rows would ask for each page again.
const BAND_ROWS: usize = 1024;
/// A strip of a band has this many columns.
const WALK_COLUMNS: usize = 64;
/// Most strips of a band: of numbers of 8 bytes, four pages of each row are read in one go. Measured with one page, 8192 × 16384
/// numbers take a quarter longer, whose rows begin at the same place in so many pages that few translations are kept.
const TASK: usize = 32;
/// There are at least this many tasks for each thread.
const TASKS_PER_THREAD_MIN: usize = 4;
/// A matrix of at most this many columns is one strip: its rows are read as they lie.
const NARROW_COLUMNS_MAX: usize = 128;
/// Bytes of a run, the part of a row of the target that is written in one go, at least.
const RUN_MIN: usize = 512;
/// Bytes of a run at most: a page.
const RUN_MAX: usize = 4096;
/// Bytes of a block of a narrow strip, whose runs may be longer.
const BLOCK: usize = 16 << 10;
/// Rows of the target of up to this many bytes are written many in one go.
const SHORT_ROW_BYTES_MAX: usize = 1024;
/// Bytes of a line of the cache.
const LINE: usize = 64;
/// Threads share the strips from this many elements on.
const SHARED_ELEMENTS_MIN: usize = 1 << 18;

/// Writes the transpose of the `rows` × `columns` matrix `from` to `to`; both are row-major.
///
/// Elements of 1, 2, 4 and 8 bytes are turned in vector registers where the processor has them. Runs on the current rayon
/// pool. O(rows · columns), O(1) memory beside the two matrices: some 40 KiB for each thread.
///
/// # Errors
/// [`Error::Option`] if the length of `from` or of `to` is not `rows · columns`.
///
/// ```
/// let mut turned = [0; 6];
/// taut_oblivious::transpose(&[1, 2, 3, 4, 5, 6], 2, 3, &mut turned)?;
/// assert_eq!(turned, [1, 4, 2, 5, 3, 6]);
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
pub fn transpose<T: Pod + Send + Sync>(
    from: &[T],
    rows: usize,
    columns: usize,
    to: &mut [T],
) -> Result<(), Error> {
    check_length("from", from.len(), rows, columns)?;
    check_length("to", to.len(), rows, columns)?;
    if to.is_empty() || size_of::<T>() == 0 {
        return Ok(());
    }
    let shape = Shape::new::<T>(Level::best(), rows, columns, rayon::current_num_threads());
    let task_len = shape.task_columns * rows;
    if to.len() < SHARED_ELEMENTS_MIN || rayon::current_num_threads() == 1 {
        for (k, task) in to.chunks_mut(task_len).enumerate() {
            shape.task(from, k * shape.task_columns, task, &mut NoProbe);
        }
    } else {
        to.par_chunks_mut(task_len)
            .enumerate()
            .for_each(|(k, task)| shape.task(from, k * shape.task_columns, task, &mut NoProbe));
    }
    Ok(())
}

/// As [`transpose()`], on one thread and through the scratch block, and tells `probe` of every block.
///
/// # Errors
/// As [`transpose()`].
pub fn transpose_instrumented<T: Pod, P: Probe>(
    from: &[T],
    rows: usize,
    columns: usize,
    to: &mut [T],
    probe: &mut P,
) -> Result<(), Error> {
    check_length("from", from.len(), rows, columns)?;
    check_length("to", to.len(), rows, columns)?;
    if to.is_empty() || size_of::<T>() == 0 {
        return Ok(());
    }
    probe.place(from);
    probe.place(to);
    let shape = Shape { past: false, ..Shape::new::<T>(Level::best(), rows, columns, 1) };
    for (k, task) in to.chunks_mut(shape.task_columns * rows).enumerate() {
        shape.task(from, k * shape.task_columns, task, probe);
    }
    probe.lift(to);
    probe.lift(from);
    Ok(())
}

/// Tests whether `length` is that of a `rows` × `columns` matrix.
pub(crate) fn check_length(
    name: &'static str,
    length: usize,
    rows: usize,
    columns: usize,
) -> Result<(), Error> {
    if rows.checked_mul(columns) == Some(length) {
        return Ok(());
    }
    let value = format!("{length} elements for {rows} × {columns}");
    Err(Error::Option { name, value, expected: "as many elements as rows times columns" })
}

/// The shape that all strips of one transposition share.
struct Shape {
    level: Level,
    rows: usize,
    columns: usize,
    /// Columns of the source that one strip takes.
    strip_columns: usize,
    /// Columns of the source that a thread takes: some strips, whose rows are read in bands.
    task_columns: usize,
    /// Elements of a line of the cache.
    line: usize,
    /// True if the target is written past the caches.
    past: bool,
}

impl Shape {
    /// For as many threads; they change nothing but what is done at a time.
    fn new<T>(level: Level, rows: usize, columns: usize, threads: usize) -> Self {
        let width = size_of::<T>();
        let past = 2 * rows * columns * width > last_cache_bytes();
        let line = elements_of_line::<T>();
        // Rows of the target that are short share lines, so a strip has as many as make a long run.
        let strip_columns = if rows * width <= SHORT_ROW_BYTES_MAX {
            STRIP_COLUMNS.max((1 << 16) / rows / STRIP_COLUMNS * STRIP_COLUMNS)
        } else {
            if columns <= NARROW_COLUMNS_MAX { columns } else { STRIP_COLUMNS }
        };
        let banded = past && strip_columns < columns && rows >= 2 * BAND_ROWS;
        let strips = (columns / WALK_COLUMNS / (TASKS_PER_THREAD_MIN * threads)).clamp(1, TASK);
        let task_columns = if banded { strips * WALK_COLUMNS } else { strip_columns };
        Self { level, rows, columns, strip_columns, task_columns, line, past }
    }

    /// The columns from `left` on become the rows `to` of the target.
    fn task<T: Pod, P: Probe>(&self, from: &[T], left: usize, to: &mut [T], probe: &mut P) {
        if self.task_columns == self.strip_columns || !self.bands(from, left, to) {
            for (k, strip) in to.chunks_mut(self.strip_columns * self.rows).enumerate() {
                self.strip(from, left + k * self.strip_columns, strip, probe);
            }
        }
        tiles::fence(self.level);
    }

    /// All strips of a task in bands of rows, past the caches; whether there is a kernel that does.
    fn bands<T: Pod>(&self, from: &[T], left: usize, to: &mut [T]) -> bool {
        let (rows, columns) = (self.rows, to.len() / self.rows);
        let lead = if self.columns.is_multiple_of(self.line) { to_line(&from[left..]) } else { 0 };
        let bands = rows / BAND_ROWS;
        for band in 0..bands {
            let top = band * BAND_ROWS;
            let height = if band + 1 == bands { rows - top } else { BAND_ROWS };
            let mut strip = 0;
            while strip < columns {
                // From the second one on strips begin with a line of the source, if all its rows do so at one place.
                let width = if strip == 0 && lead > 0 {
                    WALK_COLUMNS - self.line + lead
                } else {
                    WALK_COLUMNS
                };
                let extent = (height, width.min(columns - strip));
                let part = &from[top * self.columns + left + strip..];
                let place = &mut to[strip * rows + top..];
                if !tiles::walk(self.level, extent, (part, self.columns), (place, rows)) {
                    // The first one says so already.
                    return false;
                }
                strip += extent.1;
            }
        }
        true
    }

    /// The columns from `left` on become the rows `to` of the target.
    fn strip<T: Pod, P: Probe>(&self, from: &[T], left: usize, to: &mut [T], probe: &mut P) {
        let columns = to.len() / self.rows;
        let source = (&from[left..], self.columns);
        let walked = self.past
            && tiles::walk(self.level, (self.rows, columns), source, (&mut *to, self.rows));
        if !walked && self.rows * size_of::<T>() <= SHORT_ROW_BYTES_MAX {
            self.short(from, left, to, probe);
        } else if !walked {
            self.long(from, left, to, probe);
        }
    }

    /// A strip whose rows in the target are runs of their own.
    fn long<T: Pod, P: Probe>(&self, from: &[T], left: usize, to: &mut [T], probe: &mut P) {
        let width = size_of::<T>();
        let (rows, columns) = (self.rows, to.len() / self.rows);
        let run = (BLOCK / columns / width).clamp(RUN_MIN / width, RUN_MAX / width).max(1);
        let run = run.next_multiple_of(self.line);
        let stride = run + self.line;
        let mut room = vec![T::zeroed(); stride * columns + self.line];
        let aligned = to_line(&room);
        let scratch = &mut room[aligned..];
        probe.place(scratch);
        // Where all rows of the target begin at the same place in a line, blocks need not overlap.
        let even = (rows * width).is_multiple_of(LINE);
        let mut top = 0;
        while top < rows {
            let first = if top == 0 && even { to_line(to) } else { 0 };
            let bottom = rows.min(top + run + if top == 0 { first } else { 0 });
            let below = if even { bottom } else { rows.min(bottom + self.line - 1) };
            self.turn(from, top..below, left..left + columns, (scratch, stride), probe);
            for (j, row) in to.chunks_exact_mut(rows).enumerate() {
                self.fetch(
                    from,
                    bottom + j * run / columns..bottom + (j + 1) * run / columns,
                    left,
                );
                let end =
                    if bottom == rows { rows } else { rows.min(bottom + to_line(&row[bottom..])) };
                let begin = if top == 0 { 0 } else { end.min(top + to_line(&row[top..])) };
                let part = &scratch[j * stride + begin - top..j * stride + end - top];
                self.copy(part, &mut row[begin..end], probe);
            }
            top = bottom;
        }
        probe.lift(scratch);
    }

    /// A strip whose rows in the target are short: blocks of it are runs.
    fn short<T: Pod, P: Probe>(&self, from: &[T], left: usize, to: &mut [T], probe: &mut P) {
        let (rows, columns) = (self.rows, to.len() / self.rows);
        let step = (BLOCK / (rows * size_of::<T>())).next_multiple_of(8).min(columns);
        let mut scratch = vec![T::zeroed(); step * rows + self.line];
        probe.place(&scratch);
        let (mut done, mut waiting) = (0, 0);
        for j in (0..columns).step_by(step) {
            let right = columns.min(j + step);
            let block = left + j..left + right;
            self.turn(from, 0..rows, block, (&mut scratch[waiting..], rows), probe);
            // All but the elements of a line that is not complete.
            let mut ready = right * rows;
            if right < columns {
                let over = to[..ready].as_ptr_range().end as usize % LINE / size_of::<T>();
                ready = done.max(ready - over.min(self.line - 1));
            }
            self.copy(&scratch[..ready - done], &mut to[done..ready], probe);
            scratch.copy_within(ready - done..right * rows - done, 0);
            waiting = right * rows - ready;
            done = ready;
        }
        probe.lift(&scratch);
    }

    /// A block of the source goes turned to the scratch.
    fn turn<T: Pod, P: Probe>(
        &self,
        from: &[T],
        rows: std::ops::Range<usize>,
        columns: std::ops::Range<usize>,
        (scratch, stride): (&mut [T], usize),
        probe: &mut P,
    ) {
        if P::IS_RECORDING {
            for i in rows.clone() {
                probe.read(&from[i * self.columns..][columns.clone()]);
            }
            for j in 0..columns.len() {
                probe.write(&scratch[j * stride..j * stride + rows.len()]);
            }
        }
        let block = &from[rows.start * self.columns + columns.start..];
        let extent = (rows.len(), columns.len());
        tiles::turn(self.level, extent, (block, self.columns), (scratch, stride));
    }

    /// A run goes from the scratch to the target.
    fn copy<T: Pod, P: Probe>(&self, part: &[T], to: &mut [T], probe: &mut P) {
        probe.read(part);
        probe.write(to);
        if self.past {
            tiles::stream(self.level, part, to);
        } else {
            to.copy_from_slice(part);
        }
    }

    /// Asks for rows of the strip that starts at column `left`.
    fn fetch<T: Pod>(&self, from: &[T], rows: std::ops::Range<usize>, left: usize) {
        let columns = self.strip_columns.min(self.columns - left);
        let rows = rows.start.min(self.rows)..rows.end.min(self.rows);
        if columns == self.columns {
            tiles::fetch(self.level, &from[rows.start * columns..rows.end * columns]);
        } else {
            for i in rows {
                tiles::fetch(self.level, &from[i * self.columns + left..][..columns]);
            }
        }
    }
}

/// Elements up to the next line of the cache, as far as there are; 0 if elements do not fill lines.
fn to_line<T>(part: &[T]) -> usize {
    let offset = part.as_ptr().align_offset(LINE);
    if offset < elements_of_line::<T>() { offset.min(part.len()) } else { 0 }
}

/// Elements that fill a line of the cache; 1 if none do.
const fn elements_of_line<T>() -> usize {
    if LINE.is_multiple_of(size_of::<T>()) { LINE / size_of::<T>() } else { 1 }
}
