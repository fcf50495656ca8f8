//! Tables 4, 5 and 6, and figures 76 and 77: k-dops in meshes, by the procedure of the thesis and by the default method.
//!
//! *What is rerun.* Of the eight models five are here; Beethoven, the dragon and the bunny are other versions. The thesis does not
//! say which models figures 76 and 77 show: here they are Beethoven and the bunny. Its times are mostly those of a 1 GHz Pentium III
//! (8.5.6), and its shares are of the grid that gave the seeds; here they are of points that the search does not see.

use taut_inscribe::{
    BodiesMethod, BodiesOptions, BodiesThesisOptions, BodyShape, inscribed_bodies,
};

use super::*;
use crate::inscribe::shapes::{Mesh, read};

/// A model, and what the thesis says of it for 18 and for 26 directions.
struct Model {
    name: &'static str,
    file: &'static str,
    /// Seconds for the largest dop.
    largest: [f64; 2],
    /// Dops of a packing, seconds, and the share covered in percent.
    packed: [(usize, f64, f64); 2],
}

const MODELS: [Model; 5] = [
    Model {
        name: "Beethoven",
        file: "beethoven",
        largest: [1.91, 10.7],
        packed: [(15, 18.57, 58.0), (13, 27.63, 61.0)],
    },
    Model {
        name: "Dragon",
        file: "chinese_dragon_10k",
        largest: [1.97, 6.48],
        packed: [(17, 28.72, 39.0), (33, 167.0, 52.0)],
    },
    Model {
        name: "Porsche",
        file: "porsche",
        largest: [1.6, 4.78],
        packed: [(10, 22.25, 66.0), (4, 33.16, 55.0)],
    },
    Model {
        name: "Bunny",
        file: "bunny_res2",
        largest: [2.55, 7.98],
        packed: [(45, 62.51, 72.0), (40, 223.47, 75.0)],
    },
    Model {
        name: "Horse",
        file: "horse",
        largest: [4.85, 7.17],
        packed: [(10, 55.65, 54.0), (12, 102.4, 55.0)],
    },
];

/// The methods by their names, and whether dops are disjoint.
const METHODS: [(&str, BodiesMethod, bool); 4] = [
    ("thesis", BodiesMethod::Thesis(BodiesThesisOptions::DEFAULT), true),
    (
        "thesis, merged",
        BodiesMethod::Thesis(BodiesThesisOptions { merge: true, ..BodiesThesisOptions::DEFAULT }),
        true,
    ),
    ("default, disjoint", BodiesMethod::Recreate, true),
    ("default, overlapping", BodiesMethod::Recreate, false),
];

/// Dops found, the seconds this took, and the share covered in percent.
fn pack(
    plan: &Plan,
    mesh: &Mesh,
    (shape, count): (BodyShape<'_>, usize),
    (method, disjoint): (BodiesMethod, bool),
) -> Result<(usize, f64, f64)> {
    let points = Points::new(mesh.as_flattened().as_flattened(), 9)?;
    let events = plan.context.size(BodiesOptions::default().events, 5_000);
    let options = BodiesOptions { shape, count, method, disjoint, events, ..Default::default() };
    let pool = plan.context.pool()?;
    let solve = || Ok(pool.install(|| inscribed_bodies(&points, &options))?);
    let (found, seconds) = plan.best_of(solve)?;
    found.check(&points)?;
    let counter = |name: &str| found.trace.counters.get(name).copied().unwrap_or(0) as f64;
    Ok((found.answer.bodies.len(), seconds, 100.0 * counter("covered") / counter("sample_points")))
}

/// Reruns the tables: one file for all three.
pub(super) fn tables(plan: &Plan) -> Result<()> {
    let mut csv = String::from("table,model,directions,method,dops,seconds,covered\n");
    for model in MODELS.iter().take(plan.context.size(MODELS.len(), 1)) {
        let Some(mesh) = read(model.file)? else { continue };
        for (at, k) in [18, 26].into_iter().enumerate() {
            let (count, seconds, share) = model.packed[at];
            let (name, largest) = (model.name, model.largest[at]);
            writeln!(
                csv,
                "4,{name},{k},printed,1,{largest},\n{},{name},{k},printed,{count},{seconds},{share}",
                5 + at
            )?;
            for (table, count) in [(4, 1), (5 + at, count)] {
                for (method_name, method, disjoint) in METHODS {
                    let (dops, seconds, share) =
                        pack(plan, &mesh, (BodyShape::Dop(k), count), (method, disjoint))?;
                    writeln!(
                        csv,
                        "{table},{name},{k},\"{method_name}\",{dops},{seconds:.3},{share:.1}"
                    )?;
                }
            }
        }
    }
    print!("{csv}");
    let path = plan.out.join("tables-4-5-6.csv");
    fs::write(&path, csv)?;
    println!("{}", path.display());
    Ok(())
}

/// Reruns figures 76 and 77: the share covered by the number of 18-dops.
pub(super) fn figures(plan: &Plan) -> Result<()> {
    for (number, file) in [(76, "beethoven"), (77, "bunny_res2")] {
        let Some(mesh) = read(file)? else { continue };
        let title = format!("share of {file} covered by 18-dops");
        let mut figure = Figure::of_shares(number, title, "dops");
        for (name, method, disjoint) in METHODS {
            let mut points = vec![];
            for &count in plan.upto(&[1, 2, 5, 10, 15, 20, 30, 45, 60], 2, 8) {
                let (_, _, share) =
                    pack(plan, &mesh, (BodyShape::Dop(18), count), (method, disjoint))?;
                points.push([count as f64, share]);
            }
            figure.curves.push(Curve { name: name.to_owned(), points });
        }
        figure.show(plan)?;
    }
    Ok(())
}
