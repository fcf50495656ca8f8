//! Errors of rasters.

/// Why a raster cannot be written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RasterError {
    /// It has the name of something else.
    #[error("{path}: rasters are .npy or .asc files; name one of these")]
    Name {
        /// The file.
        path: String,
    },
    /// It has more cells than bytes can be counted for, or than memory holds.
    #[error("a raster of {columns} columns and {rows} rows is too large: choose larger cells")]
    Size {
        /// Columns.
        columns: u64,
        /// Rows.
        rows: u64,
    },
}
