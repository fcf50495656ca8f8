//! Tests what the tests of surfaces share: a judge of answers, and points whose surface is known.
#![allow(unreachable_pub)] // modules of one test program

pub mod judge;
pub mod points;
