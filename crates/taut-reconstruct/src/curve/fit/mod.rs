//! Curves through noisy points: connectivity first, regression along the ordered curve after it.
pub(super) mod link;
mod local;
mod minimax;
pub(super) mod regress;
pub(super) mod seeds;
pub(super) mod strand;
