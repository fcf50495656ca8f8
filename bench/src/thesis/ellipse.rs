//! Figure 62: the largest ellipse in a projection of the bunny, by the methods of the thesis and by the default one.
//!
//! *What is rerun.* The thesis does not say from where its bunny is seen. Here the model is projected along its z axis; the outline is the
//! largest loop of the alpha shape of the projected vertices. Times are not printed in the thesis.

use std::collections::BTreeMap;

use taut_delaunay::{DelaunayOptions, Plane};
use taut_draw::ellipse_figures;
use taut_inscribe::{EllipseMethod, EllipseOptions, EllipseThesisOptions, inscribed_ellipse};

use super::*;
use crate::inscribe::shapes::read;

/// The radius of the alpha shape; the longest side of the model is 1.
const ALPHA: f64 = 0.02;

const METHODS: [EllipseMethod; 3] = [
    EllipseMethod::BranchAndBound,
    EllipseMethod::Thesis(EllipseThesisOptions::DEFAULT),
    EllipseMethod::FivePoint(EllipseThesisOptions::DEFAULT),
];

/// Reruns the figure: a picture for each method, and a table.
pub(super) fn write(plan: &Plan) -> Result<()> {
    let Some(mesh) = read("bunny_res2")? else { return Ok(()) };
    let projected: Vec<f64> = mesh.as_flattened().iter().flat_map(|p| [p[0], p[1]]).collect();
    let ring = outline(&projected)?;
    let points = Points::new(&ring, 2)?;
    let mut csv = String::from("figure,method,vertices,area,seconds,gap\n");
    for method in METHODS {
        let options = EllipseOptions { method, ..EllipseOptions::default() };
        let (found, seconds) = plan.best_of(|| Ok(inscribed_ellipse(&points, &options)?))?;
        let gap = found.check(&points)?.gap;
        let (name, area) = (method.name(), found.answer.area);
        writeln!(csv, "62,{name},{},{area:.6},{seconds:.4},{gap:.6}", ring.len() / 2)?;
        for figure in ellipse_figures(&found, &points, &DrawOptions::default())? {
            let path = plan.out.join(format!("figure-62-{name}.svg"));
            fs::write(&path, to_svg(&figure, &Style::default()))?;
            println!("{}", path.display());
        }
    }
    print!("{csv}");
    fs::write(plan.out.join("figure-62.csv"), csv)?;
    Ok(())
}

/// The largest loop around the alpha shape of points of the plane.
fn outline(points: &[f64]) -> Result<Vec<f64>> {
    let plane = Plane::build(&Points::new(points, 2)?, &DelaunayOptions::default())?;
    let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for [from, to] in plane.alpha_complex(ALPHA).boundary {
        next.entry(from).or_default().push(to);
    }
    let (mut best, mut largest) = (vec![], 0.0);
    while let Some((&first, _)) = next.first_key_value() {
        let (mut ring, mut at) = (vec![], first);
        while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
            next.retain(|_, ends| !ends.is_empty());
            ring.push(plane.site(at));
            at = to;
        }
        let corners = ring.iter().zip(ring.iter().cycle().skip(1));
        let area = corners.map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum::<f64>().abs();
        if area > largest {
            (best, largest) = (ring, area);
        }
    }
    ensure!(largest > 0.0, "the projection has no outline");
    Ok(best.concat())
}
