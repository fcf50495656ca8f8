//! Figures 1, 16 and 17: k centers of cities and of points in space, by Algorithm 2 and by the default method.
//!
//! *What is rerun.* Figure 17 of the 15,112 cities of Germany in TSPLIB's `d15112`, k = 5, and figure 1 of the 13,509 cities of the USA
//! in `usa13509`, k = 5, both with ε = 0.01. The thesis does not name the points in space of figure 16, k = 4; here they are the
//! vertices of the bunny, or normal points where that is not at hand.
//! *What is printed.* 2.5 says only that some sets in space took almost a week; so times are told beside the gap that was proved.

use taut_certify::{Centers, Solution};
use taut_draw::centers_figures;
use taut_enclose::{CentersMethod, CentersOptions, centers};
use taut_io::{Content, open_mesh};

use super::*;
use crate::centers::cities;

/// One picture.
struct Picture {
    /// Number in the thesis.
    number: u32,
    /// What the points are.
    what: &'static str,
    values: Vec<f64>,
    dim: usize,
    k: usize,
}

const EPSILON: f64 = 0.01;

const METHODS: [CentersMethod; 2] = [CentersMethod::Thesis, CentersMethod::Tree];

fn pictures() -> Result<Vec<Picture>> {
    let mut found = vec![];
    for (number, what, name) in
        [(1, "cities of the USA", "usa13509.xy.xz"), (17, "cities of Germany", "d15112.tsp.xz")]
    {
        if let Some(values) = cities::read(name)? {
            found.push(Picture { number, what, values, dim: 2, k: 5 });
        }
    }
    let (what, values) = match data::find("surface/stanford_bunny.off.xz") {
        Some(path) => {
            let mesh = open_mesh(&path, Content::Surface, None)?;
            ("vertices of the bunny", mesh.vertices.into_flattened())
        }
        None => ("normal points", generate(Distribution::Normal, 1000, 3, SEED)?),
    };
    found.push(Picture { number: 16, what, values, dim: 3, k: 4 });
    Ok(found)
}

/// Reruns the three figures: a picture by the default method for each, and a table of both methods.
pub(super) fn figures(plan: &Plan) -> Result<()> {
    let max_nodes = match plan.size {
        Size::Quick => 10_000,
        Size::Usual => 1_000_000,
        Size::Full => CentersOptions::default().max_nodes,
    };
    let mut csv = String::from("figure,points,n,k,method,radius,gap,nodes,core_set,seconds\n");
    for picture in pictures()? {
        let Picture { number, what, ref values, dim, k } = picture;
        let points = Points::new(values, dim)?;
        for method in METHODS {
            let options =
                CentersOptions { epsilon: EPSILON, method, max_nodes, ..CentersOptions::default() };
            let (found, seconds) = plan.best_of(|| Ok(centers(&points, k, &options)?))?;
            let gap = found.check(&points)?.gap;
            let (name, trace, n) = (method.name(), &found.trace, values.len() / dim);
            writeln!(
                csv,
                "{number},{what},{n},{k},{name},{},{gap:.3e},{},{},{seconds:.4}",
                found.answer.radius, trace.iterations, trace.core_set
            )?;
            if method == CentersMethod::Tree {
                draw(plan, number, &found, &points)?;
            }
        }
    }
    print!("{csv}");
    Ok(fs::write(plan.out.join("figures-1-16-17.csv"), csv)?)
}

/// Draws the points, or some thousands of them, with their balls.
fn draw(
    plan: &Plan,
    number: u32,
    found: &Solution<Centers>,
    points: &Points<'_, f64>,
) -> Result<()> {
    let options = DrawOptions { max_points: 4000, ..DrawOptions::default() };
    if let Some(figure) = centers_figures(found, points, &options)?.first() {
        let path = plan.out.join(format!("figure-{number:02}.svg"));
        fs::write(&path, to_svg(figure, &Style::default()))?;
        println!("{}", path.display());
    }
    Ok(())
}
