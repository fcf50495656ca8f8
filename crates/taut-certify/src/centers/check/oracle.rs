//! The question that the replay of a proof log asks: does one ball of a radius less than ρ hold a few items of the core-set?

use taut_points::Cancelled;

use super::meter::Meter;

/// A feasibility oracle: groups of items that may share a ball, and how they grow.
///
/// A group is refuted only where it is proved that no such ball exists. Where rounding leaves that open, the group is
/// kept: the log is then refused where it counts on a refutation, but no wrong bound is accepted.
pub(super) trait Oracle {
    /// Items that are to be in one ball, and what is known of the ball.
    type Group;

    /// Data to undo the last `grow`.
    type Undo;

    fn len(&self) -> usize;

    /// A group of one item; `None` where it is refuted.
    fn open(&mut self, item: usize) -> Option<Self::Group>;

    /// Adds an item to the group; `None` where that is refuted, and the group as it was.
    fn grow(
        &mut self,
        group: &mut Self::Group,
        item: usize,
        meter: &mut Meter<'_>,
    ) -> Result<Option<Self::Undo>, Cancelled>;

    /// Takes the item out that the group got last.
    fn undo(&self, group: &mut Self::Group, undo: Self::Undo);

    /// The bytes that are kept to undo.
    fn undo_bytes(undo: &Self::Undo) -> usize;
}
