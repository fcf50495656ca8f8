//! What searches ask: whether one ball of a radius less than ρ holds a few items of the core-set.

use super::meter::{Meter, Stop};

/// Groups of items that may share a ball, and how they grow.
///
/// A group is refuted only where it is proved that no such ball exists. Where rounding leaves that open, it is not: a
/// search then has more to do, or finds no proof, but never a wrong one.
pub(super) trait Room {
    /// Items that are to be in one ball, and what is known of the ball.
    type Group;

    /// What a group that grew has to be told to be what it was.
    type Undo;

    /// How many items there are.
    fn len(&self) -> usize;

    /// Whether it is known without a search that no ball holds both items.
    fn are_apart(&self, i: usize, j: usize, meter: &mut Meter<'_>) -> Result<bool, Stop>;

    /// A group of one item; `None` where it is refuted.
    fn open(&mut self, item: usize) -> Option<Self::Group>;

    /// Adds an item to the group; `None` where that is refuted, and the group as it was.
    fn grow(
        &mut self,
        group: &mut Self::Group,
        item: usize,
        meter: &mut Meter<'_>,
    ) -> Result<Option<Self::Undo>, Stop>;

    /// Takes the item out that the group got last.
    fn shrink(&self, group: &mut Self::Group, undo: Self::Undo);

    /// Bytes that are kept to undo.
    fn kept(undo: &Self::Undo) -> usize;

    /// By how much one item more narrows the room of the group, by some measure; infinite where it is refuted.
    fn strain(
        &mut self,
        group: &Self::Group,
        item: usize,
        meter: &mut Meter<'_>,
    ) -> Result<f64, Stop>;

    /// Whether a ball that holds the group, as far as rounding tells, holds the item too.
    fn covers(&self, group: &Self::Group, item: usize, meter: &mut Meter<'_>)
    -> Result<bool, Stop>;

    /// Whether one ball may hold all these items.
    fn fit(
        &mut self,
        items: impl IntoIterator<Item = usize>,
        meter: &mut Meter<'_>,
    ) -> Result<bool, Stop> {
        let mut items = items.into_iter();
        let Some(first) = items.next() else { return Ok(true) };
        let Some(mut group) = self.open(first) else { return Ok(false) };
        for item in items {
            if self.grow(&mut group, item, meter)?.is_none() {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
