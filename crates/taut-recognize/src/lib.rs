//! Classifiers built on enclosing balls, how they are evaluated, and recognition of people by the outlines of their hands.
#![forbid(unsafe_code)]

pub mod classify;
pub mod evaluate;
#[cfg(feature = "hand")]
pub mod hand;
