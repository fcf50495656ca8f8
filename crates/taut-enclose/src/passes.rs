//! Solvers without input and output: they ask questions about all rows, and whoever holds the rows answers, in parts.
//!
//! *Problem.* A solver that reads its points itself is of no use where they lie on many machines.
//! *Idea.* A [`Solver`] has one open [`Query`] at a time. Each part of the rows is whole [`Blocks`](taut_points::Blocks)
//! and runs the query over itself, which gives a [`Partial`]; partials are merged, in any order and grouping, and the merged
//! one is fed to the solver, until it has no further query. The functions that run over a part are those of the passes in
//! memory, and what they find are order statistics under a total order (the farthest rows, ties by row number) and hashes
//! of blocks.
//! *Guarantee.* The solution has the bytes of the one that [`ball()`](crate::ball()) and
//! [`ellipsoid()`](crate::ellipsoid()) find over all rows at once, however these are
//! divided. Parts that overlap, lack a block, answer another query or were worked on by other kernels are refused.
//! *How it is made.* The solver is the same code as in memory, on a thread of its own, over a source whose rows are
//! [`Elsewhere`](taut_points::Elsewhere): it waits where it would read.
//!
//! ```
//! use taut_enclose::{BallOptions, passes::{Partial, Solver}};
//! use taut_points::{Blocks, Distribution, Monitor, PointSource, Points, generate};
//!
//! let dim = 3;
//! let values: Vec<f64> = generate(Distribution::Normal, 50_000, dim, 7)?;
//! let all = Points::new(&values, dim)?;
//! let first = Blocks::of(&all).range(0).end;                       // two parts: one block, and the others
//! let parts = [(0, all.slice(0..first as usize)), (first, all.slice(first as usize..50_000))];
//!
//! let monitor = Monitor::silent();
//! let mut solver = Solver::ball(50_000, dim, BallOptions::default())?;
//! while let Some(query) = solver.query(&monitor)? {
//!     let mut partials = parts.iter().map(|(first_row, part)| query.run(part, *first_row, &monitor));
//!     let merged = partials.try_fold(Partial::none(query), |all, part| Ok::<_, taut_enclose::Error>(all.merge(part?)?))?;
//!     solver.feed(merged)?;
//! }
//! let found = solver.solution(&monitor)?;
//! assert_eq!(found.to_json(), taut_enclose::ball(&all, &BallOptions::default())?.to_json());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod centers;
mod items;
mod partial;
mod points;
mod query;
mod shells;
mod solver;
mod traversal;

pub(crate) use centers::ask_reach;
pub(crate) use items::{FirstAnswer, ask_first, ask_items, ask_spread};
pub use partial::Partial;
pub(crate) use points::{PointsAnswer, ask_points};
pub use query::Query;
pub(crate) use shells::{SHELLS, ask_border, ask_counts};
pub use solver::{RobustSolver, Solver};
pub(crate) use traversal::{ask_extent, ask_farthest};
