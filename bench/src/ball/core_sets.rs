//! Core-set sizes as the thesis counts them: one far point per pass, ε = 1e-3.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use anyhow::Result;
use serde_json::{Value, json};
use taut_enclose::{BallMethod, BallOptions, ball};
use taut_points::{Distribution, Monitor};

use super::Context;
use super::case::Case;
use crate::input::Input;
use crate::stats::seconds;
use crate::table::Table;

/// What the thesis says of an instance.
struct Instance {
    input: Input,
    said: &'static str,
}

/// Prints core-set sizes of four distributions, of USPS, and of the two instances of which the thesis gives figures.
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let shrink = if context.quick { 10 } else { 1 };
    let in_figures = "30–170 (figures 8, 10, 12)";
    let mut instances = vec![
        Instance {
            input: Input::points(Distribution::Normal, 5_000 / shrink, 500)?,
            said: "75, r = 24.094 on its own sample, 81 s",
        },
        Instance {
            input: Input::points(Distribution::CubeVertices, 5_000 / shrink, 500)?,
            said: "670–692 s; size not given",
        },
    ];
    for distribution in [
        Distribution::Normal,
        Distribution::Uniform,
        Distribution::Poisson,
        Distribution::CubeVertices,
    ] {
        let input = Input::points(distribution, 10_000 / shrink, 300)?;
        instances.push(Instance { input, said: in_figures });
    }
    match Input::usps()? {
        Some(input) => instances.push(Instance { input, said: "30 (fast)" }),
        None => {
            println!("USPS is left out: set TAUT_DATA to a folder with ball/usps_train.csv.xz\n")
        }
    }

    let ways = [
        ("thesis-pure", BallMethod::ThesisPure, None),
        ("thesis-fast", BallMethod::ThesisFast, None),
        ("core-set, batch 1", BallMethod::CoreSet, Some(1)),
        ("core-set, default", BallMethod::CoreSet, None),
    ];
    let mut table = Table::new(&[
        "input",
        "method",
        "core-set",
        "support",
        "passes",
        "radius",
        "verified gap",
        "time",
        "the thesis",
    ]);
    let mut rows = Vec::new();
    for Instance { input, said } in &instances {
        let source = input.source()?;
        for (name, method, batch) in ways {
            let options = BallOptions { epsilon: 1e-3, method, batch, ..BallOptions::default() };
            let start = Instant::now();
            let Some(found) = within(context.limit, |monitor| {
                ball(&*source, &BallOptions { inputs: input.items, monitor: *monitor, ..options })
            })?
            else {
                let silence = format!("none in {} s", context.limit.as_secs());
                println!("{}: {name}: no answer in {} s", input.what, context.limit.as_secs());
                rows.push(json!({ "input": input.what, "method": name, "silence": &silence }));
                let mut row = vec![input.what.clone(), name.to_owned(), silence];
                row.extend(vec![String::new(); 5]);
                row.push((*said).to_owned());
                table.push(row);
                continue;
            };
            let time = start.elapsed().as_secs_f64();
            let verdict = found.check(&*source);
            let support = found.certificate.support.len();
            table.push(vec![
                input.what.clone(),
                name.to_owned(),
                found.trace.core_set.to_string(),
                support.to_string(),
                found.trace.passes.to_string(),
                format!("{:.4}", found.answer.radius),
                verdict
                    .as_ref()
                    .map_or_else(|e| format!("REJECTED: {e}"), |v| format!("{:.1e}", v.gap)),
                seconds(time),
                (*said).to_owned(),
            ]);
            rows.push(json!({
                "input": input.what, "method": name, "core_set": found.trace.core_set, "support": support,
                "passes": found.trace.passes, "radius": found.answer.radius, "seconds": time,
                "gap": verdict.ok().map(|v| v.gap),
            }));
        }
    }
    println!("{table}");
    context.report.add(json!({ "name": case.name, "rows": Value::from(rows) }));
    Ok(())
}

/// What `solve` answers, or `None` once it has been stopped, at the first pass after `limit`.
fn within<T>(
    limit: Duration,
    solve: impl FnOnce(&Monitor<'_>) -> Result<T, taut_enclose::Error>,
) -> Result<Option<T>> {
    let late = AtomicBool::new(false);
    let flag = &late;
    let answer = std::thread::scope(|scope| {
        let (done, wait) = channel::<()>();
        scope.spawn(move || {
            if wait.recv_timeout(limit) == Err(RecvTimeoutError::Timeout) {
                flag.store(true, Ordering::Relaxed);
            }
        });
        let answer = solve(&Monitor { cancel: Some(flag), ..Monitor::silent() });
        drop(done);
        answer
    });
    match answer {
        Ok(answer) => Ok(Some(answer)),
        Err(_) if late.load(Ordering::Relaxed) => Ok(None),
        Err(error) => Err(error.into()),
    }
}
