//! Depth-first search: items are put into clusters one after the other, and taken back.
//!
//! *Idea.* A [`State`] is an oracle that knows what fits where: for free balls ([`super::clusters`]) or for balls with their
//! centers at rows ([`super::rows`]). A [`Path`] holds the nodes above the present one. [`super::subsearch`] has a path of its own,
//! because it jumps back over decisions and can be cut into several subsearches.

/// Where an item may go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// Into a cluster that has items.
    Into(usize),
    /// Into the first empty cluster.
    Open,
    /// Into none.
    LeaveOut,
}

/// Items in clusters, or left out.
pub(super) trait State {
    /// The data to take a step back.
    type Undo;

    /// Puts an item where it may go.
    fn put(&mut self, item: u32, place: Place) -> Self::Undo;

    /// Takes the last step back.
    fn undo(&mut self, undo: Self::Undo);
}

/// A node under way.
struct Frame<U> {
    item: u32,
    /// Items to branch on below it, before the state is asked for one.
    chain: Vec<u32>,
    places: std::vec::IntoIter<Place>,
    undo: Option<U>,
}

/// The nodes above the present one.
pub(super) struct Path<S: State> {
    frames: Vec<Frame<S::Undo>>,
}

impl<S: State> Path<S> {
    /// A path at the root.
    pub(super) fn new() -> Self {
        Path { frames: vec![] }
    }

    /// Branches on an item, and below it on those of a chain.
    pub(super) fn branch(&mut self, item: u32, places: Vec<Place>, chain: Vec<u32>) {
        self.frames.push(Frame { item, chain, places: places.into_iter(), undo: None });
    }

    /// Returns the rest of the chain; empty if the state must choose; `None` at the root.
    pub(super) fn chain(&self) -> Option<&[u32]> {
        self.frames.last().map(|frame| &frame.chain[..])
    }

    /// The states of the children to come, from the deepest node up, each with its chain.
    pub(super) fn left(self, mut state: S) -> Vec<(S, Vec<u32>)>
    where
        S: Clone,
    {
        let mut left = vec![];
        for frame in self.frames.into_iter().rev() {
            if let Some(undo) = frame.undo {
                state.undo(undo);
            }
            for place in frame.places {
                let mut child = state.clone();
                child.put(frame.item, place);
                left.push((child, frame.chain.clone()));
            }
        }
        left
    }

    /// Goes on to the next child of the deepest node that has one; returns false where none has.
    pub(super) fn advance(&mut self, state: &mut S) -> bool {
        while let Some(frame) = self.frames.last_mut() {
            if let Some(undo) = frame.undo.take() {
                state.undo(undo);
            }
            if let Some(place) = frame.places.next() {
                frame.undo = Some(state.put(frame.item, place));
                return true;
            }
            self.frames.pop();
        }
        false
    }
}
