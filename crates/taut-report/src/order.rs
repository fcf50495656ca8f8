//! The report about an order of points.

use taut::certify::OrderVerdict;
use taut::certify::{Order, OrderCurve};
use taut::{PointSource, Solution};

use crate::numbers::{count, counted};
use crate::{Claims, Field, Report, Summary};

impl Summary for Order {
    const FOUND: &'static str = "the order";

    fn title(report: &Report<'_, Self>) -> String {
        format!("{} points {}", count(report.points.len()), along(report.found))
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        vec![match &report.verdict {
            Some(verdict) => Field::new("verified", "yes")
                .remark(format!("the one order, by {}", counted(verdict.grids, "grid"))),
            None => Field::new("verified", "not checked"),
        }]
    }

    fn dim(report: &Report<'_, Self>) -> usize {
        report.points.dim()
    }

    fn no_picture(_: &Solution<Self>) -> Option<&'static str> {
        Some("an order of points has no picture")
    }

    fn claims(found: &Solution<Self>, verdict: &OrderVerdict, source: &dyn PointSource) -> Claims {
        let dim = counted(source.dim() as u64, "dimension");
        let grids = Field::proved("grids", count(verdict.grids))
            .remark("no place on the curve is below the one before it");
        Claims {
            what: format!("{} {} in {dim}", counted(verdict.points, "point"), along(found)),
            gap: None,
            fields: vec![grids],
        }
    }
}

fn along(found: &Solution<Order>) -> &'static str {
    match found.answer.curve {
        OrderCurve::Hilbert => "along a Hilbert curve",
        OrderCurve::Morton => "in Z-order",
    }
}
