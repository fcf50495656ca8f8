//! Enclosing shapes of [`taut_enclose`], and queries of points and balls of [`taut_search`].

pub use taut_enclose::*;
pub use taut_search::{
    Diameter, Error as SearchError, Neighbor, QueryOptions, RowPair, SphereSearch,
    SphereSearchOptions,
};
