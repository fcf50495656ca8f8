//! Balls, under each of six radius laws.

use super::*;

/// Runs the case under all six laws.
pub(super) fn run(
    context: &Context,
    out: &mut Outcome,
    goals: Goals,
    balls: &BallsCase,
) -> Result<()> {
    for radii in Radii::ALL {
        let input = Input::balls(radii, context.count(balls.n), balls.d)?;
        Paired::run(context, &input, balls.peers)?.show(out, &input, goals);
        out.close(&input.what);
    }
    Ok(())
}
