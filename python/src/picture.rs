//! The picture of a solution, as a notebook shows it.

use taut::PointSource;
use taut::certify::AnySolution;
use taut_draw::{
    DrawOptions, Style, ball_figures, centers_figures, circle_figures, curve_figures,
    delaunay_figures, ellipsoid_figures, inscribed_figures, robust_figures, surface_figures,
    to_svg,
};

/// Most simplices of a picture: unlike points they are never thinned, and a notebook keeps all that it shows.
const SIMPLICES_MAX: usize = 20_000;

/// The first figure, as SVG; none for orders, for too many simplices, and where drawing refuses the rows.
pub(crate) fn picture(found: &AnySolution, rows: &dyn PointSource) -> Option<String> {
    let options = DrawOptions { width: 560.0, height: 420.0, ..DrawOptions::default() };
    let figures = match found {
        AnySolution::Ball(found) => ball_figures(found, rows, &options),
        AnySolution::Ellipsoid(found) => ellipsoid_figures(found, rows, &options),
        AnySolution::Inscribed(found) => inscribed_figures(found, rows, &options),
        AnySolution::Circle(found) => circle_figures(found, rows, &options),
        AnySolution::Robust(found) => robust_figures(found, rows, &options),
        AnySolution::Centers(found) => centers_figures(found, rows, &options),
        AnySolution::Curve(found) => curve_figures(found, rows, &options),
        AnySolution::Surface(found) if found.answer.triangles.len() <= SIMPLICES_MAX => {
            surface_figures(found, rows, &options)
        }
        AnySolution::Triangulation(found) if found.answer.len() <= SIMPLICES_MAX => {
            delaunay_figures(found, rows, &options)
        }
        _ => return None,
    };
    Some(to_svg(figures.ok()?.first()?, &Style::default()))
}
