//! Reasons to doubt that the topology of a surface is that of what was sampled.
//!
//! No checker can know what was sampled, so none of this is proved or refuted: it is evidence of the method that found the surface.

use serde::{Deserialize, Serialize};

/// A reason of the method to doubt the topology of its answer, and where.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a doubt about the topology of a surface: an object with reason and rows"
)]
pub struct TopologyDoubt {
    /// The reason.
    pub reason: TopologyReason,
    /// Rows where it was found, ascending.
    pub rows: Vec<u32>,
}

/// What speaks against a topology.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, thiserror::Error)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum TopologyReason {
    /// At many vertices the border was no surface before it was repaired.
    #[error("many vertices had to be repaired")]
    Repairs,
    /// A repair made or closed a handle, a hole or a part.
    #[error("a repair changed the number of handles or parts")]
    Rebuilt,
    /// Facets that strongly say "a surface is here" lie within one side.
    #[error("strong evidence of surfaces was overruled")]
    Overruled,
    /// Vertices at the tips of spikes, as outliers make them.
    #[error("a spike sticks out, as outliers make them")]
    Spikes,
    /// The noise is as large as what is around it.
    #[error("the noise is as large as the features")]
    Noise,
}
