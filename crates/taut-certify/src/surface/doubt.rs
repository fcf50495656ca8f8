//! Why a surface is not certified.

use serde::{Serialize, Serializer};

use super::TopologyReason;

/// The first reason not to call a surface certified, and where. Triangles and components are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceDoubt {
    /// There are no triangles.
    #[error("there are no triangles")]
    Empty,
    /// An edge has more than two triangles.
    #[error("the edge of rows {} and {} has {triangles} triangles", edge[0], edge[1])]
    NonManifoldEdge {
        /// Its ends.
        edge: [u32; 2],
        /// The number of them.
        triangles: usize,
    },
    /// The triangles at a vertex are more than one fan.
    #[error("the triangles at row {row} are {fans} fans, joined there alone")]
    NonManifoldVertex {
        /// The vertex.
        row: u32,
        /// Sets of its triangles that hang together by edges at it.
        fans: usize,
    },
    /// A component has one side only, as a Möbius band has.
    #[error("component {component} has one side only: no turning of triangles orients it")]
    OneSided {
        /// The first such component.
        component: usize,
    },
    /// Two triangles run along their edge in the same direction.
    #[error("triangles {} and {} run along their edge in the same direction", triangles[0], triangles[1])]
    NotOriented {
        /// The two.
        triangles: [u32; 2],
    },
    /// A triangle has no area.
    #[error("triangle {triangle} is flat: its vertices are on a line")]
    Flat {
        /// The triangle.
        triangle: u32,
    },
    /// Two triangles share more than their common vertices and edges.
    #[error("triangles {} and {} meet beyond the vertices that they share", triangles[0], triangles[1])]
    Crossing {
        /// The two.
        triangles: [u32; 2],
    },
    /// A closed component has the side that it bounds in front of it.
    #[error(
        "closed component {component}, within {depth} others, faces the side that it should have behind it"
    )]
    Inward {
        /// The first such component.
        component: usize,
        /// The number of closed components it lies within.
        depth: usize,
    },
    /// It is not claimed that triangles are Delaunay triangles.
    #[error("no balls are named: that its triangles are Delaunay triangles is not claimed")]
    NoBalls,
    /// The surface is sound, and its method doubts that its topology is that of what was sampled.
    #[error("the topology is in doubt near row {row}: {reason}")]
    Topology {
        /// The first reason.
        reason: TopologyReason,
        /// The first row that it names.
        row: u32,
    },
}

/// As its sentence.
impl Serialize for SurfaceDoubt {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
