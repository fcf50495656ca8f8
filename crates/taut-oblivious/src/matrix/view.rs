//! Matrices of f64 that lie in somebody's memory.

use crate::Error;

/// A matrix to read: element (i, j) is number i · `row_stride` + j · `column_stride` of the data.
#[derive(Clone, Copy, Debug)]
pub struct MatrixView<'a> {
    pub(super) data: &'a [f64],
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) row_stride: usize,
    pub(super) column_stride: usize,
}

impl<'a> MatrixView<'a> {
    /// A row-major matrix without gaps.
    ///
    /// # Errors
    /// [`Error::Option`] if the length is not `rows · columns`.
    pub fn new(data: &'a [f64], rows: usize, columns: usize) -> Result<Self, Error> {
        super::transpose::check_length("matrix", data.len(), rows, columns)?;
        Ok(Self { data, rows, columns, row_stride: columns, column_stride: 1 })
    }

    /// A matrix with any strides, also 0 or overlapping ones.
    ///
    /// # Errors
    /// [`Error::Option`] if an element would be beyond the data.
    pub fn strided(
        data: &'a [f64],
        (rows, columns): (usize, usize),
        (row_stride, column_stride): (usize, usize),
    ) -> Result<Self, Error> {
        check_extent(data.len(), (rows, columns), (row_stride, column_stride))?;
        // A stride that no second row or column follows may be of any size; nothing is calculated with it.
        let row_stride = if rows > 1 { row_stride } else { 0 };
        let column_stride = if columns > 1 { column_stride } else { 1 };
        Ok(Self { data, rows, columns, row_stride, column_stride })
    }

    /// Rows and columns.
    pub fn shape(&self) -> (usize, usize) {
        (self.rows, self.columns)
    }

    /// The transpose, of the same data.
    #[must_use]
    pub fn transposed(self) -> Self {
        Self {
            rows: self.columns,
            columns: self.rows,
            row_stride: self.column_stride,
            column_stride: self.row_stride,
            ..self
        }
    }

    /// A block of it; the caller vouches for the extent.
    pub(super) fn part(
        self,
        rows: std::ops::Range<usize>,
        columns: std::ops::Range<usize>,
    ) -> Self {
        let begin = rows.start * self.row_stride + columns.start * self.column_stride;
        let data = self.data.get(begin..).unwrap_or_default();
        Self { data, rows: rows.len(), columns: columns.len(), ..self }
    }
}

/// A matrix to write: rows of adjacent elements, `stride` apart.
#[derive(Debug)]
pub struct MatrixViewMut<'a> {
    pub(super) data: &'a mut [f64],
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) stride: usize,
}

impl<'a> MatrixViewMut<'a> {
    /// A row-major matrix without gaps.
    ///
    /// # Errors
    /// [`Error::Option`] if the length is not `rows · columns`.
    pub fn new(data: &'a mut [f64], rows: usize, columns: usize) -> Result<Self, Error> {
        super::transpose::check_length("target", data.len(), rows, columns)?;
        Ok(Self { data, rows, columns, stride: columns })
    }

    /// A row-major matrix whose rows begin `stride` elements apart.
    ///
    /// # Errors
    /// [`Error::Option`] if rows would overlap or an element would be beyond the data.
    pub fn strided(
        data: &'a mut [f64],
        (rows, columns): (usize, usize),
        stride: usize,
    ) -> Result<Self, Error> {
        if stride < columns {
            let value = format!("{stride} for {columns} columns");
            return Err(Error::Option {
                name: "stride",
                value,
                expected: "rows that do not overlap",
            });
        }
        check_extent(data.len(), (rows, columns), (stride, 1))?;
        // As of a view to read.
        Ok(Self { data, rows, columns, stride: if rows > 1 { stride } else { columns } })
    }

    /// A view of the same matrix for a shorter time.
    pub(super) fn again(&mut self) -> MatrixViewMut<'_> {
        MatrixViewMut { data: self.data, ..*self }
    }

    /// A block of it; the caller vouches for the extent.
    pub(super) fn part(
        &mut self,
        rows: std::ops::Range<usize>,
        columns: std::ops::Range<usize>,
    ) -> MatrixViewMut<'_> {
        let begin = rows.start * self.stride + columns.start;
        let data = self.data.get_mut(begin..).unwrap_or_default();
        MatrixViewMut { data, rows: rows.len(), columns: columns.len(), stride: self.stride }
    }

    /// Row i.
    pub(super) fn row(&mut self, i: usize) -> &mut [f64] {
        &mut self.data[i * self.stride..][..self.columns]
    }

    /// To read.
    pub(super) fn view(&self) -> MatrixView<'_> {
        MatrixView {
            data: self.data,
            rows: self.rows,
            columns: self.columns,
            row_stride: self.stride,
            column_stride: 1,
        }
    }
}

/// Whether the last element is among `length`.
fn check_extent(
    length: usize,
    (rows, columns): (usize, usize),
    (row_stride, column_stride): (usize, usize),
) -> Result<(), Error> {
    let last = |n: usize, stride: usize| (n - 1).checked_mul(stride);
    let fits = rows == 0
        || columns == 0
        || last(rows, row_stride)
            .zip(last(columns, column_stride))
            .and_then(|(down, right)| down.checked_add(right))
            .is_some_and(|end| end < length);
    if fits {
        return Ok(());
    }
    let value = format!(
        "{length} elements for {rows} × {columns} with strides {row_stride} and {column_stride}"
    );
    Err(Error::Option { name: "matrix", value, expected: "data up to the last element" })
}
