//! The picture of a solution, as a notebook shows it.

use taut::PointSource;
use taut::certify::{AnySolution, Solution, with_solution};
use taut_draw::{DrawOptions, Figures, Style, to_svg};

/// Most simplices of a picture: unlike points they are never thinned, and a notebook keeps all that it shows.
const SIMPLICES_MAX: usize = 20_000;

/// The first figure, as SVG; none for orders, for too many simplices, and where drawing refuses the rows.
pub(crate) fn picture(found: &AnySolution, rows: &dyn PointSource) -> Option<String> {
    with_solution!(found, found => first(found, rows))
}

fn first<A: Figures>(found: &Solution<A>, rows: &dyn PointSource) -> Option<String> {
    if found.answer.simplices() > SIMPLICES_MAX {
        return None;
    }
    let options = DrawOptions { width: 560.0, height: 420.0, ..DrawOptions::default() };
    let figures = A::figures(found, rows, &options).ok()?;
    Some(to_svg(figures.first()?, &Style::default()))
}
