//! What searches ask: whether one ball of a radius less than ρ holds a few items of the core-set.

/// Groups of items that may share a ball, and how they grow.
///
/// A group is refuted only where it is proved that no such ball exists. Where rounding leaves that open, it is not: a
/// search then has more to do, or finds no proof, but never a wrong one.
pub(super) trait Room {
    /// Items that are to be in one ball, and what is known of the ball.
    type Group: Clone;

    /// How many items there are.
    fn len(&self) -> usize;

    /// Whether it is known without a search that no ball holds both items.
    fn are_apart(&self, i: usize, j: usize) -> bool;

    /// A group of one item; `None` where it is refuted.
    fn open(&mut self, item: usize) -> Option<Self::Group>;

    /// The group with one item more; `None` where it is refuted.
    fn with(&mut self, group: &Self::Group, item: usize) -> Option<Self::Group>;

    /// By how much one item more narrows the room of the group, by some measure; infinite where it is refuted.
    fn strain(&mut self, group: &Self::Group, item: usize) -> f64;

    /// Whether a ball that holds the group, as far as rounding tells, holds the item too.
    fn covers(&self, group: &Self::Group, item: usize) -> bool;
}
