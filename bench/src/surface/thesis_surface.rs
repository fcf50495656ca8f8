//! Table 1 of the thesis, rerun: a table as CSV, and a picture of each row by the default method.

use std::fs;
use std::path::PathBuf;

use anyhow::Result;
use serde_json::Value;
use taut_draw::{DrawOptions, Style, surface_figures, to_svg};
use taut_points::Points;
use taut_reconstruct::SurfaceOptions;

use super::found::ours;
use super::table_one::{self, TABLE};
use crate::context::Context;

/// Seeds what is drawn at random.
const SEED: u64 = 1;

/// Where the table and its pictures go.
#[derive(clap::Args)]
pub(crate) struct ThesisArguments {
    /// Folder for the CSV and SVG files.
    #[arg(long, default_value = "bench/thesis-surface")]
    out: PathBuf,
    /// Rounds where times are taken; the least of them counts.
    #[arg(long, default_value_t = 3)]
    runs: usize,
}

/// Reruns Table 1.
pub(crate) fn run(arguments: &ThesisArguments) -> Result<()> {
    fs::create_dir_all(&arguments.out)?;
    let context = Context::begin(arguments.runs, false, &[1], [300, 300], None)?;
    let measured = table_one::run(&context, SEED..SEED + 1)?;
    let path = arguments.out.join("table-1.csv");
    fs::write(&path, csv(&measured))?;
    println!("{}", path.display());
    for (name, count, _) in TABLE {
        let Some((points, _)) = table_one::input(name, count, SEED)? else { continue };
        let (found, _) = ours(&points, &SurfaceOptions::default())?;
        let view = Points::new(points.as_flattened(), 3)?;
        let figures = surface_figures(&found, &view, &DrawOptions::default())?;
        if let Some(figure) = figures.first() {
            let path = arguments.out.join(format!("{}.svg", name.to_lowercase()));
            fs::write(&path, to_svg(figure, &Style::default()))?;
            println!("{}", path.display());
        }
    }
    Ok(())
}

/// The rows of the table; seconds of the thesis first.
fn csv(measured: &Value) -> String {
    let mut csv =
        "row,thesis,input,points,method,seconds,components,genus,loops,unused\n".to_owned();
    let rows = measured["rows"].as_array().into_iter().flatten();
    for row in rows {
        let text = |value: &Value| value.as_str().map_or(value.to_string(), str::to_owned);
        let cells =
            ["row", "then", "input", "points", "method", "seconds"].map(|key| text(&row[key]));
        let counts =
            ["components", "genus", "loops", "unused"].map(|key| text(&row["judged"][key]));
        csv += &[&cells[..], &counts[..]].concat().join(",");
        csv.push('\n');
    }
    csv
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_row_of_the_table_is_a_line() {
        let judged = json!({ "components": 1, "genus": null, "loops": 0, "unused": 2 });
        let row = json!({
            "row": "Cat", "then": "12 s", "input": "a wedge", "points": 9, "method": "tree", "seconds": 0.5,
            "judged": judged,
        });
        let csv = csv(&json!({ "rows": [row] }));
        assert_eq!(csv.lines().last(), Some("Cat,12 s,a wedge,9,tree,0.5,1,null,0,2"));
    }
}
