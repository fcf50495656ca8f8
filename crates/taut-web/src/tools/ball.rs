//! The smallest ball.

use serde_json::Value;
use taut::{BallMethod, BallOptions, Items, Monitor, ball};

use crate::input::Opened;
use crate::options::{self, Options};
use crate::shape::{Found, Shape};

pub(super) fn options() -> Vec<Value> {
    vec![
        options::number(
            "epsilon",
            BallOptions::default().epsilon,
            "Proved relative gap to reach, in [0, 1); 0 is exact to rounding",
        ),
        // The others need a conic solver, which is not part of this page.
        options::choice::<BallMethod>("method", "The way to find it", |name| {
            ["core-set", "badoiu-clarkson"].contains(&name)
        }),
        options::flag("balls", "Rows are balls: a center, then a radius"),
    ]
}

pub(super) fn solve(
    points: &Opened,
    options: &Options,
    monitor: &Monitor<'_>,
) -> Result<Box<dyn Shape>, String> {
    let usual = BallOptions::default();
    let options = BallOptions {
        inputs: if options.flag("balls") { Items::Balls } else { Items::Points },
        epsilon: options.number("epsilon", usual.epsilon)?,
        method: options.choice("method")?,
        monitor: *monitor,
        ..usual
    };
    let found = ball(points.source(), &options).map_err(|error| points.explain(error))?;
    Ok(Found::boxed(found, super::no_file))
}
