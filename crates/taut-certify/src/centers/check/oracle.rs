//! The question that the replay of a proof log asks: does one ball of a radius less than ρ hold a few items of the core-set?

use taut_points::Cancelled;

use super::meter::Meter;

/// A feasibility oracle: clusters of items that may share a ball, and how they grow.
///
/// A cluster is refuted only where it is proved that no such ball exists. Where rounding leaves that open, the cluster is
/// kept: the log is then refused where it counts on a refutation, but no wrong bound is accepted.
pub(super) trait Oracle {
    /// Items that are to be in one ball, and what is known of the ball.
    type Cluster;

    /// Data to undo the last `grow`.
    type Undo;

    fn len(&self) -> usize;

    /// A cluster of one item; `None` where it is refuted.
    fn open(&mut self, item: usize) -> Option<Self::Cluster>;

    /// Adds an item to the cluster; `None` where that is refuted, and the cluster as it was.
    fn grow(
        &mut self,
        cluster: &mut Self::Cluster,
        item: usize,
        meter: &mut Meter<'_>,
    ) -> Result<Option<Self::Undo>, Cancelled>;

    /// Takes the item out that the cluster got last.
    fn undo(&self, cluster: &mut Self::Cluster, undo: Self::Undo);

    /// Returns true if it is proved that each ball of a radius just below ρ that holds the cluster holds one of the items left out.
    fn is_held_out(
        &self,
        cluster: &Self::Cluster,
        left_out: &[usize],
        meter: &mut Meter<'_>,
    ) -> Result<bool, Cancelled>;

    /// The bytes that are kept to undo.
    fn undo_bytes(undo: &Self::Undo) -> usize;
}
