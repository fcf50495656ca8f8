//! A method over instances of growing size: its times and sizes, until its budget is used up.

use super::*;

/// What one instance gave.
pub(super) struct Measured {
    pub(super) x: f64,
    /// The least of all runs.
    pub(super) seconds: f64,
    pub(super) core_set: f64,
    pub(super) support: f64,
    /// What has to be said of it.
    pub(super) warning: Option<String>,
}

impl Plan {
    /// The last answer of all runs, and their least time.
    pub(super) fn best_of<T>(&self, solve: impl Fn() -> Result<T>) -> Result<(T, f64)> {
        let (mut best, mut last) = (f64::INFINITY, None);
        for _ in 0..self.context.runs {
            let start = Instant::now();
            let found = solve()?;
            best = best.min(start.elapsed().as_secs_f64());
            last = Some(found);
        }
        Ok((last.context("no run")?, best))
    }
}

/// What has to be said where the gap is not the one asked for: a rejected answer is not drawn in silence.
pub(super) fn warning(gap: Result<f64, impl std::fmt::Display>, asked: f64) -> Option<String> {
    match gap {
        Ok(gap) if gap <= asked => None,
        Ok(gap) => Some(format!("the gap reached is {gap:.1e}")),
        Err(error) => Some(format!("REJECTED by the checker: {error}")),
    }
}

/// The values of one method, in order of the instances.
pub(super) struct Sweep {
    pub(super) name: String,
    pub(super) values: Vec<Measured>,
    /// Where it stops early, and what has to be said of answers.
    notes: Vec<String>,
}

impl Sweep {
    /// Measures the instances in order until the budget is used up or there is no answer.
    pub(super) fn run<X: Copy>(
        plan: &Plan,
        name: impl Into<String>,
        budget: Duration,
        instances: &[X],
        x: impl Fn(X) -> f64,
        mut measure: impl FnMut(X) -> Result<Result<Measured, Silence>>,
    ) -> Result<Self> {
        let mut sweep = Sweep { name: name.into(), values: vec![], notes: vec![] };
        let mut used = 0.0;
        for &instance in instances {
            let (name, x) = (&sweep.name, x(instance));
            if used > budget.as_secs_f64() {
                let note = format!("“{name}” stops before {x}: its budget of time is used up.");
                sweep.notes.push(note);
                break;
            }
            match measure(instance)? {
                Ok(value) => {
                    let warning = value.warning.as_ref();
                    sweep.notes.extend(warning.map(|it| format!("“{name}” at {x}: {it}.")));
                    used += value.seconds * plan.context.runs as f64;
                    sweep.values.push(value);
                }
                Err(silence) => {
                    sweep.notes.push(format!("“{name}” stops at {x}: {silence}."));
                    break;
                }
            }
        }
        Ok(sweep)
    }

    /// Adds a curve with its notes to a figure.
    pub(super) fn draw(&self, figure: &mut Figure, kind: &str, pick: fn(&Measured) -> f64) {
        let points = self.values.iter().map(|value| [value.x, pick(value)]).collect();
        figure.curves.push(Curve { name: format!("{}{kind}", self.name), points });
        for note in &self.notes {
            if !figure.notes.contains(note) {
                figure.notes.push(note.clone());
            }
        }
    }
}
