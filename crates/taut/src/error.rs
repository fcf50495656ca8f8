//! Why there is no answer, whichever function was asked.

use taut_points::InputError;

/// The errors of this crate. Each error says where the fault is, its value, and what would be accepted.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// Points or options that no function accepts, points that could not be read, or a caller who asked to stop.
    Input(InputError),
    /// A ball, an ellipsoid or centers were asked for.
    Enclose(taut_enclose::Error),
    /// Queries of points or of balls were asked.
    Search(taut_search::Error),
    /// A triangulation or an order was asked for.
    Delaunay(taut_delaunay::Error),
    /// A circle in a polygon was asked for.
    Inscribe(taut_inscribe::Error),
    /// A classifier or an error rate was asked for.
    #[cfg(feature = "recognize")]
    Recognize(taut_recognize::Error),
    /// Curves or a surface were asked for.
    #[cfg(feature = "reconstruct")]
    Reconstruct(taut_reconstruct::Error),
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Error::Input(error) => error.fmt(f),
            Error::Enclose(error) => error.fmt(f),
            Error::Search(error) => error.fmt(f),
            Error::Delaunay(error) => error.fmt(f),
            Error::Inscribe(error) => error.fmt(f),
            #[cfg(feature = "recognize")]
            Error::Recognize(error) => error.fmt(f),
            #[cfg(feature = "reconstruct")]
            Error::Reconstruct(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Error::Input(error) => error.source(),
            Error::Enclose(error) => error.source(),
            Error::Search(error) => error.source(),
            Error::Delaunay(error) => error.source(),
            Error::Inscribe(error) => error.source(),
            #[cfg(feature = "recognize")]
            Error::Recognize(error) => error.source(),
            #[cfg(feature = "reconstruct")]
            Error::Reconstruct(error) => error.source(),
        }
    }
}

impl From<InputError> for Error {
    fn from(error: InputError) -> Self {
        Error::Input(error)
    }
}

impl From<taut_enclose::Error> for Error {
    fn from(error: taut_enclose::Error) -> Self {
        match error {
            taut_enclose::Error::Input(error) => Error::Input(error),
            other => Error::Enclose(other),
        }
    }
}

impl From<taut_search::Error> for Error {
    fn from(error: taut_search::Error) -> Self {
        match error {
            taut_search::Error::Input(error) => Error::Input(error),
            other => Error::Search(other),
        }
    }
}

impl From<taut_delaunay::Error> for Error {
    fn from(error: taut_delaunay::Error) -> Self {
        match error {
            taut_delaunay::Error::Input(error) => Error::Input(error),
            other => Error::Delaunay(other),
        }
    }
}

impl From<taut_inscribe::Error> for Error {
    fn from(error: taut_inscribe::Error) -> Self {
        match error {
            taut_inscribe::Error::Input(error) => Error::Input(error),
            other => Error::Inscribe(other),
        }
    }
}

#[cfg(feature = "recognize")]
impl From<taut_recognize::Error> for Error {
    fn from(error: taut_recognize::Error) -> Self {
        match error {
            taut_recognize::Error::Input(error) => Error::Input(error),
            taut_recognize::Error::Enclose(error) => error.into(),
            other => Error::Recognize(other),
        }
    }
}

#[cfg(feature = "reconstruct")]
impl From<taut_reconstruct::Error> for Error {
    fn from(error: taut_reconstruct::Error) -> Self {
        match error {
            taut_reconstruct::Error::Input(error) => Error::Input(error),
            taut_reconstruct::Error::Triangulation(error) => error.into(),
            other => Error::Reconstruct(other),
        }
    }
}
