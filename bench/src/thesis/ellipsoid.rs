//! Figure 18 of the thesis: sizes of core-sets for the smallest ellipsoid, by dimension and by ε.
//!
//! *What is rerun.* The thesis shows preliminary results of a MATLAB program and no numbers: core-sets of Algorithm 5. They
//! are drawn beside what the same steps with steps away leave, and the support of the exact ellipsoid, which has between
//! d + 1 and d(d + 3)/2 points. Each size is that of an answer whose gap was proved.

use std::time::Instant;

use anyhow::{Result, bail};
use taut_draw::Scale;
use taut_enclose::{EllipsoidMethod, EllipsoidOptions, ellipsoid};
use taut_points::{Distribution, Points, generate};

use super::Plan;
use super::figure::{Curve, Figure};
use crate::input::SEED;

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

/// What one instance gave.
struct Value {
    x: f64,
    seconds: f64,
    core_set: f64,
}

/// Solves the instances in order until the budget of the plan is used up; says where it stopped.
fn sweep(plan: &Plan, way: &Way, all: &[Instance], notes: &mut Vec<String>) -> Result<Vec<Value>> {
    let (mut values, mut used) = (Vec::new(), 0.0);
    for &Instance { x, law, dim, epsilon } in all {
        if used > plan.budget.as_secs_f64() {
            notes.push(format!("“{}” stops before {x}: its budget of time is used up.", way.name));
            break;
        }
        let rows: Vec<f64> = generate(law, N, dim, SEED)?;
        let points = Points::new(&rows, dim)?;
        let epsilon = way.epsilon.unwrap_or(epsilon);
        let options = EllipsoidOptions { method: way.method, epsilon, ..Default::default() };
        let (mut best, mut last) = (f64::INFINITY, None);
        for _ in 0..plan.runs {
            let start = Instant::now();
            let found = ellipsoid(&points, &options)?;
            let seconds = start.elapsed().as_secs_f64();
            best = best.min(seconds);
            used += seconds;
            last = Some(found);
        }
        let Some(found) = last else { bail!("no run") };
        // Checked outside the time; a rejected answer is not drawn in silence.
        match found.check(&points) {
            Ok(verdict) if verdict.gap <= epsilon => {}
            Ok(verdict) => {
                notes.push(format!(
                    "“{}” at {x}: the gap reached is {:.1e}.",
                    way.name, verdict.gap
                ));
            }
            Err(error) => {
                notes.push(format!("“{}” at {x} is REJECTED by the checker: {error}.", way.name));
            }
        }
        let core_set = match way.method {
            EllipsoidMethod::Newton => found.certificate.support.len() as f64,
            _ => found.trace.core_set as f64,
        };
        values.push(Value { x, seconds: best, core_set });
    }
    Ok(values)
}

/// Sizes of one set of instances under all ways, and the times if asked for.
fn draw(
    plan: &Plan,
    part: &'static str,
    title: &str,
    x: &'static str,
    instances: &[Instance],
    with_times: Option<&'static str>,
) -> Result<Vec<Figure>> {
    let figure = |part, title, y, unit, scale| Figure {
        number: 18,
        part,
        title,
        x,
        y,
        unit,
        scale,
        curves: vec![],
        notes: vec![],
    };
    let mut sizes = figure(part, format!("core-set size, {title}"), "points", "", Scale::Linear);
    let mut times = figure(
        with_times.unwrap_or_default(),
        format!("running time, {title}"),
        "time",
        "s",
        Scale::Log,
    );
    for way in &WAYS {
        let mut notes = vec![];
        let values = sweep(plan, way, instances, &mut notes)?;
        let curve = |name: String, pick: &dyn Fn(&Value) -> f64| Curve {
            name,
            points: values.iter().map(|value| [value.x, pick(value)]).collect(),
        };
        let of = if way.epsilon.is_some() { ": support" } else { "" };
        sizes.curves.push(curve(format!("{}{of}", way.name), &|value| value.core_set));
        times.curves.push(curve(way.name.to_owned(), &|value| value.seconds));
        sizes.notes.extend(notes.iter().cloned());
        times.notes.extend(notes);
    }
    Ok(if with_times.is_some() { vec![sizes, times] } else { vec![sizes] })
}

/// All parts of figure 18.
pub(super) fn figures(plan: &Plan) -> Result<Vec<Figure>> {
    let dims = plan.upto(&[2usize, 3, 4, 6, 8, 10, 15, 20, 25, 30, 40, 50], 2, 9);
    let by_dim = |law| -> Vec<Instance> {
        let instance = |&dim: &usize| Instance { x: dim as f64, law, dim, epsilon: 0.1 };
        dims.iter().map(instance).collect()
    };
    let powers = plan.upto(&[1u32, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], 2, 8);
    let by_epsilon: Vec<Instance> = powers
        .iter()
        .map(|&power| Instance {
            x: power.into(),
            law: Distribution::Normal,
            dim: 10,
            epsilon: 0.5f64.powi(power as i32),
        })
        .collect();
    let normal = by_dim(Distribution::Normal);
    let uniform = by_dim(Distribution::Uniform);
    let mut all = draw(plan, "a", "10⁴ normal points, ε = 0.1", "dimension", &normal, Some("b"))?;
    all.extend(draw(plan, "c", "10⁴ uniform points, ε = 0.1", "dimension", &uniform, None)?);
    let title = "10⁴ normal points, d = 10";
    all.extend(draw(plan, "d", title, "log2(1/ε)", &by_epsilon, Some("e"))?);
    Ok(all)
}
