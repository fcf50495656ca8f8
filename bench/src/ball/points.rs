//! Points in memory, and balls under each of six radius laws, solved exactly.

use super::*;

/// Runs n generated points of dimension d.
pub(super) fn run(
    context: &Context,
    out: &mut Outcome,
    distribution: Distribution,
    n: usize,
    d: usize,
) -> Result<()> {
    let n = context.size(n, (n / 10).max(500));
    show(context, out, &Input::points(distribution, n, d)?)
}

/// Runs points of the size of the largest instance of the thesis, in single precision, which peers do not take.
pub(super) fn run_largest(context: &Context, out: &mut Outcome) -> Result<()> {
    show(context, out, &Input::single(Distribution::Normal, context.count(100_000), 1500)?)
}

/// Runs the USPS digits.
pub(super) fn run_usps(context: &Context, out: &mut Outcome) -> Result<()> {
    match Input::usps()? {
        Some(input) => show(context, out, &input),
        None => out.left_out(),
    }
}

/// Runs n balls with normal centers of dimension d under all laws.
pub(super) fn run_balls(context: &Context, out: &mut Outcome, n: usize, d: usize) -> Result<()> {
    for radii in Radii::ALL {
        let input = Input::balls(radii, context.count(n), d)?;
        show(context, out, &input)?;
        out.close(&input.what);
    }
    Ok(())
}

fn show(context: &Context, out: &mut Outcome, input: &Input) -> Result<()> {
    Paired::run(context, input)?.show(out, input);
    Ok(())
}
