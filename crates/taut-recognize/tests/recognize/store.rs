//! The encrypted store: enrolling and verifying, and what is refused.

mod attacks;
mod crash;
mod help;
mod people;
