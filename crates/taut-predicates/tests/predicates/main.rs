//! Signs of predicates against closed forms, and laws that hold whatever the answer is.

mod known;
mod laws;
