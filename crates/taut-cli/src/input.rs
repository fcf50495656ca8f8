//! The inputs of a subcommand: points, answers, amounts of memory.

pub(crate) mod answer_file;
pub(crate) mod choice;
pub(crate) mod heights;
pub(crate) mod obstacles;
pub(crate) mod reading;
pub(crate) mod samples;
pub(crate) mod size;
pub(crate) mod table;
pub(crate) mod units;
