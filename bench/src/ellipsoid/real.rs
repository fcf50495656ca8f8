//! Small sets of real data, beside the brackets in which their optima are known to lie.

use super::*;

/// Up to this dimension the time counts.
const TIMED_DIM_MAX: usize = 13;

/// What is known of a set; those in a hyperplane have no bracket.
#[derive(Deserialize)]
struct Known {
    log_volume_lower: Option<f64>,
    log_volume_upper: Option<f64>,
}

/// Solves all sets of which a bracket is known.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let Some(optima) = data::find("ellipsoid/reference_optima.json") else {
        return out.left_out();
    };
    let known: BTreeMap<String, Known> = serde_json::from_str(&std::fs::read_to_string(&optima)?)?;
    let mut table = Table::new(&format!("set | n × d | {} | outside:e", columns()));
    let mut found = Found::default();
    // A set takes less than a millisecond: one that is disturbed in each of a few rounds would say nothing.
    let runs = 4 * context.runs;
    for (name, known) in &known {
        let (Some(lower), Some(upper)) = (known.log_volume_lower, known.log_volume_upper) else {
            continue;
        };
        let (values, d) = read(&optima.with_file_name(name), None).with_context(|| name.clone())?;
        let solved = solve(context, runs, &values, d, &[])?;
        let volume = solved.rounds.found.answer.log_volume;
        let outside = (volume - upper).max(lower - volume).max(0.0);
        let size = format!("{} × {d}", values.len() / d);
        let head =
            json!({ "set": name, "n × d": size, "outside": outside, "solved": solved.json() });
        table.push(joined([head, solved.cells()]));
        let mut of = solved.found();
        of.add(OUTSIDE, outside);
        if d > TIMED_DIM_MAX {
            of.forget(SECONDS);
        }
        found.join(of);
    }
    out.table(&format!("the time counts where d ≤ {TIMED_DIM_MAX}"), table);
    out.judge(&found);
    Ok(())
}
