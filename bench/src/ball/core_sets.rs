//! Core-set sizes as the thesis counts them: one far point per pass, ε = 1e-3.

use super::*;

/// Prints core-set sizes of four distributions, of USPS, and of the two instances of which the thesis gives figures.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let points = |distribution, n, d| Input::points(distribution, context.count(n), d);
    let in_figures = "30–170 (figures 8, 10, 12)";
    let mut instances = vec![
        (points(Distribution::Normal, 5_000, 500)?, "75, r = 24.094 on its own sample, 81 s"),
        (points(Distribution::CubeVertices, 5_000, 500)?, "670–692 s; size not given"),
    ];
    for distribution in [
        Distribution::Normal,
        Distribution::Uniform,
        Distribution::Poisson,
        Distribution::CubeVertices,
    ] {
        instances.push((points(distribution, 10_000, 300)?, in_figures));
    }
    instances.extend(Input::usps()?.map(|input| (input, "30 (fast)")));
    let ways = [
        ("thesis-pure", BallMethod::ThesisPure, None),
        ("thesis-fast", BallMethod::ThesisFast, None),
        ("core-set, batch 1", BallMethod::CoreSet, Some(1)),
        ("core-set, default", BallMethod::CoreSet, None),
    ];
    let mut table = Table::new(
        "input | method | core-set | support | passes | radius:4 | verified gap | time:s | the \
            thesis",
    );
    for (input, said) in &instances {
        let source = input.source()?;
        for (name, method, batch) in ways {
            let inputs = input.items;
            let options =
                BallOptions { epsilon: 1e-3, method, batch, inputs, ..Default::default() };
            let start = Instant::now();
            let found = within(context.limit, |monitor| {
                ball(&*source, &BallOptions { monitor: *monitor, ..options })
            })?;
            let time = start.elapsed().as_secs_f64();
            let head = json!({ "input": input.what, "method": name, "the thesis": said });
            let Some(found) = found else {
                let silence = Silence::Slow(context.limit);
                table.push(joined([head, json!({ "core-set": silence })]));
                continue;
            };
            let gap = match found.check(&*source) {
                Ok(verdict) => Unit::Power.show(verdict.gap),
                Err(error) => format!("REJECTED: {error}"),
            };
            let cells = json!({
                "core-set": found.trace.core_set, "support": found.certificate.support.len(),
                "passes": found.trace.passes, "radius": found.answer.radius, "verified gap": gap, "time": time,
            });
            table.push(joined([head, cells]));
        }
    }
    out.table("", table);
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
