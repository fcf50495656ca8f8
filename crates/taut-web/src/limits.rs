//! The memory that a tool takes, as far as it can be told before it runs.
//!
//! A module has at most 4 GiB, and when they end, it ends. So the page says beforehand how much a tool is likely to take, and
//! refuses what cannot fit. The figures are bytes a point beside the points, measured in a browser and rounded up.

use serde_json::{Value, json};
use taut::PointSource;
use taut_report::numbers::{bytes, count};

use crate::tools::Tool;

/// The memory of a module.
const MODULE_BYTES: u64 = 4 << 30;

/// From here on the page warns: phones and small machines give a module less than its 4 GiB.
const LARGE_BYTES: u64 = 1 << 30;

/// Returns the bytes a point that a tool takes beside the points.
fn bytes_per_point(tool: Tool, dim: usize) -> u64 {
    match (tool, dim) {
        (Tool::Ball | Tool::Ellipsoid, dim) => 16 * dim as u64,
        (Tool::Centers, dim) => 32 * dim as u64 + 64,
        (Tool::Delaunay, 3) => 2200,
        (Tool::Delaunay, _) => 660,
        (Tool::Curve, _) => 2500,
        (Tool::Surface, _) => 6000,
    }
}

/// Describes to the page how much memory a tool takes for points, and whether they fit.
pub(crate) fn of(tool: Tool, source: &dyn PointSource) -> Value {
    let (rows, dim) = (source.len(), source.dim());
    // The file, its points, and what the tool makes of them.
    let each = bytes_per_point(tool, dim).saturating_add(16 * dim as u64);
    let needed = rows.saturating_mul(each);
    let most = MODULE_BYTES / each.max(1);
    let words = match needed {
        _ if rows > most => format!(
            "{} points need about {}, and a page has at most {}: about {} points fit. The command `taut {}` has no such limit.",
            count(rows),
            bytes(needed),
            bytes(MODULE_BYTES),
            count(round_down(most)),
            tool.name()
        ),
        LARGE_BYTES.. => format!(
            "about {} of memory are needed, which not every device gives to a page",
            bytes(needed)
        ),
        _ => String::new(),
    };
    json!({ "fits": rows <= most, "words": words, "most": round_down(most) })
}

/// Returns two digits of a number.
fn round_down(most: u64) -> u64 {
    let unit = 10_u64.pow(most.max(1).ilog10().saturating_sub(1));
    most / unit * unit
}

#[cfg(test)]
mod tests {
    use super::*;
    use taut::points::{Distribution, GeneratedSource, ScalarKind};

    #[test]
    fn what_cannot_fit_is_refused_with_the_number_that_can() {
        let points = |n| GeneratedSource::new(Distribution::Uniform, n, 2, 0, ScalarKind::F64);
        let small = of(Tool::Delaunay, &points(1000).unwrap());
        assert_eq!((small["fits"].as_bool(), small["words"].as_str()), (Some(true), Some("")));
        let large = of(Tool::Delaunay, &points(3_000_000).unwrap());
        assert!(
            large["fits"].as_bool().unwrap() && large["words"].as_str().unwrap().contains("GiB")
        );
        let huge = of(Tool::Delaunay, &points(10_000_000_000).unwrap());
        assert_eq!(huge["fits"].as_bool(), Some(false));
        assert!(huge["words"].as_str().unwrap().contains("6,200,000 points fit"), "{huge}");
        assert_eq!(round_down(6_236_000), 6_200_000);
        assert_eq!(round_down(7), 7);
    }
}
