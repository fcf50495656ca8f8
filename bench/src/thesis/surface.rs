//! Table 1 of the thesis, rerun: a table as CSV, and a picture of each row by the default method.

use super::*;
use crate::surface::table_one;

/// Reruns Table 1.
pub(super) fn write(plan: &Plan) -> Result<()> {
    let path = plan.out.join("table-1.csv");
    fs::write(&path, csv(&TableOne::run(&plan.context)?.rows))?;
    println!("{}", path.display());
    for (name, count, _) in TABLE {
        let Some((points, _)) = table_one::input(name, count, plan.context.seeds.start)? else {
            continue;
        };
        let (found, _) = ours(&points, &SurfaceOptions::default())?;
        let view = Points::new(points.as_flattened(), 3)?;
        let figures = surface_figures(&found, &view, &DrawOptions::default())?;
        if let Some(figure) = figures.first() {
            let path = plan.out.join(format!("table-1-{}.svg", name.to_lowercase()));
            fs::write(&path, to_svg(figure, &Style::default()))?;
            println!("{}", path.display());
        }
    }
    Ok(())
}

/// The rows of the table.
fn csv(rows: &[Value]) -> String {
    const COLUMNS: [&str; 10] = [
        "row",
        "thesis",
        "input",
        "points",
        "method",
        "seconds",
        "components",
        "genus",
        "loops",
        "unused",
    ];
    let text = |value: &Value| value.as_str().map_or(value.to_string(), str::to_owned);
    let lines = rows.iter().map(|row| COLUMNS.map(|name| text(&row[name])).join(",") + "\n");
    [COLUMNS.join(",") + "\n"].into_iter().chain(lines).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_of_the_table_is_a_line() {
        let row = json!({
            "row": "Cat", "thesis": "12 s", "input": "a wedge", "points": 9, "method": "tree", "seconds": 0.5,
            "components": 1, "genus": null, "loops": 0, "unused": 2,
        });
        let csv = csv(&[row]);
        assert!(csv.starts_with("row,thesis,input,"));
        assert_eq!(csv.lines().last(), Some("Cat,12 s,a wedge,9,tree,0.5,1,null,0,2"));
    }
}
