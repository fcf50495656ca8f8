//! Points in memory, solved exactly.

use super::*;

/// Runs a case of generated points.
pub(super) fn run(
    context: &Context,
    out: &mut Outcome,
    goals: Goals,
    points: &PointsCase,
) -> Result<()> {
    let n = context.size(points.n, (points.n / 10).max(500));
    let draw = if points.single { Input::single } else { Input::points };
    let input = draw(points.distribution, n, points.d)?;
    Paired::run(context, &input, points.peers)?.show(out, &input, goals);
    Ok(())
}

/// Runs the case of the USPS digits, beside the Fischer–Gärtner–Kutz code.
pub(super) fn run_usps(context: &Context, out: &mut Outcome, goals: Goals) -> Result<()> {
    let Some(input) = Input::usps()? else { return out.left_out() };
    Paired::run(context, &input, FGK)?.show(out, &input, goals);
    Ok(())
}
