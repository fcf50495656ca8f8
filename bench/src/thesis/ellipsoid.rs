//! Figure 18 of the thesis: sizes of core-sets for the smallest ellipsoid, by dimension and by ε.
//!
//! *What is rerun.* The thesis (3.6) shows preliminary results of a MATLAB program, no numbers, and does not name the method. Here
//! core-sets of Algorithm 5 are drawn beside what the same steps with steps away leave, and the support of the exact ellipsoid,
//! which has between d + 1 and d(d + 3)/2 points. Each size is that of an answer whose gap was proved.

use super::*;
use taut_enclose::ellipsoid;

const N: usize = 10_000;

/// A method of ours and the name of its curves.
struct Way {
    name: &'static str,
    method: EllipsoidMethod,
    /// The gap it is asked for, whatever that of the instance; `None` takes that.
    epsilon: Option<f64>,
}

const WAYS: [Way; 3] = [
    Way { name: "Algorithm 5", method: EllipsoidMethod::ThesisCoreSet, epsilon: None },
    Way { name: "with steps away", method: EllipsoidMethod::AwaySteps, epsilon: None },
    Way { name: "taut, ε = 1e-9", method: EllipsoidMethod::Newton, epsilon: Some(1e-9) },
];

/// A number of points in a dimension, under a law, for a gap.
#[derive(Clone, Copy)]
struct Instance {
    /// Where it is drawn.
    x: f64,
    law: Distribution,
    dim: usize,
    epsilon: f64,
}

impl Way {
    fn measure(&self, plan: &Plan, instance: Instance) -> Result<Measured> {
        let Instance { x, law, dim, epsilon } = instance;
        let rows: Vec<f64> = generate(law, N, dim, SEED)?;
        let points = Points::new(&rows, dim)?;
        let epsilon = self.epsilon.unwrap_or(epsilon);
        let options = EllipsoidOptions { method: self.method, epsilon, ..Default::default() };
        let (found, seconds) = plan.best_of(|| Ok(ellipsoid(&points, &options)?))?;
        // Checked outside the time.
        let gap = found.check(&points).map(|verdict| verdict.gap);
        Ok(Measured {
            x,
            seconds,
            core_set: found.trace.core_set as f64,
            support: found.certificate.support.len() as f64,
            warning: warning(gap, epsilon),
        })
    }
}

/// Sizes of one set of instances under all ways, and the times if asked for.
fn draw(
    plan: &Plan,
    part: &'static str,
    of: &str,
    x: &'static str,
    instances: &[Instance],
    part_of_times: Option<&'static str>,
) -> Result<()> {
    let mut sizes = Figure::of_sizes(18, format!("core-set size, {of}"), x).part(part);
    let mut times = Figure::of_times(18, format!("running time, {of}"), x)
        .part(part_of_times.unwrap_or_default());
    for way in &WAYS {
        let measure = |instance| way.measure(plan, instance).map(Ok);
        let (budget, at) = (plan.context.limit, |instance: Instance| instance.x);
        let sweep = Sweep::run(plan, way.name, budget, instances, at, measure)?;
        match way.epsilon {
            Some(_) => sweep.draw(&mut sizes, ": support", |value| value.support),
            None => sweep.draw(&mut sizes, "", |value| value.core_set),
        }
        sweep.draw(&mut times, "", |value| value.seconds);
    }
    sizes.show(plan)?;
    if part_of_times.is_some() { times.show(plan) } else { Ok(()) }
}

/// All parts of figure 18.
pub(super) fn figures(plan: &Plan) -> Result<()> {
    let dims = plan.upto(&[2usize, 3, 4, 6, 8, 10, 15, 20, 25, 30, 40, 50], 2, 9);
    let by_dim = |law| -> Vec<Instance> {
        let instance = |&dim: &usize| Instance { x: dim as f64, law, dim, epsilon: 0.1 };
        dims.iter().map(instance).collect()
    };
    let powers = plan.upto(&[1u32, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], 2, 8);
    let law = Distribution::Normal;
    let by_power = |&power: &u32| {
        let epsilon = 0.5f64.powi(power as i32);
        Instance { x: power.into(), law, dim: 10, epsilon }
    };
    let by_epsilon: Vec<Instance> = powers.iter().map(by_power).collect();
    let [normal, uniform] = [law, Distribution::Uniform].map(by_dim);
    draw(plan, "a", "10⁴ normal points, ε = 0.1", "dimension", &normal, Some("b"))?;
    draw(plan, "c", "10⁴ uniform points, ε = 0.1", "dimension", &uniform, None)?;
    draw(plan, "d", "10⁴ normal points, d = 10", "log2(1/ε)", &by_epsilon, Some("e"))
}
